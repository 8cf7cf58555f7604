"""Test constructs of dictated notes, lists and stories: corrections, absence, inversions, what things are for."""

import pytest

from deixis.grammar.english.reader import read_english
from deixis.report.layouts.read import reading_to_dict


def asserted(text: str) -> set[str]:
    found = read_english(text).reading
    assert found is not None
    return {str(fact.content) for fact in found.stated if fact.asserted}


@pytest.mark.parametrize(
    ("text", "facts"),
    [
        ("Gauze in front of the cup, uh, scratch that, in front of the tin.", {"in_front(gauze, tin)"}),
        ("The fork goes left of the plate, no wait, right of the plate.", {"right(fork, plate)"}),
        ("We are putting the flowers in front of the pot.", {"in_front(flowers, pot)"}),
        ("The spoon for the sugar is inside the box.", {"inside(spoon, box)"}),
        ("The bowl with apples is behind the jug.", {"inside(apples, bowl)", "behind(bowl, jug)"}),
        ("The bowl with handles is behind the jug.", {"behind(bowl, jug)"}),
        ("Camera: lens side up, right of the mat.", {"right(camera, mat)"}),
        ("Zoom lens left of the mat, standing on its cap.", {"left(zoom_lens, mat)", "on(zoom_lens, cap)"}),
        ("The pot is behind the jug. The spoon rests on its lid.", {"behind(pot, jug)", "on(spoon, pot)"}),
        ("The lamp is in the corner, the far left one.", {"corner(lamp, 'far left')"}),
        ("A vase adorns the far right corner.", {"corner(vase, 'far right')"}),
        ("Before me lies the book.", {"in_front(book, 'viewer')"}),
    ],
)
def test_constructs_of_notes_and_stories(text: str, facts: set[str]) -> None:
    assert asserted(text) == facts


def test_in_between_goes_back_to_two_things_before() -> None:
    assert "between(cup, jug, tin)" in asserted("The jug and the tin are on the tray. In between stands the cup.")


def test_one_each_side_is_one_on_either_side() -> None:
    found = asserted("Two filters, one each side of the mask.")
    assert {"each_side(filter_1, mask)", "each_side(filter_2, mask)"} <= found


def test_a_clause_after_a_list_of_owned_things_is_not_in_it() -> None:
    found = asserted("The tray has a jug on its left, and the napkins are on the plate.")
    assert {"left(jug, tray)", "on(napkins, plate)"} <= found


def test_a_surface_is_not_in_a_row() -> None:
    assert not any(
        fact.startswith("row") for fact in asserted("Repair bench, left to right. The mat is in the middle.")
    )


@pytest.mark.parametrize(
    ("note", "absent"),
    [("No flash unit.", ["flash_unit"]), ("No sign of a pen anywhere.", ["pen"]), ("No problem.", [])],
)
def test_notes_of_absence(note: str, absent: list[str]) -> None:
    assert reading_to_dict(read_english(f"The lamp is on the tray. {note}"))["absent"] == absent
