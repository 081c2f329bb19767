# make demo: set up, encode a sample asset, decode it, show sizes and errors
# make test: set up, then everything that CI runs
# make docs: the page of the public names, into build/api
# make package: sdist and wheel into build/dist, tried in clean environments of every Python that is there
# make web: what the tests of web/ want besides node and Chromium, by npm
# make warp: the example of docs/physics.md, in an environment of its own with NVIDIA Warp, half a gigabyte
# make blender: the extension in Blender 4.5, in an environment of its own, one gigabyte; wants Python 3.11
# make fuzz: RUNS files of a coverage-guided fuzzer against the parser
# make sanitize: the tests of the native kernels with the sanitizers of memory and undefined behavior, threads with that of threads
# make bench: every codec on the assets in ASSETS, into build/bench/report.html; one to three hours, goes on where it stopped

PYTHON ?= python3
ASSETS ?= ../shared/assets
RUNS ?= 2000000
TORCH ?= torch==2.13.0
BIN := .venv/bin
KERNEL := $(wildcard nispcodec/core/kernel/* nispcodec/train/backend/native/kernel/* nispcodec/infer/native/kernel/*)

.PHONY: setup demo test lint docs package web warp blender fuzz sanitize bench

setup: .venv/ready

# torch first and by itself, as on Linux what pip finds may bring gigabytes of CUDA: the build for
# processors alone is on an index of PyTorch's own, TORCH='torch==2.13.0 --index-url ...'.
# Simplification is for the benchmarks alone, and goes without where there is no C++ compiler.
.venv/ready: pyproject.toml setup.py constraints.txt $(KERNEL)
	$(PYTHON) -m venv .venv
	$(BIN)/pip install --disable-pip-version-check -q -c constraints.txt $(TORCH)
	$(BIN)/pip install --disable-pip-version-check -q -c constraints.txt -e '.[all,dev,bench]'
	-$(BIN)/pip install --disable-pip-version-check -q -c constraints.txt -e '.[simplify]'
	touch $@

# Without torch, where the native backend could be built.
.venv/demo: pyproject.toml setup.py constraints.txt $(KERNEL)
	$(PYTHON) -m venv .venv
	$(BIN)/pip install --disable-pip-version-check -q -c constraints.txt -e '.[encode,render]'
	$(BIN)/python -m nispcodec.train.backend.native || $(BIN)/pip install --disable-pip-version-check -q -c constraints.txt $(TORCH)
	touch $@

demo: .venv/demo
	$(BIN)/nisp sample -o demo --force
	$(BIN)/nisp encode demo/sample.obj -o demo/sample.nisp
	$(BIN)/nisp decode demo/sample.nisp --mesh -o demo/decoded.glb --force
	$(BIN)/nisp render demo/sample.nisp -o demo/sample.png --force
	$(BIN)/nisp compare demo/sample.obj demo/decoded.glb
	ls -l demo

lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

docs: setup
	$(BIN)/python docs/api.py

package: setup
	$(BIN)/python .ci/package.py

web:
	cd web && npm ci --no-audit --no-fund

build/warp/bin/python:
	$(PYTHON) -m venv build/warp
	build/warp/bin/pip install --disable-pip-version-check -q warp-lang==1.19.0 numpy==2.4.6 || { rm -r build/warp; exit 1; }

warp: setup build/warp/bin/python
	$(BIN)/pytest tests/docs/test_physics.py

build/blender/bin/python:
	$(PYTHON) -m venv build/blender
	build/blender/bin/pip install --disable-pip-version-check -q bpy==4.5.15 || { rm -r build/blender; \
		echo 'blender: bpy 4.5.15 has packages for Python 3.11 alone: make blender PYTHON=python3.11'; exit 1; }

blender: setup build/blender/bin/python
	$(BIN)/pytest tests/addons

# Each worker has half of the files, so that what their tests share is made once, and takes from the
# other when it is done. Threads of BLAS that wait for work would spin on the other's core.
test: lint docs package
	$(BIN)/python -m benchmarks.status
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/pytest -n 2 --dist worksteal --cov --cov-report=term

fuzz: setup
	$(BIN)/pip install --disable-pip-version-check -q -c constraints.txt -e '.[fuzz]'
	$(BIN)/python -m tests.fuzz.fuzz_unpack -runs=$(RUNS) -max_len=4096 -rss_limit_mb=8192 -print_final_stats=1 build/corpus
	$(BIN)/python -m tests.fuzz.fuzz_mesh -runs=$(RUNS)

# Built apart, and run from there. Python itself has no sanitizer, so theirs is loaded before it; it
# frees little at its end, so leaks are not told: a test of ours looks at the memory instead.
SANITIZE := -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer
SANITIZED := build/sanitize
sanitize: setup
	CFLAGS='$(SANITIZE)' CXXFLAGS='$(SANITIZE)' LDFLAGS='$(SANITIZE)' $(BIN)/python setup.py -q build \
		--force --build-temp $(SANITIZED)/objects --build-lib $(SANITIZED)/lib
	@echo 'sanitize: $(SANITIZE) in' $$(find $(SANITIZED)/lib -name '*.so')
	LD_PRELOAD="$$(g++ -print-file-name=libasan.so) $$(g++ -print-file-name=libubsan.so)" \
		ASAN_OPTIONS=detect_leaks=0:quarantine_size_mb=4 UBSAN_OPTIONS=print_stacktrace=1 \
		$(BIN)/python -m pytest -q --import-mode=importlib -o 'pythonpath=$(SANITIZED)/lib .' tests/train/backend/native tests/infer/native
	g++ -std=c++17 -O1 -g -fsanitize=thread -pthread -Wno-psabi -DNISP_VECTOR_LENGTH=4 -Wl,--wrap=aligned_alloc \
		-Inispcodec/train/backend/native/kernel tests/train/backend/native/threads.cpp -o $(SANITIZED)/threads
	$(SANITIZED)/threads
	@echo 'sanitize: no races between threads'

bench: setup
	$(BIN)/python -m benchmarks --assets $(ASSETS)
