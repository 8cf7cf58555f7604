"""docs/guides/queries.md: the queries run over what two shipped scripts teach."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from deixis.examples_data import example
from deixis.session import Session

PAGE = Path(__file__).parents[2] / "docs" / "guides" / "queries.md"
QUERIES = re.findall(r"^```sparql\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.M | re.S)


@pytest.fixture(scope="module")
def taught(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("queries") / "memory"
    with Session(path) as session:
        for script in ("formal_dinner.layout", "script1.layout"):
            session.learn(example(script), example("place_setting.scene.json"))
        session.learn_relations()
    return path


def test_there_are_ten_or_more() -> None:
    assert len(QUERIES) >= 10


def test_they_have_answers_over_what_was_really_learned(taught: Path) -> None:
    with Session(taught) as session:
        answers = {query: session.query(query) for query in QUERIES}
        found = {query: len(answer.rows) + len(answer.triples) for query, answer in answers.items()}
    assert (
        sum(number > 0 for number in found.values()) >= 10
    )  # one looks for disagreements, one for sizes, which take three views
