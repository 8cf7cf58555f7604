"""Find the objects that noun phrases stand for: new ones, earlier ones, members of groups, and pronouns."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

from deixis.grammar.english.confidence import Guess
from deixis.grammar.english.discourse.entities import Entity, Role, is_one_thing
from deixis.grammar.english.tree import Adjective, Degree, NounPhrase, Span
from deixis.grammar.english.vocabulary.nouns import (
    ABSTRACT,
    FIGURES,
    GENERAL,
    GROUPS,
    HOLDERS,
    PAIRED,
    PARTS,
    PEOPLE,
    PLACES_OF,
    REMOVABLE,
    SINGLE_PLURALS,
    SUBSTANCES,
    SURROUNDINGS,
    VESSELS,
    VIEWER,
    VIEWER_WORDS,
    last_word,
)
from deixis.grammar.english.vocabulary.relation_words import prepositions
from deixis.ontology.inflection import plural, singulars

MAX_COUNTED = 1000
"""Largest number in a noun phrase (*twelve cups*) for which the group is expanded into single things."""
NAMED = re.compile(
    r"\b(?:the|a|an|your|my|[A-Z]\w+['\u2019]s)\s+((?:(?!(?:the|a|an|your|my|is|are|was|were)\b)[a-z]+\s+)*?(?!(?:is|are|was|were)\b)[a-z]+)(?=\s+(?:and|then|so|,)|[,;:])",
    re.IGNORECASE,
)
"""Noun phrase at the end of a clause."""
MOVED = re.compile(
    r"\b(?:the|a|an|your|my)\s+([a-z]+(?:\s+(?!on|in|under|behind|is\b|are\b|was\b|were\b)[a-z]+)?)\s+(?:on|onto|in|into|under|behind|near|by|next\s+to)\s+$",
    re.IGNORECASE,
)
"""Object of a verb before the place that it is moved to."""
MAX_SENTENCES_TO_GROUP = 4
"""Number of sentences over which *the smallest* goes back to a group."""
MIN_LOST = 12
"""Minimum number of characters at which a phrase that was not understood can name a thing."""
REGIONS = frozenset(
    [
        "corner",
        "edge",
        "end",
        "side",
        "middle",
        "centre",
        "midpoint",
        "quadrant",
        "center",
        "front",
        "back",
        "rear",
        "half",
        "part",
        "rim",
        "border",
    ]
)
DEFINITE = frozenset({"the", "this", "that", "these", "those", "same", "its", "their", "my", "your"})
OPPOSITES = {
    "left": "right", "right": "left", "in_front": "behind", "behind": "in_front", "above": "below", "below": "above",
    "on": "under", "under": "on", "top": "bottom", "bottom": "top",
}  # fmt: skip
_ACTS = frozenset({"placement", "decision", "agreement", "discussion"})
"""Nouns of acts, which have no place whatever stands before them: *the accurate placement of the cups*."""
_LASTING = frozenset({"colour", "material", "contents", "ordinal", "rank"})
"""Dimensions that hold from one mention of a thing to the next, and tell it from others of its noun."""
_OWN = frozenset({"size", "height", "length", "width", "thickness", "colour", "material", "shape"})
"""Dimensions of adjectives that are true of one thing of a kind."""
_MIDDLES = frozenset({"middle", "central", "center", "centre"})
_TELLING = frozenset({"with", "on", "inside", "under", "next_to", "left", "right", "behind", "in_front"})
"""Relations in a relative clause that tell one of several things: *the table that holds the lamp*."""
_CARRYING = frozenset({"on", "across", "inside"})
"""Relations to a thing that the subject of the clause before carries or holds."""
_COMPASS = frozenset({"north", "south", "east", "west"})
_FURTHER = re.compile(r"\b(?:more|additional|extra)\s+\w+$", re.IGNORECASE)
"""Words before other things of a kind than those before."""
_SIDES = frozenset(
    ["side", "front", "back", "rear", "top", "bottom", "left", "right", "end", "middle", "upper", "lower"]
)
"""Words that tell a thing from another one of its kind by its place: *the side rails*."""
CORNERS = frozenset({"top_left", "top_right", "bottom_left", "bottom_right"})
"""Relations that name a corner of a thing or of the surface, where no other thing is named."""
POLES = {
    **dict.fromkeys(("large", "big", "tall", "long", "wide", "thick", "high", "deep", "heavy", "broad"), 1),
    **dict.fromkeys(("small", "little", "short", "narrow", "thin", "low", "shallow", "light", "tiny"), -1),
}
COMPARATIVES = {
    ("size", 1): "bigger", ("size", -1): "smaller", ("height", 1): "taller", ("height", -1): "shorter",
    ("length", 1): "longer", ("length", -1): "shorter", ("width", 1): "wider", ("width", -1): "narrower",
    ("thickness", 1): "thicker", ("thickness", -1): "thinner",
}  # fmt: skip
"""Relation of a comparative by its dimension and pole."""


@dataclass(frozen=True, slots=True)
class Region:
    """A part of the surface or of an object, such as the *right end of the counter*: ``term`` is ``end``."""

    term: str
    value: str | None
    of: Entity | None


@dataclass
class Focus:
    """Subject, other objects and relation of a clause, which pronouns in later clauses refer to."""

    subject: Entity | None
    others: list[Entity]
    relation: str | None
    sentence: int


@dataclass(frozen=True, slots=True)
class PronounUse:
    """A pronoun, the object that it was taken for, and the others of the clause before that it could stand for."""

    span: Span
    word: str
    chosen: Entity
    others: tuple[Entity, ...]


def _is_figure(thing: Entity) -> bool:
    """Return True for a doll, an animal or a thing with a name of its own: *Anna*."""
    return last_word(thing.noun) in FIGURES or all(mention[:1].isupper() for mention in thing.mentions)


@dataclass
class References:
    """Objects of a text so far, and the rules by which a phrase refers to one of them.

    ``compare`` is called with a relation and two objects when a phrase such as *the larger beaker* tells two members of
    a group apart.
    """

    surface_noun: str | None
    compare: Callable[[str, Entity, Entity, NounPhrase], None]
    entities: list[Entity] = field(default_factory=list)
    recent: list[Focus] = field(default_factory=list)
    sentence: int = 0
    start: int = 0  # of the sentence in the text
    text: str = ""
    host: Entity | None = None  # subject of *with*, whose phrase is read: 'a bread plate with a knife across the plate'
    holder: str | None = None  # relation of the phrase whose restrictions are read: 'in' for 'in the crate beside it'
    lost: list[Span] = field(default_factory=list)  # of the sentence, phrases that were not understood
    surface: Entity | None = None
    surface_named: int = -1  # last sentence that names the surface
    named: list[Entity] = field(default_factory=list)  # objects that the present clause named after its subject
    doubtful: list[PronounUse] = field(default_factory=list)
    guesses: list[tuple[Span, Guess]] = field(default_factory=list)  # phrases whose antecedent is a close call
    renamed: list[Entity] = field(default_factory=list)  # entities with aliases
    pair: tuple[Entity, ...] = ()  # the two things that *the former* and *the latter* stood for last
    _by_last_word: dict[str, list[Entity]] = field(default_factory=dict)
    _indexed: int = 0  # entities that the index holds

    def __post_init__(self) -> None:
        self.viewer = Entity(VIEWER, Role.VIEWER)

    # Noun phrases -----------------------------------------------------------------------------------------------

    def region(self, phrase: NounPhrase) -> Region | None:
        """Return the region that a phrase names, or None if it names an object.

        Parameters
        ----------
        phrase
            Noun phrase such as *the far left corner of the tray*.

        Returns
        -------
        Region or None
            Part of an object, or of the whole surface if the phrase names no object.
        """
        term = phrase.head if phrase.head in REGIONS else last_word(phrase.head)
        if term not in REGIONS or phrase.owner is not None or phrase.members:
            return None
        if phrase.head != term and (phrase.count or 0) > 1 and phrase.of is None:
            return None  # 'two cigarette ends'
        words = [a.word for a in phrase.adjectives if a.dimension in ("position", "size", "length", "other")]
        words += [word for word in phrase.head.split()[:-1] if word in _COMPASS]  # 'the north edge'
        of = self.find(phrase.of) if phrase.of is not None else None
        term = {"centre": "middle", "center": "middle", "midpoint": "middle", "rear": "back"}.get(term, term)
        if term in ("front", "back", "half", "part", "quadrant"):
            words, term = ([*words, term] if term in ("front", "back") else words), "part"
        return Region(term, " ".join(words) or None, None if of is None or of.role is Role.SURFACE else of)

    def find(self, phrase: NounPhrase, relation: str | None = None, besides: Entity | None = None) -> Entity | None:
        """Return the object or group that a phrase stands for, a new one if necessary; None for nothing.

        Parameters
        ----------
        phrase
            The noun phrase.
        relation
            Relation of which the phrase is an argument; it decides between antecedents of a pronoun.
        besides
            Subject of the clause, which a pronoun in its predicate does not stand for.

        Returns
        -------
        Entity or None
            Object, or a group for a coordination or a plural; None also for a phrase that refers to nothing.
        """
        if phrase.members:
            found = [entity for part in phrase.members if (entity := self.find(part, relation, besides)) is not None]
            return found[0] if len(found) == 1 else Entity("", members=found) if found else None
        if phrase.pronoun is not None and not phrase.head:
            return self._pronoun(phrase, relation, besides)
        if phrase.head:
            return self._noun(phrase, relation, besides)
        return self._ellipsis(phrase, besides, relation)

    def _noun(self, phrase: NounPhrase, relation: str | None, besides: Entity | None) -> Entity | None:
        noun, last = phrase.head, last_word(phrase.head)
        if last in ABSTRACT and (noun == last or last in _ACTS):
            return self._earlier(phrase) or self._new(phrase, Role.ABSTRACT)
        if last == VIEWER or (last in PEOPLE and noun == last):
            entity = self._earlier(phrase) or self._new(phrase, Role.VIEWER if last == VIEWER else Role.PERSON)
            return entity
        other = self.surface is not None and " " in noun and " " in self.surface.noun and noun != self.surface.noun
        if self.surface_noun is not None and last == self.surface_noun and phrase.determiner != "another" and not other:
            if self.surface is None:
                self.surface = Entity(noun, Role.SURFACE, born=self.sentence)
            self.surface_named = self.sentence
            return self.surface
        worn = phrase.owner is not None and phrase.owner.pronoun in VIEWER_WORDS | {"he", "she"} and last in REMOVABLE
        stands_on_own = relation == "on" and self._is_own(phrase, besides)
        if stands_on_own and last in PARTS - REMOVABLE:
            return None  # 'the lamp is left of the mat, on its foot'
        is_part = last in PARTS and noun == last and not worn and not stands_on_own
        if is_part and (phrase.owner is not None or phrase.of is not None):
            whole = None
            if phrase.owner is not None and phrase.owner.pronoun == "it" and besides is not None:
                whole = next((e for e in self.named[-1:] if e is not besides and not e.itself.members), None)
            whole = whole or self.find(phrase.owner or phrase.of, relation, besides)  # type: ignore[arg-type]
            return None if whole is None else Entity(noun, Role.PART, whole=whole)
        if last in PARTS - REMOVABLE and noun != last and phrase.determiner != "a":
            whole = self._earlier(replace(phrase, head=noun.rpartition(" ")[0], adjectives=(), determiner="the"))
            if whole is not None:
                return Entity(last, Role.PART, whole=whole)  # 'the knife blade'
        whose = phrase.owner or phrase.of
        placed = whose is not None and noun in PLACES_OF and relation is None and last_word(whose.head) not in PEOPLE
        if placed and whose is not None and whose.pronoun not in VIEWER_WORDS | {"we", "he", "she"}:
            return self.find(whose, relation, besides)  # 'the home of the bucket is under the tap'
        if phrase.of is not None and last in GENERAL:
            counted = phrase.count is not None and phrase.of.count is None and phrase.of.determiner is None
            inner = replace(phrase.of, count=phrase.count, plural=True) if counted else phrase.of
            return self.find(inner, relation, besides)
        earlier = self._carrier(phrase, relation, besides) or self._earlier(phrase)
        own = earlier is not None and besides is not None and earlier in [leaf.itself for leaf in besides.leaves()]
        if own and earlier is not None and earlier.noun != noun and not earlier.was_called(noun):
            others = [e for e in self._named_like(noun) if e is not earlier and _can_name(noun, e) and not e.members]
            earlier = next((e for e in others if not _conflicting(e, phrase)), None)  # 'the sleeping bag is in the bag'
        if earlier is not None and besides is not None and earlier is besides.itself and besides.born == self.sentence:
            others = [e for e in self._named_like(noun) if e is not earlier and _can_name(noun, e) and not e.members]
            other = bool(phrase.adjectives) and besides.noun != noun  # 'the oat milk behind the whole milk'
            itself = None if other or phrase.predicates else earlier  # 'two rods across the rods that have hooks'
            earlier = next((e for e in others if not _conflicting(e, phrase)), itself)
        of_it = phrase.owner is not None and phrase.owner.pronoun in ("it", "they")
        if of_it and earlier is not None and earlier.noun != noun and not earlier.was_called(noun):
            earlier = None  # 'the cake is in its box' beside a cool box
        if earlier is not None:
            return self._seen(earlier, phrase)
        several = phrase.plural and phrase.count is None and phrase.determiner in DEFINITE
        several = several and not any(a.dimension == "colour" for a in phrase.adjectives)
        described = any(a.dimension != "other" for a in phrase.adjectives)
        if several and last in GENERAL - {"piece"} and noun == last and not described:
            return None  # 'the following items', but 'the heavy items'
        if phrase.owner is not None:
            self.find(phrase.owner, relation, besides)
        return self._new(phrase, Role.SURROUNDING if noun in SURROUNDINGS else Role.THING)

    def _is_own(self, phrase: NounPhrase, besides: Entity | None) -> bool:
        """Return True for *its* of the subject, of which the words before tell a place: *left of it, on its cap*."""
        last = self.recent[0] if self.recent else None
        owned = phrase.owner is not None and phrase.owner.pronoun == "it" and not phrase.owner.head
        if not owned or besides is None:
            return False
        other = last is not None and last.sentence == self.sentence and last.subject is not None
        if other and last is not None and last.subject is not None and last.subject.itself is not besides.itself:
            return False  # 'the pot is in the middle, and the spoon lies left of it, on its lid'
        return bool(self.named) and besides.itself not in self.named

    def _new(self, phrase: NounPhrase, role: Role) -> Entity:
        entity = Entity(phrase.head, role, born=self.sentence, indefinite=phrase.determiner in ("a", "an", None))
        entity.adjectives = {
            (a.dimension, a.word)
            for a in phrase.adjectives
            if a.degree is Degree.PLAIN or a.dimension in ("position", "size", "height", "length")
        } | _marks(phrase)
        own_end = min((p.span[0] for p in phrase.predicates if p.span[0] > phrase.span[0]), default=phrase.span[1])
        written = self.text[phrase.span[0] : own_end].casefold()
        words = re.sub(r"[,:;\"\u201c\u201d\u2018]|['\u2019](?!\w)", " ", written).split()
        count = phrase.count
        stem = last_word(phrase.head)
        amount = written.partition(" of ")[0].split()[-1:] if " of " in written and phrase.of is None else []
        if amount and not phrase.plural:  # 'a drop of water', and later 'the drop'
            entity.aliases.add(amount[0])
            self.renamed.append(entity)
        lump = next((word for word in words if word in SINGLE_PLURALS and is_one_thing(written)), None)
        paired = stem in PAIRED and (phrase.determiner is not None or phrase.owner is not None)
        if count is None and phrase.plural and lump is None and (paired or phrase.determiner == "both"):
            count = 2
        if phrase.of is not None and phrase.of.plural and stem in GROUPS:
            entity.aliases.add(phrase.of.head)
            self.renamed.append(entity)  # 'a stack of three towels', and later 'the towels'
        if lump is not None and count == 2 and "pair" in words:
            count = None
        if count is not None and 1 < count <= MAX_COUNTED:
            entity.split(count)
        elif phrase.plural:
            entity.plural, entity.single = True, lump is not None
            in_text = next((w for w in words if stem in singulars(w)), None)
            in_text = in_text or next((w for w in reversed(words) if w.startswith(stem[: max(2, len(stem) - 2)])), None)
            if in_text is not None:
                entity.written = f"{phrase.head[: -len(stem)]}{in_text}".strip()
            elif phrase.determiner == "the" and any(a.dimension == "position" for a in phrase.adjectives):
                entity.written = plural(phrase.head)  # 'the front' of 'the front and back rails'
        self.entities.append(entity)
        return self._seen(entity, phrase)

    def _seen(self, entity: Entity, phrase: NounPhrase) -> Entity:
        words = self.words(phrase)
        entity.mention(words)
        entity.compared = False
        if not entity.members and entity.group is None:
            known = {dimension for dimension, _ in entity.adjectives}
            plain = {(a.dimension, a.word) for a in phrase.adjectives if a.degree is Degree.PLAIN}
            entity.adjectives |= {mark for mark in plain | _marks(phrase) if mark[0] in _LASTING - known}
        if entity.members and entity.noun:
            for leaf in entity.leaves():
                leaf.mention(words)
        return entity

    def words(self, phrase: NounPhrase) -> str:
        """Return the words of a phrase without its restrictions and commas.

        Parameters
        ----------
        phrase
            Noun phrase of the text.

        Returns
        -------
        str
            Words as written, from the start of the phrase to its head or complement, with single spaces.
        """
        wording = " ".join(self.text[phrase.span[0] : phrase.span[1]].split())
        stem = last_word(phrase.head)
        if not stem:
            one = re.match(r".*?\bones?\b", wording, re.IGNORECASE) if phrase.pronoun == "one" else None
            return (wording if one is None else one[0]).strip(" ,;:.")
        first = max(wording.casefold().find(phrase.head.split()[0][:2]), 0)
        start = re.escape(stem[: max(2, len(stem) - 2)].casefold())
        match = re.search(rf"\b{start}", wording.casefold()[first:]) or re.search(start, wording.casefold()[first:])
        place = first + match.start() if match is not None else -1
        if place < 0:
            return wording.strip(" ,;:.")
        end = next((i for i in range(place, len(wording)) if wording[i] in " ,;:."), len(wording))
        if phrase.of is not None and phrase.of.span[1] <= phrase.span[1] and phrase.of.span[0] >= phrase.span[0]:
            part = re.escape(last_word(phrase.of.head)[: max(2, len(last_word(phrase.of.head)) - 2)].casefold())
            named = re.search(rf"\b{part}[\w'-]*", wording[end:].casefold()) if phrase.of.head else None
            whole_of = min(len(wording), phrase.of.span[1] - phrase.span[0])
            end = max(end, whole_of if named is None else end + named.end())
        return wording[:end].strip(" ,;:.").removesuffix("'s")

    def earlier(self, phrase: NounPhrase) -> Entity | None:
        """Return the earlier object that a definite phrase stands for, or None.

        Parameters
        ----------
        phrase
            Noun phrase with a head.

        Returns
        -------
        Entity or None
            Object or group that the text introduced before.
        """
        return self._earlier(phrase)

    def _earlier(self, phrase: NounPhrase) -> Entity | None:
        """Return the earlier object with the same noun, unless the phrase introduces another one."""
        latest_first = self._named_like(phrase.head)
        yours = phrase.owner is not None and phrase.owner.pronoun in VIEWER_WORDS | {"we"}  # 'your eight pawns'
        same = yours and any(entity.size == phrase.count and entity.noun == phrase.head for entity in latest_first)
        if phrase.determiner in ("another", "a", "an", "some", "no") or (
            phrase.count is not None and phrase.determiner not in DEFINITE | {"both", "all", "other"} and not same
        ):
            return None
        if _FURTHER.search(self.text[max(0, phrase.span[0] - 12) : phrase.span[0]] + self.words(phrase)):
            return None
        if any(a.word == "matching" for a in phrase.adjectives):
            return None  # 'align the pockets with the matching pockets'
        if any(a.word == "remaining" for a in phrase.adjectives):
            return self._remaining(phrase, latest_first)
        if self._is_ambiguous(phrase, latest_first):
            return None
        beside = {e.noun for e in latest_first if e.noun != phrase.head and e.noun.partition(" ")[0] in _SIDE_DISHES}
        if phrase.head in ("plate", "bowl") and len(beside) > 1 and len(beside) == len({e.noun for e in latest_first}):
            return None  # 'the plate' after 'the bread plate' and 'the salad plate'
        comparative = any(a.degree is Degree.COMPARATIVE for a in phrase.adjectives)
        general = phrase.plural and phrase.determiner is None and phrase.owner is None and comparative
        if phrase.plural and (several := self._all_of(phrase, latest_first)) is not None:
            return several
        for entity in sorted(
            latest_first,
            key=lambda entity: (
                not phrase.plural and phrase.determiner == "the" and entity.plural and not entity.single
                and entity.born < self.sentence and entity.noun == phrase.head and not _agreement(entity, phrase),
                entity.compared,
                entity.noun != phrase.head and entity.noun in beside,
                phrase.head not in (entity.noun, *entity.aliases) and not entity.was_called(phrase.head),
                -_agreement(entity, phrase),
                not phrase.plural and phrase.determiner in DEFINITE and bool(entity.members),
                -entity.named if entity.noun != phrase.head else 0,  # 'the plate': the one that is named most often
            ),
        ):  # fmt: skip
            if not _can_name(phrase.head, entity) or _conflicting(entity, phrase):
                continue
            if phrase.determiner == "other" and not entity.members:
                continue
            if (phrase.count or 1) > 1 and not (entity.members or entity.plural or entity.group is not None):
                continue  # 'the two rails' after 'a rail'
            if self._is_further(phrase, entity) or _is_told_apart(phrase, entity):
                continue
            alone = not (entity.members or entity.plural or entity.single or entity.group is not None)
            named = entity.noun == phrase.head or phrase.head in entity.aliases or entity.was_called(phrase.head)
            if (
                alone
                and phrase.plural
                and phrase.count is None
                and (not named or entity.noun.endswith(f" {phrase.head}"))
            ):
                continue  # 'the drums' after 'the bass drum'
            every = phrase.determiner in ("each", "every") or any(a.rank is not None for a in phrase.adjectives)
            if (
                every
                and alone
                and entity.born < self.sentence
                and not _agreement(entity, phrase)
                and any(dimension in _LASTING for dimension, _ in entity.adjectives)
            ):
                continue  # 'one on each square' after 'the white square'
            sized = any(a.dimension == "size" and a.degree is Degree.PLAIN for a in phrase.adjectives)
            other = phrase.head in GENERAL and entity.noun != phrase.head and sized
            if other and not _agreement(entity, replace(phrase, plural=False)):
                continue  # 'the large pieces' after 'the foot pieces'
            kind = phrase.plural and phrase.determiner is None and phrase.owner is None and phrase.count is None
            if kind and not (entity.members or entity.plural or entity.group is not None):
                continue  # 'towels' after 'a towel'
            one = not phrase.plural and phrase.determiner == "the" and entity.plural and not entity.single
            apart = any(a.degree is Degree.PLAIN and a.rank is None for a in phrase.adjectives)
            if one and apart and not entity.members and not _agreement(entity, phrase):
                continue  # 'the shallow drawer' after 'the bottom drawers'
            coloured = {("colour", a.word) for a in phrase.adjectives if a.dimension == "colour"}
            if coloured and entity.members and phrase.plural and not any(
                coloured & leaf.adjectives for leaf in entity.leaves()
            ):  # fmt: skip
                continue  # 'the white pieces' after '12 pieces'
            if _is_one_of_a_kind(phrase, entity) or _are_placed_apart(phrase, entity):
                continue
            if general and not _agreement(entity, phrase) - bool(entity.members or entity.plural):
                continue  # 'larger items' after 'sale items'
            bare = phrase.plural and phrase.determiner is None and phrase.owner is None and phrase.count is None
            if bare and phrase.adjectives and not _agreement(entity, replace(phrase, plural=False)):
                continue  # 'folded napkins' after 'the paper napkins', 'used cards' after 'four cards'
            longer = entity.noun != phrase.head and not entity.was_called(phrase.head)
            if bare and longer and entity.born < self.sentence - MAX_SENTENCES_TO_GROUP:
                continue  # 'cups, mugs and plates' after 'measuring cups', long before
            if _are_others(phrase, entity):
                continue
            if entity.group is not None and entity.group in self.entities:
                continue
            if (
                entity.plural
                and not entity.members
                and not phrase.plural
                and any(a.degree is Degree.COMPARATIVE for a in phrase.adjectives)
            ):
                entity.split(2)
            if entity.plural and not entity.members and 1 < (phrase.count or 0) <= MAX_COUNTED:
                entity.split(phrase.count or 0)  # 'the two corks'
            if entity.members and not phrase.plural and phrase.determiner not in ("each", "every", "all", "both"):
                member = self.member(entity, phrase)
                apart = any(a.dimension in ("position", "rank") for a in phrase.adjectives)
                return member or (None if apart else entity)  # 'the bottom board', where two of three are known
            return entity
        return None

    def _is_ambiguous(self, phrase: NounPhrase, latest_first: list[Entity]) -> bool:
        """Return True for *the plate* after *the butter plate* and *the side plate*, of which neither was called so."""
        bare = phrase.determiner == "the" and not phrase.plural and not phrase.adjectives and phrase.owner is None
        named = [e for e in latest_first if _can_name(phrase.head, e) and not (e.compared or _conflicting(e, phrase))]
        named = [e for e in named if e.noun != phrase.head or e.members or e.single or not e.plural]  # not 'bags'
        longer = {e.noun for e in named if e.noun != phrase.head and not e.was_called(phrase.head)}
        return bare and not phrase.predicates and len(longer) > 1 and len(named) == len(longer)

    def _carrier(self, phrase: NounPhrase, relation: str | None, besides: Entity | None) -> Entity | None:
        """Return the subject that a thing lies on: *the bread plate is here, with a knife across the plate*."""
        last = self.recent[0] if self.recent and self.recent[0].sentence == self.sentence else None
        host = self.host or (None if last is None or last.subject is None else last.subject.itself)
        if host is None or besides is None or host is besides.itself or relation not in _CARRYING:
            return None
        bare = phrase.determiner == "the" and not phrase.plural and not phrase.adjectives and phrase.owner is None
        single = host.role is Role.THING and not (host.members or host.plural)
        return host if bare and single and host.noun != phrase.head and _can_name(phrase.head, host) else None

    def _remaining(self, phrase: NounPhrase, latest_first: list[Entity]) -> Entity | None:
        """Return the members of a group that *the remaining cups* leaves over; None if no group was told apart."""
        for entity in latest_first:
            left = [leaf for leaf in entity.leaves() if not leaf.is_picked] if entity.members else []
            if left and len(left) < entity.size and _can_name(phrase.head, entity):
                return left[0] if len(left) == 1 or not phrase.plural else Entity("", members=left)
        return None

    def _is_further(self, phrase: NounPhrase, entity: Entity) -> bool:
        """Return True for *the second panel* after *one panel*: another one, which is not counted from a side."""
        rank = next((a.rank for a in phrase.adjectives if a.rank is not None), None)
        counted = any(p.relation == "ordinal" for p in phrase.predicates)
        alone = not (entity.members or entity.plural or entity.group is not None)
        ranked = any(dimension == "rank" for dimension, _ in entity.adjectives)
        longer = entity.noun != phrase.head and not entity.was_called(
            phrase.head
        )  # 'the last hole' after 'an exit hole'
        further = rank is not None and (rank > 1 or (rank < 0 and longer))
        return alone and not ranked and further and not counted and not phrase.plural

    def _named_like(self, head: str) -> list[Entity]:
        """Return the known objects whose noun, or another noun for them, has the same last word, the latest first."""
        for entity in self.entities[self._indexed :]:
            self._by_last_word.setdefault(last_word(entity.noun), []).append(entity)
        self._indexed = len(self.entities)
        found = [
            *self._by_last_word.get(last_word(head), ()),
            *(e for e in self.renamed if last_word(head) in e.aliases),
        ]
        return [entity.itself for entity in reversed(found) if not entity.absent]

    def _all_of(self, phrase: NounPhrase, latest_first: list[Entity]) -> Entity | None:
        """Return the single things that a definite plural stands for: *the bins* after a green bin and a blue bin."""
        named = [e for e in latest_first if _can_name(phrase.head, e) and not _conflicting(e, phrase)]
        if any(entity.members or entity.plural for entity in named) or phrase.determiner not in DEFINITE | {
            "both",
            "all",
        }:
            return None
        kept = named[: phrase.count] if phrase.count is not None else named
        return Entity("", members=kept[::-1]) if len(kept) > 1 and len(kept) >= (phrase.count or 0) else None

    def _known(self) -> Iterator[Entity]:
        exact: list[Entity] = [entity.itself for entity in self.entities if not entity.absent]
        yield from exact

    # Members of groups ------------------------------------------------------------------------------------------

    def member(self, group: Entity, phrase: NounPhrase) -> Entity | None:
        """Return the member of a group that adjectives pick out, such as *the taller one* or *the second*.

        Parameters
        ----------
        group
            Group with its members.
        phrase
            Noun phrase, the adjectives of which pick the member out. An adjective that no member has yet is given to a
            free one.

        Returns
        -------
        Entity or None
            Member; None if the phrase picks none out.
        """
        leaves = list(group.leaves())
        if phrase.determiner == "other" or phrase.pronoun == "other":
            left = [leaf for leaf in leaves if not leaf.is_picked]
            if phrase.plural and len(left) > 1 and len(left) >= (phrase.count or 0):  # 'the other two', 'the others'
                return Entity("", members=[self.picked(leaf, phrase) for leaf in left[: phrase.count]])
            return left[0] if left else leaves[-1]
        for predicate in phrase.predicates:  # 'the second fork from the left', with the leaves from left to right
            rank = predicate.value.rank if predicate.relation == "ordinal" and predicate.value is not None else None
            if rank is not None and 0 < abs(rank) <= len(leaves):
                from_left = (rank > 0) == (predicate.part not in ("right", "back", "far"))
                return self.picked(leaves[abs(rank) - 1 if from_left else -abs(rank)], phrase)
        owner = phrase.owner.head if phrase.owner is not None else ""
        if owner and not phrase.plural and phrase.head:  # 'the passenger's seat' after 'the seats'
            owned = next((leaf for leaf in leaves if ("picked", f"of {owner}") in leaf.adjectives), None)
            owned = owned or next((leaf for leaf in leaves if not leaf.is_picked), None)
            if owned is not None:
                owned.adjectives.add(("picked", f"of {owner}"))
                return self.picked(owned, phrase)
        for place in phrase.predicates:  # 'the table that holds the lamp' after 'two tables'
            if phrase.determiner != "the" or phrase.plural or not phrase.head or not place.positive:
                continue
            if place.relation in _TELLING and len(place.arguments) == 1 and place.arguments[0].head:
                tag = f"{place.relation} {place.reversed} {place.arguments[0].head}"
                same = next((leaf for leaf in leaves if ("picked", tag) in leaf.adjectives), None)
                same = same or next((leaf for leaf in leaves if not leaf.is_picked), None)
                if same is not None:
                    same.adjectives.add(("picked", tag))
                    return self.picked(same, phrase)
        apart = any(p.degree is Degree.SUPERLATIVE and p.arguments for p in phrase.predicates)
        free = [leaf for leaf in leaves if not leaf.is_picked]
        if apart and free and not phrase.plural and phrase.head and phrase.determiner == "the":
            return self.picked(free[0], phrase)  # 'the post nearest the door'
        for adjective in phrase.adjectives:
            if adjective.dimension == "position" and adjective.word in _MIDDLES and len(leaves) > 1:
                return self.picked(leaves[len(leaves) // 2], phrase) if len(leaves) % 2 else None
            if adjective.dimension == "rank" and adjective.rank is not None and abs(adjective.rank) <= len(leaves):
                return self.picked(leaves[adjective.rank - 1 if adjective.rank > 0 else adjective.rank], phrase)
            tag = _tag(adjective)
            for leaf in leaves:
                if (adjective.dimension, adjective.word) in leaf.adjectives or ("picked", tag) in leaf.adjectives:
                    return self.picked(leaf, phrase)
            free = [leaf for leaf in leaves if not leaf.is_picked]
            if not free or adjective.dimension == "state":
                continue
            leaf = free[0]
            leaf.adjectives.add(("picked", tag))
            if adjective.degree is Degree.PLAIN and adjective.dimension != "position":
                leaf.adjectives.add((adjective.dimension, adjective.word))
            self._compare(adjective, leaf, leaves, phrase)
            return self.picked(leaf, phrase)
        return None

    def _compare(self, adjective: Adjective, leaf: Entity, leaves: list[Entity], phrase: NounPhrase) -> None:
        relation = None
        if adjective.degree is not Degree.PLAIN:
            relation = COMPARATIVES.get((adjective.dimension, POLES.get(adjective.word, 0)))
        elif adjective.dimension == "position" and len(leaves) == 2:
            relation = {"left": "left", "right": "right", "far": "behind", "near": "in_front"}.get(adjective.word)
        elif adjective.dimension == "size" and len(leaves) == 2:
            relation = COMPARATIVES.get(("size", POLES.get(adjective.word, 0)))
        if relation is not None and not any(
            p[0] == "picked" and p[1] == _opposite_tag(adjective) for other in leaves for p in other.adjectives
        ):
            for other in leaves:
                if other is not leaf:
                    self.compare(relation, leaf, other, phrase)

    def picked(self, leaf: Entity, phrase: NounPhrase) -> Entity:
        """Return a member of a group, marked as told apart from the others by a phrase.

        Parameters
        ----------
        leaf
            Member of a group.
        phrase
            Noun phrase that stands for it.

        Returns
        -------
        Entity
            The member.
        """
        if not leaf.is_picked:
            leaf.adjectives.add(("picked", "named"))
        leaf.mention(self.words(phrase))
        return leaf

    def last_group(self, besides: Entity | None = None) -> Entity | None:
        """Return the group that the text mentioned last.

        Parameters
        ----------
        besides
            Entity that is not meant. If it is a member of a group, that group is returned.

        Returns
        -------
        Entity or None
            Group with a noun; None if the text has none yet, or if the sentence names several things since.
        """
        if besides is not None and besides.group is not None:
            return besides.group
        for focus in self.recent:
            for entity in [focus.subject, *focus.others]:
                if entity is None or entity is besides:
                    continue
                group = entity.itself if entity.itself.members else entity.itself.group
                if group is not None and group.noun:
                    return group
                if entity.plural and focus.sentence == self.sentence:
                    return None  # 'the bolts are stacked, the heaviest at the bottom'
        late = (e for e in reversed(self.entities) if e.born >= self.sentence - MAX_SENTENCES_TO_GROUP)
        return next((e for e in late if e.members and e.noun), None)

    def _is_fresh(self, group: Entity) -> bool:
        """Return True if a clause of this sentence or the one before is about a group or a member of it."""
        late = (e.itself for f in self.recent if f.sentence >= self.sentence - 1 for e in (f.subject, *f.others) if e)
        return any(entity is group or entity.group is group for entity in late)

    # Pronouns ---------------------------------------------------------------------------------------------------

    def _pronoun(self, phrase: NounPhrase, relation: str | None, besides: Entity | None) -> Entity | None:
        word = phrase.pronoun or ""
        if word in VIEWER_WORDS:
            return self.viewer
        if word == "object":  # which a command leaves out: that of the command before
            late = [f.subject for f in self.recent[:1] if f.sentence >= self.sentence - 1]
            return next((entity for entity in late if entity is not None and entity.role is Role.THING), None)
        if word == "both" and phrase.of is not None and phrase.of.pronoun == "they" and not phrase.of.head:
            phrase = replace(phrase, of=None)
        if phrase.of is not None and word not in ("it", "they"):
            group = self.find(phrase.of, relation, besides)
            if group is None or word in ("all", "both", "each", "everything"):
                return group
            if word == "one" and group.members and not phrase.plural:  # 'one of the cups', which another one is not
                free = (leaf for leaf in group.leaves() if not leaf.is_picked)
                return self.picked(self.member(group, phrase) or next(free, None) or next(group.leaves()), phrase)
            return (self.member(group, phrase) or next(group.leaves())) if group.members else group
        if word in ("it", "they") and self._is_lost(phrase):
            return None
        if word == "they" and relation is None and besides is None and self._are_persons(phrase):
            return None
        if word == "they" and (left_out := self._left_out(phrase)) is not None:
            return left_out
        if word in ("they", "both", "all", "each", "these", "those"):
            several = self._plural(relation, besides, word == "both")
            if several is not None and word in ("these", "those") and relation is not None and not several.noun:
                self.guesses.append((phrase.span, Guess.THOSE))  # 'next to these lies the spoon'
            if several is not None and word == "they" and relation is None and not self._is_fresh(several.itself):
                self.guesses.append((phrase.span, Guess.THEY))
            return several
        if word in ("it", "itself", "they") and (left_out := self._left_out(phrase)) is not None:
            return left_out
        if word in ("it", "this", "that", "itself"):
            pointed = self._pointed_at(phrase, relation, besides) if word == "this" else None
            chosen = pointed or self._singular(relation, besides)
            here = [e for f in self.recent if f.sentence == self.sentence for e in (f.subject, *f.others)]
            if relation is not None and here and chosen not in here and self.surface_named == self.sentence:
                return self.surface  # 'the lamp isn't on the table, it hangs from the ceiling above it'
            self._note_doubt(phrase, chosen, relation, besides)
            return chosen
        if word in ("he", "she") and relation is not None:
            named = (e for f in self.recent for e in (f.subject, *f.others) if e is not None and e is not besides)
            persons = [entity for entity in self.entities if entity.role is Role.PERSON]
            only = persons if len(persons) == 1 else []
            last = self.recent[0].subject if self.recent and self.recent[0].sentence >= self.sentence - 1 else None
            thing = last if last is not None and last.role is Role.THING and last is not besides else None
            figure = thing if thing is not None and _is_figure(thing) else None
            thing = thing if self.recent and self.recent[0].sentence == self.sentence else None
            found = next((entity for entity in named if entity.role is Role.PERSON), None)
            return found or thing or next(iter(only), figure)  # 'Joseph stands there with a donkey beside him'
        if word in ("he", "she") and self.recent and self.recent[0].sentence == self.sentence:
            last = self.recent[0].subject  # 'the dinosaur is the biggest and he's next to the lamp'
            return last if last is not None and last.role is Role.THING and not last.members else None
        if word in ("former", "latter"):
            self.pair = self._pair_of_latter(besides) or ()
            return None if not self.pair else self.pair[0 if word == "former" else -1]
        if word in ("one", "other"):
            return self._ellipsis(phrase, besides, relation)
        return None

    def _pair_of_latter(self, besides: Entity | None) -> tuple[Entity, Entity] | None:
        """Return the two things of which *the former* is the first and *the latter* the second."""
        here = [entity for entity in self.named if entity is not besides]
        if len(here) > 1:  # 'between the mug and the bowl, but closer to the latter'
            return here[-2], here[-1]
        with_subject = [f for f in self.recent if f.subject is not None]
        if len(self.pair) > 1 and with_subject and with_subject[0].subject in self.pair:
            return self.pair[0], self.pair[-1]  # 'the former is red, the latter is blue'
        in_this_sentence = [
            f for f in with_subject[:2] if f.sentence == self.sentence and f.relation == with_subject[0].relation
        ]
        subjects = [f.subject for f in in_this_sentence if f.subject is not None]
        if len(subjects) > 1 and subjects[0] is not subjects[1]:
            return subjects[1], subjects[0]  # 'the knife is on the mat and the fork isn't; the latter …'
        pair = next((f for f in with_subject if f.others), None)
        for focus in with_subject:
            if focus.subject is not None and not focus.subject.noun and len(focus.subject.members) > 1:
                return focus.subject.members[0], focus.subject.members[-1]
            if focus.others and focus.sentence < self.sentence:
                pair = focus
                break
        return None if pair is None or pair.subject is None else (pair.subject, pair.others[0])

    def _is_lost(self, phrase: NounPhrase) -> bool:
        """Return True for a pronoun after a clause of its sentence that was not understood, which it may go back to."""
        if any(focus.sentence == self.sentence for focus in self.recent) or (self._left_out(phrase) is not None):
            return False
        return any(end <= phrase.span[0] and end - start > MIN_LOST for start, end in self.lost)

    def _are_persons(self, phrase: NounPhrase) -> bool:
        """Return True for *they* after persons of its sentence: *so that guests can sit while they eat*."""
        words = re.findall(r"[a-z]+", self.text[self.start : phrase.span[0]].casefold())
        return any(word.endswith("s") and word[:-1] in PEOPLE for word in words)

    def _left_out(self, phrase: NounPhrase) -> Entity | None:
        """Return the object of an earlier clause of the sentence that says no place: *fold the napkin and put it …*."""
        if any(focus.sentence == self.sentence and not _is_person(focus.subject) for focus in self.recent):
            return None
        before = self.text[self.start : phrase.span[0]]
        named = list(NAMED.finditer(before))
        placed = MOVED.search(before, 0, named[-1].start()) if named else None
        if placed is not None:  # 'I put the mirror on the desk, but it is safer behind the sofa'
            named.append(placed)
        words = named[-1][1].casefold().split() if named else []
        if not words or len(words) > 3 or not prepositions().keys().isdisjoint(words):
            return None
        one = singulars(words[-1])[0]
        if (phrase.pronoun == "they") is not (one != words[-1] or words[-1] in SINGLE_PLURALS):
            return None
        span = (self.start + named[-1].start(1), self.start + named[-1].end(1))
        head = " ".join([*words[:-1], one])
        return self.find(NounPhrase(span, head=head, determiner="the", plural=one != words[-1]))

    def _ellipsis(self, phrase: NounPhrase, besides: Entity | None, relation: str | None = None) -> Entity | None:
        two = phrase.count == 2 and phrase.determiner in ("the", "these", "those") and not phrase.adjectives
        if two and phrase.of is None and (pair := self._plural(None, besides)) is not None and pair.size == 2:
            return pair  # 'behind the two'
        group = self.find(phrase.of, None, besides) if phrase.of is not None else None
        if (
            phrase.of is None
            and phrase.pronoun == "one"
            and phrase.determiner in ("this", "that")
            and not phrase.adjectives
        ):
            return self._singular(relation, besides)  # 'behind that one'
        label = self.recent[0] if self.recent and self.recent[0].sentence == self.sentence else None
        named_before = label.subject if label is not None and label.relation is None and not label.others else None
        coloured = any(a.dimension == "colour" for a in phrase.adjectives)
        apart = relation is None and phrase.pronoun == "one" and bool(phrase.adjectives) and not coloured
        several = named_before is not None and named_before.plural and named_before.role is Role.THING
        if group is None and apart and named_before is not None and several and named_before.noun:
            return self._new(replace(phrase, head=named_before.noun, pronoun=None), Role.THING)
        if group is None and phrase.pronoun == "one" and coloured:
            contrasted = self._contrasted(phrase)
            if contrasted is not None:
                return contrasted
        bare = phrase.determiner is None and phrase.pronoun is None and phrase.count is None and not phrase.plural
        if group is None and bare and coloured and relation is not None:
            return None  # 'on black's right'
        if group is None and phrase.adjectives:
            colours = {a.word for a in phrase.adjectives if a.dimension == "colour"}
            if colours and (noun := self._last_noun()):  # the blue one, beside the red box
                for entity in self._known():
                    if _same_noun(entity.noun, noun) and any(("colour", c) in entity.adjectives for c in colours):
                        return entity
                if noun in PEOPLE:  # 'the guests; the blue lies behind the brie'
                    return self._new(replace(phrase, head=min(colours), adjectives=(), pronoun=None), Role.THING)
                group = self.last_group(besides)
                if group is None or not _same_noun(group.noun, noun):
                    entity = Entity(noun, born=self.sentence)
                    entity.plural = phrase.plural
                    entity.adjectives = {("colour", c) for c in colours}
                    self.entities.append(entity)
                    return self._seen(entity, phrase)
        pair = self.last_group(besides) if phrase.pronoun == "one" else None
        pair = pair if pair is not None and pair.size == 2 and self._is_fresh(pair) else None  # 'two shelves: …'
        if group is None and pair is None and (contrasted := self._contrasted(phrase)) is not None:
            return contrasted
        ordered = phrase.adjectives and all(a.dimension in ("rank", "position", "height") for a in phrase.adjectives)
        alone = phrase.pronoun is None and phrase.determiner == "the" and not phrase.plural and phrase.of is None
        if group is None and ordered and alone and relation in ("inside", "on") and besides is not None:
            beside = next((f.others[-1] for f in self.recent[:1] if f.relation == relation and f.others), None)
            single = beside is not None and bool(beside.noun) and not beside.members and beside.group is None
            if beside is not None and single and any(d in ("position", "height", "rank") for d, _ in beside.adjectives):
                return self._new(replace(phrase, head=beside.noun), beside.role)  # 'in the top drawer, … in the second'
        if group is None and not phrase.adjectives and relation in ("inside", "on", "under"):
            another = self._another_one(phrase, besides, relation)
            if another is not None:
                return another
        ranks = [a.rank for a in phrase.adjectives if a.rank is not None]
        if group is None and ranks and besides is not None and besides.noun and not besides.itself.members:
            like = [e for e in self._known() if e.noun == besides.noun and not e.members and e is not besides.itself]
            if like and besides.itself.group is None:
                return self._seen(like[0], phrase)  # 'the second panel opposite the first one'
        some = (
            group is not None and not group.members and phrase.of is not None and 1 < (phrase.count or 0) <= MAX_COUNTED
        )
        if some and phrase.of is not None and phrase.of.head and phrase.of.plural:
            return self._new(replace(phrase, head=phrase.of.head, of=None), Role.THING)  # 'two of the beads'
        if group is None:
            group = self.last_group(besides)
            told_apart = bool(phrase.adjectives) or phrase.pronoun is not None
            if group is not None and told_apart and not self._is_fresh(group):
                self.guesses.append((phrase.span, Guess.ELLIPSIS))
        further = phrase.determiner in ("a", "an", "another") and phrase.pronoun == "one"
        second = relation is None and phrase.pronoun == "other" and phrase.determiner == "the" and not phrase.plural
        leaves = [] if group is None else list(group.leaves())
        free = [leaf for leaf in leaves if not leaf.is_picked]
        before = self.recent[0] if self.recent and self.recent[0].sentence == self.sentence else None
        labelled = before is not None and before.subject is group and before.relation is None
        listed = before is not None and (labelled or before.subject in leaves)
        if further and group is not None and listed and free and not ranks:
            # 'two cups: a red one on the box, a blue one behind the jar'
            return self.picked(self.member(group, phrase) or free[0], phrase)
        if further and group is not None and group.noun and phrase.of is None:
            return self._new(replace(phrase, head=group.noun, pronoun=None), group.role)  # 'a third one'
        if (further or (second and group is None)) and phrase.of is None and (last := self._last_thing(besides)):
            return self._new(replace(phrase, head=last.noun, pronoun=None), Role.THING)  # 'on it, a smaller one'
        if group is None or not group.members:
            many = self.recent[0].subject if self.recent and relation is None else None
            bare = phrase.pronoun == "one" and phrase.determiner is None and not phrase.adjectives
            if bare and many is not None and many.plural and not phrase.predicates:
                return many  # 'fold the napkins and tuck one under each fork'
            kinds = phrase.pronoun == "one" and phrase.plural and bool(phrase.adjectives) and not phrase.determiner
            if kinds and many is not None and many.plural and many.noun and many.role is Role.THING:
                return self._new(replace(phrase, head=many.noun, pronoun=None), Role.THING)  # 'and used ones'
            told = any(a.dimension in ("state", "other") for a in phrase.adjectives) and phrase.pronoun == "one"
            if told and phrase.plural and besides is not None and besides.plural and besides.noun:
                return self._new(replace(phrase, head=besides.noun, pronoun=None), besides.role)  # 'above fragile ones'
            return self._another_one(phrase, besides, relation)
        if ranks and min(ranks) > group.size and group.noun and phrase.of is None:
            return self._new(
                replace(phrase, head=group.noun, pronoun=None), group.role
            )  # 'the third' after two of them
        some = phrase.of is not None or (phrase.determiner is None and relation is None)
        if some and 1 < (phrase.count or 0) <= group.size and not phrase.adjectives:
            chosen = [*free, *(leaf for leaf in leaves if leaf not in free)][: phrase.count]
            return Entity("", members=[self.picked(leaf, phrase) for leaf in chosen])  # 'three of the five forks'
        found = self.member(group, phrase)
        if found is None and phrase.pronoun == "one":
            found = self.picked(free[0], phrase) if free else None
        if found is not None:
            self.picked(found, phrase)
        return found

    def _last_thing(self, besides: Entity | None) -> Entity | None:
        """Return the single thing that the last clause is about."""
        last = self.recent[0].subject if self.recent else None
        known = last is not None and last is not besides and last.role is Role.THING and bool(last.noun)
        return last if known else None

    def _contrasted(self, phrase: NounPhrase) -> Entity | None:
        """Return *the front one* beside *the back burner*: the thing of the same noun with the other adjective."""
        for adjective in phrase.adjectives:
            if adjective.dimension not in ("position", "size", "height", "length", "rank", "colour"):
                continue
            latest: Entity | None = None
            for entity in reversed(list(self._known())):
                words = {word for dimension, word in entity.adjectives if dimension == adjective.dimension}
                if not words or entity.group is not None or entity.members or not entity.noun:
                    continue
                latest = latest or entity
                if adjective.word in words and entity.noun == latest.noun:
                    return self._seen(entity, phrase)  # 'the right panel opposite the left one'
            if latest is not None:
                return self._new(replace(phrase, head=latest.noun, pronoun=None), latest.role)
        return None

    def _another_one(self, phrase: NounPhrase, besides: Entity | None, relation: str | None = None) -> Entity | None:
        """Return a new thing with the noun of the subject for *the one leaning against the wall*.

        After *in* and *on* it has the noun of the thing that the one before is in or on: *onions in the bowl, garlic in
        the one behind it*.
        """
        other = phrase.pronoun in ("one", "other") and phrase.determiner in ("other", "the") and relation is not None
        other = other and (phrase.determiner == "other" or phrase.pronoun == "other")
        other = other and self.last_group(besides) is None
        if (phrase.pronoun != "one" or not phrase.predicates) and not other:
            return None
        if besides is not None and relation in ("inside", "on", "under"):
            parallel = next((f.others[0] for f in self.recent[:2] if f.relation == relation and f.others), None)
            return (
                None if parallel is None else self._new(replace(phrase, head=parallel.noun, pronoun=None), Role.THING)
            )
        last = besides or next((f.subject for f in self.recent if f.subject is not None), None)
        if last is None or last.role is not Role.THING or not last.noun:
            return None
        return self._new(replace(phrase, head=last.noun, pronoun=None), Role.THING)

    def _last_noun(self) -> str | None:
        last = self.recent[0].subject if self.recent else None
        many = last is not None and (bool(last.itself.members) or last.plural or last.itself.group is not None)
        if last is not None and last.noun and many and last.role is Role.THING:
            return last.noun  # 'three buttons on the panel: the red one …, the green one …'
        return self.entities[-1].noun if self.entities else None

    def _singular(self, relation: str | None, besides: Entity | None) -> Entity | None:
        last = self.recent[0] if self.recent else None
        listed_last = last.subject if last is not None and last.relation is None and not last.others else None
        pair = listed_last is not None and bool(listed_last.members) and not listed_last.noun
        if pair and relation is None and besides is None:
            return listed_last  # 'next is the cup and saucer. It goes …'
        parallel = last is not None and self.holder in ("inside", "on") and last.relation == self.holder
        if last is not None and parallel and relation != "under":
            held = last.others if last.sentence == self.sentence and last.subject is not besides else []
            if held:
                return held[0]  # 'cans go in the box, glass in the crate beside it'
        if (
            besides is not None and last is not None and relation in OPPOSITES.keys() - {"on", "under"} and last.others
            and OPPOSITES[relation] == last.relation and last.subject is not besides
        ):  # fmt: skip
            return last.others[0]
        listed = self.recent[-1] if self.recent else None
        if (
            listed is not None and listed.sentence == self.sentence and relation in OPPOSITES and listed.others
            and OPPOSITES[relation] == listed.relation and besides is not None and listed.subject is not besides
        ):  # fmt: skip
            return listed.others[0]  # 'a fork to the left of the plate and a knife to the right of it'
        if relation == "inside" and last is not None and last.sentence == self.sentence:
            named = [e for e in (last.subject, *last.others) if e is not None and e is not besides]
            hollow = [e for e in named if last_word(e.noun) in VESSELS | HOLDERS and not e.itself.members]
            if len(hollow) == 1 and named[0] is not hollow[0] and last_word(named[0].noun) not in VESSELS | HOLDERS:
                return hollow[0]  # 'the filling is in the bowl, with a spoon standing in it'
        several: Entity | None = None
        for focus in self.recent[:4]:
            for entity in [focus.subject, *focus.others]:
                if entity is None or entity is besides or entity.role in (Role.VIEWER, Role.PERSON, Role.ABSTRACT):
                    continue
                if relation is not None and entity.itself.absent:
                    continue  # 'no cushion lies on the bench, but there is a rug under it'
                entity = entity.whole if entity.role is Role.PART and entity.whole is not None else entity
                if entity.itself.members or entity is besides:
                    continue
                poured = entity is focus.subject and focus.relation == "inside" and last_word(entity.noun) in SUBSTANCES
                if poured and any(last_word(e.noun) in VESSELS for e in focus.others if e is not besides):
                    continue  # 'fill the jug with milk and put it on the mat'
                if entity.itself.plural and not entity.itself.single:
                    several = several or entity
                    continue
                return entity
        return several

    def _pointed_at(self, phrase: NounPhrase, relation: str | None, besides: Entity | None) -> Entity | None:
        """Return the thing of the last clause that was named last: *it leans on the wall rail, and under that …*."""
        last = self.recent[0] if self.recent else None
        if last is None or last.sentence != self.sentence or last.subject is None or last.relation == relation:
            return None  # 'A to the right of B, and to the right of that C'
        before = self.text[self.start : phrase.span[0]].casefold()
        things = [e for e in (last.subject, *last.others) if e.role is Role.THING and e.noun and e is not besides]
        single = [not (e.members or e.plural) for e in things]
        placed = [(before.rfind(last_word(e.noun)[:4]), i) for i, e in enumerate(things) if single[i]]
        found = [place for place in placed if place[0] >= 0]
        return things[max(found)[1]] if len(found) > 1 else None

    def _note_doubt(
        self, phrase: NounPhrase, chosen: Entity | None, relation: str | None, besides: Entity | None
    ) -> None:
        """Record a pronoun after a relation where the clause before names two objects that it could stand for.

        A pronoun that is the subject goes on with the subject before it, and one after the opposite of the relation
        before (*left of the plate … right of it*) with its object; neither is in doubt.
        """
        last = self.recent[0] if self.recent else None
        if chosen is None or last is None or besides is None or chosen.role is not Role.THING:
            return
        if relation in OPPOSITES and OPPOSITES[relation] == last.relation:
            return
        named = [e for e in (last.subject, *last.others) if e is not None and e.role is Role.THING]
        others = [e for e in named if e.itself not in (chosen.itself, besides.itself) and not e.itself.members]
        if others and chosen.itself in [e.itself for e in named]:
            self.doubtful.append(PronounUse(phrase.span, phrase.pronoun or "", chosen, tuple(others)))

    def _plural(self, relation: str | None, besides: Entity | None, both: bool = False) -> Entity | None:
        last = self.recent[0] if self.recent else None
        if both and last is not None and last.sentence == self.sentence and len(last.others) == 2:
            return Entity("", members=list(last.others))  # 'it has a fork and a spoon, both …'
        before = self.recent[0].subject if self.recent and self.recent[0].sentence == self.sentence else None
        many = before is not None and before.role is Role.THING and bool(before.itself.members or before.plural)
        if many and relation is None and not both:
            return before  # 'the nuts must not be next to the cereals, nor may they stand …'
        earlier = last.subject if last is not None and last.sentence == self.sentence - 1 else None
        goes_on = relation is None and besides is None and not both and earlier is not None
        if (
            goes_on
            and earlier is not None
            and earlier.role is Role.THING
            and (earlier.itself.members or earlier.plural)
        ):
            return earlier  # 'the lamps are on two stands. They point at the door.'
        for group in reversed(self.named):
            if group is not besides and relation != "between" and (group.itself.members or group.plural):
                return group  # 'next to the trays but not touching them'
        first = None if last is None or last.sentence != self.sentence else last.subject
        several = first is not None and first is not besides and (first.plural or first.size > 1)
        if first is not None and relation == "between" and several and first.role is Role.THING:
            return first  # 'the curtains were drawn, yet a glove was caught between them'
        if relation == "between" and (two := self.last_two_subjects(besides)) is not None:
            return two
        restrictions = [f.subject for f in self.recent[1:] if f.sentence == self.sentence and f.subject is not None]
        for focus in self.recent[:4]:
            for entity in [focus.subject, *focus.others, *restrictions]:  # 'a tank with two snails in it, and they …'
                if entity is None or entity is besides or entity.role is not Role.THING:
                    continue
                if entity.itself.members or entity.plural:
                    return entity
            pair = [e for e in [focus.subject, *focus.others[:1]] if e is not None and e.role is Role.THING]
            if len(pair) == 2 and besides not in pair:
                return Entity("", members=pair)
        return None

    def last_two_subjects(self, besides: Entity | None) -> Entity | None:
        """Return the two subjects of the last clause, or those of two clauses of one sentence.

        Parameters
        ----------
        besides
            Entity that is not meant.

        Returns
        -------
        Entity or None
            Group of the two, as of *the pump is left and the motor right of it*; None if the last two clauses are not
            of one sentence, or have no such subjects.
        """
        last = [f for f in self.recent[:3] if f.subject is not None and f.subject is not besides][:2]
        group = last[0].subject.itself if last and last[0].subject is not None else None
        if group is not None and len(group.members) == 2:
            return group  # 'the jug and the tin are on the tray, and in between stands the cup'
        if len(last) < 2 or last[0].sentence != last[1].sentence:
            return None
        if last[0].others and last[0].others != last[1].others:
            return None  # but 'the lamp is at one end of the rail, and the screen at the other'
        pair = [f.subject.itself for f in reversed(last) if f.subject is not None and f.subject.role is Role.THING]
        return Entity("", members=pair) if len(set(pair)) == 2 and not any(e.members for e in pair) else None


def _is_person(entity: Entity | None) -> bool:
    return entity is not None and entity.role in (Role.VIEWER, Role.PERSON)


def _same_noun(first: str, second: str) -> bool:
    """Return True if two nouns can name one thing: equal, or the longer one ends in the shorter one."""
    a, b = first.split(), second.split()
    short, long = sorted((a, b), key=len)
    return bool(short) and long[-len(short) :] == short


def _can_name(head: str, entity: Entity) -> bool:
    """Return True if a noun can name an entity again: its own noun, the end of it, or another noun for it."""
    words = head.split()
    return any(noun.split()[-len(words) :] == words for noun in (entity.noun, *entity.aliases))


_SIDE_DISHES = frozenset({"bread", "salad", "side", "dessert", "butter", "soup", "cake", "rice", "finger", "pie"})
"""First words of plates and bowls beside the one that *the plate* means."""
_CORRESPONDING = frozenset(
    {"corresponding", "respective", "appropriate", "designated", "provided", "indicated", "proper", "empty", "adjacent"}
)
"""Adjectives of a thing that the text tells by what it is for, and not by a name before."""


def _is_told_apart(phrase: NounPhrase, entity: Entity) -> bool:
    """Return True for *the back door* after *the pantry door*: the longer name has no side.

    The same holds of *the black piece* after *the side pieces*, and of *the front rail* after *the side rails*.
    """
    distinguishing = {
        (a.dimension, a.word) for a in phrase.adjectives
        if a.dimension in ("position", "colour", "material", "size") and a.degree is Degree.PLAIN
    }  # fmt: skip
    longer = " " in entity.noun and entity.noun != phrase.head and not entity.was_called(phrase.head)
    if longer and any(a.word in _CORRESPONDING for a in phrase.adjectives):
        return True
    if (
        not longer
        or not distinguishing
        or distinguishing & entity.adjectives
        or entity.noun.startswith(tuple(w for _, w in distinguishing))
    ):
        return False
    sides = _SIDES.intersection(entity.noun.split()[:-1])
    lateral = all(word in ("left", "right") for _, word in distinguishing) and sides == {"side"}
    if any(d == "position" for d, _ in distinguishing) and sides and not lateral:
        return True  # but 'the left panel' is one of the side panels
    several = entity.members or entity.plural or entity.group is not None
    return not several or (any(d == "colour" for d, _ in distinguishing) and not phrase.plural)


def _is_one_of_a_kind(phrase: NounPhrase, entity: Entity) -> bool:
    """Return True for *the large knife* after *knives*: one of them, of which the adjective is true."""
    kind = entity.plural and not (entity.single or entity.members) and not phrase.plural and phrase.determiner == "the"
    qualities = {(a.dimension, a.word) for a in phrase.adjectives if a.degree is Degree.PLAIN and a.dimension in _OWN}
    return kind and bool(qualities) and not qualities & entity.adjectives


def _are_others(phrase: NounPhrase, group: Entity) -> bool:
    """Return True for *all other cards* and *these five cards* after *four cards*: more than the group has."""
    if not (phrase.plural and group.members and group.noun):
        return False
    other = phrase.determiner == "other" or any(a.word == "other" for a in phrase.adjectives)
    return (other and not any(leaf.is_picked for leaf in group.leaves())) or (phrase.count or 0) > group.size


def _agreement(entity: Entity, phrase: NounPhrase) -> int:
    """Return the number of adjectives of a phrase that were used for an entity before."""
    several = phrase.plural and bool(entity.members or entity.plural)
    return several + sum((a.dimension, a.word) in entity.adjectives for a in phrase.adjectives)


def _marks(phrase: NounPhrase) -> set[tuple[str, str]]:
    """Return what tells a thing from others of its noun: *bowl of rice*, *second row from the bottom*."""
    of = phrase.of
    filled = of is not None and bool(of.head) and of.determiner is None and of.owner is None
    marks = {("contents", of.head)} if of is not None and filled and last_word(phrase.head) not in PARTS else set()
    first, _, last = phrase.head.rpartition(" ")
    if first in SUBSTANCES and last in VESSELS:
        marks.add(("contents", first))  # 'the rice bowl', which is not 'the bowl of soup'
    for predicate in phrase.predicates:
        if predicate.relation == "ordinal" and predicate.value is not None and not predicate.reversed:
            marks.add(("ordinal", f"{predicate.value.rank} from {predicate.part}"))
    return marks


def _are_placed_apart(phrase: NounPhrase, entity: Entity) -> bool:
    """Return True for things that a position tells from those before: *the rear speakers* after *two speakers*."""
    places = {("position", a.word) for a in phrase.adjectives if a.dimension == "position" and a.degree is Degree.PLAIN}
    if not places or not phrase.plural or phrase.count is not None or not (entity.members or entity.plural):
        return False
    return not any(places & leaf.adjectives for leaf in (entity, *entity.leaves()))


def _conflicting(entity: Entity, phrase: NounPhrase) -> bool:
    if entity.members:
        return False
    marks = dict(_marks(phrase))
    if any(marks.get(dimension, word) != word for dimension, word in entity.adjectives):
        return True
    for adjective in phrase.adjectives:
        words = {word for dimension, word in entity.adjectives if dimension == adjective.dimension}
        if adjective.dimension in ("colour", "material", "position", "rank") and words and adjective.word not in words:
            return True
        if adjective.dimension in ("size", "height", "length") and words:
            pole = POLES.get(adjective.word)
            if pole is not None and all(POLES.get(word) == -pole for word in words):
                return True
    return False


def _tag(adjective: Adjective) -> str:
    pole = POLES.get(adjective.word)
    return f"{adjective.dimension} {pole}" if pole is not None else f"{adjective.dimension} {adjective.word}"


def _opposite_tag(adjective: Adjective) -> str:
    pole = POLES.get(adjective.word)
    other = {"left": "right", "right": "left", "far": "near", "near": "far"}.get(adjective.word, "")
    return f"{adjective.dimension} {-pole}" if pole is not None else f"{adjective.dimension} {other}"
