"""Read layout scripts: parse a text into a tree, statement by statement, and report all errors at once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

from lark import Token
from lark.exceptions import UnexpectedToken

from deixis.deadline import Deadline
from deixis.grammar.errors import (
    MAX_PROBLEMS_SHOWN,
    Diagnostic,
    ScriptError,
    ScriptFileError,
    ScriptTimeError,
    StatementError,
)
from deixis.grammar.files import Includes, read_text
from deixis.grammar.layout.diagnostics import bad_token, unexpected
from deixis.grammar.layout.draft import Draft, Place, place
from deixis.grammar.layout.language import Language, language_of
from deixis.grammar.layout.names import key_of
from deixis.grammar.layout.tokens import TERMINALS_WITHOUT_RULE
from deixis.grammar.layout.tree import span_of
from deixis.grammar.script import Comment, Header, Include, Script, Statement
from deixis.ontology.graph.facts import Source
from deixis.ontology.tbox import Ontology, default_ontology

STATEMENTS_PER_CLOCK_CHECK = 200


def parse_script(
    text: str, file: str = "<text>", ontology: Ontology | None = None, deadline: Deadline = Deadline.never()
) -> Script:
    """Parse the text of a layout script.

    Parameters
    ----------
    text
        The script; docs/reference/language.md describes the language.
    file
        Name of the text in error messages and sources.
    ontology
        Words that the script may use: relations, hedges, kinds and colours. By default :func:`default_ontology`.
    deadline
        Time limit.

    Returns
    -------
    The script with its statements and comments.

    Raises
    ------
    ScriptError
        If the text has errors; it holds all of them. An include is one, since a text is in no folder.
    ScriptTimeError
        If the time limit is reached.

    Examples
    --------
    >>> [str(fact) for fact in parse_script("the fork is to the left of the plate").facts]
    ['left(fork, plate)']
    >>> parse_script("fork lft of plate")
    Traceback (most recent call last):
        ...
    deixis.grammar.errors.ScriptError: <text>:1:6: expected a relation, not 'lft of'
    fork lft of plate
         ^^^^^^
    did you mean 'left of'?
    """
    ontology = ontology or default_ontology()
    return _script(FileReader(text, file, Draft(ontology), language_of(ontology)), deadline)


def read_layout(path: str | Path, ontology: Ontology | None = None, deadline: Deadline = Deadline.never()) -> Script:
    """Read the layout script in a file, with the files that it includes.

    Parameters
    ----------
    path
        The script file, in UTF-8. Included files must be in its folder or below.
    ontology
        Words that the script may use: relations, hedges, kinds and colours. By default :func:`default_ontology`.
    deadline
        Time limit.

    Returns
    -------
    The script with its statements and comments.

    Raises
    ------
    ScriptFileError
        If the file cannot be read.
    ScriptError
        If the script has errors; it holds all of them, those of included files too.
    ScriptTimeError
        If the time limit is reached.
    """
    ontology = ontology or default_ontology()
    text = read_text(Path(path), str(path))
    if text.lstrip("\ufeff \t\r\n").startswith("{"):
        raise ScriptFileError(
            f"{path}:1:1: this is JSON, not a layout script; if it is a scene, give it after the script"
        )
    real = Path(path).resolve()
    includes = Includes(real.parent, [real])
    return _script(FileReader(text, str(path), Draft(ontology), language_of(ontology), includes), deadline)


def _script(reader: FileReader, deadline: Deadline) -> Script:
    statements = []
    for statement in reader.read():
        statements.append(statement)
        if len(statements) % STATEMENTS_PER_CLOCK_CHECK == 0 and deadline.passed:
            raise ScriptTimeError(f"{reader.file}: time limit reached after {len(statements)} statements were read")
    if reader.draft.problems:
        raise ScriptError(tuple(reader.draft.problems))
    first = statements[0] if statements else None
    header = first if isinstance(first, Header) else Header(None, None, None, Source(reader.file, 1, 1, 1, 1))
    return Script(
        file=reader.file,
        name=header.name,
        title=header.title,
        viewpoint=header.viewpoint,
        surface=header.surface,
        statements=tuple(statements),
        comments=tuple(reader.comments),
        ontology=reader.draft.ontology,
    )


@dataclass
class FileReader:
    """Reader of one file of a script: the outermost file, or an included one."""

    text: str
    file: str
    draft: Draft
    language: Language
    includes: Includes | None = None  # None for a text, which has no folder to include from
    comments: list[Comment] = field(default_factory=list)
    _lines: list[str] | None = None

    def __post_init__(self) -> None:
        self.text = self.text.removeprefix("\ufeff").replace("\r\n", "\n")

    def read(self) -> Iterator[Statement]:
        """Yield the statements without errors; add the errors of the others to the draft.

        Yields
        ------
        Statement
            A statement.
        """
        here = Place(self.draft, self.file, Source(self.file, 1, 1, 1, 1))
        statement: Statement | None
        first = True
        for tokens in self.statements():
            previous = place.set(here)
            try:
                here.statement = span_of(tokens)
                statement = self._resolve(self._parse(tokens), first)
            except StatementError as refusal:
                if self._lines is None:
                    self._lines = self.text.split("\n")
                line = self._lines[refusal.source.line - 1]
                problem = Diagnostic(refusal.source, refusal.message, line, refusal.hint, refusal.replacement)
                self.draft.problems.append(problem)
                statement = None
            finally:
                place.reset(previous)
            if statement is not None:
                yield statement
            first = False

    def statements(self) -> Iterator[list[Token]]:
        """Yield the tokens of each statement, and collect the comments; a comma at a line's end joins the next line.

        Yields
        ------
        list of Token
            Tokens of one statement.
        """
        statement: list[Token] = []
        line = 0  # of the last token that is not a comment
        for token in self.language.scanner.tokens(self.text):
            if token.type == "COMMENT":
                assert token.line is not None
                assert token.column is not None
                source = Source(self.file, token.line, token.column, token.line, token.column + len(token))
                self.comments.append(Comment(token[1:].strip(), source, token.line != line))
                continue
            line = token.end_line or 0
            if token.type != "END":
                statement.append(token)
            elif token == "\n":
                line = 0
                if statement and statement[-1].type not in ("_COMMA", "_AND"):
                    yield statement
                    statement = []
            elif statement:
                yield statement
                statement = []
        if statement:
            yield statement

    def _parse(self, tokens: list[Token]) -> Statement:
        for token in tokens:
            if token.type in TERMINALS_WITHOUT_RULE:
                raise bad_token(token)
        parser = self.language.lark.parse_interactive()
        state = parser.parser_state
        at = -1
        try:
            for at in range(len(tokens)):
                state.feed_token(tokens[at])
            at = len(tokens)
            statement: Statement = state.feed_token(Token.new_borrow_pos("$END", "", tokens[-1]), True)
        except UnexpectedToken as error:
            many = len(self.draft.problems) >= MAX_PROBLEMS_SHOWN  # then the approximate set is good enough
            accepts = error.expected if many else parser.accepts()  # type: ignore[no-untyped-call]
            raise unexpected(tokens, at, set(accepts), self.draft) from None
        return statement

    def _resolve(self, statement: Statement, first: bool) -> Statement:
        """Check the place and the viewpoint of a header; add the content of an included file."""
        if isinstance(statement, Header):
            if not first:
                raise StatementError(statement.source, "the header must be the first statement, and occur only once")
            if self.includes is None or len(self.includes.open) == 1:
                self.draft.surface = statement.surface
            seen_from = self.draft.viewpoint
            if statement.viewpoint is not None:
                if self.includes is None or len(self.includes.open) == 1:
                    self.draft.viewpoint = statement.viewpoint
                elif seen_from is not None and key_of(seen_from) != key_of(statement.viewpoint):
                    message = (
                        f"this file is seen from '{statement.viewpoint}',"
                        f" but the script that includes it from '{seen_from}'"
                    )
                    raise StatementError(statement.source, message)
        if isinstance(statement, Include):
            return replace(statement, statements=tuple(self._read_included(statement)))
        return statement

    def _read_included(self, include: Include) -> Iterator[Statement]:
        if self.includes is None:
            raise StatementError(include.source, "a text has no folder to include from; read the script from a file")
        beside = self.includes.open[-1].parent
        real = self.includes.find(include.path, beside, include.source)
        if real is None:
            return
        shown = str(Path(self.file).parent / include.path)
        try:
            text = read_text(real, shown)
        except ScriptFileError as error:
            raise StatementError(include.source, str(error)) from None
        self.includes.open.append(real)
        yield from FileReader(text, shown, self.draft, self.language, self.includes).read()
        self.includes.open.pop()
