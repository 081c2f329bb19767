from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

pytest.importorskip("matplotlib", reason="plots: extra `bench`")

from benchmarks.measuring.result_file import Record
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


def encoded(
    seconds: float, accuracy: float | None, psnr: float | None, collapsed: float = 0.0
) -> Record:
    """A record of the main job, as far as the paper's tables read it."""
    measured = {} if accuracy is None else {"chart_accuracy": accuracy}
    distortion = dict.fromkeys(("mean", "max", "std"), 4.0) | {"collapsed": collapsed}
    pictures = {} if psnr is None else {"pictures": {"psnr": psnr, "ssim": 0.99}}
    sides = dict.fromkeys(("original", "decoded"), distortion)
    return {
        "encode": {"seconds": seconds},
        "report": {"measured": measured},
        "metrics": {"parameterization": sides, **pictures},
    }


def test_paper_quality_is_of_the_assets_that_have_it() -> None:
    assets = {"a": encoded(1800, 0.9, None), "b": encoded(5400, None, 40.0)}
    assets["palette"] = encoded(3600, None, None, collapsed=0.1)
    rows = {row.quantity: row for row in quality({"assets": assets})}
    assert rows["all networks"].ours == 1.0
    assert rows["chart accuracy"].ours == 0.9
    assert "uv error mean" not in rows
    assert rows["PSNR"].ours == 40.0
    assert rows["PSNR"].differs.endswith("over b")
    assert rows["mean, learned"].differs.endswith("over a, b")


def test_a_codec_that_was_installed_later_is_no_longer_skipped() -> None:
    skipped = [{"asset": name, "codec": "gltfpack", "skipped": "no node here"} for name in "ab"]
    ran = {"asset": "a", "codec": "gltfpack", "bytes": 10}
    assert current([*skipped, ran]) == [skipped[1], ran]
