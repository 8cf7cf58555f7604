"""Ids of things in what persons say: *t2 is right of t3* is about the things that the robot calls t2 and t3."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from deixis.errors import DeixisError
from deixis.ontology.tbox import Ontology

_ID = re.compile(r"\b(?:the )?(?P<id>[A-Za-z]+\d+)\b", re.IGNORECASE)


class IdError(DeixisError, ValueError):
    """Error for an id in a text that stands for no thing in view, or for a thing without a name of its own."""


@dataclass(frozen=True, slots=True)
class NamedText:
    """A text with the names of things instead of their ids.

    Attributes
    ----------
    text
        The text.
    things
        Ids of the things that were replaced, by their names.
    """

    text: str
    things: dict[str, str]


def with_names(text: str, ids: Iterable[str], ontology: Ontology, name_of: Callable[[str], str | None]) -> NamedText:
    """Replace the ids of things in a text by their names.

    Only words of letters and digits that are not nouns count as ids: *fork2* may be a second fork.

    Parameters
    ----------
    text
        English, or a script in the layout language.
    ids
        Ids of the things in view.
    ontology
        The nouns.
    name_of
        Function that returns the category of a thing by its id, or None for a thing without a name.

    Returns
    -------
    NamedText
        The text, and the things that it is about by their names; the same text if it has no ids.

    Raises
    ------
    IdError
        If an id is like those of the things in view, but none of them has it; or if a thing has no name, or the name of
        another thing that the text is about.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> names = {"t2": "cup", "t3": "bread_plate"}
    >>> with_names("T2 is right of the t3.", names, default_ontology(), names.get)
    NamedText(text='the cup is right of the bread plate.', things={'cup': 't2', 'bread_plate': 't3'})
    """
    known = {id.lower(): id for id in ids if _ID.fullmatch(id) and ontology.of_name(_stem(id))[0] is None}
    stems = {_stem(id) for id in known}
    things: dict[str, str] = {}

    def name(found: re.Match[str]) -> str:
        id = found["id"].lower()
        if id not in known:
            if _stem(id) in stems:
                raise IdError(f"no thing '{found['id']}' is in view; there are: {', '.join(sorted(known.values()))}")
            return found[0]
        category = name_of(known[id])
        if category is None:
            raise IdError(f"{known[id]} has no name yet; say what it is first, as in '{known[id]} is a fork'")
        other = things.setdefault(category, known[id])
        words = category.replace("_", " ")
        if other != known[id]:
            raise IdError(f"{other} and {known[id]} are both called '{words}', so that a layout cannot tell them apart")
        return f"the {words}"

    return NamedText(_ID.sub(name, text), things)


def _stem(id: str) -> str:
    """Return the letters of an id."""
    return id.rstrip("0123456789").lower()
