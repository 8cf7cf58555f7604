"""Evidence of colours: the likelihood of a thing's colour given the described colour, against chance.

A colour term is a normal density in CIELAB (:mod:`deixis.ontology.things.colours`); the basic terms are those of Berlin
and Kay (*Basic Color Terms*, 1969). Chance is a mixture of the basic terms, and of the narrower ones that are
described, by their shares in the scene, with equal prior shares: *red* is strong evidence for the only red thing, and
none where all things are red.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.things.colours import Colour, Colours
from deixis.reasoning.geometry.coordinates import coordinates

Array = NDArray[np.float64]

MIN_TERM_SHARE = 0.9
"""Minimum share of a colour term among the densities of all terms, from which the term names a colour."""

OUTLIERS = 0.05
"""Share of things whose seen colour is independent of the described one, because of the light or several colours."""

MAX_OTHER_RATIO = 0.05
"""Maximum ratio of the described colour's density to the greatest density for a thing of another colour."""

TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
"""Matrix from linear sRGB to CIE XYZ, white point D65 (IEC 61966-2-1)."""


def lab_of_srgb(rgb: NDArray[np.float64] | NDArray[np.uint8]) -> Array:
    """Convert colours in sRGB, 0 to 255, to CIELAB, both of shape (…, 3).

    L is 0 to 100, a grows towards red, b towards yellow; NaN stays NaN. The sources are IEC 61966-2-1 for sRGB, and
    CIE 15 for CIELAB under the white of sRGB (D65).

    Parameters
    ----------
    rgb
        Colours in sRGB, 0 to 255, shape (…, 3).

    Returns
    -------
    ndarray
        Colours in CIELAB, shape (…, 3).

    Examples
    --------
    >>> lab_of_srgb(np.array([[255.0, 255.0, 255.0], [255.0, 0.0, 0.0]])).round(1).tolist()
    [[100.0, 0.0, 0.0], [53.2, 80.1, 67.2]]
    """
    if np.asarray(rgb).dtype == np.uint8:
        linear = _linear(np.arange(256.0))[np.asarray(rgb, np.uint8)]
    else:
        linear = _linear(np.asarray(rgb, dtype=np.float64))
    xyz = coordinates(linear.reshape(-1, 3), TO_XYZ).reshape(linear.shape) / TO_XYZ.sum(axis=1)
    limit = 6 / 29
    f = np.where(xyz > limit**3, np.cbrt(xyz), xyz / (3 * limit**2) + 4 / 29)
    lab: Array = np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], axis=-1)
    return lab + 0.0  # no minus zero


def _linear(rgb: NDArray[np.float64]) -> Array:
    """Return linear sRGB in [0, 1] of sRGB values 0 to 255."""
    share = rgb / 255
    linear: Array = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return linear


def colour_evidence(described: Sequence[str | None], seen: NDArray[np.float64], colours: Colours) -> Array:
    """Return log-likelihood ratios by colour of n1 objects being each of n2 things, shape (n1, n2), finite.

    Parameters
    ----------
    described
        Colour of each object (IRI); None where none is described.
    seen
        Colours of the things in sRGB, 0 to 255, shape (n2, 3); a row of NaN where the colour is unknown.
    colours
        Known colour terms.

    Returns
    -------
    ndarray
        Ratios in nats.

    Notes
    -----
    The evidence is log((1 - outliers) p(seen | described) / p(seen) + outliers), and 0 where either colour is unknown.
    The ratio is at most one over the share of the described colour, so that colours are weak evidence in a scene that
    is all in one colour.
    """
    evidence = np.zeros((len(described), len(seen)))
    known = np.flatnonzero(~np.isnan(seen).any(axis=1))
    if not len(known) or not any(described):
        return evidence
    lab, terms = lab_of_srgb(seen[known]), _terms(described, colours)
    densities = np.stack([_log_density(lab, term) for term in terms], axis=1)
    # the share (k,) of each term among the things of the scene, from the log densities of things with a known colour
    things = len(seen)
    named_terms = densities.shape[1]
    naming = np.exp(densities - np.logaddexp.reduce(densities, axis=1, keepdims=True))
    unknown = things - len(densities) + 1
    shares: Array = (naming.sum(axis=0) + unknown / named_terms) / (things + 1)
    chance = np.logaddexp.reduce(densities + np.log(shares), axis=1)
    ratios = np.logaddexp(np.log1p(-OUTLIERS) + densities - chance[:, None], np.log(OUTLIERS))
    column = {term.iri: position for position, term in enumerate(terms)}
    for row, iri in enumerate(described):
        if iri is not None:
            evidence[row, known] = ratios[:, column[iri]]
    return evidence


def colour_terms(seen: NDArray[np.float64], colours: Colours) -> list[Colour | None]:
    """Return the basic colour term of each of n things, None where the colour is unknown or two terms fit.

    Parameters
    ----------
    seen
        Colours of the things in sRGB, 0 to 255, shape (n, 3); a row of NaN where the colour is unknown.
    colours
        Known colour terms.

    Returns
    -------
    list of Colour or None
        Colour term of each thing.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> terms = colour_terms(np.array([[200.0, 20, 30], [np.nan] * 3]), default_ontology().colours)
    >>> [term and term.label for term in terms]
    ['red', None]
    """
    found: list[Colour | None] = [None] * len(seen)
    for place in np.flatnonzero(~np.isnan(seen).any(axis=1)):
        lab = lab_of_srgb(seen[place])[None]
        densities = np.array([_log_density(lab, term)[0] for term in colours.basic])
        shares = np.exp(densities - np.logaddexp.reduce(densities))
        if shares.max() >= MIN_TERM_SHARE:
            found[place] = colours.basic[int(shares.argmax())]
    return found


def other_colours(described: Sequence[str | None], seen: NDArray[np.float64], colours: Colours) -> list[Colour | None]:
    """Return the colour of each of n things that clearly differs from the described one, None for other things.

    For neighbouring colours such as red and orange,
    either word may be used; so p(seen | described) must be at most ``MAX_OTHER_RATIO`` of the greatest density. The
    other things of the scene do not matter.

    Parameters
    ----------
    described
        Colour of the object that each thing is compared with (IRI); None where none is described.
    seen
        Colours of the things in sRGB, 0 to 255, shape (n, 3); a row of NaN where the colour is unknown.
    colours
        Known colour terms.

    Returns
    -------
    list of Colour or None
        Colour term of each thing, None where its colour fits or is unknown.
    """
    found: list[Colour | None] = [None] * len(described)
    terms = _terms(described, colours)
    column = {term.iri: position for position, term in enumerate(terms)}
    for place, iri in enumerate(described):
        if iri is not None and not np.isnan(seen[place]).any():
            lab = lab_of_srgb(seen[place])[None]
            densities = np.array([_log_density(lab, term)[0] for term in terms])
            if densities[column[iri]] - densities.max() <= np.log(MAX_OTHER_RATIO):
                found[place] = terms[int(densities.argmax())]
    return found


def _terms(described: Sequence[str | None], colours: Colours) -> list[Colour]:
    """Return the basic terms, and the narrower terms among the described ones."""
    narrower = (colours[iri] for iri in dict.fromkeys(described) if iri is not None and colours[iri].broader)
    return [*colours.basic, *narrower]


def _log_density(lab: Array, term: Colour) -> Array:
    """Return log densities of CIELAB colours (n, 3) under a term's normal distribution, up to a constant, (n,)."""
    apart = lab - lab_of_srgb(np.array(term.prototype, dtype=np.float64))
    precision = np.linalg.inv(term.matrix())
    result: Array = -0.5 * np.einsum("ni,ij,nj->n", apart, precision, apart) + 0.5 * np.linalg.slogdet(precision)[1]
    return result
