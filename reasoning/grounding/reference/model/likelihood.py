"""Log-linear scores with gradients: sums, products of features and weights, and log-sum-exp over axes.

A :class:`Score` is an array of log scores that remembers how it was computed. :func:`add_gradients` computes the
derivatives of one number by all weights, in one pass backwards (reverse-mode differentiation; Griewank and Walther,
*Evaluating Derivatives*, 2008).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, MutableMapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Pull = Callable[[Array], Array]
"""Function from the derivative by a result to the derivative by one of its operands."""


@dataclass(slots=True, eq=False)
class Score:
    """An array of log scores, and the operands that it was computed from."""

    value: Array
    operands: tuple[tuple[Score, Pull], ...] = ()
    weights: tuple[tuple[str, ...], Array] | None = None  # names of the weights, and the features that they multiply
    gradient: Array | None = field(default=None, repr=False)

    def __add__(self, other: Score) -> Score:
        """Return the sum, broadcast as numpy does."""
        first, second = self.value.shape, other.value.shape
        return Score(
            self.value + other.value,
            ((self, lambda given: _summed_to(given, first)), (other, lambda given: _summed_to(given, second))),
        )

    def __getitem__(self, index: Any) -> Score:
        """Return a view with added or reordered axes; ``index`` must not repeat entries."""
        shape = self.value.shape

        def pull(given: Array) -> Array:
            full = np.zeros(shape)
            full[index] = given
            return full

        return Score(self.value[index], ((self, pull),))


def constant(value: Array) -> Score:
    """Return a score that depends on no weight.

    Parameters
    ----------
    value
        Log scores of any shape.

    Returns
    -------
    Score
        Score with these values.
    """
    return Score(np.asarray(value, dtype=np.float64))


def weighted(features: Array, name: str, weights: Mapping[str, Array]) -> Score:
    """Return the products of features with weights.

    The weights of ``family/word`` are the sum of those of the family and the word; a word without weights has those of
    its family.

    Parameters
    ----------
    features
        Features, shape (…, f).
    name
        Name of the weights: ``family`` or ``family/word``.
    weights
        Weights by name, each of shape (f,).

    Returns
    -------
    Score
        Score of shape (…,).
    """
    names = tuple(part for part in dict.fromkeys((name.partition("/")[0], name)) if part in weights)
    total = sum((weights[part] for part in names), np.zeros(features.shape[-1]))
    return Score(features @ total, weights=(names, features))


def log_sum(score: Score, axis: int) -> Score:
    """Return the logarithm of the sum of exponentials along an axis, which is dropped.

    Parameters
    ----------
    score
        Log scores.
    axis
        Axis to sum over.

    Returns
    -------
    Score
        Score with one axis fewer.
    """
    top = score.value.max(axis=axis, keepdims=True)
    top = np.where(np.isfinite(top), top, 0.0)
    shares = np.exp(score.value - top)
    total = np.maximum(shares.sum(axis=axis, keepdims=True), 1e-300)
    shares = shares / total
    value = np.log(total) + top
    return Score(np.squeeze(value, axis), ((score, lambda given: np.expand_dims(given, axis) * shares),))


def log_mixture(parts: Sequence[Score], shares: Score) -> Score:
    """Return the log probabilities of a mixture of distributions with log shares.

    Parameters
    ----------
    parts
        Log probabilities of each distribution, all of the same shape.
    shares
        Log share of each distribution, shape (len(parts),).

    Returns
    -------
    Score
        Score of the shape of a part.
    """
    joint = np.stack([part.value + share for part, share in zip(parts, shares.value, strict=True)])
    value = np.logaddexp.reduce(joint, axis=0)
    blame = np.exp(joint - value)
    operands = [(part, _times(one)) for part, one in zip(parts, blame, strict=True)]
    return Score(value, (*operands, (shares, lambda given: (given * blame).reshape(len(parts), -1).sum(axis=1))))


def _times(factor: Array) -> Pull:
    return lambda given: given * factor


def log_shares(score: Score, axis: int) -> Score:
    """Return log probabilities along an axis (log-softmax).

    Parameters
    ----------
    score
        Scores, up to a constant along the axis.
    axis
        Axis along which the probabilities add up to 1.

    Returns
    -------
    Score
        Log probabilities of the same shape.
    """
    top = score.value.max(axis=axis, keepdims=True)
    value = score.value - top
    value = value - np.log(np.exp(value).sum(axis=axis, keepdims=True))
    shares = np.exp(value)

    def pull(given: Array) -> Array:
        result: Array = given - shares * given.sum(axis=axis, keepdims=True)
        return result

    return Score(value, ((score, pull),))


def log_complement(score: Score, share: float) -> Score:
    """Return log(1 - share p) of the log probabilities of p.

    Parameters
    ----------
    score
        Log probabilities, at most 0.
    share
        Share, in (0, 1), which keeps the result finite.

    Returns
    -------
    Score
        Log probabilities of the same shape.
    """
    p = share * np.exp(np.minimum(score.value, 0.0))
    return Score(np.log1p(-p), ((score, lambda given: -given * p / (1 - p)),))


def add_gradients(result: Score, found: MutableMapping[str, Array]) -> None:
    """Add the derivatives of a score by all weights to arrays of derivatives.

    Parameters
    ----------
    result
        Score of shape ().
    found
        Derivatives by the names of the weights; they are changed in place, or added.
    """
    order: list[Score] = []
    seen: set[int] = set()
    open_nodes = [(result, iter(result.operands))]
    while open_nodes:  # depth first; an operand comes before what is computed from it
        node, rest = open_nodes[-1]
        for operand, _ in rest:
            if id(operand) not in seen:
                seen.add(id(operand))
                open_nodes.append((operand, iter(operand.operands)))
                break
        else:
            order.append(node)
            open_nodes.pop()
    result.gradient = np.ones_like(result.value)
    for node in reversed(order):
        given = node.gradient
        if given is None:
            continue
        if node.weights is not None:
            names, features = node.weights
            share = given.reshape(-1) @ features.reshape(-1, features.shape[-1])
            for name in names:
                found[name] += share
        for operand, pull in node.operands:
            share = pull(given)
            operand.gradient = share if operand.gradient is None else operand.gradient + share


def _summed_to(given: Array, shape: tuple[int, ...]) -> Array:
    """Return a derivative summed over the axes along which an operand was broadcast."""
    while given.ndim > len(shape):
        given = given.sum(axis=0)
    for axis, size in enumerate(shape):
        if size == 1 and given.shape[axis] != 1:
            given = given.sum(axis=axis, keepdims=True)
    return given
