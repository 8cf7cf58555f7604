"""Meanings in force: graded models of relation words (shipped or learned), sizes of kinds, and weights of evidence.

One rule makes every term: 1 at the prototype, a half at the border to the neighbouring word, a twentieth at the other
extreme. Where the prototype and the border lie is said beside each term. Directions fall off by angle as a von Mises
density does; the order of edges is that of semi-intervals (Freksa 1992): *clear* of the object is the prototype, the
same order of starts and of ends the neighbourhood. Which of two things is the subject follows Talmy (1978): the
reference object is the larger one; it is chosen by size (Luce's rule), so that a pair's degree is b / (a + b).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from deixis.ontology.models.relations import FAMILIES, SAYING, RelationModel, RelationModels, Term, Trend
from deixis.ontology.models.sizes import SizeModel
from deixis.reasoning.grounding.evidence.unary import UnaryWeights

BORDER, EXTREME = float(np.log(0.5)), float(np.log(0.05))
OUTLIERS = 0.01
"""Share of facts that are said of a pair whatever it is like: no fact speaks more than ln 100 against its best pair."""

CHANCE = {"horizontal": 0.074, "vertical": 0.074, "diagonal": 0.038, "support": 0.028, SAYING: 0.303}
"""Mean degrees of ordered pairs of random boxes: :func:`deixis.reasoning.grounding.fitting.fit.random_scenes`, seed
1."""


def falling_with_angle(half: float) -> Term:
    """Return ``deviation``: exp(k (cos a - 1)), a half at ``half`` radians."""
    angles = np.radians([0.0, 22.5, 45.0, 67.5, 90.0, 135.0, 180.0])
    values = BORDER * (1 - np.cos(angles)) / (1 - np.cos(half))
    return Term("deviation", tuple(angles.tolist()), tuple(np.maximum(values, 2 * EXTREME).tolist()), Trend.FALLING)


def direction_terms(half: float, abreast: Trend) -> tuple[Term, ...]:
    """Return the terms of a direction word whose neighbours' borders lie ``half`` radians off."""
    beside = (BORDER, 0.0) if abreast is Trend.RISING else (0.0, BORDER)
    return (
        falling_with_angle(half),
        # clear of the object; half where they overlap by a mean size; wholly past it the wrong way
        Term("clear", (-1.0, -0.5, 0.0, 1.0), (EXTREME, BORDER, 0.0, 0.0), Trend.RISING),
        # both ends farther along, by a quarter of the mean size; half where two starts or two ends are level
        Term("trail", (-1.0, 0.0, 0.2, 1.0), (EXTREME, BORDER, 0.0, 0.0), Trend.RISING),
        # within the other's breadth, or (diagonals) beyond it
        Term("abreast", (0.0, 1.0), beside, abreast),
        # touching; half at a gap of twice the mean size
        Term("gap", (0.0, 2 / 3, 1.0), (0.0, BORDER, EXTREME), Trend.FALLING),
    )


def support_terms() -> tuple[Term, ...]:
    """Return the terms of ``on``: within the bearer's outline, its foot there, and higher where heights are known."""
    return (
        Term("across", (0.0, 0.5, 1.0), (EXTREME, BORDER, 0.0), Trend.RISING),
        # what reaches below its bearer is not borne: half at a quarter of the depth; what reaches above may stand on it
        Term("foot", (-0.5, -0.25, 0.0, 1.0, 1.5, 2.0), (EXTREME, BORDER, 0.0, 0.0, BORDER, EXTREME)),
        # things in contact touch from wherever they are seen: half at a ninth of the mean size, the extreme at a third
        Term("gap", (0.0, 0.1, 0.25), (0.0, BORDER, EXTREME), Trend.FALLING),
        Term("rise", (-1.0, 0.0, 0.2, 1.0), (EXTREME, BORDER, 0.0, 0.0), Trend.RISING),
    )


def saying_terms() -> tuple[Term, ...]:
    """Return which pairs are spoken of: neighbours, three times as readily as the farthest; the larger as the
    reference."""
    sizes = np.linspace(-1.0, 1.0, 9)
    chosen = np.log(np.maximum((1 + sizes) / 2, 0.05))
    return (
        Term("crowd", (0.0, 1.0), (0.0, float(np.log(1 / 3))), Trend.FALLING),
        Term("figure", tuple(sizes.tolist()), tuple((chosen - chosen.max()).tolist()), Trend.RISING),
    )


@lru_cache(maxsize=1)
def shipped_models() -> RelationModels:
    """Return the models of all ten words, and of what is spoken of.

    >>> [term.feature for term in shipped_models()["support"].terms]
    ['across', 'foot', 'gap', 'rise']
    """
    terms = {
        "horizontal": direction_terms(np.pi / 4, Trend.RISING),
        "vertical": direction_terms(np.pi / 4, Trend.RISING),
        "diagonal": direction_terms(np.pi / 8, Trend.FALLING),
        "support": support_terms(),
        SAYING: saying_terms(),
    }
    names = (*dict.fromkeys(FAMILIES.values()), SAYING)
    return RelationModels({name: RelationModel(name, terms[name], OUTLIERS, CHANCE[name]) for name in names})


@dataclass(frozen=True, eq=False)
class Meaning:
    """What grounding goes by beside the script and the scene; the default is what is shipped.

    ``models`` are those of the relation words (None: the shipped ones); ``sizes``, by class IRI, take the place of the
    usual sizes of the TBox. ``graded`` False takes words literally: a pair bears the word's name, implies it, or not.
    """

    models: RelationModels | None = None
    sizes: Mapping[str, SizeModel] = field(default_factory=dict)
    graded: bool = True
    weights: UnaryWeights = field(default_factory=UnaryWeights)


LITERAL = Meaning(graded=False)
"""Crisp words, and all the rest as shipped."""

SHIPPED = Meaning()
