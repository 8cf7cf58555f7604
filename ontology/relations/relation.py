"""Relation words and their meaning: a reading, an inverse, and the atoms of the rectangle algebra that they admit."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property
from typing import TYPE_CHECKING

from deixis.errors import OntologyError, UnknownTermError
from deixis.ontology.rdf.vocabulary import DX, W3C
from deixis.ontology.relations.allen import SYMBOLS, Allen, allen_mask
from deixis.spelling import nearest

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from deixis.ontology.rdf.triple_index import TripleIndex


class Reading(StrEnum):
    """The readings of relation words: wide and exact for the ten, graded for all others."""

    WIDE = "wide"  # in a script: constrains the axis that the word names, and leaves the other one open
    EXACT = "exact"  # between two boxes: one of ten names, of which each pair of boxes has exactly one
    GRADED = "graded"  # of words beside the ten: a graded model says how well the word fits a pair


@dataclass(frozen=True, slots=True, repr=False)
class Relation:
    """A relation word in one reading, as stated in the TBox.

    ``x_atoms`` and ``y_atoms`` are 13-bit masks of Allen relations (bit = code); their product is the set of
    rectangle-algebra atoms that the relation admits. ``z_atoms`` decides instead where heights are known; 0 means that
    heights decide nothing. ``broader`` names the relations that this one implies, ``index`` is its bit in a relation
    set. The atoms of a relation in the graded reading are necessary for it, not sufficient. ``by_model`` is True
    if only its graded model decides whether it holds, since no exact relation implies it.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> left = default_ontology().relations["left"]
    >>> left.word, left.phrase, str(left.reading)
    ('left', 'left of', 'wide')
    >>> left.symmetric, left.is_strict_order, left.bit == 1 << left.index, left.admits().shape
    (False, True, True, (13, 13))
    """

    name: str  # 'top_left', 'exactly_top_left'
    iri: str
    index: int
    word: str = field(compare=False)  # 'top_left' in both readings, as the paper writes it
    reading: Reading = field(compare=False)
    inverse: str = field(compare=False)
    transitive: bool = field(compare=False)
    x_atoms: int = field(compare=False)
    y_atoms: int = field(compare=False)
    z_atoms: int = field(compare=False)
    broader: frozenset[str] = field(compare=False)
    phrase: str = field(compare=False)
    words: tuple[str, ...] = field(compare=False)
    by_model: bool = field(compare=False, default=False)

    def __repr__(self) -> str:
        return f"<Relation {self.name} ({self.reading.value})>"

    def __str__(self) -> str:
        return self.name

    @property
    def bit(self) -> int:
        """Bit mask with only the bit of this relation set."""
        return 1 << self.index

    @property
    def symmetric(self) -> bool:
        """True if the relation is its own inverse."""
        return self.inverse == self.name

    @property
    def is_strict_order(self) -> bool:
        """True if nothing has the relation to itself, as no transitive relation with another inverse allows."""
        return self.transitive and not self.symmetric

    def admits(self) -> NDArray[np.bool_]:
        """Return the admitted atoms of the rectangle algebra.

        Returns
        -------
        ndarray
            Boolean array of shape (13, 13): Allen codes of the axes x and y.
        """
        import numpy as np

        codes = np.arange(13)
        return ((self.x_atoms >> codes & 1)[:, None] & (self.y_atoms >> codes & 1)[None, :]).astype(bool)


class Relations(Mapping[str, Relation]):
    """All relations by name, in the order of their indices; an unknown name raises an error that suggests a known one.

    >>> from deixis.ontology.tbox import default_ontology
    >>> relations = default_ontology().relations
    >>> relations["left"].inverse, relations["left"].transitive
    ('right', True)
    >>> relations["lefft"]
    Traceback (most recent call last):
        ...
    deixis.errors.UnknownTermError: there is no relation 'lefft'; did you mean 'left'?
    """

    def __init__(self, relations: tuple[Relation, ...]) -> None:
        self._all = relations
        self._by_name = {relation.name: relation for relation in relations}
        for relation in relations:
            for other in (relation.inverse, *relation.broader):
                if other not in self._by_name:
                    raise OntologyError(f"relation '{relation.name}' refers to '{other}', which is not a relation")

    def __getitem__(self, name: str) -> Relation:
        try:
            return self._by_name[name]
        except KeyError:
            hint = nearest(name, self._by_name)
            raise UnknownTermError(
                f"there is no relation '{name}'" + (f"; did you mean '{hint}'?" if hint else "")
            ) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._by_name)

    def __len__(self) -> int:
        return len(self._all)

    def of_reading(self, reading: Reading) -> tuple[Relation, ...]:
        """Return the relations of one reading.

        Parameters
        ----------
        reading
            The reading.

        Returns
        -------
        tuple of Relation
            The relations, by index.
        """
        return tuple(relation for relation in self._all if relation.reading is reading)

    def members(self, mask: int) -> tuple[Relation, ...]:
        """Return the relations in a relation set.

        Parameters
        ----------
        mask
            Bit mask over the relations.

        Returns
        -------
        tuple of Relation
            The relations, by index.
        """
        return tuple(relation for relation in self._all if mask >> relation.index & 1)

    @cached_property
    def by_word(self) -> dict[str, Relation]:
        """Relations by each phrase that a script may use, case-folded, single-spaced and without articles."""
        words: dict[str, Relation] = {}
        for relation in self._all:
            for word in relation.words:
                plain = plain_phrase(word)
                other = words.setdefault(plain, relation)
                if other is not relation:
                    raise OntologyError(
                        f"the word '{plain}' stands for both '{other}' and '{relation}'; keep it for one of them"
                    )
        return words

    def wide(self, exact: Relation) -> Relation:
        """Return the wide relation of the same word.

        Parameters
        ----------
        exact
            The exact relation.

        Returns
        -------
        Relation
            The wide relation.
        """
        if exact.reading is Reading.GRADED:
            return exact
        return self._by_name[exact.word]

    def paper_word(self, relation: Relation) -> str | None:
        """Return the one of the ten words that a relation has or implies.

        Parameters
        ----------
        relation
            The relation.

        Returns
        -------
        str or None
            The word, such as *top* for *behind*, or None.
        """
        if relation.reading is not Reading.GRADED:
            return relation.word
        wide = [name for name in sorted(relation.broader) if self._by_name[name].reading is Reading.WIDE]
        return wide[0] if wide else None

    @cached_property
    def paper_labels(self) -> tuple[tuple[str, ...], NDArray[np.int8]]:
        """The ten words, and the position of each relation's word among them; -1 for relations without one."""
        import numpy as np

        labels = tuple(relation.word for relation in self.of_reading(Reading.EXACT))
        words = (self.paper_word(relation) for relation in self.values())
        return labels, np.array([-1 if word is None else labels.index(word) for word in words], dtype=np.int8)

    def exact(self, wide: Relation) -> Relation:
        """Return the exact relation of the same word.

        Parameters
        ----------
        wide
            A relation in any reading.

        Returns
        -------
        Relation
            The exact relation, or the graded one, which is the only reading of its word.
        """
        if wide.reading is Reading.GRADED:
            return wide
        return next(r for r in self._all if r.word == wide.word and r.reading is Reading.EXACT)

    @cached_property
    def degrees(self) -> NDArray[np.float64]:
        """Degree to which each relation holds of a pair with a given exact relation, shape (relations, relations).

        ``degrees[stated, name]`` is 1 if both are the same word and ``name`` is exact, 0.5 if ``name`` implies the
        stated wide relation of another word, and 0 otherwise. Columns of wide relations are 0, since the relation of a
        pair is always an exact one. A stated exact relation holds fully or not at all. A graded word that implies a
        wide one (*behind*) has the degrees of that one; other graded words have none.
        """
        import numpy as np

        table = np.zeros((len(self._all), len(self._all)))
        for name in self.of_reading(Reading.EXACT):
            table[name.index, name.index] = 1.0
            for broader in name.broader:
                same_word = self._by_name[broader].word == name.word
                table[self._by_name[broader].index, name.index] = 1.0 if same_word else 0.5
        for word in self.of_reading(Reading.GRADED):
            wide = [self._by_name[name] for name in word.broader if self._by_name[name].reading is Reading.WIDE]
            if wide:
                table[word.index] = np.min([table[relation.index] for relation in wide], axis=0)
        return table


def plain_phrase(words: str) -> str:
    """Return a phrase in the form that scripts are matched against: case-folded, without articles and underscores.

    Parameters
    ----------
    words
        The phrase.

    Returns
    -------
    str
        The plain form.

    Examples
    --------
    >>> plain_phrase("To the  Left_of")
    'to left of'
    """
    return " ".join(w for w in words.casefold().replace("_", " ").split() if w not in ARTICLES)


ARTICLES = frozenset({"the", "a", "an"})


def relation_from_triples(iri: str, triples: TripleIndex, index: int) -> Relation:
    """Build a relation from the statements about it.

    Parameters
    ----------
    iri
        IRI of the relation.
    triples
        The TBox.
    index
        Index of the relation in its vocabulary.

    Returns
    -------
    Relation
        The relation.

    Raises
    ------
    OntologyError
        If a statement is missing.
    """
    label = triples.only(iri, W3C.RDFS_LABEL)
    reading = READINGS[DX(triples.only(iri, DX.READING))]
    broader = [
        parent for parent in triples.ancestors(iri, W3C.RDFS_SUB_PROPERTY_OF) if triples.values(parent, DX.READING)
    ]
    phrase = triples.only(iri, DX.PHRASE)
    name = _name(iri)
    # An exact relation has the word of its direct wide parent.
    if reading is not Reading.EXACT:
        word = name
    else:
        direct = [p for p in triples.values(iri, W3C.RDFS_SUB_PROPERTY_OF) if p in broader]
        if len(direct) != 1:
            raise OntologyError(f"the exact relation <{iri}> must be a sub-property of exactly one wide relation")
        word = _name(direct[0])
    # OWL may state an inverse from either side; a symmetric property is its own.
    symmetric = W3C.OWL_SYMMETRIC_PROPERTY in triples.values(iri, W3C.RDF_TYPE)
    stated = (
        {iri} if symmetric else {*triples.values(iri, W3C.OWL_INVERSE_OF), *triples.subjects(W3C.OWL_INVERSE_OF, iri)}
    )
    if len(stated) != 1:
        raise OntologyError(f"<{iri}> must have exactly one owl:inverseOf, got {len(stated)}")
    inverse = _name(stated.pop())
    return Relation(
        name=name,
        word=word,
        iri=iri,
        reading=reading,
        index=index,
        inverse=inverse,
        transitive=W3C.OWL_TRANSITIVE_PROPERTY in triples.values(iri, W3C.RDF_TYPE),
        x_atoms=_atoms(iri, DX.ADMITS_ON_X, triples),
        y_atoms=_atoms(iri, DX.ADMITS_ON_Y, triples),
        z_atoms=_atoms(iri, DX.DECIDED_ON_Z, triples),
        broader=frozenset(_name(parent) for parent in broader),
        phrase=phrase,
        # Of a graded relation, only the phrase and its variants are words of scripts: "above" alone means top.
        words=tuple(
            dict.fromkeys(
                (*(() if reading is Reading.GRADED else (label,)), phrase, *triples.values(iri, W3C.SKOS_ALT_LABEL))
            )
        ),
        by_model=reading is Reading.GRADED and all(triples.only(p, DX.READING) == DX.GRADED for p in broader),
    )


READINGS = {DX.WIDE: Reading.WIDE, DX.EXACT: Reading.EXACT, DX.GRADED: Reading.GRADED}
"""Readings by the IRIs of their individuals."""


def _name(iri: str) -> str:
    """Return the local part of an IRI in snake case: ``top_left`` for ``…#topLeft``."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", iri.rpartition("#")[2]).lower()


def _atoms(iri: str, prop: DX, triples: TripleIndex) -> int:
    symbols = [triples.only(allen, DX.ALLEN_SYMBOL) for allen in triples.values(iri, prop)]
    unknown = [symbol for symbol in symbols if symbol not in SYMBOLS]
    if unknown:
        raise OntologyError(f"<{iri}> admits '{unknown[0]}', which is not the symbol of an Allen relation")
    return allen_mask(Allen(SYMBOLS.index(symbol)) for symbol in symbols)
