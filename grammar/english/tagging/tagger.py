"""Find the best sequence of word classes of a sentence by dynamic programming over the states of its clauses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

from deixis.grammar.english.tagging.weights import WEIGHTS
from deixis.grammar.english.tagging.word_classes import (
    FINITE,
    NOMINAL,
    VERBAL,
    Possible,
    WordClass,
    closed_words,
    possible_classes,
)
from deixis.grammar.english.tokens import Word
from deixis.grammar.english.vocabulary.adjectives import is_adjective
from deixis.grammar.english.vocabulary.function_words import (
    ADVERBS,
    ARTICLES,
    DEGREE_ADVERBS,
    DETERMINERS,
    HEDGES,
    IS_FORMS,
    MODALS,
    NEGATIONS,
    NUMBERS,
    PLURAL_PRONOUNS,
    POSSESSIVES,
)
from deixis.grammar.english.vocabulary.known_nouns import KnownNouns
from deixis.grammar.english.vocabulary.relation_words import places_alone, prepositions
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import NAMED_LIKE_THINGS, REPORTS, SAYING, verb_forms

MAX_LOSS = 2.0
"""Maximum loss of log probability, in nats, of a second reading of a sentence."""
MAX_SECOND_READINGS = 6
"""Maximum number of second readings of a sentence."""


Awaited = Literal["verb", "two verbs", "perhaps", "nothing", "infinitive"]


class Clause(NamedTuple):
    """State of the clause after a word."""

    before: WordClass
    """Class of the word; adverbs are passed over."""
    subject: Literal["none", "one", "several", "joined", "unknown"]
    """Number of the last noun outside a place; ``joined`` after *and*, before the second noun."""
    awaits: Awaited
    """Verbs that the clause still needs; ``perhaps`` after a comma or *and*, ``infinitive`` after a modal verb."""
    within: Literal["", "place", "aside"]
    """Phrase whose nouns are not the subject: a place, or an aside after a comma; empty outside both."""
    mood: Literal["open", "statement", "command"]
    """Kind of the last clause with a verb; ``open`` before the first one."""


START = Clause("cut", "none", "verb", "", "open")


@dataclass(frozen=True, slots=True)
class Tagging:
    """Classes of the words of a sentence, with the logarithm of their unnormalised probability."""

    classes: tuple[WordClass, ...]
    score: float
    tried: frozenset[int] = frozenset()
    """Words that are verbs in a second reading only."""


class Tagger:
    """Finder of the word classes of one sentence.

    Parameters
    ----------
    words
        Words of the sentence.
    nouns
        Nouns of the ontology.
    weights
        Log odds by feature.

    Notes
    -----
    The model is a conditional random field (Lafferty, McCallum and Pereira 2001). Its states hold the class of the last
    word, the number of the subject, and the verbs that the clause still awaits. The best sequence is found by Viterbi's
    algorithm.
    """

    def __init__(self, words: list[Word], nouns: KnownNouns, weights: Mapping[str, float] = WEIGHTS) -> None:
        self._words, self._nouns, self._weights = words, nouns, weights
        self._norms = [word.norm for word in words] + [""] * 4
        self.possible = [*possible_classes(words, self._norms, nouns), (Possible("cut"),)]
        self._following = [_following(self._norms, at + 1) for at in range(len(words) + 1)]
        self._place_later = self._places()
        self._local = [
            [self.features(at, possible) for possible in classes] for at, classes in enumerate(self.possible)
        ]

    def best(self, required: Mapping[int, frozenset[WordClass]] | None = None) -> Tagging:
        """Return the best sequence of classes.

        Parameters
        ----------
        required
            Classes of which a word must have one, by index.

        Returns
        -------
        Tagging
            One class for each word.
        """
        get = self._weights.get
        front: dict[Clause, float] = {START: 0.0}
        trail: list[dict[Clause, tuple[Clause, WordClass]]] = []
        for at, classes in enumerate(self.possible):
            allowed = None if required is None else required.get(at)
            after: dict[Clause, float] = {}
            back: dict[Clause, tuple[Clause, WordClass]] = {}
            for possible, features in zip(classes, self._local[at], strict=True):
                if allowed is not None and possible.word_class not in allowed:
                    continue
                local = sum(get(feature, 0.0) for feature in features)
                for clause, score in front.items():
                    following, joint = self.step(clause, possible.word_class, at)
                    total = score + local
                    for feature in joint:
                        total += get(feature, 0.0)
                    if following not in after or total > after[following]:
                        after[following] = total
                        back[following] = clause, possible.word_class
            front = after
            trail.append(back)
        clause = max(front, key=front.__getitem__)
        score = front[clause]
        found: list[WordClass] = []
        for back in reversed(trail):
            clause, word_class = back[clause]
            found.append(word_class)
        return Tagging(tuple(found[:0:-1]), score)

    def second_best(self, best: Tagging) -> Iterator[Tagging]:
        """Yield the best sequences in which a noun of the best one is a verb, the most probable first.

        Parameters
        ----------
        best
            The best sequence.

        Yields
        ------
        Tagging
            Sequence whose score is at most ``MAX_LOSS`` below that of the best one.
        """
        found: dict[tuple[WordClass, ...], Tagging] = {}
        for at, word_class in enumerate(best.classes):
            verbs = frozenset(possible.word_class for possible in self.possible[at]) & FINITE
            if word_class not in NOMINAL or not verbs:
                continue
            other = self.best({at: verbs})
            tried = frozenset(
                i for i, one in enumerate(other.classes) if one in FINITE and best.classes[i] not in VERBAL
            )
            if best.score - other.score <= MAX_LOSS:
                found.setdefault(other.classes, Tagging(other.classes, other.score, tried))
        yield from sorted(found.values(), key=lambda tagging: -tagging.score)[:MAX_SECOND_READINGS]

    def features(self, at: int, possible: Possible) -> tuple[str, ...]:
        """Return the features of a class of a word that do not depend on the classes of other words.

        Parameters
        ----------
        at
            Index of the word.
        possible
            Class of the word.

        Returns
        -------
        tuple of str
            Keys of the weights; none for a word with one class only.
        """
        column = _COLUMNS.get(possible.word_class)
        if len(self.possible[at]) == 1 or column is None:
            return possible.priors if len(self.possible[at]) > 1 else ()
        norm, following = self._norms[at], self._following[at]
        after = self._norms[at + 1]
        found = [*possible.priors, f"{column} before {following}"]
        if possible.word_class == "noun":
            if at and self._norms[at - 1].isalpha() and self._nouns.knows(f"{self._norms[at - 1]} {norm}"):
                found.append("known compound ends")
            if after.isalpha() and self._nouns.knows(f"{norm} {after}"):
                found.append("known compound begins")
            if at and self._words[at].text[:1].isupper() and self._words[at - 1].text[:1].islower():
                found.append("capital within a sentence")
            if (agreement := self._agreement_before(at)) is not None:
                found.append(agreement)
        if possible.word_class == "ing" and following == "word":
            named = self._words[at + 1].text[:1].isupper()
            known = "a name" if named else "a known noun" if self._nouns.knows(after) else "an unknown noun"
            found.append(f"-ing before {known}")
        return tuple(found)

    def step(self, clause: Clause, word_class: WordClass, at: int) -> tuple[Clause, Sequence[str]]:
        """Return the state of the clause after a word, and the features that depend on the state before.

        Parameters
        ----------
        clause
            State before the word.
        word_class
            Class of the word.
        at
            Index of the word.

        Returns
        -------
        tuple of Clause and sequence of str
            State after the word, and keys of the weights.
        """
        if word_class == "adverb":
            alone = clause.before == "determiner" and self._norms[at] not in DEGREE_ADVERBS
            return (clause._replace(before="pronoun") if alone else clause), ()  # 'both never touch'
        before, subject, awaits, within, mood = clause
        found: list[str] = []
        column = _COLUMNS.get(word_class)
        if column is not None and (len(self.possible[at]) > 1 or (at and len(self.possible[at - 1]) > 1)):
            governs = before == "preposition" and self._norms[at - 1] in ("of", "by")
            row = self._norms[at - 1] if governs else _ROWS.get(before, before)
            found.append(f"{column} after {row}")
            if column == "noun" and before == "noun" and self._number(at - 1, "noun") == "several":
                found.append("noun after a plural")
        if word_class == "cut":
            if awaits == "infinitive" or (awaits == "verb" and subject != "none"):
                found.append(f"{awaits} missing")
            return Clause("cut", "none", "verb", "", mood), found
        if word_class in ("comma", "conjunction"):
            counts = subject in ("one", "several")
            if word_class == "comma":
                within = "aside" if counts and awaits == "verb" else ""
            elif counts and awaits != "nothing" and within != "place" and before != "comma":
                subject, within = ("several" if within else "joined"), ""
            return Clause(word_class, subject, "perhaps" if awaits == "nothing" else awaits, within, mood), found
        if word_class == "subordinate" and within == "aside" and before == "comma" and awaits == "verb":
            return Clause(word_class, subject, "two verbs", within, mood), found  # 'the fork, if you need it, rests …'
        if word_class == "subordinate":
            return Clause(word_class, "none", "verb", "", mood), found
        if word_class == "relative":
            of_noun = self._number(at - 1, "noun") if before == "noun" else "unknown"
            owned = self._norms[at] == "whose"
            more: Awaited = "verb" if awaits in ("nothing", "perhaps") else "two verbs"
            return Clause("determiner" if owned else word_class, of_noun, more, "", mood), found
        if word_class in ("preposition", "place"):
            within = within if within == "aside" else "place" if word_class == "preposition" else ""
            return Clause(word_class, subject, awaits, within, mood), found
        if word_class in ("determiner", "pronoun", "noun"):
            if word_class != "noun" and before in ("noun", "pronoun", "adjective") and within == "place":
                within = ""
            if word_class != "determiner" and not within and awaits not in ("nothing", "infinitive"):
                subject = "several" if subject == "joined" else self._number(at, word_class)
            return Clause(word_class, subject, awaits, within, mood), found
        if word_class in FINITE or word_class in ("be", "modal"):
            return self._after_verb(clause, word_class, at, found), found
        return Clause(word_class, subject, awaits, "" if word_class in VERBAL else within, mood), found

    def _after_verb(self, clause: Clause, word_class: WordClass, at: int, found: list[str]) -> Clause:
        """Return the state after a verb, and add its features."""
        before, subject, awaits, within, mood = clause
        if word_class == "base" and (awaits == "infinitive" or before == "to"):
            found.append("infinitive")
            return Clause("base", subject, "nothing" if awaits == "infinitive" else awaits, "", mood)
        if awaits == "nothing":
            found.append("second verb of a clause")
        if awaits == "infinitive" and word_class in ("third", "past"):
            found.append("finite verb after a modal verb")
        if word_class in ("third", "base"):
            begins = before in ("cut", "comma", "conjunction", "subordinate")
            if word_class == "base" and begins:
                place = f"{before} within a {mood}" if before in ("comma", "conjunction") else _ROWS.get(before, before)
                found.append(f"command, {place}{'' if subject == 'none' else ', after a subject'}")
                found.append(f"command before {self._following[at]}")
                if self._following[at] in ("place", "end", "joint") and self._norms[at] in NAMED_LIKE_THINGS:
                    found.append("command like a thing without an object")
                if self._place_later[at] and self._following[at] in _OBJECTS and self._norms[at] in verb_forms():
                    found.append("command with an object and a place")
            else:
                found += (_agreement(word_class, subject, within), *self._complement(at))
        if word_class in ("third", "past") and before in ("comma", "conjunction"):
            found.append(f"finite verb after a joint, within a {mood}")
        if self._norms[at] in SAYING | REPORTS:
            return Clause("subordinate", "none", "verb", "", mood)
        helps = word_class == "modal" or self._norms[at] in _CAUSATIVE
        left: Awaited = "infinitive" if helps else "verb" if awaits == "two verbs" else "nothing"
        commands = word_class == "base" and (subject == "none" or before in ("cut", "comma", "conjunction"))
        mood = "command" if commands else "statement" if mood == "open" else mood
        return Clause(word_class, subject, left, "", mood)

    def _places(self) -> list[bool]:
        """Return for each word whether a preposition stands in its clause after the next word."""
        found = [False] * len(self.possible)
        for at in range(len(self._words) - 1, 0, -1):
            place = any(possible.word_class in ("preposition", "place") for possible in self.possible[at])
            ends = self.possible[at][0].word_class in ("cut", "subordinate", "relative") or self._norms[at] in IS_FORMS
            found[at - 1] = not ends and (found[at] or place)
        return [*found[1:], False]

    def _agreement_before(self, at: int) -> str | None:
        """Return whether a noun has the number that a determiner or a number before it asks for."""
        several = self._number(at, "noun") == "several"
        for norm in reversed(self._norms[max(0, at - MAX_MODIFIERS) : at]):
            if norm in _OF_ONE:
                return "plural after a determiner of one" if several else None
            if NUMBERS.get(norm, 1) > 1 or norm in _OF_SEVERAL or (norm.isdigit() and norm != "1"):
                return "plural after a number" if several else "singular after a number"
            if not norm.isalpha() or norm in closed_words():
                break
        return None

    def _complement(self, at: int) -> tuple[str, ...]:
        """Return whether the word after a verb of a statement is one that its kind asks for."""
        form, following = verb_forms().get(self._norms[at]), self._following[at]
        if form is None:
            return (f"unknown verb before {following}",)
        if form.kind == "transitive":
            return ("object after a transitive verb",) if following in _OBJECTS else ()
        if form.kind in _SPATIAL:
            return ("place after a verb of place",) if following in ("place", "adverb", "to") else ()
        return ("place after another verb",) if following == "place" else ()

    def _number(self, at: int, word_class: WordClass) -> Literal["one", "several"]:
        norm = self._norms[at]
        if word_class == "noun":
            return "several" if norm[:1].isalpha() and self._nouns.singular(norm)[1] else "one"
        return "several" if norm in _PLURALS or NUMBERS.get(norm, 1) > 1 else "one"


def _agreement(word_class: WordClass, subject: str, within: str) -> str:
    """Return the feature for the number of a verb and of its subject."""
    if subject == "none":
        return "verb after a place only" if within == "place" else "verb without a subject"
    agrees = subject == "unknown" or (subject == "one") == (word_class == "third")
    return "verb agrees" if agrees else "verb disagrees"


def _following(norms: list[str], at: int) -> str:
    """Return the kind of a word, as far as the word alone tells it, for the class of the word before it."""
    norm = norms[at]
    for kind, words in _KINDS:
        if norm in words:
            return kind
    if norm[0].isdigit():
        return "digits"
    if norm in prepositions() or norm in places_alone() or (norm, norms[at + 1]) in _POSES:
        return "place"
    if norm in ADVERBS or norm in HEDGES or norm in NEGATIONS:
        return "adverb"
    if is_adjective(norm):
        return "adjective"
    form = verb_forms().get(norm)
    if norm.endswith("ed") or (form is not None and form.form == "participle"):
        return "participle"
    return "word" if form is None or form.form not in ("base", "s") else "verb or noun"


_COLUMNS: dict[WordClass, str] = {
    "noun": "noun", "third": "finite", "past": "finite", "base": "base", "participle": "participle", "ing": "ing",
    "adjective": "adjective", "determiner": "determiner", "pronoun": "pronoun", "modal": "modal",
}  # fmt: skip
"""Classes between which the words beside decide."""

_ROWS: dict[WordClass, str] = {
    "cut": "start", "comma": "joint", "conjunction": "joint", "genitive": "determiner", "third": "verb", "past": "verb",
    "base": "verb",
}  # fmt: skip
"""Classes that count as the same for the word after them."""

_KINDS: tuple[tuple[str, frozenset[str]], ...] = (
    ("colon", frozenset({":"})),
    ("end", word_set(". ; ! ? - \u2013 \u2014 \u2026") | {""}),
    ("joint", word_set(", ( ) [ ] / and or nor but plus then yet")),
    ("be", IS_FORMS | MODALS.keys() | word_set("do does did")),
    ("pronoun", word_set("it them you me us they he she we i him")),
    ("relative", word_set("that which who whose whom")),
    ("determiner", ARTICLES | POSSESSIVES.keys() | DETERMINERS | NUMBERS.keys()),
    ("of", frozenset({"of"})),
    ("to", frozenset({"to"})),
    ("there", frozenset({"there"})),
    ("place", word_set("left right next")),
    ("joint", word_set("if when because while although though unless whether so where how why whenever wherever than")),
)
"""Kinds of words that the word alone tells; the first one that has the word counts."""

_POSES = frozenset({("side", "by"), ("face", "down"), ("upside", "down"), ("face", "up")})
"""Beginnings of phrases that stand after a verb as a place does."""

_OBJECTS = frozenset({"determiner", "pronoun", "digits", "adjective", "word", "verb or noun"})
"""Kinds of words that begin an object."""

_SPATIAL = frozenset({"posture", "lean", "face", "point"})
"""Kinds of verbs that a place follows."""

MAX_MODIFIERS = 4
"""Maximum number of words between a noun and the determiner that it agrees with."""

_OF_ONE = word_set("a an one this that each every another")

_OF_SEVERAL = word_set("these those several many few both")

_CAUSATIVE = word_set("let lets letting")
"""Verbs with a noun phrase and an infinitive after them: *let the ivy trail over the rim*."""

_PLURALS = PLURAL_PRONOUNS | word_set("i you many few several most some")
"""Pronouns with a verb in the plural."""
