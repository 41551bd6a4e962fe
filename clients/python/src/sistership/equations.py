"""Models as functions of time, by the equations that are exported as Python."""

from __future__ import annotations

import os
import re
import types
from typing import Any, Optional

from .tracks import CANONICAL, Track
from .trials import PathLike


class ExportedModel:
    """A model that is exported to other tools, and that simulates on this machine when called."""

    def __init__(self) -> None:
        self._module: Optional[types.ModuleType] = None

    @property
    def name(self) -> str:
        """The model's name."""
        raise NotImplementedError

    def export(self, format: str) -> bytes:
        """The model for another tool: `c`, `python`, `matlab`, `modelica`, `fmu2`, `fmu3`."""
        raise NotImplementedError

    def save(self, format: str, path: PathLike) -> str:
        """The same as a file; gives its path."""
        given = self.export(format)
        with open(path, "wb") as file:
            file.write(given)
        return os.fspath(path)

    @property
    def module(self) -> types.ModuleType:
        """The model's equations as a module of Python: `rates`, `step`, `run`, `simulate`."""
        if self._module is None:
            module = types.ModuleType("sistership_" + re.sub(r"\W", "_", self.name))
            exec(compile(self.export("python"), module.__name__, "exec"), module.__dict__)
            self._module = module
        return self._module

    def __call__(self, duration_s: float, **given: Any) -> Track:
        """Simulates here: `model(600.0, delta_order=0.6)`; an input (`module.INPUTS` has them all)
        is a number, or a function of time and state. `state`, `step_s` and `coefficients` may be
        given, too."""
        rows = list(self.module.run(duration_s, **given))
        return Track(["t_s", *CANONICAL], [[t, *state] for t, state in rows])
