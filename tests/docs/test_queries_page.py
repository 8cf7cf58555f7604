"""docs/guides/queries.md: the queries run over what two shipped scripts teach."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from deixis.examples_data import example
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
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


def test_acts_are_found_with_their_persons(tmp_path: Path) -> None:
    seen = Source(Origin.SEEN, "tracker")
    acts = [(("t1", "isA", "fork"), 0.0), (("Ada", "moved", "t1"), 5.0), (("Ben", "took", "t1"), 9.0)]
    with Blackboard.open(tmp_path, create=True) as board:
        for number, (act, start) in enumerate(acts):
            board.add(episodic(f"f{number}", act, start=start, source=seen), by="test")
    (query,) = [each for each in QUERIES if "prov:wasAssociatedWith" in each]
    with Session(tmp_path) as session:
        rows = session.query(query).rows
    found = [tuple(str(value.value).rpartition("/")[2].rpartition("#")[2] for value in row[:4]) for row in rows]
    assert found == [("Ada", "moved", "t1", "fork"), ("Ben", "took", "t1", "fork")]
