"""The rules of OWL 2 RL whose premises are lists: what an axiom with a whole list says, member by member.

Source: OWL 2 Profiles, section 4.3: ``cls-int1``, ``cls-int2``, ``cls-uni``, ``cls-oo``, ``scm-int``, ``scm-uni``,
``prp-spo2``, ``prp-key``, ``prp-adp``, ``cax-adc``, ``eq-diff2``, ``eq-diff3``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations

from deixis.reasoning.owl.terms import DISTINCT_MEMBERS, MEMBERS, SAME_AS, SUB_CLASS_OF, TYPE, term
from deixis.reasoning.owl_rl.facts import Fact, FactIndex
from deixis.reasoning.owl_rl.rules import TermAtom, TextRule

Expansion = Callable[[str, Sequence[str]], Iterator[TextRule]]
"""From the node that has a list, and the list's members, to rules without lists."""


def _rule(name: str, body: Sequence[TermAtom], head: TermAtom | None) -> TextRule:
    return TextRule(name, (), tuple(body), head)


def _intersection(node: str, members: Sequence[str]) -> Iterator[TextRule]:
    yield _rule("cls-int1", [("?x", TYPE, member) for member in members], ("?x", TYPE, node))
    for member in members:
        yield _rule("cls-int2", [("?x", TYPE, node)], ("?x", TYPE, member))
        yield _rule("scm-int", [], (node, SUB_CLASS_OF, member))


def _union(node: str, members: Sequence[str]) -> Iterator[TextRule]:
    for member in members:
        yield _rule("cls-uni", [("?x", TYPE, member)], ("?x", TYPE, node))
        yield _rule("scm-uni", [], (member, SUB_CLASS_OF, node))


def _one_of(node: str, members: Sequence[str]) -> Iterator[TextRule]:
    for member in members:
        yield _rule("cls-oo", [], (member, TYPE, node))


def _chain(node: str, members: Sequence[str]) -> Iterator[TextRule]:
    steps = [(f"?{i}", member, f"?{i + 1}") for i, member in enumerate(members)]
    yield _rule("prp-spo2", steps, ("?0", node, f"?{len(members)}"))


def _key(node: str, members: Sequence[str]) -> Iterator[TextRule]:
    alike = [(who, member, f"?{i}") for i, member in enumerate(members) for who in ("?x", "?y")]
    yield _rule("prp-key", [("?x", TYPE, node), ("?y", TYPE, node), *alike], ("?x", SAME_AS, "?y"))


def _disjoint_classes(node: str, members: Sequence[str]) -> Iterator[TextRule]:
    for one, other in combinations(members, 2):
        yield _rule("cax-adc", [("?x", TYPE, one), ("?x", TYPE, other)], None)


def _disjoint_properties(node: str, members: Sequence[str]) -> Iterator[TextRule]:
    for one, other in combinations(members, 2):
        yield _rule("prp-adp", [("?x", one, "?y"), ("?x", other, "?y")], None)


def _different(name: str) -> Expansion:
    def expand(node: str, members: Sequence[str]) -> Iterator[TextRule]:
        for one, other in combinations(members, 2):
            yield _rule(name, [] if one == other else [(one, SAME_AS, other)], None)

    return expand


EXPANSIONS: dict[tuple[str, str | None], Expansion] = {
    (term("owl:intersectionOf"), None): _intersection,
    (term("owl:unionOf"), None): _union,
    (term("owl:oneOf"), None): _one_of,
    (term("owl:propertyChainAxiom"), None): _chain,
    (term("owl:hasKey"), None): _key,
    (MEMBERS, term("owl:AllDisjointClasses")): _disjoint_classes,
    (MEMBERS, term("owl:AllDisjointProperties")): _disjoint_properties,
    (MEMBERS, term("owl:AllDifferent")): _different("eq-diff2"),
    (DISTINCT_MEMBERS, term("owl:AllDifferent")): _different("eq-diff3"),
}
"""By the predicate that leads to the list and, where it takes one, the type of the node that has it."""


def list_members(
    index: FactIndex, head: int, first: int, rest: int, nil: int
) -> tuple[list[int], tuple[Fact, ...]] | None:
    """The members of a list and the facts that make it; None where it is not whole, or a ring."""
    members, links, seen = [], [], set()
    while head != nil:
        member = min(index.objects(head, first), default=None)
        tail = min(index.objects(head, rest), default=None)
        if member is None or tail is None or head in seen:
            return None
        seen.add(head)
        members.append(member)
        links += [(head, first, member), (head, rest, tail)]
        head = tail
    return members, tuple(links)
