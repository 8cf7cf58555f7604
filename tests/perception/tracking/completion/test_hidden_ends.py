"""Ends of long things that something hides: where they can be, and which length is likely."""

import numpy as np
import pytest

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.settings import OutlineSettings
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.tracking.completion.hidden_ends import hidden_lengths, likely_length
from deixis.perception.tracking.frames.image import FrameImage, Optics, table_view
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.reference import UNKNOWN_OWNER, Reference
from deixis.perception.tracking.things.pipeline import Pipeline

SHAPE = 60, 120
OPTICS = Optics(np.array([[200.0, 0, 59.5], [0, 200.0, 29.5], [0, 0, 1]]), np.zeros(3))
BACK = np.diag([1.0, -1.0, -1.0, 1.0])
BACK[2, 3] = 1.0  # the camera is one metre above the table and looks down: a pixel is 5 mm
VIEW = table_view(OPTICS, BACK, SHAPE)


def box_of(first: int, last: int, slot: int, height: float) -> Pipeline:
    """Return a thing that covers pixels of rows 28 to 31 from one column to another, and its reference label."""
    x = (np.array([first, last]) - 60.0) / 200
    length = float(x[1] - x[0])
    pose = np.eye(4)
    pose[:3, 3] = x.mean(), 0.0, height / 2
    points = np.random.default_rng(0).uniform(-0.5, 0.5, (400, 3)) * (length, 0.02, height)
    cloud = PointCloud(points.astype(np.float32), np.full((400, 3), 190, np.uint8))
    box = OrientedBox((0.0, 0.0, 0.0), 0.0, (length, 0.02, height))
    half = np.array([length, 0.02, height]) / 2
    return Pipeline(f"t{slot}", slot, cloud, half, box, pose, 0.0, TrackingSettings())


def table_with(hider: slice, owner: int = 2, own: slice = slice(30, 50), unknown: slice | None = None) -> Reference:
    """Return a table with a knife in some columns, and a surface 15 cm above the table in others."""
    owners, depth = np.zeros(SHAPE, np.int16), np.ones(SHAPE, np.float32)
    owners[28:32, own], depth[28:32, own] = 1, 0.99
    owners[:, hider], depth[:, hider] = owner, 0.85
    if unknown is not None:
        owners[:, unknown] = UNKNOWN_OWNER
    image = FrameImage(np.zeros((*SHAPE, 3), np.float32), depth, np.zeros((*SHAPE, 3), np.float32), OPTICS)
    return Reference(image, owners, 0.0)


KNIFE = 30, 50
"""Columns of the part of a knife that is seen."""


def test_end_lies_behind_what_hides_it() -> None:
    knife = box_of(*KNIFE, 1, 0.01)
    before, after = hidden_lengths(knife, [], table_with(slice(50, 66)), VIEW)
    assert before == 0.0, "the table is seen beyond this end"
    assert after == pytest.approx(0.08, abs=0.006), "16 pixels are hidden"


def test_pixel_of_the_table_before_a_hidden_end_may_be_noise() -> None:
    knife = box_of(*KNIFE, 1, 0.01)
    assert hidden_lengths(knife, [], table_with(slice(51, 67)), VIEW)[1] > 0.07


@pytest.mark.parametrize("first", [52, 56])
def test_end_is_seen_where_the_table_is(first: int) -> None:
    knife = box_of(*KNIFE, 1, 0.01)
    assert hidden_lengths(knife, [], table_with(slice(first, 72)), VIEW) == (0.0, 0.0)


def test_thing_goes_on_where_its_own_pixels_are() -> None:
    knife = box_of(*KNIFE, 1, 0.01)
    _, after = hidden_lengths(knife, [], table_with(slice(54, 70), own=slice(30, 54)), VIEW)
    assert after == pytest.approx(0.1, abs=0.006), "pixels beyond its box have not been added to it yet"


def test_nothing_known_may_hide_an_end() -> None:
    knife = box_of(*KNIFE, 1, 0.01)
    _, after = hidden_lengths(knife, [], table_with(slice(50, 60), unknown=slice(60, 66)), VIEW)
    assert after == pytest.approx(0.08, abs=0.006)


def test_thing_does_not_go_on_into_another_one() -> None:
    knife, bottle = box_of(*KNIFE, 1, 0.01), box_of(58, 70, 2, 0.15)
    _, after = hidden_lengths(knife, [bottle], table_with(slice(50, 72)), VIEW)
    assert after == pytest.approx(0.04, abs=0.006)


def bent(knife: Pipeline, across: float) -> Pipeline:
    """Return a knife whose last centimetre is beside the middle of its box."""
    last = knife.cloud.points[:, 0] > knife.oriented.extents[0] / 2 - 0.01
    knife.cloud.points[last, 1] = across
    return knife


def test_bent_thing_goes_on_where_its_end_is() -> None:
    beside = table_with(slice(50, 66))
    beside.depth[29:33, 50:66], beside.owner[29:33, 50:66] = 1.0, 0  # the table is seen beyond the middle of its box
    assert hidden_lengths(box_of(*KNIFE, 1, 0.01), [], beside, VIEW)[1] == 0.0
    _, after = hidden_lengths(bent(box_of(*KNIFE, 1, 0.01), 0.009), [], beside, VIEW)
    assert after == pytest.approx(0.08, abs=0.006)
    hidden = table_with(slice(50, 66))
    hidden.depth[26:29, 50:66], hidden.owner[26:29, 50:66] = 1.0, 0  # the table is seen beyond its end alone
    assert hidden_lengths(bent(box_of(*KNIFE, 1, 0.01), 0.009), [], hidden, VIEW)[1] == 0.0


@pytest.mark.parametrize(("foot", "goes_on"), [(0.02, True), (0.06, False)], ids=["a bowl", "a tumbler"])
def test_a_knife_goes_on_below_a_rim_but_not_into_a_foot(foot: float, goes_on: bool) -> None:
    turn, height = np.meshgrid(np.linspace(0, 2 * np.pi, 40), np.linspace(-0.04, 0.04, 9))
    radius = np.where(height < -0.02, foot, 0.06)
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=-1).reshape(-1, 3)
    cloud = PointCloud(points.astype(np.float32), np.full((len(points), 3), 190, np.uint8))
    pose = np.eye(4)
    pose[:3, 3] = (58 - 60) / 200, 0.04, 0.04
    box = OrientedBox((0.0, 0.0, 0.0), 0.0, (0.12, 0.12, 0.08))
    bowl = Pipeline("t2", 2, cloud, np.array([0.06, 0.06, 0.04]), box, pose, 0.0, TrackingSettings())
    _, after = hidden_lengths(box_of(*KNIFE, 1, 0.01), [bowl], table_with(slice(50, 66)), VIEW)
    assert (after == pytest.approx(0.08, abs=0.006)) == goes_on


def test_only_long_flat_things_go_on() -> None:
    for thing in (box_of(46, 50, 1, 0.01), box_of(*KNIFE, 1, 0.1)):
        assert hidden_lengths(thing, [], table_with(slice(50, 66)), VIEW) == (0.0, 0.0)


def test_length_is_between_what_is_seen_and_what_can_be_hidden() -> None:
    for seen, most in ((0.08, 0.18), (0.15, 0.19), (0.2, 0.21)):
        mean, spread = likely_length(seen, 0.02, 0.008, most)
        assert seen <= mean <= most and 0 < spread < most - seen
    assert likely_length(0.1, 0.06, 0.02, 0.4)[0] > likely_length(0.1, 0.03, 0.017, 0.4)[0], "a tablespoon, a teaspoon"
    assert likely_length(0.1, 0.012, 0.018, 0.4)[0] < likely_length(0.1, 0.023, 0.008, 0.4)[0], "a spoon, a knife"
    assert likely_length(0.215, 0.02, 0.008, 0.4)[0] < 0.215 + 0.015, (
        "it is right for a knife whose end is just seen, too"
    )


def test_report_has_the_supposed_length_and_its_spread() -> None:
    knife = box_of(*KNIFE, 1, 0.01)
    seen = knife.report(0.0)
    knife.suppose((0.0, 0.08), 0.16, 0.02)
    whole = knife.report(0.0)
    assert whole.oriented.extents[0] == pytest.approx(0.16)
    assert whole.centre - seen.centre == pytest.approx([0.03, 0.0, 0.0])
    assert whole.spread == pytest.approx(0.01) and seen.spread == 0.0, "half of the length is on either side"
    assert np.ptp(whole.box, axis=0) == pytest.approx([0.16, 0.02, 0.01])
    part = np.random.default_rng(1).uniform((-0.05, -0.01, 0.0), (-0.02, 0.01, 0.01), (100, 3))
    knife.extend(part, np.full((100, 3), 190, np.float32), OutlineSettings())
    longer = knife.report(0.0)
    assert longer.centre == pytest.approx(whole.centre, abs=0.004), "a part that comes into view was supposed before"
    assert longer.oriented.extents[0] == pytest.approx(0.16, abs=0.004)


def test_end_that_was_seen_is_not_supposed_again() -> None:
    knife = box_of(*KNIFE, 1, 0.01)
    assert knife.unseen_ends((0.0, 0.08)) == (0.0, 0.08)
    assert knife.unseen_ends((0.05, 0.0)) == (0.0, 0.08), "the first end was seen before, the other one once only"
    assert knife.unseen_ends((0.05, 0.07)) == (0.0, 0.07)
    assert knife.unseen_ends((0.05, 0.0)) == (0.0, 0.07)
    assert knife.unseen_ends((0.05, 0.0)) == (0.0, 0.0), "two views in a row show it"
    assert knife.unseen_ends((0.05, 0.08)) == (0.0, 0.0)


def test_name_is_that_of_the_part_whose_whole_was_in_place() -> None:
    knife, handle = box_of(*KNIFE, 1, 0.01), box_of(58, 70, 2, 0.01)
    knife.suppose((0.0, 0.1), 0.2, 0.02)
    place = knife.report(0.0).centre
    knife.seen_at = 5.0
    knife.suppose((0.0, 0.0), 0.1, 0.0)
    assert knife.near_for(place, 9.0) == pytest.approx(5.0), "until it seemed to be shorter"
    handle.at = 4.0
    handle.pose = knife.pose.copy()
    handle.pose[:3, 3] = place
    handle.take_name([knife], 9.0)
    assert (handle.id, knife.id) == ("t1", "t2")
