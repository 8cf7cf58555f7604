"""A memory that is opened when it is needed: what is done with it alone, without a table to look at."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Self

from deixis.grammar.script import Script
from deixis.memory.owner import Closing
from deixis.ontology.tbox import Ontology, default_ontology
from deixis.perception.scene import Scene
from deixis.reasoning.errors import NothingFoundError
from deixis.reasoning.grounding.evidence.meaning import SHIPPED, Meaning

if TYPE_CHECKING:
    from deixis.learning.recollection import Recollection
    from deixis.learning.words import LearnedWords
    from deixis.memory.semantic.queries.results import QueryResult
    from deixis.memory.semantic.store import SemanticMemory
    from deixis.ontology.lessons.types import LayoutConcept


def default_memory() -> Path:
    """``$DEIXIS_MEMORY``, else a folder for the user's data."""
    named = os.environ.get("DEIXIS_MEMORY")
    if named:
        return Path(named)
    data = os.environ.get("XDG_DATA_HOME")
    return (Path(data) if data else Path.home() / ".local" / "share") / "deixis" / "memory"


class MemorySession(Closing):
    """A memory held by this process from the first call that needs it until the session is closed, and never after."""

    def __init__(self, memory: str | Path | None = None, ontology: Ontology | None = None) -> None:
        self.path = default_memory() if memory is None else Path(memory)
        self.ontology = default_ontology() if ontology is None else ontology
        self._memory: SemanticMemory | None = None
        self._meaning: Meaning | None = None  # what is in force, since the last change
        self._closed = False

    def __enter__(self) -> Self:
        self._require_open()
        return super().__enter__()

    def close(self) -> None:
        """Lets go of the memory; what would need it afterwards raises MemoryFormatError."""
        self._closed = True
        self._let_go()

    def _let_go(self) -> None:
        """Closes what is open, until it is needed again."""
        self._meaning = None
        if self._memory is not None:
            self._memory.close()
            self._memory = None

    def remembers(self) -> bool:
        """Whether there is a memory at the path; raises MemoryFormatError where something else or a damaged one is."""
        from deixis.memory.folder import State, inspect

        return self._memory is not None or inspect(self.path) not in (State.ABSENT, State.EMPTY)

    def memory(self, create: bool = False) -> SemanticMemory:
        """The open memory; raises DeixisError where there is none and ``create`` is not set."""
        from deixis.memory.semantic.store import SemanticMemory

        self._require_open()
        if self._memory is None:
            self._memory = SemanticMemory.open(self.path, create=create)
        return self._memory

    def _require_open(self) -> None:
        from deixis.memory.errors import MemoryFormatError

        if self._closed:
            raise MemoryFormatError(f"{self.path}: this session is closed, and holds no memory; open another")

    def meaning(self) -> Meaning:
        """The words and sizes in force: what is shipped, but for what was learned; where there is no memory, all of it.

        Raises OntologyError where a learned model in the memory is not whole, MemoryBusyError where another process
        has the memory.
        """
        if self._meaning is None:
            self._meaning = self._in_force() if self.remembers() else SHIPPED
        return self._meaning

    def _in_force(self) -> Meaning:
        from deixis.memory.semantic.rdf.graphs import ModelSet
        from deixis.ontology.models.relation_triples import models_from_triples
        from deixis.ontology.models.sizes import sizes_from_triples
        from deixis.reasoning.grounding.evidence.meaning import shipped_models

        words = models_from_triples(self.memory().models(ModelSet.WORDS))
        sizes = sizes_from_triples(self.memory().models(ModelSet.SIZES))
        return Meaning(shipped_models().replaced(*words) if words else None, sizes)

    def recollection(self) -> Recollection:
        """All lessons of the memory, ready to be learned from; none where there is no memory."""
        from deixis.learning.recollection import Recollection
        from deixis.learning.update import remembered

        return remembered(self.memory(), self.ontology) if self.remembers() else Recollection(())

    def learn_relations(self, examples: Sequence[tuple[Script, Scene]] = (), strength: float = 3.0) -> LearnedWords:
        """Fits what relation words mean to everything remembered, and to examples: scripts, each with a labelled scene.

        The examples are kept as lessons, and the models take the place of those that were learned before. Raises
        NothingFoundError, having changed nothing, where there is nothing to learn from; SettingError for a strength
        that is not above 0.
        """
        from deixis.learning.update import keep_words
        from deixis.learning.words import new_lessons

        ids = self.memory().lessons() if self.remembers() else ()
        lessons, left_out = new_lessons(examples, self.recollection(), ids)
        if not lessons and not self.remembers():
            none = f"nothing is remembered at {self.path}, and no example teaches anything"
            raise NothingFoundError("; ".join((f"nothing to learn: {none}", *left_out)))
        learned = keep_words(self.memory(create=True), self.ontology, lessons, strength)
        self._meaning = None
        return replace(learned, kept=tuple(lesson.id for lesson in lessons), left_out=(*learned.left_out, *left_out))

    def forget_relations(self) -> None:
        """Takes the learned models of relation words away: the shipped ones are in force again. Lessons stay."""
        from deixis.memory.semantic.rdf.graphs import ModelSet

        self.memory().keep_models({ModelSet.WORDS: []})
        self._meaning = None

    def forget(self, lesson: str) -> None:
        """Takes back one lesson, with everything that follows from it alone, and what it taught of words and sizes.

        What it kept of how things look stays.
        """
        from deixis.learning.update import forget

        forget(self.memory(), self.ontology, lesson)
        self._meaning = None

    def import_(self, file: str | Path) -> None:
        """Takes in what another memory exported, or plain triples; what is there stays.

        Raises InconsistencyError, having changed nothing, where what is there and what comes contradict each other.
        """
        from deixis.learning.update import take_in

        self._require_open()
        self._let_go()
        take_in(file, self.path, self.ontology)

    def layouts(self) -> tuple[LayoutConcept, ...]:
        """Every learned layout."""
        from deixis.memory.semantic.rdf.graphs import GraphName
        from deixis.ontology.lessons.read import layouts

        return layouts(self.memory().triples(GraphName.LEARNED), self.ontology.relations)

    def layout(self, name: str) -> LayoutConcept:
        """The layout of that name, learned last, or of the lesson with that id; raises UnknownTermError for none."""
        from deixis.ontology.lessons.read import layout_named

        return layout_named(self.layouts(), name, self.memory().lessons())

    def show(self, name: str) -> str:
        """A learned layout as a script again."""
        from deixis.grammar.format import layout_script

        return layout_script(self.layout(name), self.ontology)

    def query(self, sparql: str) -> QueryResult:
        """Asks SPARQL of everything remembered: SELECT, ASK, CONSTRUCT or DESCRIBE; nothing else is let in."""
        return self.memory().query(sparql)
