"""Turn parsed sentences into facts: what each clause states about which objects, and with what qualification."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

from deixis.deadline import Deadline
from deixis.grammar.english.confidence import Guess
from deixis.grammar.english.discourse.commitment import (
    AT_MOST,
    CONSEQUENCE,
    ELSEWHERE,
    EVENT,
    FRAMED,
    FUTURE,
    HABIT,
    LEFT,
    LIMITED,
    NOW,
    OBLIGED,
    PAST_RELATIVE,
    PAST_TIME,
    PRESENT,
    REPORTED,
    REVOKED,
    SAID_AFTER,
    SELDOM,
    UNREAL,
    UNSURE,
    UNTIL,
    condition_of,
    inserted_condition,
    is_condition,
)
from deixis.grammar.english.discourse.drafts import RARE, Draft, Qualification
from deixis.grammar.english.discourse.entities import Entity, Role
from deixis.grammar.english.discourse.mentions import SUPERLATIVES, _with_restrictions_of_contents
from deixis.grammar.english.discourse.references import POLES, Focus
from deixis.grammar.english.discourse.statements import Statements
from deixis.grammar.english.discourse.surfaces import DIRECTIONS
from deixis.grammar.english.rewording import DOUBT
from deixis.grammar.english.tree import Clause, Degree, Mood, NounPhrase, Predicate, Sentence
from deixis.grammar.english.vocabulary.adjectives import is_adjective
from deixis.grammar.english.vocabulary.nouns import (
    ABSTRACT,
    FRONTS,
    GENERAL,
    HOLDERS,
    PARTS,
    PEOPLE,
    PLACES_OF,
    REMOVABLE,
    SURFACES,
    VIEWER_WORDS,
    last_word,
)
from deixis.grammar.english.vocabulary.relation_words import PLACE_NOUNS
from deixis.grammar.english.vocabulary.things import can_have_a_place
from deixis.grammar.english.vocabulary.verbs import verb_forms
from deixis.ontology.graph.claims import PLACES

UNCERTAIN = frozenset({"might", "may", "could", "would"})

HYPOTHETICAL = UNCERTAIN | {"will", "can"}
"""Modal verbs of clauses about things that need not be there: *crumbs near the fan will burn*."""

NOT_NEEDED = frozenset({"need", "needn't", "have to", "has to", "needs to", "need to"})

LABEL = re.compile(
    r"\s*(?:first|second|third|next|then|last)?\s*:\s*(?P<again>(?:[\w'\u2019-]+\s+){0,3}(?:it|them|they)\b)?",
    re.IGNORECASE,
)
"""Words after a label of what follows: *towel first: fold it*."""
ITEM_LABEL = re.compile(r"([A-Z][\w'\u2019-]*(?:\s+[\w'\u2019-]+){0,2})\s*:\s+\w")
"""Label of an item and what is said about it: *Soup spoon: a large and round spoon.*"""
AGAIN = re.compile(r"\b(?:and|then|,)\s+(?:then\s+)?\w+\s+(?:it|them)\b", re.IGNORECASE)
"""Second command about the object of the first: *take a cup and put it on the tray*."""
ABOUT_IT = re.compile(r"\s*(?:it|they)\s", re.IGNORECASE)
MEASURES = frozenset({"size", "height", "length", "width", "thickness"})
"""Properties that a part and its whole need not share."""
BARE_AFTER_BE = re.compile(
    r"\b(?:is|are|was|were|be|been|remains?|perfectly|quite)\s+(?:all\s+)?$|['\u2019]s\s+$", re.IGNORECASE
)
"""Words before *left* or *right* that is not a place, because no *on the* or *of* goes with it."""

CONTRARY = re.compile(r"\b(?:but|instead|actually|yet|however|in fact)\b")
"""Words between what should be and what is."""

MAX_BETWEEN_CLAUSES = 40
"""Number of characters between two clauses that are contrasted."""

_INSTEAD = re.compile(r"\b(?:instead\s+of|rather\s+than)\b", re.IGNORECASE)
"""Words before a place that another one stands for."""

_NO_PERSON = re.compile(r"no(?:body|[ -]one)", re.IGNORECASE)
"""Subjects by which a person, and no thing, is not somewhere."""

EACH_APART = re.compile(
    r"\b(?:are|were)\s+each\b(?!\s+(?:of|other)\b)|\w+\s+each\s+(?:have|are|lie|stand|sit|rest|hang)\b"
    r"|(?<!\bone)\s+each\s*(?=[,.;!]|\band\b|$)",
    re.IGNORECASE,
)
"""Words by which each thing of a subject has its own: *they are each behind a plate*, *they stand on a saucer each*."""

_FORBIDDEN = frozenset(
    {"near", "next_to", "touching", "between", "against", "leaning", "opposite", "across", "facing", "pointing"}
)
"""Relations that *no* denies, besides the directions: *no book touches the lamp*."""

_PILING = frozenset({"stack", "pile", "bundle", "heap"})
"""Commands whose verb names later what they made."""

ABSENT = frozenset(["missing", "miss", "absent", "gone"])


def _is_moved(clause: Clause, subject: NounPhrase) -> bool:
    """Return True for a part that a command puts somewhere, such as a leg of a chair that is assembled."""
    commanded = clause.mood is Mood.COMMAND and clause.span[0] < subject.span[0]
    return commanded and not any(p.relation in ("pointing", "facing") for p in clause.predicates)


def _shown(clause: Clause) -> NounPhrase | None:
    """Return the thing of *this is the closet in my room*, which shows it and is not about what was named before."""
    subject, predicates = clause.subject, clause.predicates
    pointing = subject is not None and subject.pronoun in ("this", "these") and not subject.head
    if not pointing or len(predicates) != 1 or predicates[0].relation != "kind" or not predicates[0].positive:
        return None
    phrases = predicates[0].arguments
    if len(phrases) != 1 or not phrases[0].head or phrases[0].head in PLACE_NOUNS or phrases[0].head in PLACES_OF:
        return None
    definite = phrases[0].determiner == "the" or phrases[0].owner is not None
    return phrases[0] if definite and phrases[0].predicates and phrases[0].of is None else None


_FORBIDDING = re.compile(r"\s*(?:do\s+not|don['\u2019]t|never|avoid)\b", re.IGNORECASE)
"""Beginning of a sentence that forbids something."""
_EXCEPTED = re.compile(r"[;:\u2014]|\b(?:but|instead|rather|except|only|just|then|unless|until)\b", re.IGNORECASE)
"""Words after which such a sentence says what to do."""
_UNREAL = (UNREAL.search, SAID_AFTER.search, FRAMED.search, UNSURE.search, FUTURE.match)
"""Searches for words by which nothing in a sentence is asserted."""


class Discourse(Statements):
    """Reader of parsed sentences, in order; it collects drafts of facts."""

    def read(self, deadline: Deadline = Deadline.never()) -> list[Draft]:
        """Read the sentences; return the drafts of what they state.

        Parameters
        ----------
        deadline
            End of the time limit; the sentences that were not read until then are left out of ``sentences``.

        Returns
        -------
        list of Draft
            Facts and claims about entities, which have no names yet, in the order of the text.
        """
        for number, sentence in enumerate(self.sentences):
            if deadline.passed:
                self.sentences = self.sentences[:number]
                break
            self.references.sentence = number
            self.references.start, self.end = sentence.span
            self.references.lost = [problem.span for problem in sentence.misunderstood]
            self.condition = condition_of(sentence)
            doubt = DOUBT.match(self.text, *sentence.span)
            whole = self.text[sentence.span[0] if doubt is None else doubt.end() : self.end]
            self.unreal = next((found for search in _UNREAL if (found := search(whole)) is not None), None)
            self.reports = REPORTED.search(self.text, *sentence.span) is not None
            self.elsewhere = self._other_viewpoint(sentence)
            self.titled = sentence.place if sentence.heading else self.titled
            parts: list[Clause | NounPhrase] = list(sentence.clauses)
            if sentence.fragment is not None and sentence.text.rstrip("\"'\u201d) ").endswith("?"):
                self._ask_about(sentence.fragment)
            elif sentence.fragment is not None and not sentence.heading:
                parts.append(sentence.fragment)
            for part in sorted(parts, key=lambda part: part.span[0]):
                if isinstance(part, NounPhrase):
                    self._fragment(part, number)
                else:
                    self._clause(part, number)
            self._focus_on_label(number)
        return self.drafts

    def _other_viewpoint(self, sentence: Sentence) -> str | None:
        """Return the words by which a sentence speaks from another place than the viewer's: *seen from the door*.

        A sentence that only states a viewpoint states that of the whole text.
        """
        at = None if sentence.viewpoint is None else sentence.viewpoint.at
        if sentence.viewpoint is None or at is None or not at.head:
            return None
        owner = at.owner or at.of
        here = owner is not None and owner.pronoun in VIEWER_WORDS and not owner.head
        if here or last_word(at.head) in PEOPLE | {"viewer"}:
            return None  # 'from my side of the table'
        if self.seen_from is None and not sentence.clauses and sentence.fragment is None:
            self.seen_from = at.head  # 'The table is seen from the door.'
        if at.head == self.seen_from:
            return None
        return " ".join(self.text[slice(*sentence.viewpoint.span)].strip(" ,").split())

    def _focus_on_label(self, number: int) -> None:
        """Let *it* in the next sentence mean the label of this one, as in *Spoon: a large one*."""
        sentence, following = self.sentences[number], self.sentences[number + 1 : number + 2]
        label = ITEM_LABEL.match(sentence.text)
        if label is None or not following or ABOUT_IT.match(following[0].text) is None:
            return
        words = label[1].casefold().split()
        while len(words) > 1 and is_adjective(words[0]):
            del words[0]
        noun, plural = self.nouns.singular(words[-1])
        if not self.nouns.knows(noun) or noun in SURFACES | HOLDERS | PLACE_NOUNS.keys() | ABSTRACT:
            return
        span = (sentence.span[0], sentence.span[0] + label.end(1))
        head = " ".join([*words[:-1], noun])
        labelled = self._introduce(NounPhrase(span, head=head, determiner="the", plural=plural))
        if labelled is not None:
            self.references.recent.insert(0, Focus(labelled, [], None, number))

    def _fragment(self, phrase: NounPhrase, sentence: int) -> None:
        """Read a sentence without a verb: *rucksack at the back*, or a heading that tells the order of a list."""
        whole_sentence = self.text[self.references.start : self.end]
        wished = UNREAL.search(whole_sentence) is not None
        ended = PAST_TIME.search(whole_sentence) is not None and PRESENT.search(whole_sentence) is None
        self.how = Qualification(
            phrase.span, sentence, weight=0.5 if wished else 1.0, optional=wished, uncertain=wished,
            past=ended and not self.story, guesses=self.sentences[sentence].guesses,
        )  # fmt: skip
        for predicate in phrase.predicates:
            if predicate.relation == "row":
                self.order = predicate.part or self.order
        ordered = bool(phrase.predicates) and all(p.relation == "row" for p in phrase.predicates)
        if ordered and not phrase.plural and not phrase.members and last_word(phrase.head) in SURFACES:
            return  # 'workbench, from left to right'
        listed = phrase.members or (phrase,)
        mark = LABEL.match(self.text[phrase.span[1] : self.end])
        label = mark is not None and (phrase.plural or mark["again"] is not None) and bool(phrase.head)
        if label and phrase.determiner is None and not phrase.predicates and not self.how.uncertain:
            labelled = self._introduce(phrase)  # 'tyre levers: blue ones in the mug, …'
            if labelled is not None:
                self.references.recent.insert(0, Focus(labelled, [], None, sentence))
            return
        clauses = self.sentences[sentence].clauses
        taken = phrase.determiner == "the" and bool(phrase.head or phrase.pronoun == "one") and not phrase.members
        again = AGAIN.search(self.text[phrase.span[1] : self.end]) is not None
        taken = taken or (again and bool(phrase.head) and not phrase.members and phrase.determiner != "no")
        if taken and not phrase.predicates and clauses and phrase.span[0] < clauses[-1].span[0]:
            handled = self._introduce(phrase)  # 'take the red one and put it behind the slit'
            if handled is not None:
                self.references.recent.insert(0, Focus(handled, [], None, sentence))
            return
        missing = all(p.determiner == "no" and self._is_named_thing(p.head) for p in listed)
        if not missing and not any(p.predicates or p.of or p.count for p in (phrase, *listed)):
            return
        if any(last_word(p.head) in ("lot", "content", "list", "thank", "note", "inventory") for p in listed):
            return
        if missing or (phrase.determiner == "no" and phrase.head):
            self._nothing(phrase, Clause(phrase, phrase.predicates, phrase.span))
            return
        subject: Entity | None = None
        fronted = bool(phrase.members and phrase.predicates) and phrase.predicates[0].span[0] < listed[0].span[0]
        if fronted:  # 'left of it, two cups and a spoon on them': *it* goes back to what was said before
            placed = tuple(replace(p, predicates=()) for p in listed if not _is_own_part(p))
            whole = self._introduce(NounPhrase(phrase.span, plural=True, members=placed, joined_by="and"))
            if whole is not None:
                self._say(whole, phrase.predicates, phrase)
        for part in self._with_shared_places(listed):
            if subject is not None and _is_own_part(part):
                for predicate in part.predicates:  # 'shells, front left, hollow side down'
                    self._predicate(subject, predicate, [])
                continue
            if part.pronoun == "one" and subject is not None and subject.members and not part.adjectives:
                self._one_each(subject, part)
                continue
            if _can_be_verb(part):
                self.how = self._guessed(Guess.BARE)
            self.how = replace(self.how, condition=self._inserted_condition(part, part.predicates) or self.condition)
            subject = self._introduce(replace(part, predicates=()))
            if not self.story and PAST_RELATIVE.search(self.text[slice(*part.span)]):
                self.how = replace(self.how, past=True)
            if subject is not None and part.predicates:
                self._say(subject, part.predicates, part)
        if phrase.members and phrase.predicates and not fronted:
            whole = self._introduce(replace(phrase, predicates=()))
            if whole is not None:
                self._say(whole, phrase.predicates, phrase)

    def _is_named_thing(self, noun: str) -> bool:
        """Return True for a known noun or a compound that names a thing: *no flash unit*, but not *no problem*."""
        return bool(noun) and (
            self.nouns.knows(last_word(noun)) or (" " in noun and can_have_a_place(noun, self.nouns))
        )

    def _with_shared_places(self, listed: tuple[NounPhrase, ...]) -> Iterator[NounPhrase]:
        """Yield the things of a note; *oil and vinegar behind it* are one coordination, both behind it."""
        waiting: list[NounPhrase] = []
        placed = False
        for part in listed:
            if not part.predicates:
                waiting.append(part)
                continue
            joined = bool(waiting) and self._joined_to(waiting[-1], part)
            plurals = joined and part.plural and waiting[-1].plural and part.determiner is None
            joined = joined and (len(listed) > 2 or plurals)  # 'knives and spoons right of the plate'
            sharing = len(waiting) if joined and not placed else int(joined)  # all of 'lemons, limes and a knife on it'
            yield from waiting[: len(waiting) - sharing]
            if sharing:
                members = (*waiting[-sharing:], replace(part, predicates=()))
                span = (members[0].span[0], part.span[1])
                part = NounPhrase(span, plural=True, members=members, joined_by="and", predicates=part.predicates)
            yield part
            waiting, placed = [], True
        yield from waiting

    def _joined_to(self, part: NounPhrase, following: NounPhrase) -> bool:
        """Return True if *and* stands between two things of a note."""
        return self.text[part.span[1] : following.span[0]].strip(" ,") in ("and", "&")

    def _ask_about(self, phrase: NounPhrase | None, predicates: tuple[Predicate, ...] = ()) -> None:
        """Take the thing that a question is about as what the next sentence speaks of: *and the knife? it is …*."""
        if phrase is None or not phrase.head or phrase.determiner in ("a", "an", "no", "any"):
            return
        alone = self.text[self.references.start : self.end].strip().rstrip("?").casefold() == phrase.head
        if phrase.determiner is None and phrase.owner is None and not phrase.plural and not alone:
            return  # 'bread? in a basket'
        asked = self.references.find(replace(phrase, predicates=()))
        if asked is not None and asked.role is Role.THING:
            named = [a for p in predicates for a in p.arguments if a.head and a.determiner == "the"]
            others = [e for a in named if (e := self.references.find(replace(a, predicates=()))) is not None]
            self.references.recent.insert(0, Focus(asked, others, None, self.references.sentence))
            self.asked = (self.references.sentence, asked)

    def _one_each(self, group: Entity, phrase: NounPhrase) -> None:
        """Read *one at either end*: a member of the group at each."""
        for predicate in phrase.predicates:
            if predicate.relation in ("end", "side") and predicate.part in (None, "either", "each"):
                for leaf, side in zip(group.leaves(), ("left", "right"), strict=False):
                    leaf.adjectives |= {("picked", f"position {side}")}
                    self._add(predicate.relation, (leaf,), (), value=side)

    def _clause(self, clause: Clause, sentence: int) -> None:
        if clause.mood is Mood.QUESTION:
            self._ask_about(clause.subject, clause.predicates)
            return
        if clause.mood is Mood.STATEMENT and clause.condition is not None and not is_condition(clause.condition):
            clause = replace(clause, condition=None)
        shown = _shown(clause)
        if shown is not None:
            clause = replace(clause, subject=replace(shown, predicates=()), predicates=shown.predicates)
        modal = clause.modal
        denied = tuple(p for p in clause.predicates if not p.positive)
        if modal in UNCERTAIN and clause.positive and 0 < len(denied) < len(clause.predicates):
            affirmed = tuple(p for p in clause.predicates if p.positive)  # 'it may stand behind the box, not on it'
            self._clause(replace(clause, predicates=affirmed), sentence)
            if _INSTEAD.search(self.text[slice(*clause.span)]) is None:  # which denies nothing of what may be
                self._clause(replace(clause, predicates=denied, choices=()), sentence)
            return
        weight = min([self.hedges.get(word, 1.0) for word in clause.hedges] or [1.0])
        positive = clause.positive and all(p.positive for p in clause.predicates)
        if modal in NOT_NEEDED and not positive:
            return
        forbids = clause.subject is not None and (
            clause.subject.pronoun == "nothing" or clause.subject.determiner == "no"
        )  # 'nothing may be stacked on it'
        uncertain = (
            (modal in UNCERTAIN and positive and not (forbids and modal == "may"))
            or weight == 0.5
            or not RARE.isdisjoint(clause.hedges)
        )
        uncertain = uncertain or (modal == "must" and clause.past)  # 'it must have lain there'
        uncertain = uncertain or (modal == "would" and clause.positive)  # 'without the clamp it would lie there'
        none = clause.subject is not None and clause.subject.pronoun == "none"
        self.how = Qualification(
            clause.span, sentence, clause.positive and not none, min(weight, 0.5) if uncertain else weight,
            optional=uncertain or "optionally" in clause.hedges or (modal == "can" and positive and weight == 1.0),
            condition=clause.condition or self.condition or self._inserted_condition(clause.subject, clause.predicates),
            past=self._is_past(clause), uncertain=uncertain, guesses=clause.guesses,
        )  # fmt: skip
        subject = clause.subject
        self.how = replace(self.how, guesses=self.how.guesses | _guesses_of_subject(clause))
        if subject is not None and {m.determiner == "no" for m in subject.members} == {True, False}:
            members = tuple(
                replace(m, determiner=None, negated=True) if m.determiner == "no" else m for m in subject.members
            )
            subject = replace(subject, members=members)  # 'a spoon but no fork'
        if subject is not None and any(member.negated for member in subject.members):
            self._contrast(clause, subject, sentence)  # 'the glass, not the cup, is on the mat'
            return
        if subject is None and self.asked is not None and self.asked[0] == sentence - 1 and clause.predicates:
            self._say(self.asked[1], clause.predicates, None)  # 'the cups? on the crate'
            return
        first = len(self.drafts)
        missing = [
            p for p in clause.predicates
            if p.value is not None and p.value.word in ABSENT and p.positive and p.subject_part is None
        ]  # fmt: skip
        lost = () if subject is None else subject.members or (subject,)
        if missing and lost and all(m.head for m in lost) and not self.how.past and clause.positive:
            for member in lost:
                self._absent(member)
            return
        if (
            subject is not None and subject.pronoun in ("anything", "something")
            and (not clause.positive or any(not p.positive for p in clause.predicates))
        ):  # fmt: skip
            predicates = (*clause.predicates, *subject.predicates)
            subject = replace(subject, pronoun="nothing", predicates=())
            clause = replace(clause, predicates=tuple(replace(p, positive=True) for p in predicates))
        if subject is not None and subject.pronoun == "neither" and subject.of is not None:
            subject = replace(subject, pronoun="both")
            self.how = replace(self.how, positive=not self.how.positive)
        if subject is None or subject.pronoun == "nothing" or subject.determiner == "no" or (
            subject.members and all(m.determiner == "no" for m in subject.members)
        ):  # fmt: skip
            if subject is not None:
                self._nothing(subject, clause)
            return
        if (not clause.predicates and subject.pronoun == "they") or (
            subject.of is not None and subject.of.pronoun == "they" and not subject.head and not clause.predicates
        ):
            self._count(subject)
            return
        subject = _with_restrictions_of_contents(subject)
        if modal in HYPOTHETICAL and subject.predicates and _names_any(subject):
            subject = replace(subject, predicates=())  # 'crumbs near the fan will burn'
            if not clause.predicates:
                return
        order = tuple(p for p in subject.predicates if p.relation == "follows")
        if order and clause.predicates:  # 'on the left comes a cup, followed by a jug': the place goes first
            subject = replace(subject, predicates=tuple(p for p in subject.predicates if p not in order))
            clause = replace(clause, predicates=(*clause.predicates, *order))
        unreal = self.unreal or REVOKED.search(self.text[clause.span[1] : self.end])
        if self.reports:
            unreal = unreal or REPORTED.search(self.text, self.references.start, clause.span[1])
        if clause.mood is Mood.COMMAND:
            unreal = unreal or CONSEQUENCE.match(self.text[clause.span[1] : self.end])
        bounds = AT_MOST.finditer(self.text, self.references.start, clause.span[1])
        unreal = unreal or next((match for match in bounds if match.end() > clause.span[0]), None)
        forbidden = _FORBIDDING.match(self.text, self.references.start)
        if positive and forbidden and _EXCEPTED.search(self.text, forbidden.end(), max(0, clause.span[0])) is None:
            is_lost = any(forbidden.end() <= start <= clause.span[0] for start, _ in self.references.lost)
            unreal = unreal or (forbidden if is_lost else None)  # 'do not put soiled, chipped or bent knives on it'
        if (unreal and positive) or SELDOM.search(self.text[slice(*clause.span)]):
            self.how = replace(self.how, uncertain=True, optional=True, weight=0.5)
        if not clause.predicates and not clause.choices and not clause.existential:
            if clause.condition is not None and clause.mood is Mood.STATEMENT:
                subject = _without_verb(subject)  # 'when the kettle boils'
            handled = self._introduce(subject)  # 'fold the napkin'
            if handled is not None:
                verb = self.text[slice(*clause.span)].casefold().partition(" ")[0]
                if verb in _PILING and clause.mood is Mood.COMMAND:  # 'stack the mats', and later 'the stack'
                    handled.itself.aliases.add(verb)
                    self.references.renamed.append(handled.itself)
                self.references.recent.insert(0, Focus(handled, [], None, sentence))
                self.references.named = []
            return
        if clause.existential and not clause.predicates and subject.predicates:
            clause = replace(clause, predicates=subject.predicates)
            subject = replace(subject, predicates=())
        if clause.existential and not clause.predicates and subject.members:
            subject = _with_shared_surface(subject)
        text = self.text[self.references.start : self.end]
        limit = self._limit(clause, sentence) or ELSEWHERE.match(text) or EVENT.match(text)
        if limit is not None and self.how.condition is None:
            self.how = replace(self.how, condition=limit[0].strip(" ,."))
        predicates = tuple(p for p in clause.predicates if not self._remains(p, clause.existential))
        if not predicates and clause.predicates and not clause.existential:
            return
        aimed = bool(predicates) and all(
            p.relation in ("pointing", "facing")
            or (p.relation == "far" and any(a.pronoun in VIEWER_WORDS for a in p.arguments))
            for p in predicates
        )
        own = subject.determiner is None and subject.owner is None and bool(subject.head) and not subject.count
        last = next((f for f in self.references.recent if f.subject is not None), None)
        if (
            aimed and own and clause.modal is None and last is not None and last.sentence == sentence
            and self.references.earlier(replace(subject, determiner="the")) is None
            and self._of_last(predicates, subject)
        ):  # fmt: skip
            return  # 'the forceps lie in the middle, beaks pointing away'
        if (
            subject.head in PARTS
            and subject.owner is None
            and subject.of is None
            and not (
                (last_word(subject.head) in REMOVABLE or _is_moved(clause, subject))
                and any(
                    (
                        p.arguments
                        and not p.reversed
                        and not (subject.determiner is None and p.relation in ("facing", "pointing"))
                    )
                    or p.relation in PLACES
                    for p in predicates
                )
            )
            and not self._is_thing(subject, predicates, clause)
            and self._of_last(predicates, subject)
        ):
            return
        best = any(a.degree is Degree.SUPERLATIVE for a in subject.adjectives)
        if last_word(subject.head) in GENERAL and best and not subject.plural:
            self._superlative_apposition(subject, predicates)
            return
        if subject.owner is not None and subject.owner.pronoun == "it" and _is_put_beside(subject, predicates):
            subject = replace(subject, owner=None, determiner="the")  # 'its lid lies next to it'
        entity = self._subject(subject, predicates)
        if entity is None:
            return
        apart = EACH_APART.search(self.text[slice(*clause.span)])
        if entity.size > 1 and apart is not None:
            self.how = replace(self.how, quantifier="each")
        if self.obliged is not None and self.how.past and LEFT.search(self.text[self.obliged[3] : clause.span[1]]):
            self.how = replace(self.how, past=False)  # 'it should be here, but I left it there'
        if modal is None and not self.how.past and clause.mood is Mood.STATEMENT:
            self._replaces_what_should_be(entity, clause)
        choices = clause.choices
        if choices:
            self.alternatives += 1
            outer = self.how
            for option in (predicates, *choices):
                self.how = replace(
                    outer, alternative=self.alternatives, optional=True, weight=weight / (len(choices) + 1),
                    need_not_hold=outer.optional,
                )  # fmt: skip
                self._say(entity, option, clause.subject)
        elif positive and _is_choice(subject) and len(entity.members) > 1:
            self._say_of_one(entity, predicates, subject)
        else:
            self._say(entity, predicates, subject, existential=clause.existential)
        if modal in UNCERTAIN and positive:
            self._alternative_to_the_last(first, entity)
        if modal in OBLIGED:
            self.obliged = (entity, first, len(self.drafts), clause.span[1])

    def _limit(self, clause: Clause, sentence: int) -> re.Match[str] | None:
        """Return the words for a time outside which a clause need not hold: *…, but most nights it is in the sink*."""
        spans = [other.span for other in self.sentences[sentence].clauses]
        start = max((end for _, end in spans if end <= clause.span[0]), default=clause.span[0])
        following = min((other for other, _ in spans if other >= clause.span[1]), default=None)
        denied = not clause.positive or any(not predicate.positive for predicate in clause.predicates)
        until = UNTIL.search(self.text, clause.span[0], following or self.end) if denied else None
        places = [q for p in clause.predicates for q in (p, *(r for a in p.arguments for r in a.predicates))]
        if until is not None and not any(p.relation == "in_front" for p in places):
            return until  # 'never put the cup on the table before dessert'
        for match in LIMITED.finditer(self.text, start, self.end):
            if following is None or not clause.span[1] <= match.start() < following:
                return match
        return None

    def _say_of_one(self, options: Entity, predicates: tuple[Predicate, ...], phrase: NounPhrase) -> None:
        """State predicates of one of several things: *the cup or the mug is on the saucer*."""
        self.alternatives += 1
        outer = self.how
        for option in options.members:
            self.how = replace(
                outer, alternative=self.alternatives, optional=True, weight=outer.weight / len(options.members),
                need_not_hold=outer.optional,
            )  # fmt: skip
            self._say(option, predicates, phrase)
        self.how = outer
        self.references.recent.insert(0, Focus(options, [], None, outer.sentence))

    def _inserted_condition(self, subject: NounPhrase | None, predicates: tuple[Predicate, ...]) -> str | None:
        """Return the condition between a subject and what is said about it."""
        if subject is None or not predicates or predicates[0].span[0] < subject.span[0]:
            return None
        return inserted_condition(self.text[subject.span[0] : predicates[-1].span[1]])

    def _is_past(self, clause: Clause) -> bool:
        """Return True for what was so, and need not be so now: *my mother always kept it here*."""
        wording = self.text[slice(*clause.span)]
        if self.story or NOW.search(wording):
            return False
        text = self.text[self.references.start : self.end]
        ended = PAST_TIME.search(text) is not None and PRESENT.search(wording) is None
        return clause.past or ended or HABIT.search(wording) is not None

    def _contrast(self, clause: Clause, subject: NounPhrase, sentence: int) -> None:
        for negated in (False, True):
            members = tuple(replace(m, negated=False) for m in subject.members if m.negated is negated)
            if members:
                phrase = members[0] if len(members) == 1 else replace(subject, members=members)
                answered = tuple(replace(p, positive=not p.positive) if negated else p for p in clause.predicates)
                self._clause(replace(clause, subject=phrase, predicates=answered), sentence)

    def _replaces_what_should_be(self, entity: Entity, clause: Clause) -> None:
        """Take back *it should be in the drawer* before *but it is on the shelf*."""
        if self.obliged is None or self.obliged[0].itself is not entity.itself:
            return
        _, first, last, end = self.obliged
        between = self.text[end : clause.span[0]].casefold()
        if len(between) > MAX_BETWEEN_CLAUSES or not CONTRARY.search(
            between + self.text[slice(*clause.span)].casefold()
        ):
            return
        for place in range(first, last):
            if self.drafts[place].subjects == (entity,):
                how = replace(self.drafts[place].how, uncertain=True, optional=True, weight=0.5)
                self.drafts[place] = replace(self.drafts[place], how=how)
        self.obliged = None

    def _remains(self, predicate: Predicate, existential: bool) -> bool:
        """Return True for *left* of *leave* and *right* that means correct: *two forks are left*, *that is right*."""
        word = self.text[slice(*predicate.span)].casefold()
        if word not in ("left", "right") or predicate.arguments:
            return False
        if BARE_AFTER_BE.search(self.text[self.references.start : predicate.span[0]]):
            return True
        if word != "left":
            return False
        after = (*self.text[predicate.span[1] :].casefold().split(None, 1)[:1], "")[0].strip(",.;")
        return existential or after in ("over", "the", "a", "an", "it", "them")

    def _alternative_to_the_last(self, first: int, entity: Entity) -> None:
        """Mark *should be there, but might be here* as a choice."""
        before = next((d for d in reversed(self.drafts[:first]) if d.subjects == (entity,)), None)
        if before is None or before.how.sentence != self.how.sentence or before.how.alternative is not None:
            return
        self.alternatives += 1
        for place, draft in enumerate(self.drafts):
            if (place >= first or draft is before) and draft.subjects == (entity,):
                how = replace(
                    draft.how, alternative=self.alternatives, weight=min(draft.how.weight, 0.7), optional=True
                )
                self.drafts[place] = replace(draft, how=how)

    def _nothing(self, subject: NounPhrase, clause: Clause) -> None:
        """Read *nothing lies between the boots*, *no stopper was found*."""
        is_described = any(argument.predicates for p in clause.predicates for argument in p.arguments)
        if _NO_PERSON.fullmatch(self._words(subject)) and not is_described:
            return  # 'so that no one sits in the salad'
        predicates = tuple(p for p in clause.predicates if p.relation != "there")  # 'anywhere near it'
        if not predicates:
            for phrase in subject.members or (subject,):
                if phrase.head and last_word(phrase.head) not in GENERAL:
                    self._absent(phrase)
            return
        forbidden = clause.modal in (None, "may", "must", "should", "shall", "can")
        if not forbidden and subject.pronoun is None and last_word(subject.head) not in GENERAL:
            return
        known = self.references.earlier(replace(subject, determiner="the")) if subject.head else None
        inside = all(p.relation in ("on", "inside") for p in predicates)
        if known is None and subject.head and inside and last_word(subject.head) not in GENERAL:
            if not self.text[: subject.span[0]].rstrip().casefold().endswith((" so", " so that")):
                self._absent(subject)  # unlike 'in a box, so that no juice drips on it'
            return
        if known is not None and last_word(subject.head) not in GENERAL:
            self.how = replace(self.how, positive=False)  # 'no glass stands to the left of it' after 'the glasses'
            self._say(known, tuple(replace(p, positive=True) for p in predicates), None)
            return
        specific = bool(subject.head) and last_word(subject.head) not in GENERAL and subject.pronoun is None
        surface = self.references.surface_noun
        specific = specific and not any(last_word(a.head) == surface for p in predicates for a in p.arguments)
        if specific and all(p.arguments and p.relation in DIRECTIONS | _FORBIDDEN for p in predicates):
            thing = self.references.find(replace(subject, determiner="the", predicates=()))
            if thing is not None:  # 'no flowers may stand in front of the cross', which may or may not be there
                self.how = replace(self.how, positive=False)
                self._say(thing, tuple(replace(p, positive=True) for p in predicates), None)
                thing.absent = True
            return
        for predicate in predicates:
            arguments = [
                a for p in predicate.arguments if isinstance(a := self._argument(p, predicate.relation, None), Entity)
            ]
            if arguments and arguments[0].role is Role.PART and arguments[0].whole is not None:
                self._add(f"none_{predicate.relation}", (arguments[0].whole,), (), value=arguments[0].noun)
                continue
            if not arguments or arguments[0].role is Role.SURFACE:
                if subject.head and last_word(subject.head) not in GENERAL:
                    self._absent(subject)
                continue
            if predicate.relation == "between" and len(arguments) == 1 and not arguments[0].itself.members:
                arguments[0].itself.split(2)
            if not subject.head or last_word(subject.head) in GENERAL:
                self._add(f"none_{predicate.relation}", tuple(arguments), ())

    def _of_last(self, predicates: tuple[Predicate, ...], part: NounPhrase) -> bool:
        """Read *toes pointing forward* of the last subject; False if there is none."""
        last = next((f.subject for f in self.references.recent if f.subject is not None), None)
        if last is None or last.role is not Role.THING:
            return False  # a floor has no handle
        if last.size > 1 and part.determiner == "the" and any(p.arguments for p in predicates):
            return False  # 'the hinges are next to the tin'
        if last.size > 1 and last_word(part.head) in REMOVABLE:
            return True  # 'rosin and cloth are in the case, lid open'
        outer = self.how
        for predicate in predicates:
            self.how = replace(outer, positive=outer.positive and predicate.positive)
            if not predicate.positive and not predicate.arguments and predicate.relation in DIRECTIONS:
                continue  # 'label on top, not underneath' denies nothing of the whole
            if predicate.relation in ("left", "right") and not predicate.arguments:
                self._add("pointing", (last,), (), value=predicate.relation)
                continue
            if predicate.relation in MEASURES or predicate.relation in ("colour", "material", "shape"):
                continue  # 'the cable is too short'
            if predicate.relation == "far":
                predicate = replace(predicate, relation="pointing", arguments=(), value=None, part="away")
            if (predicate.relation == "pointing" and any("same" in self._words(a) for a in predicate.arguments)) or (
                predicate.relation == "pointing" and predicate.part is not None and "same" in predicate.part
            ):
                self._add("parallel_each_other", (last,), ())
            else:
                kept = tuple(adverb for adverb in predicate.adverbs if adverb not in ("toward", "towards"))
                self._predicate(last, replace(predicate, adverbs=kept), [])
        return True

    def _is_thing(self, subject: NounPhrase, predicates: tuple[Predicate, ...], clause: Clause) -> bool:
        """Return True for parts that lie somewhere by themselves: *Blades are stored in the drawer*."""
        begins = clause.span[0] == self.references.start and clause.mood is Mood.STATEMENT
        if begins and any(p.relation == "part" and p.arguments and p.part in ("front", "back") for p in predicates):
            return True  # 'the handle goes on the front of the drawer'
        before = self.references.recent[0] if self.references.recent else None
        listed = before is not None and before.sentence == self.references.sentence and before.relation is not None
        placed = [p.relation for p in predicates if p.arguments and p.relation in ("inside", "on")]
        if listed and before is not None and before.relation in placed and subject.plural:
            return True  # 'the pegs are in the upper drawer, the necks in the lower'
        places = any(p.arguments and p.relation in ("inside", "on", "under", "behind", "next_to") for p in predicates)
        return begins and places and subject.plural and subject.determiner is None and not subject.adjectives

    def _superlative_apposition(self, phrase: NounPhrase, predicates: tuple[Predicate, ...]) -> None:
        last = next((f.subject for f in self.references.recent if f.subject is not None), None)
        if last is None:
            return
        where = next((p.part for p in predicates if p.relation in PLACES), None)
        for adjective in phrase.adjectives:
            name = SUPERLATIVES.get((adjective.dimension, POLES.get(adjective.word, 0)))
            if name is not None:
                self._add(name, (last,), (), value=where)


def _names_any(phrase: NounPhrase) -> bool:
    """Return True for a phrase that names no certain thing: *a spill*, *crumbs*."""
    parts = phrase.members or (phrase,)
    bare = all(p.head and p.owner is None and p.count is None for p in parts)
    return bare and all(p.determiner in ("a", "an", "any", None) for p in parts)


def _is_choice(phrase: NounPhrase) -> bool:
    """Return True for *a cup or a mug*, of which one is meant, but not for *plates or bowls*, which are both."""
    kinds = any(member.plural and member.determiner is None for member in phrase.members)
    return phrase.joined_by == "or" and not kinds


def _guesses_of_subject(clause: Clause) -> frozenset[Guess]:
    """Return the doubtful steps by which the subject of a clause is found."""
    subject = clause.subject
    if subject is None:
        return frozenset()
    vague = subject.pronoun in ("these", "those") and not (subject.head or subject.of or subject.adjectives)
    twice = subject.pronoun == "it" and any(a.pronoun == "it" for p in clause.predicates[:1] for a in p.arguments)
    if twice and clause.mood is Mood.COMMAND:
        return frozenset({Guess.ELLIPSIS})  # 'wrap it around it'
    return frozenset({Guess.THOSE} if vague else {Guess.BARE} if _can_be_verb(subject) else ())


def _with_shared_surface(phrase: NounPhrase) -> NounPhrase:
    """Return *two bowls, a spoon and a jar on the mat*, which are there, with the mat as the place of each."""
    *others, last = phrase.members
    shared = phrase.joined_by == "and" and not any(member.predicates or member.negated for member in others)
    named = {last_word(member.head) for member in phrase.members}
    carried = last.predicates and all(
        p.relation in ("on", "inside") and not p.reversed
        and all(a.determiner == "the" and last_word(a.head) not in named for a in p.arguments)
        for p in last.predicates
    )  # fmt: skip
    if not (shared and carried):
        return phrase
    return replace(phrase, members=tuple(replace(member, predicates=last.predicates) for member in phrase.members))


def _is_put_beside(part: NounPhrase, predicates: tuple[Predicate, ...]) -> bool:
    """Return True for a part that can be taken off, and that lies beside its whole."""
    beside = DIRECTIONS | {"next_to", "near", "under"}
    return part.head in REMOVABLE and any(
        p.relation in beside and any(a.pronoun == "it" and not a.head for a in p.arguments) for p in predicates
    )


def _without_verb(phrase: NounPhrase) -> NounPhrase:
    """Return *the kettle boils*, all of a condition, as the kettle: the last word is its verb."""
    noun = phrase.head.rpartition(" ")[0]
    agrees = bool(noun) and phrase.plural and phrase.count is None and phrase.determiner in ("the", "a", "an")
    return replace(phrase, head=noun, plural=False) if agrees and not phrase.members else phrase


def _can_be_verb(phrase: NounPhrase) -> bool:
    """Return True for one word without an article that is known as a verb and not as a noun: *listen up*."""
    bare = phrase.determiner is None and phrase.owner is None and phrase.count is None and not phrase.adjectives
    return bare and not phrase.known and phrase.head in verb_forms().keys() - PARTS


def _is_own_part(phrase: NounPhrase) -> bool:
    """Return True for a part of the thing before in a note: *shells, hollow side down*, *spoons, bowls downwards*."""
    bare = phrase.determiner is None and phrase.owner is None and bool(phrase.predicates)
    aimed = all(p.relation == "pointing" and p.value is not None and not p.arguments for p in phrase.predicates)
    directed = all(p.relation in ("pointing", "facing") for p in phrase.predicates)
    return bare and directed and (aimed or last_word(phrase.head) in PARTS | FRONTS)
