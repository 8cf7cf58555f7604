"""Order and time of the completion of things at rest."""

import pytest
from first_looks import HALF, MUG, PLATE, first_look

from deixis.perception.tracking.completion.completion import complete

pytest.importorskip("open3d")


@pytest.mark.parametrize(("hand_at", "is_completed"), [(1.0, True), (1.7, False)])
def test_thing_is_completed_when_the_hand_has_gone(hand_at: float, is_completed: bool) -> None:
    look = first_look([PLATE, MUG])
    plate, mug = look.things
    plate.completed, mug.settled_at, mug.seen_at = True, 0.5, 2.0
    complete(look.things, look.table, look.seen(2.0, hand_at), HALF)
    assert mug.completed == is_completed


def test_thing_is_completed_again_when_the_hand_has_gone() -> None:
    look = first_look([PLATE, MUG])
    plate, mug = look.things
    plate.completed = True
    for at, hand_at, is_new in ((2.0, 1.9, True), (2.2, 2.1, False), (2.8, 2.1, True), (3.0, 2.1, False)):
        plate.seen_at = mug.seen_at = at
        complete(look.things, look.table, look.seen(at, hand_at), HALF)
        assert (mug.completed_at == at) == is_new
