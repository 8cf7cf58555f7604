"""Learn new adjectives from sentences and the things that they picked out."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from deixis.grammar.files import read_text
from deixis.perception.scene import Scene
from deixis.reasoning.attributes.attribute import Attribute, Example
from deixis.reasoning.errors import DescriptionError
from deixis.workflows.descriptions.attributes import examples_of, new_adjectives
from deixis.workflows.descriptions.refer import line_of_batch, scene_of_line


def learn_attributes(sentences: str | Path | Iterable[str], folder: Path | None = None) -> dict[str, Attribute]:
    """Learn what new adjectives mean from sentences and the things that they picked out.

    Parameters
    ----------
    sentences
        File, or lines of JSON: ``{"text": "the blick one", "scene": "a.scene.json", "target": "o3"}``. Their order does
        not matter, and without a line the words mean what they would mean had it never been said.
    folder
        Folder that scenes are relative to; default: that of the file.

    Returns
    -------
    dict
        Attributes by word, the names of kinds among them (:attr:`Attribute.names_kinds`).

    Raises
    ------
    DescriptionError
        If a line is not such an object, or its scene has no such thing; with the number of the line.
    SceneError
        If a scene cannot be read.
    """
    if isinstance(sentences, str | Path):
        path = Path(sentences)
        lines: Sequence[str] = read_text(path, str(path)).split("\n")
        file, folder = str(path), folder or path.parent
    else:
        lines, file, folder = list(sentences), "<sentences>", folder or Path()
    found: dict[str, list[Example]] = {}
    scenes: dict[str, Scene] = {}
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        try:
            data = line_of_batch(line, ("text", "scene", "target"))
            phrase = new_adjectives(data["text"])
            if phrase is None:
                continue
            examples = examples_of(phrase, scene_of_line(data, folder, scenes), data["target"])
        except DescriptionError as error:
            raise DescriptionError(f"{file}:{number}: {error}") from error
        for word in phrase.words:
            found.setdefault(word, []).extend(examples)
    return {word: Attribute(word, tuple(examples)) for word, examples in found.items()}
