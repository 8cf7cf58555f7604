"""Fit graded models of relation words to scenes with known words and boxes.

The unknowns are the values of every term at its knots. The fit maximises the probability that, of all ordered pairs of
a scene, the word was stated of the annotated pair (a conditional logit, McFadden 1974, over the saying model): this is
the decision of grounding. A second contrast, with the other words that could have been stated of the same pair, has the
weight ``word_contrast``. A Gaussian prior has its mean at the prior models: the variance of differences from knot to
knot is ``1 / strength``, that of the values is larger. Without data, the result is the prior. Terms with a trend keep
it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.models.relations import (
    FAMILIES,
    GRADED_FAMILIES,
    MODEL_OF_WORD,
    ORIENTED,
    SAYING,
    Provenance,
    RelationModel,
    RelationModels,
    Term,
)
from deixis.reasoning.errors import SettingError
from deixis.reasoning.geometry.pairs import PairGeometry
from deixis.reasoning.grounding.evidence.words.degrees import degree_of_view
from deixis.reasoning.grounding.evidence.words.pair_features import view
from deixis.reasoning.grounding.fitting.likelihood import Expansion, Likelihood, SaidPairs, hats
from deixis.reasoning.grounding.fitting.parameters import Layout


def random_scenes(count: int = 200, size: int = 8, seed: int = 1) -> list[NDArray[np.float64]]:
    """Return scenes of boxes with centres anywhere in the unit square and extents between 0.02 and 0.3.

    Parameters
    ----------
    count
        Number of scenes.
    size
        Number of boxes of a scene.
    seed
        Seed of the random numbers.

    Returns
    -------
    list of ndarray
        Boxes of each scene, minimum and maximum corners, shape (size, 2, 2).
    """
    rng = np.random.default_rng(seed)
    centres = rng.uniform(0.0, 1.0, (count, size, 2))
    halves = rng.uniform(0.01, 0.15, (count, size, 2))
    return list(np.stack([centres - halves, centres + halves], axis=2))


def chance_degree(model: RelationModel, scenes: Iterable[PairGeometry]) -> float:
    """Return the mean degree of a model over all ordered pairs of scenes and words of the model; 1 without pairs.

    Parameters
    ----------
    model
        Model of a family of words.
    scenes
        Pairs of boxes of each scene.

    Returns
    -------
    float
        Mean degree, in (0, 1].
    """
    if not model.terms:
        return 1.0
    found = degree_sum(model, scenes)
    return found.total / found.count if found.count else 1.0


@dataclass(frozen=True, eq=False)
class DegreeSum:
    """Sum of the degrees that :func:`chance_degree` averages."""

    count: int
    total: float
    slope: NDArray[np.float64]  # (k,) derivative of the sum by the values of all terms


def degree_sum(model: RelationModel, scenes: Iterable[PairGeometry]) -> DegreeSum:
    """Return the sum of degrees of a model over all ordered pairs of scenes and words of the model.

    Parameters
    ----------
    model
        Model of a family of words.
    scenes
        Pairs of boxes of each scene.

    Returns
    -------
    DegreeSum
        Number of pairs and words, sum of their degrees, and derivative of the sum by the values of the model.
    """
    words = [word for word, family in FAMILIES.items() if family == model.name]
    words = words or [word for word, family in GRADED_FAMILIES.items() if family == model.name] or [SAYING]
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
"""Bounds of the share of outliers, so that the evidence of a learned fact against a pair is at most ln 1000 nats."""


@dataclass(frozen=True, slots=True)
class FitSettings:
    """Settings of a fit."""

    strength: float = 3.0  # of the prior; at 1, a difference of 1 between knots costs half a nat
    word_contrast: float = 0.0  # weight of the contrast with other words, at least 0
    iterations: int = 100  # maximum number of iterations

    def __post_init__(self) -> None:
        if not 0 < self.strength < np.inf:
            raise SettingError(f"the strength of the shipped models must be above 0, got {self.strength:g}")
        if not self.word_contrast >= 0 or self.iterations < 1:
            raise SettingError(
                "`word_contrast` must be at least 0 and `iterations` at least 1, "
                f"got {self.word_contrast:g} and {self.iterations}"
            )


@dataclass(frozen=True, eq=False)
class FitStatistics:
    """Sums over the scenes of a fit, from which a scene can be removed without the other scenes."""

    names: tuple[str, ...]  # models
    values: Array  # (k,) fitted values of all terms of the models
    gradient: Array  # (k,) derivative of the scenes' log-likelihood at the values
    information: Array  # (k, k) negated second derivative
    examples: dict[str, float]  # weight of the stated words of each family
    degrees: dict[str, DegreeSum]  # sums of each model's chance degree
    scenes: int  # number of scenes in the sums
    fitted: int  # number of scenes of the last complete fit


@dataclass(frozen=True, eq=False)
class RelationFit:
    """Models after a fit, and its statistics.

    The statistics are None where no scene states a word, so that the models are the prior, and with ``word_contrast``.
    """

    models: RelationModels
    statistics: FitStatistics | None


def learn_relations(
    scenes: Sequence[SaidPairs],
    prior: RelationModels,
    settings: FitSettings | None = None,
) -> RelationModels:
    """Return the models that best fit the scenes and the prior.

    Models of words that no scene states are returned unchanged.

    Parameters
    ----------
    scenes
        Examples of each scene.
    prior
        Models from which the fit starts, and towards which the prior draws.
    settings
        Settings of the fit; by default, those of :class:`FitSettings`.

    Returns
    -------
    RelationModels
        Fitted models; the words of a family share one.
    """
    return fit_relations(scenes, prior, settings or FitSettings()).models


def fit_relations(
    scenes: Sequence[SaidPairs],
    prior: RelationModels,
    settings: FitSettings,
    sources: Sequence[str] = (),
    version: str = "",
) -> RelationFit:
    """Fit models like :func:`learn_relations`, and return them with the statistics for :func:`take_out`.

    Parameters
    ----------
    scenes
        Examples of each scene.
    prior
        Models from which the fit starts, and towards which the prior draws.
    settings
        Settings of the fit.
    sources
        Names of the data, for the provenance.
    version
        Version of the software, for the provenance.

    Returns
    -------
    RelationFit
        Fitted models, and the statistics.
    """
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
"""Maximum number of scenes that are always fitted again completely, which takes a bounded time and is exact."""


def take_out(
    statistics: FitStatistics, scene: SaidPairs, prior: RelationModels, settings: FitSettings, version: str = ""
) -> RelationFit | None:
    """Return the fit without one of its scenes, in a time that does not depend on the number of scenes.

    The log-likelihood of the other scenes is expanded to second order about the fitted values, and maximised under the
    same prior and bounds: a Newton step, whose difference from a new fit is of the order of the square of the scene's
    share. Returns None where a new fit is needed: few scenes, or fewer than half of the fitted ones, remain, or a
    family of words loses its last example.

    Parameters
    ----------
    statistics
        Statistics of the fit with all scenes.
    scene
        Examples of the scene to take out.
    prior
        The prior of the fit.
    settings
        The settings of the fit.
    version
        Version of the software, for the provenance.

    Returns
    -------
    RelationFit or None
        Models and statistics without the scene; None where a new fit is needed.

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
    """Return the weight of the stated words of each family with at least one; words without a model have none.

    Words such as *facing* have none where no orientation is known.
    """
    weights: dict[str, float] = {}
    for scene in scenes:
        for word, weight in zip(scene.words, scene.weights.tolist(), strict=True):
            family = MODEL_OF_WORD.get(word)
            unseen = family in ORIENTED and scene.pairs.subject_poses is None
            if family is not None and not unseen and weight > 0:
                weights[family] = weights.get(family, 0.0) + weight
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

    The maximum of each term is shifted to 0. The share of outliers is adjusted to the shifts of a word and of the
    saying model, so that the likelihood ratio stays as fitted.
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
    **{name: {"gap": _UNIT, "crowd": _UNIT} for name in ("nearness", "adjacency", "farness")},
}


def extended(model: RelationModel) -> RelationModel:
    """Return the model with more knots, and with terms of value 0 for the features that the prior does not use.

    Parameters
    ----------
    model
        Model of a family of words, usually of the prior.

    Returns
    -------
    RelationModel
        Model with the same degrees and more free values.
    """
    direction = model.name in {"horizontal", "vertical", "diagonal"}
    finer = _KNOTS.get("direction" if direction else model.name, {})
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
    """Return the term with new values, shifted so that their maximum is 0."""
    shifted = values - values.max()
    return Term(term.feature, term.knots, tuple(np.minimum(shifted, 0.0).tolist()), term.trend)
