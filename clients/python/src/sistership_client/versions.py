"""Versions of models: something to call, to export, and to have under way."""

from __future__ import annotations

import os
import types
from typing import Any, Dict, Mapping, Optional, Sequence, cast

from .core import Core, ManoeuvreRequest, SessionRequest
from .tracks import CANONICAL, Track
from .trials import PathLike


class Version:
    """A version of a model. Called with the inputs of a run it simulates on this machine."""

    def __init__(self, core: Core, ship: str, number: int) -> None:
        self.core, self.ship, self.number = core, ship, number
        self._module: Optional[types.ModuleType] = None

    def __repr__(self) -> str:
        return f"Version({self.name!r})"

    @property
    def name(self) -> str:
        """`ship/number`."""
        return f"{self.ship}/{self.number}"

    @property
    def document(self) -> Dict[str, Any]:
        """Recipe, model and report."""
        return self.core.get_models_model_versions_number(self.ship, self.number)["document"]

    @property
    def coefficients(self) -> Dict[str, Dict[str, Any]]:
        """Its coefficients by name: `value`, `source`, and `standard_error` where it is refined."""
        return self.document["model"]["coefficients"]

    def manoeuvre(self, *, turn_deg: Optional[float] = None,
                  zigzag: Optional[Sequence[float]] = None, **further: Any) -> Dict[str, Any]:
        """A turning circle, a zigzag (rudder and change of heading), or all standard manoeuvres,
        sailed by the server; `further` holds `speed_m_s`, `n_rps`, `bands`."""
        asked: Dict[str, Any] = {key: value for key, value in further.items() if value is not None}
        if turn_deg is not None:
            asked["turn_deg"] = turn_deg
        elif zigzag is not None:
            asked["zigzag"] = {"rudder_deg": zigzag[0], "switch_deg": zigzag[1]}
        else:
            asked["all"] = True
        manoeuvre = cast(ManoeuvreRequest, asked)
        return self.core.post_predictions({"model": self.name, "manoeuvre": manoeuvre})

    def under_way(self, **asked: Any) -> "UnderWay":
        """The ship under way on the server: `start` (`{"u_m_s": 7.0}`), `wind`, `current`,
        `depth_m`, `draws`. Use it in a `with`, which ends the session."""
        request = cast(SessionRequest, {"model": self.name, **asked})
        return UnderWay(self.core, self.core.post_sessions(request))

    def export(self, format: str) -> bytes:
        """The version for another tool: `c`, `python`, `matlab`, `modelica`, `fmu2`, `fmu3`, `ssp`."""
        return self.core.get_models_model_versions_number_export(
            self.ship, self.number, format=format)  # type: ignore[arg-type]

    def save(self, format: str, path: PathLike) -> str:
        """The same as a file; gives its path."""
        given = self.export(format)
        with open(path, "wb") as file:
            file.write(given)
        return os.fspath(path)

    @property
    def module(self) -> types.ModuleType:
        """The version's equations as a module of Python: `rates`, `step`, `run`, `simulate`."""
        if self._module is None:
            module = types.ModuleType(f"sistership_{self.ship.replace('-', '_')}_{self.number}")
            exec(compile(self.export("python"), module.__name__, "exec"), module.__dict__)
            self._module = module
        return self._module

    def __call__(self, duration_s: float, **given: Any) -> Track:
        """Sails here: `version(600.0, delta_order=0.6)`; an input (`module.INPUTS` has them all) is
        a number, or a function of time and state. `state`, `step_s` and `coefficients` may be
        given, too."""
        rows = list(self.module.run(duration_s, **given))
        return Track(["t_s", *CANONICAL], [[t, *state] for t, state in rows])


class UnderWay:
    """A ship under way on the server, who sails on as orders come."""

    def __init__(self, core: Core, view: Mapping[str, Any]) -> None:
        self.core, self.id = core, view["id"]

    def __enter__(self) -> "UnderWay":
        return self

    def __exit__(self, *_: Any) -> None:
        self.end()

    def step(self, dt_s: float, steps: int = 1, **orders: Any) -> Dict[str, Any]:
        """Sails on: `ship.step(0.5, delta_rad=0.3, n_rps=1.2)`. What is not ordered stays; the
        answer has `trajectory` (for `Track.of`), `band`, `stopped`."""
        asked: Dict[str, Any] = {"dt_s": dt_s, "steps": steps, "orders": orders}
        return self.core.post_sessions_id_steps(self.id, asked)  # type: ignore[arg-type]

    @property
    def now(self) -> Dict[str, Any]:
        """Where it is."""
        return self.core.get_sessions_id(self.id)

    def end(self) -> None:
        """Ends the session."""
        self.core.delete_sessions_id(self.id)
