"""The command line: `python -m voronaut`, or `voronaut`."""

import sys

from . import _voronaut


def main() -> int:
    """Runs the program with the words that were typed."""
    return _voronaut.main([sys.executable, "-m", "voronaut"], sys.argv[1:])


if __name__ == "__main__":
    sys.exit(main())
