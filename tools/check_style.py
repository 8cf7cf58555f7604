"""Check the plain English of docstrings, comments, messages, pages and descriptions against `docs/style.md`.

Print one line per finding, as `file:line: message`, and exit with 1 where there is any. `make lint` runs it.
"""

from __future__ import annotations

import argparse
import ast
import re
import sys
import tokenize
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PYTHON_FOLDERS = (
    "ontology", "reasoning", "grammar", "perception", "memory", "src/deixis", "tests", "benchmarks", "tools",
)  # fmt: skip
TEXT_FILES = ("*.md", "docs/**/*.md", "examples/**/*.md", ".github/**/*.md")
DESCRIBING_FILES = ("ontology/*.ttl", "docs/schema/*.json", "examples/*.ipynb", "examples/*.layout", "Makefile")
"""Files of other languages with descriptions, comments or texts in English."""

UNCHECKED = (
    "style.md", "check_style.py", "test_check_style.py", "ontology.md",
    "words.py", "function_words.py", "relation_words.py", "verbs.py",
)  # fmt: skip
"""Files that quote what is to be avoided, or list the words of users, or are generated."""

MAX_TEST_NAME = 60
"""Maximum number of characters in the name of a test function."""

RIDDLES = ("What", "How", "Whether", "Who", "Whom", "Whose", "Which", "Why", "The same")
"""Openings that no docstring may have: they start a question or lean on another docstring."""

NOT_A_VERB = (
    "A", "All", "An", "Any", "As", "At", "Both", "Each", "Every", "For", "From", "If", "In", "It", "Its", "No", "Of",
    "On", "One", "That", "The", "There", "These", "They", "This", "Those", "When", "Where", "With",
)  # fmt: skip
"""Openings that the docstring of a function may not have: it starts with a verb in the imperative."""

PHRASES = {
    r"but for": "except, or without",
    r"so many as": "as many as, or a bound in symbols",
    r"(?:is|are|be|been|was|were|being) told(?! apart)": "name who reports what: 'the message names …'",
    r"anew": "again, or re- before the verb",
    r"(?<!there )(?-i:(?:is|are|was|were) none)": "there is no …",
    r"(?<!teddy )(?<!the )(?<!a )(?<![\"'`])(?-i:bears?)(?! in mind)": "has, carries, or supports",
    r"in the place of": "instead of",
    r"who is who": "which object each name refers to",
    r"nobody|somebody|nothing but": "name the person or the data",
    r"(?<!there )(?:is|are) no(?= )(?! (?:longer|more|less|fewer|greater|larger|smaller|matter))": "is not a …",
    r"is to be|are to be": "must be, or will be",
    r"thereof|therein|whereof|wherein|thereby": "of it, in it",
    r"from which on": "at which, above which, or minimum",
    r"if need be": "if necessary, or the condition",
    r"any more(?=[.,;:)])": "no longer",
    r"ever (?:nearer|closer|farther|smaller|larger|greater|sharper)": "decreasing, increasing, or closer and closer",
    r"worth (?:its|their) while": "pays off, or the minimum from which it pays off",
    r"learnt|whilst": "learned, while",
    r"(?:its|and the|or the) like(?=[ .,;:)]|$)": "similar words, or the whole list",
    r"(?:return|yield|compute|draw|write|do)s? the same (?:as|of|for|without|with)": "name what it is",
    r"(?:says?|said|saying) (?:(?:nothing|something|little|more) )?of(?! what| which|[:*])": "about",
    r"tells? (?:nothing|little|something)": "carries no information, or states nothing",
}
"""Wordings that stand in the way of a reader, as regular expressions, and what to write instead."""

_PHRASES = [(re.compile(rf"\b(?:{wording})(?!\w)", re.IGNORECASE), advice) for wording, advice in PHRASES.items()]


@dataclass(frozen=True, slots=True)
class Finding:
    """One place that breaks a rule."""

    path: Path
    line: int
    message: str

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: {self.message}"


def python_findings(path: Path, source: str) -> Iterator[Finding]:
    """Yield what breaks a rule in the docstrings, comments, strings and test names of a module."""
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            yield from _opening_findings(path, node)
        if isinstance(node, ast.Module | ast.ClassDef):
            yield from _attribute_openings(path, node.body[1:])
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
            if len(node.name) > MAX_TEST_NAME:
                found = f"`{node.name}` has {len(node.name)} characters, at most {MAX_TEST_NAME}"
                yield Finding(path, node.lineno, found)
            yield from _phrase_findings(path, node.name.replace("_", " "), node.lineno)
    for token in tokenize.generate_tokens(iter(source.splitlines(keepends=True)).__next__):
        if token.type in (tokenize.COMMENT, tokenize.STRING) or tokenize.tok_name[token.type] == "FSTRING_MIDDLE":
            yield from _phrase_findings(path, token.string, token.start[0])


def _opening_findings(
    path: Path, node: ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
) -> Iterator[Finding]:
    docstring = ast.get_docstring(node)
    if not docstring:
        return
    line = node.body[0].lineno
    yield from _riddle(path, line, docstring)
    if isinstance(node, ast.Module | ast.ClassDef) or _is_property(node):
        return
    opening = docstring.split()[0].rstrip(",")
    if opening in NOT_A_VERB:
        yield Finding(path, line, f"docstring of a function opens with '{opening}': start with a verb")


def _is_property(node: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    """Return True for a function that is read as an attribute, or is a fixture: a noun phrase names it."""
    return any("property" in ast.unparse(each) or "fixture" in ast.unparse(each) for each in node.decorator_list)


def _attribute_openings(path: Path, statements: list[ast.stmt]) -> Iterator[Finding]:
    for statement in statements:
        match statement:
            case ast.Expr(value=ast.Constant(value=str(text))):
                yield from _riddle(path, statement.lineno, text)


_THRESHOLD = re.compile(
    r"(?:Least|Greatest)\b"
    r"|(?:Age|Agreement|Angle|Confidence|Degree|Distance|Error|Height|Length|Metres|Probability|Ratio|Share)\b"
    r"[^.:;]*\sfrom\swhich\b"
)


def _riddle(path: Path, line: int, docstring: str) -> Iterator[Finding]:
    opening = next((words for words in RIDDLES if re.match(rf"{words}\b", docstring.strip())), None)
    if opening is not None:
        yield Finding(path, line, f"docstring opens with '{opening}': say what it is or does")
    if _THRESHOLD.match(docstring.strip()):
        yield Finding(path, line, "docstring of a threshold: start with 'Minimum' or 'Maximum', then 'at which'")


def _phrase_findings(path: Path, text: str, line: int) -> Iterator[Finding]:
    for wording, advice in _PHRASES:
        for found in wording.finditer(text):
            at = line + text.count("\n", 0, found.start())
            yield Finding(path, at, f"'{' '.join(found.group().split())}': write {advice}")


def text_findings(path: Path, text: str) -> Iterator[Finding]:
    """Yield the wordings to avoid in a page, outside of its code blocks."""
    without_code = re.sub(
        r"^```.*?^```|`[^`\n]+`",
        lambda block: re.sub(r"[^\n]", " ", block.group()),
        text,
        flags=re.DOTALL | re.MULTILINE,
    )
    yield from _phrase_findings(path, without_code, 1)


_DESCRIPTIONS = re.compile(r'(?:skos:definition|rdfs:comment|sh:message|"(?:description|title)":)\s+"([^"]+)"')


def description_findings(path: Path, text: str) -> Iterator[Finding]:
    """Yield the wordings to avoid in Turtle, JSON and other files, and descriptions that open with a question."""
    yield from _phrase_findings(path, text, 1)
    for found in _DESCRIPTIONS.finditer(text):
        for riddle in _riddle(path, 1 + text.count("\n", 0, found.start(1)), found[1]):
            yield replace(riddle, message=riddle.message.replace("docstring", "description"))


def findings(names: list[str]) -> Iterator[Finding]:
    """Yield the findings of the whole project, or of the files and folders that ``names`` starts with."""
    python = [path for folder in PYTHON_FOLDERS for path in sorted((ROOT / folder).rglob("*.py"))]
    texts = [path for pattern in TEXT_FILES for path in sorted(ROOT.glob(pattern))]
    others = [path for pattern in DESCRIBING_FILES for path in sorted(ROOT.glob(pattern))]
    for path in [*python, *texts, *others]:
        local = path.relative_to(ROOT)
        if local.name in UNCHECKED or any(parent.is_symlink() for parent in path.parents):
            continue
        if names and not any(local.is_relative_to(name) for name in names):
            continue
        source = path.read_text(encoding="utf-8")
        check = {".py": python_findings, ".md": text_findings}.get(path.suffix, description_findings)
        yield from check(local, source)


def main() -> int:
    """Run the check over the paths given, or over everything."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="files and folders, relative to the repository; everything if none")
    found = list(findings(parser.parse_args().names))
    print("\n".join(map(str, found)))
    print(f"{len(found)} findings; docs/style.md says what to write", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
