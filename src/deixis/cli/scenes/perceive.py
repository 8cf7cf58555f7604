"""The command ``deixis perceive``: find the table in a point cloud and the objects on it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from deixis.cli.common import (
    NO,
    AsJson,
    Picture,
    print_json,
    print_lines,
    print_note,
    print_written,
    require_plot,
    require_scene_name,
    require_writable,
)
from deixis.cli.progress import progress_bar, stage_bar


def perceive(
    cloud: Annotated[str, typer.Argument(metavar="CLOUD", help="PCD, PLY, XYZ, NPZ, or a depth image.")],
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write the scene, and the clouds beside it.")
    ] = None,
    labels: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the object number of each point (.npy, int32, -1: none).")
    ] = None,
    intrinsics: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Camera intrinsics (.json) of a depth image.")
    ] = None,
    viewpoint: Annotated[str, typer.Option(metavar="NAME", help="Name of the side where the camera is.")] = "chair",
    table: Annotated[int, typer.Option(metavar="N", min=1, help="Number of the table, if there are several.")] = 1,
    up: Annotated[
        tuple[float, float, float] | None,
        typer.Option(metavar="X Y Z", help="The upward direction in the cloud's frame, within 45 degrees."),
    ] = None,
    plot: Picture = None,
    as_json: AsJson = False,
) -> None:
    """Find the table in a point cloud and the objects on it; without a table, no scene is written."""
    from deixis.errors import DeixisError
    from deixis.perception.detection.settings import DetectionSettings
    from deixis.perception.formats.scene_json import scene_to_dict
    from deixis.report.scenes.seen import scene_lines, shows_line
    from deixis.workflows.scenes.perceive import STAGES, write_scene
    from deixis.workflows.scenes.perceive import perceive as run

    require_plot(plot)
    if labels is not None and labels.suffix != ".npy":
        raise DeixisError(f"{labels}: the name of a file of labels must end in .npy")
    require_scene_name(out)
    require_writable([out, labels, plot], [cloud, intrinsics])
    with stage_bar(*STAGES) as begin:
        scene = run(cloud, intrinsics, viewpoint, DetectionSettings(table=table, up=up), begin)
    found = scene.detection
    assert found is not None
    seen = bool(found.table is not None or scene.objects)
    written = write_scene(scene, out) if out is not None and seen else scene
    if labels is not None:
        _write_labels(labels, found.labels)
    if plot is not None:
        from deixis.plots.seen import plot_perceived

        with progress_bar("drawing"):
            plot_perceived(scene, plot)
    if as_json or out is None:
        print_json({**scene_to_dict(written), "shows": str(found.shows)})
        for note in found.notes:
            print_note(note)
    else:
        print_lines(scene_lines(scene))
        print_lines(f"Note: {note}." for note in found.notes)
        print_lines([shows_line(found.shows)])
        print_written(out if seen else None)
    if not as_json:
        print_written(labels, plot, aside=out is None)
    if not scene.objects:
        raise typer.Exit(NO)


def _write_labels(file: Path, labels: Any) -> None:
    import numpy as np

    from deixis.errors import DeixisError

    try:
        np.save(file, labels)
    except OSError as error:
        raise DeixisError(f"{file}: cannot write the labels: {error.strerror}") from error
