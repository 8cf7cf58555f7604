"""Check that every step of a derivation follows, its leaves are stated, and nothing in it is dispensable."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
from timing import processor_time_below

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import Source
from deixis.reasoning.constraints.proof import Rule
from deixis.reasoning.qualitative.calculi.calculus import ProductCalculus
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.closure.algebraic import close
from deixis.reasoning.qualitative.networks.closure.rounds import PairRelation, Rounds, Step, step_lines
from deixis.reasoning.qualitative.networks.conflict import minimal_conflict
from deixis.reasoning.qualitative.networks.derivation import contradiction, derive, explain
from deixis.reasoning.qualitative.networks.network import Constraint, Network

POINT, ALLEN, RA = calculus("point"), calculus("allen"), calculus("ra")


def assert_sound(step: Step, network: Network) -> None:
    chosen = network.calculus
    claim = step.claim
    if step.rule is Rule.STATED:
        ways = [(c.first, c.second, c.relation) for c in network.constraints]
        ways += [(c.second, c.first, chosen.converse(c.relation)) for c in network.constraints]
        assert (claim.first, claim.second, claim.relation) in ways
    elif step.rule is Rule.COMPOSITION:
        left, right = (premise.claim for premise in step.premises)
        assert (left.first, left.second, right.second) == (claim.first, right.first, claim.second)
        assert not chosen.compose(left.relation, right.relation) & ~claim.relation
    else:
        assert step.rule is Rule.CONJUNCTION
        together = chosen.universal
        for premise in step.premises:
            assert (premise.claim.first, premise.claim.second) == (claim.first, claim.second)
            together &= premise.claim.relation
        assert not together & ~claim.relation
    for premise in step.premises:
        assert_sound(premise, network)


@st.composite
def networks(draw: st.DrawFn) -> Network:
    chosen = calculus(draw(st.sampled_from(["point", "allen", "rcc8", "cd", "ra"])))
    pair = st.tuples(st.integers(0, 4), st.integers(0, 4)).filter(lambda p: p[0] != p[1])
    code = st.integers(0, len(chosen.atoms) - 1)
    stated = draw(st.lists(st.tuples(pair, code, code), min_size=1, max_size=8))
    return Network(chosen, 5, tuple(Constraint(i, j, 1 << a | 1 << b) for (i, j), a, b in stated))


@settings(max_examples=60, deadline=None)
@given(networks(), st.integers(0, 4), st.integers(0, 4))
def test_closed_relations_are_derived_soundly(network: Network, i: int, j: int) -> None:
    closed, step = close(network), explain(network, i, j)
    if not closed.consistent or i == j or closed.relation(i, j) == network.calculus.universal:
        assert step is None
        return
    assert step is not None
    assert step.claim == PairRelation(i, j, closed.relation(i, j))
    assert_sound(step, network)


@settings(max_examples=60, deadline=None)
@given(networks())
def test_minimal_conflicts_of_closure_are_derived(network: Network) -> None:
    if not close(network).consistent:
        conflict = minimal_conflict(network)
        assert conflict is not None
        thinned = network.only(conflict.constraints)
        step = contradiction(thinned)
        if close(thinned).consistent:  # search left out constraints that closure needs
            assert step is None
            return
        assert step is not None and step.claim.relation == 0
        assert_sound(step, network)


def test_the_shorter_of_two_derivations_is_chosen() -> None:
    before = POINT.relation(["<"])
    ends = [(0, 1), (1, 2), (2, 3), (3, 4), (0, 5), (5, 4)]
    stated = tuple(Constraint(i, j, before, Source("f", k, 1, k, 9)) for k, (i, j) in enumerate(ends, start=1))
    step = derive(Network(POINT, 6, stated), 0, 4, before)
    assert step is not None
    assert [leaf.source.line for leaf in step.leaves() if isinstance(leaf.source, Source)] == [5, 6]
    assert_sound(step, Network(POINT, 6, stated))


def test_a_wide_goal_needs_no_more_than_its_premises() -> None:
    assert isinstance(RA, ProductCalculus)
    x = RA.axes[0]
    left = RA.of_axes([x.relation(["<", "m"]), RA.axes[1].universal])
    exact = RA.of_axes([x.relation(["<"]), RA.axes[1].relation(["d"])])
    network = Network(RA, 3, (Constraint(0, 1, left), Constraint(1, 2, exact)), ("fork", "plate", "spoon"))
    step = derive(network, 0, 2, left)
    assert step is not None
    assert next(step_lines(step, network)) == "fork ( <; any ) spoon   composed"
    assert derive(network, 0, 2, exact) is None
    assert derive(network, 0, 2, RA.universal) is None


def test_rounds_keep_to_their_deadline() -> None:
    before = POINT.relation(["<"])
    network = Network(POINT, 300, tuple(Constraint(i, i + 1, before) for i in range(299)))
    with processor_time_below(2.0):
        assert Rounds(network).derive(0, 299, before, Deadline.after(0.2)) is None


def test_a_long_chain_is_derived_in_time() -> None:
    before = ALLEN.relation(["<"])
    network = Network(ALLEN, 60, tuple(Constraint(i, i + 1, before) for i in range(59)))
    step = derive(network, 0, 59, before)
    assert step is not None
    assert len(step.leaves()) == 59
