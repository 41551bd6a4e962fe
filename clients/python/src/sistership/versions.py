"""Versions of models: to call, to export, and to simulate in sessions."""

from __future__ import annotations

from typing import Any, Dict, Mapping, Optional, Sequence, cast

from .core import Core, ManoeuvreRequest, SessionRequest
from .equations import ExportedModel


class Version(ExportedModel):
    """A version of a model. Called with the inputs of a run it simulates on this machine."""

    def __init__(self, core: Core, ship: str, number: int) -> None:
        super().__init__()
        self.core, self.ship, self.number = core, ship, number

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
        """Its coefficients by name: `value`, `source`, and `standard_error` if it was refined."""
        return self.document["model"]["coefficients"]

    def manoeuvre(self, *, turn_deg: Optional[float] = None,
                  zigzag: Optional[Sequence[float]] = None, **further: Any) -> Dict[str, Any]:
        """A turning circle, a zigzag (rudder and change of heading), or all standard manoeuvres,
        simulated by the server; `further` has `speed_m_s`, `n_rps`, `bands`."""
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
        """Opens a simulation session on the server: `start` (`{"u_m_s": 7.0}`), `wind`, `current`,
        `depth_m`, `draws`. Use it in a `with` statement, which ends the session."""
        request = cast(SessionRequest, {"model": self.name, **asked})
        return UnderWay(self.core, self.core.post_sessions(request))

    def export(self, format: str) -> bytes:
        """The version for another tool: `c`, `python`, `matlab`, `modelica`, `fmu2`, `fmu3`, `ssp`."""
        return self.core.get_models_model_versions_number_export(
            self.ship, self.number, format=format)  # type: ignore[arg-type]


class UnderWay:
    """A simulation session on the server, advanced step by step with orders."""

    def __init__(self, core: Core, view: Mapping[str, Any]) -> None:
        self.core, self.id = core, view["id"]

    def __enter__(self) -> "UnderWay":
        return self

    def __exit__(self, *_: Any) -> None:
        self.end()

    def step(self, dt_s: float, steps: int = 1, **orders: Any) -> Dict[str, Any]:
        """Advances: `ship.step(0.5, delta_rad=0.3, n_rps=1.2)`. Other orders are unchanged; the
        answer has `trajectory` (for `Track.of`), `band`, `stopped`."""
        asked: Dict[str, Any] = {"dt_s": dt_s, "steps": steps, "orders": orders}
        return self.core.post_sessions_id_steps(self.id, asked)  # type: ignore[arg-type]

    @property
    def now(self) -> Dict[str, Any]:
        """The present state."""
        return self.core.get_sessions_id(self.id)

    def end(self) -> None:
        """Ends the session."""
        self.core.delete_sessions_id(self.id)
