"""Adjectives by dimension."""

from __future__ import annotations

import pytest

from deixis.errors import OntologyError
from deixis.ontology.lexicon.adjectives import DIMENSIONS, adjectives, read_adjectives
from deixis.ontology.tbox import default_ontology


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_every_dimension_has_words(dimension: str) -> None:
    assert default_ontology().lexicon.adjectives_of(dimension)


@pytest.mark.parametrize(
    ("word", "dimension", "sign"),
    [
        ("huge", "size", 1),
        ("tiny", "size", -1),
        ("low", "height", -1),
        ("wooden", "material", 0),
        ("round", "shape", 0),
    ],
)
def test_a_word_has_its_dimension_and_end_of_the_scale(word: str, dimension: str, sign: int) -> None:
    found = adjectives()[word]
    assert (found.dimension, found.sign) == (dimension, sign)


@pytest.mark.parametrize(
    "line", ["zorgle: big", "size *: big", "size: big,, large", "size: big\nheight: big", "size big"]
)
def test_a_line_of_another_form_is_an_error(line: str) -> None:
    with pytest.raises(OntologyError, match=r"adjectives\.txt:"):
        read_adjectives(line)
