"""The friendly layer over `core`: what a person at a prompt wants."""

from __future__ import annotations

import sys
import time
import types
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Union

from .core import Core
from .http import Http

ENDED = ("succeeded", "failed", "cancelled")


class JobFailed(Exception):
    """A job that came to no result, with its reason."""


class Client:
    """A server: `Client("http://127.0.0.1:8080", key="...")`."""

    def __init__(self, url: str = "http://127.0.0.1:8080", key: Optional[str] = None) -> None:
        self.core = Core(Http(url, key))

    def ship(self, name: str) -> "Ship":
        """A ship that is there."""
        self.core.get_ships_ship(name)
        return Ship(self.core, name)

    def ships(self, **search: Any) -> Iterator["Ship"]:
        """Ships, by what `GET /v1/ships` can be asked for: `category`, `tag`, `similar_to`, ..."""
        after = None
        while True:
            page = self.core.get_ships(after=after, **search)
            for head in page["items"]:
                yield Ship(self.core, head["name"])
            after = page.get("next")
            if not after:
                return

    def create(self, document: Union[str, Mapping[str, Any]]) -> "Ship":
        """A new ship, from the text of a vessel's YAML file or from its fields."""
        if isinstance(document, str):
            answer = self.core.http.json(
                "POST", "/v1/ships", body=document.encode(), media="application/yaml")
        else:
            answer = self.core.post_ships(dict(document))
        return Ship(self.core, answer["name"])

    def compare(self, versions: Sequence[Union[str, "Version"]],
                trials: Sequence[str] = ()) -> Dict[str, Any]:
        """Two to five versions side by side, and their errors on the same trials."""
        names = [version if isinstance(version, str) else version.name for version in versions]
        return self.core.get_compare(version=names, trial=list(trials) or None)


class Ship:
    """A ship of the server."""

    def __init__(self, core: Core, name: str) -> None:
        self.core, self.name = core, name

    def __repr__(self) -> str:
        return f"Ship({self.name!r})"

    @property
    def about(self) -> Dict[str, Any]:
        """Title, category, condition and document."""
        return self.core.get_ships_ship(self.name)

    def upload(self, trial: Any, name: str, manoeuvre: Optional[str] = None,
               depth_m: Optional[float] = None, diagnose: Optional[bool] = None) -> str:
        """Keeps a trial and gives its id: a pandas frame with canonical columns (`t_s, u_m_s,
        v_m_s, r_rad_s, psi_rad, delta_rad, ...`), the text of such a CSV file, or its bytes."""
        if hasattr(trial, "to_csv"):
            trial = trial.to_csv(index=False)
        body = trial.encode() if isinstance(trial, str) else bytes(trial)
        answer = self.core.post_trials(body, "text/csv", ship=self.name, name=name,
                                       manoeuvre=manoeuvre, depth_m=depth_m, diagnose=diagnose)
        return answer["trials"][0]["id"]

    def trials(self) -> List[Dict[str, Any]]:
        """Every trial of the ship."""
        found: List[Dict[str, Any]] = []
        after = None
        while True:
            page = self.core.get_trials(ship=self.name, after=after)
            found.extend(page["items"])
            after = page.get("next")
            if not after:
                return found

    def refine(self, **asked: Any) -> "Job":
        """Refines a model: plainly, or with `source`, `law`, `trials` and `settings`."""
        return Job(self.core, self.core.post_refinements({"ship": self.name, **asked}))

    def champion(self) -> "Version":
        """The model that the ship stands for."""
        head = self.core.get_ships_ship_model(self.name)["version"]
        return Version(self.core, head["model"], head["number"])

    def version(self, number: int) -> "Version":
        """A version of the ship's model."""
        return Version(self.core, self.name, number)


class Job:
    """Long work."""

    def __init__(self, core: Core, view: Mapping[str, Any]) -> None:
        self.core, self.view = core, dict(view)

    @property
    def id(self) -> str:
        """Its id."""
        return self.view["id"]

    def refresh(self) -> "Job":
        """Looks how far it is."""
        self.view = dict(self.core.get_jobs_id(self.id))
        return self

    def cancel(self) -> None:
        """Asks it to stop."""
        self.view = dict(self.core.delete_jobs_id(self.id))

    def wait(self, progress: Union[bool, Callable[[float, str], None]] = True,
             every_s: float = 0.5) -> Dict[str, Any]:
        """Its result, when it has one; `progress` draws a bar, or is called with share and words.

        Raises `JobFailed` with the server's reason."""
        tell = _bar if progress is True else progress or None
        while self.refresh().view["state"] not in ENDED:
            if tell:
                tell(self.view["progress"], self.view["message"])
            time.sleep(every_s)
        if tell:
            tell(1.0, self.view["state"])
        if progress is True and sys.stderr.isatty():
            print(file=sys.stderr)
        if self.view["state"] != "succeeded":
            raise JobFailed(self.view.get("error") or self.view["state"])
        return self.view["result"]


def _bar(share: float, words: str) -> None:
    if sys.stderr.isatty():
        done = round(30 * share)
        print(f"\r[{'#' * done}{'.' * (30 - done)}] {words[:40]:40}", end="", file=sys.stderr)


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
        return self.core.post_predictions({"model": self.name, "manoeuvre": asked})

    def under_way(self, **asked: Any) -> "UnderWay":
        """The ship under way on the server: `start` (`{"u_m_s": 7.0}`), `wind`, `current`,
        `depth_m`, `draws`. Use it in a `with`, which ends the session."""
        return UnderWay(self.core, self.core.post_sessions({"model": self.name, **asked}))

    def export(self, format: str, path: Optional[str] = None) -> bytes:
        """The version for another tool: `c`, `python`, `matlab`, `modelica`, `fmu2`, `fmu3`."""
        given = self.core.get_models_model_versions_number_export(
            self.ship, self.number, format=format)  # type: ignore[arg-type]
        if path:
            with open(path, "wb") as file:
                file.write(given)
        return given

    @property
    def module(self) -> types.ModuleType:
        """The version's equations as a module of Python: `rates`, `step`, `run`, `simulate`."""
        if self._module is None:
            module = types.ModuleType(f"sistership_{self.ship.replace('-', '_')}_{self.number}")
            exec(compile(self.export("python"), module.__name__, "exec"), module.__dict__)
            self._module = module
        return self._module

    def __call__(self, duration_s: float, **given: Any) -> "Track":
        """Sails here: `version(600.0, delta_order=0.6)`; an input is a number, or a function of
        time and state."""
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


CANONICAL = ("u_m_s", "v_m_s", "r_rad_s", "p_rad_s", "phi_rad", "psi_rad", "x_m", "y_m",
             "delta_rad")


class Track:
    """States over time."""

    def __init__(self, columns: Sequence[str], rows: Sequence[Sequence[float]]) -> None:
        self.columns, self.rows = list(columns), rows

    @classmethod
    def of(cls, trajectory: Mapping[str, Sequence[float]]) -> "Track":
        """Of the `trajectory` of a prediction."""
        columns = list(trajectory)
        return cls(columns, list(zip(*(trajectory[name] for name in columns))))

    def __getitem__(self, column: str) -> List[float]:
        place = self.columns.index(column)
        return [row[place] for row in self.rows]

    def frame(self) -> Any:
        """As a frame of pandas."""
        import pandas

        return pandas.DataFrame(self.rows, columns=self.columns)

    def plot(self, axes: Any = None) -> Any:
        """Draws where the ship went, north up, by matplotlib."""
        from matplotlib import pyplot

        axes = axes or pyplot.gca()
        axes.plot(self["y_m"], self["x_m"])
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel("east, m")
        axes.set_ylabel("north, m")
        return axes
