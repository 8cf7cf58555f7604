"""State what each predicate says about its subject: a place, a property, contents, an order."""

from __future__ import annotations

import re
from dataclasses import replace

from deixis.grammar.english.confidence import UNJOINED, Guess
from deixis.grammar.english.discourse.entities import Entity, Role, plain_noun
from deixis.grammar.english.discourse.mentions import SUPERLATIVES
from deixis.grammar.english.discourse.references import POLES, Focus
from deixis.grammar.english.discourse.relations import CONTAINING, HOLDING, Relations
from deixis.grammar.english.discourse.surfaces import DIRECTIONS
from deixis.grammar.english.tree import Degree, NounPhrase, Predicate, aimed
from deixis.grammar.english.vocabulary.nouns import (
    FRONTS,
    GAPS,
    GENERAL,
    HOLDERS,
    PARTS,
    PLACES_OF,
    SUBSTANCES,
    SUPPORTS,
    SURFACES,
    VESSELS,
    VIEWER,
    VIEWER_WORDS,
    last_word,
)
from deixis.grammar.english.vocabulary.relation_words import PLACE_NOUNS
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import PLACING_VERBS, verb_forms
from deixis.ontology.graph.claims import PLACES

UNARY = frozenset(
    [
        "upside_down",
        "empty",
        "open",
        "closed",
        "colour",
        "size",
        "shape",
        "material",
        "state",
        "height",
        "length",
        "width",
        "thickness",
    ]
)

FLEXIBLE = frozenset({"cable", "cord", "hose", "string", "strap", "lead", "wire", "tail", "chain", "flex"})
"""Parts that reach to other places than their wholes."""

NOT_STATES = word_set(
    "need turn roll lay put place set leave open water know call referred name mean work pick choose use allow require"
    " include exclude recommended dedicated devoted recommend suggest advise ask forget remember consider regard offer"
    " give hand drink eat keep say design intend utilize"
)
"""Verbs whose participles tell no state of a thing."""

_MAY_BE = re.compile(r"\b(?:can|could|may|might)\s+(?:[\w-]+\s+){0,2}be\b", re.IGNORECASE)
"""Verbs of what may be done to a thing, which is not its state."""

_KEPT = re.compile(
    r"\b(?:go|goes|belongs?|stored?|keep|kept|put|placed?|put|lives?|moved?|stash|stashed)\b", re.IGNORECASE
)
"""Verbs before *here* and *there* that mean a place named before, and not one that is pointed at."""

_TURNS = frozenset({"step", "exception", "addition", "option", "choice", "thing", "item", "piece", "element"})
"""Nouns that *is* fills with a thing: *the last step is the napkin, which goes on the plate*."""

_CUTLERY = frozenset({"spoon", "teaspoon", "fork", "knife", "straw", "stirrer", "ladle", "strainer", "lid", "tongs"})
"""Nouns of single things that go with a vessel and that it need not hold."""

_DETACHED = frozenset({"lid", "cap"})
"""Parts that are taken off their thing, and then have a place of their own."""
_APART = frozenset(
    {"on", "inside", "under", "next_to", "near", "behind", "in_front", "left", "right", "above", "below"}
)
"""Relations to another thing that a part can have while its own thing is elsewhere."""


def _is_all_else(predicate: Predicate) -> bool:
    """Return True for a comparison with everything else or all the others, which is a superlative."""
    rest = predicate.arguments if len(predicate.arguments) == 1 and predicate.value is not None else ()
    return any(
        (a.pronoun in ("everything", "anything") or (a.determiner == "all" and a.pronoun in ("other", None)))
        and not a.head and a.of is None
        for a in rest
    )  # fmt: skip


def _is_placed(value: str) -> bool:
    """Return True for the participle of a verb that puts things somewhere: *placed* of *is best placed near it*."""
    form = verb_forms().get(value)
    return form is not None and form.lemma in NOT_STATES | PLACING_VERBS and form.lemma not in _SEEN_ON_THINGS


_OF_PARTS = frozenset({"colour", "material", "shape", "size", "height", "length", "width", "thickness"})
"""Qualities of a part that the whole need not have."""

_SEEN_ON_THINGS = frozenset({"stack", "hang", "roll", "turn", "open"})
"""Such verbs whose participles tell a state that can be seen."""


def _carries(subject: Entity) -> bool:
    """Return True for what has glasses on it or in it, and not a glass as its part, as a clock has."""
    return last_word(subject.noun) in SUPPORTS | SURFACES | VESSELS | HOLDERS


class Statements(Relations):
    """Reader of predicates."""

    def _predicate(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        if predicate.span in self.sentences[self.how.sentence].contested:
            self.how = self._guessed(Guess.CONTESTED)
        if subject.role is Role.PART or predicate.subject_part is not None or subject.noun in PARTS | FRONTS:
            predicate = aimed(predicate)
        relation = predicate.relation
        part_said = predicate.subject_part.head if predicate.subject_part is not None else ""
        self.part = last_word(subject.noun if subject.role is Role.PART else part_said)
        handler = getattr(self, f"_say_{relation}", None)
        if subject.itself.absent and predicate.arguments and self.how.positive and not self.how.past:
            self._found_elsewhere(subject.itself)
        if subject.role is Role.PART and subject.noun in _DETACHED:
            own = NounPhrase(self.how.span, head=subject.noun, determiner="the")
            moved = relation in _APART and bool(predicate.arguments)
            thing = self.references.find(own) if moved else self.references.earlier(own)
            subject = thing or subject  # 'the lid of the jar is on the tray'
        if subject.role is Role.PART and subject.whole is not None:
            if not predicate.arguments and relation in ("left", "right"):  # its handle to the right
                self._add("pointing", (subject.whole,), (), value=relation)
                return
            lies = relation in DIRECTIONS or relation in ("on", "under", "inside")
            if relation in PLACES or relation in _OF_PARTS or (not predicate.arguments and lies):
                return  # said about the part alone: 'the rounded edge is at the top', 'the lid of the box is red'
            if any(a.pronoun in ("it", "they") and not a.head for a in predicate.arguments):
                return  # 'the drill, its cord wrapped around it'
            apart = predicate.arguments and relation not in ("inside", "on", "touching", "pointing", "facing")
            if relation == "upside_down" or (subject.noun in FLEXIBLE and (apart or relation in DIRECTIONS)):
                return  # the label, and not the bottle; the cable, and not the lamp
            denied = not (self.how.positive and predicate.positive)
            if denied and relation not in ("pointing", "facing", "open", "closed"):
                return  # what is denied of a part need not be so of the whole
            subject = subject.whole
        if subject.role is Role.ABSTRACT and relation == "kind":
            self._say_kind(subject, predicate, others)
        if subject.role in (Role.VIEWER, Role.PERSON, Role.ABSTRACT) or last_word(subject.noun) in GAPS:
            return
        if predicate.subject_part is not None and " " in predicate.subject_part.head:
            owner, _, part = predicate.subject_part.head.rpartition(" ")
            if part in PARTS:  # 'with the knife blade facing the plate'
                named = self.references.earlier(NounPhrase(predicate.subject_part.span, owner, "the"))
                subject = named or subject
        if predicate.subject_part is not None and relation not in ("pointing", "facing", "open", "closed", "parallel"):
            return  # said about a part: 'whose stick is in the pot'
        if handler is not None:
            handler(subject, predicate, others)
        elif predicate.degree is Degree.COMPARATIVE and _is_all_else(predicate):
            self._property(subject, replace(predicate, arguments=(), degree=Degree.SUPERLATIVE))
        elif self._is_seen_from_the_viewer(predicate):
            nearer = replace(predicate, relation="bottom" if relation == "near" else "top", degree=Degree.PLAIN)
            self._relate(subject, replace(nearer, arguments=(predicate.than,), than=None), others)  # type: ignore[arg-type]
        elif relation in UNARY or (predicate.value is not None and not predicate.arguments and not predicate.part):
            self._property(subject, predicate)
        elif relation in PLACES:
            self._place(subject, predicate, others)
        elif not predicate.arguments and relation == "inside" and predicate.span[0] == self.how.span[0]:
            self._bare_direction(subject, predicate)  # 'inside are my earrings'
        elif not predicate.arguments and relation == "on" and not predicate.part:
            if "top" in self.text[slice(*predicate.span)].casefold():
                self._on_top(subject)
        elif not predicate.arguments and relation == "between":
            pair = self.references.last_two_subjects(subject)
            if pair is not None:
                self._between(subject, [pair])  # 'a cup on the left, a jug on the right, and in between a pot'
        elif not predicate.arguments and (relation in DIRECTIONS or relation in ("near", "far", "around", "next_to")):
            self._bare_direction(subject, predicate)
        else:
            self._relate(subject, predicate, others)

    def _is_seen_from_the_viewer(self, predicate: Predicate) -> bool:
        """Return True for *nearer to you than X* and *farther than X*, which compare along the line of sight."""
        return (
            predicate.relation in ("near", "far")
            and predicate.degree is Degree.COMPARATIVE
            and predicate.than is not None
            and all(a.pronoun in VIEWER_WORDS or last_word(a.head) == VIEWER for a in predicate.arguments)
        )

    def _property(self, subject: Entity, predicate: Predicate) -> None:
        value = predicate.value.word if predicate.value is not None else None
        relation = predicate.relation
        if predicate.degree is Degree.SUPERLATIVE and predicate.value is not None:
            if subject.itself.members or predicate.value.word in ("high", "low"):
                return  # 'the smallest' of them is one of them; 'put it lowest on the cart' tells a place
            name = SUPERLATIVES.get((predicate.value.dimension, POLES.get(predicate.value.word, 0)))
            if name is not None:
                self._add(name, (subject,), ())
            return
        if relation in ("colour", "material", "shape", "size") and value is not None and self.how.positive:
            for leaf in subject.leaves():
                leaf.adjectives.add((relation, value))
        if value in ("nested", "nest", "stacked", "stack") and (subject.itself.members or subject.plural):
            relation, value = ("nested" if value.startswith("nest") else "stacked"), None
        elif relation == "open" and self.text[predicate.span[1] : self.end].lstrip().casefold().startswith("to "):
            return  # 'the hall is open to the kitchen'
        elif relation in ("upside_down", "empty", "open", "closed"):
            value = None
        elif (
            value is None
            or relation in ("other", "position")
            or value in NOT_STATES
            or (relation == "state" and _is_placed(value))
        ):
            return
        elif relation == "state" and ("being" in predicate.adverbs or not UNJOINED.isdisjoint(self.how.guesses)):
            return  # 'it is being cleaned' and 'it is reflecting the lamp' tell what happens, and not a state
        elif relation == "state" and self._is_doubtful_state(predicate):
            return
        elif relation == "state":
            value = self._participle(value, predicate)
        self._add(relation, (subject,), (), value=value)

    def _participle(self, lemma: str, predicate: Predicate) -> str:
        """Return the participle for a state of a thing: *hidden* for *it is hidden*, *burning* for *burns*."""
        forms = verb_forms()
        written = [w for w in self.text[slice(*predicate.span)].casefold().split() if w in forms]
        found = next((word for word in written if forms[word].lemma == lemma), None)
        if found is None or forms[found].form not in ("s", "base"):
            return found or lemma
        return next((word for word, form in forms.items() if form.lemma == lemma and form.form == "ing"), lemma)

    def _is_doubtful_state(self, predicate: Predicate) -> bool:
        """Return True for what may be done to a thing, and where words beside a state were not understood.

        Examples are *the lid can be removed* and *fill it half full with what you want to use*.
        """
        lost = self.references.lost
        acts = predicate.value is not None and predicate.value.word.endswith("ing")
        may_be = _MAY_BE.search(self.text[self.how.span[0] : predicate.span[1]]) is not None
        return acts or may_be or any(end <= predicate.span[0] or start > predicate.span[1] for start, end in lost)

    def _say_one_each(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        pass

    def _say_there(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        pointed = self.text[slice(*predicate.span)].casefold().split()[-1:] in (["here"], ["there"])
        here = pointed and not predicate.arguments  # not 'anywhere'
        if here and subject.role is Role.THING and _KEPT.search(self.text[slice(*self.how.span)]):
            self._say_here(subject, others)
            return
        if self.how.positive or self.how.past:
            return
        for leaf in subject.leaves():
            leaf.absent = True
            self._add("count", (leaf,), (), value="0", how=replace(self.how, positive=True))

    def _say_here(self, subject: Entity, others: list[Entity]) -> None:
        """Read *the door is warm, so keep it there*: at the place that was named last, or that of the heading."""
        late = [f for f in self.references.recent[:2] if f.sentence >= self.how.sentence - 1]
        named = [e for f in late for e in (*f.others, f.subject) if e is not None and e.itself is not subject.itself]
        place = next((e for e in named if e.role is not Role.PERSON and self._holding(e) is not None), None)
        if place is not None:
            self._pair(subject, self._holding(place) or "on", place, False)
            others.append(place)
            return
        for predicate in self.titled:
            self._predicate(subject, predicate, others)

    def _holding(self, thing: Entity) -> str | None:
        """Return the relation of what is kept in or on a thing; None for a thing in which nothing is kept."""
        noun = last_word(thing.noun)
        stated = next((d.relation for d in reversed(self.drafts) if thing in d.arguments), None)
        if stated in ("inside", "on") and noun in VESSELS | HOLDERS | SURFACES | SUPPORTS:
            return stated
        return "inside" if noun in VESSELS | HOLDERS else "on" if noun in SURFACES | SUPPORTS | {"door"} else None

    def _say_follows(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        """Read *followed by the probe*: it is farther on in the direction in which the first was placed."""
        last = next((d for d in reversed(self.drafts) if subject in d.subjects and d.relation != "count"), None)
        sides = {"left", "right"} & {last.relation, *(last.value or "").split()} if last is not None else set()
        ordered = self.order is not None or (last is not None and last.relation == "part")
        relation = "right" if ordered and "left" in sides else "left" if ordered and "right" in sides else None
        relation = relation or (last.relation if last is not None and last.relation in ("left", "right") else "next_to")
        if last is not None and last.relation in ("on", "inside", "above", "under"):
            return  # 'on the gravel comes moss, followed by charcoal' tells an order in time
        before = subject
        for phrase in predicate.arguments:
            for member in phrase.members or (phrase,):
                following = self._introduce(member, "right", subject)
                if following is not None:
                    self._pair(following, relation, before, False)
                    others.append(following)
                    before = following

    def _say_kind(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        """Read *it is the tallest*, *the third is the shortest of them*, *it is a red cup*."""
        one = [a for a in predicate.arguments if a.pronoun == "one" and a.determiner is None and not a.head]
        if one and one == list(predicate.arguments) and subject.itself.members and one[0].predicates:
            free = [leaf for leaf in subject.leaves() if not leaf.is_picked]
            if free:  # 'there are two candles: one behind the cross and one in front of it'
                self._say(self.references.picked(free[0], one[0]), one[0].predicates, one[0])
            return
        for phrase in predicate.arguments:
            abstract = subject.role is Role.ABSTRACT or subject.noun in _TURNS or self._is_no_thing(subject)
            if abstract and phrase.head and phrase.predicates:
                self._introduce(phrase)  # 'the only exception is the oyster fork, which goes on the right'
            if abstract and (phrase.predicates or subject.role is Role.ABSTRACT):
                continue
            one_of_them = phrase.pronoun == "one" and phrase.determiner == "the"  # 'my mug, the big blue one'
            for adjective in phrase.adjectives:
                name = SUPERLATIVES.get((adjective.dimension, POLES.get(adjective.word, 0)))
                if adjective.degree is Degree.SUPERLATIVE and name is not None:
                    group = None if phrase.of is None else self.references.find(phrase.of, None, subject)
                    rest = [
                        leaf for leaf in (group.leaves() if group is not None else ()) if leaf is not subject.itself
                    ]
                    self._add(name, (subject,), tuple(rest))
                elif adjective.degree is Degree.SUPERLATIVE and adjective.word in ("left", "right"):
                    self._add(f"{adjective.word}most", (subject,), ())
                elif adjective.dimension == "rank" and adjective.rank is not None and phrase.head not in GENERAL:
                    self._add("ordinal", (subject,), (), value=f"{adjective.rank} from left")
                elif adjective.dimension in ("colour", "size", "material", "shape") and (phrase.head or one_of_them):
                    self._add(adjective.dimension, (subject,), (), value=adjective.word)
                    subject.itself.adjectives.add((adjective.dimension, adjective.word))
            if phrase.head and phrase.head not in GENERAL and phrase.determiner in ("a", "an"):
                subject.itself.aliases.add(phrase.head)
                self.references.renamed.append(subject.itself)
                subject.mention(self.references.words(phrase))
            if (
                phrase.head
                and phrase.head not in GENERAL
                and not phrase.adjectives
                and phrase.determiner in ("a", "an")
            ):
                self._add("kind", (subject,), (), value=plain_noun(phrase.head))
            if phrase.predicates and not (phrase.head in PLACE_NOUNS or phrase.head in PLACES_OF):
                self._say(subject, phrase.predicates, phrase, focus=False)

    def _say_ordinal(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        if predicate.value is not None and predicate.value.rank is not None:
            group = subject.itself.group
            rest = () if group is None else tuple(leaf for leaf in group.leaves() if leaf is not subject.itself)
            value = f"{predicate.value.rank} from {predicate.part or 'left'}"
            self._add("ordinal", (subject,), rest, value=value)

    @staticmethod
    def _is_tableware(head: str) -> bool:
        """Return True for a noun of one thing, and not of a stuff: *saucer* of *a cup with saucer and spoon*."""
        return last_word(head) in VESSELS | SUPPORTS | _CUTLERY

    def _say_with(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        """Read what a thing has: contents, a part in some state, or another thing at it."""
        for phrase in predicate.arguments:
            if not predicate.positive:
                continue  # without the cup on the saucer
            if phrase.pronoun in ("none", "nothing") or phrase.determiner == "no":
                for thing in self.shared[1] if self.shared is not None else ():
                    self._add(self.shared[0], (subject,), (thing,), how=replace(self.how, positive=False))  # type: ignore[index]
            elif phrase.owner is not None and not phrase.head and self.shared is not None:
                thing = Entity(self.shared[1][0].noun, born=self.how.sentence)
                thing.mention(self._words(phrase))
                self.references.entities.append(thing)
                self.shared[1].append(thing)
                self._add(self.shared[0], (subject,), (thing,))
            elif phrase.head in SUBSTANCES or (
                last_word(subject.noun) in VESSELS and phrase.head and phrase.determiner is None and not phrase.plural
                and not self._is_tableware(phrase.head)
                and phrase.owner is None and not phrase.predicates and phrase.count is None
            ):  # fmt: skip
                self._add("contents", (subject,), (), value=phrase.head)
            elif last_word(phrase.head) in PARTS or (phrase.head == "glass" and not _carries(subject)):
                states = [a.word for a in phrase.adjectives if a.dimension == "state"]
                if states:
                    self._add("state", (subject,), (), value=f"{states[0]} {phrase.head}")
            elif phrase.head:
                phrase = self._placed_on(phrase, subject)
                own = any(a.pronoun == "it" for p in phrase.predicates for a in p.arguments)
                if own and subject.role is Role.THING:  # 'the bucket is by the hatch with the lemons beside it'
                    self.references.recent.insert(0, Focus(subject, [], None, self.how.sentence))
                host, self.references.host = self.references.host, subject.itself
                held = self._introduce(phrase, "with", subject)
                self.references.host = host
                if own and subject.role is Role.THING:
                    self.references.recent.pop(0)
                part = (
                    phrase.plural
                    and phrase.determiner is None
                    and phrase.count is None
                    and predicate.relation == "with"
                )
                vague = part and last_word(subject.noun) not in SUPPORTS | SURFACES | VESSELS | HOLDERS
                if held is not None and held.role is Role.THING:
                    others.append(held)
                if held is not None and held.role is Role.THING and not phrase.predicates and not vague:
                    self._hold(subject, held, self._words_of_clause())

    def _words_of_clause(self) -> list[str]:
        """Return the words of the clause; those of the sentence if the clause leaves out the verb of the one before."""
        words = self.text[slice(*self.how.span)].casefold().split()
        if {"with", "has", "have", "having", *CONTAINING, *HOLDING}.isdisjoint(words):
            return self.text[self.references.start : self.end].casefold().split()
        return words

    def _placed_on(self, phrase: NounPhrase, subject: Entity) -> NounPhrase:
        """Return *a lamp at each end*, which a thing has, with the thing as what the ends are of."""
        if subject.role is not Role.THING or not phrase.predicates:
            return phrase
        whole = NounPhrase(phrase.span, subject.noun, "the")
        made = []
        for predicate in phrase.predicates:
            own = [a for a in predicate.arguments if a.pronoun == "it"]
            if (
                predicate.relation in PLACES | {"each_side", "left", "right"}
                and (own or not predicate.arguments)
                and (predicate.relation in PLACES | {"each_side"} or own)
            ):
                if self._at_each(predicate) and phrase.count is None and not phrase.plural:
                    phrase = replace(phrase, count=2, determiner=None, plural=True)
                predicate = replace(predicate, arguments=(whole,))
            made.append(predicate)
        return replace(phrase, predicates=tuple(made))

    def _say_leftmost(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        self._add("leftmost", (subject,), ())

    def _say_share(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        for phrase in predicate.arguments:
            thing = self._introduce(phrase, None, subject)
            if thing is not None:
                relation = "inside" if last_word(thing.noun) in (VESSELS | HOLDERS) - SUPPORTS else "on"
                self.shared = (relation, [thing])
                self._add(relation, (subject,), (thing,))

    def _say_parallel(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        for phrase in predicate.arguments:
            if phrase.pronoun == "it" and self.edge is not None:
                self._add("parallel", (subject,), (), value=f"{self.edge} edge")
                return
            region = self.references.region(phrase)
            if region is not None and region.value is None and region.term == "edge" and self.edge is not None:
                self._add("parallel", (subject,), (), value=f"{self.edge} edge")
                return
        self._relate(subject, predicate, others)
