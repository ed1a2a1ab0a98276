"""The command line as ``python -m moyai``."""

from moyai.cli.main import main

if __name__ == "__main__":
    main()
