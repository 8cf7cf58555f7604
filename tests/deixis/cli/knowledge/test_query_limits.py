"""``deixis query`` within its limits: exit 3 and no part of the answer past them, and Ctrl-C ends it at once."""

from __future__ import annotations

import itertools
import os
import signal
import subprocess
import sys
from pathlib import Path

import pyoxigraph as ox
import pytest
from commands import deixis
from timing import BUSY_SECONDS

import deixis as package
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.memory.semantic.store import SemanticMemory

PRODUCT = "{ ?a ?b ?c . ?d ?e ?f . ?g ?h ?i . ?j ?k ?l }"
COUNT = f"SELECT (COUNT(*) AS ?n) {PRODUCT}"
ENDLESS = {
    "select": COUNT,
    "rows": f"SELECT * {PRODUCT}",
    "ask": f"ASK {{ {{ {COUNT} }} FILTER(?n < 0) }}",
    "construct": f"CONSTRUCT {{ <urn:n> <urn:p> ?n }} WHERE {{ {COUNT} }}",
    "describe": f"DESCRIBE ?n WHERE {{ {COUNT} }}",
}


@pytest.fixture(scope="module")
def memory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("asked") / "memory"
    with SemanticMemory.open(folder, create=True) as memory:
        p = ox.NamedNode("urn:p")
        triples = [ox.Triple(ox.NamedNode(f"urn:{i}"), p, ox.Literal(i)) for i in range(500)]
        memory.load({GraphName.ASSERTED: triples})
    return folder


@pytest.mark.parametrize("form", [[], ["--json"], ["--format", "csv"]], ids=["table", "json", "csv"])
@pytest.mark.parametrize("query", ENDLESS.values(), ids=ENDLESS)
def test_past_a_limit_nothing_is_printed(memory: Path, query: str, form: list[str]) -> None:
    limits = ["--time-limit", "0.3", "--memory-limit", "64"]
    code, out, err = deixis("query", query, "--memory", memory, *limits, *form)
    assert (code, out) == (3, "")
    assert err.startswith("deixis: query: ") and err.count("\n") == 1
    assert "limit" in err


def test_a_query_that_is_answered_in_time(memory: Path) -> None:
    assert deixis("query", "ASK { <urn:7> ?p 7 }", "--memory", memory, "--time-limit", "20")[0] == 0
    assert deixis("query", "ASK { <urn:7> ?p 8 }", "--memory", memory)[:2] == (1, "no\n")
    assert deixis("query", "ASK {}", "--memory", memory, "--time-limit", "-1")[0] == 2
    assert deixis("query", "ASK {}", "--memory", memory, "--memory-limit", "0")[0] == 2


@pytest.mark.parametrize(
    ("command", "limit"),
    [*itertools.product([("query", "ASK {}"), ("validate",), ("reason", "--engine", "rl")], ["9e9", "1e300", "inf"])],
)
def test_limits_beyond_those_of_the_system_do_not_limit(memory: Path, command: tuple[str, ...], limit: str) -> None:
    code, _, err = deixis(*command, "--memory", memory, "--time-limit", limit)
    assert (code, err) == (0, "")


def test_an_endless_limit_does_not_limit_a_process_of_java(tmp_path: Path) -> None:
    file = tmp_path / "kinds.ttl"
    file.write_text("<urn:Fork> a <http://www.w3.org/2002/07/owl#Class> .", encoding="utf-8")
    code, _, err = deixis("reason", file, "--engine", "hermit", "--time-limit", "inf")
    assert (code, err) == (0, "")


def test_any_memory_limit_can_be_given(memory: Path) -> None:
    assert deixis("query", "ASK {}", "--memory", memory, "--memory-limit", 10**20) == (0, "yes\n", "")


def test_ctrl_c_ends_a_query_at_once(memory: Path) -> None:
    code = (
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "import os, threading, time\n"
        "from deixis.memory.semantic.queries import process\n"
        "ask = process.QueryProcess.ask\n"
        "def told(*args):\n"
        "    threading.Timer(0.3, lambda: print('asking', flush=True)).start()\n"
        "    return ask(*args)\n"
        "process.QueryProcess.ask = told\n"
        "from deixis.cli.app import run; run()"
    )
    command = [sys.executable, "-c", code, "query", ENDLESS["select"], "--memory", str(memory)]
    env = {**os.environ, "PYTHONPATH": str(Path(package.__file__).parents[1])}
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=env) as ran:
        assert ran.stdout is not None and ran.stderr is not None
        assert ran.stdout.readline() == "asking\n"
        ran.send_signal(signal.SIGINT)
        assert ran.wait(timeout=BUSY_SECONDS) == 130
        assert (ran.stdout.read(), ran.stderr.read()) == ("", "")
    assert not (memory / "semantic.snapshot").exists()


def test_half_of_a_surrogate_pair_in_a_query_has_its_place(memory: Path) -> None:
    code, out, err = deixis("query", 'ASK { ?a ?b "\udcff" }', "--memory", memory)
    assert (code, out) == (2, "") and err.startswith(
        "deixis: query:1:14: this is not a character; write the query in UTF-8"
    )
