from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

pytest.importorskip("matplotlib", reason="plots: extra `bench`")

from benchmarks.paper.command import markdown
from benchmarks.paper.quality import quality
from benchmarks.paper.row import Comparison
from benchmarks.rate_distortion.results import current, write_results
from benchmarks.rate_distortion.store import Store
from tests.benchmarks.test_summary import record


@pytest.fixture
def store(tmp_path: Path) -> Store:
    store = Store(tmp_path / "points")
    pictures = {"pictures": {"psnr": 41.0, "ssim": 0.99}}
    store.put(record("nisp", 500, 1e-3, 1e-3) | pictures, b"x", picture=b"a picture")
    for size, error in ((300, 2e-3), (600, 1e-3), (900, 4e-4)):
        store.put(record("simplified_draco", size, error, error), b"x")
    store.put({"asset": "a", "codec": "draco", "setting": {}, "failure": "out of <cheese>"})
    store.put({"asset": "a", "codec": "gltfpack", "setting": {}, "skipped": "no node here"})
    image = {"setting": {"format": "webp"}, "bytes": 70, "psnr": 40.0, "encode": {"seconds": 1.0}}
    store.put({"asset": "a", "codec": "textures", **image})
    store.put_original("a", b"the original")
    return store


def test_report_is_one_file_with_hover_values_pictures_and_problems(store: Store) -> None:
    text = write_results(store, store.folder.parent).read_text()
    assert not re.search(r'(src|href)="(?!data:|#)', text)
    assert text.count("<title>.nisp") >= 4
    assert "500 bytes" in text
    assert text.count("<figure>") == 2
    assert "out of &lt;cheese&gt;" in text
    assert "no node here" in text
    assert "570" in text  # 500 bytes of networks and 70 of textures


def test_results_have_schema_machine_and_seeds(store: Store) -> None:
    write_results(store, store.folder.parent)
    found = json.loads((store.folder.parent / "results.json").read_text())
    assert found["schema"] == 1
    assert {"machine", "versions", "commit", "seeds", "points", "textures"} <= set(found)
    assert len(found["points"]) == 6
    names = {"distance.png", "uv.png", "uv_median.png", "color.png", "results.csv"}
    assert names <= {path.name for path in store.folder.parent.iterdir()}


def test_paper_table_says_what_differs() -> None:
    rows = [Comparison("Sizes", "all", 487.0, 9.5, "kB", "the machine")]
    text = markdown(rows)
    assert "| all | 487 kB | 9.5 kB |" in text
    assert "What differs: the machine." in text


def test_paper_quality_wants_points(tmp_path: Path) -> None:
    assert list(quality(Store(tmp_path))) == []


def test_a_codec_that_was_installed_later_is_no_longer_skipped() -> None:
    skipped = [{"asset": name, "codec": "gltfpack", "skipped": "no node here"} for name in "ab"]
    ran = {"asset": "a", "codec": "gltfpack", "bytes": 10}
    assert current([*skipped, ran]) == [skipped[1], ran]
