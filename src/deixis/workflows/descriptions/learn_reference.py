"""Learn the weights of ``deixis refer`` from descriptions of objects whose answers are known."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.errors import DeixisError, OntologyError
from deixis.ontology.strict_json import parse_json
from deixis.perception.scene import Scene
from deixis.reasoning.errors import DescriptionError, SettingError, require_time_limit
from deixis.text_files import read_text, replace_text
from deixis.workflows.descriptions.refer import (
    line_of_batch,
    model_with,
    read_description,
    scene_of_line,
    shipped_model,
)

if TYPE_CHECKING:
    from deixis.reasoning.grounding.reference.model.fitting import Example
    from deixis.reasoning.grounding.reference.model.model import Model

Array = NDArray[np.float64]

ITERATIONS = 40
"""Maximum number of iterations of the fit."""

CHANGED = 0.02
"""Minimum change of a weight for which its word is listed as learned."""


@dataclass(frozen=True, eq=False, repr=False)
class LearnedReference(Answer):
    """Weights of reference after learning.

    Attributes
    ----------
    model
        The model with the learned weights.
    descriptions
        Number of descriptions that taught something.
    changed
        Largest change of a weight of each word or feature family that changed, the largest first.
    right
        Number of the descriptions that the model answers right before and after learning.
    steps
        Number of steps of the fit.
    converged
        Whether the fit converged within its steps and the time limit.
    left_out
        A line for each description that taught nothing, with the reason.

    Examples
    --------
    >>> import deixis
    >>> from deixis.examples_data import example
    >>> said = {"text": "the bin near the door", "scene": str(example("study.scene.json")), "target": "o14"}
    >>> learned = deixis.learn_reference([json.dumps(said)], strength=0.3)
    >>> learned.right, learned.converged
    ((0, 1), True)
    """

    model: Model
    descriptions: int
    changed: Mapping[str, float]
    right: tuple[int, int]
    steps: int
    converged: bool
    left_out: tuple[str, ...] = ()

    def summary(self) -> str:
        """Return the answer in a few words, for ``repr``.

        Returns
        -------
        str
            The summary, without the name of the type.
        """
        before, after = self.right
        return f"{count(self.descriptions, 'description')}, {before} right before and {after} after"


@checks_arguments
def learn_reference(
    descriptions: str | Path | Iterable[str],
    strength: float = 3.0,
    prior: Model | None = None,
    progress: Callable[[int, int], None] | None = None,
    time_limit: float = math.inf,
) -> LearnedReference:
    """Fit the words of descriptions, with their frames, to descriptions whose target is known.

    Parameters
    ----------
    descriptions
        File of lines of JSON with the keys ``text``, ``scene`` (a file, relative to the folder of the lines) and
        ``target`` (the id of the object that is meant); or such lines, with scenes relative to the current folder.
    strength
        Weight of the prior, above 0: the cost in nats of changing one weight by 1.
    prior
        Model from which the fit starts; the shipped one by default.
    progress
        Called after each step of the fit with the number of steps done and their maximum.
    time_limit
        Seconds after which the fit ends with the weights so far.

    Returns
    -------
    LearnedReference
        The model, and what it was learned from.

    Raises
    ------
    DescriptionError
        If no line teaches anything.
    SettingError
        If ``strength`` is not above 0, or ``time_limit`` is below 0.

    Notes
    -----
    Penalised maximum likelihood, as for the shipped weights
    (:func:`deixis.reasoning.grounding.reference.model.fitting.fit`). Weights of words that no description has stay.

    Examples
    --------
    >>> import deixis
    >>> from deixis.examples_data import example
    >>> said = {"text": "the bin near the door", "scene": str(example("study.scene.json")), "target": "o14"}
    >>> deixis.learn_reference([json.dumps(said)], strength=0.3)
    <LearnedReference 1 description, 0 right before and 1 after>
    """
    from deixis.ontology.tbox import default_ontology
    from deixis.reasoning.grounding.reference.model.fitting import fit, initial_weights

    if not 0 < strength < np.inf:
        raise SettingError(f"the strength of the shipped weights must be above 0, got {strength:g}")
    require_time_limit(time_limit)
    deadline = Deadline.after(time_limit)
    if isinstance(descriptions, (str, Path)):
        examples, left_out = _examples(read_text(descriptions).split("\n"), Path(descriptions).parent)
    else:
        examples, left_out = _examples(descriptions, Path())
    before = prior or shipped_model()
    if not examples:
        more = f"; and {len(left_out) - 1} more lines" if len(left_out) > 1 else ""
        why = left_out[0] if left_out else 'there is no description; write lines {"text": …, "scene": …, "target": …}'
        raise DescriptionError(f"nothing to learn; {why}{more}")
    unset = {name: np.zeros_like(values) for name, values in initial_weights(default_ontology().colours).items()}
    start = replace(before, weights={**unset, **before.weights})
    fitted = fit(start, examples, strength, ITERATIONS, progress, deadline)
    learned = replace(start, weights=fitted.weights)
    changes = {name: float(np.abs(values - start.weights[name]).max()) for name, values in learned.weights.items()}
    changed = {name: change for name, change in sorted(changes.items(), key=lambda one: -one[1]) if change >= CHANGED}
    right = (_right(before, examples), _right(learned, examples))
    return LearnedReference(learned, len(examples), changed, right, fitted.steps, fitted.converged, tuple(left_out))


def _examples(lines: Iterable[str], folder: Path) -> tuple[list[Example], list[str]]:
    """Return the examples of the lines, and a line for each that teaches nothing with the reason."""
    scenes: dict[str, Scene] = {}
    examples, left_out = [], []
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        try:
            examples.append(_example(line, folder, scenes))
        except DeixisError as error:
            left_out.append(f"line {number}: {error}")
    return examples, left_out


def _example(line: str, folder: Path, scenes: dict[str, Scene]) -> Example:
    from deixis.reasoning.grounding.reference.model.fitting import Example

    data = line_of_batch(line, ("text", "scene", "target"))
    scene, query = scene_of_line(data, folder, scenes), read_description(data["text"])
    if data["target"] not in scene.ids:
        raise DescriptionError(f"{scene.file}: there is no object '{data['target']}'; give an id of the scene")
    found = Example(query, scene.room, scene.ids.index(data["target"]))
    if found.target not in shipped_model().candidates(query, scene.room):
        raise DescriptionError(f"the noun '{query.target.noun}' cannot name the object '{data['target']}'")
    return found


def _right(model: Model, examples: Iterable[Example]) -> int:
    return sum(int(model.probabilities(one.query, one.room).argmax()) == one.target for one in examples)


def write_reference(model: Model, file: Path, source: str) -> None:
    """Write the weights of a model as JSON, by the names of their features.

    Parameters
    ----------
    model
        The model.
    file
        The file.
    source
        Where the weights come from, as a text in the file.

    Raises
    ------
    DeixisError
        If the file cannot be written.
    """
    from deixis.ontology.tbox import default_ontology
    from deixis.reasoning.grounding.reference.model.fitting import named_weights

    data = {"source": source, "weights": named_weights(model.weights, default_ontology().colours)}
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        replace_text(file, json.dumps(data, indent=1) + "\n")
    except OSError as error:
        raise DeixisError(f"{file}: cannot write the weights: {error.strerror}") from error


def read_reference(file: Path) -> Model:
    """Return the model of a file that :func:`write_reference` wrote.

    Parameters
    ----------
    file
        The file.

    Returns
    -------
    Model
        The model.

    Raises
    ------
    OntologyError
        If the file cannot be read or is not a file of weights.
    """
    text = read_text(file, OntologyError)
    try:
        data = parse_json(text, str(file), OntologyError, no_number=None)
    except OntologyError as error:
        raise OntologyError(f"{error}; 'deixis learn-relation --descriptions' writes such a file") from error
    return model_with(_weights(data, file))


def _weights(data: Any, file: Path) -> dict[str, Array]:
    from deixis.ontology.tbox import default_ontology
    from deixis.reasoning.grounding.reference.model.fitting import weight_names

    blocks = data.get("weights") if isinstance(data, dict) else None
    if not isinstance(blocks, dict) or not all(isinstance(values, dict) for values in blocks.values()):
        raise OntologyError(f"{file}: there must be an object 'weights' with an object of numbers for each word")
    names = weight_names(default_ontology().colours)
    found = {}
    for block, values in blocks.items():
        expected = names.get(block, names.get(block.partition("/")[0]))
        if expected is None or tuple(values) != tuple(expected):
            raise OntologyError(f"{file}: the weights of '{block}' are not those of this version; learn them again")
        if not all(isinstance(value, (int, float)) and np.isfinite(value) for value in values.values()):
            raise OntologyError(f"{file}: the weights of '{block}' must be finite numbers")
        found[block] = np.array(list(values.values()), dtype=np.float64)
    return found
