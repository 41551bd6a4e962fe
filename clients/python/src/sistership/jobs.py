"""Jobs on the server."""

from __future__ import annotations

import time
from typing import Any, Dict, Mapping

from .core import Core
from .progress import Progress, end_bar, progress_sink

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

    def wait(self, progress: Progress = True,
             every_s: float = 0.5) -> Dict[str, Any]:
        """Waits for the result; `progress` draws a bar, or is called with share and message.

        Raises `JobFailed` with the server's reason."""
        sink = progress_sink(progress)
        while self.refresh().view["state"] not in ENDED:
            if sink is not None:
                sink(self.view["progress"], self.view["message"])
            time.sleep(every_s)
        end_bar(sink, self.view["state"])
        if self.view["state"] != "succeeded":
            raise JobFailed(self.view.get("error") or self.view["state"])
        return self.view["result"]
