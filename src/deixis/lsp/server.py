"""The language server: features of documents offered to an editor by the Language Server Protocol, over pipes.

Errors of the parser are sent at once, warnings after a pause in typing. Long computations run in threads with time
limits, so that the server keeps answering.
"""

from __future__ import annotations

import asyncio
import logging
import os
import sys
from pathlib import Path

from lsprotocol import types
from pygls.exceptions import JsonRpcInvalidParams
from pygls.lsp.server import LanguageServer
from pygls.uris import to_fs_path
from pygls.workspace import ServerTextPosition, ServerTextRange

from deixis.errors import DeixisError
from deixis.grammar.files import MAX_FILE_BYTES
from deixis.lsp.completion import Role, completions
from deixis.lsp.diagnostics import Problem, errors, warnings
from deixis.lsp.document import Document
from deixis.lsp.edits import Edit, RenameError, fixes, formatted, rename
from deixis.lsp.english import (
    EnglishText,
    english_completions,
    english_fixes,
    english_hover,
    english_mentions,
    english_noun_at,
    english_problems,
    english_rename,
)
from deixis.lsp.hover import hover
from deixis.lsp.symbols import mentions_of, symbols
from deixis.ontology.graph.facts import Source
from deixis.printable import shortened
from deixis.version import VERSION

PAUSE = 0.3
"""Seconds without a change after which warnings are computed."""

COMPLETION_KINDS = {
    Role.NAME: types.CompletionItemKind.Variable,
    Role.KIND: types.CompletionItemKind.Class,
    Role.COLOUR: types.CompletionItemKind.Color,
    Role.RELATION: types.CompletionItemKind.Operator,
    Role.KEYWORD: types.CompletionItemKind.Keyword,
}


class LayoutServer(LanguageServer):
    """Language server that holds the open documents, and the problems that were sent last, by URI."""

    def __init__(self) -> None:
        super().__init__("deixis", VERSION, text_document_sync_kind=types.TextDocumentSyncKind.Full)
        self._documents: dict[str, Document | EnglishText] = {}
        self.problems: dict[str, tuple[Document | EnglishText, list[Problem]]] = {}

    def document(self, uri: str) -> Document | EnglishText:
        """Return the document that an editor shows; the same object until its text changes.

        Plain text, or a file ``NAME.txt``, is English.

        Parameters
        ----------
        uri
            URI of an open document.

        Returns
        -------
        Document or EnglishText
            Document with the text of the editor, which is empty if the text exceeds the size limit of a file.
        """
        shown = self.workspace.get_text_document(uri)
        text = shown.source
        if len(text) > MAX_FILE_BYTES:
            text = ""  # the size limit of a script file; send() reports it
        known = self._documents.get(uri)
        if known is None or known.text != text:
            path = to_fs_path(uri) if uri.startswith("file:") else None
            english = shown.language_id == "plaintext" or uri.endswith(".txt")
            known = (EnglishText if english else Document)(text, Path(path) if path else None)
            self._documents[uri] = known
        return known

    def layout(self, uri: str) -> Document:
        """Return the layout script that an editor shows; an empty one for a text in English.

        Parameters
        ----------
        uri
            URI of an open document.

        Returns
        -------
        Document
            Script. The empty one has as many lines as the text in English, so that positions stay valid.
        """
        document = self.document(uri)
        return document if isinstance(document, Document) else Document("\n" * (len(document.lines) - 1))

    def mentions(self, uri: str, place: types.Position) -> tuple[Document | EnglishText, list[Source]]:
        """Return a document and the places at which it mentions the object at a position.

        Parameters
        ----------
        uri
            URI of an open document.
        place
            Position of the cursor.

        Returns
        -------
        tuple
            Document, and the spans in their order; none where no object is named.
        """
        document = self.document(uri)
        line, column = self.position(document, place)
        if isinstance(document, EnglishText):
            return document, english_mentions(document, line, column)
        return document, mentions_of(document, line, column)

    def forget(self, uri: str) -> None:
        """Drop a document that was closed, and take its problems from the editor's list.

        Parameters
        ----------
        uri
            URI of the document.
        """
        self._documents.pop(uri, None)
        self.problems.pop(uri, None)
        self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri=uri, diagnostics=[]))

    def position(self, document: Document | EnglishText, place: types.Position) -> tuple[int, int]:
        """Return the line and the column, counted from 1 in characters, of an editor's position.

        Parameters
        ----------
        document
            Script or text that the position is in.
        place
            Position that counts from 0, in the units that server and editor agreed on.

        Returns
        -------
        tuple of int
            Line and column.
        """
        found = self.workspace.position_codec.position_from_client_units(document.lines, place)
        return found.line + 1, found.character + 1

    def range(self, document: Document | EnglishText, source: Source) -> types.Range:
        """Return an editor's range for a span of a document.

        Parameters
        ----------
        document
            Script or text that has the span.
        source
            Span, counted from 1 in characters.

        Returns
        -------
        Range
            Span that counts from 0, in the units that server and editor agreed on.
        """
        found = ServerTextRange(
            ServerTextPosition(source.line - 1, source.column - 1),
            ServerTextPosition(source.end_line - 1, source.end_column - 1),
        )
        return self.workspace.position_codec.range_to_client_units(document.lines, found)

    def text_edit(self, document: Document | EnglishText, edit: Edit) -> types.TextEdit:
        """Return an edit as the protocol writes it.

        Parameters
        ----------
        document
            Script or text to edit.
        edit
            Replacement of a span.

        Returns
        -------
        TextEdit
            Edit whose range counts in the units of the editor.
        """
        return types.TextEdit(self.range(document, edit.source), edit.text)

    def diagnostic(self, document: Document | EnglishText, problem: Problem) -> types.Diagnostic:
        """Return a problem as the protocol writes it.

        Parameters
        ----------
        document
            Script or text that has the problem.
        problem
            Error or warning.

        Returns
        -------
        Diagnostic
            Diagnostic whose range counts in the units of the editor.
        """
        level = types.DiagnosticSeverity.Error if problem.is_error else types.DiagnosticSeverity.Warning
        place = self.range(document, problem.source)
        return types.Diagnostic(place, problem.message, severity=level, code=problem.code, source="deixis")

    def send(self, uri: str, document: Document | EnglishText, problems: list[Problem]) -> None:
        """Send the problems of a document, and keep them for quick fixes.

        Parameters
        ----------
        uri
            URI of the document.
        document
            Script or text that was checked.
        problems
            Its errors and warnings, which replace those sent before.
        """
        self.problems[uri] = (document, problems)
        if len(self.workspace.get_text_document(uri).source) > MAX_FILE_BYTES:
            message = f"this file is larger than {MAX_FILE_BYTES // 1024**2} MB"
            problems = [Problem(Source(document.file, 1, 1, 1, 1), message)]
        shown = [self.diagnostic(document, problem) for problem in problems]
        self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri=uri, diagnostics=shown))

    async def check(self, uri: str) -> None:
        """Send the errors of a document, and after a pause its warnings, unless it changes in the meantime.

        Parameters
        ----------
        uri
            URI of an open document.
        """
        document = self.document(uri)
        if isinstance(document, EnglishText):
            await asyncio.sleep(PAUSE)
            if self._documents.get(uri) is document:
                found = await asyncio.to_thread(english_problems, document)
                if self._documents.get(uri) is document:
                    self.send(uri, document, found)
            return
        found = await asyncio.to_thread(errors, document)
        if self._documents.get(uri) is not document:
            return
        self.send(uri, document, found)
        await asyncio.sleep(PAUSE)
        if self._documents.get(uri) is not document:
            return
        found = found + await asyncio.to_thread(warnings, document)
        if self._documents.get(uri) is document:
            self.send(uri, document, found)


def build_server() -> LayoutServer:
    """Return a language server with all features registered.

    Returns
    -------
    LayoutServer
        Server that is not started yet.
    """
    server = LayoutServer()

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    async def opened(params: types.DidOpenTextDocumentParams) -> None:
        await server.check(params.text_document.uri)

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    async def changed(params: types.DidChangeTextDocumentParams) -> None:
        await server.check(params.text_document.uri)

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def closed(params: types.DidCloseTextDocumentParams) -> None:
        server.forget(params.text_document.uri)

    @server.feature(types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(trigger_characters=[" ", "(", ","]))
    async def complete(params: types.CompletionParams) -> types.CompletionList:
        document = server.document(params.text_document.uri)
        line, column = server.position(document, params.position)
        if isinstance(document, EnglishText):
            found = await asyncio.to_thread(english_completions, document, line, column)
        else:
            found = await asyncio.to_thread(completions, document, line, column)
        items = []
        for number, one in enumerate(found):
            place = server.range(document, Source(document.file, line, one.column, line, column))
            items.append(
                types.CompletionItem(
                    label=one.text,
                    kind=COMPLETION_KINDS[one.role],
                    detail=one.detail or None,
                    sort_text=f"{number:05}",
                    filter_text=document.lines[line - 1][one.column - 1 : column - 1] or None,
                    text_edit=types.TextEdit(place, one.text),
                )
            )
        return types.CompletionList(is_incomplete=True, items=items)

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    async def explain(params: types.HoverParams) -> types.Hover | None:
        document = server.document(params.text_document.uri)
        line, column = server.position(document, params.position)
        if isinstance(document, EnglishText):
            found = await asyncio.to_thread(english_hover, document, line, column)
        else:
            found = await asyncio.to_thread(hover, document, line, column)
        return types.Hover(types.MarkupContent(types.MarkupKind.Markdown, found)) if found else None

    @server.feature(
        types.TEXT_DOCUMENT_CODE_ACTION, types.CodeActionOptions(code_action_kinds=[types.CodeActionKind.QuickFix])
    )
    def fix(params: types.CodeActionParams) -> list[types.CodeAction]:
        uri = params.text_document.uri
        document, problems = server.problems.get(uri, (None, []))
        if document is None or server.document(uri) is not document:
            return []
        asked = [problem for problem in problems if _meet(server.range(document, problem.source), params.range)]
        return [
            types.CodeAction(
                title=one.title,
                kind=types.CodeActionKind.QuickFix,
                diagnostics=[server.diagnostic(document, one.problem)],
                edit=types.WorkspaceEdit(changes={uri: [server.text_edit(document, edit) for edit in one.edits]}),
            )
            for one in (fixes(document, asked) if isinstance(document, Document) else english_fixes(asked))
        ]

    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    def prepare_rename(params: types.PrepareRenameParams) -> types.Range | None:
        document = server.document(params.text_document.uri)
        line, column = server.position(document, params.position)
        if isinstance(document, EnglishText):
            source = english_noun_at(document, line, column)
        else:
            name = document.name_at(line, column)
            source = None if name is None else name.source
        return None if source is None else server.range(document, source)

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    def rename_object(params: types.RenameParams) -> types.WorkspaceEdit:
        uri = params.text_document.uri
        document = server.document(uri)
        line, column = server.position(document, params.position)
        try:
            if isinstance(document, EnglishText):
                edits = english_rename(document, line, column, params.new_name)
            else:
                edits = rename(document, line, column, params.new_name)
        except RenameError as error:
            raise JsonRpcInvalidParams(message=str(error)) from None
        return types.WorkspaceEdit(changes={uri: [server.text_edit(document, edit) for edit in edits]})

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    def write_canonically(params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        document = server.document(params.text_document.uri)
        text = formatted(document) if isinstance(document, Document) else None  # English has no canonical form
        if text is None or text == document.text:
            return []
        end = Source(document.file, 1, 1, len(document.lines), len(document.lines[-1]) + 1)
        return [types.TextEdit(server.range(document, end), text)]

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    def outline(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        document = server.layout(params.text_document.uri)
        found = [(one, server.range(document, one.source)) for one in symbols(document)]
        kind = types.SymbolKind.Object
        return [types.DocumentSymbol(one.name, kind, place, place, one.kind) for one, place in found]

    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    def first_mention(params: types.DefinitionParams) -> types.Location | None:
        uri = params.text_document.uri
        document, found = server.mentions(uri, params.position)
        return types.Location(uri, server.range(document, found[0])) if found else None

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    def all_mentions(params: types.ReferenceParams) -> list[types.Location]:
        uri = params.text_document.uri
        document, found = server.mentions(uri, params.position)
        return [types.Location(uri, server.range(document, place)) for place in found]

    return server


def _meet(first: types.Range, second: types.Range) -> bool:
    """Return True if two ranges share a position."""

    def place(position: types.Position) -> tuple[int, int]:
        return position.line, position.character

    return place(first.start) <= place(second.end) and place(second.start) <= place(first.end)


def _is_defect(record: logging.LogRecord) -> bool:
    """Return False for the record of a request that was refused with a reason, or that ended with the input."""
    kind = None if record.exc_info is None else record.exc_info[0]
    return kind not in (JsonRpcInvalidParams, asyncio.CancelledError)


class LineFormatter(logging.Formatter):
    """Format of log entries as one line each: an error by its class and its message."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the first line of the message, and the error.

        Parameters
        ----------
        record
            The log entry.

        Returns
        -------
        str
            The line.
        """
        first, error = record.getMessage().partition("\n")[0], record.exc_info[1] if record.exc_info else None
        return first if error is None else f"{first}: {type(error).__name__}: {shortened(' '.join(str(error).split()))}"


def serve() -> None:
    """Answer an editor on standard input and output until it closes them; print anything else on standard error.

    Raises
    ------
    DeixisError
        If standard input or output is closed.
    """
    if sys.stdin is None or sys.stdout is None:
        raise DeixisError(
            "the language server needs standard input and output, got a closed one; start it in an editor"
        )
    log = logging.StreamHandler(sys.stderr)
    log.addFilter(_is_defect)
    if not os.environ.get("DEIXIS_DEBUG"):
        log.setFormatter(LineFormatter())
    logging.basicConfig(handlers=[log], level=logging.WARNING)
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")  # pygls closes it at the end
    sys.stdout = sys.stderr
    build_server().start_io(sys.stdin.buffer, answers)
