"""8-bit sRGB PNG files for display and notebooks."""

from __future__ import annotations

import io

import numpy as np
from numpy.typing import NDArray

from .colour import exposure_scale, srgb8


def encode_png(
    rgb: NDArray[np.float32], alpha: NDArray[np.float32] | None = None, *, exposure: float = 0.0, level: int = 4
) -> bytes:
    """The PNG file of a linear Rec.709 image, marked as sRGB. Equal arguments give equal bytes.

    Args:
        rgb: (height, width, 3) linear, premultiplied by alpha when alpha is given; NaN becomes black.
        alpha: (height, width) in 0..1, or None for an opaque PNG. PNG stores colour not premultiplied.
        exposure: in EV, applied before encoding.
        level: zlib's, 1 (quick) to 9 (small).

    Raises:
        ImageError: exposure out of range.
    """
    from PIL import Image, PngImagePlugin  # late: a render that writes no PNG does without it

    scale = np.float32(exposure_scale(exposure))
    with np.errstate(over="ignore", invalid="ignore"):  # what overflows is white
        if alpha is None:
            pixels = srgb8(rgb * scale)
        else:
            opacity = np.clip(np.nan_to_num(alpha), 0.0, 1.0)[:, :, None]
            straight = np.divide(rgb, opacity, out=np.zeros_like(rgb), where=opacity > 0)
            pixels = np.concatenate([srgb8(straight * scale), np.rint(opacity * 255).astype(np.uint8)], axis=2)
    chunks = PngImagePlugin.PngInfo()
    chunks.add(b"sRGB", b"\0")  # rendering intent: perceptual
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, format="PNG", compress_level=level, pnginfo=chunks)
    return buffer.getvalue()


def shrink(image: NDArray[np.float32], limit: int) -> NDArray[np.float32]:
    """The (height, width, channels) image averaged over k x k blocks, k the least that gives width <= limit.

    Blocks at the right and lower edge are averaged over the pixels they have.
    """
    k = -(-image.shape[1] // limit)
    if k <= 1:
        return image
    ys, xs = np.arange(0, image.shape[0], k), np.arange(0, image.shape[1], k)
    total = np.add.reduceat(np.add.reduceat(image, ys, axis=0), xs, axis=1)
    rows = np.diff(np.append(ys, image.shape[0]))
    columns = np.diff(np.append(xs, image.shape[1]))
    area = rows[:, None] * columns[None, :]
    return np.asarray(total / area[:, :, None], dtype=np.float32)
