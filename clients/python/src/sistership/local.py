"""Refinement, diagnosis and estimates without a server, by the program of this machine."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any, List, Mapping, Optional, Sequence, Union

from .files import (ShipLike, TrialsLike, option_flags, write_document, write_ship,
                    write_trials)
from .models import Model
from .program import run_command
from .progress import Progress
from .reports import Report
from .trials import PathLike


def refine(ship: ShipLike, trials: TrialsLike, *, source: Union[None, str, Model] = None,
           law: Optional[str] = None, method: Optional[str] = None,
           settings: Union[None, PathLike, Mapping[str, Any]] = None,
           held_out: Sequence[str] = (), progress: Progress = True, **options: Any) -> Report:
    """Refines a model of a ship against trials: `refine("my-ship.yaml", ["zigzag.csv"])`.

    `ship` is a name of the zoo, a vessel file, its text or its fields; `trials` a manifest, files,
    pandas frames with canonical columns (`t_s, u_m_s, v_m_s, r_rad_s, psi_rad, delta_rad, ...`), or
    a mapping of names to frames. Without `source`, `law` and `method` the model is selected by
    cross-validation. `options` are further flags of `sistership refine`. Raises `CommandFailed`
    with the reason of a refusal."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        named = source.file_in(folder) if isinstance(source, Model) else source
        options.update(source=named, law=law, method=method, held_out=list(held_out))
        if settings is not None:
            options["settings"] = write_document(settings, folder / "settings.yaml")
        ship_argument = f"--ship={write_ship(ship, folder)}"
        return _report("refine", [ship_argument], trials, options, folder, progress)


def diagnose(model: Union[PathLike, Model], trials: TrialsLike, *, progress: Progress = True,
             **options: Any) -> Report:
    """Finds the effects that a model lacks, from trials that it was not fitted on; `model` of the
    report has them. `options` are flags of `sistership diagnose`."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        named = model if isinstance(model, Model) else Model(model)
        arguments = [f"--model={named.file_in(folder)}"]
        return _report("diagnose", arguments, trials, options, folder, progress)


def estimate(ship: ShipLike, **options: Any) -> Model:
    """A model of a ship from its particulars alone, by published regressions: a stopgap until
    there are trials. `options` are flags of `sistership estimate`."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        out = folder / "estimate.yaml"
        run_command("estimate", f"--ship={write_ship(ship, folder)}", f"--out={out}",
                    *option_flags(options))
        return Model(out)


def _report(command: str, arguments: List[str], trials: TrialsLike, options: Mapping[str, Any],
            folder: Path, progress: Progress) -> Report:
    """Runs a command that writes a model and a report."""
    out, page = folder / f"{command}d.yaml", folder / "report.html"
    document = run_command(command, *arguments, f"--out={out}", f"--report={page}",
                           *option_flags(options), "--trials", *write_trials(trials, folder),
                           progress=progress)
    model = Model(out) if out.is_file() else None
    return Report(document, page.read_text(encoding="utf-8"), model)
