"""Test boxes as the proof that networks in several calculi are consistent: found if there are any, always verified."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from bench_joint import COMBINATIONS
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from timing import processor_time_below

from deixis.deadline import Deadline
from deixis.reasoning.qualitative.calculi.bridges import links_between, to_ra
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.closure.algebraic import close
from deixis.reasoning.qualitative.networks.combination import close_jointly, joint_conflict, solve_jointly
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.realisation.boxes import find_boxes, satisfies
from deixis.reasoning.qualitative.networks.search.consistency import Verdict, solve
from deixis.reasoning.qualitative.relate import relate

NAMES = (*COMBINATIONS, "ten+ra+cd+distance+rcc8+direction-distance")
Boxes = NDArray[np.float64]


def networks_of(names: str, boxes: Boxes, rng: np.random.Generator, share: float, others: float) -> list[Network]:
    """Return the relations of boxes for a share of the pairs in each calculus, with other atoms beside them."""
    found, n = [], len(boxes)
    for name in names.split("+"):
        codes, atoms = relate(boxes, name, reference=1.0), len(calculus(name).atoms)
        stated = []
        for i, j in np.argwhere(rng.random((n, n)) < share).tolist():
            more = np.flatnonzero(rng.random(atoms) < others).tolist()
            stated.append(
                Constraint(i, j, 1 << int(codes[i, j]) | sum(1 << k for k in more if i != j and k != codes[i, j]))
            )
        found.append(Network(calculus(name), n, tuple(stated)))
    return found


def random_boxes(n: int, rng: np.random.Generator) -> Boxes:
    centres, halves = rng.integers(0, 16, (n, 2)) / 4, rng.integers(1, 8, (n, 2)) / 4
    return np.stack([centres - halves, centres + halves], axis=1)


def solved(networks: list[Network]) -> tuple[Verdict, Boxes | None]:
    links = links_between([network.calculus for network in networks])
    found = solve_jointly(networks, links, Deadline.after(60.0), scenario=True)
    return found.verdict, found.boxes


def atom_by_hand(name: str, a: list[list[Fraction]], b: list[list[Fraction]]) -> str:
    """Return the atom of two boxes by the definitions, in exact numbers."""
    signs = {-1: "<", 0: "=", 1: ">"}
    centres = [(a[0][k] + a[1][k] - b[0][k] - b[1][k]) / 2 for k in (0, 1)]
    squared = centres[0] ** 2 + centres[1] ** 2
    reach = "same" if squared == 0 else "near" if squared <= 1 else "medium" if squared <= 9 else "far"
    tile = "NS"[centres[1] < 0] * (centres[1] != 0) + "EW"[centres[0] < 0] * (centres[0] != 0) or "EQ"
    if name == "cd":
        return tile
    if name == "distance":
        return reach
    if name == "direction-distance":
        return f"{tile},{reach}"
    if name == "rcc8":
        if any(a[1][k] < b[0][k] or b[1][k] < a[0][k] for k in (0, 1)):
            return "DC"
        if any(a[1][k] == b[0][k] or b[1][k] == a[0][k] for k in (0, 1)):
            return "EC"
        if a == b:
            return "EQ"
        for first, second, converse in ((a, b, ""), (b, a, "I")):
            if all(second[0][k] < first[0][k] and first[1][k] < second[1][k] for k in (0, 1)):
                return f"NTPP{converse}"
            if all(second[0][k] <= first[0][k] and first[1][k] <= second[1][k] for k in (0, 1)):
                return f"TPP{converse}"
        return "PO"
    assert name == "ra"
    by_order = {"<<": "o", ">>": "oi", "<>": "di", "><": "d", "=<": "s", "=>": "si", "<=": "fi", ">=": "f", "==": "="}
    parts = []
    for k in (0, 1):
        (a0, a1), (b0, b1) = (a[0][k], a[1][k]), (b[0][k], b[1][k])
        if a1 <= b0 or b1 <= a0:
            parts.append("<" if a1 < b0 else "m" if a1 == b0 else "mi" if b1 == a0 else ">")
            continue
        begin, end = signs[(a0 > b0) - (a0 < b0)], signs[(a1 > b1) - (a1 < b1)]
        parts.append(by_order[begin + end])
    return ",".join(parts)


def holds_by_hand(boxes: Boxes, network: Network) -> bool:
    """Return True if boxes satisfy a network, computed in exact numbers by independent code."""
    exact = [[[Fraction(value) for value in corner] for corner in box] for box in boxes.tolist()]
    chosen, ra = network.calculus, calculus("ra")
    for c in network.constraints:
        name, relation = (chosen.name, c.relation) if chosen.name != "ten" else ("ra", to_ra(c.relation))
        atom = atom_by_hand(name, exact[c.first], exact[c.second])
        if not relation >> (ra if chosen.name == "ten" else chosen).code(atom) & 1:
            return False
    return True


@pytest.mark.parametrize("names", NAMES)
def test_relations_of_boxes_are_satisfied_by_found_boxes(names: str) -> None:
    for seed, (share, others) in enumerate([(1.0, 0.0), (0.6, 0.2), (0.3, 0.4), (0.2, 0.05)]):
        rng = np.random.default_rng([seed, len(names)])
        networks = networks_of(names, random_boxes(7, rng), rng, share, others)
        verdict, boxes = solved(networks)
        assert verdict is Verdict.CONSISTENT and boxes is not None
        assert all(holds_by_hand(boxes, network) for network in networks)


@settings(max_examples=60)
@given(st.integers(0, 2**32 - 1), st.sampled_from(NAMES), st.integers(1, 4))
def test_verdicts_on_random_networks_agree_with_sampled_boxes(seed: int, names: str, n: int) -> None:
    """Check that networks of sampled boxes are never refuted, and that consistent ones have boxes."""
    rng = np.random.default_rng(seed)
    networks = []
    for name in names.split("+")[:3]:
        chosen = calculus(name)
        pairs = [(i, j) for i in range(n) for j in range(i) if rng.random() < 0.7]
        width = rng.choice([0.1, 0.3, 0.6])
        masks = [sum(1 << int(k) for k in np.flatnonzero(rng.random(len(chosen.atoms)) < width)) for _ in pairs]
        stated = tuple(Constraint(i, j, mask) for (i, j), mask in zip(pairs, masks, strict=True))
        networks.append(Network(chosen, n, stated))
    verdict, found = solved(networks)
    if verdict is Verdict.CONSISTENT and found is not None:
        assert all(holds_by_hand(found, network) for network in networks)
    some = (random_boxes(n, rng) for _ in range(20))
    if verdict is Verdict.INCONSISTENT:
        assert not any(all(satisfies(boxes, network) for network in networks) for boxes in some)


def test_a_contradiction_is_never_called_consistent() -> None:
    """Contradict in one calculus what follows in another, for a pair without a stated relation."""
    for seed in range(25):
        rng = np.random.default_rng(seed)
        names = COMBINATIONS[seed % 4]
        first, second = (network for network in networks_of(names, random_boxes(6, rng), rng, 0.5, 0.05))
        (link,) = links_between([first.calculus, second.calculus])
        if link.source is not first.calculus:
            first, second = second, first
        closure = close(first)
        excluded = [
            (i, j, second.calculus.universal & ~link.forward(closure.relation(i, j)))
            for i in range(6)
            for j in range(i)
            if not any({c.first, c.second} == {i, j} for c in first.constraints)
        ]
        for i, j, relation in [each for each in excluded if each[2]][:2]:
            contrary = second.only([*second.constraints, Constraint(i, j, relation)])
            assert solved([first, contrary])[0] is not Verdict.CONSISTENT


def test_only_boxes_refute_what_closure_accepts() -> None:
    """Put a's centre left of b's and b's left of c's, with sides that only search excludes."""
    lines = [(3, 0, "m s"), (3, 1, "o"), (3, 2, "m s"), (0, 1, "d di"), (1, 2, "d di"), (0, 2, "f fi")]
    ra, cd = calculus("ra"), calculus("cd")
    boxes = Network(
        ra, 4, tuple(Constraint(i, j, ra.relation(f"{s},=" for s in said.split())) for i, j, said in lines[:-1])
    )
    assert solve(boxes).verdict is Verdict.CONSISTENT
    ending_level = ra.relation(["f,=", "fi,="])
    points = Network(cd, 4, (Constraint(0, 2, cd.relation(["W", "E"])),))
    links = links_between([ra, cd])
    whole = [boxes.only([*boxes.constraints, Constraint(0, 2, ending_level | 1 << ra.identity)]), points]
    assert solve(whole[0]).verdict is Verdict.CONSISTENT
    solution = solve_jointly(whole, links)
    assert solution.verdict is Verdict.INCONSISTENT
    conflict = joint_conflict(whole, links)
    assert conflict is not None and {name for name, _ in conflict.constraints} == {"ra", "cd"}


def test_regions_other_than_boxes_stay_undecided() -> None:
    """Give an L beside a box in its notch: apart, although one bounding box is within the other."""
    ra, rcc8 = calculus("ra"), calculus("rcc8")
    networks = [
        Network(ra, 2, (Constraint(0, 1, ra.relation(["d,d"])),)),
        Network(rcc8, 2, (Constraint(0, 1, rcc8.relation(["DC"])),)),
    ]
    solution = solve_jointly(networks, links_between([ra, rcc8]))
    assert solution.verdict is Verdict.UNDECIDED
    assert "regions of other shapes may" in solution.reason


def test_points_that_do_not_fit_the_plane_stay_undecided() -> None:
    distance = calculus("distance")
    medium = distance.relation(["medium"])
    pairs = tuple(Constraint(i, j, medium) for i in range(25) for j in range(i))
    solution = solve_jointly([Network(distance, 25, pairs)], (), Deadline.after(1.0))
    assert solution.verdict is Verdict.UNDECIDED and solution.boxes is None


def test_the_deadline_holds() -> None:
    rng = np.random.default_rng(1)
    networks = networks_of("ra+cd+distance", random_boxes(40, rng), rng, 0.5, 0.2)
    links = links_between([network.calculus for network in networks])
    with processor_time_below(2.0):
        solution = solve_jointly(networks, links, Deadline.after(0.2))
    assert solution.verdict is Verdict.CONSISTENT or "time limit" in solution.reason


def test_the_same_seed_finds_the_same_boxes() -> None:
    rng = np.random.default_rng(3)
    networks = networks_of("cd+distance", random_boxes(8, rng), rng, 0.5, 0.2)
    closure = close_jointly(networks, links_between([network.calculus for network in networks]))
    first, second = (find_boxes(networks, closure.relation) for _ in range(2))
    assert first.boxes is not None and second.boxes is not None
    assert (first.boxes == second.boxes).all()


def test_calculi_without_boxes_are_reported() -> None:
    point = calculus("point")
    found = find_boxes([Network(point, 1, ())], lambda name, i, j: point.universal)
    assert found.boxes is None and "point" in found.reason
