"""Read a script from a file or standard input: a layout, or a text in English, by the ending of its name."""

from __future__ import annotations

import sys
from pathlib import Path

from deixis.deadline import Deadline
from deixis.grammar.errors import ScriptFileError
from deixis.grammar.files import MAX_FILE_BYTES, read_text
from deixis.grammar.script import Script
from deixis.ontology.tbox import Ontology

ENGLISH_ENDINGS = (".txt",)
STANDARD_INPUT = "-"


def is_english(path: str | Path) -> bool:
    """Return whether a script of a given name is a text in English.

    Parameters
    ----------
    path
        The name.

    Returns
    -------
    bool
        True for ``.txt``, and for ``-``, which is standard input.
    """
    return str(path) == STANDARD_INPUT or str(path).casefold().endswith(ENGLISH_ENDINGS)


def read_script_file(
    path: str | Path,
    ontology: Ontology | None = None,
    deadline: Deadline = Deadline.never(),
) -> Script:
    """Read a script: English from ``NAME.txt`` or from standard input (``-``), else a layout.

    Parameters
    ----------
    path
        The file, in UTF-8, or ``-``.
    ontology
        Words that the script may use. By default :func:`deixis.ontology.tbox.default_ontology`.
    deadline
        Time limit.

    Returns
    -------
    Script
        The facts with their places in the text.

    Raises
    ------
    ScriptFileError
        If the file cannot be read.
    ScriptError
        If a layout has errors, or nothing of a text was understood.
    ScriptTimeError
        If the time limit is reached.
    """
    if not is_english(path):
        from deixis.grammar.layout.parser import read_layout

        return read_layout(path, ontology, deadline)
    from deixis.grammar.english.reader import read_english

    if str(path) == STANDARD_INPUT:
        text, shown = _standard_input(), "<stdin>"
    else:
        text, shown = read_text(Path(path), str(path)), str(path)
    return read_english(text, shown, ontology, deadline)


def _standard_input() -> str:
    if sys.stdin is None:
        raise ScriptFileError("standard input: it is closed; name a file")
    try:
        text = sys.stdin.read(MAX_FILE_BYTES + 1)
    except (OSError, ValueError) as error:
        raise ScriptFileError(f"standard input: it cannot be read ({error})") from None
    if len(text) > MAX_FILE_BYTES:
        raise ScriptFileError(f"standard input: this text is larger than {MAX_FILE_BYTES // 1024**2} MB")
    return text
