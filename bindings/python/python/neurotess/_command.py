"""The command `neurotess`."""

from __future__ import annotations

import os
import sys


def main() -> int:
    """Runs the command with the arguments of the process; returns its exit code."""
    from . import _neurotess, quiet_adapters

    quiet_adapters()
    return _neurotess.main(["neurotess", *sys.argv[1:]])


if __name__ == "__main__":
    os._exit(main())
