"""Find the surface that everything in a text stands on: the table, the desk, the tray."""

from __future__ import annotations

from collections.abc import Iterator

from deixis.grammar.english.tree import Mood, NounPhrase, Predicate, Sentence
from deixis.grammar.english.vocabulary.nouns import SURFACES, SURROUNDINGS, last_word
from deixis.ontology.graph.claims import PLACES

DIRECTIONS = frozenset(
    [
        "left",
        "right",
        "in_front",
        "behind",
        "above",
        "below",
        "top",
        "bottom",
        "top_left",
        "top_right",
        "bottom_left",
        "bottom_right",
    ]
)
"""Relations that are directions."""

OF_SURFACES = PLACES | {"on", "inside", "at", "along", "across", "near", "around", "row", "circle", "part"} | DIRECTIONS
"""Relations of things to the surface that they stand on."""
SPREAD = frozenset({"blanket", "groundsheet", "tablecloth", "rug", "cloth"})
"""Nouns of what is spread out to lay things on."""
HOLLOW_SURFACES = frozenset({"cabinet", "dresser", "trolley", "cart", "nightstand", "sideboard", "desk", "buffet"})
"""Surfaces that things can also be inside of."""


def surface_noun(sentences: tuple[Sentence, ...]) -> str | None:
    """Return the noun of what everything stands on, such as *desk*; None if the text names none.

    A surface noun that is said to be somewhere itself is an object; the noun of a place (*corner of the tray*) goes
    before others.

    Parameters
    ----------
    sentences
        All sentences of the text.

    Returns
    -------
    str or None
        Last word of the surface that the text mentions most.
    """
    counts: dict[str, int] = {}
    objects: set[str] = set()
    for sentence in sentences:
        for clause in sentence.clauses:
            for phrase in _own_and_members(clause.subject):
                if clause.mood is Mood.QUESTION:
                    continue
                outer = [a for p in clause.predicates for a in p.arguments]
                if any(last_word(a.head) not in SURROUNDINGS for a in outer) or (clause.predicates and not outer):
                    objects.add(last_word(phrase.head))
            for predicate in [*clause.predicates, *(p for choice in clause.choices for p in choice)]:
                _count_surfaces(predicate, counts)
            _count_restrictions(clause.subject, counts)
        for phrase in _own_and_members(sentence.fragment):
            if phrase.of is not None and last_word(phrase.of.head) in SURFACES:
                counts[last_word(phrase.of.head)] = counts.get(last_word(phrase.of.head), 0) + 2
            elif phrase.predicates:
                objects.add(last_word(phrase.head))
        _count_restrictions(sentence.fragment, counts)
        if sentence.heading:  # 'Setup of the bench'
            for word in sentence.text.casefold().replace("(", " ").replace(")", " ").split():
                if word in SURFACES - {"top"}:
                    counts[word] = counts.get(word, 0) + 1
        for clause in sentence.clauses:  # the thing that was spread or set up, not placed
            for phrase in _own_and_members(clause.subject):
                if last_word(phrase.head) in SPREAD and last_word(phrase.head) not in objects:
                    counts[last_word(phrase.head)] = counts.get(last_word(phrase.head), 0) + 1
            for predicate in clause.predicates:
                objects |= set(_placed(predicate))
    counts = {noun: number for noun, number in counts.items() if noun not in objects}
    return max(counts, key=lambda noun: counts[noun]) if counts else None


def _count_surfaces(predicate: Predicate, counts: dict[str, int]) -> None:
    for argument in predicate.arguments if not predicate.reversed else ():
        of_place = predicate.relation in PLACES or argument.of is not None
        if predicate.relation not in OF_SURFACES and not of_place:
            continue
        for phrase in (*_own_and_members(argument), *_own_and_members(argument.of)):
            noun = last_word(phrase.head)
            told_apart = any(a.dimension in ("position", "colour", "rank") for a in phrase.adjectives)
            if noun == "top" and phrase.of is not None:
                continue  # 'on top of the case', 'at the top of the case'
            held = predicate.relation == "inside" and noun in HOLLOW_SURFACES and not of_place
            if noun in SURFACES and phrase.determiner not in ("a", "an") and not told_apart and not held:
                counts[noun] = counts.get(noun, 0) + (3 if of_place else 1)
        _count_restrictions(argument, counts)


def _placed(predicate: Predicate) -> Iterator[str]:
    """Yield the nouns of surfaces that have a place beside a thing: *on the tray behind the board*."""
    for argument in predicate.arguments:
        for own in argument.predicates:
            beside = own.relation in ("left", "right", "behind", "in_front", "next_to") and not own.reversed
            outer = [last_word(a.head) for a in own.arguments if a.head]
            if beside and outer and not any(noun in SURFACES | SURROUNDINGS for noun in outer):
                yield last_word(argument.head)


def _count_restrictions(phrase: NounPhrase | None, counts: dict[str, int]) -> None:
    for own in _own_and_members(phrase):
        for predicate in (*own.predicates, *(own.of.predicates if own.of is not None else ())):
            _count_surfaces(predicate, counts)


def _own_and_members(phrase: NounPhrase | None) -> Iterator[NounPhrase]:
    if phrase is not None:
        yield phrase
        for member in phrase.members:
            yield from _own_and_members(member)
