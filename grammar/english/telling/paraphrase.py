"""Say facts in plain English, one short clause for each."""

from __future__ import annotations

from collections.abc import Sequence

from deixis.grammar.english.telling.wording import (
    auxiliary,
    clause_of_claim,
    name_plainly,
    said_of_claim,
    said_of_fact,
)
from deixis.grammar.reading import StatedFact, joined_choices
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact
from deixis.ontology.inflection import is_plural


def paraphrase(facts: Sequence[StatedFact], surface: str = "table") -> str:
    """Return a plain paraphrase of facts, a clause for each; empty for none.

    Parameters
    ----------
    facts
        Facts and claims of one sentence; the alternatives of a choice are joined into one clause.
    surface
        Noun of what everything stands on, for claims without an object.

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
    clauses = list(dict.fromkeys(_clause(fact, surface) for fact in joined_choices(facts)))
    said = "; ".join(clauses)
    return f"{said[0].upper()}{said[1:]}." if said else ""


def _clause(stated: StatedFact, surface: str) -> str:
    content = stated.content
    if isinstance(content, Fact):
        subject, predicate = said_of_fact(content)
        subjects: tuple[str, ...] = (subject,)
        denied = not content.positive and len(content.relations) == 1
    else:
        subjects, predicate, denied = content.subjects, said_of_claim(content, surface) or "", not content.positive
    be = auxiliary(stated, plural=len(subjects) > 1 or is_plural(subjects[0])) + (" not" if denied else "")
    said = f"{name_plainly(subjects)} {be} {predicate}"
    if isinstance(content, Claim) and not predicate:
        said = clause_of_claim(content, be)
    if stated.condition:
        return f"{stated.condition[0].lower()}{stated.condition[1:]}, {said}"
    return said
