"""Add lessons to a memory and remove them, with all that follows from them, in one step each.

The cost of a lesson does not depend on how many came before: only the inferences that it touches are changed, and sizes
are counts that views are added to and removed from. A memory records the version of the rules by which it was last
updated. Where the record differs from the current rules, because the memory is of an earlier version, was filled by
hand, or has another ontology, the next lesson recomputes everything.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from pathlib import Path
from types import MappingProxyType

import pyoxigraph as ox

from deixis.deadline import Deadline
from deixis.learning.inference.implied_statements import completion
from deixis.learning.inference.inferred_graph import everything_by_hermit, everything_that_follows, following
from deixis.learning.lessons.recollection import Recollection, Remembered, recollect, remembered_lesson
from deixis.learning.models.size_counts import (
    counted,
    new_rows,
    recounted,
    recounted_from_scratch,
    stored_rows,
    stored_shares,
)
from deixis.learning.models.word_statistics import replacing, stored_words
from deixis.learning.models.words import LearnedWords, fit, informed, without
from deixis.memory.folder import FolderState, inspect
from deixis.memory.journal import Commit, JointWrite
from deixis.memory.perceptual.protocol import Progress
from deixis.memory.perceptual.records import View
from deixis.memory.semantic.exchange import import_dump, merging_dump
from deixis.memory.semantic.opening import open_memory
from deixis.memory.semantic.rdf import ledger
from deixis.memory.semantic.rdf.after import After
from deixis.memory.semantic.rdf.change import Change, concluding, modelling, together
from deixis.memory.semantic.rdf.graphs import GraphName, ModelSet, models_graph
from deixis.memory.semantic.rdf.links import Link, linking, relinking
from deixis.memory.semantic.rdf.links import replacing as replacing_links
from deixis.memory.semantic.rdf.package import package_digest
from deixis.memory.semantic.store import SemanticMemory
from deixis.ontology.lessons.shapes import layout_shapes
from deixis.ontology.lessons.types import Lesson, WordLesson
from deixis.ontology.lessons.write import asserted_triples, episode_triples, learned_triples, noun_triples
from deixis.ontology.models.relation_triples import model_triples, models_from_triples
from deixis.ontology.models.relations import RelationModel
from deixis.ontology.tbox import Ontology
from deixis.reasoning.description_logic.subsumption import BeyondLessonsError
from deixis.reasoning.errors import NothingFoundError
from deixis.scratch import scratch_folder

RULES = 2
"""Version of the rules for inferences and counts; a memory records it."""

BY_HERMIT = " by HermiT"
"""Suffix of the recorded rules where HermiT classified the memory, as it has more class axioms than lessons write."""

AT_ONCE = 100
"""Maximum number of lessons in one change of the store; a change takes 1 to 2 MB of memory a lesson.

More lessons are written to a copy of the store, part by part.
"""

MAX_NAMED = 3
"""Maximum number of differing statements that a line of :func:`stale` names."""


def remembered(memory: SemanticMemory, ontology: Ontology) -> Recollection:
    """Return all lessons of a memory, ready to be learned from.

    Parameters
    ----------
    memory
        The open memory.
    ontology
        Words of the language.

    Returns
    -------
    Recollection
        The lessons.
    """
    return _recollected(After(memory.store), ontology)


def keeping(
    memory: SemanticMemory,
    ontology: Ontology,
    lessons: Sequence[Lesson],
    seen: Mapping[str, Sequence[View]] = MappingProxyType({}),
) -> Commit:
    """Return a function that commits lessons, with the views that each taught: all of them, or none.

    What follows from the lessons is computed here, so that the commit itself is fast. For more than :data:`AT_ONCE`
    lessons it is computed in the commit, on the copy of the store that then replaces the store.

    Parameters
    ----------
    memory
        The open memory.
    ontology
        The ontology.
    lessons
        The lessons, in order.
    seen
        Views by the id of the lesson that teaches them.

    Returns
    -------
    Commit
        The function.
    """
    if len(lessons) <= AT_ONCE:
        change, rules = _arrived(memory, ontology, lessons, seen)
        return lambda joint: memory.commit(change, rules, joint)

    def write(copy: SemanticMemory, joint: JointWrite | None) -> None:
        for start in range(0, len(lessons), AT_ONCE):
            change, rules = _arrived(copy, ontology, lessons[start : start + AT_ONCE], seen)
            copy.commit(change, rules, joint)

    return lambda joint: memory.commit_in_bulk(lambda copy: write(copy, joint))


def _arrived(
    memory: SemanticMemory, ontology: Ontology, lessons: Sequence[Lesson], seen: Mapping[str, Sequence[View]]
) -> tuple[Change, str]:
    """Return the change that new lessons make, with what follows from it, and its rules."""
    change = memory.arrival({lesson.id: _contributions(lesson, ontology) for lesson in lessons})
    change, rules = _followed(memory, ontology, change, [remembered_lesson(lesson, ontology) for lesson in lessons])
    links = []
    for lesson in lessons:
        categories = {view.id: view.category for view in seen.get(lesson.id, ())}
        links += [relinking(memory.store, categories), linking(lesson.id, categories, lesson.events)]
    return together(change, *links), rules


def keep_words(
    memory: SemanticMemory, ontology: Ontology, lessons: Sequence[WordLesson], strength: float
) -> LearnedWords:
    """Write lessons about words, and the models refitted to all lessons.

    Parameters
    ----------
    memory
        The open memory.
    ontology
        The ontology.
    lessons
        Lessons about words.
    strength
        Weight of the shipped models, above 0.

    Returns
    -------
    LearnedWords
        The models that changed.

    Raises
    ------
    NothingFoundError
        If no fact of any lesson has both of its objects in its scene.
    """
    change = memory.arrival({lesson.id: _contributions(lesson, ontology) for lesson in lessons})
    words = fit(_recollected(After(memory.store, change), ontology), strength)
    if not words.taught:
        why = "; ".join(("nothing to learn: no fact of a lesson has both its objects in its scene", *words.left_out))
        raise NothingFoundError(f"{why}; learn from a script with a labelled scene, or ground one ('deixis learn')")
    models = _worded(memory, words)
    rules = memory.kept_up()
    if lessons:
        come = [remembered_lesson(lesson, ontology) for lesson in lessons]
        change, rules = _followed(memory, ontology, change, come)
    memory.commit(together(change, models), rules)
    return words


def forgetting(memory: SemanticMemory, ontology: Ontology, lesson: str) -> Commit:
    """Return a function that removes one lesson, with what follows from it only and what it taught.

    If relation words were fitted to the lesson, it is removed from the statistics of the fit; where that is impossible,
    the words are refitted to the other lessons of the fit.

    Parameters
    ----------
    memory
        The open memory.
    ontology
        The ontology.
    lesson
        Id of the lesson.

    Returns
    -------
    Commit
        The function.

    Raises
    ------
    UnknownLessonError
        If there is no such lesson.
    """
    change, rules = _departed(memory, ontology, lesson)
    return lambda joint: memory.commit(change, rules, joint)


def unlearning(
    memory: SemanticMemory,
    ontology: Ontology,
    lessons: Sequence[str],
    links: Mapping[str, Sequence[Link]],
    revised: Sequence[Lesson] = (),
    progress: Progress | None = None,
) -> Commit:
    """Return a function that removes lessons, with what follows from them only, and changes the links of views.

    Parameters
    ----------
    memory
        The open memory.
    ontology
        The ontology.
    lessons
        Ids of the lessons.
    links
        All links of each view that changes, by the id of the view.
    revised
        Lessons that replace those with their ids, in their places.
    progress
        Called with the number of lessons that are done, and of all.

    Returns
    -------
    Commit
        The function.

    Raises
    ------
    UnknownLessonError
        If there is no such lesson.
    """
    if len(lessons) <= 1 and not revised:
        parts = [_departed(memory, ontology, lesson) for lesson in lessons]
        change = together(*(part for part, _ in parts), replacing_links(memory.store, links))
        rules = parts[0][1] if parts else memory.kept_up()
        return lambda joint: memory.commit(change, rules, joint)

    total = len(lessons) + len(revised)

    def write(copy: SemanticMemory, joint: JointWrite | None) -> None:
        for number, lesson in enumerate(lessons):
            if progress is not None:
                progress(number, total)
            copy.commit(*_departed(copy, ontology, lesson), joint)
        for number, new in enumerate(revised, len(lessons)):
            if progress is not None:
                progress(number, total)
            _replace(copy, ontology, new)
        copy.commit(replacing_links(copy.store, links), copy.kept_up(), joint)

    return lambda joint: memory.commit_in_bulk(lambda copy: write(copy, joint))


def _replace(memory: SemanticMemory, ontology: Ontology, lesson: Lesson) -> None:
    """Replace the lesson with an id by another one, also in the order and in the fit of relation words."""
    number = ledger.place(memory.store, lesson.id)[0]
    known, strength = informed(models_from_triples(memory.models(ModelSet.WORDS)))
    memory.commit(*_departed(memory, ontology, lesson.id))
    memory.commit(*_arrived(memory, ontology, [lesson], {}))
    numbered = Change(operations=tuple(ledger.renumbering(memory.store, lesson.id, number)))
    memory.commit(numbered, memory.kept_up())
    if lesson.id in known:
        fitted = [memory.contributions(id) for id in sorted(known) if memory.knows(id)]
        memory.commit(_worded(memory, fit(_recollected_from(fitted, ontology), strength)), memory.kept_up())


def sizes_before(memory: SemanticMemory, ontology: Ontology, lesson: str) -> list[ox.Triple]:
    """Return the models of sizes that the lessons before a lesson teach.

    Parameters
    ----------
    memory
        The open memory.
    ontology
        The ontology.
    lesson
        Id of the lesson.

    Returns
    -------
    list of ox.Triple
        The models as the memory stores them.
    """
    known = memory.lessons()
    before = [memory.contributions(id) for id in known[: known.index(lesson)]]
    return counted(_recollected_from(before, ontology), ontology)[2]


def _departed(memory: SemanticMemory, ontology: Ontology, lesson: str) -> tuple[Change, str]:
    """Return the change that removes a lesson, with what follows from it only, and its rules."""
    one = _remembered_one(memory, ontology, lesson)
    change, rules = _followed(memory, ontology, memory.departure(lesson), gone=[lesson])
    known, strength = informed(models_from_triples(memory.models(ModelSet.WORDS)))
    if lesson in known:
        kept = stored_words(memory.store)
        words = without(one, kept, strength) if kept is not None and one is not None else None
        if words is None:
            others = [memory.contributions(id) for id in sorted(known - {lesson}) if memory.knows(id)]
            words = fit(_recollected_from(others, ontology), strength)
        change = together(change, _worded(memory, words))
    return change, rules


def forget_words(memory: SemanticMemory) -> None:
    """Remove the learned models of relation words, and the statistics of their fit; keep the lessons.

    Parameters
    ----------
    memory
        The open memory.
    """
    memory.commit(_worded(memory, None), memory.kept_up())


def _worded(memory: SemanticMemory, words: LearnedWords | None) -> Change:
    """Return the change that replaces the learned words and the statistics of their fit."""
    models = modelling(memory.store, {ModelSet.WORDS: word_triples(words.changed) if words is not None else []})
    return together(models, Change(operations=tuple(replacing(words))))


def take_in(file: str | Path, target: Path, ontology: Ontology) -> None:
    """Import a file into the memory at a path; keep what the memory has.

    Parameters
    ----------
    file
        The file.
    target
        Path of the memory, which must not be open.
    ontology
        The ontology.

    Raises
    ------
    InconsistencyError
        The file contradicts the memory. Nothing was changed.
    """
    with scratch_folder() as scratch:
        import_dump(file, scratch / "memory")
        with SemanticMemory.open(scratch / "memory") as imported:
            brought = models_from_triples(imported.models(ModelSet.WORDS))
            if inspect(target) in (FolderState.ABSENT, FolderState.EMPTY):
                imported.commit(*_followed(imported, ontology, Change(), from_scratch=True))
                open_memory(target, create=True, fill=lambda store: store.bulk_extend(imported.store)).close()
                return
    with SemanticMemory.open(target) as memory:
        change = merging_dump(memory, Path(file))
        ours = models_from_triples(memory.models(ModelSet.WORDS))
        lessons, strength = informed(ours)
        words = Change()
        if ours and brought and informed(brought)[0] != lessons:
            both = _recollected(After(memory.store, change), ontology).of(lessons | informed(brought)[0])
            words = _worded(memory, fit(both, strength))
        change, rules = _followed(memory, ontology, change, from_scratch=True)
        memory.commit(together(change, words), rules)


def word_triples(models: Iterable[RelationModel]) -> list[ox.Triple]:
    """Return learned models as the triples that a memory stores.

    Parameters
    ----------
    models
        Learned models.

    Returns
    -------
    list of ox.Triple
        The triples.
    """
    return list(dict.fromkeys(triple for model in models for triple in model_triples(model)))


def _contributions(lesson: Lesson | WordLesson, ontology: Ontology) -> dict[GraphName, list[ox.Triple]]:
    contributions = {
        GraphName.ASSERTED: list(asserted_triples(lesson)),
        GraphName.EPISODES: list(episode_triples(lesson)),
    }
    if isinstance(lesson, Lesson):
        contributions[GraphName.LEARNED] = [
            *learned_triples(lesson, ontology.relations),
            *noun_triples(lesson, ontology.kinds),
        ]
        contributions[GraphName.SHAPES] = list(layout_shapes(lesson.layout))
    return contributions


def _remembered_one(memory: SemanticMemory, ontology: Ontology, lesson: str) -> Remembered | None:
    """Return one lesson, ready to be learned from, or None where it cannot be read."""
    lessons = _recollected_from([memory.contributions(lesson)], ontology).lessons if memory.knows(lesson) else ()
    return lessons[0] if lessons else None


def _recollected_from(
    contributions: Sequence[Mapping[GraphName, Sequence[ox.Triple]]], ontology: Ontology
) -> Recollection:
    """Return the lessons in some contributions."""
    learned, episodes = (
        [triple for by_graph in contributions for triple in by_graph.get(name, ())]
        for name in (GraphName.LEARNED, GraphName.EPISODES)
    )
    return recollect(learned, episodes, ontology)


def _recollected(after: After, ontology: Ontology) -> Recollection:
    return recollect(after.triples(GraphName.LEARNED), after.triples(GraphName.EPISODES), ontology)


# ---- what follows


def _followed(
    memory: SemanticMemory,
    ontology: Ontology,
    change: Change,
    come: Sequence[Remembered] = (),
    gone: Sequence[str] = (),
    from_scratch: bool = False,
) -> tuple[Change, str]:
    """Return a change together with what follows from it, and the rules that hold after it.

    ``come`` are the lessons that the change adds, ``gone`` the ids of those that it removes. With ``from_scratch``
    everything is recomputed and both are ignored. Raises InconsistencyError where a class becomes unsatisfiable.
    """
    rules, known = kept_up_rules(ontology), None if from_scratch else memory.kept_up()
    after = After(memory.store, change)
    inferred, by_hermit = _inferred(after, ontology, stepwise=known == rules)
    if known in (rules, rules + BY_HERMIT):
        sizes = recounted(memory.store, ontology, come, gone)
    else:
        sizes = recounted_from_scratch(memory.store, ontology, _recollected(after, ontology))
    return together(change, inferred, sizes), rules + BY_HERMIT if by_hermit else rules


def kept_up_rules(ontology: Ontology) -> str:
    """Return the rules by which a memory is updated with an ontology, as a memory records them.

    Parameters
    ----------
    ontology
        The ontology.

    Returns
    -------
    str
        A text that differs wherever updates would differ.
    """
    return f"{RULES} {package_digest()[:16]} {ontology.kinds_key}"


def _inferred(after: After, ontology: Ontology, stepwise: bool) -> tuple[Change, bool]:
    """Return the change of the inferred graph, and whether HermiT was needed for it."""
    try:
        if stepwise:
            return following(after, ontology.relations), False
        return concluding(after.store, everything_that_follows(after, ontology.relations)), False
    except BeyondLessonsError:
        return concluding(after.store, everything_by_hermit(after, ontology.relations)), True


def complete_implications(memory: SemanticMemory, ontology: Ontology, deadline: Deadline) -> None:
    """Store what the layouts imply that implied too much to store it when they were learned.

    Parameters
    ----------
    memory
        The open memory, which can be written.
    ontology
        The ontology.
    deadline
        Time limit; layouts whose implications are not computed in time stay as they are.
    """
    change = completion(After(memory.store), ontology.relations, deadline)
    if change.operations:
        memory.commit(change, memory.kept_up())


def stale(store: ox.Store, ontology: Ontology) -> Iterator[str]:
    """Yield a line for each part of a memory that differs from what its lessons lead to when recomputed.

    A memory of other rules has nothing stale: its next lesson recomputes everything.

    Parameters
    ----------
    store
        The store.
    ontology
        The ontology.

    Yields
    ------
    str
        A line of text.
    """
    known, rules = ledger.kept_up(store), kept_up_rules(ontology)
    if known not in (rules, rules + BY_HERMIT):
        return
    after = After(store)
    follows = everything_that_follows if known == rules else everything_by_hermit
    inferred = set(ledger.as_stored(follows(after, ontology.relations)))
    counts, shares, sizes = counted(_recollected(after, ontology), ontology)
    scratch = ox.Store()
    ledger.update(scratch, shares)
    pairs: list[tuple[str, Set[object], Set[object]]] = [
        ("inferred triples", set(after.triples(GraphName.INFERRED)), inferred),
        ("counts", stored_rows(store), new_rows(counts)),
        ("lessons' shares of the counts", stored_shares(store), set(scratch)),
        (
            "triples of size models",
            set(ledger.triples_in(store, models_graph(ModelSet.SIZES))),
            set(ledger.as_stored(sizes)),
        ),
    ]
    for what, kept, right in pairs:
        if kept != right:
            differing = [*(("too many", each) for each in kept - right), *(("missing", each) for each in right - kept)]
            named = "; ".join(sorted(f"{how}: {_shortened(each)}" for how, each in differing)[:MAX_NAMED])
            yield (
                f"{what} differ from what the lessons lead to: {len(kept - right)} too many, "
                f"{len(right - kept)} missing ({named})"
            )


def _shortened(statement: object) -> str:
    """Return a triple or quad as a short text: the last parts of its IRIs."""
    terms = (getattr(statement, name) for name in ("subject", "predicate", "object"))
    values = (str(getattr(term, "value", term)) for term in terms)
    return " ".join(value.rsplit("/", 1)[-1].rsplit("#", 1)[-1][:40] for value in values)
