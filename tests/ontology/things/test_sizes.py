"""Usual sizes: every kind has one with a source, within the range of its broader kinds."""

from __future__ import annotations

import pytest

from deixis.errors import OntologyError
from deixis.ontology.rdf.vocabulary import BASE, DX
from deixis.ontology.tbox import default_ontology, load_ontology
from deixis.ontology.things.kinds import Kind
from deixis.ontology.things.sizes import Extent, Outline, Sizes

ONTOLOGY = default_ontology()
KINDS, SIZES = ONTOLOGY.kinds, ONTOLOGY.sizes
TABLEWARE, SURFACE = f"{BASE}Tableware", f"{BASE}Surface"
PREFIX = "@prefix dx: <https://w3id.org/deixis/onto#> .\n"
OWL = "@prefix owl: <http://www.w3.org/2002/07/owl#> . @prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .\n"


def kind(word: str) -> Kind:
    found = KINDS.of_word(word)
    assert found is not None
    return found


@pytest.mark.parametrize("some", list(KINDS), ids=lambda some: some.name)
def test_every_kind_has_a_size_with_a_source_and_ordered_sides(some: Kind) -> None:
    size = SIZES.of(some.iri)
    assert size.source
    assert size.stated_of == some.iri or size.stated_of in some.broader
    assert size.width.typical <= size.length.typical
    assert size.width.least <= size.length.least
    assert size.width.greatest <= size.length.greatest
    assert (size.width == size.length) == (size.outline is Outline.CIRCLE)


@pytest.mark.parametrize(
    "some", [some for some in KINDS if some.broader - {DX.THING.value}], ids=lambda some: some.name
)
def test_the_size_of_a_kind_lies_within_that_of_broader_kinds(some: Kind) -> None:
    size = SIZES.of(some.iri)
    for iri in some.broader - {DX.THING.value}:
        above = SIZES.of(iri)
        for narrow, broad in ((size.length, above.length), (size.width, above.width), (size.height, above.height)):
            assert broad.least <= narrow.least
            assert narrow.greatest <= broad.greatest, f"{some.name} under {iri}"


def test_sizes_are_those_of_the_sources() -> None:
    """Dinner plates of 9 to 12 inches, soup spoons about 7 inches long, wine bottles 7.5 cm across and 30 cm high."""
    plate, spoon = SIZES.of(kind("dinner plate").iri), SIZES.of(kind("soup spoon").iri)
    assert (plate.length.least, plate.length.greatest) == pytest.approx((9 * 0.0254, 12 * 0.0254), abs=1e-3)
    assert spoon.length.typical == pytest.approx(7 * 0.0254, abs=1e-3)
    bottle = SIZES.of(kind("wine bottle").iri)
    assert bottle.length.admits(0.075)
    assert bottle.height.admits(0.3)


def test_a_soup_spoon_does_not_have_the_size_of_a_plate() -> None:
    spoon, plate = SIZES.of(kind("soup spoon").iri), SIZES.of(kind("plate").iri)
    assert spoon.width.greatest < plate.width.least


def test_a_kind_without_a_size_takes_that_of_a_broader_kind() -> None:
    assert SIZES.of(kind("salt shaker").iri) == SIZES.of(kind("shaker").iri)
    extra = load_ontology(
        PREFIX + OWL + "dx:Ladle a owl:Class ; rdfs:label 'ladle' ; rdfs:subClassOf dx:Spoon ."
        "dx:SilverLadle a owl:Class ; rdfs:label 'silver ladle' ; rdfs:subClassOf dx:Ladle ."
    )
    assert extra.sizes.of(extra.kinds.of_word("silver ladle").iri).stated_of == kind("spoon").iri  # type: ignore[union-attr]


@pytest.mark.parametrize("some", [k for k in KINDS if k.broader & {TABLEWARE, SURFACE}], ids=lambda some: some.name)
def test_an_unknown_thing_may_have_any_size_of_known_kinds(some: Kind) -> None:
    unknown, size = SIZES.of(None), SIZES.of(some.iri)
    assert unknown == SIZES.of("https://example.org/Gadget")
    for narrow, broad in ((size.length, unknown.length), (size.width, unknown.width), (size.height, unknown.height)):
        assert broad.least <= narrow.least and narrow.greatest <= broad.greatest


@pytest.mark.parametrize(
    ("smaller", "larger"),
    [("computer mouse", "keyboard"), ("cat", "horse"), ("shoe", "person"), ("car", "bus"), ("bush", "tree")],
)
def test_everyday_things_are_in_order_of_size(smaller: str, larger: str) -> None:
    small, large = SIZES.of(kind(smaller).iri), SIZES.of(kind(larger).iri)
    assert small.length.typical * small.height.typical < large.length.typical * large.height.typical


def test_kinds_with_a_handle_have_a_reach() -> None:
    reach = SIZES.of(kind("mug").iri).reach
    assert reach is not None and 0.3 <= reach.least <= reach.typical <= reach.greatest <= 0.5
    assert SIZES.of(kind("dinner plate").iri).reach is None


def test_a_size_in_an_extra_text_is_used() -> None:
    numbers = " ; ".join(
        f"dx:{which}{end} {metres}"
        for end in ("Length", "Height")
        for which, metres in (("least", 0.1), ("typical", 0.2), ("greatest", 0.3))
    )
    source = "<http://purl.org/dc/terms/source> 'measured'"
    extra = load_ontology(f"{PREFIX} dx:SaltShaker dx:outline 'circle' ; {numbers} ; {source} .")
    assert extra.sizes.of(kind("salt shaker").iri).width == Extent(0.1, 0.2, 0.3)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("dx:SaltShaker dx:outline 'star' .", "an outline must be one of circle, rectangle, got 'star'"),
        ("dx:SaltShaker dx:outline 'circle' .", "must have exactly one <https://w3id.org/deixis/onto#leastLength>"),
        ("dx:Mug dx:typicalLength 2.0 .", "must have exactly one <https://w3id.org/deixis/onto#typicalLength>"),
        (
            "dx:SaltShaker dx:outline 'circle' ; dx:leastLength 1.0 ; dx:typicalLength 0.5 ; dx:greatestLength 2.0 .",
            "must be above 0 and in that order",
        ),
        ("dx:Bowl dx:typicalReach 0.2 .", "must have exactly one <https://w3id.org/deixis/onto#leastReach>"),
        (
            "dx:SaltShaker dx:outline 'circle' ; dx:leastLength 'wee' ; dx:typicalLength 0.5 ; dx:greatestLength 2.0 .",
            "must be three numbers, got wee",
        ),
    ],
)
def test_an_incomplete_size_is_an_ontology_error(text: str, message: str) -> None:
    with pytest.raises(OntologyError, match=message):
        load_ontology(PREFIX + text)


def test_without_a_size_of_all_things_unknown_things_have_none() -> None:
    with pytest.raises(OntologyError, match="state one"):
        Sizes({}, {}).of(None)
