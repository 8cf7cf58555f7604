"""Evidence of claims: places, orders, distances and arrangements."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.grammar.english.reader import read_english
from deixis.ontology.graph.claims import Claim
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.grounding.evidence.claims.claims import MAX_THINGS, ClaimTables, claim_tables, ordinal_degrees
from deixis.reasoning.grounding.evidence.words.meaning import OUTLIERS, shipped_models
from deixis.workflows.grounding.ground import GroundingRequest, ground

R = default_ontology().relations


def cube(x: float, y: float, side: float = 0.1, height: float = 0.1, low: float = 0.0) -> list[list[float]]:
    return [[x - side / 2, y - side / 2, low], [x + side / 2, y + side / 2, low + height]]


# 0 far left, 1 far right, 2 centre, 3 near left, 4 near right, and 5 right of the centre
TABLE = np.array([cube(0, 1), cube(2, 1), cube(1, 0.5), cube(0, 0), cube(2, 0), cube(1.5, 0.5, 0.2, 0.4)])


def said(claims: list[Claim], names: str = "s a b", boxes: np.ndarray = TABLE, metric: bool = True) -> ClaimTables:
    nodes = names.split()
    return claim_tables(claims, nodes, boxes, R, shipped_models(), np.zeros((len(nodes), len(boxes))), metric)


@pytest.mark.parametrize(
    ("term", "value", "best"),
    [
        ("corner", "far left", {0}),
        ("corner", "near right", {4}),
        ("corner", None, {0, 1, 3, 4}),
        ("corner", "far", {0, 1}),
        ("middle", None, {2}),
        ("edge", "near", {3, 4}),
        ("end", "left", {0, 3}),
        ("part", "right", {1, 4}),
        ("part", "back", {0, 1}),
        ("part", "far right", {1}),
        ("part", "middle", {2}),
        ("tallest", None, {5}),
        ("largest", None, {5}),
        ("size", "big", {5}),
        ("rightmost", None, {1, 4}),
    ],
)
def test_a_claim_about_one_thing_favours_its_prototypes(term: str, value: str | None, best: set[int]) -> None:
    ratios = said([Claim(term, ("s",), value=value)]).unary[0]
    assert set(np.flatnonzero(np.isclose(ratios, ratios.max(), atol=0.05)).tolist()) == best
    assert ratios.max() > 0 > ratios.min()


def test_a_denied_claim_favours_the_other_things() -> None:
    ratios = said([Claim("corner", ("s",), value="far left", positive=False)]).unary[0]
    assert ratios.argmin() == 0


def test_between_favours_the_thing_on_the_line() -> None:
    found = said([Claim("between", ("s",), ("a", "b"))])
    assert {tuple(ends) for ends in found.ends.tolist()} == {(0, 1), (0, 2)}
    of_a = found.tables[found.ends.tolist().index([0, 1])]
    assert of_a[2, 0] > 0 > of_a[0, 2]  # the centre is between, the corner is not


def test_the_third_object_is_taken_by_its_own_evidence() -> None:
    known = np.zeros((3, len(TABLE)))
    known[2, 4] = 20.0
    found = claim_tables([Claim("between", ("s",), ("a", "b"))], ["s", "a", "b"], TABLE, R, shipped_models(), known)
    of_a = found.tables[found.ends.tolist().index([0, 1])]
    assert of_a[2, 0] > of_a[2, 1] + 1  # from corner to corner through the centre


def test_a_distance_favours_pairs_at_that_distance() -> None:
    table = said([Claim("distance", ("s",), ("a",), metres=1.0)]).tables[0]
    assert table[0, 3] > 0 > table[0, 4]


def test_a_distance_in_pixels_says_nothing() -> None:
    assert len(said([Claim("distance", ("s",), ("a",), metres=1.0)], metric=False).ends) == 0


def test_nearest_favours_the_nearest_thing() -> None:
    table = said([Claim("nearest", ("s",), ("a",))]).tables[0]
    assert table[:, 2].argmax() == 5


def test_a_row_from_left_to_right_orders_neighbours() -> None:
    found = said([Claim("row", ("s", "a", "b"), value="left to right")])
    assert found.ends.tolist() == [[0, 1], [1, 2]]
    assert found.tables[0][0, 1] > 0 > found.tables[0][1, 0]


def test_nothing_on_a_thing_rules_out_what_carries_something() -> None:
    boxes = np.array([cube(0, 0, 0.3), cube(1, 0, 0.3), cube(0, 0, 0.1, low=0.1)])
    bare = said([Claim("none_on", ("s",))], boxes=boxes).unary[0]
    assert bare[1] > bare[0]
    standing = said([Claim("on", ("s",))], boxes=boxes).unary[0]
    assert standing[0] == standing[1] > standing[2]


@pytest.mark.parametrize(
    "claim",
    [
        Claim("material", ("s",), value="glass"),
        Claim("corner", ("s",), value="left right"),
        Claim("corner", ("other",), value="far left"),
        Claim("colour", ("s",), value="red"),
    ],
)
def test_undecidable_claims_are_neutral(claim: Claim) -> None:
    found = said([claim])
    assert not found.unary.any() and not len(found.ends)


def test_claims_in_very_large_scenes_are_neutral() -> None:
    many = np.array([cube(i, i) for i in range(MAX_THINGS + 1)])
    assert not said([Claim("corner", ("s",))], boxes=many).unary.any()


TERMS = [
    Claim("corner", ("s",), value="far left"),
    Claim("edge", ("s",)),
    Claim("corner", ("s",), ("a",), "left"),
    Claim("between", ("s",), ("a", "b")),
    Claim("closer", ("s",), ("a", "b")),
    Claim("closer", ("s",), ("a",), "edge"),
    Claim("distance_more", ("s",), ("a",), metres=0.3),
    Claim("smallest", ("s",)),
    Claim("shortest", ("s",), ("a", "b")),
    Claim("row", ("s", "a", "b")),
    Claim("near_each_other", ("s", "a")),
    Claim("parallel", ("s",), value="near edge"),
    Claim("in_front", ("s",), value="viewer"),
]


@settings(max_examples=25, deadline=None)
@given(
    st.sampled_from(TERMS),
    st.lists(st.tuples(*[st.integers(0, 9)] * 3, st.integers(0, 3)), min_size=2, max_size=6),
    st.booleans(),
    st.sampled_from([0.3, 1.0]),
)
def test_evidence_is_finite_and_bounded(
    claim: Claim, places: list[tuple[int, ...]], positive: bool, weight: float
) -> None:
    boxes = np.array([cube(x / 5, y / 5, size / 10, size / 20) for x, y, size, _ in places])
    shown = Claim(claim.relation, claim.subjects, claim.arguments, claim.value, claim.metres, positive, False, weight)
    found = said([shown], boxes=boxes)
    most = -np.log(OUTLIERS) + 1e-6
    for table in (found.unary, found.tables):
        assert np.isfinite(table).all() and (np.abs(table) <= most).all()


def test_a_text_with_places_grounds_things_without_labels() -> None:
    text = "The lamp is in the far left corner. The mug is in the middle. The lamp is left of the pen."
    things = [
        {"id": name, "min": box[0], "max": box[1]}
        for name, box in zip("pqrtu", TABLE[[0, 1, 2, 3, 4]].tolist(), strict=True)
    ]
    found = ground(read_english(text), {"objects": things}, sizes=False).matches
    assert (found["lamp"].perceived, found["mug"].perceived) == ("p", "r")


def test_scripts_without_claims_have_the_same_problem() -> None:
    from deixis.grammar.layout.parser import parse_script
    from deixis.workflows.layouts.read import as_scene

    things = [{"id": name, "min": box[0], "max": box[1]} for name, box in zip("pq", TABLE[:2].tolist(), strict=True)]
    request = GroundingRequest(parse_script("cup left of jug"), as_scene({"objects": things}))
    evidence = request.evidence(request.scene)
    assert evidence.claims == () and len(evidence.problem.ends) == len(evidence.facts) == 1


@pytest.mark.parametrize("options", [{}, {"literal": True}, {"viewpoint": "quarter"}, {"engine": "scalable"}])
def test_only_facts_are_pivotal_beside_claims(options: dict[str, Any]) -> None:
    text = "The mug is between the lamp and the pen. The lamp is left of the pen. The mug is right of the lamp."
    things = [{"id": name, "min": box[0], "max": box[1]} for name, box in zip("pqr", TABLE[:3].tolist(), strict=True)]
    script = read_english(text)
    found = ground(script, {"objects": things}, sizes=False, **options)
    assert len(found.matches) == 3
    assert {str(one.fact) for one in found.pivotal or ()} <= {str(fact) for fact in script.facts}


@settings(max_examples=20)
@given(st.lists(st.floats(0, 1), min_size=2, max_size=6), st.integers(0, 10**6))
def test_ranks_from_a_side_share_the_members_before_a_thing(chances: list[float], seed: int) -> None:
    n = len(chances)
    centres = np.random.default_rng(seed).permutation(n)[:, None] * np.ones(2)
    ranks = (ordinal_degrees(f"{rank} from left", centres, np.array(chances)) for rank in range(1, n + 1))
    found = [one for one in ranks if one is not None]
    np.testing.assert_allclose(sum(found), 1.0)
    by_hand = [np.prod([1 - chances[s] for s in range(n) if centres[s, 0] < centres[t, 0]]) for t in range(n)]
    np.testing.assert_allclose(found[0], by_hand)


def test_an_ordinal_counts_the_things_that_can_be_in_its_group() -> None:
    boxes = np.array([cube(float(x), 0.0) for x in range(5)])
    unary = np.zeros((3, 5))
    unary[:, [0, 3]] = -20.0  # not a fork
    claim = Claim("ordinal", ("b",), ("a", "c"), value="2 from left")
    found = claim_tables([claim], ["a", "b", "c"], boxes, R, shipped_models(), unary).unary
    assert found[1, [1, 2, 4]].argmax() == 1 and not found[[0, 2]].any()


@pytest.mark.parametrize("value", ["", "0 from left", "two from left", "2 from above"])
def test_an_unknown_order_says_nothing(value: str) -> None:
    assert ordinal_degrees(value, TABLE.mean(axis=1), np.ones(len(TABLE))) is None


def test_two_things_on_each_side_have_the_third_between_them() -> None:
    claims = [Claim("each_side", ("a",), ("s",)), Claim("each_side", ("b",), ("s",))]
    tables = said(claims)
    pairs = [tuple(ends) for ends in tables.ends.tolist()]
    assert {(0, 1), (0, 2)} <= {tuple(sorted(pair)) for pair in pairs}
    beside = tables.tables[pairs.index((1, 0))]
    assert beside[5, 2] > beside[3, 2]
