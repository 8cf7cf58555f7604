"""Text files of users: read within limits; what is not a text file is refused by its name."""

from __future__ import annotations

import errno
import os
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from deixis.errors import DeixisError, OntologyError
from deixis.text_files import read_lines, read_text, replace_text

READERS: list[Callable[[Path], object]] = [read_text, lambda file: list(read_lines(file))]


def refused(read: Callable[[Path], object], file: Path) -> str:
    with pytest.raises(DeixisError) as found:
        read(file)
    assert str(found.value).startswith(str(file).replace("\0", "\\u0000"))
    return str(found.value)


@pytest.mark.parametrize("read", READERS, ids=["text", "lines"])
def test_what_is_not_a_text_file_is_refused_by_name(read: Callable[[Path], object], tmp_path: Path) -> None:
    latin = tmp_path / "latin.txt"
    latin.write_bytes(b"caf\xe9\n")
    assert "this is a folder; name a file" in refused(read, tmp_path)
    assert "this is not a regular file" in refused(read, Path("/dev/zero"))
    assert "there is no such file" in refused(read, tmp_path / "missing.txt")
    (tmp_path / "breakfast.txt").write_text("fork", encoding="utf-8")
    assert refused(read, tmp_path / "breakfats.txt").endswith(f"did you mean '{tmp_path / 'breakfast.txt'}'?")
    assert refused(read, tmp_path / "breakfast.csv").endswith("there is no such file")
    assert "not UTF-8 (byte 3); save it as UTF-8" in refused(read, latin)
    assert "cannot be read: embedded null byte" in refused(read, tmp_path / "a\0b")


@pytest.mark.parametrize("read", READERS, ids=["text", "lines"])
def test_pipe_is_read_and_not_waited_for(read: Callable[[Path], object], tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    assert not read(pipe)  # no program writes to it
    source, target = os.pipe()

    def write() -> None:
        os.write(target, b"a\nb")
        os.close(target)

    late = threading.Timer(0.2, write)
    late.start()
    assert read(Path(f"/dev/fd/{source}")) in ("a\nb", ["a\n", "b"])
    late.join()
    os.close(source)


def test_texts_and_lines_have_a_largest_length(tmp_path: Path) -> None:
    file = tmp_path / "long.txt"
    file.write_text("\ufeffab\ncdef\n", encoding="utf-8")
    assert read_text(file, most=8) == "ab\ncdef\n" and list(read_lines(file, most=5)) == ["ab\n", "cdef\n"]
    with pytest.raises(OntologyError, match="at most 7 characters, got more; split it"):
        read_text(file, OntologyError, most=7)
    with pytest.raises(OntologyError, match=r"long.txt:2: a line must have at most 4 characters"):
        list(read_lines(file, OntologyError, most=4))


def test_a_text_is_replaced_in_one_step(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file, link = tmp_path / "a.json", tmp_path / "link.json"
    replace_text(file, "old\r\n")
    file.chmod(0o640)
    link.symlink_to(file)

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(Path, "replace", full)
        with pytest.raises(OSError, match="No space"):
            replace_text(link, "new")
    assert file.read_bytes() == b"old\r\n" and len(list(tmp_path.iterdir())) == 2
    replace_text(link, "new")
    assert link.is_symlink() and file.read_text("utf-8") == "new" and file.stat().st_mode & 0o777 == 0o640


def test_a_text_is_written_directly_to_a_pipe(tmp_path: Path) -> None:
    source, target = os.pipe()
    replace_text(f"/dev/fd/{target}", "text")
    os.close(target)
    assert os.read(source, 10) == b"text"
    os.close(source)


def test_an_error_of_writing_names_file_and_missing_folder(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="there is no such folder; make it first") as caught:
        replace_text(tmp_path / "missing" / "a.txt", "text")
    assert caught.value.filename == str(tmp_path / "missing" / "a.txt")
    with pytest.raises(OSError, match="Is a directory") as caught:
        replace_text(tmp_path, "text")
    assert caught.value.filename == str(tmp_path)
