"""Write a qualitative calculus as the three files of GQR, which ``deixis solve --calculus`` reads."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import product
from pathlib import Path


def write_calculus(
    folder: Path,
    name: str,
    atoms: Sequence[str],
    identity: str,
    converse: Callable[[str], str],
    compose: Callable[[str, str], Iterable[str]],
) -> Path:
    """Write the specification, the converses and the compositions; return the path of the specification."""
    folder.mkdir(parents=True, exist_ok=True)
    specification = folder / f"{name}.spec"
    specification.write_text(
        f"comp_table_file {name}.comp\nconverse_file {name}.conv\nidentity {identity}\ncalculus_size {len(atoms)}\n",
        encoding="utf-8",
    )
    converses = "".join(f"{atom} :: {converse(atom)}\n" for atom in atoms)
    (folder / f"{name}.conv").write_text(converses, encoding="utf-8")
    with (folder / f"{name}.comp").open("w", encoding="utf-8") as out:
        for first, second in product(atoms, atoms):
            out.write(f"{first} : {second} :: ( {' '.join(compose(first, second))} )\n")
    return specification
