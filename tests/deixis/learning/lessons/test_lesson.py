"""Learn, show, query and forget, through the session and the command line."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pyoxigraph as ox
import pytest
from commands import deixis

from deixis.errors import UnknownTermError
from deixis.examples_data import example
from deixis.experiments.place_settings import formal_setting
from deixis.grammar.layout.format import layout_script
from deixis.learning.lessons.lesson import layout_concept, layout_name
from deixis.memory.on_demand import default_memory
from deixis.memory.semantic.exchange import export_memory
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.ontology.rdf.triples import with_blank_nodes
from deixis.perception.formats.scene_json import read_scene
from deixis.reasoning.description_logic.reasoners import classify
from deixis.reasoning.errors import InconsistencyError
from deixis.session import Session
from deixis.workflows.layouts.read import read_script

FULL, SCRIPT1, SCENE = (example(n) for n in ("formal_dinner.layout", "script1.layout", "place_setting.scene.json"))
LEARNED = "https://w3id.org/deixis/learned/"


@pytest.fixture(scope="module")
def taught(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Memory with two lessons: the fuller script, and Figure 7 with two words of unknown size."""
    path = tmp_path_factory.mktemp("taught") / "memory"
    text = SCRIPT1.read_text(encoding="utf-8").replace("dinner_knife", "implement").replace("water_glass", "vessel")
    with Session(path) as session:
        session.learn(FULL, SCENE)
        session.learn(read_script(text=text), replace(read_scene(SCENE), unit="px"))
    return path


def test_a_lesson_outlives_the_process_that_learned_it(taught: Path) -> None:
    with Session(taught) as session:
        assert session.memory().lessons() == ("formal_dinner-1", "script1-1")
        assert [layout.name for layout in session.layouts()] == ["formal_dinner", "script1"]
        concept = session.layout("formal_dinner")
        assert [str(fact) for fact in concept.facts] == [str(fact) for fact in read_script(FULL).facts]


def test_a_layout_is_found_by_its_name_or_its_lesson(taught: Path) -> None:
    with Session(taught) as session:
        assert session.layout("formal_dinner-1").name == session.layout("formal_dinner").name == "formal_dinner"
        assert session.layout("formal_dinner") == session.layouts()[0]
        with pytest.raises(UnknownTermError, match="did you mean 'script1'"):
            session.layout("script")


def test_the_layout_is_a_class_whose_label_is_its_name(taught: Path) -> None:
    with Session(taught) as session:
        asked = "ASK { ?l a owl:Class ; rdfs:subClassOf dx:Layout ; rdfs:label 'formal_dinner' ; dx:learnedIn ?lesson }"
        assert session.query(asked).boolean is True


def test_what_is_doubtful_is_recorded_and_teaches_nothing(taught: Path) -> None:
    with Session(taught) as session:
        rows = session.query(
            "SELECT ?name (COUNT(?thing) AS ?n) { ?m dx:ofRole ?role ; dx:decided false ; dx:couldBe ?thing . "
            f"?role rdfs:label ?name ; dx:inLayout <{LEARNED}layout/script1-1> }} GROUP BY ?name ORDER BY ?name"
        ).rows
        assert len(rows) >= 6
        asked = "ASK { ?m dx:ofRole/dx:inLayout ?l ; dx:decided false ; dx:category ?c }"
        assert session.query(asked).boolean is False
        swap = "ASK { ?a rdfs:label 'implement' . ?a dx:interchangeableWith/rdfs:label 'vessel' }"
        assert session.query(swap).boolean is True


def test_a_category_says_which_lessons_showed_it(taught: Path) -> None:
    with Session(taught) as session:
        rows = session.query(
            f"SELECT ?lesson {{ ?m dx:category <{LEARNED}category/dinner_plate> ; prov:wasGeneratedBy ?lesson }} "
            "ORDER BY ?lesson"
        ).rows
        assert [str(row[0]) for row in rows] == [
            f"<{LEARNED}lesson/{lesson}>" for lesson in ("formal_dinner-1", "script1-1")
        ]


def test_a_kind_of_the_lexicon_is_learned_with_those_above_it(tmp_path: Path) -> None:
    boxes = {"a": [0, 0], "b": [2, 0]}
    things = [
        {"id": name, "min": low, "max": [low[0] + 1, 1], "label": label}
        for (name, low), label in zip(boxes.items(), ("ottoman", "rice_bowl"), strict=True)
    ]
    scene = tmp_path / "room.scene.json"
    scene.write_text(json.dumps({"unit": "px", "objects": things}), encoding="utf-8")
    with Session(tmp_path / "memory") as session:
        session.learn(read_script(text="layout room. ottoman left of rice_bowl"), scene)
        classes = "ASK { ?ottoman rdfs:label 'ottoman' ; rdfs:subClassOf dx:Seat }"
        assert session.query(classes).boolean is True
        assert session.query("ASK { ?thing a dx:Furniture . ?other a dx:Bowl }").boolean is True
        assert session.layout("room").roles[0].kind == read_script(text="ottoman left of a").graph().kinds[0]
        session.forget("room-1")
        assert session.query(classes).boolean is False


def test_what_follows_is_in_the_inferred_graph_and_only_there(taught: Path) -> None:
    with Session(taught) as session:
        memory = session.memory()
        inferred, said = set(memory.triples(GraphName.INFERRED)), set(memory.triples(GraphName.LEARNED))
        rdfs, dx = "http://www.w3.org/2000/01/rdf-schema#", "https://w3id.org/deixis/onto#"
        broader = ox.Triple(
            ox.NamedNode(LEARNED + "category/fish_knife"),
            ox.NamedNode(rdfs + "subClassOf"),
            ox.NamedNode(dx + "Cutlery"),
        )
        assert broader in inferred
        assert not inferred & said
        assert any(triple.predicate.value == dx + "left" for triple in inferred)


@pytest.mark.slow
def test_the_whole_memory_is_consistent_for_hermit(taught: Path) -> None:
    with Session(taught) as session:
        names = (GraphName.ONTOLOGY, GraphName.LEARNED, GraphName.ASSERTED, GraphName.EPISODES)
        triples = [triple for name in names for triple in session.memory().triples(name)]
    text = ox.serialize(with_blank_nodes(triples), format=ox.RdfFormat.N_TRIPLES) or b""
    assert classify(text.decode("utf-8")).unsatisfiable == ()


@pytest.mark.slow
def test_forgetting_b_after_a_and_b_leaves_what_a_alone_leaves(tmp_path: Path) -> None:
    with Session(tmp_path / "memory") as session:
        session.learn(FULL, SCENE)
        before = export_memory(session.memory(), "trig")
        session.learn(SCRIPT1, SCENE)
        assert export_memory(session.memory(), "trig") != before
        session.forget("script1-1")
        assert export_memory(session.memory(), "trig") == before


@pytest.mark.slow
def test_a_lesson_that_makes_a_kind_impossible_is_refused(tmp_path: Path) -> None:
    scene = replace(formal_setting().without_labels(), unit="px")  # so that sizes have less weight
    says = FULL.read_text(encoding="utf-8").split("chair")[1].replace("napkin", "thing") + "thing is a "
    with Session(tmp_path / "memory") as session:
        assert "thing" in session.learn(read_script(text=f"layout a\n{says} Napkin"), scene).categories
        before = export_memory(session.memory(), "trig")
        with pytest.raises(InconsistencyError, match="no instance of 'thing' is possible"):
            session.learn(read_script(text=f"layout b\n{says} BreadBasket"), scene)
        assert export_memory(session.memory(), "trig") == before


def test_a_script_that_contradicts_itself_is_not_learned(tmp_path: Path) -> None:
    session = Session(tmp_path / "memory")
    with pytest.raises(InconsistencyError, match=r"contradiction\.layout:5:1"):
        session.learn(example("contradiction.layout"), SCENE)
    assert not (tmp_path / "memory").exists()


def test_the_commands(taught: Path) -> None:
    code, shown, _ = deixis("show", "formal_dinner", "--memory", taught)
    assert (code, shown.splitlines()[0]) == (0, 'layout formal_dinner "Formal dinner" seen from chair')
    assert [str(f) for f in read_script(text=shown).facts] == [str(f) for f in read_script(FULL).facts]
    second = example("second_table.scene.json")
    code, told, _ = deixis("check", "formal_dinner", second, "--json", "--memory", taught)
    found = json.loads(told)
    assert code == 1
    assert [entry["object"] for entry in found["misplaced"]] == ["dinner_fork", "dinner_knife"]
    assert [entry["object"] for entry in found["missing"]] == ["water_glass"]
    assert [entry["perceived"] for entry in found["extra"]] == ["p1"]
    assert found["misplaced"][0]["violated"][0]["line"] == 7
    code, told, _ = deixis("memory", "stats", "--json", "--memory", taught)
    assert (code, json.loads(told)["lesson_ids"]) == (0, ["formal_dinner-1", "script1-1"])
    assert deixis("query", "ASK { ?x a dx:Layout . FILTER(?x = lx:nothing) }", "--memory", taught)[0] == 1


@pytest.mark.parametrize(
    ("command", "said"),
    [
        (["check", "formal_diner", "SECOND"], "did you mean 'formal_dinner'"),
        (["memory", "forget", "formal_diner-1"], "formal_dinner-1"),
        (["query", "INSERT DATA { <a:b> <a:c> 1 }"], "INSERT is refused"),
        (["query", "ASK { SERVICE <http://localhost/> { ?s ?p ?o } }"], "SERVICE is refused"),
    ],
)
def test_a_refusal_says_what_is_wrong(taught: Path, command: list[str], said: str) -> None:
    second = str(example("second_table.scene.json"))
    code, out, err = deixis(*(second if part == "SECOND" else part for part in command), "--memory", taught)
    assert (code, out) == (2, "")
    assert said in err


def test_nothing_is_made_where_only_reading_was_asked_for(tmp_path: Path) -> None:
    for command in (["show", "x"], ["query", "ASK {}"], ["memory", "stats"], ["memory", "forget", "x"]):
        code, _, err = deixis(*command, "--memory", tmp_path / "none")
        assert (code, err.count("\n")) == (2, 1)
    assert not (tmp_path / "none").exists()


def test_the_memory_is_where_the_environment_says(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("DEIXIS_MEMORY", str(tmp_path / "here"))
    assert default_memory() == tmp_path / "here"
    monkeypatch.delenv("DEIXIS_MEMORY")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    assert default_memory() == tmp_path / "deixis" / "memory"


@pytest.mark.slow
def test_an_import_that_contradicts_the_memory_is_refused(tmp_path: Path) -> None:
    scene = replace(formal_setting().without_labels(), unit="px")  # so that sizes have less weight
    says = FULL.read_text(encoding="utf-8").split("chair")[1].replace("napkin", "thing") + "thing is a "
    for name, kind in (("first", "Napkin"), ("second", "BreadBasket")):
        with Session(tmp_path / name) as session:
            session.learn(read_script(text=f"layout {name}\n{says} {kind}"), scene)
            (tmp_path / f"{name}.trig").write_text(export_memory(session.memory()), encoding="utf-8")
    code, _, err = deixis("memory", "import", tmp_path / "second.trig", "--memory", tmp_path / "first")
    assert (code, "no instance of 'thing' is possible" in err) == (2, True)
    with Session(tmp_path / "first") as session:
        assert export_memory(session.memory()) == (tmp_path / "first.trig").read_text(encoding="utf-8")


@pytest.mark.slow
def test_what_was_exported_comes_back_the_same(taught: Path, tmp_path: Path) -> None:
    assert deixis("memory", "export", "-o", tmp_path / "all.trig", "--memory", taught)[0] == 0
    assert deixis("memory", "import", tmp_path / "all.trig", "--memory", tmp_path / "new")[0] == 0
    assert deixis("memory", "export", "-o", tmp_path / "again.trig", "--memory", tmp_path / "new")[0] == 0
    assert (tmp_path / "again.trig").read_bytes() == (tmp_path / "all.trig").read_bytes()


@pytest.mark.parametrize("file", ["2nd", "left", "is", ".hidden", "-dash", 'my layout "q"', "a b#c", "名"])
def test_a_layout_named_by_its_file_can_be_shown_and_read(file: str, tmp_path: Path) -> None:
    path = tmp_path / f"{file}.layout"
    path.write_text("fork left of plate", encoding="utf-8")
    script = read_script(path)
    shown = layout_script(layout_concept(script, "x-1"), script.ontology)
    assert read_script(text=shown).name == layout_name(script)
    assert [str(fact) for fact in read_script(text=shown).facts] == ["left(fork, plate)"]
