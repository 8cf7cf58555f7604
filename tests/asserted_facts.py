"""Facts that an English text asserts."""

from __future__ import annotations

from deixis.grammar.english.reader import read_english

MINOR = ("count(", "colour(", "size(", "material(", "contents(", "kind(", "shape(")
"""Beginnings of facts that say neither a place nor a state."""


def asserted(text: str, without: tuple[str, ...] = MINOR) -> list[str]:
    """Return the facts that a text asserts, as text.

    Parameters
    ----------
    text
        English text of which at least one fact is understood.
    without
        Beginnings of facts that are left out.

    Returns
    -------
    list of str
        Facts in the order of the text.
    """
    reading = read_english(text).reading
    assert reading is not None
    shown = [str(fact.content) for fact in reading.stated if fact.asserted]
    return [fact for fact in shown if not fact.startswith(without)]
