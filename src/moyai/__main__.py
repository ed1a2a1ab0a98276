"""The command line, also as ``python -m moyai``."""

import sys

from moyai.core.interrupts import ignore, listen


def main() -> None:
    """Entry point of the ``moyai`` command: Ctrl-C is heard before the commands are loaded."""
    listen()
    try:
        from moyai.cli.main import main as run

        run()
    except KeyboardInterrupt:
        ignore()
        sys.exit("interrupted")
    finally:
        ignore()


if __name__ == "__main__":
    main()
