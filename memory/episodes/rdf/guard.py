"""Check changes of fluents by SHACL before they are written.

Compiled checks accept fluents that are certainly well formed; pyshacl decides about the others and says what is wrong.
The data of a check is the description of each changed fluent and its statement as a plain triple. Shapes with
constraints that cannot be compiled are checked by pyshacl alone, which is slower.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, cast

import pyoxigraph as ox

from deixis.answers import count
from deixis.errors import OntologyError
from deixis.memory.episodes.fluents.episode import EpisodicFluent
from deixis.memory.episodes.rdf.observations import (
    TYPE,
    Values,
    fluent_iri,
    fluent_triples,
    fluent_values,
    statement_triple,
    thing_iri,
)
from deixis.memory.errors import RejectedWriteError, ShapesError
from deixis.memory.semantic.validation.compiled_shapes import Shapes, compile_shapes
from deixis.memory.semantic.validation.shacl import violations
from deixis.ontology.tbox import TBOX_FILES
from deixis.reasoning.temporal.fluent import Statement

if TYPE_CHECKING:
    from deixis.memory.semantic.rdf.after import Node
    from deixis.memory.semantic.validation.focus_data import FocusData

MAX_STATEMENTS = 10_000
"""Maximum number of statements whose verdict is kept."""

SHIPPED = TBOX_FILES[0].with_name("episode_shapes.ttl")
"""Shapes that every fluent must conform to."""


class Guard:
    """The shapes of one Turtle file, compiled where they can be."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._compiled: Shapes | None = None
        self._statements: dict[Statement, bool] = {}
        try:
            self._compiled = compile_shapes(file)
        except OntologyError:
            self._compiled = None  # a constraint that only pyshacl knows
        except (OSError, ValueError) as error:
            raise ShapesError(f"{file}: the shapes cannot be read: {error}") from error

    def check(self, fluents: Iterable[EpisodicFluent]) -> None:
        """Raise RejectedWriteError unless fluents conform to the shapes.

        Parameters
        ----------
        fluents
            Fluents as they are after a change.

        Raises
        ------
        RejectedWriteError
            If one does not conform; the error names the shape and the reason for each violation.
        """
        doubtful = [fluent for fluent in fluents if not self.accepts(fluent)]
        if doubtful:
            described = [(*fluent_triples(fluent), statement_triple(fluent.statement)) for fluent in doubtful]
            results = violations([triple for triples in described for triple in triples], file=self._file)
            if results:
                raise RejectedWriteError(
                    f"nothing was written: it breaks the shapes in {count(len(results), 'place')}", results
                )

    def selects(self, fluent: EpisodicFluent) -> bool:
        """Return whether a shape of the file targets a fluent or its statement, and the fluent conforms to the shapes.

        Parameters
        ----------
        fluent
            The fluent.

        Returns
        -------
        bool
            True if both hold.

        Raises
        ------
        ShapesError
            If the shapes have constraints that only pyshacl knows; subscriptions need those that are compiled.
        """
        if self._compiled is None or self._compiled.objects_of:
            raise ShapesError(f"{self._file}: a subscription needs shapes of the constraints that can be compiled")
        triple = statement_triple(fluent.statement)
        nodes: tuple[tuple[ox.NamedNode, Values], ...] = (
            (fluent_iri(fluent.id), fluent_values(fluent)),
            (thing_iri(fluent.statement.subject), {triple.predicate: [triple.object]}),
        )
        views = [(node, cast("FocusData", _Description(node, values))) for node, values in nodes]
        targeted = any(shape.targets(view, node) for node, view in views for shape in self._compiled.shapes)
        return targeted and self.accepts(fluent)

    def accepts(self, fluent: EpisodicFluent) -> bool:
        """Return whether the compiled checks are certain that a fluent conforms.

        Parameters
        ----------
        fluent
            The fluent.

        Returns
        -------
        bool
            False if pyshacl must decide.
        """
        if self._compiled is None or self._compiled.objects_of:
            return False
        statement = fluent.statement
        known = self._statements.get(statement)
        if known is None:
            if len(self._statements) >= MAX_STATEMENTS:
                self._statements.clear()
            triple = statement_triple(statement)
            known = self._sure(thing_iri(statement.subject), {triple.predicate: [triple.object]})
            self._statements[statement] = known
        return known and self._sure(fluent_iri(fluent.id), fluent_values(fluent))

    def _sure(self, node: ox.NamedNode, values: Values) -> bool:
        """Return whether a node with these values certainly conforms to each shape that targets it."""
        assert self._compiled is not None
        view = cast("FocusData", _Description(node, values))
        return all(shape.sure(view, node) for shape in self._compiled.shapes if shape.targets(view, node))


@lru_cache(maxsize=1)
def shipped_guard() -> Guard:
    """Return the guard of the shipped shapes, compiled once."""
    return Guard(SHIPPED)


class _Description:
    """The triples of one node, with the methods of ``FocusData`` that compiled checks call."""

    def __init__(self, node: ox.NamedNode, values: Values) -> None:
        self._node, self._values = node, values

    def values(self, node: Node, predicate: ox.NamedNode) -> Sequence[Node]:
        return self._values.get(predicate, ()) if node == self._node else ()

    fresh = values

    def some(self, node: Node, predicate: ox.NamedNode, number: int) -> Sequence[Node]:
        return self.values(node, predicate)[:number]

    def classes(self, node: Node) -> frozenset[Node]:
        return frozenset(self.values(node, TYPE))

    def is_a(self, node: Node, kind: Node) -> bool:
        return kind in self.values(node, TYPE)

    def subjects(self, predicate: ox.NamedNode, node: Node) -> set[Node]:
        return {self._node} if node in self.values(self._node, predicate) else set()

    def leads_here(self, predicate: ox.NamedNode, node: Node) -> bool:
        return bool(self.subjects(predicate, node))
