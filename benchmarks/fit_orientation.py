"""Fit how to tell the ends of long things and the handles of round ones to simulated things, and write the weights.

    python benchmarks/fit_orientation.py FILE
    python benchmarks/fit_orientation.py --tables 20

The things are seen alone and on whole tables (``bench_orientation.py``), whose seeds are apart from those of the
benchmark. Without FILE it prints how well weights that are fitted to two thirds of the tables tell the rest.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from bench_orientation import ALONE, FIRST_SEED, HANDLED, ROUND, SURE, Segment, segments, views
from numpy.typing import NDArray

from deixis.perception.features.orientation import (
    MIN_POINTS,
    EndNetwork,
    handle_features,
    in_slices,
    thinned,
)

TABLES = 300
THINGS = 40
HIDDEN = 12
"""Number of hidden units of the network."""

PENALTY = 20.0
"""Weight of the squares of the network's weights, chosen on the third of the tables that was left out."""

HANDLE_PENALTY = 1.0
Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Examples:
    """Features of n long things (n, 2, k) with the class of each, and of m round ones (m, l) with signs (m,).

    The class is the end with the head, or 2 for none. ``groups`` are the numbers of the tables of both.
    """

    ends: Array
    classes: NDArray[np.int64]
    handles: Array
    signs: Array
    groups: tuple[NDArray[np.int64], NDArray[np.int64]]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", type=Path, help="file of the weights")
    parser.add_argument("--tables", type=int, default=TABLES, help="number of tables")
    options = parser.parse_args()
    examples = collected(options.tables)
    print(f"{len(examples.classes)} long things, {len(examples.signs)} round ones with something that sticks out")
    if options.file is None:
        held_out(examples)
        return
    network = fitted_network(examples.ends, examples.classes)
    weights = {
        "ends": {name: rounded(getattr(network, name)) for name in ("mean", "scale", "hidden", "bias", "out")}
        | {"none": round(network.none, 4)},
        "handle": rounded(fitted_handle(examples.handles, examples.signs)),
    }
    options.file.write_text(json.dumps(weights) + "\n", encoding="utf-8")


def collected(tables: int) -> Examples:
    """Return the features of things on tables and alone."""
    ends, classes, handles, signs = [], [], [], []
    groups: tuple[list[int], list[int]] = ([], [])
    for number, segment in numbered_segments(tables):
        if len(segment.points) < MIN_POINTS:
            continue
        long = in_slices(segment.points, segment.others)
        if long is not None and long[1] is not None:
            ends.append(long[1])
            classes.append(0 if segment.is_right(long[0]) else 1 if segment.is_right(-long[0]) else 2)
            groups[0].append(number)
        elif long is None and (found := handle_features(segment.points)) is not None:
            handles.append(found[0])
            signs.append(1.0 if segment.is_right(found[1]) else -1.0)
            groups[1].append(number)
    numbers = np.array(groups[0]), np.array(groups[1])
    return Examples(np.array(ends), np.array(classes), np.array(handles), np.array(signs), numbers)


def numbered_segments(tables: int) -> Iterator[tuple[int, Segment]]:
    """Yield the things of each table, and things alone, with a number of the table."""
    seeds = range(2 * FIRST_SEED, 2 * FIRST_SEED + tables)
    with ProcessPoolExecutor() as pool:
        for seed, found in zip(seeds, pool.map(segments, seeds, chunksize=4), strict=True):
            for segment in found:
                yield seed, segment
    for kind, seen, truth in views((*ALONE, *HANDLED, *ROUND), range(min(THINGS, tables)), noise=1.0):
        yield 0, Segment(kind, thinned(seen.points), np.zeros((0, 3)), truth)


def held_out(examples: Examples) -> None:
    """Print how well weights that are fitted to two thirds of the tables find the things of the others."""
    rest = [group % 3 != 0 for group in examples.groups]
    network = fitted_network(examples.ends[rest[0]], examples.classes[rest[0]])
    shares = network.probabilities(examples.ends[~rest[0]])[:, :2]
    weights = fitted_handle(examples.handles[rest[1]], examples.signs[rest[1]])
    handle = 1 / (1 + np.exp(-examples.handles[~rest[1]] @ weights))
    for name, told, right in (
        ("heads", shares.max(axis=1), shares.argmax(axis=1) == examples.classes[~rest[0]]),
        ("handles", handle, examples.signs[~rest[1]] > 0),
    ):
        sure = told >= SURE
        print(f"{name} from {SURE:g}: {(~right[sure]).sum()} of {sure.sum()} wrong, {len(told)} in all")


def fitted_network(ends: Array, classes: NDArray[np.int64]) -> EndNetwork:
    """Return the network with the most probable classes, with a penalty on the squares of its weights."""
    from scipy.optimize import minimize

    both = ends.reshape(-1, ends.shape[2])
    mean, scale = both.mean(axis=0), both.std(axis=0) + 1e-3
    known = (ends - mean) / scale
    n, k = len(known), known.shape[2]
    cuts = np.cumsum([k * HIDDEN, HIDDEN, 2 * HIDDEN])

    def parts(weights: Array) -> tuple[Array, Array, Array, float]:
        hidden, bias, out, none = np.split(weights, cuts)
        return hidden.reshape(k, HIDDEN), bias, out.reshape(HIDDEN, 2), float(none[0])

    def loss(weights: Array) -> tuple[float, Array]:
        hidden, bias, out, none = parts(weights)
        units = np.tanh(known @ hidden + bias)
        scores = units @ out
        odds = np.column_stack([scores[..., 0], scores[..., 1].sum(axis=1) + none])
        logs = odds - np.logaddexp.reduce(odds, axis=1, keepdims=True)
        off = np.exp(logs)
        off[np.arange(n), classes] -= 1
        down = np.stack([off[:, :2], np.repeat(off[:, 2:], 2, axis=1)], axis=-1)  # by thing, end and score
        inner = (down @ out.T) * (1 - units**2)
        slopes = [
            np.einsum("nek,neh->kh", known, inner).ravel(),
            inner.sum(axis=(0, 1)),
            np.einsum("neh,nes->hs", units, down).ravel(),
            [off[:, 2].sum()],
        ]
        shrunk = weights * (np.arange(len(weights)) < cuts[-1])
        value = PENALTY / 2 * float(shrunk @ shrunk) - float(logs[np.arange(n), classes].sum())
        return value, np.concatenate(slopes) + PENALTY * shrunk

    start = np.random.default_rng(0).normal(0.0, 0.1, cuts[-1] + 1)
    hidden, bias, out, none = parts(minimize(loss, start, jac=True, method="L-BFGS-B", options={"maxiter": 500}).x)
    return EndNetwork(mean, scale, hidden, bias, out, none)


def fitted_handle(features: Array, signs: Array) -> Array:
    """Return the weights of a logistic regression, with a penalty on their squares."""
    from scipy.optimize import minimize

    found = minimize(
        lambda w: np.logaddexp(0, -signs * (features @ w)).sum() + HANDLE_PENALTY * (w @ w), np.zeros(features.shape[1])
    )
    result: Array = found.x
    return result


def rounded(values: Array) -> list[float]:
    """Return an array as nested lists of numbers with four digits after the point."""
    result: list[float] = np.round(values, 4).tolist()
    return result


if __name__ == "__main__":
    main()
