"""Retrieved layouts and scenes as lines of text and as plain data for JSON."""

from __future__ import annotations

from typing import Any

from deixis.workflows.grounding.retrieve import Retrieval


def retrieval_lines(retrieval: Retrieval) -> list[str]:
    """Return a line for each result, best first.

    Parameters
    ----------
    retrieval
        Answer of ``deixis retrieve``.

    Returns
    -------
    list of str
        A header and an aligned line for each result, or one sentence where no candidate is similar enough.
    """
    found = retrieval.found
    if not found:
        return [
            f"None of the {retrieval.among} candidates has a similarity of at least {retrieval.least:g} to "
            f"{retrieval.query}."
        ]
    wide = max(len(one.name) for one in found)
    lines = [f"{'':{wide}}  similarity  objects  relations"]
    for one in found:
        relations = "     none" if one.relations is None else f"{one.relations:9.3f}"
        doubt = "" if one.proved else "   lower bound: not proved in time"
        lines.append(f"{one.name:<{wide}}  {one.similarity:10.3f}  {one.objects:7.3f}  {relations}{doubt}")
    return lines


def retrieval_to_dict(retrieval: Retrieval) -> dict[str, Any]:
    """Return the query, how many it was compared with, and the results, best first.

    Parameters
    ----------
    retrieval
        Answer of ``deixis retrieve``.

    Returns
    -------
    dict
        Data for JSON with the keys ``query``, ``among`` (number of candidates) and ``results``.
    """
    results = [
        {
            "name": one.name,
            "similarity": one.similarity,
            "objects": one.objects,
            "relations": one.relations,
            "matches": one.matches,
            "proved_best": one.proved,
        }
        for one in retrieval.found
    ]
    return {"query": retrieval.query, "among": retrieval.among, "results": results}
