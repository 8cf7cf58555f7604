"""docs/queries.md: every query runs over what the two shipped scripts teach, and has an answer."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from deixis.examples_data import example
from deixis.session import Session

PAGE = Path(__file__).parents[2] / "docs" / "queries.md"
QUERIES = re.findall(r"^## (\d+)\. (.*?)$.*?^```sparql\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.M | re.S)


@pytest.fixture(scope="module")
def taught(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("queries") / "memory"
    with Session(path) as session:
        for script in ("formal_dinner.layout", "script1.layout"):
            session.learn(example(script), example("place_setting.scene.json"))
    return path


def test_there_are_ten() -> None:
    assert [int(number) for number, _, _ in QUERIES] == list(range(1, 11))


@pytest.mark.parametrize(("number", "query"), [(int(number), query) for number, _, query in QUERIES])
def test_each_has_an_answer(number: int, query: str, taught: Path) -> None:
    with Session(taught) as session:
        answer = session.query(query)
        found = (
            list(answer.triples or ()) if answer.kind == "construct" else [list(map(str, row)) for row in answer.rows]
        )
    expected = {1: 2, 2: 11, 3: 12, 4: 12, 5: 3, 6: 8, 7: 4, 8: 8, 9: 1, 10: 11}
    assert len(found) == expected[number], found
