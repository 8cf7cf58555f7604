"""Choice between readings of one sentence, and what is not asserted because the good readings do not agree."""

from dataclasses import replace

import pytest
from asserted_facts import asserted as asserted_except

from deixis.grammar.english.chunking.chunk import Chunk
from deixis.grammar.english.clauses.readings import MAX_OTHER_JOINTS, other_joints, settled
from deixis.grammar.english.confidence import Guess, Standing, standing
from deixis.grammar.english.parse import parse_english


def asserted(text: str) -> list[str]:
    """Return the facts that a text asserts, without counts."""
    return asserted_except(text, ("count(",))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("There are two snails, one on the glass and one under a leaf.",
         ["on(snail_1, glass)", "under(snail_2, leaf)"]),
        ("The bust faces the jug, with the pearls round its neck and nothing else.",
         ["facing(bust, jug)", "around(pearls, bust)"]),
        ("Pears go in the bowl, and the bowl near the jug.", ["inside(pears, bowl)", "near(bowl, jug)"]),
        ("Bread: in the bin, the jug on a box behind the bin.",
         ["inside(bread, bin)", "behind(box, bin)", "on(jug, box)"]),
    ],
)  # fmt: skip
def test_unlike_phrases_are_not_coordinated(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The cup and the jug stand on the box.", ["on(cup, box)", "on(jug, box)"]),
        ("Behind the jug are a cup, a spoon and a fork.",
         ["behind(cup, jug)", "behind(spoon, jug)", "behind(fork, jug)"]),
        ("The envelope stands between the cup and the jug.", ["between(envelope, cup, jug)"]),
        ("I keep the cup and the jug on the box.", ["on(cup, box)", "on(jug, box)"]),
    ],
)  # fmt: skip
def test_coordinations_of_like_phrases_are_kept(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


def test_predicate_that_a_rival_reading_lacks_is_contested() -> None:
    text = "The cup is on the box and behind the jug."
    (sentence,) = parse_english(text)
    (clause,) = sentence.clauses
    on, behind = clause.predicates
    rival = replace(sentence, clauses=(replace(clause, predicates=(on, replace(behind, relation="near"))),))
    assert sentence.contested == frozenset()
    assert settled(sentence, [(rival, False)]).contested == frozenset()
    contested = settled(sentence, [(rival, True)]).contested
    assert {text[slice(*span)] for span in contested} == {"behind the jug"}


def test_fact_of_a_contested_predicate_is_not_asserted() -> None:
    assert [standing(guesses) for guesses in ([Guess.CONTESTED], [])] == [Standing.DOUBTFUL, Standing.ASSERTED]


def test_number_of_other_readings_is_bounded() -> None:
    chunks = [Chunk(kind, i, i + 1) for i, kind in enumerate(["PREP", "AND"] * 50)]
    assert len(list(other_joints(chunks))) == MAX_OTHER_JOINTS


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The spoon, if there is soup, lies to the right of the knife. The jug is on the box.", ["on(jug, box)"]),
        ("The lid, when hot, lies next to the pot. The jug is on the box.", ["on(jug, box)"]),
        ("The key that once hung from the hook is lost. The jug is on the box.",
         ["state(key, 'lost')", "on(jug, box)"]),
        ("Perhaps there is a cup behind the jug. The jug is on the box.", ["on(jug, box)"]),
        ("Never is there a cup behind the jug. The jug is on the box.",
         ["not behind(cup, jug)", "on(jug, box)"]),
    ],
)  # fmt: skip
def test_inserted_conditions_and_hedges_assert_nothing(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The book lies open at page 40 on the box.", ["open(book)", "on(book, box)"]),
        ("The box is open at the back.", ["open(box)"]),
        ("I have left you a cake under the dome.", ["under(cake, dome)"]),
        ("The strop hangs from a ring.", ["on(strop, ring)"]),
        ("The filters are behind the tin, under a towel (mice!).",
         ["behind(filters, tin)", "under(filters, towel)"]),
        ("The roses stand in water behind the jug.", ["behind(roses, jug)", "inside(roses, water)"]),
    ],
)  # fmt: skip
def test_phrases_belong_to_what_they_place(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected
