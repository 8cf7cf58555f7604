"""Words for single facts and claims: English predicates that the reader reads as the same facts."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from deixis.grammar.reading import StatedFact
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact
from deixis.ontology.inflection import is_plural, plural
from deixis.ontology.relations.relation import Relation
from deixis.ontology.tbox import default_ontology

RELATION_WORDS = {
    "top": "farther from you than", "bottom": "nearer to you than", "stacked": "stacked upon",
    "closer": "closer to", "farther": "farther from", "nearest": "nearest to", "farthest": "farthest from",
    "pointing": "pointing to", "each_side": "on each side of", "distance": "from", "distance_less": "from",
    "distance_more": "from",
}  # fmt: skip
"""Words for a relation whose phrase in the layout language means something else in English, or nothing."""

INVERSE_WORDS = {
    "containing": "inside", "crossed_by": "across", "faced_by": "facing", "leaned_on_by": "leaning",
    "less_long": "longer", "pointed_at_by": "pointing", "ringed_by": "around", "stacked_under": "stacked",
}  # fmt: skip
"""Relations that are stated by the inverse: *the ball is inside the box* for *containing(box, ball)*."""

HEDGES = (("usually", 0.8), ("probably", 0.7), ("perhaps", 0.5), ("rarely", 0.2))
"""Words for the weight of a fact."""

SUPERLATIVES = frozenset({"tallest", "largest", "smallest", "shortest", "longest", "widest", "thickest", "thinnest"})
PROPERTIES = frozenset({"colour", "size", "shape", "material", "state", "height", "length", "width", "thickness"})

Namer = Callable[[Sequence[str]], str]
"""Function that names objects: ``["fork", "cup"]`` as *the fork and the cup*."""


def name_plainly(names: Sequence[str]) -> str:
    """Name objects by their names with articles.

    Parameters
    ----------
    names
        Names in the layout language, at least one.

    Returns
    -------
    str
        Names with *the*, joined by commas and *and*.

    Examples
    --------
    >>> name_plainly(["fork", "wine_glass", "cup"])
    'the fork, the wine glass and the cup'
    """
    return listed([f"the {name.replace('_', ' ')}" for name in names])


def listed(parts: Sequence[str], last: str = "and") -> str:
    """Join phrases with commas and a conjunction.

    Parameters
    ----------
    parts
        Phrases, at least one.
    last
        Conjunction before the last phrase.

    Returns
    -------
    str
        Joined phrases, without a comma before the conjunction.

    Examples
    --------
    >>> listed(["red", "round", "open"]), listed(["a, b", "c"], "or")
    ('red, round and open', 'a, b or c')
    """
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} {last} {parts[-1]}"


def relation_words(relation: Relation | str) -> str:
    """Return the words of a relation that stand before its object.

    Parameters
    ----------
    relation
        Relation, or its name. A name that the ontology does not have is printed with spaces.

    Returns
    -------
    str
        Words in plain English; *top* is *farther from you than*.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> [relation_words(default_ontology().relations[name]) for name in ("left", "top", "exactly_on", "exactly_bottom")]
    ['left of', 'farther from you than', 'exactly on', 'exactly nearer to you than']
    """
    if isinstance(relation, str) and relation in default_ontology().relations:
        relation = default_ontology().relations[relation]
    name = relation if isinstance(relation, str) else relation.name
    _exact, _, plain = name.rpartition("exactly_")
    if plain in RELATION_WORDS:
        words = RELATION_WORDS[plain]
    else:
        words = name.replace("_", " ") if isinstance(relation, str) else relation.phrase.removeprefix("exactly ")
    return f"exactly {words}" if name != plain else words


def oriented(fact: Fact) -> tuple[str, str, tuple[str, ...]]:
    """Return subject, object and words of the relations of a fact, from the side from which it can be said.

    Parameters
    ----------
    fact
        Fact, which may have several possible relations.

    Returns
    -------
    tuple
        Name of the subject, name of the object, and the words of each relation. Subject and object are exchanged if a
        relation has ``INVERSE_WORDS``.
    """
    if any(relation.name in INVERSE_WORDS for relation in fact.relations):
        relations = default_ontology().relations
        inverses = [relations[INVERSE_WORDS.get(r.name, r.inverse)] for r in fact.relations]
        return fact.object, fact.subject, tuple(relation_words(relation) for relation in inverses)
    return fact.subject, fact.object, tuple(relation_words(relation) for relation in fact.relations)


def said_of_fact(fact: Fact, name: Namer = name_plainly) -> tuple[str, str]:
    """Return the subject of a fact and what is said about it; the alternatives of a denied choice are all denied.

    Parameters
    ----------
    fact
        Fact, which may have several possible relations.
    name
        Function that turns names into a noun phrase.

    Returns
    -------
    tuple of str
        Name of the subject, and the words after *is*, or after *is not* for a denied fact with one relation.
    """
    subject, thing, words = oriented(fact)
    if len(words) == 1:
        return subject, f"{words[0]} {name([thing])}"
    compared = [word.split()[0].endswith("er") or word.startswith("exactly") for word in words]  # not after "either"
    words = tuple(
        word for is_compared in (False, True) for word, c in zip(words, compared, strict=True) if c is is_compared
    )
    parts = [f"{word} {name([thing])}" for word in words]
    if fact.positive:
        return subject, f"{'' if all(compared) else 'either '}{listed(parts, 'or')}"
    if any(compared):
        return subject, listed([f"not {part}" for part in parts])
    return subject, f"neither {listed(parts, 'nor')}"


def said_of_claim(claim: Claim, surface: str = "table", name: Namer = name_plainly) -> str | None:
    """Return what a claim says about its subjects after *is*; None for a claim that needs a clause of its own.

    Parameters
    ----------
    claim
        Claim about one or more subjects.
    surface
        Noun of what everything stands on, for a claim without an object.
    name
        Function that turns names into a noun phrase.

    Returns
    -------
    str or None
        Words after *is* or *are*.
    """
    relation, value = claim.relation, claim.value
    where = name(claim.arguments) if claim.arguments else f"the {surface}"
    if relation.startswith("none_") or relation in ("count", "contents"):
        return None
    if relation == "row" and value and " to " in value and len(claim.subjects) > 1 and claim.positive:
        return None
    match relation:
        case "corner" | "edge" | "end" | "side":
            preposition = {"corner": "in", "side": "on"}.get(relation, "at")
            return f"{preposition} the {f'{value} ' if value else ''}{relation} of {where}"
        case "middle":
            return f"in the middle of {where if value is None else f'the {value} of {where}'}"
        case "part" if value in ("left", "right", "near", "far", "top", "bottom"):
            sides = {"near": "at the front of", "far": "at the back of"}
            if not claim.arguments and value in ("left", "right"):
                return f"on the {value}"
            return f"{sides.get(value, f'at the {value} of')} {where}"
        case "part":
            return f"at the {value} of {where}"
        case "row" | "circle":
            return f"in a {relation}" + (f" {'from ' if ' to ' in value else ''}{value}" if value else "")
        case "distance" | "distance_less" | "distance_more":
            bound = {"distance_less": "less than ", "distance_more": "more than "}.get(relation, "")
            return f"{bound}{100 * (claim.metres or 0):g} cm from {where}"
        case "closer" | "farther" if len(claim.arguments) > 1 or (value and claim.arguments):
            to = f"the {value}" if value else name(claim.arguments[:1])
            return f"{relation_words(relation)} {to} than {name(claim.arguments[-1:])}"
        case "on" if not claim.arguments:
            return f"on the {surface}"
        case "ordinal":
            rank, _, side = (value or "").partition(" from ")
            return f"number {rank}" + (f" from the {side}" if side else "")
        case "kind":
            return f"{'an' if (value or '').strip('`')[:1] in 'aeiou' else 'a'} {value}"
        case "stacked" | "nested" if len(claim.subjects) > 1 or is_plural(claim.subjects[0]):
            return "on top of each other" if relation == "stacked" else "inside each other"
        case "near_each_other" | "parallel_each_other" | "touching_each_other":
            word = relation.removesuffix("_each_other").replace("parallel", "parallel to").replace("_", " ")
            return f"{word} each other"
    if claim.arguments:
        return f"{relation_words(relation)} {where}"
    if relation in SUPERLATIVES:
        return f"the {relation}" + (f" at the {value}" if value else "")
    if value is not None and relation in PROPERTIES:
        return value
    words = relation_words(relation)
    if relation in ("pointing", "facing") and value in ("forward", "backward", "away", "up", "down"):
        return f"{relation} {value}"
    return f"{words} the {value}" if value else words


def clause_of_claim(claim: Claim, be: str, name: Namer = name_plainly) -> str:
    """Return the clause of a claim that cannot be said with *is*: a number, contents, or that nothing is there.

    Parameters
    ----------
    claim
        Claim for which :func:`said_of_claim` returns None.
    be
        Form of *be*, as :func:`auxiliary` returns it.
    name
        Function that turns names into a noun phrase.

    Returns
    -------
    str
        Clause without a capital letter and a full stop.

    Examples
    --------
    >>> clause_of_claim(Claim("count", ("wine_glass_1", "wine_glass_2"), value="2"), "are")
    'there are 2 wine glasses: the wine glass 1 and the wine glass 2'
    """
    subjects = name(claim.subjects)
    if claim.relation.startswith("none_"):
        return f"nothing is {relation_words(claim.relation.removeprefix('none_'))} {subjects}"
    if claim.relation == "contents":
        return f"{subjects} {'holds' if be == 'is' else 'hold' if be == 'are' else f'{be} holding'} {claim.value}"
    if claim.relation == "row":
        return f"from {claim.value}: {subjects}"
    if claim.value == "0":
        return f"there is no {claim.subjects[0].replace('_', ' ')}"
    stems = {name.rpartition("_")[0].replace("_", " ") for name in claim.subjects}
    kind = stems.pop() if len(stems) == 1 else ""
    counted = f"{claim.value} {plural(kind) if kind and claim.value != '1' else kind}".rstrip()
    return f"there {be} {counted}: {subjects}"


def auxiliary(stated: StatedFact, plural: bool = False) -> str:
    """Return the form of *be* for what qualifies a fact: *is*, *can be*, *may be*, *was*, *are usually*.

    Parameters
    ----------
    stated
        Fact or claim with what qualifies it.
    plural
        True for a subject in the plural.

    Returns
    -------
    str
        Verb, with *optionally* for an optional fact and an adverb such as *usually* for a weight below 1.
    """
    content = stated.content
    if stated.past:
        be = "were" if plural else "was"
    elif content.optional and content.weight >= 1 and content.positive and not stated.uncertain:
        return "can be"
    elif (stated.uncertain and content.weight == 0.5) or (stated.alternative is not None and content.optional):
        return "may be"
    else:
        be = "are" if plural else "is"
    optional = content.optional and not stated.uncertain
    hedge = min(HEDGES, key=lambda entry: abs(entry[1] - content.weight))[0] if content.weight < 1 else ""
    return " ".join(filter(None, (be, "optionally" if optional else "", hedge)))
