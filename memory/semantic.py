"""Semantic memory: what is known, as RDF in named graphs that outlive the process.

>>> import tempfile
>>> with SemanticMemory.open(Path(tempfile.mkdtemp()) / "memory", create=True) as memory:
...     memory.lessons()
()
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import pyoxigraph as ox

from deixis.memory import ledger
from deixis.memory.change import Change, Models, arriving, concluding, departing, incoming, modelling, together
from deixis.memory.closing import Closing
from deixis.memory.errors import MemoryFormatError, RejectedWriteError, UnknownLessonError
from deixis.memory.graphs import GraphName, ModelSet, graph_iri, models_graph
from deixis.memory.merged import default_graph, merging
from deixis.memory.opening import Opened, open_memory
from deixis.memory.stats import MemoryStats, count
from deixis.memory.writing import committed, reading
from deixis.ontology.relation import nearest

if TYPE_CHECKING:
    import rdflib

    from deixis.memory.results import QueryResult


class SemanticMemory(Closing):
    """The semantic memory in one folder, owned by this process until it is closed."""

    def __init__(self, opened: Opened) -> None:
        self._opened: Opened | None = opened
        self._views: list[rdflib.Dataset] = []
        self._union: list[ox.NamedNode] | None = None  # the graphs that a query looks at, since the last write

    @classmethod
    def open(cls, path: str | Path, create: bool = False) -> SemanticMemory:
        """Opens a memory, or makes one with ``create``.

        Raises MemoryBusyError where somebody has it open, MemoryFormatError where there is none or it cannot be
        believed, MemoryWriteError where the folder cannot be written. A failed open changes nothing.
        """
        return cls(open_memory(Path(path), create))

    def close(self) -> None:
        """Lets go of the folder; views made by :meth:`dataset` are of no use any more."""
        if self._opened is not None:
            opened, self._opened = self._opened, None
            self._drop_views()
            opened.close()

    @property
    def path(self) -> Path:
        """The folder."""
        return self._open.folder

    @property
    def store(self) -> ox.Store:
        """The Oxigraph store; read it, and leave writing to this class."""
        return self._open.store

    @property
    def _open(self) -> Opened:
        if self._opened is None:
            raise MemoryFormatError("this memory is closed: open it again")
        return self._opened

    def learn(
        self,
        lesson: str,
        contributions: Mapping[GraphName, Sequence[ox.Triple]],
        inferred: Sequence[ox.Triple],
        models: Models | None = None,
    ) -> None:
        """Writes a lesson, and what now follows from everything, in one step; see :meth:`learn_all`."""
        self.learn_all({lesson: contributions}, inferred, models)

    def learn_all(
        self,
        lessons: Mapping[str, Mapping[GraphName, Sequence[ox.Triple]]],
        inferred: Sequence[ox.Triple],
        models: Models | None = None,
    ) -> None:
        """Writes lessons, and what now follows from everything, in one step.

        ``inferred`` replaces the inferred graph, ``models`` the sets of models that are given. Blank nodes become
        names. Raises RejectedWriteError, having written nothing, where a lesson is known already, says nothing, or
        would break the shapes.
        """
        changes, known = [], self.lessons()
        for lesson, contributions in lessons.items():
            if lesson in known:
                raise RejectedWriteError(f"lesson '{lesson}' is known already: forget it first, or choose another name")
            said = incoming(lesson, contributions)
            if not any(said.values()):
                raise RejectedWriteError(f"lesson '{lesson}' says nothing: give at least one triple")
            changes.append(arriving(self.store, lesson, said))
        self.commit(together(*changes, concluding(self.store, inferred), modelling(self.store, models or {})))

    def forget(self, lesson: str, inferred: Sequence[ox.Triple], models: Models | None = None) -> None:
        """Takes back what only this lesson contributed, and replaces the inferred graph and models, in one step.

        Raises UnknownLessonError, naming the nearest one, where there is no such lesson; RejectedWriteError where
        something that stays depends on what would go.
        """
        self._known(lesson)
        gone = departing(self.store, lesson)
        self.commit(together(gone, concluding(self.store, inferred), modelling(self.store, models or {})))

    def conclude(self, inferred: Sequence[ox.Triple], models: Models | None = None) -> None:
        """Replaces the inferred graph, and the models that are given, in one step."""
        change = together(concluding(self.store, inferred), modelling(self.store, models or {}))
        if change.statements:
            self.commit(change)

    def keep_models(self, models: Models) -> None:
        """Replaces the sets of learned models that are given, in one step; an empty set takes them away."""
        change = modelling(self.store, models)
        if change.statements:
            self.commit(change)

    def models(self, which: ModelSet) -> list[ox.Triple]:
        """The triples of a set of learned models."""
        with reading(self.path):
            return list(ledger.triples_in(self.store, models_graph(which)))

    def remaining(self, lesson: str) -> dict[GraphName, list[ox.Triple]]:
        """What the canonical graphs would hold without that lesson; raises UnknownLessonError where there is none."""
        self._known(lesson)
        with reading(self.path):
            gone = departing(self.store, lesson).removed
            return {
                name: [triple for triple in self.triples(name) if triple not in gone.get(name, frozenset())]
                for name in GraphName
            }

    def load(self, contributions: Mapping[GraphName, Iterable[ox.Triple]]) -> None:
        """Writes much at once that belongs to no lesson: fast, all or nothing, guarded by the same shapes.

        Raises RejectedWriteError where the shapes would be broken, and writes nothing then.
        """
        from deixis.memory.bulk import load_aside

        self._drop_views()
        self._union = None
        load_aside(self._open, contributions)

    def lessons(self) -> tuple[str, ...]:
        """The lessons in the order learned."""
        with reading(self.path):
            return ledger.lessons(self.store)

    def contributions(self, lesson: str) -> dict[GraphName, list[ox.Triple]]:
        """What one lesson contributed, by graph; raises UnknownLessonError where there is none."""
        self._known(lesson)
        with reading(self.path):
            return ledger.copies(self.store, lesson)

    def triples(self, name: GraphName) -> Iterator[ox.Triple]:
        """The triples of a canonical graph, in no stated order."""
        with reading(self.path):
            yield from ledger.triples_in(self.store, graph_iri(GraphName(name)))

    def query(self, sparql: str) -> QueryResult:
        """Asks SELECT, ASK, CONSTRUCT or DESCRIBE of the asserted, inferred and learned graphs together.

        ``GRAPH ?g`` reaches all six canonical graphs. Raises QueryError, with the place, for anything else.
        """
        from deixis.memory.sparql import run_query

        with reading(self.path):
            if self._union is None:
                self._union = default_graph(self.store)
            return run_query(self.store, sparql, self._union)

    def dataset(self) -> rdflib.Dataset:
        """A live view of the six canonical graphs for rdflib; to be read only."""
        from deixis.memory.rdflib_view import dataset_view

        view = dataset_view(self.store)
        self._views.append(view)
        return view

    def stats(self) -> MemoryStats:
        """Counts of what is kept."""
        with reading(self.path):
            return count(self.store, self.path, len(self.lessons()))

    def commit(self, change: Change) -> None:
        """Writes a change in one step, if what comes of it keeps to the shapes; raises RejectedWriteError if not."""
        from deixis.memory.validation import check_change

        check_change(self.store, change)
        self._union = None
        with committed(self.path):
            statements = [*change.statements, *merging(self.store, change.added, change.removed)]
            self.store.update(" ;\n".join(statements))
            self.store.flush()

    def _known(self, lesson: str) -> None:
        known = self.lessons()
        if lesson not in known:
            near = nearest(lesson, list(known))
            hint = (
                f"did you mean '{near}'?" if near else f"it holds: {', '.join(known[-5:])}" if known else "it has none"
            )
            raise UnknownLessonError(f"no lesson '{lesson}' in the memory at {self.path}; {hint}")

    def _drop_views(self) -> None:
        for view in self._views:
            view.store._store = ox.Store()  # type: ignore[attr-defined]
        self._views.clear()
