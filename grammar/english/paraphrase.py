"""Say facts in plain English, one short clause for each."""

from __future__ import annotations

from collections.abc import Sequence

from deixis.grammar.reading import StatedFact
from deixis.ontology.claims import Claim
from deixis.ontology.facts import Fact

PHRASES = {
    "left": "left of", "right": "right of", "in_front": "in front of", "near": "near", "far": "far from",
    "next_to": "next to", "top": "beyond", "bottom": "in front of", "inside": "in", "leaning": "leaning against",
    "bigger": "bigger than", "smaller": "smaller than", "taller": "taller than", "shorter": "shorter than",
    "longer": "longer than", "wider": "wider than", "facing": "facing", "parallel": "parallel to",
    "aligned": "aligned with", "opposite": "opposite", "stacked": "stacked on", "level_with": "level with",
    "closer": "closer to", "farther": "farther from", "nearest": "nearest to", "farthest": "farthest from",
    "pointing": "pointing to", "distance": "away from", "distance_less": "away from at most",
    "distance_more": "away from at least",
}  # fmt: skip
"""Words for a relation where its name with blanks does not do."""


def paraphrase(facts: Sequence[StatedFact], surface: str = "table") -> str:
    """Return a plain paraphrase of facts, a clause for each; empty for none.

    >>> claim = Claim("corner", ("lamp",), value="far left")
    >>> paraphrase([StatedFact(claim, 0, (0, 4))], "desk")
    'The lamp is in the far left corner of the desk.'
    """
    clauses = list(dict.fromkeys(_clause(fact, surface) for fact in facts))
    said = "; ".join(clauses)
    return f"{said[0].upper()}{said[1:]}." if said else ""


def _clause(stated: StatedFact, surface: str) -> str:
    content = stated.content
    be = "was" if stated.past else "may be" if stated.uncertain or content.optional else "is"
    if content.weight < 1 and not (stated.uncertain or content.optional):
        be = "is probably" if content.weight >= 0.5 else "is rarely"
    if not content.positive:
        be += " not"
    subjects = (content.subject,) if isinstance(content, Fact) else content.subjects
    if len(subjects) == 1 and _is_plural(subjects[0]):
        be = be.replace("is", "are").replace("was", "were")
    said = _fact(content, be) if isinstance(content, Fact) else _claim(content, be, surface)
    if stated.condition:
        return f"{stated.condition[0].lower()}{stated.condition[1:]}, {said}"
    return said


def _fact(fact: Fact, be: str) -> str:
    words = " or ".join(PHRASES.get(relation.name, relation.phrase) for relation in fact.relations)
    return f"{_the(fact.subject)} {be} {words} {_the(fact.object)}"


def _claim(claim: Claim, be: str, surface: str) -> str:
    relation, value = claim.relation, claim.value
    subject = _all(claim.subjects)
    if len(claim.subjects) > 1:
        be = be.replace("is", "are").replace("was", "were")
    where = _all(claim.arguments) if claim.arguments else f"the {surface}"
    if relation.startswith("none_"):
        word = relation.removeprefix("none_")
        return f"nothing is {PHRASES.get(word, word.replace('_', ' '))} {subject}"
    match relation:
        case "count":
            return (
                f"there is no {claim.subjects[0].replace('_', ' ')}"
                if value == "0"
                else f"there {be} {value}: {subject}"
            )
        case "corner" | "edge" | "end" | "side":
            preposition = "in" if relation == "corner" else "at"
            return f"{subject} {be} {preposition} the {f'{value} ' if value else ''}{relation} of {where}"
        case "middle":
            return f"{subject} {be} in the middle of {where if value is None else f'the {value} of {where}'}"
        case "part":
            return f"{subject} {be} at the {value} of {where}"
        case "contents":
            return f"{subject} {'holds' if be == 'is' else f'{be} holding'} {value}"
        case "row" | "circle":
            order = f", {value}" if value else ""
            return f"{subject} {be} in a {relation}{order}"
        case "distance" | "distance_less" | "distance_more":
            bound = PHRASES[relation].replace("away from", "").strip()
            return " ".join(f"{subject} {be} {bound} {100 * (claim.metres or 0):g} cm from {where}".split())
        case "closer" | "farther" if claim.arguments:
            to = f"the {value}" if value else _the(claim.arguments[0])
            return f"{subject} {be} {PHRASES[relation]} {to} than {_the(claim.arguments[-1])}"
        case "between":
            return f"{subject} {be} between {_all(claim.arguments)}"
        case "on" if not claim.arguments:
            return f"{subject} {be} on the {surface}"
        case "ordinal":
            return f"{subject} {be} number {value}"
        case "kind":
            return f"{subject} {be} a {value}"
    if claim.arguments:
        return f"{subject} {be} {PHRASES.get(relation, relation.replace('_', ' '))} {_all(claim.arguments)}"
    if relation in ("tallest", "largest", "smallest", "shortest", "longest", "widest"):
        return f"{subject} {be} the {relation}" + (f" at the {value}" if value else "")
    word = relation.replace("_", " ")
    if value is not None and relation in ("colour", "size", "shape", "material", "state", "height", "length", "width"):
        return f"{subject} {be} {value}"
    return f"{subject} {be} {PHRASES.get(relation, word)}" + (f" the {value}" if value else "")


def _is_plural(name: str) -> bool:
    """Return True for a name that ends in a plural noun, such as ``milk_cups`` and ``tongs``."""
    return name.endswith("s") and not name.endswith(("ss", "us", "is", "as"))


def _the(name: str) -> str:
    return f"the {name.replace('_', ' ')}"


def _all(names: Sequence[str]) -> str:
    said = [_the(name) for name in names]
    return said[0] if len(said) == 1 else f"{', '.join(said[:-1])} and {said[-1]}"
