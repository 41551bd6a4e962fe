"""The program `sistership` of this machine, for work without a server."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from typing import IO, Any, Callable, Dict, Iterator, List, Optional

from .progress import Progress, end_bar, progress_sink

PROGRAM = "sistership.exe" if os.name == "nt" else "sistership"
# Notes of progress, such as `search  40 %, about 3 s left: kvlcc2` and ` 70 % simulating`.
SHARE = re.compile(r"^(?:search)?\s*(\d{1,3}) %(.*)")


class CommandFailed(Exception):
    """A command that refused its data (`exit_status` 1) or its arguments (2), with its reason."""

    def __init__(self, exit_status: int, reason: str) -> None:
        super().__init__(reason)
        self.exit_status = exit_status


def find_program() -> str:
    """The path of the program: `SISTERSHIP_PROGRAM`, that of this package, or one on the `PATH`.

    Raises `FileNotFoundError` if there is none."""
    named = os.environ.get("SISTERSHIP_PROGRAM")
    if named:
        return named
    for folder in _script_folders():
        path = os.path.join(folder, PROGRAM)
        if os.path.isfile(path):
            return path
    found = shutil.which("sistership")
    if found is None:
        raise FileNotFoundError(
            "the program `sistership` is not installed; install a wheel for this platform, or "
            "build it and set SISTERSHIP_PROGRAM to its path")
    return found


def _script_folders() -> Iterator[str]:
    """The folders into which pip installs programs: of this environment, of the user, and of
    `pip install --target`."""
    yield sysconfig.get_path("scripts")
    yield sysconfig.get_path("scripts", f"{os.name}_user")
    yield os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "bin")


def run_program(arguments: List[str]) -> int:
    """Runs the program in place of this process where the system can; else gives its status."""
    program = find_program()
    if os.name != "nt":
        os.execv(program, [program, *arguments])
    return subprocess.run([program, *arguments]).returncode


def run_command(*arguments: str, progress: Progress = False) -> Dict[str, Any]:
    """Runs a command with `--json` and gives its document: `run_command("similar", "kvlcc2")`.

    Raises `CommandFailed` with the program's reason."""
    text = run_text(*arguments, "--json", progress=progress)
    return json.loads(text)


def run_text(*arguments: str, progress: Progress = False) -> str:
    """Runs a command and gives its standard output.

    Raises `CommandFailed` with the program's reason."""
    sink = progress_sink(progress)
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen([find_program(), *arguments], stdin=subprocess.DEVNULL,
                                   stdout=output, stderr=subprocess.PIPE)
        try:
            assert process.stderr is not None
            notes = _read_notes(process.stderr, sink)
            status = process.wait()
        except BaseException:
            process.kill()
            process.wait()
            raise
        finally:
            if process.stderr is not None:
                process.stderr.close()
        end_bar(sink, "failed" if status else "done")
        if status:
            raise CommandFailed(status, _reason(notes) or f"exit status {status}")
        output.seek(0)
        return output.read().decode()


def _read_notes(stderr: IO[bytes], sink: Optional[Callable[[float, str], None]]) -> List[str]:
    """The lines that say no progress; shares of the work go to `sink`."""
    notes = []
    for line in stderr:
        note = line.decode(errors="replace").rstrip()
        share = SHARE.match(note)
        if share is None:
            notes.append(note)
        elif sink is not None:
            sink(int(share[1]) / 100.0, share[2].strip(" :,"))
    return notes


def _reason(notes: List[str]) -> str:
    """The message of the error, which may have several lines."""
    first = next((number for number, note in enumerate(notes) if note.startswith("error: ")), 0)
    return "\n".join(notes[first:]).replace("error: ", "", 1).strip()


def main() -> None:
    """`python -m sistership`."""
    try:
        sys.exit(run_program(sys.argv[1:]))
    except FileNotFoundError as error:
        sys.exit(str(error))
