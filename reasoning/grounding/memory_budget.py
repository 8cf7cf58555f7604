"""How much memory a grounding takes, estimated before any of it is taken."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from deixis.reasoning.errors import OutOfMemoryError, SettingError

if TYPE_CHECKING:
    from deixis.ontology.graph import RelationGraph

DEFAULT_MEMORY_LIMIT = 2.0
"""Gigabytes (of 10^9 bytes) that a grounding may take, beyond the program itself."""

BYTES_PER_PAIR, BYTES_PER_PAIR_AND_TABLE = 24, 16
"""Of each pair of things: names, neighbours and a table in the making; and for each table its degrees, its logarithms,
and what the engines read."""

BYTES_PER_MATCH, BYTES_OF_CHAINS, BYTES_PER_MESSAGE = 160, 140, 24
"""Of each object with each thing: evidence, gains and beliefs; guides and counts of chains, where they are run; and of
each end of a fact with each thing."""

FIXED_BYTES = 3e7
"""Blocks of pairs at work, and the processor's own caches of compiled code."""


BYTES_PER_LISTED_MATCH = 250
"""Of each object with each thing of a scene of which a shortlist is made: labels, trusted and not, sizes, colours, what
they come to, and beliefs."""

BYTES_PER_LISTED_THING = 3000
"""Of each thing of such a scene: how crowded it is, and what the answer says of it."""


def bytes_of_things(objects: int, things: int) -> float:
    """Return about how many bytes it takes to know things by themselves, before any two are compared."""
    return float(things * (objects * BYTES_PER_LISTED_MATCH + BYTES_PER_LISTED_THING))


def required_gigabytes(objects: int, things: int, facts: int, tables: int, *, chains: bool = True) -> float:
    """Return about how many gigabytes (10^9 bytes) it takes at most to ground a description in a scene.

    ``tables`` is the number of different facts: of relation, sign and weight. Without ``chains`` no marginals are
    sampled.

    >>> required_gigabytes(1000, 1000, 2500, 10) < 1 < required_gigabytes(20000, 20000, 50000, 10)
    True
    """
    from deixis.reasoning.grounding.matching.exact import MAX_PASS_CELLS, MAX_STACK_CELLS

    proved = 2 * facts * (things + 1) ** 2 <= MAX_PASS_CELLS  # by a search that keeps a stack
    level = 2 * (objects + facts) * (things + 1)
    stack = 8 * min((objects + 1) * level, max(MAX_STACK_CELLS, level)) if proved else 0
    pairs = things**2 * (BYTES_PER_PAIR + BYTES_PER_PAIR_AND_TABLE * tables)
    per_match = BYTES_PER_MATCH + (BYTES_OF_CHAINS if chains else 0)
    matches = things * (objects * per_match + 2 * facts * BYTES_PER_MESSAGE)
    return (pairs + matches + stack + FIXED_BYTES) / 1e9


def different_facts(description: RelationGraph) -> int:
    """Return how many facts differ in relation, sign or weight: each takes a table."""
    columns = (description.relation_sets, description.affirmed, description.net_weights)
    return len(set(zip(*(column.tolist() for column in columns), strict=True)))


def leaves_room_for_chains(description: RelationGraph, things: int, limit: float) -> bool:
    """Return whether ``limit`` gigabytes are enough to sample marginals, too.

    Raises OutOfMemoryError where a description beside so many things takes more even without.
    """
    objects, facts, tables = len(description.nodes), len(description), different_facts(description)
    if required_gigabytes(objects, things, facts, tables) <= limit:
        return True
    needed = required_gigabytes(objects, things, facts, tables, chains=False)
    if needed > limit:
        raise OutOfMemoryError(
            f"{objects} objects of a description beside {things} things take about {needed:.1f} GB, and the memory "
            f"limit is {limit:g} GB: raise it (--memory-limit), or ground in parts of the table"
        )
    return False


def require_memory_limit(gigabytes: float) -> None:
    """Raise SettingError for what is no memory limit."""
    if not isinstance(gigabytes, int | float) or not gigabytes > 0 or math.isnan(gigabytes):
        raise SettingError(f"a memory limit is above 0 gigabytes, not {gigabytes}")
