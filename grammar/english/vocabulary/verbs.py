"""Verbs with their forms, by what they tell: a posture, an action, a relation, a report."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from deixis.grammar.english.vocabulary.tables import table, word_set

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
posture: draw draws drew drawn drawing, strew strews strewed strewn strewing, sweep sweeps swept swept sweeping
posture: sink sinks sank sunk sinking, wind winds wound wound winding, drive drives drove driven driving, stash
posture: weave weaves wove woven weaving
posture: sling slings slung slung slinging, preset presets preset preset presetting
posture: thrust thrusts thrust thrust thrusting, burn burns burnt burnt burning, loop, huddle, snuggle
posture: deposit, sort, follow, bundle, plop, plonk, dump, snap, hoist, lash, moor, plaster, paste, stencil
lean: lean leans leant leant leaning, prop, lean
face: face, stare, gaze, peer, view
point: point, aim, direct, open
transitive: hold holds held held holding, contain, support, touch, cover, have has had had having, share, include
transitive: show shows shown shown showing, carry carries carried carried carrying, surround, block, flank, feature
transitive: overlook, border, abut, adjoin, wear wears wore worn wearing, bear bears bore borne bearing, display, divide
transitive: separate, own, resemble, match matches matched matched matching, use, meet meets met met meeting
transitive: overlap, hug, intersect, enclose, house
transitive: serve, form, make makes made made making, occupy occupies occupied occupied occupying
other: read reads read read reading, need, allow, mean, move, change, water
other: start, help, look, walk, enter, approach, turn
other: come comes came come coming, want, like, say says said said saying, think thinks thought thought thinking, try
other: eat eats ate eaten eating, drink drinks drank drunk drinking, write writes wrote written writing, wash, let, take
other: takes took taken, open, close, know knows knew known knowing, give gives gave given giving, call, work, happen
other: lose loses lost lost losing, sell sells sold sold selling, buy buys bought bought buying
other: steal steals stole stolen stealing, forget forgets forgot forgotten forgetting, send sends sent sent sending
other: listen, shift, transfer, relocate, return
other: describe, mention, do does did done doing, set, share, watch, finish, order, ask, prefer, wait, notice
other: see sees seen seen seeing
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
other: replace, provide, require, protect, prevent, receive, create, explain, reduce, avoid, knock
other: become becomes became become becoming
other: rinse, tighten, loosen, unscrew, unplug, preheat, assemble, remove, repeat, mind, admire, inspect
other: destroy, believe, weigh, bake, allow
other: bind binds bound bound binding, upholster, gild, enamel, lacquer, varnish
posture: clamp, clip, stow, slip, sew sews sewed sewn sewing, string strings strung strung stringing, lower
transitive: encircle, straddle
other: burrow, roam, relegate, graze, save, conserve, absorb, soften, maximize, minimize, improve, enhance, achieve
other: catch catches caught caught catching, break breaks broke broken breaking, tear tears tore torn tearing
other: hear hears heard heard hearing
other: pay pays paid paid paying, light lights lit lit lighting, shut shuts shut shut shutting
other: split splits split split splitting, feed feeds fed fed feeding, dig digs dug dug digging
other: flow, drip, trickle, spoil, expire, perish, rot, wilt
other: melt, freeze freezes froze frozen freezing, strike strikes struck struck striking, win wins won won winning
other: shake shakes shook shaken shaking, spin spins spun spun spinning, cut cuts cut cut cutting
other: pick, pluck, trap, squash, reach, arrive, enjoy, own, own, wish, decide, belong, blow blows blew blown blowing
posture: ride rides rode ridden riding, rise rises risen risen rising, languish, lurk, bask, recline, jostle, flutter
posture: drift, emerge, congregate, overhang overhangs overhung overhung overhanging, sprout, flop
posture: grow grows grew grown growing, bloom, thrive, climb, creep creeps crept crept creeping, flourish, blossom
posture: slant, topple, collapse, cling clings clung clung clinging, intrude, peek, abide
posture: dwell dwells dwelt dwelt dwelling
posture: dock, hitch, tether, latch, snag, interleave, immerse, submerge, chuck, fling flings flung flung flinging
posture: toss, pop, plump, plant, deposit, dab, smear, hammer, tap, bung, whack, thumbtack, staple, stitch, peg
transitive: span, adorn, grace, cradle, accommodate, sport, boast, crown, cap, skirt, fringe, ring
other: fly flies flew flown flying, swim swims swam swum swimming, crawl, leap leaps leapt leapt leaping, jump
other: unpack, unload, unhook, detach, disassemble, discard
other: simmer, stir, whisk, knead, marinate, garnish, refrigerate, adjust, rotate, straighten, flatten, verify, confirm
other: dispose, emphasize, emphasise, ensure, remind, imagine, disconnect, dismantle, vary, differ
other: lead leads led led leading, separate, shine shines shone shone shining, block, belong, protrude, jut, stick, fill
posture: stuff, file, reposition, rearrange, plunk, corral, collect, consolidate, distribute, sow, restore, berth, wad
posture: sheathe, lug, haul, conceal, hoard, ensconce, mound, ease, guide, maneuver, manoeuvre
posture: wiggle, flip, invert, upend, cascade, confine, banish, interlace, intersperse, superimpose, juxtapose
posture: elevate, implant, transplant, repot, rehang rehangs rehung rehung rehanging, reinsert, reinstall, reattach
posture: reconnect, restack, replant, unroll, tack, rack, chain, wire
other: alter, amend, cultivate, define, develop, merge, mince, poach, refold, slather, uncover
other: accept, accomplish, acquire, adapt, adhere, admit, adopt, adore, afford, analyse, analyze, annotate, announce
other: annoy, anticipate, apologize, appreciate, approve, ascend, assess, assist, assure, attend, attract
other: baste, bathe, behave, blanch, borrow, bother, braise, breathe, brighten, broaden, browse, calculate
other: calibrate, celebrate, characterize, cherish, chop, clarify, cleanse, coincide, combine, commemorate
other: communicate, compare, compensate, compete, compile, complain, comply, comprise, concentrate
other: condense, conduct, conform, confuse, consider, consist, constitute, consume, contribute
other: convert, convey, convince, cook, cooperate, coordinate, correspond, crumble, customise, customize, dampen
other: darken, deadhead, decant, declare, declutter, decorate, dedicate, deepen, defend, defrost, degrease, delete
other: deliver, demonstrate, deny, depend, depict, deserve, detect, deter, deteriorate, determine, detract, devote
other: diffuse, dilute, diminish, disappear, discover, discuss, disguise, disinfect, disrupt, dissolve
other: distinguish, distract, disturb, dominate, donate, earn, educate, eliminate, elongate, embellish, embody, emit
other: employ, enable, encourage, endanger, endure, engage, engrave, enlarge, enlighten, enrich, entertain, equip
other: erase, erect, establish, estimate, evaluate, evaporate, evoke, exaggerate, examine, exceed, excel, excite
other: execute, exist, expand, expect, explore, expose, extinguish, facilitate, fade, familiarize, ferment
other: fertilize, finalize, flatter, formulate, fortify, foster, freshen, frighten, fulfil, fulfill, generate
other: germinate, greet, halve, harden, harmonize, hasten, heighten, hesitate, hibernate, hinder, hire
other: hydrate, ignite, illuminate, illustrate, imitate, impose, impress, incorporate, indicate, induce, indulge
other: inflate, inform, infuse, inhabit, inherit, inhibit, initiate, injure, inspire, instruct, insulate, integrate
other: intend, interact, interfere, interpret, interrupt, introduce, invent, invest, invite, involve, isolate
other: itemize, jeopardize, justify, launder, lengthen, lessen, lighten, loathe, lubricate, magnify, maintain
other: manage, manipulate, memorize, mingle, minimise, misplace, modify, moisten, motivate, multiply, narrate
other: navigate, neaten, necessitate, neglect, neutralize, nourish, obey, obstruct, obtain, offend, omit, operate
other: oppose, optimize, originate, overcook, overfill, overheat, overpower, overshadow, overwater, overwhelm, owe
other: participate, penetrate, perceive, perform, persist, personalize, persuade, pertain, polish, pollinate, ponder
other: portray, possess, postpone, precede, predict, prepare, preserve, prevail, prioritise, prioritize, proceed
other: proclaim, procure, prohibit, proliferate, prolong, promote, pronounce, propagate, propose, prosper, prune
other: publish, pulverize, purify, pursue, qualify, quench, radiate, reassemble, reassure, recharge, recite
other: reclaim, recognise, recognize, reconsider, reconstruct, recover, recreate, redecorate, redefine
other: refer, refine, refinish, reflect, refrain, refresh, regain, regulate, reheat, reinforce, reject, relate
other: relax, relieve, rely, remember, renew, renovate, repaint, represent, reproduce, repurpose, resist, resolve
other: respond, restrain, restrict, resume, retain, retire, retrieve, reuse, revise, revisit, revolve, ripen
other: sanitise, sanitize, satisfy, saturate, scour, sharpen, shatter, shorten, sift, signify, simplify, soothe
other: stabilize, startle, sterilize, stimulate, strengthen, submit, succeed, suffer, suffice, summarize, supervise
other: surpass, survive, sustain, sweeten, symbolise, symbolize, tempt, tend, terminate, thicken, threaten, tolerate
other: transform, translate, transmit, undermine, unify, unite, unlock, untangle, untie, unwrap, unzip, utilise
other: utilize, vanish, ventilate, vibrate, violate, visualize, wander, warn, weaken, widen, wither, worry, yank
other: yearn, understand understands understood understood understanding
other: withdraw withdraws withdrew withdrawn withdrawing, undo undoes undid undone undoing
other: redo redoes redid redone redoing, overcome overcomes overcame overcome overcoming
other: oversee oversees oversaw overseen overseeing, lend lends lent lent lending
other: teach teaches taught taught teaching, forgive forgives forgave forgiven forgiving
other: foresee foresees foresaw foreseen foreseeing
other: undertake undertakes undertook undertaken undertaking, withstand withstands withstood withstood withstanding
other: prove proves proved proven proving, rethink rethinks rethought rethought rethinking
other: rebuild rebuilds rebuilt rebuilt rebuilding, seek seeks sought sought seeking
other: spend spends spent spent spending, deal deals dealt dealt dealing, fight fights fought fought fighting
"""

REPORTS = word_set(
    "states claims reports says insists maintains asserts swears testifies stated claimed reported said insisted"
    " maintained asserted swore testified alleges alleged assume assumes assumed suppose supposes presume presumes"
    " reckon reckons suggest suggests suggested recommend recommends advise advises argue argues pretend pretends"
)
"""Verbs of persons who tell something that need not be so."""

SAYING = word_set(
    "swore swears says said claims claimed insists insisted believes thinks thought reckons"
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
    "adorn": ("inside", False),
    "grace": ("inside", False),
    "fill": ("inside", False),
    "span": ("across", False),
    "cradle": ("inside", True),
    "accommodate": ("inside", True),
    "house": ("inside", True),
    "sport": ("with", False),
    "boast": ("with", False),
    "crown": ("on", False),
    "cap": ("on", False),
    "skirt": ("along", False),
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
    "choose find select pick locate identify click want take use get grab hit lift spot point search chose need note"
    " notice observe"
)

PUT_VERBS = word_set(
    "put place set lay position keep leave stand arrange hang stack lean rest move slide push add drop insert store"
    " line fold roll turn center centre align tuck mount attach install fix plug bring stick spread"
    " surround situate locate seat nest wrap pile prop start finish balance"
    " plant heap pour scatter screw bolt glue nail tape strap sprinkle drizzle spoon load thread drape lower raise pin"
    " slot hook suspend fasten secure connect press wedge nestle space clip clamp tip park sit lodge sandwich group"
    " tie shelve stow bury hide cram slip pack feed affix anchor angle straddle"
    " hammer tap pop chuck toss fling hitch latch staple stitch peg dab smear immerse submerge dock"
    " cover top fill flank tilt swing pull lift drag scoop ladle fit float dot fan return"
    " scoot snake wheel cluster layer stash nudge transfer shift display hoist squeeze settle deposit organize"
    " organise lash"
    " stuff file reposition rearrange plunk corral collect consolidate distribute sow restore berth wad sheathe lug"
    " haul conceal hoard ensconce mound ease guide maneuver manoeuvre wiggle flip invert upend cascade"
    " confine banish interlace intersperse superimpose juxtapose elevate implant transplant repot rehang reinsert"
    " reinstall reattach reconnect restack replant unroll tack rack chain wire"
)

PLACING_VERBS = word_set(
    "place put store keep leave lay position arrange insert attach install hang tuck stack set stow mount fix stand"
    " situate locate"
)
"""Verbs that say where things are put; their object can be left out: *cut the bread and place in the basket*."""

NAMED_LIKE_THINGS = word_set(
    "plant heap screw bolt glue nail tape strap spoon load thread pin slot hook press wedge clip clamp tip park group"
    " tie pack feed anchor angle top lower fit dot fill float cover position space spread stick stack pile line drop"
    " hammer tap pop staple stitch peg dab smear dock hitch latch"
    " center centre turn roll fold fan prop nest seat store rest stand set place mount slide bring"
    " snake wheel cluster layer transfer shift display squeeze nudge"
    " stuff file mound guide flip tack rack chain wire"
)
"""Commands whose verb is a noun as well: *screw the bracket to it* and *screw holes*."""

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

LINKING_VERBS = frozenset({"look", "seem", "appear", "remain", "stay"})
"""Verbs that join a quality to their subject: *it looks nice*."""

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
    for kind, entries in table(_VERBS).items():
        for entry in entries:
            parts = entry.split()
            lemma = parts[0]
            forms: dict[str, str] = dict(zip(("s", "past", "participle", "ing"), parts[1:], strict=False))
            for form, regular in (("base", lemma), *_regular(lemma).items()):
                if lemma in NOUNS_BEFORE_VERBS and form in ("base", "s"):
                    continue
                word = forms.get(form, regular) if form != "base" else lemma
                found.setdefault(word, VerbForm(lemma, kind, form))
    for lemma in sorted(PUT_VERBS | FIND_VERBS):
        found.setdefault(lemma, VerbForm(lemma, "posture", "base"))
    return found


NOUNS_BEFORE_VERBS = word_set(
    "draw sink wind drive sling snap loop bundle dump paste plaster stencil deposit clip clamp ring tower string"
    " range coil slip lower fill stow plant heap spoon load"
    " thread pack feed scoop dot ladle stretch swing"
    " pop plump dab smear hammer tap staple stitch peg latch dock hitch cap crown ring light cut split shut catch break"
    " bloom tear pick strike melt fringe sport boast cradle skirt"
    " file tack rack chain wire guide mound stuff"
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
                      "bob", "strap", "drag", "transfer", "refer", "tap", "pop", "dab", "peg", "flop",
                      "snag", "cap", "trap", "travel", "omit", "submit", "emit", "admit", "excel", "deter", "equip",
                      "chop", "repot", "wad", "flip", "corral"})  # fmt: skip
