"""Convert a depth image and the intrinsics of its camera to an organised cloud in the frame of the camera.

Depth is measured along the optical axis. The image is a 16-bit greyscale PNG, or an array of shape (rows, columns) in a
.npy file or, with the name ``depth``, in a .npz file. The frame is the optical frame of the camera: x points right in
the image, y down, z into the scene. A pixel whose depth is 0 or not finite has no point; its coordinates are NaN.
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
from deixis.perception.clouds.formats.npy import MAGIC, MAX_DEFLATED, read_npy, read_npz
from deixis.perception.errors import CloudError

MAX_PIXELS = 2**25
"""Number of pixels of the largest depth image."""
MAX_ZOOM = 1000
"""Largest focal length, as a multiple of the size of the image."""
_MAX_JSON = 2**16
PNG = b"\x89PNG\r\n\x1a\n"


@dataclass(frozen=True)
class Intrinsics:
    """Pinhole camera without distortion.

    Parameters
    ----------
    width, height
        Size of the image, in pixels.
    fx, fy
        Focal lengths, in pixels.
    cx, cy
        Principal point, in pixels; the centres of pixels have whole coordinates.
    depth_scale
        Units of the depth image in one metre: 1000 if they are millimetres. None stands for 1000 in images of integers
        and for 1 in images of floats.

    Raises
    ------
    CloudError
        If a size or the scale is not positive, a focal length is below 1 pixel or above :data:`MAX_ZOOM` times the
        size of the image, or a number is not finite.
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
            raise CloudError(f"an image must have 1 to {MAX_PIXELS} pixels, got {self.width} by {self.height}")
        positive = (self.fx, self.fy, 1.0 if self.depth_scale is None else self.depth_scale)
        if not all(math.isfinite(value) for value in (*positive, self.cx, self.cy)) or min(positive) <= 0:
            raise CloudError("fx, fy and depth_scale must be above 0, and all numbers must be finite")
        if not max(self.width, self.height) * MAX_ZOOM >= max(self.fx, self.fy) >= min(self.fx, self.fy) >= 1:
            raise CloudError(
                f"fx and fy must be in pixels, from 1 to {MAX_ZOOM} times the size of the image, got {self.fx:g} and"
                f" {self.fy:g}"
            )


def read_intrinsics(path: str | Path) -> Intrinsics:
    """Read the intrinsics of a camera from a JSON file.

    The file holds an object ``{"width": 640, "height": 480, "fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5}``,
    optionally with ``depth_scale``.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    Intrinsics
        Size, focal lengths and centre, in pixels.

    Raises
    ------
    CloudError
        If a value is missing or wrong; the message names the file and the key.
    """
    content = content_of(path)
    if len(content) > _MAX_JSON:
        raise CloudError(
            f"{content.name}: intrinsics must have at most {_MAX_JSON} bytes, got {len(content)}; give a JSON file with"
            " width, height, fx, fy, cx and cy"
        )
    try:
        text = content.data.tobytes().decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise CloudError(
            f"{content.name}: byte {error.start}: intrinsics must be JSON in UTF-8; save the file as UTF-8"
        ) from None
    data = parse_json(text, content.name, CloudError, "is not a number for a camera; correct it")
    if not isinstance(data, dict):
        raise CloudError(f"{content.name}: intrinsics must be an object {{…}} with width, height, fx, fy, cx and cy")
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
        raise CloudError(f"{file}: '{key}' must be a {kind}; correct or add it")
    return float(data[key])


def read_depth(content: Content, camera: Intrinsics) -> PointCloud:
    """Return the organised cloud of a depth image.

    Parameters
    ----------
    content
        The file of the image.
    camera
        Intrinsics of the camera.

    Returns
    -------
    PointCloud
        The cloud in the frame of the camera, in metres.

    Raises
    ------
    CloudError
        If the image is malformed, or its size is not that of the camera.
    """
    depth = depth_image(content)
    if depth.shape != (camera.height, camera.width):
        raise CloudError(
            f"{content.name}: the image has {depth.shape} rows and columns, and the intrinsics are for"
            f" {(camera.height, camera.width)}; give the intrinsics of this camera"
        )
    scale = camera.depth_scale or (1.0 if depth.dtype.kind == "f" else 1000.0)
    return PointCloud(back_projected(depth.astype(np.float64) / scale, camera), organised=depth.shape)


def back_projected(depth: NDArray[np.floating], camera: Intrinsics) -> NDArray[np.float32]:
    """Return the points of a depth image.

    A pixel of depth z is the point ((column - cx) z / fx, (row - cy) z / fy, z).

    Parameters
    ----------
    depth
        Depths in metres, shape (rows, columns).
    camera
        Intrinsics of the camera.

    Returns
    -------
    ndarray
        Points in metres, shape (rows * columns, 3).
    """
    z = np.where(np.isfinite(depth) & (depth > 0), depth, np.nan)
    x = (np.arange(camera.width) - camera.cx) * z / camera.fx
    y = (np.arange(camera.height)[:, None] - camera.cy) * z / camera.fy
    return np.stack([x, y, z], axis=-1).astype(np.float32).reshape(-1, 3)


def depth_image(content: Content) -> NDArray[np.generic]:
    """Return the values of a depth image.

    Parameters
    ----------
    content
        The file of the image.

    Returns
    -------
    ndarray
        Values in the unit of the file, shape (rows, columns).

    Raises
    ------
    CloudError
        If the image is malformed.
    """
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
        raise CloudError(
            f"{content.name}: depth must be an array of numbers of shape (rows, columns), got {image.dtype} of shape"
            f" {image.shape}"
        )
    return image


def _png(content: Content) -> NDArray[np.generic]:
    """Return greyscale values; compare the declared size with that of the file before unpacking anything."""
    require("PIL", f"{content.name}: reading a depth image in PNG")
    from PIL import Image

    head = content.data[8:33].tobytes()
    width, height = int.from_bytes(head[8:12], "big"), int.from_bytes(head[12:16], "big")
    if len(head) < 25 or head[4:8] != b"IHDR":
        raise CloudError(f"{content.name}: byte 8: the PNG has no header; get the whole file")
    if head[17] != 0 or head[16] != 16 or head[20] != 0:
        raise CloudError(
            f"{content.name}: byte 24: depth must be a 16-bit greyscale PNG that is not interlaced; save it as one"
        )
    size = height * (1 + width * head[16] // 8)
    if not 0 < width * height <= MAX_PIXELS or size > len(content) * MAX_DEFLATED:
        raise CloudError(
            f"{content.name}: byte 16: the header declares {width} by {height} pixels, in a file of"
            f" {len(content)} bytes; there must be 1 to {MAX_PIXELS} pixels, and they must fit the file"
        )
    try:
        # Pillow fills missing pixels with zeros, so their number is checked first.
        parts, at = [], 8
        while at + 12 <= len(content):
            length = int.from_bytes(content.data[at : at + 4].tobytes(), "big")
            if content.data[at + 4 : at + 8].tobytes() == b"IDAT":
                parts.append(content.data[at + 8 : at + 8 + length].tobytes())
            at += 12 + length
        unpacking = zlib.decompressobj()
        there = len(unpacking.decompress(b"".join(parts), size + 1))
        if there != size or not unpacking.eof:
            raise ValueError(f"{there} bytes of pixels instead of {size}")
        with Image.open(io.BytesIO(content.data.data), formats=["PNG"]) as image:
            return np.asarray(image)
    except (OSError, SyntaxError, ValueError, zlib.error) as error:
        reason = " ".join(str(error).split())
        raise CloudError(f"{content.name}: the PNG is damaged ({reason}); get the whole file") from error
