"""A session: a memory of what was learned and one of what was seen, and the commands that use them as methods."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, Self, TypeVar

from deixis.knowledge_store import KnowledgeStore
from deixis.memory.on_demand import default_memory
from deixis.memory.owner import Closing, ThreadLock
from deixis.memory.semantic.queries.limits import QUERY_MEMORY_LIMIT, QUERY_TIME_LIMIT
from deixis.reasoning.grounding.memory_budget import DEFAULT_MEMORY_LIMIT
from deixis.reasoning.grounding.options import DEFAULT_TIME_LIMIT, EngineName, Select, ViewpointName
from deixis.view_store import ViewStore

if TYPE_CHECKING:
    from deixis.grammar.script import Script
    from deixis.learning.recollection import Recollection
    from deixis.learning.views import Recognised, Taught
    from deixis.learning.words import LearnedWords
    from deixis.memory.perceptual.level import LevelMemory
    from deixis.memory.perceptual.protocol import Progress
    from deixis.memory.semantic.queries.results import QueryResult
    from deixis.memory.semantic.store import SemanticMemory
    from deixis.ontology.lessons.types import LayoutConcept
    from deixis.ontology.tbox import Ontology
    from deixis.perception.scene import Scene
    from deixis.reasoning.description_logic.object_view import ObjectView
    from deixis.reasoning.grounding.answer import Grounding
    from deixis.reasoning.grounding.evidence.meaning import Meaning
    from deixis.workflows.check import Check
    from deixis.workflows.dialogue import Ask
    from deixis.workflows.learn import Learned


Given = ParamSpec("Given")
Result = TypeVar("Result")


def _one_at_a_time(
    method: Callable[Concatenate[Session, Given], Result],
) -> Callable[Concatenate[Session, Given], Result]:
    """Let one thread at a time into the methods of a session; the others wait for their turn."""

    @wraps(method)
    def waiting(self: Session, /, *args: Given.args, **kwargs: Given.kwargs) -> Result:
        with self.lock:
            return method(self, *args, **kwargs)

    return waiting


class Session(Closing):
    """A memory, and what is done with it and a table. Use it as a context manager, or close it.

    ``knowledge_store`` holds what was learned, ``view_store`` what things look like. Each is opened by the first call
    that needs it, and held by this process until the session is closed.

    Notes
    -----
    Threads may share a session. Its methods run one at a time, in :attr:`lock`; only the search of :meth:`ground` runs
    beside others. What several calls have to do as one, such as reading a store and writing it, is done with the lock
    held: ``with session.lock: ...``. A process that is forked while a session has its memory open cannot use that
    memory: every call that needs it raises MemoryBusyError at once.

    A memory in a folder that cannot be written is opened for reading; what would change it raises ReadOnlyMemoryError.
    """

    def __init__(self, memory: str | Path | None = None, ontology: Ontology | None = None) -> None:
        self.path = default_memory() if memory is None else Path(memory)
        self.lock = ThreadLock()
        self.knowledge_store = KnowledgeStore(self.path, ontology)
        self.view_store = ViewStore(self.path)

    def __enter__(self) -> Self:
        self.knowledge_store.require_usable()
        return super().__enter__()

    @_one_at_a_time
    def close(self) -> None:
        """Lets go of the memory; what would need it afterwards raises MemoryFormatError."""
        self.view_store.close()
        self.knowledge_store.close()

    @property
    def ontology(self) -> Ontology:
        """The words that scripts may use."""
        return self.knowledge_store.ontology

    # ---- what is done with a table

    def ground(
        self,
        script: Script | str | Path,
        scene: Scene | str | Path | Mapping[str, Any],
        engine: str = EngineName.EXACT,
        time_limit: float = DEFAULT_TIME_LIMIT,
        viewpoint: str = ViewpointName.STATED,
        *,
        select: str = Select.FACTS,
        literal: bool = False,
        sizes: bool = True,
        ask: Ask | None = None,
        max_questions: int | None = None,
        memory_limit: float = DEFAULT_MEMORY_LIMIT,
    ) -> Grounding:
        """Ground as :func:`deixis.ground` does, with words and sizes as this memory has learned them."""
        from deixis.workflows.ground import ground
        from deixis.workflows.read import as_script

        return ground(
            as_script(script, self.ontology),
            scene,
            engine,
            time_limit,
            select,
            self.meaning(),
            viewpoint,
            literal=literal,
            sizes=sizes,
            ask=ask,
            max_questions=max_questions,
            memory_limit=memory_limit,
        )

    @_one_at_a_time
    def learn(
        self,
        script: Script | str | Path,
        scene: Scene | str | Path | Mapping[str, Any],
        engine: str = "exact",
        time_limit: float = DEFAULT_TIME_LIMIT,
    ) -> Learned:
        """Grounds a script in a scene, and keeps the layout and what its objects look like, with where it comes from.

        What is doubtful or interchangeable is kept as such and teaches no category; how sure each match is is kept too,
        for :meth:`learn_relations`. Sizes are learned at once. What a teacher named stays of that name. Raises
        DeixisError, having changed nothing, where the script contradicts itself or what was learned before.
        """
        (learned,) = self.learn_all([(script, scene)], engine, time_limit)
        return learned

    @_one_at_a_time
    def learn_all(
        self,
        examples: Sequence[tuple[Script | str | Path, Scene | str | Path | Mapping[str, Any]]],
        engine: str = "exact",
        time_limit: float = DEFAULT_TIME_LIMIT,
    ) -> tuple[Learned, ...]:
        """Learn from many scripts, each with its scene, as :meth:`learn` does from one: all of them, or none.

        Each is grounded with what the memory had learned before this call. ``time_limit`` is for each grounding.
        """
        from deixis.workflows.learn import learn

        return learn(examples, self.knowledge_store, self.view_store, engine, time_limit)

    @_one_at_a_time
    def check(
        self,
        layout: str | Path | Script,
        scene: Scene | str | Path | Mapping[str, Any],
        time_limit: float = DEFAULT_TIME_LIMIT,
    ) -> Check:
        """What is wrong with a table: ``layout`` is a learned layout's name, or a script or its file."""
        from deixis.workflows.check import check

        return check(layout, scene, time_limit, self.knowledge_store)

    @_one_at_a_time
    def teach(
        self, scene: Scene | str | Path | Mapping[str, Any], object: str, category: str, teacher: str = "user"
    ) -> Taught:
        """Keeps what a thing of a scene looks like as a view of a category: see :func:`deixis.workflows.teach.teach`.

        Raises SceneError where the scene has no such thing, or no cloud of it; SettingError for a name that is none.
        """
        from deixis.workflows.teach import teach

        return teach(scene, object, category, self.knowledge_store, self.view_store, teacher)

    @_one_at_a_time
    def recognise(
        self,
        scene: Scene | str | Path | Mapping[str, Any],
        progress: Progress | None = None,
        left_out: Callable[[str], None] | None = None,
    ) -> Recognised:
        """Names what is known among the things of a scene; where nothing was taught, nothing is.

        ``progress`` is told of reading what was taught, and of the calibration, which take seconds after many views;
        ``left_out``, in one line, of views that are damaged and teach nothing.
        """
        from deixis.workflows.recognise import recognise

        return recognise(scene, self.view_store, progress, left_out)

    # ---- what was learned

    @_one_at_a_time
    def remembers(self) -> bool:
        """Whether there is a memory at the path; raises MemoryFormatError where something else or a damaged one is."""
        return self.knowledge_store.exists()

    @_one_at_a_time
    def memory(self, create: bool = False) -> SemanticMemory:
        """The open memory; raises DeixisError where there is none and ``create`` is not set."""
        return self.knowledge_store.memory(create)

    @_one_at_a_time
    def meaning(self) -> Meaning:
        """The words and sizes in force: what is shipped, but for what was learned; where there is no memory, all of it.

        Raises OntologyError where a learned model in the memory is not whole, MemoryBusyError where another process
        has the memory.
        """
        return self.knowledge_store.meaning()

    @_one_at_a_time
    def recollection(self) -> Recollection:
        """All lessons of the memory, ready to be learned from; none where there is no memory."""
        return self.knowledge_store.recollection()

    @_one_at_a_time
    def learn_relations(self, examples: Sequence[tuple[Script, Scene]] = (), strength: float = 3.0) -> LearnedWords:
        """Fits what relation words mean to everything remembered, and to examples: scripts, each with a labelled scene.

        The examples are kept as lessons, and the models take the place of those that were learned before. Raises
        NothingFoundError, having changed nothing, where there is nothing to learn from; SettingError for a strength
        that is not above 0.
        """
        return self.knowledge_store.learn_relations(examples, strength)

    @_one_at_a_time
    def forget_relations(self) -> None:
        """Takes the learned models of relation words away: the shipped ones are in force again. Lessons stay."""
        self.knowledge_store.forget_relations()

    @_one_at_a_time
    def forget(self, lesson: str) -> None:
        """Takes back one lesson, with everything that follows from it alone, and what it taught of words and sizes.

        What it kept of how things look stays.
        """
        from deixis.workflows.views_of_lessons import forget_lesson

        forget_lesson(lesson, self.knowledge_store, self.view_store)

    @_one_at_a_time
    def import_(self, file: str | Path) -> None:
        """Takes in what another memory exported, or plain triples; what is there stays.

        Raises InconsistencyError, having changed nothing, where what is there and what comes contradict each other.
        """
        self.knowledge_store.import_(file)

    @_one_at_a_time
    def layouts(self) -> tuple[LayoutConcept, ...]:
        """Every learned layout."""
        return self.knowledge_store.layouts()

    @_one_at_a_time
    def layout(self, name: str) -> LayoutConcept:
        """The layout of that name, learned last, or of the lesson with that id; raises UnknownTermError for none."""
        return self.knowledge_store.layout(name)

    @_one_at_a_time
    def show(self, name: str) -> str:
        """A learned layout as a script again."""
        return self.knowledge_store.show(name)

    @_one_at_a_time
    def query(
        self, sparql: str, time_limit: float = QUERY_TIME_LIMIT, memory_limit: int = QUERY_MEMORY_LIMIT
    ) -> QueryResult:
        """Asks SPARQL of everything remembered: SELECT, ASK, CONSTRUCT or DESCRIBE; nothing else is let in.

        Another process answers, so that the query can be ended. ``time_limit`` is in seconds, ``memory_limit`` in
        bytes; the answer, as text, may take a sixteenth of them. Raises QueryError for what is refused or cannot be
        understood, QueryTimeoutError and QueryMemoryError, with no part of the answer, where a limit is reached.
        """
        return self.knowledge_store.query(sparql, time_limit, memory_limit)

    @_one_at_a_time
    def owl(self) -> ObjectView:
        """The ontology with everything learned, as owlready2's objects in a world of their own; to be closed.

        It has what was stated and what followed when it was made. Without a memory it has the ontology alone.
        """
        return self.knowledge_store.owl()

    # ---- what things look like

    @_one_at_a_time
    def has_views(self) -> bool:
        """Whether anything was ever taught."""
        return self.view_store.exists()

    @_one_at_a_time
    def views(self, create: bool = False) -> LevelMemory:
        """The open perceptual memory; raises DeixisError where there is none and ``create`` is not set."""
        return self.view_store.memory(create)

    @_one_at_a_time
    def category_meant(self, name: str) -> str:
        """The known category of that name, else the first that differs from it only in case, else the name itself."""
        return self.view_store.category_meant(name)

    @_one_at_a_time
    def rename_category(self, old: str, new: str) -> None:
        """Give a category another name; its views stay.

        Raises UnknownCategoryError; RejectedWriteError for a name that is taken; SettingError for one that is none.
        """
        from deixis.view_store import category_name, new_category_name
        from deixis.workflows.views_of_lessons import rename_category

        rename_category(category_name(old), new_category_name(new), self.knowledge_store, self.view_store)

    @_one_at_a_time
    def merge_categories(self, source: str, into: str) -> None:
        """Make the views of one category views of another: two words for one thing. Raises UnknownCategoryError."""
        from deixis.view_store import category_name
        from deixis.workflows.views_of_lessons import merge_categories

        merge_categories(category_name(source), category_name(into), self.knowledge_store, self.view_store)

    @_one_at_a_time
    def forget_category(self, name: str) -> None:
        """Forget a category with all its views. Raises UnknownCategoryError."""
        from deixis.view_store import category_name
        from deixis.workflows.views_of_lessons import forget_category

        forget_category(category_name(name), self.knowledge_store, self.view_store)

    @_one_at_a_time
    def categories(self, left_out: Callable[[str], None] | None = None) -> dict[str, int]:
        """The names of what was taught, each with its number of views; ``left_out`` as in :meth:`recognise`."""
        return self.view_store.categories(left_out)
