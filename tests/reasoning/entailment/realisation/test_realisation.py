"""Pictures of facts satisfy the facts or do not exist, as brute force confirms."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from itertools import permutations, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.relations.relation import Reading
from deixis.ontology.tbox import default_ontology
from deixis.ontology.things.sizes import Extent, Outline, SizeRange
from deixis.reasoning.entailment.realisation.picture import MAX_PICTURED, Impossible, Picture, Undecided, realise
from deixis.reasoning.entailment.realisation.verification import facts_that_are_named, facts_that_hold
from deixis.reasoning.errors import LimitError
from deixis.reasoning.geometry.allen import allen_relations

ONTOLOGY = default_ontology()
R = ONTOLOGY.relations
ALL = [r for r in R.values() if r.reading is not Reading.GRADED]  # words that order edges
ANY = ONTOLOGY.sizes.of(None)
NAMES = "abc"

FACTS = st.builds(
    lambda ends, names, positive: Fact(ends[0], tuple(dict.fromkeys(names)), ends[1], positive),
    st.permutations(NAMES).map(lambda names: names[:2]),
    st.lists(st.sampled_from(ALL), min_size=1, max_size=3),
    st.sampled_from([True, True, False]),
)


def graph(*facts: Fact, nodes: str = NAMES) -> RelationGraph:
    return RelationGraph.from_facts(R, list(nodes), facts)


def fact(subject: str, words: str, thing: str, **more: object) -> Fact:
    made = Fact(subject, tuple(R[word] for word in words.split("|")), thing)
    return replace(made, **more)  # type: ignore[arg-type]


def picture(*facts: Fact, nodes: str = NAMES) -> Picture:
    found = realise(graph(*facts, nodes=nodes), [ANY] * len(nodes))
    assert isinstance(found, Picture)
    return found


# ---- compared with brute force ----------------------------------------------------------------------------------


@lru_cache(maxsize=1)
def scenarios() -> NDArray[np.int8]:
    """Return all consistent atomic networks of three intervals, shape (409, 3, 3); six different end points suffice."""
    intervals = [(low, high) for low in range(6) for high in range(low + 1, 6)]
    ends = np.array(list(product(intervals, repeat=3)), dtype=np.float64)
    a, b = ends[:, :, None], ends[:, None]
    return np.unique(allen_relations(a[..., 0], a[..., 1], b[..., 0], b[..., 1]), axis=0)


def possible(facts: list[Fact]) -> bool:
    """Return whether some three boxes, stacked in some order, satisfy the facts, by trying all.

    If the plan leaves open which of two boxes lies on the other, the stacking order decides.
    """
    orders = np.array(list(permutations(range(3))))
    s = scenarios()
    ok = np.ones((len(s), len(s), len(orders)), dtype=np.bool_)
    for f in facts:
        a, b = NAMES.index(f.subject), NAMES.index(f.object)
        above = orders[:, a] > orders[:, b]
        holds = np.zeros((13, 13, len(orders)), dtype=np.bool_)
        for relation in f.relations:
            shared = relation.admits() & R[relation.inverse].admits()
            holds |= (relation.admits() & ~shared)[..., None]
            holds |= shared[..., None] & (above if relation.word == "on" else ~above)
        ok &= (holds if f.positive else ~holds)[s[:, a, b][:, None], s[:, a, b][None]]
    return bool(ok.any())


def test_three_intervals_have_409_scenarios() -> None:
    assert len(scenarios()) == 409


@settings(max_examples=60, deadline=None)
@given(st.lists(FACTS, min_size=1, max_size=7))
def test_pictures_and_minimal_conflicts_match_brute_force(facts: list[Fact]) -> None:
    found = realise(graph(*facts), [ANY] * 3, any_size=True)
    assert isinstance(found, Picture) == possible(facts)
    if isinstance(found, Impossible):
        conflict = [facts[edge] for edge in found.edges]
        assert found.minimal
        assert found.sizes == ()
        assert not possible(conflict)
        assert all(possible(conflict[:i] + conflict[i + 1 :]) for i in range(len(conflict)))


def small(outline: Outline, length: tuple[int, int], width: tuple[int, int]) -> SizeRange:
    """Return the size range of an object in whole millimetres."""
    ends = [Extent(low / 1000, low / 1000, high / 1000) for low, high in (length, width)]
    return SizeRange(outline, ends[0], ends[1], ends[0], "thing", "made up")


SIDES = st.tuples(st.integers(1, 4), st.integers(0, 2)).map(lambda pair: (pair[0], sum(pair)))
SMALL = st.one_of(
    SIDES.map(lambda sides: small(Outline.CIRCLE, sides, sides)),
    st.builds(lambda a, b: small(Outline.RECTANGLE, max(a, b), min(a, b)), SIDES, SIDES),
)


def plans(size: SizeRange) -> list[tuple[int, int]]:
    """Return the possible sides along x and y, in both orientations."""
    (a, b), (c, d) = (
        (round(1000 * extent.least), round(1000 * extent.greatest)) for extent in (size.length, size.width)
    )
    upright = set(product(range(a, b + 1), range(c, d + 1)))
    return sorted(upright | {(y, x) for x, y in upright})


def fits(facts: list[Fact], sizes: list[SizeRange]) -> bool:
    """Return whether two boxes of these sizes satisfy the facts, by trying all positions in whole millimetres."""
    places = np.arange(-9, 10, dtype=np.float64)
    for (ax, ay), (bx, by) in product(plans(sizes[0]), plans(sizes[1])):
        x = allen_relations(np.zeros(19), np.full(19, float(ax)), places, places + bx)
        y = allen_relations(np.zeros(19), np.full(19, float(ay)), places, places + by)
        ok = np.ones((19, 19), dtype=np.bool_)
        for f in facts:
            turned = f.subject == "b"
            atoms = (12 - x, 12 - y) if turned else (x, y)
            cells = atoms[0][:, None], atoms[1][None]
            admitted = np.any([r.admits()[cells] for r in f.relations], axis=0)
            open_ = np.any([(r.admits() & R[r.inverse].admits())[cells] for r in f.relations], axis=0)
            ok &= (admitted == f.positive) & ~open_
        if ok.any():
            return True
    return False


@settings(max_examples=60, deadline=None)
@given(st.lists(FACTS.filter(lambda f: "c" not in (f.subject, f.object)), min_size=1, max_size=4), SMALL, SMALL)
def test_pictures_with_given_sizes_match_brute_force(facts: list[Fact], first: SizeRange, second: SizeRange) -> None:
    sizes = [first, second]
    found = realise(graph(*facts, nodes="ab"), sizes)
    if fits(facts, sizes):
        assert isinstance(found, Picture)
        sides = np.rint(1000 * (found.boxes[:, 1] - found.boxes[:, 0])).astype(int).tolist()
        assert all(tuple(side) in plans(size) for side, size in zip(sides, sizes, strict=True))
    else:
        assert isinstance(found, Impossible)


# ---- pictures ---------------------------------------------------------------------------------------------------


@settings(max_examples=60, deadline=None)
@given(st.lists(FACTS, max_size=6), st.integers(0, 3))
def test_every_firm_fact_holds_in_the_picture(facts: list[Fact], seed: int) -> None:
    g = graph(*facts)
    found = realise(g, [ANY] * 3, any_size=True, rng=np.random.default_rng(seed) if seed else None)
    if isinstance(found, Picture):
        assert facts_that_hold(g, found.boxes).all()
        wrong = np.flatnonzero(~facts_that_are_named(g, found.boxes))
        assert set(wrong.tolist()) == set(found.named_otherwise)
        assert not len(wrong) or found.overlapping
        assert (found.boxes[:, 1] > found.boxes[:, 0]).all()


def test_unrelated_objects_do_not_overlap() -> None:
    found = picture(*(fact(name, "left", "z") for name in "abcdefg"), nodes="abcdefgz")
    low, high = found.boxes[:, 0], found.boxes[:, 1]
    share = np.all((low[:, None] < high[None]) & (low[None] < high[:, None]), axis=2)
    assert share.sum() == 8  # each with itself
    assert found.finished


def test_a_forced_overlap_is_reported() -> None:
    denied = [fact("a", word, "b", positive=False) for word in ("left", "right", "top", "bottom", "on", "under")]
    found = picture(*denied, nodes="ab")
    assert found.overlapping == ((0, 1),)
    assert facts_that_hold(graph(*denied, nodes="ab"), found.boxes).all()


def test_a_hedged_fact_holds_if_possible() -> None:
    found = picture(fact("a", "left", "b", weight=0.2), nodes="ab")
    assert found.given_up == ()


def test_a_hedged_fact_against_a_firm_one_is_given_up() -> None:
    found = picture(fact("a", "left", "b"), fact("a", "right", "b", weight=0.8), fact("c", "on", "a"))
    assert [(entry.edge, entry.because) for entry in found.given_up] == [(1, (0,))]


def test_of_two_exclusive_facts_the_heavier_one_holds() -> None:
    light, heavy = fact("a", "left", "b", weight=0.2), fact("b", "left", "a", weight=0.8)
    assert [entry.edge for entry in picture(light, heavy, nodes="ab").given_up] == [0]
    assert [entry.edge for entry in picture(heavy, light, nodes="ab").given_up] == [1]


def test_a_demand_is_restored_after_its_rival_is_given_up() -> None:
    found = picture(
        fact("a", "left", "b"),
        fact("b", "left", "a", weight=0.7),
        fact("c", "left", "a", weight=0.5),
        nodes=NAMES,
    )
    assert [entry.edge for entry in found.given_up] == [1]


def test_round_kinds_are_as_long_as_wide() -> None:
    plate = ONTOLOGY.sizes.of(ONTOLOGY.kinds.of_word("dinner plate").iri)  # type: ignore[union-attr]
    found = realise(graph(fact("a", "left", "b"), nodes="ab"), [plate, plate])
    assert isinstance(found, Picture)
    sides = found.boxes[:, 1] - found.boxes[:, 0]
    assert sides == pytest.approx(np.full((2, 2), 0.27))


def test_an_empty_graph_has_an_empty_picture() -> None:
    found = realise(graph(nodes=""), [])
    assert isinstance(found, Picture)
    assert found.boxes.shape == (0, 2, 2)


def test_only_a_random_generator_varies_the_picture() -> None:
    g = graph(fact("a", "left|top", "b"), fact("b", "left", "c"))
    first, again = (realise(g, [ANY] * 3) for _ in range(2))
    drawn = [realise(g, [ANY] * 3, rng=np.random.default_rng(seed)) for seed in (1, 1, 2)]
    pictures = [p for p in (first, again, *drawn) if isinstance(p, Picture)]
    assert len(pictures) == 5
    same = [p.boxes.tobytes() for p in pictures]
    assert same[0] == same[1]
    assert same[2] == same[3]
    assert len(set(same)) == 3


def test_fifty_objects_are_laid_apart_in_a_few_seconds() -> None:
    """Picture facts that hold on a random table of fifty objects, some with a false alternative."""
    rng = np.random.default_rng(3)
    corners = np.stack(np.divmod(np.arange(50), 8), axis=1) * 0.3 + rng.uniform(0, 0.1, (50, 2))
    names = [f"thing_{i}" for i in range(50)]
    facts = []
    for a, b in (rng.choice(50, 2, replace=False) for _ in range(120)):
        x, y = np.sign(corners[a] - corners[b])
        words = [["left", "right"][int(x > 0)], ["bottom", "top"][int(y > 0)]]
        apart = np.abs(corners[a] - corners[b]) > 0.2
        true = [word for word, is_so in zip(words, apart, strict=True) if is_so]
        facts.append(fact(names[a], "|".join(dict.fromkeys([rng.choice(true), rng.choice(words)])), names[b]))
    spoon = ONTOLOGY.sizes.of(ONTOLOGY.kinds.of_word("teaspoon").iri)  # type: ignore[union-attr]
    g = RelationGraph.from_facts(R, names, facts)
    found = realise(g, [spoon] * 50, deadline=Deadline.after(60.0))
    assert isinstance(found, Picture)
    assert (found.finished, found.overlapping) == (True, ())


def test_too_many_objects_are_refused() -> None:
    names = [f"thing_{i}" for i in range(MAX_PICTURED + 1)]
    with pytest.raises(LimitError, match="got 501"):
        realise(RelationGraph.from_facts(R, names, []), [ANY] * len(names))


# ---- no picture -------------------------------------------------------------------------------------------------


def test_a_contradiction_by_exhaustion_is_proved_and_minimal() -> None:
    """Make every alternative of a choice close a cycle with another fact; the fact about c is not involved."""
    facts = [
        fact("a", "left|right|top|bottom", "b"),
        fact("a", "left", "b", positive=False),
        fact("a", "right", "b", positive=False),
        fact("c", "on", "a"),
        fact("b", "on", "a"),
    ]
    found = realise(graph(*facts), [ANY] * 3)
    assert isinstance(found, Impossible)
    assert (found.edges, found.sizes, found.minimal) == ((0, 4), (), True)


def test_objects_cannot_lie_on_one_another_in_a_cycle() -> None:
    found = realise(graph(fact("a", "on", "b"), fact("b", "on", "c"), fact("c", "on", "a")), [ANY] * 3)
    assert isinstance(found, Impossible)
    assert found.edges == (0, 1, 2)


def test_only_a_denied_relation_to_itself_has_a_picture() -> None:
    assert isinstance(realise(graph(fact("a", "left", "a")), [ANY] * 3), Impossible)
    assert isinstance(realise(graph(fact("a", "left", "a", positive=False)), [ANY] * 3), Picture)


def test_only_incompatible_sizes_are_reported() -> None:
    large, little = small(Outline.CIRCLE, (50, 60), (50, 60)), small(Outline.RECTANGLE, (30, 40), (10, 12))
    g = graph(fact("a", "on", "b"), fact("a", "left", "c"))
    found = realise(g, [large, little, little])
    assert isinstance(found, Impossible)
    assert (found.edges, found.sizes, found.minimal) == ((0,), (0, 1), True)
    assert isinstance(realise(g, [large, little, little], any_size=True), Picture)


def test_an_oblong_object_is_turned_if_necessary() -> None:
    tray = small(Outline.RECTANGLE, (50, 50), (12, 12))
    stick = small(Outline.RECTANGLE, (40, 40), (10, 10))
    g = graph(fact("a", "on", "b"), fact("c", "on", "b"), fact("a", "left", "c"))
    found = realise(g, [stick, tray, small(Outline.CIRCLE, (8, 8), (8, 8))])
    assert isinstance(found, Picture)
    sides = np.rint(1000 * (found.boxes[:, 1] - found.boxes[:, 0])).astype(int).tolist()
    assert sides[0] == [40, 10]
    assert sides[1] == [50, 12]


def test_at_an_early_deadline_the_answer_is_undecided() -> None:
    assert isinstance(realise(graph(fact("a", "left", "b")), [ANY] * 3, deadline=Deadline.after(0.0)), Undecided)
