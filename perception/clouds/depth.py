"""A depth image and its camera's intrinsics, as an organised cloud in the camera's frame.

Depth is along the optical axis, as depth cameras give it: a 16-bit greyscale PNG, or an array (rows, columns) in a .npy
file or, under the name ``depth``, in a .npz file. The frame is the camera's optical one: x to the right in the image, y
down, z into the scene. A pixel of depth 0, or of none that is finite, has no point: its coordinates are NaN.
"""

from __future__ import annotations

import io
import math
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.extras import require
from deixis.ontology.strict_json import parse_json
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.content import Content, content_of
from deixis.perception.clouds.npy import MAGIC, MAX_DEFLATED, read_npy, read_npz
from deixis.perception.errors import CloudError

MAX_PIXELS = 2**25
"""The largest depth image."""
_MAX_JSON = 2**16
PNG = b"\x89PNG\r\n\x1a\n"


@dataclass(frozen=True)
class Intrinsics:
    """A pinhole camera: size of its image and, in pixels, focal lengths and principal point (pixel centres are whole).

    ``depth_scale`` is how many of a depth image's units make a metre: 1000 where they are millimetres. None stands for
    1000 in images of whole numbers and 1 in those of floats. Raises CloudError where a value makes no camera.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    depth_scale: float | None = None

    def __post_init__(self) -> None:
        if self.width < 1 or self.height < 1 or self.width * self.height > MAX_PIXELS:
            raise CloudError(f"an image of {self.width} by {self.height} pixels; it has 1 to {MAX_PIXELS}")
        positive = (self.fx, self.fy, 1.0 if self.depth_scale is None else self.depth_scale)
        if not all(math.isfinite(value) for value in (*positive, self.cx, self.cy)) or min(positive) <= 0:
            raise CloudError("fx, fy and depth_scale are above 0, and all are finite")


def read_intrinsics(path: str | Path) -> Intrinsics:
    """Read ``{"width": 640, "height": 480, "fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5, "depth_scale": 1000}``.

    Raises CloudError, with the file and the key, where it is no such thing.
    """
    content = content_of(path)
    if len(content) > _MAX_JSON:
        raise CloudError(f"{content.name}: a file of {len(content)} bytes; intrinsics take a few lines of JSON")
    try:
        text = content.data.tobytes().decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise CloudError(f"{content.name}: byte {error.start}: this is no UTF-8; intrinsics are JSON") from None
    data = parse_json(text, content.name, CloudError, "is no number that a camera can have; correct it")
    if not isinstance(data, dict):
        raise CloudError(f"{content.name}: intrinsics are an object {{…}} with width, height, fx, fy, cx and cy")
    width, height = (_number(data, key, content.name, whole=True) for key in ("width", "height"))
    fx, fy, cx, cy = (_number(data, key, content.name) for key in ("fx", "fy", "cx", "cy"))
    scale = _number(data, "depth_scale", content.name) if data.get("depth_scale") is not None else None
    try:
        return Intrinsics(int(width), int(height), fx, fy, cx, cy, scale)
    except CloudError as error:
        raise CloudError(f"{content.name}: {error}; correct them") from None


def _number(data: dict[str, Any], key: str, file: str, whole: bool = False) -> float:
    value = data.get(key)
    good = isinstance(value, int if whole else (int, float)) and not isinstance(value, bool) and abs(value) < 1e15
    if not good:
        kind = "whole number" if whole else "number"
        raise CloudError(f"{file}: '{key}' must be a {kind}; correct it, or put it in")
    return float(data[key])


def read_depth(content: Content, camera: Intrinsics) -> PointCloud:
    """Return the organised cloud that a depth image shows; raises CloudError where it is malformed or of another
    size."""
    depth = depth_image(content)
    if depth.shape != (camera.height, camera.width):
        raise CloudError(
            f"{content.name}: an image of {depth.shape} rows and columns, and the intrinsics are for"
            f" {(camera.height, camera.width)}; give those of this camera"
        )
    scale = camera.depth_scale or (1.0 if depth.dtype.kind == "f" else 1000.0)
    return PointCloud(back_projected(depth.astype(np.float64) / scale, camera), organised=depth.shape)


def back_projected(depth: NDArray[np.floating], camera: Intrinsics) -> NDArray[np.float32]:
    """Return points (rows * columns, 3) of depth (rows, columns) in metres: z = depth, x = (column - cx) z / fx, y
    alike."""
    z = np.where(np.isfinite(depth) & (depth > 0), depth, np.nan)
    x = (np.arange(camera.width) - camera.cx) * z / camera.fx
    y = (np.arange(camera.height)[:, None] - camera.cy) * z / camera.fy
    return np.stack([x, y, z], axis=-1).astype(np.float32).reshape(-1, 3)


def depth_image(content: Content) -> NDArray[np.generic]:
    """Return the image's values (rows, columns), in its own units."""
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
    """Return greyscale values; what the header declares is compared with the file's size before anything is
    unpacked."""
    require("PIL", f"{content.name}: reading a depth image in PNG")
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
        # the pixels must all be there: pillow fills up missing ones with zeros
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
        with Image.open(io.BytesIO(content.data.data), formats=["PNG"]) as image:
            return np.asarray(image)
    except (OSError, SyntaxError, ValueError, zlib.error) as error:
        reason = " ".join(str(error).split())
        raise CloudError(f"{content.name}: the PNG is damaged ({reason}); get the whole file") from error
