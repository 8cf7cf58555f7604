"""Meanings of words: graded models of relation words (shipped or learned), sizes of kinds, and weights of evidence.

All terms follow one rule: 1 at the prototype, one half at the border to the neighbouring word, one twentieth at the
other extreme. A comment beside each term tells where the prototype and the border are. Directions fall off with the
angle like a von Mises density, and reach beyond the border, because people say *left* more often than *top left*. The
order of edges is that of semi-intervals (Freksa 1992): the prototype is *clear* of the object, and its neighbourhood
is the same order of starts and of ends. The choice of the subject of a pair follows Talmy (1978): the reference
object is the larger one. It is chosen by size (Luce's rule), so that the degree of a pair of sizes a and b is b / (a
+ b).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from deixis.answers import Answer, count
from deixis.ontology.models.relations import (
    FAMILIES,
    GRADED_FAMILIES,
    SAYING,
    RelationModel,
    RelationModels,
    Term,
    Trend,
)
from deixis.ontology.models.sizes import SizeModel
from deixis.reasoning.grounding.evidence.properties.unary import UnaryWeights
from deixis.reasoning.grounding.evidence.words.pair_features import UNKNOWN_AIM

BORDER, EXTREME = float(np.log(0.5)), float(np.log(0.05))
OUTLIERS = 0.01
"""Share of facts that are stated independently of the pair, which limits the evidence of a fact to ln 100 nats against
any pair."""

SECTOR = float(np.radians(65))
"""Angle from the axis of *left* at which it fits half as well: people seldom say *top left*, and use *left* for it."""

CHANCE = {
    **{"horizontal": 0.09, "vertical": 0.091, "diagonal": 0.05, "support": 0.028, SAYING: 0.198},
    **{"nearness": 0.309, "adjacency": 0.198, "farness": 0.305, "height": 0.523, "containment": 0.03, "contact": 0.14},
    **{"along": 0.197, "crossing": 0.083, "parallels": 0.559, "alignment": 0.283, "level": 0.178, "comparison": 0.567},
    **{"facing": 0.27, "pointing": 0.21, "opposition": 0.187},
}
"""Mean degrees of ordered pairs of random boxes: :func:`deixis.reasoning.grounding.fitting.fit.random_scenes`, seed
1."""


def falling_with_angle(half: float) -> Term:
    """Return the term of ``deviation``: exp(k (cos a - 1)), one half at ``half`` radians.

    Parameters
    ----------
    half
        Angle in radians at which the degree is one half.

    Returns
    -------
    Term
        Term with knots in radians and values in nats.
    """
    angles = np.radians([0.0, 22.5, 45.0, 67.5, 90.0, 135.0, 180.0])
    values = BORDER * (1 - np.cos(angles)) / (1 - np.cos(half))
    return Term("deviation", tuple(angles.tolist()), tuple(np.maximum(values, 2 * EXTREME).tolist()), Trend.FALLING)


def aim_term(half: float, chance: float) -> Term:
    """Return the term of ``aim``: one half at ``half`` radians, and the degree of a random pair where it is unknown.

    Parameters
    ----------
    half
        Angle in radians at which the degree is one half.
    chance
        Degree of a random pair, above 0.

    Returns
    -------
    Term
        Term with knots in radians and values in nats.
    """
    fall = falling_with_angle(half)
    return Term("aim", (UNKNOWN_AIM, *fall.knots), (float(np.log(chance)), *fall.values))


@lru_cache(maxsize=1)
def own_frame_model() -> RelationModel:
    """Return the model of directions from the front of a thing: *in front of the chair*.

    Returns
    -------
    RelationModel
        Model with the term ``aim``, computed once.
    """
    gap = Term("gap", (0.0, 2 / 3, 1.0), (0.0, BORDER, EXTREME), Trend.FALLING)
    return RelationModel("own frame", (aim_term(np.pi / 4, CHANCE["facing"]), gap), OUTLIERS, CHANCE["facing"])


@lru_cache(maxsize=1)
def beneath_model() -> RelationModel:
    """Return the model of *under* for what stands below a thing, between its legs: *the bin is under the desk*.

    Returns
    -------
    RelationModel
        Model of a subject within the object's outline that is not higher than the object and reaches down beside it,
        computed once.
    """
    terms = (
        Term("across", (0.0, 0.5, 1.0), (EXTREME, BORDER, 0.0), Trend.RISING),
        Term("along", (0.0, 0.5, 1.0), (EXTREME, BORDER, 0.0), Trend.RISING),
        # one half: higher than the object by an eighth of its height
        Term("roof", (-0.5, -0.125, 0.0, 1.0), (EXTREME, BORDER, 0.0, 0.0), Trend.RISING),
        # prototype: in the lower quarter of the object; one half: at half of its height, as what lies in a tray
        Term("floor", (0.0, 0.25, 0.5, 1.0), (0.0, 0.0, BORDER, EXTREME), Trend.FALLING),
    )
    return RelationModel("beneath", terms, OUTLIERS, CHANCE["containment"])


def direction_terms(half: float, abreast: Trend) -> tuple[Term, ...]:
    """Return the terms of a direction word that fits half as well at ``half`` radians from its axis.

    Parameters
    ----------
    half
        Angle in radians from the axis of the word at which the degree is one half.
    abreast
        Trend of the degree with the share of the extents across that overlap.

    Returns
    -------
    tuple of Term
        Terms with values in nats.
    """
    beside = (BORDER, 0.0) if abreast is Trend.RISING else (0.0, BORDER)
    return (
        falling_with_angle(half),
        # prototype: clear of the object; one half: they overlap by a mean size; extreme: entirely on the other side
        Term("clear", (-1.0, -0.5, 0.0, 1.0), (EXTREME, BORDER, 0.0, 0.0), Trend.RISING),
        # prototype: both ends farther along, by a quarter of the mean size; one half: two starts or two ends are level
        Term("trail", (-1.0, 0.0, 0.2, 1.0), (EXTREME, BORDER, 0.0, 0.0), Trend.RISING),
        # prototype: within the breadth of the other, or (diagonals) beyond it
        Term("abreast", (0.0, 1.0), beside, abreast),
        # prototype: touching; one half: a gap of twice the mean size
        Term("gap", (0.0, 2 / 3, 1.0), (0.0, BORDER, EXTREME), Trend.FALLING),
    )


def support_terms() -> tuple[Term, ...]:
    """Return the terms of ``on``: within the object's outline, the foot on it, and higher where heights are known.

    Returns
    -------
    tuple of Term
        Terms with values in nats.
    """
    return (
        Term("across", (0.0, 0.5, 1.0), (EXTREME, BORDER, 0.0), Trend.RISING),
        # a thing that extends below the object is not on it: one half at a quarter of the depth; above, it may stand
        Term("foot", (-0.5, -0.25, 0.0, 1.0, 1.5, 2.0), (EXTREME, BORDER, 0.0, 0.0, BORDER, EXTREME)),
        # things in contact touch in every view: one half at a ninth of the mean size, the extreme at a third
        Term("gap", (0.0, 0.1, 0.25), (0.0, BORDER, EXTREME), Trend.FALLING),
        Term("rise", (-1.0, 0.0, 0.2, 1.0), (EXTREME, BORDER, 0.0, 0.0), Trend.RISING),
    )


def saying_terms() -> tuple[Term, ...]:
    """Return the terms of ``saying``: neighbours ten times as often as the farthest, the larger as the reference.

    A speaker chooses a landmark that singles out the subject, and words that fit a thing near it: of the dots of
    OneCommon, nine of ten are the nearest one in the half plane that the word names.

    Returns
    -------
    tuple of Term
        Terms with values in nats.
    """
    sizes = np.linspace(-1.0, 1.0, 9)
    chosen = np.log(np.maximum((1 + sizes) / 2, 0.05))
    return (
        Term("crowd", (0.0, 1.0), (0.0, float(np.log(1 / 10))), Trend.FALLING),
        Term("figure", tuple(sizes.tolist()), tuple((chosen - chosen.max()).tolist()), Trend.RISING),
    )


def graded_terms() -> dict[str, tuple[Term, ...]]:
    """Return the terms of the words beside the ten, by model.

    Returns
    -------
    dict
        Terms by the name of the model.
    """
    return {
        # prototype: touching or nearly; one half: a gap of three mean sizes, or a third of the other things nearer
        "nearness": (
            Term("gap", (0.0, 0.5, 0.75, 0.95), (0.0, 0.0, BORDER, EXTREME), Trend.FALLING),
            Term("crowd", (0.0, 1 / 3, 1.0), (0.0, BORDER, EXTREME), Trend.FALLING),
        ),
        # prototype: touching; one half: a gap of one mean size, or a quarter of the other things nearer
        "adjacency": (
            Term("gap", (0.0, 0.25, 0.5, 0.9), (0.0, 0.0, BORDER, EXTREME), Trend.FALLING),
            Term("crowd", (0.0, 0.25, 1.0), (0.0, BORDER, EXTREME), Trend.FALLING),
        ),
        # prototype: two thirds of the others are nearer; one half: a gap of three mean sizes, or a third of them nearer
        "farness": (
            Term("gap", (0.0, 0.5, 0.75, 0.85), (EXTREME, EXTREME, BORDER, 0.0), Trend.RISING),
            Term("crowd", (0.0, 1 / 3, 2 / 3), (EXTREME, BORDER, 0.0), Trend.RISING),
        ),
        # prototype: both ends higher, by a quarter of the mean height; one half: one end is level
        "height": tuple(
            Term(feature, (-1.0, 0.0, 0.2, 1.0), (EXTREME, BORDER, 0.0, 0.0), Trend.RISING)
            for feature in ("rise", "trail")
        ),
        # prototype: within the outline, reaching down, and not lower than the object; one half: half outside, only at
        # the rim, or lower by an eighth of the smaller height
        "containment": (
            Term("across", (0.0, 0.5, 1.0), (EXTREME, BORDER, 0.0), Trend.RISING),
            Term("along", (0.0, 0.5, 1.0), (EXTREME, BORDER, 0.0), Trend.RISING),
            Term("depth", (-0.5, 0.1, 0.4, 2.0), (EXTREME, BORDER, 0.0, 0.0), Trend.RISING),
            Term("floor", (-0.4, -0.125, 0.0, 1.0), (EXTREME, BORDER, 0.0, 0.0), Trend.RISING),
        ),
        # prototype: no gap; one half: a gap of a twentieth of the mean size
        "contact": (
            Term("gap", (0.0, 0.05, 0.25), (0.0, BORDER, EXTREME), Trend.FALLING),
            Term("lift", (0.0, 0.05, 0.25), (0.0, BORDER, EXTREME), Trend.FALLING),
        ),
        "along": (
            Term("gap", (0.0, 0.25, 0.5, 0.9), (0.0, 0.0, BORDER, EXTREME), Trend.FALLING),
            Term("coaxial", (-1.0, 0.0, 0.3), (EXTREME, BORDER, 0.0), Trend.RISING),
        ),
        "crossing": (
            Term("gap", (0.0, 0.1, 0.25), (0.0, BORDER, EXTREME), Trend.FALLING),
            Term("coaxial", (-0.3, 0.0, 1.0), (0.0, BORDER, EXTREME), Trend.FALLING),
        ),
        "parallels": (Term("coaxial", (-1.0, 0.0, 0.3), (EXTREME, BORDER, 0.0), Trend.RISING),),
        # prototype: the centres are level on one axis; one half: they are off by half of what makes two boxes touch
        "alignment": (Term("lateral", (0.0, 1 / 3, 0.5), (0.0, BORDER, EXTREME), Trend.FALLING),),
        "level": (Term("lateral", (0.0, 1 / 3, 0.5), (0.0, BORDER, EXTREME), Trend.FALLING),),
        # prototype: longer by a fifth; one half: equal
        "comparison": (Term("excess", (-0.5, 0.0, 0.1, 1.0), (EXTREME, BORDER, 0.0, 0.0), Trend.RISING),),
        "facing": (aim_term(np.pi / 4, CHANCE["facing"]),),
        "pointing": (aim_term(np.pi / 9, CHANCE["pointing"]),),
        "opposition": (aim_term(np.pi / 6, CHANCE["opposition"]),),
    }


@lru_cache(maxsize=1)
def shipped_models() -> RelationModels:
    """Return the shipped models of all words, and of the pairs that people mention.

    Returns
    -------
    RelationModels
        Models by family, computed once.

    Examples
    --------
    >>> [term.feature for term in shipped_models()["support"].terms]
    ['across', 'foot', 'gap', 'rise']
    """
    terms = {
        "horizontal": direction_terms(SECTOR, Trend.RISING),
        "vertical": direction_terms(SECTOR, Trend.RISING),
        "diagonal": direction_terms(SECTOR / 2, Trend.FALLING),
        "support": support_terms(),
        SAYING: saying_terms(),
        **graded_terms(),
    }
    names = (*dict.fromkeys((*FAMILIES.values(), *GRADED_FAMILIES.values())), SAYING)
    return RelationModels({name: RelationModel(name, terms[name], OUTLIERS, CHANCE[name]) for name in names})


@dataclass(frozen=True, eq=False, repr=False)
class Meaning(Answer):
    """Models of words and sizes, and weights of evidence; by default, the shipped ones.

    Attributes
    ----------
    models
        Models of the relation words; None for the shipped ones.
    sizes
        Learned sizes by class IRI, used instead of the usual sizes of the ontology.
    graded
        False to read words literally: the exact relation of a pair is the word, implies it, or neither.
    weights
        Factors of labels, sizes and colours.

    Examples
    --------
    >>> meaning = Meaning()
    >>> meaning
    <Meaning graded words as shipped, usual sizes>
    >>> meaning.to_text().splitlines()[1]
    'horizontal       shipped, from prototypes'
    """

    models: RelationModels | None = None
    sizes: Mapping[str, SizeModel] = field(default_factory=dict)
    graded: bool = True
    weights: UnaryWeights = field(default_factory=UnaryWeights)

    def summary(self) -> str:
        """Return how words are read, how many models were learned, and the number of kinds with learned sizes."""
        learned = [model for model in self.models_in_force.models.values() if model.provenance.made is not None]
        origin = count(len(learned), "learned model") if learned else "as shipped"
        words = f"graded words {'with ' if learned else ''}{origin}" if self.graded else "literal words"
        sizes = f"learned sizes of {count(len(self.sizes), 'kind')}" if self.sizes else "usual sizes"
        return f"{words}, {sizes}"

    @property
    def models_in_force(self) -> RelationModels:
        """Models of the relation words, which are the shipped ones if ``models`` is None.

        Examples
        --------
        >>> meaning = Meaning()
        >>> meaning.models is None, sorted(meaning.models_in_force.models)[:2]
        (True, ['adjacency', 'alignment'])
        """
        return self.models or shipped_models()


LITERAL = Meaning(graded=False)
"""Literal words, with the shipped sizes and weights."""

SHIPPED = Meaning()
"""Shipped models, sizes and weights."""
