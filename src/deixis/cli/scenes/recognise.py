"""The command ``deixis recognise``: name the things of a scene by the taught categories."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli.common import (
    NO,
    AsJson,
    MemoryDir,
    PerceivedScene,
    Picture,
    print_json,
    print_lines,
    print_note,
    print_written,
    require_memory,
    require_plot,
    require_scene_name,
    require_writable,
)
from deixis.cli.progress import progress_bar

if TYPE_CHECKING:
    from deixis.perception.scene import Scene


def recognise(
    scene: PerceivedScene,
    out: Annotated[Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write the scene with names.")] = None,
    why: Annotated[bool, typer.Option("--why", help="Print the reasons and the distances.")] = False,
    plot: Picture = None,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Name the things of a scene that look like taught categories; exit 1 if none is recognised."""
    from deixis.report.scenes.seen import recognised_lines, recognised_to_dict
    from deixis.session import Session
    from deixis.workflows.layouts.read import load_scene

    require_plot(plot)
    require_scene_name(out)
    require_memory(memory)
    seen = load_scene(scene)
    require_writable([out, plot], _cloud_files(seen))
    with Session(memory) as session, progress_bar("comparing with the taught views") as progress:
        found = session.recognise(seen, progress, print_note)
    if out is not None:
        from deixis.workflows.scenes.perceive import write_scene

        write_scene(found.scene, out)
    if plot is not None:
        from deixis.plots.seen import plot_recognised

        with progress_bar("drawing"):
            plot_recognised(found, plot)
    if as_json:
        print_json(recognised_to_dict(found))
    else:
        print_lines(recognised_lines(found, why))
        print_written(out, plot)
    if not any(answer.label for answer in found.answers.values()):
        raise typer.Exit(NO)


def _cloud_files(scene: Scene) -> list[Path]:
    return [Path(scene.file).parent / thing.cloud for thing in scene.objects if isinstance(thing.cloud, str)]
