"""Explain a table as a layout with few mistakes: the most probable mistakes, and what each thing is.

A role of a layout is filled, or something is wrong with it: its thing is missing, lies elsewhere (*displaced*), is
turned in its place, or has changed places with that of another role (*swapped*). Things that fill no role are *extra*.
An explanation says this of every role. Its value adds up, in nats against chance, what each thing looks like, how it is
turned, which facts hold between the places of the roles, and the log-odds of each mistake. Facts about a displaced or
missing thing say nothing; those about a turned thing are compared with the thing as it should lie; those about swapped
things with the places exchanged.

The best explanation is found by steepest ascent from several starts: all changes of one or two roles are compared at
once. Probabilities are the shares of the explanations that were compared.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import IntEnum, StrEnum

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int64]

NOTHING = -1
"""Thing of a role that is not filled."""

KEPT_WITHIN = 12.0
"""Difference in nats to the best explanation beyond which an explanation is ignored."""

TURNED_ELSEWHERE = 0.1
"""Share of displaced things that lie in any direction; the others lie as they would in their places."""

MAX_STEPS = 60
"""Maximum number of changes in the ascent from one start."""


class MistakeKind(StrEnum):
    """Kinds of mistakes on a table."""

    MISSING = "missing"
    EXTRA = "extra"
    DISPLACED = "displaced"
    TURNED = "turned"
    SWAPPED = "swapped"


class State(IntEnum):
    """State of a role."""

    FILLED = 0
    MISSING = 1
    DISPLACED = 2
    TURNED = 3
    SWAPPED = 4


@dataclass(frozen=True, slots=True)
class MistakeOdds:
    """Log-odds in nats of each mistake: that a role has it, that a thing is extra, that two roles are swapped."""

    missing: float = -3.4
    extra: float = -1.5
    displaced: float = -3.4
    turned: float = -4.0
    swapped: float = -8.5


@dataclass(frozen=True, eq=False)
class TableEvidence:
    """Evidence of a layout with n roles for a table with m things, each in one or more poses.

    Attributes
    ----------
    identity
        Log-likelihood ratio of each role's thing being each thing, by its looks, shape (n, m).
    turn
        Log-likelihood ratio of each role's thing lying as in each pose, shape (n, p). The first m poses are the things
        as seen.
    straight
        Pose of each thing as it would lie in a role, shape (n, m); ``NOTHING`` where it lies so already, or is round.
    ends, kinds
        Roles of each fact, shape (f, 2), and its table, shape (f,).
    tables
        Log-likelihood ratio of a fact for each pair of poses, shape (k, p, p).
    optional
        Roles that may be missing without a mistake, shape (n,).
    apart
        Things that can change places, since neither lies on the other, shape (m, m); by default, all.
    pieces
        Things that may be pieces of others, so that they are not extra, shape (m,); by default, none.
    odds
        Log-odds of the mistakes.
    """

    identity: Array
    turn: Array
    straight: Index
    ends: Index
    kinds: Index
    tables: Array
    optional: NDArray[np.bool_]
    apart: NDArray[np.bool_] = field(default_factory=lambda: np.array(True))
    pieces: NDArray[np.bool_] = field(default_factory=lambda: np.array(False))
    odds: MistakeOdds = field(default_factory=MistakeOdds)

    def __post_init__(self) -> None:
        things = self.identity.shape[1]
        object.__setattr__(self, "apart", np.broadcast_to(self.apart, (things, things)))
        object.__setattr__(self, "pieces", np.broadcast_to(self.pieces, (things,)))


@dataclass(frozen=True, slots=True)
class Mistake:
    """A mistake: the roles and the things (as positions) that it is about. An extra thing has no role."""

    kind: MistakeKind
    roles: tuple[int, ...]
    things: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Explanation:
    """Thing of each role, and the mistakes.

    Attributes
    ----------
    value
        Log-likelihood ratio against a table of things that the layout does not mention, in nats.
    evidence
        Logarithm of the sum over all explanations that were compared, in nats.
    thing
        Thing of each role, or ``NOTHING``, shape (n,).
    state, partner
        State of each role, and the role with which it is swapped, shape (n,).
    roles_of
        Probability that each thing is that of each role, shape (n, m).
    """

    value: float
    evidence: float
    thing: Index
    state: Index
    partner: Index
    roles_of: Array
    optional: NDArray[np.bool_]
    pieces: NDArray[np.bool_]

    @property
    def mistakes(self) -> tuple[Mistake, ...]:
        """Mistakes, those of roles in their order, and then the extra things."""
        found = []
        for role, (thing, state) in enumerate(zip(self.thing.tolist(), self.state.tolist(), strict=True)):
            if state == State.MISSING and not self.optional[role]:
                found.append(Mistake(MistakeKind.MISSING, (role,), ()))
            elif state == State.DISPLACED:
                found.append(Mistake(MistakeKind.DISPLACED, (role,), (thing,)))
            elif state == State.TURNED:
                found.append(Mistake(MistakeKind.TURNED, (role,), (thing,)))
            elif state == State.SWAPPED and role < (other := int(self.partner[role])):
                found.append(Mistake(MistakeKind.SWAPPED, (role, other), (thing, int(self.thing[other]))))
        taken = set(self.thing.tolist())
        extra = [thing for thing in range(self.roles_of.shape[1]) if thing not in taken and not self.pieces[thing]]
        return (*found, *(Mistake(MistakeKind.EXTRA, (), (thing,)) for thing in extra))


def explain(evidence: TableEvidence) -> Explanation:
    """Find the most probable explanation of a table by a layout.

    Parameters
    ----------
    evidence
        Evidence of the layout for the table.

    Returns
    -------
    Explanation
        The best explanation that was found, with probabilities.

    Examples
    --------
    A fork and a knife that lies on the wrong side of it; with one fact, two things that changed places cost more:

    >>> looks = np.array([[9.0, -9.0], [-9.0, 9.0]])
    >>> left = np.array([[[0.0, -9.0], [3.0, 0.0]]])
    >>> none, ends = np.full((2, 2), NOTHING), np.array([[0, 1]])
    >>> table = TableEvidence(looks, np.zeros((2, 2)), none, ends, np.array([0]), left, np.zeros(2, bool))
    >>> [(str(mistake.kind), mistake.roles) for mistake in explain(table).mistakes]
    [('displaced', (1,))]
    """
    search = _Search(evidence)
    best: _States | None = None
    compared: list[tuple[_States, Array]] = []
    for start in search.starts():
        state, value = start, search.values(start)
        for _ in range(MAX_STEPS):
            near = search.neighbours(state)
            values = search.values(near)
            compared.append((near, values))
            if not len(values) or values.max() <= value[0] + 1e-9:
                break
            place = int(values.argmax())
            state, value = near.take(np.array([place])), values[place : place + 1]
        compared.append((state, value))
    thing, kind, partner, weights = _distinct(compared)
    if not len(weights):
        raise ValueError("a table must have at least one explanation")
    place = int(weights.argmax())
    best = _States(thing, kind, partner).take(np.array([place]))
    shares = np.exp(weights - weights[place])
    roles_of = np.zeros(evidence.identity.shape)
    for role in range(thing.shape[1]):
        filled = thing[:, role] != NOTHING
        np.add.at(roles_of[role], thing[filled, role], shares[filled])
    return Explanation(
        float(weights[place]),
        float(weights[place] + np.log(shares.sum())),
        best.thing[0],
        best.state[0],
        best.partner[0],
        roles_of / shares.sum(),
        evidence.optional,
        evidence.pieces,
    )


@dataclass(frozen=True, eq=False)
class _States:
    """Explanations of s states for n roles, each array of shape (s, n)."""

    thing: Index
    state: Index
    partner: Index

    def take(self, places: Index) -> _States:
        return _States(self.thing[places], self.state[places], self.partner[places])


def _distinct(compared: Sequence[tuple[_States, Array]]) -> tuple[Index, Index, Index, Array]:
    """Return the different explanations near the best, with their values."""
    top = max(float(values.max()) for _, values in compared if len(values))
    rows, weights = [], []
    for states, values in compared:
        kept = values >= top - KEPT_WITHIN
        rows.append(np.concatenate([states.thing[kept], states.state[kept], states.partner[kept]], axis=1))
        weights.append(values[kept])
    together, first = np.unique(np.concatenate(rows), axis=0, return_index=True)
    n = together.shape[1] // 3
    return together[:, :n], together[:, n : 2 * n], together[:, 2 * n :], np.concatenate(weights)[first]


class _Search:
    """Values and changes of explanations of one table."""

    def __init__(self, evidence: TableEvidence) -> None:
        self.evidence = evidence
        self.n, self.m = evidence.identity.shape
        odds = evidence.odds
        missing = np.where(evidence.optional, np.log(0.5), odds.missing)
        self.cost = np.zeros((len(State), self.n))
        self.cost[State.MISSING] = missing
        self.cost[State.DISPLACED], self.cost[State.TURNED] = odds.displaced, odds.turned
        self.cost[State.SWAPPED] = odds.swapped / 2
        # A row and a column of zeros for what is not there.
        self.identity = np.pad(evidence.identity, ((0, 0), (0, 1)))
        self.turn = np.pad(evidence.turn, ((0, 0), (0, 1)))
        self.turn_elsewhere = np.logaddexp(np.log(1 - TURNED_ELSEWHERE) + self.turn, np.log(TURNED_ELSEWHERE))
        self.tables = np.pad(evidence.tables, ((0, 0), (0, 1), (0, 1)))

    def values(self, states: _States) -> Array:
        """Return the value of each explanation, shape (s,)."""
        rows = np.arange(self.n)
        place = self.places(states)
        evidence = self.evidence
        value = self.identity[rows, states.thing].sum(axis=1)
        filled = states.state == State.FILLED
        swapped = states.state == State.SWAPPED
        value += np.where(filled | swapped, self.turn[rows, states.thing], 0.0).sum(axis=1)
        displaced = states.state == State.DISPLACED
        value += np.where(displaced, self.turn_elsewhere[rows, states.thing], 0.0).sum(axis=1)
        value += self.cost[states.state, rows].sum(axis=1)
        value += evidence.odds.extra * (self.m - (states.thing != NOTHING).sum(axis=1))
        a, b = place[:, evidence.ends[:, 0]], place[:, evidence.ends[:, 1]]
        value += self.tables[evidence.kinds, a, b].sum(axis=1)
        return np.asarray(value, dtype=np.float64)

    def places(self, states: _States) -> Index:
        """Return the pose by which the facts about each role are compared; ``NOTHING`` where they say nothing."""
        rows = np.arange(self.n)
        place = np.where(states.state == State.FILLED, states.thing, NOTHING)
        turned = states.state == State.TURNED
        place = np.where(turned, self.evidence.straight[rows, states.thing], place)
        swapped = states.state == State.SWAPPED
        others = np.take_along_axis(states.thing, np.where(swapped, states.partner, 0), axis=1)
        return np.where(swapped, others, place)

    def starts(self) -> Iterator[_States]:
        """Yield explanations to begin with: by looks alone, and by looks and the facts, role by role."""
        from scipy.optimize import linear_sum_assignment

        for gain in (self.evidence.identity, self._with_facts()):
            # A role is left empty where that is worth more than its thing.
            odds = self.evidence.odds
            least = np.broadcast_to((self.cost[State.MISSING] + odds.extra)[:, None], (self.n, self.n))
            rows, columns = linear_sum_assignment(np.concatenate([gain, least], axis=1), maximize=True)
            thing = np.full(self.n, NOTHING, dtype=np.int64)
            for row, column in zip(rows.tolist(), columns.tolist(), strict=True):
                thing[row] = column if column < self.m else NOTHING
            empty = np.full((1, self.n), NOTHING, dtype=np.int64)
            for seen in (State.FILLED, State.DISPLACED):
                state = np.where(thing == NOTHING, int(State.MISSING), int(seen)).astype(np.int64)
                yield _States(thing[None], state[None], empty)

    def _with_facts(self) -> Array:
        """Return the looks of each role and thing, and the best value of each fact about it with any other thing."""
        gain = self.evidence.identity.copy()
        m = self.m
        if m < 2:
            return gain
        for (a, b), kind in zip(self.evidence.ends.tolist(), self.evidence.kinds.tolist(), strict=True):
            table = self.evidence.tables[kind, :m, :m]
            gain[a] += (table + self.evidence.identity[b][None, :]).max(axis=1) - self.evidence.identity[b].max()
            gain[b] += (table + self.evidence.identity[a][:, None]).max(axis=0) - self.evidence.identity[a].max()
        return gain

    def neighbours(self, states: _States) -> _States:
        """Return all explanations that differ from one in the state or the thing of one or two roles."""
        thing, state, partner = states.thing[0], states.state[0], states.partner[0]
        free = [t for t in range(self.m) if t not in set(thing.tolist())]
        found: list[tuple[Index, Index, Index]] = []

        def change(**roles: dict[int, tuple[int, int, int]]) -> None:
            new = thing.copy(), state.copy(), partner.copy()
            wanted = roles["to"]
            for role in list(wanted):  # the partner of a swap that ends fills its place again
                other = int(partner[role]) if state[role] == State.SWAPPED else NOTHING
                if other != NOTHING and other not in wanted:
                    new[1][other], new[2][other] = State.FILLED, NOTHING
            for role, values in wanted.items():
                for array, value in zip(new, values, strict=True):
                    array[role] = value
            found.append(new)

        for i in range(self.n):
            own = int(thing[i])
            if own != NOTHING:
                change(to={i: (NOTHING, State.MISSING, NOTHING)})
            for t in (*([own] if own != NOTHING else []), *free):
                if not (t == own and state[i] == State.FILLED):
                    change(to={i: (t, State.FILLED, NOTHING)})
                if not (t == own and state[i] == State.DISPLACED):
                    change(to={i: (t, State.DISPLACED, NOTHING)})
                if self.evidence.straight[i, t] != NOTHING and not (t == own and state[i] == State.TURNED):
                    change(to={i: (t, State.TURNED, NOTHING)})
            for j in range(self.n):
                other = int(thing[j])
                if i == j or other == NOTHING:
                    continue
                if own == NOTHING:  # takes the thing of another role, which is then missing
                    for how in (State.FILLED, State.DISPLACED):
                        change(to={i: (other, how, NOTHING), j: (NOTHING, State.MISSING, NOTHING)})
                        for t in free:
                            change(to={i: (other, how, NOTHING), j: (t, State.FILLED, NOTHING)})
                elif i < j:
                    change(to={i: (other, State.FILLED, NOTHING), j: (own, State.FILLED, NOTHING)})
                    if self.evidence.apart[own, other]:
                        change(to={i: (own, State.SWAPPED, j), j: (other, State.SWAPPED, i)})
                        change(to={i: (other, State.SWAPPED, j), j: (own, State.SWAPPED, i)})
        if not found:
            return states.take(np.zeros(0, dtype=np.int64))
        things, kinds, partners = (np.stack(arrays) for arrays in zip(*found, strict=True))
        return _States(things, kinds, partners)
