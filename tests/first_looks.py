"""First looks at simulated tables, for tests of the steps of the tracker."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import Detection, detect
from deixis.perception.simulator.films.film import FilmedFrame
from deixis.perception.simulator.films.stage import Rest, film
from deixis.perception.simulator.laying import Placement
from deixis.perception.tracking.frames.image import FrameImage, TableView, image_of, optics_of, table_view
from deixis.perception.tracking.looks.whole import bare_table, lay_out
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.observation import Observation, Table
from deixis.perception.tracking.things.collection import Things

HALF = TrackingSettings(stride=1)
"""Options for films at half of the resolution."""


PLATE = Placement("plate", "dinner plate", -0.2, 0.05, seed=1)
MUG = Placement("mug", "mug", 0.2, 0.1, seed=2)


@dataclass(frozen=True, eq=False)
class FirstLook:
    """Table and things after a look at one frame."""

    frame: FilmedFrame
    cloud: PointCloud
    found: Detection
    image: FrameImage
    view: TableView
    table: Table
    things: Things
    settings: TrackingSettings = HALF

    def seen(self, at: float, hand_at: float = -np.inf) -> Observation:
        """Return the same frame at a later time, compared with the table."""
        settings, table = self.settings, self.table
        changes = table.reference.compared(
            self.image, self.view.level, len(self.things), settings.tolerance, table.deviation, settings.colour, 0,
            table.colours,
        )  # fmt: skip
        hand = np.zeros(self.image.depth.shape, np.bool_)
        return Observation(self.image, self.view, changes, hand, at, hand_at, False)


def first_look(
    laid: Sequence[Placement], found: Callable[[FilmedFrame], Detection] | None = None, cloud: PointCloud | None = None
) -> FirstLook:
    """Return a table with some things after a look; ``found`` and ``cloud`` replace the detection and the cloud."""
    frame = next(iter(film(laid, [Rest(0.2)]).frames(5, scale=0.4)))
    shown = cloud or frame.cloud
    objects = found(frame) if found else detect(shown)
    optics = optics_of(shown)
    assert optics is not None
    image = image_of(shown, optics, HALF.stride)
    view = table_view(image.optics, objects.frame, image.depth.shape)
    things = Things(HALF)
    table, _ = lay_out(bare_table(image, view, 0.0, HALF), things, objects, shown, image, view, 0.0, {}, HALF)
    return FirstLook(frame, shown, objects, image, view, table, things)


def cut_rim(frame: FilmedFrame) -> Detection:
    """Return the detection of a frame with a plate and a mug, in which a part of the rim of the plate is an object."""
    found = detect(frame.cloud)
    plate = np.flatnonzero(found.labels == 0)
    rim = plate[frame.cloud.points[plate, 0] < np.quantile(frame.cloud.points[plate, 0], 0.3)]
    labels = found.labels.copy()
    labels[rim] = len(found.boxes)
    boxes = np.concatenate([found.boxes, found.boxes[:1]])
    return replace(found, labels=labels, boxes=boxes, oriented=(*found.oriented, found.oriented[0]))
