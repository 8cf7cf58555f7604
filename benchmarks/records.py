"""Keep the figures of benchmarks as JSON records, and write ``docs/benchmarks.md`` from them.

A benchmark opens ``recorded(parser)`` and calls ``share``, ``mean``, ``ratio``, ``count``, ``seconds`` or ``figure``
for the figures that documents may quote. With ``--record`` they are written to ``benchmarks/recorded/NAME.json``; NAME
is the run of ``RUNS`` with the same options. Each file keeps the last recordings, so that the report shows the change.
``make bench`` records all runs, ``make report`` writes the page.

The commit of a recording is the last one that changed the measured code (``MEASURED``). Times depend on what else the
machine does: on a busy machine, figures in seconds are left out, and only ratios to a peer in the same run are kept.
"""

from __future__ import annotations

import argparse
import datetime
import json
import math
import os
import platform
import statistics
import subprocess
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "benchmarks" / "recorded"
PAGE = ROOT / "docs" / "benchmarks.md"
MEASURED = ("ontology", "reasoning", "grammar", "perception", "memory", "src", "examples", "pyproject.toml")
"""Files whose last commit a recording names."""

KEPT = 5
"""Number of recordings that a file keeps."""

BUSY = 0.25
"""Number of other running programs per core above which times are left out."""

RUNNING = Path("/proc/loadavg")
"""Linux's file with the number of programs that run now, the reader included."""

MEASURES_OF_A_CASE = 1.5
"""Minimum mean number of figures named ``case: measure`` per case at which they form a table."""

NORMAL_95 = 1.96
"""Half of the 95 per cent interval of a normal distribution, in standard deviations."""


@dataclass(frozen=True)
class Run:
    """A benchmark with the options under which its figures are recorded.

    Attributes
    ----------
    name
        Name of the record file.
    area, measures
        Heading and title on the page.
    benchmark
        Module without ``bench_``; the name of the run by default.
    options
        Options on the command line.
    data
        Whether it reads the public data that ``DEIXIS_DATA`` names.
    """

    name: str
    area: str
    measures: str
    benchmark: str = ""
    options: str = ""
    data: bool = False

    @property
    def file(self) -> Path:
        """The benchmark's module."""
        return ROOT / "benchmarks" / f"bench_{self.benchmark or self.name}.py"

    @property
    def record(self) -> Path:
        """The file of the recordings."""
        return FOLDER / f"{self.name}.json"

    @property
    def command(self) -> str:
        """The command that prints the figures."""
        return f"python benchmarks/{self.file.name} {self.options}".strip()


RUNS = (
    Run("graded", "Grounding", "photographs with people's descriptions", options="--orders 10 --halves", data=True),
    Run("graded-tables", "Grounding", "generated tables of 12 objects", "graded", "--tables 60"),
    Run("faults", "Grounding", "decided matches on tables that contradict their descriptions"),
    Run("fits", "Grounding", "descriptions of another scene that are noticed", data=True),
    Run("large", "Grounding", "calibration and limits in large scenes", options="--limit 15"),
    Run("matching", "Grounding", "engines of the matching problem beside CP-SAT, FAQ and annealing"),
    Run("peers", "Grounding", "settings of the peers of the scoreboard"),
    Run("posterior", "Grounding", "marginals beside those of a longer run"),
    Run(
        "scoreboard",
        "Grounding",
        "engines and peers on tables and photographs: share named right",
        options="--cases 3 --time-limit 2",
        data=True,
    ),
    Run("onecommon", "Grounding", "dots described by people", data=True),
    Run("vrd", "Grounding", "photographs, each engine", data=True),
    Run("retrieval", "Grounding", "layouts found by scenes, and scenes by layouts"),
    Run("subgraphs", "Grounding", "similarity of all sub-graphs of a script"),
    Run("detection", "Perception", "objects segmented in point clouds", data=True),
    Run("clouds", "Perception", "reading of point clouds"),
    Run("tracking", "Perception", "tracking of things while a hand moves them"),
    Run("live", "Perception", "the live robot, in stories of one table and two customers"),
    Run("recognition", "Perception", "search of the nearest views"),
    Run("recognition-tables", "Perception", "objects named on laid tables", "recognition", "--tables"),
    Run("naming", "Perception", "meshes of unseen objects named", data=True),
    Run("colour", "Perception", "real objects named by shape and by colour", data=True),
    Run("embedding", "Perception", "learned projections of descriptors", data=True),
    Run("spin_images", "Perception", "spin images"),
    Run("infer", "Reasoning", "inference of all that follows from a script"),
    Run("closure", "Reasoning", "algebraic closure of constraint networks"),
    Run("joint", "Reasoning", "networks of several calculi together"),
    Run("search", "Reasoning", "verdicts on hard constraint networks", data=True),
    Run("time", "Reasoning", "simple temporal networks"),
    Run("relations", "Reasoning", "relations of all pairs of boxes"),
    Run("description_logic", "Reasoning", "engines of description logic"),
    Run("memory", "Memory", "bulk load and queries"),
    Run("perceptual", "Memory", "views in LevelDB"),
    Run("blackboard", "Memory", "fluents on the blackboard, beside pyoxigraph and zenoh"),
    Run("growth", "Memory", "cost of a lesson after many lessons", options="--batch 0"),
    Run("kills", "Memory", "writes that are killed"),
    Run("shacl", "Memory", "validation of changed nodes"),
    Run("shapes", "Memory", "engines of SHACL"),
    Run("lexicon", "English", "nouns of public data sets that the lexicon has", data=True),
    Run("english_syntax", "English", "words and sentences that the parser understands", data=True),
    Run("tell", "English", "layouts and scenes written in English and read again", data=True),
    Run("english", "English", "facts of paragraphs about tables", options="--ground", data=True),
    Run("stepgame", "English", "relative positions stated in one to ten sentences", options="--sample 20", data=True),
    Run("refer", "English", "objects that descriptions of rooms refer to", data=True),
    Run("blocks", "English", "coloured blocks that instructions across a table pick", data=True),
    Run("habits", "Learning", "places of unseen things, from examples of where a person puts things", data=True),
    Run("laying", "Learning", "prediction of what is laid next, and where"),
    Run("laying-told", "Learning", "prediction of what is laid next, also from what a person said", "laying", "--told"),
    Run("laying-films", "Learning", "layings watched by a moving camera", "laying", "--films 4 --seed 21"),
    Run("activities", "Learning", "recognition of ways to lay a table, and of steps in the wrong order"),
    Run("attributes", "Learning", "adjectives with hidden meanings, learned from sentences"),
    Run("orientation", "Perception", "heads and handles found in simulated clouds"),
    Run("pointing", "Perception", "things that simulated teachers point at"),
    Run("startup", "Command line", "processor time of commands on small jobs"),
)
"""The recorded runs, in the order of the page. Each benchmark has one or more."""


@dataclass(frozen=True)
class Figure:
    """A measured number: its name, value, unit, 95 per cent interval, and the peer that it is relative to."""

    name: str
    value: float
    unit: str
    interval: tuple[float, float] | None = None
    peer: str | None = None

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON object, with four significant digits."""
        entry: dict[str, Any] = {"name": self.name, "value": _rounded(self.value), "unit": self.unit}
        if self.interval is not None:
            entry["interval"] = [_rounded(end) for end in self.interval]
        if self.peer is not None:
            entry["peer"] = self.peer
        return entry

    @classmethod
    def from_dict(cls, entry: dict[str, Any]) -> Figure:
        """Return the figure of a JSON object."""
        low_high = entry.get("interval")
        interval = None if low_high is None else (float(low_high[0]), float(low_high[1]))
        return cls(entry["name"], entry["value"], entry["unit"], interval, entry.get("peer"))


@dataclass
class Recording:
    """The figures of one run, with the commit, the date and the class of machine.

    ``number`` counts the commits up to and with this one, so that the page can say which are old; 0 if unknown.
    """

    commit: str
    date: str
    machine: str
    figures: list[Figure] = field(default_factory=list)
    number: int = 0

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON object."""
        figures = [figure.to_dict() for figure in self.figures]
        place = {"commit": self.commit, "number": self.number}
        return {**place, "date": self.date, "machine": self.machine, "figures": figures}

    @classmethod
    def from_dict(cls, entry: dict[str, Any]) -> Recording:
        """Return the recording of a JSON object."""
        figures = [Figure.from_dict(each) for each in entry["figures"]]
        return cls(entry["commit"], entry["date"], entry["machine"], figures, entry.get("number", 0))


_current: ContextVar[list[Figure] | None] = ContextVar("figures of the running benchmark", default=None)


def command_line(file: str, documentation: str | None) -> argparse.ArgumentParser:
    """Return the parser of a benchmark (``__file__``, ``__doc__``), with ``--help`` and ``--record``."""
    parser = argparse.ArgumentParser(
        prog=f"python benchmarks/{Path(file).name}",
        description=documentation,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--record", action="store_true", help="write the figures to benchmarks/recorded/")
    return parser


@contextmanager
def recorded(parser: argparse.ArgumentParser, arguments: Sequence[str] | None = None) -> Iterator[argparse.Namespace]:
    """Parse the options, and write the figures of the ``with`` block if ``--record`` is one of them.

    Raises
    ------
    SystemExit
        If no run of ``RUNS`` has these options, or measured files have changes that are not committed.
    """
    options = parser.parse_args(arguments)
    run = run_of(parser, options) if options.record else None
    if options.record and run is None:
        parser.error("`--record` must go with the options of a run in benchmarks/records.py; add a line to RUNS")
    commit, busy = (measured_commit(), is_busy()) if options.record else ("", False)
    figures: list[Figure] = []
    token = _current.set(figures)
    try:
        yield options
    finally:
        _current.reset(token)
    kept = [each for each in figures if not (busy and each.unit in ("s", "ms"))]
    if run is not None and kept:
        today = datetime.date.today().isoformat()
        write(run, Recording(commit, today, machine_class(), kept, commit_number(commit)))


def run_of(parser: argparse.ArgumentParser, options: argparse.Namespace) -> Run | None:
    """Return the run of a parser's benchmark that has these options, apart from ``--record``."""
    given = {**vars(options), "record": False}
    own = [run for run in RUNS if parser.prog.endswith(run.file.name)]
    return next((run for run in own if vars(parser.parse_args(run.options.split())) == given), None)


def figure(
    name: str, value: float, unit: str, interval: tuple[float, float] | None = None, peer: str | None = None
) -> None:
    """Record a figure of the running benchmark; ``peer`` is ``"program version"``. Skip infinite values."""
    figures = _current.get()
    if figures is not None and math.isfinite(value):
        figures.append(Figure(name, float(value), unit, interval, peer))


def share(name: str, right: int, of: int) -> None:
    """Record a share of independent cases, with Wilson's interval (1927)."""
    if of:
        z, p = NORMAL_95, right / of
        middle = (p + z * z / (2 * of)) / (1 + z * z / of)
        half = z * math.sqrt(p * (1 - p) / of + z * z / (4 * of * of)) / (1 + z * z / of)
        figure(name, p, "share", (max(0.0, middle - half), min(1.0, middle + half)))


def mean(name: str, values: Iterable[float], unit: str = "share") -> None:
    """Record a mean of independent values, with the interval of 1.96 standard errors."""
    known = list(map(float, values))
    if known:
        middle = statistics.fmean(known)
        half = NORMAL_95 * statistics.stdev(known) / math.sqrt(len(known)) if len(known) > 1 else math.inf
        figure(name, middle, unit, (middle - half, middle + half) if math.isfinite(half) else None)


def ratio(name: str, theirs: float, ours: float, peer: str) -> None:
    """Record how many times as long a peer takes, both measured in one run; ``peer`` is a package or a program."""
    figure(name, theirs / ours, "times as long", peer=peer_version(peer))


def count(name: str, value: int) -> None:
    """Record a number of cases."""
    figure(name, value, "count")


def seconds(name: str, value: float) -> None:
    """Record a time, which is left out if the machine was busy."""
    figure(name, value, "s")


def peer_version(package: str) -> str:
    """Return ``"package version"``, or the name alone of what is not a Python package."""
    try:
        return f"{package} {version(package)}"
    except PackageNotFoundError:
        return package


def machine_class() -> str:
    """Return the architecture and the number of cores that this process may use, such as ``x86-64, 2 cores``."""
    architecture = platform.machine().replace("_", "-").replace("AMD64", "x86-64")
    return f"{architecture}, {len(os.sched_getaffinity(0))} cores"


def is_busy() -> bool:
    """Return whether other programs load the machine so that times mean little.

    The programs that run now count: the load average of the last minute includes a benchmark that has just ended.
    """
    samples = []
    for _ in range(20):
        time.sleep(0.1)
        samples.append(int(RUNNING.read_text(encoding="ascii").split()[3].split("/")[0]) - 1)
    return statistics.fmean(samples) > BUSY * len(os.sched_getaffinity(0))


def measured_commit() -> str:
    """Return the last commit that changed the measured files; exit if they have changes that are not committed."""

    def git(*arguments: str) -> str:
        command = ["git", *arguments, "--", *MEASURED]
        return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()

    if git("status", "--porcelain"):
        raise SystemExit(f"commit the changes in {', '.join(MEASURED)} before you record figures of them")
    return git("log", "-1", "--format=%h")


def commit_number(commit: str) -> int:
    """Return the number of commits up to and with a commit, 0 if git does not know it."""
    done = subprocess.run(["git", "rev-list", "--count", commit], cwd=ROOT, capture_output=True, text=True, check=False)
    return int(done.stdout) if done.returncode == 0 else 0


def read(run: Run) -> list[Recording]:
    """Return the recordings of a run, the last one first."""
    if not run.record.exists():
        return []
    contents = json.loads(run.record.read_text(encoding="utf-8"))
    return [Recording.from_dict(entry) for entry in contents["recordings"]]


def write(run: Run, recording: Recording) -> None:
    """Put a recording before the others of its run; replace one of the same commit."""
    others = [each for each in read(run) if each.commit != recording.commit]
    recordings = [each.to_dict() for each in (recording, *others)][:KEPT]
    contents = {"name": run.name, "command": run.command, "recordings": recordings}
    FOLDER.mkdir(exist_ok=True)
    run.record.write_text(json.dumps(contents, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def page() -> str:
    """Return the text of ``docs/benchmarks.md``, as the records give it."""
    lines = [
        "# Benchmarks",
        "",
        "The command above each table prints the figures of the table. With `--record` it also writes them to",
        "`benchmarks/recorded`, and `make report` makes this page from these records. Run the commands in the root",
        "folder of the repository. A star (*) marks commands that read public data that does not come with Deixis;",
        "`DEIXIS_DATA` names the folder of that data ([which data](explanation/figures.md)). Brackets hold 95 per cent",
        "intervals. *Times as long* is the time of the named peer divided by that of Deixis in the same run. Times in",
        "seconds are recorded only on an idle machine. A signed number in italics is the change of the value since the",
        "recording before.",
        "",
        "*Old* marks a record that is older than the newest one on this page, by the stated number of commits. The",
        "measured code may have changed since; `git diff --stat COMMIT` lists the changed files.",
    ]
    recordings = {run.name: read(run) for run in RUNS}
    newest = max((each[0].number for each in recordings.values() if each), default=0)
    for area in dict.fromkeys(run.area for run in RUNS):
        lines += ["", f"## {area}"]
        for run in (each for each in RUNS if each.area == area):
            lines += ["", f"### {run.measures[0].upper()}{run.measures[1:]}", ""]
            lines += [f"`{run.command}`{' *' if run.data else ''}", "", *_table(recordings[run.name], newest)]
    return "\n".join(lines) + "\n"


def _table(recordings: list[Recording], newest: int) -> list[str]:
    """Return the lines of a run: a row for each case and a column for each measure if its figures form a table.

    A figure named ``case: measure`` belongs in such a table.
    """
    if not recordings:
        return ["Not recorded yet."]
    last = recordings[0]
    before = {(each.name, each.unit): each.value for each in recordings[1].figures} if len(recordings) > 1 else {}
    since = f" Changes are those since `{recordings[1].commit}`." if before else ""
    age = newest - last.number
    old = f" *Old*, by {age} commit{'s' if age > 1 else ''}." if last.number and age else ""
    lines = [f"Commit `{last.commit}`, {last.date}, {last.machine}.{old}{since}", ""]
    cells: dict[str, dict[str, str]] = {}
    for each in last.figures:
        case, _, measure = each.name.rpartition(": ")
        cells.setdefault(case, {})[f"{measure}{_peer_and_unit(each)}"] = _cell(each, before)
    measures = list(dict.fromkeys(measure for row in cells.values() for measure in row))
    if "" in cells or len(last.figures) < MEASURES_OF_A_CASE * len(cells):
        rows = [(f"{each.name}{_peer_and_unit(each)}", _cell(each, before)) for each in last.figures]
        return [*lines, *_rows(("figure", "value"), rows)]
    return [*lines, *_rows(("case", *measures), [(case, *map(row.get, measures)) for case, row in cells.items()])]


def _rows(heads: Sequence[str], rows: Iterable[Sequence[str | None]]) -> Iterator[str]:
    for row in (heads, ["---"] * len(heads), *rows):
        yield f"| {' | '.join(cell or '' for cell in row)} |"


def _peer_and_unit(figure: Figure) -> str:
    """Return what follows the name of a figure, such as ``, rdflib 7.6.0 (times as long)``."""
    peer = "" if figure.peer is None else f", {figure.peer}"
    return peer if figure.unit in ("share", "count") else f"{peer} ({figure.unit})"


def _cell(figure: Figure, before: Mapping[tuple[str, str], float]) -> str:
    """Return the value, its interval, and its change; the interval of a share is cut off at 0 and 1."""
    interval = ""
    if figure.interval is not None:
        low, high = figure.interval
        ends = (max(low, 0.0), min(high, 1.0)) if figure.unit == "share" else (low, high)
        interval = " ({} to {})".format(*map(_shown, ends))
    earlier = before.get((figure.name, figure.unit))
    change = "" if earlier is None else _signed(figure.value - earlier)
    return f"{_shown(figure.value)}{interval}{change and f', *{change}*'}"


def _rounded(value: float) -> float | int:
    short = float(f"{value:.4g}")
    return int(short) if short.is_integer() else short


def _shown(value: float) -> str:
    return f"{float(f'{round(value, 9):.3g}'):,g}" if abs(value) < 1e6 else f"{value:,.0f}"


def _signed(change: float) -> str:
    shown = _shown(change)
    return "" if shown in ("0", "-0") else shown if change < 0 else f"+{shown}"


def main(arguments: Sequence[str] | None = None) -> None:
    """Write ``docs/benchmarks.md``, or list the commands of all runs."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--list", action="store_true", help="print the command of each run, with --record")
    if parser.parse_args(arguments).list:
        print("\n".join(f"{run.command} --record" for run in RUNS))
        return
    PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
