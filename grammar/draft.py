"""The script that is being read: what the meaning of a statement depends on besides its own words."""

from __future__ import annotations

from contextvars import ContextVar
from dataclasses import dataclass, field
from functools import cached_property

from deixis.grammar.errors import MAX_PROBLEMS_SHOWN, Diagnostic, Refusal, shortened
from deixis.grammar.names import NameTable
from deixis.grammar.script import Mention
from deixis.grammar.words import chains
from deixis.ontology.colours import Colour
from deixis.ontology.facts import Source
from deixis.ontology.kinds import Kind, with_article
from deixis.ontology.relation import Relation, nearest, plain_phrase
from deixis.ontology.tbox import Ontology

MAX_FACTS = 1_000_000  # of one script with all that it includes
MAX_COMPARED_CHARACTERS = 40  # characters of a word for which the nearest known one is looked for


@dataclass
class Draft:
    """What one script and all the files that it includes share while they are read."""

    ontology: Ontology
    problems: list[Diagnostic] = field(default_factory=list)
    book: NameTable = field(default_factory=NameTable)
    viewpoint: str | None = None
    size: int = 0  # facts and declared objects so far
    declared: dict[str, list[Kind]] = field(default_factory=dict)
    coloured: dict[str, Colour] = field(default_factory=dict)
    _relations: dict[str, Relation] = field(default_factory=dict)

    def nearest(self, word: str, known: list[str]) -> str | None:
        """Return the known word that looks most like this one; none once more problems were found than are shown."""
        if len(self.problems) >= MAX_PROBLEMS_SHOWN or len(word) > MAX_COMPARED_CHARACTERS:
            return None
        return nearest(word.casefold(), known)

    def relation(self, phrase: str) -> Relation:
        """Return the relation that a phrase stands for; the lexer knows that there is one."""
        found = self._relations.get(phrase)
        if found is None:
            found = self._relations[phrase] = self.ontology.relations.by_word[plain_phrase(phrase)]
        return found

    @cached_property
    def phrases(self) -> dict[str, str]:
        """Every relation phrase as it is written, by its plain form."""
        return {plain_phrase(word): word for r in self.ontology.relations.values() for word in r.words}

    @cached_property
    def chains(self) -> dict[str, Relation]:
        """What may head a chain, without its colon."""
        return chains(self.ontology)

    @cached_property
    def hedges(self) -> dict[str, float]:
        """The weight of each hedge."""
        return {plain_phrase(word): weight for word, weight in self.ontology.hedges.items()}

    def grow(self, more: int, source: Source) -> None:
        """Count facts before they are made; raises Refusal beyond the limit."""
        if self.size + more > MAX_FACTS:
            raise Refusal(source, f"a script states at most {MAX_FACTS:,} facts, and with these it states more")
        self.size += more

    def quality(self, word: str, source: Source) -> tuple[Kind | None, Colour | None]:
        """Return the kind of thing, its plural if need be, the colour, or the kind in a colour that a word stands for.

        Raises Refusal where there is none.
        """
        colours = self.ontology.colours
        for form in (word, word.removesuffix("s"), word.removesuffix("es")):
            kind, colour = self.ontology.quality(form)
            if kind is not None:
                return kind, colour
        if (colour := colours.of_word(word)) is not None:
            return None, colour
        rest = colours.split(word)[1]
        near = self.nearest(rest.replace("_", " "), [*self.ontology.kinds.words, *colours.words])
        hint = f"did you mean '{near}'?" if near else None
        raise Refusal(source, f"there is no kind of thing and no colour called '{shortened(rest)}'", hint)

    def paint(self, subjects: tuple[Mention, ...], colour: Colour) -> None:
        """Notes a declared colour; raises Refusal where an object was declared to be of another one before."""
        for mention in subjects:
            for name in mention.names:
                before = self.coloured.setdefault(name, colour)
                if before is not colour:
                    message = f"'{shortened(name)}' was declared as {before.label}, and is not {colour.label}"
                    raise Refusal(mention.source, message, "an object is of one colour: say the one that it mostly is")

    def declare(self, subjects: tuple[Mention, ...], kind: Kind) -> None:
        """Notes a declared kind; raises Refusal where an object was declared as something else before."""
        kinds = self.ontology.kinds
        for mention in subjects:
            for name in mention.names:
                before = self.declared.setdefault(name, [])
                for other in before:
                    if not (kinds.is_a(kind, other) or kinds.is_a(other, kind)):
                        before_it = with_article(other.label)
                        message = f"'{shortened(name)}' was declared as {before_it}, and is no {kind.label}"
                        raise Refusal(mention.source, message)
                if kind not in before:
                    before.append(kind)


@dataclass
class Place:
    """Where reading is: in which file, in which statement, of which draft."""

    draft: Draft
    file: str
    statement: Source


place: ContextVar[Place] = ContextVar("place")
"""Read by the tree builder, which lark makes once for all scripts; set for the time that one file is parsed."""
