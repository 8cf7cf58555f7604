"""Write the pages of the Python reference: one page per package, one section per module, in the order of the folders.

``make docs`` calls ``write_package_pages``. The text of each section comes from the docstrings, by way of autodoc.
"""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "src" / "deixis"
LEFT_OUT = {"cli", "examples"}
"""Packages without a page: the commands have a reference of their own, and the examples are files."""

MODULE = """\
.. automodule:: {name}
   :members:
"""


def write_package_pages(folder: Path) -> list[Path]:
    """Write the pages of all packages into a folder, and remove pages of packages that no longer exist.

    Parameters
    ----------
    folder
        The folder of the pages; it is made if needed. A page is written only if its text changes, so that Sphinx does
        not read it again.

    Returns
    -------
    list of Path
        The pages, sorted.
    """
    folder.mkdir(parents=True, exist_ok=True)
    every = dict(packages())
    pages = {folder / f"{name}.rst": package_page(name, path, list(every)) for name, path in every.items()}
    for page in set(folder.glob("*.rst")) - set(pages):
        page.unlink()
    for page, text in pages.items():
        if not page.exists() or page.read_text(encoding="utf-8") != text:
            page.write_text(text, encoding="utf-8")
    return sorted(pages)


def packages() -> Iterator[tuple[str, Path]]:
    """Yield the dotted name and the folder of each package of the reference, parents first.

    The packages at the top of the repository are found there, since links under ``src/deixis`` may be missing.

    >>> [name for name, _ in packages()][:3]
    ['deixis', 'deixis.experiments', 'deixis.experiments.apprentice']
    """

    def below(name: str, path: Path) -> Iterator[tuple[str, Path]]:
        yield name, path
        folders = [*path.iterdir(), *(ROOT.iterdir() if path == PACKAGE else ())]
        for inner in sorted(folders, key=lambda folder: folder.name):
            if (inner / "__init__.py").exists() and inner.name not in LEFT_OUT and not inner.is_symlink():
                yield from below(f"{name}.{inner.name}", inner)

    yield from below("deixis", PACKAGE)


def package_page(name: str, path: Path, every: Collection[str]) -> str:
    """Return the page of a package: its docstring, its modules as sections, and its sub-packages.

    Modules without a public name are left out. ``every`` are the names of all packages.
    """
    files = [file for file in sorted(path.glob("*.py")) if not file.stem.startswith("__")]
    modules = [file.stem for file in files if has_public(file)]
    inner = [child for child in every if child.rpartition(".")[0] == name]
    parts = [_title(name, "="), MODULE.format(name=name) + ("   :no-index:\n" if name == "deixis" else "")]
    parts += [_title(module, "-") + "\n" + MODULE.format(name=f"{name}.{module}") for module in modules]
    if inner:
        parts.append(".. toctree::\n   :hidden:\n\n" + "".join(f"   {child}\n" for child in inner))
    return "\n".join(parts)


def has_public(module: Path) -> bool:
    """Return whether a module defines a class, a function or a constant without a leading underscore."""
    for statement in ast.parse(module.read_text(encoding="utf-8")).body:
        match statement:
            case ast.ClassDef(name=name) | ast.FunctionDef(name=name):
                names = [name]
            case ast.Assign(targets=targets):
                names = [target.id for target in targets if isinstance(target, ast.Name)]
            case ast.AnnAssign(target=ast.Name(id=name)):
                names = [name]
            case _:
                continue
        if any(not name.startswith("_") for name in names):
            return True
    return False


def _title(text: str, line: str) -> str:
    return f"{text}\n{line * len(text)}\n"
