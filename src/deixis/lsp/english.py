"""A text in English as an editor holds it: the phrases that are not understood, and the facts of each sentence."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from deixis.deadline import Deadline
from deixis.grammar.errors import MAX_PROBLEMS_SHOWN, ScriptError, ScriptTimeError
from deixis.grammar.script import Script
from deixis.lsp.diagnostics import LINT_TIME_LIMIT, Problem
from deixis.lsp.document import READ_TIME_LIMIT
from deixis.ontology.facts import Source


@dataclass(frozen=True)
class EnglishText:
    """A text in English; ``path`` is the file that the editor shows, or None for a text without a file."""

    text: str
    path: Path | None = None

    @cached_property
    def lines(self) -> list[str]:
        """Lines of the text without their ends."""
        return self._plain.split("\n")

    @cached_property
    def _plain(self) -> str:
        return self.text.replace("\r\n", "\n")

    @cached_property
    def file(self) -> str:
        """Name of the text in sources."""
        return "untitled.txt" if self.path is None else str(self.path)

    @cached_property
    def script(self) -> Script | ScriptError | ScriptTimeError:
        """The script that the text states, or the error where nothing was understood in time."""
        from deixis.grammar.english.reader import read_english

        try:
            return read_english(self._plain, self.file, deadline=Deadline.after(READ_TIME_LIMIT))
        except (ScriptError, ScriptTimeError) as error:
            return error


def english_problems(document: EnglishText) -> list[Problem]:
    """Return the phrases of a text that are not understood, and the contradiction in what it states.

    >>> text = "The fork is to the left of the plate. The plate is left of the fork."
    >>> [problem.code for problem in english_problems(EnglishText(text))]
    ['F003']
    """
    from deixis.workflows.lint import lint

    script = document.script
    if not document.text.strip():
        return []
    if isinstance(script, ScriptTimeError):
        top = Source(document.file, 1, 1, 1, 2)
        return [Problem(top, f"the text is too long to be checked while it is edited ({READ_TIME_LIMIT:g} s)")]
    if isinstance(script, ScriptError):
        problems = script.problems
    else:
        assert script.reading is not None
        problems = tuple(problem for sentence in script.reading.sentences for problem in sentence.problems)
    code = None if isinstance(script, ScriptError) else "not understood"
    found = [
        Problem(one.source, f"{one.message}; {one.hint}" if one.hint else one.message, code)
        for one in problems[:MAX_PROBLEMS_SHOWN]
    ]
    if isinstance(script, Script):
        conflicts = lint(script, select=["F003"], time_limit=LINT_TIME_LIMIT).findings
        found += [Problem(one.source, one.message, one.code) for one in conflicts]
    return found


def english_hover(document: EnglishText, line: int, column: int) -> str | None:
    """Return the paraphrase and the facts of the sentence at a position, in Markdown; None between sentences.

    >>> print(english_hover(EnglishText("The fork lies to the left of the plate."), 1, 5))
    The fork is left of the plate.
    <BLANKLINE>
    - `left(fork, plate)`
    """
    script = document.script
    if not isinstance(script, Script) or script.reading is None or not 1 <= line <= len(document.lines):
        return None
    at = sum(len(one) + 1 for one in document.lines[: line - 1]) + column - 1
    for number, sentence in enumerate(script.reading.sentences):
        if sentence.span[0] <= at < sentence.span[1]:
            facts = [f"- `{stated.content}`" for stated in script.reading.stated if stated.sentence == number]
            said = [sentence.paraphrase] if sentence.paraphrase else []
            if not said and not facts:
                return "Nothing in this sentence states a fact."
            return "\n".join([*said, *([""] if said and facts else []), *facts])
    return None
