"""Estimate of the memory that a grounding needs, before it is allocated."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from deixis.reasoning.errors import OutOfMemoryError, SettingError

if TYPE_CHECKING:
    from deixis.ontology.graph.graph import RelationGraph

DEFAULT_MEMORY_LIMIT = 2.0
"""Default memory limit of a grounding in units of 10^9 bytes, without the program itself."""

BYTES_PER_PAIR, BYTES_PER_PAIR_AND_TABLE = 24, 16
"""Bytes per pair of things: for names, neighbours and a table under construction; and for each table, for its degrees,
its logarithms, and the copy that the engines read."""

BYTES_PER_MATCH, BYTES_OF_CHAINS, BYTES_PER_MESSAGE = 160, 140, 24
"""Bytes per object and thing for evidence, gains and beliefs; per object and thing for the guides and counts of chains,
where they are run; per end of a fact and thing for messages."""

BYTES_PER_PLACE_AND_TABLE, BYTES_PER_MESSAGE_OF_PLACES = 8, 16
"""Bytes for the places of absent objects, where chains are run: per thing, place and table; per end of a fact and thing
for the messages of the places."""

FIXED_BYTES = 3e7
"""Bytes for the blocks of pairs in progress and the caches of compiled code."""

BYTES_PER_LISTED_MATCH = 250
"""Bytes per object and thing of a scene with a shortlist: labels (trusted and doubted), sizes, colours, their sums, and
beliefs."""

BYTES_PER_LISTED_THING = 3000
"""Bytes per thing of a scene with a shortlist: its surroundings, and its entry in the answer."""


def bytes_of_things(objects: int, things: int) -> float:
    """Estimate the bytes for labels, sizes and colours of all things, before any two things are compared.

    Parameters
    ----------
    objects
        Number of objects of the description.
    things
        Number of things of the scene.

    Returns
    -------
    float
        The number of bytes.
    """
    return float(things * (objects * BYTES_PER_LISTED_MATCH + BYTES_PER_LISTED_THING))


def required_gigabytes(objects: int, things: int, facts: int, tables: int, *, chains: bool = True) -> float:
    """Estimate the maximum memory for grounding a description in a scene, in units of 10^9 bytes.

    Parameters
    ----------
    objects, things, facts
        Number of objects and facts of the description, and of things of the scene.
    tables
        Number of facts that differ in relation, sign or weight.
    chains
        Whether marginals are sampled by Markov chains.

    Returns
    -------
    float
        Gigabytes (10^9 bytes).

    Examples
    --------
    >>> required_gigabytes(1000, 1000, 2500, 10) < 1 < required_gigabytes(20000, 20000, 50000, 10)
    True
    """
    from deixis.reasoning.grounding.matching.problem import MAX_PLACES, MIN_PLACES, PLACES_PER_THING
    from deixis.reasoning.grounding.matching.search.exact import MAX_PASS_CELLS, MAX_STACK_CELLS

    proved = 2 * facts * (things + 1) ** 2 <= MAX_PASS_CELLS  # by a search that keeps a stack
    level = 2 * (objects + facts) * (things + 1)
    stack = 8 * min((objects + 1) * level, max(MAX_STACK_CELLS, level)) if proved else 0
    pairs: float = things**2 * (BYTES_PER_PAIR + BYTES_PER_PAIR_AND_TABLE * tables)
    per_match = BYTES_PER_MATCH + (BYTES_OF_CHAINS if chains else 0)
    per_message = BYTES_PER_MESSAGE + (BYTES_PER_MESSAGE_OF_PLACES if chains else 0)
    matches = things * (objects * per_match + 2 * facts * per_message)
    if chains:
        pairs += (
            things * min(max(PLACES_PER_THING * things, MIN_PLACES), MAX_PLACES) * BYTES_PER_PLACE_AND_TABLE * tables
        )
    return (pairs + matches + stack + FIXED_BYTES) / 1e9


def different_facts(description: RelationGraph) -> int:
    """Return the number of facts that differ in relation, sign or weight; each needs a table.

    Parameters
    ----------
    description
        The relation graph of the description.

    Returns
    -------
    int
        The number.
    """
    columns = (description.relation_sets, description.affirmed, description.net_weights)
    return len(set(zip(*(column.tolist() for column in columns), strict=True)))


def leaves_room_for_chains(description: RelationGraph, things: int, limit: float) -> bool:
    """Return whether a grounding that samples marginals fits in memory.

    Parameters
    ----------
    description
        The relation graph of the description.
    things
        Number of things of the scene.
    limit
        Memory limit in gigabytes (10^9 bytes).

    Returns
    -------
    bool
        True if it fits.

    Raises
    ------
    OutOfMemoryError
        If a grounding without sampling does not fit either.
    """
    objects, facts, tables = len(description.nodes), len(description), different_facts(description)
    if required_gigabytes(objects, things, facts, tables) <= limit:
        return True
    needed = required_gigabytes(objects, things, facts, tables, chains=False)
    if needed > limit:
        raise OutOfMemoryError(
            f"a description of {objects} objects in a scene of {things} things needs about {needed:.1f} GB, and the "
            f"memory limit is {limit:g} GB; raise the limit (--memory-limit), or ground in parts of the scene"
        )
    return False


def require_memory_limit(gigabytes: float) -> None:
    """Raise SettingError unless a memory limit is a positive number.

    Parameters
    ----------
    gigabytes
        The limit.

    Raises
    ------
    SettingError
        If it is not.
    """
    if not isinstance(gigabytes, int | float) or not gigabytes > 0 or math.isnan(gigabytes):
        raise SettingError(f"the memory limit must be above 0 gigabytes, got {gigabytes}")
