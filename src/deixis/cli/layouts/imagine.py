"""The command ``deixis imagine``: lay example tables that satisfy a script, or show which facts allow no table."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli.common import (
    NO,
    UNDECIDED,
    AsJson,
    Script,
    print_json,
    print_lines,
    print_written,
    require_scene_name,
    tell_of_compiling,
)
from deixis.cli.progress import step_bar, time_bar

if TYPE_CHECKING:
    from deixis.workflows.layouts.imagine import Imagination


def imagine(
    script: Script,
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write the table as a scene (.scene.json).")
    ] = None,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw the table (.png, .svg, .pdf).")] = None,
    count: Annotated[
        int, typer.Option(metavar="N", min=1, max=1000, help="Number of different tables; files are numbered.")
    ] = 1,
    seed: Annotated[int, typer.Option(metavar="N", min=0, help="Seed of the random sizes and places.")] = 0,
    any_size: Annotated[bool, typer.Option("--any-size", help="Allow unusual sizes.")] = False,
    time_limit: Annotated[float, typer.Option(min=0.0, metavar="SECONDS", help="Time for each table.")] = 30.0,
    as_json: AsJson = False,
) -> None:
    """Lay an example table that satisfies a script, or print which facts allow no table (exit 1).

    Each line has an object, its width and depth, the place of its centre in centimetres, and its kind.
    """
    from deixis.deadline import Deadline
    from deixis.grammar.read import read_script_file
    from deixis.report.layouts.imagine import imagination_lines, imagination_to_dict
    from deixis.workflows.layouts.imagine import imagine as run

    scenes, pictures = _numbered(out, count), _numbered(plot, count)
    _require_writable(script, scenes, pictures)
    parsed = read_script_file(script, deadline=Deadline.after(time_limit))
    tell_of_compiling()
    with time_bar("laying the table" if count == 1 else f"laying {count} tables", count * time_limit):
        found = run(parsed, any_size=any_size, seed=seed, count=count, time_limit=time_limit)
    _write(found, scenes, pictures)
    if as_json:
        print_json(imagination_to_dict(found))
    else:
        print_lines(imagination_lines(found))
        print_written(*scenes[: len(found.tables)], *pictures[: len(found.tables)])
    raise typer.Exit(_verdict(found))


def _verdict(found: Imagination) -> int:
    if found.none is not None:
        return NO
    return 0 if found.tables else UNDECIDED


def _numbered(path: Path | None, count: int) -> list[Path]:
    """Return the files of all tables: one table keeps the name, several get a number before the ending.

    >>> [str(path) for path in _numbered(Path("out/t.scene.json"), 2)]
    ['out/t-1.scene.json', 'out/t-2.scene.json']
    """
    if path is None:
        return []
    if count == 1:
        return [path]
    ending = ".scene.json" if path.name.endswith(".scene.json") else path.suffix
    stem = path.name.removesuffix(ending)
    return [path.with_name(f"{stem}-{number}{ending}") for number in range(1, count + 1)]


def _require_writable(script: str, scenes: list[Path], pictures: list[Path]) -> None:
    """Check, before any work, that the scenes and pictures can be written; raise DeixisError otherwise."""
    from deixis.errors import DeixisError
    from deixis.plots.figure import require_picture

    for picture in pictures:
        require_picture(picture)
    for scene in scenes:
        if scene.is_dir():
            raise DeixisError(f"{scene}: this is a folder; name a file for the scene")
        if scene.exists() and Path(script).exists() and scene.samefile(script):
            raise DeixisError(f"{scene}: this is the script; name another file for the scene")
        require_scene_name(scene)
        scene.parent.mkdir(parents=True, exist_ok=True)


def _write(found: Imagination, scenes: list[Path], pictures: list[Path]) -> None:
    from deixis.workflows.scenes.perceive import write_scene

    for table, file in zip(found.tables, scenes, strict=False):
        write_scene(table.scene, file)
    if pictures:
        from deixis.plots.imagine import plot_table

        with step_bar(len(pictures), "drawing") as drawn:
            for table, file in zip(found.tables, pictures, strict=False):
                plot_table(table, found.script.ontology.kinds, file, found.script.title or found.script.name)
                drawn("drawing")
