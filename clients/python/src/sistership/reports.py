"""Outcomes of refinements and diagnoses on this machine."""

from __future__ import annotations

import html
import os
from typing import Any, Dict, Optional

from .models import Model
from .trials import PathLike

# Channels of the errors in the order of the report, with their units.
CHANNELS = {"u": "m/s", "v": "m/s", "r": "rad/s", "psi": "rad", "x": "m", "y": "m",
            "phi": "rad", "p": "rad/s"}


class Report:
    """An outcome: `document` has all figures, `html` the page, `model` what was found (`None` if a
    diagnosis found no effect). A notebook shows the page."""

    def __init__(self, document: Dict[str, Any], page: str, model: Optional[Model]) -> None:
        self.document, self.html, self.model = document, page, model

    def __repr__(self) -> str:
        if "verdict" in self.document:
            return f"Report(verdict {self.document['verdict']})"
        return f"Report({self.document['ship']} from {self.document['source']})"

    def _repr_html_(self) -> str:
        """The page in a frame of its own, so that its style stays inside."""
        return (f'<iframe srcdoc="{html.escape(self.html)}" style="width:100%;height:45em;'
                f'border:1px solid #ccc" title="{html.escape(repr(self))}"></iframe>')

    def save(self, path: PathLike) -> str:
        """Writes the page; gives its path."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.html)
        return os.fspath(path)

    @property
    def held_out(self) -> Dict[str, Dict[str, float]]:
        """Root mean square errors on held-out manoeuvres, of `source` and `refined`, by channel, in
        SI units."""
        errors = self.document["held_out"]
        return {side: errors[side] for side in ("source", "refined")}

    def errors(self) -> Any:
        """`held_out` as a frame of pandas: a row for each channel, with its unit."""
        import pandas

        frame = pandas.DataFrame(self.held_out)
        frame = frame.loc[[channel for channel in CHANNELS if channel in frame.index]]
        frame.insert(0, "unit", [CHANNELS[channel] for channel in frame.index])
        return frame

    def coefficients(self) -> Any:
        """Every coefficient as a frame of pandas, by name: source, estimate, standard error."""
        import pandas

        return pandas.DataFrame(self.document["coefficients"]).set_index("name")

    def plot(self, axes: Any = None) -> Any:
        """Draws the errors of the refined model by those of the source, by matplotlib."""
        from matplotlib import pyplot

        axes = pyplot.gca() if axes is None else axes
        before, after = self.held_out["source"], self.held_out["refined"]
        channels = [name for name in CHANNELS if before.get(name)]
        axes.bar(channels, [after[name] / before[name] for name in channels])
        axes.axhline(1.0, color="black", linewidth=1.0)
        axes.set_ylabel("held-out error, refined / source")
        return axes
