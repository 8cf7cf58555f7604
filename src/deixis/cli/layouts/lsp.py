"""The command ``deixis lsp``: serve an editor."""

from __future__ import annotations


def lsp() -> None:
    """Serve an editor by the Language Server Protocol, on standard input and output."""
    from deixis.extras import require

    require("pygls", "the language server")
    from deixis.lsp.server import serve

    serve()
