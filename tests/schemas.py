"""The published JSON Schemas, and the check of an answer against one."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

import pytest
from source_tree import ROOT

SCHEMAS = {path.name.removesuffix(".schema.json"): path for path in sorted((ROOT / "docs" / "schema").glob("*.json"))}


@cache
def contents(name: str) -> dict[str, Any]:
    """Return a schema as parsed JSON."""
    loaded: dict[str, Any] = json.loads(SCHEMAS[name].read_text(encoding="utf-8"))
    return loaded


@cache
def validator(name: str) -> Any:
    """Return a validator of one schema, which knows all others; skip the test where jsonschema is not installed."""
    jsonschema, referencing = pytest.importorskip("jsonschema"), pytest.importorskip("referencing")
    registry = referencing.Registry().with_resources(
        (contents(other)["$id"], referencing.Resource.from_contents(contents(other))) for other in SCHEMAS
    )
    return jsonschema.Draft202012Validator(contents(name), registry=registry)


def errors_in(name: str, data: Any) -> list[str]:
    """Return what is wrong with plain data by a schema, one message for each place."""
    return [f"{error.json_path}: {error.message}" for error in validator(name).iter_errors(data)]
