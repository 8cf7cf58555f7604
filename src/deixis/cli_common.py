"""What the commands share: exit codes, the options that several of them have, and how they print."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any

import typer

NO, BAD_INPUT, UNDECIDED = 1, 2, 3

Script = Annotated[str, typer.Argument(metavar="SCRIPT", help="A layout script (.layout).")]
SceneFile = Annotated[
    str, typer.Argument(metavar="SCENE", help="A scene (.scene.json), or COCO or LabelMe annotations.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]
TimeLimit = Annotated[float, typer.Option(min=0.0, metavar="SECONDS", help="Answer by then.")]
HideLabels = Annotated[bool, typer.Option("--hide-labels", help="Look at the scene as if nothing in it were named.")]
Image = Annotated[str | None, typer.Option(metavar="NAME", help="Which image of a COCO file.")]
MemoryDir = Annotated[
    Path | None,
    typer.Option("--memory", metavar="DIR", help="The memory (default: $DEIXIS_MEMORY, else a folder of yours)."),
]
NoMemory = Annotated[bool, typer.Option("--no-memory", help="As if nothing were remembered.")]


def print_json(data: Any) -> None:
    print(json.dumps(data, indent=2, ensure_ascii=False))


def print_lines(lines: Iterable[str]) -> None:
    for line in lines:
        print(line)
