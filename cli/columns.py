"""What the numbers of `nisp compare` mean, one line each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

FRAME = "Distances are shares of the asset's radius: 0.001 of a vase 1 m tall is about half a mm."
DIRECTIONS = {
    "original_to_decoded": "from points of the original to the decode: large where parts are lost",
    "decoded_to_original": "from points of the decode to the original: large where parts are new",
    "larger": "the larger of both directions, number by number",
}
COLUMNS: dict[str, dict[str, str]] = {
    "surface": {
        "hidden": "share of the original inside of its own walls: not held, not compared",
        "sheet": "share of the original with no inside behind it, such as leaves",
    },
    "geometry": {
        **DIRECTIONS,
        "mean": "mean distance to the other surface",
        "p99": "one point in a hundred is further off than this",
        "max": "the furthest of all points",
        "d1_psnr": "point to point, in dB (MPEG PCC): 6 dB more is half the distance",
        "d2_psnr": "point to plane, in dB: sliding along the surface does not count",
        "normal_consistency": "mean |cosine| between normals: 1 is the same direction",
    },
    "spurious": {
        "count": "pieces of the decode that are nowhere near the original",
        "area": "their area, in squared radii",
    },
    "uv": {
        **DIRECTIONS,
        "mean": "mean error of the texture coordinates: 0.001 is one texel of a 1024 image",
        "median": "half of the points are nearer than this",
        "p99": "one point in a hundred is further off than this: the wrong chart, mostly",
    },
    "parameterization": {
        "original": "how much the original's texture is stretched",
        "decoded": "how much the decode's is",
        "collapsed": "share of triangles without an area",
        "mean": "mean stretch; it depends on the scale of the layout",
        "max": "the largest stretch",
        "std": "its standard deviation",
    },
    "color": {"psnr": "of base colors at corresponding points, in dB: 6 dB more is half the error"},
    "normal_map": {
        "mean": "mean angle between the directions that the normal maps give, in degrees",
        "p99": "one point in a hundred is further off than this: the wrong chart, mostly",
        "max": "the largest angle of all points",
    },
    "charts": {"accuracy": "share of points whose chart is right"},
}


def explanations(report: Mapping[str, Any]) -> dict[str, dict[str, str]]:
    """The lines for what is in a report, group by group."""
    return {
        title: {name: text for name, text in COLUMNS[title].items() if name in set(names(values))}
        for title, values in report.items()
    }


def names(values: Mapping[str, Any]) -> Iterator[str]:
    """Every name in a group, and in groups within it."""
    for name, value in values.items():
        yield name
        if isinstance(value, Mapping):
            yield from names(value)
