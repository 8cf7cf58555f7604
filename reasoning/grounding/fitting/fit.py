"""Fits graded models of relation words to scenes in which words and boxes are both known.

The unknowns are the values of every term at its knots. What is maximised is the probability that, of all ordered pairs
of a scene, the word was said of the pair of which it was (a conditional logit, McFadden 1974, over the saying model):
that is what grounding has to tell apart. A second contrast, to the other words that might have been said of the same
pair, counts as much as ``word_contrast`` says. A Gaussian prior holds the values at those of the prior models: their
differences from knot to knot to ``1 / strength`` in variance, the values themselves more loosely. Without data the
prior comes back. Terms with a trend keep it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.models.relations import FAMILIES, SAYING, Provenance, RelationModel, RelationModels, Term
from deixis.reasoning.errors import SettingError
from deixis.reasoning.geometry.pairs import PairGeometry
from deixis.reasoning.grounding.evidence.degrees import degree_of_view
from deixis.reasoning.grounding.evidence.pair_features import view
from deixis.reasoning.grounding.fitting.likelihood import Expansion, Likelihood, SaidPairs, hats
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
    found = degree_sum(model, scenes)
    return found.total / found.count if found.count else 1.0


@dataclass(frozen=True, eq=False)
class DegreeSum:
    """The degrees that :func:`chance_degree` averages: how many, their sum, and its slope by the values of all terms,
    shape (k,)."""

    count: int
    total: float
    slope: NDArray[np.float64]


def degree_sum(model: RelationModel, scenes: Iterable[PairGeometry]) -> DegreeSum:
    """Return the degrees of a model over all ordered pairs of scenes and the words that share it."""
    words = [word for word, family in FAMILIES.items() if family == model.name] or [SAYING]
    count, total, slope = 0, 0.0, np.zeros(sum(len(term.knots) for term in model.terms))
    for pairs in scenes:
        apart = ~np.eye(len(pairs), dtype=bool)
        for word in words:
            features = view(pairs, word)
            degrees = degree_of_view(model, features)[apart]
            count, total = count + degrees.size, total + float(degrees.sum())
            slope += degrees @ hats(model, features, apart)
    return DegreeSum(count, total, slope)


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


@dataclass(frozen=True, eq=False)
class FitStatistics:
    """What a fit was made of, as sums over its scenes: scenes can be taken out without looking at the others.

    ``values`` (k,) are those of all terms of the models ``names``, as fitted; ``gradient`` (k,) and ``information``
    (k, k) are the first derivative of the scenes' log-likelihood there, and its second one negated. ``examples`` is
    the weight of the words said of each family, ``degrees`` the sums behind each model's chance degree. ``scenes``
    are still in the sums, of ``fitted`` that the values were fitted to.
    """

    names: tuple[str, ...]
    values: Array
    gradient: Array
    information: Array
    examples: dict[str, float]
    degrees: dict[str, DegreeSum]
    scenes: int
    fitted: int


@dataclass(frozen=True, eq=False)
class RelationFit:
    """Models after a fit, and its statistics.

    There are none where no scene said a word, so that the models are the prior's, nor of a fit with ``word_contrast``.
    """

    models: RelationModels
    statistics: FitStatistics | None


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
    return fit_relations(scenes, prior, settings or FitSettings(), sources, version).models


def fit_relations(
    scenes: Sequence[SaidPairs],
    prior: RelationModels,
    settings: FitSettings,
    sources: Sequence[str] = (),
    version: str = "",
) -> RelationFit:
    """Return what :func:`learn_relations` does, with the statistics for :func:`take_out`."""
    examples = _examples(scenes)
    if not examples:
        return RelationFit(prior, None)
    layout = _layout(prior, examples)
    likelihood = Likelihood(scenes, layout, settings.word_contrast)
    values = _maximise(likelihood, layout, settings)
    models, degrees = _finished(
        prior, layout, values, examples, lambda model: degree_sum(model, (s.pairs for s in scenes)), sources, version
    )
    if settings.word_contrast:
        return RelationFit(models, None)
    names, count = tuple(model.name for model in layout.models), len(scenes)
    gradient, information = likelihood(values)[1], likelihood.information(values)
    return RelationFit(models, FitStatistics(names, values, gradient, information, examples, degrees, count, count))


FEW_SCENES = 20
"""At most this many scenes are always fitted from nothing: it takes no longer than a constant, and nothing is lost."""


def take_out(
    statistics: FitStatistics, scene: SaidPairs, prior: RelationModels, settings: FitSettings, version: str = ""
) -> RelationFit | None:
    """Return the fit without one of its scenes, in a time that does not depend on how many there are.

    The sums of the others are expanded to second order about the fitted values, and what is expanded is maximised
    under the same prior and the same bounds: a Newton step, which for one scene of many differs from a new fit by
    the square of that scene's share. Returns None where only a new fit will do: few scenes or fewer than half of
    those fitted remain, or a family of words loses its last example.

    Notes
    -----
    The Newton step for taking data out of a fitted model: Guo, Goldstein, Hannun and van der Maaten, "Certified data
    removal from machine learning models", ICML 2020.
    """
    gone = _examples([scene])
    examples = {name: weight - gone.get(name, 0.0) for name, weight in statistics.examples.items()}
    scenes = statistics.scenes - 1
    lost = any(weight < 1e-6 for weight in examples.values()) or not gone.keys() <= examples.keys()
    if lost or scenes <= FEW_SCENES or scenes < statistics.fitted / 2:
        return None
    layout = _layout(prior, statistics.examples)
    one = Likelihood([scene], layout, 0.0)
    gradient = statistics.gradient - one(statistics.values)[1]
    information = statistics.information - one.information(statistics.values)
    values = _maximise(Expansion(statistics.values, gradient, information), layout, settings)

    step = values - statistics.values

    def others(model: RelationModel) -> DegreeSum:
        all_of_them, its = statistics.degrees[model.name], degree_sum(model, [scene.pairs])
        spans = [layout.slices[model.name, term.feature] for term in model.terms]
        shift = sum(values[span].max() - statistics.values[span].max() for span in spans)
        moved = all_of_them.slope @ np.concatenate([step[span] for span in spans])
        scale = float(np.exp(moved / all_of_them.total - shift))  # the sum of all, at the new values
        total = max(all_of_them.total * scale - its.total, 0.0)
        return DegreeSum(all_of_them.count - its.count, total, all_of_them.slope * scale - its.slope)

    models, degrees = _finished(prior, layout, values, examples, others, (), version)
    gradient = gradient - information @ step
    kept = FitStatistics(statistics.names, values, gradient, information, examples, degrees, scenes, statistics.fitted)
    return RelationFit(models, kept)


def _examples(scenes: Iterable[SaidPairs]) -> dict[str, float]:
    """Return the weight of the words that were said of each family, for those of which one was said."""
    weights: dict[str, float] = {}
    for scene in scenes:
        for word, weight in zip(scene.words, scene.weights.tolist(), strict=True):
            if word in FAMILIES and weight > 0:
                weights[FAMILIES[word]] = weights.get(FAMILIES[word], 0.0) + weight
    return weights


def _layout(prior: RelationModels, examples: dict[str, float]) -> Layout:
    return Layout([extended(prior[name]) for name in (*sorted(examples), SAYING)])


def _finished(
    prior: RelationModels,
    layout: Layout,
    values: Array,
    examples: dict[str, float],
    degrees: Callable[[RelationModel], DegreeSum],
    sources: Sequence[str],
    version: str,
) -> tuple[RelationModels, dict[str, DegreeSum]]:
    """Return the prior with the models of a layout fitted, and the degrees behind their chance degrees.

    Each term's best is shifted to 0. What the shifts of a word and of the saying model take from the degrees, the
    outliers take over, so that their likelihood ratio stays what was fitted.
    """
    made, found, sums = datetime.now(UTC), [], {}
    for model in layout.models:
        own = [values[layout.slices[model.name, term.feature]] for term in model.terms]
        spoken = [values[layout.slices[SAYING, term.feature]] for term in layout.model(SAYING).terms]
        shift = sum(float(part.max()) for part in (own if model.name == SAYING else own + spoken))
        odds = model.outliers / (1 - model.outliers) * float(np.exp(-shift))
        outliers = float(np.clip(odds / (1 + odds), *OUTLIER_BOUNDS))
        weight = sum(examples.values()) if model.name == SAYING else examples[model.name]
        terms = tuple(_term(term, part) for term, part in zip(model.terms, own, strict=True))
        fitted = RelationModel(model.name, terms, outliers, 1.0, Provenance(tuple(sources), weight, made, version))
        of_all = sums[model.name] = degrees(fitted)
        found.append(replace(fitted, chance=max(of_all.total / of_all.count if of_all.count else 1.0, 1e-6)))
    return prior.replaced(*found), sums


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


def _maximise(likelihood: Callable[[Array], tuple[float, Array]], layout: Layout, settings: FitSettings) -> Array:
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
