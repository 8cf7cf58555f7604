"""A text in English as an editor holds it: warnings, completion, and the facts of each sentence."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from deixis.deadline import Deadline
from deixis.grammar.errors import MAX_PROBLEMS_SHOWN, ScriptError, ScriptTimeError
from deixis.grammar.script import Script
from deixis.lsp.completion import MAX_COMPLETIONS, MAX_WORDS, Completion, Role
from deixis.lsp.diagnostics import LINT_TIME_LIMIT, MAX_WARNINGS, Problem
from deixis.lsp.document import READ_TIME_LIMIT
from deixis.lsp.edits import Edit, Fix
from deixis.ontology.graph.facts import Source


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
    """Return the errors of a text of which nothing is understood, else the warnings of ``deixis lint``.

    Parameters
    ----------
    document
        Text in English.

    Returns
    -------
    list of Problem
        At most :data:`~deixis.grammar.errors.MAX_PROBLEMS_SHOWN` errors or :data:`~deixis.lsp.diagnostics.MAX_WARNINGS`
        warnings; empty for an empty text.

    Examples
    --------
    >>> text = "The fork is to the left of the plate. The plate is left of the fork."
    >>> [problem.code for problem in english_problems(EnglishText(text))]
    ['F003']
    """
    from deixis.workflows.layouts.lint import lint

    script = document.script
    if not document.text.strip():
        return []
    if isinstance(script, ScriptTimeError):
        top = Source(document.file, 1, 1, 1, 2)
        return [Problem(top, f"the text is too long to be checked while it is edited ({READ_TIME_LIMIT:g} s)")]
    if isinstance(script, ScriptError):
        return [
            Problem(one.source, f"{one.message}; {one.hint}" if one.hint else one.message)
            for one in script.problems[:MAX_PROBLEMS_SHOWN]
        ]
    found = lint(script, time_limit=LINT_TIME_LIMIT).findings
    return [
        Problem(one.source, f"{one.message}; {one.hint}" if one.hint else one.message, one.code, one.replacement)
        for one in found[:MAX_WARNINGS]
    ]


def english_fixes(problems: Iterable[Problem]) -> Iterator[Fix]:
    """Yield the quick fixes of problems: insert the suggested word.

    Parameters
    ----------
    problems
        Errors and warnings of a text in English.

    Yields
    ------
    Fix
        One fix for each problem with a suggested word.
    """
    for problem in problems:
        if problem.replacement is not None:
            edit = Edit(problem.source, problem.replacement.replace("_", " "))
            yield Fix(f"Replace with '{edit.text}'", problem, (edit,))


def english_completions(document: EnglishText, line: int, column: int) -> list[Completion]:
    """Return words that can go on at a position: names of the text, relations, and nouns that the ontology knows.

    Parameters
    ----------
    document
        Text in English with the cursor in it.
    line, column
        Position of the cursor, counted from 1; the words before it are completed.

    Returns
    -------
    list of Completion
        At most :data:`~deixis.lsp.completion.MAX_COMPLETIONS` words that begin with what is typed.

    Examples
    --------
    >>> text = "The fork is left of the plate. The knife is right of the pl"
    >>> [found.text for found in english_completions(EnglishText(text), 1, len(text) + 1)][:2]
    ['plate', 'place card']
    """
    if not 1 <= line <= len(document.lines):
        return []
    before = document.lines[line - 1][: column - 1]
    found: dict[str, Completion] = {}
    for start in _starts(before):
        typed = before[start:].casefold()
        if not typed.strip():
            continue
        for text, role, detail in _words(document, typed):
            if text.casefold().startswith(typed) and text.casefold() != typed:
                found.setdefault(text, Completion(text, role, start + 1, detail))
                if len(found) >= MAX_COMPLETIONS:
                    return list(found.values())
    return list(found.values())


def _starts(before: str) -> Iterator[int]:
    """Yield the columns, from 0, at which the phrase that is being typed may begin: the longest phrase first."""
    words = [match.start() for match in re.finditer(r"[^\s,;.()\"]+", before)]
    yield from words[-MAX_WORDS:]


def _words(document: EnglishText, typed: str) -> Iterator[tuple[str, Role, str]]:
    """Yield the names of the text, the phrases of relations, and the kinds, each with a short explanation."""
    from deixis.grammar.english.vocabulary.relation_words import prepositions
    from deixis.ontology.tbox import default_ontology

    script = document.script
    if isinstance(script, Script) and script.reading is not None:
        for name in script.reading.mentions:
            shown = re.sub(r"_\d+$", "", name).replace("_", " ")
            if shown != typed:
                yield shown, Role.NAME, "name"
    for phrase, preposition in prepositions().items():
        if preposition.relation != "-":
            yield phrase, Role.RELATION, preposition.relation.replace("_", " ")
    ontology = default_ontology()
    for kind in ontology.kinds:
        yield kind.words[0] if kind.words else kind.label, Role.KIND, "kind"
    for colour in ontology.colours:
        yield colour.label, Role.COLOUR, "colour"


def english_hover(document: EnglishText, line: int, column: int) -> str | None:
    """Return the paraphrase and the facts of the sentence at a position, in Markdown; None between sentences.

    Parameters
    ----------
    document
        Text in English.
    line, column
        Position, counted from 1.

    Returns
    -------
    str or None
        Markdown. One sentence says so where the sentence states no fact.

    Examples
    --------
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
            paraphrases = [sentence.paraphrase] if sentence.paraphrase else []
            if not paraphrases and not facts:
                return "Nothing in this sentence states a fact."
            return "\n".join([*paraphrases, *([""] if paraphrases and facts else []), *facts])
    return None
