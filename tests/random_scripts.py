"""Random layout scripts for property tests: text from random statements, in all the forms that the language has."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from deixis.grammar.errors import ScriptError
from deixis.grammar.parser import parse_script
from deixis.grammar.script import Script
from deixis.ontology.tbox import default_ontology

ONTOLOGY = default_ontology()


def meaning(script: Script) -> tuple[Any, ...]:
    """Return the content of a script, without source positions."""
    facts = [(str(f), f.positive, f.optional, f.weight) for f in script.facts]
    kinds = {name: kind.iri for name, kind in script.kinds.items()}
    colours = {name: colour.iri for name, colour in script.colours.items()}
    return facts, script.objects, kinds, colours, script.name, script.title, script.viewpoint


WORD = st.sampled_from(
    ["fork", "knife", "Plate", "glass", "löffel", "x2", "left-handed", "a", "napkin", "leftmost", "tea", "皿", "red"]
)
PLAIN = st.lists(WORD, min_size=1, max_size=3).map(" ".join)
QUOTED = st.sampled_from(
    ["left", "to the", "is", "the", "2nd", "a?b", "x, y", "Usually", "of", "spoon#", "a.b", "upper", "in front"]
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
END = st.sampled_from(["\n", "\n", "\n\n", ";", ". ", " # note\n", "\n  # alone\n", "\r\n"])
HEADER = st.sampled_from(
    ["", 'layout x "T"\n', "layout seen from chair\n", 'layout big x "A title" seen from "left" # h\n']
)


@st.composite
def scripts(draw: st.DrawFn) -> Script:
    """Draw random statements and make a script of those that parse together."""
    text = draw(HEADER)
    for statement, end in draw(st.lists(st.tuples(STATEMENT, END), max_size=6)):
        try:
            parse_script(text + statement + end)
        except ScriptError:
            continue
        text += statement + end
    return parse_script(text)
