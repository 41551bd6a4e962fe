"""Servers and ships: the convenient interface on top of `core`."""

from __future__ import annotations

import json
from typing import Any, Iterator, List, Mapping, Optional, Sequence, Union, cast

from .core import Comparison, Core, RefinementRequest, ShipDetail, VesselFile
from .http import Http
from .jobs import Job
from .trials import PathLike, Trial, form, ids
from .versions import Version


class Client:
    """A server: `Client("http://127.0.0.1:8080", key="...")`."""

    def __init__(self, url: str = "http://127.0.0.1:8080", key: Optional[str] = None) -> None:
        self.core = Core(Http(url, key))

    def __repr__(self) -> str:
        return f"Client({self.core.http.url!r})"

    def ship(self, name: str) -> "Ship":
        """Returns an existing ship."""
        self.core.get_ships_ship(name)
        return Ship(self.core, name)

    def ships(self, **search: Any) -> Iterator["Ship"]:
        """Ships by the parameters of `GET /v1/ships`: `category`, `tag`, `similar_to`, ..."""
        after = None
        while True:
            page = self.core.get_ships(after=after, **search)
            for head in page["items"]:
                yield Ship(self.core, head["name"])
            after = page.get("next")
            if not after:
                return

    def create(self, document: Union[str, Mapping[str, Any]]) -> "Ship":
        """Creates a ship from the text of a vessel's YAML file or from its fields."""
        if isinstance(document, str):
            answer = self.core.http.json(
                "POST", "/v1/ships", body=document.encode(), media="application/yaml")
        else:
            answer = self.core.post_ships(cast(VesselFile, dict(document)))
        return Ship(self.core, answer["name"])

    def version(self, name: str) -> Version:
        """Returns a version by `ship/number`, or the champion by `ship`."""
        ship, _, number = name.partition("/")
        return Ship(self.core, ship).version(int(number)) if number else self.ship(ship).champion()

    def compare(self, versions: Sequence[Union[str, Version]],
                trials: Sequence[Union[str, Trial]] = ()) -> Comparison:
        """Compares two to five versions, also by their errors on the same trials."""
        names = [version if isinstance(version, str) else version.name for version in versions]
        return self.core.get_compare(version=names, trial=ids(trials) or None)


class Ship:
    """A ship of the server."""

    def __init__(self, core: Core, name: str) -> None:
        self.core, self.name = core, name

    def __repr__(self) -> str:
        return f"Ship({self.name!r})"

    @property
    def about(self) -> ShipDetail:
        """Title, category, condition and document."""
        return self.core.get_ships_ship(self.name)

    def upload(self, trial: Any, name: str, manoeuvre: Optional[str] = None,
               depth_m: Optional[float] = None, diagnose: Optional[bool] = None) -> Trial:
        """Uploads a trial: a pandas frame with canonical columns (`t_s, u_m_s, v_m_s, r_rad_s,
        psi_rad, delta_rad, ...`; other units by suffix, such as `u_kn`, `r_deg_s`), the text of
        such a CSV file, or its bytes."""
        if hasattr(trial, "to_csv"):
            trial = trial.to_csv(index=trial.index.name is not None)
        body = trial.encode() if isinstance(trial, str) else bytes(trial)
        answer = self.core.post_trials(body, "text/csv", ship=self.name, name=name,
                                       manoeuvre=manoeuvre, depth_m=depth_m, diagnose=diagnose)
        return Trial(self.core, answer["trials"][0])

    def upload_files(self, files: Sequence[str], manifest: Union[str, Mapping[str, Any]],
                     folder: PathLike = ".", diagnose: Optional[bool] = None) -> List[Trial]:
        """Uploads the trials of a manifest with their files, all or none. The manifest is a
        text, or its `columns`, `conventions` and `trials`; its files are relative to
        `folder`."""
        if not isinstance(manifest, str):
            manifest = json.dumps({"kind": "trials", "ship": self.name, **manifest})
        body, media = form(manifest, files, folder)
        answer = self.core.post_trials(body, media, diagnose=diagnose)
        return [Trial(self.core, about) for about in answer["trials"]]

    def trials(self) -> List[Trial]:
        """All trials of the ship."""
        found: List[Trial] = []
        after = None
        while True:
            page = self.core.get_trials(ship=self.name, after=after)
            found.extend(Trial(self.core, about) for about in page["items"])
            after = page.get("next")
            if not after:
                return found

    def refine(self, trials: Optional[Sequence[Union[str, Trial]]] = None, **asked: Any) -> Job:
        """Refines a model against all or some trials, with default settings or with `source`, `law`
        and `settings`."""
        if trials is not None:
            asked["trials"] = ids(trials)
        request = cast(RefinementRequest, {"ship": self.name, **asked})
        return Job(self.core, self.core.post_refinements(request))

    def champion(self) -> Version:
        """The champion of the ship: the version in use."""
        head = self.core.get_ships_ship_model(self.name)["version"]
        return Version(self.core, head["model"], head["number"])

    def version(self, number: int) -> Version:
        """A version of the ship's model."""
        return Version(self.core, self.name, number)
