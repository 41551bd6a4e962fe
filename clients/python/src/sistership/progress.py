"""A bar that shows how far long work is."""

from __future__ import annotations

import sys
from typing import Callable, Optional, Union

Progress = Union[bool, Callable[[float, str], None]]


def progress_sink(progress: Progress) -> Optional[Callable[[float, str], None]]:
    """The function that is called with share and words; `True` draws a bar where it can be seen."""
    if progress is True:
        return draw_bar if is_watched() else None
    return progress if callable(progress) else None


def is_watched() -> bool:
    """Whether a person sees what is drawn: at a terminal, or under a notebook's cell."""
    return sys.stderr.isatty() or "ipykernel" in sys.modules


def draw_bar(share: float, words: str) -> None:
    """Draws the bar over the one before it."""
    done = round(30 * share)
    print(f"\r[{'#' * done}{'.' * (30 - done)}] {words[:60]:60}", end="", file=sys.stderr,
          flush=True)


def end_bar(sink: Optional[Callable[[float, str], None]], words: str) -> None:
    """Ends the work with its outcome."""
    if sink is not None:
        sink(1.0, words)
    if sink is draw_bar:
        print(file=sys.stderr)
