"""`python -m arkanoid` is the command `arkanoid`."""

import sys

if __name__ == "__main__":
    from .agents.cli import main

    sys.exit(main())
