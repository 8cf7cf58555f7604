"""The names of learned things: IRIs under one base, made from what people called them."""

from __future__ import annotations

import hashlib
from urllib.parse import quote, unquote

LEARNED = "https://w3id.org/deixis/learned/"


def learned_iri(*parts: str | int) -> str:
    """An IRI under :data:`LEARNED`; every part is percent-encoded, so that no name can reach out of its place.

    >>> learned_iri("category", "fish knife>")
    'https://w3id.org/deixis/learned/category/fish%20knife%3E'
    """
    return LEARNED + "/".join(quote(str(part), safe="") for part in parts)


def category_iri(name: str) -> str:
    """The class of things that go by a name, as it was learned."""
    return learned_iri("category", name)


def content_key(content: str) -> str:
    """A short name for a text, in the letters that a blank node's label may have."""
    return hashlib.sha256(content.encode("utf-8")).hexdigest()[:16]


def last_part(iri: str) -> str:
    """The name that the last part of a learned IRI was made from.

    >>> last_part(learned_iri("category", "fish knife>"))
    'fish knife>'
    """
    return unquote(iri.rsplit("/", 1)[-1])
