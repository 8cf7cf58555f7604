"""Search for tractable relations: choose one, close, and learn a nogood from every contradiction.

Branching on tractable relations follows Nebel (1997), and learning follows Marques-Silva and Sakallah (1999). The loops
are in :mod:`deixis.reasoning.qualitative.networks.search.search_kernels`; this module prepares their data. Only edges
with a stated relation are decided. An edge is *settled* when a tractable relation within the stated one contains the
remaining relation: the stated network with these relations instead is tractable, and its closure is not empty, because
it contains the present closed network. So the search may stop with most pairs undetermined.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.errors import LimitError
from deixis.reasoning.kernel import interprets
from deixis.reasoning.qualitative.calculi.calculus import TableCalculus
from deixis.reasoning.qualitative.networks.closure.state import MAX_BYTES
from deixis.reasoning.qualitative.networks.closure.tables import in_parts

if TYPE_CHECKING:
    from deixis.reasoning.qualitative.networks.search.search_kernels import Algebra, Memory

MAX_ATOMS = 64  # maximum atoms of an axis
MAX_HULL_ATOMS = 16  # maximum atoms of an axis with a table of all its relations
MAX_TABLE_BYTES = 1 << 20  # maximum size of the look-up table of compositions
BYTES_PER_EDGE = 48
STEPS_PER_CHECK = 2_000_000  # look-ups between two readings of the clock: some milliseconds
FIRST_STEPS = 5_000  # look-ups that may be interpreted before compiled loops are loaded
FIRST_ROOM, FIRST_NOGOODS, FIRST_PREMISES = (
    1 << 12,
    1 << 12,
    1 << 17,
)  # lengths: trail, nogoods, premises
NOGOODS_KEPT = 2_000  # learned nogoods at the first restart; the number grows

Premise = tuple[int, int]
"""An edge and a relation: the premise that the remaining relation of the edge is within the relation."""


class ConflictSearch:
    """A search for tractable relations, or for atoms, that a network may have.

    Parameters
    ----------
    axes : sequence of TableCalculus
        The calculus on each axis; one for a network that is not a product.
    masks : ndarray, (axes, n, n)
        What every pair may be, one bit an atom; empty nowhere.
    candidates : ndarray, (c,)
        Edges to settle: the pair i < k on axis a is (a * n + i) * n + k.
    stated : ndarray, (axes, n, n), optional
        The stated relation of every pair, of which ``masks`` may be the closure; ``masks`` itself by default.
    nogoods : sequence of sequences of Premise
        Premises of which one must be false.
    atomic : bool
        True to narrow each candidate to one atom, False to narrow it to within a tractable relation.
    closed : bool
        True if ``masks`` is closed already.

    Raises
    ------
    LimitError
        Where the network would not fit in memory.

    Examples
    --------
    >>> from deixis.reasoning.qualitative.calculi.registry import calculus
    >>> allen = calculus("allen")
    >>> masks = np.full((1, 3, 3), allen.universal, dtype=np.uint64)
    >>> masks[0, 0, 1] = masks[0, 1, 2] = allen.relation(["<"])
    >>> masks[0, 1, 0] = masks[0, 2, 1] = allen.relation([">"])
    >>> search = ConflictSearch([allen], masks, np.array([1, 5]), closed=False)
    >>> search.run(), allen.members(int(search.masks[0, 0, 2]))
    (True, ('<',))
    """

    def __init__(
        self,
        axes: Sequence[TableCalculus],
        masks: NDArray[np.unsignedinteger[Any]],
        candidates: NDArray[np.int64],
        stated: NDArray[np.unsignedinteger[Any]] | None = None,
        nogoods: Sequence[Sequence[Premise]] = (),
        *,
        atomic: bool = False,
        closed: bool = True,
    ) -> None:
        from deixis.reasoning.qualitative.networks.search.search_kernels import queue_edges

        require_room(*masks.shape[:2])
        self._algebra = algebra(tuple(axes), atomic)
        dtype = self._algebra.compositions.dtype
        allowed = (masks if stated is None else stated).astype(dtype)
        self._memory = _memory(masks.astype(dtype), allowed, candidates, nogoods)
        self._scratch = np.zeros(masks.shape[1] + 1, np.int64), np.zeros(masks.shape[1] + 1, self.masks.dtype)
        if not closed:
            queue_edges(self._algebra, self._memory)

    def run(self, deadline: Deadline = Deadline.never()) -> bool | None:
        """Continue the search: True if all candidates are settled, False if they cannot be, None if out of time.

        Parameters
        ----------
        deadline
            End of the time limit, after which the search can be continued.

        Returns
        -------
        bool or None
            Result of the search.

        Raises
        ------
        LimitError
            The search does not fit in memory.
        """
        from deixis.reasoning.qualitative.networks.search import search_kernels

        budget = FIRST_STEPS if interprets() else STEPS_PER_CHECK
        while not deadline.passed:
            status = search_kernels.search(budget, *self._scratch, self._algebra, self._memory)
            budget = STEPS_PER_CHECK
            if status in (search_kernels.CONSISTENT, search_kernels.INCONSISTENT):
                return bool(status == search_kernels.CONSISTENT)
            if status == search_kernels.TRAIL_FULL:
                self._memory = _longer(self._memory, "edges", "olds", "reasons", "earlier", "premises")
                self._memory = _longer(self._memory, "starts", "cursors", "stamps")
            elif status == search_kernels.NOGOODS_FULL:
                self._memory = _longer(self._memory, "begins", "levels", "watched", "next_watch")
                self._memory = _longer(self._memory, "premise_edges", "premise_masks")
        return None

    @property
    def masks(self) -> NDArray[np.unsignedinteger[Any]]:
        """The current relations of all pairs, (axes, n, n)."""
        found: NDArray[np.unsignedinteger[Any]] = self._memory.masks
        return found

    @property
    def decisions(self) -> int:
        """Number of relations chosen so far."""
        from deixis.reasoning.qualitative.networks.search.search_kernels import DECISIONS

        return int(self._memory.counts[DECISIONS])

    @property
    def conflicts(self) -> int:
        """Number of contradictions met so far."""
        from deixis.reasoning.qualitative.networks.search.search_kernels import CONFLICTS

        return int(self._memory.counts[CONFLICTS])

    def tractable(self) -> NDArray[np.unsignedinteger[Any]]:
        """Return the least tractable relation that contains the remaining relation of each pair, (axes, n, n).

        Returns
        -------
        ndarray
            Relations as bit masks, shape (axes, n, n).
        """
        hulls = self._algebra.hulls
        return np.stack([hulls[axis][mask] for axis, mask in enumerate(self.masks)])


def require_room(axes: int, things: int) -> None:
    """Raise LimitError if a search on this many axes and things would not fit in memory.

    Parameters
    ----------
    axes
        Number of axes of the calculus.
    things
        Number of things.

    Raises
    ------
    LimitError
        The search would take more than ``MAX_BYTES``.
    """
    if axes * things**2 * BYTES_PER_EDGE > MAX_BYTES:
        raise LimitError(
            f"a search among {things:,} things takes more than {MAX_BYTES >> 20:,} MB; "
            "split the network, or close it without a search"
        )


@lru_cache(maxsize=16)
def algebra(axes: tuple[TableCalculus, ...], atomic: bool) -> Algebra:
    """Return the tables of the calculi on the axes.

    Parameters
    ----------
    axes
        Calculus of each axis.
    atomic
        Whether the search is for atoms; tractable relations are then not listed.

    Returns
    -------
    Algebra
        Tables as arrays.

    Raises
    ------
    LimitError
        An axis has more than 64 atoms.
    """
    from deixis.reasoning.qualitative.networks.search.search_kernels import Algebra

    most = max(len(axis.atoms) for axis in axes)
    if most > MAX_ATOMS:
        raise LimitError(f"a search takes at most {MAX_ATOMS} atoms per axis, got {most}")
    dtype = np.dtype(np.uint16 if most <= MAX_HULL_ATOMS else np.uint64)
    parts = 2
    while (parts << -(-most // parts)) ** 2 * dtype.itemsize > MAX_TABLE_BYTES:
        parts += 1
    width = -(-most // parts)
    tables = [in_parts(axis, parts, width, dtype) for axis in axes]
    relations = 1 << most if most <= MAX_HULL_ATOMS else 0
    hulls = np.zeros((len(axes), 0 if atomic else 1 << most), dtype=dtype)
    tractable = np.zeros((len(axes), 0), dtype=dtype)
    if not atomic:
        subclasses = [axis.tractable for axis in axes if axis.tractable is not None]
        tractable = np.zeros((len(axes), max(len(each.largest_first) for each in subclasses)), dtype=dtype)
        for position, each in enumerate(subclasses):
            hulls[position, : len(each.hulls)] = each.hulls
            tractable[position, : len(each.largest_first)] = each.largest_first
    weights = np.zeros((len(axes), most))
    for position, axis in enumerate(axes):
        weights[position, : len(axis.atoms)] = np.bitwise_count(axis.composition).sum(axis=1)
    return Algebra(
        width,
        np.stack([compositions for compositions, _ in tables]),
        np.stack([converses for _, converses in tables]),
        np.array([axis.universal for axis in axes], dtype=np.uint64),
        np.empty((len(axes), max(1, relations), parts, 1 << width), dtype=dtype),
        np.zeros((len(axes), relations), dtype=np.bool_),
        hulls,
        tractable,
        weights,
    )


def _memory(
    masks: NDArray[np.unsignedinteger[Any]],
    allowed: NDArray[np.unsignedinteger[Any]],
    candidates: NDArray[np.int64],
    nogoods: Sequence[Sequence[Premise]],
) -> Memory:
    from deixis.reasoning.qualitative.networks.search import search_kernels as kernels

    edges, dtype = masks.size, masks.dtype
    stated = sum(len(premises) for premises in nogoods)
    room, nogood_room = FIRST_ROOM + 4 * masks.shape[1] + len(nogoods), FIRST_NOGOODS + 2 * len(nogoods)
    sizes = np.bitwise_count(masks.ravel()[candidates])
    counts = np.zeros(kernels.COUNTS, dtype=np.int64)
    counts[kernels.CONFLICT] = -1
    counts[kernels.UNTIL_RESTART] = kernels.RESTART_UNIT
    counts[kernels.KEPT] = NOGOODS_KEPT
    counts[[kernels.NOGOODS, kernels.STATED]] = len(nogoods)
    counts[kernels.PREMISES] = stated

    def integers(size: int, value: int = 0) -> NDArray[np.int32]:
        return np.full(size, value, dtype=np.int32)

    memory = kernels.Memory(
        masks=masks,
        flat=masks.ravel(),
        allowed=allowed.ravel(),
        candidates=candidates[np.argsort(sizes, kind="stable")],
        counts=counts,
        edges=integers(room),
        olds=np.zeros(room, dtype=dtype),
        reasons=integers(room),
        earlier=integers(room),
        latest=integers(edges, -1),
        starts=integers(room),
        cursors=integers(room),
        stamps=integers(room),
        first=integers(MAX_ATOMS + 1, -1),
        last=integers(MAX_ATOMS + 1, -1),
        following=integers(edges, -2),
        activity=np.zeros(edges),
        increment=np.ones(1),
        tried=np.zeros(edges, dtype=dtype),
        needed=np.zeros(edges, dtype=dtype),
        since=integers(edges, -1),
        premises=integers(room + edges),
        begins=integers(nogood_room + 1),
        premise_edges=integers(FIRST_PREMISES + stated + edges),
        premise_masks=np.zeros(FIRST_PREMISES + stated + edges, dtype=dtype),
        levels=integers(nogood_room),
        watched=integers(2 * nogood_room),
        next_watch=integers(2 * nogood_room),
        watches=integers(edges, -1),
    )
    if nogoods:
        memory.begins[1 : len(nogoods) + 1] = np.cumsum([len(premises) for premises in nogoods])
        memory.premise_edges[:stated] = [edge for premises in nogoods for edge, _ in premises]
        memory.premise_masks[:stated] = [relation for premises in nogoods for _, relation in premises]
    return memory


def _longer(memory: Memory, *names: str) -> Memory:
    """Return the memory with the named arrays twice as long."""
    grown = {}
    for name in names:
        old = getattr(memory, name)
        if 2 * old.nbytes > MAX_BYTES:
            raise LimitError("the search does not fit in memory; split the network, or close it without a search")
        grown[name] = np.concatenate([old, np.zeros_like(old)])
    return memory._replace(**grown)
