"""Hover: what a word of a script means, and what follows for the object that it names."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from operator import attrgetter

from deixis.deadline import Deadline
from deixis.grammar.layout.names import key_of
from deixis.grammar.script import Script
from deixis.lsp.document import Document, is_object, name_of
from deixis.ontology.graph.facts import Fact
from deixis.ontology.relations.relation import Relation, plain_phrase
from deixis.ontology.tbox import Ontology
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
        parts = ([kind_and_size(document.words, kind)] if kind else []) + ([f"colour {colour.label}"] if colour else [])
        return f"**{name}**: {', '.join(parts)}" if parts else None
    if not is_object(token, before, None):
        return None
    return "\n".join(_about(document, name, Deadline.after(time_limit)))


def kind_and_size(ontology: Ontology, kind: Kind) -> str:
    """Return the name of a kind with the usual size of its things.

    Parameters
    ----------
    ontology
        Ontology with the sizes.
    kind
        Kind of thing.

    Returns
    -------
    str
        Phrase such as *fork, usually 12.5 to 23 cm long and 1.2 to 3.5 cm wide*.
    """
    return f"{kind.label}, usually {ontology.sizes.of(kind.iri)}"


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
    parts.append(kind_and_size(document.words, kind) if kind else "kind unknown")
    yield f"**{name}**: {', '.join(parts)}"
    stated = [wording for fact in script.facts if (wording := _seen_from(document.words, fact, first))]
    follows, complete = what_follows(script, document.words, first, set(stated), deadline)
    if stated or follows:
        yield ""
    for title, facts in (("states", stated), ("follows", follows)):
        yield from (f"- {title}: {wording}" for wording in facts[:MAX_FACTS_SHOWN])
    if len(stated) > MAX_FACTS_SHOWN or len(follows) > MAX_FACTS_SHOWN or not complete:
        yield "- …"


def _seen_from(
    ontology: Ontology, fact: Fact, name: str, words: Callable[[Relation], str] = attrgetter("phrase")
) -> str | None:
    """Return a fact as a phrase about one of its objects, or None if it is about others."""
    relations = fact.relations
    if fact.object == name:
        relations = tuple(ontology.relations[relation.inverse] for relation in relations)
    elif fact.subject != name:
        return None
    other = fact.object if fact.subject == name else fact.subject
    denied, rarely = "" if fact.positive else "not ", "rarely " if fact.rare else ""
    return f"{rarely}{denied}{' or '.join(map(words, relations))} {other}"


def what_follows(
    script: Script,
    ontology: Ontology,
    name: str,
    stated: set[str],
    deadline: Deadline,
    words: Callable[[Relation], str] = attrgetter("phrase"),
) -> tuple[list[str], bool]:
    """Return what follows for an object from the facts of a script.

    Parameters
    ----------
    script
        Script with the facts.
    ontology
        Ontology of its words.
    name
        Name of the object.
    stated
        Phrases that are left out.
    deadline
        Time at which the search ends.
    words
        Function that returns the words of a relation.

    Returns
    -------
    tuple
        Phrases such as *left of knife*, at most one more than are shown, and whether all were found in time.
    """
    from deixis.workflows.layouts.infer import inference_of

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
        wording = _seen_from(ontology, fact, name, words)
        if wording is not None and wording not in stated:
            found[wording] = None
            if len(found) > MAX_FACTS_SHOWN:
                break
    return list(found), complete
