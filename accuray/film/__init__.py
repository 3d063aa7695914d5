"""Images: exact sums of samples, error bars, colour, and files that are their own checkpoints.

`Film` holds integer sums and the record of which samples they contain; `Image` adds metadata and gives the views people
want: an RGB array, error layers, regions with confidence intervals, EXR and PNG files.
"""

from __future__ import annotations

from .coverage import BLOCK, SampleRange
from .errors import FilmOverflowError, ImageError, ImageWriteError, MergeError
from .estimates import RegionEstimate, pixel_estimates, region_estimate, relative_error
from .files import atomic_write, probe_writable
from .film import DEFAULT_STEP, LAYERS, XYZA, Film, channels_with
from .image import EXTENSIONS, Image
from .layers import Layers
from .merging import merge
from .student import student_t

__all__ = [
    "BLOCK",
    "DEFAULT_STEP",
    "EXTENSIONS",
    "LAYERS",
    "XYZA",
    "Film",
    "FilmOverflowError",
    "Image",
    "ImageError",
    "ImageWriteError",
    "Layers",
    "MergeError",
    "RegionEstimate",
    "SampleRange",
    "atomic_write",
    "channels_with",
    "merge",
    "pixel_estimates",
    "probe_writable",
    "region_estimate",
    "relative_error",
    "student_t",
]
