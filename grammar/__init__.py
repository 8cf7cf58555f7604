"""From text to a relation graph: the layout language, and everything that reads or writes it.

:mod:`deixis.grammar.parser` reads a script, :mod:`deixis.grammar.script` is what it reads it into,
:mod:`deixis.grammar.format` writes it again, :mod:`deixis.grammar.errors` is what can go wrong.
"""
