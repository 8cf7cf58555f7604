"""Look up everyday words: the kind and the size that a noun stands for, how well it fits a label, and adjectives.

The nouns are the kinds of the TBox and of ``nouns.txt``. A noun of several words is looked up whole before its head
noun: a trash can is a bin, a rice bowl is a bowl.
"""

from __future__ import annotations

from enum import StrEnum
from functools import cached_property
from typing import TYPE_CHECKING

from deixis.ontology.inflection import singulars
from deixis.ontology.lexicon.adjectives import Description, adjectives
from deixis.ontology.things.kinds import Kind, Kinds, plain_name, spaced

if TYPE_CHECKING:
    from deixis.ontology.lexicon.groups import Groups
    from deixis.ontology.things.colours import Colours
    from deixis.ontology.things.sizes import SizeRange, Sizes

SYNONYMS = 0.97
"""Similarity of two words for the same kind."""

STEP = 0.85
"""Factor of the similarity of a noun and a label for each step between them in the taxonomy."""

SIBLINGS = 0.5
"""Similarity of two kinds right below the same specific kind."""

GENERAL = 2
"""Number of broader kinds below which a kind is too general for its members to be siblings: *furniture*, *thing*."""


class Relatedness(StrEnum):
    """The relation of a person's noun to the label of a thing."""

    SAME = "same"
    SYNONYM = "synonym"
    BROADER = "broader"
    NARROWER = "narrower"
    SIBLING = "sibling"
    UNRELATED = "unrelated"


class Lexicon:
    """Nouns with their kinds, sizes and inflection, and adjectives with their dimensions.

    >>> from deixis.ontology.tbox import default_ontology
    >>> lexicon = default_ontology().lexicon
    >>> lexicon.kind_of("rice_bowl").name, lexicon.kind_of("wooden coffee tables").name
    ('Bowl', 'CoffeeTable')
    >>> lexicon.relation("couch", "sofa"), lexicon.relation("chair", "armchair"), lexicon.relation("can", "trash can")
    (<Relatedness.SYNONYM: 'synonym'>, <Relatedness.BROADER: 'broader'>, <Relatedness.UNRELATED: 'unrelated'>)
    """

    def __init__(self, kinds: Kinds, sizes: Sizes, colours: Colours) -> None:
        self._kinds = kinds
        self._sizes = sizes
        self._colours = colours

    @cached_property
    def groups(self) -> Groups:
        """The groups that people sort household things into."""
        from deixis.ontology.lexicon.groups import Groups

        return Groups(self._kinds)

    def knows(self, noun: str) -> bool:
        """Return whether a whole noun, in the singular or the plural, is one of the lexicon.

        Parameters
        ----------
        noun
            A noun phrase without its article.

        Returns
        -------
        bool
            False also where only its head noun is known.

        Examples
        --------
        >>> from deixis.ontology.tbox import default_ontology
        >>> [default_ontology().lexicon.knows(noun) for noun in ("tea towels", "rice bowl")]
        [True, False]
        """
        return any(self._kinds.senses(one) for one in (noun, *singulars(spaced(noun))))

    def singular(self, noun: str) -> str:
        """Return the singular of a noun; the lexicon decides where the spelling leaves it open.

        Parameters
        ----------
        noun
            A noun in the singular or the plural.

        Returns
        -------
        str
            The singular.

        Examples
        --------
        >>> from deixis.ontology.tbox import default_ontology
        >>> [default_ontology().lexicon.singular(noun) for noun in ("cookies", "strawberries", "jeans", "shelves")]
        ['cookie', 'strawberry', 'jeans', 'shelf']
        """
        possible = singulars(noun)
        if len(possible) == 1:
            return possible[0]
        return next((one for one in possible if self._ends_in_a_noun(one)), possible[0])

    def _ends_in_a_noun(self, singular: str) -> bool:
        words = spaced(singular).split()
        return any(self._kinds.senses(" ".join(words[start:])) for start in range(len(words)))

    def senses(self, noun: str) -> tuple[Kind, ...]:
        """Return all kinds that a noun may stand for.

        The longest known end of the noun counts, in the singular or the plural; before *of*, that of its first part.

        Parameters
        ----------
        noun
            A noun phrase without its article.

        Returns
        -------
        tuple of Kind
            The kinds, the usual one first; empty if the lexicon has none.
        """
        return self._kinds.head_noun(plain_name(noun))[0]

    def kind_of(self, noun: str) -> Kind | None:
        """Return the kind that a noun, or else its head noun, stands for.

        Parameters
        ----------
        noun
            A noun phrase without its article.

        Returns
        -------
        Kind or None
            The kind, or None if the lexicon has none.

        Examples
        --------
        >>> from deixis.ontology.tbox import default_ontology
        >>> lexicon = default_ontology().lexicon
        >>> [lexicon.kind_of(noun).label for noun in ("trash can", "cup of tea", "pair of scissors")]
        ['bin', 'cup', 'scissors']
        """
        return next(iter(self.senses(noun)), None)

    def size_of(self, noun: str) -> SizeRange:
        """Return the usual size of what a noun stands for.

        Parameters
        ----------
        noun
            A noun phrase without its article.

        Returns
        -------
        SizeRange
            The size of its kind, its head noun, its class, or else of all things, in metres.

        Examples
        --------
        >>> from deixis.ontology.tbox import default_ontology
        >>> print(default_ontology().lexicon.size_of("grandmother's soup spoon"))
        15 to 20 cm long and 3 to 5.5 cm wide
        """
        kind = self.kind_of(noun)
        return self._sizes.of(kind.iri if kind else None)

    def adjective(self, word: str) -> Description | None:
        """Return the meaning of an adjective in its plain degree.

        Parameters
        ----------
        word
            The adjective.

        Returns
        -------
        Description or None
            Dimension and value, or None for other words.

        Examples
        --------
        >>> from deixis.ontology.tbox import default_ontology
        >>> lexicon = default_ontology().lexicon
        >>> lexicon.adjective("crimson"), lexicon.adjective("spoon")
        (Description(dimension='colour', value='red', sign=0), None)
        """
        colour = self._colours.of_word(word)
        return Description("colour", colour.label) if colour else adjectives().get(spaced(word))

    def adjectives_of(self, dimension: str) -> tuple[str, ...]:
        """Return all adjectives of a dimension.

        Parameters
        ----------
        dimension
            One of :data:`~deixis.ontology.lexicon.adjectives.DIMENSIONS`.

        Returns
        -------
        tuple of str
            The adjectives.

        Examples
        --------
        >>> from deixis.ontology.tbox import default_ontology
        >>> "wooden" in default_ontology().lexicon.adjectives_of("material")
        True
        """
        listed = tuple(word for word, meant in adjectives().items() if meant.dimension == dimension)
        return tuple(dict.fromkeys((*self._colours.words, *listed))) if dimension == "colour" else listed

    def relation(self, noun: str, label: str) -> Relatedness:
        """Return how a noun is related to a label.

        Parameters
        ----------
        noun
            A noun phrase without its article.
        label
            Label of a thing.

        Returns
        -------
        Relatedness
            The relation; ``BROADER`` says that the noun is broader than the label.
        """
        return self._compared(noun, label)[0]

    def similarity(self, noun: str, label: str) -> float:
        """Return how well a person's noun fits the label of a thing.

        The value is 1 for the same word, nearly 1 for synonyms, less by each step from a kind to a broader one, small
        for kinds with a specific broader kind in common (a stool and a bench), and 0 for unrelated words.

        Parameters
        ----------
        noun
            A noun phrase without its article.
        label
            Label of a thing.

        Returns
        -------
        float
            Graded evidence in [0, 1], which is not a probability.

        Examples
        --------
        >>> from deixis.ontology.tbox import default_ontology
        >>> lexicon = default_ontology().lexicon
        >>> pairs = [("sofa", "sofas"), ("couch", "sofa"), ("chair", "office chair"), ("fork", "chair")]
        >>> [round(lexicon.similarity(noun, label), 2) for noun, label in pairs]
        [1.0, 0.97, 0.85, 0.0]
        """
        return self._compared(noun, label)[1]

    def _compared(self, noun: str, label: str) -> tuple[Relatedness, float]:
        plain_noun, plain_label = self._plain(noun), self._plain(label)
        if plain_noun == plain_label:
            return Relatedness.SAME, 1.0
        ours, theirs = self._kinds.head_noun(plain_noun), self._kinds.head_noun(plain_label)
        pairs = (
            self._relation_of(first, self._narrowing(ours[1], first), second, self._narrowing(theirs[1], second))
            for first in ours[0]
            for second in theirs[0]
        )
        return max(pairs, key=lambda found: found[1], default=(Relatedness.UNRELATED, 0.0))

    def _narrowing(self, words: str, kind: Kind) -> bool:
        """Return whether the words before a head noun narrow it down: those of *garbage bin* do not."""
        return bool(words) and kind not in self._kinds.senses(words)

    def _relation_of(self, ours: Kind, we_narrow: bool, theirs: Kind, they_narrow: bool) -> tuple[Relatedness, float]:
        """Relate two kinds; unknown words before a head noun make a kind of its own below that of the head noun."""
        steps = (len(ours.broader) + we_narrow) - (len(theirs.broader) + they_narrow)
        if ours == theirs and we_narrow == they_narrow:
            return (Relatedness.SIBLING, SIBLINGS) if we_narrow else (Relatedness.SYNONYM, SYNONYMS)
        if self._kinds.is_a(ours, theirs) and not they_narrow:
            return Relatedness.NARROWER, STEP ** max(1, steps)
        if self._kinds.is_a(theirs, ours) and not we_narrow:
            return Relatedness.BROADER, STEP ** max(1, -steps)
        common = max((len(self._kinds[iri].broader) for iri in ours.broader & theirs.broader), default=0)
        if common < GENERAL:
            return Relatedness.UNRELATED, 0.0
        apart = len(ours.broader) + len(theirs.broader) - 2 * common
        return Relatedness.SIBLING, SIBLINGS * STEP ** max(0, apart - 2)

    def _plain(self, noun: str) -> str:
        return self.singular(spaced(plain_name(noun)))
