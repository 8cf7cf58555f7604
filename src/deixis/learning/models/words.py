"""Models of relation words, learned from all lessons, and lessons that teach relation words only."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime

from deixis.answers import Answer, count
from deixis.grammar.layout.format import layout_script
from deixis.grammar.script import Script
from deixis.learning.lessons.lesson import Occasion, layout_concept, layout_name
from deixis.learning.lessons.recollection import Recollection, Remembered, labelled
from deixis.ontology.lessons.types import WordLesson, next_lesson_id
from deixis.ontology.models.relations import RelationModel, RelationModels
from deixis.ontology.rdf.triples import content_key
from deixis.perception.formats.scene_json import scene_to_dict
from deixis.perception.scene import Scene
from deixis.reasoning.grounding.evidence.words.meaning import shipped_models
from deixis.reasoning.grounding.fitting.fit import FitSettings, FitStatistics, RelationFit, fit_relations, take_out
from deixis.reasoning.grounding.fitting.likelihood import SaidPairs, said_pairs
from deixis.version import VERSION


@dataclass(frozen=True, repr=False)
class LearnedWords(Answer):
    """Models of relation words after learning, and what they were learned from.

    Attributes
    ----------
    models
        All models, those that changed included.
    taught
        Names of the models that changed.
    lessons
        Ids of the lessons that taught them.
    kept
        Ids under which the examples of this call were kept as lessons.
    left_out
        A line for each lesson or example that taught nothing, with the reason.
    statistics
        Sums that a lesson can be subtracted from.
    texts
        A key by the id of each lesson; lessons with equal texts share it.

    Examples
    --------
    >>> from deixis.reasoning.grounding.evidence.words.meaning import shipped_models
    >>> words = LearnedWords(shipped_models(), ("horizontal",), ("tea-1", "tea-2"))
    >>> words, words.summary()
    (<LearnedWords 1 model from 2 lessons>, '1 model from 2 lessons')
    >>> [model.name for model in words.changed], words.to_dict()["lessons"]
    (['horizontal'], ['tea-1', 'tea-2'])
    """

    models: RelationModels
    taught: tuple[str, ...]
    lessons: tuple[str, ...] = ()
    kept: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()
    statistics: FitStatistics | None = None
    texts: Mapping[str, str] = field(default_factory=dict)

    def summary(self) -> str:
        """Return the number of models that changed, and of the lessons behind them."""
        left = f", {len(self.left_out)} left out" if self.left_out else ""
        return f"{count(len(self.taught), 'model')} from {count(len(self.lessons), 'lesson')}{left}"

    @property
    def changed(self) -> tuple[RelationModel, ...]:
        """Models that differ from those before learning."""
        return tuple(self.models[name] for name in self.taught)


def fit(
    recollection: Recollection,
    strength: float = 3.0,
    prior: RelationModels | None = None,
    more: Sequence[SaidPairs] = (),
    sources: Sequence[str] = (),
) -> LearnedWords:
    """Fit the models of relation words to all lessons, and to pairs from other sources.

    Of several lessons with the same script and scene, one counts.

    Parameters
    ----------
    recollection
        The lessons.
    strength
        Weight of the prior, above 0.
    prior
        Models to start from; default: the shipped ones.
    more
        Pairs of things from other sources.
    sources
        Names of these sources.

    Returns
    -------
    LearnedWords
        The models that changed, with the lessons that taught them.

    Raises
    ------
    SettingError
        If ``strength`` is not above 0.

    Notes
    -----
    The prior is never a learned model: so no lesson counts twice, and a forgotten one does not count.
    """
    known = prior or shipped_models()
    teaching = {one.lesson: _pairs(one) for one in recollection.lessons}
    teaching = {lesson: pairs for lesson, pairs in teaching.items() if pairs.weights.sum() > 0}
    once = {one.texts: one.lesson for one in reversed(recollection.lessons) if one.lesson in teaching}
    scenes = [*(teaching[lesson] for lesson in sorted(once.values())), *more]
    found = fit_relations(scenes, known, FitSettings(strength), sources, VERSION)
    texts = {one.lesson: content_key(" ".join(one.texts)) for one in recollection.lessons if one.lesson in teaching}
    return _learned(found, known, strength, texts, recollection.unreadable)


def without(one: Remembered, words: LearnedWords, strength: float) -> LearnedWords | None:
    """Return the models without one of the lessons that they were fitted to, in a time that depends on it only.

    Parameters
    ----------
    one
        The lesson.
    words
        The learned models with their statistics.
    strength
        Weight of the shipped models, above 0.

    Returns
    -------
    LearnedWords or None
        The models. None if they must be refitted to the other lessons: if :func:`take_out` cannot remove the lesson, or
        another lesson has the same script and scene.
    """
    if words.statistics is None or [*words.texts.values()].count(words.texts[one.lesson]) > 1:
        return None
    known = shipped_models()
    found = take_out(words.statistics, _pairs(one), known, FitSettings(strength), VERSION)
    if found is None:
        return None
    return _learned(found, known, strength, {id: key for id, key in words.texts.items() if id != one.lesson})


def _learned(
    found: RelationFit,
    known: RelationModels,
    strength: float,
    texts: Mapping[str, str],
    left_out: tuple[str, ...] = (),
) -> LearnedWords:
    """Return a fit with its lessons and its strength added to the provenance of the models that changed."""
    taught = tuple(name for name in found.models.models if found.models[name] != known[name])
    lessons, marked = tuple(sorted(texts)), []
    for name in taught:
        model = found.models[name]
        marked.append(replace(model, provenance=replace(model.provenance, lessons=lessons, strength=strength)))
    models = found.models.replaced(*marked)
    return LearnedWords(models, taught, lessons, left_out=left_out, statistics=found.statistics, texts=texts)


def _pairs(one: Remembered) -> SaidPairs:
    return said_pairs(one.description, one.scene.boxes, one.matched.things, one.matched.sureness)


def informed(models: Iterable[RelationModel]) -> tuple[frozenset[str], float]:
    """Return which lessons taught some learned models.

    Parameters
    ----------
    models
        The models.

    Returns
    -------
    tuple
        Ids of the lessons, and the weight of the shipped models in the fit.
    """
    models = list(models)
    strengths = [model.provenance.strength for model in models if model.provenance.strength is not None]
    return frozenset(id for model in models for id in model.provenance.lessons), strengths[0] if strengths else 1.0


Example = tuple[Script, Scene]


def example_pairs(example: Example) -> SaidPairs:
    """Return the pairs of things in a labelled scene that the facts of a script are about.

    Parameters
    ----------
    example
        A script and a labelled scene.

    Returns
    -------
    SaidPairs
        The pairs with their words.
    """
    script, scene = example
    description = script.graph()
    matched = labelled(description, scene, script.ontology.kinds)
    return said_pairs(description, scene.boxes, matched.things, matched.sureness)


def teaching(examples: Sequence[Example]) -> tuple[list[Example], list[str]]:
    """Return the examples that teach something, and a line for each of the others with the reason.

    Parameters
    ----------
    examples
        Scripts, each with a labelled scene.

    Returns
    -------
    tuple
        The examples, and the lines.
    """
    taught, left_out = [], []
    for script, scene in examples:
        if example_pairs((script, scene)).weights.sum() > 0:
            taught.append((script, scene))
        else:
            why = "no plain fact has both its objects among the labels of its scene"
            left_out.append(f"{script.file} {scene.file}: {why}")
    return taught, left_out


def new_lessons(
    examples: Sequence[Example], known: Recollection, taken: Callable[[str], bool]
) -> tuple[list[WordLesson], list[str]]:
    """Return lessons about words from examples that teach something new, and why the others do not.

    Parameters
    ----------
    examples
        Scripts, each with a labelled scene.
    known
        The lessons of the memory.
    taken
        Function that returns whether an id of a lesson is in use.

    Returns
    -------
    tuple
        The lessons, and a line for each other example.
    """
    taught, left_out = teaching(examples)
    texts, ids = {one.texts: one.lesson for one in known.lessons}, set[str]()
    lessons: list[WordLesson] = []
    for script, scene in taught:
        now = datetime.now(UTC)
        id = next_lesson_id(f"words_{layout_name(script)}", lambda id: id in ids or taken(id))
        lesson = word_lesson(script, scene, id, Occasion(now, now, VERSION))
        same = texts.setdefault((lesson.script_text, lesson.scene_text), id)
        if same == id:
            lessons.append(lesson)
            ids.add(id)
        else:
            left_out.append(f"{script.file} {scene.file}: remembered already, as {same}")
    return lessons, left_out


def word_lesson(script: Script, scene: Scene, id: str, occasion: Occasion) -> WordLesson:
    """Return a script and a labelled scene as a lesson; the includes of the script become part of its text.

    Parameters
    ----------
    script
        The script.
    scene
        The labelled scene.
    id
        Id of the lesson.
    occasion
        Time span and version of the program.

    Returns
    -------
    WordLesson
        The lesson.
    """
    return WordLesson(
        id=id,
        scene=scene,
        started=occasion.started,
        ended=occasion.ended,
        version=occasion.version,
        script_file=script.file,
        script_text=layout_script(layout_concept(script, id), script.ontology),
        scene_text=json.dumps(scene_to_dict(scene), ensure_ascii=False, sort_keys=True),
        teacher=occasion.teacher,
        scene_file=scene.file,
        told_text=None if script.reading is None else script.reading.text,
    )
