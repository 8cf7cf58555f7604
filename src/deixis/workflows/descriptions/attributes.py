"""Find new adjectives in sentences, and compare learned ones with the things of a scene."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.learning.attributes import measured
from deixis.ontology.tbox import default_ontology
from deixis.perception.scene import Scene
from deixis.reasoning.attributes.attribute import Attribute, Example
from deixis.reasoning.errors import DescriptionError
from deixis.reasoning.grounding.reference.features.properties import LIGHTNESS, MIDDLE, SIDES, SIZES

DETERMINERS = frozenset(
    ["the", "a", "an", "this", "that", "these", "those", "my", "your", "his", "her", "our", "their"]
)
HEADS = frozenset(["one", "ones", "thing", "things", "object", "objects", "item", "items"])
"""Nouns that name no kind."""

ENDS = frozenset(
    [
        "is",
        "are",
        "was",
        "were",
        "looks",
        "look",
        "seems",
        "seem",
        "to",
        "of",
        "on",
        "in",
        "at",
        "near",
        "next",
        "left",
        "right",
        "between",
        "behind",
        "below",
        "under",
        "above",
        "beside",
        "with",
        "without",
        "that",
        "which",
        "who",
        "and",
        "or",
        "but",
        "from",
        "by",
        "for",
        "it",
        "here",
        "there",
        "not",
        "very",
    ]
)
"""Words at which a noun phrase ends."""

SAME_NOUN = 0.5
"""Minimum similarity of a noun to a label at which the noun may name the thing."""

LINKS = frozenset(["is", "are", "was", "were", "looks", "look", "seems", "seem", "isn't", "aren't"])


@dataclass(frozen=True, slots=True)
class Phrase:
    """Adjectives without a known meaning in a sentence, and the noun that they stand with.

    ``noun`` is empty for *the blick one*. ``stated`` is True for *the cup is blick*, which says nothing about other
    things, and ``positive`` is False for *is not blick*.
    """

    words: tuple[str, ...]
    noun: str
    stated: bool = False
    positive: bool = True


def new_adjectives(text: str) -> Phrase | None:
    """Return the adjectives without a known meaning in a sentence about one thing.

    Parameters
    ----------
    text
        English: *the blick one*, *the blick red cup on the tray*, *the cup is not blick*.

    Returns
    -------
    Phrase or None
        The adjectives of the first noun phrase, or those after *is*; None if there are none.

    Examples
    --------
    >>> new_adjectives("the blick red cup on the tray")
    Phrase(words=('blick',), noun='cup', stated=False, positive=True)
    >>> new_adjectives("the red cup") is None
    True
    """
    words = re.findall(r"[a-z][a-z'-]*", text.casefold().replace("’", "'"))
    link = next((i for i, word in enumerate(words) if word in LINKS), None)
    if link is not None:
        rest = [word for word in words[link + 1 :] if word not in ("not", "very", "quite", "really")]
        if len(rest) == 1 and is_new_adjective(rest[0]):
            denied = "not" in words[link:] or words[link].endswith("n't")
            return Phrase((rest[0],), "", stated=True, positive=not denied)
        if not rest or rest[0] not in DETERMINERS:
            return None
        words = rest
    start = next((i for i, word in enumerate(words) if word in DETERMINERS), -1) + 1
    end = next((i for i in range(start, len(words)) if words[i] in ENDS), len(words))
    phrase = words[start:end]
    if len(phrase) < 2:
        return None
    lexicon = default_ontology().lexicon
    *modifiers, head = phrase
    if head not in HEADS and not lexicon.knows(head):
        return None
    if modifiers and lexicon.knows(f"{modifiers[-1]} {head}") and lexicon.knows(modifiers[-1]):
        head = f"{modifiers.pop()} {head}"
    found = tuple(word for word in modifiers if is_new_adjective(word))
    return Phrase(found, "" if head in HEADS else head, stated=link is not None) if found else None


def is_new_adjective(word: str) -> bool:
    """Return whether a word may be an adjective whose meaning nothing measures yet.

    Parameters
    ----------
    word
        A word in lower case.

    Returns
    -------
    bool
        False for nouns, colours, and words of size, place and light.
    """
    ontology = default_ontology()
    measured_words = word in SIZES or word in SIDES or word in LIGHTNESS or word in MIDDLE
    known = measured_words or ontology.colours.of_word(word) is not None
    return len(word) > 1 and not known and word not in ENDS | HEADS | DETERMINERS and not ontology.lexicon.knows(word)


def examples_of(phrase: Phrase, scene: Scene, target: str) -> list[Example]:
    """Return the things of a scene as examples of the words of a phrase that picked out one of them.

    Parameters
    ----------
    phrase
        Adjectives with their noun.
    scene
        The scene.
    target
        Id of the thing that was meant.

    Returns
    -------
    list of Example
        The thing, and, unless the phrase is a statement, the other things that its noun may name, as negative ones.

    Raises
    ------
    DescriptionError
        If the scene has no such thing.
    """
    if target not in scene.ids:
        raise DescriptionError(f"{scene.file}: there is no object '{target}'; give an id of the scene")
    lexicon, measures = default_ontology().lexicon, measured(scene)
    found = []
    for row, thing in zip(measures, scene.objects, strict=True):
        if thing.id == target:
            found.append(Example(row, thing.label, phrase.positive))
        elif not phrase.stated and (
            not phrase.noun or thing.label is None or lexicon.similarity(phrase.noun, thing.label) > SAME_NOUN
        ):
            found.append(Example(row, thing.label, False))
    return found


def attribute_odds(text: str, scene: Scene, attributes: Mapping[str, Attribute]) -> tuple[str, NDArray[np.float64]]:
    """Return a description without its learned adjectives, and their log odds for each thing.

    Parameters
    ----------
    text
        The description.
    scene
        Scene of n things.
    attributes
        Learned attributes by word.

    Returns
    -------
    text : str
        The rest of the description, with *thing* for *one* if an adjective was taken out.
    odds : ndarray
        Sums of the log odds of the words, shape (n,).
    """
    phrase = new_adjectives(text)
    words = [word for word in phrase.words if word in attributes] if phrase is not None and not phrase.stated else []
    if not words:
        return text, np.zeros(len(scene.objects))
    labels = [thing.label for thing in scene.objects]
    p = np.array([attributes[word].probabilities(measured(scene), labels) for word in words])
    rest = re.sub(rf"\b(?:{'|'.join(map(re.escape, words))})\b[\s,]*", "", text, flags=re.IGNORECASE)
    rest = re.sub(r"\bone\b", "thing", rest, count=1)
    return rest, (np.log(p) - np.log1p(-p)).sum(axis=0)


def is_bare(text: str) -> bool:
    """Return whether a description has only a determiner and a noun that names no kind.

    Parameters
    ----------
    text
        The description.

    Returns
    -------
    bool
        True for *the thing*.
    """
    return set(re.findall(r"[a-z']+", text.casefold())) <= DETERMINERS | HEADS
