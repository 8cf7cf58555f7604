"""Read the TBox (``deixis.ttl``, ``everyday.ttl``): the words and their meanings that the other packages use."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from deixis.errors import OntologyError
from deixis.ontology.inflection import singulars
from deixis.ontology.kept import kept
from deixis.ontology.rdf.triple_index import TripleIndex
from deixis.ontology.rdf.triples import content_key
from deixis.ontology.rdf.vocabulary import DX, W3C
from deixis.ontology.relations.relation import Relation, Relations, relation_from_triples
from deixis.ontology.things.colours import Colour, Colours, colours_from_triples
from deixis.ontology.things.kinds import Kind, Kinds, plain_name, spaced
from deixis.ontology.things.sizes import Sizes, sizes_from_triples

if TYPE_CHECKING:
    import pyoxigraph as ox

    from deixis.ontology.lexicon.lexicon import Lexicon
    from deixis.ontology.lexicon.nouns import Nouns

Read = TypeVar("Read")

TBOX_FILES = tuple(Path(__file__).with_name(name) for name in ("deixis.ttl", "everyday.ttl"))
"""Turtle files of one ontology: the vocabulary with the kinds of tableware, and the everyday kinds around them."""


@dataclass(frozen=True, repr=False)
class Ontology:
    """The content of the TBox: relations, kinds of things, usual sizes, colours, and hedges with their weights."""

    relations: Relations
    kinds: Kinds
    hedges: dict[str, float]
    sizes: Sizes
    colours: Colours

    def __reduce__(self) -> str | tuple[Any, ...]:
        return (default_ontology, ()) if self is default_ontology() else super().__reduce__()

    def __repr__(self) -> str:
        return f"<Ontology {len(self.relations)} relations, {len(self.kinds)} kinds>"

    @cached_property
    def lexicon(self) -> Lexicon:
        """The nouns of the ontology: their inflection, head nouns, kinds, sizes, and how well they fit labels."""
        from deixis.ontology.lexicon.lexicon import Lexicon

        return Lexicon(self.kinds, self.sizes, self.colours)

    @cached_property
    def kinds_key(self) -> str:
        """Hash of all statements about kinds: their words, their broader kinds, their usual sizes, and the lexicon."""
        from deixis.ontology.lexicon.nouns import NOUNS_FILE

        stated = [(kind.iri, kind.words, sorted(kind.broader), self.sizes.of(kind.iri)) for kind in self.kinds]
        return content_key(repr(stated) + NOUNS_FILE.read_text(encoding="utf-8"))

    def quality(self, words: str) -> tuple[Kind | None, Colour | None]:
        """Return the kind, the colour, or both, that words such as ``red mug`` stand for.

        A colour is split off only where the other words are not a kind by themselves: a red wine glass need not be red.

        Parameters
        ----------
        words
            The words.

        Returns
        -------
        tuple
            Kind and colour. Words that name neither give (None, None); a colour before unknown words gives (None,
            colour).

        Examples
        --------
        >>> kind, colour = default_ontology().quality("red mug")
        >>> kind.name, colour.label
        ('Mug', 'red')
        >>> kind, colour = default_ontology().quality("red wine glass")
        >>> kind.name, colour
        ('RedWineGlass', None)
        """
        kind = self.kinds.of_word(words)
        if kind is not None:
            return kind, None
        colour, rest = self.colours.split(words)
        return (None, self.colours.of_word(words)) if colour is None else (self.kinds.of_word(rest), colour)

    def of_name(self, name: str) -> tuple[Kind | None, Colour | None]:
        """Return the kind and the colour that the name of an object stands for, without its number.

        A name that is only a colour word gives no colour, since an orange may be a fruit. A name of several words
        that is not a kind itself is of the kind of its head noun: a rice bowl is a bowl. A noun that has several senses
        and is not a word of the TBox counts only if things of all its senses are about as large.

        Parameters
        ----------
        name
            Name of an object.

        Returns
        -------
        tuple
            Kind and colour; either may be None.

        Examples
        --------
        >>> [kind and kind.name for kind, _ in map(default_ontology().of_name, ("rice_bowl_2", "mouse", "router"))]
        ['Bowl', 'ComputerMouse', None]
        """
        plain = plain_name(name)
        colour, noun = (None, plain) if self.kinds.of_word(plain) else self.colours.split(plain)
        return self._usual_kind(noun), colour

    def _usual_kind(self, noun: str) -> Kind | None:
        known = self.kinds.words.get(spaced(noun))
        if known is not None:  # without reading the lexicon
            return known
        head = self.kinds.headed(spaced(noun))
        senses, before = self.kinds.head_noun(head)
        end = head[len(before) :].strip()
        usual = end if self.kinds.senses(end) else singulars(end)[0]
        if len(senses) < 2 or usual in self.kinds.words:
            return next(iter(senses), None)
        first, *others = (self.sizes.of(kind.iri) for kind in senses)
        return senses[0] if all(first.is_about_as_large_as(other) for other in others) else None


def load_ontology(*extra: str) -> Ontology:
    """Return the shipped TBox, with further Turtle texts merged into it.

    Parameters
    ----------
    *extra
        Turtle texts. A ``skos:altLabel`` is enough for scripts to understand a new word for a relation.

    Returns
    -------
    Ontology
        The ontology.

    Raises
    ------
    OntologyError
        If a text is not valid Turtle, or a relation, hedge, size or colour is incomplete.

    Examples
    --------
    >>> more = load_ontology('''@prefix dx: <https://w3id.org/deixis/onto#> .
    ... @prefix skos: <http://www.w3.org/2004/02/skos/core#> .
    ... dx:left skos:altLabel "port side of" .''')
    >>> more.relations.by_word["port side of"].name
    'left'
    """
    triples = TripleIndex(quad for text in (tbox_turtle(), *extra) for quad in _parse(text))
    relations: list[Relation] = []
    for reading in (DX.WIDE, DX.EXACT, DX.GRADED):
        for iri in triples.subjects(DX.READING, reading):
            relations.append(relation_from_triples(iri, triples, index=len(relations)))
    colours = colours_from_triples(
        triples, {iri: _words(triples, iri) for iri in triples.subjects(W3C.RDF_TYPE, DX.COLOUR)}
    )
    kinds = _kinds(triples)

    nouns, listed = _ReadOnce(_nouns, kinds.words), _ReadOnce(_listed_words, kinds.words)
    return Ontology(
        Relations(tuple(relations)),
        Kinds(tuple(kinds), nouns, listed),
        _hedges(triples),
        sizes_from_triples(triples, nouns),
        colours,
    )


@dataclass(frozen=True, eq=False)
class _ReadOnce(Generic[Read]):
    """Function without arguments that reads something about words at its first call; it can be pickled."""

    read: Callable[[Mapping[str, Kind]], Read]
    words: Mapping[str, Kind]

    def __call__(self) -> Read:
        return self._found

    @cached_property
    def _found(self) -> Read:
        return self.read(self.words)


def _nouns(words: Mapping[str, Kind]) -> Nouns:
    from deixis.ontology.lexicon.nouns import read_nouns

    return read_nouns(words)


def _listed_words(words: Mapping[str, Kind]) -> frozenset[str]:
    from deixis.ontology.lexicon.nouns import listed_words

    return listed_words(words)


def tbox_turtle() -> str:
    """Return the shipped TBox as one Turtle text.

    Returns
    -------
    str
        The text.
    """
    return "\n".join(file.read_text(encoding="utf-8") for file in TBOX_FILES)


@lru_cache(maxsize=1)
def default_ontology() -> Ontology:
    """Return the shipped ontology, read once and then kept on disk."""
    here = Path(__file__).parent
    code = ["tbox.py", "rdf/triple_index.py", "rdf/vocabulary.py", "relations/relation.py", "relations/allen.py"]
    code += ["things/kinds.py", "things/sizes.py", "things/colours.py"]

    def parts() -> tuple[Relations, Kinds, dict[str, float], Sizes, Colours]:
        read = load_ontology()
        return read.relations, read.kinds, read.hedges, read.sizes, read.colours

    return Ontology(*kept("ontology", (*TBOX_FILES, *(here / name for name in code)), parts))


def _parse(text: str) -> Iterator[ox.Quad]:
    """Yield the statements whose subject is an IRI and whose object is not a blank node."""
    import pyoxigraph as ox

    try:
        for quad in ox.parse(text, format=ox.RdfFormat.TURTLE):
            if isinstance(quad.subject, ox.NamedNode) and not isinstance(quad.object, ox.BlankNode):
                yield quad
    except SyntaxError as error:
        raise OntologyError(f"the ontology is not valid Turtle: {error}") from error


def _words(triples: TripleIndex, iri: str) -> tuple[str, ...]:
    labels = [*triples.values(iri, W3C.RDFS_LABEL), *triples.values(iri, W3C.SKOS_ALT_LABEL)]
    return tuple(dict.fromkeys(label.casefold() for label in labels))


def _kinds(triples: TripleIndex) -> Kinds:
    kinds = []
    above_things = triples.ancestors(DX.THING, W3C.RDFS_SUB_CLASS_OF)
    classes = frozenset(triples.subjects(W3C.RDF_TYPE, W3C.OWL_CLASS)) - above_things
    for iri in sorted(classes):
        broader = triples.ancestors(iri, W3C.RDFS_SUB_CLASS_OF)
        if DX.THING in broader or iri == DX.THING:
            kinds.append(Kind(iri, triples.only(iri, W3C.RDFS_LABEL), _words(triples, iri), broader & classes))
    return Kinds(tuple(kinds))


def _hedges(triples: TripleIndex) -> dict[str, float]:
    weights = {}
    for iri in triples.subjects(W3C.RDF_TYPE, DX.HEDGE):
        text = triples.only(iri, DX.HEDGE_WEIGHT)
        try:
            weight = float(text)
        except ValueError:
            raise OntologyError(f"<{iri}>: the weight of a hedge must be a number, got '{text}'") from None
        if not 0 < weight <= 1:
            raise OntologyError(f"<{iri}>: the weight of a hedge must be above 0 and at most 1, got {weight}")
        weights.update(dict.fromkeys(_words(triples, iri), weight))
    return weights
