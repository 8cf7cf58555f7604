"""New things: those that came into view, and pixels that give no thing."""

import numpy as np
import pytest
from first_looks import HALF, MUG, PLATE, first_look

from deixis.perception.tracking.changes.arrivals import is_revealed, segment
from deixis.perception.tracking.changes.hands import Hands
from deixis.perception.tracking.table.reference import TABLE, UNKNOWN_OWNER

pytest.importorskip("open3d")


@pytest.mark.parametrize("is_hand_in_view", [True, False])
def test_tries_count_only_when_no_hand_is_in_view(is_hand_in_view: bool) -> None:
    look = first_look([MUG])
    reference = look.table.reference
    table = np.flatnonzero(reference.owner == TABLE)[:50]  # part of a thing that a hand is setting down
    seen = look.seen(0.5, hand_at=0.5 if is_hand_in_view else 0.0)
    assert segment(table, look.things, look.table, seen, Hands(), look.cloud, HALF) == ()
    assert (reference.tries.ravel()[table] == (0 if is_hand_in_view else 1)).all()


def test_new_thing_far_from_hands_was_there_before() -> None:
    look = first_look([PLATE, MUG])
    thing, reference, hands = next(iter(look.things)), look.table.reference, Hands()
    pixels = np.flatnonzero(reference.owner == TABLE)[:40]
    assert is_revealed(thing, pixels, look.table, hands)
    hands._past.append((0.0, thing.pose[None, :3, 3]))
    assert not is_revealed(thing, pixels, look.table, hands), "a hand may have set it down"
    reference.owner.ravel()[pixels] = UNKNOWN_OWNER
    assert is_revealed(thing, pixels, look.table, hands), "nothing was known there"
