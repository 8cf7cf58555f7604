"""Read questions about then and now."""

from __future__ import annotations

import pytest

from deixis.grammar.recall.questions import WORDINGS, RecallQuestionError, is_question, read_question


@pytest.mark.parametrize("wording", WORDINGS)
def test_suggested_wordings_are_understood(wording: str) -> None:
    assert read_question(wording).kind


@pytest.mark.parametrize(
    ("text", "kind", "thing", "other", "relation", "when"),
    [
        ("Where's the big red cup?", "where", "big red cup", None, None, "unstated"),
        ("where was my knife an hour ago", "where", "knife", None, None, "ago"),
        ("What's next to the bread plate now?", "related", None, "bread plate", "next_to", "now"),
        ("which cups were to the left of the tray before 3 p.m.?", "related", "cups", "tray", "left", "before_time"),
        ("What has been removed since 2026-11-23?", "gone", None, None, None, "since"),
        ("what disappeared after the cup arrived?", "gone", None, None, None, "after"),
        ("Which spoon was added between noon and 12:30:05?", "come", "spoon", None, None, "between"),
        ("Was the fork in front of the candle at first?", "whether", "fork", "candle", "in_front", "at_first"),
        ("how many glasses are in the sink", "how_many", "glasses", "sink", "inside", "unstated"),
        ("which of them did I show you last", "shown", "one", None, None, "unstated"),
        ("Where has the fork been earlier?", "where", "fork", None, None, "before"),
        ("where was the fork originally?", "where", "fork", None, None, "at_first"),
        ("what did anyone take away since noon?", "gone", None, None, None, "since"),
        ("did someone take the cup away since noon?", "whether_did", "cup", None, None, "since"),
        ("has the cup gone?", "whether_did", "cup", None, None, "unstated"),
        ("what has left the table since noon?", "gone", None, None, None, "since"),
        ("Can you tell me where the cup was half an hour ago?", "where", "cup", None, None, "ago"),
        ("Do you remember where the fork used to be?", "where", "fork", None, None, "before"),
        ("Could you tell me if the cup is on the saucer?", "whether", "cup", "saucer", "on", "unstated"),
        ("The cup was on the saucer, wasn't it?", "whether", "cup", "saucer", "on", "ever"),
        ("What was on the saucer?", "related", None, "saucer", "on", "ever"),
        ("Where are the fork and the spoon?", "where", "fork or spoon", None, None, "unstated"),
        ("Which came first, the spoon or the big cup?", "come", "spoon or big cup", None, None, "unstated"),
        ("Did the spoon come before the cup?", "whether_did", "spoon", None, None, "before_time"),
        ("At what time did the cup go?", "when_did", "cup", None, None, "unstated"),
        ("Which things have not been moved since noon?", "unmoved", "things", None, None, "since"),
        ("What has been here the whole time?", "always", None, None, None, "unstated"),
        ("Is t2 really a bread plate?", "whether_called", "t2", "bread plate", None, "unstated"),
        ("What layout was this at noon?", "layout", None, None, None, "at_time"),
        ("Was anything in the wrong place yesterday?", "fault", None, None, None, "on_day"),
        ("Has the plate ever been moved?", "whether_did", "plate", None, None, "unstated"),
        ("When did you learn what a fork is?", "when_did", "fork", None, None, "unstated"),
        ("Which things has Ada named?", "shown", "things", None, None, "unstated"),
        ("Where was the fork moved from?", "where", "fork", None, None, "before"),
        ("How sure are you that t4 is a spoon?", "whether_called", "t4", "spoon", None, "unstated"),
        ("What has Ada said about the cup?", "said_about", "cup", None, None, "unstated"),
        ("Were there two big forks at noon?", "how_many", "big forks", None, None, "at_time"),
        ("Is there a glass?", "whether_there", "glass", None, None, "unstated"),
        ("Wasn't there a cup on the saucer?", "whether", "cup", "saucer", "on", "ever"),
        ("Did you see the spoon being moved?", "whether_did", "spoon", None, None, "unstated"),
        ("What is left on the table?", "related", None, "table", "on", "unstated"),
        ("What is left of the plate?", "related", None, "plate", "left", "unstated"),
        ("Since when is something wrong?", "fault", None, None, None, "ever"),
        ("Has anybody seen the cup?", "seen_last", "cup", None, None, "unstated"),
        ("List the things on the table.", "present", None, None, None, "unstated"),
        ("Will the cup come back?", "future", None, None, None, "unstated"),
        ("Please tell me, since when is the island on the island?", "when_held", "island", "island", "on", "unstated"),
    ],
)
def test_questions_are_read_with_their_parts(
    text: str, kind: str, thing: str | None, other: str | None, relation: str | None, when: str
) -> None:
    read = read_question(text)
    assert (read.kind, read.thing, read.other, read.relation, read.when.kind) == (kind, thing, other, relation, when)


@pytest.mark.parametrize(
    ("text", "asks"),
    [
        ("Where is the sofa?", True),
        ("where was the fork before", True),
        ("please tell me which one did I show you first", True),
        ("what the fork is left of", False),
        ("When there is soup, the spoon is right of the plate.", False),
        ("The fork is left of the plate.", False),
        ("When the cup is on the saucer, the spoon is right of it.", False),
        ("tell me where the cup was", True),
    ],
)
def test_questions_are_distinguished_from_statements(text: str, asks: bool) -> None:
    assert is_question(text) is asks


@pytest.mark.parametrize(
    "text", ["", "   ", "fork?", "where the fork", "whence came the fork?", "what is on?", "\0", "where " * 400]
)
def test_what_is_not_understood_gets_a_wording(text: str) -> None:
    with pytest.raises(RecallQuestionError, match=r"for example|at most"):
        read_question(text)


@pytest.mark.parametrize(
    ("text", "kind", "thing", "person", "acts", "order"),
    [
        ("Who's taken my knife?", "who_did", "knife", None, ("took",), None),
        ("By whom was the fork moved?", "who_did", "fork", None, ("moved",), None),
        ("Who was the last one to touch the fork?", "who_did", "fork", None, ("put", "moved", "took"), "last"),
        ("When was the mug last moved, and by whom?", "who_did", "mug", None, ("moved",), "last"),
        ("Was the fork moved by Ben or by Ada?", "who_did", "fork", None, ("moved",), None),
        ("What has Ben put down since noon?", "what_did", None, "ben", ("put", "moved"), None),
        ("what was the last thing Ada moved?", "what_did", None, "ada", ("moved",), "last"),
        ("What did Ben do?", "what_did", None, "ben", ("put", "moved", "took"), None),
        ("when was the cup taken away by the waiter", "when_did_by", "cup", "waiter", ("took",), None),
        ("Has Ada moved the fork?", "whether_did_by", "fork", "ada", ("moved",), None),
        ("What did you move?", "what_did", None, "robot", ("moved",), None),
        ("Could you tell me who removed the knife, please?", "who_did", "knife", None, ("took",), None),
        ("Was it Ben who took the knife?", "whether_did_by", "knife", "ben", ("took",), None),
        ("When did anyone last touch the mug?", "who_did", "mug", None, ("put", "moved", "took"), "last"),
        ("Did I ever mention the kitchen?", "said_about", "kitchen", None, (), None),
    ],
)
def test_questions_about_acts_name_the_person(
    text: str, kind: str, thing: str | None, person: str | None, acts: tuple[str, ...], order: str | None
) -> None:
    found = read_question(text)
    assert (found.kind, found.thing, found.speaker, found.acts, found.order) == (kind, thing, person, acts, order)


def test_a_time_can_be_an_act_of_a_person() -> None:
    (moment,) = read_question("where was the fork before Ben moved it?").when.moments
    assert (moment.kind, moment.value, moment.person, moment.acts) == ("by", "it", "ben", ("moved",))
