"""Join the phrases of a predicate: what verbs and participles make of the places after them."""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.chunk import VerbGroup
from deixis.grammar.english.clauses.built import Noun, Predication, misunderstood, union
from deixis.grammar.english.clauses.places import arrangement_of
from deixis.grammar.english.tree import (
    Adjective,
    Degree,
    NounPhrase,
    Predicate,
    Span,
    aimed,
)
from deixis.grammar.english.vocabulary.nouns import (
    AIMED_PARTS,
    GAPS,
    HOLDERS,
    PARTS,
    SUPPORTS,
    SURFACES,
    VESSELS,
    last_word,
)
from deixis.grammar.english.vocabulary.relation_words import NOT_PLACES, PLACE_NOUNS
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import ENTER_VERBS, TRANSITIVE_RELATIONS
from deixis.ontology.graph.claims import PLACES

DIRECTION_RELATIONS = word_set(
    "corner left right top bottom above below in_front behind top_left top_right bottom_left bottom_right under inside"
    " on beside near"
)
"""Relations of places, which can stand without an object and take that of their neighbour."""
MOVING = frozenset(
    {"shift", "transfer", "relocate", "return", "move", "bring", "slide", "push", "add", "carry", "take"}
)
WRAPPING = {"cover": "on", "top": "on", "line": "on", "fill": "inside", "pack": "inside", "flank": "each_side"}
"""Relation of what a command uses to the thing that it changes: *cover the bowl with a cloth*."""
_ATTACHING = word_set(
    "affix hinge anchor glue screw bolt secure nail tape strap attach fix mount connect lash"
    " join fasten tie hook link stick pin clip clamp wire press"
)
"""Verbs after which *to* means that two things touch."""
AWAY_FROM = {"off": "on", "off of": "on", "out of": "inside"}
"""Prepositions that, after a verb of being or staying, deny a place: *keep the cat off the table*."""
_KEEPING = frozenset({"keep", "leave", "stay", "remain"})
_REACHING = frozenset({"get", "come", "listen", "ask", "look"})
"""Verbs after which *at*, *to* and *for* name no place of the subject."""
_AT_THE_SUBJECT = frozenset({"inside", "on", "under", "beside", "above", "around", "in_front", "behind"})
"""Relations that, without an object, are to the thing that *with* describes: *a dish with the swabs inside*."""
_COVERING = frozenset(
    {
        "spread",
        "drape",
        "throw",
        "sprinkle",
        "pour",
        "pull",
        "fold",
        "scatter",
        "wrap",
        "hook",
        "sling",
        "loop",
        "fling",
    }
)
"""Verbs after which *over* means *on*."""
_OUTER = frozenset({"back", "front", "side", "edge", "end", "corner"})
"""Parts of a thing over which a cover hangs."""
_DIRECTIONAL = frozenset(
    {"left", "right", "top", "bottom", "in_front", "behind", "above", "below", "far", "near", "part"}
)
_HANGING = frozenset({"hang", "dangle", "suspend", "swing", "droop", "sling"})
"""Verbs after which what is *from* a thing is on it."""
_LYING = frozenset({"lay", "lie", "fall", "rest"})
"""Verbs after which *on its left side* says how a thing lies."""
_LAID = _LYING | {"turn", "flip", "tip", "put", "place", "set"}
"""Verbs after which *on its back* says how a thing lies."""
_OWN_EDGES = {"edge": (None, "front", "back", "long", "short"), "end": (None,)}
"""Words for the edges and ends on which a thing can lie itself: *it lies on its front edge*."""
_LEADING = word_set("door doors doorway entrance entry exit gate path stairs way hallway steps door_way")
_LEAPING = word_set("jump leap climb walk step pass skip hop")
"""Verbs of a motion past a thing."""
_PASSING = word_set("go run fit thread insert slot poke push pull stick feed slip slide protrude hang plug")
"""Verbs after which what is *through* a thing is in it."""
_PASSIVES = {
    "surround": "around", "enclose": "around", "encircle": "around", "ring": "around", "flank": "each_side",
    "cover": "on", "bury": "on", "top": "on", "support": "under", "border": "next_to", "follow": "follows",
}  # fmt: skip
"""Relation of the agent of a participle to its subject: *surrounded by cups*."""
_TREATING = word_set(
    "wash rinse wet soak dampen moisten"
    " clean wipe polish dry scrub brush sweep dust rub mop sponge bathe cut slice chop carve peel open close"
    " shut seal secure fix fasten tie mark paint varnish oil grease glue sand treat spray cook heat boil burn warm cool"
    " make build construct create shape use compare associate replace mix blend combine stir pair match eat drink serve"
    " test check measure adjust tighten loosen move lift deal confuse connect concern"
)
"""Verbs after which *with* names a means or a companion, and not what a thing holds: *washed with soap*."""
_EXTENDING = frozenset({"reach", "extend", "stretch"})
"""Verbs after which a direction without an object is where a thing points: *its branches reach to the left*."""
_ROTATING = frozenset({"turn", "rotate", "angle", "tilt", "swivel"})
_SHAPING = frozenset({"fold", "roll", "cut", "shape", "form", "tie", "twist", "slice", "divide", "turn", "arrange"})
_CUTTING = frozenset({"fold", "cut", "slice", "shape", "form"})
"""Verbs after which *in* and a bare noun name a shape too: *folded in squares*, but *rolled in napkins*."""
_STATES = frozenset({"burn", "fold", "roll", "turn", "open", "hide", "bury", "tip"})
_STAYING = word_set(
    "stand sit lie lay hang put place position locate situate set keep leave rest stay remain park stow store mount"
    " lean prop nestle perch find see go come wait live stop linger belong be"
)
"""Verbs after which *by* means *near*."""
_TELLING = word_set(
    "mention describe list show note picture record state name quote illustrate explain depict photograph"
)
"""Verbs after which *in* names a text or a picture."""

_LEAVING = word_set(
    "roll come take move pull fall slip drop slide get remove fetch bring push lift drag carry run crawl jump fly"
)
"""Verbs after which *from under* and *from behind* say where something was."""

_RANGING = frozenset({"line", "range", "queue", "row"})
"""Verbs by which things get into a row: *lined up on the shelf*."""

_ARRANGING = {"stack": "stacked", "pile": "stacked", "nest": "nested", "line": "row", "align": "row"}
"""Relation of several things together by the participle that states it alone: *the plates are stacked*."""

_FORMING = frozenset({"form", "make", "build"})
"""Verbs whose object can be an arrangement of the subject: *the cups form a circle*."""

_FINISHING = word_set("bind bound upholster gild enamel lacquer varnish paint print dress cast carve engrave sign mark")
"""Verbs after which *in* names a material or a manner."""


def merged(parts: tuple[tuple[Predicate, ...], ...], check: bool = True) -> tuple[Predicate, ...]:
    """Return predicates as one list; a participle gives its meaning to the phrase after it.

    Parameters
    ----------
    parts
        Predicates of each part of a coordination or a sequence of phrases, in the order of the text.
    check
        True to leave out *apart*, and *to* where it names no place, which is noted as misunderstood.

    Returns
    -------
    tuple of Predicate
        Predicates without those that only stood for a participle.
    """
    flat_parts = [predicate for part in parts for predicate in part]
    found: list[Predicate] = []
    i = 0
    while i < len(flat_parts):
        predicate = flat_parts[i]
        following = flat_parts[i + 1] if i + 1 < len(flat_parts) else None
        if predicate.relation.startswith("~"):
            lemma, kind = predicate.relation[1:].split("~")
            if lemma in ("stack", "pile") and following is not None and following.relation != "stacked":
                found.append(Predicate("stacked", (), predicate.span, positive=predicate.positive))
            agent = flat_parts[i + 2] if i + 2 < len(flat_parts) else None
            if (
                lemma in _PASSIVES
                and following is not None
                and following.relation in ("left", "right")
                and not following.arguments
                and agent is not None
                and agent.relation in ("near", "by")
            ):  # 'bordered on the right by a pen'
                flat_parts[i + 1 : i + 3] = [
                    replace(agent, relation=following.relation, reversed=True, span=union(following.span, agent.span))
                ]
                i += 1
                continue
            ranged = following is not None and lemma in _RANGING and not following.reversed
            if ranged and following is not None and following.relation not in ("row", "with", "inside"):
                found.append(Predicate("row", (), predicate.span, positive=predicate.positive))
            if following is not None and lemma in _SHAPING and _is_shape(lemma, following):
                misunderstood(following.span, "this says what shape something gets, not where it is")
                found += [p for argument in following.arguments for p in argument.predicates]
                i += 2
                continue  # 'folded into a fan'
            if following is not None and lemma == "base" and following.relation == "on":
                misunderstood(following.span, "this says what something follows, not where it is")
                i += 2
                continue  # 'based on the old layout'
            if following is not None and lemma in _LEAVING and any(a.startswith("from ") for a in following.adverbs):
                misunderstood(following.span, "this says where something was")
                i += 2
                continue  # 'the ball rolled from under the table'
            if following is not None and lemma in ("center", "centre") and following.relation in ("on", "inside"):
                found.append(replace(following, relation="middle"))  # 'centred on the table'
            if following is not None and not following.relation.startswith("~"):
                flat_parts[i + 1] = _meant(lemma, kind, predicate, following)
                placed = following.relation == "pointing" or lemma == "hide"  # 'hide the key under the mat'
                if lemma in _STATES and not placed:
                    found.append(_state(lemma, predicate))
            elif following is None and lemma in _ARRANGING:
                found.append(Predicate(_ARRANGING[lemma], (), predicate.span, positive=predicate.positive))
            elif following is None and lemma in ("find", "see", "notice", "present"):
                found.append(Predicate("there", (), predicate.span, positive=predicate.positive))
            elif (following is None or kind == "unknown") and (kind != "posture" or lemma in _STATES):
                found.append(_state(lemma, predicate))
            i += 1
            continue
        if predicate.measure is not None and not predicate.arguments and following is not None:
            joined = _distance(predicate, following)
            if joined is not None:
                flat_parts[i + 1] = joined[0]
                if joined[1]:
                    found.append(joined[1][0])
                if not joined[0].relation:
                    del flat_parts[i + 1]
                i += 1
                continue
        if (
            following is not None
            and (following.relation == "to" or (following.relation == "from" and predicate.relation in ("near", "far")))
            and not predicate.arguments
            and (
                predicate.relation in ("near", "far")
                or predicate.relation in DIRECTION_RELATIONS
                or (predicate.value is not None and predicate.value.dimension == "clock")
            )
        ):
            predicate = replace(predicate, arguments=following.arguments, span=union(predicate.span, following.span))
            flat_parts[i + 1] = predicate
            i += 1
            continue
        if (
            predicate.relation == "far"
            and predicate.degree is Degree.SUPERLATIVE
            and not predicate.arguments
            and following is not None
            and following.relation in ("left", "right", "top", "bottom", "in_front", "behind")
        ):  # 'the one furthest to the left'
            joined_span = union(predicate.span, following.span)
            flat_parts[i + 1] = replace(following, degree=Degree.SUPERLATIVE, span=joined_span)
            i += 1
            continue
        if (
            predicate.relation == "ordinal"
            and predicate.value is not None
            and following is not None
            and (following.relation == "ordinal" and following.value is None)
        ):
            flat_parts[i + 1] = replace(following, value=predicate.value, span=union(predicate.span, following.span))
            i += 1
            continue
        opening = bool(found) and _tells_opening(found[-1], predicate)
        found += [p for a in predicate.arguments for p in a.predicates] if opening else [predicate]
        i += 1
    found = [replace(p, relation="near") if p.relation == "by" else p for p in found]
    return tuple(checked(found)) if check else tuple(found)


def _is_shape(lemma: str, predicate: Predicate) -> bool:
    """Return True for what something is folded into: *into a fan*, *in squares*, *into thirds*."""
    if "into" in predicate.adverbs or (predicate.relation == "part" and not predicate.arguments):
        return True
    shapes = predicate.arguments if predicate.relation == "inside" and lemma in _CUTTING else ()
    return bool(shapes) and all(
        a.determiner is None and a.owner is None and last_word(a.head) not in VESSELS | HOLDERS for a in shapes
    )


def moved(group: VerbGroup, predications: tuple[Predication, ...], span: Span) -> tuple[Predication, ...]:
    """Give the phrases after a verb the meaning of the verb: *leans against X*, *points to the right*, *faces away*.

    Parameters
    ----------
    group
        Verb before the places.
    predications
        What stands after the verb.
    span
        Place of the verb in the text.

    Returns
    -------
    tuple of Predication
        Places after the verb, as it makes them.
    """
    if not predications:
        if group.lemma == "touch" and not {"almost", "nearly"} & set(group.adverbs):
            return (Predication((Predicate("touching_each_other", (), span),)),)  # 'the cups must not touch'
        if group.kind in ("posture", "lean", "be") or group.lemma in ENTER_VERBS:
            return ()
        misunderstood(span, f"'{group.lemma}' does not say where something is")
        return ()
    if group.kind not in ("posture", "lean", "be", "face", "point") and group.lemma not in ENTER_VERBS:
        misunderstood(span, f"'{group.lemma}' does not say where something is")
        return () if group.lemma in _REACHING else predications
    first, *others = predications
    over = first.predicates[0] if first.predicates else None
    draped = over is not None and over.relation == "above" and bool(over.arguments) and _is_draped(over.arguments[0])
    if group.lemma == "hang" and not group.positive and draped:
        misunderstood(span, "this does not say whether it is there at all")
        return ()  # 'the cloth does not hang over both ends of the table'
    marker = Predicate(f"~{group.lemma}~{group.kind}", (), span, positive=True)
    aims = group.kind in ("face", "point")
    others = [replace(o, predicates=merged(((marker,), o.predicates))) if aims and _denies(o) else o for o in others]
    return (replace(first, predicates=merged(((marker,), first.predicates))), *others)


def _denies(predications: Predication) -> bool:
    """Return True for a place that begins with *not*: *it points at the door, not at the wall*."""
    return bool(predications.predicates) and not predications.predicates[0].positive


def with_support(group: VerbGroup, predications: tuple[Predication, ...]) -> tuple[Predication, ...]:
    """Return the places after a verb of hanging with *on* and *from* as what its subject hangs on.

    Parameters
    ----------
    group
        Verb before the places.
    predications
        What stands after the verb; a place after another one is a restriction of its noun.

    Returns
    -------
    tuple of Predication
        Places in which *it hangs over the fire on a chain* says that the subject, not the fire, is on a chain.
    """
    if group.lemma in _HANGING and predications and len(predications[-1].predicates) > 1:
        places = predications[-1].predicates  # 'it hangs above it from a nail'
        made = (p if p.relation != "from" or not p.arguments else replace(p, relation="on") for p in places[1:])
        predications = (*predications[:-1], replace(predications[-1], predicates=(places[0], *made)))
    last = predications[-1].predicates[-1] if predications and predications[-1].predicates else None
    inner = last.arguments[-1].predicates[-1:] if last is not None and last.arguments else ()
    support = bool(inner) and inner[0].relation in ("on", "from") and bool(inner[0].arguments) and not inner[0].reversed
    if last is None or group.lemma not in _HANGING or not support:
        return predications
    definite = last.arguments[-1].determiner == "the" or last.arguments[-1].owner is not None
    if last.relation in ("on", "from") and not (definite and inner[0].arguments[0].determiner in ("a", "an")):
        return predications  # 'it hangs from a hook on the door', but 'from the lamp on a thread'
    noun = last.arguments[-1]
    bare = replace(noun, predicates=noun.predicates[:-1], span=(noun.span[0], max(noun.span[0], inner[0].span[0])))
    here = replace(last, arguments=(*last.arguments[:-1], bare))
    support_of_subject = replace(inner[0], relation="on")
    return (
        *predications[:-1],
        replace(predications[-1], predicates=(*predications[-1].predicates[:-1], here, support_of_subject)),
    )


def destination(predicate: Predicate) -> Predicate:
    """Return *to the drawer* after a verb of motion as the place where the thing is now.

    Parameters
    ----------
    predicate
        Place after a verb of moving.

    Returns
    -------
    Predicate
        *To* and *into* as a place on, in or at their object; another predicate as it is.
    """
    if predicate.relation != "to" or not predicate.arguments:
        return predicate
    noun = last_word(predicate.arguments[0].head)
    relation = "inside" if noun in VESSELS | HOLDERS else "on" if noun in SURFACES | SUPPORTS else "at"
    return replace(predicate, relation=relation)


def by_means(lemma: str, thing: NounPhrase, predicates: tuple[Predicate, ...]) -> tuple[Predicate, ...]:
    """Return the predicates of a command with *with* read as what it uses: a cover, or a tool, which is left out.

    Parameters
    ----------
    lemma
        Verb in its base form.
    thing
        Object of the verb.
    predicates
        What stands after the verb.

    Returns
    -------
    tuple of Predicate
        Predicates in which *with* and *to* say what the verb makes of them.
    """
    found: list[Predicate] = []
    for predicate in predicates:
        bare = predicate.relation == "with" and not any(a.predicates for a in predicate.arguments)
        if bare and predicate.subject_part is None and lemma in WRAPPING:
            inner = lemma == "line" and last_word(thing.head) in VESSELS | HOLDERS  # 'line the box with paper'
            relation = "inside" if inner else WRAPPING[lemma]
            found.append(replace(predicate, relation=relation, reversed=True))
        elif not bare:
            found.append(predicate)
    return tuple(found)


def transitive(group: VerbGroup, things: Noun, span: Span) -> tuple[Predicate, ...]:
    """Return the predicates of a transitive verb: *holding a pen*, *facing the window*.

    Parameters
    ----------
    group
        Verb group.
    things
        Object of the verb with what belongs to the subject.
    span
        Place of the verb in the text.

    Returns
    -------
    tuple of Predicate
        What the verb with its object says about the subject; empty if it says no place.
    """
    span = union(span, things.phrase.span)
    phrase = things.phrase
    if group.lemma in ("point", "face", "aim") and phrase.head in ("way", "direction") and phrase.adjectives:
        return (Predicate("parallel_each_other", (), span, value=phrase.adjectives[0]), *things.extra)
    if group.lemma in ("face", "look") or group.kind == "face":
        relation, swap = "facing", False
    elif group.lemma in ("point", "aim"):
        relation, swap = "pointing", False
    elif group.lemma in TRANSITIVE_RELATIONS:
        relation, swap = TRANSITIVE_RELATIONS[group.lemma]
    elif group.kind in ("posture",):
        relation, swap = "", False
    else:
        relation, swap = "", False
    if group.lemma in ENTER_VERBS:
        relation = "through"
    if relation == "with":
        found = []
        for member in phrase.members or (phrase,):
            found += accompanied_by(member, span)
        return (*(_adverbs(p, group) for p in found), *things.extra)
    between = tuple(p for p in phrase.predicates if p.relation == "between")
    if last_word(phrase.head) in GAPS and between:  # 'soft bags fill the gaps between the cases'
        return (*between, *things.extra)
    arranged = arrangement_of(phrase) if group.lemma in _FORMING and phrase.determiner in ("a", "an") else None
    if arranged is not None:
        return (Predicate(arranged, (), span, adverbs=group.adverbs, positive=group.positive), *things.extra)
    if not relation:
        misunderstood(span, f"'{group.lemma}' with an object does not say where something is")
        return things.extra
    made = Predicate(
        relation, arguments_of(relation, phrase), span, adverbs=group.adverbs, reversed=swap, positive=group.positive
    )
    return (made, *things.extra)


def _adverbs(predicate: Predicate, group: VerbGroup) -> Predicate:
    return replace(predicate, adverbs=(*group.adverbs, *predicate.adverbs)) if group.adverbs else predicate


def accompanied_by(member: NounPhrase, span: Span) -> list[Predicate]:
    """Return the predicates of *with a napkin on it*, *with its handle pointing right*, *with the monitor*.

    Parameters
    ----------
    member
        Thing after *with*.
    span
        Place of the phrase in the text.

    Returns
    -------
    list of Predicate
        Where the thing is, or that the subject has it.
    """
    found: list[tuple[Predicate, bool]] = []
    rest: list[Predicate] = []
    is_part = last_word(member.head) in PARTS or (member.owner is not None and member.owner.pronoun is not None)
    if member.head in GAPS:
        return []
    for predicate in member.predicates:
        if member.determiner == "the" and not member.plural:
            predicate = aimed(predicate)  # 'with the cable hole towards the back'
        faces = predicate.relation in ("facing", "pointing") and last_word(member.head) in AIMED_PARTS
        if faces and any(argument.pronoun == "it" for argument in predicate.arguments):
            found.append((predicate, False))  # 'right of the plate with the blade facing it'
        elif any(argument.pronoun in ("it", "they") for argument in predicate.arguments):
            one = any(argument.pronoun == "it" and not argument.head for argument in predicate.arguments)
            predicate = replace(predicate, of_one=one)
            found.append((predicate, True))
        elif any(_is_of_it(argument) for argument in predicate.arguments):
            found.append((predicate, True))  # 'a plate with a knife across its edge'
        elif not predicate.arguments and predicate.part is None and predicate.relation in _AT_THE_SUBJECT:
            found.append((replace(predicate, arguments=(member,)), True))
        elif predicate.relation == "state" and not is_part and any(p.arguments for p in member.predicates):
            rest.append(predicate)  # 'with the strop folded on top of the case'
        elif predicate.relation in ("pointing", "facing") and not is_part and member.plural:
            rest.append(predicate)  # 'with the drilled holes facing up'
        elif predicate.relation in ("pointing", "facing", "open", "state", "parallel") and member.determiner != "a":
            found.append((predicate, False))
        else:
            rest.append(predicate)
    bare = replace(member, predicates=tuple(rest))
    if member.determiner == "no":  # 'the table has no drawer under its top'
        found = [(replace(predicate, positive=not predicate.positive), swapped) for predicate, swapped in found]
        bare = replace(bare, determiner="a")
    made = []
    for predicate, swapped in found:
        if swapped and len(predicate.arguments) == 1:
            made.append(replace(predicate, arguments=(bare,), reversed=True, span=span))
        else:
            made.append(replace(predicate, subject_part=bare, span=span))
    return made or [Predicate("with", (member,), span)]


def _is_of_it(phrase: NounPhrase) -> bool:
    """Return True for a part or a place of *it*: *its right-hand edge*."""
    owned = phrase.owner is not None and phrase.owner.pronoun == "it"
    return owned and (last_word(phrase.head) in PARTS or phrase.head in PLACE_NOUNS)


def arguments_of(relation: str, phrase: NounPhrase) -> tuple[NounPhrase, ...]:
    """Return the arguments of a relation.

    Parameters
    ----------
    relation
        Name of the relation.
    phrase
        Noun phrase after the preposition.

    Returns
    -------
    tuple of NounPhrase
        Members of the phrase for *between* and *among*, otherwise the phrase.
    """
    if relation in ("between", "among") and phrase.members and phrase.joined_by == "and":
        return phrase.members
    return (phrase,)


_SEATS = frozenset({"place", "seat", "chair", "end", "side", ""})
"""Nouns after *at* that are a place of a thing as a whole: *the menu lies open at each place*."""


def checked(found: list[Predicate], phrase: NounPhrase | None = None) -> list[Predicate]:
    """Return predicates without the marks of participles.

    Parameters
    ----------
    found
        Predicates of one subject.
    phrase
        The subject, or None.

    Returns
    -------
    list of Predicate
        Predicates without participles that say nothing about a place, which are noted as misunderstood.
    """
    kept = []
    for predicate in found:
        if predicate.relation == "apart":
            continue
        if predicate.relation == "to":
            if phrase is not None and (
                len(phrase.head) == 1
                or phrase.pronoun == "one"
                or phrase.head.endswith(("angle", "degree"))
                or phrase.head.rpartition(" ")[2] in _LEADING
                or phrase.head == "relation"
            ):
                kept.append(predicate)
                continue
            misunderstood(predicate.span, f"'{predicate.relation}' does not say where something is here")
            continue
        kept.append(predicate)
    return kept


def _tells_opening(state: Predicate, following: Predicate) -> bool:
    """Return True for the place where a thing is open or closed: *a book open at page 40*, *a box open at the back*."""
    apart = state.relation not in ("open", "closed") or following.span[0] > state.span[1] + 1
    if apart or following.measure is not None:
        return False
    nouns = {last_word(argument.head) for argument in following.arguments}
    where = following.relation == "at" and bool(nouns) and nouns.isdisjoint(SURFACES | _SEATS)
    return where or (following.relation in PLACES | {"top", "bottom"} and not nouns)


def _state(lemma: str, marker: Predicate) -> Predicate:
    word = Adjective(lemma, "state", Degree.PLAIN, marker.span)
    return Predicate("state", (), marker.span, value=word, adverbs=marker.adverbs, positive=marker.positive)


def _meant(lemma: str, kind: str, marker: Predicate, following: Predicate) -> Predicate:
    span = union(marker.span, following.span)
    if kind in ("face", "point") or lemma in ("look", "aim", "lean") or lemma in _ROTATING:
        following = aimed(following)
    relation, value, arguments = following.relation, following.value, following.arguments
    if relation == "to" and arguments and lemma in MOVING:
        relation = destination(following).relation
    if relation == "to" and arguments:
        if lemma in _ATTACHING:
            relation = "touching"
        elif lemma in ("pull", "push", "tuck", "move", "scoot", "park"):
            relation = "near"
    if (kind == "lean" or lemma in ("lean", "prop")) and relation in ("against", "on", "at", "near"):
        relation = "leaning"
    elif (
        lemma in _ROTATING and not arguments and (relation in ("left", "right") or following.part in ("left", "right"))
    ):
        value = Adjective(following.part or relation, "position", Degree.PLAIN, following.span)
        relation = "facing"
    elif lemma in _ROTATING and relation == "far":
        value = Adjective("away", "position", Degree.PLAIN, following.span)
        relation, arguments = "facing", ()  # 'turn the label away from you'
    elif lemma in _ROTATING and relation in ("to", "facing", "pointing") and arguments:
        relation = "facing"  # 'its opening turned to the fire'
    elif lemma == "fill" and relation in ("part", "top") and not any(a.startswith("at") for a in following.adverbs):
        relation = "through"  # 'filled to the top'
    elif relation == "with" and not _TREATING.isdisjoint((lemma, lemma.removesuffix("ed"), lemma.removesuffix("d"))):
        relation = "through"  # 'washed with soap'
    elif relation == "through" and lemma in _PASSING:
        relation = "inside"  # 'the bolt goes through the hole'
    elif lemma.removesuffix("ed") in _LEAPING and relation in ("above", "across", "under", "between"):
        relation = "through"  # 'the cat jumped over the vase'
    elif kind == "point" and relation in ("middle", "corner", "edge", "end", "side", "part"):
        word = " ".join(filter(None, (following.part, relation)))
        return replace(following, relation="pointing", arguments=(), part=word, span=span)
    elif (
        kind in ("face", "point")
        or lemma in ("look", "aim")
        or (lemma in _EXTENDING and not arguments and following.part != "side")
    ):  # but 'the keyboard is extended on the right-hand side'
        meaning = "pointing" if kind == "point" or lemma in _EXTENDING else "facing"
        if relation == "pointing":
            relation = meaning
        elif not arguments and (relation in _DIRECTIONAL or following.part):
            value = Adjective((following.part or relation).replace("_", " "), "position", Degree.PLAIN, following.span)
            relation = meaning
        elif relation in ("to", "at", "facing", "pointing", "inside", "near", "on"):
            relation = meaning
        elif relation in ("above", "across") and lemma == "look":
            relation = meaning  # 'the window looks out over the garden'
        elif relation in ("far", "apart"):
            value = Adjective("away", "position", Degree.PLAIN, following.span)
            relation = meaning
    elif (lemma in _HANGING and relation == "from") or (
        lemma in ("stack", "pile") and relation in ("on", "stacked") and arguments
    ):
        relation = "on"
    elif lemma in ("centre", "center") and relation == "on":
        relation = "middle"
    elif lemma in _LYING and relation in ("left", "right") and following.part == "side" and _is_it(arguments):
        lying = Adjective("sideways", "state", Degree.PLAIN, following.span)  # 'lay the frame on its left side'
        return Predicate("state", (), span, value=lying, positive=marker.positive)
    elif lemma in _LAID and relation == "part" and following.part in ("far", "back") and _is_it(arguments):
        lying = Adjective("on its back", "state", Degree.PLAIN, following.span)  # 'turn the chair on its back'
        return Predicate("state", (), span, value=lying, positive=marker.positive)
    elif (
        lemma in _LAID - {"rest"}
        and relation in ("edge", "end")
        and following.part in _OWN_EDGES[relation]
        and _is_it(arguments)
    ):
        standing = Adjective(f"on its {relation}", "state", Degree.PLAIN, following.span)  # 'lay it on its front edge'
        return Predicate("state", (), span, value=standing, positive=marker.positive)
    elif lemma == "hang" and relation == "part" and arguments:
        return replace(following, relation="on", part=None, span=span)  # 'on the back of the door'
    elif relation in ("behind", "in_front") and lemma in _ATTACHING and not arguments:
        relation = "through"  # 'stuck to the front'
    elif relation in ("behind", "in_front") and lemma in _ATTACHING and any("to the" in a for a in following.adverbs):
        relation = "touching"  # 'tied to the back of the chair'
    elif relation == "next_to" and lemma in _ATTACHING and any("side of" in a for a in following.adverbs):
        relation = "touching"  # 'clipped to the side of the jug'
    elif lemma == "align" and relation == "with":
        relation = "aligned"
    elif lemma == "line" and relation == "with":
        relation = "aligned" if "up" in (*marker.adverbs, *following.adverbs) else "through"  # 'lined with felt'
    elif lemma in _FINISHING and relation in ("inside", "on", "with"):
        relation = "through"  # 'bound in calfskin'
    elif lemma in _TELLING and relation in ("inside", "on", "at"):
        relation = "through"  # 'mentioned in the catalogue'
    elif lemma in ("cover", "coat", "drape") and relation == "with":
        denied = following.positive is not marker.positive
        return replace(following, relation="on", reversed=True, span=span, positive=not denied)
    elif relation == "above" and lemma in _COVERING and arguments and arguments[0].head in _OUTER and arguments[0].of:
        relation, arguments = "on", (arguments[0].of,)  # 'draped over the back of the chair'
    elif relation == "above" and lemma == "hang" and arguments and _is_draped(arguments[0]) and arguments[0].of:
        relation, arguments = "on", (arguments[0].of,)  # 'the cloth hangs over both ends of the table'
    elif relation == "above" and arguments and arguments[0].head in ("rim", "lip"):
        pass  # 'hooked over the rim'
    elif relation == "above" and (lemma in _COVERING or (lemma in ("lay", "lie") and "over" in following.adverbs)):
        relation = "on"
    elif lemma in ("stick", "poke", "peek", "peep", "protrude", "hang", "jut") and relation == "from":
        relation = "inside"
    elif lemma in ("divide", "split", "separate", "cut", "break") and relation in ("inside", "near", "by"):
        relation = "through"
    elif relation == "by" and lemma not in _PASSIVES and lemma not in _STAYING:
        relation = "through"  # 'sorted by price', 'hidden by the lamp' name no place
    elif lemma in _PASSIVES and relation in ("near", "by") and kind != "be":
        denied = following.positive is not marker.positive  # 'behind the door, not covered by a cloth'
        return replace(following, relation=_PASSIVES[lemma], reversed=True, span=span, positive=not denied)
    positive = following.positive if marker.positive else not following.positive
    if lemma in _KEEPING and relation == "from" and (left := place_left(following)) is not following:
        relation, positive = left.relation, not positive
    return replace(
        following,
        relation=relation,
        value=value,
        arguments=arguments,
        span=span,
        positive=positive,
        adverbs=(*marker.adverbs, *following.adverbs),
    )


def place_left(predicate: Predicate) -> Predicate:
    """Return *off the table* and *out of the box* as the denial of the place.

    Parameters
    ----------
    predicate
        Predicate that may have such a preposition.

    Returns
    -------
    Predicate
        Denied place; the predicate itself if it names none.
    """
    left = next((place for word, place in AWAY_FROM.items() if word in predicate.adverbs), None)
    if predicate.relation != "from" or left is None or last_word(predicate.arguments[0].head) in NOT_PLACES:
        return predicate
    return replace(predicate, relation=left, positive=not predicate.positive)


def _is_it(arguments: tuple[NounPhrase, ...]) -> bool:
    return bool(arguments) and arguments[0].pronoun in ("it", "they") and not arguments[0].head


def _is_draped(phrase: NounPhrase) -> bool:
    """Return True for what a cloth and no lamp hangs over: *both ends of the table*, *the back of the chair*."""
    several = phrase.head in _OUTER and (phrase.plural or phrase.determiner in ("both", "each", "all"))
    return several or phrase.head in ("edge", "side", "back")


def _distance(measure: Predicate, following: Predicate) -> tuple[Predicate, tuple[Predicate, ...]] | None:
    """Return a distance joined with what follows: *10 cm from the cup*, *10 cm to the left of the cup*."""
    span = union(measure.span, following.span)
    if following.relation in ("measured_from", "from", "far", "to") and following.arguments:
        return replace(measure, arguments=following.arguments, span=span), ()
    if following.relation in DIRECTION_RELATIONS and (following.arguments or following.relation in ("left", "right")):
        return replace(following, measure=measure.measure, span=span), ()
    return None
