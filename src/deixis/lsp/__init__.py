"""The language server: diagnostics, completion, hover and edits of layout scripts in an editor.

``document`` holds a script that is being typed. ``diagnostics``, ``completion``, ``hover``, ``edits`` and ``symbols``
are functions of a document. ``english`` has the diagnostics and the hover of texts in English. ``server`` offers all of
them to an editor by the Language Server Protocol; only this module needs the extra ``lsp``. Lines and columns count
characters from 1, as in :class:`deixis.ontology.graph.facts.Source`.
"""
