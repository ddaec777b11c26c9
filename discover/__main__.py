"""``python -m discover``: the same as ``inerter``."""

import sys

from discover.cli import program

if __name__ == "__main__":
    sys.exit(program())
