"""Fits graded models of relation words to scenes in which words and boxes are both known.

The unknowns are the values of every term at its knots. What is maximised is the probability that, of all ordered pairs
of a scene, the word was said of the pair of which it was (a conditional logit, McFadden 1974, over the saying model):
that is what grounding has to tell apart. A second contrast, to the other words that might have been said of the same
pair, counts as much as ``word_contrast`` says. A Gaussian prior holds the values at those of the prior models: their
differences from knot to knot to ``1 / strength`` in variance, the values themselves more loosely. Without data the
prior comes back. Terms with a trend keep it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.models.relations import FAMILIES, SAYING, Provenance, RelationModel, RelationModels, Term
from deixis.reasoning.errors import SettingError
from deixis.reasoning.geometry.pairs import PairGeometry
from deixis.reasoning.grounding.evidence.degrees import degree_of_view
from deixis.reasoning.grounding.evidence.pair_features import view
from deixis.reasoning.grounding.fitting.likelihood import Likelihood, SaidPairs
from deixis.reasoning.grounding.fitting.parameters import Layout


def random_scenes(count: int = 200, size: int = 8, seed: int = 1) -> list[NDArray[np.float64]]:
    """Return boxes (size, 2, 2) with centres anywhere in the unit square and extents between 0.02 and 0.3."""
    rng = np.random.default_rng(seed)
    centres = rng.uniform(0.0, 1.0, (count, size, 2))
    halves = rng.uniform(0.01, 0.15, (count, size, 2))
    return list(np.stack([centres - halves, centres + halves], axis=2))


def chance_degree(model: RelationModel, scenes: Iterable[PairGeometry]) -> float:
    """Return mean degree of a model over all ordered pairs of scenes and the words that share it; 1 where there is
    none."""
    words = [word for word, family in FAMILIES.items() if family == model.name] or [SAYING]
    found = []
    for pairs in scenes:
        apart = ~np.eye(len(pairs), dtype=bool)
        found += [degree_of_view(model, view(pairs, word))[apart] for word in words]
    pooled = np.concatenate(found) if found else np.zeros(0)
    return float(pooled.mean()) if pooled.size else 1.0


Array = NDArray[np.float64]

OUTLIER_BOUNDS = (0.001, 0.2)
"""Between these the share of outliers is kept, so that a learned fact weighs against a pair ln 1000 at the most."""


@dataclass(frozen=True, slots=True)
class FitSettings:
    """``strength`` of the prior (1: a difference of 1 between knots costs half a nat), and ``word_contrast``."""

    strength: float = 3.0
    word_contrast: float = 0.0
    iterations: int = 100

    def __post_init__(self) -> None:
        if not 0 < self.strength < np.inf:
            raise SettingError(f"the strength of what is shipped is a number above 0, not {self.strength:g}")
        if not self.word_contrast >= 0 or self.iterations < 1:
            raise SettingError("word_contrast is at least 0, iterations at least 1")


def learn_relations(
    scenes: Sequence[SaidPairs],
    prior: RelationModels,
    settings: FitSettings | None = None,
    sources: Sequence[str] = (),
    version: str = "",
) -> RelationModels:
    """Return the models that fit the scenes and the prior best together, with their provenance.

    Models of which no word was said come back as they were. Raises SettingError for settings that cannot be.
    """
    taught = {
        family: (
            float(
                sum(
                    weight
                    for scene in scenes
                    for word, weight in zip(scene.words, scene.weights.tolist(), strict=True)
                    if FAMILIES.get(word) == family
                )
            )
        )
        for family in {*FAMILIES.values()}
    }
    total = sum(taught.values())
    if total == 0:
        return prior
    chosen = settings or FitSettings()
    names = [*sorted(name for name, count in taught.items() if count > 0), SAYING]
    layout = Layout([extended(prior[name]) for name in names])
    values = _maximise(Likelihood(scenes, layout, chosen.word_contrast), layout, chosen)
    made = datetime.now(UTC)
    where = {each: Provenance(tuple(sources), n, made, version) for each, n in {**taught, SAYING: total}.items()}
    fitted = [_fitted(model, values, layout, scenes, where[model.name]) for model in layout.models]
    return prior.replaced(*fitted)


def _fitted(
    model: RelationModel, values: Array, layout: Layout, scenes: Sequence[SaidPairs], where: Provenance
) -> RelationModel:
    """Return the model with new values, each term's best shifted to 0.

    What the shifts of a word and of the saying model take from the degrees, the outliers take over, so that their
    likelihood ratio stays what was fitted.
    """
    own = [values[layout.slices[model.name, term.feature]] for term in model.terms]
    spoken = [values[layout.slices[SAYING, term.feature]] for term in layout.model(SAYING).terms]
    shift = sum(float(part.max()) for part in (own if model.name == SAYING else own + spoken))
    odds = model.outliers / (1 - model.outliers) * float(np.exp(-shift))
    outliers = float(np.clip(odds / (1 + odds), *OUTLIER_BOUNDS))
    terms = tuple(_term(term, part) for term, part in zip(model.terms, own, strict=True))
    found = RelationModel(model.name, terms, outliers, 1.0, where)
    chance = max(chance_degree(found, (scene.pairs for scene in scenes)), 1e-6)
    return RelationModel(model.name, terms, outliers, chance, where)


_UNIT, _SIGNED = np.linspace(0, 1, 5), np.array([-1.0, -0.5, -0.25, 0.0, 0.25, 0.5, 1.0])
_LEVEL = np.array([-1.0, -0.5, 0.0, 0.33, 0.67, 1.0, 1.5, 2.0])
_KNOTS = {
    "direction": {
        "lead": _SIGNED,
        "forward": _SIGNED,
        "lateral": _UNIT,
        "alike": _UNIT,
        "clear": _SIGNED,
        "trail": _SIGNED,
        "gap": _UNIT,
    },
    SAYING: {"crowd": _UNIT},
    "support": {
        **dict.fromkeys(("across", "along", "bears", "spans", "gap"), _UNIT),
        **dict.fromkeys(("rest", "upper", "lower", "level"), _SIGNED),
        "foot": _LEVEL,
    },
}


def extended(model: RelationModel) -> RelationModel:
    """Return the same model with more knots, and with the features that the prior is blind to as terms of 0."""
    finer = _KNOTS[model.name if model.name in _KNOTS else "direction"]
    known = {term.feature: term for term in model.terms}
    terms = []
    for feature in dict.fromkeys([*known, *finer]):
        term = known.get(feature, Term(feature, (-1.0, 2.0), (0.0, 0.0)))
        knots = np.unique(np.concatenate([finer.get(feature, np.zeros(0)), term.knots if feature in known else []]))
        values = np.interp(knots, term.knots, term.values)
        terms.append(Term(feature, tuple(knots.tolist()), tuple(values.tolist()), term.trend))
    return RelationModel(model.name, tuple(terms), model.outliers, model.chance, model.provenance)


def _maximise(likelihood: Likelihood, layout: Layout, settings: FitSettings) -> Array:
    from scipy.optimize import minimize

    steps, precision = layout.steps(), settings.strength * layout.precision()

    def loss(unknowns: Array) -> tuple[float, Array]:
        values = steps @ unknowns
        found, gradient = likelihood(values)
        held = precision @ (values - layout.prior)
        return 0.5 * float((values - layout.prior) @ held) - found, steps.T @ (held - gradient)

    start = np.linalg.solve(steps, layout.prior)
    options = {"maxiter": settings.iterations}
    found = minimize(loss, start, jac=True, method="L-BFGS-B", bounds=layout.bounds(), options=options)
    values: Array = steps @ found.x
    return values


def _term(term: Term, values: Array) -> Term:
    """Return the term with new values, shifted so that its best is 0."""
    shifted = values - values.max()
    return Term(term.feature, term.knots, tuple(np.minimum(shifted, 0.0).tolist()), term.trend)
