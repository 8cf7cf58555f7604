"""Assertions about scripts and scenes, whose messages show the alternatives, the derivation or the conflict."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from deixis.answers import rounded
from deixis.arguments import checks_arguments

if TYPE_CHECKING:
    from deixis.grammar.script import Script
    from deixis.perception.scene import Scene
    from deixis.reasoning.grounding.answers.answer import Grounding
    from deixis.workflows.grounding.check import Check
    from deixis.workflows.layouts.infer import Inference

TIME_LIMIT = 30.0
"""Seconds that an assertion may take; more counts as a failure."""


P = ParamSpec("P")
T = TypeVar("T")


def _errors_in_the_test(function: Callable[P, T]) -> Callable[P, T]:
    """Make the errors of bad input point to the line of the test, without the frames inside Deixis."""

    @wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> T:
        from deixis.errors import DeixisError

        __tracebackhide__ = True
        try:
            return function(*args, **kwargs)
        except DeixisError as error:
            raise error.with_traceback(None) from None

    return call


@_errors_in_the_test
def script_of(script: Script | str | Path, folder: Path | None = None) -> Script:
    """Return a script that is given as such, by its file, or as a text.

    Parameters
    ----------
    script
        A script; a string is the name of a file if it ends in ``.layout``, and else the text itself.
    folder
        Folder that names of files are relative to.

    Returns
    -------
    Script
        The script.
    """
    from deixis.grammar.script import Script
    from deixis.workflows.layouts.read import SCRIPT_ENDING, read_script

    if isinstance(script, Script):
        return script
    if isinstance(script, Path) or script.endswith(SCRIPT_ENDING):
        return read_script(_in(folder, script))
    return read_script(text=script)


@_errors_in_the_test
def scene_of(scene: Scene | str | Path | Mapping[str, Any], folder: Path | None = None) -> Scene:
    """Return a scene that is given as such, by its file, or as parsed JSON.

    Parameters
    ----------
    scene
        A scene, the name of its file, or parsed JSON.
    folder
        Folder that names of files are relative to.

    Returns
    -------
    Scene
        The scene.
    """
    from deixis.workflows.layouts.read import as_scene

    return as_scene(_in(folder, scene) if isinstance(scene, str | Path) else scene)


def _in(folder: Path | None, name: str | Path) -> Path:
    return Path(name) if folder is None else folder / name


@_errors_in_the_test
@checks_arguments
def assert_grounds(
    script: Script | str | Path,
    scene: Scene | str | Path | Mapping[str, Any],
    expected: Mapping[str, str | int | None],
    *,
    decided: bool = False,
    **options: Any,
) -> Grounding:
    """Assert that objects of a script are found to be certain things of a scene.

    Parameters
    ----------
    script
        A script, the name of its file (``.layout``), or its text.
    scene
        A scene, the name of its file, or parsed JSON.
    expected
        The id of the thing that each object is, or None for an object that is not there. Others may be anything.
    decided
        Require that each expected match is decided, that is, at least 0.99 probable.
    options
        Options of :func:`deixis.ground`, such as ``sizes=False``.

    Returns
    -------
    Grounding
        The whole answer, for further assertions.

    Raises
    ------
    AssertionError
        If an object is something else, is left out, or is not decided; the message lists each with its alternatives.
    DeixisError
        If the script or the scene cannot be read.

    Examples
    --------
    >>> table = {"objects": [
    ...     {"id": "o1", "min": [0, 0], "max": [0.03, 0.2]}, {"id": "o2", "min": [0.1, 0], "max": [0.35, 0.25]}]}
    >>> assert_grounds("fork left of plate", table, {"fork": "o1", "plate": "o2"})
    <Grounding 2 of 2 objects matched, 2 decided, 1 of 1 fact satisfied, fits 1.00>
    """
    from deixis.errors import DeixisError
    from deixis.report.grounding.ground import grounding_lines
    from deixis.workflows.grounding.ground import ground

    __tracebackhide__ = True
    described = script_of(script)
    unknown = [name for name in expected if name not in described.objects]
    if unknown:
        known = ", ".join(described.objects)
        raise DeixisError(f"`expected` names '{unknown[0]}', which the script does not mention; it mentions {known}")
    seen = scene_of(scene)
    strange = [str(thing) for thing in expected.values() if thing is not None and str(thing) not in seen.ids]
    if strange:
        raise DeixisError(f"`expected` names '{strange[0]}', which is not in the scene; it has {', '.join(seen.ids)}")
    found = ground(described, seen, **{"time_limit": TIME_LIMIT, **options})
    wrong = []
    for name, thing in expected.items():
        match = found.matches.get(name)
        got = None if match is None else match.perceived
        if got != (None if thing is None else str(thing)):
            wrong.append(f"{name} must be {thing or 'absent'}, got {got or 'absent'}")
        elif decided and match is not None and not match.decided:
            probability = "" if match.probability is None else f" (probability {rounded(match.probability)})"
            others = ", ".join(other.perceived or "absent" for other in match.alternatives)
            wrong.append(f"{name} is {got}{probability} and not decided; it could be {others or 'something else'}")
    if wrong:
        raise AssertionError("\n".join([*wrong, "The whole grounding:", *grounding_lines(found)]))
    return found


@_errors_in_the_test
@checks_arguments
def assert_follows(script: Script | str | Path, fact: str) -> Inference:
    """Assert that a fact follows from a script in the wide reading, or is stated in it.

    Parameters
    ----------
    script
        A script, the name of its file (``.layout``), or its text.
    fact
        The fact, such as ``left(fork, plate)``.

    Returns
    -------
    Inference
        The facts that follow, for further assertions.

    Raises
    ------
    AssertionError
        If it does not follow; the message shows a picture without it, or why it cannot hold.

    Examples
    --------
    >>> assert_follows("fork left of plate; plate left of knife", "left(fork, knife)")
    <Inference 2 stated facts: consistent>
    """
    from deixis.reasoning.entailment.why_not import why_not
    from deixis.report.layouts.script import why_not_lines

    __tracebackhide__ = True
    inference, claim = _inferred(script, fact)
    if inference.implications.derive(claim.relations[0], claim.subject, claim.object) is None:
        raise AssertionError("\n".join(why_not_lines(why_not(inference.implications, claim))))
    return inference


@_errors_in_the_test
@checks_arguments
def assert_not_follows(script: Script | str | Path, fact: str) -> Inference:
    """Assert that a fact does not follow from a script.

    Parameters
    ----------
    script
        A script, the name of its file (``.layout``), or its text.
    fact
        The fact, such as ``left(fork, plate)``.

    Returns
    -------
    Inference
        The facts that follow, for further assertions.

    Raises
    ------
    AssertionError
        If it follows; the message shows its derivation.

    Examples
    --------
    >>> assert_not_follows("fork left of plate", "left(plate, fork)")
    <Inference 1 stated fact: consistent>
    """
    __tracebackhide__ = True
    inference, claim = _inferred(script, fact)
    derivation = inference.implications.derive(claim.relations[0], claim.subject, claim.object)
    if derivation is not None:
        raise AssertionError("\n".join([f"{claim} follows:", *derivation.lines()]))
    return inference


@_errors_in_the_test
@checks_arguments
def assert_consistent(script: Script | str | Path) -> Inference:
    """Assert that a script does not contradict itself.

    Parameters
    ----------
    script
        A script, the name of its file (``.layout``), or its text.

    Returns
    -------
    Inference
        The facts that follow, for further assertions.

    Raises
    ------
    AssertionError
        If it contradicts itself; the message shows the minimal conflict.

    Examples
    --------
    >>> assert_consistent("fork left of plate")
    <Inference 1 stated fact: consistent>
    """
    from deixis.report.layouts.script import inference_lines
    from deixis.workflows.layouts.infer import infer

    __tracebackhide__ = True
    inference = infer(script_of(script), TIME_LIMIT)
    if not inference.decided:
        raise AssertionError(f"time limit of {TIME_LIMIT:g} s reached before it was known whether the script can hold")
    if not inference.consistent:
        raise AssertionError("\n".join(inference_lines(inference)))
    return inference


@_errors_in_the_test
@checks_arguments
def assert_contradictory(script: Script | str | Path) -> Inference:
    """Assert that a script contradicts itself.

    Parameters
    ----------
    script
        A script, the name of its file (``.layout``), or its text.

    Returns
    -------
    Inference
        The minimal conflict, for further assertions.

    Raises
    ------
    AssertionError
        If it does not; the message gives boxes that satisfy it.

    Examples
    --------
    >>> assert_contradictory("fork left of plate; plate left of fork")
    <Inference 2 stated facts: contradictory>
    """
    from deixis.report.layouts.imagine import imagination_lines
    from deixis.workflows.layouts.imagine import imagine
    from deixis.workflows.layouts.infer import infer

    __tracebackhide__ = True
    read = script_of(script)
    inference = infer(read, TIME_LIMIT)
    if not inference.decided:
        raise AssertionError(f"time limit of {TIME_LIMIT:g} s reached before it was known whether the script can hold")
    if inference.consistent:
        example = imagination_lines(imagine(read, any_size=True))
        raise AssertionError("\n".join(["the script does not contradict itself; this table satisfies it:", *example]))
    return inference


@_errors_in_the_test
@checks_arguments
def assert_checks(
    layout: Script | str | Path,
    scene: Scene | str | Path | Mapping[str, Any],
    *,
    missing: Collection[str] = (),
    misplaced: Collection[str] = (),
    miscoloured: Collection[str] = (),
    extra: Collection[str] = (),
) -> Check:
    """Assert that a table is laid as a layout says, or has exactly the faults that are named.

    Parameters
    ----------
    layout
        A script, the name of its file (``.layout``), or its text.
    scene
        A scene, the name of its file, or parsed JSON.
    missing, misplaced, miscoloured
        Objects of the layout that must have this fault, and no others.
    extra
        Ids of the things that must be called extra, and no others.

    Returns
    -------
    Check
        The check, for further assertions.

    Raises
    ------
    AssertionError
        If the faults are others; the message lists what ``deixis check`` prints.

    Examples
    --------
    >>> table = {"objects": [
    ...     {"id": "o1", "label": "fork", "min": [0, 0], "max": [0.03, 0.2]},
    ...     {"id": "o2", "label": "plate", "min": [0.1, 0], "max": [0.35, 0.25]}]}
    >>> assert_checks("fork left of plate; knife right of plate", table, missing=["knife"])
    <Check of 'text': not as described, 2 correct, 1 missing>
    """
    from deixis.report.layouts.script import check_lines
    from deixis.workflows.grounding.check import check

    __tracebackhide__ = True
    checked = check(script_of(layout), scene_of(scene), TIME_LIMIT)
    found: dict[str, set[str]] = {"missing": set(), "misplaced": set(), "miscoloured": set()}
    for role in checked.table.roles:
        if role.verdict.value in found:
            found[role.verdict.value].add(role.role)
    found["extra"] = {thing.perceived for thing in checked.table.extra}
    wanted = {"missing": missing, "misplaced": misplaced, "miscoloured": miscoloured, "extra": extra}
    wrong = [
        f"{fault} must be {_listed(wanted[fault])}, got {_listed(names)}"
        for fault, names in found.items()
        if names != set(wanted[fault])
    ]
    if not wrong and not any(wanted.values()) and not checked.table.well:
        wrong = ["no fault is expected, but facts are violated"]
    if wrong:
        raise AssertionError("\n".join([*wrong, *check_lines(checked)]))
    return checked


def _listed(names: Collection[str]) -> str:
    return ", ".join(sorted(names)) or "empty"


def _inferred(script: Script | str | Path, fact: str) -> tuple[Inference, Any]:
    from deixis.workflows.layouts.infer import plain_fact, require_names

    inference = assert_consistent(script)
    claim = plain_fact(fact, "`fact`")
    require_names(inference, claim, "`fact`")
    return inference, claim
