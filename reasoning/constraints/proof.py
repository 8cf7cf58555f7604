"""Proofs: trees from a conclusion down to stated claims, for claims of any type.

The caller decides what a claim is: a fact or an order of edges (:mod:`deixis.reasoning.entailment`), a bound on a time
in words (:mod:`deixis.reasoning.temporal`), or the relation of a pair (:mod:`deixis.reasoning.qualitative.networks`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Generic, TypeVar

from deixis.ontology.graph.graph import Source

Claim = TypeVar("Claim", covariant=True)


class Rule(StrEnum):
    """The rule by which a claim follows from its premises."""

    STATED = "stated"
    CASES = "cases"  # it holds in every case, or every case is refuted
    ASSUMED = "assumed"  # one of the cases
    CONTRADICTION = "contradiction"  # the premises exclude each other
    CONJUNCTION = "conjunction"  # the premises are about one pair, and together imply the claim
    COMPOSITION = "composition"  # the premises' relations are composed, from the first object to the last
    # of relations between objects
    INVERSE = "inverse"  # owl:inverseOf
    SUB_PROPERTY = "sub-property"  # rdfs:subPropertyOf
    TRANSITIVITY = "transitivity"  # owl:TransitiveProperty
    CLAIM = "claim"  # a claim about several objects implies it of two of them
    MEANING = "meaning"  # the premise admits nothing that the conclusion does not
    # of times
    PROPER_INTERVAL = "proper interval"  # a fluent starts before it finishes
    DEFINITION = "definition"  # of Allen's relations by end points (Allen 1983)
    SHORTEST_PATH = "shortest path"  # difference constraints added up (Dechter, Meiri, Pearl 1991)
    NEGATIVE_CYCLE = "negative cycle"  # difference constraints around a cycle that add up to a contradiction
    ELIMINATION = "elimination"  # all other alternatives of a disjunction are refuted
    INTERSECTION = "intersection"  # of sets of relations that all hold
    CASE = "case"  # assumed, within CASES


@dataclass(frozen=True)
class Proof(Generic[Claim]):
    r"""A claim, its rule, and the proofs of the premises of the rule.

    >>> stated = Proof("a.finish <= 5", Rule.STATED, source="t.json: fluents[0].finish")
    >>> proper = Proof("a.start < a.finish", Rule.PROPER_INTERVAL)
    >>> print(*Proof("a.start < 5", Rule.SHORTEST_PATH, (stated, proper)).lines(), sep="\n")
    a.start < 5   by shortest path
        a.finish <= 5   stated   [t.json: fluents[0].finish]
        a.start < a.finish   by proper interval
    """

    claim: Claim
    rule: Rule
    premises: tuple[Proof[Claim], ...] = ()
    source: Source | str | None = None

    def leaves(self) -> tuple[Proof[Claim], ...]:
        """Return the stated leaves, without repetition, in the order of use.

        Returns
        -------
        tuple of Proof[Claim]
            The leaves.
        """
        return tuple(dict.fromkeys(proof for proof, _, _ in self._walk() if proof.rule is Rule.STATED))

    def stated(self) -> tuple[Claim, ...]:
        """Return the claims of the stated leaves, without repetition, in the order of use.

        Returns
        -------
        tuple of Claim
            The claims.
        """
        return tuple(dict.fromkeys(leaf.claim for leaf in self.leaves()))

    def size(self) -> int:
        """Return the number of leaves of the tree with shared parts written out each time.

        Returns
        -------
        int
            The number.
        """
        return sum(premise.size() for premise in self.premises) or 1

    def lines(self, indent: str = "") -> Iterator[str]:
        """Yield the proof as indented text, conclusion first; a repeated part refers to its first occurrence.

        Parameters
        ----------
        indent
            Blanks before each line.

        Yields
        ------
        str
            A line.
        """
        for proof, depth, again in self._walk():
            place = f"   [{proof.source}]" if proof.source else ""
            above = ", as above" if again and proof.premises else ""
            rule = proof.rule if proof.rule is Rule.STATED else f"by {proof.rule}"
            yield f"{indent}{'    ' * depth}{proof.claim}   {rule}{above}{place}"

    def _walk(self) -> Iterator[tuple[Proof[Claim], int, bool]]:
        """Yield each proof in the order of print, its depth, and whether it occurred before.

        The premises of a repeated proof are not yielded again: proofs share parts, and would grow exponentially.
        """
        met: set[int] = set()
        waiting: list[tuple[Proof[Claim], int]] = [(self, 0)]
        while waiting:
            proof, depth = waiting.pop()
            again = id(proof) in met
            yield proof, depth, again
            if not again:
                met.add(id(proof))
                waiting += [(premise, depth + 1) for premise in reversed(proof.premises)]
