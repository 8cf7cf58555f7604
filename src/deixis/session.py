"""A session: a semantic and a perceptual memory, with the commands that use them as methods."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, Self, TypeVar

from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.knowledge_store import KnowledgeStore
from deixis.memory.on_demand import default_memory
from deixis.memory.owner import Closing, ThreadLock
from deixis.memory.semantic.queries.limits import QUERY_MEMORY_LIMIT, QUERY_TIME_LIMIT
from deixis.printable import visible_line
from deixis.reasoning.grounding.memory_budget import DEFAULT_MEMORY_LIMIT
from deixis.reasoning.grounding.options import DEFAULT_TIME_LIMIT, EngineName, Select, ViewpointName
from deixis.view_store import ViewStore

if TYPE_CHECKING:
    from datetime import datetime

    from deixis.grammar.script import Script
    from deixis.learning.layouts.concept import CountedConcept
    from deixis.learning.layouts.tables import TaughtTable
    from deixis.learning.lessons.recollection import Recollection
    from deixis.learning.models.words import LearnedWords
    from deixis.learning.views.views import Recognised, Taught
    from deixis.memory.journal import Part
    from deixis.memory.perceptual.level import LevelMemory
    from deixis.memory.perceptual.protocol import Progress
    from deixis.memory.semantic.queries.results import QueryResult
    from deixis.memory.semantic.store import SemanticMemory
    from deixis.ontology.lessons.types import LayoutConcept
    from deixis.ontology.tbox import Ontology
    from deixis.perception.scene import Scene
    from deixis.reasoning.attributes.attribute import Attribute
    from deixis.reasoning.description_logic.object_view import ObjectView
    from deixis.reasoning.grounding.answers.answer import Grounding
    from deixis.reasoning.grounding.evidence.words.meaning import Meaning
    from deixis.workflows.grounding.check import Check
    from deixis.workflows.grounding.dialogue import Ask
    from deixis.workflows.knowledge.learn import Learned, Recording
    from deixis.workflows.knowledge.recall_answer import Recall
    from deixis.workflows.knowledge.unlearn import Selection, Unlearned


Given = ParamSpec("Given")
Result = TypeVar("Result")


def _one_at_a_time(
    method: Callable[Concatenate[Session, Given], Result],
) -> Callable[Concatenate[Session, Given], Result]:
    """Check the arguments of a method of a session, and let only one thread at a time run it; others wait."""
    checked = checks_arguments(method)

    @wraps(method)
    def waiting(self: Session, /, *args: Given.args, **kwargs: Given.kwargs) -> Result:
        with self.lock:
            return checked(self, *args, **kwargs)

    return waiting


class Session(Closing):
    """A memory, and the commands on it and on tables as methods. Use it as a context manager, or close it.

    ``knowledge_store`` holds what was learned, ``view_store`` what things look like. Each is opened by the first call
    that needs it, and held by this process until the session is closed.

    Parameters
    ----------
    memory
        Folder of the memory. None means ``$DEIXIS_MEMORY``, else a folder for the user's data.
    ontology
        Words that scripts may use; None means the shipped ones.

    Notes
    -----
    Threads may share a session. Its methods run one at a time, in :attr:`lock`; only the search of :meth:`ground` runs
    beside others. To do several calls as one, such as reading a store and writing it, hold the lock:
    ``with session.lock: ...``. In a process that was forked while a session had its memory open, every call that needs
    the memory raises MemoryBusyError.

    A memory in a folder that cannot be written is opened for reading; a call that changes it raises
    ReadOnlyMemoryError.

    Examples
    --------
    >>> import tempfile
    >>> import deixis
    >>> script = deixis.read_script(text="layout supper; fork left of plate; knife right of plate")
    >>> scene = deixis.read_scene({"objects": [
    ...     {"id": "o1", "label": "fork", "min": [0, 0], "max": [0.03, 0.2]},
    ...     {"id": "o2", "label": "plate", "min": [0.1, 0], "max": [0.35, 0.25]},
    ...     {"id": "o3", "label": "knife", "min": [0.4, 0], "max": [0.43, 0.2]}]})
    >>> folder = tempfile.TemporaryDirectory()
    >>> session = deixis.Session(folder.name + "/memory")
    >>> session.learn(script, scene).lesson.layout.name
    'supper'
    >>> [layout.name for layout in session.layouts()], session.remembers(), session.has_views()
    (['supper'], True, False)
    >>> session.check("supper", scene)
    <Check of 'supper': nothing wrong, 3 correct>
    >>> print(session.show("supper").strip())
    layout supper
    <BLANKLINE>
    fork left of plate
    knife right of plate
    >>> session.query("SELECT ?role WHERE { ?role a dx:Role }")
    <QueryResult SELECT ?role: 3 rows>
    >>> session.forget("supper-1")
    >>> session.layouts()
    ()
    >>> session.close()
    >>> folder.cleanup()
    """

    @checks_arguments
    def __init__(self, memory: str | Path | None = None, ontology: Ontology | None = None) -> None:
        self.path = default_memory() if memory is None else Path(memory)
        self.lock = ThreadLock()
        self.knowledge_store = KnowledgeStore(self.path, ontology)
        self.view_store = ViewStore(self.path)

    def __repr__(self) -> str:
        return visible_line(f"<Session {self.path}>")

    def __enter__(self) -> Self:
        self.knowledge_store.require_usable()
        return super().__enter__()

    @_one_at_a_time
    def close(self) -> None:
        """Close the memory; a later call that needs it raises MemoryFormatError."""
        self.view_store.close()
        self.knowledge_store.close()

    @property
    def ontology(self) -> Ontology:
        """Words that scripts may use."""
        return self.knowledge_store.ontology

    # ---- tables

    @checks_arguments
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
        """Ground a script in a scene, with the words and sizes learned in this memory.

        Parameters
        ----------
        script, scene
            The script and the scene, or their files.
        engine, time_limit, viewpoint, select, literal, sizes, ask, max_questions, memory_limit
            The settings of :func:`deixis.ground`.

        Returns
        -------
        Grounding
            The thing that each object of the script refers to, with its posterior.

        Raises
        ------
        DeixisError
            For bad input, as :func:`deixis.ground`.

        Examples
        --------
        >>> import tempfile
        >>> from deixis.examples_data import example
        >>> script, scene = example("formal_dinner.layout"), example("place_setting.scene.json")
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     session.ground(script, scene)
        <Grounding 12 of 12 objects matched, 12 decided, 11 of 11 facts satisfied, fits 1.00>
        """
        from deixis.workflows.grounding.ground import ground
        from deixis.workflows.layouts.read import as_script

        return ground(
            as_script(script, self.ontology, Deadline.after(time_limit)),
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
            attributes=self.attributes(),
        )

    @_one_at_a_time
    def attributes(self) -> dict[str, Attribute]:
        """Return the adjectives that sentences in the episodes of this memory taught.

        Returns
        -------
        dict
            Attributes by word; empty without episodes, and while another process has them open.
        """
        from deixis.memory.episodes.blackboard import Blackboard, has_episodes
        from deixis.memory.errors import MemoryBusyError
        from deixis.workflows.descriptions.remembered_attributes import remembered_attributes

        if not has_episodes(self.path):
            return {}
        try:
            with Blackboard.open(self.path) as board:
                return remembered_attributes(board)
        except MemoryBusyError:
            return {}

    @_one_at_a_time
    def learn(
        self,
        script: Script | str | Path,
        scene: Scene | str | Path | Mapping[str, Any],
        engine: str = "exact",
        time_limit: float = DEFAULT_TIME_LIMIT,
        teacher: str = "user",
        events: Sequence[str] = (),
        episodes: Recording | None = None,
    ) -> Learned:
        """Ground a script in a scene, and keep the layout and the look of its objects, with their provenance.

        Doubtful and interchangeable matches are kept as such and teach no category. The posterior of each match is kept
        too, for :meth:`learn_relations`. Sizes are learned at once. A thing that a teacher named keeps that name.

        Parameters
        ----------
        script
            The script, or the path of its file.
        scene
            The scene, the path of its file, or its content as a mapping.
        engine
            Name of the engine that grounds the script.
        time_limit
            Seconds for the grounding.
        teacher
            Name of the teacher, stored with the lesson.
        events
            Ids in the episodes of what the teacher said.
        episodes
            Function that returns what the blackboard states about the lesson (:meth:`Blackboard.part`), which is
            written in the same step.

        Returns
        -------
        Learned
            The lesson with its grounding, and the views that it taught.

        Raises
        ------
        DeixisError
            The script contradicts itself or earlier lessons. Nothing was changed.

        Examples
        --------
        >>> import tempfile
        >>> from deixis.examples_data import example
        >>> script, scene = example("formal_dinner.layout"), example("place_setting.scene.json")
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     session.learn(script, scene, teacher="Ada")
        <Learned 'formal_dinner' as lesson formal_dinner-1: 12 categories>
        """
        (learned,) = self.learn_all([(script, scene)], engine, time_limit, None, teacher, events, episodes)
        return learned

    @_one_at_a_time
    def learn_all(
        self,
        examples: Sequence[tuple[Script | str | Path, Scene | str | Path | Mapping[str, Any]]],
        engine: str = "exact",
        time_limit: float = DEFAULT_TIME_LIMIT,
        progress: Progress | None = None,
        teacher: str = "user",
        events: Sequence[str] = (),
        episodes: Recording | None = None,
    ) -> tuple[Learned, ...]:
        """Learn from many scripts, each with its scene, as :meth:`learn` does from one: all of them, or none.

        Each is grounded with what the memory had learned before this call.

        Parameters
        ----------
        examples
            Pairs of a script and its scene, or of their files.
        engine
            Name of the engine that grounds the scripts.
        time_limit
            Seconds for each grounding.
        progress
            Called with the number of grounded examples and of all.
        teacher
            Name of the teacher, stored with each lesson.
        events
            Ids in the episodes of what the teacher said.
        episodes
            Function that returns what the blackboard states about the lessons (:meth:`Blackboard.part`), which is
            written in the same step.

        Returns
        -------
        tuple of Learned
            A lesson for each example, with its grounding.

        Raises
        ------
        DeixisError
            If an example is invalid, or nothing that it names is found; nothing is kept then.

        Examples
        --------
        >>> import tempfile
        >>> import deixis
        >>> from deixis.workflows.knowledge.unlearn import Selection
        >>> script = deixis.read_script(text="layout supper; fork left of plate; knife right of plate")
        >>> corners = [[0, 0], [0.1, 0], [0.4, 0]], [[0.03, 0.2], [0.35, 0.25], [0.43, 0.2]]
        >>> scene = deixis.Scene.from_boxes(*corners, labels=["fork", "plate", "knife"])
        >>> with tempfile.TemporaryDirectory() as folder, deixis.Session(folder + "/memory") as session:
        ...     [learned.lesson.id for learned in session.learn_all([(script, scene), (script, scene)])]
        ...     session.ground(script, scene)
        ...     [table.lesson for table in session.tables("supper")]
        ...     list(session.concept("supper").lines())[0]
        ...     session.learn_relations().lessons
        ...     session.meaning().graded, session.attributes(), session.lessons_of_events()
        ...     session.forget_relations()
        ...     session.unlearn(Selection(lesson="supper-1"))
        ...     [lesson.lesson for lesson in session.recollection().lessons]
        ...     session.memory().lessons()
        ['supper-1', 'supper-2']
        <Grounding 3 of 3 objects matched, 3 decided, 2 of 2 facts satisfied, fits 1.00>
        ['supper-1', 'supper-2']
        '2 tables: supper-1, supper-2'
        ('supper-1', 'supper-2')
        (True, {}, {})
        <Unlearned 1 lesson taken back, 0 views forgotten, 0 views changed>
        ['supper-2']
        ('supper-2',)
        """
        from deixis.workflows.knowledge.learn import learn

        stores = (self.knowledge_store, self.view_store)
        return learn(examples, *stores, engine, time_limit, progress, teacher, events, episodes)

    @_one_at_a_time
    def check(
        self,
        layout: str | Path | Script,
        scene: Scene | str | Path | Mapping[str, Any],
        time_limit: float = DEFAULT_TIME_LIMIT,
    ) -> Check:
        """Check a table against a layout.

        Parameters
        ----------
        layout
            The name of a learned layout, a script, or the path of a script.
        scene
            The scene, the path of its file, or its content as a mapping.
        time_limit
            Seconds until the answer.

        Returns
        -------
        Check
            The missing, misplaced and additional things, and the facts that do not hold.

        Examples
        --------
        >>> import tempfile
        >>> from deixis.examples_data import example
        >>> script, scene = example("formal_dinner.layout"), example("place_setting.scene.json")
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     learned = session.learn(script, scene)
        ...     session.check("formal_dinner", example("second_table.scene.json"))
        <Check of 'formal_dinner': not as described, 9 correct, 2 misplaced, 1 missing, 1 extra, 2 violated facts>
        """
        from deixis.workflows.grounding.check import check

        return check(layout, scene, time_limit, self.knowledge_store)

    @_one_at_a_time
    def teach(
        self,
        scene: Scene | str | Path | Mapping[str, Any],
        object: str,
        category: str,
        teacher: str = "user",
        settles: tuple[str, str] | None = None,
        event: str | None = None,
        episodes: Part | None = None,
    ) -> Taught:
        """Store the look of a thing of a scene as a view of a category, which is made if it is new.

        Parameters
        ----------
        scene
            The scene, the path of its file, or its content as a mapping. It must have the thing's cloud.
        object
            Id of the thing.
        category
            Name of the category. A name that differs from a known one only in case means that one.
        teacher
            Name of the teacher, stored with the view.
        settles
            Id of a lesson and a role in it, if this says which thing that role is; the counts of the layout then
            have it (:meth:`tables`).
        event
            Event in the episodes in which the teacher showed it, with their origin; None where they do not have it.
        episodes
            What the blackboard says about it (:meth:`Blackboard.part`), which is written in the same step.

        Returns
        -------
        Taught
            The stored view, with its earlier category if the call corrects one.

        Raises
        ------
        SceneError
            The scene has no such thing, or no cloud of it.
        SettingError
            The name of the category is invalid.

        Examples
        --------
        >>> import tempfile
        >>> import numpy as np
        >>> from deixis.perception.clouds.cloud import PointCloud
        >>> from deixis.perception.scene import PerceivedObject, Scene
        >>> angle = np.linspace(0, 40, 600)
        >>> points = np.stack([0.05 * np.cos(angle), 0.05 * np.sin(angle), angle / 400], axis=1, dtype=np.float32)
        >>> thing = PerceivedObject("o1", (-0.05, -0.05, 0.0), (0.05, 0.05, 0.1), cloud=PointCloud(points))
        >>> scene = Scene((thing,))
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     session.teach(scene, "o1", "mug").category, session.has_views()
        ...     session.category_meant("Mug"), session.recognise(scene)
        ...     session.rename_category("mug", "cup")
        ...     [view.category for view in session.views().views()]
        ...     session.forget_category("cup")
        ...     session.categories()
        ('mug', True)
        ('mug', <Recognised 1 of 1 object recognised>)
        ['cup']
        {}
        """
        from deixis.workflows.scenes.teach import teach

        stores = (self.knowledge_store, self.view_store)
        return teach(scene, object, category, *stores, teacher, settles, event, episodes)

    @_one_at_a_time
    def recognise(
        self,
        scene: Scene | str | Path | Mapping[str, Any],
        progress: Progress | None = None,
        left_out: Callable[[str], None] | None = None,
    ) -> Recognised:
        """Name the known things of a scene; where nothing was taught, none is known.

        Parameters
        ----------
        scene
            The scene, the path of its file, or its content as a mapping.
        progress
            Called while views are read and calibrated, which takes seconds for many views, then for each thing.
        left_out
            Called with a line about damaged views, which teach nothing.

        Returns
        -------
        Recognised
            The scene with the names, and the recogniser's answer for each thing.
        """
        from deixis.workflows.scenes.recognise import recognise

        return recognise(scene, self.view_store, progress, left_out)

    # ---- knowledge

    @_one_at_a_time
    def remembers(self) -> bool:
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
        return self.knowledge_store.exists()

    @_one_at_a_time
    def memory(self, create: bool = False) -> SemanticMemory:
        """Return the open semantic memory.

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
        return self.knowledge_store.memory(create)

    @_one_at_a_time
    def meaning(self) -> Meaning:
        """Return the words and sizes that apply: the learned ones, and the shipped ones for the rest.

        Returns
        -------
        Meaning
            Models of words and ranges of sizes, for :func:`deixis.ground`.

        Raises
        ------
        OntologyError
            If a learned model in the memory is incomplete.
        MemoryBusyError
            If another process has the memory open.
        """
        return self.knowledge_store.meaning()

    @_one_at_a_time
    def recollection(self) -> Recollection:
        """Return all lessons of the memory, ready to be learned from.

        Returns
        -------
        Recollection
            The lessons with their scenes; empty without a memory.
        """
        return self.knowledge_store.recollection()

    @_one_at_a_time
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

        Examples
        --------
        >>> import tempfile
        >>> from deixis.examples_data import example
        >>> script, scene = example("formal_dinner.layout"), example("place_setting.scene.json")
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     learned = session.learn(script, scene)
        ...     session.learn_relations()
        <LearnedWords 5 models from 1 lesson>
        """
        return self.knowledge_store.learn_relations(examples, strength)

    @_one_at_a_time
    def forget_relations(self) -> None:
        """Remove the learned models of relation words, so that the shipped ones apply again; keep the lessons."""
        self.knowledge_store.forget_relations()

    @_one_at_a_time
    def forget(self, lesson: str) -> None:
        """Remove one lesson, what follows from it only, and its share in words and sizes.

        The views that it taught stay.

        Parameters
        ----------
        lesson
            Id of the lesson.

        Raises
        ------
        UnknownLessonError
            If there is no such lesson.

        Examples
        --------
        >>> import tempfile
        >>> from deixis.examples_data import example
        >>> script, scene = example("formal_dinner.layout"), example("place_setting.scene.json")
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     learned = session.learn(script, scene)
        ...     session.forget(learned.lesson.id)
        ...     session.layouts()
        ()
        """
        from deixis.workflows.scenes.views_of_lessons import forget_lesson

        forget_lesson(lesson, self.knowledge_store, self.view_store)

    @_one_at_a_time
    def unlearn(self, selection: Selection, dry_run: bool = False, progress: Progress | None = None) -> Unlearned:
        """Take back what a lesson, a sentence, a label, a table, a teacher or a day taught, in all stores.

        Everything that came only from it goes, and nothing else: a view keeps its other teachings, and is forgotten
        with its last one.

        Parameters
        ----------
        selection
            What to take back.
        dry_run
            True to change nothing, and return what would be taken back.
        progress
            Called with the number of lessons that are taken back, and of all.

        Returns
        -------
        Unlearned
            The lessons and views; it is false where nothing matches.

        Raises
        ------
        UnknownLessonError
            If the selected lesson is not in the memory.

        Examples
        --------
        >>> from deixis.workflows.knowledge.unlearn import Selection
        >>> import tempfile
        >>> from deixis.examples_data import example
        >>> script, scene = example("formal_dinner.layout"), example("place_setting.scene.json")
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     learned = session.learn(script, scene, teacher="Ada")
        ...     session.unlearn(Selection(teacher="Ada"), dry_run=True)
        ...     session.unlearn(Selection(teacher="Ada")).lessons
        <Unlearned 1 lesson taken back, 0 views forgotten, 0 views changed>
        ('formal_dinner-1',)
        """
        from deixis.workflows.knowledge.unlearn import unlearn

        return unlearn(selection, self.knowledge_store, self.view_store, dry_run, progress)

    @_one_at_a_time
    def recall(self, question: str, at: datetime | None = None, speaker: str | None = None) -> Recall:
        """Answer a question about then and now from the episodes of the memory.

        Parameters
        ----------
        question
            The question, such as ``where was the fork before?``.
        at
            Time of asking, with a time zone; the present by default.
        speaker
            Name of the person who says *I*; by default, *I* may be any person.

        Returns
        -------
        Recall
            The answer in a sentence, with the fluents that it rests on, or the reason why it is not known.

        Raises
        ------
        RecallQuestionError
            If the question is not understood; the message has wordings that would be.
        MemoryFormatError
            If the memory has no episodes.

        Examples
        --------
        >>> import tempfile
        >>> from datetime import UTC, datetime
        >>> from deixis.memory.episodes.blackboard import Blackboard
        >>> from deixis.memory.episodes.fluents.changes import Add
        >>> from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
        >>> seen, noon = Source(Origin.SEEN, "tracker"), datetime(2026, 5, 1, 12, tzinfo=UTC)
        >>> facts = (("t1", "isA", "fork"), ("t2", "isA", "plate"), ("t1", "left", "t2"))
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder) as session:
        ...     with Blackboard.open(folder, create=True, origin=noon) as board:
        ...         fluents = [episodic(board.new_id("f"), fact, start=0.0, source=seen) for fact in facts]
        ...         sequence = board.write(*map(Add, fluents), by="tracker")
        ...     found = session.recall("where is the fork?", at=datetime(2026, 5, 1, 13, tzinfo=UTC))
        >>> found.known, [str(fact.fluent.statement) for fact in found.facts]
        (True, ['left(t1, t2)'])
        """
        from deixis.memory.episodes.blackboard import Blackboard, has_episodes
        from deixis.memory.errors import MemoryFormatError
        from deixis.workflows.knowledge.recall import recall

        if not has_episodes(self.path):
            raise MemoryFormatError(
                f"the memory at {self.path} has no episodes; record something first, or name another folder"
            )

        with Blackboard.open(self.path) as board:
            return recall(question, board, None if at is None else board.seconds(at), speaker=speaker)

    @_one_at_a_time
    def import_(self, file: str | Path) -> None:
        """Import the export of another memory, or plain triples; keep what the memory has.

        Parameters
        ----------
        file
            The file: TriG, Turtle, N-Triples, RDF/XML or OWL.

        Raises
        ------
        InconsistencyError
            If the file contradicts the memory; nothing is changed then.
        ImportFormatError
            If the file cannot be read.

        Examples
        --------
        >>> import tempfile
        >>> triple = '<https://example.org/beaker> <http://www.w3.org/2000/01/rdf-schema#label> "beaker" .'
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     size = (Path(folder) / "words.nt").write_text(triple)
        ...     session.import_(Path(folder) / "words.nt")
        ...     session.query("SELECT ?thing WHERE { ?thing rdfs:label 'beaker' }")
        <QueryResult SELECT ?thing: 1 row>
        """
        self.knowledge_store.import_(file)

    @_one_at_a_time
    def layouts(self) -> tuple[LayoutConcept, ...]:
        """Return all learned layouts.

        Returns
        -------
        tuple of LayoutConcept
            One layout for each lesson; empty without a memory.

        Examples
        --------
        >>> import tempfile
        >>> from deixis.examples_data import example
        >>> script, scene = example("formal_dinner.layout"), example("place_setting.scene.json")
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     learned = session.learn(script, scene)
        ...     session.layouts()
        (<LayoutConcept 'formal_dinner' of lesson formal_dinner-1: 12 roles, 11 facts>,)
        """
        return self.knowledge_store.layouts()

    @_one_at_a_time
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

        Examples
        --------
        >>> import tempfile
        >>> from deixis.examples_data import example
        >>> script, scene = example("formal_dinner.layout"), example("place_setting.scene.json")
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     learned = session.learn(script, scene)
        ...     layout = session.layout("formal_dinner")
        >>> str(layout.facts[0])
        'on(napkin, dinner_plate)'
        """
        return self.knowledge_store.layout(name)

    @_one_at_a_time
    def tables(self, name: str | None = None) -> tuple[TaughtTable, ...]:
        """Return the tables on which layouts were taught.

        Parameters
        ----------
        name
            Name of the layout, or id of the lesson; None for all layouts.

        Returns
        -------
        tuple of TaughtTable
            The tables in the order learned, each with the things that are known by now; empty without a memory.

        Examples
        --------
        >>> import tempfile
        >>> from deixis.examples_data import example
        >>> script, scene = example("formal_dinner.layout"), example("place_setting.scene.json")
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     learned = session.learn(script, scene)
        ...     table, = session.tables("formal_dinner")
        >>> table.lesson, table.things["napkin"]
        ('formal_dinner-1', 'o2')
        """
        from deixis.learning.layouts.tables import taught_tables

        if not self.knowledge_store.exists():
            return ()
        settled = self.view_store.settled_roles()
        return tuple(taught_tables(self.knowledge_store.memory(), self.ontology, settled, name))

    @_one_at_a_time
    def lessons_of_events(self) -> dict[str, str]:
        """Return the lessons that sentences in the episodes of the memory taught.

        Returns
        -------
        dict
            Id of the lesson by the id of the event of the sentence.
        """
        from deixis.memory.semantic.rdf.links import events_of_lessons

        known = events_of_lessons(self.memory().store) if self.remembers() else {}
        return {event: lesson for lesson, events in known.items() for event in events}

    @_one_at_a_time
    def concept(self, name: str) -> CountedConcept:
        """Return what the tables of a layout have in common, with counts.

        Parameters
        ----------
        name
            Name of the layout, or id of its lesson.

        Returns
        -------
        CountedConcept
            The concept over all tables of the layout, or over that of the lesson.

        Raises
        ------
        UnknownTermError
            If there is neither.

        Examples
        --------
        >>> import tempfile
        >>> from deixis.examples_data import example
        >>> script, scene = example("formal_dinner.layout"), example("place_setting.scene.json")
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     lessons = session.learn_all([(script, scene), (script, scene)])
        ...     concept = session.concept("formal_dinner")
        >>> concept
        <CountedConcept 'formal_dinner' on 2 tables: 12 roles, 11 statements>
        """
        from deixis.learning.layouts.concept import CountedConcept, concept_of

        last, tables = self.layout(name), self.tables(name)
        if not tables:
            return CountedConcept(last, (last.lesson,), (), {})
        return concept_of(tables, self.ontology.relations)

    @_one_at_a_time
    def show(self, name: str) -> str:
        """Return a learned layout as a script.

        Parameters
        ----------
        name
            Name of the layout, or id of its lesson.

        Returns
        -------
        str
            The text of the script. If the layout has several tables, it is that of their concept, and comments at its
            end say on how many of them each statement held.

        Raises
        ------
        UnknownTermError
            If there is neither.

        Examples
        --------
        >>> import tempfile
        >>> from deixis.examples_data import example
        >>> script, scene = example("formal_dinner.layout"), example("place_setting.scene.json")
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     learned = session.learn(script, scene)
        ...     text = session.show("formal_dinner")
        >>> print(text.splitlines()[2])
        napkin on dinner_plate
        """
        from deixis.grammar.layout.format import layout_script

        last = self.layout(name)
        if self.knowledge_store.count_of_tables(name) < 2:
            return layout_script(last, self.ontology)
        return self.concept(name).script(self.ontology)

    @_one_at_a_time
    def query(
        self, sparql: str, time_limit: float = QUERY_TIME_LIMIT, memory_limit: int = QUERY_MEMORY_LIMIT
    ) -> QueryResult:
        """Run a SPARQL query over the memory: SELECT, ASK, CONSTRUCT or DESCRIBE; other requests are refused.

        Parameters
        ----------
        sparql
            Text of the query.
        time_limit
            Seconds until the answer. Another process runs the query, so that it can be stopped.
        memory_limit
            Bytes for the evaluation. The answer, as text, may take a sixteenth of them.

        Returns
        -------
        QueryResult
            The answer, read to the end.

        Raises
        ------
        QueryError
            The query is refused or malformed.
        QueryTimeoutError, QueryMemoryError
            A limit was reached. No part of the answer is returned.

        Examples
        --------
        >>> sparql = "SELECT ?name { ?kind rdfs:subClassOf* dx:Fork ; dx:learnedIn [] ; rdfs:label ?name }"
        >>> import tempfile
        >>> from deixis.examples_data import example
        >>> script, scene = example("formal_dinner.layout"), example("place_setting.scene.json")
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     learned = session.learn(script, scene)
        ...     found = session.query(sparql)
        >>> sorted(row.name.value for row in found.rows)
        ['dessert fork', 'dinner fork', 'salad fork']
        """
        return self.knowledge_store.query(sparql, time_limit, memory_limit)

    @_one_at_a_time
    def owl(self) -> ObjectView:
        """Return the ontology with everything learned as objects of owlready2.

        It has what was stated and inferred when it was made; without a memory it has the ontology only.

        Returns
        -------
        ObjectView
            An own world of owlready2, to be closed after use.

        Examples
        --------
        >>> import tempfile
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     with session.owl() as view:
        ...         view.ontology.name, len(session.ontology.relations) > 10
        ('onto', True)
        """
        return self.knowledge_store.owl()

    # ---- views

    @_one_at_a_time
    def has_views(self) -> bool:
        """Return whether the memory has views.

        Returns
        -------
        bool
            True if a view was taught.
        """
        return self.view_store.exists()

    @_one_at_a_time
    def views(self, create: bool = False) -> LevelMemory:
        """Return the open perceptual memory.

        Parameters
        ----------
        create
            True to make a memory where there is none.

        Returns
        -------
        LevelMemory
            The store, open until the session ends.

        Raises
        ------
        DeixisError
            If there is no memory and ``create`` is False.
        """
        return self.view_store.memory(create)

    @_one_at_a_time
    def category_meant(self, name: str) -> str:
        """Return the known category that a name stands for.

        Parameters
        ----------
        name
            A name, in any case.

        Returns
        -------
        str
            The category with this name, else the first that differs only in case, else the name itself.
        """
        return self.view_store.category_meant(name)

    @_one_at_a_time
    def rename_category(self, old: str, new: str) -> None:
        """Rename a category; its views stay.

        Parameters
        ----------
        old, new
            Its present name and its new one.

        Raises
        ------
        UnknownCategoryError
            If there is no category ``old``.
        RejectedWriteError
            If the new name is in use.
        SettingError
            If the new name is invalid.
        """
        from deixis.view_store import category_name, new_category_name
        from deixis.workflows.scenes.views_of_lessons import rename_category

        rename_category(category_name(old), new_category_name(new), self.knowledge_store, self.view_store)

    @_one_at_a_time
    def merge_categories(self, source: str, into: str) -> None:
        """Move the views of one category to another, such as two words for one thing.

        Parameters
        ----------
        source, into
            Names of the category that goes and of the category that gets the views.

        Raises
        ------
        UnknownCategoryError
            If there is no category ``source``.

        Examples
        --------
        >>> import tempfile
        >>> import numpy as np
        >>> from deixis.perception.clouds.cloud import PointCloud
        >>> from deixis.perception.scene import PerceivedObject, Scene
        >>> angle = np.linspace(0, 40, 600)
        >>> points = np.stack([0.05 * np.cos(angle), 0.05 * np.sin(angle), angle / 400], axis=1, dtype=np.float32)
        >>> clouds = PointCloud(points), PointCloud(1.2 * points)
        >>> things = (PerceivedObject(f"o{i}", (0, 0, 0), (1, 1, 1), cloud=cloud) for i, cloud in enumerate(clouds))
        >>> scene = Scene(tuple(things))
        >>> with tempfile.TemporaryDirectory() as folder, Session(folder + "/memory") as session:
        ...     taught = [session.teach(scene, id, name) for id, name in (("o0", "mug"), ("o1", "beaker"))]
        ...     session.merge_categories("beaker", into="mug")
        ...     session.categories()
        {'mug': 2}
        """
        from deixis.view_store import category_name
        from deixis.workflows.scenes.views_of_lessons import merge_categories

        merge_categories(category_name(source), category_name(into), self.knowledge_store, self.view_store)

    @_one_at_a_time
    def forget_category(self, name: str) -> None:
        """Forget a category with all its views.

        Parameters
        ----------
        name
            Name of the category.

        Raises
        ------
        UnknownCategoryError
            If there is no such category.
        """
        from deixis.view_store import category_name
        from deixis.workflows.scenes.views_of_lessons import forget_category

        forget_category(category_name(name), self.knowledge_store, self.view_store)

    @_one_at_a_time
    def categories(self, left_out: Callable[[str], None] | None = None) -> dict[str, int]:
        """Return the number of views of each taught category.

        Parameters
        ----------
        left_out
            Called with a line about damaged views, which are not counted.

        Returns
        -------
        dict
            Number of views by the name of the category, sorted; empty if nothing was taught.
        """
        return self.view_store.categories(left_out)
