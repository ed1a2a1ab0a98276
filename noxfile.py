"""The commands that a contributor types: ``nox -s lint``, ``types``, ``tests``, ``slow``, ``docs``, ``wheel``."""

import nox

nox.options.sessions = ["lint", "types", "tests"]
VERSIONS = ["3.11", "3.12", "3.13"]


def _install(session: nox.Session) -> None:
    session.install("-c", "constraints.txt", ".[test,docs]")
    # Capytaine 3.0 asks for pandas < 3 and does not need it here; its other requirements are there
    session.install("--no-deps", "capytaine==3.0.0")


@nox.session
def lint(session: nox.Session) -> None:
    """Style and format."""
    session.install("-c", "constraints.txt", "ruff")
    session.run("ruff", "check", ".")
    session.run("ruff", "format", "--check", ".")


@nox.session
def types(session: nox.Session) -> None:
    """Type hints."""
    _install(session)
    session.run("mypy")


@nox.session(python=VERSIONS)
def tests(session: nox.Session) -> None:
    """Fast tests; further arguments go to pytest."""
    _install(session)
    session.run("python", "-m", "pytest", "-n", "2", *session.posargs)


@nox.session
def slow(session: nox.Session) -> None:
    """Slow tests and the validation cases."""
    _install(session)
    session.run("python", "-m", "pytest", "-m", "slow", "-n", "2", *session.posargs)
    session.run("moyai", "validate")


@nox.session
def docs(session: nox.Session) -> None:
    """The documentation, warnings as errors."""
    _install(session)
    session.run("sphinx-build", "-q", "-W", "--keep-going", "-b", "html", "docs", "docs/_build/html")


@nox.session
def wheel(session: nox.Session) -> None:
    """Wheel and source archive, and the wheel installed alone."""
    folder = session.create_tmp()
    session.install("build")
    session.run("python", "-m", "build", "--outdir", folder, ".")
    session.run("python", "-m", "pip", "install", "--force-reinstall", "--find-links", folder, "moyai")
    session.run("moyai", "new")
