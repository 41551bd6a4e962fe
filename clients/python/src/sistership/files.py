"""Ships, trials and settings of Python as files that the program reads."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Iterable, List, Mapping, Sequence, Tuple, Union

from .trials import PathLike

# A pandas frame (or any other with `to_csv` or `write_csv`) with canonical columns, or a path.
TrialLike = Any
TrialsLike = Union[TrialLike, Sequence[TrialLike], Mapping[str, TrialLike]]
ShipLike = Union[str, PathLike, Mapping[str, Any]]


def write_ship(ship: ShipLike, folder: Path) -> str:
    """The name or the path of a ship: one of the zoo, a vessel file, its text, or its fields."""
    return write_document(ship, folder / "ship.yaml")


def write_document(given: Union[str, PathLike, Mapping[str, Any]], path: Path) -> str:
    """The path of a document that is given as fields or as text; paths and names stay."""
    if isinstance(given, Mapping):
        # JSON is YAML.
        given = json.dumps(given, indent=1) + "\n"
    if isinstance(given, str) and "\n" in given:
        path.write_text(given, encoding="utf-8")
        return str(path)
    return os.fspath(given)


def write_trials(trials: TrialsLike, folder: Path) -> List[str]:
    """The paths of trials: a manifest, files, or frames, which are written as CSV files."""
    return [_write_trial(name, trial, folder) for name, trial in _named(trials)]


def _named(trials: TrialsLike) -> Iterable[Tuple[str, TrialLike]]:
    """Trials with the names of their files; a frame without a name gets a number."""
    if isinstance(trials, Mapping):
        return trials.items()
    single = isinstance(trials, (str, os.PathLike)) or _is_frame(trials)
    listed = [trials] if single else list(trials)
    return [(f"trial-{number}", trial) for number, trial in enumerate(listed, 1)]


def _is_frame(given: Any) -> bool:
    return hasattr(given, "to_csv") or hasattr(given, "write_csv")


def _write_trial(name: str, trial: TrialLike, folder: Path) -> str:
    if not _is_frame(trial):
        return os.fspath(trial)
    if Path(name).name != name:
        raise ValueError(f"trial {name!r}: write a file's name, without folders")
    path = folder / (name if name.endswith(".csv") else f"{name}.csv")
    if hasattr(trial, "to_csv"):
        trial.to_csv(path, index=trial.index.name is not None)
    else:
        trial.write_csv(path)
    return str(path)


def option_flags(options: Mapping[str, Any]) -> List[str]:
    """Flags of the command line: `held_out=["a", "b"]` is `--held-out a --held-out b`."""
    flags: List[str] = []
    for name, value in options.items():
        flag = "--" + name.replace("_", "-")
        if value is True:
            flags.append(flag)
        elif isinstance(value, (list, tuple)):
            flags.extend(f"{flag}={one}" for one in value)
        elif value is not None and value is not False:
            flags.append(f"{flag}={value}")
    return flags
