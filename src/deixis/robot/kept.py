"""Sentences that tell where things are kept, away from the table: *the cups belong in the kitchen*.

They are about a kind of things or a habit, not about how the table is laid, so that no layout is learned from them.
"""

from __future__ import annotations

from dataclasses import dataclass

from deixis.grammar.script import Script
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact
from deixis.ontology.tbox import Ontology
from deixis.ontology.things.kinds import plain_name

INSIDE = "inside"
"""Relation of things to the container in which they are kept."""

MIN_LENGTH = 0.3
"""Minimum length in metres, for the shortest of its kind, at which a container does not stand on a table."""


@dataclass(frozen=True, slots=True)
class KeptElsewhere:
    """Things that a person said are kept away from the table.

    Attributes
    ----------
    things
        Nouns of the things, as they were said.
    places
        Nouns of the places, one for each thing.
    """

    things: tuple[str, ...]
    places: tuple[str, ...]

    def __str__(self) -> str:
        return ", ".join(f"the {thing} in the {place}" for thing, place in zip(self.things, self.places, strict=True))


def kept_elsewhere(script: Script, ontology: Ontology) -> KeptElsewhere | None:
    """Return where a description says that things are kept, if all that it says is about places away from the table.

    Parameters
    ----------
    script
        The description.
    ontology
        Kinds and their sizes.

    Returns
    -------
    KeptElsewhere or None
        The things with their places: in something that is not in view, or in a container that is too large for a
        table. None if the description says anything else.
    """
    pairs: list[tuple[str, str]] = []
    for each in script.stated:
        found = _kept(each, ontology)
        if not found:
            return None
        pairs += found
    things, places = zip(*pairs, strict=True) if pairs else ((), ())
    return KeptElsewhere(things, places) if pairs else None


def _kept(stated: Fact | Claim, ontology: Ontology) -> list[tuple[str, str]]:
    """Return the things that a statement puts away from the table, each with its place; none for another statement."""
    if not stated.positive:
        return []
    if isinstance(stated, Claim):
        is_elsewhere = stated.relation in ontology.relations and not stated.arguments and stated.value is not None
        return [(_words(thing), _words(stated.value or "")) for thing in stated.subjects] if is_elsewhere else []
    container = ontology.kinds.of_word(_words(stated.object))
    is_inside = {relation.name for relation in stated.relations} == {INSIDE}
    if not is_inside or container is None or ontology.sizes.of(container.iri).length.least < MIN_LENGTH:
        return []
    return [(_words(stated.subject), _words(stated.object))]


def _words(name: str) -> str:
    return plain_name(name).replace("_", " ")
