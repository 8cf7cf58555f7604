"""The check of arguments against annotations, and its use by all public functions."""

from __future__ import annotations

import ast
import importlib
import inspect
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deixis
from deixis import arguments
from deixis.arguments import checks_arguments, require_fields
from deixis.errors import ArgumentError, DeixisError
from deixis.ontology.tbox import default_ontology
from deixis.perception.scene import Scene
from deixis.workflows.knowledge.unlearn import Selection


@checks_arguments
def takes(
    text: str = "",
    whole: int = 0,
    number: float = 0.0,
    flag: bool = False,
    path: str | Path | None = None,
    names: Sequence[str] = (),
    pair: tuple[str, int] = ("a", 1),
    pairs: Sequence[tuple[str, int]] = (),
    given: Mapping[str, Any] | None = None,
    call: Callable[[int], None] | None = None,
    scene: Scene | None = None,
) -> tuple[Any, ...]:
    return text, whole, number, flag, path, names, pair, pairs, given, call, scene


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("text", None, "a string"),
        ("text", b"ab", "a string"),
        ("whole", 1.5, "a whole number"),
        ("whole", "1", "a whole number"),
        ("number", "1", "a number"),
        ("number", 10**400, "a number"),
        ("number", np.zeros(2), "a number"),
        ("flag", "no", "True or False"),
        ("flag", 1, "True or False"),
        ("flag", np.zeros(2), "True or False"),
        ("path", 0, "a string, a path or None"),
        ("names", "fork", "a list of strings"),
        ("names", ["fork", 3], "a list of strings"),
        ("names", iter(["fork"]), "a list of strings"),
        ("names", {"fork": 1}, "a list of strings"),
        ("pair", (), "a tuple of a string and a whole number"),
        ("pair", ("a", "b"), "a tuple of a string and a whole number"),
        ("pairs", [("a", 1), ("a",)], "a list of tuples of a string and a whole number"),
        ("given", [1], "a mapping or None"),
        ("call", 3, "a function or None"),
        ("scene", {"objects": []}, "a Scene or None"),
    ],
)
def test_a_wrong_type_is_named_with_the_expected_one(name: str, value: Any, expected: str) -> None:
    with pytest.raises(ArgumentError, match=f"^`{name}` must be {expected}, got ") as caught:
        takes(**{name: value})
    assert isinstance(caught.value, DeixisError) and isinstance(caught.value, TypeError)
    assert "\n" not in str(caught.value)


def test_right_types_pass_as_they_are() -> None:
    given = ("a", 1, 2.5, True, Path("x"), ["a"], ("b", 2), [("c", 3)], {"k": 1}, print, Scene(()))
    assert takes(*given) == given
    assert takes(number=1, path="x")[2:5] == (1, False, "x")


def test_numbers_of_numpy_become_numbers_of_python() -> None:
    found = takes(whole=np.int64(3), number=np.float32(0.5), flag=np.bool_(True))[1:4]  # type: ignore[arg-type]
    assert (found, [type(value) for value in found]) == ((3, 0.5, True), [int, float, bool])


@pytest.mark.parametrize("path", ["", "a\0b"])
def test_a_path_is_not_empty_and_has_no_nul(path: str) -> None:
    with pytest.raises(ArgumentError, match="`path` must have at least one character, and no NUL"):
        takes(path=path)


def test_a_value_without_a_usable_repr_is_shown_by_its_type() -> None:
    class Odd:
        def __repr__(self) -> str:
            raise RuntimeError

    for value in (Odd(), 10**5000):
        with pytest.raises(ArgumentError, match="`text` must be a string, got "):
            takes(text=value)  # type: ignore[arg-type]


def test_fields_of_a_record_are_checked() -> None:
    require_fields(Selection(teacher="Ada"))
    with pytest.raises(ArgumentError, match="`lesson` must be a string or None, got 3"):
        Selection(lesson=3)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"relations": ("left",)}, "`relations` must be a list of Relations, got ('left',)"),
        ({"relations": ()}, "`relations` must have at least one relation, got none"),
        ({"subject": 3}, "`subject` must be a string, got 3"),
        ({"positive": "no"}, "`positive` must be True or False, got 'no'"),
        ({"weight": 0}, "`weight` must be above 0 and at most 1, got 0"),
        ({"weight": float("nan")}, "`weight` must be above 0 and at most 1, got nan"),
        ({"source": "supper.layout"}, "`source` must be a Source or None, got 'supper.layout'"),
    ],
)
def test_fields_of_a_fact_are_checked(given: dict[str, Any], message: str) -> None:
    left = default_ontology().relations["left"]
    with pytest.raises(DeixisError, match=f"^{re.escape(message)}$"):
        deixis.Fact(**{"subject": "fork", "relations": (left,), "object": "plate"} | given)


def test_the_relations_of_a_fact_may_be_a_list() -> None:
    left = default_ontology().relations["left"]
    assert deixis.Fact("fork", [left], "plate") == deixis.Fact("fork", (left,), "plate")  # type: ignore[arg-type]


def _is_protocol(kind: type) -> bool:
    return bool(getattr(kind, "_is_protocol", False))


def _public() -> Iterator[tuple[str, Callable[..., Any]]]:
    """Yield the public functions, and the methods of the classes that users call."""
    for name in deixis.__all__:
        if inspect.isfunction(found := getattr(deixis, name)):
            yield name, found
    for kind in (deixis.Session, deixis.Robot):
        yield from _methods(kind)


def _methods(kind: type) -> Iterator[tuple[str, Callable[..., Any]]]:
    """Yield the public methods of a class that have a parameter."""
    for name, method in inspect.getmembers(kind, inspect.isfunction):
        if not name.startswith("_") and len(inspect.signature(method).parameters) > 1:
            yield f"{kind.__name__}.{name}", method


def _methods_of_exported_classes() -> Iterator[tuple[str, Callable[..., Any]]]:
    """Yield the methods of all other exported classes, those of base classes once."""
    kinds = [kind for name in deixis.__all__ if inspect.isclass(kind := getattr(deixis, name))]
    found = [each for kind in kinds if kind not in (deixis.Session, deixis.Robot) for each in _methods(kind)]
    unchecked = deixis.PointCloud.take  # NumPy checks its array
    yield from {method: (name, method) for name, method in found if method is not unchecked}.values()


@pytest.mark.parametrize("kind", [Scene, deixis.PerceivedObject, deixis.OrientedBox, Selection])
def test_each_field_of_a_checked_record_has_a_known_type(kind: type) -> None:
    module = importlib.import_module(kind.__module__)
    for name, annotation in kind.__annotations__.items():
        words = set(re.findall(r"[A-Za-z]\w*", annotation)) - set(arguments.UNCHECKED) - set(arguments.PROTOCOLS)
        for word in words - set(arguments._KNOWN) - set(arguments.MANY):
            assert inspect.isclass(getattr(module, word, dict)) and not _is_protocol(getattr(module, word, dict)), (
                name,
                word,
            )


@pytest.mark.parametrize(("name", "function"), list(_public()))
def test_every_public_function_checks_its_arguments(name: str, function: Callable[..., Any], tmp_path: Path) -> None:
    required = [p for p in inspect.signature(function).parameters.values() if p.name != "self"]
    given: dict[str, Any] = {p.name: object() for p in required if p.default is p.empty or p.name in ("path", "text")}
    given = given or {required[0].name: object()}
    with pytest.raises(DeixisError, match=r"must be|from parsed JSON"):
        function(*([deixis.Session(tmp_path / "memory")] if "." in name else []), **given)


@pytest.mark.parametrize(("name", "method"), list(_methods_of_exported_classes()))
def test_methods_of_exported_classes_check_their_arguments(name: str, method: Callable[..., Any]) -> None:
    required = [p for p in inspect.signature(method).parameters.values() if p.name != "self"]
    with pytest.raises(DeixisError, match=r"^`.*` must be "):
        method(None, **{p.name: object() for p in required})


@pytest.mark.parametrize(("name", "function"), [*_public(), *_methods_of_exported_classes()])
def test_each_name_in_a_checked_annotation_is_a_class(name: str, function: Callable[..., Any]) -> None:
    function = inspect.unwrap(function)
    module = inspect.getmodule(function)
    assert module is not None
    imported = {
        alias.asname or alias.name: node.module
        for node in ast.walk(ast.parse(inspect.getsource(module)))
        if isinstance(node, ast.ImportFrom) and node.module
        for alias in node.names
    }
    known = {*arguments.UNCHECKED, *arguments.FUNCTIONS, *arguments.MANY, *arguments.PROTOCOLS, *arguments._KNOWN}
    for parameter, annotation in function.__annotations__.items():
        shown = re.sub(r"Callable\[\[[^]]*\], [^]]*\]", "Callable", annotation)
        used = {node.id for node in ast.walk(ast.parse(shown)) if isinstance(node, ast.Name)}
        for word in used - known if parameter != "return" else ():
            found = getattr(module, word, None) or getattr(importlib.import_module(imported[word]), word)
            assert inspect.isclass(found) and not _is_protocol(found), (name, parameter, word)
