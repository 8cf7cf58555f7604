"""Corrections of the first look: pieces of one colour, things of other colours, and what is hidden now."""

from dataclasses import replace

import numpy as np
import pytest
from first_looks import HALF, MUG, PLATE, cut_rim, first_look

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import BACKGROUND, Detection, detect
from deixis.perception.detection.outline import oriented_box, upright_box
from deixis.perception.detection.table.viewpoint import moved
from deixis.perception.simulator.films.film import FilmedFrame
from deixis.perception.simulator.films.stage import Rest, film
from deixis.perception.simulator.laying import Placement
from deixis.perception.tracking.looks.correction import correct, reconciled, remodelled
from deixis.perception.tracking.things.model import model_on_table

pytest.importorskip("open3d")


def cut_plate(is_rim_blue: bool) -> tuple[Detection, PointCloud]:
    """Return a detection in which a part of the rim of a plate is an object, and a cloud in which this may be blue."""
    frame = next(iter(film([PLATE, MUG], [Rest(0.2)]).frames(5, scale=0.4)))
    cut = cut_rim(frame)
    assert frame.cloud.colours is not None
    colours = frame.cloud.colours.copy()
    if is_rim_blue:
        colours[cut.labels == 2] = 40, 60, 160
    return cut, replace(frame.cloud, colours=colours)


@pytest.mark.parametrize("is_other_colour", [False, True])
def test_closer_look_leaves_a_thing_of_another_colour_its_points(is_other_colour: bool) -> None:
    cut, cloud = cut_plate(is_other_colour)
    rim, look = cut.labels == 2, first_look([PLATE, MUG], lambda frame: cut, cloud)
    found = reconciled(detect(look.frame.cloud), cloud, look.table, look.things, look.image, look.view, HALF)
    share = (found.labels[rim] == BACKGROUND).mean()
    assert share > 0.9 if is_other_colour else share == 0
    assert (found.labels[cut.labels == 0] == 0).all() and len(found.boxes) == 2


@pytest.mark.parametrize("is_other_colour", [False, True])
def test_closer_look_joins_pieces_of_one_colour_to_a_thing(is_other_colour: bool) -> None:
    (cut, cloud), look = cut_plate(is_other_colour), first_look([PLATE, MUG])
    rim, shown = cut.labels == 2, replace(cut, cloud=cloud)
    found = reconciled(shown, cloud, look.table, look.things, look.image, look.view, HALF)
    assert len(found.boxes) == (3 if is_other_colour else 2)
    assert set(found.labels[rim]) == ({2} if is_other_colour else {0})
    if not is_other_colour:
        assert found.boxes[0] == pytest.approx(look.found.boxes[0], abs=0.01)


def test_new_model_keeps_what_is_hidden_now() -> None:
    look = first_look([PLATE, MUG])
    cloud, plate = look.cloud, next(iter(look.things))
    seen = np.flatnonzero(look.found.labels == 0)
    seen = seen[cloud.points[seen, 0] > np.median(cloud.points[seen, 0])]
    model = model_on_table(look.found, cloud, seen, 0, look.table, look.view.back, HALF)
    part = replace(model, half=plate.half / 2, oriented=replace(plate.oriented, extents=(0.1, 0.1, 0.02)))
    own = look.table.reference.owner == 1
    hidden = own & (look.image.points[..., 0] <= np.median(cloud.points[seen, 0]))
    image = replace(look.image, depth=np.where(hidden, look.image.depth - 0.2, look.image.depth))
    made = remodelled(plate, part, look.things, image, look.view, 0.5, HALF)
    assert made is next(iter(look.things)) and made.rest == plate.rest and made.at == plate.at
    assert made.oriented.extents[0] > 0.9 * plate.oriented.extents[0]


def test_thing_that_was_cut_keeps_the_name_of_its_middle() -> None:
    def cut_knife(frame: FilmedFrame) -> Detection:
        """Return a detection in which the first half of a knife is a thing, and its middle another one."""
        found = detect(frame.cloud)
        own = np.flatnonzero(found.labels == 0)
        points = moved(frame.cloud.points[own].astype(np.float64), found.frame)
        along = (points - found.oriented[0].centre) @ found.oriented[0].axes[0] / found.oriented[0].extents[0] + 0.5
        labels = found.labels.copy()
        labels[own] = np.select([along < 0.45, along < 0.8], [0, 1], BACKGROUND)
        pieces = [points[labels[own] == k] for k in (0, 1)]
        boxes = np.array([upright_box(piece, HALF.detection.outlines) for piece in pieces])
        oriented = tuple(oriented_box(piece, HALF.detection.outlines) for piece in pieces)
        return replace(found, labels=labels, boxes=boxes, oriented=oriented)

    look = first_look([Placement("knife", "dinner knife", 0.0, 0.0, 0.4, seed=1)], cut_knife)
    assert [thing.id for thing in look.things] == ["t1", "t2"]
    whole = detect(look.cloud)
    result = correct(look.table, look.things, whole, look.cloud, look.image, look.view, 0.5, 1.0, HALF)
    assert [thing.id for thing in look.things] == ["t2"] == list(result.ids.values())
    assert [thing.id for thing in result.merged] == ["t1"]
