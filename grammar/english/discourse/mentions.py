"""Read noun phrases: the things that they introduce or refer to, and what they say about them."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from dataclasses import replace

from deixis.grammar.english.confidence import Guess
from deixis.grammar.english.discourse.commitment import PAST_RELATIVE, UNSURE_RELATIVE
from deixis.grammar.english.discourse.drafts import Drafting
from deixis.grammar.english.discourse.entities import Entity, Role
from deixis.grammar.english.discourse.references import POLES, REGIONS, Focus, Region
from deixis.grammar.english.discourse.surfaces import DIRECTIONS
from deixis.grammar.english.tree import Degree, NounPhrase, Predicate
from deixis.grammar.english.vocabulary.adjectives import is_material_noun
from deixis.grammar.english.vocabulary.nouns import (
    HOLDERS,
    PARTS,
    PEOPLE,
    PLACES_OF,
    SUBSTANCES,
    SURFACES,
    SURROUNDINGS,
    VESSELS,
    VIEWER_WORDS,
    last_word,
)
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.things import can_have_a_place
from deixis.ontology.graph.claims import PLACES

VERB_AFTER = re.compile(r"\s+(?:is|are|was|were|has|have|must|should|can|may|will)\b", re.IGNORECASE)
"""Verb after a noun phrase, without which it tells how the thing before it is: *its flap opening away from you*."""

SIDE_OF = re.compile(r"\b(?:side|half|end|edge|corner|part|section|third|quarter)\s+of\s+$", re.IGNORECASE)
"""Words before a thing whose part is meant: *on the left side of the desk*."""

SUPERLATIVES = {
    ("size", 1): "largest", ("size", -1): "smallest", ("height", 1): "tallest", ("height", -1): "shortest",
    ("length", 1): "longest", ("length", -1): "shortest", ("width", 1): "widest", ("width", -1): "narrowest",
    ("thickness", 1): "thickest", ("thickness", -1): "thinnest",
}  # fmt: skip

_COMPARISONS = frozenset(
    {"bigger", "smaller", "taller", "shorter", "longer", "wider", "narrower", "thicker", "thinner"}
)
"""Relations to a thing that need not be there: *smaller than a dinner plate*."""


def _with_restrictions_of_contents(phrase: NounPhrase) -> NounPhrase:
    """Attach to the vessel what follows its contents: *a box of screws on the left*."""
    of = phrase.of
    if of is None or not of.predicates or last_word(phrase.head) in PARTS | REGIONS:
        return phrase
    bare = replace(of, predicates=(), span=(of.span[0], max(of.span[0], of.predicates[0].span[0])))
    return replace(phrase, of=bare, predicates=(*phrase.predicates, *of.predicates))


def _is_beside_part(phrase: NounPhrase, of: NounPhrase) -> bool:
    """Return True for a place after a part of a known thing, which is the place of what is at the part."""
    beside = all(p.relation in _BESIDE | {"above", "below"} and p.arguments and not p.reversed for p in of.predicates)
    return beside and last_word(phrase.head) in PARTS and of.determiner == "the"


def _said_of_subject(entity: Entity, phrase: NounPhrase) -> bool:
    """Return True if what follows a surface is said about the subject: *on the floor to the left*."""
    around = entity.role is Role.SURFACE or (entity.role is Role.SURROUNDING and last_word(entity.noun) != "shelf")
    bare = all((not p.arguments and p.relation in DIRECTIONS) or p.reversed for p in phrase.predicates)
    noun = last_word(entity.noun)
    wide = noun in ("wall", "floor", "ceiling", "ground")
    beside = all(p.relation in _BESIDE and p.degree is Degree.PLAIN for p in phrase.predicates)
    flat = noun in ("wall", "ceiling") and all(
        p.relation in DIRECTIONS | {"next_to", "near"} for p in phrase.predicates
    )
    ends = [one for p in phrase.predicates for a in p.arguments for one in (a.members or (a,))]
    on_it = entity.role is Role.SURFACE and all(p.relation in _BESIDE | {"above", "below"} for p in phrase.predicates)
    on_it = on_it and beside and all(a.head and last_word(a.head) not in SURROUNDINGS for a in ends)
    amid = noun in SURFACES and all(p.relation == "between" for p in phrase.predicates)
    own = phrase.owner is not None and phrase.owner.pronoun in VIEWER_WORDS and noun in _LIMBS
    stuff = noun in SUBSTANCES and phrase.determiner is None and phrase.owner is None  # 'in water behind the counter'
    spots = noun in ("wall", "ceiling", "floor") and all(
        p.relation in PLACES and not p.arguments and not p.reversed for p in phrase.predicates
    )  # 'on the wall in the corner'
    placed = entity.role in (Role.VIEWER, Role.PERSON) and all(
        p.relation == "with" and all(a.predicates and last_word(a.head) not in PARTS for a in p.arguments)
        for p in phrase.predicates
    )  # 'in front of the guest with a fork on the left'
    flanked = entity.role is Role.SURROUNDING and all(
        p.relation == "with" and all(any(q.relation == "each_side" for q in a.predicates) for a in p.arguments)
        for p in phrase.predicates
    )  # 'against the wall with a lamp on either side'
    measured = entity.role is Role.SURFACE and all(p.relation.startswith("distance") for p in phrase.predicates)
    return (
        (around and bare)
        or measured
        or flanked
        or on_it
        or spots
        or (wide and (bare or beside))
        or flat
        or amid
        or own
        or stuff
        or placed
    )


COMPARTMENTS = frozenset(
    {"row", "slot", "hole", "well", "compartment", "column", "position", "tier", "section", "pocket"}
)
"""Nouns of places in a thing, which stand for the thing: *in slot 3 of the rack*."""


_LOOSE = frozenset({"clay", "cotton"})
"""Materials that are kept in vessels."""

_NEEDS = frozenset({"place", "room", "space", "spot", "need", "reason", "way", "point", "limit", "sense", "use"})
"""Nouns of what is not a thing that is missing: *there is no room for the lamp*."""

_SIGNS = frozenset({"sign", "trace", "hint"})
"""Nouns of what shows that a thing is there."""

ARRANGEMENTS = {"row": "row", "line": "row", "circle": "circle", "ring": "circle"}
"""Claim about the things of a phrase by its head: *a row of pawns*."""


class Mentions(Drafting, ABC):
    """Reader of noun phrases."""

    @abstractmethod
    def _predicate(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        """State what a predicate, such as the restriction of a noun phrase, says about its subject."""

    def _subject(self, subject: NounPhrase, predicates: tuple[Predicate, ...]) -> Entity | None:
        """Return the subject of a clause; one new object for each member of a group that an argument quantifies."""
        best = any(a.degree is Degree.SUPERLATIVE for a in subject.adjectives)
        if subject.head in _SIDES or (subject.head in PLACES_OF and best):
            return None  # 'the best place for a lamp is behind the sofa'
        if (
            subject.determiner in ("a", "an", None)
            and subject.head
            and subject.count in (None, 1)
            and not subject.plural
        ):
            for predicate in predicates:
                if predicate.relation == "each_side" and not predicate.reversed:
                    return self._introduce(replace(subject, count=2, determiner=None, plural=True))
                if predicate.relation in ("end", "side") and self._at_each(predicate):
                    return self._introduce(replace(subject, count=2, determiner=None, plural=True))
                for argument in predicate.arguments:
                    of_each = argument.pronoun == "each" and not argument.head and argument.of is not None
                    if argument.determiner in ("each", "every") or of_each:
                        group = self.references.find(argument)
                        if group is not None and group.size > 1:
                            self.how = replace(self.how, quantifier="each")
                            return self._introduce(replace(subject, count=group.size, determiner=None, plural=True))
        entity = self._introduce(subject)
        if subject.determiner in ("each", "every") or subject.pronoun == "each":
            self.how = replace(self.how, quantifier="each")
        return entity

    def _introduce(
        self, phrase: NounPhrase, relation: str | None = None, besides: Entity | None = None
    ) -> Entity | None:
        """Return what a phrase stands for, and state what its adjectives, its number and its clauses say about it."""
        if phrase.members:
            found: list[Entity] = []
            for member in phrase.members:
                beside = any(a.pronoun == "it" and not a.head for p in member.predicates for a in p.arguments)
                if beside and found:  # 'a mirror on the wall and a chair beside it'
                    self.references.recent.insert(0, Focus(found[-1], [], None, self.how.sentence))
                introduced = self._introduce(member, relation, besides)
                if beside and found:
                    self.references.recent.pop(0)
                found += [] if introduced is None else [introduced]
            return found[0] if len(found) == 1 else Entity("", members=found) if found else None
        phrase = _with_restrictions_of_contents(phrase)
        of = phrase.of
        if of is not None and of.predicates and besides is not None and _is_beside_part(phrase, of):
            self._say(besides, of.predicates, phrase, focus=False)  # 'on the base of the stand below the burner'
            of = replace(of, predicates=())
            phrase = replace(phrase, of=of)
        arranged = phrase.head in ARRANGEMENTS and phrase.count is None and not (phrase.plural or phrase.adjectives)
        if arranged and of is not None and of.head and of.plural and self.references.earlier(phrase) is None:
            return self._arrange(phrase, replace(of, predicates=()), relation, besides)
        key = (phrase.span, phrase.head, phrase.count)
        if phrase.head and key in self.introduced:
            return self.introduced[key]
        known = len(self.references.entities)
        entity = self.references.find(phrase, relation, besides)
        if entity is None:
            return None
        if phrase.head and phrase.determiner in ("a", "an", None):
            self.introduced[key] = entity
        new = len(self.references.entities) > known and self.references.entities[-1] is entity
        if entity.role is Role.THING or entity.role is Role.SURROUNDING:
            self._describe(entity, phrase, new)
        if phrase.determiner == "the" and besides is not None:
            heights = ("above", "below")  # 'the cupboard underneath' is not below the thing in it
            kept = tuple(p for p in phrase.predicates if p.arguments or p.relation not in heights)
            phrase = replace(phrase, predicates=kept)
        rows = tuple(p for p in phrase.predicates if p.relation in ("row", "circle") and not p.arguments)
        if rows and besides is not None and not entity.plural and not entity.itself.members:
            self._say(besides, rows, phrase, focus=False)
            phrase = replace(phrase, predicates=tuple(p for p in phrase.predicates if p not in rows))
        bare = all(p.relation in PLACES | DIRECTIONS and not p.arguments for p in phrase.predicates)
        carried = relation in ("on", "inside") and new and entity.indefinite and phrase.plural and bare
        if phrase.predicates and besides is not None and carried:  # 'the dishes stand on trivets in the middle'
            self._say(besides, phrase.predicates, phrase, focus=False)
        held = (
            "on"
            if relation in PLACES or SIDE_OF.search(self.text, max(0, phrase.span[0] - 24), phrase.span[0]) is not None
            else relation
        )
        outside = tuple(
            p for p in phrase.predicates
            if besides is not None and (
                (not new and self._bears(entity, p)) or _shares_support(phrase, held, p)
                or _is_packed(phrase, relation, p)
                or (p.relation == "opposite" and relation in ("in_front", "behind") and len(p.arguments) == 1)
            )  # 'put it in front of the chair on the opposite side of the lamp'
        )  # fmt: skip
        if outside and besides is not None:  # 'on the desk to the left of the lamp' of a lamp that is on the desk
            self._say(besides, outside, phrase, focus=False)
            phrase = replace(phrase, predicates=tuple(p for p in phrase.predicates if p not in outside))
        upon = relation in ("on", "inside", "touching", "leaning") and not new and entity.role is Role.THING
        spots = all(p.relation in PLACES and not p.arguments and not p.reversed for p in phrase.predicates)
        if phrase.predicates and besides is not None and upon and spots and phrase.determiner == "the":
            whole = replace(phrase, predicates=())  # 'it is stuck to the glass in the upper right corner'
            own_parts = tuple(replace(p, arguments=(whole,)) for p in phrase.predicates)
            self._say(besides, own_parts, phrase, focus=False)
        elif phrase.predicates and besides is not None and _said_of_subject(entity, phrase):
            outer, with_things = self.how, all(p.relation == "with" for p in phrase.predicates)
            if with_things:  # 'in front of the guest with a fork on the left, or next to the napkin'
                self.how = replace(outer, weight=1.0, optional=False, alternative=None)
            self._say(besides, phrase.predicates, phrase, focus=False)
            self.how = outer
        elif phrase.predicates and entity.role not in (Role.PERSON, Role.ABSTRACT) and phrase.head not in _SIDES:
            outer, holder = self.how, self.references.holder
            self.references.holder = relation
            self.how = replace(outer, positive=True, quantifier=None, weight=1.0, optional=False, alternative=None)
            own = self.text[phrase.span[0] : self._end_of_own(phrase)]
            if not self.story and PAST_RELATIVE.search(own):
                self.how = replace(self.how, past=True)
            if UNSURE_RELATIVE.search(own):
                self.how = replace(self.how, uncertain=True, optional=True, weight=0.5)
            self._say(entity, phrase.predicates, phrase, focus=False)
            self.how, self.references.holder = outer, holder
            restriction = self.references.recent[-1]
            if restriction.subject is entity and restriction.others:
                self.restricted = {entity: (restriction.others[-1].itself, phrase.predicates[-1].span[1])}
        return entity

    def _arrange(
        self, phrase: NounPhrase, of: NounPhrase, relation: str | None, besides: Entity | None
    ) -> Entity | None:
        """Return the things of *a row of pawns*, and state that they are in a row."""
        things = self._introduce(of, relation, besides)
        if things is None or things.role is not Role.THING:
            return things
        things.aliases.add(phrase.head)
        self.references.renamed.append(things)  # later 'the row'
        plain = replace(self.how, positive=True, weight=1.0, optional=False, quantifier=None, span=phrase.span)
        self._add(ARRANGEMENTS[phrase.head], (things,), (), how=plain)
        if phrase.predicates:
            self._say(things, phrase.predicates, phrase, focus=False)
        return things

    def _bears(self, entity: Entity, predicate: Predicate) -> bool:
        """Return True for a place beside a thing that is on or inside an entity, which the entity cannot have."""
        if predicate.relation not in _BESIDE | {"left", "right"} or len(predicate.arguments) != 1 or predicate.reversed:
            return False
        phrase = predicate.arguments[0]
        thing = self.references.earlier(phrase) if phrase.head and phrase.determiner == "the" else None
        return thing is not None and any(
            d.relation in ("on", "inside") and d.how.positive and not d.how.past
            and thing in [s.itself for s in d.subjects] and entity.itself in [a.itself for a in d.arguments]
            for d in self.drafts
        )  # fmt: skip

    def _end_of_own(self, phrase: NounPhrase) -> int:
        """Return the end of the words about a phrase itself, before the words about things in its restrictions."""
        last = phrase.predicates[-1]
        inner = [argument for argument in last.arguments if argument.predicates]
        return min((a.predicates[0].span[0] for a in inner), default=phrase.span[1])

    def _describe(self, entity: Entity, phrase: NounPhrase, new: bool) -> None:
        plain = replace(self.how, positive=True, weight=1.0, optional=False, quantifier=None, alternative=None)
        if self.how.condition or self.how.past or self.how.uncertain:
            return
        for adjective in phrase.adjectives:
            if adjective.degree is Degree.PLAIN and adjective.dimension in ("colour", "size", "material", "shape"):
                if entity.members and not phrase.plural and not new:
                    continue
                key = (id(entity), adjective.dimension, adjective.word)
                if key not in self.stated_qualities:
                    self.stated_qualities.add(key)
                    self._add(
                        adjective.dimension, (entity,), (), value=adjective.word, how=replace(plain, span=phrase.span)
                    )
        for adjective in phrase.adjectives:
            name = SUPERLATIVES.get((adjective.dimension, POLES.get(adjective.word, 0)))
            if adjective.word in ("left", "right"):
                name = f"{adjective.word}most"
            placed = adjective.word in ("high", "low")  # 'the highest drawer' is not the tallest
            best = adjective.degree is Degree.SUPERLATIVE and name is not None and not placed
            if new and best and name is not None and not entity.members:
                self._add(name, (entity,), (), how=replace(plain, span=phrase.span))
        if new and entity.members:
            self._add("count", (entity,), (), value=str(entity.size), how=replace(plain, span=phrase.span))
        if phrase.of is not None and phrase.of.head and new:
            stuff = phrase.of.head
            vessel = last_word(phrase.head) in VESSELS
            filled = vessel and (stuff in _LOOSE or not is_material_noun(last_word(stuff)))
            filled = filled and can_have_a_place(stuff, self.nouns)  # not 'jars of different sizes'
            filled = filled and (
                phrase.of.determiner != "the" or stuff in SUBSTANCES
            )  # not 'the last glass of the row'
            if is_material_noun(stuff) and not filled and not phrase.of.determiner:  # 'a jug of green glass'
                self._add("material", (entity,), (), value=stuff, how=plain)
                for adjective in phrase.of.adjectives:
                    if adjective.dimension == "colour" and adjective.degree is Degree.PLAIN:
                        self._add("colour", (entity,), (), value=adjective.word, how=plain)
            elif filled:  # 'a bag of clay'
                self._add("contents", (entity,), (), value=stuff, how=plain)

    def _count(self, phrase: NounPhrase) -> None:
        """Read *there are four of them*."""
        group = self.references.find(NounPhrase(phrase.span, pronoun="they"))
        if group is not None and not group.members and phrase.count is not None and 1 < phrase.count <= 1000:
            group.split(phrase.count)
            self._add("count", (group,), (), value=str(phrase.count))

    def _absent(self, phrase: NounPhrase) -> None:
        if phrase.of is not None and last_word(phrase.head) in _SIGNS:
            phrase = phrase.of  # 'no sign of the pen'
        entity = self.references.find(replace(phrase, determiner="the", predicates=()))
        if entity is not None and phrase.head not in _NEEDS and self.how.condition is None:
            entity.absent = True
            self._add("count", (entity,), (), value="0", how=replace(self.how, positive=True, past=False))
            self.references.recent.insert(0, Focus(entity, [], None, self.how.sentence))

    def _say(
        self,
        entity: Entity,
        predicates: tuple[Predicate, ...],
        phrase: NounPhrase | None,
        focus: bool = True,
        existential: bool = False,
    ) -> None:
        held = [p for p in predicates if p.relation in ("with", "inside") and len(p.arguments) == 1]
        if any(self.text[slice(*p.span)].casefold().startswith(("with", "in")) for p in held):
            held = []  # what is with a thing, and not what it holds
        shared = phrase is not None and phrase.determiner in ("both", "each", "every", "all")
        if 1 < len(held) == entity.size and not shared:
            if any(p.relation in ("row", "one_each") for p in predicates):
                for leaf, predicate in zip(entity.leaves(), held, strict=True):
                    self._say(leaf, (predicate,), phrase, focus=False)  # 'from left to right they hold A, B and C'
                predicates = tuple(p for p in predicates if p not in held)
            else:
                self.how = self._guessed(Guess.CONTESTED)
        others: list[Entity] = []
        if focus:
            self.references.named = others
        if any(p.relation == "one_each" for p in predicates):
            self.how = replace(self.how, quantifier="each")
            sides = [p for p in predicates if p.relation != "one_each"]
            if 1 < len(sides) == entity.size and not any(p.arguments for p in sides):
                for leaf, side in zip(entity.leaves(), sides, strict=True):  # 'to the left and right respectively'
                    self._say(leaf, (side,), phrase, focus=False)
                predicates = ()
        outer = self.how
        places = {p.part for p in predicates if p.relation in ("part", "edge") and not p.arguments and p.part}
        if any(p.relation == "row" for p in predicates):  # 'from left to right across the stage are …'
            predicates = tuple(p for p in predicates if p.relation != "across")
        for predicate in predicates:
            if predicate.relation == "there" and self.text[predicate.span[1] :].lstrip().casefold().startswith("but "):
                outer = replace(outer, positive=False)  # everywhere but left of the plate
                continue
            self.how = replace(outer, positive=outer.positive and predicate.positive, quantifier=self.how.quantifier)
            if outer.weight == 1 and outer.alternative is None:
                self._hedge(predicate.adverbs)
            if predicate.relation == "middle" and not predicate.part and places and entity.role is Role.THING:
                self._add("middle", (entity,), (), value=min(places))
                continue
            self._predicate(entity, predicate, others)
        relation = next((p.relation for p in predicates if p.arguments), None)
        if focus:
            last = self.references.recent[0] if self.references.recent else None
            here = last is not None and last.sentence == self.how.sentence and last.subject is not entity
            own = phrase is not None and bool(phrase.head) and self._is_absolute(phrase)
            self.references.recent.insert(int(own and here), Focus(entity, others, relation, self.how.sentence))
        else:
            self.references.recent.append(Focus(entity, others, relation, self.how.sentence))

    def _is_absolute(self, phrase: NounPhrase) -> bool:
        """Return True for a part of the thing before, of which no verb follows: *its flap opening away from you*."""
        part = phrase.owner is not None and phrase.owner.pronoun == "it"
        return part and VERB_AFTER.match(self.text[phrase.span[1] : self.end]) is None

    def _argument(self, phrase: NounPhrase, relation: str, subject: Entity | None) -> Entity | Region | None:
        if relation in ("inside", "on") and phrase.of is not None and (
            phrase.head.partition(" ")[0] in COMPARTMENTS
        ):  # fmt: skip
            phrase = phrase.of  # 'in row 1 of the rack'
        region = self.references.region(phrase)
        if region is not None:
            return region
        if (phrase.pronoun in ("each", "other") and phrase.determiner in ("each",)) or phrase.pronoun == "another":
            return None
        owned = phrase.owner is not None and phrase.head and last_word(phrase.head) not in PARTS and not phrase.plural
        owned = owned and phrase.owner is not None and phrase.owner.pronoun not in VIEWER_WORDS | {"we"}  # 'your sofa'
        if owned and subject is not None and subject.itself.members and self.how.quantifier == "each":
            return self._introduce(replace(phrase, owner=None, determiner=None, count=subject.size, plural=True))
        if (
            subject is not None and self.how.quantifier == "each" and subject.size > 1
            and phrase.determiner in ("a", "an") and phrase.head and not phrase.plural
        ):  # fmt: skip
            return self._introduce(replace(phrase, determiner=None, count=subject.size, plural=True))
        if phrase.determiner in ("each", "every") or (phrase.pronoun == "each" and phrase.of is not None):
            self.how = replace(self.how, quantifier="each")
        found = self._introduce(phrase, relation, subject)
        if found is not None and relation in _COMPARISONS and phrase.determiner in ("a", "an"):
            found.itself.compared = True
        if (
            found is not None and subject is not None and phrase.count is not None and phrase.count > 1
            and found.size == subject.size and phrase.determiner is None
        ):  # fmt: skip
            self.how = replace(self.how, quantifier="each")
        return found


def _shares_support(phrase: NounPhrase, relation: str | None, predicate: Predicate) -> bool:
    """Return True for *next to the screen* after *on the desk*, which is about what is on the desk.

    What stands on the floor, or is a part of the room, is beside the desk itself: *on the desk next to the door*.
    """
    named = phrase.determiner == "the" or phrase.owner is not None
    person = len(predicate.arguments) == 1 and last_word(predicate.arguments[0].head) in PEOPLE
    seats = len(predicate.arguments) == 1 and last_word(predicate.arguments[0].head) in _SEATS
    person = person or (seats and predicate.arguments[0].determiner in ("each", "every"))
    if person and named and predicate.relation in ("in_front", "near", "next_to") and relation in ("on", "inside"):
        return True  # 'on the tray in front of the guest'
    if relation != "on" or not named or phrase.plural or last_word(phrase.head) not in _SUPPORTS_OF_SEVERAL:
        return False
    if predicate.relation not in _NEXT_TO or len(predicate.arguments) != 1 or predicate.reversed:
        return False
    other = predicate.arguments[0]
    noun = last_word(other.head)
    return bool(noun) and not other.members and noun not in SURROUNDINGS | SURFACES | FURNITURE


def _is_packed(phrase: NounPhrase, relation: str | None, predicate: Predicate) -> bool:
    """Return True for *in small bowls* after *on the tray*, which says what the subject is in, and not the tray."""
    if relation is None or predicate.relation != "inside" or predicate.reversed or len(predicate.arguments) != 1:
        return False
    named = phrase.determiner in ("the", "this") or phrase.owner is not None
    vessel = predicate.arguments[0]
    bare = vessel.determiner is None and vessel.plural and vessel.owner is None and not vessel.members
    return named and bare and last_word(vessel.head) in VESSELS | HOLDERS


_SEATS = frozenset({"chair", "seat", "stool", "place", "setting", "cover"})
"""Nouns of what stands at a table for one person: *on the table in front of each chair*."""
_NEXT_TO = frozenset({"next_to", "near", "in_front", "behind", "left", "right"})
_SUPPORTS_OF_SEVERAL = word_set(
    "desk table tabletop counter countertop worktop bench workbench board shelf sideboard dresser stage"
)
"""Nouns of what carries many things, most of which are smaller than it is."""
FURNITURE = word_set(
    "chair armchair sofa couch bed stool bookcase wardrobe cupboard fireplace chimney heater radiator stairs staircase"
    " doorway entryway hallway hall gate balcony patio porch terrace fence piano machine washer dryer dishwasher cooker"
    " bath bathtub shower toilet basin person seat audience driver player closet pantry curtain elevator lift column"
    " pillar locker rack shed garage pool pond bush hedge path road car truck van board lectern pulpit crib cot"
)
"""Nouns of what stands on the floor or the ground, beside a table and not on it."""
_BESIDE = DIRECTIONS | {"near", "next_to", "between", "under", "opposite"}
"""Relations that, after a wall or a floor, are those of the thing that is on it: *on the wall near the exit*."""

_LIMBS = frozenset({"elbow", "hand", "arm", "foot", "knee", "shoulder", "side"})


_SIDES = frozenset({"left", "right", "furthest", "farthest", "closest", "nearest"})
"""Nouns that name a side or a degree and no thing, of which nothing is said."""
