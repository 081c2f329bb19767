"""D1 and D2 once more, by code that shares nothing with `nispcodec.metrics`: do they agree?

    python -m benchmarks.studies.cross_check ../shared/assets/spot/spot.obj --codec draco

scipy's k-d tree over a dense cloud finds candidate triangles, plain numpy the closest points on
them (Ericson, Real-Time Collision Detection, 5.1.5), and the points are drawn by other random
numbers. `cloud` is what MPEG's tool would say of the same dense clouds: the nearest sample stands
for the nearest point, so the spacing of the samples is a floor.
"""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np

from benchmarks.assets.source import Source
from benchmarks.codecs import CODECS, codec
from benchmarks.measuring.machine import commit
from benchmarks.measuring.result_file import as_json, write_result
from nispcodec.core.arrays import Float64Array, IndexArray

QUERIES, CLOUD, CANDIDATES = 100_000, 2_000_000, 24


def sampled(triangles: Float64Array, count: int, seed: int) -> tuple[Float64Array, IndexArray]:
    """Points (count, 3) uniform over triangles (m, 3, 3), and the triangle of each."""
    generator = np.random.default_rng(seed)
    doubled = np.linalg.norm(_crosses(triangles), axis=1)
    owners = generator.choice(len(triangles), count, p=doubled / doubled.sum())
    weights = generator.dirichlet((1, 1, 1), count)
    return (weights[:, :, None] * triangles[owners]).sum(axis=1), owners


def closest(points: Float64Array, triangles: Float64Array) -> Float64Array:
    """The closest point (n, 3) of one triangle each (n, 3, 3): inside or on one of its sides."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normals = _crosses(triangles)
    squared = np.maximum((normals**2).sum(axis=1), 1e-300)
    weights = [
        (np.cross(second - first, points - first) * normals).sum(axis=1) / squared
        for first, second in ((b, c), (c, a), (a, b))
    ]
    inside = np.min(weights, axis=0) >= 0
    flat = points - normals * (((points - a) * normals).sum(axis=1) / squared)[:, None]
    sides = [_on_segment(points, *ends) for ends in ((a, b), (b, c), (c, a))]
    distances = np.stack([np.linalg.norm(side - points, axis=1) for side in sides])
    nearest = np.stack(sides)[distances.argmin(axis=0), np.arange(len(points))]
    chosen: Float64Array = np.where(inside[:, None], flat, nearest)
    return chosen


def offsets(
    points: Float64Array, triangles: Float64Array
) -> tuple[Float64Array, IndexArray, Float64Array]:
    """From points (n, 3) to the closest of the surface, its triangle; to the nearest sample."""
    from scipy.spatial import cKDTree

    cloud, owners = sampled(triangles, CLOUD, seed=77)
    _, near = cKDTree(cloud).query(points, k=CANDIDATES)
    best, found = np.full_like(points, np.inf), owners[near[:, 0]]
    for candidates in owners[near].T:
        offset = closest(points, triangles[candidates]) - points
        better = (offset**2).sum(axis=1) < (best**2).sum(axis=1)
        best[better], found[better] = offset[better], candidates[better]
    return best, found, cloud[near[:, 0]] - points


def psnrs(original: Float64Array, decoded: Float64Array) -> dict[str, float]:
    """D1 and D2 of two surfaces (m, 3, 3) in any frame, dB, the worse direction."""
    normals = _crosses(original)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    found: dict[str, list[float]] = {"d1_psnr": [], "d2_psnr": [], "d1_psnr_cloud": []}
    peak = np.linalg.norm(np.ptp(original.reshape(-1, 3), axis=0))
    for first, second in ((original, decoded), (decoded, original)):
        points, owners = sampled(first, QUERIES, seed=5)
        offset, hit, rough = offsets(points, second)
        normal = normals[owners if first is original else hit]
        found["d1_psnr"].append(_db((offset**2).sum(axis=1), peak))
        found["d2_psnr"].append(_db((offset * normal).sum(axis=1) ** 2, peak))
        found["d1_psnr_cloud"].append(_db((rough**2).sum(axis=1), peak))
    return {name: min(values) for name, values in found.items()}


def _db(squares: Float64Array, peak: np.floating) -> float:
    return float(10 * np.log10(peak**2 / squares.mean()))


def _on_segment(points: Float64Array, first: Float64Array, second: Float64Array) -> Float64Array:
    along = second - first
    length = np.maximum((along**2).sum(axis=1), 1e-300)
    share = np.clip(((points - first) * along).sum(axis=1) / length, 0, 1)
    place: Float64Array = first + share[:, None] * along
    return place


def _crosses(triangles: Float64Array) -> Float64Array:
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    crosses: Float64Array = np.cross(b - a, c - a)
    return crosses


@click.command()
@click.argument("asset", type=click.Path(path_type=Path, exists=True))
@click.option("--codec", "name", type=click.Choice(list(CODECS)), default="draco")
@click.option("-o", "--output", type=click.Path(path_type=Path))
def main(asset: Path, name: str, output: Path | None) -> None:
    """Print both results for ASSET coded with the codec's first quick setting."""
    source, coder = Source(asset), codec(name)
    setting = coder.settings(source, quick=True)[0]
    decoded = coder.decode(coder.encode(source, setting), source)
    ours = source.reference.compare(decoded)["geometry"]
    theirs = psnrs(source.mesh.corners, decoded.corners)
    record = {"asset": source.name, "codec": name, "setting": setting, "commit": commit()}
    record |= {"nispcodec": {k: ours[k] for k in ("d1_psnr", "d2_psnr")}, "independent": theirs}
    click.echo(as_json(record))
    if output is not None:
        write_result(output, record)


if __name__ == "__main__":
    main()
