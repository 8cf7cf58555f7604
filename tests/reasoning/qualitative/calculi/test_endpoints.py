"""Compare the calculi of ordered numbers with the published table and with numbers themselves."""

from __future__ import annotations

from itertools import product
from typing import cast

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.ontology.relations.allen import SYMBOLS
from deixis.reasoning.qualitative.calculi.calculus import ProductCalculus
from deixis.reasoning.qualitative.calculi.registry import calculus

# Allen 1983, Figure 4, with his "=" row and column, which the figure leaves out. One letter an atom, as is usual for
# so long a table: p m o s d f are <, m, o, s, d, f; capitals are their converses; e is =.
LETTERS = dict(zip("pmoFDseSdfOMP", SYMBOLS, strict=True))
ROWS = {
    "p": "p p p p p p p p pmosd pmosd pmosd pmosd *",
    "m": "p p p p p m m m osd osd osd Fef DSOMP",
    "o": "p p pmo pmo pmoFD o o oFD osd osd oFDseSdfO DSO DSOMP",
    "F": "p m o F D o F D osd Fef DSO DSO DSOMP",
    "D": "pmoFD oFD oFD D D oFD D D oFDseSdfO DSO DSO DSO DSOMP",
    "s": "p p pmo pmo pmoFD s s seS d d dfO M P",
    "e": "p m o F D s e S d f O M P",
    "S": "pmoFD oFD oFD D D seS S S dfO O O M P",
    "d": "p p pmosd pmosd * d d dfOMP d d dfOMP P P",
    "f": "p m osd Fef DSOMP d f OMP d f OMP P P",
    "O": "pmoFD oFD oFDseSdfO DSO DSOMP dfO O OMP dfO O OMP P P",
    "M": "pmoFD seS dfO M P dfO M P dfO M P P P",
    "P": "* dfOMP dfOMP P P dfOMP P P dfOMP P P P P",
}


def test_allen_compositions_are_the_published_ones() -> None:
    allen = calculus("allen")
    for first, row in ROWS.items():
        for second, entry in zip(LETTERS, row.split(), strict=True):
            expected = LETTERS.values() if entry == "*" else [LETTERS[letter] for letter in entry]
            found = allen.compose(allen.relation([LETTERS[first]]), allen.relation([LETTERS[second]]))
            assert set(allen.members(found)) == set(expected), (first, second)


def test_point_compositions_are_those_of_numbers() -> None:
    point = calculus("point")
    expected = {"<<": "<", "<=": "<", "<>": "<=>", "=<": "<", "==": "=", "=>": ">", "><": "<=>", ">=": ">", ">>": ">"}
    for signs, entry in expected.items():
        composed = point.compose(point.relation(signs[0]), point.relation(signs[1]))
        assert "".join(point.members(composed)) == entry


def test_allen_compositions_hold_for_random_intervals() -> None:
    """Draw intervals with ends far from the six numbers from which the table was derived."""
    allen, rng = calculus("allen"), np.random.default_rng(7)
    ends = np.sort(rng.integers(0, 9, (3, 60_000, 2)), axis=2)
    a, b, c = ends[:, (ends[:, :, 0] < ends[:, :, 1]).all(axis=0)]
    seen: dict[tuple[int, int], int] = {}
    for first, second, third in set(zip(_allen(a, b), _allen(b, c), _allen(a, c), strict=True)):
        seen[first, second] = seen.get((first, second), 0) | 1 << third
    assert seen == {(i, j): allen.compose(1 << i, 1 << j) for i, j in product(range(13), repeat=2)}


def _allen(
    a: np.ndarray[tuple[int, int], np.dtype[np.int64]], b: np.ndarray[tuple[int, int], np.dtype[np.int64]]
) -> list[int]:
    """Return the atoms by the signs of the four differences, written out independently."""
    by_signs = {
        (-1, -1, -1, -1): "<", (-1, -1, 0, -1): "m", (-1, -1, 1, -1): "o", (-1, 0, 1, -1): "fi", (-1, 1, 1, -1): "di",
        (0, -1, 1, -1): "s", (0, 0, 1, -1): "=", (0, 1, 1, -1): "si", (1, -1, 1, -1): "d", (1, 0, 1, -1): "f",
        (1, 1, 1, -1): "oi", (1, 1, 1, 0): "mi", (1, 1, 1, 1): ">",
    }  # fmt: skip
    differences = [a[:, 0] - b[:, 0], a[:, 1] - b[:, 1], a[:, 1] - b[:, 0], a[:, 0] - b[:, 1]]
    signs = np.sign(np.stack(differences, axis=1)).tolist()
    return [SYMBOLS.index(by_signs[tuple(row)]) for row in signs]


def test_directions_compose_like_points_of_a_grid() -> None:
    cd = calculus("cd")
    step = {"N": (0, 1), "NE": (1, 1), "E": (1, 0), "SE": (1, -1), "S": (0, -1), "SW": (-1, -1), "W": (-1, 0)}
    tile = {signs: name for name, signs in (step | {"NW": (-1, 1), "EQ": (0, 0)}).items()}
    grid = list(product(range(-3, 4), repeat=2))
    seen: dict[tuple[str, str], set[str]] = {}
    for p, q in product(grid, repeat=2):
        r = (p[0] + q[0], p[1] + q[1])
        first, second, third = (tile[int(np.sign(v[0])), int(np.sign(v[1]))] for v in (p, q, r))
        seen.setdefault((first, second), set()).add(third)
    for (first, second), expected in seen.items():
        assert set(cd.members(cd.compose(cd.relation([first]), cd.relation([second])))) == expected
    assert len(seen) == 81


@settings(max_examples=25, deadline=None)
@given(st.data())
def test_products_compose_and_convert_atom_by_atom(data: st.DataObject) -> None:
    """Compare composition by groups of products with composition of single atoms."""
    ra = cast(ProductCalculus, calculus("ra"))
    x, y = ra.axes
    codes = st.lists(st.tuples(st.integers(0, 12), st.integers(0, 12)), max_size=8)
    first, second = data.draw(codes), data.draw(codes)
    r, s = (sum(1 << ra.code_of(pair) for pair in set(pairs)) for pairs in (first, second))
    composed = 0
    for (ax, ay), (bx, by) in product(first, second):
        for cx, cy in product(range(13), repeat=2):
            if x.compose(1 << ax, 1 << bx) >> cx & 1 and y.compose(1 << ay, 1 << by) >> cy & 1:
                composed |= 1 << ra.code_of((cx, cy))
    assert ra.compose(r, s) == composed
    assert ra.converse(r) == sum(1 << ra.code_of((12 - i, 12 - j)) for i, j in set(first))


def test_numbers_of_atoms_of_the_products() -> None:
    assert [len(calculus(name).atoms) for name in ("cd", "ra", "ba")] == [9, 169, 2197]
