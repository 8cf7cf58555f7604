"""Read docstrings for the Python reference: numpydoc sections to reStructuredText, and names to links.

``docs/conf.py`` connects these functions to events of Sphinx.
"""

from __future__ import annotations

import ast
import re
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx
from sphinx.ext.napoleon import Config
from sphinx.ext.napoleon.docstring import NumpyDocstring
from sphinx.util.nodes import find_pending_xref_condition

SETTINGS: Any = Config(napoleon_google_docstring=False, napoleon_use_rtype=False)
LITERAL_OR_BAR = re.compile(r"``.*?``|`[^`]*`|\|")
ARRAY = re.compile(r"~?numpy\.ndarray\[tuple\[~?typing\.Any, \.\.\.\], ~?numpy\.dtype\[(?:~?numpy\.)?([\w.~]+)\]\]")


def read_sections(app: Sphinx, what: str, name: str, obj: object, options: Any, lines: list[str]) -> None:
    """Turn the numpydoc sections of a docstring into field lists, in place.

    Napoleon's own listener reads the docstring of a constant or attribute as ``type: description`` and so takes any
    sentence with a colon apart; here it is text. A vertical bar outside of code is a vertical bar and begins no
    substitution.
    """
    kind: Any = "object" if what in ("attribute", "data", "property") else what
    sections = NumpyDocstring("\n".join(lines), SETTINGS, app, kind, name, obj, options).lines()
    lines[:] = [LITERAL_OR_BAR.sub(lambda found: r"\|" if found[0] == "|" else found[0], line) for line in sections]


def shorten_arrays(
    app: Sphinx, what: str, name: str, obj: object, options: Any, signature: str | None, returns: str | None
) -> tuple[str | None, str | None]:
    """Write array types of a signature as ``NDArray[float64]`` rather than in full."""
    return tuple(text and ARRAY.sub(r"NDArray[\1]", text) for text in (signature, returns))  # type: ignore[return-value]


def qualify_names(app: Sphinx, page: nodes.document) -> None:
    """Give the short names of annotations their modules, as the module that uses them imports or defines them.

    Autodoc leaves names short that are imported for type checking only. Words of a numpydoc type that are not names of
    the module, as in ``ndarray (axes, n, n)``, are text.
    """
    for node in list(page.findall(pending_xref)):
        module, target = node.get("py:module"), node["reftarget"]
        if node.get("refdomain") != "py" or not module or _is_role(node):
            continue
        if full := full_name(module, target):
            node["reftarget"], node["refspecific"] = full, False
        elif node.get("refspecific") and "." not in target:
            either = find_pending_xref_condition(node, "*")
            node.replace_self(node.children if either is None else either.children)


def full_name(module: str, name: str) -> str | None:
    """Return the full name of what a module calls by a short one; a package also knows the names of its members.

    >>> full_name("deixis.workflows.grounding.ground", "Scene")
    'deixis.perception.scene.Scene'
    >>> full_name("deixis", "Ontology"), full_name("deixis", "axes")
    ('deixis.ontology.tbox.Ontology', None)
    """
    known = names_of(module)
    if name not in known and hasattr(import_module(module), "__path__"):
        homes = {found.rpartition(".")[0] for found in known.values() if found.startswith("deixis.")}
        return next((names_of(home)[name] for home in sorted(homes) if name in names_of(home)), None)
    return known.get(name)


@cache
def names_of(module: str) -> dict[str, str]:
    """Return the full names of what a module imports or defines, by the names that it uses."""
    file = import_module(module).__file__
    assert file is not None
    whole = ast.parse(Path(file).read_text(encoding="utf-8"))
    names = {
        node.name: f"{module}.{node.name}" for node in whole.body if isinstance(node, ast.ClassDef | ast.FunctionDef)
    }
    for node in ast.walk(whole):
        if isinstance(node, ast.ImportFrom) and node.module:
            names |= {alias.asname or alias.name: f"{node.module}.{alias.name}" for alias in node.names}
    return names


def keep_other_names(app: Sphinx, env: Any, node: pending_xref, text: nodes.Element) -> nodes.Element | None:
    """Leave a Python name that Sphinx did not find as text, unless a docstring promises something that is not there.

    Names of other projects stay text, since the build never fetches the inventories of other projects, and so do names
    of Deixis without a docstring.

    Returns
    -------
    Element or None
        None if a name under ``deixis`` does not exist, or if a role in a docstring names nothing known; Sphinx then
        reports it.
    """
    if node.get("refdomain") != "py":
        return None
    target = node["reftarget"]
    if target.startswith("deixis."):
        return text if _exists(target) else None
    return None if _is_role(node) and node.get("refspecific") else text


def _is_role(node: pending_xref) -> bool:
    """Return whether a cross-reference was written as a role in a docstring, rather than made of an annotation."""
    return bool(node.children) and isinstance(node.children[0], nodes.literal)


def _exists(name: str) -> bool:
    """Return whether a dotted name is that of a module, or of something in one."""
    module, _, attribute = name.rpartition(".")
    try:
        if find_spec(name) is not None:
            return True
    except ModuleNotFoundError:
        pass
    return hasattr(import_module(module), attribute)
