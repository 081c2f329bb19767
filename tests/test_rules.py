"""The rules of the house: which package may import what, and what stays out of the way."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent

# Folder -> third-party roots that it may import, and other folders of nispcodec.
RULES: dict[str, tuple[set[str], set[str]]] = {
    # A mesh knows how to save itself.
    "core": ({"numpy", "scipy", "PIL"}, {"io"}),
    "io": (
        {"numpy", "PIL", "DracoPy", "meshoptimizer", "opengl_basisu", "pxr", "trimesh"},
        {"core"},
    ),
    # What is closest, and inside, is told by the kernel that answers for mesh parts.
    "geometry": ({"numpy", "scipy", "igl", "embreex"}, {"core", "infer"}),
    "dataset": ({"numpy", "scipy"}, {"core", "geometry"}),
    "simplify": (
        {"numpy", "scipy", "igl", "meshoptimizer"},
        {"core", "geometry", "metrics"},
    ),
    "train": ({"numpy", "scipy", "threadpoolctl", "torch"}, {"core", "dataset"}),
    "format": ({"numpy", "msgpack", "zstandard"}, {"core"}),
    "infer": ({"numpy", "threadpoolctl"}, {"core"}),
    # Mesh parts in levels of detail are simplified as the encoder does it.
    "extract": ({"numpy", "fast_simplification"}, {"core", "infer", "simplify"}),
    # A model hands itself to trimesh.
    "model": ({"numpy", "trimesh"}, {"core", "infer", "extract", "io"}),
    "trimesh_loader": ({"trimesh"}, {"core", "io", "format", "model"}),
    "metrics": ({"numpy", "skimage", "igl"}, {"core"}),
    "render": (
        {"numpy", "scipy", "embreex", "PIL"},
        {"core", "infer", "extract", "model", "metrics"},
    ),
    "bake": ({"numpy", "PIL", "xatlas"}, {"core", "io", "model"}),
    "edit": ({"numpy"}, {"core", "io"}),
    "procedural": ({"numpy", "PIL"}, {"core"}),
    "encode": (
        {"numpy"},
        {"core", "geometry", "dataset", "simplify", "train", "format", "infer", "extract"}
        | {"model", "edit", "metrics", "render"},
    ),
    # A driver of everything else, by what is public of it.
    "catalogue": (
        {"fsspec", "ray"},
        {
            "core",
            "io",
            "encode",
            "format",
            "infer",
            "metrics",
            "model",
            "bake",
            "render",
            "compare",
            "__version__",
        },
    ),
}


def sources(package: str) -> Iterator[Path]:
    place = ROOT / "nispcodec" / package
    return place.rglob("*.py") if place.is_dir() else iter([place.with_suffix(".py")])


def imported(path: Path) -> set[str]:
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            found |= {f"{node.module}.{alias.name}" for alias in node.names}
    return found


def forbidden(name: str, package: str) -> bool:
    third_party, ours = RULES[package]
    root, _, rest = name.partition(".")
    if root == "nispcodec":
        return rest.split(".")[0] not in {package, *ours}
    return root not in sys.stdlib_module_names and root not in third_party


@pytest.mark.parametrize("package", RULES)
def test_a_package_imports_only_what_its_place_allows(package: str) -> None:
    wrong = {
        f"{path.relative_to(ROOT)} imports {name}"
        for path in sources(package)
        for name in imported(path)
        if forbidden(name, package)
    }
    assert not wrong


def test_every_folder_has_a_rule() -> None:
    found = {path.stem for path in (ROOT / "nispcodec").iterdir() if not path.name.startswith("_")}
    assert found - {"py"} == set(RULES)


def test_a_rule_allows_nothing_that_nobody_needs() -> None:
    for package, (third_party, ours) in RULES.items():
        used = {name for path in sources(package) for name in imported(path)}
        roots = {name.split(".")[0] for name in used}
        rooms = {name.split(".")[1] for name in used if name.startswith("nispcodec.")}
        assert not third_party - roots, package
        assert not ours - rooms, package


def test_nothing_in_the_library_imports_the_command_line_or_the_benchmarks() -> None:
    for path in (ROOT / "nispcodec").rglob("*.py"):
        roots = {name.split(".")[0] for name in imported(path)}
        assert not roots & {"nispcodec_cli", "cli", "benchmarks", "tests"}, path


def test_no_module_is_a_drawer_for_anything() -> None:
    names = {path.stem for path in ROOT.rglob("nispcodec/**/*.py")}
    assert not names & {"utils", "helpers", "common", "misc"}


# Numbers of a format, an algorithm or a machine: another value would be another thing, not a better
# or worse result.
STRUCTURAL = {
    "nispcodec/dataset/chart_borders.py BITS",
    "nispcodec/dataset/chart_error_weight.py BLOCK",
    "nispcodec/dataset/sampler.py BLOCK",
    "nispcodec/encode/compact_images.py LEAST",
    "nispcodec/encode/compact_images.py MOST",
    "nispcodec/encode/image_shares.py NOTHING",
    "nispcodec/extract/grid.py BLOCK",
    "nispcodec/extract/grid.py CHUNK",
    "nispcodec/extract/grid.py CUBE",
    "nispcodec/extract/isosurface.py BALL",
    "nispcodec/extract/meeting.py REACH",
    "nispcodec/extract/neighbors.py PAIRS",
    "nispcodec/geometry/nearest.py BLOCK",
    "nispcodec/geometry/winding.py BLOCK",
    "nispcodec/geometry/z_order.py APART",
    "nispcodec/geometry/z_order.py BITS",
    "nispcodec/simplify/closest.py FLAT",
    "nispcodec/simplify/copy_search.py KEPT",
    "nispcodec/simplify/copy_search.py TURNED",
    "nispcodec/simplify/halves.py UV_SIGNS",
    "nispcodec/simplify/meshoptimizer_call.py PRUNE",
    "nispcodec/simplify/mirror.py TURNS",
    "nispcodec/simplify/quantize.py STEP_DIGITS",
}


LITERAL = (
    ast.Constant,
    ast.Tuple,
    ast.List,
    ast.Dict,
    ast.UnaryOp,
    ast.BinOp,
    ast.operator,
    ast.unaryop,
    ast.Load,
)


def numeric_constants(path: Path) -> Iterator[str]:
    """Names that the module gives at its top to numbers, or to tables of numbers."""
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if not isinstance(node, ast.Assign | ast.AnnAssign) or node.value is None:
            continue
        parts = list(ast.walk(node.value))
        numbers = [part for part in parts if type(getattr(part, "value", None)) in (int, float)]
        if numbers and all(isinstance(part, LITERAL) for part in parts):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            names = (part for target in targets for part in ast.walk(target))
            yield from (part.id for part in names if isinstance(part, ast.Name))


@pytest.mark.parametrize(
    "package", ["geometry", "dataset", "simplify", "train", "encode", "extract"]
)
def test_tuned_numbers_are_in_configs(package: str) -> None:
    found = {
        f"{path.relative_to(ROOT)} {name}"
        for path in sources(package)
        if path.name != "config.py"
        for name in numeric_constants(path)
        if name != "TINY"
    }
    wanted = {each for each in STRUCTURAL if each.startswith(f"nispcodec/{package}/")}
    assert found == wanted


@pytest.mark.parametrize(
    "package", ["geometry", "dataset", "simplify", "train", "encode", "extract"]
)
def test_a_config_says_what_each_of_its_numbers_is(package: str) -> None:
    config = import_module(f"nispcodec.{package}.config")
    for name, each in vars(config).items():
        if not is_dataclass(each) or each.__module__ != config.__name__:
            continue
        numbers = {at.name for at in fields(each) if "Config" not in str(at.type)}
        assert numbers <= set(re.findall(r"\w+", each.__doc__ or "")), name


def test_array_types_have_names_in_one_place() -> None:
    wrong = [
        path
        for path in (ROOT / "nispcodec").rglob("*.py")
        if path.name != "arrays.py" and "NDArray" in path.read_text(encoding="utf-8")
    ]
    assert not wrong


def loaded_by(code: str) -> set[str]:
    script = f"{code}\nimport sys\nprint(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return set(run.stdout.splitlines()[-1].split())


def test_importing_the_library_loads_nothing_heavy() -> None:
    heavy = {"torch", "scipy", "igl", "trimesh", "PIL", "skimage", "msgpack", "zstandard"}
    loaded = loaded_by("import nispcodec")
    assert not heavy & loaded
    # Settings alone, and no code that they are for.
    assert not {"nispcodec.simplify.errors", "nispcodec.metrics.surface"} & loaded


def test_the_command_answers_help_without_numpy() -> None:
    code = "from click.testing import CliRunner; import nispcodec_cli as c\n"
    code += "assert CliRunner().invoke(c.main, ['--help']).exit_code == 0"
    assert not {"torch", "numpy", "rich"} & loaded_by(code)


def test_queries_and_meshes_need_no_torch() -> None:
    code = (
        "import sys; sys.modules['torch'] = None\n"
        "from tests.tiny import document\n"
        "from nispcodec import NispModel\n"
        "model = NispModel(document())\n"
        "assert len(model.to_mesh(16).faces) > 0 and len(model.uv([[0.1, 0.2, 0.3]])) == 1"
    )
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr


LARGE = 30
"""Lines of code, without docstrings and comments, from which on a module has tests of its own."""

# Module -> the tests that hold it, where these are not in a module of its name: what is asked of it
# can only be said of the whole that it is a part of, or it is a table that others are held to.
TESTED_ELSEWHERE = {
    # What a file may hold: refused, or brought back, as bytes.
    "core/network.py": "format/test_malformed.py",
    "format/container.py": "format/test_malformed.py",
    "format/document.py": "format/test_round_trip.py",
    # Steps of the coding of a mesh part: each is said only where the others lead to it.
    "format/mesh/charts.py": "format/mesh/test_section.py",
    "format/mesh/edges.py": "format/mesh/test_section.py",
    "format/mesh/fields.py": "format/mesh/test_section.py",
    "format/mesh/positions.py": "format/mesh/test_section.py",
    "format/mesh/texture.py": "format/mesh/test_section.py",
    "format/mesh/part.py": "format/mesh/test_section.py",
    # What is computed once for what is tested beside it.
    "bake/tangents.py": "bake/test_rebake.py",
    "simplify/source.py": "simplify/test_shading.py",
    # Tables.
    "format/mesh/priors.py": "format/mesh/test_spec_decoder.py",
    "core/slots.py": "format/test_spec.py",
    "format/constants.py": "format/test_spec.py",
    "extract/config.py": "test_rules.py",
    "geometry/config.py": "test_rules.py",
    "simplify/config.py": "test_rules.py",
    "train/config.py": "test_rules.py",
    # Steps of an encode.
    "dataset/recipes.py": "dataset/test_sampler.py",
    "encode/field_form.py": "encode/test_recipe.py",
    "encode/report.py": "encode/test_recipe.py",
    "geometry/analysis.py": "dataset/test_sampler.py",
    "geometry/enclosing.py": "geometry/test_bodies.py",
    "geometry/reach.py": "geometry/test_distance.py",
    "geometry/winding.py": "geometry/test_distance.py",
    "geometry/surface_points.py": "dataset/test_sampler.py",
    "train/lottery_ticket.py": "train/test_prune.py",
    "train/task.py": "train/test_loop.py",
    "train/tasks.py": "encode/test_targets.py",
    # Backends: each against the other.
    "train/backend/native/settings.py": "train/backend/native/test_steps.py",
    "train/backend/torch/muon.py": "train/backend/torch/test_optimizers.py",
    "train/backend/torch/optimizer.py": "train/backend/torch/test_trainer.py",
    "train/backend/torch/soap.py": "train/backend/torch/test_optimizers.py",
    # Steps of a decode.
    "extract/components.py": "extract/test_isosurface.py",
    "extract/sliver_operations.py": "extract/test_slivers.py",
    "extract/vertex_charts.py": "extract/test_seams.py",
    "extract/wedges.py": "extract/test_slivers.py",
    # Parts of one mesh format, and formats that are tested alike.
    "io/read/gltf_buffers.py": "io/test_gltf.py",
    "io/read/gltf_json.py": "io/test_gltf.py",
    "io/read/gltf_materials.py": "io/test_gltf.py",
    "io/read/gltf_nodes.py": "io/test_gltf.py",
    "io/read/obj_materials.py": "io/test_mtl.py",
    "io/read/off.py": "io/test_stl_off.py",
    "io/read/ply_tables.py": "io/test_ply.py",
    "io/read/stl.py": "io/test_stl_off.py",
    "io/read/wavefront.py": "io/test_obj.py",
    "io/save.py": "io/test_writers.py",
    "io/write/gltf_tree.py": "io/test_writers.py",
    "io/write/losses.py": "io/test_writers.py",
    "io/write/npz.py": "core/test_sdf_grid.py",
    "io/write/usd_material.py": "io/test_usdz.py",
    "io/write/trimesh_geometry.py": "test_trimesh_loader.py",
    "io/write/vertices.py": "io/test_writers.py",
    # Numbers that are known for the same small shapes.
    "metrics/parameterization.py": "metrics/test_parts.py",
    "metrics/spurious.py": "metrics/test_parts.py",
    "metrics/surface.py": "metrics/test_parts.py",
    # What is told by the way: who shows it.
    "core/progress.py": "cli/test_progress.py",
    # What only a picture shows.
    "render/channels.py": "render/test_field.py",
    "render/difference.py": "render/test_images.py",
    "render/layout.py": "render/test_sheet.py",
    "render/maps.py": "render/test_shading.py",
    "render/picture.py": "render/test_raycast.py",
    "render/space.py": "render/test_march.py",
    "render/views.py": "render/test_shading.py",
}


def lines_of_code(source: str) -> int:
    """Lines that are no docstring, no comment and not empty."""
    said = {
        line
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        for line in range(node.lineno, (node.end_lineno or node.lineno) + 1)
    }
    lines = enumerate((line.strip() for line in source.splitlines()), 1)
    return sum(bool(line) and line[0] != "#" and at not in said for at, line in lines)


def large_modules() -> Iterator[Path]:
    """Paths below `nispcodec` of modules that are large."""
    place = ROOT / "nispcodec"
    for path in place.rglob("*.py"):
        module = path.relative_to(place)
        large = lines_of_code(path.read_text(encoding="utf-8")) > LARGE
        if large and not path.name.startswith("_"):
            yield module


def test_every_large_module_has_a_test_module_of_its_name() -> None:
    """In the folder of tests that has the name of the module's, or further down in it."""
    tests = ROOT / "tests"
    without = set()
    for module in large_modules():
        folder = tests / module.parts[0] if module.parent.name else tests
        if not any(folder.rglob(f"test_{module.name}")):
            without.add(module.as_posix())
    assert without == set(TESTED_ELSEWHERE)
    assert all((tests / test).is_file() for test in TESTED_ELSEWHERE.values())


def test_lines_of_code_are_counted_without_what_is_said_about_them() -> None:
    assert lines_of_code('"""One\ntwo."""\n\nx = 1  # three\n# four\ny = """a\nb"""\n') == 3
