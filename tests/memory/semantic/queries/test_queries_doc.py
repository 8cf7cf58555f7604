"""The queries of docs/guides/queries.md run, and have results."""

from __future__ import annotations

import re
from datetime import UTC, datetime
from math import log
from pathlib import Path

import pytest

from deixis.memory.semantic.queries.results import QueryKind
from deixis.memory.semantic.rdf.graphs import ModelSet
from deixis.memory.semantic.store import SemanticMemory
from deixis.ontology.models.relation_triples import model_triples
from deixis.ontology.models.relations import Provenance, RelationModel, Term
from deixis.ontology.models.sizes import SizeModel, size_triples
from deixis.ontology.rdf.vocabulary import BASE

PAGE = Path(__file__).parents[4] / "docs" / "guides" / "queries.md"
SECTIONS = re.findall(r"^## (.+?)\n\n(.+?)\n\n```sparql\n(.+?)```", PAGE.read_text(encoding="utf-8"), re.M | re.S)

OF_LESSONS = [section for section in SECTIONS if "dxg:fluents" not in section[2]]
"""Sections about lessons; ``tests/docs/test_queries_page.py`` has those about episodes."""

EXPECTED = {
    "1. Which": "formal_dinner  Formal dinner  chair      lx:lesson/dinner-1",
    "2. What does": "5     dinner_fork  left or top left  dinner_plate  1",
    "3. What filled": "lx:lesson/dinner-1  fish_knife    o2      0.9",
    "4. Which": "dinner plate  2      2",
    "5. Which": "lx:lesson/dinner-1  salad_fork  o3        dinner_fork",
    "6. What lies": "lx:layout/dinner-1  salad_fork   4     0.7",
    "7. Which": "fish_knife  dx:FishKnife  lx:lesson/dinner-1  dx:DinnerKnife  lx:lesson/dinner-2",
    "8. What was": "dx:Plate",
    "9. Which": "lx:scene/s1  o2",
    "10. Where": "2026-11-21T10:00:00Z  0.1.0    exact   dinner.layout  lx:scene/s1",
    "11. Which": "horizontal  3      2026-11-21T00:00:00Z  lx:lesson/dinner-1",
    "12. How": "dx:DinnerPlate  0.27    false     0.98    3      2",
    "How large": "dxg:learned",
}


MADE = Provenance((), 3.0, datetime(2026, 11, 21, tzinfo=UTC), "0.1.0", ("dinner-1", "dinner-2"), 1.0)
MODEL = RelationModel("horizontal", (Term("gap", (0.0, 1.0), (0.0, -1.5)),), 0.01, 0.07, MADE)
SCENES = [f"https://w3id.org/deixis/learned/scene/s{number}" for number in (1, 2)]


@pytest.fixture
def modelled(taught: SemanticMemory) -> SemanticMemory:
    """Memory of two lessons, with a learned word and a learned size."""
    size = size_triples(BASE + "DinnerPlate", SizeModel((log(0.27), 0.1), (log(0.98), 0.1), False, 3.0), SCENES)
    taught.keep_models({ModelSet.WORDS: list(model_triples(MODEL)), ModelSet.SIZES: list(size)})
    return taught


def test_the_page_has_thirteen_queries_and_the_counts() -> None:
    assert len(SECTIONS) == 14
    assert PAGE.read_text(encoding="utf-8").count("```sparql") == 14
    assert all(sentence.rstrip().endswith(".") for _, sentence, _ in SECTIONS)


@pytest.mark.parametrize(("title", "query"), [(title, query) for title, _, query in OF_LESSONS])
def test_every_query_finds_what_is_there(modelled: SemanticMemory, title: str, query: str) -> None:
    answer = modelled.query(query)
    assert answer.kind is QueryKind.SELECT
    assert answer.rows
    (expected,) = [line for start, line in EXPECTED.items() if title.startswith(f"{start} ")]
    assert any(expected in line for line in answer.to_table()), "\n".join(answer.to_table())
