"""The language server as an editor sees it: messages of the protocol over pipes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import deixis
from deixis.errors import DeixisError
from deixis.lsp.server import serve

URI = "file:///tea.layout"
TEXT = "layout tea seen from chair\n𐐀 left of plaet; left(knife, plate)\nfork lft of plate"


class Client:
    """Editor that starts the server and speaks JSON-RPC with it."""

    def __init__(self) -> None:
        environment = {**os.environ, "PYTHONPATH": str(Path(deixis.__file__).parents[1])}
        if "PYTHONPATH" in os.environ:
            environment["PYTHONPATH"] += os.pathsep + os.environ["PYTHONPATH"]
        command = [sys.executable, "-m", "deixis", "lsp"]
        self.server = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment)
        self.watchdog = threading.Timer(60, self.server.kill)  # so that no test waits for ever
        self.watchdog.start()
        self.count = 0
        self.notes: list[dict[str, Any]] = []

    def write(self, message: dict[str, Any]) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        assert self.server.stdin is not None
        self.server.stdin.write(b"Content-Length: %d\r\n\r\n%b" % (len(body), body))
        self.server.stdin.flush()

    def read(self) -> dict[str, Any]:
        assert self.server.stdout is not None
        length = 0
        while (line := self.server.stdout.readline().strip()) or not length:
            assert line or self.server.poll() is None, "the server ended"
            if line.lower().startswith(b"content-length:"):
                length = int(line.split(b":")[1])
        message: dict[str, Any] = json.loads(self.server.stdout.read(length))
        return message

    def ask(self, method: str, params: Any) -> dict[str, Any]:
        self.count += 1
        self.write({"id": self.count, "method": method, "params": params})
        while (message := self.read()).get("id") != self.count:
            self.notes.append(message)
        return message

    def result(self, method: str, **params: Any) -> Any:
        return self.ask(method, {"textDocument": {"uri": URI}, **params})["result"]

    def diagnostics(self, wanted: int) -> list[dict[str, Any]]:
        """Return the next list of diagnostics with ``wanted`` entries."""
        while True:
            message = self.notes.pop(0) if self.notes else self.read()
            if message.get("method") == "textDocument/publishDiagnostics":
                found: list[dict[str, Any]] = message["params"]["diagnostics"]
                if len(found) == wanted:
                    return found

    def change(self, text: str, version: int) -> None:
        document = {"uri": URI, "version": version}
        self.write(
            {
                "method": "textDocument/didChange",
                "params": {"textDocument": document, "contentChanges": [{"text": text}]},
            }
        )


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    """Client that has opened TEXT; the server ends on request."""
    client = Client()
    try:
        found = client.ask("initialize", {"processId": None, "rootUri": None, "capabilities": {}})
        assert found["result"]["serverInfo"]["name"] == "deixis"
        client.write({"method": "initialized", "params": {}})
        document = {"uri": URI, "languageId": "deixis-layout", "version": 1, "text": TEXT}
        client.write({"method": "textDocument/didOpen", "params": {"textDocument": document}})
        yield client
        assert client.ask("shutdown", None)["result"] is None
        client.write({"method": "exit"})
        assert client.server.wait(timeout=20) == 0
    finally:
        client.watchdog.cancel()
        client.server.kill()
        client.server.communicate()


def place(line: int, character: int) -> dict[str, int]:
    return {"line": line, "character": character}


def test_a_session_of_an_editor(client: Client) -> None:
    (error,) = client.diagnostics(1)
    assert (error["severity"], error["range"]) == (1, {"start": place(2, 5), "end": place(2, 11)})
    found = client.diagnostics(3)
    codes = {one.get("code"): one for one in found}
    assert set(codes) == {None, "N001", "N003"}
    # columns count UTF-16 code units: the first letter takes two
    assert codes["N001"]["range"] == {"start": place(1, 11), "end": place(1, 16)}

    actions = client.result("textDocument/codeAction", range=error["range"], context={"diagnostics": [error]})
    assert [edit["newText"] for action in actions for edit in action["edit"]["changes"][URI]] == ["left of"]

    items = client.result("textDocument/completion", position=place(2, 6))["items"]
    assert "left of" in [item["label"] for item in items]

    said = client.result("textDocument/hover", position=place(1, 26))["contents"]["value"]
    assert "states: left of plate" in said

    edits = client.result("textDocument/rename", position=place(1, 26), newName="spoon")["changes"][URI]
    assert [edit["range"]["start"] for edit in edits] == [place(1, 23)]
    refused = client.ask(
        "textDocument/rename", {"textDocument": {"uri": URI}, "position": place(1, 26), "newName": "plate"}
    )
    assert "already" in refused["error"]["message"]

    names = [symbol["name"] for symbol in client.result("textDocument/documentSymbol")]
    assert names[:4] == ["chair", "𐐀", "plaet", "knife"]

    options = {"tabSize": 4, "insertSpaces": True}
    assert client.result("textDocument/formatting", options=options) == []
    client.change("layout seen from chair\nleft(fork, the plate)", 2)
    assert client.diagnostics(0) == []
    (edit,) = client.result("textDocument/formatting", options=options)
    assert edit["newText"] == "layout seen from chair\nfork left of plate\n"


def test_a_document_without_text_or_words_gets_answers(client: Client) -> None:
    for version, text in enumerate(["", "\x00\x01", "((((" * 1_000, "é" * 50_000, "\u2028fork\r\nleft"], start=10):
        client.change(text, version)
        for method in ("completion", "hover", "definition"):
            client.ask(f"textDocument/{method}", {"textDocument": {"uri": URI}, "position": place(0, 3)})
        assert client.result("textDocument/documentSymbol") is not None


def test_a_text_in_english_is_checked_and_explained(client: Client) -> None:
    uri, text = "file:///tea.txt", "The fork lies left of the plate. The plate lies left of the fork."
    document = {"uri": uri, "languageId": "plaintext", "version": 1, "text": text}
    client.write({"method": "textDocument/didOpen", "params": {"textDocument": document}})
    while True:
        message = client.notes.pop(0) if client.notes else client.read()
        if message.get("params", {}).get("uri") == uri:
            break
    assert [found["code"] for found in message["params"]["diagnostics"]] == ["F003"]
    asked = {"textDocument": {"uri": uri}, "position": place(0, 5)}
    assert "`left(fork, plate)`" in client.ask("textDocument/hover", asked)["result"]["contents"]["value"]
    assert client.ask("textDocument/documentSymbol", asked)["result"] == []
    options = {"tabSize": 4, "insertSpaces": True}
    assert client.ask("textDocument/formatting", {**asked, "options": options})["result"] == []
    assert client.ask("textDocument/prepareRename", asked)["result"] == {"start": place(0, 4), "end": place(0, 8)}
    edits = client.ask("textDocument/rename", {**asked, "newName": "spoon"})["result"]["changes"][uri]
    assert [edit["range"]["start"] for edit in edits] == [place(0, 4), place(0, 60)]
    refused = client.ask("textDocument/rename", {**asked, "newName": "plate"})
    assert "already" in refused["error"]["message"]
    assert client.ask("textDocument/definition", asked)["result"]["range"]["start"] == place(0, 0)
    assert len(client.ask("textDocument/references", {**asked, "context": {"includeDeclaration": True}})["result"]) == 2


def message(body: object) -> bytes:
    data = body if isinstance(body, bytes) else json.dumps(body).encode()
    return b"Content-Length: %d\r\n\r\n%b" % (len(data), data)


BROKEN = (
    message({"jsonrpc": "2.0", "id": 1, "method": "textDocument/hover", "params": None}),
    message({"jsonrpc": "2.0", "id": 2, "method": "initialize", "params": {"capabilities": {}, "processId": None}}),
    message(b"{bad"), message([1, 2]), message({"jsonrpc": "2.0", "method": 5}),
    message({"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": {"textDocument": {
        "uri": URI, "languageId": "x", "version": 1, "text": TEXT}}}),
    b"Content-Length: 500\r\n\r\n{",
)  # fmt: skip


def test_a_broken_client_gets_a_line_for_each_mistake() -> None:
    environment = {**os.environ, "PYTHONPATH": str(Path(deixis.__file__).parents[1])}
    command = [sys.executable, "-m", "deixis", "lsp"]
    done = subprocess.run(
        command, input=b"".join(BROKEN), capture_output=True, env=environment, timeout=60, check=False
    )
    told = done.stderr.decode()
    assert done.returncode == 0 and b'"capabilities"' in done.stdout
    assert "Traceback" not in told and 3 <= len(told.splitlines()) <= 12, told


@pytest.mark.parametrize("stream", ["stdin", "stdout"])
def test_a_closed_stream_is_an_error(stream: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, stream, None)
    with pytest.raises(DeixisError, match="needs standard input and output"):
        serve()
