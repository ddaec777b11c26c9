"""The command ``inerter``: one file a verb."""

from discover.cli.app import main

__all__ = ["main"]
