"""Read English sentence by sentence: the facts of each, its paraphrase, and what was not understood."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.errors import DeixisError
from deixis.grammar.errors import ScriptError
from deixis.grammar.read import is_english, read_script_file
from deixis.grammar.reading import Reading
from deixis.grammar.script import Script
from deixis.reasoning.errors import require_time_limit
from deixis.text_files import require_path_or_text


@dataclass(frozen=True, repr=False)
class ReadText(Answer):
    """A text in English as it was read; ``script`` holds the facts that it asserts.

    Examples
    --------
    >>> import deixis
    >>> found = deixis.read(text="The fork is left of the plate. Is the cup on the tray?")
    >>> found
    <ReadText 2 sentences, 1 fact, 100% of the words understood>
    >>> found.script.facts[0].subject
    'fork'
    >>> [sentence.question for sentence in found.reading.sentences]
    [False, True]
    """

    script: Script
    reading: Reading

    def summary(self) -> str:
        """Return the numbers of sentences and facts, and the share of understood words."""
        sentences, facts = count(len(self.reading.sentences), "sentence"), count(len(self.reading.stated), "fact")
        return f"{sentences}, {facts}, {self.reading.understood:.0%} of the words understood"


@checks_arguments
def read(
    path: str | Path | None = None, *, text: str | None = None, strict: bool = False, time_limit: float = 10.0
) -> ReadText:
    """Read a text in English.

    Parameters
    ----------
    path
        File of the text (``.txt``), or ``-`` for standard input.
    text
        The text itself, instead of a file.
    strict
        True to refuse a text that is not understood completely.
    time_limit
        Time limit in seconds.

    Returns
    -------
    ReadText
        The sentences with their facts, and the script.

    Raises
    ------
    DeixisError
        If the file is a layout script.
    ScriptError
        If nothing is understood or, with ``strict``, not all.
    ScriptTimeError
        If the time limit is reached.
    TypeError
        Unless exactly one of ``path`` and ``text`` is given.

    Examples
    --------
    >>> import deixis
    >>> [sentence.paraphrase for sentence in deixis.read(text="Left of the plate is the fork.").reading.sentences]
    ['The fork is left of the plate.']
    """
    require_path_or_text("read", path, text)
    require_time_limit(time_limit)
    deadline = Deadline.after(time_limit)
    if path is not None and not is_english(path):
        raise DeixisError(
            f"'{path}' must be a .txt file with an English text, or - for standard input; 'deixis parse' reads layouts"
        )
    if path is not None:
        script = read_script_file(path, deadline=deadline)
    else:
        from deixis.grammar.english.reader import read_english

        script = read_english(text or "", deadline=deadline)
    assert script.reading is not None
    problems = tuple(problem for sentence in script.reading.sentences for problem in sentence.problems)
    if strict and problems:
        raise ScriptError(problems)
    return ReadText(script, script.reading)
