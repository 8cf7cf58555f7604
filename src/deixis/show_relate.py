"""The relations of a scene as lines, as a matrix, and as plain data."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from deixis.reasoning.relate import Related


def pair_lines(related: Related, subject: str | None = None, object: str | None = None) -> list[str]:
    """A line for every ordered pair: subject, relation, object."""
    pairs = list(related.pairs(subject, object))
    if not pairs:
        return ["There are no pairs."]
    wide, mid = (max(len(pair[place]) for pair in pairs) for place in (0, 1))
    return [f"{a:<{wide}}  {sign:<{mid}}  {b}" for a, sign, b in pairs]


def matrix_lines(related: Related) -> list[str]:
    """Subjects in rows, objects in columns; a dot where both are the same."""
    if not related.ids:
        return ["There are no objects."]
    rows = [["", *related.ids]]
    for i, id in enumerate(related.ids):
        signs = [related.signs[code] for code in related.codes[i]]
        rows.append([id, *("." if i == j else sign for j, sign in enumerate(signs))])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def related_to_dict(related: Related, subject: str | None = None, object: str | None = None) -> dict[str, Any]:
    """The calculus, the objects, and every ordered pair."""
    return {
        "calculus": related.calculus,
        "objects": list(related.ids),
        "pairs": [{"subject": a, "relation": sign, "object": b} for a, sign, b in related.pairs(subject, object)],
    }
