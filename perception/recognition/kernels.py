"""Compiled kernels of equation 1: exact distances between views, and lower bounds of them from a few axes.

Squared distances are |t|^2 + |v|^2 - 2 t.v in single precision, which is fast, but inaccurate for similar vectors.
Every pair whose inaccurate value is within its error of the least is therefore computed again from differences in
double precision, so that an exact distance agrees with the definition to the last digits of a double.
"""

from __future__ import annotations

import numpy as np
from llvmlite.binding import get_host_cpu_features
from numba import njit

AXES = 24
"""Number of coordinates of bounds, a constant for the compiler: principal axes, and last the length of the rest."""

LANES = 32
"""Number of columns that the compiled loop processes at a time."""

EPSILON = 2.0**-24
"""Relative rounding error in single precision."""

ONE_THREAD = 100**3 if get_host_cpu_features().get("avx512vl") else 2**18
"""Number of multiplications up to which OpenBLAS uses one thread for a product: with AVX-512 by its kernels for small
matrices (kernel/x86_64/sgemm_small_kernel_permit_skylakex.c), which are also the fastest, and otherwise because there
is little work (interface/gemm.c: SMP_THRESHOLD_MIN times GEMM_MULTITHREAD_THRESHOLD)."""

ROWS = 4
"""Number of rows that kernels of OpenBLAS process at a time."""

_NO_NAN = {"nnan", "nsz"}
_SUMS_IN_ANY_ORDER = {"nnan", "nsz", "reassoc", "contract"}


@njit(cache=True, nogil=True, error_model="numpy", fastmath=_SUMS_IN_ANY_ORDER)
def lower_bounds(columns, squares, reduced, starts, slack, out):  # type: ignore[no-untyped-def]
    """Fill ``out`` (m,) with lower bounds of D_V between the target and each of m views.

    ``columns`` (AXES, >= q) are the target's reduced descriptors times -2, and ``squares`` (q,) their squared lengths.
    There may be more than q columns, since multiples of :data:`LANES` are fastest. ``reduced`` (n, AXES + 1) are the
    views' reduced descriptors, with their squared lengths last. ``slack`` bounds the error of a value.
    """
    count = columns.shape[1]
    least = np.empty(count, np.float32)
    for view in range(len(out)):
        least[:] = np.inf
        for k in range(starts[view], starts[view + 1]):
            row = reduced[k]
            base = row[AXES]
            for t in range(count):
                value = base
                for axis in range(AXES):
                    value += columns[axis, t] * row[axis]
                least[t] = min(least[t], value)
        total = 0.0
        for t in range(len(squares)):
            total += np.sqrt(max(np.float64(least[t]) + squares[t] - slack, 0.0))
        out[view] = total / len(squares)


@njit(cache=True, nogil=True, error_model="numpy", fastmath=_SUMS_IN_ANY_ORDER)
def estimates(target, squares, count, reduced, starts, views, out):  # type: ignore[no-untyped-def]
    """Add to ``out`` (m,) the estimates of D_V times q from ``count`` lists of an inverted file.

    ``target`` (q, AXES + 1) and ``reduced`` (n, AXES + 1) are reduced descriptors; those of the views are in lists from
    ``starts[i]`` to ``starts[i + 1]``, and ``views`` (n,) holds the indexes of their views. ``squares`` (q, l) are
    squared distances to the lists' centres, minus the target's squared lengths. The distance to a view without a
    descriptor in the lists counts as that of their farthest centre.
    """
    best = np.empty(len(out), np.float32)
    lists, apart = np.empty(count, np.int64), np.empty(count, np.float32)
    for t in range(len(target)):
        row = target[t]
        _least(squares[t], lists, apart)
        best[:] = apart[count - 1]
        for place in range(count):
            for k in range(starts[lists[place]], starts[lists[place] + 1]):
                squared = reduced[k, AXES]
                for axis in range(AXES):
                    squared -= np.float32(2.0) * row[axis] * reduced[k, axis]
                best[views[k]] = min(best[views[k]], squared)
        for view in range(len(out)):
            out[view] += np.sqrt(max(best[view] + row[AXES], np.float32(0.0)))


@njit(cache=True, nogil=True, error_model="numpy")
def _least(values, places, least):  # type: ignore[no-untyped-def]
    """Fill ``least`` (p,) with the p least of ``values`` (l,), in order, and ``places`` (p,) with their indexes."""
    last = len(least) - 1
    least[:] = np.inf
    for place in range(len(values)):
        value = values[place]
        if value < least[last]:
            at = last
            while at > 0 and least[at - 1] > value:
                least[at], places[at] = least[at - 1], places[at - 1]
                at -= 1
            least[at], places[at] = value, place


@njit(cache=True, nogil=True, error_model="numpy")
def _products(view, columns):  # type: ignore[no-untyped-def]
    """Return dot products (k, q) of rows (k, d) with columns (d, q), in pieces that a BLAS computes in one thread.

    Products of views are small. If other programs keep the processors busy, the threads of a BLAS wait for each other
    about a hundred times as long as they compute.
    """
    products = np.empty((len(view), columns.shape[1]), np.float32)
    rows = max(1, ONE_THREAD // columns.size)
    rows -= rows % ROWS if rows > ROWS else 0
    for low in range(0, len(view), rows):
        np.dot(view[low : low + rows], columns, products[low : low + rows])
    return products


@njit(cache=True, nogil=True, error_model="numpy", fastmath=_NO_NAN)
def _least_of_columns(products, squares, least):  # type: ignore[no-untyped-def]
    """Fill ``least`` (q,) with each column's least |v|^2 - 2 t.v, from dot products (k, q)."""
    least[:] = np.inf
    for k in range(products.shape[0]):
        row = products[k]
        for t in range(products.shape[1]):
            least[t] = min(least[t], squares[k] - np.float32(2.0) * row[t])


@njit(cache=True, nogil=True, error_model="numpy", fastmath=_SUMS_IN_ANY_ORDER)
def _lowest(least, lengths, rough, longest, within):  # type: ignore[no-untyped-def]
    """Return a lower bound of D_V times q from the columns' least values (q,).

    Fill ``within`` (q,) with the values up to which a pair may be the nearest.
    """
    lowest = 0.0
    for t in range(len(least)):
        error = rough * (lengths[t] + longest)
        within[t] = least[t] + error
        lowest += np.sqrt(max(least[t] + lengths[t] * lengths[t] - error, 0.0))
    return lowest


@njit(cache=True, nogil=True, error_model="numpy")
def view_distance(target, columns, lengths, view, squares, limit):  # type: ignore[no-untyped-def]
    """Return D_V (equation 1) between a target (q, d) and a view (k, d), or infinity if that is above ``limit``.

    ``columns`` (d, q) is the transposed target, ``lengths`` (q,) are the lengths of its descriptors, and ``squares``
    (k,) the squared lengths of the view's descriptors.
    """
    products = _products(view, columns)
    least = np.empty(len(target), np.float32)
    _least_of_columns(products, squares, least)
    longest = np.sqrt(np.float64(squares.max()))
    rough = 4.0 * (target.shape[1] + 4) * EPSILON * longest
    within = np.empty(len(target), np.float32)
    if _lowest(least, lengths, rough, longest, within) > limit * len(target) * (1.0 + EPSILON):
        return np.inf
    nearest = np.full(len(target), np.inf)
    for k in range(len(view)):
        row = products[k]
        for t in range(len(target)):
            if squares[k] - np.float32(2.0) * row[t] <= within[t]:
                nearest[t] = min(nearest[t], _squared(target[t], view[k]))
    return np.sqrt(nearest).mean()


@njit(cache=True, nogil=True, error_model="numpy", fastmath=_SUMS_IN_ANY_ORDER)
def _squared(one, other):  # type: ignore[no-untyped-def]
    total = 0.0
    for axis in range(len(one)):
        apart = np.float64(one[axis]) - np.float64(other[axis])
        total += apart * apart
    return total


@njit(cache=True, nogil=True, error_model="numpy")
def fill_view_distances(target, columns, lengths, descriptors, starts, squares, out):  # type: ignore[no-untyped-def]
    """Fill ``out`` (m,) with D_V between the target and each of m views."""
    for view in range(len(out)):
        low, high = starts[view], starts[view + 1]
        out[view] = view_distance(target, columns, lengths, descriptors[low:high], squares[low:high], np.inf)


@njit(cache=True, nogil=True, error_model="numpy")
def nearest_view(  # type: ignore[no-untyped-def]
    target, columns, lengths, descriptors, starts, squares, candidates, bounds
):
    """Return the least D_V over ``candidates`` (c,), the index of that view, and the number of views compared.

    Candidates are in the order of their lower ``bounds`` (c,); those with a bound above the best are not compared. Of
    equally near views the first in memory is taken.
    """
    best, at, seen = np.inf, -1, 0
    for place in range(len(candidates)):
        if bounds[place] > best:
            break
        seen += 1
        view = candidates[place]
        low, high = starts[view], starts[view + 1]
        distance = view_distance(target, columns, lengths, descriptors[low:high], squares[low:high], best)
        if distance < best or (distance == best and view < at):
            best, at = distance, view
    return best, at, seen
