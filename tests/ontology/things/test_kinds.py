"""The taxonomy, looked up by the words that people use."""

from __future__ import annotations

import pytest

from deixis.ontology.rdf.vocabulary import DX
from deixis.ontology.tbox import default_ontology
from deixis.ontology.things.kinds import Kind, Kinds

KINDS = default_ontology().kinds


def kind(word: str) -> Kind:
    found = KINDS.of_word(word)
    assert found is not None
    return found


@pytest.mark.parametrize("word", ["dinner plate", "dinner_plate", "Dinner  Plate", "dinner-plate", "DinnerPlate"])
def test_a_kind_is_found_however_its_name_is_written(word: str) -> None:
    assert kind(word).name == "DinnerPlate"


def test_an_unknown_word_gives_no_kind() -> None:
    assert KINDS.of_word("thingummy") is None
    assert KINDS.of_word("") is None


@pytest.mark.parametrize(
    ("narrow", "broad"),
    [("dessert fork", "fork"), ("dessert fork", "cutlery"), ("red wine glass", "glass"), ("saucer", "tableware")],
)
def test_the_taxonomy_is_transitive(narrow: str, broad: str) -> None:
    assert KINDS.is_a(kind(narrow), kind(broad))
    assert not KINDS.is_a(kind(broad), kind(narrow))


def test_every_kind_is_itself_and_a_thing() -> None:
    assert all(KINDS.is_a(k, k) and KINDS.is_a(k, KINDS[DX.THING]) for k in KINDS)


def test_every_broader_class_of_a_kind_is_a_kind() -> None:
    known = {k.iri for k in KINDS}
    assert all(k.broader <= known for k in KINDS)
    assert len(known) == len(KINDS)


def test_a_fork_is_not_a_spoon() -> None:
    assert not KINDS.is_a(kind("fork"), kind("spoon"))


def test_no_two_kinds_share_a_word() -> None:
    words: dict[str, str] = {}
    clashes = [
        (word, words[word], k.name) for k in KINDS for word in k.words if words.setdefault(word, k.name) != k.name
    ]
    assert clashes == []


def test_the_first_of_two_kinds_keeps_a_shared_word() -> None:
    first = Kind("urn:x#First", "thing", ("thing",), frozenset())
    second = Kind("urn:x#Second", "thing", ("thing",), frozenset())
    assert Kinds((first, second)).of_word("Thing") is first
