"""Groups of household things that people put together: shoes, cookware, snacks, cleaning supplies.

The taxonomy of nouns says what a thing is; groups cut across it by use: a rolling pin is a kitchen tool and bakeware.
``groups.txt`` lists them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from deixis.errors import OntologyError
from deixis.ontology.inflection import singulars
from deixis.ontology.things.kinds import Kind, Kinds, spaced

GROUPS_FILE = Path(__file__).with_name("groups.txt")

OPENING = " *"
"""End of a member of a group that stands for all names with the words before it at their beginning."""


@dataclass(frozen=True, slots=True)
class Group:
    """A group: its words, the IRIs of the kinds in it, the names in it that the lexicon lacks, and first words.

    Each kind stands for its narrower kinds too. The names are in the singular. A name that begins with one of the
    ``openings`` is in the group, whatever comes after it: *canned*, *frozen*.
    """

    words: tuple[str, ...]
    kinds: frozenset[str]
    names: frozenset[str]
    openings: frozenset[str] = frozenset()

    @property
    def label(self) -> str:
        """The usual word for the group, in the plural or as a mass noun."""
        return self.words[0]


class Groups:
    """All groups, by the things in them and by their words.

    >>> from deixis.ontology.tbox import default_ontology
    >>> groups = Groups(default_ontology().kinds)
    >>> sorted(group.label for group in groups.of("rolling pin"))
    ['bakeware', 'kitchen tools']
    >>> groups.of_word("pots and pans").label
    'cookware'
    """

    def __init__(self, kinds: Kinds, text: str | None = None) -> None:
        self._kinds = kinds
        self._listed = _listed(GROUPS_FILE.read_text(encoding="utf-8") if text is None else text)

    def __iter__(self) -> Iterator[Group]:
        return iter(self._all.values())

    def of(self, noun: str) -> tuple[Group, ...]:
        """Return the groups of a thing.

        Parameters
        ----------
        noun
            A noun phrase without its article.

        Returns
        -------
        tuple of Group
            The groups of the first word of its name (*canned*), else of its kind or of a longer known ending.
        """
        if group := self._by_opening(noun):
            return group
        kind, name = self.known_as(noun)
        if kind is None:
            return tuple(group for group in self if name in group.names)
        return tuple(group for group in self if not group.kinds.isdisjoint({*kind.broader, kind.iri}))

    def _by_opening(self, noun: str) -> tuple[Group, ...]:
        """Return the groups of the first words of a compound that neither a group nor the lexicon lists as a whole."""
        whole = _singular(noun)
        if " " not in whole or whole in self._names or self._kinds.senses(whole):
            return ()
        return tuple(group for group in self if any(whole.startswith(f"{opening} ") for opening in group.openings))

    def of_word(self, word: str) -> Group | None:
        """Return the group that a word stands for.

        Parameters
        ----------
        word
            The word.

        Returns
        -------
        Group or None
            The group, or None for other words.
        """
        return self._by_word.get(_singular(word))

    def known_as(self, noun: str) -> tuple[Kind | None, str]:
        """Return the kind of a noun phrase, or the ending of it that a group lists.

        The longest ending counts: a *paper plate* is more than a plate.

        Parameters
        ----------
        noun
            A noun phrase without its article.

        Returns
        -------
        tuple
            The kind, or None and the ending of the name that a group lists. Without any, the name is empty.
        """
        words = _singular(noun).split()
        for start in range(len(words)):
            ending = " ".join(words[start:])
            if ending in self._names:
                return None, ending
            if self._kinds.senses(ending):
                break
        return next(iter(self._kinds.head_noun(spaced(noun))[0]), None), ""

    def size(self, group: Group) -> int:
        """Return the number of kinds and names in a group.

        Parameters
        ----------
        group
            The group.

        Returns
        -------
        int
            The number.
        """
        return self._sizes[group.label]

    def narrower(self, kind: Kind) -> int:
        """Return the number of kinds that are a kind or narrower.

        Parameters
        ----------
        kind
            The kind.

        Returns
        -------
        int
            The number, at least 1.
        """
        return self._narrower.get(kind.iri, 1)

    @cached_property
    def _all(self) -> dict[str, Group]:
        found = {}
        for label, words in self._listed.items():
            kinds, names, openings = set(), set(), set()
            for member in _members(label, self._listed):
                if member.endswith(OPENING):
                    openings.add(member.removesuffix(OPENING))
                    continue
                senses = self._kinds.senses(member) or self._kinds.senses(_singular(member))
                if senses:
                    kinds.add(senses[0].iri)
                else:
                    names.add(_singular(member))
            found[label] = Group(words[0], frozenset(kinds), frozenset(names), frozenset(openings))
        return found

    @cached_property
    def _by_word(self) -> dict[str, Group]:
        return {_singular(word): group for group in reversed(self._all.values()) for word in group.words}

    @cached_property
    def _names(self) -> frozenset[str]:
        return frozenset(name for group in self for name in group.names)

    @cached_property
    def _every_kind(self) -> tuple[Kind, ...]:
        return tuple({kind.iri: kind for kinds in self._kinds.every_word.values() for kind in kinds}.values())

    @cached_property
    def _narrower(self) -> dict[str, int]:
        counts: dict[str, int] = {}
        for kind in self._every_kind:
            for iri in {*kind.broader, kind.iri}:
                counts[iri] = counts.get(iri, 0) + 1
        return counts

    @cached_property
    def _sizes(self) -> dict[str, int]:
        above = [{*kind.broader, kind.iri} for kind in self._every_kind]
        return {
            group.label: sum(not group.kinds.isdisjoint(iris) for iris in above) + len(group.names) for group in self
        }


def _singular(word: str) -> str:
    first, _, last = spaced(word).rpartition(" ")
    return f"{first} {singulars(last)[0]}".strip() if last else ""


def _listed(text: str) -> dict[str, tuple[tuple[str, ...], tuple[str, ...]]]:
    """Return the words and the members of each group, by its first word."""
    listed: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {}
    for number, raw in enumerate(text.splitlines(), 1):
        line = raw.partition("#")[0].strip()
        if not line:
            continue
        named, _, members = line.partition(":")
        words, things = (tuple(word.strip() for word in part.split(",")) for part in (named, members))
        if not all(words) or not all(things):
            raise OntologyError(
                f"{GROUPS_FILE.name}:{number}: a line must be 'group, synonym: noun, noun', got '{line}'"
            )
        if words[0] in listed:
            raise OntologyError(f"{GROUPS_FILE.name}:{number}: the group '{words[0]}' is already listed")
        listed[words[0]] = words, things
    return listed


def _members(
    label: str, listed: Mapping[str, tuple[tuple[str, ...], tuple[str, ...]]], inside: tuple[str, ...] = ()
) -> Iterator[str]:
    """Yield the nouns of a group and of the groups in braces, each of which must be listed and not hold itself."""
    if label in inside or label not in listed:
        raise OntologyError(f"{GROUPS_FILE.name}: '{{{label}}}' must be a listed group that does not contain itself")
    for member in listed[label][1]:
        if member.startswith("{"):
            yield from _members(member.strip("{}"), listed, (*inside, label))
        else:
            yield member
