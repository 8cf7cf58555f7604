"""Two small lessons in the model of the ontology, and memories with them."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pyoxigraph as ox
import pytest

from deixis.memory.semantic.exchange import export_memory
from deixis.memory.semantic.rdf.files import PREFIXES
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.memory.semantic.store import SemanticMemory

Contributions = dict[GraphName, list[ox.Triple]]
Read = Callable[[str], list[ox.Triple]]
MakeLesson = Callable[..., Contributions]

LEARNED = """
<L/layout/NAME> a owl:Class ; rdfs:label "formal_dinner" ; dcterms:title "Formal dinner" ;
    rdfs:subClassOf dx:Layout, <https://w3id.org/deixis/.well-known/genid/NAME.r1> ;
    dx:describedFrom <L/viewpoint/chair> ; dx:learnedIn <L/lesson/NAME> .
<https://w3id.org/deixis/.well-known/genid/NAME.r1> a owl:Restriction ; owl:onProperty dx:shows ;
    owl:someValuesFrom dx:DinnerPlate .
<L/layout/NAME/role/dinner_plate> a dx:Role ; rdfs:label "dinner_plate" ; dx:inLayout <L/layout/NAME> ;
    dx:ofKind dx:DinnerPlate ; dx:kindDeclared false ; dx:position 1 .
<L/layout/NAME/role/fish_knife> a dx:Role ; rdfs:label "fish_knife" ; dx:inLayout <L/layout/NAME> ;
    dx:ofKind KIND ; dx:kindDeclared true ; dx:position 2 .
<L/layout/NAME/role/salad_fork> a dx:Role ; rdfs:label "salad_fork" ; dx:inLayout <L/layout/NAME> ;
    dx:ofKind dx:Fork ; dx:kindDeclared false ; dx:position 3 ;
    dx:interchangeableWith <L/layout/NAME/role/dinner_fork> .
<L/layout/NAME/role/dinner_fork> a dx:Role ; rdfs:label "dinner_fork" ; dx:inLayout <L/layout/NAME> ;
    dx:ofKind dx:Fork ; dx:kindDeclared false ; dx:position 4 ;
    dx:interchangeableWith <L/layout/NAME/role/salad_fork> .
<L/layout/NAME/fact/1> a dx:RelationStatement ; dx:inLayout <L/layout/NAME> ;
    dx:subject <L/layout/NAME/role/fish_knife> ; dx:object <L/layout/NAME/role/dinner_plate> ; dx:relation dx:right ;
    dx:positive true ; dx:optional false ; dx:weight 1.0 ; dx:line 3 ; dx:statedAt "dinner.layout:3:1" ; dx:position 1 .
<L/layout/NAME/fact/2> a dx:RelationStatement ; dx:inLayout <L/layout/NAME> ;
    dx:subject <L/layout/NAME/role/salad_fork> ; dx:object <L/layout/NAME/role/dinner_plate> ; dx:relation dx:left ;
    dx:positive true ; dx:optional false ; dx:weight 0.7 ; dx:line 4 ; dx:statedAt "dinner.layout:4:1" ; dx:position 2 .
<L/layout/NAME/fact/3> a dx:RelationStatement ; dx:inLayout <L/layout/NAME> ;
    dx:subject <L/layout/NAME/role/dinner_fork> ; dx:object <L/layout/NAME/role/dinner_plate> ;
    dx:relation dx:left, dx:topLeft ;
    dx:positive true ; dx:optional true ; dx:weight 1.0 ; dx:line 5 ; dx:statedAt "dinner.layout:5:1" ; dx:position 3 .
<L/category/dinner_plate> a owl:Class ; rdfs:label "dinner plate" ; rdfs:subClassOf dx:DinnerPlate ;
    dx:learnedIn <L/lesson/NAME> .
<L/category/fish_knife> a owl:Class ; rdfs:label "fish knife" ; rdfs:subClassOf KIND ; dx:learnedIn <L/lesson/NAME> .
<L/lesson/NAME/match/dinner_plate> a dx:Match ; dx:ofRole <L/layout/NAME/role/dinner_plate> ;
    dx:perceivedAs <L/scene/SCENE/o1> ; dx:decided true ; dx:score 1.0 ; dx:category <L/category/dinner_plate> ;
    prov:wasGeneratedBy <L/lesson/NAME> .
<L/lesson/NAME/match/fish_knife> a dx:Match ; dx:ofRole <L/layout/NAME/role/fish_knife> ;
    dx:perceivedAs <L/scene/SCENE/o2> ; dx:decided true ; dx:score 0.9 ; dx:category <L/category/fish_knife> ;
    prov:wasGeneratedBy <L/lesson/NAME> .
<L/lesson/NAME/match/salad_fork> a dx:Match ; dx:ofRole <L/layout/NAME/role/salad_fork> ;
    dx:couldBe <L/scene/SCENE/o3>, <L/scene/SCENE/o4> ; dx:decided false ; dx:score 0.5 ;
    prov:wasGeneratedBy <L/lesson/NAME> .
<L/viewpoint/chair> a dx:Viewpoint ; rdfs:label "chair" .
"""

SCENE = """
<L/scene/SCENE> a dx:Scene ; dx:frame "table" ; dx:unit "m" ; dx:seenFrom <L/viewpoint/chair> .
<L/viewpoint/chair> a dx:Viewpoint ; rdfs:label "chair" .
"""

OBJECT = """
<L/scene/SCENE/ID> a dx:PerceivedObject ; dx:inScene <L/scene/SCENE> ; dx:identifier "ID" ;
    dx:minX LOW.0e0 ; dx:maxX HIGH.0e0 ; dx:minY 0.0e0 ; dx:maxY 1.5e0 .
"""

KNOWN = """
<L/scene/SCENE/o1> a <L/category/dinner_plate> ; dx:perceivedLabel "plate" ; dx:confidence 0.9 .
<L/scene/SCENE/o2> a <L/category/fish_knife> ; dx:exactlyRight <L/scene/SCENE/o1> .
<L/scene/SCENE/o3> dx:exactlyLeft <L/scene/SCENE/o1> .
"""

EPISODE = """
<L/lesson/NAME> a dx:Lesson ; rdfs:label "NAME" ; prov:used <L/scene/SCENE> ; dx:engine "exact" ; dx:provedBest true ;
    prov:startedAtTime "2026-11-2DAYT10:00:00+00:00"^^xsd:dateTime ;
    prov:endedAtTime "2026-11-2DAYT10:00:02.5+00:00"^^xsd:dateTime ;
    dx:softwareVersion "0.1.0" ; dx:scriptFile "dinner.layout" ;
    dx:scriptText "layout formal_dinner" ; dx:sceneText "{}" .
"""

INFERRED = """
<L/scene/SCENE/o1> a dx:DinnerPlate, dx:Plate .
<L/scene/SCENE/o2> a KIND ; dx:right <L/scene/SCENE/o1> .
"""


def _read(turtle: str) -> list[ox.Triple]:
    head = "".join(f"@prefix {prefix}: <{base}> .\n" for prefix, base in PREFIXES.items())
    text = head + turtle.replace("<L/", "<https://w3id.org/deixis/learned/")
    return [quad.triple for quad in ox.parse(text, format=ox.RdfFormat.TURTLE)]


@pytest.fixture
def read() -> Read:
    """Read Turtle with the known prefixes declared, where ``L/`` begins the IRIs of learned things."""
    return _read


def _make(name: str = "dinner-1", scene: str = "s1", kind: str = "dx:FishKnife", day: int = 1) -> Contributions:
    def filled(text: str) -> list[ox.Triple]:
        for word, value in (("NAME", name), ("SCENE", scene), ("KIND", kind), ("DAY", str(day))):
            text = text.replace(word, value)
        return _read(text)

    objects = [
        OBJECT.replace("ID", f"o{number}").replace("LOW", str(number)).replace("HIGH", str(number + 1))
        for number in range(1, 5)
    ]
    return {
        GraphName.LEARNED: filled(LEARNED),
        GraphName.ASSERTED: [triple for part in (SCENE, *objects, KNOWN) for triple in filled(part)],
        GraphName.EPISODES: filled(EPISODE),
        GraphName.INFERRED: filled(INFERRED),
    }


@pytest.fixture
def make_lesson() -> MakeLesson:
    """Return the contributions of a lesson; those to the inferred graph are what follows from it."""
    return _make


def teach(memory: SemanticMemory, name: str, **how: str | int) -> None:
    """Write a lesson to a memory, with all that follows from it and the other lessons."""
    said = _make(name, **how)  # type: ignore[arg-type]
    inferred = [*memory.triples(GraphName.INFERRED), *said.pop(GraphName.INFERRED)]
    memory.learn(name, said, inferred)


@pytest.fixture
def learn() -> Callable[..., None]:
    return teach


@pytest.fixture(scope="session")
def empty_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Empty closed memory, to be copied, which is faster than making one for each test."""
    folder = tmp_path_factory.mktemp("empty") / "memory"
    SemanticMemory.open(folder, create=True).close()
    return folder


@pytest.fixture(scope="session")
def kept_folder(empty_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Closed memory with one lesson."""
    folder = shutil.copytree(empty_folder, tmp_path_factory.mktemp("kept") / "memory")
    with SemanticMemory.open(folder) as memory:
        teach(memory, "dinner-1")
    return folder


@pytest.fixture(scope="session")
def empty_export(empty_folder: Path) -> str:
    """Export of an empty memory: the package only."""
    with SemanticMemory.open(empty_folder) as memory:
        return export_memory(memory)


@pytest.fixture(scope="session")
def kept_export(kept_folder: Path) -> str:
    """Export of the memory with one lesson."""
    with SemanticMemory.open(kept_folder) as memory:
        return export_memory(memory)


@pytest.fixture(scope="session")
def taught_folder(empty_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Closed memory with two lessons that differ about the kind of one object."""
    folder = shutil.copytree(empty_folder, tmp_path_factory.mktemp("taught") / "memory")
    with SemanticMemory.open(folder) as memory:
        teach(memory, "dinner-1")
        teach(memory, "dinner-2", scene="s2", kind="dx:DinnerKnife", day=2)
    return folder


@pytest.fixture
def memory(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[SemanticMemory]:
    """Memory of this test's own: empty, or ``taught`` if it uses that fixture."""
    template = "taught_folder" if "taught" in request.fixturenames else "empty_folder"
    with SemanticMemory.open(shutil.copytree(request.getfixturevalue(template), tmp_path / "memory")) as memory:
        yield memory


@pytest.fixture
def taught(memory: SemanticMemory) -> SemanticMemory:
    """Memory with two lessons that differ about the kind of one object."""
    return memory
