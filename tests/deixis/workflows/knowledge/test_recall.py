"""Answer questions about then and now: a told history, and random ones against their states at each second."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime, timedelta
from pathlib import Path

import pytest
from commands import deixis
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.reasoning.errors import SettingError
from deixis.reasoning.temporal.bounds import Bounds
from deixis.session import Session
from deixis.workflows.knowledge.recall import moment_of, recall
from deixis.workflows.knowledge.recall_answer import Recall

NOW = datetime.now().astimezone().replace(hour=12, minute=30, second=0, microsecond=0)
SEEN, ADA, BOB = (
    Source(Origin.SEEN, "tracker"),
    Source(Origin.SHOWN, "Ada", "gesture 1"),
    Source(Origin.SHOWN, "Bob"),
)


@pytest.fixture(scope="module")
def board() -> Iterator[Blackboard]:
    """An hour, from 11:30 to 12:30: a fork is moved onto a plate, a cup comes and goes."""
    with Blackboard.transient(origin=NOW - timedelta(hours=1)) as board:
        told = [
            (("t1", "isA", "dinner_fork"), 0, None, ADA, 1.0),
            (("t2", "isA", "plate"), 10, None, SEEN, 0.9),
            (("t3", "isA", "cup"), 20, None, BOB, 1.0),
            (("t1", "left", "t2"), 10, 600, SEEN, 1.0),
            (("t1", "on", "t2"), 600, None, SEEN, 0.97),
            (("t2", "on", "table"), 10, None, SEEN, 1.0),
            (("t3", "right", "t2"), 20, Bounds(2000, 2010), SEEN, 1.0),
            (("Ada", "pointedAt", "t1"), 0, 1, ADA, 0.99),
            (("Bob", "noticed", "'mug' was not learned"), 5, None, BOB, 1.0),
            (("Ada", "said", "put the fork on the plate"), 590, 591, Source(Origin.SAID, "Ada", "sentence 1"), 1.0),
        ]
        for number, (said, start, finish, source, certainty) in enumerate(told):
            fluent = episodic(f"f{number}", said, start=start, finish=finish, source=source, certainty=certainty)
            board.add(fluent, by="test")
        yield board


def ask(board: Blackboard, question: str) -> Recall:
    return recall(question, board, at=3600.0)


FORK_NOW = "dinner fork has been on the plate since 11:40:00 (seen, certainty 0.97)."
FORK_THEN = "dinner fork was left of the plate from 11:30:10 to 11:40:00 (seen)."
CUP_THEN = "The cup was right of the plate from 11:30:20 to between 12:03:20 and 12:03:30 (seen)."
NO_SPOON = "Not known: nothing on the blackboard is called 'spoon'; it has: cup, dinner fork, plate, table."


@pytest.mark.parametrize(
    ("question", "answer"),
    [
        ("where is the fork?", f"The {FORK_NOW}"),
        ("where was the fork before?", f"The {FORK_THEN}"),
        ("where was the fork at 11:35?", f"The {FORK_THEN}"),
        ("where was t1 at 11:35 am?", f"The {FORK_THEN}"),
        ("what was taken away since noon?", "The cup went between 12:03:20 and 12:03:30 (seen)."),
        ("what was taken away before noon?", "Not known: nothing is recorded as taken away for that time."),
        ("which one did I show you first?", "Ada showed the dinner fork at 11:30:00."),
        ("who showed you the cup first?", "Bob showed the cup at 11:30:20."),
        ("where was the cup?", CUP_THEN),
        ("where was the fork?", f"The {FORK_NOW}"),
        ("where did the cup go?", "Not known: the cup has been gone since 12:03:30."),
        ("is the cup still there?", f"No: the {CUP_THEN[4:]}"),
        ("how many things were taken away since noon?", "1: the cup."),
        ("how long was the cup there?", CUP_THEN),
        ("what was the last thing Bob showed you?", "Bob showed the cup at 11:30:20."),
        ("what is on the plate now?", f"The {FORK_NOW}"),
        ("when did the cup go?", "The cup went between 12:03:20 and 12:03:30 (seen)."),
        ("when did the cup come?", "The cup came at 11:30:20 (seen)."),
        ("when was the fork moved?", "The dinner fork was moved at 11:40:00 (seen, certainty 0.97)."),
        ("has the fork been moved since noon?", f"No: the {FORK_NOW}"),
        ("was the cup taken away?", "Yes: the cup went between 12:03:20 and 12:03:30 (seen)."),
        ("which of the things was taken away last?", "The cup went between 12:03:20 and 12:03:30 (seen)."),
        ("where did I put the fork?",
         f"Not known: who moved the dinner fork at 11:40:00 was not seen; the {FORK_NOW[:-1]}."),
        ("when did you last see the cup?", CUP_THEN),
        ("what have I shown you last?", "Bob showed the cup at 11:30:20."),
        ("where is the cup?", "Not known: the cup has been gone since 12:03:30."),
        ("where was the cup before?", CUP_THEN),
        ("where is the spoon?", NO_SPOON),
        ("what did Ada say?", "Ada said at 11:39:50: put the fork on the plate."),
        ("what did Eve say?", "Not known: nothing is recorded that 'eve' said, showed or did."),
        ("who showed you the cup?", "Bob showed the cup at 11:30:20."),
        ("was the fork left of the plate 55 minutes ago?", f"Yes: the {FORK_THEN}"),
        ("is the fork left of the plate?", f"No: the {FORK_NOW}"),
        ("how many things were on the table when the cup was taken away?", "1: the plate."),
        ("where was the fork before the cup came?", f"The {FORK_THEN}"),
        ("since when is the cutlery on the plate?", f"The {FORK_NOW}"),
        ("what has been moved most recently?", "The dinner fork was moved at 11:40:00 (seen, certainty 0.97)."),
        ("what was the last thing that moved?", "The dinner fork was moved at 11:40:00 (seen, certainty 0.97)."),
        ("how often was the fork moved?", "1 time: the dinner fork was moved at 11:40:00 (seen, certainty 0.97)."),
        ("how many times did the cup move?", "Not known: nothing that answers it is recorded."),
        ("how many things did I show you?", "2: the cup, the dinner fork."),
        ("how many things did Bob show you?", "1: the cup."),
        ("what came after the fork?", "The cup came at 11:30:20 (seen)."),
        ("what did Ada put on the plate?",
         "Not known: nothing is recorded as put on the plate by Ada; who moved the dinner fork at 11:40:00 "
         "was not seen."),
        ("who moved the fork?", "Not known: who moved the dinner fork at 11:40:00 was not seen."),
        ("who moved the cup?", "Not known: the cup is not recorded as moved."),
        ("who took the cup away?", "Not known: who took the cup away at 12:03:30 was not seen."),
        ("when did Bob take the cup away?",
         "Not known: the cup is not recorded as taken away by Bob; who took the cup away at 12:03:30 was not seen."),
        ("did Ada move the fork?",
         "Not known: the fork is not recorded as moved by Ada; who moved the dinner fork at 11:40:00 was not seen."),
        ("what did Ada tell you about the forks?", "Ada said at 11:39:50: put the fork on the plate."),
        ("what did Ada tell you about the cup?", "Not known: nothing is recorded that was said about it."),
        ("what did Bob tell you about the cup?", "Bob showed the cup at 11:30:20."),
        ("did you see a cup?", "Yes: the cup came at 11:30:20 (seen)."),
        ("what did you see last?", "The cup came at 11:30:20 (seen)."),
        ("when did you first see the cup?", "The cup came at 11:30:20 (seen)."),
        ("where have you last seen the cup?", CUP_THEN),
        ("when was the cup there?", CUP_THEN),
        ("what happened to the cup?", CUP_THEN),
        ("what happened last?", f"The {FORK_NOW}"),
        ("has anything changed since 11:35?", f"{CUP_THEN[:-1]}; the {FORK_NOW}"),
        ("where was the fork at quarter to twelve?", f"The {FORK_NOW}"),
        ("where was the fork at twenty five to twelve?", f"The {FORK_THEN}"),
    ],
)  # fmt: skip
def test_questions_are_answered_with_times_and_sources(board: Blackboard, question: str, answer: str) -> None:
    found = ask(board, question)
    assert found.answer == answer
    assert found.known == (not found.answer.startswith("Not known"))
    assert (found.reason is None) == found.known


@pytest.fixture(scope="module")
def tea() -> Iterator[Blackboard]:
    """An hour of boxes: a cup is on a saucer and goes, a spoon is moved, and the table is a layout with a mistake."""
    places = [
        ("plate", (0.17, -0.13, 0, 0.42, 0.12, 0.02), 0, None),
        ("saucer", (0.5, 0.2, 0, 0.64, 0.34, 0.02), 0, None),
        ("cup", (0.53, 0.23, 0.02, 0.61, 0.31, 0.11), 300, 2400),
        ("spoon", (-0.1, 0.2, 0, -0.07, 0.36, 0.01), 1200, 2100),
        ("spoon", (0.66, 0.2, 0, 0.69, 0.36, 0.01), 2100, None),
    ]
    things = {name: f"t{number}" for number, name in enumerate(("plate", "saucer", "cup", "spoon"), 1)}
    said = [((things[name], "at", str(list(box))), start, finish) for name, box, start, finish in places]
    said += [((thing, "isA", name), 300, None) for name, thing in things.items()]
    said += [(("table", "layout", "tea"), 900, None), (("table", "fault", "the cup is missing"), 2400, 3000)]
    said += [(("ball", "colour", "red"), 0, None), (("ball", "isA", "ball"), 0, None)]
    with Blackboard.transient(origin=NOW - timedelta(hours=1)) as board:
        for number, (statement, start, finish) in enumerate(said):
            board.add(episodic(f"f{number}", statement, start=start, finish=finish, source=SEEN), by="test")
        yield board


CUP_ON_SAUCER = "the cup was on the saucer from 11:35:00 to 12:10:00 (seen)."


@pytest.mark.parametrize(
    ("question", "answer"),
    [
        ("what is t4?", "t4 has been a spoon since 11:35:00 (seen)."),
        ("is t2 a saucer?", "Yes: t2 has been a saucer since 11:35:00 (seen)."),
        ("is t2 a spoon?", "No: t2 has been a saucer since 11:35:00 (seen)."),
        ("which one is the cup?", "t3 has been a cup since 11:35:00 (seen)."),
        ("what layout is this?", "The layout has been 'tea' since 11:45:00 (seen)."),
        ("what layout was there at 11:40?", "Not known: no layout of the table is recorded for that time."),
        ("what was wrong at 12:15?", "The cup is missing, from 12:10:00 to 12:20:00 (seen)."),
        ("is everything in its place?", "Not known: nothing is recorded as wrong."),
        ("what colour is the ball?", "The ball has been red since 11:30:00 (seen)."),
        ("what colour is the cup?", "Not known: no colour of it is recorded."),
        ("what was on the saucer?", CUP_ON_SAUCER.capitalize()),
        ("was the cup on the saucer?", f"Yes: {CUP_ON_SAUCER}"),
        ("is the cup on the saucer?", f"No: {CUP_ON_SAUCER}"),
        ("was there ever a cup on the saucer?", f"Yes: {CUP_ON_SAUCER}"),
        ("was the cup there at 12:20?", f"No: {CUP_ON_SAUCER}"),
        ("did the cup come back?", f"No: {CUP_ON_SAUCER}"),
        (
            "did the spoon come before the cup?",
            "No: the spoon was top left of the plate from 11:50:00 to 12:05:00 (seen).",
        ),
        ("which came first, the spoon or the cup?", "The cup came at 11:35:00 (seen)."),
        ("how long ago was the cup taken away?", "The cup went at 12:10:00, 20 minutes ago (seen)."),
        ("where was the spoon before?", "The spoon was top left of the plate from 11:50:00 to 12:05:00 (seen)."),
        ("how many plates are there?", "2: the plate, the saucer."),
        ("what was moved before noon?", "Not known: nothing is recorded as moved for that time."),
        ("who took it?", "Not known: the question does not say what 'it' is."),
        ("will the cup come back?", "Not known: what will happen is not recorded."),
    ],
)
def test_names_faults_and_the_past_are_recalled(tea: Blackboard, question: str, answer: str) -> None:
    assert ask(tea, question).answer == answer


def test_lasting_things_are_those_without_changes(tea: Blackboard) -> None:
    for question, things in (
        ("which things were never moved?", {"t1", "t2"}),
        ("which things were not moved since 12:06?", {"t1", "t2", "t4"}),
        ("what has been here the whole time?", {"t1", "t2"}),
        ("where is the plate?", {"t1"}),  # not the saucer, which is a kind of plate
    ):
        assert {fact.fluent.statement.subject for fact in ask(tea, question).facts} == things, question


def test_a_certainty_below_one_is_not_worded_as_one() -> None:
    with Blackboard.transient(origin=NOW - timedelta(hours=1)) as board:
        board.add(episodic("f1", ("t1", "isA", "cup"), start=0.0, certainty=0.9996, source=SEEN), by="test")
        assert ask(board, "what is t1?").answer == "t1 has been a cup since 11:30:00 (seen, certainty 0.99)."


def test_a_person_is_there_now_if_just_seen_or_heard(board: Blackboard) -> None:
    assert ask(board, "is Ada still here?").answer == (
        "Not known: this person was not seen or heard just now; Ada was heard at 11:39:50."
    )
    assert recall("is Ada here?", board, at=620.0).answer.startswith("Yes: Ada was")


def test_a_speaker_can_be_named(board: Blackboard) -> None:
    assert recall("what did I show you first?", board, at=3600.0, speaker="bob").answer.startswith("Bob showed the cup")
    assert recall("what was shown first?", board, at=3600.0, speaker="bob").answer.startswith("Ada showed the dinner")


def test_an_empty_blackboard_knows_nothing() -> None:
    with Blackboard.transient() as board:
        assert recall("where is the fork?", board).reason == (
            "nothing on the blackboard is called 'fork', which is empty"
        )
        assert recall("what is there?", board).answer == "Not known: nothing is recorded as there."


def test_a_time_without_zone_is_local() -> None:
    assert moment_of("2026-11-23T12:30").utcoffset() is not None
    with pytest.raises(SettingError, match="a time must be as in"):
        moment_of("noonish")


PLACES = [None, ("on", "table"), ("left", "plate"), ("on", "plate")]
LENGTH = 12
States = dict[str, list[tuple[str, str] | None]]


@st.composite
def histories(draw: st.DrawFn) -> States:
    """Draw where each of two things is in each second; they may be absent."""
    seconds = st.lists(st.sampled_from(PLACES), min_size=LENGTH, max_size=LENGTH)
    return {name: draw(seconds) for name in ("fork", "cup")}


def write(states: States, board: Blackboard) -> None:
    number = 0
    for name, places in states.items():
        board.add(episodic(f"i{name}", (name, "isA", name), start=0.0, source=SEEN), by="test")
        for second, place in enumerate(places):
            if place is None or (second and places[second - 1] == place):
                continue
            end = next((later for later in range(second, LENGTH) if places[later] != place), None)
            fluent = episodic(f"f{number}", (name, *place), start=float(second), finish=end, source=SEEN)
            board.write(Add(fluent), by="test")
            number += 1


def facts(found: Recall) -> set[tuple[str, str, str | None]]:
    said = (fact.fluent.statement for fact in found.facts)
    return {(each.subject, each.predicate, each.object) for each in said}


def gone(places: list[tuple[str, str] | None]) -> list[int]:
    """Return the seconds in which a thing was taken away."""
    return [second for second in range(1, LENGTH) if places[second] is None and places[second - 1] is not None]


@settings(max_examples=8, deadline=None)
@given(histories(), st.integers(0, LENGTH - 1))
def test_answers_about_random_histories_are_their_states(states: States, second: int) -> None:
    now = LENGTH - 0.5
    with Blackboard.transient() as board:
        write(states, board)
        ago = f"{now - second - 0.5:g} seconds ago"
        for name, places in states.items():
            then, last = places[second], places[-1]
            at_then = recall(f"where was the {name} {ago}?", board, at=now)
            assert facts(at_then) == (set() if then is None else {(name, *then)})
            at_now = recall(f"where is the {name}?", board, at=now)
            assert facts(at_now) == (set() if last is None else {(name, *last)})
            ended = [at for at in range(1, LENGTH) if places[at] != places[at - 1] and places[at - 1] is not None]
            before = recall(f"where was the {name} before?", board, at=now)
            assert facts(before) == ({(name, *(places[ended[-1] - 1] or ()))} if ended else set())
            went = recall(f"when did the {name} go?", board, at=now)
            assert [fact.fluent.finish.upper for fact in went.facts] == gone(places)
        window = f"in the last {now - second:g} seconds"
        taken = recall(f"what was taken away {window}?", board, at=now)
        expected = {name for name, places in states.items() if any(at >= second for at in gone(places))}
        assert {fact.fluent.statement.subject for fact in taken.facts} == expected
        on = recall(f"what was on the plate {ago}?", board, at=now)
        assert facts(on) == {
            (name, *place) for name, places in states.items() if (place := places[second]) == ("on", "plate")
        }


@pytest.mark.parametrize(
    ("question", "answer", "ids"),
    [
        ("where was the fork before?", "The fork was left of the plate", ["f3"]),
        ("what was taken away since noon?", "The cup went at 12:10:00", ["f5"]),
        ("which one did I show you first?", "Ada showed the fork", ["f1"]),
        ("what did I tell you that you have not seen?", "Ada said at 12:15:00: there is a ball", ["f7"]),
        ("is there a ball?", "Probably: Ada said at 12:15:00: there is a ball", ["f7"]),
    ],
)
def test_python_command_and_sparql_answer_alike(tmp_path: Path, question: str, answer: str, ids: list[str]) -> None:
    said = Source(Origin.SAID, "Ada", "sentence1")
    told = [
        (("t1", "isA", "fork"), 0, None, ADA),
        (("t2", "isA", "plate"), 0, None, SEEN),
        (("t1", "left", "t2"), 0, 600, SEEN),
        (("t1", "on", "t2"), 600, None, SEEN),
        (("t3", "right", "t2"), 30, 2400, SEEN),
        (("t3", "isA", "cup"), 30, None, SEEN),
        (("e1", "expected", "there is a ball"), 2700, None, said),
        (("e1", "isA", "ball"), 2700, None, said),
    ]
    with Blackboard.open(tmp_path, create=True, origin=NOW - timedelta(hours=1)) as board:
        for number, (statement, start, finish, source) in enumerate(told, 1):
            board.add(episodic(f"f{number}", statement, start=start, finish=finish, source=source), by="test")
    with Session(tmp_path) as session:
        found = session.recall(question, at=NOW)
        assert found.search is not None
        rows = session.query(found.search.sparql()).rows
    assert found.answer.startswith(answer)
    assert [each.fluent.id for each in found.facts] == ids
    assert [row[0].value for row in rows] == ids
    code, out, _ = deixis("recall", question, "--at", NOW.isoformat(), "--memory", tmp_path)
    assert (code, out) == (0, f"{found.answer}\n")
