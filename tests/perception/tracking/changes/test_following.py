"""Things that move: with what carries them, and until they are gone."""

from dataclasses import replace

import numpy as np
import pytest
from first_looks import HALF, MUG, PLATE, first_look

from deixis.perception.tracking.changes.following import Workers, carry, follow, let_go
from deixis.perception.tracking.changes.hands import Hands
from deixis.perception.tracking.changes.rest import start

pytest.importorskip("open3d")


@pytest.mark.parametrize(("is_out_of_view", "gone_at"), [(False, 1.0), (True, 3.5)])
def test_thing_carried_out_of_the_image_is_kept_longer(is_out_of_view: bool, gone_at: float) -> None:
    look = first_look([PLATE, MUG])
    thing = next(iter(look.things))
    start(thing, look.things, look.table.reference)
    thing.lost()
    thing.out_of_view = is_out_of_view
    gone = [at for at in np.arange(0.5, 4.0, 0.5) if let_go(look.things, at, -np.inf, HALF)]
    assert gone == [gone_at] and thing not in look.things


def test_thing_that_is_not_found_moves_with_what_it_lies_on() -> None:
    look = first_look([PLATE, MUG])
    plate, mug = look.things
    mug.pose = mug.pose.copy()
    mug.pose[:3, 3] = plate.pose[:3, 3] + (0.02, 0.01, 0.05)
    mug._rest = mug.pose
    start(plate, look.things, look.table.reference)
    assert mug.carrier is plate
    start(mug, look.things, look.table.reference)
    mug.lost()
    plate.pose = plate.pose.copy()
    plate.pose[:3, 3] += 0.1, 0.2, 0.05
    carry(mug, Hands())
    assert mug.pose[:3, 3] - plate.pose[:3, 3] == pytest.approx([0.02, 0.01, 0.05])


@pytest.mark.parametrize(("hand_at", "lift", "moves"), [(-np.inf, 0.0, False), (0.9, 0.0, True), (0.9, 0.03, False)])
def test_hidden_thing_moves_after_a_hand_and_not_below_the_table(hand_at: float, lift: float, moves: bool) -> None:
    look = first_look([PLATE, MUG])
    mug = list(look.things)[1]
    mug._rest = mug.pose.copy()
    mug._rest[0, 3] -= 0.05  # the frame shows it 5 cm beside the place where it rests
    x, y, z = mug.oriented.centre
    mug.oriented = replace(mug.oriented, centre=(x, y, z - lift))  # its box reaches below the table there
    mug.rest_again()
    look.table.reference.take(mug.slot, None, set())
    seen = look.seen(1.0, hand_at)
    follow(look.things, look.table, seen, Hands(), 0.1, Workers(1), HALF)
    assert mug.active == moves


@pytest.mark.parametrize("is_there", [False, True])
def test_hidden_thing_leaves_with_the_hand_if_its_place_is_empty(is_there: bool) -> None:
    look = first_look([PLATE, MUG])
    mug = list(look.things)[1]
    if not is_there:
        mug.pose = mug.pose.copy()
        mug.pose[:2, 3] = 0.0, -0.15  # nothing is there
        mug._rest = mug.pose
        mug.rest_again()
    pixels, _ = look.view.pixels(mug.placed_points)
    columns = pixels % look.image.depth.shape[1]
    hidden = pixels[columns > np.quantile(columns, 0.2)]
    look.image.depth.ravel()[hidden] -= 0.3
    mug.there_at = 0.4
    hands, grip = Hands(), mug.pose[:3, 3] + (0.0, 0.0, 0.05)
    hands._past.extend([(0.3, grip[None] + 1.0), (0.4, grip[None]), (1.0, grip[None] + (0.01, 0.02, 0.1))])
    before = mug.pose[:3, 3].copy()
    follow(look.things, look.table, look.seen(1.0, 1.0), hands, 0.1, Workers(1), HALF)
    assert mug.active == mug.in_hand == (not is_there)
    assert mug.pose[:3, 3] - before == pytest.approx([0.0, 0.0, 0.0] if is_there else [0.01, 0.02, 0.1])
