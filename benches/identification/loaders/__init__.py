"""Data sets by name; a name with a slash is a folder with a manifest."""

from . import folder, made, measured

NAMES = measured.NAMES + made.NAMES


def load(name, shared):
    """The data set of a name; raises `Missing` where its folder is not on this machine."""
    if "/" in name:
        return folder.load(name, shared)
    return (made if name.startswith("made-") else measured).load(name, shared)
