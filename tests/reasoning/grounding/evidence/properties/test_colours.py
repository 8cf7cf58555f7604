"""Evidence of colours for matches."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from matplotlib.colors import XKCD_COLORS
from numpy.typing import NDArray
from scipy.stats import multivariate_normal

from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.ontology.things.colours import rgb_of_hex
from deixis.reasoning.errors import SettingError
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.evidence.evidence import evidence_from
from deixis.reasoning.grounding.evidence.properties.colours import OUTLIERS, colour_evidence, lab_of_srgb, other_colours
from deixis.reasoning.grounding.evidence.properties.unary import UnaryWeights
from deixis.reasoning.grounding.evidence.words.meaning import Meaning

ONTOLOGY = default_ontology()
COLOURS = ONTOLOGY.colours
UNKNOWN = (np.nan, np.nan, np.nan)


def iri(word: str) -> str:
    colour = COLOURS.of_word(word)
    assert colour is not None
    return colour.iri


def seen(*given: str | None) -> NDArray[np.float64]:
    return np.array([UNKNOWN if text is None else rgb_of_hex(text) for text in given], dtype=np.float64)


TABLE = seen("#c02020", "#e6e2da", "#1e3a6e", "#f4f4f0", "#3c7a3c")


@pytest.mark.parametrize(
    ("rgb", "lab"),
    [  # Lindbloom's calculator, D65, to one place
        ((255, 0, 0), (53.2, 80.1, 67.2)),
        ((0, 255, 0), (87.7, -86.2, 83.2)),
        ((0, 0, 255), (32.3, 79.2, -107.9)),
        ((128, 128, 128), (53.6, 0.0, 0.0)),
        ((0, 0, 0), (0.0, 0.0, 0.0)),
    ],
)
def test_cielab_of_srgb(rgb: tuple[float, ...], lab: tuple[float, ...]) -> None:
    assert lab_of_srgb(np.array(rgb, dtype=np.float64)) == pytest.approx(np.array(lab), abs=0.06)


def test_each_word_speaks_for_the_thing_that_people_call_so() -> None:
    words = ["red", "blue", "green"]
    found = colour_evidence([iri(word) for word in words], TABLE, COLOURS)
    assert found.argmax(axis=1).tolist() == [0, 2, 4]
    assert (np.sort(found, axis=1)[:, -2] < 0).all()


def test_most_names_of_the_survey_get_the_word_that_they_end_in() -> None:
    labels = [colour.label for colour in COLOURS.basic]
    known = [(name.split()[-1], value) for name, value in XKCD_COLORS.items()]
    known = [(word.removeprefix("xkcd:"), value) for word, value in known if word.removeprefix("xkcd:") in labels]
    found = colour_evidence(
        [colour.iri for colour in COLOURS.basic], seen(*(str(value) for _, value in known)), COLOURS
    )
    right = [labels[best] == word for best, (word, _) in zip(found.argmax(axis=0), known, strict=True)]
    assert len(right) == 558
    assert np.mean(right) > 0.88


def test_other_colour_needs_a_clear_difference() -> None:
    said = [iri("red"), iri("orange"), iri("red"), iri("blue"), None]
    found = other_colours(said, seen("#c02020", "#f04818", "#1e3a6e", None, "#1e3a6e"), COLOURS)
    assert [colour and colour.label for colour in found] == [None, None, "blue", None, None]


def test_each_prototype_differs_from_all_other_colours() -> None:
    prototypes = np.array([colour.prototype for colour in COLOURS.basic], dtype=np.float64)
    for said in COLOURS.basic:
        found = other_colours([said.iri] * len(prototypes), prototypes, COLOURS)
        assert found == [None if seen_as == said else seen_as for seen_as in COLOURS.basic]


def test_a_narrower_term_speaks_for_its_shade() -> None:
    blues = seen("#042451", "#5b7abf", "#c02020")
    navy, blue = colour_evidence([iri("navy"), iri("blue")], blues, COLOURS)
    assert navy[0] > 0 > navy[1] > navy[2] - 0.5
    assert blue.argmax() == 1
    assert colour_evidence([iri("blue")], blues, COLOURS)[0, 0] > 0


def test_impure_whites_are_about_equally_white() -> None:
    (found,) = colour_evidence([iri("white")], TABLE, COLOURS)
    assert found[1] == pytest.approx(found[3], abs=0.1)
    assert min(found[1], found[3]) > 0.5 > 0 > found[[0, 2, 4]].max()


def test_the_only_thing_of_a_colour_gets_more_than_one_of_many() -> None:
    alone = colour_evidence([iri("red")], seen("#c02020", *["#1e3a6e"] * 5), COLOURS)[0, 0]
    many = colour_evidence([iri("red")], seen(*["#c02020"] * 5, "#1e3a6e"), COLOURS)[0, 0]
    all_alike = colour_evidence([iri("red")], seen(*["#c02020"] * 60), COLOURS)[0, 0]
    assert alone > many > all_alike > 0
    assert all_alike == pytest.approx(0, abs=0.05)


def test_nothing_is_said_where_no_colour_is_described_or_seen() -> None:
    found = colour_evidence([None, iri("red")], np.concatenate([TABLE, seen(None)]), COLOURS)
    assert (found[0] == 0).all() and found[1, -1] == 0
    assert (colour_evidence([iri("red")], seen(None, None), COLOURS) == 0).all()
    assert colour_evidence([iri("red")], np.zeros((0, 3)), COLOURS).shape == (1, 0)
    assert colour_evidence([], TABLE, COLOURS).shape == (0, 5)


@settings(max_examples=50, deadline=None)
@given(arrays(np.float64, st.tuples(st.integers(1, 6), st.just(3)), elements=st.floats(0, 255)))
def test_colour_evidence_is_bounded_both_ways(rgb: NDArray[np.float64]) -> None:
    found = colour_evidence([colour.iri for colour in COLOURS], rgb, COLOURS)
    least_share = 1 / len(COLOURS) / (len(rgb) + 1)
    assert found.min() >= np.log(OUTLIERS) - 1e-9
    assert found.max() <= np.log((1 - OUTLIERS) / least_share + OUTLIERS) + 1e-9


def test_evidence_is_the_ratio_of_densities_as_scipy_gives_them() -> None:
    lab = lab_of_srgb(TABLE)
    dense = np.array(
        [multivariate_normal(lab_of_srgb(np.array(c.prototype, float)), c.matrix()).pdf(lab) for c in COLOURS.basic]
    )
    shares = ((dense / dense.sum(axis=0)).sum(axis=1) + 2 / 11) / 7  # a sixth thing is of no known colour
    wanted = np.log((1 - OUTLIERS) * dense / (shares @ dense) + OUTLIERS)
    found = colour_evidence([c.iri for c in COLOURS.basic], np.concatenate([TABLE, seen(None)]), COLOURS)
    assert found[:, :5] == pytest.approx(wanted)


def test_colours_weigh_as_stated_and_move_with_their_things() -> None:
    graph = RelationGraph.from_facts(ONTOLOGY.relations, ["a", "b"], [], colours=[iri("red"), None])
    boxes = np.array([[[i, 0.0], [i + 0.5, 0.5]] for i in range(5)])
    scene = scene_relations(tuple("vwxyz"), boxes, ONTOLOGY.relations)

    def unary(weight: float) -> NDArray[np.float64]:
        meaning = Meaning(weights=UnaryWeights(colours=weight))
        labels = [None] * 5
        known = (ONTOLOGY.kinds, ONTOLOGY.sizes)
        evidence = evidence_from(graph, scene, labels, *known, meaning=meaning, seen=TABLE, colours=COLOURS)
        order = np.array([4, 3, 2, 1, 0])
        turned = evidence.reordered(np.array([1, 0]), order)
        assert (turned.unary == evidence.unary[::-1, order]).all()
        return evidence.unary

    alone = colour_evidence(graph.colours, TABLE, COLOURS)
    assert unary(2.0) - unary(0.0) == pytest.approx(2 * alone)
    assert unary(1.0)[0].argmax() == 0
    with pytest.raises(SettingError):
        UnaryWeights(colours=-1.0)
