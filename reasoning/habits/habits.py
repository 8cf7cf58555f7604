"""Learn rules from examples of where a person puts things, and say where other things go.

A habit is a set of rules such as *shoes: rack*. Its description length is a cost for each rule, plus the bits that say
where the examples are, given the rules; the shortest descriptions explain the examples with few rules. What a rule
means is uncertain too: *sneakers, boots: rack* may be about shoes or about clothing. Concepts that cover the same
examples are weighed by the size principle (Tenenbaum and Griffiths 2001): examples of a broad concept would not all
fall into a narrow one by chance. A thing goes to a place with the probability that the rules give, summed over the
short descriptions by their weights.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.tbox import Ontology, default_ontology
from deixis.reasoning.errors import SettingError
from deixis.reasoning.habits.concepts import COSTS, Concept, Concepts

Array = NDArray[np.float64]

RULE_BITS = 2.0
"""Description length of a rule, beside the cost of what it is about."""

EXCEPTION = 0.02
"""Probability that a thing is put somewhere against the rules."""

UNEXPLAINED = 0.5
"""Factor of the probability of an example to which no rule applies, against a guess."""

BY_CHANCE = 1e-4
"""Fit of a thing to a place by mere chance, less than one in the number of all kinds: a fit below it, as by size alone,
decides little."""

SHARPNESS = 2.0
"""Exponent of the probabilities of the places, since the weights of the descriptions alone are too cautious:
cross-validation by scenario chooses 1.9 to 2.2 (``benchmarks/bench_habits.py --sharpness``, with an exponent of 1)."""

LEAST_REASON = 0.25
"""Minimum share of the decision at which the rule behind it is named."""

SMALLEST = 3.0
"""Number added to the size of a concept, since the lexicon lacks some of its kinds."""

MOST_COUNTED = 3
"""Number of examples beyond which further ones do not narrow a rule: a person's examples are not drawn at random."""

BEAM, SLACK = 60, 8.0
"""Descriptions kept in each round of the search; bits above the shortest one up to which a description counts."""

STATED_EXAMPLES = 20
"""Weight of a stated rule, as a number of examples."""


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule of the shortest description: things of a concept go to a place.

    Attributes
    ----------
    concept
        Words for the things.
    place
        Where they go.
    probability
        Share of the weight of all short descriptions that have this rule.
    examples
        Examples that the rule explains; empty for a stated rule without any.
    stated
        Whether a person stated the rule.
    other
        Whether a narrower rule before it is about some of the same things, so that this one is about the others.
    """

    concept: str
    place: str
    probability: float
    examples: tuple[str, ...]
    stated: bool = False
    other: bool = False


@dataclass(frozen=True, slots=True)
class Placement:
    """Place of a thing, with the probabilities of all places.

    Attributes
    ----------
    thing
        The thing.
    place
        The most probable place.
    probability
        Probability of that place.
    alternatives
        Probabilities of all places, most probable first.
    because
        Words of the concept of the rule that decides most; None where no rule applies.
    known
        Whether the lexicon knows the thing.
    """

    thing: str
    place: str
    probability: float
    alternatives: tuple[tuple[str, float], ...]
    because: str | None
    known: bool


@dataclass(frozen=True, slots=True, eq=False)
class _Class:
    """Concepts that cover the same examples, with the probability that a rule about them means each."""

    covered: NDArray[np.bool_]
    concepts: tuple[Concept, ...]
    weights: Array

    def fit(self, concepts: frozenset[Concept]) -> float:
        """Return the probability of drawing a thing with these concepts from those that the rule is about."""
        pairs = zip(self.concepts, self.weights.tolist(), strict=True)
        return math.fsum(weight / (concept.size + SMALLEST) for concept, weight in pairs if concept in concepts)

    @property
    def likeliest(self) -> Concept:
        return self.concepts[int(np.argmax(self.weights))]

    @property
    def least_cost(self) -> float:
        return min(COSTS[concept.aspect] for concept in self.concepts)


class Habits:
    """Rules that explain examples of where a person puts things.

    Parameters
    ----------
    examples
        Places by thing.
    places
        All places, also those without an example; by default those of the examples and the stated rules.
    stated
        Places by the words of a concept: rules that a person stated, which hold against examples.
    ontology
        Words and kinds. By default :func:`deixis.ontology.tbox.default_ontology`.
    deadline
        Time limit; the search ends with the best rules so far.

    Raises
    ------
    SettingError
        If there are neither examples nor rules, or a stated rule names nothing that the lexicon knows.

    Examples
    --------
    >>> habits = Habits({"sneakers": "rack", "boots": "rack", "sweater": "chair", "jeans": "chair"})
    >>> [(rule.concept, rule.place) for rule in habits.rules]
    [('shoes', 'rack'), ('clothing', 'chair')]
    >>> habits.place_of("sandals").place, habits.place_of("hoodie").place
    ('rack', 'chair')
    """

    def __init__(
        self,
        examples: Mapping[str, str],
        places: Sequence[str] = (),
        stated: Mapping[str, str] | None = None,
        ontology: Ontology | None = None,
        deadline: Deadline = Deadline.never(),
    ) -> None:
        stated = stated or {}
        self.examples = dict(examples)
        ordered = dict(sorted(examples.items()))  # so that ties in the search do not follow the order of the examples
        self.places = tuple(dict.fromkeys((*places, *ordered.values(), *stated.values())))
        if not self.places:
            raise SettingError("habits: state at least one example or rule, such as 'sneakers: rack'")
        self._concepts = Concepts(ontology or default_ontology())
        self._known = {thing: self._concepts.of(thing) for thing in ordered}
        self._labels = np.array([self.places.index(place) for place in ordered.values()], dtype=np.int64)
        self._stated = [(self._named(words), self.places.index(place)) for words, place in stated.items()]
        self._classes = self._group_by_examples()
        self._descriptions = self._search(deadline)

    @property
    def rules(self) -> tuple[Rule, ...]:
        """The rules of the shortest description, the narrower ones first: a broad one is about all other things."""
        total = sum(self._descriptions.values())
        found = [(concept, concept.words, place, 1.0, True) for concept, place in self._stated]
        for number, place in self._best:
            meant = self._classes[number].likeliest
            share = sum(weight for chosen, weight in self._descriptions.items() if (number, place) in chosen) / total
            found.append((meant, meant.words, place, float(share), False))
        rules: list[Rule] = []
        taken: set[str] = set()
        for concept, words, place, probability, stated in sorted(found, key=lambda one: (one[0].size, one[1])):
            about = {thing for thing, concepts in self._known.items() if concept in concepts}
            own = tuple(thing for thing in about if self.examples[thing] == self.places[place])
            examples = tuple(thing for thing in self.examples if thing in own)
            rules.append(Rule(words, self.places[place], probability, examples, stated, bool(about & taken - set(own))))
            taken |= about
        return tuple(rules)

    @property
    def exceptions(self) -> tuple[str, ...]:
        """Examples that no rule of the shortest description explains, or that the rules put elsewhere."""
        scores = self._stated_scores()
        for number, place in self._best:
            scores[place] += self._covered_scores(number)
        chosen = scores.argmax(axis=0) if scores.size else self._labels
        wrong = (chosen != self._labels) | ~scores.any(axis=0)
        off = {thing for thing, is_off in zip(self._known, wrong, strict=True) if is_off}
        return tuple(thing for thing in self.examples if thing in off)

    def place_of(self, thing: str) -> Placement:
        """Return where a thing goes.

        An example goes where it was put. For a thing to which no rule applies, all concepts that it shares with
        examples count.

        Parameters
        ----------
        thing
            A noun with or without adjectives: ``wool sweater``.

        Returns
        -------
        Placement
            The most probable place, with the probabilities of all.
        """
        concepts = self._concepts.of(thing)
        known = self._concepts.knows(thing)
        if thing in self.examples:
            place = self.examples[thing]
            return Placement(thing, place, 1.0, ((place, 1.0),), "example", known)
        fits = np.array([meant.fit(concepts) for meant in self._classes])
        fixed = BY_CHANCE + self._stated_fits(concepts)
        similar, total = self._similar(fits), sum(self._descriptions.values())
        found, reasons = np.zeros(len(self.places)), np.zeros(len(self._classes))
        for chosen, weight in self._descriptions.items():
            scores = fixed.copy()
            for number, goal in chosen:
                scores[goal] += fits[number]
            ruled = scores.sum() > BY_CHANCE * len(scores)
            found += weight / total * (_normalised(scores, EXCEPTION) if ruled else similar)
            for number, _ in chosen:
                reasons[number] += weight * fits[number] / scores.sum()
        because = next((concept.words for concept, _ in self._stated if concept in concepts), None)
        if because is None and reasons.max(initial=0.0) >= LEAST_REASON * total:
            because = self._classes[int(reasons.argmax())].likeliest.words
        found = _normalised(found**SHARPNESS, EXCEPTION)
        ranked = tuple((self.places[k], float(found[k])) for k in np.argsort(-found, kind="stable").tolist())
        return Placement(thing, *ranked[0], ranked, because, known)

    def _named(self, words: str) -> Concept:
        concept = self._concepts.named(words)
        if concept is None:
            raise SettingError(f"habits: the rule about '{words}' must name a kind, a group or a description of things")
        return concept

    @property
    def _best(self) -> frozenset[tuple[int, int]]:
        return max(self._descriptions, key=lambda chosen: self._descriptions[chosen])

    def _stated_scores(self) -> Array:
        """Return the scores of the examples by the stated rules, shape (places, examples)."""
        fits = [self._stated_fits(concepts) for concepts in self._known.values()]
        return np.array(fits).reshape(len(fits), len(self.places)).T

    def _stated_fits(self, concepts: frozenset[Concept]) -> Array:
        """Return the scores of the places for a thing by the stated rules, shape (places,)."""
        scores = np.zeros(len(self.places))
        for concept, place in self._stated:
            if concept in concepts:
                scores[place] += STATED_EXAMPLES / (concept.size + SMALLEST) + 1.0
        return scores

    def _covered_scores(self, number: int) -> Array:
        """Return the scores of the examples by a rule about a class, shape (examples,)."""
        meant = self._classes[number]
        sizes = np.array([concept.size + SMALLEST for concept in meant.concepts])
        return meant.covered.astype(np.float64) * float((meant.weights / sizes).sum())

    def _group_by_examples(self) -> tuple[_Class, ...]:
        """Group the concepts of the examples by the examples that they cover."""
        by_cover: dict[tuple[bool, ...], list[Concept]] = {}
        for concept in sorted({concept for concepts in self._known.values() for concept in concepts}):
            covered = tuple(concept in concepts for concepts in self._known.values())
            by_cover.setdefault(covered, []).append(concept)
        found = []
        for covered, concepts in by_cover.items():
            counted = min(sum(covered), MOST_COUNTED)
            bits = np.array([COSTS[c.aspect] + counted * math.log2(c.size + SMALLEST) for c in concepts])
            weights = 2.0 ** (bits.min() - bits)
            found.append(_Class(np.array(covered), tuple(concepts), weights / weights.sum()))
        return tuple(found)

    def _search(self, deadline: Deadline) -> dict[frozenset[tuple[int, int]], float]:
        """Return the short descriptions, each as (class, place) pairs, with their weights.

        A beam search adds one rule at a time; a description costs its rules and the bits of the examples' places.
        """
        rules, scores = [], []
        count = len(self._labels)
        for number, meant in enumerate(self._classes):
            for place in np.unique(self._labels[meant.covered]).tolist():
                rows = np.zeros((len(self.places), count))
                rows[place] = self._covered_scores(number)
                rules.append((number, place))
                scores.append(rows)
        start = self._stated_scores()
        prices = {rule: RULE_BITS + self._classes[rule[0]].least_cost for rule in rules}
        priced = np.array([prices[rule] for rule in rules])
        added = np.array(scores).reshape(len(rules), len(self.places), count)
        costs = {frozenset[tuple[int, int]](): float(self._bits(start))}
        front = [(frozenset[tuple[int, int]](), start)]
        for size in range(1, count + 2):
            reached: dict[frozenset[tuple[int, int]], tuple[float, Array, int]] = {}
            for chosen, total in front:
                bits = sum(prices[rule] for rule in chosen) + priced + self._bits(total + added)
                for k, rule in enumerate(rules):
                    wider = chosen | {rule}
                    if len(wider) == size and wider not in reached:
                        reached[wider] = float(bits[k]), total, k
            best = sorted(reached, key=lambda wider: reached[wider][0])[:BEAM]
            if not best or reached[best[0]][0] > min(costs.values()) + SLACK or deadline.passed:
                break
            costs.update({wider: reached[wider][0] for wider in best})
            front = [(wider, reached[wider][1] + added[reached[wider][2]]) for wider in best]
        least = min(costs.values())
        return {chosen: 2.0 ** (least - bits) for chosen, bits in costs.items() if bits < least + SLACK}

    def _bits(self, scores: Array) -> Array:
        """Return the bits that say where the examples are, for scores of shape (…, places, examples)."""
        guess = 1.0 / len(self.places)
        totals = scores.sum(axis=-2)
        own = np.take_along_axis(scores, np.broadcast_to(self._labels, (*scores.shape[:-2], 1, len(self._labels))), -2)
        share = own[..., 0, :] / np.where(totals > 0, totals, 1.0)
        likely = np.where(totals > 0, (1 - EXCEPTION) * share + EXCEPTION * guess, UNEXPLAINED * guess)
        bits: Array = -np.log2(likely).sum(axis=-1)
        return bits

    def _similar(self, fits: Array) -> Array:
        """Return the probabilities of the places by all concepts that a thing shares with examples."""
        scores = np.full(len(self.places), BY_CHANCE)
        for meant, fit in zip(self._classes, fits.tolist(), strict=True):
            if fit:
                inside = np.bincount(self._labels[meant.covered], minlength=len(self.places))
                scores += fit * inside / inside.sum()
        return _normalised(scores, EXCEPTION)


def _normalised(scores: Array, exception: float) -> Array:
    total = scores.sum()
    guess = np.full(len(scores), 1.0 / len(scores))
    shares: Array = guess if total <= 0 else (1 - exception) * scores / total + exception * guess
    return shares
