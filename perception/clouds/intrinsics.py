"""A pinhole camera's intrinsics, as a small JSON file gives them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deixis.ontology.strict_json import parse_json
from deixis.perception.clouds.content import content_of
from deixis.perception.errors import CloudError

MAX_PIXELS = 2**25
"""The largest depth image."""
_MAX_JSON = 2**16


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
    """Reads ``{"width": 640, "height": 480, "fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5, "depth_scale": 1000}``.

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
