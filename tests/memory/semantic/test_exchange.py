"""Export a memory as text and import it; import valid and hostile files."""

from __future__ import annotations

import codecs
import io
from collections.abc import Callable
from pathlib import Path

import owlready2
import pyoxigraph as ox
import pytest
import rdflib

from deixis.memory.errors import ImportFormatError, MemoryFormatError, RejectedWriteError
from deixis.memory.semantic.exchange import export_memory, import_dump
from deixis.memory.semantic.rdf import files as rdf_files
from deixis.memory.semantic.rdf.graphs import MERGED, ORDER, GraphName
from deixis.memory.semantic.store import SemanticMemory

Learn = Callable[..., None]
Read = Callable[[str], list[ox.Triple]]

RDF = 'xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"'
XML = f'<rdf:RDF {RDF}><rdf:Description rdf:about="urn:a"><p xmlns="urn:">x</p></rdf:Description></rdf:RDF>'


@pytest.fixture
def dump(taught: SemanticMemory, tmp_path: Path) -> Path:
    file = tmp_path / "dump.trig"
    file.write_text(export_memory(taught), encoding="utf-8")
    return file


def exported(folder: Path, format: str = "trig") -> str:
    with SemanticMemory.open(folder) as memory:
        return export_memory(memory, format)


@pytest.mark.parametrize("format", ["trig", "turtle"])
def test_an_export_does_not_depend_on_the_order_of_learning(tmp_path: Path, learn: Learn, format: str) -> None:
    texts = []
    for order in ([1, 2], [2, 1]):
        with SemanticMemory.open(tmp_path / f"m{order}", create=True) as memory:
            for number in order:
                learn(memory, f"dinner-{number}", scene=f"s{number}", day=number)
            texts.append(export_memory(memory, format))
    assert texts[0] == texts[1]


def test_an_export_in_trig_comes_back_exactly(dump: Path, tmp_path: Path, taught: SemanticMemory) -> None:
    import_dump(dump, tmp_path / "new")
    assert exported(tmp_path / "new") == dump.read_text(encoding="utf-8")
    with SemanticMemory.open(tmp_path / "new") as memory:
        assert set(memory.store) == set(taught.store)


def test_n_quads_come_back_exactly(dump: Path, tmp_path: Path) -> None:
    quads = ox.parse(path=dump, format=ox.RdfFormat.TRIG)
    ox.serialize(quads, str(tmp_path / "dump.nq"), ox.RdfFormat.N_QUADS)
    import_dump(tmp_path / "dump.nq", tmp_path / "new")
    assert exported(tmp_path / "new") == dump.read_text(encoding="utf-8")


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_an_export_is_read_by_others(dump: Path, taught: SemanticMemory) -> None:
    quads = set(ox.parse(path=dump, format=ox.RdfFormat.TRIG))
    assert len(quads) == len([quad for quad in taught.store if quad.graph_name not in (MERGED, ORDER)])
    dataset = rdflib.Dataset()
    dataset.parse(dump, format="trig")
    assert sum(len(graph) for graph in dataset.graphs()) == len(quads)
    text = export_memory(taught, "turtle")
    assert len(rdflib.Graph().parse(data=text, format="turtle")) == len(set(ox.parse(text, format=ox.RdfFormat.TURTLE)))
    assert "genid" not in text
    assert "owl:Ontology" in text


def test_an_empty_memory_is_exported_and_comes_back(memory: SemanticMemory, tmp_path: Path) -> None:
    (tmp_path / "e.trig").write_text(export_memory(memory))
    (tmp_path / "new").mkdir()
    import_dump(tmp_path / "e.trig", tmp_path / "new")
    assert exported(tmp_path / "new") == (tmp_path / "e.trig").read_text()


def test_an_unknown_export_format(memory: SemanticMemory) -> None:
    with pytest.raises(ImportFormatError, match="must be trig or turtle"):
        export_memory(memory, "xml")


def test_merging_brings_the_lessons_that_are_missing(dump: Path, tmp_path: Path, learn: Learn) -> None:
    with SemanticMemory.open(tmp_path / "m", create=True) as memory:
        learn(memory, "dinner-1")
    import_dump(dump, tmp_path / "m")
    assert exported(tmp_path / "m") == dump.read_text(encoding="utf-8")
    import_dump(dump, tmp_path / "m")
    assert exported(tmp_path / "m") == dump.read_text(encoding="utf-8")


def test_merging_refuses_another_lesson_of_the_same_name(dump: Path, tmp_path: Path, learn: Learn) -> None:
    with SemanticMemory.open(tmp_path / "m", create=True) as memory:
        learn(memory, "dinner-1", kind="dx:Knife")
    before = exported(tmp_path / "m")
    with pytest.raises(RejectedWriteError, match="lesson 'dinner-1' differs from the one in the memory"):
        import_dump(dump, tmp_path / "m")
    assert exported(tmp_path / "m") == before


def test_loaded_triples_shared_with_a_lesson_survive_export(memory: SemanticMemory, tmp_path: Path, read: Read) -> None:
    triples = read("<urn:a> <urn:p> 1 . <urn:b> <urn:p> 2 .")
    memory.load({GraphName.ASSERTED: triples})
    memory.learn("one", {GraphName.ASSERTED: triples[:1]}, [])
    (tmp_path / "d.trig").write_text(export_memory(memory))
    import_dump(tmp_path / "d.trig", tmp_path / "new")
    with SemanticMemory.open(tmp_path / "new") as again:
        assert export_memory(again) == export_memory(memory)
        again.forget("one", [])
        assert set(again.triples(GraphName.ASSERTED)) == set(triples)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("k.ttl", "<urn:a> <urn:p> 'x' ; <http://www.w3.org/2002/07/owl#imports> <http://127.0.0.1:1/o> ."),
        ("k.nt", '<urn:a> <urn:p> "x" .'),
        ("k.rdf", XML),
        ("k.owl", f'<?xml version="1.0" encoding="UTF-8"?>\n{XML}'),
        ("k.xml", f"﻿{XML}"),
        ("k.trig", '<urn:a> <urn:p> "x" .'),
    ],
)
def test_plain_triples_become_a_lesson_named_after_the_file(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text, encoding="utf-8")
    import_dump(tmp_path / name, tmp_path / "m")
    with SemanticMemory.open(tmp_path / "m") as memory:
        assert memory.lessons() == ("k",)
        assert memory.query("ASK { <urn:a> <urn:p> 'x' }").boolean is True
        memory.forget("k", [])
        assert not list(memory.triples(GraphName.ASSERTED))


def test_relative_names_stand_under_a_fixed_base(tmp_path: Path) -> None:
    (tmp_path / "k.ttl").write_text("<x> <urn:p> <../../../y> .")
    import_dump(tmp_path / "k.ttl", tmp_path / "m")
    with SemanticMemory.open(tmp_path / "m") as memory:
        (triple,) = memory.triples(GraphName.ASSERTED)
    assert triple.subject == ox.NamedNode("https://w3id.org/deixis/imported/k/x")
    assert triple.object == ox.NamedNode("https://w3id.org/y")


def test_utf_16_is_read(tmp_path: Path) -> None:
    (tmp_path / "k.rdf").write_bytes(f'<?xml version="1.0" encoding="UTF-16"?>{XML}'.encode("utf-16"))
    import_dump(tmp_path / "k.rdf", tmp_path / "m")
    with SemanticMemory.open(tmp_path / "m") as memory:
        assert memory.query("ASK { <urn:a> <urn:p> 'x' }").boolean is True


DTD = f'<?xml version="1.0"?>\n<!DOCTYPE r [ <!ENTITY a "aaaa"> <!ENTITY b "&a;&a;"> ]>\n{XML}'


@pytest.mark.parametrize(
    "content",
    [
        DTD.encode(),
        DTD.lower().encode(),
        codecs.BOM_UTF8 + DTD.encode(),
        DTD.encode("utf-16"),
        DTD.encode("utf-16-le"),
        DTD.encode("utf-16-be"),
        DTD.encode("utf-32"),
        DTD.encode("utf-32-be"),
        DTD.replace("<!DOCTYPE", "<!\nDOCTYPE").encode(),
        (" " * 100_000 + DTD).encode(),
    ],
)
@pytest.mark.parametrize("ending", [".rdf", ".owl", ".xml", ".RDF"])
def test_a_dtd_is_refused_before_a_parser_sees_it(
    tmp_path: Path, content: bytes, ending: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("deixis.memory.semantic.rdf.files.ox.parse", None)
    (tmp_path / f"k{ending}").write_bytes(content)
    with pytest.raises(ImportFormatError, match=r"(?s)k\.\w+:\d+:\d+: a DTD .* is refused"):
        import_dump(tmp_path / f"k{ending}", tmp_path / "m")
    assert not (tmp_path / "m").exists()


@pytest.mark.parametrize(
    ("name", "content", "told"),
    [
        ("k.rdf", b'<?xml version="1.0" encoding="utf-7"?>+ADwAIQ-DOCTYPE', "encoding 'utf-7' is not supported"),
        ("k.rdf", b'<?xml version="1.0" encoding="cp037"?><x/>', "save it as UTF-8"),
        ("k.rdf", b"\x4c\x6f\xa7\x94\x93", "save it as UTF-8"),
        ("k.rdf", b"<a>", r"k\.rdf"),
        ("k.ttl", b"<urn:a> <urn:p>\n   oops .", r"k\.ttl:2:\d+: "),
        ("k.nt", b"\xff\xfe", r"k\.nt"),
        ("k.trig", b"<urn:g> { <urn:a> <urn:p> 1 }", "the graph <urn:g> is not one of a memory"),
        ("k.trig", b"_:g { <urn:a> <urn:p> 1 }", "a graph must be named by an IRI"),
        ("k.jsonld", b"{}", r"its name must end in \.trig, \.nq, \.ttl"),
        ("k", b"", "unknown format"),
        ("k.ttl", b"<urn:a> <urn:p> <<( <urn:a> <urn:p> 1 )>> .", "a triple inside a triple"),
    ],
)
def test_an_unreadable_file_is_a_one_line_error(tmp_path: Path, name: str, content: bytes, told: str) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ImportFormatError, match=told) as caught:
        import_dump(tmp_path / name, tmp_path / "m")
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "m").exists()


def test_no_file_and_too_large_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ImportFormatError, match="no such file"):
        import_dump(tmp_path / "k.ttl", tmp_path / "m")
    monkeypatch.setattr(rdf_files, "MAX_BYTES", 10)
    (tmp_path / "k.ttl").write_text("<urn:a> <urn:p> 'x' .")
    with pytest.raises(ImportFormatError, match="split it"):
        import_dump(tmp_path / "k.ttl", tmp_path / "m")


@pytest.mark.parametrize("there", [False, True])
def test_an_import_that_breaks_the_shapes_changes_nothing(tmp_path: Path, learn: Learn, there: bool) -> None:
    (tmp_path / "k.ttl").write_text("<urn:a> a <https://w3id.org/deixis/onto#Viewpoint> .")
    before = ""
    if there:
        with SemanticMemory.open(tmp_path / "m", create=True) as memory:
            learn(memory, "dinner-1")
            before = export_memory(memory)
    with pytest.raises(RejectedWriteError, match="a viewpoint has one name"):
        import_dump(tmp_path / "k.ttl", tmp_path / "m")
    if there:
        assert exported(tmp_path / "m") == before
    else:
        assert not (tmp_path / "m").exists()


def test_a_foreign_folder_takes_no_import(dump: Path, tmp_path: Path) -> None:
    (tmp_path / "f").mkdir()
    (tmp_path / "f" / "letter").write_text("dear")
    with pytest.raises(MemoryFormatError, match="is not a memory"):
        import_dump(dump, tmp_path / "f")


def test_owlready2_lists_all_individuals_of_a_turtle_export(taught: SemanticMemory) -> None:
    triples = [*ox.parse(input=export_memory(taught, "turtle"), format=ox.RdfFormat.TURTLE)]
    world = owlready2.World()
    content = ox.serialize((quad.triple for quad in triples), format=ox.RdfFormat.N_TRIPLES) or b""
    world.get_ontology("urn:all#").load(fileobj=io.BytesIO(content), format="ntriples", only_local=True)
    listed = {one.iri for one in world.individuals()}
    learned = {
        str(triple.subject.value)  # type: ignore[union-attr]
        for name in (GraphName.LEARNED, GraphName.ASSERTED, GraphName.EPISODES)
        for triple in taught.triples(name)
        if triple.predicate.value.endswith("#type") and "/owl#" not in str(triple.object)
    }
    assert learned and learned <= listed
    assert not listed & {one.iri for one in world.classes()}
    world.close()
