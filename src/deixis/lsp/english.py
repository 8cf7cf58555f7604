"""A text in English as an editor holds it: warnings, completion, renaming, and the facts of each sentence."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from deixis.deadline import Deadline
from deixis.grammar.errors import MAX_PROBLEMS_SHOWN, ScriptError, ScriptTimeError
from deixis.grammar.reading import Span, source_of_span
from deixis.grammar.script import Script
from deixis.lsp.completion import MAX_COMPLETIONS, MAX_WORDS, Completion, Role
from deixis.lsp.diagnostics import LINT_TIME_LIMIT, MAX_WARNINGS, Problem
from deixis.lsp.document import READ_TIME_LIMIT
from deixis.lsp.edits import Edit, Fix, RenameError
from deixis.lsp.hover import HOVER_TIME_LIMIT, MAX_FACTS_SHOWN, kind_and_size, what_follows
from deixis.ontology.graph.facts import Source
from deixis.ontology.inflection import plural


@dataclass(frozen=True)
class EnglishText:
    """A text in English; ``path`` is the file that the editor shows, or None for a text without a file."""

    text: str
    path: Path | None = None

    @cached_property
    def lines(self) -> list[str]:
        """Lines of the text without their ends."""
        return self.plain.split("\n")

    @cached_property
    def plain(self) -> str:
        """The text with line feeds as the ends of lines."""
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
            return read_english(self.plain, self.file, deadline=Deadline.after(READ_TIME_LIMIT))
        except (ScriptError, ScriptTimeError) as error:
            return error


def english_problems(document: EnglishText) -> list[Problem]:
    """Return the errors of a text in which nothing is understood, otherwise the warnings of ``deixis lint``.

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
        for text, role, detail in _words(document, typed):
            if not typed and role is not Role.NAME:
                break
            if text.casefold().startswith(typed) and text.casefold() != typed:
                found.setdefault(text, Completion(text, role, start + 1, detail))
                if len(found) >= MAX_COMPLETIONS:
                    return list(found.values())
    return list(found.values())


def _starts(before: str) -> Iterator[int]:
    """Yield the columns, from 0, at which the phrase that is being typed may begin: the longest phrase first.

    After an article and a blank, a name may begin at the cursor.
    """
    words = [match.start() for match in re.finditer(r"[^\s,;.()\"]+", before)]
    yield from words[-MAX_WORDS:]
    if re.search(r"\b(?:the|a|an)\s+$", before, re.IGNORECASE):
        yield len(before)


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


@dataclass(frozen=True, slots=True)
class _Mention:
    """Words of a text for an object: their span, and that of the noun among them, if it is there."""

    span: Span
    name: str
    noun: Span | None
    plural: bool


def english_mentions(document: EnglishText, line: int, column: int) -> list[Source]:
    """Return the places of all phrases for the object at a position, in the order of the text.

    Parameters
    ----------
    document
        Text in English.
    line, column
        Position, counted from 1.

    Returns
    -------
    list of Source
        Spans of the phrases; pronouns are not among them. Empty where no object is named.

    Examples
    --------
    >>> text = EnglishText("The milk jug is on the tray. The fork is near the jug.")
    >>> [(place.column, place.end_column) for place in english_mentions(text, 1, 6)]
    [(1, 13), (47, 54)]
    """
    return [_source(document, mention.span) for mention in _mentions_at(document, line, column)]


def english_rename(document: EnglishText, line: int, column: int, new_name: str) -> list[Edit]:
    """Return the edits that put another noun into all phrases for the object at a position.

    Parameters
    ----------
    document
        Text in English.
    line, column
        Position, counted from 1.
    new_name
        New noun in the singular; plural mentions get its plural.

    Returns
    -------
    list of Edit
        Edits of the nouns; articles, adjectives and pronouns stay as they are.

    Raises
    ------
    RenameError
        If no object is named at the position, the new name is not made of words, or it belongs to another object.

    Examples
    --------
    >>> text = EnglishText("The milk jug is on the tray. The fork is near the jug.")
    >>> [(edit.source.column, edit.text) for edit in english_rename(text, 1, 6, "tea pot")]
    [(5, 'tea pot'), (51, 'tea pot')]
    """
    mentions = _mentions_at(document, line, column)
    if not mentions:
        raise RenameError("no object is named here; put the cursor on its noun")
    words = new_name.replace("_", " ").split()
    new = " ".join(words)
    if not words or not all(word.replace("-", "").replace("'", "").isalnum() for word in words):
        raise RenameError(f"a name must consist of words, got {new_name.strip()!r}")
    if new.casefold() in {mention.name for mention in _mentions(document)} - {mentions[0].name}:
        raise RenameError(f"there is an object called '{new}' already; choose another name")
    return [
        Edit(_source(document, mention.noun), plural(new) if mention.plural else new)
        for mention in mentions
        if mention.noun is not None
    ]


def english_noun_at(document: EnglishText, line: int, column: int) -> Source | None:
    """Return the place of the noun at a position, which :func:`english_rename` replaces there.

    Parameters
    ----------
    document
        Text in English.
    line, column
        Position, counted from 1. A position right after the noun belongs to it.

    Returns
    -------
    Source or None
        Span of the noun without articles and adjectives; None where no object is named.

    Examples
    --------
    >>> found = english_noun_at(EnglishText("The milk jug is on the tray."), 1, 6)
    >>> found.column, found.end_column
    (5, 13)
    """
    at = _offset(document, line, column)
    nouns = (mention.noun for mention in _mentions_at(document, line, column))
    here = next((noun for noun in nouns if noun is not None and at is not None and noun[0] <= at <= noun[1]), None)
    return None if here is None else _source(document, here)


def _offset(document: EnglishText, line: int, column: int) -> int | None:
    """Return the number of characters before a position; None for a line that the text does not have."""
    if not 1 <= line <= len(document.lines):
        return None
    return sum(len(one) + 1 for one in document.lines[: line - 1]) + column - 1


def _source(document: EnglishText, span: Span) -> Source:
    return source_of_span(document.plain, span, document.file)


def _mentions_at(document: EnglishText, line: int, column: int) -> list[_Mention]:
    """Return the mentions of the object whose phrase is at a position; the longest phrase there counts."""
    at = _offset(document, line, column)
    if at is None:
        return []
    found = _mentions(document)
    here = [mention for mention in found if mention.span[0] <= at <= mention.span[1]]
    if not here:
        return []
    name = max(here, key=lambda mention: mention.span[1] - mention.span[0]).name
    return [mention for mention in found if mention.name == name]


def _mentions(document: EnglishText) -> list[_Mention]:
    """Return the phrases for objects; one that stands for objects with different names is left out."""
    script = document.script
    if not isinstance(script, Script) or script.reading is None:
        return []
    names: dict[str, set[str]] = {}
    for name, phrases in script.reading.mentions.items():
        for phrase in phrases:
            names.setdefault(phrase.casefold(), set()).add(re.sub(r"_\d+$", "", name).replace("_", " ").casefold())
    text = document.plain.casefold()
    found: list[_Mention] = []
    for phrase, of in sorted(names.items(), key=lambda entry: -len(entry[0])):
        for match in re.finditer(rf"(?<!\w){re.escape(phrase)}(?!\w)", text) if len(of) == 1 else ():
            if all(match.end() <= one.span[0] or one.span[1] <= match.start() for one in found):
                found.append(_mention(match.span(), phrase, next(iter(of))))
    return sorted(found, key=lambda mention: mention.span)


def _mention(span: Span, phrase: str, name: str) -> _Mention:
    words = name.split()
    for noun in (" ".join(words[start:]) for start in range(len(words))):
        for form in (noun, plural(noun)):
            if (match := re.search(rf"(?<!\w){re.escape(form)}(?!\w)", phrase)) is not None:
                return _Mention(span, name, (span[0] + match.start(), span[0] + match.end()), form != noun)
    return _Mention(span, name, None, False)


def english_hover(document: EnglishText, line: int, column: int) -> str | None:
    """Return the paraphrase and the facts of the sentence at a position, in Markdown; None between sentences.

    On a phrase for an object, its kind, its usual size and what follows for it stand before them.

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
    >>> print(english_hover(EnglishText("The fork lies to the left of the plate."), 1, 12))
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
            about = list(_about(document, script, line, column))
            if not paraphrases and not facts:
                paraphrases = ["Nothing in this sentence states a fact."]
            return "\n".join([*about, *paraphrases, *([""] if facts else []), *facts])
    return None


def _about(document: EnglishText, script: Script, line: int, column: int) -> Iterator[str]:
    """Yield lines about the object that is named at a position: its kind and size, and what follows for it."""
    from deixis.grammar.english.telling.wording import relation_words
    from deixis.ontology.tbox import default_ontology

    mentions, ontology = _mentions_at(document, line, column), default_ontology()
    if not mentions:
        return
    name = mentions[0].name
    kind = ontology.of_name(name.replace(" ", "_"))[0]
    yield f"**{name}**: {kind_and_size(ontology, kind) if kind else 'kind unknown'}"
    yield ""
    deadline = Deadline.after(HOVER_TIME_LIMIT)
    follows, _ = what_follows(script, ontology, name.replace(" ", "_"), set(), deadline, relation_words)
    shown = [f"- follows: {wording.replace('_', ' ')}" for wording in follows[:MAX_FACTS_SHOWN]]
    yield from [*shown, ""] if shown else []
