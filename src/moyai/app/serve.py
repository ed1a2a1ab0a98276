"""Start the server on this machine, print its address, open the browser; end with the terminal."""

from __future__ import annotations

import contextlib
import signal
import socket
import threading
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

from moyai.app.folder import CASE_ENDINGS, Folder, within
from moyai.app.pins import Run
from moyai.core.errors import InputError
from moyai.language import spoken_language

_NEEDED = ("starlette", "uvicorn")


def require_extra() -> None:
    """Raise what to install where the packages of the app are absent.

    Raises
    ------
    InputError
    """
    absent = [name for name in _NEEDED if find_spec(name) is None]
    if absent:
        raise InputError(f"'moyai app' needs {' and '.join(absent)}", remedy='pip install ".[app]"')


def chosen_folder(start: Path | None, output: Path | None) -> tuple[Folder, str]:
    """Return the folder of the app and the case that opens at once, by what stands on the command line.

    Parameters
    ----------
    start : Path or None
        Case file or folder; the folder of work when absent.
    output : Path or None
        Folder of the results; ``out`` in the chosen folder when absent.

    Raises
    ------
    InputError
        When there is no such file or folder.
    """
    target = (start or Path()).resolve()
    if not target.exists():
        raise InputError(f"there is no {start}", path="FILE", allowed="a case file or a folder")
    root = target if target.is_dir() else target.parent
    if target.is_file() and target.suffix not in CASE_ENDINGS:
        raise InputError(f"{start} is no case file", path="FILE", allowed="a file .yaml or .yml, or a folder")
    results = within(root, root / "out", "out") if output is None else output.resolve()
    return Folder(root, results), "" if target.is_dir() else target.name


def open_socket(port: int) -> socket.socket:
    """Return a socket of this machine only.

    Parameters
    ----------
    port : int
        0 for any that is free.

    Raises
    ------
    InputError
        When the port is taken.
    """
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind(("127.0.0.1", port))
        # A browser that is quicker than the server waits for it instead of being refused
        listener.listen(1024)
    except OSError as error:
        listener.close()
        raise InputError(
            f"port {port} cannot be used: {error.strerror or error}", path="--port", remedy="leave --port out"
        ) from None
    return listener


def serve(folder: Folder, first: str, run: Run, *, port: int, browser: bool, say: Callable[[str], None]) -> None:
    """Serve until the terminal ends it, in the language in force.

    Parameters
    ----------
    folder : Folder
    first : str
        Case that opens at once; empty for the gallery.
    run : callable
        Runs a case; a function of a module.
    port : int
        0 for any that is free.
    browser : bool
        Whether the browser is opened.
    say : callable
        Prints a line.
    """
    import uvicorn

    from moyai.app.security import Secrets
    from moyai.app.server import create
    from moyai.app.state import App

    listener = open_socket(port)
    number = listener.getsockname()[1]
    secrets = Secrets()
    address = f"http://127.0.0.1:{number}/?token={secrets.address}"
    application = create(App(folder, run, secrets, first, spoken_language()), number)
    settings = uvicorn.Config(
        application,
        log_level="critical",
        access_log=False,
        lifespan="on",
        ws="none",
        server_header=False,
        timeout_graceful_shutdown=1,
        h11_max_incomplete_event_size=64_000,
    )
    say(f"moyai app: {address}")
    say(f"folder {folder.root}, results in {folder.output}; Ctrl-C ends it")
    if browser:
        import webbrowser

        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
    if hasattr(signal, "SIGHUP"):  # a terminal that is closed ends it as Ctrl-C does
        signal.signal(signal.SIGHUP, lambda *_: signal.raise_signal(signal.SIGINT))
    try:
        uvicorn.Server(settings).run(sockets=[listener])
    except KeyboardInterrupt:
        pass
    finally:
        listener.close()
    with contextlib.suppress(OSError):  # the terminal may be gone
        say("moyai app has ended")
