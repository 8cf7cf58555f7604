"""Labels: find the objects of a description that the labels of perceived things name.

A label names the object that has it as its name (``wine_glass`` names ``wine_glass_1``), otherwise every object of the
label's kind. A narrower label also names broader objects: a dinner fork is a fork, and by its head noun a rice bowl is
a bowl. Exact names take precedence: where one thing has the label *fork*, a dinner fork beside it is not the only fork
of a script; where a script has a dinner fork, a thing with that label is not another fork of the script. Broader
objects get only what exact names leave over, on both sides: of two dinner forks, one can be the fork. The evidence of a
name is computed by :func:`deixis.reasoning.grounding.evidence.properties.unary.label_ratios`.

The maximum matching is scipy's. With networkx (Hopcroft-Karp and a search along alternating paths) it takes 2, 10 and
20 times as long for 12, 100 and 500 rows, and the import takes 0.14 s more.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.inflection import singulars
from deixis.ontology.lexicon.adjectives import adjectives
from deixis.ontology.rdf.triples import category_iri
from deixis.ontology.things.kinds import Kinds, plain_name


def spare_rows(pairs: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the mask of rows that at least one maximum matching leaves over.

    All maximum matchings are reached from one of them by alternating paths from its unmatched rows (Dulmage and
    Mendelsohn 1958).

    Parameters
    ----------
    pairs
        Allowed pairs of n rows and m columns, shape (n, m).

    Returns
    -------
    ndarray
        Mask of shape (n,).

    Examples
    --------
    >>> spare_rows(np.array([[1, 0], [1, 0], [0, 1], [0, 0]], bool)).tolist()
    [True, True, False, True]
    """
    if not pairs.any():
        return np.ones(len(pairs), dtype=bool)
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import maximum_bipartite_matching

    partner = maximum_bipartite_matching(csr_array(pairs), perm_type="column")
    spare: NDArray[np.bool_] = partner < 0
    while True:
        wanted: NDArray[np.bool_] = np.any(pairs[spare], axis=0)
        more = spare | (wanted[partner] & (partner >= 0))
        if (more == spare).all():
            return spare
        spare = more


@dataclass(frozen=True, slots=True)
class Label:
    """Name that perception gives to a thing, with the probability ``confidence`` in [0, 1] that it is right."""

    text: str
    confidence: float = 1.0


@dataclass(frozen=True, eq=False)
class Naming:
    """Objects that labels name.

    Attributes
    ----------
    named
        Mask (n1, n2) of the objects that the label of each thing names.
    fitted
        Mask (n1, n2) of the named objects that the label fits: it is the object's name, its kind or a narrower kind. A
        broader label (*cutlery*) names objects (the fork) that it does not fit.
    """

    named: NDArray[np.bool_]
    fitted: NDArray[np.bool_]


def naming(description: RelationGraph, labels: Sequence[Label | None], kinds: Kinds) -> Naming:
    """Return the objects that the labels of all things of a scene name, with one label or None per thing.

    Parameters
    ----------
    description
        The n1 objects.
    labels
        Label of each of n2 things, None where it has none.
    kinds
        The known kinds.

    Returns
    -------
    Naming
        Masks of shape (n1, n2).
    """
    given_texts = [label.text if label is not None and label.confidence > 0 else None for label in labels]
    nothing = np.zeros(len(description.nodes), dtype=bool)
    texts = {
        text: _columns(description, text, kinds) if text is not None else (nothing, nothing)
        for text in dict.fromkeys(given_texts)
    }
    place = {text: number for number, text in enumerate(texts)}
    which = np.array([place[text] for text in given_texts], dtype=np.int64)
    both = np.array(list(texts.values()), dtype=bool).reshape(len(texts), 2, len(nothing))  # (different texts, 2, n1)
    named, fitting = both[which, 0].T, both[which, 1].T
    sureness = np.array([label.confidence if label is not None else 0.0 for label in labels])
    by_name = named & fitting
    narrower = fitting & ~named
    found = np.zeros_like(narrower)
    for level in sorted(set(sureness[narrower.any(axis=0)].tolist())):
        claims, at_level = by_name & (sureness >= level), sureness == level
        spare = spare_rows(claims)[:, None] & spare_rows(claims.T)[None, :]
        found[:, at_level] = (narrower & spare)[:, at_level]
    named = named | found
    return Naming(named, named & fitting)


def _columns(description: RelationGraph, label: str, kinds: Kinds) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return masks (n1,) of the objects that a single label names, by name or as a broader word, and that it fits."""
    called, bare = objects_called(description, label), plain_name(label)
    meant, more = kinds.head_noun(bare)  # of a rice bowl: a bowl, of rice
    k = next(iter(meant), None)
    narrow = _narrowing(more)
    found = []
    for node, name in zip(description.nodes, _kinds(description), strict=True):
        if _plain(plain_name(node)) == _plain(bare):
            found.append(bare == label or plain_name(node) == node)
        else:
            fits = k is not None and name is not None and kinds.is_a(k, kinds[name])
            found.append(fits and not (narrow and _narrowing(kinds.head_noun(plain_name(node))[1])))
    fitting = called | np.array(found, dtype=bool)
    kind = None if narrow else kinds.of_word(label)
    if called.any() or kind is None:
        return called, fitting
    known = (None if iri is None else kinds[iri] for iri in _kinds(description))
    return np.array(
        [known_name is not None and kinds.is_a(known_name, kind) for known_name in known], dtype=bool
    ), fitting


def _narrowing(words: str) -> bool:
    """Return whether the words before a head noun make a kind of its own: a rice bowl is not a soy bowl.

    Adjectives do not: a red bowl may be a rice bowl.
    """
    return not all(word in adjectives() for word in words.split())


def objects_called(description: RelationGraph, name: str) -> NDArray[np.bool_]:
    """Return the mask of objects with a name, or else with it and a number, or else in the plural.

    ``wine_glass`` is the name of ``wine_glass``, of ``wine_glass_1`` and of a group ``wine_glasses``.

    Parameters
    ----------
    description
        The n1 objects.
    name
        The name, in any case, with spaces or underscores.

    Returns
    -------
    ndarray
        Mask of shape (n1,).
    """
    plain = _plain(name)
    same = np.array([_plain(node) == plain for node in description.nodes], dtype=bool)
    if same.any():
        return same
    numbered = np.array([_plain(plain_name(node)) == plain for node in description.nodes], dtype=bool)
    if numbered.any():
        return numbered
    return np.array([plain in singulars(_plain(node)) for node in description.nodes], dtype=bool)


def category_of(name: str) -> str:
    """Return the category, as a class IRI, of things with a name (without its number) that is not a known kind.

    Parameters
    ----------
    name
        Name of a thing.

    Returns
    -------
    str
        IRI of the category.

    Examples
    --------
    >>> category_of("fish_knife_2") == category_of("Fish knife")
    True
    """
    return category_iri(_plain(plain_name(name)).replace(" ", "_"))


def classes(description: RelationGraph) -> tuple[str, ...]:
    """Return the class IRI of each object of a description: its kind, else the category of its name.

    Parameters
    ----------
    description
        The n1 objects.

    Returns
    -------
    tuple of str
        IRI of each object's class, in the order of the objects.
    """
    return tuple(kind or category_of(node) for kind, node in zip(_kinds(description), description.nodes, strict=True))


def _kinds(description: RelationGraph) -> tuple[str | None, ...]:
    return description.kinds or (None,) * len(description.nodes)


def _plain(name: str) -> str:
    return " ".join(unicodedata.normalize("NFC", name).casefold().replace("_", " ").split())
