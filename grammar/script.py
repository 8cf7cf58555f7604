"""The tree of a layout script: its statements, the objects that they mention, and their places in the file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain, pairwise, product
from typing import TYPE_CHECKING

from deixis.answers import Answer, count
from deixis.grammar.reading import Reading
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact, Source
from deixis.ontology.relations.relation import Relation
from deixis.ontology.tbox import Ontology
from deixis.ontology.things.colours import Colour
from deixis.ontology.things.kinds import Kind

if TYPE_CHECKING:
    from deixis.ontology.graph.graph import RelationGraph


@dataclass(frozen=True, slots=True)
class Mention:
    """A name in a statement: one object, or ``count`` objects.

    ``names`` are the objects: ``("wine_glass_1", "wine_glass_2")`` for ``2 wine_glass``.
    """

    name: str
    source: Source
    count: int | None
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Modifiers:
    """Qualifiers of a statement: denied, optional, or hedged by a word, whose weight is less than 1."""

    positive: bool = True
    optional: bool = False
    hedge: str | None = None
    weight: float = 1.0


@dataclass(frozen=True, slots=True)
class Comment:
    """A comment: ``text`` without its ``#``; ``own_line`` is True if only blanks precede it on its line."""

    text: str
    source: Source
    own_line: bool


@dataclass(frozen=True, slots=True)
class Header:
    """A header, ``layout NAME "Title" on SURFACE seen from VIEWPOINT``."""

    name: str | None
    title: str | None
    viewpoint: str | None
    source: Source
    surface: str | None = None


@dataclass(frozen=True, slots=True)
class Include:
    """An include, ``include "other.layout"``, with the file's statements; empty if the file was included before."""

    path: str
    source: Source
    statements: tuple[Statement, ...] = ()


@dataclass(frozen=True, slots=True)
class Declaration:
    """A declared kind, colour or both: ``soup_spoon is a Spoon``, ``napkin is red``, ``cup is a blue mug``."""

    subjects: tuple[Mention, ...]
    kind: Kind | None
    colour: Colour | None
    source: Source


@dataclass(frozen=True, slots=True)
class RelationStatement:
    """One of the relations between every subject and every object: ``fork left of plate``, ``left(fork, plate)``."""

    subjects: tuple[Mention, ...]
    relations: tuple[Relation, ...]
    objects: tuple[Mention, ...]
    modifiers: Modifiers
    source: Source

    def facts(self) -> Iterator[Fact]:
        """Yield a fact for each subject and object, in the order of writing.

        Yields
        ------
        Fact
            A fact.
        """
        for subject, thing in product(_names(self.subjects), _names(self.objects)):
            yield _fact(subject, self.relations, thing, self)


@dataclass(frozen=True, slots=True)
class Chain:
    """A relation between each object and the next one: ``left to right: a, b, c``."""

    relation: Relation
    objects: tuple[Mention, ...]
    modifiers: Modifiers
    source: Source

    def facts(self) -> Iterator[Fact]:
        """Yield a fact for each pair of neighbours, in the order of writing.

        Yields
        ------
        Fact
            A fact.
        """
        relations = (self.relation,)
        for subject, thing in pairwise(_names(self.objects)):
            yield _fact(subject, relations, thing, self)


@dataclass(frozen=True, slots=True)
class ClaimStatement:
    """A statement of claims, such as ``fork between plate and knife`` and ``lamp at far left corner``.

    Several subjects have one claim each, except in a claim about all of them, such as ``a, b, c in a row``.
    """

    subjects: tuple[Mention, ...]
    arguments: tuple[Mention, ...]
    claims: tuple[Claim, ...]
    modifiers: Modifiers
    source: Source


Statement = Header | Include | Declaration | RelationStatement | Chain | ClaimStatement


def _names(mentions: tuple[Mention, ...]) -> Iterator[str]:
    return chain.from_iterable(mention.names for mention in mentions)


def _fact(subject: str, relations: tuple[Relation, ...], thing: str, statement: RelationStatement | Chain) -> Fact:
    how = statement.modifiers
    return Fact(subject, relations, thing, how.positive, how.optional, how.weight, statement.source)


@dataclass(frozen=True, repr=False)
class Script(Answer):
    """A layout script: its statements, and the objects, facts, kinds and colours that they state.

    Examples
    --------
    >>> from deixis.grammar.layout.parser import parse_script
    >>> script = parse_script("soup_spoon is a Spoon; soup spoon right of the plate")
    >>> script.objects
    ('soup_spoon', 'plate')
    >>> [str(fact) for fact in script.facts]
    ['right(soup_spoon, plate)']
    >>> [type(statement).__name__ for statement in script.all_statements()]
    ['Declaration', 'RelationStatement']
    >>> {name: kind.label for name, kind in script.kinds.items()}
    {'soup_spoon': 'spoon'}
    >>> script = parse_script("fork between plate and knife; plate left of knife")
    >>> [str(statement) for statement in script.stated] == [str(script.claims[0]), str(script.facts[0])]
    True
    >>> script.uncounted
    ()
    """

    file: str
    name: str | None
    title: str | None
    viewpoint: str | None
    statements: tuple[Statement, ...]
    comments: tuple[Comment, ...]
    ontology: Ontology = field(repr=False, compare=False)
    reading: Reading | None = field(default=None, repr=False, compare=False)  # of a text in English
    surface: str | None = None  # what everything stands on; it is not an object

    def summary(self) -> str:
        """Return one line with the file, the title, and the numbers of objects and facts."""
        title = f" {self.title or self.name!r}" if self.title or self.name else ""
        return f"{self.file}{title}: {count(len(self.objects), 'object')}, {count(len(self.facts), 'fact')}"

    def all_statements(self) -> Iterator[Statement]:
        """Return the statements in order; those of an included file follow its include.

        Yields
        ------
        Statement
            A statement of the script or of an included file.
        """
        return _flat(self.statements)

    @cached_property
    def objects(self) -> tuple[str, ...]:
        """Objects in the order and the spelling of their first mention."""
        found: dict[str, None] = {}
        for statement in self.all_statements():
            for mention in mentions(statement):
                found.update(dict.fromkeys(mention.names))
        return tuple(found)

    @property
    def uncounted(self) -> tuple[str, ...]:
        """Objects that are groups of unknown number (*the chairs*), as English texts may state them."""
        return () if self.reading is None else self.reading.uncounted

    @cached_property
    def facts(self) -> tuple[Fact, ...]:
        """Stated facts in order, each with its source."""
        stating = (s for s in self.all_statements() if isinstance(s, RelationStatement | Chain))
        return tuple(chain.from_iterable(statement.facts() for statement in stating))

    @cached_property
    def claims(self) -> tuple[Claim, ...]:
        """Asserted claims in order, each with its source."""
        stating = (s.claims for s in self.all_statements() if isinstance(s, ClaimStatement))
        return tuple(chain.from_iterable(stating))

    @cached_property
    def stated(self) -> tuple[Fact | Claim, ...]:
        """Facts and claims together, in the order of the statements."""
        found: list[Fact | Claim] = []
        for statement in self.all_statements():
            match statement:
                case RelationStatement() | Chain():
                    found += statement.facts()
                case ClaimStatement(claims=claims):
                    found += claims
        return tuple(found)

    @cached_property
    def kinds(self) -> dict[str, Kind]:
        """Declared kinds by object; the narrowest if several are declared."""
        found: dict[str, Kind] = {}
        for statement in self.all_statements():
            if isinstance(statement, Declaration) and statement.kind is not None:
                for name in _names(statement.subjects):
                    if name not in found or self.ontology.kinds.is_a(statement.kind, found[name]):
                        found[name] = statement.kind
        return found

    @cached_property
    def colours(self) -> dict[str, Colour]:
        """Colours by object: the declared or claimed colour, or else the colour word at the start of the name.

        >>> from deixis.grammar.layout.parser import parse_script
        >>> script = parse_script("the red mug left of the plate; plate is white")
        >>> {name: colour.label for name, colour in script.colours.items()}
        {'red_mug': 'red', 'plate': 'white'}
        """
        named = ((name, self.ontology.of_name(name)[1]) for name in self.objects)
        found = {name: colour for name, colour in named if colour is not None}
        for statement in self.all_statements():
            if isinstance(statement, Declaration) and statement.colour is not None:
                found.update(dict.fromkeys(_names(statement.subjects), statement.colour))
            elif isinstance(statement, ClaimStatement):
                for claim in statement.claims:
                    colour = self.ontology.colours.of_word(claim.value or "") if claim.relation == "colour" else None
                    if colour is not None and claim.positive:
                        found.update(dict.fromkeys(claim.subjects, colour))
        return found

    def graph(self) -> RelationGraph:
        """Return the stated facts as a relation graph.

        The kind of a node is the declared kind of the object, or else the kind that its name stands for, or None.

        Returns
        -------
        RelationGraph
            A graph with a node for each object and an edge for each fact, in the wide reading.

        Examples
        --------
        >>> from deixis.grammar.layout.parser import parse_script
        >>> graph = parse_script("2 wine_glass right of the red thingummy").graph()
        >>> [kind and kind.rpartition("#")[2] for kind in graph.kinds]
        ['WineGlass', 'WineGlass', None]
        >>> [colour and colour.rpartition("#")[2] for colour in graph.colours]
        [None, None, 'red']
        """
        return self._graph

    @cached_property
    def _graph(self) -> RelationGraph:
        from deixis.ontology.graph.graph import RelationGraph  # imports numpy, which the facts do not need

        known = [self.kinds.get(name) or self.ontology.of_name(name)[0] for name in self.objects]
        kinds = [kind.iri if kind else None for kind in known]
        colours = [self.colours[name].iri if name in self.colours else None for name in self.objects]
        shown = colours if self.colours else ()
        return RelationGraph.from_facts(self.ontology.relations, self.objects, self.facts, kinds=kinds, colours=shown)


def _flat(statements: tuple[Statement, ...]) -> Iterator[Statement]:
    for statement in statements:
        yield statement
        if isinstance(statement, Include):
            yield from _flat(statement.statements)


def mentions(statement: Statement) -> tuple[Mention, ...]:
    """Return the mentions of objects in a statement, in order.

    Parameters
    ----------
    statement
        The statement.

    Returns
    -------
    tuple of Mention
        The mentions.
    """
    match statement:
        case Declaration(subjects=subjects):
            return subjects
        case RelationStatement(subjects=subjects, objects=objects):
            return subjects + objects
        case ClaimStatement(subjects=subjects, arguments=arguments):
            return subjects + arguments
        case Chain(objects=objects):
            return objects
        case _:
            return ()
