"""Completion of things: parts behind others, pieces of one thing, thin ends, and sides that come into view."""

import numpy as np
import pytest
from flat_tables import BLUE, KNIFE, OPTICS, SHADED, SHAPE, STEEL, WHITE, WOOD, Table, lay, table, thing_at, view

from deixis.perception.oriented_box import OrientedBox
from deixis.perception.tracking.completion.missing_parts import FlatThing, revealed_part
from deixis.perception.tracking.completion.pieces import fits_another
from deixis.perception.tracking.frames.image import FrameImage
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.reference import TABLE, UNKNOWN_OWNER
from deixis.perception.tracking.things.pipeline import Pipeline


def flat(thing: Pipeline, on: Table, now: Table | None = None, views: int = 0) -> FlatThing:
    """Return a thing on a table, of which a frame shows what is there now, and which was seen from some views."""
    seen = now or on
    image = FrameImage(np.zeros((*SHAPE, 3), np.float32), seen.depth, seen.colour, OPTICS)
    changed = (seen.colour != on.colour).any(axis=2)
    return FlatThing(thing, on.reference, view(), 1.0, 0.0015, 40.0, image, changed, views)


def half_hidden_knife(end: tuple[int, int, int], row: int = 29, hidden: int = 20) -> tuple[Table, Pipeline]:
    """Return a knife whose middle a high thing hides, and whose other end has a colour and begins in a row."""
    on, last = table(), 50 + hidden
    lay(on, np.s_[29:32, 20:50], STEEL, 1)
    lay(on, np.s_[15:45, 50:last], BLUE, 2, 0.15)
    lay(on, np.s_[row : row + 3, last : last + 5], end, TABLE)
    return on, thing_at(np.s_[29:32, 20:50], 1)


def test_long_thing_goes_on_behind_what_stands_before_it() -> None:
    on, knife = half_hidden_knife(STEEL)
    columns = flat(knife, on).missing_part() % SHAPE[1]
    assert set(columns.tolist()) == {70, 71, 72, 73, 74}


def test_thing_does_not_go_on_beyond_its_largest_length() -> None:
    on, knife = half_hidden_knife(STEEL, hidden=30)
    assert not len(flat(knife, on).missing_part()), "both ends together are 32 cm apart"


@pytest.mark.parametrize(("end", "row"), [(BLUE, 29), (STEEL, 40), (WOOD, 29)])
def test_other_colours_and_places_do_not_continue_a_thing(end: tuple[int, int, int], row: int) -> None:
    on, knife = half_hidden_knife(end, row)
    assert not len(flat(knife, on).missing_part())


def test_end_of_its_colour_is_added_without_any_height() -> None:
    on = table()
    lay(on, KNIFE, STEEL, TABLE)
    lay(on, np.s_[29:32, 20:70], STEEL, 1)
    added = flat(thing_at(np.s_[29:32, 20:70], 1), on).missing_part()
    assert len(added) == 30 and (added % SHAPE[1]).min() == 70


def test_flat_patch_of_another_colour_is_not_a_part() -> None:
    on = table()
    lay(on, KNIFE, (100, 75, 52), TABLE)  # a shadow
    lay(on, np.s_[29:32, 20:70], STEEL, 1)
    assert not len(flat(thing_at(np.s_[29:32, 20:70], 1), on).missing_part())


@pytest.mark.parametrize("is_hidden", [True, False])
def test_pieces_of_one_thing_are_found(is_hidden: bool) -> None:
    on, gap = table(), 10 if is_hidden else 0
    lay(on, np.s_[29:32, 30:50], STEEL, 1)
    lay(on, np.s_[15:45, 50 : 50 + gap], BLUE, 3, 0.15)
    end = np.s_[29:32, 50 + gap : 60 + gap]
    lay(on, end, STEEL, 2)
    handle, tines, later = thing_at(np.s_[29:32, 30:50], 1), thing_at(end, 2), thing_at(end, 2)
    later.at = 3.0
    assert flat(handle, on).pieces([tines]) == [tines]
    assert flat(handle, on).pieces([later]) == [], "it was set down later"
    assert flat(tines, on).pieces([handle]) == [], "the larger piece is the thing"


@pytest.mark.parametrize(
    ("colour", "has_glass", "is_one"), [(BLUE, True, True), (STEEL, True, False), (BLUE, False, False)]
)
def test_napkin_goes_on_at_the_other_side_of_a_glass(
    colour: tuple[int, int, int], has_glass: bool, is_one: bool
) -> None:
    on, seen, corner = table(), np.s_[10:20, 40:70], np.s_[30:40, 40:48]
    lay(on, seen, BLUE, 1)
    lay(on, corner, colour, 2)
    for hidden in (np.s_[20:46, 48:80], np.s_[20:30, 36:48]):
        if has_glass:
            lay(on, hidden, WHITE, 3, 0.15)
    napkin, piece = thing_at(seen, 1, BLUE), thing_at(corner, 2, colour)
    assert flat(napkin, on).pieces([piece]) == ([piece] if is_one else [])


def test_end_that_came_into_view_later_is_a_piece() -> None:
    on = table()
    lay(on, np.s_[29:32, 40:45], STEEL, 1)  # most of it is hidden by now
    lay(on, np.s_[15:45, 45:55], BLUE, 3, 0.15)
    lay(on, np.s_[28:33, 55:75], STEEL, 2)
    handle, blade = thing_at(np.s_[29:32, 20:45], 1), thing_at(np.s_[28:33, 55:75], 2)
    blade.at = 3.0
    assert flat(handle, on).pieces([blade]) == [], "it was set down later"
    blade.revealed = True
    assert flat(handle, on).pieces([blade]) == [blade] and flat(blade, on).pieces([handle]) == []


def test_piece_within_the_box_of_a_thing_may_be_larger_in_view() -> None:
    on = table()
    lay(on, np.s_[29:32, 30:40], STEEL, 1)
    lay(on, np.s_[29:32, 40:60], STEEL, 2)
    blade = thing_at(np.s_[29:32, 40:60], 2)
    assert flat(thing_at(np.s_[29:32, 30:55], 1), on).pieces([blade]) == []
    assert flat(thing_at(np.s_[29:32, 30:62], 1), on).pieces([blade]) == [blade]


@pytest.mark.parametrize("is_edge", [False, True])
def test_far_end_in_a_later_view_is_not_the_edge_of_another(is_edge: bool) -> None:
    on, now = table(), table()
    for each in (on, now):
        lay(each, np.s_[29:32, 20:50], STEEL, 1)
        lay(each, np.s_[15:45, 50:60], BLUE, 3, 0.15)
    lay(now, np.s_[29:32, 60:63], STEEL, TABLE)
    if is_edge:
        lay(on, np.s_[29:32, 63:80], STEEL, 4)
        lay(now, np.s_[29:32, 63:80], STEEL, 4)
    seen = flat(thing_at(np.s_[29:32, 20:50], 1), on, now, views=1)
    assert seen.is_cut_off and set((seen.missing_part() % SHAPE[1]).tolist()) == (set() if is_edge else {60, 61, 62})


def test_thing_that_nothing_hides_is_not_cut_off() -> None:
    on = table()
    lay(on, np.s_[29:32, 20:50], STEEL, 1)
    assert not flat(thing_at(np.s_[29:32, 20:50], 1), on).is_cut_off


@pytest.mark.parametrize(("rows", "is_piece"), [(np.s_[26:35], True), (np.s_[32:41], False)])
def test_bowl_of_a_spoon_is_in_line_with_its_handle(rows: slice, is_piece: bool) -> None:
    on, end = table(), (rows, np.s_[50:60])
    lay(on, np.s_[29:32, 20:50], STEEL, 1)
    lay(on, end, STEEL, 2)
    handle, bowl = thing_at(np.s_[29:32, 20:50], 1), thing_at(end, 2)
    handle.oriented = OrientedBox((0.0, 0.0, 0.0), 0.0, (*handle.oriented.extents[:2], 0.032))
    assert flat(handle, on).pieces([bowl]) == ([bowl] if is_piece else [])


def test_short_ends_of_one_thing_are_joined_behind_another() -> None:
    on = table()
    tip, handle = np.s_[29:32, 42:45], np.s_[29:32, 61:66]
    lay(on, tip, STEEL, 2)
    lay(on, np.s_[15:45, 45:61], BLUE, 3, 0.15)
    lay(on, handle, STEEL, 1)
    end = thing_at(tip, 2)
    assert flat(thing_at(handle, 1), on).pieces([end]) == [end]
    lay(on, np.s_[15:45, 45:61], WOOD, TABLE)
    assert flat(thing_at(handle, 1), on).pieces([end]) == [], "nothing hides what is between them"


def test_piece_belongs_to_the_nearer_of_two_ends() -> None:
    on = table()
    tip, handle, knife = np.s_[29:32, 42:45], np.s_[29:32, 61:66], np.s_[46:58, 42:45]
    lay(on, np.s_[15:45, 45:61], BLUE, 4, 0.15)
    lay(on, np.s_[32:46, 38:61], BLUE, 4, 0.15)
    for slot, place in enumerate((tip, handle, knife), start=1):
        lay(on, place, STEEL, slot)
    end, other, long = (thing_at(place, slot) for slot, place in enumerate((tip, handle, knife), start=1))
    long.oriented = OrientedBox((0.0, 0.0, 0.0), np.pi / 2, (0.06, 0.015, 0.01))
    assert flat(long, on).pieces([end, other]) == [end]
    assert fits_another(end, long, [end, other], lambda each: flat(each, on))
    assert not fits_another(end, long, [end], lambda each: flat(each, on))
    assert not fits_another(end, other, [end, long], lambda each: flat(each, on)), "the knife is farther away"


def test_pieces_are_joined_by_their_middle_that_comes_into_view() -> None:
    on, now = table(), table()
    lay(on, np.s_[29:32, 42:45], STEEL, 2)
    lay(on, np.s_[29:32, 61:66], STEEL, 1)
    lay(now, np.s_[29:32, 42:66], STEEL, TABLE)
    end, handle = thing_at(np.s_[29:32, 42:45], 2), thing_at(np.s_[29:32, 61:66], 1)
    assert flat(handle, on, now).pieces([end]) == [], "something new may lie on the table between them"
    on.owner[29:32, 45:61] = UNKNOWN_OWNER
    assert flat(handle, on, now).pieces([end]) == [end]
    on.owner[on.owner == 2] = 1
    middle = flat(handle, on, now).missing_part()
    assert set((middle % SHAPE[1]).tolist()) == set(range(45, 61))


@pytest.mark.parametrize(("height", "found"), [(0.005, 30), (0.1, 0)])
def test_end_that_a_moving_camera_reveals_is_a_part(height: float, found: int) -> None:
    on, now = table(), table()
    lay(on, np.s_[29:32, 20:50], STEEL, 1)
    lay(now, np.s_[29:32, 20:50], STEEL, 1)
    lay(now, np.s_[29:32, 51:61], STEEL, TABLE, height)  # behind a gap of one pixel
    knife = thing_at(np.s_[29:32, 20:50], 1)
    assert not len(flat(knife, on, now).missing_part()), "something new may lie there"
    assert len(flat(knife, on, now, views=1).missing_part()) == found


def test_end_of_a_spoon_on_a_plate_is_found() -> None:
    on = table()
    lay(on, np.s_[10:50, 10:110], WHITE, 2, 0.015)
    lay(on, np.s_[10:50, 70:76], SHADED, 2, 0.015)  # the wall of the plate
    lay(on, np.s_[28:33, 62:74], STEEL, 2, 0.015)
    lay(on, np.s_[29:32, 30:62], STEEL, 1, 0.015)
    spoon = thing_at(np.s_[29:32, 30:62], 1)
    assert flat(spoon, on).is_carried and not len(flat(spoon, on, views=3).missing_part())
    added = flat(spoon, on).missing_part()
    rows, columns = np.divmod(added, SHAPE[1])
    assert set(columns.tolist()) == set(range(62, 74)) and set(rows.tolist()) <= set(range(28, 33))


def test_shaded_wall_of_a_plate_does_not_continue_a_spoon() -> None:
    on = table()
    lay(on, np.s_[10:50, 10:110], WHITE, 2, 0.015)
    lay(on, np.s_[28:33, 62:80], (150, 147, 143), 2, 0.015)  # the wall, where the spoon's line crosses it at an angle
    lay(on, np.s_[29:32, 30:62], STEEL, 1, 0.015)
    assert not len(flat(thing_at(np.s_[29:32, 30:62], 1), on).missing_part())


def test_cutlery_side_by_side_is_not_in_pieces() -> None:
    on = table()
    lay(on, np.s_[29:32, 30:60], STEEL, 1)
    lay(on, np.s_[33:36, 30:50], STEEL, 2)
    fork, spoon = thing_at(np.s_[29:32, 30:60], 1), thing_at(np.s_[33:36, 30:50], 2)
    assert flat(fork, on).pieces([spoon]) == []


def test_side_that_comes_into_view_extends_the_thing() -> None:
    on = table()
    lay(on, np.s_[25:40, 30:45], BLUE, 1, 0.01)
    mug = thing_at(np.s_[25:40, 30:45], 1, BLUE)
    assert not len(revealed_part(mug, [], on.reference, view()))
    lay(on, np.s_[30:34, 45:50], BLUE, 1, 0.01)
    handle = revealed_part(mug, [], on.reference, view())
    assert len(handle) >= 12 and (handle % SHAPE[1]).min() >= 45
    before = mug.pose[:3, 3].copy()
    points = on.reference.points(handle, view())
    mug.extend(points, np.tile(BLUE, (len(points), 1)).astype(np.float32), TrackingSettings().detection.outlines)
    assert mug.pose[0, 3] - before[0] == pytest.approx(0.0125, abs=0.003)


def test_plate_that_comes_into_view_is_not_a_part_of_a_napkin() -> None:
    on = table()
    lay(on, np.s_[10:50, 10:60], WHITE, 2, 0.01)
    lay(on, np.s_[25:40, 30:45], BLUE, 1, 0.01)
    napkin, plate = thing_at(np.s_[25:40, 30:45], 1, BLUE), thing_at(np.s_[10:50, 10:60], 2, WHITE)
    on.owner[25:40, 45:50] = 1  # of the plate, but within the margin of the napkin's box
    assert len(revealed_part(napkin, [], on.reference, view()))
    assert not len(revealed_part(napkin, [plate], on.reference, view()))
