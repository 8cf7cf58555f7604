"""Script files: includes, and files that cannot be read."""

from __future__ import annotations

from pathlib import Path

import pytest

from deixis.errors import DeixisError
from deixis.grammar.errors import ScriptError, ScriptFileError
from deixis.grammar.layout.format import format_script
from deixis.grammar.layout.parser import read_layout


def write(folder: Path, **texts: str) -> Path:
    """Write files called NAME.layout, and return the path of the first."""
    for name, text in texts.items():
        (folder / f"{name}.layout").write_text(text, encoding="utf-8")
    return folder / f"{next(iter(texts))}.layout"


def message(path: Path) -> str:
    with pytest.raises(DeixisError) as caught:
        read_layout(path)
    return str(caught.value).replace(str(path.parent) + "/", "")


def test_include(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "c.layout").write_text("Fork above cup")
    path = write(tmp_path, a='include "b.layout"; fork on plate', b='b on c\ninclude "sub/c.layout"')
    script = read_layout(path)
    assert [str(f) for f in script.facts] == ["on(b, c)", "top(Fork, cup)", "on(Fork, plate)"]
    files = [f.source.file.removeprefix(f"{tmp_path}/") for f in script.facts if f.source]
    assert files == ["b.layout", "sub/c.layout", "a.layout"]
    assert format_script(script) == 'include "b.layout"\nFork on plate\n'


def test_a_file_is_included_once(tmp_path: Path) -> None:
    path = write(
        tmp_path, a='include "b.layout"; include "b.layout"; include "c.layout"', b="x on y", c='include "b.layout"'
    )
    assert len(read_layout(path).facts) == 1


def test_the_header_of_an_included_file(tmp_path: Path) -> None:
    path = write(tmp_path, a='layout a seen from chair\ninclude "b.layout"', b="layout b seen from Chair\nx on y")
    assert read_layout(path).name == "a"
    write(tmp_path, b="layout b seen from door\nx on y")
    assert message(path) == (
        "b.layout:1:1: this file is seen from 'door', but the script that includes it from 'chair'\n"
        "layout b seen from door\n^^^^^^^^^^^^^^^^^^^^^^^"
    )


def test_errors_of_included_files_are_reported(tmp_path: Path) -> None:
    path = write(tmp_path, a='fork\ninclude "b.layout"\nspoon', b="x on x")
    with pytest.raises(ScriptError) as caught:
        read_layout(path)
    assert [Path(p.source.file).name for p in caught.value.problems] == ["a.layout", "b.layout", "a.layout"]


@pytest.mark.parametrize(
    ("include", "expected"),
    [
        ("../x.layout", "'../x.layout' is outside the folder of the script"),
        ("/etc/passwd", "'/etc/passwd' is outside the folder of the script"),
        ("link.layout", "'link.layout' is outside the folder of the script"),
        ("a.layout", "'a.layout' includes itself"),
        ("none.layout", "none.layout: there is no such file"),
        ("sub", "sub: this is a folder; name a file"),
        ("", "an include needs a file name"),
        ("x\0y", r"'x\u0000y' is not a valid file name"),
    ],
)
def test_includes_out_of_bounds(tmp_path: Path, include: str, expected: str) -> None:
    folder = tmp_path / "folder"
    (folder / "sub").mkdir(parents=True)
    (tmp_path / "x.layout").write_text("x on y")
    (folder / "link.layout").symlink_to(tmp_path / "x.layout")
    assert message(write(folder, a=f'include "{include}"')).split("\n")[0] == f"a.layout:1:9: {expected}"


def test_cycle(tmp_path: Path) -> None:
    path = write(tmp_path, a='include "b.layout"', b='include "a.layout"')
    assert message(path).split("\n") == [
        "b.layout:1:9: 'a.layout' includes itself",
        'include "a.layout"',
        "        ^^^^^^^^^^",
        "a.layout includes b.layout includes a.layout",
    ]


def test_includes_are_bounded(tmp_path: Path) -> None:
    deep = write(tmp_path, **{f"d{i}": f'include "d{i + 1}.layout"' for i in range(40)})
    assert "d32.layout:1:9: includes are nested deeper than 32" in message(deep)
    for i in range(1001):
        (tmp_path / f"w{i}.layout").write_text("")
    wide = write(tmp_path, wide="\n".join(f'include "w{i}.layout"' for i in range(1001)))
    assert message(wide).startswith("wide.layout:1001:9: more than 1,000 files are included\n")


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        ("a on b".encode("utf-16"), "this file is UTF-16, not UTF-8; save it as UTF-8"),
        ("a on b\nä on b".encode("latin-1"), "line 2 is not UTF-8; save the file as UTF-8"),
    ],
)
def test_wrong_encodings(tmp_path: Path, data: bytes, expected: str) -> None:
    path = tmp_path / "a.layout"
    path.write_bytes(data)
    with pytest.raises(ScriptFileError) as caught:
        read_layout(path)
    assert str(caught.value) == f"{path}: {expected}"


def test_unreadable_files(tmp_path: Path) -> None:
    assert message(tmp_path / "none.layout") == "none.layout: there is no such file"
    with pytest.raises(ScriptFileError, match="this is a folder; name a file"):
        read_layout(tmp_path)
    with pytest.raises(OSError, match="regular file"):
        read_layout("/dev/zero")
    with pytest.raises(ScriptFileError, match="cannot be read"):
        read_layout(tmp_path / ("x" * 5000))


def test_an_empty_file_is_an_empty_script(tmp_path: Path) -> None:
    script = read_layout(write(tmp_path, a=""))
    assert (script.facts, script.objects, len(script.graph().nodes)) == ((), (), 0)


def test_too_large(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("deixis.grammar.files.MAX_FILE_BYTES", 1024 * 1024)
    with pytest.raises(ScriptFileError, match="larger than 1 MB"):
        read_layout(write(tmp_path, a=" " * (1024 * 1024 + 1)))
