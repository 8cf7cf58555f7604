"""Say facts in plain English, in short clauses."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass

from deixis.grammar.english.telling.wording import (
    SUPERLATIVES,
    Namer,
    auxiliary,
    clause_of_claim,
    listed,
    name_plainly,
    said_of_claim,
    said_of_fact,
)
from deixis.grammar.reading import StatedFact, joined_choices
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact
from deixis.ontology.inflection import is_plural, plural


def paraphrase(facts: Sequence[StatedFact], surface: str = "table", name: Namer = name_plainly) -> str:
    """Return a plain paraphrase of facts; empty for none.

    What is so of several things is said in one clause.

    Parameters
    ----------
    facts
        Facts and claims of one sentence; the alternatives of a choice are joined into one clause.
    surface
        Noun of what everything stands on, for claims without an object.
    name
        Function that names objects.

    Returns
    -------
    str
        One sentence, with semicolons between its clauses.

    Examples
    --------
    >>> claim = Claim("corner", ("lamp",), value="far left")
    >>> paraphrase([StatedFact(claim, 0, (0, 4))], "desk")
    'The lamp is in the far left corner of the desk.'
    """
    clauses: dict[Hashable, _Clause] = {}
    for fact in joined_choices(facts):
        clause = _clause(fact, surface, name)
        known = clauses.setdefault(clause.key(), clause)
        known.subjects += [subject for subject in clause.subjects if subject not in known.subjects]
    text = "; ".join(clause.words() for clause in clauses.values())
    return f"{text[0].upper()}{text[1:]}." if text else ""


def _named(names: Sequence[str], name: Namer) -> str:
    """Name objects with articles; three or more of a group with consecutive numbers are *the cups 1 to 3*."""
    runs: list[list[tuple[str, int]]] = []
    for one in names:
        stem, _, number = one.rpartition("_")
        numbered = (stem or one, int(number) if stem and number.isdecimal() else 0)
        goes_on = bool(runs) and numbered[1] > 1 and runs[-1][-1] == (numbered[0], numbered[1] - 1)
        runs = [*runs[:-1], [*runs[-1], numbered]] if goes_on else [*runs, [numbered]]
    phrases, place = [], 0
    for run in runs:
        stem = plural(run[0][0].replace("_", " "))
        several = f"the {stem} {run[0][1]} to {run[-1][1]}"
        phrases += [several] if len(run) > 2 else [name([one]) for one in names[place : place + len(run)]]
        place += len(run)
    return listed(phrases)


@dataclass(slots=True)
class _Clause:
    """A clause of a paraphrase; ``shared`` is True if what it says holds of each of its subjects alone."""

    stated: StatedFact
    name: Namer
    subjects: list[str]
    predicate: str
    denied: bool
    shared: bool

    def key(self) -> Hashable:
        """Return what two clauses share if one clause can state both."""
        content = self.stated.content
        qualified = (self.stated.condition, self.stated.past, self.stated.uncertain, content.optional, content.weight)
        subjects = () if self.shared else (content,)
        return self.predicate, self.denied, qualified, self.stated.alternative, subjects

    def words(self) -> str:
        """Return the clause without a capital letter and a full stop."""
        plural = len(self.subjects) > 1 or is_plural(self.subjects[0])
        be = auxiliary(self.stated, plural) + (" not" if self.denied else "")
        content = self.stated.content
        text = f"{_named(self.subjects, self.name)} {be} {self.predicate}"
        if isinstance(content, Claim) and not self.predicate:
            text = clause_of_claim(content, be, self.name)
        condition = self.stated.condition
        return f"{condition[0].lower()}{condition[1:]}, {text}" if condition else text


def _clause(stated: StatedFact, surface: str, name: Namer) -> _Clause:
    content = stated.content
    if isinstance(content, Fact):
        subject, predicate = said_of_fact(content, name)
        denied = not content.positive and len(content.relations) == 1
        return _Clause(stated, name, [subject], predicate, denied, stated.alternative is None)
    predicate = said_of_claim(content, surface, name) or ""
    shared = len(content.subjects) == 1 and bool(predicate) and stated.alternative is None
    shared = shared and content.relation not in SUPERLATIVES | {"ordinal", "kind"}
    return _Clause(stated, name, list(content.subjects), predicate, not content.positive, shared)
