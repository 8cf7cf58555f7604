"""Every construct of the language, with the facts that it states and their places in the text."""

from __future__ import annotations

import pytest

from deixis.grammar.errors import ScriptError
from deixis.grammar.layout.parser import parse_script
from deixis.grammar.script import Script
from deixis.ontology.graph.graph import Source
from deixis.ontology.tbox import load_ontology

FIGURE_7 = """\
right(water_glass, dinner_plate)
top_left(bread_plate, dinner_plate)
top(dessert_fork, dinner_plate)
top(dessert_spoon, dinner_plate)
left(salad_fork, dinner_plate)
left(dinner_fork, dinner_plate)
right(dinner_knife, dinner_plate)
right(fish_knife, dinner_plate)
right(soup_spoon, fish_knife)
on(napkin, dinner_plate)
on(butter_knife, bread_plate)
"""


def facts(text: str) -> list[str]:
    return [str(fact) for fact in parse_script(text).facts]


def test_figure_7() -> None:
    script = parse_script(FIGURE_7)
    assert [str(fact) for fact in script.facts] == FIGURE_7.splitlines()
    assert len(script.objects) == 12
    assert [fact.source.line for fact in script.facts if fact.source] == list(range(1, 12))
    assert len(script.graph()) == 11


@pytest.mark.parametrize(
    ("text", "stated"),
    [
        ("napkin on dinner_plate", ["on(napkin, dinner_plate)"]),
        ("the bread plate is at the top left of the dinner plate.", ["top_left(bread_plate, dinner_plate)"]),
        ("a, b left of c", ["left(a, c)", "left(b, c)"]),
        ("a and b above c, and d", ["top(a, c)", "top(a, d)", "top(b, c)", "top(b, d)"]),
        ("x right of or top right of y", ["right or top_right(x, y)"]),
        ("x right of or to the right of y", ["right(x, y)"]),
        ("right or top_right(x, y)", ["right or top_right(x, y)"]),
        ("left(x, y) or top(x, y)", ["left or top(x, y)"]),
        ("not left(x, y); x is not left of y", ["not left(x, y)", "not left(x, y)"]),
        ("left to right: a, b, c", ["left(a, b)", "left(b, c)"]),
        ("bottom right to top left: a, b", ["bottom_right(a, b)"]),
        ("above to below: a and b", ["top(a, b)"]),
        ("left to right: 2 glass, plate", ["left(glass_1, glass_2)", "left(glass_2, plate)"]),
        ("2 glass above x", ["top(glass_1, x)", "top(glass_2, x)"]),
        ("the two glass above x; glass_1 on y", ["top(glass_1, x)", "top(glass_2, x)", "on(glass_1, y)"]),
        ("2 glass on x; 2 Glass on y", [f"on(glass_{i}, {o})" for o in "xy" for i in (1, 2)]),
        ("left(a, b)", ["left(a, b)"]),
        ("a left of b", ["left(a, b)"]),
        ("a left of the a b", ["left(a, b)"]),
        ('"left shoe" on "the"', ["on(left_shoe, the)"]),
        ("left_glass on left-handed_fork", ["on(left_glass, left-handed_fork)"]),
        ("onion left of leftmost", ["left(onion, leftmost)"]),
        ("spoon to the right of plate", ["right(spoon, plate)"]),
        ("Fork on plate; fork left of PLATE", ["on(Fork, plate)", "left(Fork, plate)"]),
        ("fork TO THE Left_Of plate", ["left(fork, plate)"]),
        ("fork directly left of plate", ["exactly_left(fork, plate)"]),
        ("bread and butter plate left of x", ["left(bread_and_butter_plate, x)"]),
        ("a is placed on b; a sits on b; a, b are laid above c", ["on(a, b)", "on(a, b)", "top(a, c)", "top(b, c)"]),
        ("löffel links on größe", ["on(löffel_links, größe)"]),
        ("cafe\u0301 on x", ["on(café, x)"]),
        ("a left of b,  # first\n\n  # between\n  c\nd on e", ["left(a, b)", "left(a, c)", "on(d, e)"]),
        ("a on b; ; c on d..\n;", ["on(a, b)", "on(c, d)"]),
        ("\ufeffa on b\r\nc on d\r\n", ["on(a, b)", "on(c, d)"]),
        ("a\ton\u00a0b", ["on(a, b)"]),
        ("", []),
        ("# nothing", []),
    ],
)
def test_stated_facts(text: str, stated: list[str]) -> None:
    assert facts(text) == stated


@pytest.mark.parametrize(
    ("text", "positive", "optional", "weight"),
    [
        ("fork left of plate", True, False, 1.0),
        ("usually fork left of plate", True, False, 0.8),
        ("the fork is usually left of the plate", True, False, 0.8),
        ("the fork is maybe placed left of the plate", True, False, 0.5),
        ("fork usually goes left of plate", True, False, 0.8),
        ("maybe left(fork, plate)", True, False, 0.5),
        ("optional fork left of plate", True, True, 1.0),
        ("optional usually not left(fork, plate)", False, True, 0.8),
        ("not usually optional left(fork, plate)", False, True, 0.8),
        ("optional fork is usually not left of plate", False, True, 0.8),
        ("usually left to right: fork, plate", True, False, 0.8),
    ],
)
def test_modifiers(text: str, positive: bool, optional: bool, weight: float) -> None:
    (fact,) = parse_script(text).facts
    assert (fact.positive, fact.optional, fact.weight) == (positive, optional, weight)
    assert (fact.subject, fact.relations[0].name, fact.object) == ("fork", "left", "plate")


def declared(script: Script) -> dict[str, str]:
    return {name: kind.name for name, kind in script.kinds.items()}


def test_declarations() -> None:
    script = parse_script(
        "soup_spoon is a Spoon; f1, f2 are forks; 2 x are glasses; a is a plate; k is the dinner knife"
    )
    assert declared(script) == {
        **{"soup_spoon": "Spoon", "f1": "Fork", "f2": "Fork", "x_1": "Glass", "x_2": "Glass", "a": "Plate"},
        "k": "DinnerKnife",
    }
    assert script.objects == ("soup_spoon", "f1", "f2", "x_1", "x_2", "a", "k")


def test_the_narrower_declaration_holds() -> None:
    assert declared(parse_script("x is a DinnerFork; x is a Fork; x is a thing")) == {"x": "DinnerFork"}


def coloured(script: Script) -> dict[str, str]:
    return {name: colour.label for name, colour in script.colours.items()}


def test_colours_are_declared_like_kinds() -> None:
    script = parse_script("napkin is red; the plate is dark blue; x is a white mug; 2 y are gray; x, z are white")
    colours = {"napkin": "red", "plate": "blue", "x": "white", "y_1": "grey", "y_2": "grey", "z": "white"}
    assert coloured(script) == colours
    assert declared(script) == {"x": "Mug"}
    assert script.facts == ()


def test_kind_and_colour_in_separate_statements() -> None:
    script = parse_script("x is a mug; x is red; x is a red thing; x left of y")
    assert (coloured(script), declared(script)) == ({"x": "red"}, {"x": "Mug"})


def test_a_name_may_begin_with_its_colour() -> None:
    script = parse_script(
        "the red mug left of red_wine_glass; 2 green_plate on mat; orange on mat; white_wine is yellow"
    )
    colours = {"red_mug": "red", "green_plate_1": "green", "green_plate_2": "green", "white_wine": "yellow"}
    assert coloured(script) == colours


def test_the_kind_of_a_name_after_its_colour() -> None:
    graph = parse_script("the red mug left of blue thingummy").graph()
    assert [kind and kind.rpartition("#")[2] for kind in graph.kinds] == ["Mug", None]
    assert [colour and colour.rpartition("#")[2] for colour in graph.colours] == ["red", "blue"]


def test_no_colours_in_the_script_give_none_in_the_graph() -> None:
    assert parse_script("fork left of plate").graph().colours == ()


def test_header() -> None:
    script = parse_script('layout formal dinner "Formal dinner" seen from the chair\na on b')
    assert (script.name, script.title, script.viewpoint) == ("formal_dinner", "Formal dinner", "chair")
    assert parse_script('layout "T"').title == "T"
    assert parse_script("layout seen from chair").viewpoint == "chair"
    assert parse_script("a on b").name is None


def test_kinds_in_the_graph() -> None:
    graph = parse_script("2 wine_glass above thingummy; salt is a Candle; salt on fork").graph()
    kinds = [kind.rpartition("#")[2] if kind else None for kind in graph.kinds]
    assert dict(zip(graph.nodes, kinds, strict=True)) == {
        **{"wine_glass_1": "WineGlass", "wine_glass_2": "WineGlass", "thingummy": None},
        **{"salt": "Candle", "fork": "Fork"},
    }


def test_a_synonym_in_the_ontology_is_a_word_of_the_language() -> None:
    prefixes = """@prefix dx: <https://w3id.org/deixis/onto#> .
        @prefix skos: <http://www.w3.org/2004/02/skos/core#> ."""
    more = load_ontology(prefixes + 'dx:left skos:altLabel "to port of" . dx:maybe skos:altLabel "with some luck" .')
    (fact,) = parse_script("fork is with some luck to the port of the plate", ontology=more).facts
    assert (str(fact), fact.weight) == ("left(fork, plate)", 0.5)
    with pytest.raises(ScriptError):
        parse_script("fork to port of plate")


@pytest.mark.parametrize(
    ("text", "span"),
    [
        ("a on b", (1, 1, 1, 7)),
        ("  the a on the b  ", (1, 7, 1, 17)),
        ("# one\r\n\ta on b # two\r\n", (2, 2, 2, 8)),
        ("x on y; a on b.", (1, 9, 1, 15)),
        ("a on\u00a0b", (1, 1, 1, 7)),
        ("a on b,\n  c", (1, 1, 2, 4)),
    ],
)
def test_spans(text: str, span: tuple[int, int, int, int]) -> None:
    assert parse_script(text, "f.layout").facts[-1].source == Source("f.layout", *span)


def test_comments() -> None:
    comments = parse_script("# one\na on b  #  two \n  #").comments
    assert [(c.text, c.own_line, c.source.line, c.source.column) for c in comments] == [
        ("one", True, 1, 1),
        ("two", False, 2, 9),
        ("", True, 3, 3),
    ]


def test_all_errors_are_reported_at_once() -> None:
    with pytest.raises(ScriptError) as caught:
        parse_script("fork\na on b\na on a\nc ? d; e on\nf on g")
    assert [(p.source.line, p.source.column) for p in caught.value.problems] == [(1, 1), (3, 6), (4, 3), (4, 12)]


def test_fifty_errors_are_shown_and_the_rest_counted() -> None:
    with pytest.raises(ScriptError) as caught:
        parse_script("fork\n" * 60)
    assert len(caught.value.problems) == 60
    assert str(caught.value).endswith("\n… and 10 more")
    assert str(caught.value).count("this statement says nothing") == 50
