"""State where things are: relations between things, and places on the surface."""

from __future__ import annotations

import re
from dataclasses import replace

from deixis.grammar.english.confidence import UNANCHORED, Guess
from deixis.grammar.english.discourse.entities import Entity, Role
from deixis.grammar.english.discourse.mentions import FURNITURE, Mentions
from deixis.grammar.english.discourse.references import CORNERS, OPPOSITES, Region
from deixis.grammar.english.discourse.surfaces import DIRECTIONS, HOLLOW_SURFACES
from deixis.grammar.english.tree import Degree, NounPhrase, Predicate
from deixis.grammar.english.vocabulary.adjectives import EMPTY
from deixis.grammar.english.vocabulary.nouns import (
    HOLDERS,
    PARTS,
    PEOPLE,
    SUBSTANCES,
    SUPPORTS,
    SURFACES,
    VESSELS,
    VIEWER_WORDS,
    last_word,
)
from deixis.grammar.english.vocabulary.relation_words import prepositions
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.ontology.graph.claims import COLLECTIVE, PLACES

GROUNDS = re.compile(r"\b(?:foreground|background)\b", re.IGNORECASE)

AT_CORNER = re.compile(
    r"(?:\b(?:at|in|on)\s+the\s+[\w-]+\s+|^(?:top|upper|bottom|lower)[\s-]+)(?:left|right)(?:\s+(?:position|spot|place))?$",
    re.IGNORECASE,
)
"""Corner as a place, and not as a direction: *at the upper left* and *top left*, not *to the upper left*."""

MAX_WORDS_AFTER = 3
"""Number of words between a relative clause and the pronoun that stands for its last thing."""

EXACT = (DIRECTIONS - {"in_front", "behind", "above", "below"}) | {"on", "under"}
"""Relations that have an exact reading: *exactly left of*."""

CONTAINING = frozenset({"contains", "contain", "containing"})

HOLDING = frozenset({"holds", "hold", "holding", "filled", "full", "stuffed", "packed", "crammed", "stocked"}) | EMPTY
"""Words of clauses that say what a vessel holds: *it is filled with spoons*, *it is empty except for a spoon*."""


_OUTER = frozenset({"top", "rim", "edge", "brim"})
"""Parts of a thing that another one lies across."""

_OF_SEVERAL = frozenset(
    {"circle", "near_each_other", "parallel_each_other", "touching_each_other", "nested", "stacked"}
)
"""Relations of several things together."""

_MUTUAL = {"next_to": "near", "against": "touching"}
"""Relation of each to the others, by the relation to *each other*."""


_PARTS_OF_PAIRS = {
    ("top", "below"): "bottom", ("bottom", "above"): "top", ("left", "right"): "right", ("right", "left"): "left",
    ("back", "in_front"): "front", ("front", "behind"): "back", ("far", "in_front"): "near", ("near", "behind"): "far",
}  # fmt: skip
"""Part of the second of two things by the part of the first and the direction of the second."""

_QUALITIES = frozenset({"size", "colour", "material", "shape", "state", "count", "kind", "height", "length", "surface"})
"""Relations of drafts that say no place."""

_ONE_BY_ONE = {"one behind": "behind", "one in front": "in_front"}
"""Relation of the first of two things to the second by the words for a row."""

_BESIDE = frozenset({"left", "right", "in_front", "behind", "next_to", "near"})

_FORMS = frozenset(
    ["rectangle", "triangle", "square", "fan", "roll", "quarter", "third", "half", "cube", "slice", "piece", "cone",
     "cylinder", "oval", "shape", "strip", "wedge", "ball", "pattern"]
)  # fmt: skip
"""Nouns of what a thing becomes by *into*: *fold it into a rectangle*."""


def _whole(entity: Entity) -> Entity:
    """Return the thing that a part belongs to: *across the rim of the bowl* is across the bowl."""
    return entity.whole if entity.role is Role.PART and entity.whole is not None else entity


_LATERAL = frozenset({"left", "right"})
"""Relations after which *the other side* of a thing is the opposite one."""


_STUFFS = word_set(
    "oak pine walnut maple cherry birch beech teak mahogany bamboo steel brass copper bronze chrome aluminium aluminum"
    " leather velvet linen cotton silk wool denim canvas marble granite porcelain acrylic plastic vinyl nylon polyester"
)


def _is_stuff(phrase: NounPhrase) -> bool:
    """Return True for a material without an article and without a number: *oak* of *a chair in oak*."""
    bare = phrase.determiner is None and phrase.owner is None and phrase.count is None and not phrase.plural
    return bare and phrase.of is None and not phrase.members and last_word(phrase.head) in _STUFFS


_WIDE = word_set(
    "table desk bench workbench worktop counter countertop sideboard dresser shelf board pegboard whiteboard stage tray"
    " rack wall bar buffet altar trolley cart"
)
"""Nouns of what carries or shows many things, each of which can be on one side of it."""

_ON_A_SIDE = re.compile(r"\b(?:on|at|to)\s+the\s+(?:[\w-]+\s+)*side\s+of\b")
"""Words by which a side is a part of the surface, and not a direction from it."""


def _are_contents(held: Entity, vessel: Entity) -> bool:
    """Return True for several things with one vessel, which are in it: *a bowl with apples*, but not *with handles*."""
    several = held.plural or bool(held.members)
    return several and not (vessel.plural or vessel.members) and last_word(held.noun) not in PARTS | _PATTERNS


_TOLD_APART = word_set("box case")
"""Vessels that *with* often tells apart by a part: *the one with the antennas*."""

_CLOSED = word_set("cabinet dresser sideboard")
"""Surfaces with doors or drawers, which hold things inside them."""

_RACKS = word_set("rack holder basket crate caddy quiver")
"""Holders without doors and drawers, so that *with* says what is in them: *a rack with four test tubes*."""

_PATTERNS = word_set("stripe dot spot flower letter word number picture initial star pattern figure line")
"""Nouns of what can be painted on a thing."""


class Relations(Mentions):
    """Reader of predicates that tell a place."""

    def _of_the_other_side(self, predicate: Predicate) -> Predicate:
        """Return *A is left of B, and C on the other side of it* with the direction opposite to the one before."""
        last = self.references.recent[0] if self.references.recent else None
        relation = None if last is None or predicate.relation != "opposite" else last.relation
        written = self.text[slice(*predicate.span)].casefold()
        if last is None or " other side" not in written or relation not in _LATERAL or len(last.others) != 1:
            return predicate
        (phrase,) = predicate.arguments
        named = phrase.pronoun == "it" or self.references.earlier(phrase) is last.others[0].itself
        if not named or last.sentence < self.how.sentence - 1:
            return predicate
        return replace(predicate, relation=OPPOSITES[relation])

    def _relate(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        """State a relation between the subject and the arguments."""
        predicate = self._of_the_other_side(predicate)
        relation = predicate.relation
        if "exactly" in predicate.adverbs and relation in EXACT:
            relation = f"exactly_{relation}"
        if relation in ("touching", "on", "inside") and not {"almost", "nearly"}.isdisjoint(predicate.adverbs):
            relation = "near"
        single = subject.size == 1 and not subject.plural
        if relation == "each_side" and single and self.how.optional:
            relation = "next_to"  # 'the pump can stand on either side of the sink'
        if relation == "each_side" and not predicate.arguments:
            flanked = self._flanked(subject)
            if flanked is not None:
                self._pair(subject, relation, flanked, False)  # 'the mirror is here, with a light on each side'
            return
        forms = all(last_word(a.head) in _FORMS and a.determiner not in ("the", "each") for a in predicate.arguments)
        into = self.text[slice(*predicate.span)].casefold().startswith("into")
        if into and relation == "inside" and predicate.arguments and forms:
            return  # 'fold it into a rectangle'
        if relation == "inside" and self.how.positive and any(self._is_town(a) for a in predicate.arguments):
            self._is_not_here(subject)  # 'the knife is in London'
            return
        degree = self.text[self.references.start : predicate.span[0]].casefold().split()[-1:]
        if relation in ("near", "far") and degree in (["equally"], ["as"]):
            return  # 'equally far from the cross' compares, and says no distance
        stuffs = [_is_stuff(a) for a in predicate.arguments]
        if relation == "inside" and not predicate.reversed and stuffs and all(stuffs):
            return  # 'a chair in oak', which says what it is made of
        if relation == "outside":
            hollow = all(last_word(a.head) in VESSELS | HOLDERS for a in predicate.arguments)
            if predicate.arguments and hollow and self.how.positive and not predicate.reversed:
                self.how = replace(self.how, positive=False)  # 'outside the box' denies that it is inside
                self._relate(subject, replace(predicate, relation="inside"), others)
            return
        if relation in ("at", "on") and self._at_the_other(subject, predicate):
            return
        found: list[Entity | Region] = []
        restricted, end = self.restricted.get(subject, (None, 0))
        options = [a for a in predicate.arguments if a.joined_by == "or"]
        if options and relation != "between" and not self.how.positive:
            for member in options[0].members:  # 'not next to the jar or the box' denies both
                self._relate(subject, replace(predicate, arguments=(member,)), others)
            return
        if options and relation != "between" and not self.how.alternative:
            self.alternatives += 1
            outer = self.how
            for member in options[0].members:
                self.how = replace(
                    outer, alternative=self.alternatives, optional=True, weight=1 / len(options[0].members)
                )
                self._relate(subject, replace(predicate, arguments=(member,)), others)
            self.how = outer
            return
        mutual = any(a.pronoun == "other" and a.determiner == "each" for a in predicate.arguments)
        if mutual and _MUTUAL.get(relation, relation) + "_each_other" in COLLECTIVE:
            self._add(f"{_MUTUAL.get(relation, relation)}_each_other", (subject,), ())
            return
        if mutual and subject.size == 2:
            first, second = subject.leaves()
            self._pair(first, relation, second, False)
            self._pair(second, relation, first, False)
            return
        if predicate.reversed and [a.pronoun for a in predicate.arguments] == ["nothing"]:
            self._add(f"none_{relation}", (subject,), ())  # 'the plate has nothing on it'
            return
        for phrase in predicate.arguments:
            if predicate.reversed and phrase.head and phrase.owner is not None and phrase.owner.pronoun == "it":
                phrase = replace(phrase, owner=None, determiner="the")  # 'on the mat, with its cable under it'
            if phrase.pronoun == "one" and not predicate.positive and others and not phrase.adjectives:
                phrase = replace(phrase, head=others[-1].noun, pronoun=None, determiner="another")  # 'not in the one …'
            last = others[-1].itself if others and phrase.pronoun == "it" and not phrase.head else None
            if phrase.pronoun == "it" and not others and self.on_surface == self.how.span and self.references.surface:
                found.append(self.references.surface)  # 'outside the tray, behind it'
                continue
            near = predicate.span[0] >= end and len(self.text[end : predicate.span[0]].split()) <= MAX_WORDS_AFTER
            if phrase.pronoun == "it" and restricted is not None and not others and near:
                last = restricted  # 'the comb, which was in front of the mirror, is behind it'

            if last is not None and relation in _BESIDE and self._holds(last, subject):
                last = None  # 'crackers, in a bowl, to the left of it'
            if last is not None and last.role is Role.THING and not last.members and last is not subject.itself:
                found.append(last)  # above the saucer and to the left of it
                continue
            host = self._host_of(phrase, relation, subject)
            if host is not None:
                found.append(host)
                continue
            for member in ([m for m in phrase.members if m.negated] and phrase.members) or (phrase,):
                if member.negated:
                    other = self._argument(replace(member, negated=False), relation, subject)
                    if isinstance(other, Entity):
                        how = replace(self.how, positive=not self.how.positive)
                        self._add(relation, (subject,), (other,), how=how)
                    continue
                thing = self._argument(member, relation, subject)
                if thing is not None:
                    found.append(thing)
        entities = [_whole(thing) for thing in found if isinstance(thing, Entity)]
        regions = [thing for thing in found if isinstance(thing, Region)]
        if any(e.role is Role.SURFACE for e in entities):
            self.on_surface = self.how.span
        others += [e for e in entities if e.role is Role.THING]
        if predicate.arguments and not found:
            return
        if relation.startswith("distance") or predicate.measure is not None:
            self._distance(subject, predicate, entities, others, regions)
            if relation.startswith("distance"):
                return
        if predicate.degree is Degree.COMPARATIVE and relation in ("near", "far"):
            than = [] if predicate.than is None else [self._argument(predicate.than, relation, subject)]
            more = [e for e in than if isinstance(e, Entity)]
            name = "closer" if relation == "near" else "farther"
            value = " ".join(filter(None, (regions[0].value, regions[0].term))) if regions else None
            self._add(name, (subject,), tuple(entities + more), value=value)
            return
        if predicate.degree is Degree.SUPERLATIVE and relation in ("near", "far"):
            name = "nearest" if relation == "near" else "farthest"
            person = next((e.noun for e in entities if e.role in (Role.VIEWER, Role.PERSON)), None)
            ends = () if person is not None else tuple(entities)
            self._add(name, (subject,), ends, value=person)
            return
        if regions and not entities:
            self._at_region(subject, relation, regions[0])
            return
        if predicate.reversed and self._holds_inside(subject, predicate):
            for thing in entities:  # 'the drawer has knives in front and forks in back'
                self._add("part", (thing,), (subject,), value={"in_front": "front"}.get(relation, "back"))
            return
        if relation == "between":
            if predicate.reversed:  # 'the comb and the razor, with a necklace between them'
                both = [subject, *others[:1]] if subject.size == 1 and not subject.plural else [subject]
                for thing in entities:  # also 'the wheel is strapped to the frame, with a card between them'
                    self._between(thing, [e for e in both if e is not thing])
            else:
                self._between(subject, entities)
            return
        if relation == "among" and self.text[slice(*predicate.span)].casefold().startswith(("of ", "out of ")):
            return  # 'of the two cups one is on the tray'
        if single and not entities and relation in _OF_SEVERAL:
            return
        if relation in COLLECTIVE and not (relation == "stacked" and entities):
            if subject.itself.members:
                subject.itself.aliases.add({"stacked": "stack"}.get(relation, relation))
                self.references.renamed.append(subject.itself)  # later 'the row'
            one_by_one = next(
                (end for words, end in _ONE_BY_ONE.items() if (predicate.part or "").startswith(words)), None
            )
            if relation == "row" and one_by_one is not None and subject.size == 2:
                first, second = subject.leaves()
                self._pair(first, one_by_one, second, False)  # 'two jugs, one behind the other'
                return
            directed = relation == "row" and " to " in (predicate.part or "")  # 'left to right'
            value = predicate.part if directed else None
            if relation == "stacked" and "inside" in self.text[predicate.span[0] : predicate.span[1]]:
                relation = "nested"
            self._add(relation, tuple(dict.fromkeys([subject, *entities])), (), value=value)
            return
        if not entities:
            if relation in ("pointing", "facing") and (predicate.part or predicate.value):
                self._add(
                    relation,
                    (subject,),
                    (),
                    value=predicate.part or (predicate.value.word if predicate.value is not None else None),
                )
            return
        written = self.text[slice(*predicate.span)].casefold()
        timed = relation == "in_front" and written.startswith("before ") and self.how.positive
        if timed and any(entity.role is Role.THING for entity in entities):
            self.how = self._guessed(Guess.BEFORE)  # 'put the knives out before the forks'
        on_a_side = relation in _LATERAL and not predicate.reversed and _ON_A_SIDE.search(written) is not None
        on_a_side = on_a_side and subject.role is not Role.SURFACE and last_word(subject.noun) not in FURNITURE
        for other in entities:
            if on_a_side and other.role is Role.SURFACE:
                self._add("part", (subject,), (), value=relation)  # 'on the left side of the tray'
            elif on_a_side and last_word(other.noun) in _WIDE and other.role is Role.THING and not other.members:
                self._add("part", (subject,), (other,), value=relation)
            else:
                self._pair(subject, relation, other, predicate.reversed)

    def _holds_inside(self, subject: Entity, predicate: Predicate) -> bool:
        """Return True for *in front* and *in back* after what a drawer or a shelf has, which are parts of it."""
        words = self.text[slice(*predicate.span)].casefold()
        bare = re.search(r"\bin (?:front|back)\b(?!\s+of\b)", words) is not None
        holder = last_word(subject.noun) in HOLDERS | VESSELS | SURFACES and subject.role is Role.THING
        return predicate.relation in ("in_front", "behind") and bare and holder

    def _flanked(self, subject: Entity) -> Entity | None:
        """Return the thing that *on each side* is about: the subject before, of this sentence or the last one."""
        before = [f for f in self.references.recent if f.subject is not None and f.subject.itself is not subject.itself]
        if not before or before[0].sentence < self.how.sentence - 1 or not self.how.positive:
            return None
        thing = before[0].subject
        if before[0].sentence != self.how.sentence:
            self.how = self._guessed(Guess.OF_EARLIER)
        single = thing is not None and thing.role is Role.THING and not (thing.itself.members or thing.plural)
        return thing if single else None

    def _host_of(self, phrase: NounPhrase, relation: str, subject: Entity) -> Entity | None:
        """Return the thing before, of which *the rim* is: *the plate is here, with a knife across the rim*."""
        bare = phrase.determiner == "the" and not (phrase.of or phrase.owner or phrase.adjectives or phrase.plural)
        last = self.references.recent[0] if self.references.recent else None
        before = None if last is None or last.sentence != self.how.sentence else last.subject
        host = self.references.host or before
        if relation != "across" or phrase.head not in _OUTER or not bare or host is None or host is subject:
            return None
        return host.itself if host.role is Role.THING and not (host.itself.members or host.plural) else None

    def _holds(self, thing: Entity, subject: Entity) -> bool:
        """Return True if this sentence says that the subject is inside a thing, so that it cannot be beside it."""
        return any(
            d.relation == "inside" and d.subjects == (subject,) and d.arguments == (thing,) and d.how.positive
            for d in self.drafts if d.how.sentence == self.how.sentence
        )  # fmt: skip

    def _at_the_other(self, subject: Entity, predicate: Predicate) -> bool:
        """Read *a cooler at one end and the basket at the other*; False for another thing than an end."""
        other = [a for a in predicate.arguments if a.pronoun == "other" and a.determiner == "the" and not a.head]
        here = [d for d in self.drafts if d.how.sentence == self.how.sentence and d.relation in ("end", "side", "edge")]
        if not other or not here or subject in here[-1].subjects:
            return False
        value = OPPOSITES.get(here[-1].value or "")
        self._add(here[-1].relation, (subject,), here[-1].arguments, value=value)
        return True

    def _is_town(self, phrase: NounPhrase) -> bool:
        """Return True for a name in capitals that is not a known noun, after *in*: a place that is not on the table."""
        words = self.text[slice(*phrase.span)].split()
        named = bool(words) and not phrase.known and phrase.determiner is None and phrase.owner is None
        bare = named and not (phrase.adjectives or phrase.predicates or phrase.members or phrase.count)
        after_in = self.text[self.references.start : phrase.span[0]].casefold().split()[-1:] == ["in"]
        return bare and after_in and all(word[0].isupper() and not word.isupper() for word in words)

    def _pair(self, subject: Entity, relation: str, other: Entity, swapped: bool) -> None:
        same_group = subject.itself.group is not None and subject.itself.group is other.itself.group
        if other is subject or (same_group and relation == "inside"):
            return
        if other.role is Role.ABSTRACT:
            return
        if other.role is Role.VIEWER or other.role is Role.PERSON:
            self._add(relation, (subject,), (), value=other.noun)
        elif other.role is Role.SURFACE or subject.role is Role.SURFACE:
            hollow = relation == "inside" and last_word(other.noun) in HOLLOW_SURFACES
            if hollow and subject.role is not Role.SURFACE and not swapped:
                self._add(relation, (subject,), (), value=other.noun)
            elif subject.role is not Role.SURFACE and relation in ("on", "inside") and not swapped:
                self._add("on", (subject,), ())
                if not self.how.positive and not swapped:
                    self._is_not_here(subject)
            elif subject.role is not Role.SURFACE and not swapped:
                self._add(relation, (subject,), (), value=other.noun)
        elif other.role is Role.SURROUNDING and relation in (
            "pointing",
            "facing",
            "leaning",
            "inside",
            "against",
            "under",
        ):
            self._add(relation, (subject,), (), value=other.noun)
        elif self._holds_substance(*((other, subject) if swapped else (subject, other)), relation):
            return
        elif swapped:
            self._add(relation, (other,), (subject,))
        else:
            self._add(relation, (subject,), (other,))

    def _holds_substance(self, content: Entity, vessel: Entity, relation: str) -> bool:
        """Read *the tea is in the jar* as the contents of the jar; the words for the tea then mean the jar as well."""
        if relation != "inside" or content.noun not in SUBSTANCES or content.itself is vessel.itself:
            return False
        if last_word(vessel.noun) not in VESSELS or vessel.itself.members or not self.how.positive:
            return False
        self._add("contents", (vessel,), (), value=content.noun)
        if content.same_as is None and not content.members:
            placed = any(content in (*d.subjects, *d.arguments) for d in self.drafts)
            if not (placed or content.born < self.how.sentence):
                self._identify(content, vessel)
            elif not content.indefinite:  # after 'pour water into the cup', 'fill the tank with water' is other water
                self._identify(vessel, content)
        return True

    def _between(self, subject: Entity, entities: list[Entity]) -> None:
        if len(entities) == 1 and not entities[0].itself.members and entities[0].plural:
            entities[0].itself.split(2)
        ends = [e for e in entities if e.role in (Role.THING, Role.SURROUNDING)]
        persons = [e for e in entities if e.role in (Role.VIEWER, Role.PERSON)]
        if not {leaf.itself for leaf in subject.leaves()}.isdisjoint(leaf.itself for e in ends for leaf in e.leaves()):
            return  # nothing is between itself and others
        if ends and (len(ends) > 1 or ends[0].size > 1):
            self._add("between", (subject,), tuple(ends))
        elif not ends and persons and (len(persons) > 1 or persons[0].plural or persons[0].size > 1):
            self._add("between", (subject,), (), value=persons[0].noun)
        elif ends and persons:
            self._add("between", (subject,), tuple(ends), value=persons[0].noun)

    def _distance(
        self, subject: Entity, predicate: Predicate, entities: list[Entity], others: list[Entity], regions: list[Region]
    ) -> None:
        measure = predicate.measure
        ends = entities or others[-1:]
        name_of_bound = {"<": "distance_less", ">": "distance_more"}
        if measure is not None and regions and not entities and predicate.relation.startswith("distance"):
            region = regions[0]
            self._add(
                name_of_bound.get(measure.bound or "", "distance"), (subject,),
                () if region.of is None else (region.of,), metres=measure.metres,
                value=" ".join(filter(None, (region.value, region.term))),
            )  # fmt: skip
            return
        if measure is not None and entities and entities[-1].role is Role.SURROUNDING:
            name = name_of_bound.get(measure.bound or "", "distance")
            self._add(name, (subject,), (), value=entities[-1].noun, metres=measure.metres)
            return
        if measure is not None and entities and entities[-1].role is Role.SURFACE:
            name = name_of_bound.get(measure.bound or "", "distance")
            self._add(name, (subject,), (), value=entities[-1].noun, metres=measure.metres)
            return
        if measure is None or not ends or ends[-1].role is not Role.THING:
            return
        name = {"<": "distance_less", ">": "distance_more"}.get(measure.bound or "", "distance")
        self._add(name, (subject,), tuple(ends[-1:]), metres=measure.metres)

    def _at_region(self, subject: Entity, relation: str, region: Region) -> None:
        arguments = () if region.of is None else (region.of,)
        if region.term == "side" and region.of is None and region.value is None and relation in ("inside", "on", "to"):
            return  # 'to the inside of the sides', which are parts of something
        if relation == "parallel":
            self._add("parallel", (subject,), arguments, value=" ".join(filter(None, (region.value, region.term))))
        elif relation in ("against", "touching", "leaning") and region.of is not None and region.of.role is Role.THING:
            self._pair(subject, relation, region.of, False)
        elif relation in ("on", "inside", "near", "next_to", "at", "along", "touching", "against", "aligned"):
            if relation != "touching" or region.of is not None or region.term == "middle":
                self._add(region.term, (subject,), arguments, value=region.value)  # not of 'tied to the free end'
        elif relation == "far" and region.term in PLACES:  # 'keep it away from the edge'
            how = replace(self.how, positive=not self.how.positive)
            self._add(region.term, (subject,), arguments, value=region.value, how=how)
        elif region.of is not None and region.of.role is Role.THING:
            self._pair(subject, relation, region.of, False)
        elif region.of is None:
            self._add(relation, (subject,), (), value=" ".join(filter(None, (region.value, region.term))))

    def _place(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        """State a place on the surface or on an object: a corner, an edge, the middle."""
        if predicate.reversed:  # 'a towel with a rest on its near edge'
            for phrase in predicate.arguments:
                held = self._introduce(phrase, predicate.relation, subject)
                if held is not None and held.role is Role.THING:
                    of = () if subject.role is Role.SURFACE else (subject,)
                    self._add(predicate.relation, (held,), of, value=predicate.part)
            return
        if subject.role is Role.SURFACE:
            return
        arguments: list[Entity] = []
        for phrase in predicate.arguments:
            found = self._argument(phrase, predicate.relation, subject)
            if isinstance(found, Region):
                if found.term == "edge" and predicate.relation == "middle":
                    self._add("edge", (subject,), (), value=found.value)
                    self._add("middle", (subject,), (), value=f"{found.value or ''} edge".strip())
                    self.edge = found.value
                    return
                self._at_region(subject, "on", found)  # 'at the left end of the front edge of the tray'
                if predicate.relation == "middle":
                    return  # of the side, and not of the whole
                if found.of is not None and found.of.role is Role.THING:
                    arguments.append(found.of)
                continue
            if isinstance(found, Entity) and found.role in (Role.THING, Role.SURROUNDING):
                arguments.append(found)
        if not arguments and predicate.relation in ("end", "edge", "side", "corner", "part") and predicate.part:
            before = [
                d for d in self.drafts if d.how.sentence == self.how.sentence and d.relation == predicate.relation
            ]
            if before and before[-1].value != predicate.part and subject not in before[-1].subjects:
                arguments = list(before[-1].arguments)  # 'at the left end of the rail … and at the right end'
        if not arguments and not predicate.arguments and predicate.relation == "part" and predicate.part:
            packed = [d for d in self.drafts if d.how.sentence == self.how.sentence and d.relation == "inside"][-1:]
            holders = [a for d in packed for a in d.arguments if last_word(a.noun) in VESSELS | HOLDERS]
            arguments = holders if len(holders) == 1 and subject not in packed[0].subjects else []  # 'in the back'
        if predicate.relation == "edge":
            self.edge = predicate.part
        others += arguments
        part = predicate.part
        if part in ("either", "each", "both"):
            part = None
        if predicate.relation == "part" and predicate.arguments and not arguments:
            part = {"back": "far", "front": "near"}.get(part or "", part)  # 'at the back of the table'
        if predicate.relation in ("end", "side") and subject.size == 2 and self._at_each(predicate):
            for leaf, side in zip(subject.leaves(), ("left", "right"), strict=True):
                self._add(predicate.relation, (leaf,), tuple(arguments), value=side)
            return
        if predicate.relation == "part" and not part and not arguments:
            if predicate.arguments:
                self._add("on", (subject,), ())  # 'on one half of the table'
            return  # 'in a position', which does not say where
        self._add(predicate.relation, (subject,), tuple(arguments), value=part)
        words = self.text[slice(*predicate.span)].casefold()
        within = words.startswith(("in the ", "inside the ")) and any(last_word(a.noun) in words for a in arguments)
        if within and len(arguments) == 1 and last_word(arguments[0].noun) in VESSELS | HOLDERS:
            self._pair(subject, "inside", arguments[0], False)  # 'pebbles in the bottom of the jar'

    def _on_top(self, subject: Entity) -> None:
        """Read *on top*: of the last object, or the farthest one of a line that the subject is a member of."""
        here = [d for d in self.drafts if d.how.sentence == self.how.sentence and d.relation == "part"]
        if here and "bottom" in (here[-1].value or "").split() and subject not in here[-1].subjects:
            self._add("part", (subject,), here[-1].arguments, value="top")  # 'pots at the bottom, lids on top'
            return
        focus = next((f for f in self.references.recent if f.subject is not subject), None)
        last = None if focus is None else focus.subject
        if focus is None or last is None or last.role is not Role.THING:
            return
        is_positive = [d.how.positive for d in self.drafts if d.how.sentence == focus.sentence and last in d.subjects]
        if focus.sentence != self.how.sentence and not any(is_positive):
            return  # after 'keep lilies away from the door', nothing is on top of them
        rest = [leaf for leaf in last.leaves() if leaf is not subject.itself]
        if len(rest) < last.size:
            for other in rest:
                self._pair(subject, "top", other, False)
        else:
            self._pair(subject, "on", last, False)

    def _in_corner(self, subject: Entity, predicate: Predicate) -> bool:
        """Read *at the upper left* as a corner: of the thing of the corner before, or else of the surface."""
        if predicate.relation not in CORNERS:
            return False
        last = next((d for d in reversed(self.drafts) if d.relation in CORNERS and subject not in d.subjects), None)
        near = last is not None and self.how.sentence - last.how.sentence <= 1
        if last is not None and near and not last.how.guesses & UNANCHORED:
            self._add(predicate.relation, (subject,), last.arguments, value=last.value)
            return True
        if not AT_CORNER.search(self.text[slice(*predicate.span)]):
            return False
        self._add("part", (subject,), (), value=predicate.relation.replace("_", " "))
        return True

    def _bare_direction(self, subject: Entity, predicate: Predicate) -> None:
        if self._in_corner(subject, predicate):
            return
        after = self.text[predicate.span[1] :]
        following = predicate.span[1] + len(after) - len(after.lstrip())
        lost = any(start == following for start, _ in self.references.lost)
        if lost and self.text[slice(*predicate.span)].casefold() in prepositions():
            return  # of the words after it, which were not understood
        own = predicate.viewpoint.own if predicate.viewpoint is not None else None
        if own is not None and own.pronoun in VIEWER_WORDS and not own.head and predicate.part is None:
            self._pair(subject, predicate.relation, self.references.viewer, False)  # 'the lamp is to my left'
            return
        contrasted = self._of_the_other(subject, predicate.relation) if predicate.part is None else None
        if contrasted is not None:
            self._pair(subject, predicate.relation, contrasted, False)
            return
        shared = self._of_what_follows(predicate)
        if shared:
            self._relate(subject, replace(predicate, arguments=shared, part=None), [])
            return
        sided = self.drafts[-1] if self.drafts else None
        of_sides = sided is not None and sided.relation == "part" and sided.how.sentence == self.how.sentence
        if sided is not None and of_sides and sided.arguments and sided.value == OPPOSITES.get(predicate.relation):
            self._add("part", (subject,), sided.arguments, value=predicate.relation)
            return  # 'pens on the left side of the board and pins on the right'
        across = self._side_of(subject, predicate)
        if across is not None:
            self.how = self._guessed(Guess.OF_THE_LAST)
            self._pair(subject, predicate.relation, across, False)
            return
        beside = self.drafts[-1] if self.drafts else None
        person = beside is not None and not beside.arguments and beside.value in PEOPLE and beside.metres is None
        turned = person and beside is not None and beside.relation == OPPOSITES.get(predicate.relation)
        if turned and beside is not None and beside.how.sentence == self.how.sentence and predicate.part is None:
            self._add(
                predicate.relation, (subject,), (), value=beside.value
            )  # 'A to the left of the host, B to the right'
            return
        if predicate.relation == "near" and predicate.part is None:
            return  # 'store the sponges nearby', which does not say near what
        last = next((f.subject for f in self.references.recent if f.subject is not subject), None)
        high = self.text[slice(*predicate.span)].casefold().startswith(("up ", "high up", "at top"))
        if (
            predicate.part is None
            and not high  # 'the bowls are up top'
            and last is not None
            and last.role is Role.THING
            and self.how.positive
            and (predicate.relation not in ("near", "far"))
            and not GROUNDS.search(self.text[slice(*predicate.span)])
        ):
            before = next(f for f in self.references.recent if f.subject is not subject)
            placed = [
                d for d in self.drafts if d.how.sentence == self.how.sentence and d.relation not in _QUALITIES
            ]  # not 'small' of 'small pots in front'
            stated = placed[-1] if placed and placed[-1].relation in ("part", "middle") else None
            levels = [d.value for d in placed if d.relation == "part"]
            level = levels[-1] if levels and stated is not None else None
            part = _PARTS_OF_PAIRS.get((level or "", predicate.relation))
            if part is not None and stated is not None:
                self._add("part", (subject,), stated.arguments, value=part)  # 'forks left, knives right'
                return
            opposite = OPPOSITES.get(before.relation or "") == predicate.relation
            if before.others and (opposite or before.relation == "on") and before.others[0].role is Role.THING:
                last = before.others[0]  # 'the spoon to the right of the plate, the fork to the left'
            same = [d for d in self.drafts if d.how.sentence == self.how.sentence and d.subjects == (last,)]
            if same and same[-1].arguments and same[-1].how.guesses & UNANCHORED:
                last = same[-1].arguments[0]  # 'the bread plate above to the left, the glass above to the right'
            further = (
                self.text[self.references.start : predicate.span[0]]
                .rstrip()
                .casefold()
                .endswith(("further", "farther"))
            )
            here = before.sentence == self.how.sentence or further  # 'further to the right lie the tongs'
            here = here or (opposite and before.sentence == self.how.sentence - 1)  # 'the fork to the left of it. …'
            self.how = self._guessed(Guess.OF_THE_LAST if here else Guess.OF_EARLIER)
            self._pair(subject, predicate.relation, last, False)
            if predicate.measure is not None and last.role is Role.THING:
                self._add("distance", (subject,), (last,), metres=predicate.measure.metres)
            return
        drafted = [d for d in self.drafts if d.how.sentence == self.how.sentence and d.subjects == (subject,)]
        if not self.how.positive and drafted and drafted[-1].arguments and predicate.part is None:
            self._pair(subject, predicate.relation, drafted[-1].arguments[0], False)  # 'tongs on top, not underneath'
            return
        value = {"in_front": "near", "behind": "far"}.get(predicate.relation, predicate.part or predicate.relation)
        if predicate.relation in ("in_front", "behind", "above", "below") and not self.how.positive:
            return
        value = value.replace("_", " ")
        if value in ("near", "far", "side") or predicate.relation in DIRECTIONS:
            self._add("part", (subject,), (), value=predicate.relation if value == "side" else value)

    def _of_what_follows(self, predicate: Predicate) -> tuple[NounPhrase, ...]:
        """Return the thing of which the next clause says the other side: *A to the left and B to the right of C*."""
        clauses = self.sentences[self.how.sentence].clauses
        following = next((c for c in clauses if c.span[0] >= predicate.span[1]), None)
        if following is None or OPPOSITES.get(predicate.relation) not in DIRECTIONS or not self.how.positive:
            return ()
        return next(
            (
                p.arguments for p in following.predicates
                if p.relation == OPPOSITES[predicate.relation] and p.positive and len(p.arguments) == 1
                and p.arguments[0].head and not p.reversed
            ),
            (),
        )  # fmt: skip

    def _side_of(self, subject: Entity, predicate: Predicate) -> Entity | None:
        """Return the thing of which *on the right* is the other side: *A on the left of the plate, B on the right*."""
        opposite = OPPOSITES.get(predicate.relation)
        if predicate.relation not in ("left", "right") or predicate.part is None or not self.how.positive:
            return None
        here = [d for d in self.drafts if d.how.sentence == self.how.sentence and d.relation in ("left", "right")]
        last = here[-1] if here else None
        if last is None or last.relation != opposite or len(last.arguments) != 1 or not last.how.positive:
            return None
        thing = last.arguments[0]
        return thing if thing.role is Role.THING and subject not in (*last.subjects, thing) else None

    def _of_the_other(self, subject: Entity, relation: str) -> Entity | None:
        """Return what the other one is on the other side of: *the box left of the desk … the one to the right*."""
        for draft in reversed(self.drafts):
            other = draft.subjects[0].itself
            if self.how.sentence - draft.how.sentence > 1:
                return None
            opposite = draft.relation == OPPOSITES.get(relation) and draft.how.positive and len(draft.subjects) == 1
            if opposite and other is not subject.itself and other.noun == subject.noun:
                of_surface = bool(draft.value) and draft.value == self.references.surface_noun
                return draft.arguments[0] if draft.arguments else self.references.surface if of_surface else None
        return None

    def _hold(self, subject: Entity, held: Entity, words: list[str]) -> None:
        """State what a support or a vessel holds as on or inside it; what another thing is with is near it."""
        noun = last_word(subject.noun)
        if noun in _CLOSED and not HOLDING.isdisjoint(words) and subject.role is not Role.SURFACE:
            self._pair(held, "inside", subject, False)  # 'the cabinet holds cups'
        elif subject.role is Role.SURFACE or (noun in SUPPORTS | SURFACES and CONTAINING.isdisjoint(words)):
            self._pair(held, "on", subject, False)
        elif not CONTAINING.isdisjoint(words) or (noun in VESSELS | HOLDERS and not HOLDING.isdisjoint(words)):
            self._pair(held, "inside", subject, False)
        elif noun in VESSELS - HOLDERS - _TOLD_APART | _RACKS and "with" in words and _are_contents(held, subject):
            self._pair(held, "inside", subject, False)  # 'a bowl with apples'
        elif not {"with", "without"}.isdisjoint(words):  # what a thing has may be a part of it
            self._add("near", (held,), (subject,), how=self._guessed(Guess.ACCOMPANIED))

    def _is_not_here(self, subject: Entity) -> None:
        """Take a thing that is not on the surface, and is said to be nowhere else, as absent."""
        plain = not (self.how.condition or self.how.past or self.how.uncertain or self.how.optional)
        entity = subject.itself
        placed = any(entity in d.subjects and d.arguments and d.how.positive and not d.how.past for d in self.drafts)
        if plain and not placed and not entity.members and entity.role is Role.THING:
            entity.absent = True
            self._add("count", (entity,), (), value="0", how=replace(self.how, positive=True))

    def _found_elsewhere(self, entity: Entity) -> None:
        """Take back that a thing is absent: *it isn't here, it is in the trunk*."""
        entity.absent = False
        self.drafts = [
            d for d in self.drafts if not (d.relation == "count" and d.value == "0" and entity in d.subjects)
        ]
