"""The layout language: scripts are read into a tree, and written from it.

:mod:`deixis.grammar.layout.parser` reads a script into the tree of :mod:`deixis.grammar.script`, and
:mod:`deixis.grammar.layout.format` writes the tree as text. :mod:`deixis.grammar.errors` holds the errors.
"""
