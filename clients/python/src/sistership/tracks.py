"""States over time."""

from __future__ import annotations

from typing import Any, List, Mapping, Sequence

CANONICAL = ("u_m_s", "v_m_s", "r_rad_s", "p_rad_s", "phi_rad", "psi_rad", "x_m", "y_m",
             "delta_rad")


class Track:
    """States over time: `track["r_rad_s"]`, `track.frame()`, `track.plot()`."""

    def __init__(self, columns: Sequence[str], rows: Sequence[Sequence[float]]) -> None:
        self.columns, self.rows = list(columns), rows

    def __repr__(self) -> str:
        last = f", {self['t_s'][-1]:g} s" if self.rows and "t_s" in self.columns else ""
        return f"Track({len(self.rows)} samples{last})"

    @classmethod
    def of(cls, trajectory: Mapping[str, Sequence[float]]) -> "Track":
        """Creates a track from the `trajectory` of a prediction."""
        columns = list(trajectory)
        return cls(columns, list(zip(*(trajectory[name] for name in columns))))

    def __getitem__(self, column: str) -> List[float]:
        place = self.columns.index(column)
        return [row[place] for row in self.rows]

    def frame(self) -> Any:
        """Returns a pandas frame."""
        import pandas

        return pandas.DataFrame(self.rows, columns=self.columns)

    def plot(self, axes: Any = None, **line: Any) -> Any:
        """Draws the track, north up, by matplotlib; `line` has options of its `plot`, such as
        `label` and `color`."""
        from matplotlib import pyplot

        axes = pyplot.gca() if axes is None else axes
        axes.plot(self["y_m"], self["x_m"], **line)
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel("east, m")
        axes.set_ylabel("north, m")
        return axes
