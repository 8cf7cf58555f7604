"""Parsers of the grammars, from LALR tables that are stored, because making a table takes longer than most commands.

The table of ``NAME.lark`` is ``NAME.table.json`` beside it, which ``python tools/grammar_tables.py`` writes. It is used
only with the grammar and the version of lark that it was made from; otherwise the parser is made from the grammar.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import lark
from lark import Lark, Token, Transformer
from lark.grammar import Rule
from lark.lark import PostLex
from lark.lexer import Lexer, TerminalDef


class NoLexer(Lexer):
    """Placeholder for lark's lexer: a scanner feeds the parser, so that lark compiles no patterns."""

    def __init__(self, conf: Any) -> None:
        pass

    def lex(self, lexer_state: Any, parser_state: Any) -> Iterator[Token]:
        """Raise NotImplementedError: lark never calls it.

        Parameters
        ----------
        lexer_state, parser_state
            States of lark.

        Yields
        ------
        Token
            Nothing.

        Raises
        ------
        NotImplementedError
            Always.
        """
        raise NotImplementedError("tokens come from the scanner")


@dataclass(frozen=True)
class ParsedGrammar:
    """A grammar file with what turns its parses into a tree.

    ``postlex`` names terminals that no rule uses, which lark would drop.
    """

    file: Path
    start: str
    transformer: Transformer[Token, Any]
    postlex: PostLex | None = None

    @property
    def table_file(self) -> Path:
        """The file of the stored table."""
        return self.file.with_suffix(".table.json")

    def parser(self) -> Lark:
        """Return the parser from the stored table, or from the grammar where the table does not fit.

        Returns
        -------
        Lark
            The parser.
        """
        text = self.file.read_text(encoding="utf-8")
        try:
            stored = json.loads(self.table_file.read_text(encoding="utf-8"), object_hook=_with_numbers)
        except FileNotFoundError:
            return self.made(text)
        if stored["made_from"] != _origin(text):
            return self.made(text)
        data = stored["data"]
        data["options"]["lexer"] = data["parser"]["lexer_conf"]["lexer_type"] = NoLexer
        given = {"transformer": self.transformer, "postlex": self.postlex}
        return Lark._load_from_dict(data, stored["memo"], **given)  # type: ignore[no-any-return, no-untyped-call]

    def made(self, text: str) -> Lark:
        """Return the parser made from the grammar.

        Parameters
        ----------
        text
            The grammar.

        Returns
        -------
        Lark
            The parser.
        """
        return Lark(
            text, parser="lalr", lexer=NoLexer, start=self.start, transformer=self.transformer, postlex=self.postlex
        )

    def table(self) -> str:
        """Return the table of the grammar as JSON, with what it was made from.

        Returns
        -------
        str
            The content of :attr:`table_file`.
        """
        text = self.file.read_text(encoding="utf-8")
        data, memo = self.made(text).memo_serialize([TerminalDef, Rule])
        data["options"] = {
            name: value for name, value in data["options"].items() if name not in ("lexer", "transformer", "postlex")
        }
        del data["parser"]["lexer_conf"]["lexer_type"]
        stored = {"made_from": _origin(text), "data": data, "memo": memo}
        return json.dumps(stored, separators=(",", ":"), sort_keys=True) + "\n"


def _origin(text: str) -> list[str]:
    """Return what a table is made from: the version of lark, and the hash of the grammar."""
    return [lark.__version__, hashlib.sha256(text.encode("utf-8")).hexdigest()]


def _with_numbers(entries: dict[str, Any]) -> dict[Any, Any]:
    """Return an object of JSON with its keys as whole numbers where they are: states and numbers of rules."""
    return {int(key) if key.isdecimal() else key: value for key, value in entries.items()}
