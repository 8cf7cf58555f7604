"""Things at rest: those that left their places, alone or with most others."""

from dataclasses import replace

import numpy as np
import pytest
from first_looks import HALF, MUG, PLATE, FirstLook, first_look

from deixis.perception.tracking.changes.rest import has_left, is_laid_anew, is_lifted, look_at_resting
from deixis.perception.tracking.kernels import FARTHER, SAME
from deixis.perception.tracking.table.observation import Observation
from deixis.perception.tracking.table.reference import UNKNOWN_OWNER

pytest.importorskip("open3d")


def seen_without(look: FirstLook, *slots: int) -> Observation:
    """Return a frame that shows what is behind some things."""
    seen = look.seen(0.1)
    for slot in slots:
        seen.changes.counts[slot, FARTHER] += seen.changes.counts[slot, SAME]
        seen.changes.counts[slot, SAME] = 0
    return seen


def test_thing_whose_place_shows_the_table_moves() -> None:
    look = first_look([PLATE, MUG])
    plate, mug = look.things
    seen = seen_without(look, mug.slot)
    assert has_left(mug, seen.changes, HALF.moved) and not has_left(plate, seen.changes, HALF.moved)
    look_at_resting(look.things, look.table, seen, HALF)
    assert mug.active and not plate.active and plate.seen_at == 0.1 > mug.seen_at
    assert not (look.table.reference.owner == mug.slot).any(), "its pixels are free"
    assert (look.table.reference.owner == UNKNOWN_OWNER).any()


@pytest.mark.parametrize(("count", "is_anew"), [(1, False), (2, True)])
def test_table_is_laid_again_if_most_things_left_at_once(count: int, is_anew: bool) -> None:
    look = first_look([PLATE, MUG])
    changes = seen_without(look, *range(1, count + 1)).changes
    assert is_laid_anew(look.things.resting, changes, HALF.moved) == is_anew


@pytest.mark.parametrize(
    ("hand_at", "is_foot", "lifted"), [(0.1, True, True), (-5.0, True, False), (0.1, False, False)]
)
def test_mug_is_lifted_if_its_foot_is_gone_by_hand(hand_at: float, is_foot: bool, lifted: bool) -> None:
    look = first_look([PLATE, MUG])
    plate, mug = look.things
    seen = replace(look.seen(0.1), hand_at=hand_at)
    own = np.flatnonzero(look.table.reference.owner == mug.slot)
    low = look.table.reference.points(own, seen.view)[:, 2] < 0.02
    left = own[low if is_foot else ~low]
    seen.changes.state.ravel()[left] = FARTHER
    seen.changes.counts[mug.slot, FARTHER] += len(left)
    assert is_lifted(mug, look.table.reference, seen) == lifted
    assert not is_lifted(plate, look.table.reference, seen)


@pytest.mark.parametrize(("known", "moves"), [(1.0, True), (0.1, False)])
def test_few_known_pixels_do_not_tell_that_a_thing_left(known: float, moves: bool) -> None:
    look = first_look([PLATE, MUG])
    _, mug = look.things
    own = np.flatnonzero(look.table.reference.owner == mug.slot)
    kept = max(int(known * len(own)), 12)
    look.table.reference.owner.ravel()[own[kept:]] = UNKNOWN_OWNER
    look.table.reference.depth.ravel()[own[kept:]] = 0.0
    seen = replace(look.seen(0.1), is_camera_moving=True)
    seen.changes.counts[mug.slot] = 0
    seen.changes.counts[mug.slot, FARTHER] = kept
    look_at_resting(look.things, look.table, seen, HALF)
    assert mug.active == moves
