"""A script from the facts of a layout: what was learned, as a script again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from deixis.grammar.format import format_script
from deixis.grammar.script import Declaration, Header, Mention, Modifiers, Placement, Script, Statement
from deixis.ontology.colours import Colour
from deixis.ontology.concepts import LayoutConcept, Role
from deixis.ontology.graph import Fact
from deixis.ontology.source import Source
from deixis.ontology.tbox import Ontology


def layout_script(layout: LayoutConcept, ontology: Ontology) -> str:
    """The layout as a script in canonical form, a fact a line; reading it gives the same facts, kinds and header."""
    lines = _Lines()
    statements = tuple(_statements(layout, ontology, lines))
    script = Script(f"<{layout.name}>", layout.name, layout.title, layout.viewpoint, statements, (), ontology)
    return format_script(script)


class _Lines:
    """Places for statements that were never written: one line each, and an empty one after a gap."""

    def __init__(self) -> None:
        self._line = 0

    def next(self, gap: bool = False) -> Source:
        self._line += 2 if gap else 1
        return Source("<layout>", self._line, 1, self._line, 2)


def _statements(layout: LayoutConcept, ontology: Ontology, lines: _Lines) -> Iterator[Statement]:
    yield Header(layout.name, layout.title, layout.viewpoint, lines.next())
    gap = True
    related = {name for fact in layout.facts for name in (fact.subject, fact.object)}
    for role in layout.roles:
        kind = ontology.kinds[role.kind] if role.declared and role.kind is not None else None
        colour = _declared_colour(role, role.name in related, ontology)
        if kind is not None or colour is not None:
            source = lines.next(gap)
            yield Declaration((_mention(role.name, source),), kind, colour, source)
            gap = False
    gap = True
    for fact in layout.facts:
        source = lines.next(gap)
        yield _placement(fact, ontology, source)
        gap = False


def _declared_colour(role: Role, related: bool, ontology: Ontology) -> Colour | None:
    """The colour of a role, None where its name says it already and a fact bears the name."""
    colour = ontology.colours[role.colour] if role.colour is not None else None
    return None if related and colour is ontology.of_name(role.name)[1] else colour


def _placement(fact: Fact, ontology: Ontology, source: Source) -> Placement:
    hedge = None if fact.weight >= 1 else _hedge(fact.weight, ontology)
    modifiers = Modifiers(fact.positive, fact.optional, hedge, fact.weight)
    ends = [(_mention(name, source),) for name in (fact.subject, fact.object)]
    return Placement(ends[0], fact.relations, ends[1], modifiers, source)


def _mention(name: str, source: Source) -> Mention:
    return Mention(name, source, None, (name,))


def _hedge(weight: float, ontology: Ontology) -> str:
    """The first word whose weight is nearest."""
    words: Sequence[str] = list(ontology.hedges)
    return min(words, key=lambda word: abs(ontology.hedges[word] - weight))
