"""Claims checked in a scene: their verdicts, what was measured, and their denials."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.grammar.layout.parser import parse_script
from deixis.ontology.graph.claims import Claim
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.poses import Poses
from deixis.reasoning.grounding.answers.claims import ClaimOutcome, ClaimVerdict, check_claims
from deixis.reasoning.grounding.evidence.words.meaning import shipped_models

THINGS = {  # minimum and maximum in metres, on a table of 70 by 50 cm
    "plate": ((0.20, 0.10, 0.0), (0.44, 0.34, 0.02)),
    "fork": ((0.15, 0.12, 0.0), (0.18, 0.32, 0.01)),
    "knife": ((0.46, 0.12, 0.0), (0.48, 0.32, 0.01)),
    "cup": ((0.60, 0.40, 0.0), (0.68, 0.48, 0.09)),
    "jar": ((0.02, 0.40, 0.0), (0.10, 0.48, 0.08)),
    "grape": ((0.31, 0.21, 0.02), (0.33, 0.23, 0.04)),
}
NAMES = tuple(THINGS)
BOXES = np.array([THINGS[name] for name in NAMES])


def checked(claim: Claim, boxes: np.ndarray | None = BOXES, metric: bool = True) -> ClaimOutcome:
    words = default_ontology().relations
    filled = {name: name for name in NAMES}
    return check_claims([claim], filled, NAMES, boxes, words, shipped_models(), metric)[0]


@pytest.mark.parametrize(
    ("text", "verdict", "measured"),
    [
        ("cup at the far right corner", "satisfied", "92% of the free width is left of it"),
        ("cup at the near edge", "violated", "91% of the free depth is nearer than it"),
        ("grape at the middle of the plate", "satisfied", "on plate, it is 50% of the way"),
        ("cup at the left end of the plate", "violated", "it is 17.09 cm away from plate"),
        ("fork about 2 cm from plate", "satisfied", "2 cm from plate"),
        ("cup about 2 cm from plate", "violated", "about 2 cm was stated"),
        ("jar at most 3 cm from fork", "violated", "9.43 cm from fork (24.38 cm between the centres)"),
        ("cup at least 10 cm from plate", "satisfied", "17.09 cm"),
        ("plate between fork and knife", "satisfied", "51% of the way from fork to knife"),
        ("cup between fork and plate", "violated", "of the way from fork to plate"),
        ("plate among fork, knife", "satisfied", "in their midst"),
        ("cup closer to knife than jar", "satisfied", "jar is"),
        ("cup farther from knife than jar", "violated", "jar is"),
        ("cup closer to the far edge than plate", "satisfied", ""),
        ("cup is the tallest", "satisfied", "it measures 9 cm, jar 8 cm"),
        ("jar is tallest", "violated", "it measures 8 cm, cup 9 cm"),
        ("jar is the tallest of plate, fork", "satisfied", ""),
        ("jar is tallest at the left", "satisfied", ""),
        ("jar is second from the left", "violated", "number 1 of 6"),
        ("cup is last from the left of fork, knife", "satisfied", "number 3 of 3"),
        ("fork, plate, knife in a row from left to right", "satisfied", "off a line"),
        ("knife, plate, fork in a row from left to right", "violated", "not in the order"),
        ("fork, jar, knife, cup in a row", "violated", "off a line"),
        ("fork, jar, cup in a circle", "satisfied", "from their middle"),
        ("fork, plate, knife in a circle", "violated", "from their middle"),
        ("cup, jar near each other", "violated", "50 cm apart"),
        ("nothing on plate", "violated", "grape is there"),
        ("nothing on jar", "satisfied", "nothing is there"),
        ("nothing between fork, knife", "violated", "is there"),
        ("cup on surface", "satisfied", "0 cm above the lowest"),
        ("grape on surface", "violated", "2 cm above the lowest"),
        ("fork parallel to the left edge", "satisfied", "it extends 3 cm by 20 cm"),
        ("jar has contents coffee", "undecidable", "boxes do not show the contents"),
        ("cup pointing to the left", "undecidable", "boxes have no direction"),
        ("cup near unseen wall", "undecidable", "'wall' is not among the objects"),
        ("plate is big", "undecidable", "relative to the usual size"),
        ("spoon at the left", "open", "not found: spoon"),
        ("optional jar is tallest", "waived", ""),
        ("cup, fork have count 2", "satisfied", "2 found"),
    ],
)
def test_verdicts(text: str, verdict: str, measured: str) -> None:
    found = checked(parse_script(text).claims[0])
    assert found.verdict.value == verdict, found
    assert measured in found.measured


@given(st.sampled_from(NAMES), st.sampled_from(NAMES), st.floats(0.001, 2))
def test_a_denied_claim_has_the_opposite_verdict(subject: str, other: str, metres: float) -> None:
    opposite = {ClaimVerdict.SATISFIED: ClaimVerdict.VIOLATED, ClaimVerdict.VIOLATED: ClaimVerdict.SATISFIED}
    if subject == other:
        return
    for term, value, length in (("distance", None, metres), ("nearest", None, None), ("end", "left", None)):
        said, denied = (
            checked(Claim(term, (subject,), (other,), value, length, positive=positive)) for positive in (True, False)
        )
        assert denied.verdict is opposite[said.verdict]
        assert said.degree is not None
        assert denied.degree is not None
        assert said.degree + denied.degree == pytest.approx(1)


def test_pictures_have_no_distances_and_no_boxes_decide_nothing() -> None:
    claim = Claim("distance", ("fork",), ("plate",), metres=0.02)
    assert checked(claim, metric=False).measured == "the scene is not in metres"
    assert checked(claim, None).verdict is ClaimVerdict.UNDECIDABLE
    assert checked(Claim("tallest", ("cup",)), BOXES[:, :, :2]).measured == "the scene has no heights"


def aimed(text: str, fronts: dict[str, tuple[float, float]], heads: dict[str, tuple[float, float]]) -> ClaimOutcome:
    ways = [np.array([known.get(name, (np.nan, np.nan)) for name in NAMES]) for known in (fronts, heads)]
    poses = replace(Poses.of_boxes(BOXES, ways[0]), heads=ways[1])
    filled, words = {name: name for name in NAMES}, default_ontology().relations
    (claim,) = parse_script(text).claims
    return check_claims([claim], filled, NAMES, BOXES, words, shipped_models(), poses=poses)[0]


@pytest.mark.parametrize(
    ("text", "head", "verdict", "measured"),
    [
        ("fork pointing away", (0.0, 1.0), "satisfied", "it points 0"),
        ("fork pointing away", (0.0, -1.0), "violated", "it points 180"),
        ("fork pointing left", (0.0, 1.0), "violated", "it points 90"),
        ("fork pointing away", None, "undecidable", "which of its ends"),
        ("fork pointing left", None, "violated", "it lies 90"),
        ("fork facing left", (0.0, 1.0), "undecidable", "which of its sides"),
        ("fork facing left", (1.0, 0.0), "violated", "it points 180"),
        ("fork facing left", None, "undecidable", "its direction is not known"),
        ("fork with its handle to the viewer", (0.0, 1.0), "satisfied", "its handle points 0"),
        ("fork with its handle to the plate", (1.0, 0.0), "violated", "away from 'plate'"),
        ("fork with its tines to the plate", (1.0, 0.0), "satisfied", "away from 'plate'"),
        ("plate pointing left", None, "undecidable", "its direction is not known"),
    ],
)
def test_direction_of_a_long_thing_is_checked(
    text: str, head: tuple[float, float] | None, verdict: str, measured: str
) -> None:
    found = aimed(text, {}, {} if head is None else {"fork": head})
    assert found.verdict == verdict and measured in found.measured


def test_front_of_a_cup_decides_what_it_faces() -> None:
    assert aimed("cup facing left", {"cup": (-1.0, 0.2)}, {}).verdict == "satisfied"
    assert aimed("cup facing left", {"cup": (1.0, 0.2)}, {}).verdict == "violated"
