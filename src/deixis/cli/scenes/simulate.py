"""The command ``deixis simulate``: simulate a depth camera that looks at a table; write the cloud and the truth."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli.common import (
    NO,
    AsJson,
    print_json,
    print_lines,
    print_written,
    require_scene_name,
    require_writable,
)
from deixis.cli.progress import stage_bar

if TYPE_CHECKING:
    from deixis.perception.clouds.mesh import Mesh
    from deixis.workflows.layouts.lay_table import LaidScript


def simulate(
    layout: Annotated[str | None, typer.Argument(metavar="LAYOUT", help="A layout script, or use --random.")] = None,
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write the labelled cloud (.pcd, .ply).")
    ] = None,
    truth: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the true scene (.scene.json).")] = None,
    seed: Annotated[int, typer.Option(metavar="N", min=0, help="Seed of the random things, places and noise.")] = 0,
    random: Annotated[int | None, typer.Option(metavar="N", help="1 to 300 random things instead of a layout.")] = None,
    mesh: Annotated[
        list[str] | None, typer.Option(metavar="NAME=FILE", help="A mesh (.ply, .obj, .stl; z up) for an object.")
    ] = None,
    mesh_unit: Annotated[str, typer.Option(metavar="UNIT", help="Unit of the meshes: m, cm or mm.")] = "m",
    cloth: Annotated[bool, typer.Option("--cloth", help="Put a white cloth on the table.")] = False,
    camera_height: Annotated[float, typer.Option(metavar="METRES", help="Height of the camera above the table.")] = 0.7,
    camera_back: Annotated[
        float, typer.Option(metavar="METRES", help="Distance from the table's edge to the camera.")
    ] = 0.0,
    azimuth: Annotated[float, typer.Option(metavar="DEGREES", help="Angle of the camera around the table.")] = 0.0,
    intrinsics: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Camera intrinsics (.json); default: a Kinect.")
    ] = None,
    noise: Annotated[
        float, typer.Option(metavar="FACTOR", help="Multiple of the noise of a Kinect; 0: no noise.")
    ] = 1.0,
    missing: Annotated[
        float, typer.Option(metavar="SHARE", help="Share of points that are missing at random.")
    ] = 0.005,
    quantised: Annotated[bool, typer.Option("--quantised", help="Round depths to the steps of a Kinect.")] = False,
    table_frame: Annotated[
        bool, typer.Option("--table-frame", help="Write the cloud in the table's frame, not the camera's.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Lay a table from a layout, or at random, and simulate a depth camera that looks at it."""
    from deixis.errors import DeixisError
    from deixis.perception.clouds.depth import read_intrinsics
    from deixis.perception.simulator.cameras.camera import KINECT
    from deixis.perception.simulator.cameras.depth import DepthSensor, in_table_frame
    from deixis.report.scenes.simulate import simulation_lines, simulation_to_dict
    from deixis.workflows.layouts.lay_table import NoTableError
    from deixis.workflows.scenes.simulate import CameraSetup
    from deixis.workflows.scenes.simulate import simulate as run

    require_scene_name(truth)
    require_writable([out, truth], [layout, intrinsics, *(entry.partition("=")[2] for entry in mesh or [])])
    if out is not None and out.suffix.lower() not in (".pcd", ".ply"):
        raise DeixisError(f"{out}: the name of a cloud must end in .pcd or .ply")
    meshes = _meshes(mesh or [], mesh_unit)
    sensor = DepthSensor(noise=noise, missing=missing, quantised=quantised)
    lens = KINECT if intrinsics is None else read_intrinsics(intrinsics)
    view = CameraSetup(camera_height, camera_back, math.radians(azimuth), lens, sensor)
    try:
        with stage_bar("laying the table", "looking at the table") as begin:
            laid = _laid(layout, random, seed, meshes, cloth)
            begin("looking at the table")
            found = run(laid, view, seed)
    except NoTableError as error:
        print_json({"simulated": False, "reason": str(error)}) if as_json else print_lines([str(error)])
        raise typer.Exit(NO) from error
    if out is not None:
        from deixis.perception.clouds.cloud_file import write_cloud

        write_cloud(out, in_table_frame(found.cloud, found.camera) if table_frame else found.cloud)
    if truth is not None:
        from deixis.workflows.scenes.perceive import write_scene

        write_scene(found.truth, truth)
    if as_json:
        print_json(simulation_to_dict(found))
    else:
        print_lines(simulation_lines(found))
        print_written(out, truth)


def _laid(layout: str | None, random: int | None, seed: int, meshes: dict[str, Mesh], cloth: bool) -> LaidScript:
    from deixis.errors import DeixisError
    from deixis.grammar.read import read_script_file
    from deixis.workflows.layouts.lay_table import lay_random, lay_script

    if (layout is None) == (random is None):
        raise DeixisError("simulate: give either a layout or --random N")
    if layout is not None:
        return lay_script(read_script_file(layout), seed, meshes, cloth=cloth)
    return lay_random(random or 0, seed, meshes, cloth=cloth)


def _meshes(given: list[str], unit: str) -> dict[str, Mesh]:
    """Read meshes given as NAME=FILE; return them by name, in metres."""
    from dataclasses import replace

    from deixis.errors import DeixisError
    from deixis.perception.clouds.mesh_file import read_mesh
    from deixis.perception.scene import UNITS_OF_LENGTH

    if unit not in UNITS_OF_LENGTH:
        raise DeixisError(f"simulate: --mesh-unit must be one of {', '.join(UNITS_OF_LENGTH)}, got '{unit}'")
    meshes: dict[str, Mesh] = {}
    for entry in given:
        name, sign, file = entry.partition("=")
        if not (name and sign and file):
            raise DeixisError(f"simulate: --mesh must be NAME=FILE, got '{entry}'")
        if name in meshes:
            raise DeixisError(f"simulate: two meshes are given for '{name}'")
        read = read_mesh(file)
        meshes[name] = replace(read, vertices=read.vertices * UNITS_OF_LENGTH[unit])
    return meshes
