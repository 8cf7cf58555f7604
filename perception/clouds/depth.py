"""A depth image and its camera's intrinsics, as an organised cloud in the camera's frame.

Depth is along the optical axis, as depth cameras give it: a 16-bit greyscale PNG, or an array (rows, columns) in a .npy
file or, under the name ``depth``, in a .npz file. The frame is the camera's optical one: x to the right in the image, y
down, z into the scene. A pixel of depth 0, or of none that is finite, has no point: its coordinates are NaN.
"""

from __future__ import annotations

import io
import zlib

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.content import Content
from deixis.perception.clouds.intrinsics import MAX_PIXELS, Intrinsics
from deixis.perception.clouds.npy import MAGIC, MAX_DEFLATED, read_npy, read_npz
from deixis.perception.errors import CloudError

PNG = b"\x89PNG\r\n\x1a\n"


def read_depth(content: Content, camera: Intrinsics) -> PointCloud:
    """The organised cloud that a depth image shows; raises CloudError where it is malformed or of another size."""
    depth = depth_image(content)
    if depth.shape != (camera.height, camera.width):
        raise CloudError(
            f"{content.name}: an image of {depth.shape} rows and columns, and the intrinsics are for"
            f" {(camera.height, camera.width)}; give those of this camera"
        )
    scale = camera.depth_scale or (1.0 if depth.dtype.kind == "f" else 1000.0)
    return PointCloud(back_projected(depth.astype(np.float64) / scale, camera), organised=depth.shape)


def back_projected(depth: NDArray[np.floating], camera: Intrinsics) -> NDArray[np.float32]:
    """Points (rows * columns, 3) of depth (rows, columns) in metres: z = depth, x = (column - cx) z / fx, y alike."""
    z = np.where(np.isfinite(depth) & (depth > 0), depth, np.nan)
    x = (np.arange(camera.width) - camera.cx) * z / camera.fx
    y = (np.arange(camera.height)[:, None] - camera.cy) * z / camera.fy
    return np.stack([x, y, z], axis=-1).astype(np.float32).reshape(-1, 3)


def depth_image(content: Content) -> NDArray[np.generic]:
    """The image's values (rows, columns), in its own units."""
    head = content.data[:8].tobytes()
    if head == PNG:
        return _png(content)
    if head.startswith(MAGIC):
        image = read_npy(content.data.tobytes(), content.name)
    else:
        arrays = read_npz(content, ["depth"])
        if "depth" not in arrays:
            raise CloudError(f"{content.name}: there is no array 'depth'; save it with numpy.savez(file, depth=…)")
        image = arrays["depth"]
    if image.ndim != 2 or image.dtype.kind not in "iuf":
        raise CloudError(f"{content.name}: a {image.dtype} array of shape {image.shape}; depth is (rows, columns)")
    return image


def _png(content: Content) -> NDArray[np.generic]:
    """Greyscale values; what the header declares is compared with the file's size before anything is unpacked."""
    from PIL import Image

    head = content.data[8:33].tobytes()
    width, height = int.from_bytes(head[8:12], "big"), int.from_bytes(head[12:16], "big")
    if len(head) < 25 or head[4:8] != b"IHDR":
        raise CloudError(f"{content.name}: byte 8: a PNG begins with its header; get the whole file")
    if head[17] != 0 or head[16] != 16 or head[20] != 0:
        raise CloudError(
            f"{content.name}: byte 24: no plain greyscale PNG of 16 bits; save depth as one, not interlaced"
        )
    size = height * (1 + width * head[16] // 8)
    if not 0 < width * height <= MAX_PIXELS or size > len(content) * MAX_DEFLATED:
        raise CloudError(
            f"{content.name}: byte 16: {width} by {height} pixels are declared, in a file of {len(content)} bytes;"
            f" it must be possible, and 1 to {MAX_PIXELS}"
        )
    try:
        _check_length(content, size)
        with Image.open(io.BytesIO(content.data.data), formats=["PNG"]) as image:
            return np.asarray(image)
    except (OSError, SyntaxError, ValueError, zlib.error) as error:
        reason = " ".join(str(error).split())
        raise CloudError(f"{content.name}: the PNG is damaged ({reason}); get the whole file") from error


def _check_length(content: Content, size: int) -> None:
    """Raises ValueError where the pixels are not all there, which pillow fills up with zeros."""
    parts, at = [], 8
    while at + 12 <= len(content):
        length = int.from_bytes(content.data[at : at + 4].tobytes(), "big")
        if content.data[at + 4 : at + 8].tobytes() == b"IDAT":
            parts.append(content.data[at + 8 : at + 8 + length].tobytes())
        at += 12 + length
    unpacking = zlib.decompressobj()
    there = len(unpacking.decompress(b"".join(parts), size + 1))
    if there != size or not unpacking.eof:
        raise ValueError(f"{there} bytes of pixels, not {size}")
