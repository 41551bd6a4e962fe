"""Requests and errors, with the standard library only."""

from __future__ import annotations

import json as _json
import urllib.error
import urllib.parse
import urllib.request
from typing import Any, List, Mapping, Optional


class Refused(Exception):
    """Refusal by the server, with its problem document (RFC 9457)."""

    def __init__(self, status: int, problem: Mapping[str, Any]) -> None:
        self.status = status
        self.problem = dict(problem)
        lines = [str(problem.get("detail") or problem.get("title") or status)]
        lines += [f"  {_place(error)}: {error.get('message')}" for error in self.errors]
        super().__init__("\n".join(lines))

    @property
    def errors(self) -> List[Mapping[str, Any]]:
        """The faults: `message`, and `field`, `row` and `column` if known."""
        return self.problem.get("errors") or []


class NoAnswer(ConnectionError):
    """The server does not respond at its address."""


def _place(error: Mapping[str, Any]) -> str:
    """Location of an error, such as `turn.csv, row 3, psi_deg`."""
    row = f"row {error['row']}" if error.get("row") is not None else None
    return ", ".join(str(part) for part in (error.get("field"), row, error.get("column")) if part)


def _text(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


class Http:
    """A server by its address, with an optional key."""

    def __init__(self, url: str, key: Optional[str] = None, timeout_s: float = 600.0) -> None:
        self.url = url.rstrip("/")
        self.key = key
        self.timeout_s = timeout_s

    def send(self, method: str, path: str, *, query: Optional[Mapping[str, Any]] = None,
             headers: Optional[Mapping[str, Any]] = None, json: Any = None,
             body: Optional[bytes] = None, media: Optional[str] = None) -> bytes:
        """Sends a request and returns the body of the response."""
        address = self.url + urllib.parse.quote(path)
        given = {name: value for name, value in (query or {}).items() if value is not None}
        if given:
            plain = {n: [_text(v) for v in value] if isinstance(value, (list, tuple))
                     else _text(value) for n, value in given.items()}
            address += "?" + urllib.parse.urlencode(plain, doseq=True)
        request = urllib.request.Request(address, data=body, method=method)
        if json is not None:
            request.data = _json.dumps(json).encode()
            media = "application/json"
        if media:
            request.add_header("Content-Type", media)
        if self.key:
            request.add_header("Authorization", f"Bearer {self.key}")
        for name, value in (headers or {}).items():
            if value is not None:
                request.add_header(name, _text(value))
        try:
            with urllib.request.urlopen(request, timeout=self.timeout_s) as answer:
                return answer.read()
        except urllib.error.HTTPError as error:
            raise Refused(error.code, _problem(error.read())) from None
        except urllib.error.URLError as error:
            raise NoAnswer(f"no server answers at {self.url}: {error.reason}") from None

    def json(self, method: str, path: str, **given: Any) -> Any:
        """Sends a request and returns the response as JSON."""
        given["headers"] = {"Accept": "application/json", **(given.get("headers") or {})}
        return _json.loads(self.send(method, path, **given))

    def bytes(self, method: str, path: str, **given: Any) -> bytes:
        """Sends a request and returns the response as bytes."""
        return self.send(method, path, **given)

    def none(self, method: str, path: str, **given: Any) -> None:
        """Sends a request whose response has no body."""
        self.send(method, path, **given)


def _problem(text: bytes) -> Mapping[str, Any]:
    try:
        known = _json.loads(text)
    except ValueError:
        return {"detail": text.decode(errors="replace")}
    return known if isinstance(known, dict) else {"detail": str(known)}
