"""Nouns of people and labels of scenes: kinds, sizes, and how well one fits the other."""

from __future__ import annotations

import pytest

from deixis.ontology.lexicon.lexicon import Relatedness
from deixis.ontology.rdf.vocabulary import DX
from deixis.ontology.tbox import default_ontology, load_ontology
from deixis.ontology.things.kinds import Kind
from deixis.ontology.things.sizes import Outline

ONTOLOGY = default_ontology()
LEXICON = ONTOLOGY.lexicon


def kind_of(noun: str) -> Kind:
    found = LEXICON.kind_of(noun)
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("noun", "label"),
    [
        ("rice_bowl_2", "bowl"),
        ("wooden coffee tables", "coffee table"),
        ("trash can", "bin"),
        ("watering can", "watering can"),
        ("soda can", "can"),
        ("mouse pad", "mouse pad"),
        ("cup of tea", "cup"),
        ("pair of scissors", "scissors"),
        ("stack of books", "stack of books"),
        ("grandmother's old teapot", "teapot"),
        ("glasses", "glass"),
    ],
)
def test_a_noun_is_of_the_kind_of_its_longest_known_end(noun: str, label: str) -> None:
    assert kind_of(noun).label == label


@pytest.mark.parametrize("noun", ["", "thingummy", "glorble of wax", "bowling", "kind of", "left side"])
def test_a_noun_without_a_known_end_has_no_kind(noun: str) -> None:
    assert LEXICON.kind_of(noun) is None
    assert not LEXICON.knows(noun)


@pytest.mark.parametrize(
    ("noun", "label", "relation"),
    [
        ("Sofa", "sofas", Relatedness.SAME),
        ("couch", "sofa", Relatedness.SYNONYM),
        ("garbage bin", "trash can", Relatedness.SYNONYM),
        ("chair", "office chair", Relatedness.BROADER),
        ("bowl", "rice bowl", Relatedness.BROADER),
        ("office chair", "chair", Relatedness.NARROWER),
        ("salad fork", "cutlery", Relatedness.NARROWER),
        ("rice bowl", "noodle bowl", Relatedness.SIBLING),
        ("office chair", "rocking chair", Relatedness.SIBLING),
        ("can", "trash can", Relatedness.UNRELATED),
        ("mouse", "mouse pad", Relatedness.UNRELATED),
        ("sofa", "lamp", Relatedness.UNRELATED),
        ("thingummy", "lamp", Relatedness.UNRELATED),
    ],
)
def test_nouns_and_labels_are_related_as_people_use_them(noun: str, label: str, relation: Relatedness) -> None:
    assert LEXICON.relation(noun, label) is relation


def test_similarity_falls_from_synonyms_to_unrelated_words() -> None:
    labels = ("couch", "sofa", "love seat", "bench", "lamp")
    found = [LEXICON.similarity("couch", label) for label in labels]
    assert found == sorted(found, reverse=True)
    assert found[0] == 1 and found[-1] == 0 and len(set(found)) == len(found)


def test_similarity_is_as_great_in_both_directions() -> None:
    words = ["couch", "seat", "rice bowl", "bowl", "plate", "trash can", "bin", "owl", "eagle", "thingummy"]
    for first in words:
        for second in words:
            assert LEXICON.similarity(first, second) == LEXICON.similarity(second, first)


def test_a_homonym_fits_labels_of_each_of_its_senses() -> None:
    assert LEXICON.relation("screen", "television") is Relatedness.SYNONYM
    assert LEXICON.relation("mouse", "animal") is Relatedness.NARROWER
    assert kind_of("mouse").name == "ComputerMouse"


def test_a_size_is_of_the_kind_the_head_noun_or_all_things() -> None:
    own = LEXICON.size_of("coffee table")
    assert own.stated_of == kind_of("coffee table").iri and own.outline is Outline.RECTANGLE
    assert LEXICON.size_of("scratched coffee table") == own
    assert LEXICON.size_of("tulip").stated_of == kind_of("flower").iri
    assert LEXICON.size_of("thingummy") == ONTOLOGY.sizes.of(DX.THING)


def test_a_word_added_to_the_ontology_is_a_noun_of_the_lexicon() -> None:
    more = load_ontology("""@prefix dx: <https://w3id.org/deixis/onto#> .
        @prefix skos: <http://www.w3.org/2004/02/skos/core#> . dx:Sofa skos:altLabel "settle"@en .""")
    assert more.lexicon.relation("old settles", "couch") is Relatedness.NARROWER
    assert LEXICON.relation("settle", "couch") is Relatedness.UNRELATED
