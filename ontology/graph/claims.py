"""Claims: everything that a description states besides binary relations between two described objects.

Examples: *between* two others, a place on the table (*in the far left corner*), a property (*red*, *big*), a distance,
an order (*the second from the left*), an arrangement (*in a row*).
"""

from __future__ import annotations

from dataclasses import dataclass

from deixis.ontology.graph.facts import Source

PLACES = frozenset({"corner", "edge", "end", "side", "part", "middle"})
"""Claims about a place in a region: of the surface, or of the thing that is the argument."""

EACH_OTHER = {"near_each_other": "near", "touching_each_other": "touching", "parallel_each_other": "parallel"}
"""Relation of each two members of an arrangement."""

ROW_ORDERS = {
    "left to right": "left",
    "right to left": "right",
    "front to back": "bottom",
    "near to far": "bottom",
    "bottom to top": "bottom",
    "back to front": "top",
    "far to near": "top",
    "top to bottom": "top",
}
"""Relation of each member of a row to the next one, by the order of the row."""

COLLECTIVE = frozenset({"row", "circle", "nested", "stacked", *EACH_OTHER})
"""Claims about all of their subjects together."""

SUPERLATIVES = (
    *("largest", "smallest", "tallest", "shortest", "longest", "widest", "narrowest", "thickest", "thinnest"),
    *("leftmost", "rightmost"),
)
"""Claims that compare the subject with the arguments, or with everything."""


@dataclass(frozen=True, slots=True)
class Claim:
    """A statement about one or more described objects by a term that is not a binary relation of the ontology.

    ``relation`` is the term (``between``, ``corner``, ``colour``, ``leftmost``, ``row``, ``distance``), ``subjects``
    the objects that it is about (several for a row), ``arguments`` the other objects, ``value`` a word (``red``,
    ``far left``, ``3``) and ``metres`` a distance. The other fields are those of a
    :class:`~deixis.ontology.graph.facts.Fact`.

    >>> print(Claim("between", ("bottle",), ("glass", "jug")))
    between(bottle, glass, jug)
    >>> print(Claim("corner", ("lamp",), value="far left", positive=False))
    not corner(lamp, 'far left')
    """

    relation: str
    subjects: tuple[str, ...]
    arguments: tuple[str, ...] = ()
    value: str | None = None
    metres: float | None = None
    positive: bool = True
    optional: bool = False
    weight: float = 1.0
    source: Source | None = None

    def __str__(self) -> str:
        arguments = [*self.subjects, *self.arguments]
        if self.value is not None:
            arguments.append(repr(self.value))
        if self.metres is not None:
            arguments.append(f"{self.metres:g} m")
        return f"{'' if self.positive else 'not '}{self.relation}({', '.join(arguments)})"
