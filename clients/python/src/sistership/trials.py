"""Trials on the server."""

from __future__ import annotations

import io
import os
import uuid
from typing import Any, Dict, List, Mapping, Sequence, Tuple, Union

from .core import Core

PathLike = Union[str, "os.PathLike[str]"]


class Trial:
    """A stored trial: `about` has its name, manoeuvre, rows, duration, warnings."""

    def __init__(self, core: Core, about: Mapping[str, Any]) -> None:
        self.core, self.about = core, dict(about)

    def __repr__(self) -> str:
        return f"Trial({self.name!r}, {self.about['rows']} samples, {self.about['duration_s']:g} s)"

    @property
    def id(self) -> str:
        """Its id."""
        return self.about["id"]

    @property
    def name(self) -> str:
        """Its file's name."""
        return self.about["name"]

    @property
    def warnings(self) -> List[Dict[str, Any]]:
        """Warnings of the checks: `row`, `column`, `message`."""
        return self.about["warnings"]

    def csv(self) -> str:
        """Its samples under canonical names, SI and radians."""
        kept = self.core.http.send("GET", f"/v1/trials/{self.id}/samples",
                                   headers={"Accept": "text/csv"})
        return kept.decode()

    def frame(self) -> Any:
        """Its samples as a pandas frame."""
        import pandas

        return pandas.read_csv(io.StringIO(self.csv()))


def ids(trials: Sequence[Union[str, Trial]]) -> List[str]:
    """The ids of trials that are given as trials or ids."""
    return [trial if isinstance(trial, str) else trial.id for trial in trials]


def form(manifest: str, files: Sequence[str], folder: PathLike) -> Tuple[bytes, str]:
    """The body and media type of an upload with a manifest (RFC 7578)."""
    between = uuid.uuid4().hex
    parts = [_part(between, 'name="manifest"', manifest.encode())]
    for name in files:
        with open(os.path.join(folder, name), "rb") as file:
            escaped = name.replace("\\", "\\\\").replace('"', '\\"')
            parts.append(_part(between, f'name="file"; filename="{escaped}"', file.read()))
    body = b"".join([*parts, f"--{between}--\r\n".encode()])
    return body, f"multipart/form-data; boundary={between}"


def _part(between: str, what: str, content: bytes) -> bytes:
    head = f"--{between}\r\nContent-Disposition: form-data; {what}\r\n\r\n"
    return head.encode() + content + b"\r\n"
