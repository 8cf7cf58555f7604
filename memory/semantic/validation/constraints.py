"""SHACL constraints as compiled checks: each returns True only where it is certain that the constraint holds.

Literals are checked in their common spellings only; others are doubtful, and left to pyshacl.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from datetime import datetime
from typing import Protocol

import pyoxigraph as ox

from deixis.memory.semantic.rdf.after import Node
from deixis.memory.semantic.validation.focus_data import FocusData


class Values(Protocol):
    """Nodes at the end of a path from a node."""

    def __call__(self, view: FocusData, node: Node) -> Iterable[Node]:
        """Return the nodes that the path leads to."""
        ...

    def some(self, view: FocusData, node: Node, number: int) -> Iterable[Node]:
        """Return at most ``number`` of these nodes.

        Parameters
        ----------
        view
            Data after a change.
        node
            Start of the path.
        number
            Maximum number of nodes.

        Returns
        -------
        Iterable[Node]
            Distinct nodes.
        """
        ...

    def fresh(self, view: FocusData, node: Node) -> Iterable[Node]:
        """Return the nodes whose class the change may have altered.

        Parameters
        ----------
        view
            Data after a change.
        node
            Start of the path.

        Returns
        -------
        Iterable[Node]
            Nodes that must be checked again; there may be more than necessary.
        """
        ...


Check = Callable[[FocusData, Node], bool]
Make = Callable[[Values, Sequence[Node]], Check]

_XSD = "http://www.w3.org/2001/XMLSchema#"

_SPELLINGS = {
    ox.NamedNode(_XSD + name): re.compile(pattern)
    for name, pattern in {
        "string": r"(?s:.*)",
        "boolean": "true|false",
        "integer": r"-?[0-9]{1,18}",
        "decimal": r"-?[0-9]{1,18}(\.[0-9]{1,18})?",
        "double": r"-?[0-9]{1,18}(\.[0-9]{1,20})?([eE]-?[0-9]{1,2})?",
        "dateTime": r"[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}(\.[0-9]{1,6})?(Z|[+-][0-9]{2}:[0-9]{2})",
    }.items()
}
_NUMBERS = {ox.NamedNode(_XSD + name) for name in ("integer", "decimal", "double")}
_DATE_TIME = ox.NamedNode(_XSD + "dateTime")
_STRING = ox.NamedNode(_XSD + "string")


def _well_spelt(node: Node) -> bool:
    if not isinstance(node, ox.Literal):
        return False
    pattern = _SPELLINGS.get(node.datatype)
    if pattern is None or not pattern.fullmatch(node.value):
        return False
    return node.datatype != _DATE_TIME or _moment(node) is not None


def _number(node: Node) -> float | None:
    if isinstance(node, ox.Literal) and node.datatype in _NUMBERS and _well_spelt(node):
        value = float(node.value)
        return value if math.isfinite(value) else None
    return None


def _moment(node: Node) -> datetime | None:
    """Return the time of a literal, or None for one without a time zone, which cannot be compared with others."""
    if isinstance(node, ox.Literal) and node.datatype == _DATE_TIME:
        try:
            moment = datetime.fromisoformat(node.value)
        except ValueError:
            return None
        return moment if moment.tzinfo is not None else None
    return None


def _integers(arguments: Sequence[Node]) -> list[int]:
    return [int(argument.value) for argument in arguments if isinstance(argument, ox.Literal)]


def _min_count(values: Values, arguments: Sequence[Node]) -> Check:
    least = max(_integers(arguments))
    return lambda view, node: len(list(values.some(view, node, least))) >= least


def _max_count(values: Values, arguments: Sequence[Node]) -> Check:
    most = min(_integers(arguments))
    return lambda view, node: len(list(values.some(view, node, most + 1))) <= most


def _each(values: Values, holds: Callable[[Node], bool]) -> Check:
    return lambda view, node: all(holds(value) for value in values(view, node))


def _datatype(values: Values, arguments: Sequence[Node]) -> Check:
    (wanted,) = arguments
    return _each(
        values, lambda value: isinstance(value, ox.Literal) and value.datatype == wanted and _well_spelt(value)
    )


def _class(values: Values, arguments: Sequence[Node]) -> Check:
    return lambda view, node: all(view.is_a(value, kind) for value in values.fresh(view, node) for kind in arguments)


def _node_kind(values: Values, arguments: Sequence[Node]) -> Check:
    wanted = [str(getattr(argument, "value", "")).rsplit("#", 1)[-1] for argument in arguments]
    return _each(values, lambda value: wanted == ["IRI"] and isinstance(value, ox.NamedNode))


def _bound(holds: Callable[[float, float], bool]) -> Make:
    def make(values: Values, arguments: Sequence[Node]) -> Check:
        bounds = [_number(argument) for argument in arguments]

        def within(value: Node) -> bool:
            number = _number(value)
            return number is not None and all(bound is not None and holds(number, bound) for bound in bounds)

        return _each(values, within)

    return make


def _min_length(values: Values, arguments: Sequence[Node]) -> Check:
    least = max(_integers(arguments))
    return _each(values, lambda value: isinstance(value, ox.Literal) and len(value.value) >= least)


def _pattern(values: Values, arguments: Sequence[Node]) -> Check:
    patterns = [re.compile(argument.value) for argument in arguments if isinstance(argument, ox.Literal)]
    return _each(
        values,
        lambda value: isinstance(value, ox.Literal) and all(pattern.search(value.value) for pattern in patterns),
    )


def _in(values: Values, arguments: Sequence[Node]) -> Check:
    listed = set(arguments)
    return _each(values, lambda value: value in listed)


def _has_value(values: Values, arguments: Sequence[Node]) -> Check:
    wanted = set(arguments)
    return lambda view, node: wanted <= set(values(view, node))


def _predicates(arguments: Sequence[Node]) -> list[ox.NamedNode]:
    return [argument for argument in arguments if isinstance(argument, ox.NamedNode)]


def _disjoint(values: Values, arguments: Sequence[Node]) -> Check:
    others = _predicates(arguments)
    return lambda view, node: all(set(values(view, node)).isdisjoint(view.values(node, other)) for other in others)


def _less_than_or_equals(values: Values, arguments: Sequence[Node]) -> Check:
    others = _predicates(arguments)
    return lambda view, node: all(
        _ordered(value, bound) for value in values(view, node) for other in others for bound in view.values(node, other)
    )


def _ordered(low: Node, high: Node) -> bool:
    numbers = _number(low), _number(high)
    if numbers[0] is not None and numbers[1] is not None:
        return numbers[0] <= numbers[1]
    moments = _moment(low), _moment(high)
    return moments[0] is not None and moments[1] is not None and moments[0] <= moments[1]


CONSTRAINTS: dict[str, Make] = {
    "minCount": _min_count,
    "maxCount": _max_count,
    "datatype": _datatype,
    "class": _class,
    "nodeKind": _node_kind,
    "minInclusive": _bound(lambda number, bound: number >= bound),
    "minExclusive": _bound(lambda number, bound: number > bound),
    "maxInclusive": _bound(lambda number, bound: number <= bound),
    "maxExclusive": _bound(lambda number, bound: number < bound),
    "minLength": _min_length,
    "pattern": _pattern,
    "in": _in,
    "hasValue": _has_value,
    "disjoint": _disjoint,
    "lessThanOrEquals": _less_than_or_equals,
}
"""Function that makes a check from the arguments of a constraint, by the local name of its SHACL parameter."""
