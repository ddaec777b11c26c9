"""Work that executors are tried with; other processes import it from here."""

import os
import signal
import time
from pathlib import Path


def squared(value):
    return value * value


def slow(seconds):
    time.sleep(seconds)
    return seconds


def marked(path):
    """Leave a file, and take a while, so that an interrupt finds this at work."""
    Path(path).write_text("begun")
    time.sleep(0.4)
    return path


def dies_once(path):
    """Take the process down where the file `path` is not there yet."""
    if path and not Path(path).exists():
        Path(path).write_text("died")
        os.kill(os.getpid(), signal.SIGKILL)
    return path


def dies(value):
    """Take the process down for any value below zero."""
    if value < 0:
        os.kill(os.getpid(), signal.SIGKILL)
    return value


def dies_when_told(path):
    """Take the process down as soon as the file `path` is there; "" lives."""
    while path and not Path(path).exists():
        time.sleep(0.01)
    if path:
        os.kill(os.getpid(), signal.SIGKILL)
    return path


def fails(value):
    if value == 3:
        raise ValueError("three is refused")
    return value
