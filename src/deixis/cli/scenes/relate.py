"""The command ``deixis relate``: print the qualitative relations between the things of a scene."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from deixis.cli.common import AsJson, Image, SceneFile, note_unit, print_lines
from deixis.cli.completion import complete_related


def relate(
    scene: SceneFile,
    calculus: Annotated[
        str,
        typer.Option(
            "--calculus",
            "-c",
            metavar="NAME",
            autocompletion=complete_related,
            help="point, allen, ra, ba, cd, cardir, rcc8, ten, distance, direction-distance.",
        ),
    ] = "ra",
    of: Annotated[
        list[str] | None, typer.Option(metavar="ID", help="Only this subject; given twice: a subject and an object.")
    ] = None,
    axis: Annotated[
        str | None, typer.Option(metavar="AXIS", help="Axis of point and allen: x (the default), y or z.")
    ] = None,
    tolerance: Annotated[
        float, typer.Option(min=0.0, metavar="LENGTH", help="Coordinates that differ by at most this are equal.")
    ] = 0.0,
    reference: Annotated[
        float | None, typer.Option(metavar="LENGTH", help="Unit of distance: near is up to 1, medium up to 3.")
    ] = None,
    matrix: Annotated[bool, typer.Option("--matrix", help="Print a matrix with subjects in rows.")] = False,
    words: Annotated[
        bool, typer.Option("--words", help="Print also the words that people would accept, with their probabilities.")
    ] = False,
    image: Image = None,
    as_json: AsJson = False,
) -> None:
    """Print the relation of every pair of things in a scene; lengths are in metres (pixels for annotations)."""
    from deixis.reasoning.errors import SettingError
    from deixis.reasoning.qualitative.relate import ALONG_AN_AXIS, RELATED
    from deixis.report.scenes.relate import json_lines, matrix_lines, pair_lines
    from deixis.workflows.layouts.read import load_scene
    from deixis.workflows.scenes.relate import relate as relations_of

    chosen = of or []
    if len(chosen) > 2 or (matrix and (chosen or words)):
        raise SettingError(
            "--of may be given once (subject) or twice (subject, object); --matrix excludes --of and --words"
        )
    if len(chosen) == 2 and chosen[0] == chosen[1]:
        raise SettingError(f"--of must name two different things, got '{chosen[0]}' twice")
    if axis is not None and calculus not in ALONG_AN_AXIS and calculus in RELATED:
        raise SettingError(f"--axis goes with {' and '.join(ALONG_AN_AXIS)} only; {calculus} has no axis")
    seen = load_scene(scene, image=image)
    note_unit(seen)
    related = relations_of(seen, calculus, axis=axis or "x", tolerance=tolerance, reference=reference)
    fitting = None
    if words:
        from deixis.reasoning.grounding.evidence.claims.scene_words import scene_words

        fitting = scene_words(seen.boxes, seen.poses)
    subject, other = (*chosen, None, None)[:2]
    if as_json:
        sys.stdout.writelines(f"{line}\n" for line in json_lines(related, subject, other, fitting))
    else:
        print_lines(matrix_lines(related) if matrix else pair_lines(related, subject, other, fitting))
