"""The command that relates what a scene shows, in any of the calculi."""

from __future__ import annotations

from typing import Annotated

import typer

from deixis.cli_common import AsJson, Image, SceneFile, print_json, print_lines


def relate(
    scene: SceneFile,
    calculus: Annotated[
        str,
        typer.Option(
            "--calculus",
            "-c",
            metavar="NAME",
            help="point, allen, ra, ba, cd, cardir, rcc8, ten, distance, direction-distance.",
        ),
    ] = "ra",
    of: Annotated[
        list[str] | None, typer.Option(metavar="ID", help="Only this subject; given twice, this subject and object.")
    ] = None,
    axis: Annotated[str, typer.Option(metavar="AXIS", help="What point and allen look along: x, y or z.")] = "x",
    tolerance: Annotated[
        float, typer.Option(min=0.0, metavar="LENGTH", help="Coordinates that differ by no more are equal.")
    ] = 0.0,
    reference: Annotated[
        float | None, typer.Option(metavar="LENGTH", help="What distance is measured by: near is up to 1, medium to 3.")
    ] = None,
    matrix: Annotated[bool, typer.Option("--matrix", help="Print a matrix: subjects in rows.")] = False,
    image: Image = None,
    as_json: AsJson = False,
) -> None:
    """Print how every two things of a scene are related; lengths are in metres (pixels for annotations)."""
    from deixis.reasoning.errors import SettingError
    from deixis.reasoning.relate import Related
    from deixis.reasoning.relate import relate as codes_of
    from deixis.session import load_scene
    from deixis.show_relate import matrix_lines, pair_lines, related_to_dict

    chosen = of or []
    if len(chosen) > 2 or (matrix and chosen):
        raise SettingError("--of takes a subject, and once more an object, and does not go with --matrix")
    seen = load_scene(scene, image=image)
    codes = codes_of(seen.boxes, calculus, axis=axis, tolerance=tolerance, reference=reference)
    related = Related(calculus, seen.ids, codes)
    if as_json:
        print_json(related_to_dict(related, *chosen))
    else:
        print_lines(matrix_lines(related) if matrix else pair_lines(related, *chosen))
