"""The shipped examples as inquiries."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from deixis.grammar.layout.parser import read_layout
from deixis.perception.formats.scene_json import read_scene
from deixis.reasoning.grounding.evidence.facts.facts import crisp_tables, fact_tables
from deixis.reasoning.grounding.matching.problem import Problem
from deixis.reasoning.grounding.questions.candidates import candidates_of
from deixis.reasoning.grounding.questions.inquiry import Inquiry, begin
from deixis.reasoning.grounding.questions.selection import QuestionKind
from deixis.reasoning.grounding.questions.situation import situation_of

EXAMPLES = Path(__file__).parents[4] / "examples"


@pytest.fixture(scope="session")
def inquiry_of() -> Callable[..., Inquiry]:
    """A script's groundings in the place setting, by facts alone."""

    def inquiry(
        script: str, margin: float = 0.0, crisp: bool = False, kinds: tuple[QuestionKind, ...] = tuple(QuestionKind)
    ) -> Inquiry:
        scene = read_scene(EXAMPLES / "place_setting.scene.json")
        read = read_layout(str(EXAMPLES / f"{script}.layout"))
        description, seen = read.graph(), scene.relations(read.ontology.relations)
        said = crisp_tables(description, seen.names) if crisp else fact_tables(description, scene.boxes)
        n1 = len(description.nodes)
        nothing = np.zeros((n1, len(scene.objects)))
        problem = Problem(said.ends, said.kinds, said.tables, nothing, np.zeros(n1))
        return begin(situation_of(description, seen), candidates_of(problem, margin=margin), kinds)

    return inquiry
