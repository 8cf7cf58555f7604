"""Check where a robot says that things belong, and the picture of what it concludes about a table."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import deixis
from deixis.reasoning.errors import InconsistencyError
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.robot import RobotError, Told

FORK, PLATE, KNIFE, CUP = (0.0, 0.02), (0.06, 0.0), (0.36, 0.02), (0.34, 0.3)
SIZES = {"fork": (0.03, 0.2), "plate": (0.26, 0.26), "knife": (0.02, 0.22), "cup": (0.09, 0.09)}
TEXT = "layout supper; fork left of plate; knife right of plate; cup above knife"


def table(**places: tuple[float, float]) -> deixis.Scene:
    """Return a table of labelled things, each with its least corner."""
    low = np.array([(*place, 0.0) for place in places.values()])
    high = low + np.array([(*SIZES[name], 0.02) for name in places])
    return deixis.Scene.from_boxes(low, high, labels=list(places))


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[deixis.Robot]:
    """Robot that saw two tables of one layout."""
    with deixis.Robot(tmp_path / "memory") as robot:
        for at, shift in ((1.0, 0.0), (2.0, 0.01)):
            robot.sees(table(fork=FORK, plate=PLATE, knife=(KNIFE[0] + shift, KNIFE[1]), cup=CUP), at=at)
            robot.told(TEXT, at=at + 0.5)
        yield robot


def test_a_contradicting_description_is_reported_and_counts(robot: deixis.Robot) -> None:
    agreeing = robot.told("layout supper; fork left of plate", at=2.8)
    assert isinstance(agreeing, Told) and agreeing.to_dict()["contradiction"] is None
    told = robot.told("layout supper; fork right of plate; knife right of plate; cup above knife", at=3.0)
    assert isinstance(told, Told)
    assert told.contradiction == (
        "'fork' cannot be both left of and right of 'plate' (left(fork, plate), right(fork, plate))"
    )
    assert told.contradiction in told.summary() and told.contradiction in told.to_text()
    assert robot.layouts["supper"].experience.tables == 4


def test_a_description_that_cannot_hold_is_refused(robot: deixis.Robot) -> None:
    before = robot.diary.board.holding(), dict(robot.layouts)
    for text, reason in (
        ("layout cups; cup inside mug; mug inside cup", "'cup' cannot be both inside and containing 'mug'"),
        ("The cup is in the mug, the mug is in the bowl and the bowl is in the cup.", "inside and containing"),
        ("The plate, the fork and the cup lie in a row from left to right. The cup is left of the plate.", "left of"),
    ):
        with pytest.raises(InconsistencyError, match=f"nothing was learned.*{reason}"):
            robot.told(text, at=3.0)
    assert (robot.diary.board.holding(), dict(robot.layouts)) == before


def test_claims_of_an_earlier_description_may_be_contradicted(robot: deixis.Robot) -> None:
    rows = [
        f"layout row; {order} in a row from left to right" for order in ("fork, plate, knife", "plate, fork, knife")
    ]
    first, second = (robot.told(text, at=3.0 + number) for number, text in enumerate(rows))
    assert isinstance(first, Told) and isinstance(second, Told)
    assert first.contradiction is None
    assert second.contradiction is not None and "'fork' cannot be both left of and right of" in second.contradiction


def test_a_question_is_not_learned_as_a_description(robot: deixis.Robot) -> None:
    with pytest.raises(RobotError, match="got a question"):
        robot.told("Is the fork left of the plate?")


def test_a_scene_before_the_last_one_is_refused(robot: deixis.Robot) -> None:
    before = robot.diary.board.holding()
    with pytest.raises(RobotError, match=r"`at` must not be before the last scene at 2 s, got 1\.5 s"):
        robot.sees(table(fork=FORK), at=1.5)
    assert robot.diary.board.holding() == before
    robot.sees(table(fork=FORK))  # the present time is that of the blackboard, which began a moment ago
    finished = [each for each in robot.diary.board.holding(Pattern(predicate="at")) if not each.is_open]
    assert len(finished) >= 3 and all(each.finish.lower >= 2.0 for each in finished)


def test_a_missing_thing_belongs_where_it_was_on_other_tables(robot: deixis.Robot) -> None:
    robot.sees(table(fork=FORK, plate=PLATE, knife=KNIFE), at=3.0)
    look = robot.look()
    assert [str(fault) for fault in look.faults()] == ["the cup is missing"]
    (place,) = look.places().values()
    assert place == pytest.approx(np.array([CUP, np.add(CUP, SIZES["cup"])]), abs=0.01)


def test_swapped_things_belong_in_the_places_of_each_other(robot: deixis.Robot) -> None:
    robot.sees(table(fork=(0.36, 0.02), plate=PLATE, knife=(0.0, 0.02), cup=CUP), at=3.0)
    look = robot.look()
    places = look.places()
    assert places.keys() == {"fork", "knife"}
    assert places["fork"].mean(axis=0) == pytest.approx([0.01, 0.13], abs=0.001)
    assert places["knife"].mean(axis=0) == pytest.approx([0.375, 0.12], abs=0.001)


def test_the_picture_shows_where_things_belong(robot: deixis.Robot) -> None:
    pytest.importorskip("matplotlib")
    robot.sees(table(fork=FORK, plate=PLATE, knife=KNIFE), at=3.0)
    figure = robot.look().plot()
    assert "cup belongs here" in [text.get_text() for text in figure.axes[0].texts]
    assert [text.get_text() for text in figure.legends[0].texts] == ["where it belongs"]


def test_a_table_without_mistakes_has_no_such_places(robot: deixis.Robot) -> None:
    robot.sees(table(fork=FORK, plate=PLATE, knife=KNIFE, cup=CUP), at=3.0)
    assert not robot.look().places()


def test_an_unknown_thing_or_layout_is_reported(robot: deixis.Robot) -> None:
    look = robot.look()
    with pytest.raises(deixis.DeixisError, match="there is no object 'o99'"):
        look.name("o99")
    with pytest.raises(deixis.DeixisError, match="`layout` must be a layout that was looked for, got 'tea'"):
        look.faults("tea")


@pytest.mark.parametrize("at", [float("nan"), float("inf")])
def test_a_time_that_is_not_finite_changes_nothing(robot: deixis.Robot, at: float) -> None:
    before = robot.scene
    for call in (lambda: robot.sees(table(fork=FORK, plate=PLATE), at=at), lambda: robot.watches(at=at)):
        with pytest.raises(deixis.DeixisError, match="`at` must be a finite number of seconds"):
            call()
    assert robot.scene is before


def test_times_may_be_numbers_of_numpy(robot: deixis.Robot) -> None:
    robot.sees(table(fork=FORK, plate=PLATE, knife=KNIFE, cup=CUP), at=np.float32(3.0))  # type: ignore[arg-type]
    told = robot.told(TEXT, at=np.int64(4))  # type: ignore[call-overload]
    assert told.lesson.id == "supper-3"


def test_a_closed_robot_sees_and_answers_nothing(tmp_path: Path) -> None:
    with deixis.Robot(tmp_path / "memory") as robot:
        robot.sees(table(fork=FORK, plate=PLATE, knife=KNIFE), at=1.0)
        robot.told(TEXT, at=2.0)
        robot.look()
    for call in (
        lambda: robot.sees(table(fork=FORK, plate=PLATE), at=2.0),
        robot.watches,
        robot.look,
        robot.names,
        robot.layout,
        robot.check,
        lambda: robot.check("brunch"),
        robot.knowledge,
        robot.consolidate,
        robot.reconsider,
        robot.remember,
        lambda: robot.questions,
        lambda: robot.layout_question,
    ):
        with pytest.raises(deixis.DeixisError, match="this session is closed"):
            call()


def test_a_board_has_the_methods_of_a_blackboard(tmp_path: Path) -> None:
    with pytest.raises(deixis.DeixisError, match="`board` must be a Board or None, got 3"):
        deixis.Robot(tmp_path / "memory", board=3)  # type: ignore[arg-type]
