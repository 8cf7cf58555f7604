"""The semantic memory of a session, opened on demand, and the words and sizes learned in it."""

from __future__ import annotations

import re
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING

from deixis.memory.on_demand import OnDemand
from deixis.memory.owner import Closing
from deixis.memory.semantic.queries.limits import QUERY_MEMORY_LIMIT, QUERY_TIME_LIMIT
from deixis.reasoning.errors import NothingFoundError

if TYPE_CHECKING:
    from deixis.grammar.script import Script
    from deixis.learning.lessons.recollection import Recollection
    from deixis.learning.models.words import LearnedWords
    from deixis.memory.journal import Commit, JointWrite
    from deixis.memory.perceptual.protocol import Progress
    from deixis.memory.perceptual.records import View
    from deixis.memory.semantic.queries.results import QueryResult
    from deixis.memory.semantic.rdf.links import Link
    from deixis.memory.semantic.store import SemanticMemory
    from deixis.ontology.lessons.types import LayoutConcept, Lesson
    from deixis.ontology.tbox import Ontology
    from deixis.perception.scene import Scene
    from deixis.reasoning.description_logic.object_view import ObjectView
    from deixis.reasoning.grounding.evidence.words.meaning import Meaning

COMPLETION_SHARE = 0.5
"""Share of a query's time limit in which the implications of layouts are computed."""


_GRAPHS = re.compile(r"\b(graph|from)\b", re.IGNORECASE)  # a query without these reads no graph of the blackboard


class KnowledgeStore(Closing):
    """Learned layouts, lessons, words and sizes; the memory stays open from the first call that needs it."""

    def __init__(self, path: Path, ontology: Ontology | None = None) -> None:
        self._given = ontology
        self._memory = OnDemand(path, _open)
        self._meaning: Meaning | None = None  # present words and sizes; None after a change

    @cached_property
    def ontology(self) -> Ontology:
        """Words that scripts may use: the given ones, else the shipped ones."""
        from deixis.ontology.tbox import default_ontology

        return default_ontology() if self._given is None else self._given

    @property
    def path(self) -> Path:
        """The folder of the memory."""
        return self._memory.path

    def close(self) -> None:
        """Close the memory; a later call that needs it raises MemoryFormatError."""
        self._meaning = None
        self._memory.close()

    def require_usable(self) -> None:
        """Raise MemoryFormatError if this store is closed."""
        self._memory.require_usable()

    def exists(self) -> bool:
        """Return whether there is a memory at the path.

        Returns
        -------
        bool
            True if there is one.

        Raises
        ------
        MemoryFormatError
            If the path holds something else, or a damaged memory.
        """
        from deixis.memory.folder import FolderState, inspect

        return self._memory.is_open or inspect(self.path) not in (FolderState.ABSENT, FolderState.EMPTY)

    def memory(self, create: bool = False) -> SemanticMemory:
        """Return the open memory.

        Parameters
        ----------
        create
            True to make a memory where there is none.

        Returns
        -------
        SemanticMemory
            The store, open until the session ends.

        Raises
        ------
        DeixisError
            If there is no memory and ``create`` is False.
        """
        return self._memory.get(create)

    def meaning(self) -> Meaning:
        """Return the words and sizes that apply: the learned ones, and the shipped ones for the rest.

        Returns
        -------
        Meaning
            Models of words and ranges of sizes.

        Raises
        ------
        OntologyError
            If a learned model in the memory is incomplete.
        MemoryBusyError
            If another process has the memory open.
        """
        from deixis.reasoning.grounding.evidence.words.meaning import SHIPPED

        if self._meaning is None:
            self._meaning = self._in_force() if self.exists() else SHIPPED
        return self._meaning

    def _in_force(self) -> Meaning:
        from deixis.memory.semantic.rdf.graphs import ModelSet
        from deixis.ontology.models.relation_triples import models_from_triples
        from deixis.ontology.models.sizes import SIZE_PROPERTIES, sizes_from_triples
        from deixis.reasoning.grounding.evidence.words.meaning import Meaning, shipped_models

        words = models_from_triples(self.memory().models(ModelSet.WORDS))
        sizes = sizes_from_triples(self.memory().models(ModelSet.SIZES, SIZE_PROPERTIES))
        return Meaning(shipped_models().replaced(*words) if words else None, sizes)

    def recollection(self) -> Recollection:
        """Return all lessons of the memory, ready to be learned from.

        Returns
        -------
        Recollection
            The lessons with their scenes; empty without a memory.
        """
        from deixis.learning.lessons.recollection import Recollection
        from deixis.learning.update import remembered

        return remembered(self.memory(), self.ontology) if self.exists() else Recollection(())

    def keeping(self, lessons: Sequence[Lesson], seen: Mapping[str, Sequence[View]]) -> Commit:
        """Return a function that commits lessons, what follows from them, and the views that each taught, in one step.

        Parameters
        ----------
        lessons
            The lessons, in order.
        seen
            Views by the id of the lesson that teaches them.

        Returns
        -------
        Commit
            The function, to be called while the memory is held.

        Raises
        ------
        DeixisError
            If the lessons are refused; nothing is changed then.
        """
        from deixis.learning.update import keeping

        return self._forgetting_meaning(keeping(self.memory(create=True), self.ontology, lessons, seen))

    def _forgetting_meaning(self, commit: Commit) -> Commit:
        """Return a commit after which the present words and sizes are read again."""

        def committing(write: JointWrite | None) -> None:
            try:
                commit(write)
            finally:
                self._meaning = None

        return committing

    def learn_relations(self, examples: Sequence[tuple[Script, Scene]] = (), strength: float = 3.0) -> LearnedWords:
        """Fit the models of relation words to all lessons, and to labelled examples.

        The examples are kept as lessons, and the models replace those that were learned before.

        Parameters
        ----------
        examples
            Scripts, each with a labelled scene.
        strength
            Weight of the shipped models, above 0.

        Returns
        -------
        LearnedWords
            The models that changed, and the examples that teach nothing, with reasons.

        Raises
        ------
        NothingFoundError
            If there is nothing to learn from; nothing is changed then.
        SettingError
            If ``strength`` is not above 0.
        """
        from deixis.learning.models.words import new_lessons
        from deixis.learning.update import keep_words

        taken = self.memory().knows if self.exists() else lambda view_id: False
        lessons, left_out = new_lessons(examples, self.recollection(), taken)
        if not lessons and not self.exists():
            reason = f"there are no lessons at {self.path}, and no example teaches anything"
            raise NothingFoundError("; ".join((f"nothing to learn: {reason}", *left_out)))
        learned = keep_words(self.memory(create=True), self.ontology, lessons, strength)
        self._meaning = None
        return replace(learned, kept=tuple(lesson.id for lesson in lessons), left_out=(*learned.left_out, *left_out))

    def forget_relations(self) -> None:
        """Remove the learned models of relation words, so that the shipped ones apply again; keep the lessons."""
        from deixis.learning.update import forget_words

        forget_words(self.memory())
        self._meaning = None

    def forgetting(self, lesson: str) -> Commit:
        """Return a function that removes one lesson, what follows from it only, and its share in words and sizes.

        Parameters
        ----------
        lesson
            Id of the lesson.

        Returns
        -------
        Commit
            The function, to be called while the memory is held.

        Raises
        ------
        UnknownLessonError
            If there is no such lesson.
        """
        from deixis.learning.update import forgetting

        return self._forgetting_meaning(forgetting(self.memory(), self.ontology, lesson))

    def meaning_before(self, lesson: str) -> Meaning:
        """Return the present words, and the sizes that the lessons before a lesson taught.

        Parameters
        ----------
        lesson
            Id of the lesson.

        Returns
        -------
        Meaning
            Models of words and ranges of sizes.
        """
        from deixis.learning.update import sizes_before
        from deixis.ontology.models.sizes import sizes_from_triples

        before = sizes_from_triples(sizes_before(self.memory(), self.ontology, lesson))
        return replace(self.meaning(), sizes=before)

    def unlearning(
        self,
        lessons: Sequence[str],
        links: Mapping[str, Sequence[Link]],
        revised: Sequence[Lesson] = (),
        progress: Progress | None = None,
    ) -> Commit:
        """Return a function that removes lessons, with what follows from them only, and changes the links of views.

        Parameters
        ----------
        lessons
            Ids of the lessons.
        links
            All links of each view that changes, by the id of the view.
        revised
            Lessons that replace those with their ids.
        progress
            Called with the number of lessons that are done, and of all.

        Returns
        -------
        Commit
            The function, to be called while the memory is held.

        Raises
        ------
        UnknownLessonError
            If there is no such lesson.
        """
        from deixis.learning.update import unlearning

        return self._forgetting_meaning(unlearning(self.memory(), self.ontology, lessons, links, revised, progress))

    def import_(self, file: str | Path) -> None:
        """Import the export of another memory, or plain triples; keep what the memory has.

        Parameters
        ----------
        file
            The file.

        Raises
        ------
        InconsistencyError
            If the file contradicts the memory; nothing is changed then.
        """
        from deixis.learning.update import take_in

        self._memory.require_usable()
        self._memory.release()
        self._meaning = None
        take_in(file, self.path, self.ontology)

    def layouts(self) -> tuple[LayoutConcept, ...]:
        """Return every learned layout.

        Returns
        -------
        tuple of LayoutConcept
            One layout for each lesson; empty without a memory.
        """
        from deixis.memory.semantic.rdf.graphs import GraphName
        from deixis.ontology.lessons.read import layouts

        if not self.exists():
            return ()
        return layouts(self.memory().triples(GraphName.LEARNED), self.ontology.relations)

    def layout(self, name: str) -> LayoutConcept:
        """Return a learned layout.

        Parameters
        ----------
        name
            Name of the layout, or id of its lesson.

        Returns
        -------
        LayoutConcept
            The layout that was learned last with this name, or that of the lesson.

        Raises
        ------
        UnknownTermError
            If there is neither.
        """
        from deixis.learning.lessons.recollection import find_layout

        return find_layout(self.memory(), name, self.ontology.relations)

    def count_of_tables(self, name: str) -> int:
        """Return the number of lessons about a layout.

        Parameters
        ----------
        name
            Name of the layout.

        Returns
        -------
        int
            The number, without reading the lessons; 0 for the id of a lesson.
        """
        from deixis.learning.lessons.recollection import lessons_named

        return len(lessons_named(self.memory(), name))

    def query(
        self, sparql: str, time_limit: float = QUERY_TIME_LIMIT, memory_limit: int = QUERY_MEMORY_LIMIT
    ) -> QueryResult:
        """Run a SPARQL query over the memory.

        The first query about what layouts imply stores it for the layouts that implied too much when they were learned.

        Parameters
        ----------
        sparql
            Text of the query.
        time_limit
            Seconds until the answer.
        memory_limit
            Bytes for the evaluation.

        Returns
        -------
        QueryResult
            The answer, read to the end.

        Raises
        ------
        QueryError
            If the query is refused or malformed.
        QueryTimeoutError, QueryMemoryError
            If a limit is reached.
        """
        if _GRAPHS.search(sparql):
            self._follow_episodes()
        memory, started = self.memory(), time.monotonic()
        if time_limit > 0 and not memory.read_only and memory.incomplete_layouts(sparql):
            from deixis.deadline import Deadline
            from deixis.learning.update import complete_implications

            complete_implications(memory, self.ontology, Deadline.after(COMPLETION_SHARE * time_limit))
            time_limit = max(time_limit - (time.monotonic() - started), time_limit * (1 - COMPLETION_SHARE) / 2)
        return memory.query(sparql, time_limit, memory_limit)

    def _follow_episodes(self) -> None:
        """Bring the graphs of the blackboard up to date, if the memory has episodes."""
        from deixis.memory.episodes.blackboard import Blackboard, has_episodes
        from deixis.memory.episodes.projection import follow, is_current

        if has_episodes(self.path):
            with Blackboard.open(self.path) as board:
                self.memory(create=True).update_copy(partial(is_current, board), partial(follow, board))

    def owl(self) -> ObjectView:
        """Return the ontology with everything learned as objects of owlready2.

        The view has what is stated and inferred now, and does not see later changes. Without a memory it has the
        ontology only.

        Returns
        -------
        ObjectView
            An own world of owlready2, to be closed after use.
        """
        import pyoxigraph as ox

        from deixis.memory.semantic.exchange import TURTLE_GRAPHS
        from deixis.memory.semantic.rdf.graphs import GraphName
        from deixis.memory.semantic.rdf.package import packaged
        from deixis.ontology.rdf.triples import with_blank_nodes
        from deixis.ontology.rdf.vocabulary import BASE
        from deixis.reasoning.description_logic.object_view import ObjectView

        if self.exists():
            triples = {triple for name in TURTLE_GRAPHS for triple in self.memory().triples(name)}
        else:
            triples = set(packaged()[GraphName.ONTOLOGY])
        text = ox.serialize(with_blank_nodes(triples), format=ox.RdfFormat.N_TRIPLES) or b""
        return ObjectView.of(text.decode("utf-8"), BASE)


def _open(path: Path, create: bool) -> SemanticMemory:
    from deixis.memory.semantic.store import SemanticMemory

    return SemanticMemory.open(path, create=create)
