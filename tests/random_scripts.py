"""Random layout scripts for property tests: text from random statements, in all the forms that the language has."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from deixis.grammar.errors import ScriptError
from deixis.grammar.layout.parser import parse_script
from deixis.grammar.script import Script
from deixis.ontology.tbox import default_ontology

ONTOLOGY = default_ontology()


def meaning(script: Script) -> tuple[Any, ...]:
    """Return the content of a script, without source positions."""
    facts = [(str(f), f.positive, f.optional, f.weight) for f in script.stated]
    kinds = {name: kind.iri for name, kind in script.kinds.items()}
    colours = {name: colour.iri for name, colour in script.colours.items()}
    return facts, script.objects, kinds, colours, script.name, script.title, script.viewpoint, script.surface


WORD = st.sampled_from(
    ["fork", "knife", "Plate", "glass", "löffel", "x2", "left-handed", "a", "napkin", "leftmost", "tea", "皿", "red"]
)
PLAIN = st.lists(WORD, min_size=1, max_size=3).map(" ".join)
QUOTED = st.sampled_from(
    [
        "second",
        "closest",
        "largest",
        "nothing",
        "parallel",
        "left",
        "to the",
        "is",
        "the",
        "2nd",
        "a?b",
        "x, y",
        "Usually",
        "of",
        "spoon#",
        "a.b",
        "upper",
        "in front",
    ]
)
NAME = PLAIN | PLAIN.map(lambda n: "the " + n) | PLAIN.map(lambda n: n.replace(" ", "_")) | QUOTED.map('"{}"'.format)
OBJECT = NAME | st.builds(lambda n, name: f"{n} c{name}", st.sampled_from(["2", "three"]), WORD)
OBJECTS = st.builds(
    lambda names, sep: sep.join(names),
    st.lists(OBJECT, min_size=1, max_size=3),
    st.sampled_from([", ", " and ", ", and ", ",\n # in\n"]),
)
PHRASE = st.sampled_from(sorted(ONTOLOGY.relations.by_word))
RELATIONS = st.lists(PHRASE, min_size=1, max_size=2).map(" or ".join)
FRONT = st.sampled_from(["", "", "usually ", "optional ", "not ", "optional maybe ", "optional not "])
LINK = st.sampled_from(["", " is", " are placed", " not", " is usually", " goes"])
CHAIN = st.sampled_from(["left to right:", "bottom to top:", "above to below :"])
KIND = st.sampled_from(sorted(ONTOLOGY.kinds.words)).filter(lambda w: not {"and", "under"} & set(w.split()))
COLOUR = st.sampled_from(sorted(ONTOLOGY.colours.words))
STATEMENT = st.one_of(
    st.builds(lambda f, s, k, r, o: f"{f}{s}{k} {r} {o}", FRONT, OBJECTS, LINK, RELATIONS, OBJECTS),
    st.builds(lambda f, r, s, o: f"{f}{r}({s}, {o})", FRONT, RELATIONS, OBJECT, OBJECT),
    st.builds(lambda f, c, o: f"{f}{c} {o}", st.sampled_from(["", "usually "]), CHAIN, OBJECTS),
    st.builds(lambda s, k: f"{s} is a {k}", OBJECTS, KIND),
    st.builds(lambda s, c: f"{s} is {c}", OBJECTS, COLOUR),
    st.builds(lambda s, c, k: f"{s} are {c} {k}", OBJECTS, COLOUR, KIND),
)
CLAIM = st.sampled_from(
    [
        *("at the far left corner", "in the middle", "along the near edge", "at an end", "at the far right"),
        *("at the middle of the near edge", "on the surface", "pointing to the right", "parallel to the left side"),
        *("in a row", "in a row from left to right", "in a circle", "near each other", "inside each other"),
        *("second from the left", "the 12th from the right", "the tallest at the front", "upside down"),
        *("has contents hot tea", 'has state "half_open"', "have material wood", "has count 3", 'has colour "x  y"'),
        *("is big", "are empty", "is the tallest", "on tray", "left of unseen door", 'near unseen "the wall"'),
        "closer to the left edge",
    ]
)
CLAIM_OF = st.sampled_from(
    [
        *("at the far left corner of", "in the corner of", "at the middle of the back of", "at the left part of"),
        *("between", "among", "on each side of", "nearest to", "farthest from", "closer to", "the largest of"),
        *("about 2 cm from", "at most 0.125 m from", "more than 7 mm away from", "third from the left of"),
        *("closer to the edge than", "parallel to the near edge of", "at the right end of tray, "),
    ]
)
CLAIMS = st.one_of(
    st.builds(lambda f, s, k, c: f"{f}{s}{k} {c}", FRONT, OBJECTS, LINK, CLAIM),
    st.builds(lambda f, s, c: f"{f}{s} {c}", FRONT, OBJECTS, CLAIM),
    st.builds(lambda f, s, k, c, o: f"{f}{s}{k} {c} {o}", FRONT, OBJECTS, LINK, CLAIM_OF, OBJECTS),
    st.builds(lambda s, o, t: f"{s} closer to {o} than {t}", OBJECTS, OBJECT, OBJECT),
    st.builds(lambda f, r, o: f"{f}nothing {r} {o}", FRONT, PHRASE | st.just("between"), OBJECTS),
)
END = st.sampled_from(["\n", "\n", "\n\n", ";", ". ", " # note\n", "\n  # alone\n", "\r\n"])
HEADER = st.sampled_from(
    [
        "",
        'layout x "T"\n',
        "layout seen from chair\n",
        'layout big x "A title" on tray seen from "left" # h\n',
        "layout on tray\n",
    ]
)


@st.composite
def scripts(draw: st.DrawFn, claims: bool = False) -> Script:
    """Draw random statements, with ``claims`` also these, and make a script of those that parse together."""
    text = draw(HEADER)
    for statement, end in draw(st.lists(st.tuples(STATEMENT | CLAIMS if claims else STATEMENT, END), max_size=6)):
        try:
            parse_script(text + statement + end)
        except ScriptError:
            continue
        text += statement + end
    return parse_script(text)
