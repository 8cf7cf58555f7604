"""Why something about time holds: a tree from the conclusion down to what was stated."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum


class Rule(StrEnum):
    """How a conclusion comes from its premises."""

    STATED = "stated"
    PROPER_INTERVAL = "proper interval"  # a fluent starts before it finishes
    DEFINITION = "definition"  # of Allen's relations by end points (Allen 1983)
    SHORTEST_PATH = "shortest path"  # difference constraints added up (Dechter, Meiri, Pearl 1991)
    NEGATIVE_CYCLE = "negative cycle"  # the same, back to where it began: a contradiction
    ELIMINATION = "elimination"  # all other alternatives of a disjunction are refuted
    INTERSECTION = "intersection"  # of sets of relations that all hold
    CASES = "cases"  # so it is in every alternative
    CASE = "case"  # assumed, within CASES


@dataclass(frozen=True)
class Explanation:
    """A conclusion in words, the rule that gives it, and the explanations of what the rule needs.

    >>> stated = Explanation("a.finish <= 5", Rule.STATED, source="t.json: fluents[0].finish")
    >>> proper = Explanation("a.start < a.finish", Rule.PROPER_INTERVAL)
    >>> print(*Explanation("a.start < 5", Rule.SHORTEST_PATH, (stated, proper)).lines(), sep="\\n")
    a.start < 5   by shortest path
        a.finish <= 5   by stated   [t.json: fluents[0].finish]
        a.start < a.finish   by proper interval
    """

    conclusion: str
    rule: Rule
    premises: tuple[Explanation, ...] = ()
    source: str | None = None

    def stated(self) -> tuple[Explanation, ...]:
        """The stated leaves that it rests on, without repetition, in the order of use."""
        return tuple(
            dict.fromkeys(explanation for explanation, _, _ in self._walk() if explanation.rule is Rule.STATED)
        )

    def lines(self, indent: str = "") -> Iterator[str]:
        """The explanation as indented text, conclusion first; what was explained before is referred to."""
        for explanation, depth, again in self._walk():
            place = f"   [{explanation.source}]" if explanation.source else ""
            above = ", as above" if again and explanation.premises else ""
            yield f"{indent}{'    ' * depth}{explanation.conclusion}   by {explanation.rule}{above}{place}"

    def _walk(self) -> Iterator[tuple[Explanation, int, bool]]:
        """Each explanation in the order of print, its depth, and whether it came before: its premises do not again.

        Explanations share parts, and written out each time they would grow exponentially.
        """
        met: set[int] = set()
        waiting = [(self, 0)]
        while waiting:
            explanation, depth = waiting.pop()
            again = id(explanation) in met
            yield explanation, depth, again
            if not again:
                met.add(id(explanation))
                waiting += [(premise, depth + 1) for premise in reversed(explanation.premises)]
