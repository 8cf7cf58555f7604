"""Functions behind the commands, for Python and the command line: one module per command."""
