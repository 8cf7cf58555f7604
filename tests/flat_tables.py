"""Tables from above on which flat patches lie, and things of these patches, for tests of the tracker."""

from dataclasses import dataclass

import numpy as np

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.tracking.frames.image import FrameImage, Optics, TableView, table_view
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.reference import Reference
from deixis.perception.tracking.things.pipeline import Pipeline

SHAPE = 60, 120
OPTICS = Optics(np.array([[200.0, 0, 59.5], [0, 200.0, 29.5], [0, 0, 1]]), np.zeros(3))
BACK = np.diag([1.0, -1.0, -1.0, 1.0])
BACK[2, 3] = 1.0  # the camera is one metre above the table and looks down: a pixel is 5 mm
WOOD, STEEL, BLUE = (140, 105, 73), (190, 190, 195), (40, 60, 160)
WHITE, SHADED = (235, 230, 225), (215, 210, 205)
KNIFE = np.s_[29:32, 20:80]
"""Pixels of a knife of 30 cm that lies along a row."""


@dataclass
class Table:
    """Table from above, on which flat patches lie; their owners are numbers from 1."""

    owner: np.ndarray
    depth: np.ndarray
    colour: np.ndarray

    @property
    def reference(self) -> Reference:
        points = np.zeros((*SHAPE, 3), np.float32)
        return Reference(FrameImage(points, self.depth, self.colour, OPTICS), self.owner.copy(), 0.0)


def table() -> Table:
    """Return a bare table."""
    return Table(
        np.zeros(SHAPE, np.int16), np.ones(SHAPE, np.float32), np.broadcast_to(WOOD, (*SHAPE, 3)).astype(np.float32)
    )


def lay(on: Table, pixels: tuple[slice, slice], colour: tuple[int, int, int], owner: int, height: float = 0.0) -> None:
    """Lay a patch on a table."""
    on.owner[pixels], on.depth[pixels], on.colour[pixels] = owner, 1.0 - height, colour


def view() -> TableView:
    """Return the view of a camera that looks down."""
    return table_view(OPTICS, BACK, SHAPE)


def thing_at(pixels: tuple[slice, slice], slot: int, colour: tuple[int, int, int] = STEEL) -> Pipeline:
    """Return a thing of 1 cm height that covers some pixels."""
    rows, columns = np.mgrid[pixels]
    plan = np.stack([(columns - 59.5) / 200, -(rows - 29.5) / 200], axis=-1).reshape(-1, 2)
    low, high = plan.min(axis=0) - 0.0025, plan.max(axis=0) + 0.0025
    middle = np.append((low + high) / 2, 0.005)
    points = np.column_stack([plan, np.full(len(plan), 0.005)]) - middle
    pose = np.eye(4)
    pose[:3, 3] = middle
    length, width = (high - low).tolist()
    cloud = PointCloud(points.astype(np.float32), np.tile(np.array(colour, np.uint8), (len(points), 1)))
    box = OrientedBox((0.0, 0.0, 0.0), 0.0, (length, width, 0.01))
    return Pipeline(f"t{slot}", slot, cloud, np.array([length, width, 0.01]) / 2, box, pose, 0.0, TrackingSettings())
