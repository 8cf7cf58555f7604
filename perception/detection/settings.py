"""What detection may be told; every length in metres, every angle in radians."""

from __future__ import annotations

import math
from dataclasses import dataclass

from deixis.perception.errors import CloudError


@dataclass(frozen=True, slots=True)
class DetectionSettings:
    """The defaults fit things of a few millimetres to half a metre on a table, seen from half a metre to two metres.

    ``viewer`` is where the one stands whose left and right are meant, in the cloud's frame; None: the camera. ``up``
    points upwards in the cloud's frame, within 45 degrees, where that is known. ``table`` is the table that is looked
    at, from 1 for the one with most on it. ``height`` is the least that things rise above the table, ``reach`` the
    highest that is looked at, ``least_points`` and ``least_length`` what a thing has at least. ``concavity`` is the
    angle between two surfaces, and ``step`` the height between them, at which they are two things.
    """

    seed: int = 0
    viewer: tuple[float, float, float] | None = None
    up: tuple[float, float, float] | None = None
    table: int = 1
    height: float = 0.002
    reach: float = 0.6
    least_points: int = 40
    least_length: float = 0.02
    concavity: float = math.radians(35.0)
    step: float = 0.0025

    def __post_init__(self) -> None:
        for name in ("height", "reach", "least_length", "concavity", "step"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise CloudError(f"detection's {name} is a number above 0, not {value:g}")
        if self.table < 1:
            raise CloudError(f"tables are numbered from 1, not from {self.table}")
        if self.least_points < 1:
            raise CloudError(f"a thing has 1 point or more, not {self.least_points}")
        for name in ("viewer", "up"):
            vector = getattr(self, name)
            if vector is not None and not (len(vector) == 3 and all(map(math.isfinite, vector))):
                raise CloudError(f"detection's {name} is three finite numbers, not {vector}")
        if self.up is not None and not any(self.up):
            raise CloudError("detection's up is a direction, not (0, 0, 0)")
