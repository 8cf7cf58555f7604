"""Writing to a memory: lessons in and out, with all that follows from what is there then, in one step each."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import pyoxigraph as ox

from deixis.learning.lesson import consequences
from deixis.learning.recollection import Recollection, recollect
from deixis.learning.sizes import learned_size_triples
from deixis.learning.words import LearnedWords, fit, informed
from deixis.memory.folder import State, inspect
from deixis.memory.semantic.exchange import import_dump
from deixis.memory.semantic.rdf.change import Models
from deixis.memory.semantic.rdf.graphs import GraphName, ModelSet
from deixis.memory.semantic.store import SemanticMemory
from deixis.ontology.lessons.shapes import layout_shapes
from deixis.ontology.lessons.types import Lesson, WordLesson
from deixis.ontology.lessons.write import asserted_triples, episode_triples, learned_triples
from deixis.ontology.models.relation_triples import model_triples, models_from_triples
from deixis.ontology.models.relations import RelationModel
from deixis.ontology.tbox import Ontology
from deixis.reasoning.errors import NothingFoundError

Graphs = Mapping[GraphName, Sequence[ox.Triple]]


def remembered(memory: SemanticMemory, ontology: Ontology) -> Recollection:
    """All lessons of a memory, ready to be learned from."""
    return recollect(memory.triples(GraphName.LEARNED), memory.triples(GraphName.EPISODES), ontology)


def keep(memory: SemanticMemory, ontology: Ontology, lesson: Lesson) -> None:
    """Writes a lesson."""
    new, graphs = _with(memory, ontology, [lesson])
    memory.learn_all(new, _inferred(graphs, ontology), _models(graphs, ontology))


def keep_words(
    memory: SemanticMemory, ontology: Ontology, lessons: Sequence[WordLesson], strength: float
) -> LearnedWords:
    """Writes lessons about words, and the models fitted anew to everything remembered.

    Raises NothingFoundError, having written nothing, where there is nothing to learn from.
    """
    new, graphs = _with(memory, ontology, lessons)
    words = fit(_recollected(graphs, ontology), strength)
    if not words.taught:
        told = "; ".join(("nothing to learn: no fact of a lesson has both its objects in its scene", *words.left_out))
        raise NothingFoundError(f"{told}; learn from a script with a labelled scene, or ground one ('deixis learn')")
    if lessons:
        memory.learn_all(new, _inferred(graphs, ontology), _models(graphs, ontology, words.changed))
    else:
        memory.keep_models({ModelSet.WORDS: word_triples(words.changed)})
    return words


def _with(
    memory: SemanticMemory, ontology: Ontology, lessons: Sequence[Lesson | WordLesson]
) -> tuple[dict[str, dict[GraphName, list[ox.Triple]]], Graphs]:
    """What lessons contribute, and what the memory's graphs then hold."""
    new = {lesson.id: _contributions(lesson, ontology) for lesson in lessons}
    come = {name: [triple for said in new.values() for triple in said.get(name, ())] for name in GraphName}
    return new, {name: [*memory.triples(name), *come[name]] for name in GraphName}


def forget(memory: SemanticMemory, ontology: Ontology, lesson: str) -> None:
    """Takes back one lesson, with what follows from it alone and what it taught."""
    graphs = memory.remaining(lesson)
    known, strength = informed(models_from_triples(memory.models(ModelSet.WORDS)))
    words = None
    if lesson in known:
        words = fit(_recollected(graphs, ontology).of(known - {lesson}), strength).changed
    memory.forget(lesson, _inferred(graphs, ontology), _models(graphs, ontology, words))


def take_in(file: str | Path, target: Path, ontology: Ontology) -> None:
    """Takes a file into the memory at a place, which nobody has open; what is there stays.

    What follows from both together is worked out first, and words that both had learned are fitted from the lessons of
    both: raises InconsistencyError, having changed nothing, where they contradict each other.
    """
    with tempfile.TemporaryDirectory() as scratch:
        import_dump(file, Path(scratch) / "memory")
        graphs, theirs = _content(Path(scratch) / "memory")
    words: Sequence[RelationModel] | None = None
    if inspect(target) not in (State.ABSENT, State.EMPTY):
        own_graphs, ours = _content(target)
        graphs = {name: list({*triples, *own_graphs[name]}) for name, triples in graphs.items()}
        lessons, strength = informed(ours)
        if ours and theirs and informed(theirs)[0] != lessons:
            both = lessons | informed(theirs)[0]
            words = fit(_recollected(graphs, ontology).of(both), strength).changed
    inferred, models = _inferred(graphs, ontology), _models(graphs, ontology, words)
    import_dump(file, target)
    with SemanticMemory.open(target) as memory:
        memory.conclude(inferred, models)


def _content(folder: Path) -> tuple[dict[GraphName, list[ox.Triple]], tuple[RelationModel, ...]]:
    with SemanticMemory.open(folder) as memory:
        graphs = {name: list(memory.triples(name)) for name in GraphName}
        return graphs, models_from_triples(memory.models(ModelSet.WORDS))


def word_triples(models: Iterable[RelationModel]) -> list[ox.Triple]:
    """Learned models as a memory keeps them."""
    return list(dict.fromkeys(triple for model in models for triple in model_triples(model)))


def _contributions(lesson: Lesson | WordLesson, ontology: Ontology) -> dict[GraphName, list[ox.Triple]]:
    said = {GraphName.ASSERTED: list(asserted_triples(lesson)), GraphName.EPISODES: list(episode_triples(lesson))}
    if isinstance(lesson, Lesson):
        said[GraphName.LEARNED] = list(learned_triples(lesson, ontology.relations))
        said[GraphName.SHAPES] = list(layout_shapes(lesson.layout))
    return said


def _recollected(graphs: Graphs, ontology: Ontology) -> Recollection:
    return recollect(graphs[GraphName.LEARNED], graphs[GraphName.EPISODES], ontology)


def _inferred(graphs: Graphs, ontology: Ontology) -> list[ox.Triple]:
    stated, learned, asserted = (graphs[n] for n in (GraphName.ONTOLOGY, GraphName.LEARNED, GraphName.ASSERTED))
    return consequences(stated, learned, asserted, ontology.relations)


def _models(graphs: Graphs, ontology: Ontology, words: Iterable[RelationModel] | None = None) -> Models:
    """The learned models to write: sizes always, words where they were fitted anew."""
    sizes = learned_size_triples(_recollected(graphs, ontology), ontology)
    return {ModelSet.SIZES: sizes} if words is None else {ModelSet.SIZES: sizes, ModelSet.WORDS: word_triples(words)}
