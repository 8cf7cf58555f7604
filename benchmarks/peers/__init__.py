"""Solvers of other makers behind the call of the engines: ``solve(problem, seconds) -> assignment``."""
