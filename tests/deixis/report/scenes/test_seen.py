"""Lines of recognised things."""

from __future__ import annotations

import pytest

from deixis.perception.recognition.calibration import SHIPPED
from deixis.perception.recognition.recogniser import Candidate, Recognition
from deixis.perception.recognition.spread import Width, spreads
from deixis.report.scenes.seen import answer_words


def _answer(label: str | None, probability: float, unknown: float) -> Recognition:
    spread = spreads([Width(0.1, 2)], prior=0.1)[0]
    candidate = Candidate("bread plate", 0.1, spread, 0.3, "v1", 1, probability)
    return Recognition(label, (candidate,), unknown, SHIPPED, True, ())


@pytest.mark.parametrize(
    ("label", "probability", "unknown", "words"),
    [
        ("bread plate", 0.9, 0.1, "bread plate          0.90"),
        (None, 0.58, 0.42, "bread plate?         0.58, unknown 0.42"),
        (None, 0.3, 0.7, "unknown              0.70, bread plate 0.30"),
        (None, 0.01, 0.99, "unknown              0.99"),
    ],
)
def test_unnamed_things_list_what_they_may_be_in_order(
    label: str | None, probability: float, unknown: float, words: str
) -> None:
    assert answer_words(_answer(label, probability, unknown)) == words
