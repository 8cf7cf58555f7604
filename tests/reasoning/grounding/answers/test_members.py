import pytest

import deixis
from deixis.grammar.english.reader import read_english
from deixis.reasoning.grounding.answers.answer import Grounding
from deixis.report.json_answers import grounding_to_dict

TRAY: dict[str, object] = {"id": "tray", "label": "tray", "min": [0.0, 0.0, 0.0], "max": [0.4, 0.3, 0.02]}


def thing(name: str, label: str | None, x: float, y: float = 0.1, z: float = 0.02) -> dict[str, object]:
    box: dict[str, object] = {"id": name, "min": [x, y, z], "max": [x + 0.07, y + 0.07, z + 0.12]}
    return box if label is None else {**box, "label": label}


def flat(name: str, label: str, x: float, width: float) -> dict[str, object]:
    return {"id": name, "label": label, "min": [x, 0.0, 0.0], "max": [x + width, 0.2, 0.02]}


def grounded(text: str, *things: dict[str, object]) -> Grounding:
    return deixis.ground(read_english(text), {"objects": list(things)})


def members(found: Grounding, name: str) -> list[str]:
    return sorted(one.perceived for one in found.members.get(name, ()))


TABLE = (TRAY, thing("g1", "glass", 0.05), thing("g2", "glass", 0.25), thing("g3", "glass", 0.9, z=0.0))
JUG = thing("jug", "jug", 0.1, 0.6, 0.0)


def test_plural_without_a_number_is_all_things_that_fit() -> None:
    found = grounded("There are glasses on the tray. The jug is behind the tray.", *TABLE, JUG)
    assert members(found, "glasses") == ["g1", "g2"]
    assert found.matches["glasses"].perceived in ("g1", "g2")
    assert (found.matches["glasses"].probability or 0) > 0.9
    assert [left.name for left in found.unmatched_perceived] == ["g3"]


def test_things_of_other_objects_are_not_members() -> None:
    text = "The glasses are on the tray. The jug is behind the tray. One cup is on the tray too."
    found = grounded(text, *TABLE, JUG, thing("cup", "cup", 0.15))
    assert members(found, "glasses") == ["g1", "g2"]
    assert found.matches["cup"].perceived == "cup"


def test_plurals_are_related_to_some_member_each() -> None:
    plates = [flat("p1", "plate", 0.0, 0.2), flat("p2", "plate", 1.0, 0.2)]
    forks = [flat("f1", "fork", -0.1, 0.02), flat("f2", "fork", 0.9, 0.02)]
    found = grounded("The forks are to the left of the plates.", *plates, *forks)
    assert members(found, "forks") == ["f1", "f2"]


def test_json_lists_the_members_beside_the_match() -> None:
    written = grounding_to_dict(grounded("There are glasses on the tray. The jug is behind the tray.", *TABLE, JUG))
    assert {one["perceived"] for one in written["members"]["glasses"]} == {"g1", "g2"}
    assert all(one["probability"] > 0.9 for one in written["members"]["glasses"])
    assert "members" not in grounding_to_dict(grounded("The jug is behind the tray.", *TABLE, JUG))


@pytest.mark.parametrize(
    ("text", "uncounted"),
    [
        ("The glasses are on the tray.", ("glasses",)),
        ("The wine glasses are on the tray.", ("wine_glasses",)),
        ("My glasses are on the tray.", ()),
        ("The scissors are on the tray.", ()),
        ("Two cups are on the tray.", ()),
        ("The chairs stand next to the sofa.", ("chairs",)),
    ],
)
def test_uncounted_groups_of_a_text(text: str, uncounted: tuple[str, ...]) -> None:
    assert read_english(text).uncounted == uncounted
