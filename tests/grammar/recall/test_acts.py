"""Sentences that tell who did what with a thing."""

from __future__ import annotations

import pytest

from deixis.grammar.recall.acts import ToldAct, told_act


@pytest.mark.parametrize(
    ("text", "act"),
    [
        ("I moved the fork.", ToldAct(None, ("moved",), "fork")),
        ("Ada took the cup away.", ToldAct("Ada", ("took",), "cup")),
        ("The waiter has just cleared the big plate", ToldAct("waiter", ("took",), "big plate")),
        ("I have put the fork on the plate.", ToldAct(None, ("put", "moved"), "fork")),
        ("My sister took away the mug a minute ago.", ToldAct("My sister", ("took",), "mug")),
    ],
)
def test_past_acts_of_persons_are_read(text: str, act: ToldAct) -> None:
    assert told_act(text) == act


@pytest.mark.parametrize(
    "text",
    [
        "The fork is left of the plate.",
        "Put the fork on the plate.",
        "Ada puts the fork on the plate.",
        "Someone moved the fork.",
        "The fork was moved.",
        "Lay the fork left of the plate.",
        "The knife left the table.",
        "First I put the plate down.",
    ],
)
def test_other_sentences_tell_no_act(text: str) -> None:
    assert told_act(text) is None
