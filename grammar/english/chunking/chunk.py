"""Chunks: the terminals of ``english.lark``, with what was found in their words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from deixis.grammar.english.tree import Span
from deixis.grammar.english.vocabulary.relation_words import Preposition

FINITE = frozenset({"BE", "VERB", "TVERB"})
COMMANDS = frozenset({"PUT", "DO", "FIND", "GO"})
JOINT_TYPES = frozenset({"COMMA", "AND", "OR", "BUT", "THEN", "CUT", "COLON", "SUB"})


@dataclass(slots=True)
class Chunk:
    """A terminal of the grammar: its type, the words from ``start`` to ``end`` and what was found in them."""

    type: str
    start: int
    end: int
    value: Any = None
    span: Span = (0, 0)


@dataclass(frozen=True, slots=True)
class VerbGroup:
    """A verb with its auxiliaries: *must not stand* has the lemma ``stand``, ``must`` and is not positive."""

    lemma: str
    kind: str
    form: str
    modal: str | None = None
    positive: bool = True
    past: bool = False
    adverbs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Relator:
    """A preposition or a place word with its adverbs: *slightly to the left of*, *second closest to*."""

    preposition: Preposition
    adverbs: tuple[str, ...] = ()
    rank: int | None = None
    positive: bool = True
