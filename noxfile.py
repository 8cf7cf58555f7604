"""Sessions for those who have several versions of Python: `nox` runs the tests under each of them."""

import nox

nox.options.sessions = ["tests"]
nox.options.default_venv_backend = "venv"


@nox.session(python=["3.11", "3.12"])
def tests(session: nox.Session) -> None:
    """Run the tests in an environment made from the lock; arguments after `--` go to pytest."""
    session.install("--require-hashes", "--no-deps", "-r", "requirements.lock")
    session.install("--no-deps", "--no-build-isolation", "--editable", ".")
    session.run("python", "-m", "deixis.kernels")
    session.run("python", "-m", "pytest", "-n", "auto", "--dist", "loadfile", *session.posargs)


@nox.session(python=["3.11", "3.12"])
def types(session: nox.Session) -> None:
    """Check the types with mypy and pyright in an environment made from the lock."""
    session.install("--require-hashes", "--no-deps", "-r", "requirements.lock")
    session.install("--no-deps", "--no-build-isolation", "--editable", ".")
    session.run("mypy")
    session.run("basedpyright", "--pythonpath", f"{session.bin}/python")


@nox.session(python=["3.11", "3.12"])
def wheel(session: nox.Session) -> None:
    """Install the wheel with all extras, as a user does, and run the demo."""
    session.install(".[all]")
    session.chdir(session.create_tmp())
    session.run("deixis", "demo")
