"""Fit the weights of reference to described objects, by penalised maximum likelihood."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.things.colours import Colours
from deixis.reasoning.errors import OutOfTimeError
from deixis.reasoning.grounding.reference.features.nouns import NOUN_FEATURES, NUMBER_FEATURES
from deixis.reasoning.grounding.reference.features.properties import SIZES, property_features
from deixis.reasoning.grounding.reference.features.relations import FAMILIES, RELATIONS, Pairs
from deixis.reasoning.grounding.reference.features.room import Room
from deixis.reasoning.grounding.reference.model.likelihood import Score, add_gradients
from deixis.reasoning.grounding.reference.model.model import DOUBTS, UNCALIBRATED, Model, calibrated
from deixis.reasoning.grounding.reference.query import Property, Query

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Example:
    """A query about a room, and the index of the object that it was said about."""

    query: Query
    room: Room
    target: int


@dataclass(frozen=True, eq=False)
class Fitted:
    """Weights by name, each of the shape that they have in the model, after a number of steps of the search."""

    weights: dict[str, Array]
    steps: int
    converged: bool


def fit(
    model: Model,
    examples: Sequence[Example],
    penalty: float,
    iterations: int = 60,
    progress: Callable[[int, int], None] | None = None,
    deadline: Deadline = Deadline.never(),
) -> Fitted:
    """Find the weights that make the described objects most probable.

    Parameters
    ----------
    model
        The model with the weights from which the search starts, towards which the penalty draws.
    examples
        Examples; those whose target is not a candidate are left out.
    penalty
        Squared distance of the weights from the start, in nats per example for a distance of 1.
    iterations
        Maximum number of steps of L-BFGS.
    progress
        Called after each step with the number of steps done and their maximum.
    deadline
        End of the time limit; the weights so far are the answer then.

    Returns
    -------
    Fitted
        The weights, and whether the search converged.
    """
    from scipy.optimize import minimize

    names = sorted(model.weights)
    start = np.concatenate([model.weights[name] for name in names])
    ends = np.cumsum([len(model.weights[name]) for name in names])[:-1]
    kept = [replace(model, kept={}) for _ in examples]

    def loss(values: Array) -> tuple[float, Array]:
        weights = dict(zip(names, np.split(values, ends), strict=True))
        total, slopes = 0.0, {name: np.zeros_like(weights[name]) for name in names}
        for base, example in zip(kept, examples, strict=True):
            if deadline.passed:
                raise OutOfTimeError("time limit reached while the weights were fitted")
            here = replace(base, weights=weights)
            found = log_probability(here, example)
            if found is None:
                continue
            total -= float(found.value)
            add_gradients(found, slopes)
        off = values - start
        slope = np.concatenate([slopes[name] for name in names])
        return total + penalty * float(off @ off), 2 * penalty * off - slope

    reached, steps, converged = start, 0, False

    def step(values: Array) -> None:
        nonlocal reached, steps
        reached, steps = values.copy(), steps + 1
        if progress is not None:
            progress(steps, iterations)

    with suppress(OutOfTimeError):
        found = minimize(loss, start, jac=True, method="L-BFGS-B", callback=step, options={"maxiter": iterations})
        reached, converged = found.x, bool(found.success)
    return Fitted(dict(zip(names, np.split(reached, ends), strict=True)), steps, converged)


def log_probability(model: Model, example: Example) -> Score | None:
    """Return the log probability of the target; None if it is not a candidate.

    Parameters
    ----------
    model
        The model.
    example
        A query, its room and its target.

    Returns
    -------
    Score or None
        Log probability in nats, shape (); None if the target is not a candidate.
    """
    at = np.flatnonzero(model.candidates(example.query, example.room) == example.target)
    return model.scores(example.query, example.room)[int(at[0])] if len(at) else None


FIRST_LOG_ODDS = -4.0
"""Log odds from which a fit of the calibration starts, that a description carries no information."""

DOUBT_PENALTY = 0.5
"""Penalty in nats for a weight of the calibration that differs by 1 from its start."""

LEAST_WEIGHT = 5e-4
"""Minimum magnitude of a weight that is written to a file."""

INITIAL: Mapping[str, float] = {
    "same": 3.0,
    "synonym": 3.0,
    "broader": 2.0,
    "narrower": 2.0,
    "sibling": 1.0,
    "spelling": 1.0,
    "head": 1.0,
    "size": 0.5,
    "log_gap": 0.5,
    "nearest": 1.0,
    "nearest_centre": 0.5,
    "rank": 0.5,
    "cosine": 1.5,
    "forward": 0.5,
    "own_front": 1.5,
    "room_front": 1.0,
    "view_cosine": 0.5,
    "covered": 1.0,
    "rise": 1.0,
    "contained": 1.0,
    "detour": 1.0,
    "facing": 1.0,
    "faced": 0.5,
    "log_ratio": 2.0,
    "corner": 0.5,
    "nearest_corner": 1.0,
    "greatest": 1.0,
    "standard": 0.5,
    "at": 2.0,
    "off": 0.5,
    "median": 1.0,
    "exact": 0.5,
    "hue": 0.5,
    "tint": 0.5,
    "lightness": 0.5,
}
"""Weights from which the search starts, by feature; 0 for the other features."""


def initial_weights(colours: Colours) -> dict[str, Array]:
    """Return the weights from which a fit starts: those of INITIAL, and 0 for each relation's own deviations.

    Parameters
    ----------
    colours
        Known colour terms.

    Returns
    -------
    dict
        Weights by the name of the block.
    """
    names = feature_names(colours)
    weights = {block: np.array([INITIAL.get(name, 0.0) for name in given]) for block, given in names.items()}
    for word, (family, _) in RELATIONS.items():
        for degree in ("", " comparative", " superlative"):
            weights[f"{family}/{word}{degree}"] = np.zeros(len(names[family]))
        weights[f"{family} inverted/{word} inverted"] = np.zeros(len(names[family]))
    weights["viewer/from"] = np.array([-2.0, 0.0, -2.0, 0.0, 0.0, 0.0])
    weights["viewer/entering"] = np.array([-2.0, 0.0, -2.0, 0.0, 0.0, 0.0])
    weights["viewer/own"] = np.array([0.0, -2.0, -1.0, 0.0, 0.0, 0.0])
    weights["viewer/facing"] = np.array([2.0, 2.0, 2.0, 0.0, 0.0, 0.0])
    weights["towards"] = np.array([8.0])
    weights["lifted"] = np.array([-1.5])
    return weights


def feature_names(colours: Colours) -> dict[str, tuple[str, ...]]:
    """Return the names of the features of each block of weights, in order.

    Parameters
    ----------
    colours
        Known colour terms.

    Returns
    -------
    dict
        Names of features by the name of the block.
    """
    boxes = np.arange(12.0).reshape(2, 2, 3)
    room, both = Room.of(("a", "b"), boxes, ("cup", "cup")), np.arange(2)
    pairs = Pairs(room, both, both, (both,))
    names = {family: tuple(features(pairs, 1.0)) for family, features in FAMILIES.items()}
    names |= {f"{family} inverted": names[family] for family in FAMILIES}
    properties = [Property("colour", "red"), Property("colour", "dark"), Property("rank", "left", rank=2)]
    properties += [Property("position", word) for word in ("middle", "left", "back")]
    properties += [Property("size", word, degree) for word in SIZES for degree in ("plain", "superlative")]
    for prop in properties:
        known = property_features(prop, room, both, (both,), colours)
        if known is not None:
            names[known[0]] = tuple(known[1])
    views = ("middle", "front", "wall", "axis", "middle_fronted", "wall_fronted")
    return {
        **names,
        "noun": NOUN_FEATURES,
        "number": NUMBER_FEATURES,
        "target": ("rivals", "log_rivals", "surrounds"),
        "count": ("exact", "off"),
        "seen": views,
        "viewer": views,
    }


def weight_names(colours: Colours) -> dict[str, tuple[str, ...]]:
    """Return the names of the weights of each block in a file of weights, in order.

    Parameters
    ----------
    colours
        Known colour terms.

    Returns
    -------
    dict
        Names of weights by the name of the block.
    """
    return feature_names(colours) | {
        "calibration": (*(f"power_{name}" for name in DOUBTS), *(f"vain_{name}" for name in DOUBTS)),
        "towards": ("towards",),
        "lifted": ("lifted",),
    }


def named_weights(weights: Mapping[str, Array], colours: Colours) -> dict[str, dict[str, float]]:
    """Return weights by the names of their features, to three digits, without words that keep to their family.

    Parameters
    ----------
    weights
        Weights by the name of the block.
    colours
        Known colour terms.

    Returns
    -------
    dict
        Weights by the name of the feature, for each block.
    """
    names = weight_names(colours)
    return {
        block: dict(
            zip(names.get(block, names.get(block.partition("/")[0], ())), np.round(values, 3).tolist(), strict=True)
        )
        for block, values in sorted(weights.items())
        if np.abs(values).max() >= LEAST_WEIGHT
    }


def fit_calibration(held_out: Sequence[tuple[Model, Example]]) -> Array:
    """Return the weights ``calibration`` that make the targets of held-out examples most probable.

    Parameters
    ----------
    held_out
        Examples, each with a model that was fitted without it.

    Returns
    -------
    ndarray
        The weights of :func:`~deixis.reasoning.grounding.reference.model.model.calibrated`, shape (2 d,).
    """
    from scipy.optimize import minimize

    cases = []
    for model, example in held_out:
        at = np.flatnonzero(model.candidates(example.query, example.room) == example.target)
        if len(at):
            logs = model.scores(example.query, example.room).value
            cases.append((logs, model.doubts(example.query, example.room, logs), int(at[0])))
    start = np.where(UNCALIBRATED < 0, FIRST_LOG_ODDS, UNCALIBRATED)

    def loss(values: Array) -> float:
        total = sum(float(np.log(calibrated(logs, doubts, values)[target])) for logs, doubts, target in cases)
        return DOUBT_PENALTY * float((values - start) @ (values - start)) - total

    result: Array = minimize(loss, start, method="L-BFGS-B", options={"maxiter": 30}).x
    return result
