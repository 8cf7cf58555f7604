"""Verifying a memory: both stores are read, and a changed byte is detected or harmless."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pyoxigraph as ox
import pytest

from deixis.memory.errors import MemoryBusyError, MemoryFormatError
from deixis.memory.perceptual.in_folder import open_in
from deixis.memory.semantic.opening import open_memory
from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri
from deixis.memory.semantic.store import SemanticMemory
from deixis.memory.verify import Verified, verify

FLIPS = 2  # positions in each file


def fill(store: ox.Store) -> None:
    """Add some hundred quads in two graphs, with long and short terms, and numbers whose bytes are all ones."""
    for number in range(-1, 100):
        subject, word = ox.NamedNode(f"https://example.org/thing/{number}"), "long " * (number % 40)
        for graph in (GraphName.ASSERTED, GraphName.LEARNED):
            for value in (ox.Literal(number), ox.Literal(f"{word}{number}")):
                predicate = ox.NamedNode(f"https://example.org/says/{number % 7}")
                store.add(ox.Quad(subject, predicate, value, graph_iri(graph)))


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    open_memory(tmp_path / "memory", create=True, fill=fill).close()
    return tmp_path / "memory"


def content(folder: Path) -> dict[str, bytes]:
    return {str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def flips(file: Path, rng: random.Random) -> Iterator[int]:
    size = file.stat().st_size
    places = {0, size - 1, size // 2, *(rng.randrange(size) for _ in range(FLIPS))} if size else set()
    return (place for place in sorted(places) if 0 <= place < size)


def test_a_sound_memory_is_read_and_not_changed(kept: Path) -> None:
    before, seen = content(kept), list[tuple[int, int]]()
    assert verify(kept, lambda done, total: seen.append((done, total))) == Verified(True, False, ())
    assert content(kept) == before
    assert seen == [(done, 6) for done in range(1, 7)]


def test_a_flipped_byte_of_any_file_is_detected_or_harmless(kept: Path) -> None:
    rng, outcomes = random.Random(11), Counter[tuple[str, str]]()
    before = set(ox.Store.read_only(str(kept / "semantic")))
    for file in sorted(kept.rglob("*")):
        sound = file.read_bytes() if file.is_file() else b""
        for place in flips(file, rng) if sound else ():
            file.write_bytes(sound[:place] + bytes([sound[place] ^ 1]) + sound[place + 1 :])
            try:
                found = bool(verify(kept).findings)
            except MemoryFormatError:
                found = True  # this memory cannot be opened
            outcomes[file.suffix, "detected" if found else "harmless"] += 1
            if not found:
                assert set(ox.Store.read_only(str(kept / "semantic"))) == before, (file, place)
            file.write_bytes(sound)
    assert outcomes[".sst", "detected"] > 30
    assert outcomes[".sst", "detected"] > 5 * outcomes[".sst", "harmless"]
    assert verify(kept).findings == ()


def test_every_index_is_read(kept: Path) -> None:
    """Change a byte in the middle of each large table: it is detected, whichever index the table is of."""
    tables = [file for file in (kept / "semantic").glob("*.sst") if file.stat().st_size > 4000]
    assert len(tables) >= 7  # six indexes, and the texts
    for file in tables:
        sound = file.read_bytes()
        middle = len(sound) // 3
        file.write_bytes(sound[:middle] + bytes([sound[middle] ^ 1]) + sound[middle + 1 :])
        (first, *_) = verify(kept).findings
        assert first.where == "semantic"
        assert "\n" not in str(first)
        file.write_bytes(sound)


def test_a_store_that_does_not_open_is_a_finding(kept: Path) -> None:
    open_in(kept, create=True).close()
    (kept / "semantic" / "CURRENT").unlink()
    next((kept / "perceptual").glob("store-*/CURRENT")).unlink()
    found = verify(kept)
    assert (found.semantic, found.perceptual) == (True, True)
    assert [finding.where for finding in found.findings] == ["semantic", "perceptual"]


def test_missing_things_are_reported_missing(tmp_path: Path) -> None:
    assert verify(tmp_path) == Verified(False, False, ())
    open_in(tmp_path, create=True).close()
    assert verify(tmp_path) == Verified(False, True, ())


def test_a_memory_in_use_is_not_verified(kept: Path) -> None:
    with SemanticMemory.open(kept), pytest.raises(MemoryBusyError):
        verify(kept)
