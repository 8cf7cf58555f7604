"""State of the script that is being read: the context that gives a statement its meaning."""

from __future__ import annotations

from contextvars import ContextVar
from dataclasses import dataclass, field
from functools import cached_property

from deixis.grammar.errors import MAX_PROBLEMS_SHOWN, Diagnostic, StatementError, shortened
from deixis.grammar.layout.claims import COMMON_PHRASES
from deixis.grammar.layout.names import NameTable
from deixis.grammar.layout.words import chains
from deixis.grammar.script import Mention
from deixis.ontology.graph.facts import Source
from deixis.ontology.inflection import singulars
from deixis.ontology.relations.relation import Relation, plain_phrase
from deixis.ontology.tbox import Ontology
from deixis.ontology.things.colours import Colour
from deixis.ontology.things.kinds import Kind, with_article
from deixis.spelling import nearest

MAX_FACTS = 1_000_000  # maximum number of facts in a script, its includes counted
MAX_COMPARED_CHARACTERS = 40  # maximum length in characters of a word for which the nearest known word is searched


@dataclass
class Draft:
    """State that a script and the files that it includes share while they are read."""

    ontology: Ontology
    problems: list[Diagnostic] = field(default_factory=list)
    book: NameTable = field(default_factory=NameTable)
    viewpoint: str | None = None
    surface: str | None = None
    size: int = 0  # facts and declared objects so far
    declared: dict[str, list[Kind]] = field(default_factory=dict)
    coloured: dict[str, Colour] = field(default_factory=dict)
    _relations: dict[str, Relation] = field(default_factory=dict)

    def nearest(self, word: str, known: list[str]) -> str | None:
        """Return the known word that resembles a word most.

        Parameters
        ----------
        word
            The word.
        known
            Known words.

        Returns
        -------
        str or None
            The word, or None if none resembles it, or more problems were found than are shown.
        """
        if len(self.problems) >= MAX_PROBLEMS_SHOWN or len(word) > MAX_COMPARED_CHARACTERS:
            return None
        return nearest(word.casefold(), known)

    def relation(self, phrase: str) -> Relation:
        """Return the relation that a phrase stands for; the lexer has checked that there is one.

        Parameters
        ----------
        phrase
            A phrase that the lexer has found to be one of a relation.

        Returns
        -------
        Relation
            The relation.
        """
        found = self._relations.get(phrase)
        if found is None:
            found = self._relations[phrase] = self.ontology.relations.by_word[plain_phrase(phrase)]
        return found

    @cached_property
    def phrases(self) -> dict[str, str]:
        """Phrases of relations and common ones of claims, as they are written, by their plain form."""
        words = (word for relation in self.ontology.relations.values() for word in relation.words)
        return {plain_phrase(word): word for word in (*COMMON_PHRASES, *words)}

    @cached_property
    def chains(self) -> dict[str, Relation]:
        """Relations by the heads of their chains, such as 'left to right'."""
        return chains(self.ontology)

    @cached_property
    def hedges(self) -> dict[str, float]:
        """Weights of the hedges, by their plain form."""
        return {plain_phrase(word): weight for word, weight in self.ontology.hedges.items()}

    def grow(self, more: int, source: Source) -> None:
        """Count facts before they are created.

        Parameters
        ----------
        more
            Number of further facts.
        source
            Place of the statement.

        Raises
        ------
        StatementError
            If the script would have more than ``MAX_FACTS`` facts.
        """
        if self.size + more > MAX_FACTS:
            raise StatementError(
                source, f"a script must state at most {MAX_FACTS:,} facts; this statement exceeds that"
            )
        self.size += more

    def quality(self, word: str, source: Source) -> tuple[Kind | None, Colour | None]:
        """Return the kind and the colour that a word stands for.

        A plural such as 'forks' stands for its kind.

        Parameters
        ----------
        word
            The word.
        source
            Its place.

        Returns
        -------
        tuple
            Kind and colour; one of them may be None.

        Raises
        ------
        StatementError
            If the word stands for neither.
        """
        colours = self.ontology.colours
        for form in (word, *singulars(word)):
            kind, colour = self.ontology.quality(form)
            if kind is not None:
                return kind, colour
        if (colour := colours.of_word(word)) is not None:
            return None, colour
        shade, rest = colours.split(word)
        near = self.nearest(rest.replace("_", " "), [*self.ontology.kinds.words, *colours.words])
        hint = f"did you mean '{near}'?" if near else None
        whole = f"{shade.words[0]} {near}" if near and shade else near
        message = f"there is no kind of thing and no colour called '{shortened(rest)}'"
        raise StatementError(source, message, hint, whole)

    def paint(self, subjects: tuple[Mention, ...], colour: Colour) -> None:
        """Record a declared colour.

        Parameters
        ----------
        subjects
            The objects.
        colour
            Their colour.

        Raises
        ------
        StatementError
            If an object was declared in another colour before.
        """
        for mention in subjects:
            for name in mention.names:
                before = self.coloured.setdefault(name, colour)
                if before is not colour:
                    message = f"'{shortened(name)}' was declared as {before.label}; it cannot also be {colour.label}"
                    raise StatementError(mention.source, message, "an object has one colour: state the main one")

    def declare(self, subjects: tuple[Mention, ...], kind: Kind) -> None:
        """Record a declared kind.

        Parameters
        ----------
        subjects
            The objects.
        kind
            Their kind.

        Raises
        ------
        StatementError
            If an object was declared as another kind before.
        """
        kinds = self.ontology.kinds
        for mention in subjects:
            for name in mention.names:
                before = self.declared.setdefault(name, [])
                for other in before:
                    if not (kinds.is_a(kind, other) or kinds.is_a(other, kind)):
                        before_it, now = with_article(other.label), with_article(kind.label)
                        message = f"'{shortened(name)}' was declared as {before_it}; it cannot also be {now}"
                        raise StatementError(mention.source, message)
                if kind not in before:
                    before.append(kind)


@dataclass
class Place:
    """Position of the reader: the file and the statement, and the draft that they belong to."""

    draft: Draft
    file: str
    statement: Source


place: ContextVar[Place] = ContextVar("place")
"""Current place, set while a file is parsed; the tree builder reads it, since all scripts share one builder."""
