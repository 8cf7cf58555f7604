"""Classes of words that can be nouns or verbs, chosen for the whole sentence."""

from __future__ import annotations

import pytest

from deixis.grammar.english.rewording import words_of
from deixis.grammar.english.tagging.tagger import MAX_LOSS, Tagger
from deixis.grammar.english.tagging.word_classes import FINITE, NOMINAL, possible_classes
from deixis.grammar.english.vocabulary.known_nouns import known_nouns
from deixis.ontology.tbox import default_ontology

NOUNS = known_nouns(default_ontology().kinds)


def tagger(text: str) -> Tagger:
    """Return the tagger of a sentence."""
    return Tagger(words_of(text, (0, len(text))), NOUNS)


@pytest.mark.parametrize(
    ("text", "verbs"),
    [
        ("The stand holds two clamps.", ["holds"]),
        ("The cups stand on the rest.", ["stand"]),
        ("Stack the plates on the stack of trays.", ["stack"]),
        ("Store bread in the bin.", ["store"]),
        ("Store room: brooms on the left.", []),
        ("The lid must not rest on the rest.", ["rest"]),
        ("Behind the press hangs a saw.", ["hangs"]),
        ("The lamp that stands on the desk faces the door.", ["stands", "faces"]),
        ("Neither cup is on the tray; both hang on the rack.", ["hang"]),
        ("The plate is on the left, and the knife and spoon are on the right.", []),
    ],
)
def test_first_finite_verbs_of_a_sentence(text: str, verbs: list[str]) -> None:
    words = words_of(text, (0, len(text)))
    classes = tagger(text).best().classes
    assert [word.norm for word, one in zip(words, classes, strict=True) if one in FINITE] == verbs


def test_second_readings_have_a_noun_as_a_verb() -> None:
    found = tagger("Water jug and cups on the tray.")
    best = found.best()
    seconds = list(found.second_best(best))
    scores = [second.score for second in seconds]
    assert scores == sorted(scores, reverse=True)
    for second in seconds:
        assert best.score - MAX_LOSS <= second.score <= best.score
        assert all(best.classes[at] in NOMINAL and second.classes[at] in FINITE for at in second.tried)


def test_required_class_changes_the_best_sequence() -> None:
    found = tagger("The lamp stands on the desk.")
    best, forced = found.best(), found.best({2: frozenset({"noun"})})
    assert (best.classes[2], forced.classes[2]) == ("third", "noun")
    assert forced.score < best.score


@pytest.mark.parametrize(
    ("text", "word", "classes"),
    [
        ("the lamp blorps on it", "blorps", {"noun", "third"}),
        ("the crumpled cloth", "crumpled", {"noun", "participle"}),
        ("the can can stand", "can", {"modal", "noun"}),
        ("it lies next to the cup", "next", {"adjective", "preposition"}),
        ("it lies in front of the cup", "front", {"preposition"}),
    ],
)
def test_possible_classes_follow_from_tables_and_shape(text: str, word: str, classes: set[str]) -> None:
    words = words_of(text, (0, len(text)))
    norms = [one.norm for one in words]
    found = possible_classes(words, [*norms, "", ""], NOUNS)
    assert {possible.word_class for possible in found[norms.index(word)]} == classes
