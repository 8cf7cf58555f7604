"""Compare the composition of distances with triangles whose sides are whole numbers."""

from __future__ import annotations

from bisect import bisect_left
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.reasoning.errors import SettingError
from deixis.reasoning.qualitative.calculi.distance import DEFAULT_RANGES, Ranges, distance_calculus


def shown(ranges: Ranges, unit: int) -> dict[tuple[int, int], int]:
    """Return the compositions in triangles with sides of whole ``unit``-ths; each side up to beyond the last range."""
    bounds = [bound * unit for bound in ranges.bounds]
    sides = range(int(2 * bounds[-1]) + 2 * unit)
    code = {side: 0 if side == 0 else 1 + bisect_left(bounds, side) for side in range(2 * len(sides))}
    found: dict[tuple[int, int], int] = {}
    for a, b in product(sides, repeat=2):
        for c in range(abs(a - b), a + b + 1):
            found[code[a], code[b]] = found.get((code[a], code[b]), 0) | 1 << code[c]
    return found


@pytest.mark.parametrize(
    "ranges",
    [
        DEFAULT_RANGES,
        Ranges(("near", "far"), (2.0,)),
        Ranges(("touching", "near", "medium", "far"), (0.5, 3.0, 4.0)),
        Ranges(("a", "b", "c", "d", "e"), (1.0, 2.0, 4.0, 8.0)),
    ],
    ids=lambda ranges: "-".join(ranges.names),
)
def test_compositions_agree_with_triangles(ranges: Ranges) -> None:
    calculus = distance_calculus(ranges)
    n = len(calculus.atoms)
    expected = {(i, j): calculus.compose(1 << i, 1 << j) for i, j in product(range(n), repeat=2)}
    assert shown(ranges, unit=6) == expected


def test_the_default_table_by_hand() -> None:
    """Check bounds 1 and 3: two near steps lead at most 2 away; a medium and a near one more than 0, at most 4."""
    distance = distance_calculus()
    table = {
        ("near", "near"): ("same", "near", "medium"),
        ("near", "medium"): ("near", "medium", "far"),
        ("near", "far"): ("medium", "far"),
        ("medium", "medium"): ("same", "near", "medium", "far"),
        ("medium", "far"): ("near", "medium", "far"),
        ("far", "far"): ("same", "near", "medium", "far"),
    }
    for (first, second), expected in table.items():
        r, s = distance.relation([first]), distance.relation([second])
        assert distance.members(distance.compose(r, s)) == expected
        assert distance.compose(s, r) == distance.compose(r, s)


@settings(max_examples=100, deadline=None)
@given(st.lists(st.tuples(st.integers(-40, 40), st.integers(-40, 40)), min_size=3, max_size=3))
def test_points_of_the_plane_show_only_listed_compositions(points: list[tuple[int, int]]) -> None:
    distance = distance_calculus()

    def code(i: int, j: int) -> int:
        length = float(np.hypot(points[i][0] - points[j][0], points[i][1] - points[j][1])) / 10
        return 0 if length == 0 else 1 + bisect_left(DEFAULT_RANGES.bounds, length)

    assert distance.compose(1 << code(0, 1), 1 << code(1, 2)) >> code(0, 2) & 1


def test_closure_does_not_decide_distances() -> None:
    """Give 25 points, any two more than 1 and at most 3 apart: the network is closed, and the plane too small.

    Jung: they lie in a disc of radius √3; discs of radius ½ around them would be disjoint, 25 · π/4 = 19.6 in area,
    within a disc of radius √3 + ½, which has 15.7.
    """
    distance = distance_calculus()
    medium = distance.relation(["medium"])
    assert distance.compose(medium, medium) & medium == medium
    assert not distance.decided_by_closure
    assert 25 / 4 > (3**0.5 + 0.5) ** 2


@pytest.mark.parametrize(
    ("names", "bounds", "message"),
    [
        ((), (), "must be 1 to 63, got 0"),
        (tuple(map(str, range(64))), tuple(map(float, range(1, 64))), "must be 1 to 63, got 64"),
        (("near", "far"), (), "2 ranges of distance need 1 bounds"),
        (("near", "mid", "far"), (2.0, 1.0), "must rise"),
        (("near", "mid", "far"), (1.0, 1.0), "must rise"),
        (("near", "far"), (0.0,), "must rise"),
        (("near", "far"), (-1.0,), "must rise"),
        (("near", "far"), (float("nan"),), "must rise"),
        (("near", "far"), (float("inf"),), "must rise"),
        (("same", "far"), (1.0,), "must differ from one another and from 'same'"),
        (("near", "near"), (1.0,), "must differ from one another"),
    ],
)
def test_invalid_ranges_are_refused(names: tuple[str, ...], bounds: tuple[float, ...], message: str) -> None:
    with pytest.raises(SettingError, match=message):
        Ranges(names, bounds)
