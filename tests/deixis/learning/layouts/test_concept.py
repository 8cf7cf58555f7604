"""Test the concept of several tables: firm, hedged and optional statements, distances, and their counts."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import permutations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.grammar.layout.format import format_script, layout_script
from deixis.learning.layouts.concept import concept_of
from deixis.learning.layouts.experience import Tally
from deixis.learning.layouts.tables import TaughtTable
from deixis.learning.lessons.lesson import layout_concept
from deixis.ontology.graph.facts import Fact
from deixis.ontology.rdf.triples import turtle
from deixis.ontology.tbox import default_ontology
from deixis.perception.scene import PerceivedObject, Scene
from deixis.workflows.layouts.read import read_script

RELATIONS = default_ontology().relations
TEXT = "layout place; fork left of plate; knife right of plate; cup above plate"


def table(number: int, centres: Mapping[str, tuple[float, float]], text: str = TEXT) -> TaughtTable:
    """Return a table with things of 10 cm around some centres."""
    script = read_script(text=text)
    things = tuple(
        PerceivedObject(role, (x - 0.05, y - 0.05, 0.0), (x + 0.05, y + 0.05, 0.05)) for role, (x, y) in centres.items()
    )
    layout = layout_concept(script, f"place-{number}")
    return TaughtTable(
        f"place-{number}",
        layout,
        format_script(script),
        Scene(things),
        {role: role for role in centres},
        frozenset(centres),
    )


PLATE, FORK, KNIFE, CUP = (0.0, 0.0), (-0.2, 0.0), (0.2, 0.0), (0.0, 0.3)
TABLES = [
    table(1, {"plate": PLATE, "fork": FORK, "knife": KNIFE, "cup": CUP}),
    table(2, {"plate": PLATE, "fork": FORK, "knife": KNIFE}),
    table(3, {"plate": PLATE, "fork": FORK, "knife": (-0.4, 0.0), "cup": (0.2, 0.25)}),
]


def test_counts_make_facts_firm_hedged_or_optional() -> None:
    found = concept_of(TABLES, RELATIONS)
    by_ends = {(f.subject, f.object): f for f in found.layout.facts}
    assert by_ends["fork", "plate"].weight == 1
    assert by_ends["knife", "plate"].weight == pytest.approx((2 + 0.5) / (3 + 1))
    assert by_ends["cup", "plate"].optional
    assert found.optional == {"cup"}
    assert found.filled["cup"] == Tally(2.0, 3.0)
    assert "right(knife, plate): held on 2 of 3 tables" in found.lines()


def test_what_always_held_is_added_and_what_follows_is_not() -> None:
    found = concept_of(TABLES[:2], RELATIONS)
    added = {str(each.statement) for each in found.statements if not each.told}
    assert "distance(fork, plate, 0.1 m)" in added
    assert not any("left(fork, knife)" in each for each in added)  # it follows
    apart = concept_of([TABLES[0], TABLES[2]], RELATIONS)
    assert "left(fork, cup)" in {str(each.statement) for each in apart.statements if not each.told}


def test_one_table_gives_the_layout_of_its_lesson() -> None:
    found = concept_of(TABLES[:1], RELATIONS)
    assert found.layout == TABLES[0].layout
    assert all(each.tally == Tally(1.0, 1.0) for each in found.statements)


places = st.tuples(st.integers(-4, 4), st.integers(-4, 4)).map(lambda xy: (xy[0] / 10, xy[1] / 10))


@settings(max_examples=15, deadline=None)
@given(st.lists(st.fixed_dictionaries({"plate": places, "fork": places, "cup": places}), min_size=3, max_size=3))
def test_order_of_tables_does_not_matter(centres: list[dict[str, tuple[float, float]]]) -> None:
    texts = (TEXT, "layout place; fork left of plate", "layout place; cup left of plate")
    tables = [table(number, *each) for number, each in enumerate(zip(centres, texts, strict=True))]
    found = [concept_of(list(order), RELATIONS) for order in permutations(tables)]
    for other in found[1:]:
        assert other.layout == found[0].layout
        assert other.lessons == found[0].lessons
        assert tuple(other.lines()) == tuple(found[0].lines())


def test_script_and_shapes_and_class_follow_the_counts() -> None:
    found = concept_of(TABLES, RELATIONS)
    text = layout_script(found.layout, default_ontology())
    again = read_script(text=text)
    assert [(f.subject, f.object, f.optional) for f in again.facts if isinstance(f, Fact)] == [
        (f.subject, f.object, f.optional) for f in found.layout.facts
    ]
    assert [claim.metres for claim in again.claims] == [claim.metres for claim in found.layout.claims]
    shapes, owl = turtle(found.shapes()), turtle(found.owl(RELATIONS))
    assert 'sh:description "right(knife, plate): held on 2 of 3 tables"' in shapes
    assert 'sh:description "on 2 of 3 tables"' in shapes
    assert "dx:Fork" in owl
    assert "someValuesFrom" in owl
    assert "someValuesFrom dx:Cup" not in owl
