"""Other people's solvers behind the same call as the engines: ``solve(problem, seconds) -> assignment``."""
