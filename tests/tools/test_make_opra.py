"""Compare the tables of OPRA with oriented points of whole coordinates."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from make_opra import Opra, write
from numpy.typing import NDArray

RAYS = np.array([(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)])  # 45 degrees apart


def table(m: int) -> NDArray[np.bool_]:
    """Return which atoms three points can have: a to b, b to c and a to c, shape (atoms, atoms, atoms)."""
    opra = Opra(m)
    return np.array([[[opra.possible(a, b, c) for c in opra.atoms] for b in opra.atoms] for a in opra.atoms])


def direction(facing: NDArray[np.int64], towards: NDArray[np.int64], m: int) -> NDArray[np.int64]:
    """Return the direction of vectors (2, n) as seen facing (2, n), without rounding."""
    ahead = facing[0] * towards[0] + facing[1] * towards[1]
    left = facing[0] * towards[1] - facing[1] * towards[0]
    rays = RAYS[:: 4 // m]
    found = np.zeros(ahead.shape, dtype=np.int64)
    for k, (x, y) in enumerate(rays):
        beyond = x * left - y * ahead  # positive: further round than the ray
        found[(beyond == 0) & (x * ahead + y * left > 0)] = 2 * k
        before = np.roll(rays, -1, axis=0)[k][0] * left - np.roll(rays, -1, axis=0)[k][1] * ahead
        found[(beyond > 0) & (before < 0)] = 2 * k + 1
    return found


def observed(m: int, rounds: int) -> NDArray[np.bool_]:
    """Return True for the atoms observed between random oriented points, shape (atoms, atoms, atoms)."""
    count, rng = 4 * m + 16 * m * m, np.random.default_rng(20)
    seen = np.zeros((count, count, count), dtype=np.bool_)
    for number in range(rounds):
        reach = 1 + number % 3
        place, facing = rng.integers(-reach, reach + 1, (2, 3, 2, 200_000))
        facing[:, 0] += (facing == 0).all(axis=1)
        atoms = []
        for a, b in ((0, 1), (1, 2), (0, 2)):
            way = place[b] - place[a]
            apart = 4 * m + 4 * m * direction(facing[a], way, m) + direction(facing[b], -way, m)
            atoms.append(np.where((way == 0).all(axis=0), direction(facing[a], facing[b], m), apart))
        seen[tuple(atoms)] = True
    return seen


def test_the_table_of_granularity_1_agrees_with_points() -> None:
    assert (table(1) == observed(1, 12)).all()


def test_points_stay_within_the_table_of_granularity_2() -> None:
    possible, seen = table(2), observed(2, 6)
    assert not (seen & ~possible).any()
    assert seen.sum() > 0.9 * possible.sum()


@pytest.mark.parametrize("m", [1, 2, 3])
def test_opra_keeps_the_cycle_law(m: int) -> None:
    opra = Opra(m)
    rng = np.random.default_rng(m)
    for a, b, c in rng.integers(0, len(opra.atoms), (2_000, 3)):
        ab, bc, ac = opra.atoms[a], opra.atoms[b], opra.atoms[c]
        possible = opra.possible(ab, bc, ac)
        assert possible == opra.possible(opra.converse(bc), opra.converse(ab), opra.converse(ac))
        assert possible == opra.possible(ac, opra.converse(bc), ab)


def test_opra_is_written_in_three_files(tmp_path: Path) -> None:
    path = write(1, tmp_path / "made")
    assert path.name == "opra1.spec" and "calculus_size 20" in path.read_text(encoding="utf-8")
    lines = (path.parent / "opra1.comp").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 400 and "0_2 : 0_2 :: ( 0_2 )" in lines
