"""Scripts and scenes as the other workflows take them: read from a file, or taken as they are."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.errors import DeixisError
from deixis.grammar.errors import ScriptError, ScriptFileError
from deixis.grammar.layout.parser import parse_script
from deixis.grammar.read import is_english, read_script_file
from deixis.grammar.script import Script
from deixis.ontology.tbox import Ontology
from deixis.spelling import nearest
from deixis.text_files import require_path_or_text

if TYPE_CHECKING:
    from deixis.perception.scene import Scene

SCRIPT_ENDING, SCENE_ENDING = ".layout", ".scene.json"


@checks_arguments
def read_script(
    path: str | Path | None = None,
    *,
    text: str | None = None,
    ontology: Ontology | None = None,
    deadline: Deadline = Deadline.never(),
    english: bool = False,
) -> Script:
    """Read a script from a file or a text.

    A file ``NAME.txt`` and ``-`` (standard input) hold English.

    Parameters
    ----------
    path
        File of the script.
    text
        The script itself, instead of a file.
    ontology
        Words of the language; default: the shipped ones.
    deadline
        Time limit.
    english
        True if ``text`` is English rather than a layout.

    Returns
    -------
    Script
        The facts with their places in the text.

    Raises
    ------
    ScriptError
        If the script has mistakes; the message lists all of them, each with file, line and column.
    ScriptTimeError
        If the deadline passes.
    TypeError
        Unless exactly one of ``path`` and ``text`` is given.

    Examples
    --------
    >>> import deixis
    >>> script = deixis.read_script(text="fork left of plate; napkin on plate")
    >>> [str(fact) for fact in script.facts]
    ['left(fork, plate)', 'on(napkin, plate)']
    >>> deixis.read_script(text="The fork is left of the plate.", english=True).to_dict()["facts"][0]["subject"]
    'fork'
    """
    require_path_or_text("read_script", path, text)
    if text is not None and english:
        from deixis.grammar.english.reader import read_english

        return read_english(text, ontology=ontology, deadline=deadline)
    if text is not None:
        return parse_script(text, ontology=ontology, deadline=deadline)
    try:
        return read_script_file(str(path), ontology, deadline)
    except ScriptFileError as error:
        if isinstance(path, str) and _looks_like_text(path):
            raise ScriptFileError(f"{error}; if {path[:60]!r} is the script itself, pass it as text=") from error
        raise


def read_layout_or_english(text: str, ontology: Ontology | None = None) -> Script:
    """Read a text as a layout script or, if it is not one, as English.

    Parameters
    ----------
    text
        The text.
    ontology
        Words of the language; default: the shipped ones.

    Returns
    -------
    Script
        The script.

    Raises
    ------
    ScriptError
        If it is neither; the message is about the text as English.

    Examples
    --------
    >>> for text in ("fork left of plate", "The fork is left of the plate."):
    ...     print(*read_layout_or_english(text).facts)
    left(fork, plate)
    left(fork, plate)
    """
    try:
        return read_script(text=text, ontology=ontology)
    except ScriptError:
        return read_script(text=text, ontology=ontology, english=True)


def _looks_like_text(name: str) -> bool:
    """Return True for what is a script rather than the name of a file: several words without an ending."""
    return "\n" in name or ";" in name or (len(name.split()) > 1 and not name.endswith(SCRIPT_ENDING))


def load_scene(file: str | Path, hide_labels: bool = False, image: str | None = None) -> Scene:
    """Read a scene from a file, with or without its labels.

    Parameters
    ----------
    file
        The file.
    hide_labels
        True to leave out the labels.
    image
        File name or id of the image, in a file with several images.

    Returns
    -------
    Scene
        The scene.

    Raises
    ------
    SceneError
        If the file is not a scene.
    """
    from deixis.perception.formats.scene_json import read_scene

    scene = read_scene(file, image=image) if image is not None else read_scene(file)
    return scene.without_labels() if hide_labels else scene


def as_script(
    script: Script | str | Path, ontology: Ontology | None = None, deadline: Deadline = Deadline.never()
) -> Script:
    """Return a script that is given as such or by its file.

    Parameters
    ----------
    script
        A script, or the name of its file.
    ontology
        Words of the language; default: the shipped ones.
    deadline
        Time limit for reading.

    Returns
    -------
    Script
        The script.

    Raises
    ------
    ScriptError
        If the file has mistakes.
    """
    return script if isinstance(script, Script) else read_script(script, ontology=ontology, deadline=deadline)


def as_scene(scene: Scene | str | Path | Mapping[str, Any]) -> Scene:
    """Return a scene that is given as such, by its file, or as parsed JSON.

    Parameters
    ----------
    scene
        A scene, the name of its file, or parsed JSON.

    Returns
    -------
    Scene
        The scene.

    Raises
    ------
    SceneError
        If it is not a scene.
    """
    from deixis.perception.formats.scene_json import read_scene
    from deixis.perception.scene import Scene

    return scene if isinstance(scene, Scene) else read_scene(scene)


def is_script_file(layout: str | Path) -> bool:
    """Return whether a layout is given as a file rather than by its name.

    Parameters
    ----------
    layout
        Name of a file or of a layout.

    Returns
    -------
    bool
        True for a file, also for one with a misspelt ending.
    """
    if isinstance(layout, Path) or os.sep in layout or is_english(layout):
        return True
    return nearest(Path(layout).suffix, [SCRIPT_ENDING]) is not None


def example_pairs(inputs: Sequence[Path]) -> list[tuple[Path, Path]]:
    """Pair scripts with scenes: files alternate; in a folder ``NAME.layout`` goes with ``NAME.scene.json``.

    Parameters
    ----------
    inputs
        Files and folders.

    Returns
    -------
    list of tuple
        Pairs of a script and its scene.

    Raises
    ------
    DeixisError
        If a file does not exist, a script has no scene, a scene in a folder has no script, or a folder has neither.
    """
    pairs: list[tuple[Path, Path]] = []
    script: Path | None = None
    for given in inputs:
        if not given.exists():
            raise DeixisError(f"{given}: there is no such file or folder")
        if given.is_dir():
            if script is not None:
                break
            pairs += _in_folder(given)
        elif script is None:
            script = given
        else:
            pairs.append((script, given))
            script = None
    if script is not None:
        raise DeixisError(f"{script}: give its scene after it, as in 'SCRIPT SCENE'")
    return pairs


def _in_folder(folder: Path) -> Iterator[tuple[Path, Path]]:
    scripts = {file.name.removesuffix(SCRIPT_ENDING): file for file in sorted(folder.glob(f"*{SCRIPT_ENDING}"))}
    scenes = {file.name.removesuffix(SCENE_ENDING): file for file in sorted(folder.glob(f"*{SCENE_ENDING}"))}
    if not scripts and not scenes:
        raise DeixisError(f"{folder}: there is no NAME{SCRIPT_ENDING} with a NAME{SCENE_ENDING} in this folder")
    for name in sorted(scripts.keys() ^ scenes.keys()):
        there, lacking = (scripts[name], SCENE_ENDING) if name in scripts else (scenes[name], SCRIPT_ENDING)
        raise DeixisError(f"{there}: there is no {name}{lacking} beside it")
    for name, script in scripts.items():
        yield script, scenes[name]
