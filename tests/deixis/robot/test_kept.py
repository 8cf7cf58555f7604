"""Sentences that tell where things are kept, away from the table."""

from __future__ import annotations

from pathlib import Path

import pytest

from deixis.grammar.english.reader import read_english
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.memory.episodes.predicates import SAID, SAYS
from deixis.ontology.tbox import default_ontology
from deixis.perception.scene import Scene
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.kept import KeptElsewhere, kept_elsewhere
from deixis.robot.live.learner import Learner
from deixis.robot.modules import ModuleBoard
from deixis.robot.robot import Robot, Told

SCENE = Scene.from_boxes(
    [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]], [[0.03, 0.2, 0.02], [0.18, 0.08, 0.1]], labels=["fork", "cup"]
)


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ("The cups belong in the kitchen.", "the cups in the kitchen"),
        ("Spoons go in the drawer.", "the spoons in the drawer"),
        ("The cups are in the kitchen and the plates in the dishwasher.",
         "the cups in the kitchen, the plates in the dishwasher"),
        ("The bread is in the basket.", None),
        ("The fork belongs left of the plate.", None),
        ("The napkin is not in the kitchen.", None),
        ("The cups belong in the kitchen. The fork is left of the plate.", None),
    ],
)  # fmt: skip
def test_only_places_away_from_the_table_are_elsewhere(text: str, kept: str | None) -> None:
    found = kept_elsewhere(read_english(text), default_ontology())
    assert (None if found is None else str(found)) == kept


def test_no_layout_is_learned_from_where_things_are_kept(tmp_path: Path) -> None:
    with Robot(tmp_path / "memory") as robot:
        robot.sees(SCENE)
        assert robot.told("The cups belong in the kitchen.", by="Ada") == KeptElsewhere(("cups",), ("kitchen",))
        assert robot.session.layouts() == ()
        assert "The cups belong in the kitchen" in robot.session.recall("where do the cups belong?").answer
        assert isinstance(robot.told("The cup is right of the fork.", by="Ada"), Told)


def test_the_live_robot_notes_where_things_are_kept(tmp_path: Path) -> None:
    learner = Learner(str(tmp_path / "memory"))
    said = episodic(
        "f1", ("Ada", SAID, "The cups belong in the kitchen."), start=1.0, source=Source(Origin.SAID, "Ada")
    )
    with Blackboard.transient() as board:
        board.write(Add(said), by="test")
        for change in list(board.changes()):
            learner.changed(change, ModuleBoard(board, learner))
        (reply,) = board.holding(Pattern(predicate=SAYS))
    assert reply.statement.object == (
        "I have noted where things are kept: the cups in the kitchen. That is not on this table."
    )
