"""The tuned numbers of images, and of totals that they share with geometry."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class CompactConfig:
    """How images are coded in the fewest bytes.

    most_error   of data maps as AVIF, root of the mean square of a texel over its channels' range:
                 a normal is then turned by about 1.5 degrees
    finer        steps of quality until a data map is as near
    typical      quality at which ways of padding are compared: which of them takes fewer bytes
                 depends little on it
    tune         what AVIF is best by: at equal squared error "ssim" takes 6 to 20 % fewer bytes
                 than the codec's own choice, and little more than "psnr" ...
    in_between   ... whose files are as good for their bytes, and a seventh larger at a quality. So
                 many qualities below are tried, to fill the gaps, of a tenth, that one image has
    """

    most_error: float = 0.013
    finer: int = 5
    typical: int = 50
    tune: str = "ssim"
    in_between: int = 5


@dataclass(frozen=True)
class TotalConfig:
    """How the bytes of a total are shared between images and geometry.

    views            pictures around the asset, by which errors are told ...
    size             ... and the pixels of their sides
    qualities        of images whose error is measured; between them it is interpolated
    scarce           bytes for geometry from which down the least that it takes is found out first
    field_slope      of the squared error of pictures over the bytes of networks, as logarithms
    octaves          by which the bytes of networks may differ from what the preset takes
    worth_a_fit      share of the expected error from which down another split is tried
    measured_bytes   that the PSNR of the pictures takes in a file, at most
    done             share of the work after the images, the first geometry and the second
    """

    views: int = 8
    size: int = 512
    qualities: tuple[int, ...] = (1, 20, 45, 70, 90, 100)
    scarce: float = 5000
    field_slope: float = 0.5
    octaves: tuple[float, ...] = (-2, -1.5, -1, -0.5, 0.5, 1, 1.5, 2)
    worth_a_fit: float = 0.85
    measured_bytes: int = 32
    done: tuple[float, float, float] = (0.2, 0.55, 0.9)
