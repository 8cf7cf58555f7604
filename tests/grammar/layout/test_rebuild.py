"""A learned layout written as a script: reading it gives the same facts."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from random_scripts import scripts

from deixis.grammar.layout.format import layout_script
from deixis.grammar.layout.parser import parse_script
from deixis.grammar.script import Script
from deixis.learning.lessons.lesson import layout_concept
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact
from deixis.ontology.lessons.read import layouts
from deixis.ontology.tbox import default_ontology


def qualified(script: Script) -> list[tuple[str, bool, bool, float]]:
    stated: list[Fact | Claim] = [*script.graph().facts(), *script.claims]
    return [(str(f), f.positive, f.optional, f.weight) for f in stated]


@settings(deadline=None, max_examples=100)
@given(scripts(claims=True))
def test_a_learned_layout_is_read_back_unchanged(script: Script) -> None:
    concept = layout_concept(script, "x-1")
    again = parse_script(layout_script(concept, default_ontology()))
    assert qualified(again) == qualified(script)
    assert again.kinds == script.kinds
    assert again.colours == script.colours
    assert (again.title, again.viewpoint, again.surface) == (script.title, script.viewpoint, script.surface)


@pytest.mark.parametrize("text", ["red_fork is red", "red_fork is red; knife left of spoon", "fork is a plate"])
def test_unrelated_declared_objects_are_kept(text: str) -> None:
    again = parse_script(layout_script(layout_concept(parse_script(text), "x-1"), default_ontology()))
    assert again.colours == parse_script(text).colours
    assert again.objects == parse_script(text).objects


def test_the_layout_has_one_fact_per_line() -> None:
    script = parse_script(
        'layout t "T" seen from chair\nx is a Fork\n2 glass above x; maybe x not left of y', file="t.layout"
    )
    assert layouts([], default_ontology().relations) == ()
    assert layout_script(layout_concept(script, "t-1"), default_ontology()).splitlines() == [
        'layout t "T" seen from chair',
        "",
        "x is a Fork",
        "",
        "glass_1 above x",
        "glass_2 above x",
        "maybe x not left of y",
    ]
