"""Words and phrases that name a place: prepositions, place words that stand alone, nouns such as *corner*."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from deixis.grammar.english.tree import Degree
from deixis.grammar.english.vocabulary.tables import inverted, table, word_set

ARRANGEMENTS = word_set(
    "spectrum triangle semicircle pattern fan pyramid arc spiral diamond grid formation heap arrangement layout order"
    " shape mound batch clump zigzag checkerboard sequence orientation"
)
"""Nouns after *in* that say how several things lie."""
CIRCUMSTANCES = word_set(
    "time times moment moments way ways manner fashion style angle angles occasion occasions circumstances rule"
    " setting settings game games emergency emergencies colour color"
    " shape size variety"
)
"""Nouns that name no place after *in*, *at*, *as*, *on* and *under*: *in a formal setting*."""
HOLIDAYS = word_set(
    "christmas easter epiphany thanksgiving halloween hanukkah passover pentecost advent ramadan diwali lent"
)
OCCURRENCES = word_set(
    "round turn game match day night week month year season shift session class lesson meeting service process step"
    " phase stage hour play meal show evening morning afternoon summer winter spring autumn term"
    " rounds turns games days shifts sessions"
)
"""Nouns of what begins and ends in time: *at the start of each round*."""
DEGREES = word_set(
    "degree percent notch turn half third quarter fraction amount factor multiple shade hair margin width length"
    " height depth thickness millimetre millimeter centimetre centimeter metre meter inch foot mm cm m"
)
"""Nouns after *by* that say how much: *turned by ninety degrees*, *raised by two notches*."""
NOT_PLACES = word_set(
    "monday tuesday wednesday thursday friday saturday sunday january february march april june july august september"
    " october november december noon midnight morning evening afternoon schedule fire hurry average purpose sale"
    " holiday home work school contrast value dawn dusk sunset sunrise night lunch dinner breakfast birth death rights"
    " miniature bulk profile bloom reserve use stock storage transit preparation readiness advance turn total"
    " time question mind doubt trouble fashion general particular charge demand"
    " construction warranty guarantee repair risk order display account hold loan offer request discussion review"
    " consideration supervision observation control attack threat arrest pressure stress strike condition"
    " shape danger need debt love peace pain tears luck vain theory principle practice belief reach scope"
    " sight suspicion investigation way secret private writing effect force action motion progress later ease"
    " error pretext heaven hour minute month week year season harmony arrival departure entry delivery completion"
    " reflection inspection impulse place"
)
"""Nouns after which a preposition names no place, where they have no determiner: *on Monday*, *behind schedule*."""

NEVER_PLACES = word_set(
    "contract law rule agreement pretence pretense impression influence auspices assumption supervision guidance"
    " distance misapprehension spell popularity fame career power treaty"
    " excerpt reference article preference manual text"
    " chapter paragraph agenda diet odds name circumstance principle nature rumour rumor honour honor behalf occasion"
)
"""Nouns after which a preposition names no place, whatever stands before them: *under the contract*."""

# Relation words that take an object. The key is the relation's name in the ontology; '-' is no spatial relation.
_PREPOSITIONS = """
material: made of, made out of, made from, made up of, built of, built from, composed of, consisting of
stacked: stacked upon
on: halfway up, halfway down, halfway along
on: all over, on, upon, onto, atop, on top of, ontop of, on to, over top of
inside: in, inside, inside of, within, into, in side of
at: at
by: by
near: near, near to, close to, nearby, around by, in the vicinity of, not far from, close by, near by, closed to
near: within reach of, within easy reach of, a stone 's throw from, hard by
next_to: next to, beside, adjacent to, alongside, along side, along side of, right by, aside, besides, nex to, next
next_to: to the side of, near to next
each_side: either side of, to either side of, on either side of, on each side of, on both sides of
each_side: at either side of, at each side of, on opposite sides of, to both sides of
in_front: this side of, on this side of
behind: from behind, out from behind, on the far side of, the far side of
-: depending on, regardless of, in spite of, despite, in case of, thanks to, on behalf of, with regard to
-: as shown in, as seen in, as described in, as explained in, in the shape of, in the form of, in terms of
-: in full view of, in plain view of, in view of, within sight of, in the event of, for the use of, for use by
-: at the disposal of, in the presence of, in the absence of, to the delight of, at the request of, in charge of
-: by means of, by way of, by virtue of
-: clockwise from, counterclockwise from, anticlockwise from, clockwise of
far: far from, far away from, away from, well away from, as far as possible from, as far away as possible from
near: as close as possible to, as near as possible to
far: apart from, clear of, well clear of, out of reach of, well back from, back from
in_front: in front of, before, infront of, ahead of, in from of, in front
behind: behind, behind of, in back of, beyond, past, to the back of, in rear of
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
touching: in contact with, touching, back-to-back with, back to back with
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
top_left: above left of
top_left: upper left of, upper left to, north west of, northwest of, top left of, northwest to, northwest from
top_right: above right of
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
with: with, w/, complete with, together with, along with, accompanied by
with: full of, half full of, filled with, half filled with
without: without, with out
"""

# Relation words that stand alone: 'the cup in front', 'nearby'.
_PLACES_ALONE = """
in_front: in front, out front, up front, in the foreground
behind: behind, in back, out back, in the background, beyond
above: above, overhead, up above
below: below, down below, underneath
on: on top
middle: centrally, dead centre, dead center, in dead centre, smack in the middle, bang in the middle, slap in the middle
top: up top, up high, high up, at top
left: at left
right: at right
middle: at centre, at center, in centre, in center, in middle
behind: at rear, at back
in_front: at front
beside: beside
inside: inside, within
outside: outside
near: nearby, close by, near by, close, close at hand
left: left, leftward, leftwards, far left, farthest left, furthest left, most left, west
right: right, rightward, rightwards, far right, farthest right, furthest right, most right, east
between: in between
around: all around, around
opposite: opposite, across
upside_down: upside down, face down, mouth down, bottom up, face-down, mouth-down, upside-down
near_each_other: one next to the other, one beside the other
row: one behind the other, one in front of the other, one after the other, single file, in single file
near_each_other: side by side, next to each other, next to one another, beside each other, together, close together
near_each_other: near each other, adjacent to each other, beside one another
nested: inside one another, nested in one another, one inside the other, inside each other, nested in each other
stacked: on top of each other, on top of one another, one on top of the other, one on top of another, one upon another
stacked: stacked inside one another
parallel_each_other: parallel, parallel to each other, in parallel
one_each: one each, one apiece, one for each, respectively
inward: inward, inwards, inboard
outward: outward, outwards, outboard
there: within sight, within reach, within easy reach, within arm 's reach
there: straight ahead, directly ahead, dead ahead
there: over there, there, here, out there, up there, down there
apart: apart, away, far away
alone: by itself, all by itself, on its own, all on its own, by themselves, on their own, all alone
forward: forward, forwards, ahead
backward: backward, backwards, rearward
there: anywhere, everywhere, somewhere, nowhere
up: up, upward, upwards, skyward, skywards, uppermost
down: down, downward, downwards, lowermost
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
        for relation, phrases in table(_PREPOSITIONS).items()
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
    return {phrase: Preposition(phrase, relation) for phrase, relation in inverted(table(_PLACES_ALONE)).items()}


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
