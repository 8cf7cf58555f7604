"""Drafts of facts about things that have no names yet, and the state of a text that is being read."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

from deixis.grammar.english.confidence import Guess, Standing, standing
from deixis.grammar.english.discourse.entities import Entity, Role
from deixis.grammar.english.discourse.references import References
from deixis.grammar.english.discourse.surfaces import surface_noun
from deixis.grammar.english.tree import Mood, NounPhrase, Predicate, Sentence, Span
from deixis.grammar.english.vocabulary.known_nouns import KnownNouns
from deixis.grammar.english.vocabulary.nouns import HEADED, PEOPLE, SURROUNDINGS, last_word
from deixis.grammar.english.vocabulary.things import can_have_a_place
from deixis.ontology.graph.claims import COLLECTIVE

MIN_PAST_OF_STORY = 3
"""Minimum number of clauses in the past tense at which a text is a story: its past tense describes the present
table."""

SUPPOSED = {
    "apparently": 0.7,
    "seemingly": 0.7,
    "presumably": 0.7,
    "ideally": 0.7,
    "preferably": 0.7,
}
"""Weights of adverbs that the layout language does not have."""

RARE = frozenset({"hardly", "rarely", "seldom", "scarcely"})

NO_FACTS = frozenset({"other", "with", "outside", "from", "as", "through", "to", "like"})
"""Relations of the parser that say nothing about where a thing is."""


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


TURNED_AWAY = re.compile(r"\b(?:point|fac|turn|aim|look|direct|open)\w*\s+(?:\w+\s+)?away\s+from\b", re.IGNORECASE)
"""Directions that are denied: *pointing away from the plate*."""


_MATTER = re.compile(
    r"\bthing\s+(?:to|about|with|is\s+(?:that|to)|(?:you|we|i|one)\s+(?:can|could|must|should))\b", re.I
)
"""A thing that is done or said, and not one with a place: *the thing to do is …*."""

_STOREY = re.compile(r"\b(?:top|bottom|upper|lower|middle|first|second|third|highest|lowest|next)\b", re.IGNORECASE)
"""Words by which a level is a storey of a thing, and not a height: *the top level of the altar*."""

SEEN_FROM_A_SIDE = frozenset(
    {"left", "right", "top", "bottom", "top_left", "top_right", "bottom_left", "bottom_right", "in_front", "behind"}
)
"""Relations that depend on where the viewer is."""

MIN_WORDS_OF_LISTS = 3
"""Minimum number of words at which a name with a plural inside may be a list without commas."""


class Drafting:
    """State of a text while its clauses are read in order, with the drafts of facts so far."""

    def __init__(self, text: str, sentences: tuple[Sentence, ...], hedges: dict[str, float], nouns: KnownNouns) -> None:
        self.text = text
        self.nouns = nouns
        self.sentences = sentences
        self.hedges = SUPPOSED | hedges
        self.drafts: list[Draft] = []
        self.drafted: set[Draft] = set()
        self.stated_qualities: set[tuple[int, str, str]] = set()
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
        self.unreal: re.Match[str] | None = None  # words by which the sentence asserts nothing
        self.reports = False  # True for a sentence that tells what a person says
        self.elsewhere: str | None = None  # words of the sentence by which another place than the viewer's is meant
        self.seen_from: str | None = None  # noun of the viewpoint that a sentence of its own states for the text
        self.titled: tuple[Predicate, ...] = ()  # place that the last heading names
        self.obliged: tuple[Entity, int, int, int] | None = None  # subject, drafts and end of 'it should be …'
        tenses = [c.past for s in sentences for c in s.clauses if c.predicates and c.mood is not Mood.QUESTION]
        past = sum(tenses)
        self.story = past >= MIN_PAST_OF_STORY and past >= len(tenses) / 2

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
        if relation == "more" and value is None:
            return  # 'fewer than three'
        if relation == "at":
            relation = "near"
        how = how or self.how
        nameless = [leaf for s in subjects for leaf in s.leaves() if self._is_no_thing(leaf)]
        named = [leaf for s in subjects for leaf in s.leaves() if leaf not in nameless] if nameless else []
        if nameless and named and relation not in COLLECTIVE:  # 'the knife and the order are on the tray'
            for part in (named, nameless):
                self._add(relation, tuple(part), arguments, value, metres, how)
            return
        if relation in ("pointing", "facing"):
            turned = TURNED_AWAY.search(self.text[slice(*how.span)]) is not None or self.part in ("back", "rear")
            if turned and value == "viewer":
                value = "away"
            elif self.part in ("back", "rear") and value in ("left", "right"):
                value = "right" if value == "left" else "left"
            elif turned and (arguments or value in PEOPLE | SURROUNDINGS):
                how = replace(how, positive=not how.positive)
            if self.part == "handle" and all(last_word(s.noun) in HEADED for s in subjects):
                how = replace(how, by_handle=True)
        sides = relation in SEEN_FROM_A_SIDE or (value is not None and not SEEN_FROM_A_SIDE.isdisjoint(value.split()))
        if self.elsewhere is not None and sides and how.condition is None:
            how = replace(how, condition=self.elsewhere)
        start, end = self.how.span
        if any(start <= use.span[0] and use.span[1] <= end for use in self.references.doubtful[-3:]):
            how = replace(how, guesses=how.guesses | {Guess.PRONOUN})
        close = {guess for span, guess in self.references.guesses[-3:] if start <= span[0] and span[1] <= end}
        if close:
            how = replace(how, guesses=how.guesses | close)
        if any(self._may_be_a_list(entity) for entity in (*subjects, *arguments)):
            how = replace(how, guesses=how.guesses | {Guess.STRANGE})
        if nameless or any(self._is_no_thing(leaf) for entity in arguments for leaf in entity.leaves()):
            how = replace(how, guesses=how.guesses | {Guess.NO_THING})
        if standing(how.guesses) is not Standing.ASSERTED:
            how = replace(how, uncertain=True, optional=True, weight=min(how.weight, 0.5))
        draft = Draft(relation, subjects, arguments, how, value, metres)
        if draft not in self.drafted:
            self.drafted.add(draft)
            self.drafts.append(draft)

    def _may_be_a_list(self, entity: Entity) -> bool:
        """Return True for a name of three words or more with a plural before the last: *forks plate butter knife*."""
        words = entity.noun.split()
        if entity.role is not Role.THING or len(words) < MIN_WORDS_OF_LISTS or self.nouns.knows(entity.noun):
            return False
        return any(self.nouns.singular(word)[1] for word in words[:-1])

    def _is_no_thing(self, entity: Entity) -> bool:
        """Return True for an object whose name says that it is a quality, an act, a time, or a piece of a clause."""
        storey = entity.noun == "level" and any(d in ("position", "rank") for d, _ in entity.adjectives)
        storey = storey or (entity.noun == "level" and any(_STOREY.search(mention) for mention in entity.mentions))
        matter = entity.noun == "thing" and _MATTER.search(self.text, self.references.start, self.end) is not None
        unnamed = matter or not can_have_a_place(entity.noun, self.nouns)
        return entity.role is Role.THING and not storey and unnamed

    def _compare(self, relation: str, subject: Entity, other: Entity, phrase: NounPhrase) -> None:
        how = Qualification(phrase.span, self.references.sentence)
        self._add(relation, (subject,), (other,), how=how)

    def _words(self, phrase: NounPhrase) -> str:
        return " ".join(self.text[phrase.span[0] : phrase.span[1]].split())

    def _guessed(self, guess: Guess) -> Qualification:
        """Return the present qualification with one more guess."""
        return replace(self.how, guesses=self.how.guesses | {guess})

    def _hedge(self, adverbs: tuple[str, ...]) -> None:
        """Give the next fact the weight of a hedge of its own: *on the tray and probably next to the jug*."""
        weight = min([self.hedges.get(word, 1.0) for word in adverbs] or [1.0])
        uncertain = weight == 0.5 or not RARE.isdisjoint(adverbs)
        optional = self.how.optional or uncertain or "optionally" in adverbs
        self.how = replace(self.how, weight=weight, optional=optional, uncertain=self.how.uncertain or uncertain)

    def _at_each(self, predicate: Predicate) -> bool:
        words = self.text[slice(*predicate.span)].casefold().split()
        return predicate.part is None and not {"each", "either", "both"}.isdisjoint(words[:3])

    def _identify(self, entity: Entity, other: Entity) -> None:
        """Record that two entities are one; the second keeps its name."""
        entity, other = entity.itself, other.itself
        if entity is not other:
            other.mentions += [m for m in entity.mentions if m not in other.mentions]
            other.adjectives |= entity.adjectives
            entity.same_as = other
