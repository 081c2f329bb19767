"""From a scene and a camera to pixels: rays, layers of see-through surface, antialiasing."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array, FloatArray, Int32Array, Int64Array
from nispcodec.core.cores import cores
from nispcodec.core.texture import linear_to_srgb
from nispcodec.infer.parallel import parallel_for
from nispcodec.render.camera import Camera
from nispcodec.render.fragments import Fragments, Scene
from nispcodec.render.maps import Maps
from nispcodec.render.shade import looks, shaded

# Rays at a time and core: bounds the memory. Smaller bands cost more calls than they save.
BAND = 1 << 16
# A pixel on an edge is the mean of this many samples, squared.
SUBDIVISION = 3
# Neighboring pixels this many pixel widths apart in depth, or with normals whose cosine is less,
# have an edge between them.
DEEP, BENT = 6.0, 0.8
MAX_LAYERS = 16
OPAQUE = 0.996
# How far behind a see-through surface a ray goes on (normalized frame).
BEHIND = np.float32(5e-4)
# Where the lamp is: right, up and backward of the camera.
LAMP = (-0.5, 0.6, 1.0)


@dataclass(frozen=True)
class Samples:
    """The colors that n rays see, and the first surface that each of them meets.

    color      (n, 4) float32, linear light, premultiplied with alpha
    distances  (n,) float32 to the first surface that is seen, infinite without; the next three are
               of the same surface
    normals    (n, 3) float32, unit, normal maps applied
    uvs        (n, 2) float32
    charts     (n,) int32; -1 where there is none
    steps      (n,) int32: how often the field was asked
    lost       (n,) bool: given up
    """

    color: Float32Array
    distances: Float32Array
    normals: Float32Array
    uvs: Float32Array
    charts: Int32Array
    steps: Int32Array
    lost: BoolArray

    def part(self, chosen: slice) -> Samples:
        """A view of some of the rays: writing to it changes these samples."""
        return Samples(*(getattr(self, field.name)[chosen] for field in fields(self)))

    @classmethod
    def nothing(cls, count: int) -> Samples:
        """Samples of `count` rays that have met nothing yet."""
        return cls(
            color=np.zeros((count, 4), np.float32),
            distances=np.full(count, np.inf, np.float32),
            normals=np.zeros((count, 3), np.float32),
            uvs=np.zeros((count, 2), np.float32),
            charts=np.full(count, -1, np.int32),
            steps=np.zeros(count, np.int32),
            lost=np.zeros(count, np.bool_),
        )


class Eye:
    """One scene seen by one camera, in a picture of `size` x `size` pixels.

    `maps` are the scene's textures; without `normal_map` normal maps are not applied.
    Raises MeshError, when it looks, for a texture that does not decode.
    """

    def __init__(
        self, scene: Scene, maps: Maps, camera: Camera, size: int, normal_map: bool = True
    ) -> None:
        self.scene, self.maps, self.camera, self.size = scene, maps, camera, size
        self.normal_map = normal_map
        lamp = np.asarray(LAMP) @ camera.axes
        self._lamp: Float32Array = (lamp / np.linalg.norm(lamp)).astype(np.float32)

    def picture(self) -> Float32Array:
        """The picture (size, size, 4) float32 in [0, 1], top row first, edges antialiased.

        RGB is sRGB-encoded, alpha straight.
        """
        first = self.pixels()
        color = first.color
        edges = np.flatnonzero(self._edges(first))
        steps = (np.arange(SUBDIVISION) + 0.5) / SUBDIVISION
        x, y = np.meshgrid(steps, steps)
        rows, columns = edges[:, None] // self.size, edges[:, None] % self.size
        finer = self.see((columns + x.ravel()).ravel(), (rows + y.ravel()).ravel(), SUBDIVISION)
        color[edges] = finer.color.reshape(len(edges), SUBDIVISION**2, 4).mean(axis=1)
        return _encoded(color).reshape(self.size, self.size, 4)

    def pixels(self) -> Samples:
        """One sample through the middle of every pixel, top row first."""
        middle = np.arange(self.size) + 0.5
        x, y = np.meshgrid(middle, middle)
        return self.see(x.ravel(), y.ravel())

    def see(self, x: FloatArray, y: FloatArray, samples: int = 1) -> Samples:
        """The samples through points x (n,), y (n,) of the picture, in pixels from its top left.

        A pixel has `samples` of them along each side: textures are filtered accordingly.
        """
        seen = Samples.nothing(len(x))

        def see(band: slice) -> None:
            directions = self.camera.directions(x[band] / self.size, y[band] / self.size)
            self._see(directions, seen.part(band), 2 * self.camera.half_width / self.size / samples)

        size = max(1, min(BAND, -(-len(x) // cores())))
        parallel_for(see, [slice(start, start + size) for start in range(0, len(x), size)])
        return seen

    def _see(self, directions: Float32Array, seen: Samples, width: float) -> None:
        """Fill in what the rays see, surface after surface from front to back."""
        eye = self.camera.eye.astype(np.float32)
        ways, gone = np.arange(len(directions)), np.zeros(len(directions), np.float32)
        for layer in range(MAX_LAYERS):
            origins = eye + gone[ways, None] * directions[ways]
            cast = self.scene.cast(origins, directions[ways], layer)
            seen.steps[ways] += cast.steps
            seen.lost[ways] |= cast.lost
            ways = ways[cast.fragments.rays]
            gone[ways] += cast.fragments.distances
            self._lay(cast.fragments, ways, directions[ways], gone[ways], width, seen)
            ways = ways[seen.color[ways, 3] < OPAQUE]
            gone[ways] += BEHIND
            if len(ways) == 0:
                return

    def _lay(
        self,
        points: Fragments,
        ways: Int64Array,
        towards: Float32Array,
        distances: Float32Array,
        width: float,
        seen: Samples,
    ) -> None:
        """Put one surface behind what the rays have seen already."""
        slant = np.abs((points.normals * towards).sum(axis=1))
        footprints = width * distances / np.sqrt(np.maximum(slant, 0.1))
        materials = self.scene.materials
        for chosen, look in looks(points, materials, self.maps, footprints, self.normal_map):
            way, alpha = ways[chosen], look.alpha[:, None]
            light = shaded(look, towards[chosen], self._lamp)
            first = np.isinf(seen.distances[way]) & (look.alpha > 0)
            seen.color[way] += (1 - seen.color[way, 3:]) * np.hstack([light * alpha, alpha])
            new = way[first]
            seen.distances[new] = distances[chosen][first]
            seen.normals[new] = look.normals[first]
            seen.uvs[new] = points.uvs[chosen][first]
            seen.charts[new] = points.charts[chosen][first]

    def _edges(self, seen: Samples) -> BoolArray:
        """Which pixels (n,) differ from one beside, above or below in what surface they show."""
        shape = (self.size, self.size)
        edges = np.zeros(shape, np.bool_)
        depth = seen.distances.reshape(shape)
        normals, alpha = seen.normals.reshape(*shape, 3), seen.color[:, 3].reshape(shape)
        deep = DEEP * 2 * self.camera.half_width / self.size
        for here, there in (
            ((slice(None), slice(1, None)), (slice(None), slice(-1))),
            ((slice(1, None), slice(None)), (slice(-1), slice(None))),
        ):
            with np.errstate(invalid="ignore"):
                apart = np.abs(depth[here] - depth[there]) > deep * depth[here]
            bent = (normals[here] * normals[there]).sum(axis=-1) < BENT
            solid = np.isfinite(depth[here]) & np.isfinite(depth[there])
            differ = apart | (bent & solid) | (alpha[here] != alpha[there])
            edges[here] |= differ
            edges[there] |= differ
        return edges.ravel()


def _encoded(color: Float32Array) -> Float32Array:
    """Premultiplied linear light (n, 4) as sRGB with straight alpha."""
    alpha = color[:, 3:]
    straight = color[:, :3] / np.maximum(alpha, 1e-6)
    return np.hstack([linear_to_srgb(np.clip(straight, 0, 1)), np.clip(alpha, 0, 1)])
