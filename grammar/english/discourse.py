"""Turn parsed sentences into facts: what each clause states of which objects, and with what qualification."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

from deixis.grammar.english.commitment import (
    CONSEQUENCE,
    ELSEWHERE,
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
    UNREAL,
    UNSURE,
    UNSURE_RELATIVE,
    condition_of,
)
from deixis.grammar.english.confidence import Guess, is_doubtful
from deixis.grammar.english.entities import Entity, Role, plain_noun
from deixis.grammar.english.nouns import (
    GENERAL,
    HEADED,
    HOLDERS,
    PARTS,
    REMOVABLE,
    SUBSTANCES,
    SURFACES,
    VESSELS,
    VIEWER,
    VIEWER_WORDS,
    last_word,
)
from deixis.grammar.english.references import OPPOSITES, POLES, REGIONS, Focus, References, Region
from deixis.grammar.english.surfaces import DIRECTIONS, surface_noun
from deixis.grammar.english.tree import Clause, Degree, Mood, NounPhrase, Predicate, Sentence, Span
from deixis.ontology.claims import COLLECTIVE, PLACES

UNCERTAIN = frozenset({"might", "may", "could", "would"})
NOT_NEEDED = frozenset({"need", "needn't", "have to", "has to", "needs to", "need to"})
MIN_PAST_OF_STORY = 3
"""Number of clauses in the past tense from which a text is a story, whose past is its present."""

GROUNDS = re.compile(r"\b(?:foreground|background)\b", re.IGNORECASE)
BARE_AFTER_BE = re.compile(
    r"\b(?:is|are|was|were|be|been|remains?|perfectly|quite)\s+(?:all\s+)?$|['\u2019]s\s+$", re.IGNORECASE
)
"""Words before *left* or *right* that is not a place, because no *on the* or *of* goes with it."""
CONTRARY = re.compile(r"\b(?:but|instead|actually|yet|however|in fact)\b")
"""Words between what should be and what is."""
MAX_WORDS_AFTER = 3
"""Number of words between a relative clause and the pronoun that stands for its last thing."""
MAX_BETWEEN_CLAUSES = 40
"""Number of characters between two clauses that are contrasted."""

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
SUPERLATIVES = {
    ("size", 1): "largest", ("size", -1): "smallest", ("height", 1): "tallest", ("height", -1): "shortest",
    ("length", 1): "longest", ("length", -1): "shortest", ("width", 1): "widest", ("width", -1): "narrowest",
    ("thickness", 1): "thickest", ("thickness", -1): "thinnest",
}  # fmt: skip
SUPPOSED = {
    "apparently": 0.7,
    "seemingly": 0.7,
    "presumably": 0.7,
    "ideally": 0.7,
    "preferably": 0.7,
}
"""Weights of adverbs that the layout language does not have."""
RARE = frozenset({"hardly", "rarely", "seldom", "scarcely"})
ABSENT = frozenset(["missing", "miss", "absent", "gone"])
NOT_STATES = frozenset(["need", "turn", "roll", "lay", "put", "place", "set", "leave", "open", "water"])
EXACT = (DIRECTIONS - {"in_front", "behind", "above", "below"}) | {"on", "under"}
"""Relations that have an exact reading: *exactly left of*."""

GAPS = frozenset({"gap", "space", "room", "distance"})
"""Nouns of what is between things, which is not a thing."""
NO_FACTS = frozenset({"other", "with", "outside", "from", "as", "through", "to"})
"""Relations of the parser that say nothing of where a thing is."""
CONTAINING = frozenset({"contains", "contain", "containing"})
HOLDING = frozenset({"holds", "hold", "holding"})
SUPPORTS = frozenset(
    [
        "saucer",
        "plate",
        "tray",
        "mat",
        "coaster",
        "napkin",
        "board",
        "cloth",
        "stand",
        "shelf",
        "table",
        "doily",
        "tile",
    ]
)


@dataclass(frozen=True, slots=True)
class Qualification:
    """Negation, weight, condition and other qualifications of the facts of a clause."""

    span: Span
    sentence: int
    positive: bool = True
    weight: float = 1.0
    optional: bool = False
    condition: str | None = None
    past: bool = False
    uncertain: bool = False
    alternative: int | None = None
    quantifier: str | None = None
    need_not_hold: bool = False  # of a choice: none of its alternatives need hold
    guesses: frozenset[Guess] = frozenset()  # doubtful steps by which the fact was read (confidence.py)
    by_handle: bool = False  # a direction of the handle of a tool


@dataclass(frozen=True, slots=True)
class Draft:
    """A fact before its objects have names: groups are expanded when the whole text was read."""

    relation: str
    subjects: tuple[Entity, ...]
    arguments: tuple[Entity, ...]
    how: Qualification
    value: str | None = None
    metres: float | None = None

    @property
    def collective(self) -> bool:
        """True if the relation is one of all subjects together."""
        one_on_another = self.relation == "stacked" and bool(self.arguments)
        return (self.relation in COLLECTIVE and not one_on_another) or self.relation == "count"


class Discourse:
    """Reader of parsed sentences, in order; it collects drafts of facts."""

    def __init__(self, text: str, sentences: tuple[Sentence, ...], hedges: dict[str, float]) -> None:
        self.text = text
        self.sentences = sentences
        self.hedges = SUPPOSED | hedges
        self.drafts: list[Draft] = []
        self.drafted: set[Draft] = set()
        self.told: set[tuple[int, str, str]] = set()
        surface = surface_noun(sentences)
        self.references = References(surface, self._compare, text=text)
        self.order: str | None = None
        self.alternatives = 0
        self.part = ""  # noun of the part that the present predicate is about: 'handle'
        self.shared: tuple[str, list[Entity]] | None = None  # relation and things of 'share'
        self.how = Qualification((0, 0), 0)
        self.asked: tuple[int, Entity] | None = None  # sentence and thing of the last question
        self.introduced: dict[tuple[Span, str, int | None], Entity] = {}  # by their first mention
        self.restricted: dict[Entity, tuple[Entity, int]] = {}  # the last thing of a relative clause and its end
        self.on_surface: Span | None = None  # clause with a place on the surface
        self.edge: str | None = None
        self.end = 0  # of the sentence in the text
        self.condition: str | None = None
        self.obliged: tuple[Entity, int, int, int] | None = None  # subject, drafts and end of 'it should be …'
        tenses = [c.past for s in sentences for c in s.clauses if c.predicates and c.mood is not Mood.QUESTION]
        past = sum(tenses)
        self.story = past >= MIN_PAST_OF_STORY and past >= len(tenses) / 2

    def read(self) -> list[Draft]:
        """Read all sentences; return the drafts of what they state.

        Returns
        -------
        list of Draft
            Facts and claims about entities, which have no names yet, in the order of the text.
        """
        for number, sentence in enumerate(self.sentences):
            self.references.sentence = number
            self.references.start, self.end = sentence.span
            self.references.lost = [problem.span for problem in sentence.misunderstood]
            self.condition = condition_of(sentence)
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
        return self.drafts

    # Clauses ------------------------------------------------------------------------------------------------------

    def _fragment(self, phrase: NounPhrase, sentence: int) -> None:
        """Read a sentence without a verb: *rucksack at the back*, or a heading that tells the order of a list."""
        wished = UNREAL.search(self.text[self.references.start : self.end]) is not None
        self.how = Qualification(
            phrase.span, sentence, weight=0.5 if wished else 1.0, optional=wished, uncertain=wished,
            guesses=self.sentences[sentence].guesses,
        )  # fmt: skip
        for predicate in phrase.predicates:
            if predicate.relation == "row":
                self.order = predicate.part or self.order
        listed = phrase.members or (phrase,)
        label = self.text[phrase.span[1] :].lstrip().startswith(":") and phrase.plural and bool(phrase.head)
        if label and phrase.determiner is None and not phrase.predicates and not self.how.uncertain:
            self._introduce(phrase)  # 'tyre levers: blue ones in the mug, …'
            return
        if not any(p.predicates or p.of or p.count for p in (phrase, *listed)):
            return
        if any(last_word(p.head) in ("lot", "content", "list", "thank", "note", "inventory") for p in listed):
            return
        if phrase.determiner == "no" and phrase.head:
            self._nothing(phrase, Clause(phrase, phrase.predicates, phrase.span))
            return
        subject: Entity | None = None
        for part in self._with_shared_places(listed):
            own = part.determiner is None and part.owner is None and last_word(part.head) in PARTS and part.predicates
            if own and subject is not None and all(p.relation in ("pointing", "facing") for p in part.predicates):
                for predicate in part.predicates:  # 'shells, front left, hollow side down'
                    self._predicate(subject, predicate, [])
                continue
            if part.pronoun == "one" and subject is not None and subject.members:
                self._one_each(subject, part)
                continue
            subject = self._introduce(replace(part, predicates=()))
            if not self.story and PAST_RELATIVE.search(self.text[slice(*part.span)]):
                self.how = replace(self.how, past=True)
            if subject is not None and part.predicates:
                self._say(subject, part.predicates, part)
        if phrase.members and phrase.predicates:
            whole = self.references.find(replace(phrase, predicates=()))
            if whole is not None:
                self._say(whole, phrase.predicates, phrase)

    def _with_shared_places(self, listed: tuple[NounPhrase, ...]) -> Iterator[NounPhrase]:
        """Yield the things of a note; *oil and vinegar behind it* are one coordination, both behind it."""
        waiting: NounPhrase | None = None
        for part, following in zip(listed, (*listed[1:], None), strict=True):
            if waiting is not None:
                members = (waiting, replace(part, predicates=()))
                span = (waiting.span[0], part.span[1])
                yield NounPhrase(span, plural=True, members=members, joined_by="and", predicates=part.predicates)
                waiting = None
            elif (
                following is not None and len(listed) > 2 and not part.predicates and following.predicates
                and self.text[part.span[1] : following.span[0]].strip() in ("and", "&")
            ):  # fmt: skip
                waiting = part
            else:
                yield part

    def _ask_about(self, phrase: NounPhrase | None) -> None:
        """Take the thing that a question is about as what the next sentence speaks of: *and the knife? it is …*."""
        if phrase is None or not phrase.head or phrase.determiner in ("a", "an", "no", "any"):
            return
        if phrase.determiner is None and not phrase.plural:
            return
        asked = self.references.find(replace(phrase, predicates=()))
        if asked is not None and asked.role is Role.THING:
            self.references.recent.insert(0, Focus(asked, [], None, self.references.sentence))
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
            self._ask_about(clause.subject)
            return
        modal = clause.modal
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
            condition=clause.condition or self.condition,
            past=self._is_past(clause), uncertain=uncertain, guesses=clause.guesses,
        )  # fmt: skip
        subject = clause.subject
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
        order = tuple(p for p in subject.predicates if p.relation == "follows")
        if order and clause.predicates:  # 'on the left comes a cup, followed by a jug': the place goes first
            subject = replace(subject, predicates=tuple(p for p in subject.predicates if p not in order))
            clause = replace(clause, predicates=(*clause.predicates, *order))
        if not clause.predicates and not clause.choices and not clause.existential:
            handled = self._introduce(subject)  # 'fold the napkin'
            if handled is not None:
                self.references.recent.insert(0, Focus(handled, [], None, sentence))
            return
        if clause.existential and not clause.predicates and subject.predicates:
            clause = replace(clause, predicates=subject.predicates)
            subject = replace(subject, predicates=())
        whole = self.text[self.references.start : self.end]
        unreal = REVOKED.search(self.text[clause.span[1] : self.end]) or UNREAL.search(whole)
        unreal = unreal or REPORTED.search(self.text, self.references.start, clause.span[1]) or SAID_AFTER.search(whole)
        unreal = unreal or FRAMED.search(whole) or UNSURE.search(whole) or FUTURE.match(whole)
        if clause.mood is Mood.COMMAND:
            unreal = unreal or CONSEQUENCE.match(self.text[clause.span[1] : self.end])
        if unreal and positive:
            self.how = replace(self.how, uncertain=True, optional=True, weight=0.5)
        limit = LIMITED.search(self.text[slice(clause.span[0], self.end)]) or ELSEWHERE.match(
            self.text[self.references.start : self.end]
        )
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
                and any(p.arguments or p.relation in PLACES for p in predicates)
            )
            and self._of_last(predicates, subject)
        ):
            return
        if last_word(subject.head) in GENERAL and any(a.degree is Degree.SUPERLATIVE for a in subject.adjectives):
            self._superlative_apposition(subject, predicates)
            return
        entity = self._subject(subject, predicates)
        if entity is None:
            return
        if self.obliged is not None and self.how.past and LEFT.search(self.text[self.obliged[3] : clause.span[1]]):
            self.how = replace(self.how, past=False)  # 'it should be here, but I left it there'
        if modal is None and not self.how.past and clause.mood is Mood.STATEMENT:
            self._replaces_what_should_be(entity, clause)
        choices = clause.choices
        if choices:
            self.alternatives += 1
            for option in (predicates, *choices):
                share = weight / (len(choices) + 1)
                need_not = self.how.optional if self.how.alternative is None else self.how.need_not_hold
                self.how = replace(
                    self.how, alternative=self.alternatives, optional=True, weight=share, need_not_hold=need_not
                )
                self._say(entity, option, clause.subject)
        else:
            self._say(entity, predicates, subject, existential=clause.existential)
        if modal in UNCERTAIN:
            self._alternative_to_the_last(first, entity)
        if modal in OBLIGED:
            self.obliged = (entity, first, len(self.drafts), clause.span[1])

    def _is_past(self, clause: Clause) -> bool:
        """Return True for what was so, and need not be so now: *my mother always kept it here*."""
        said = self.text[slice(*clause.span)]
        if self.story or NOW.search(said):
            return False
        whole = self.text[self.references.start : self.end]
        ended = PAST_TIME.search(whole) is not None and PRESENT.search(said) is None
        return clause.past or ended or HABIT.search(said) is not None

    def _contrast(self, clause: Clause, subject: NounPhrase, sentence: int) -> None:
        for negated in (False, True):
            members = tuple(replace(m, negated=False) for m in subject.members if m.negated is negated)
            if members:
                phrase = members[0] if len(members) == 1 else replace(subject, members=members)
                said = tuple(replace(p, positive=not p.positive) if negated else p for p in clause.predicates)
                self._clause(replace(clause, subject=phrase, predicates=said), sentence)

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
        if BARE_AFTER_BE.search(self.text[: predicate.span[0]]):
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

    def _subject(self, subject: NounPhrase, predicates: tuple[Predicate, ...]) -> Entity | None:
        """Return the subject of a clause; one new object for each member of a group that an argument quantifies."""
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
                    if argument.determiner in ("each", "every"):
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
        """Return what a phrase stands for, and state what its adjectives, its number and its clauses say of it."""
        if phrase.members:
            found = [e for m in phrase.members if (e := self._introduce(m, relation, besides)) is not None]
            return found[0] if len(found) == 1 else Entity("", members=found) if found else None
        phrase = _with_restrictions_of_contents(phrase)
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
        if phrase.predicates and besides is not None and _said_of_subject(entity, phrase):
            self._say(besides, phrase.predicates, phrase, focus=False)
        elif phrase.predicates and entity.role not in (Role.PERSON, Role.ABSTRACT):
            outer = self.how
            self.how = replace(outer, positive=True, quantifier=None, weight=1.0, optional=False)
            if not self.story and PAST_RELATIVE.search(self.text[slice(*phrase.span)]):
                self.how = replace(self.how, past=True)
            if UNSURE_RELATIVE.search(self.text[slice(*phrase.span)]):
                self.how = replace(self.how, uncertain=True, optional=True, weight=0.5)
            self._say(entity, phrase.predicates, phrase, focus=False)
            self.how = outer
            restriction = self.references.recent[-1]
            if restriction.subject is entity and restriction.others:
                self.restricted = {entity: (restriction.others[-1].itself, phrase.predicates[-1].span[1])}
        return entity

    def _describe(self, entity: Entity, phrase: NounPhrase, new: bool) -> None:
        plain = replace(self.how, positive=True, weight=1.0, optional=False, quantifier=None, alternative=None)
        if self.how.condition or self.how.past or self.how.uncertain:
            return
        for adjective in phrase.adjectives:
            if adjective.degree is Degree.PLAIN and adjective.dimension in ("colour", "size", "material", "shape"):
                if entity.members and not phrase.plural and not new:
                    continue
                key = (id(entity), adjective.dimension, adjective.word)
                if key not in self.told:
                    self.told.add(key)
                    self._add(
                        adjective.dimension, (entity,), (), value=adjective.word, how=replace(plain, span=phrase.span)
                    )
        for adjective in phrase.adjectives:
            name = SUPERLATIVES.get((adjective.dimension, POLES.get(adjective.word, 0)))
            if new and adjective.degree is Degree.SUPERLATIVE and name is not None and not entity.members:
                self._add(name, (entity,), (), how=replace(plain, span=phrase.span))
        if new and entity.members:
            self._add("count", (entity,), (), value=str(entity.size), how=replace(plain, span=phrase.span))
        if phrase.of is not None and phrase.of.head and new:
            stuff = phrase.of.head
            if last_word(phrase.head) in VESSELS:
                self._add("contents", (entity,), (), value=stuff, how=plain)

    def _count(self, phrase: NounPhrase) -> None:
        """Read *there are four of them*."""
        group = self.references.find(NounPhrase(phrase.span, pronoun="they"))
        if group is not None and not group.members and phrase.count is not None and 1 < phrase.count <= 1000:
            group.split(phrase.count)
            self._add("count", (group,), (), value=str(phrase.count))

    def _nothing(self, subject: NounPhrase, clause: Clause) -> None:
        """Read *nothing lies between the boots*, *no stopper was found*."""
        predicates = clause.predicates
        if all(p.relation == "there" for p in predicates):
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
            self._absent(subject)
            return
        if known is not None and last_word(subject.head) not in GENERAL:
            self.how = replace(self.how, positive=False)  # 'no glass stands to the left of it' after 'the glasses'
            self._say(known, tuple(replace(p, positive=True) for p in predicates), None)
            return
        specific = bool(subject.head) and last_word(subject.head) not in GENERAL and subject.pronoun is None
        if specific and all(p.arguments and p.relation in DIRECTIONS | {"near", "next_to"} for p in predicates):
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

    def _absent(self, phrase: NounPhrase) -> None:
        entity = self.references.find(replace(phrase, determiner="the", predicates=()))
        if entity is not None:
            entity.absent = True
            self._add("count", (entity,), (), value="0", how=replace(self.how, positive=True, past=False))
            self.references.recent.insert(0, Focus(entity, [], None, self.how.sentence))

    def _of_last(self, predicates: tuple[Predicate, ...], part: NounPhrase) -> bool:
        """Read *toes pointing forward* of the last subject; False if there is none."""
        last = next((f.subject for f in self.references.recent if f.subject is not None), None)
        if last is None:
            return False
        if last.size > 1 and last_word(part.head) in REMOVABLE:
            return True  # 'rosin and cloth are in the case, lid open'
        for predicate in predicates:
            if predicate.relation in ("left", "right") and not predicate.arguments:
                self._add("pointing", (last,), (), value=predicate.relation)
                continue
            if predicate.relation == "far":
                predicate = replace(predicate, relation="pointing", arguments=(), value=None, part="away")
            if (predicate.relation == "pointing" and any("same" in self._words(a) for a in predicate.arguments)) or (
                predicate.relation == "pointing" and predicate.part is not None and "same" in predicate.part
            ):
                self._add("parallel_each_other", (last,), ())
            else:
                self._predicate(last, predicate, [])
        return True

    def _superlative_apposition(self, phrase: NounPhrase, predicates: tuple[Predicate, ...]) -> None:
        last = next((f.subject for f in self.references.recent if f.subject is not None), None)
        if last is None:
            return
        where = next((p.part for p in predicates if p.relation in PLACES), None)
        for adjective in phrase.adjectives:
            name = SUPERLATIVES.get((adjective.dimension, POLES.get(adjective.word, 0)))
            if name is not None:
                self._add(name, (last,), (), value=where)

    # Predicates ---------------------------------------------------------------------------------------------------

    def _say(
        self,
        entity: Entity,
        predicates: tuple[Predicate, ...],
        phrase: NounPhrase | None,
        focus: bool = True,
        existential: bool = False,
    ) -> None:
        others: list[Entity] = []
        if focus:
            self.references.named = others
        if any(p.relation == "one_each" for p in predicates):
            self.how = replace(self.how, quantifier="each")
        outer = self.how
        places = {p.part for p in predicates if p.relation in ("part", "edge") and not p.arguments and p.part}
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
        relation = next(
            (p.relation for p in predicates
             if p.arguments and not (p.relation in ("in_front", "behind") and self._within(p.relation))), None
        )  # fmt: skip
        if focus:
            self.references.recent.insert(0, Focus(entity, others, relation, self.how.sentence))
        else:
            self.references.recent.append(Focus(entity, others, relation, self.how.sentence))

    def _hedge(self, adverbs: tuple[str, ...]) -> None:
        """Give the next fact the weight of a hedge of its own: *on the tray and probably next to the jug*."""
        weight = min([self.hedges.get(word, 1.0) for word in adverbs] or [1.0])
        uncertain = weight == 0.5 or not RARE.isdisjoint(adverbs)
        optional = self.how.optional or uncertain or "optionally" in adverbs
        self.how = replace(self.how, weight=weight, optional=optional, uncertain=self.how.uncertain or uncertain)

    def _predicate(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        relation = predicate.relation
        part_said = predicate.subject_part.head if predicate.subject_part is not None else ""
        self.part = last_word(subject.noun if subject.role is Role.PART else part_said)
        handler = getattr(self, f"_say_{relation}", None)
        if subject.itself.absent and predicate.arguments and self.how.positive and not self.how.past:
            self._found_elsewhere(subject.itself)
        if subject.role is Role.PART and subject.whole is not None:
            if not predicate.arguments and relation in ("left", "right"):  # its handle to the right
                self._add("pointing", (subject.whole,), (), value=relation)
                return
            lies = relation in DIRECTIONS or relation in ("on", "under", "inside")
            if relation in PLACES or (not predicate.arguments and lies):
                return  # said of the part alone: 'the rounded edge is at the top'
            if relation == "upside_down":
                return  # the label, and not the bottle
            subject = subject.whole
        if subject.role in (Role.VIEWER, Role.PERSON, Role.ABSTRACT) or subject.noun in GAPS:
            return
        if predicate.subject_part is not None and " " in predicate.subject_part.head:
            owner, _, part = predicate.subject_part.head.rpartition(" ")
            if part in PARTS:  # 'with the knife blade facing the plate'
                named = self.references.earlier(NounPhrase(predicate.subject_part.span, owner, "the"))
                subject = named or subject
        if predicate.subject_part is not None and relation not in ("pointing", "facing", "open", "closed", "parallel"):
            return  # said of a part: 'whose stick is in the pot'
        if handler is not None:
            handler(subject, predicate, others)
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
        elif not predicate.arguments and (relation in DIRECTIONS or relation in ("near", "far", "around")):
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

    def _relate(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        """State a relation between the subject and the arguments."""
        relation = predicate.relation
        if "exactly" in predicate.adverbs and relation in EXACT:
            relation = f"exactly_{relation}"
        if relation == "touching" and not {"almost", "nearly"}.isdisjoint(predicate.adverbs):
            relation = "near"
        found: list[Entity | Region] = []
        restricted, end = self.restricted.get(subject, (None, 0))
        options = [a for a in predicate.arguments if a.joined_by == "or"]
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
        if subject.size == 2 and any(a.pronoun == "other" and a.determiner == "each" for a in predicate.arguments):
            first, second = subject.leaves()
            self._pair(first, relation, second, False)
            self._pair(second, relation, first, False)
            return
        for phrase in predicate.arguments:
            if phrase.pronoun == "one" and not predicate.positive and others and not phrase.adjectives:
                phrase = replace(phrase, head=others[-1].noun, pronoun=None, determiner="another")  # 'not in the one …'
            last = others[-1].itself if others and phrase.pronoun == "it" and not phrase.head else None
            if phrase.pronoun == "it" and not others and self.on_surface == self.how.span and self.references.surface:
                found.append(self.references.surface)  # 'outside the tray, behind it'
                continue
            near = predicate.span[0] >= end and len(self.text[end : predicate.span[0]].split()) <= MAX_WORDS_AFTER
            if phrase.pronoun == "it" and restricted is not None and not others and near:
                last = restricted  # 'the comb, which was in front of the mirror, is behind it'

            if last is not None and last.role is Role.THING and not last.members and last is not subject.itself:
                found.append(last)  # above the saucer and to the left of it
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
            self._add("nearest" if relation == "near" else "farthest", (subject,), tuple(entities))
            return
        if regions and not entities:
            self._at_region(subject, relation, regions[0])
            return
        if relation == "between":
            self._between(subject, entities)
            return
        single = subject.size == 1 and not subject.plural and not entities
        if single and relation in ("near_each_other", "parallel_each_other", "nested"):
            return
        if relation in COLLECTIVE and not (relation == "stacked" and entities):
            if subject.itself.members:
                subject.itself.aliases.add({"stacked": "stack"}.get(relation, relation))
                self.references.renamed.append(subject.itself)  # later 'the row'
            value = predicate.part if relation == "row" else None
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
        for other in entities:
            self._pair(subject, relation, other, predicate.reversed)

    def _pair(self, subject: Entity, relation: str, other: Entity, swapped: bool) -> None:
        same_group = subject.itself.group is not None and subject.itself.group is other.itself.group
        if other is subject or (same_group and relation == "inside"):
            return
        if other.role is Role.ABSTRACT:
            return
        if other.role is Role.VIEWER or other.role is Role.PERSON:
            self._add(relation, (subject,), (), value=other.noun)
        elif other.role is Role.SURFACE or subject.role is Role.SURFACE:
            if subject.role is not Role.SURFACE and relation in ("on", "inside"):
                self._add("on", (subject,), ())
                if not self.how.positive and not swapped:
                    self._is_not_here(subject)
            elif subject.role is not Role.SURFACE and relation in ("in_front", "behind") and self._within(relation):
                self._add("part", (subject,), (), value="far" if relation == "behind" else "near")
            elif subject.role is not Role.SURFACE and not swapped:
                self._add(relation, (subject,), (), value=other.noun)
        elif (
            relation in ("in_front", "behind") and last_word(other.noun) in VESSELS | HOLDERS and self._within(relation)
        ):
            self._add("part", (subject,), (other,), value="back" if relation == "behind" else "front")
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

    def _within(self, relation: str) -> bool:
        """Return True if the clause says *at the back of the table*, and not *behind the table*."""
        words = " ".join(self.text[slice(*self.how.span)].casefold().split())
        place = "back" if relation == "behind" else "front"
        return any(f"{preposition} the {place} of" in words for preposition in ("at", "in", "on", "towards", "toward"))

    def _holds_substance(self, content: Entity, vessel: Entity, relation: str) -> bool:
        """Read *the tea is in the jar* as the contents of the jar; the words for the tea then mean the jar as well."""
        if relation != "inside" or content.noun not in SUBSTANCES or content.itself is vessel.itself:
            return False
        if last_word(vessel.noun) not in VESSELS or vessel.itself.members or not self.how.positive:
            return False
        self._add("contents", (vessel,), (), value=content.noun)
        if content.same_as is None and not content.members:
            if (
                len([d for d in self.drafts if content in (*d.subjects, *d.arguments)]) > 0
                or content.born < self.how.sentence
            ):
                self._identify(vessel, content)
            else:
                self._identify(content, vessel)
        return True

    def _identify(self, entity: Entity, other: Entity) -> None:
        """Record that two entities are one; the second keeps its name."""
        entity, other = entity.itself, other.itself
        if entity is not other:
            other.mentions += [m for m in entity.mentions if m not in other.mentions]
            other.adjectives |= entity.adjectives
            entity.same_as = other

    def _between(self, subject: Entity, entities: list[Entity]) -> None:
        if len(entities) == 1 and not entities[0].itself.members and entities[0].plural:
            entities[0].itself.split(2)
        ends = [e for e in entities if e.role in (Role.THING, Role.SURROUNDING)]
        if ends and (len(ends) > 1 or ends[0].size > 1):
            self._add("between", (subject,), tuple(ends))

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
        if relation == "parallel":
            self._add("parallel", (subject,), arguments, value=" ".join(filter(None, (region.value, region.term))))
        elif relation in ("against", "touching", "leaning") and region.of is not None and region.of.role is Role.THING:
            self._pair(subject, relation, region.of, False)
        elif relation in ("on", "inside", "near", "next_to", "at", "along", "touching", "against", "aligned"):
            self._add(region.term, (subject,), arguments, value=region.value)
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
            if found is not None and found.role is Role.THING:
                arguments.append(found)
        if not arguments and predicate.relation in ("end", "edge", "side", "corner") and predicate.part:
            before = [
                d for d in self.drafts if d.how.sentence == self.how.sentence and d.relation == predicate.relation
            ]
            if before and before[-1].value != predicate.part and subject not in before[-1].subjects:
                arguments = list(before[-1].arguments)  # 'at the left end of the rail … and at the right end'
        if predicate.relation == "edge":
            self.edge = predicate.part
        others += arguments
        part = predicate.part
        if part in ("either", "each", "both"):
            part = None
        if predicate.relation in ("end", "side") and subject.size == 2 and self._at_each(predicate):
            for leaf, side in zip(subject.leaves(), ("left", "right"), strict=True):
                self._add(predicate.relation, (leaf,), tuple(arguments), value=side)
            return
        self._add(predicate.relation, (subject,), tuple(arguments), value=part)

    def _on_top(self, subject: Entity) -> None:
        """Read *on top*: of the last object, or the farthest one of a line that the subject is a member of."""
        last = next((f.subject for f in self.references.recent if f.subject is not subject), None)
        if last is None or last.role is not Role.THING:
            return
        rest = [leaf for leaf in last.leaves() if leaf is not subject.itself]
        if len(rest) < last.size:
            for other in rest:
                self._pair(subject, "top", other, False)
        else:
            self._pair(subject, "on", last, False)

    def _at_each(self, predicate: Predicate) -> bool:
        words = self.text[slice(*predicate.span)].casefold().split()
        return predicate.part is None and not {"each", "either", "both"}.isdisjoint(words[:3])

    def _bare_direction(self, subject: Entity, predicate: Predicate) -> None:
        last = next((f.subject for f in self.references.recent if f.subject is not subject), None)
        if (
            predicate.part is None
            and last is not None
            and last.role is Role.THING
            and self.how.positive
            and (predicate.relation not in ("near", "far"))
            and not GROUNDS.search(self.text[slice(*predicate.span)])
        ):
            before = next(f for f in self.references.recent if f.subject is not subject)
            if before.others and OPPOSITES.get(before.relation or "") == predicate.relation:
                last = before.others[0]  # 'the spoon to the right of the plate, the fork to the left'
            self.how = self._guessed(Guess.OF_THE_LAST)
            self._pair(subject, predicate.relation, last, False)
            if predicate.measure is not None and last.role is Role.THING:
                self._add("distance", (subject,), (last,), metres=predicate.measure.metres)
            return
        value = {"in_front": "near", "behind": "far"}.get(predicate.relation, predicate.part or predicate.relation)
        if predicate.relation in ("in_front", "behind") and not self.how.positive:
            return
        value = value.replace("_", " ")
        if value in ("near", "far", "side") or predicate.relation in DIRECTIONS:
            self._add("part", (subject,), (), value=predicate.relation if value == "side" else value)

    def _property(self, subject: Entity, predicate: Predicate) -> None:
        value = predicate.value.word if predicate.value is not None else None
        relation = predicate.relation
        if predicate.degree is Degree.SUPERLATIVE and predicate.value is not None:
            if subject.itself.members:
                return  # 'the smallest' of them is one of them
            name = SUPERLATIVES.get((predicate.value.dimension, POLES.get(predicate.value.word, 0)))
            if name is not None:
                self._add(name, (subject,), ())
            return
        if relation in ("colour", "material", "shape", "size") and value is not None and self.how.positive:
            for leaf in subject.leaves():
                leaf.adjectives.add((relation, value))
        if value in ("nested", "nest", "stacked", "stack") and (subject.itself.members or subject.plural):
            relation, value = ("nested" if value.startswith("nest") else "stacked"), None
        elif relation in ("upside_down", "empty", "open", "closed"):
            value = None
        elif value is None or relation == "other" or value in NOT_STATES:
            return
        self._add(relation, (subject,), (), value=value)

    # Relations of their own ---------------------------------------------------------------------------------------

    def _say_one_each(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        pass

    def _say_there(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        if self.how.positive or self.how.past:
            return
        for leaf in subject.leaves():
            leaf.absent = True
            self._add("count", (leaf,), (), value="0", how=replace(self.how, positive=True))

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

    def _say_follows(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        """Read *followed by the probe*: it is farther on in the direction in which the first was placed."""
        last = next((d for d in reversed(self.drafts) if subject in d.subjects and d.relation != "count"), None)
        sides = {"left", "right"} & {last.relation, *(last.value or "").split()} if last is not None else set()
        ordered = self.order is not None or (last is not None and last.relation == "part")
        relation = "right" if ordered and "left" in sides else "left" if ordered and "right" in sides else None
        relation = relation or (last.relation if last is not None and last.relation in ("left", "right") else "next_to")
        if last is not None and last.relation in ("on", "inside", "above", "under"):
            return  # 'on the gravel comes moss, followed by charcoal' tells an order in time
        for phrase in predicate.arguments:
            for member in phrase.members or (phrase,):
                following = self._introduce(member, "right", subject)
                if following is not None:
                    self._pair(following, relation, subject, False)
                    others.append(following)

    def _say_kind(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        """Read *it is the tallest*, *the third is the shortest of them*, *it is a red cup*."""
        for phrase in predicate.arguments:
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
                elif adjective.dimension in ("colour", "size", "material", "shape") and phrase.head:
                    self._add(adjective.dimension, (subject,), (), value=adjective.word)
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
            if phrase.predicates:
                self._say(subject, phrase.predicates, phrase, focus=False)

    def _say_ordinal(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        if predicate.value is not None and predicate.value.rank is not None:
            group = subject.itself.group
            rest = () if group is None else tuple(leaf for leaf in group.leaves() if leaf is not subject.itself)
            value = f"{predicate.value.rank} from {predicate.part or 'left'}"
            self._add("ordinal", (subject,), rest, value=value)

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
                and phrase.owner is None and not phrase.predicates and phrase.count is None
            ):  # fmt: skip
                self._add("contents", (subject,), (), value=phrase.head)
            elif last_word(phrase.head) in PARTS or phrase.head == "glass":
                states = [a.word for a in phrase.adjectives if a.dimension == "state"]
                if states:
                    self._add("state", (subject,), (), value=f"{states[0]} {phrase.head}")
            elif phrase.head:
                phrase = self._placed_on(phrase, subject)
                held = self._introduce(phrase, "with", subject)
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

    def _hold(self, subject: Entity, held: Entity, words: list[str]) -> None:
        """State what a support or a vessel holds as on or inside it; what another thing is with is near it."""
        noun = last_word(subject.noun)
        if subject.role is Role.SURFACE or (noun in SUPPORTS | SURFACES and CONTAINING.isdisjoint(words)):
            self._pair(held, "on", subject, False)
        elif not CONTAINING.isdisjoint(words) or (noun in VESSELS | HOLDERS and not HOLDING.isdisjoint(words)):
            self._pair(held, "inside", subject, False)
        elif not {"with", "without"}.isdisjoint(words):  # what a thing has may be a part of it
            self._add("near", (held,), (subject,), how=self._guessed(Guess.ACCOMPANIED))

    def _say_leftmost(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        self._add("leftmost", (subject,), ())

    def _say_share(self, subject: Entity, predicate: Predicate, others: list[Entity]) -> None:
        for phrase in predicate.arguments:
            thing = self._introduce(phrase, None, subject)
            if thing is not None:
                relation = "inside" if last_word(thing.noun) in VESSELS - SUPPORTS else "on"
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

    # Arguments and drafts -----------------------------------------------------------------------------------------

    def _argument(self, phrase: NounPhrase, relation: str, subject: Entity | None) -> Entity | Region | None:
        region = self.references.region(phrase)
        if region is not None:
            return region
        if (phrase.pronoun in ("each", "other") and phrase.determiner in ("each",)) or phrase.pronoun == "another":
            return None
        owned = phrase.owner is not None and phrase.head and last_word(phrase.head) not in PARTS and not phrase.plural
        if owned and subject is not None and subject.itself.members and self.how.quantifier == "each":
            return self._introduce(replace(phrase, owner=None, determiner=None, count=subject.size, plural=True))
        if (
            subject is not None and self.how.quantifier == "each" and subject.size > 1
            and phrase.determiner in ("a", "an") and phrase.head and not phrase.plural
        ):  # fmt: skip
            return self._introduce(replace(phrase, determiner=None, count=subject.size, plural=True))
        if phrase.determiner in ("each", "every"):
            self.how = replace(self.how, quantifier="each")
        found = self._introduce(phrase, relation, subject)
        if (
            found is not None and subject is not None and phrase.count is not None and phrase.count > 1
            and found.size == subject.size and phrase.determiner is None
        ):  # fmt: skip
            self.how = replace(self.how, quantifier="each")
        return found

    def _words(self, phrase: NounPhrase) -> str:
        return " ".join(self.text[phrase.span[0] : phrase.span[1]].split())

    def _guessed(self, guess: Guess) -> Qualification:
        """Return the present qualification with one more guess."""
        return replace(self.how, guesses=self.how.guesses | {guess})

    def _compare(self, relation: str, subject: Entity, other: Entity, phrase: NounPhrase) -> None:
        how = Qualification(phrase.span, self.references.sentence)
        self._add(relation, (subject,), (other,), how=how)

    def _add(
        self,
        relation: str,
        subjects: tuple[Entity, ...],
        arguments: tuple[Entity, ...],
        value: str | None = None,
        metres: float | None = None,
        how: Qualification | None = None,
    ) -> None:
        if any(s.role is Role.SURFACE for s in subjects) or relation in NO_FACTS:
            return
        if relation == "at":
            relation = "near"
        how = how or self.how
        if relation in ("pointing", "facing"):
            turned = TURNED_AWAY.search(self.text[slice(*how.span)]) is not None
            if turned and value == "viewer":
                value = "away"
            elif turned and arguments:
                how = replace(how, positive=not how.positive)
            if value is not None and self.part == "handle" and all(last_word(s.noun) in HEADED for s in subjects):
                how = replace(how, by_handle=True)
        start, end = self.how.span
        if any(start <= use.span[0] and use.span[1] <= end for use in self.references.doubtful[-3:]):
            how = replace(how, guesses=how.guesses | {Guess.PRONOUN})
        if is_doubtful(how.guesses):
            how = replace(how, uncertain=True, optional=True, weight=min(how.weight, 0.5))
        draft = Draft(relation, subjects, arguments, how, value, metres)
        if draft not in self.drafted:
            self.drafted.add(draft)
            self.drafts.append(draft)


TURNED_AWAY = re.compile(r"\b(?:point|fac|turn|aim|look|direct)\w*\s+(?:\w+\s+)?away\s+from\b", re.IGNORECASE)
"""Directions that are denied: *pointing away from the plate*."""


def _is_moved(clause: Clause, subject: NounPhrase) -> bool:
    """Return True for a part that a command puts somewhere, such as a leg of a chair that is assembled."""
    commanded = clause.mood is Mood.COMMAND and clause.span[0] < subject.span[0]
    return commanded and not any(p.relation in ("pointing", "facing") for p in clause.predicates)


def _with_restrictions_of_contents(phrase: NounPhrase) -> NounPhrase:
    """Attach to the vessel what follows its contents: *a box of screws on the left*."""
    of = phrase.of
    if of is None or not of.predicates or last_word(phrase.head) in PARTS | REGIONS:
        return phrase
    bare = replace(of, predicates=(), span=(of.span[0], max(of.span[0], of.predicates[0].span[0])))
    return replace(phrase, of=bare, predicates=(*phrase.predicates, *of.predicates))


def _whole(entity: Entity) -> Entity:
    """Return the thing that a part belongs to: *across the rim of the bowl* is across the bowl."""
    return entity.whole if entity.role is Role.PART and entity.whole is not None else entity


_BESIDE = DIRECTIONS | {"near", "next_to", "between", "under", "opposite"}
"""Relations that, after a wall or a floor, are those of the thing that is on it: *on the wall near the exit*."""


_LIMBS = frozenset({"elbow", "hand", "arm", "foot", "knee", "shoulder", "side"})


def _said_of_subject(entity: Entity, phrase: NounPhrase) -> bool:
    """Return True if what follows a surface is said of the subject: *on the floor to the left*."""
    around = entity.role is Role.SURFACE or (entity.role is Role.SURROUNDING and last_word(entity.noun) != "shelf")
    bare = all((not p.arguments and p.relation in DIRECTIONS) or p.reversed for p in phrase.predicates)
    noun = last_word(entity.noun)
    wide = noun in ("wall", "floor", "ceiling", "ground")
    beside = all(p.relation in _BESIDE and p.degree is Degree.PLAIN for p in phrase.predicates)
    flat = noun in ("wall", "ceiling") and all(
        p.relation in DIRECTIONS | {"next_to", "near"} for p in phrase.predicates
    )
    amid = noun in SURFACES and all(p.relation == "between" for p in phrase.predicates)
    own = phrase.owner is not None and phrase.owner.pronoun in VIEWER_WORDS and noun in _LIMBS
    return (around and (bare or (wide and beside))) or flat or amid or own
