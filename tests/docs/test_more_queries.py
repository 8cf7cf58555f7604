"""docs/guides/more_queries.md: each query runs, and finds what two shipped scripts teach."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from source_tree import ROOT

from deixis.examples_data import example
from deixis.session import Session

PAGE = ROOT / "docs" / "guides" / "more_queries.md"
QUERIES = re.findall(r"^```sparql\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


@pytest.fixture(scope="module")
def taught(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Session]:
    """A session that learned two layouts from one scene, the first of them twice."""
    with Session(tmp_path_factory.mktemp("more_queries") / "memory") as session:
        for script in ("formal_dinner.layout", "script2.layout", "formal_dinner.layout"):
            session.learn(example(script), example("place_setting.scene.json"))
        yield session


def test_there_are_more_than_twenty() -> None:
    assert len(QUERIES) == 23


@pytest.mark.parametrize("query", QUERIES, ids=range(1, len(QUERIES) + 1))
def test_a_query_finds_something(taught: Session, query: str) -> None:
    answer = taught.query(query)
    assert len(set(map(str, answer.rows))) == len(answer.rows), "some row is printed twice"
    if "FILTER NOT EXISTS { ?thing a ?category" in query:
        assert len(answer.rows) < 12  # the two scripts name all or nearly all of the twelve things
    elif "implicationsStored false" in query:
        assert answer.empty  # both layouts are small, without alternatives
    else:
        assert not answer.empty
