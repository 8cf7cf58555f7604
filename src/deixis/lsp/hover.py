"""Hover: what a word of a script means, and what follows for the object that it names."""

from __future__ import annotations

from collections.abc import Iterator

from deixis.deadline import Deadline
from deixis.grammar.layout.names import key_of
from deixis.lsp.document import Document, is_object, name_of
from deixis.ontology.graph.facts import Fact
from deixis.ontology.relations.relation import plain_phrase
from deixis.ontology.things.kinds import Kind

HOVER_TIME_LIMIT = 1.0
"""Time limit in seconds for what follows."""
MAX_FACTS_SHOWN = 8


def hover(document: Document, line: int, column: int, time_limit: float = HOVER_TIME_LIMIT) -> str | None:
    """Return what the word at a position means, in Markdown; None where there is nothing to say.

    Parameters
    ----------
    document
        Script that may have errors.
    line, column
        Position, counted from 1.
    time_limit
        Time limit in seconds for the inference of what follows about an object.

    Returns
    -------
    str or None
        Markdown about a relation, a hedge, a kind or an object.

    Examples
    --------
    >>> print(hover(Document("fork left of plate; plate left of knife"), 1, 2))
    **fork**: fork, usually 12.5 to 23 cm long and 1.2 to 3.5 cm wide
    <BLANKLINE>
    - states: left of plate
    - follows: left of knife
    """
    token, before = document.token_at(line, column)
    if token is None:
        return None
    ontology = document.words
    if token.type == "RELATION":
        relation = ontology.relations.by_word[plain_phrase(token)]
        inverse = ontology.relations[relation.inverse]
        also = ", ".join(word.replace("_", " ") for word in relation.words if word != relation.phrase)
        lines = [f"**{relation.phrase}**: relation ({relation.reading.value} reading)", ""]
        lines += [f"- also: {also}"] if also else []
        return "\n".join([*lines, f"- inverse: {inverse.phrase}"])
    if token.type == "HEDGE":
        weights = {plain_phrase(word): weight for word, weight in ontology.hedges.items()}
        return f"**{token}**: the fact has the weight {weights[plain_phrase(token)]:g}"
    if token.type not in ("NAME", "STRING"):
        return None
    name = name_of(token)
    if before is not None and before.type == "IS":
        kind, colour = ontology.quality(name)
        parts = ([_of_kind(document, kind)] if kind else []) + ([f"colour {colour.label}"] if colour else [])
        return f"**{name}**: {', '.join(parts)}" if parts else None
    if not is_object(token, before, None):
        return None
    return "\n".join(_about(document, name, Deadline.after(time_limit)))


def _of_kind(document: Document, kind: Kind) -> str:
    return f"{kind.label}, usually {document.words.sizes.of(kind.iri)}"


def _about(document: Document, name: str, deadline: Deadline) -> Iterator[str]:
    """Yield lines about an object: its kind, its colour, its usual size, and the facts about it."""
    script = document.script
    group = document.groups.get(key_of(name))
    members = group.names if group is not None else (document.spellings.get(key_of(name), name),)
    first = members[0]
    kind = script.kinds.get(first) or document.words.of_name(first)[0]
    colour = script.colours.get(first)
    parts = [f"{group.count} objects"] if group is not None else []
    parts += [f"colour {colour.label}"] if colour else []
    parts.append(_of_kind(document, kind) if kind else "kind unknown")
    yield f"**{name}**: {', '.join(parts)}"
    stated = [wording for fact in script.facts if (wording := _seen_from(document, fact, first))]
    follows, complete = _following(document, first, set(stated), deadline)
    if stated or follows:
        yield ""
    for title, facts in (("states", stated), ("follows", follows)):
        yield from (f"- {title}: {wording}" for wording in facts[:MAX_FACTS_SHOWN])
    if len(stated) > MAX_FACTS_SHOWN or len(follows) > MAX_FACTS_SHOWN or not complete:
        yield "- …"


def _seen_from(document: Document, fact: Fact, name: str) -> str | None:
    """Return a fact as a phrase about one of its objects, or None if it is about others."""
    relations = fact.relations
    if fact.object == name:
        relations = tuple(document.words.relations[relation.inverse] for relation in relations)
    elif fact.subject != name:
        return None
    other = fact.object if fact.subject == name else fact.subject
    denied, rarely = "" if fact.positive else "not ", "rarely " if fact.rare else ""
    return f"{rarely}{denied}{' or '.join(relation.phrase for relation in relations)} {other}"


def _following(document: Document, name: str, stated: set[str], deadline: Deadline) -> tuple[list[str], bool]:
    """Return what follows for an object, and whether all of it was found within the time limit."""
    from deixis.workflows.layouts.infer import inference_of

    script = document.script
    if not script.facts:
        return [], True
    inference = inference_of(script, deadline.left)
    if not inference.consistent or not inference.decided:
        return [], inference.decided
    found: dict[str, None] = {}
    complete = inference.complete
    for number, (fact, _) in enumerate(inference.implications.implied_with_steps()):
        if number % 100 == 99 and deadline.passed:
            return list(found), False
        wording = _seen_from(document, fact, name)
        if wording is not None and wording not in stated:
            found[wording] = None
            if len(found) > MAX_FACTS_SHOWN:
                break
    return list(found), complete
