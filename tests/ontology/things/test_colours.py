"""The colour terms: their words, names that begin with one, and the source of prototypes and spreads."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.colors import XKCD_COLORS

from deixis.errors import OntologyError
from deixis.ontology.tbox import default_ontology, load_ontology
from deixis.ontology.things.colours import Colour, Rgb, hex_of_rgb, rgb_of_hex
from deixis.reasoning.grounding.evidence.properties.colours import lab_of_srgb

ONTOLOGY = default_ontology()
COLOURS, KINDS = ONTOLOGY.colours, ONTOLOGY.kinds
BASIC = {"black", "white", "grey", "red", "green", "yellow", "blue", "brown", "orange", "pink", "purple"}

PREFIXES = """@prefix dx: <https://w3id.org/deixis/onto#> . @prefix dcterms: <http://purl.org/dc/terms/> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> . @prefix skos: <http://www.w3.org/2004/02/skos/core#> .
"""
TEAL = 'dx:petrol a dx:Colour ; rdfs:label "petrol" ; dx:prototype "#008080" ; dx:spread "100 0 0 100 0 100" .'


def test_there_are_eleven_basic_terms_and_narrower_ones_of_them() -> None:
    assert {colour.label for colour in COLOURS.basic} == BASIC
    narrower = [colour for colour in COLOURS if colour not in COLOURS.basic]
    assert {COLOURS[str(colour.broader)].label for colour in narrower} < BASIC
    assert len(narrower) == 12


@pytest.mark.parametrize(
    ("word", "label"), [("gray", "grey"), ("Violet", "purple"), ("dark_blue", "blue"), ("light-green", "green")]
)
def test_a_colour_is_found_by_every_word_however_it_is_written(word: str, label: str) -> None:
    found = COLOURS.of_word(word)
    assert found is not None
    assert found.label == label
    assert COLOURS[found.iri] is found


def test_no_word_is_both_a_colour_and_a_kind() -> None:
    assert COLOURS.words.keys() & KINDS.words.keys() == set()


@pytest.mark.parametrize(
    ("name", "kind", "colour"),
    [
        ("red_mug", "Mug", "red"),
        ("Dark_Blue_Mug_3", "Mug", "blue"),
        ("light_thingummy", None, None),
        ("red_thingummy", None, "red"),
        ("red_wine_glass", "RedWineGlass", None),
        ("white_wine_glass_2", "WhiteWineGlass", None),
        ("orange", "Orange", None),
        ("orange_2", "Orange", None),
        ("dark_blue", None, None),
        ("mug_red", None, None),
        ("redmug", None, None),
        ("", None, None),
    ],
)
def test_a_name_stands_for_a_kind_and_a_colour(name: str, kind: str | None, colour: str | None) -> None:
    found_kind, found_colour = ONTOLOGY.of_name(name)
    assert (found_kind and found_kind.name, found_colour and found_colour.label) == (kind, colour)


@given(st.tuples(*[st.integers(0, 255)] * 3))
def test_a_colour_comes_back_from_its_hexadecimal_digits(rgb: Rgb) -> None:
    assert rgb_of_hex(hex_of_rgb(rgb)) == rgb


@pytest.mark.parametrize("text", ["", "#fff", "ff0000", "#ff00001", "#ff000g", "#ff0000\n", "#١٢٣٤٥٦"])
def test_text_that_is_not_a_colour_gives_none(text: str) -> None:
    assert rgb_of_hex(text) is None


def named(term: Colour) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Return the CIELAB values of the survey's names that end in a term, shape (n, 3); the table is matplotlib's."""
    words = term.words if term.broader else (term.label,)
    found = [rgb_of_hex(str(value)) for name, value in XKCD_COLORS.items() if name[5:].split()[-1] in words]
    return lab_of_srgb(np.array(found, dtype=np.float64))


@pytest.mark.parametrize("term", [c for c in COLOURS.basic if c.label not in ("black", "white")], ids=lambda c: c.label)
def test_prototype_and_spread_are_those_of_the_survey(term: Colour) -> None:
    seen = named(term)
    assert len(seen) >= 25
    assert np.abs(lab_of_srgb(np.array(term.prototype, dtype=np.float64)) - seen.mean(axis=0)).max() < 0.5
    assert np.abs(term.matrix() - np.cov(seen.T)).max() <= 0.5 + 1e-6


def test_narrower_terms_share_the_pooled_spread_of_the_survey() -> None:
    narrower = [colour for colour in COLOURS if colour.broader]
    seen = [named(term) for term in narrower]
    for term, colours in zip(narrower, seen, strict=True):
        assert np.abs(lab_of_srgb(np.array(term.prototype, dtype=np.float64)) - colours.mean(axis=0)).max() < 0.5
    apart = np.concatenate([colours - colours.mean(axis=0) for colours in seen])
    pooled = apart.T @ apart / (len(apart) - len(seen))
    assert all(np.abs(term.matrix() - pooled).max() <= 0.5 + 1e-6 for term in narrower)


def test_black_and_white_have_the_spread_of_grey() -> None:
    black, white, grey = (colour for word in ("black", "white", "grey") if (colour := COLOURS.of_word(word)))
    assert (hex_of_rgb(black.prototype), hex_of_rgb(white.prototype)) == (
        XKCD_COLORS["xkcd:black"],
        XKCD_COLORS["xkcd:white"],
    )
    assert black.covariance == white.covariance == grey.covariance


def test_a_colour_may_be_added() -> None:
    more = load_ontology(PREFIXES + TEAL, PREFIXES + 'dx:red skos:altLabel "ruby" .')
    found, ruby = more.colours.of_word("petrol"), more.colours.of_word("ruby")
    assert found is not None and ruby is not None
    assert (found.prototype, ruby.label) == ((0, 128, 128), "red")


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (("#008080", "teal"), "a prototype must be written as #rrggbb, got 'teal'"),
        (("100 0 0 100 0 100", "100 100"), "a spread must be six numbers"),
        (("100 0 0 100 0 100", "a b c d e f"), "a spread must be six numbers"),
        (("100 0 0 100 0 100", "100 200 0 100 0 100"), "must be a positive definite matrix"),
        (("100 0 0 100 0 100", "nan 0 0 100 0 100"), "must be a positive definite matrix"),
    ],
)
def test_an_error_names_the_wrong_part_of_a_colour(wrong: tuple[str, str], message: str) -> None:
    with pytest.raises(OntologyError, match=message):
        load_ontology(PREFIXES + TEAL.replace(*wrong))
