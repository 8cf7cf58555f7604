"""deixis validate: users' own shapes over files and memories, what is refused, and limits."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import rdflib
from commands import deixis

from deixis.deadline import Deadline
from deixis.examples_data import example
from deixis.memory.semantic.rdf.files import read_quads
from deixis.memory.semantic.validation.by_shapes import validate_by_shapes
from deixis.reasoning.errors import LimitError
from deixis.session import Session

pytestmark = pytest.mark.slow

HEAD = "@prefix : <urn:t#> . @prefix sh: <http://www.w3.org/ns/shacl#> .\n"
DATA = ":a a :Fork ; :tines 4 . :b a :Fork ; :tines 1 , 2 . :b :beside :c ."
SHAPES = """
:ForkShape a sh:NodeShape ; sh:targetClass :Fork ; sh:property [
    sh:path :tines ; sh:maxCount 1 ; sh:minInclusive 2 ; sh:message "a fork has two tines or more" ] .
:Beside a sh:PropertyShape ; sh:targetSubjectsOf :beside ; sh:path ( :beside :tines ) ; sh:minCount 1 ;
    sh:severity sh:Warning .
"""


@pytest.fixture
def data(tmp_path: Path) -> Path:
    file = tmp_path / "data.ttl"
    file.write_text(HEAD + DATA, encoding="utf-8")
    return file


def shapes(folder: Path, text: str = SHAPES) -> Path:
    file = folder / "shapes.ttl"
    file.write_text(HEAD + text, encoding="utf-8")
    return file


def test_violations_come_first_each_with_its_shape(data: Path, tmp_path: Path) -> None:
    code, out, err = deixis("validate", data, "--shapes", shapes(tmp_path))
    assert (code, err) == (1, "")
    lines = out.splitlines()
    assert [line.split(":")[0] for line in lines[:-1]] == ["Violation", "Violation", "Warning"]
    assert "a fork has two tines or more" in lines[0] and "<urn:t#b>" in lines[0]
    assert lines[-1] == "3 results: does not conform"


def test_json_and_the_standard_report_say_the_same(data: Path, tmp_path: Path) -> None:
    code, out, _ = deixis("validate", data, "--shapes", shapes(tmp_path), "--json")
    found = json.loads(out)
    assert code == 1 and found["conforms"] is False
    code, out, _ = deixis("validate", data, "--shapes", shapes(tmp_path), "--turtle")
    report = rdflib.Graph().parse(data=out, format="turtle")
    results = list(report.subjects(rdflib.RDF.type, rdflib.SH.ValidationResult))
    assert code == 1 and len(results) == len(found["results"]) == 3


def test_what_conforms_exits_0(data: Path, tmp_path: Path) -> None:
    lenient = shapes(tmp_path, ":S a sh:NodeShape ; sh:targetClass :Spoon ; sh:nodeKind sh:Literal .")
    assert deixis("validate", data, "--shapes", lenient) == (0, "conforms\n", "")


def test_a_memory_is_validated_by_own_shapes(tmp_path: Path) -> None:
    with Session(tmp_path / "memory") as session:
        session.learn(example("formal_dinner.layout"), example("place_setting.scene.json"))
    role = "<https://w3id.org/deixis/onto#Role>"
    own = f":S a sh:NodeShape ; sh:targetClass {role} ; sh:property [ sh:path :x ; sh:minCount 1 ] ."
    code, out, _ = deixis("validate", "--memory", tmp_path / "memory", "--shapes", shapes(tmp_path, own))
    assert code == 1 and "lx:layout" in out
    assert deixis("validate", "--memory", tmp_path / "memory") == (0, "conforms\n", "")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (":x :y :z .", "there is no SHACL shape"),
        (":S a sh:NodeShape ; sh:targetClass :Fork ; sh:property [ sh:minCount 1 ] .", "cannot check these shapes"),
        (
            ":S a sh:NodeShape ; sh:targetClass :Fork ; sh:sparql [ sh:select "
            '"SELECT $this WHERE { SERVICE <http://x.example/> { $this ?p ?o } }" ] .',
            "SERVICE",
        ),
        (":S a sh:NodeShape", "shapes.ttl:"),
    ],
)
def test_bad_shapes_are_reported_and_exit_2(text: str, told: str, data: Path, tmp_path: Path) -> None:
    code, out, err = deixis("validate", data, "--shapes", shapes(tmp_path, text))
    assert (code, out) == (2, "")
    assert told in err and "Traceback" not in err


def test_a_time_limit_ends_the_check(data: Path, tmp_path: Path) -> None:
    code, out, err = deixis("validate", data, "--shapes", shapes(tmp_path), "--time-limit", "0.01")
    assert (code, out) == (3, "")
    assert "undecided" in err
    with pytest.raises(LimitError, match="time limit reached"):
        validate_by_shapes((quad.triple for quad in read_quads(data)), [], Deadline.after(0))
