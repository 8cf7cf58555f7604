"""Closed classes of English words, and the open classes that the parser needs to know: adjectives and verbs.

Each table is a text to read: a key, a colon and its words, with commas between phrases. Nouns need no table: a word
that is in none of them is a noun by its position.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from deixis.grammar.english.tree import Degree


def word_set(text: str) -> frozenset[str]:
    """Return the words of a text as a set.

    Parameters
    ----------
    text
        Words with spaces or line ends between them.

    Returns
    -------
    frozenset of str
        Words, each once.
    """
    return frozenset(text.split())


def _table(text: str) -> dict[str, tuple[str, ...]]:
    found: dict[str, tuple[str, ...]] = {}
    for line in text.strip().splitlines():
        key, _, words = line.partition(":")
        entries = tuple(word.strip() for word in words.split(",") if word.strip())
        found[key.strip()] = found.get(key.strip(), ()) + entries
    return found


def _inverted(table: dict[str, tuple[str, ...]]) -> dict[str, str]:
    return {word: key for key, words in table.items() for word in words}


IDIOMS = tuple(
    tuple(phrase.split())
    for phrase in (
        "above all",
        "make sure that",
        "make sure",
        "be sure that",
        "ensure that",
        "note that",
        "remember that",
        "check that",
        "see to it that",
        "right now",
        "just now",
        "after all",
        "at all",
        "of course",
        "for example",
        "for instance",
        "in addition",
        "in general",
        "by far",
        "at least",
        "any more",
        "if you prefer",
        "if you like",
        "on the other hand",
        "first of all",
        "at first",
        "as well",
        "as possible",
        "as you can",
        "in total",
        "once again",
        "in fact",
        "in addition to",
        "by the way",
        "so that",
        "at most",
        "at last",
        "if possible",
        "a bit",
        "a little bit",
        "in question",
        "like so",
        "like this",
        "as follows",
        "you know",
        "kind of",
        "sort of",
        "as usual",
        "on the house",
        "in the way",
        "out of the way",
        "all right",
        "keep an eye on",
        "have an eye on",
        "more or less",
        "at the moment",
        "for now",
        "in particular",
        "and so on",
        "or so",
        "as shown",
        "at a time",
        "each time",
        "in color",
        "in colour",
        "in shape",
        "in size",
        "in appearance",
        "in turn",
        "off center",
        "off centre",
        "in this order",
        "in that order",
        "in the following order",
        "as follows",
        "in the end",
        "all the way",
        "in the picture",
        "in the scene",
        "in the image",
        "if needed",
        "if necessary",
        "that is",
        "e.g.",
        "i.e.",
        "etc",
        "on the one hand",
        "on the contrary",
        "on the whole",
        "on the spot",
        "on the double",
        "on the go",
        "on time",
        "on second thoughts",
        "on the safe side",
        "under the circumstances",
        "under these circumstances",
        "under the weather",
        "under wraps",
        "under control",
        "under fire",
        "under one roof",
        "under the hammer",
        "in your court",
        "in the same boat",
        "in a nutshell",
        "in good hands",
        "in the works",
        "in the know",
        "in the mood",
        "up in the air",
        "on the right track",
        "on the wrong track",
        "on the cards",
        "on the fence",
        "on the agenda",
        "on the market",
        "on the menu",
        "on the mend",
        "on thin ice",
        "on duty",
        "on hold",
        "on the fritz",
        "on the blink",
        "on loan",
        "on record",
        "behind the wheel",
        "over the top",
        "in the first place",
        "in the long run",
        "in the meantime",
        "in place",
        "right then",
        "well now",
        "on end",
        "in any case",
        "in other words",
        "in no time",
        "in a hurry",
        "in a moment",
        "in the same way",
        "in a way",
        "at the same time",
        "at hand",
        "at any rate",
        "at the latest",
        "at the end of the day",
        "by all means",
        "by the book",
        "between you and me",
        "between ourselves",
        "beside the point",
        "behind the scenes",
        "behind the times",
        "above board",
        "above average",
        "below average",
        "over the moon",
        "over and over",
        "off the top of my head",
        "working from the outside in",
        "from the outside in",
        "from the inside out",
        "from the bottom up",
        "from the top down",
        "in half",
        "in two",
        "in first",
        "in last",
        "out of the way",
        "right away",
        "right off",
        "to be precise",
        "to be exact",
        "as always",
        "as ever",
        "as before",
        "as a rule",
        "as far as i remember",
        "as far as i know",
        "as far as i can see",
        "if i remember correctly",
        "believe it or not",
        "in plain view",
        "in full view",
        "for some reason",
        "in this case",
        "in that case",
        "next time",
        "last but not least",
        "at rest",
        "at an angle",
        "in pairs",
        "do not forget that",
        "do not forget to",
        "remember to",
        "be careful to",
        "be sure to",
        "make sure to",
        "take care to",
        "take care that",
        "care should be taken that",
        "care must be taken that",
        "it is best to",
        "feel free to",
        "left over",
        "at arm 's length",
        "out of sight",
        "on edge",
        "out of reach",
        "at eye level",
        "at a glance",
        "from above",
        "seen from above",
        "face up",
        "right side up",
        "right way up",
        "the right way up",
        "the right way round",
    )
)
"""Fixed phrases that say nothing of places."""
CHAT_WORDS = word_set("rn lol obvs tbh btw imo haha ugh omg idk lmao smh ikr yeah yep nope ah aha anyway")
"""Interjections of short messages, which stand anywhere."""
GREETINGS = CHAT_WORDS | word_set(
    "hi hello hey oh ok okay well yes thanks sorry welcome dear love good hmm um uh alright"
)
ARTICLES = frozenset({"a", "an", "the"})

DETERMINERS = word_set(
    "a an the this that these those each every all both no any some another other either neither same which what"
    " whichever several many few most only single"
)
POSSESSIVES = {
    "its": "it",
    "their": "they",
    "his": "he",
    "her": "she",
    "my": "me",
    "your": "you",
    "our": "we",
    "whose": "whose",
    "one's": "one",
}
PRONOUNS = {
    "it": "it",
    "itself": "it",
    "they": "they",
    "them": "they",
    "themselves": "they",
    "he": "he",
    "him": "he",
    "she": "she",
    "i": "me",
    "me": "me",
    "myself": "me",
    "you": "you",
    "yourself": "you",
    "yourselves": "you",
    "we": "we",
    "us": "we",
    "one": "one",
    "ones": "one",
    "each": "each",
    "both": "both",
    "all": "all",
    "either": "either",
    "neither": "neither",
    "none": "none",
    "nothing": "nothing",
    "nobody": "nothing",
    "everything": "everything",
    "anything": "anything",
    "something": "something",
    "someone": "someone",
    "somebody": "someone",
    "everyone": "everyone",
    "everybody": "everyone",
    "other": "other",
    "others": "other",
    "another": "other",
    "former": "former",
    "latter": "latter",
    "this": "this",
    "that": "this",
    "these": "these",
    "those": "these",
    "mine": "mine",
    "yours": "yours",
    "who": "who",
    "what": "what",
    "which": "which",
}
SUBJECT_PRONOUNS = frozenset({"it", "they", "he", "she", "i", "you", "we", "this", "that", "these", "those"})
PLURAL_PRONOUNS = frozenset(
    {"they", "them", "themselves", "ones", "both", "all", "others", "these", "those", "we", "us"}
)

NUMBERS = {
    word: value
    for value, word in enumerate(
        [
            "one",
            "two",
            "three",
            "four",
            "five",
            "six",
            "seven",
            "eight",
            "nine",
            "ten",
            "eleven",
            "twelve",
            "thirteen",
            "fourteen",
            "fifteen",
            "sixteen",
            "seventeen",
            "eighteen",
            "nineteen",
            "twenty",
        ],
        start=1,
    )
} | {"dozen": 12, "couple": 2, "pair": 2}
ORDINALS = {
    word: value
    for value, word in enumerate(
        [
            "first",
            "second",
            "third",
            "fourth",
            "fifth",
            "sixth",
            "seventh",
            "eighth",
            "ninth",
            "tenth",
            "eleventh",
            "twelfth",
        ],
        start=1,
    )
} | {f"{n}{'st' if n == 1 else 'nd' if n == 2 else 'rd' if n == 3 else 'th'}": n for n in range(1, 13)}
ORDINALS |= {"last": -1, "final": -1, "1rst": 1}

UNITS = {
    "mm": 0.001,
    "millimetre": 0.001,
    "millimeter": 0.001,
    "cm": 0.01,
    "cms": 0.01,
    "centimetre": 0.01,
    "centimeter": 0.01,
    "m": 1.0,
    "metre": 1.0,
    "meter": 1.0,
    "inch": 0.0254,
    "inches": 0.0254,
    "foot": 0.3048,
    "feet": 0.3048,
    "ft": 0.3048,
    "yard": 0.9144,
    "yards": 0.9144,
    "handbreadth": 0.1,
    "finger": 0.02,
    "hand": 0.1,
    "thumb": 0.02,
    "palm": 0.08,
    "fist": 0.1,
    "arm": 0.7,
    "stride": 0.8,
    "pace": 0.8,
}
"""Metres of a unit of length, by its singular and its irregular plurals."""

IS_FORMS = frozenset({"is", "are", "am", "'s", "'re", "'m", "be", "been", "being", "was", "were", "isn", "aren"})
PAST_FORMS = frozenset({"was", "were", "had", "did", "stood", "lay", "sat", "hung", "held", "kept", "faced", "leaned"})
MODALS = {
    "can": "can",
    "could": "could",
    "may": "may",
    "might": "might",
    "must": "must",
    "shall": "shall",
    "should": "should",
    "will": "will",
    "would": "would",
    "'ll": "will",
    "'d": "would",
    "ought": "ought",
    "need": "need",
    "needs": "need",
}
OTHER_UNITS = word_set(
    "year years month months week weeks day days hour hours minute minutes second seconds kilo kilos kg gram grams g"
    " pound"
    " pounds litre litres liter liters ml percent euro euros dollar dollars times"
)
"""Units of other quantities than lengths."""
NOT_PLACES = word_set(
    "monday tuesday wednesday thursday friday saturday sunday january february march april june july august september"
    " october november december noon midnight morning evening afternoon schedule fire hurry average purpose sale"
    " holiday"
    " miniature bulk profile bloom reserve use stock storage transit preparation readiness advance turn total"
    " time question mind doubt trouble fashion general particular charge demand"
    " construction warranty guarantee repair risk order display account hold loan offer request discussion review"
    " consideration supervision observation control attack threat arrest pressure stress strike average condition"
    " shape danger need debt love peace pain tears luck vain theory principle practice belief reach scope"
    " sight suspicion investigation way secret private writing effect force action motion progress later demand ease"
    " error pretext heaven hour minute month week year season harmony"
)
"""Nouns after which a preposition names no place, where they have no determiner: *on Monday*, *behind schedule*."""
NEGATIONS = frozenset({"not", "n't", "never", "nor", "isnt", "arent"})

HEDGES = word_set(
    "about around roughly approximately approx almost nearly usually normally generally typically mostly often"
    " sometimes maybe perhaps possibly probably likely apparently seemingly presumably always rarely seldom hardly"
    " certainly definitely ideally preferably optionally"
)
APPROXIMATE = word_set("about around roughly approximately approx almost nearly")
"""Hedges of a number or a place, which leave no doubt that the thing is there."""
ADVERBS = word_set(
    "directly immediately right just slightly very quite rather really too so exactly precisely straight fairly pretty"
    " somewhat far much well also still already now currently actually again only even both either simply closely"
    " yesterday today tomorrow tonight afterwards recently meanwhile"
    " halfway midway partway mostly completely fully partially partly"
    " totally barely clearly diagonally vertically horizontally upright flat"
    " neatly carefully gently loosely tightly firmly evenly centrally all up down back out off along there here"
    " together apart away nearby itself else instead please kindly basically kinda sorta obviously however therefore"
    " further farther close facedown freely freestanding separately individually alone solely lengthwise sideways"
    " crosswise squarely dead bang smack slap ever least most more less super extremely overnight"
)
DEGREE_ADVERBS = word_set(
    "directly immediately right just slightly very quite rather really too so exactly precisely straight fairly pretty"
    " somewhat far much way well almost nearly partially partly completely fully diagonally vertically horizontally"
    " as about roughly approximately slight mostly even still all clearly kinda mainly only"
    " vertically super extremely dead bang smack slap"
)

# Relation words that take an object. The key is the relation's name in the ontology; '-' is no spatial relation.
_PREPOSITIONS = """
material: made of, made out of, made from, made up of, built of, built from, composed of, consisting of
stacked: stacked upon
on: on, upon, onto, atop, on top of, ontop of, on to, over top of
inside: in, inside, inside of, within, into, in side of
at: at
by: by
near: near, near to, close to, nearby, around by, in the vicinity of, not far from, close by, near by, closed to
next_to: next to, beside, adjacent to, alongside, along side, along side of, right by, aside, besides, nex to, next
next_to: to the side of, near to next
each_side: either side of, to either side of, on either side of, on each side of, on both sides of
each_side: at either side of, at each side of, on opposite sides of, to both sides of
in_front: this side of, on this side of
behind: from behind, out from behind, on the far side of, the far side of
-: depending on, regardless of, in spite of, despite, in case of, thanks to, on behalf of, with regard to
-: as shown in, as seen in, as described in, as explained in, in the shape of, in the form of, in terms of
-: clockwise from, counterclockwise from, anticlockwise from, clockwise of
far: far from, far away from, away from, well away from, as far as possible from, as far away as possible from
near: as close as possible to, as near as possible to
far: apart from
in_front: in front of, before, infront of, ahead of, in the front of, at the front of, in from of, in front
behind: behind, behind of, in back of, beyond, past, in the back of, at the back of, to the back of, in rear of
above: above, over, up above
below: below
under: under of
under: from under, out from under, from underneath, under, underneath, beneath, down under, in under, underneath of
between: between, in between, inbetween, in-between, in the between of, betwen
among: among, amongst, amid, in the midst of, amidst
around: around, round, all around, surrounding
outside: outside, outside of
across: across
opposite: opposite, opposite of, opposite to, opposite from, across from, directly across from, on the other side of
opposite: facing opposite, on the opposite side of, at the opposite side of, opposing
against: against, up against, right up against, flush with, flush against
along: along, all along, down the centre of, down the center of, down the middle of, along the middle of
along: along the centre of, along the center of, down the length of, along the length of
touching: in contact with, touching
facing: facing, facing to, facing toward, facing towards, toward
facing: towards, looking at, looking toward, looking towards, facing at
pointing: pointing to, pointing at, pointing toward, pointing towards, pointing into
parallel: parallel to, parallel with, in parallel to, in parallel with
aligned: aligned with, in line with, in alignment with, flush to
level_with: level with, on a level with, at the same height as
perpendicular: perpendicular to, at right angles to, at a right angle to
leaning: leaning against, leaning on, leant against, propped against, propped up against, leaned against
left: to port of
right: to starboard of
behind: upstage of, aft of
in_front: downstage of, forward of
left: at left of, to the left from, left side from
left: left of, left to, left from, leftward of, to left of, left side of, on left of, on left side of
right: at right of, to the right from, right side from
right: right of, right to, right from, rightward of, to right of, right side of, on right of, on right side of
top: north of, to north of
bottom: south of
top_left: upper left of, upper left to, north west of, northwest of, top left of, northwest to, northwest from
top_right: upper right of, upper right to, north east of, northeast of, top right of, northeast to, northeast from
bottom_left: lower left of, lower left to, south west of, southwest of, bottom left of
bottom_right: lower right of, lower right to, south east of, southeast of, bottom right of
left: west of, to west of
right: east of, to east of
from: from, off, off of, out of, down from
to: to, up to, relative to
through: through, thru, via
like: like, similar to, looking like, identical to
-: for, as, during, except, except for, besides from, per, because of, instead of, due to, rather than, such as
-: since, until, till, after, same as, belonging to, according to, unlike, than
with: with, w/, complete with, together with, along with, full of, half full of, filled with, half filled with
without: without, with out
"""

# Relation words that stand alone: 'the cup in front', 'nearby'.
_PLACES_ALONE = """
in_front: straight ahead, directly ahead, dead ahead, in front, out front, up front, in the foreground
behind: behind, in back, out back, in the background, beyond
above: above, overhead, up above
below: below, down below, underneath
on: on top
middle: dead centre, dead center, in dead centre, smack in the middle, bang in the middle, slap in the middle
top: up top, up high, high up, at top
beside: beside
inside: inside, within
outside: outside
near: nearby, close by, near by, close, close at hand
left: left, leftward, leftwards, far left, farthest left, furthest left, most left, west
right: right, rightward, rightwards, far right, farthest right, furthest right, most right, east
between: in between
around: all around, around
opposite: opposite, across
upside_down: upside down, face down, bottom up, face-down, upside-down
near_each_other: side by side, next to each other, next to one another, beside each other, together, close together
near_each_other: near each other, adjacent to each other, beside one another
nested: inside one another, nested in one another, one inside the other, inside each other, nested in each other
stacked: on top of each other, on top of one another, one on top of the other, one on top of another, one upon another
stacked: stacked inside one another
parallel_each_other: parallel, parallel to each other, in parallel
one_each: one each, one apiece, one for each, respectively
inward: inward, inwards
outward: outward, outwards
there: within sight, within reach, within easy reach, within arm 's reach
there: over there, there, here, out there, up there, down there
apart: apart, away, far away
alone: by itself, all by itself, on its own, all on its own, by themselves, on their own, all alone
forward: forward, forwards, ahead
backward: backward, backwards, rearward
there: anywhere, everywhere, somewhere, nowhere
up: up, upward, upwards, skyward
down: down, downward, downwards
"""


@dataclass(frozen=True, slots=True)
class Preposition:
    """Relation of a preposition or of a place word, with its degree: ``near`` and superlative for *closest to*."""

    phrase: str
    relation: str
    degree: Degree = Degree.PLAIN


_DEGREES_OF_NEARNESS = {
    ("near", Degree.SUPERLATIVE): "closest nearest clostest",
    ("near", Degree.COMPARATIVE): "closer nearer",
    ("far", Degree.SUPERLATIVE): "farthest furthest farest furtherest",
    ("far", Degree.COMPARATIVE): "farther further",
}
_AFTER_NEAREST = ("to", "by", "too", "towards", "toward", "")
_AFTER_FARTHEST = ("from", "away from", "away to", "away", "form", "fron", "out from", "down from")


@cache
def prepositions() -> dict[str, Preposition]:
    """Return the prepositions by their phrase, *closest to* and *farthest away from* included."""
    found = {
        phrase: Preposition(phrase, relation)
        for relation, phrases in _table(_PREPOSITIONS).items()
        for phrase in phrases
    }
    for (relation, degree), words in _DEGREES_OF_NEARNESS.items():
        for word in words.split():
            for after in _AFTER_NEAREST if relation == "near" else _AFTER_FARTHEST:
                phrase = f"{word} {after}".strip()
                found[phrase] = Preposition(phrase, relation, degree)
    return found


@cache
def places_alone() -> dict[str, Preposition]:
    """Return the place words that need no object, by their phrase."""
    return {phrase: Preposition(phrase, relation) for phrase, relation in _inverted(_table(_PLACES_ALONE)).items()}


_ADJECTIVES = """
colour: red, green, blue, yellow, orange, purple, violet, pink, brown, black, white, grey, gray, beige, tan, cream
colour: turquoise, teal, maroon, navy, silver, gold, golden, bronze, light, dark, pale, bright, whitish, blackish
colour: brownish, greyish, grayish, reddish, greenish, bluish, yellowish, cyan, magenta, lime, olive, khaki, ivory
colour: mauve, burgundy, charcoal, aqua, indigo, lavender, peach, colored, coloured, multicolored, colorful, colourful
colour: creme, off-white, blonde, chocolate, mahogany, transparent, clear, opaque, shiny, dull, matte, glossy, blueish
size: big, bigger, biggest, large, larger, largest, small, smaller, smallest, little, littler, littlest, tiny, huge
size: medium, mini, giant, massive, enormous, medium-sized, full-size, oversized, compact, average, regular, mid-sized
size: full-sized, miniature, petite, great, full, main
height: tall, taller, tallest, short, shorter, shortest, high, higher, highest, low, lower, lowest
length: long, longer, longest
width: wide, wider, widest, narrow, narrower, narrowest, broad, broader, broadest
thickness: thick, thicker, thickest, thin, thinner, thinnest, slim, slimmer, slimmest, skinny, skinnier, skinniest
thickness: fat, fatter, fattest, deep, deeper, deepest, shallow
material: wooden, wood, metal, metallic, plastic, glass, leather, steel, stainless, brass, copper, iron, aluminium
material: aluminum, ceramic, porcelain, brick, stone, marble, granite, concrete, wicker, fabric, cloth, cotton, woollen
material: woolen, linen, velvet, tiled, cardboard, oak, pine, upholstered, rubber, tin, clay, wood-grain, suede
shape: round, rounded, square, rectangular, rectangle, circular, oval, triangular, curved, straight, flat, cylindrical
shape: l-shaped, u-shaped, boxy, conical, cubic, hexagonal, octagonal, spherical, pointed, pointy, cube-shaped, bent
position: left, right, top, bottom, upper, lower, middle, central, center, centre, front, back, rear, near, far, outer
position: downstage, upstage
position: inner, leftmost, rightmost, topmost, bottommost, uppermost, lowermost, left-hand, right-hand, lefthand
position: righthand, centermost, middlemost, outermost, innermost, foremost, hindmost, inside, outside, opposite
position: outermost, lefthanded, righthanded, near-side, far-side, overhead, nearest, closest, farthest, furthest, next
position: closer, nearer, farther, further, adjacent, distant, northern, southern, eastern, western, isolated, close
position: frontmost, rearmost, backmost, extreme
state: open, opened, closed, shut, empty, full, broken, clean, dirty, wet, dry, lit, unlit, new, old, older, newer
state: folded, unfolded, rolled, made, unmade, messy, tidy, neat, upright, vertical, horizontal, diagonal, tilted
state: upside-down, inverted, nested, stacked, empty-handed, visible, hidden, half-open, half-closed, unopened, bare
state: crooked, rotated, slanted, sideways, freestanding, standalone, free-standing, stand-alone, loose, lone
state: framed, padded, cushioned, striped, patterned, checkered, plaid, floral, solid, plain, dotted, worn, used, unused
state: uncovered, parallel, perpendicular, stationary, askew, slim-line, ajar, level
count: few, fewer, fewest
other: same, different, similar, identical, single, double, twin, sole, alone, separate, individual, only, whole, entire
other: correct, right, wrong, particular, specific, certain, nice, pretty, comfy, comfortable, soft, hard, heavy, light
other: modern, fancy, ornate, decorative, typical, normal, usual, additional, extra, remaining, various, visible, own
other: immediate, direct, weird, strange, odd, funny, unusual, regular, standard, interesting, exact, last, final
other: distinct, matching, opposite, electric, digital, electronic, industrial, domestic, personal, available, real
other: warm, hot, cold, fresh, large-scale, such, actual, prominent, noticeable, obvious, lefty, empty, busy, ergonomic
"""
_MATERIAL_NOUNS = word_set(
    "wood metal plastic glass leather steel brass copper iron brick stone marble granite concrete fabric cloth cotton"
    " linen velvet cardboard oak pine rubber tin clay"
)
COLOUR_SHADES = frozenset({"light", "dark", "pale", "bright", "deep", "medium", "off"})
NOT_NOUN_HEADS = frozenset({"same", "own", "such", "only", "very"})

_IRREGULAR_DEGREES = {
    "better": ("good", Degree.COMPARATIVE),
    "best": ("good", Degree.SUPERLATIVE),
    "further": ("far", Degree.COMPARATIVE),
    "farther": ("far", Degree.COMPARATIVE),
    "furthest": ("far", Degree.SUPERLATIVE),
    "farthest": ("far", Degree.SUPERLATIVE),
    "nearest": ("near", Degree.SUPERLATIVE),
    "nearer": ("near", Degree.COMPARATIVE),
    "closest": ("near", Degree.SUPERLATIVE),
    "closer": ("near", Degree.COMPARATIVE),
    "close": ("near", Degree.PLAIN),
    "leftmost": ("left", Degree.SUPERLATIVE),
    "rightmost": ("right", Degree.SUPERLATIVE),
    "topmost": ("top", Degree.SUPERLATIVE),
    "uppermost": ("top", Degree.SUPERLATIVE),
    "bottommost": ("bottom", Degree.SUPERLATIVE),
    "lowermost": ("bottom", Degree.SUPERLATIVE),
    "centermost": ("middle", Degree.SUPERLATIVE),
    "middlemost": ("middle", Degree.SUPERLATIVE),
    "outermost": ("outer", Degree.SUPERLATIVE),
    "innermost": ("inner", Degree.SUPERLATIVE),
    "foremost": ("front", Degree.SUPERLATIVE),
    "frontmost": ("front", Degree.SUPERLATIVE),
    "hindmost": ("back", Degree.SUPERLATIVE),
    "rearmost": ("back", Degree.SUPERLATIVE),
    "backmost": ("back", Degree.SUPERLATIVE),
    "upper": ("top", Degree.PLAIN),
    "left-hand": ("left", Degree.PLAIN),
    "lefthand": ("left", Degree.PLAIN),
    "right-hand": ("right", Degree.PLAIN),
    "righthand": ("right", Degree.PLAIN),
    "center": ("middle", Degree.PLAIN),
    "centre": ("middle", Degree.PLAIN),
    "central": ("middle", Degree.PLAIN),
    "rear": ("back", Degree.PLAIN),
    "extreme": ("far", Degree.PLAIN),
    "gray": ("grey", Degree.PLAIN),
    "larger": ("large", Degree.COMPARATIVE),
    "largest": ("large", Degree.SUPERLATIVE),
    "littler": ("little", Degree.COMPARATIVE),
    "littlest": ("little", Degree.SUPERLATIVE),
}


@cache
def adjectives() -> dict[str, str]:
    """Return the dimension of each adjective; of two dimensions the first of the table counts."""
    found: dict[str, str] = {}
    for dimension, words in _table(_ADJECTIVES).items():
        for word in words:
            found.setdefault(word, dimension)
    return found


def is_material_noun(word: str) -> bool:
    """Return True for a noun that names a material before another noun: *glass table*.

    Parameters
    ----------
    word
        Word in lower case.

    Returns
    -------
    bool
        False for a material that only has an adjective, such as *wooden*.
    """
    return word in _MATERIAL_NOUNS


_TOOLS = frozenset({"opener", "cleaner", "dryer", "shutter", "hotter"})
"""Nouns that look like the comparative of an adjective."""


@cache
def degree_of(word: str) -> tuple[str, Degree]:
    """Return the lemma and the degree of an adjective.

    >>> degree_of("tallest"), degree_of("bigger"), degree_of("leftmost")[0]
    (('tall', <Degree.SUPERLATIVE: 'superlative'>), ('big', <Degree.COMPARATIVE: 'comparative'>), 'left')
    """
    irregular = _IRREGULAR_DEGREES.get(word)
    if irregular is not None:
        return irregular
    if word in _TOOLS:
        return word, Degree.PLAIN
    known = adjectives()
    for ending, degree in (("est", Degree.SUPERLATIVE), ("er", Degree.COMPARATIVE)):
        if word.endswith(ending):
            stem = word[: -len(ending)]
            for lemma in (stem, stem + "e", stem[:-1], stem[:-1] + "y"):
                if (
                    len(lemma) > 1
                    and lemma in known
                    and not (lemma == stem[:-1] and stem[-1:] not in (*stem[-2:-1], "i"))
                ):
                    return lemma, degree
    return word, Degree.PLAIN


def is_adjective(word: str) -> bool:
    """Return True for an adjective that the tables hold, in any degree, or that has the ending of one.

    Parameters
    ----------
    word
        Word in lower case.

    Returns
    -------
    bool
        False for the name of a tool that looks like a comparative.
    """
    if word in _TOOLS:
        return False
    if word in adjectives() or degree_of(word)[1] is not Degree.PLAIN:
        return True
    if word.startswith("un") and word[2:] in adjectives():
        return True
    return word.endswith(("-shaped", "-colored", "-coloured", "-sized", "-looking", "colored", "coloured", "shaped"))


COMPARISONS = {
    "big": "bigger",
    "large": "bigger",
    "small": "smaller",
    "little": "smaller",
    "tall": "taller",
    "high": "above",
    "short": "shorter",
    "low": "below",
    "long": "longer",
    "wide": "wider",
    "broad": "wider",
    "narrow": "narrower",
    "thick": "thicker",
    "thin": "thinner",
}
"""Relation of a comparison by the lemma of its adjective; a missing one is ``more`` with the adjective as its value."""

# Verbs: lemma: third person, past, participle, -ing form (regular ones are made).
_VERBS = """
posture: stand stands stood stood standing, lie lies lay lain lying, sit sits sat sat sitting, lay lays laid laid laying
posture: hang hangs hung hung hanging, rest, go goes went gone going, belong, set sets set set setting
posture: place, put puts put put putting, position, locate, situate, mount
posture: attach, push, tuck, pull, install, fix, build
posture: arrange, find finds found found finding, keep keeps kept kept keeping, leave leaves left left leaving, prop
posture: store, bury buries buried buried burying, stick sticks stuck stuck sticking, insert, seat, stay, remain, float
posture: fit, present, happen, come comes came come coming, stack
posture: pile, line, perch, house, hide hides hid hidden hiding
posture: label, use, see sees saw seen seeing, plug, nestle, nest, wedge
posture: squeeze, drape, throw throws threw thrown throwing, sprinkle, pour, spread, fold, roll, roll, roost
posture: extend, run runs ran run running, start, begin begins began begun beginning, end, look, appear, seem, occur
posture: shove, jam, press, center, centre, space, scatter, group, fasten, connect, link, tie, drop, serve, slide, hook
posture: suspend, surround, cover, associate, align, angle, pair, connect, join, leave, turn, wall-mount, embed, display
posture: base, raise, lift, tie
posture: affix, hinge, anchor, glue, screw, bolt, secure
posture: nail, tape, strap, wrap, lift, drag, raise, build builds built built building
posture: fall falls fell fallen falling
posture: pin, slot, lock, recess, lodge, sandwich, crowd, cram, carry, tip, shelve, park
lean: lean leans leant leant leaning, prop, lean
face: face, stare, gaze, peer, view
point: point, aim, direct, open
transitive: hold holds held held holding, contain, support, touch, cover, have has had had having, share, include
transitive: show shows shown shown showing, carry carries carried carried carrying, surround, block, flank, feature
transitive: overlook, border, abut, adjoin, wear wears wore worn wearing, bear bears bore borne bearing, display, divide
transitive: separate, own, resemble, match matches matched matched matching, use, meet meets met met meeting
transitive: overlap, hug, intersect, enclose
transitive: serve, form, make makes made made making, occupy occupies occupied occupied occupying
other: read reads read read reading, need, allow, mean, move, change, water
other: start, help, look, walk, enter, approach, turn
other: come comes came come coming, want, like, say says said said saying, think thinks thought thought thinking, try
other: eat eats ate eaten eating, drink drinks drank drunk drinking, write writes wrote written writing, wash, let, take
other: takes took taken, open, close, know knows knew known knowing, give gives gave given giving, call, work, happen
other: lose loses lost lost losing, sell sells sold sold selling, buy buys bought bought buying
other: steal steals stole stolen stealing, forget forgets forgot forgotten forgetting, send sends sent sent sending
other: follow, shift, transfer, relocate, return
other: describe, mention, do does did done doing, set, share, watch, finish, order, ask, prefer, wait, see, notice
other: ignore, disregard, skip, exclude
other: choose chooses chose chosen choosing, find, select, pick, locate, identify, click, get gets got got getting, grab
other: spot, hit hits hit hit hitting, search, situate
other: balance, wrap, slide slides slid slid sliding, bring brings brought brought bringing
posture: sleep sleeps slept slept sleeping, poke, peek, peep, dangle, sprawl, curl, coil, snake, loom, tower, doze
posture: kneel kneels knelt knelt kneeling, crouch, squat, recline, droop, sag, teeter, soak, dry, cool, gather
posture: gleam, glow, glint, glitter, sparkle, shimmer, spill, stretch, hunch, cluster, bob, totter
posture: slump, wait, live, hover, nestle, linger, lounge, encircle, ring, range, reside, protrude, balance
posture: plant, heap, drizzle, spoon, load, thread, sprinkle, pack, feed, tilt, swing swings swung swung swinging, scoop
posture: travel, trail, dot, ladle, step
posture: clamp, clip, stow, slip, sew sews sewed sewn sewing, string strings strung strung stringing, lower
transitive: encircle, straddle
other: lead leads led led leading, separate, shine shines shone shone shining, block, belong, protrude, jut, stick, fill
"""
REPORTS = word_set(
    "states claims reports says insists maintains asserts swears testifies stated claimed reported said insisted"
    " maintained asserted swore testified alleges alleged"
)
"""Verbs of persons who tell something that need not be so."""
SAYING = word_set(
    "swore swears says said claims claimed insists insisted insists believes thinks thought reckons"
    " maintains suspects guesses assumes supposes argues"
)
"""Such verbs after which *that* can be left out: *the butler swore it hung there*."""
TRANSITIVE_RELATIONS = {
    "hold": ("with", False),
    "contain": ("inside", True),
    "support": ("on", True),
    "touch": ("touching", False),
    "abut": ("touching", False),
    "adjoin": ("next_to", False),
    "border": ("next_to", False),
    "hug": ("against", False),
    "cover": ("on", False),
    "have": ("with", False),
    "include": ("with", False),
    "feature": ("with", False),
    "carry": ("on", True),
    "bear": ("with", False),
    "show": ("with", False),
    "display": ("with", False),
    "wear": ("with", False),
    "surround": ("around", False),
    "encircle": ("around", False),
    "straddle": ("across", False),
    "occupy": ("inside", False),
    "fill": ("inside", False),
    "enclose": ("around", False),
    "flank": ("each_side", False),
    "block": ("in_front", False),
    "overlook": ("facing", False),
    "face": ("facing", False),
    "divide": ("between", False),
    "separate": ("between", False),
    "share": ("share", False),
}
"""Relation of a transitive verb between its subject and its object, and whether they change places."""

FIND_VERBS = word_set(
    "choose find select pick locate identify click want take use get grab hit lift spot point search chose need"
)
PUT_VERBS = word_set(
    "put place set lay position keep leave stand arrange hang stack lean rest move slide push add drop insert store"
    " line fold roll turn center centre align tuck mount attach install fix plug bring stick spread"
    " surround situate locate seat nest wrap pile prop start finish balance"
    " plant heap pour scatter screw bolt glue nail tape strap sprinkle drizzle spoon load thread drape lower raise pin"
    " slot hook suspend fasten secure connect press wedge nestle space clip clamp tip park sit lodge sandwich group"
    " tie shelve stow lay bury hide cram slip position pack feed affix anchor angle straddle"
    " cover top fill flank tilt swing pull lift drag scoop ladle fit float dot heap"
)
NAMED_LIKE_THINGS = word_set(
    "plant heap screw bolt glue nail tape strap spoon load thread pin slot hook press wedge clip clamp tip park group"
    " tie pack feed anchor angle top lower fit dot fill float cover position space spread stick stack pile line drop"
    " center centre turn roll fold prop nest seat store rest stand set place mount slide bring"
)
"""Commands whose verb is a noun as well: *screw the bracket to it* and *screw holes*."""
VIEW_VERBS = word_set(
    "facing looking standing sitting walking entering viewing coming seated stood face look stand walk enter sit view"
    " turn imagine approach approaching step stepping turning lying laying"
)
FACE_VERBS = frozenset(
    {
        "staring",
        "stare",
        "gazing",
        "facing",
        "looking",
        "viewing",
        "face",
        "look",
        "view",
        "turn",
        "turning",
        "faced",
        "looked",
    }
)
ENTER_VERBS = frozenset(
    {"walking", "entering", "coming", "walk", "enter", "come", "approach", "approaching", "step", "go", "stepping"}
)


@dataclass(frozen=True, slots=True)
class VerbForm:
    """One form of a verb: ``form`` is ``base``, ``s``, ``past``, ``participle`` (also past) or ``ing``."""

    lemma: str
    kind: str
    form: str


@cache
def verb_forms() -> dict[str, VerbForm]:
    """Return the verbs by their forms; the first entry of a form counts."""
    found: dict[str, VerbForm] = {}
    for kind, entries in _table(_VERBS).items():
        for entry in entries:
            parts = entry.split()
            lemma = parts[0]
            forms: dict[str, str] = dict(zip(("s", "past", "participle", "ing"), parts[1:], strict=False))
            for form, regular in (("base", lemma), *_regular(lemma).items()):
                if lemma in _ONLY_PARTICIPLES and form in ("base", "s"):
                    continue
                word = forms.get(form, regular) if form != "base" else lemma
                found.setdefault(word, VerbForm(lemma, kind, form))
    for lemma in sorted(PUT_VERBS | FIND_VERBS):
        found.setdefault(lemma, VerbForm(lemma, "posture", "base"))
    return found


_ONLY_PARTICIPLES = word_set(
    "clip clamp ring tower string range coil slip lower fill stow plant heap spoon load"
    " thread pack feed scoop dot ladle stretch swing"
)
"""Verbs whose plain forms are nouns or adjectives more often."""


def _regular(lemma: str) -> dict[str, str]:
    stem = lemma[:-1] if lemma.endswith("e") else lemma
    doubled = lemma + lemma[-1] if lemma in _DOUBLED else stem
    y = lemma.endswith("y") and lemma[-2:-1] not in "aeou"
    return {
        "s": lemma[:-1] + "ies" if y else lemma + ("es" if lemma.endswith(("s", "sh", "ch", "x", "z", "o")) else "s"),
        "past": lemma[:-1] + "ied" if y else doubled + "ed",
        "participle": lemma[:-1] + "ied" if y else doubled + "ed",
        "ing": doubled + "ing",
    }


_DOUBLED = frozenset({"set", "put", "sit", "run", "stop", "jut", "plug", "prop", "pin", "slot", "jam", "cram", "hug",
                      "fit", "tip", "drop", "step", "get", "overlap", "abut", "begin", "slip", "clip", "wrap", "sag",
                      "bob", "strap", "drag"})  # fmt: skip

PLACE_NOUNS = {
    "corner": "corner",
    "edge": "edge",
    "rim": "edge",
    "border": "edge",
    "end": "end",
    "tip": "end",
    "side": "side",
    "hand": "side",
    "middle": "middle",
    "midpoint": "middle",
    "quadrant": "part",
    "center": "middle",
    "centre": "middle",
    "part": "part",
    "half": "part",
    "section": "part",
    "portion": "part",
    "quarter": "part",
    "third": "part",
    "area": "part",
    "position": "part",
    "direction": "part",
    "left": "left",
    "right": "right",
    "front": "front",
    "back": "back",
    "rear": "back",
    "top": "top",
    "bottom": "bottom",
    "north": "top",
    "south": "bottom",
    "west": "left",
    "east": "right",
    "inside": "inside",
    "outside": "outside",
    "northwest": "top left",
    "northeast": "top right",
    "southwest": "bottom left",
    "southeast": "bottom right",
    "foreground": "front",
    "background": "back",
}
"""Kind of place that a noun names: in the far left *corner*, on the *left*, at the right *end*."""
DIRECTION_WORDS = frozenset(
    {"left", "right", "top", "bottom", "upper", "lower", "front", "back", "rear", "far", "near", "north", "south",
     "east", "west", "middle", "center", "centre"}
)  # fmt: skip

COLLECTIVES = word_set(
    "row line pair set group stack pile bunch couple number lot series column circle ring cluster collection dozen"
    " bundle trio array range kind type sort piece bit cup glass part majority rest"
)
"""Nouns whose *of* complement names the things: *a row of pawns*, *a pair of boots*."""

TYPOS = {
    "w/": "with", "w/o": "without",
    "teh": "the", "hte": "the", "th": "the", "thats": "that's", "isnt": "isn't", "arent": "aren't",
    "doesnt": "doesn't", "dont": "don't", "donn't": "don't", "wont": "won't", "cant": "can't", "hasnt": "hasn't",
    "wasnt": "wasn't", "theres": "there's", "closes": "closest", "closests": "closest", "closesest": "closest",
    "furtherst": "furthest", "betwen": "between", "beetween": "between", "inbetween": "between",
    "untop": "ontop", "nxt": "next", "infront": "in\u00a0front", "undr": "under", "rigth": "right", "rihgt": "right",
    "whith": "with", "wiht": "with", "wich": "which", "righthand": "right-hand", "lefthand": "left-hand",
    "youre": "you're", "midle": "middle", "conner": "corner", "cornor": "corner", "adn": "and", "nad": "and",
    "isto": "is\u00a0to", "ontop": "on\u00a0top", "ont": "on", "&": "and", "@": "at", "+": "and",
    "its'": "its", "nearset": "nearest", "closed-to": "close\u00a0to", "aother": "another", "ther": "there",
    "cuz": "because", "coz": "because", "bc": "because", "cos": "because",
    "underneat": "underneath", "directy": "directly", "opposit": "opposite", 
    "ot": "to", "fo": "of", "fro": "from", "frm": "from", "onn": "on",
}  # fmt: skip
"""Frequent misspellings of function words. A no-break space stands between the words that were written as one."""
