"""Read scripts that are still being written: the statements without errors, and what can follow the last word."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from lark import Token
from lark.exceptions import UnexpectedToken

from deixis.deadline import Deadline
from deixis.grammar.errors import Diagnostic, StatementError
from deixis.grammar.files import Includes
from deixis.grammar.layout.draft import Draft, Place, place
from deixis.grammar.layout.language import language_of
from deixis.grammar.layout.parser import STATEMENTS_PER_CLOCK_CHECK, FileReader
from deixis.grammar.layout.tokens import TERMINALS_WITHOUT_RULE
from deixis.grammar.script import Header, Include, Script, Statement
from deixis.ontology.graph.facts import Source
from deixis.ontology.relations.relation import ARTICLES
from deixis.ontology.tbox import Ontology, default_ontology


@dataclass(frozen=True)
class UnfinishedScript:
    """A script of the statements without errors, and the errors of the others.

    ``complete`` is False if the time limit was reached before all statements were read.
    """

    script: Script
    problems: tuple[Diagnostic, ...]
    complete: bool


def read_unfinished(
    text: str,
    file: str = "<text>",
    folder: Path | None = None,
    ontology: Ontology | None = None,
    deadline: Deadline = Deadline.never(),
) -> UnfinishedScript:
    """Read the statements of a text that have no errors, and collect the errors of the others.

    Parameters
    ----------
    text
        The script.
    file
        Name of the text in error messages and sources.
    folder
        Folder of the script, in which included files must be. Without it, an include is an error.
    ontology
        Words that the script may use. By default :func:`default_ontology`.
    deadline
        Time limit; what was read until then is returned.

    Returns
    -------
    UnfinishedScript
        The script, its errors, and whether all of it was read.

    Examples
    --------
    >>> found = read_unfinished("fork left of plate; knife right of")
    >>> [str(fact) for fact in found.script.facts], [problem.message for problem in found.problems]
    (['left(fork, plate)'], ["expected a name after 'right of'"])
    """
    ontology = ontology or default_ontology()
    includes = None
    if folder is not None:
        real = folder.resolve()
        includes = Includes(real, [real / Path(file).name])
    reader = FileReader(text, file, Draft(ontology), language_of(ontology), includes)
    statements: list[Statement] = []
    complete = True
    for statement in reader.read():
        statements.append(statement)
        if len(statements) % STATEMENTS_PER_CLOCK_CHECK == 0 and deadline.passed:
            complete = False
            break
    first = statements[0] if statements else None
    header = first if isinstance(first, Header) else Header(None, None, None, Source(file, 1, 1, 1, 1))
    script = Script(
        file=file,
        name=header.name,
        title=header.title,
        viewpoint=header.viewpoint,
        surface=header.surface,
        statements=tuple(statements),
        comments=tuple(reader.comments),
        ontology=ontology,
    )
    return UnfinishedScript(script, tuple(_in_file(problem, script) for problem in reader.draft.problems), complete)


def _in_file(problem: Diagnostic, script: Script) -> Diagnostic:
    """Return the problem, at the include statement if it is in an included file."""
    if problem.source.file == script.file:
        return problem
    folder = Path(script.file).parent
    for statement in script.statements:
        if isinstance(statement, Include) and _reads(statement, problem.source.file, folder):
            where = replace(problem, source=statement.source, replacement=None)
            return replace(where, message=f"{problem.source}: {problem.message}")
    start = Source(script.file, 1, 1, 1, 2)
    return replace(problem, source=start, message=f"{problem.source}: {problem.message}", replacement=None)


def _reads(include: Include, file: str, folder: Path) -> bool:
    path = folder / include.path
    inner = (statement for statement in include.statements if isinstance(statement, Include))
    return str(path) == file or any(_reads(one, file, path.parent) for one in inner)


@dataclass(frozen=True)
class Expected:
    """Tokens of the last statement of a text, and the terminals that can come next.

    ``inside`` is True if the text ends in a comment or in a name whose quotation mark is not closed yet.
    """

    tokens: tuple[Token, ...]
    terminals: frozenset[str]
    inside: bool = False


def expected_next(text: str, ontology: Ontology | None = None) -> Expected:
    """Return the terminals of the grammar that can follow a text.

    Parameters
    ----------
    text
        The beginning of a script.
    ontology
        Words of the language; default: the shipped ones.

    Returns
    -------
    Expected
        The terminals, and the words that they have; none if the last statement has an error.

    Examples
    --------
    >>> found = expected_next("fork left of plate; the knife")
    >>> "RELATION" in found.terminals, "NAME" in found.terminals
    (True, False)
    """
    ontology = ontology or default_ontology()
    language = language_of(ontology)
    last: Token | None = None
    statement: list[Token] = []
    for token in language.scanner.tokens(text):
        last = token
        if token.type == "COMMENT":
            continue
        if token.type != "END":
            statement.append(token)
        elif token != "\n" or not statement or statement[-1].type not in ("_COMMA", "_AND"):
            statement = []
    if last is not None and last.type in ("COMMENT", "OPEN_STRING"):
        return Expected(tuple(statement), frozenset(), inside=True)
    while statement and statement[-1].casefold() in ARTICLES and text[-1:].isspace():
        statement.pop()
    if any(token.type in TERMINALS_WITHOUT_RULE for token in statement):
        return Expected(tuple(statement), frozenset())
    parser = language.lark.parse_interactive()
    previous = place.set(Place(Draft(ontology), "<text>", Source("<text>", 1, 1, 1, 1)))
    try:
        for token in statement:
            parser.parser_state.feed_token(token)
        accepted = frozenset(parser.accepts())  # type: ignore[no-untyped-call]
    except (UnexpectedToken, StatementError):
        accepted = frozenset()
    finally:
        place.reset(previous)
    return Expected(tuple(statement), accepted)
