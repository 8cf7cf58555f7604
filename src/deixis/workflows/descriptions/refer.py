"""Find which object of a scene a description in English refers to."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from deixis.arguments import checks_arguments
from deixis.errors import DeixisError
from deixis.ontology.strict_json import json_mistake, parse_json
from deixis.perception.scene import Scene
from deixis.reasoning.errors import DescriptionError
from deixis.reasoning.grounding.reference.answer import DECIDED, Frame, Question, Reference, Turn
from deixis.reasoning.grounding.reference.query import Description, Query
from deixis.workflows.descriptions.attributes import attribute_odds, is_bare
from deixis.workflows.layouts.read import as_scene

if TYPE_CHECKING:
    from deixis.reasoning.attributes.attribute import Attribute
    from deixis.reasoning.grounding.reference.features.room import Room
    from deixis.reasoning.grounding.reference.model.model import Model

Array = NDArray[np.float64]
Answerer = Callable[[Question], bool | None]
"""Function that answers a question; None ends the dialogue."""

MAX_CHARACTERS = 5000
"""Maximum length of a description."""

MAX_QUESTIONS = 20
"""Maximum number of questions about one object."""

MIN_LISTED = 1e-3
"""Minimum probability of a listed alternative."""

MIN_LIKENESS = 0.5
"""Minimum similarity of a noun and a label that counts as alike; that of *stool* and *chair*."""


@checks_arguments
def refer(
    text: str,
    scene: Scene | str | Path | Mapping[str, Any],
    ask: Answerer | None = None,
    oracle: str | None = None,
    until: float = DECIDED,
    model: Model | None = None,
    attributes: Mapping[str, Attribute] | None = None,
) -> Reference:
    """Find which object of a scene a description refers to.

    Parameters
    ----------
    text
        One or more English sentences that describe one object.
    scene
        The scene, or its file or parsed JSON. If its viewpoint is ``unknown``, all sides are summed over.
    ask
        Function that answers yes-or-no questions until the reference is decided; it returns None to end the dialogue.
    oracle
        Id of the object that is meant, which answers the questions in place of ``ask``, for experiments.
    until
        Probability at which no more questions are asked, above 0 and at most 0.95. Fewer questions leave more
        answers wrong; an answer below 0.95 stays undecided.
    model
        Model with other weights than the shipped ones
        (:func:`deixis.workflows.descriptions.learn_reference.learn_reference`).
    attributes
        Learned adjectives by word (:func:`deixis.workflows.descriptions.learn_attributes.learn_attributes`).

    Returns
    -------
    Reference
        The most probable object, its probability and the alternatives.

    Raises
    ------
    DescriptionError
        If the text is blank or too long, nothing of it is understood, no noun of it is known or names an object of the
        scene, the scene has no object ``oracle``, or ``until`` is not in (0, 0.95].
    SceneError
        If the scene is invalid.

    Notes
    -----
    The model is log-linear with latent landmarks and viewers
    (:mod:`deixis.reasoning.grounding.reference.model.model`).

    Examples
    --------
    >>> import deixis
    >>> boxes = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.6, 0.0, 0.0]]
    >>> scene = deixis.Scene.from_boxes(centre=boxes, size=[[0.5, 0.5, 0.9]] * 3, labels=["chair", "chair", "desk"])
    >>> deixis.refer("the chair next to the desk", scene).target
    'o2'
    """
    if not 0 < until <= DECIDED:
        raise DescriptionError(f"`until` must be above 0 and at most {DECIDED:g}, got {until:g}")
    seen = as_scene(scene)
    rest, odds = attribute_odds(text, seen, attributes) if attributes else (text, np.zeros(len(seen.objects)))
    query = Query(Description("", anything=True)) if is_bare(rest) and rest != text else read_description(rest)
    if oracle is not None:
        if oracle not in seen.ids:
            raise DescriptionError(
                f"{seen.file}: `oracle` must be an object of the scene, got '{oracle}'; "
                f"there are: {', '.join(seen.ids)}"
            )
        ask = _oracle(oracle)
    if not seen.objects:
        return _answer(text, query, seen, np.zeros(0), None, ())
    room = seen.room
    _check_words(query, room)
    probabilities = (model or shipped_model()).probabilities(query, room) * np.exp(odds - odds.max())
    probabilities = probabilities / probabilities.sum()
    turns: list[Turn] = []
    question = _question(probabilities, room, until)
    while ask is not None and question is not None and len(turns) < MAX_QUESTIONS:
        yes = ask(question)
        if yes is None:
            break
        probabilities = _answered(probabilities, room, question, yes)
        turns.append(Turn(question, yes))
        question = _question(probabilities, room, until)
    return _answer(text, query, seen, probabilities, question, tuple(turns))


def read_description(text: str) -> Query:
    """Return the query of a description.

    Parameters
    ----------
    text
        One or more English sentences.

    Returns
    -------
    Query
        The noun, the properties and the relations of the object.

    Raises
    ------
    DescriptionError
        If the text is blank, too long, or not understood.
    """
    from deixis.grammar.english.parse import parse_english
    from deixis.workflows.descriptions.description import query_of

    if not text.strip():
        raise DescriptionError(
            "`text` must describe an object, got a blank text; write, say, 'the chair near the door'"
        )
    if len(text) > MAX_CHARACTERS:
        raise DescriptionError(f"`text` must have at most {MAX_CHARACTERS} characters, got {len(text)}; shorten it")
    query = query_of(parse_english(text))
    target = query.target
    if not query.understood or not (target.noun or target.properties or target.relations):
        raise DescriptionError(
            "nothing in `text` describes an object in English; write, say, 'the chair to the left of the desk'"
        )
    return query


def _check_words(query: Query, room: Room) -> None:
    """Raise DescriptionError if no noun is in the lexicon or near a label, and the query has no property.

    Texts in other languages parse as phrases of unknown nouns.
    """
    from deixis.ontology.tbox import default_ontology

    nouns = _nouns(query)
    lexicon, similarity = default_ontology().lexicon, shipped_model().lexis.similarity
    known = any(lexicon.knows(noun) or (similarity(noun, room) > 0).any() for noun in nouns)
    if known or any(one.dimension != "other" for one in query.target.properties):
        return
    if nouns:
        raise DescriptionError(
            f"no noun of `text` is known, got {', '.join(map(repr, nouns))};"
            " describe the object in English with a common noun or a label of the scene"
        )


def _nouns(query: Query) -> list[str]:
    """Return the nouns of a description, each once."""
    parts = [*query.target.parts(), *(() if query.viewer is None else query.viewer.landmark.parts())]
    return list(dict.fromkeys(part.noun for part in parts if part.noun))


def _label_notes(query: Query, room: Room) -> tuple[str, ...]:
    """Return a note that names the nouns that fit no label, if every object of the scene has one."""
    if room.unlabelled.any():
        return ()
    similarity = shipped_model().lexis.similarity
    strange = [noun for noun in _nouns(query) if similarity(noun, room).max() < MIN_LIKENESS]
    return (f"no object of the scene has a label like {' or '.join(map(repr, strange))}",) if strange else ()


def refer_batch(
    lines: Iterable[str], folder: Path, until: float = DECIDED, model: Model | None = None
) -> Iterator[dict[str, Any]]:
    """Answer many descriptions, given as lines of JSON.

    Parameters
    ----------
    lines
        Objects with the keys ``text`` and ``scene``, optionally ``oracle`` and ``id``; blank lines are skipped.
    folder
        Folder that scenes are relative to unless they exist as they are named.
    until
        Probability at which the questions of lines with an ``oracle`` end.
    model
        Model of reference; default: the shipped one.

    Yields
    ------
    dict
        The answer to a line as plain data, or ``{"error": …}`` for a line that is wrong.
    """
    scenes: dict[str, Scene] = {}
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        try:
            yield _batch_line(line, folder, scenes, until, model).to_dict()
        except DeixisError as error:
            yield {"error": f"line {number}: {error}"}


def _batch_line(line: str, folder: Path, scenes: dict[str, Scene], until: float, model: Model | None) -> Reference:
    data = line_of_batch(line, ("text", "scene"), ("oracle", "id"))
    scene, oracle = scene_of_line(data, folder, scenes), data.get("oracle")
    return refer(data["text"], scene, oracle=None if oracle is None else str(oracle), until=until, model=model)


def line_of_batch(line: str, required: Sequence[str], others: Sequence[str] = ()) -> dict[str, Any]:
    """Return the object of a line of JSON.

    Parameters
    ----------
    line
        The line.
    required
        Keys that must be there, with texts.
    others
        Other keys that may be there.

    Returns
    -------
    dict
        The parsed object.

    Raises
    ------
    DescriptionError
        If the line is not such an object.
    """
    form = ", ".join(f'"{key}": …' for key in required)
    try:
        line.encode()
    except UnicodeEncodeError as error:  # single surrogates stand for what was not UTF-8
        raise DescriptionError(f"column {error.start + 1}: not UTF-8; save the lines as UTF-8") from error
    try:
        data = parse_json(line, "", DescriptionError, no_number=None)
    except DescriptionError as error:
        wrong, reason = error.__cause__, str(error).removeprefix(": ")
        if isinstance(wrong, json.JSONDecodeError):
            reason = f"column {wrong.colno}: {json_mistake(wrong.doc, wrong.pos, wrong.msg)}"
        raise DescriptionError(f"not JSON: {reason}; write {{{form}}}") from error
    if not isinstance(data, dict) or not all(isinstance(data.get(key), str) for key in required):
        texts = " and ".join([", ".join(map(repr, required[:-1])), repr(required[-1])])
        raise DescriptionError(f"a line must be an object with the texts {texts}; write {{{form}}}")
    keys = sorted([*required, *others])
    unknown = sorted(set(data) - set(keys))
    if unknown:
        raise DescriptionError(f"'{unknown[0]}' is not a key of a line; the keys are {', '.join(keys)}")
    return data


def scene_of_line(data: Mapping[str, Any], folder: Path, scenes: dict[str, Scene]) -> Scene:
    """Return the scene of a line, read once.

    Parameters
    ----------
    data
        The parsed line, whose ``scene`` names a file.
    folder
        Folder that the file is relative to unless it exists as it is named.
    scenes
        Scenes read so far, by name; the scene is added.

    Returns
    -------
    Scene
        The scene.

    Raises
    ------
    SceneError
        If the file is not a scene.
    """
    name = data["scene"]
    if not name.strip():
        raise DescriptionError("'scene' must be the path of a scene, got a blank text")
    if name not in scenes:
        given = Path(name)
        scenes[name] = as_scene(given if "\0" in name or given.is_absolute() or given.exists() else folder / given)
    return scenes[name]


@cache
def shipped_model() -> Model:
    """Return the model with the fitted weights of ``ontology/models/reference.json``."""
    data = json.loads(files("deixis.ontology").joinpath("models/reference.json").read_text(encoding="utf-8"))
    return model_with({name: np.array(list(values.values())) for name, values in data["weights"].items()})


def model_with(weights: Mapping[str, Array]) -> Model:
    """Return a model of reference with given weights and the words of the ontology.

    Parameters
    ----------
    weights
        Weights by the name of their group of features.

    Returns
    -------
    Model
        The model.
    """
    from deixis.ontology.tbox import default_ontology
    from deixis.reasoning.grounding.reference.features.nouns import Nouns
    from deixis.reasoning.grounding.reference.model.model import Lexis, Model

    ontology = default_ontology()
    nouns = Nouns(ontology.lexicon)
    return Model(weights, Lexis(nouns.features, nouns.similarity, nouns.called, nouns.number, ontology.colours))


def _question(probabilities: Array, room: Room, until: float) -> Question | None:
    from deixis.reasoning.grounding.reference.questions import best_question

    if probabilities.max() >= until:
        return None
    return best_question(probabilities, room, any(label is not None for label in room.labels), until)


def _answered(probabilities: Array, room: Room, question: Question, yes: bool) -> Array:
    from deixis.reasoning.grounding.reference.questions import answered

    return answered(probabilities, room, question, yes)


def _oracle(target: str) -> Answerer:
    return lambda question: target in question.yes


def _answer(
    text: str, query: Query, scene: Scene, probabilities: Array, question: Question | None, turns: tuple[Turn, ...]
) -> Reference:
    from deixis.reasoning.grounding.reference.model.frames import frame_of
    from deixis.reasoning.grounding.reference.wording import paraphrase

    paraphrased = paraphrase(query)
    if not len(probabilities):
        return Reference(text, None, 0.0, (), query.understood, paraphrased, notes=("the scene has no objects",))
    order = np.argsort(-probabilities, kind="stable")
    listed = [(scene.ids[i], float(probabilities[i])) for i in order[1:] if probabilities[i] >= MIN_LISTED]
    frame: Frame | None = frame_of(query, scene.room, shipped_model())
    return Reference(
        text,
        scene.ids[order[0]],
        float(probabilities[order[0]]),
        tuple(listed),
        query.understood,
        paraphrased,
        frame,
        question,
        turns,
        _label_notes(query, scene.room),
        scene=scene,
    )
