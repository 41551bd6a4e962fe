"""Jobs on the server, and a progress bar."""

from __future__ import annotations

import sys
import time
from typing import Any, Callable, Dict, Mapping, Union

from .core import Core

ENDED = ("succeeded", "failed", "cancelled")


class JobFailed(Exception):
    """A job that failed or was cancelled, with the reason."""


class Job:
    """A job on the server."""

    def __init__(self, core: Core, view: Mapping[str, Any]) -> None:
        self.core, self.view = core, dict(view)

    def __repr__(self) -> str:
        return f"Job({self.view['kind']}, {self.view['state']}, {self.view['progress']:.0%})"

    @property
    def id(self) -> str:
        """Its id."""
        return self.view["id"]

    def refresh(self) -> "Job":
        """Reads the present state."""
        self.view = dict(self.core.get_jobs_id(self.id))
        return self

    def cancel(self) -> None:
        """Cancels the job."""
        self.view = dict(self.core.delete_jobs_id(self.id))

    def wait(self, progress: Union[bool, Callable[[float, str], None]] = True,
             every_s: float = 0.5) -> Dict[str, Any]:
        """Waits for the result; `progress` draws a bar, or is called with share and message.

        Raises `JobFailed` with the server's reason."""
        tell = _bar if progress is True and _watched() else progress
        while self.refresh().view["state"] not in ENDED:
            if callable(tell):
                tell(self.view["progress"], self.view["message"])
            time.sleep(every_s)
        if callable(tell):
            tell(1.0, self.view["state"])
        if tell is _bar:
            print(file=sys.stderr)
        if self.view["state"] != "succeeded":
            raise JobFailed(self.view.get("error") or self.view["state"])
        return self.view["result"]


def _watched() -> bool:
    """True if the output is visible: in a terminal or a notebook."""
    return sys.stderr.isatty() or "ipykernel" in sys.modules


def _bar(share: float, words: str) -> None:
    done = round(30 * share)
    print(f"\r[{'#' * done}{'.' * (30 - done)}] {words[:60]:60}", end="", file=sys.stderr,
          flush=True)
