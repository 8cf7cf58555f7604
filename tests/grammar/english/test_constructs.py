"""Constructs of English: each sentence has the outline that a reader would give it."""

from __future__ import annotations

import pytest

from deixis.grammar.english.outline import outline
from deixis.grammar.english.parse import parse_english
from deixis.grammar.english.tree import Degree, Mood, NounPhrase, Predicate, Sentence


def parsed(text: str) -> Sentence:
    (sentence,) = parse_english(text)
    return sentence


def restriction(text: str) -> Predicate:
    """Return the only restriction of a description."""
    fragment = parsed(text).fragment
    assert isinstance(fragment, NounPhrase)
    (predicate,) = fragment.predicates
    return predicate


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The lamp hangs on the monitor.", "the lamp: on(the monitor)"),
        ("The pot is on the left burner.", "the pot: on(the left burner)"),
        ("The fork cannot be left of the plate.", "the fork: not left(the plate) (can)"),
        ("Two beakers stand to the left of the stand.", "2 beaker: left(the stand)"),
        ("The burette stand is placed at the back.", "the burette stand: part(back)"),
        ("The watering can stands next to the trash can.", "the watering can: next_to(the trash can)"),
        ("The first is round.", "the first: shape(round)"),
        ("The glass stands above the knife.", "the glass: above(the knife)"),
        ("The red stands are on the desk.", "the red stand: on(the desk)"),
        ("The lamp w/ a red shade is on the desk.", "the lamp [with(a red shade)]: on(the desk)"),
        ("The box is behind the round table.", "the box: behind(the round table)"),
        ("The jug stands around the corner.", "the jug: around(the corner)"),
        ("The cup is on the counter top.", "the cup: on(the counter top)"),
        ("A glass jar is on the paper towel.", "a glass jar: on(the paper towel)"),
        ("The tray of brass lies under the jug.", "the tray of brass: under(the jug)"),
        ("It is the very first chair.", "it: kind(the first chair)"),
        ("The towel is hung on the rolled mat.", "the towel: on(the roll mat)"),
    ],
)
def test_words_with_several_categories(text: str, expected: str) -> None:
    found = outline(parsed(text))
    assert found.replace("rolled", "roll") == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("D and G are side by side with G on the right and D on the left.",
         "(D and G): near_each_other()\nG: right(right)\nD: left(left)"),
        ("The object labeled A is to the upper left of the object I.", "the A: top_left(the I)"),
        ("If Z is the center of a clock face, W is located between 4 and 5.", "W: bottom_right(Z)"),
        ("O is at G's 3 o'clock.", "O: right(G, 3)"),
        ("R is above B at 10 o'clock.", "R: above(B), top_left(B, 10)"),
        ("C is below A and to the left of it.", "C: below(A), left(it)"),
        ("The object E is lower and slightly to the left of the object X.", "the E: below(the X), left(the X)"),
        ("A is at a 45 degree angle to S, in the lower lefthand corner.", "A: corner(S, bottom left)"),
        ("L is on the same horizontal plane directly right to B.", "L: right(B)"),
        ("B is positioned above D and to the right.", "B: above(D), right(D)"),
    ],
)  # fmt: skip
def test_letters_and_compass_directions(text: str, expected: str) -> None:
    assert outline(parsed(text)) == expected


def test_a_place_after_the_object_belongs_to_the_object() -> None:
    assert outline(parsed("The candle is taller than the bottle on the tray.")) == (
        "the candle: taller+(the bottle [on(the tray)])"
    )


def test_a_place_after_a_comma_belongs_to_the_subject() -> None:
    assert outline(parsed("The cup stands on the saucer, to the left of the pot.")) == (
        "the cup: on(the saucer), left(the pot)"
    )


def test_a_place_after_a_pronoun_belongs_to_the_subject() -> None:
    assert outline(parsed("The fork is to the right of it on the tray.")) == "the fork: right(it), on(the tray)"


def test_a_list_after_a_place_is_one_place() -> None:
    assert outline(parsed("It is to the right of the sink and the cabinet.")) == "it: right((the sink and the cabinet))"


def test_clauses_without_punctuation() -> None:
    assert outline(parsed("the chair is brown it is near the desk there is a lamp on it")) == (
        "the chair: colour(brown)\nit: near(the desk)\na lamp: on(it)"
    )


def test_a_distance_can_go_with_a_direction() -> None:
    (clause,) = parsed("The cup is 5 cm to the left of the plate.").clauses
    (predicate,) = clause.predicates
    assert predicate.relation == "left"
    assert predicate.measure is not None
    assert predicate.measure.metres == pytest.approx(0.05)


def test_a_negation_of_the_verb_denies_all_its_predicates() -> None:
    (clause,) = parsed("The cup is not on the tray and next to the jug.").clauses
    assert [predicate.positive for predicate in clause.predicates] == [False, False]


def test_verbs_of_one_subject_have_their_own_negation() -> None:
    clauses = parsed("The cup stands on the tray and must not touch the jug.").clauses
    assert [clause.predicates[0].positive for clause in clauses] == [True, False]
    assert [clause.modal for clause in clauses] == [None, "must"]


@pytest.mark.parametrize(
    ("text", "mood"),
    [
        ("Where is the spoon, left or right of the plate?", Mood.QUESTION),
        ("Is the knife to the left of the fork?", Mood.QUESTION),
        ("Which one is left of the plate?", Mood.QUESTION),
        ("Position the flask under the burette.", Mood.COMMAND),
        ("Don't move it next to the jug.", Mood.COMMAND),
        ("The flask is under the burette.", Mood.STATEMENT),
    ],
)
def test_mood(text: str, mood: Mood) -> None:
    assert {clause.mood for clause in parsed(text).clauses} == {mood}


@pytest.mark.parametrize(
    ("text", "metres", "bound"),
    [
        ("The mug is roughly 10 cm from the keyboard.", 0.1, None),
        ("The mug is within about 15 cm of the keyboard.", 0.15, "<"),
        ("The mug is at least two inches away from the keyboard.", 0.0508, ">"),
        ("The mug is 30mm from the keyboard.", 0.03, None),
    ],
)
def test_distances(text: str, metres: float, bound: str | None) -> None:
    (clause,) = parsed(text).clauses
    (predicate,) = clause.predicates
    assert predicate.measure is not None
    assert predicate.measure.metres == pytest.approx(metres)
    assert predicate.measure.bound == bound
    assert [argument.head for argument in predicate.arguments] == ["keyboard"]


@pytest.mark.parametrize("phrase", ["closest to", "nearest", "nearest to", "second closest to"])
def test_superlatives_of_nearness(phrase: str) -> None:
    predicate = restriction(f"the chair {phrase} the door")
    assert (predicate.relation, predicate.degree) == ("near", Degree.SUPERLATIVE)
    assert (predicate.value is not None and predicate.value.rank == 2) == phrase.startswith("second")


def test_an_adjective_of_nearness_has_an_object() -> None:
    predicate = restriction("the closest block to me")
    assert (predicate.relation, predicate.degree, predicate.arguments[0].pronoun) == ("near", Degree.SUPERLATIVE, "me")


@pytest.mark.parametrize(
    ("text", "at", "facing", "back"),
    [
        ("If you are facing the bed, it is the lamp on the left.", None, "bed", None),
        ("From the door, the lamp is on the left.", "door", None, None),
        ("Standing at the sink facing the wall, the lamp on the left.", "sink", "wall", None),
        ("If your back is to the door, choose the lamp on the left.", None, None, "door"),
        ("As you enter the room, it is the lamp on the left.", "room", None, None),
        ("The lamp on the left when facing the bed.", None, "bed", None),
        ("When looking at the beds they are the ones in the middle.", None, "bed", None),
    ],
)
def test_viewpoints(text: str, at: str | None, facing: str | None, back: str | None) -> None:
    view = parsed(text).viewpoint
    assert view is not None
    assert [phrase and phrase.head for phrase in (view.at, view.facing, view.back)] == [at, facing, back]


@pytest.mark.parametrize(
    "text",
    ["You want the chair next to the desk.", "The chair you are looking for is next to the desk.",
     "You need to select the chair next to the desk.", "Please choose the chair next to the desk."],
)  # fmt: skip
def test_wishes_state_no_places(text: str) -> None:
    sentence = parsed(text)
    phrase = sentence.fragment or sentence.clauses[0].subject
    assert phrase is not None
    predicates = phrase.predicates or sentence.clauses[0].predicates
    assert phrase.head == "chair"
    assert [predicate.relation for predicate in predicates] == ["next_to"]
    assert sentence.understood == 1


def test_headings_and_steps_are_distinguished_from_sentences() -> None:
    text = "SETUP OF THE TABLE\n\n1. Place the plate in the middle.\n2. Put the fork to its left.\n"
    heading, *steps = parse_english(text)
    assert heading.heading
    assert [sentence.clauses[0].step for sentence in steps] == ["1.", "2."]


@pytest.mark.parametrize(
    ("noun", "head"),
    [("shelves", "shelf"), ("glasses", "glass"), ("boxes", "box"), ("candles", "candle"),
     ("wine glasses", "wine glass"),
     ("scissors", "scissors"), ("knives", "knife"), ("dishes", "dish"), ("cups", "cup"), ("bookshelves", "bookshelf")],
)  # fmt: skip
def test_plurals(noun: str, head: str) -> None:
    (clause,) = parsed(f"The {noun} are on the tray.").clauses
    assert clause.subject is not None
    assert (clause.subject.head, clause.subject.plural) == (head, True)


@pytest.mark.parametrize(
    "text",
    ["The guests left the table.", "The beaker is for waste.", "He drank the tea.", "It rained all day."],
)
def test_sentences_about_other_matters_state_nothing(text: str) -> None:
    sentence = parsed(text)
    assert not sentence.clauses
    assert sentence.misunderstood


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The fork isn't on the plate, but under it.", "the fork: not on(the plate), under(it)"),
        ("Neither the cup nor the jug is on the tray.", "(the cup and the jug): not on(the tray)"),
        ("The cup is no longer on the tray.", "the cup: not on(the tray)"),
        ("The cup is nowhere near the plate.", "the cup: not near(the plate)"),
        ("The cup is under no circumstances on the tray.", "the cup: not on(the tray)"),
        ("I don't think the cup is on the tray.", "the cup: not on(the tray) (probably)"),
        ("It isn't true that the cup is on the tray.", "the cup: not on(the tray)"),
        ("It is forbidden to put the cup on the tray.", "it: kind(forbidden)\nthe cup!: not on(the tray)"),
        ("Hardly any cup is on the tray.", "no cup: on(the tray)"),
        ("The cup may or may not be on the tray.", "the cup: on(the tray) (may)"),
        ("The cup used to be on the tray.", "the cup: on(the tray) (past)"),
        ("Had the cup been on the tray, the jug would be left of it.",
         "the cup: (if the cup been on the tray)\nthe jug: left(it) (would) (if the cup been on the tray)"),
        ("As soon as the cup is on the tray, put the spoon next to it.",
         "the cup: (when the cup is on the tray)\nthe spoon!: next_to(it) (when the cup is on the tray)"),
        ("All but the cup are on the tray.",
         "all: on(the tray)\n-- but the cup: 'but' does not say where something is"),
        ("The book is about birds.", "-- about birds: 'about' does not say where something is"),
        ("The meeting is on Monday.", "-- on Monday: 'monday' is not a place"),
        ("Above all, keep the knife behind the board.", "the knife!: behind(the board)"),
        ("The lamp glorfs on the monitor.",
         "the lamp: on(the monitor)\n-- glorfs: 'glorfs' does not say where something is"),
        ("Not all cups are on the tray.",
         "-- Not all cups are on the tray: a denial of all does not say which"),
    ],
)  # fmt: skip
def test_what_is_not_asserted_plainly_is_marked(text: str, expected: str) -> None:
    assert outline(parsed(text)) == expected
