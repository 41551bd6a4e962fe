"""Models on this machine: of the zoo, of files, and refined without a server."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import Any, Dict, Optional, Sequence

from .equations import ExportedModel
from .files import option_flags
from .program import run_command, run_text
from .progress import Progress
from .trials import PathLike


class Model(ExportedModel):
    """A model by its name in the zoo, or by the file of a model or a vessel: `Model("kvlcc2")`.

    Called with the inputs of a run it simulates on this machine."""

    def __init__(self, source: PathLike) -> None:
        super().__init__()
        path = Path(source)
        self.text: Optional[bytes] = path.read_bytes() if path.is_file() else None
        weights = path.with_suffix(".weights.json")
        # Weights of a learned correction, which the program expects next to the model.
        self.weights: Optional[bytes] = weights.read_bytes() if weights.is_file() else None
        self._name = path.stem if self.text is not None else os.fspath(source)

    def __repr__(self) -> str:
        return f"Model({self.name!r})"

    @property
    def name(self) -> str:
        """Its name in the zoo, or that of its file without the ending."""
        return self._name

    def write(self, path: PathLike) -> str:
        """Writes the model's YAML file, with the weights of its learned correction next to it.

        Raises `ValueError` for a model of the zoo, which has no file of its own."""
        if self.text is None:
            raise ValueError(f"{self.name} is a model of the zoo: name it as it is")
        target = Path(path)
        target.write_bytes(self.text)
        if self.weights is not None:
            target.with_suffix(".weights.json").write_bytes(self.weights)
        return str(target)

    def file_in(self, folder: Path) -> str:
        """The argument that names the model to the program; files are written into `folder`."""
        return self.name if self.text is None else self.write(folder / f"{self.name}.yaml")

    def export(self, format: str) -> bytes:
        """The model for another tool: `c`, `python`, `matlab`, `modelica`, `fmu2`, `fmu3`."""
        with tempfile.TemporaryDirectory() as name:
            out = Path(name) / "exported"
            run_text("export", self.file_in(Path(name)), f"--format={format}", f"--out={out}")
            return out.read_bytes()

    def manoeuvre(self, *, turn_deg: Optional[float] = None,
                  zigzag: Optional[Sequence[float]] = None, progress: Progress = False,
                  **options: Any) -> Dict[str, Any]:
        """A turning circle, a zigzag (rudder and change of heading), or all standard manoeuvres;
        `options` are flags of `sistership manoeuvre`, such as `speed_m_s=6.0`."""
        if turn_deg is not None:
            options["turn"] = turn_deg
        if zigzag is not None:
            options["zigzag"] = f"{zigzag[0]:g}/{zigzag[1]:g}"
        with tempfile.TemporaryDirectory() as name:
            return run_command("manoeuvre", f"--model={self.file_in(Path(name))}",
                               *option_flags(options), progress=progress)
