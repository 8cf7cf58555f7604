"""Objects that a text speaks of: single ones and groups, the words used for them, and their names."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from enum import StrEnum

from deixis.grammar.english.vocabulary.nouns import SINGLE_PLURALS, SPECTACLES
from deixis.grammar.english.vocabulary.tables import LITERAL


class Role(StrEnum):
    """Role of an entity in the scene."""

    THING = "thing"
    SURFACE = "surface"  # what everything stands on
    VIEWER = "viewer"
    PERSON = "person"
    ABSTRACT = "abstract"  # what has no place: a decision, a story
    SURROUNDING = "surrounding"  # a wall, a window
    PART = "part"  # of a thing


@dataclass(eq=False)
class Entity:
    """An object of the discourse, or a group of them.

    ``noun`` is in the singular. ``plural`` with no ``members`` is a group of unknown number, which is one object until
    the number is known. ``pairs`` relates an entity of a quantified noun phrase to the ones that it goes with.
    """

    noun: str
    role: Role = Role.THING
    plural: bool = False
    single: bool = False  # one thing in spite of its plural: 'the scissors'
    members: list[Entity] = field(default_factory=list)
    adjectives: set[tuple[str, str]] = field(default_factory=set)  # dimension and word
    mentions: list[str] = field(default_factory=list)
    named: int = 0  # how often the text named it
    group: Entity | None = None
    same_as: Entity | None = None  # another entity that turned out to be this one
    whole: Entity | None = None
    absent: bool = False
    born: int = 0  # sentence that introduced it
    indefinite: bool = False
    compared: bool = False  # only named as a measure: 'smaller than a dinner plate'
    aliases: set[str] = field(default_factory=set)  # other nouns for it: 'clock' for 'item 15, a clock'
    written: str = ""  # the noun as first written: 'glasses'

    @property
    def itself(self) -> Entity:
        """The entity that this one was identified with."""
        found = self
        while found.same_as is not None:
            found = found.same_as
        return found

    @property
    def is_picked(self) -> bool:
        """True if the text told this object apart from the others of its group."""
        return any(dimension == "picked" for dimension, _ in self.adjectives)

    def leaves(self) -> Iterator[Entity]:
        """Yield the single objects.

        Yields
        ------
        Entity
            The entity itself if it is a single object, otherwise the members of its groups.
        """
        entity = self.itself
        if not entity.members:
            yield entity
        for member in entity.members:
            yield from member.leaves()

    @property
    def size(self) -> int:
        """Number of single objects."""
        return sum(1 for _ in self.leaves())

    def split(self, count: int) -> None:
        """Make a group of ``count`` single objects out of an entity.

        Parameters
        ----------
        count
            Number of members; each gets the noun, the role and the adjectives of the group.
        """
        for _ in range(count):
            member = Entity(self.noun, self.role, group=self, born=self.born)
            member.adjectives = set(self.adjectives)
            self.members.append(member)

    def mention(self, phrase: str) -> None:
        """Record words that were used for the entity.

        Parameters
        ----------
        phrase
            Words of the text; an empty phrase and a repeated one are not recorded.
        """
        entity = self.itself
        entity.named += 1
        if phrase and phrase not in entity.mentions:
            entity.mentions.append(phrase)

    def was_called(self, noun: str) -> bool:
        """Return True if the text used a noun, with an article alone, for the entity: *the plate* for a dinner plate.

        Parameters
        ----------
        noun
            Noun in the singular.

        Returns
        -------
        bool
            False for a noun that was only used with other words.
        """
        return any(phrase.casefold() in (noun, f"the {noun}") for phrase in self.itself.mentions)


def names_of(entities: Iterable[Entity]) -> dict[Entity, str]:
    """Return a name for each single object: its noun, with an adjective or a number where several share it.

    Parameters
    ----------
    entities
        Objects and groups in the order of their first mention.

    Returns
    -------
    dict of Entity to str
        Unique name in the layout language, with underscores for spaces, for each single object.

    Examples
    --------
    >>> cup, other = Entity("tea cup"), Entity("tea cup")
    >>> list(names_of([cup, other, Entity("jug")]).values())
    ['tea_cup_1', 'tea_cup_2', 'jug']
    """
    leaves = list(dict.fromkeys(leaf for entity in entities for leaf in entity.leaves()))
    by_noun: dict[str, list[Entity]] = {}
    for leaf in leaves:
        by_noun.setdefault(_stem(leaf), []).append(leaf)
    names: dict[Entity, str] = {}
    taken: set[str] = set()
    for stem, sharing in by_noun.items():
        for number, leaf in enumerate(sharing, start=1):
            names[leaf] = stem if len(sharing) == 1 else f"{stem}_{number}"
        told_apart = [_described(leaf, sharing) for leaf in sharing]
        if len(sharing) > 1 and all(told_apart) and len(set(told_apart)) == len(sharing):
            names |= {leaf: f"{word}_{stem}" for leaf, word in zip(sharing, told_apart, strict=True)}
    for leaf in leaves:  # a number that is a name of something else, as in 'box 1' beside two boxes
        name, number = names[leaf], 1
        while name in taken:
            number += 1
            name = f"{names[leaf]}_{number}"
        taken.add(name)
        names[leaf] = name
    return {leaf: names[leaf] for leaf in leaves}


def _stem(leaf: Entity) -> str:
    noun = leaf.noun
    if noun.startswith(LITERAL):
        return noun.strip(LITERAL)
    if leaf.plural and leaf.written:
        noun = leaf.written
    return "_".join(noun.replace("'", "").replace("-", "_").split()) or "thing"


def _described(leaf: Entity, sharing: list[Entity]) -> str:
    """Return an adjective that only this one of the things that share a noun has."""
    if leaf.group is not None:
        return ""
    others = {pair for other in sharing if other is not leaf for pair in other.adjectives}
    own = sorted(
        pair for pair in leaf.adjectives if pair not in others and pair[0] in ("colour", "size", "material", "position")
    )
    return own[0][1].replace(" ", "_") if own else ""


def plain_noun(noun: str) -> str:
    """Return a noun as it is written, also one that was given between backticks.

    Parameters
    ----------
    noun
        Noun; one from backticks is enclosed in ``LITERAL`` letters and has underscores for spaces.

    Returns
    -------
    str
        Noun with spaces and without these letters.
    """
    return noun.strip(LITERAL).replace("_", " ") if noun.startswith(LITERAL) else noun


def is_one_thing(phrase: str) -> bool:
    """Return True for a phrase with a plural such as *scissors* that names one thing.

    *Glasses* are spectacles if they are someone's, a pair, or for reading, and drinking glasses otherwise.

    Parameters
    ----------
    phrase
        Noun phrase as written, in lower case.

    Returns
    -------
    bool
        True if a word of the phrase is such a plural.

    Examples
    --------
    >>> is_one_thing("the kitchen scissors"), is_one_thing("my glasses"), is_one_thing("the wine glasses")
    (True, True, False)
    """
    words = phrase.replace(",", " ").split()
    return any(
        word in SINGLE_PLURALS and (word != "glasses" or not SPECTACLES.isdisjoint(words[:place]))
        for place, word in enumerate(words)
    )
