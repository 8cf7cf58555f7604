"""Semantic memory: RDF in named graphs on disk.

>>> import tempfile
>>> with SemanticMemory.open(Path(tempfile.mkdtemp()) / "memory", create=True) as memory:
...     memory.lessons()
()
"""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyoxigraph as ox

from deixis.memory import folder as files
from deixis.memory.errors import MemoryFormatError, MemoryWriteError, RejectedWriteError, UnknownLessonError
from deixis.memory.folder import committed, read_mark, reading, write_mark
from deixis.memory.journal import JointWrite
from deixis.memory.owner import Closing, forked
from deixis.memory.semantic.opening import Opened, open_memory
from deixis.memory.semantic.queries.limits import QUERY_MEMORY_LIMIT, QUERY_TIME_LIMIT, QueryLimits
from deixis.memory.semantic.queries.union import (
    BUILD,
    building,
    default_graph,
    merge_if_overlapping,
    merging,
    overlapping,
)
from deixis.memory.semantic.rdf import ledger
from deixis.memory.semantic.rdf.change import (
    Change,
    Models,
    arriving,
    concluding,
    departing,
    incoming,
    modelling,
    named,
    together,
)
from deixis.memory.semantic.rdf.graphs import (
    COUNTED,
    KEPT_UP,
    MERGED,
    UNION,
    GraphName,
    ModelSet,
    graph_iri,
    loaded_graph,
    models_graph,
)
from deixis.memory.semantic.rdf.links import unlinking
from deixis.memory.semantic.stats import MemoryStats, count
from deixis.spelling import nearest

if TYPE_CHECKING:
    import rdflib

    from deixis.memory.semantic.queries.results import QueryResult
    from deixis.memory.semantic.queries.snapshot import SnapshotQueries


def load_aside(opened: Opened, contributions: Mapping[GraphName, Iterable[ox.Triple]]) -> None:
    """Load triples in a copy of the store: see :meth:`SemanticMemory.load`.

    Parameters
    ----------
    opened
        The open memory, whose store is replaced.
    contributions
        Triples by graph.

    Raises
    ------
    RejectedWriteError
        If a triple is in the inferred graph, or the store would break the shapes.
    """
    from deixis.memory.semantic.validation.validate import check_store

    if GraphName.INFERRED in contributions:
        raise RejectedWriteError("the inferred graph cannot be loaded: it is computed from the others")

    def fill(aside: Path) -> None:
        opened.store.backup(aside)
        store = ox.Store(aside)
        for name, triples in contributions.items():
            store.bulk_extend(_quads(opened.store, GraphName(name), triples))
        for quad in list(store.quads_for_pattern(COUNTED, KEPT_UP, None, COUNTED)):
            store.remove(quad)  # what follows from the content must be recomputed
        merge_if_overlapping(store)
        check_store(store)
        store.flush()

    _swap_in(opened, fill, files.read_mark(opened.folder))


def commit_aside(opened: Opened, write: Callable[[SemanticMemory], None]) -> None:
    """Commit many parts in a copy of the store: see :meth:`SemanticMemory.commit_in_bulk`.

    Parameters
    ----------
    opened
        The open memory, whose store is replaced.
    write
        Function that commits the parts.
    """

    def fill(aside: Path) -> None:
        opened.store.backup(aside)
        copy = _Copy(aside)
        try:
            write(copy)
            copy.finish()
        finally:
            copy.close()

    _swap_in(opened, fill, files.read_mark(opened.folder))


def rewrite(opened: Opened, mark: dict[str, Any]) -> None:
    """Rewrite the store with its present content only, as the store itself never frees the texts of removed triples.

    Parameters
    ----------
    opened
        The open memory, whose store is replaced.
    mark
        New content of ``memory.json``.
    """

    def fill(aside: Path) -> None:
        store = ox.Store(aside)
        store.bulk_extend(opened.store)
        store.flush()

    _swap_in(opened, fill, mark)


def _swap_in(opened: Opened, fill: Callable[[Path], None], mark: dict[str, Any]) -> None:
    """Replace the open store with one that ``fill`` makes in a folder; if it fails, change nothing."""
    aside = opened.folder / files.NEW
    with committed(opened.folder):
        shutil.rmtree(aside, ignore_errors=True)
        opened.store.flush()
        try:
            fill(aside)
            opened.shut_to_replace()
        except BaseException:
            shutil.rmtree(aside, ignore_errors=True)
            raise
        files.swap(opened.folder, mark)


def _quads(store: ox.Store, name: GraphName, triples: Iterable[ox.Triple]) -> Iterator[ox.Quad]:
    """Yield the quads to write; where the graph has content, a triple that exists already is marked as loaded too."""
    graph, mark = graph_iri(name), loaded_graph(name)
    merged = name in UNION and store.contains_named_graph(MERGED)
    held = any(store.quads_for_pattern(None, None, None, graph))
    for triple in named(f"loaded.{name}", triples):
        quad = ox.Quad(triple.subject, triple.predicate, triple.object, graph)
        if held and quad in store:
            yield ox.Quad(triple.subject, triple.predicate, triple.object, mark)
        if merged:
            yield ox.Quad(triple.subject, triple.predicate, triple.object, MERGED)
        yield quad


MIN_FORGOTTEN = 10
"""Minimum number of forgotten lessons after which the store is rewritten, to free disk space."""


class SemanticMemory(Closing):
    """The semantic memory in one folder, owned by this process until it is closed.

    Examples
    --------
    >>> import tempfile
    >>> from deixis.memory.semantic.rdf.graphs import GraphName, ModelSet
    >>> folder = tempfile.TemporaryDirectory()
    >>> memory = SemanticMemory.open(folder.name + "/memory", create=True)
    >>> fork = ox.Triple(
    ...     ox.NamedNode("https://example.org/fork"),
    ...     ox.NamedNode("http://www.w3.org/2000/01/rdf-schema#label"),
    ...     ox.Literal("fork"))
    >>> memory.learn("supper-1", {GraphName.LEARNED: [fork]}, inferred=[])
    >>> memory.learn_all({"supper-2": {GraphName.LEARNED: [fork]}, "tea-1": {GraphName.LEARNED: [fork]}}, inferred=[])
    >>> memory.lessons(), memory.knows("tea-1"), memory.contributions("tea-1") == {GraphName.LEARNED: [fork]}
    (('supper-1', 'supper-2', 'tea-1'), True, True)
    >>> memory.query("SELECT ?thing WHERE { ?thing rdfs:label 'fork' }")
    <QueryResult SELECT ?thing: 1 row>
    >>> len(memory.dataset().query("SELECT ?thing WHERE { ?thing rdfs:label 'fork' }"))
    1
    >>> memory.forget("tea-1", inferred=[])
    >>> list(memory.triples(GraphName.LEARNED)) == [fork], memory.stats().lessons
    (True, 2)
    >>> memory.path.name, memory.read_only, memory.kept_up() is None
    ('memory', False, True)

    A change is made first and committed with what follows from it; many are committed in a copy of the memory:

    >>> memory.commit(memory.departure("supper-2"))
    >>> memory.commit_in_bulk(lambda copy: copy.commit(copy.arrival({"tea-2": {GraphName.LEARNED: [fork]}})))
    >>> memory.require_lesson("tea-2")
    >>> memory.lessons()
    ('supper-1', 'tea-2')

    Models and triples without a lesson:

    >>> memory.keep_models({ModelSet.WORDS: [fork]})
    >>> len(memory.models(ModelSet.WORDS))
    1
    >>> memory.load({GraphName.ASSERTED: [fork]})
    >>> memory.require_writable()
    >>> memory.incomplete_layouts("SELECT ?left WHERE { ?left dx:left ?right }")
    ()
    >>> memory.update_copy(is_current=lambda store: len(store) > 0, follow=lambda store: None)
    >>> len(memory.store) > 0
    True
    >>> memory.close()
    >>> folder.cleanup()
    """

    def __init__(self, opened: Opened) -> None:
        self._opened: Opened | None = opened
        self._views: list[rdflib.Dataset] = []
        self._forgets = 0  # number of forgotten lessons
        self._union: list[ox.NamedNode] | None = None  # graphs that a query reads; None after a write
        self._queries: SnapshotQueries | None = None

    @classmethod
    def open(cls, path: str | Path, create: bool = False) -> SemanticMemory:
        """Open a memory, or make one.

        A memory in a folder that cannot be written is opened for reading only: a write raises ReadOnlyMemoryError. A
        failed opening changes nothing.

        Parameters
        ----------
        path
            The folder of the memory.
        create
            True to make a memory where there is none.

        Returns
        -------
        SemanticMemory
            The open memory, which this process owns until it is closed.

        Raises
        ------
        MemoryBusyError
            If another process has it open.
        MemoryFormatError
            If there is no memory, or its files are invalid.
        MemoryWriteError
            If the folder cannot be written.
        """
        return cls(open_memory(Path(path), create))

    def close(self) -> None:
        """Close the memory; views made by :meth:`dataset` cannot be used afterwards.

        If as many lessons were forgotten as are left, the disk space of the forgotten ones is freed.
        """
        if self._opened is not None:
            opened, self._opened = self._opened, None
            self._drop_views()
            if self._queries is not None:
                self._queries.close()
            try:
                if self._forgets and not opened.inherited:
                    _compact(opened, self._forgets)
            finally:
                opened.close()

    @property
    def path(self) -> Path:
        """Folder of the memory."""
        return self._open.folder

    @property
    def store(self) -> ox.Store:
        """The Oxigraph store, for reading; write with the methods of this class."""
        return self._open.store

    @property
    def _open(self) -> Opened:
        if self._opened is None:
            raise MemoryFormatError("this memory is closed: open it again")
        if self._opened.inherited:
            raise forked(self._opened.folder)
        return self._opened

    @property
    def _writable(self) -> Opened:
        opened = self._open
        opened.require_writable()
        return opened

    @property
    def read_only(self) -> bool:
        """True if the memory is in a folder that cannot be written."""
        return self._open.read_only is not None

    def require_writable(self) -> None:
        """Raise ReadOnlyMemoryError if the memory is in a folder that cannot be written."""
        self._open.require_writable()

    def learn(
        self,
        lesson: str,
        contributions: Mapping[GraphName, Sequence[ox.Triple]],
        inferred: Sequence[ox.Triple],
        models: Models | None = None,
    ) -> None:
        """Write a lesson, and what then follows from all lessons, in one step; see :meth:`learn_all`.

        Parameters
        ----------
        lesson
            Id of the lesson.
        contributions
            Triples by graph.
        inferred
            The new inferred graph.
        models
            Sets of learned models to replace.

        Raises
        ------
        RejectedWriteError
            If the lesson is known already, has no triples, or breaks the shapes.
        """
        self.learn_all({lesson: contributions}, inferred, models)

    def learn_all(
        self,
        lessons: Mapping[str, Mapping[GraphName, Sequence[ox.Triple]]],
        inferred: Sequence[ox.Triple],
        models: Models | None = None,
    ) -> None:
        """Write lessons, and what then follows from all lessons, in one step; blank nodes get names.

        Parameters
        ----------
        lessons
            Triples by graph, by the id of the lesson.
        inferred
            The new inferred graph.
        models
            Sets of learned models to replace.

        Raises
        ------
        RejectedWriteError
            If a lesson is known already, has no triples, or breaks the shapes; nothing is written then.
        """
        self.commit(
            together(self.arrival(lessons), concluding(self.store, inferred), modelling(self.store, models or {}))
        )

    def arrival(self, lessons: Mapping[str, Mapping[GraphName, Sequence[ox.Triple]]]) -> Change:
        """Return the change that new lessons make, to be committed with what follows from it.

        Parameters
        ----------
        lessons
            Triples by graph, by the id of the lesson.

        Returns
        -------
        Change
            The change.

        Raises
        ------
        RejectedWriteError
            If a lesson is known already, has no triples, or breaks the shapes.
        """
        changes = []
        for lesson, contributions in lessons.items():
            if self.knows(lesson):
                raise RejectedWriteError(f"there is already a lesson '{lesson}': forget it first, or choose another")
            contributions_of_lesson = incoming(lesson, contributions)
            if not any(contributions_of_lesson.values()):
                raise RejectedWriteError(f"lesson '{lesson}' has no triples: give at least one")
            changes.append(arriving(self.store, lesson, contributions_of_lesson))
        return together(*changes, Change(operations=tuple(ledger.numbering(self.store, list(lessons)))))

    def departure(self, lesson: str) -> Change:
        """Return the change that removes a lesson, to be committed with what follows.

        Parameters
        ----------
        lesson
            Id of the lesson.

        Returns
        -------
        Change
            The change.

        Raises
        ------
        UnknownLessonError
            If there is no such lesson.
        """
        self.require_lesson(lesson)
        with reading(self.path):
            self._forgets += 1
            number = Change(operations=tuple(ledger.unnumbering(self.store, lesson)))
            return together(departing(self.store, lesson), unlinking(lesson), number)

    def forget(self, lesson: str, inferred: Sequence[ox.Triple], models: Models | None = None) -> None:
        """Remove what only one lesson contributed, and replace the inferred graph and models, in one step.

        Parameters
        ----------
        lesson
            Id of the lesson.
        inferred
            The new inferred graph.
        models
            Sets of learned models to replace.

        Raises
        ------
        UnknownLessonError
            If there is no such lesson; the message names the nearest one.
        RejectedWriteError
            If something that stays depends on something that is removed.
        """
        gone = self.departure(lesson)
        self.commit(together(gone, concluding(self.store, inferred), modelling(self.store, models or {})))

    def keep_models(self, models: Models) -> None:
        """Replace some sets of learned models in one step.

        Parameters
        ----------
        models
            Sets of learned models; an empty set removes the models.
        """
        change = modelling(self.store, models)
        if change.operations:
            self.commit(change, self.kept_up() if ModelSet.SIZES not in models else None)

    def models(self, which: ModelSet, properties: Iterable[str] | None = None) -> list[ox.Triple]:
        """Return the triples of a set of learned models.

        Parameters
        ----------
        which
            The set.
        properties
            IRIs of the wanted properties; default: all.

        Returns
        -------
        list of ox.Triple
            The triples.
        """
        graph = models_graph(which)
        with reading(self.path):
            if properties is None:
                return list(ledger.triples_in(self.store, graph))
            named = [ox.NamedNode(str(name)) for name in properties]
            return [quad.triple for name in named for quad in self.store.quads_for_pattern(None, name, None, graph)]

    def load(self, contributions: Mapping[GraphName, Iterable[ox.Triple]]) -> None:
        """Write many triples that belong to no lesson: fast, all or nothing, checked by the same shapes.

        Parameters
        ----------
        contributions
            Triples by graph.

        Raises
        ------
        RejectedWriteError
            If they break the shapes; nothing is written then.
        """
        self._drop_views()
        with self._writing():
            load_aside(self._writable, contributions)

    def lessons(self) -> tuple[str, ...]:
        """Return the lessons in the order learned.

        Returns
        -------
        tuple of str
            Ids of the lessons.
        """
        with reading(self.path):
            return ledger.lessons(self.store)

    def knows(self, lesson: str) -> bool:
        """Return whether there is a lesson with an id.

        Parameters
        ----------
        lesson
            The id.

        Returns
        -------
        bool
            True if there is one.
        """
        with reading(self.path):
            return ledger.knows(self.store, lesson)

    def contributions(self, lesson: str) -> dict[GraphName, list[ox.Triple]]:
        """Return the contributions of one lesson.

        Parameters
        ----------
        lesson
            Id of the lesson.

        Returns
        -------
        dict
            Triples by graph.

        Raises
        ------
        UnknownLessonError
            If there is no such lesson.
        """
        self.require_lesson(lesson)
        with reading(self.path):
            return ledger.copies(self.store, lesson)

    def triples(self, name: GraphName) -> Iterator[ox.Triple]:
        """Yield the triples of a canonical graph, in no stated order.

        Parameters
        ----------
        name
            Name of the graph.

        Yields
        ------
        ox.Triple
            A triple.
        """
        with reading(self.path):
            yield from ledger.triples_in(self.store, graph_iri(GraphName(name)))

    def query(
        self, sparql: str, time_limit: float = QUERY_TIME_LIMIT, memory_limit: int = QUERY_MEMORY_LIMIT
    ) -> QueryResult:
        """Run a SELECT, ASK, CONSTRUCT or DESCRIBE query over the ontology and what was asserted, inferred and learned.

        ``GRAPH ?g`` reaches all six canonical graphs. Another process answers, from a snapshot of the store.

        Parameters
        ----------
        sparql
            The query.
        time_limit
            Seconds until the answer.
        memory_limit
            Bytes for the evaluation. The answer may take a sixteenth of them.

        Returns
        -------
        QueryResult
            The answer, read to the end, with notes on what it may lack.

        Raises
        ------
        QueryError
            The query is refused, nested too deeply or malformed, or names a term in the namespace of the vocabulary
            that neither it nor the memory has; the message has the place.
        QueryTimeoutError, QueryMemoryError
            A limit is reached. Both are QueryErrors; there are no partial answers.
        """
        from deixis.memory.semantic.queries.sparql import notes_on, require_terms, run_query

        with reading(self.path):
            require_terms(self.store, sparql)
            if self._union is None:
                self._union = default_graph(self.store)
            found = run_query(self._answer, sparql, self._union, QueryLimits(time_limit, memory_limit))
            return replace(found, notes=notes_on(self.store, sparql, found.empty))

    def incomplete_layouts(self, sparql: str) -> tuple[str, ...]:
        """Return the layouts whose implications a query asks for, and of which not all are stored.

        Parameters
        ----------
        sparql
            The query.

        Returns
        -------
        tuple of str
            Names of layouts, in order.

        Raises
        ------
        QueryError
            The query is refused or malformed.
        """
        from deixis.memory.semantic.queries.sparql import incomplete_layouts

        with reading(self.path):
            return incomplete_layouts(self.store, sparql)

    def dataset(self) -> rdflib.Dataset:
        """Return a live, read-only view of the six canonical graphs for rdflib.

        Its ``query`` takes text, and has the limits of :meth:`query`.

        Returns
        -------
        rdflib.Dataset
            The view, which is closed with this memory.
        """
        from deixis.memory.semantic.queries.rdflib_view import dataset_view

        view = dataset_view(self.store, self._answer)
        self._views.append(view)
        return view

    def _answer(self, request: Mapping[str, Any], limits: QueryLimits) -> tuple[bytes, bytes]:
        """Return the reply of the process that answers queries."""
        from deixis.memory.semantic.queries.snapshot import SnapshotQueries

        if self._queries is None:
            self._queries = SnapshotQueries(self.path)
        return self._queries.ask(self.store, request, limits)

    def stats(self) -> MemoryStats:
        """Return counts of the content.

        Returns
        -------
        MemoryStats
            The counts.
        """
        with reading(self.path):
            return count(self.store, self.path, len(self.lessons()))

    def commit(self, change: Change, kept_up: str | None = None, write: JointWrite | None = None) -> None:
        """Write a change in one step if the result conforms to the shapes.

        Parameters
        ----------
        change
            Triples to add and to remove, with the operations that do so.
        kept_up
            Rules by which the inferred graph and the statistics are up to date after the change; see :meth:`kept_up`.
            Without them they must be recomputed.
        write
            The write over several stores that this commit decides, if it decides one.

        Raises
        ------
        RejectedWriteError
            If the result does not conform to the shapes; nothing is written then.
        """
        from deixis.memory.semantic.validation.validate import check_change

        self.require_writable()
        check_change(self.store, change)
        with self._writing(), committed(self.path):
            operations = [*change.operations, *merging(self.store, change.added, change.removed)]
            operations += ledger.keeping_up(self.store, kept_up)
            operations += ledger.marking(self.store, write)
            ledger.update(self.store, operations, building(self.store, change.added, change.removed))
            self.store.flush()

    def update_copy(self, is_current: Callable[[ox.Store], bool], follow: Callable[[ox.Store], None]) -> None:
        """Bring a copy of data that another store holds up to date; lessons and shapes do not concern it.

        Parameters
        ----------
        is_current
            Function that says whether the copy is up to date.
        follow
            Function that writes what is missing; a crash during it must not damage the copy.
        """
        with reading(self.path):
            if is_current(self.store):
                return
        self.require_writable()
        with self._writing(), committed(self.path):
            follow(self.store)
            self.store.flush()

    def commit_in_bulk(self, write: Callable[[SemanticMemory], None]) -> None:
        """Commit many changes at once, to a copy of this memory, which then replaces it.

        This is several times as fast as one commit of all, in the memory that one change takes. If ``write`` raises,
        this memory stays as it is.

        Parameters
        ----------
        write
            Function that commits the changes to the copy.
        """

        def counting(copy: SemanticMemory) -> None:
            write(copy)
            self._forgets += copy._forgets
            copy._forgets = 0

        self._drop_views()
        with self._writing():
            commit_aside(self._writable, counting)

    def kept_up(self) -> str | None:
        """Return the rules by which the inferred graph and the statistics are up to date.

        Returns
        -------
        str or None
            The rules, or None if the graph or the statistics are not up to date.
        """
        with reading(self.path):
            return ledger.kept_up(self.store)

    def require_lesson(self, lesson: str) -> None:
        """Raise UnknownLessonError, naming the nearest lesson, if there is no lesson with an id.

        Parameters
        ----------
        lesson
            The id.

        Raises
        ------
        UnknownLessonError
            If there is no such lesson.
        """
        if not self.knows(lesson):
            known = self.lessons()
            near = nearest(lesson, list(known))
            hint = f"did you mean '{near}'?" if near else f"it has: {', '.join(known[-5:])}" if known else "it is empty"
            raise UnknownLessonError(f"no lesson '{lesson}' in the memory at {self.path}; {hint}")

    @contextlib.contextmanager
    def _writing(self) -> Iterator[None]:
        """Make queries read the store again after it is written."""
        try:
            yield
        finally:
            self._union = None
            if self._queries is not None:
                self._queries.changed()

    def _drop_views(self) -> None:
        for view in self._views:
            view.store._store = ox.Store()  # type: ignore[attr-defined]
        self._views.clear()


class _OpenedCopy(Opened):
    """The store of a copy, which needs no lock, as only this process knows the copy."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.read_only, self.inherited = folder, None, False
        self._store = ox.Store(folder)

    def close(self) -> None:
        self.shut()


class _Copy(SemanticMemory):
    """A copy of a memory that replaces it when it is complete; its commits are fast, and not atomic."""

    def __init__(self, folder: Path) -> None:
        super().__init__(_OpenedCopy(folder))
        self._overlapping = False

    def commit(self, change: Change, kept_up: str | None = None, write: JointWrite | None = None) -> None:
        from deixis.memory.semantic.validation.validate import check_change

        check_change(self.store, change)
        if not (self._overlapping or self.store.contains_named_graph(MERGED)):
            self._overlapping = overlapping(self.store, change.added, change.removed)
        operations = [*change.operations, *merging(self.store, change.added, change.removed)]
        operations += [*ledger.keeping_up(self.store, kept_up), *ledger.marking(self.store, write)]
        ledger.update_in_bulk(self.store, operations)

    def finish(self) -> None:
        """Write what is written once, after all commits.

        Each commit makes files of its own; until they are compacted, a look-up may have to read many of them.
        """
        if self._overlapping:
            self.store.update(BUILD)
        self.store.flush()
        self.store.optimize()


def _compact(opened: Opened, forgotten: int) -> None:
    """Rewrite a store that has no more lessons than were forgotten since the last rewrite; ignore a failure.

    So each forgotten lesson pays for copying one lesson, however many there are.
    """
    with contextlib.suppress(MemoryWriteError, MemoryFormatError, OSError):
        mark = read_mark(opened.folder)
        gone = int(mark.pop("forgotten", 0)) + forgotten
        if gone >= MIN_FORGOTTEN and gone >= len(ledger.lessons(opened.store)):
            rewrite(opened, mark)
        else:
            write_mark(opened.folder, {**mark, "forgotten": gone})
