"""Best partial assignment of rows to columns, with prices that prove it; compiled.

The method is that of successive shortest augmenting paths (Jonker and Volgenant 1987), for rows that may also stay
unassigned: a path may end at that option. The dual solution is the prices v >= 0 of the columns and the profits of the
rows, each the maximum of gain minus price: their sum is the value, and any v >= 0 gives an upper bound.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.kernel import njit

CELLS_PER_CLOCK_CHECK = 2e6
"""Gains that are looked at between two looks at the clock, if each path ends soon."""


def assign_until(gain: NDArray[np.float64], deadline: Deadline) -> NDArray[np.int64]:
    """Return the column of each row in the best assignment, as far as the time allows.

    Rows whose best column another row has stay unassigned if no path was computed for them in time.

    Parameters
    ----------
    gain
        Gain of each pair, shape (r, c + 1), -inf for pairs that are ruled out; the last column is that of staying
        unassigned, with finite gains.
    deadline
        End of the time limit.

    Returns
    -------
    ndarray
        Column of each row, or c; shape (r,).

    Examples
    --------
    >>> assign_until(np.array([[2.0, 1.0, 0.0], [2.0, 0.0, -5.0]]), Deadline.never()).tolist()
    [1, 0]
    """
    rows, columns = gain.shape[0], gain.shape[1] - 1
    column_of, row_of = np.empty(rows, np.int64), np.full(columns + 1, -1)
    price, profit = np.zeros(columns), np.empty(rows)
    waiting = _take_the_best(gain, column_of, row_of, profit)
    part = max(1, int(CELLS_PER_CLOCK_CHECK / max(gain.size, 1)))
    for first in range(0, len(waiting), part):
        if deadline.passed:
            column_of[waiting[first:]] = columns
            break
        _augment_all(waiting[first : first + part], gain, column_of, row_of, price, profit)
    return column_of


@njit(cache=True, nogil=True)
def solve_assignment(gain, column_of, price, profit):  # type: ignore[no-untyped-def]
    """Solve a linear assignment: fill in each row's column, the prices and the profits, and return the value.

    Where there is no assignment, the filled-in arrays have no meaning.

    Parameters
    ----------
    gain
        Gain of each pair, shape (r, c + 1), -inf for pairs that are ruled out; the last column is that of staying
        unassigned.
    column_of
        Array to fill with the column of each row, or c; shape (r,).
    price
        Array to fill with the dual price of each column, shape (c,).
    profit
        Array to fill with the dual profit of each row, shape (r,).

    Returns
    -------
    float
        Sum of the gains, -inf where there is no assignment.
    """
    rows, columns = gain.shape[0], gain.shape[1] - 1
    row_of = np.full(columns + 1, -1)
    price[:] = 0.0
    if not _augment_all(_take_the_best(gain, column_of, row_of, profit), gain, column_of, row_of, price, profit):
        return -np.inf
    value = 0.0
    for row in range(rows):
        value += gain[row, column_of[row]]
    return value


@njit(cache=True, nogil=True)
def _augment_all(waiting, gain, column_of, row_of, price, profit):  # type: ignore[no-untyped-def]
    """Augment from each of the rows; return false where there is no assignment."""
    columns = gain.shape[1] - 1
    distance, before = np.empty(columns), np.empty(columns, np.int64)
    done, possible = np.empty(columns, np.bool_), True
    for row in waiting:
        possible = possible and _augment(row, gain, column_of, row_of, price, profit, distance, before, done)
    return possible


@njit(cache=True)
def _take_the_best(gain, column_of, row_of, profit):  # type: ignore[no-untyped-def]
    """Assign every row its best column unless another row has it; return the other rows."""
    rows, columns = gain.shape[0], gain.shape[1] - 1
    waiting = np.empty(rows, np.int64)
    count = 0
    for row in range(rows):
        best = columns
        for column in range(columns):
            if gain[row, column] > gain[row, best] or (
                gain[row, column] == gain[row, best] and row_of[best] >= 0 and row_of[column] < 0
            ):
                best = column
        profit[row] = gain[row, best]
        column_of[row] = -1
        if best == columns or row_of[best] < 0:
            column_of[row] = best
            if best < columns:
                row_of[best] = row
        else:
            waiting[count] = row
            count += 1
    return waiting[:count]


@njit(cache=True)
def _augment(start, gain, column_of, row_of, price, profit, distance, before, done):  # type: ignore[no-untyped-def]
    """Augment along the cheapest path from a row to a free column or an unassigned row; return false without one."""
    columns = gain.shape[1] - 1
    distance[:] = np.inf
    done[:] = False
    row, so_far, without, leaver, column = start, 0.0, np.inf, -1, -1
    while True:
        base = so_far + profit[row]
        if base - gain[row, columns] < without:
            without, leaver = base - gain[row, columns], row
        nearest, column = np.inf, -1
        for c in range(columns):
            if done[c]:
                continue
            d = base - (gain[row, c] - price[c])
            if d < distance[c]:
                distance[c], before[c] = d, row
            if distance[c] < nearest or (distance[c] == nearest and column >= 0 and row_of[c] < 0 <= row_of[column]):
                nearest, column = distance[c], c
        if without <= nearest or row_of[column] < 0:
            break
        done[column] = True
        row, so_far = row_of[column], nearest
    length = min(without, nearest)
    if length == np.inf:
        return False
    _reprice(start, length, row_of, price, profit, distance, done)
    _move(start, leaver if without <= nearest else -1, column, columns, column_of, row_of, before)
    return True


@njit(cache=True)
def _reprice(start, length, row_of, price, profit, distance, done):  # type: ignore[no-untyped-def]
    profit[start] -= length
    for column in range(len(price)):
        if done[column]:
            price[column] += length - distance[column]
            profit[row_of[column]] -= length - distance[column]


@njit(cache=True)
def _move(start, leaver, column, columns, column_of, row_of, before):  # type: ignore[no-untyped-def]
    """Shift the rows on the path by one; the path ends in ``column``, or where ``leaver`` >= 0, unassigns that row."""
    if leaver >= 0:
        column = column_of[leaver]
        column_of[leaver] = columns
        if leaver == start:
            return
    while True:
        row = before[column]
        following = column_of[row]
        column_of[row], row_of[column] = column, row
        if row == start:
            return
        column = following
