"""Phrases of several words: those that head a chain, and the pattern that finds the longest of many."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import product
from typing import Any

from deixis.ontology.relation import Reading, Relation
from deixis.ontology.tbox import Ontology

_BETWEEN = r"[ \t_]+(?:(?:the|an|a)[ \t_]+)*"  # what may stand between the words of a phrase
_BOUNDARY = r"(?![\w-]|[^\x00-\x7f\s])"  # the end of a word, as the terminal NAME has it


def phrase_pattern(phrases: Iterable[str]) -> str:
    """A regular expression for the longest of these phrases, words parted by blanks, underscores and articles.

    It is a prefix tree, so that a word costs one branch a letter and not one a phrase, and nothing is tried twice.

    >>> pattern = re.compile(phrase_pattern(["left", "to left of"]), re.IGNORECASE)
    >>> [pattern.match(text) is not None for text in ("to the left_of", "left", "left_glass", "lefty")]
    [True, True, False, False]
    """
    tree: dict[str, Any] = {}
    for phrase in phrases:
        node = tree
        for word in phrase.split():
            node = node.setdefault(word, {})
        node[""] = {}
    return _alternatives(tree)


def _alternatives(tree: dict[str, Any]) -> str:
    by_letter: dict[str, list[str]] = {}
    for word in sorted(word for word in tree if word):
        by_letter.setdefault(word[0], []).append(re.escape(word[1:]) + _rest(tree[word]))
    options = [re.escape(letter) + f"(?:{'|'.join(rests)})" for letter, rests in by_letter.items()]
    return f"(?:{'|'.join(options)})"


def _rest(node: dict[str, Any]) -> str:
    longer = [_BETWEEN + _alternatives(node)] if any(node) else []
    return f"(?:{'|'.join([*longer, *([_BOUNDARY] if '' in node else [])])})"


def chains(ontology: Ontology) -> dict[str, Relation]:
    """What may head a chain, without its colon: from one side to the opposite one, for every direction.

    >>> from deixis.ontology.tbox import default_ontology
    >>> found = chains(default_ontology())
    >>> found["left to right"].name, found["top left to bottom right"].name, found["above to below"].name
    ('left', 'top_left', 'top')
    """
    wide = ontology.relations.of_reading(Reading.WIDE)
    directions = [relation for relation in wide if relation.z_atoms == 0]  # on and under lie in no direction
    found: dict[str, Relation] = {}
    for relation in directions:
        inverse = ontology.relations[relation.inverse]
        for start, end in product(_sides(relation), _sides(inverse)):
            found.setdefault(f"{start} to {end}", relation)
    return found


def _sides(relation: Relation) -> tuple[str, ...]:
    return tuple(dict.fromkeys((relation.word.replace("_", " "), relation.phrase.removesuffix(" of"))))
