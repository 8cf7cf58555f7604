"""Questions about who did what: persons seen and told of, persons who were not seen, and places that boxes say."""

from __future__ import annotations

import json
from collections.abc import Iterator
from datetime import datetime, timedelta

import pytest

from deixis.grammar.recall.acts import ToldAct
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.reasoning.temporal.bounds import Bounds
from deixis.session import Session
from deixis.workflows.knowledge.recall import recall, told_change

NOW = datetime.now().astimezone().replace(hour=12, minute=0, second=0, microsecond=0)
SEEN = Source(Origin.SEEN, "tracker")


def box(x: float, y: float, z: float = 0.0, width: float = 0.03, height: float = 0.02) -> str:
    """Return the text of a box of 20 cm from near to far, wide around x."""
    return json.dumps([x - width / 2, y, z, x + width / 2, y + 0.2, z + height])


HISTORY = [
    (("t1", "isA", "fork"), 0, None, SEEN),
    (("t2", "isA", "plate"), 0, None, SEEN),
    (("t3", "isA", "cup"), 0, None, SEEN),
    (("t4", "called", "knife"), 0, None, Source(Origin.SHOWN, "Ada", "gesture 1")),
    (("t5", "isA", "spoon"), 300, None, SEEN),
    (("t1", "at", box(-0.2, 0.0)), 0, 600, SEEN),
    (("t1", "at", box(0.2, 0.0)), 600, 1200, SEEN),
    (("t1", "at", box(0.0, 0.0, 0.02)), 1200, None, SEEN),
    (("t2", "at", box(0.0, 0.0, 0.0, 0.25)), 0, None, SEEN),
    (("t3", "at", box(0.4, 0.2, 0.0, 0.1, 0.1)), 0, 1800, SEEN),
    (("t4", "at", box(0.3, 0.0)), 0, 2400, SEEN),
    (("t5", "at", box(-0.3, 0.0)), 300, None, SEEN),
    (("Ada", "moved", "t1"), 600, 600.001, SEEN),
    (("Ben", "took", "t3"), 1800, 1800.001, SEEN),
    (("Ada", "put", "t5"), 300, 300.001, Source(Origin.SAID, "Ben", "words 1")),
    (("Ben", "said", "The cups belong in the kitchen."), 1900, 1901, Source(Origin.SAID, "Ben", "words 2")),
    (("learner", "says", "I see."), 1901, 1901.001, Source(Origin.INFERRED, "learner")),
    (("Ben", "said", "What did I tell you about the cups?"), 1950, 1951, Source(Origin.SAID, "Ben", "words 3")),
]  # fmt: skip


@pytest.fixture(scope="module")
def board() -> Iterator[Blackboard]:
    """Ada puts a spoon down and moves a fork; who moved it onto the plate, and who took the knife, was not seen."""
    with Blackboard.transient(origin=NOW - timedelta(hours=1)) as board:
        for number, (said, start, finish, source) in enumerate(HISTORY):
            certainty = 0.95 if said[1] in ("moved", "took") else 1.0
            board.add(
                episodic(f"f{number}", said, start=start, finish=finish, source=source, certainty=certainty), by="test"
            )
        yield board


UNSEEN_MOVE = "who moved the fork at 11:20:00 was not seen"
ADA_MOVED = "Ada moved the fork at 11:10:00 (seen, certainty 0.95)"
ADA_HERE = "at 11:10:00"
BEN_TOOK = "Ben took the cup away at 11:30:00 (seen, certainty 0.95)"


@pytest.mark.parametrize(
    ("question", "answer"),
    [
        ("Who moved the fork?", f"{ADA_MOVED}; {UNSEEN_MOVE}."),
        ("Who was it that moved the fork first?", f"{ADA_MOVED}."),
        ("Who moved the fork last?", f"Not known: {UNSEEN_MOVE}."),
        ("Who moved the fork before 11:15?", f"{ADA_MOVED}."),
        ("By whom was the cup taken away?", f"{BEN_TOOK}."),
        ("Who has taken the knife?", "Not known: who took the knife away at 11:40:00 was not seen."),
        ("Who moved the knife?", "Not known: the knife is not recorded as moved."),
        ("Who put the plate down?",
         "Not known: the plate is not recorded as put down; it was there when the table was first seen."),
        ("who brought the spoon", "Ada put the spoon down at 11:05:00 (said by Ben)."),
        ("who put the fork on the plate?", f"Not known: {UNSEEN_MOVE}."),
        ("Which things did Ben take away?", f"{BEN_TOOK}; who took the knife away at 11:40:00 was not seen."),
        ("Who was here?", f"Ada was seen {ADA_HERE}; Ben was seen and heard from 11:30:00 to 11:32:30."),
        ("who has been at the table before 11:20", f"Ada was seen {ADA_HERE}."),
        ("How many people were here?",
         f"2: Ada was seen {ADA_HERE}; Ben was seen and heard from 11:30:00 to 11:32:30."),
        ("Was Ben here?", "Yes: Ben was seen and heard from 11:30:00 to 11:32:30."),
        ("When did you last see Ben?", "Ben was heard at 11:32:30."),
        ("Has Ben left?", "Ben was heard at 11:32:30; the places of persons are not recorded."),
        ("When did Ben arrive?", "Ben was seen at 11:30:00."),
        ("Who was the last person here?", "Ben was heard at 11:32:30."),
        ("What did Ben take off the table?", f"{BEN_TOOK}; who took the knife away at 11:40:00 was not seen."),
        ("When was the last time someone took the cup?", f"{BEN_TOOK}."),
        ("Where is Ada?", "Ada was seen at 11:10:00; the places of persons are not recorded."),
        ("Was Ben here before 11:20?", "Not known: this person was not seen or heard for that time."),
        ("What happened to the cup?",
         f"The cup was near the knife from 11:00:00 to 11:30:00 (seen); {BEN_TOOK}."),
        ("What became of the knife?",
         "The knife was right of the plate from 11:00:00 to 11:40:00 (seen); who took the knife away at 11:40:00 was "
         "not seen."),
        ("What has happened since 11:25?",
         "The knife was right of the plate from 11:00:00 to 11:40:00 (seen); the cup was near the knife from 11:00:00 "
         f"to 11:30:00 (seen); {BEN_TOOK}; who took the knife away at 11:40:00 was not seen."),
        ("What did Ben do with the cup?", f"{BEN_TOOK}."),
        ("What things has Ada touched?",
         f"Ada put the spoon down at 11:05:00 (said by Ben); {ADA_MOVED}; {UNSEEN_MOVE}; who took the knife away at "
         "11:40:00 was not seen."),
        ("What was the last thing Ben said?", "Ben said at 11:32:30: What did I tell you about the cups?"),
        ("What did you say?", "The robot said at 11:31:41: I see."),
        ("Since when has the knife been missing?", "The knife went at 11:40:00 (seen)."),
        ("What did Ada move?", f"{ADA_MOVED}; {UNSEEN_MOVE}."),
        ("What did Ben move?", f"Not known: nothing is recorded as moved by Ben; {UNSEEN_MOVE}."),
        ("What has Eve moved?", "Not known: nothing is recorded that 'eve' said, showed or did."),
        ("When did Ben take the cup away?", f"{BEN_TOOK}."),
        ("When was the cup taken away by Ada?",
         f"Not known: the cup is not recorded as taken away by Ada; {BEN_TOOK}."),
        ("Did Ada move the fork?", f"Yes: {ADA_MOVED}."),
        ("Did Ada take the cup?", f"No: {BEN_TOOK}."),
        ("Has Ada taken the knife?",
         "Not known: the knife is not recorded as taken away by Ada; who took the knife away at 11:40:00 was "
         "not seen."),
        ("How many things did Ben take away?", f"1: {BEN_TOOK}; who took the knife away at 11:40:00 was not seen."),
        ("How often did Ada move the fork?", f"1 time: {ADA_MOVED}."),
        ("Where did Ada put the fork?", "The fork was right of the plate from 11:10:00 to 11:20:00 (seen)."),
        ("Who touched the cup?", f"{BEN_TOOK}."),
        ("What did Ben tell you about the cup?", "Ben said at 11:31:40: The cups belong in the kitchen."),
        ("Who showed you the knife?", "Ada showed the knife at 11:00:00."),
        ("Where is the fork?", "The fork has been on the plate since 11:20:00 (seen)."),
        ("What was left of the plate at 11:08?",
         "The fork was left of the plate from 11:00:00 to 11:10:00 (seen); the spoon has been left of the "
         "plate since 11:05:00 (seen)."),
        ("Is the fork on the plate?", "Yes: the fork has been on the plate since 11:20:00 (seen)."),
        ("Was the fork on the plate at 11:08?", "No: the fork was left of the plate from 11:00:00 to 11:10:00 (seen)."),
        ("How long was the fork right of the plate?",
         "The fork was right of the plate from 11:10:00 to 11:20:00 (seen)."),
    ],
)  # fmt: skip
def test_questions_about_persons_are_answered(board: Blackboard, question: str, answer: str) -> None:
    assert recall(question, board, at=3600.0).answer == answer


def test_the_asker_is_the_person_who_acts(board: Blackboard) -> None:
    assert recall("what did I take away?", board, at=3600.0, speaker="Ben").answer.startswith(BEN_TOOK)
    found = recall("what did I take away?", board, at=3600.0, speaker="Ada")
    assert found.answer.startswith("Not known: nothing is recorded as taken away by Ada; ")


@pytest.mark.parametrize(
    ("question", "ids"),
    [
        ("who moved the fork?", ["f12"]),
        ("who put the fork right of the plate?", ["f12"]),
        ("what did Ben tell you about the cups?", ["f15"]),
        ("what is on the plate?", ["f7"]),
    ],
)
def test_sparql_finds_the_same_acts(tmp_path_factory: pytest.TempPathFactory, question: str, ids: list[str]) -> None:
    path = tmp_path_factory.mktemp("acts")
    with Blackboard.open(path, create=True, origin=NOW - timedelta(hours=1)) as board:
        for number, (said, start, finish, source) in enumerate(HISTORY):
            board.add(episodic(f"f{number}", said, start=start, finish=finish, source=source), by="test")
    with Session(path) as session:
        found = session.recall(question, at=NOW)
        assert found.search is not None
        assert [each.fluent.id for each in found.facts] == ids
        assert [row[0].value for row in session.query(found.search.sparql()).rows] == ids


@pytest.mark.parametrize(
    ("told", "change"),
    [
        (ToldAct("Ada", ("took",), "knife"), ("took", "t4", Bounds(2400.0, 2400.0))),
        (ToldAct("Ada", ("put", "moved"), "fork"), ("moved", "t1", Bounds(1200.0, 1200.0))),
        (ToldAct("Ada", ("moved",), "plate"), ("moved", "t2", Bounds(float("-inf"), 3600.0))),
        (ToldAct("Ada", ("moved",), "mug"), None),
    ],
)
def test_told_acts_are_the_last_such_changes(
    board: Blackboard, told: ToldAct, change: tuple[str, str, Bounds] | None
) -> None:
    assert told_change(told, board, 3600.0) == change
