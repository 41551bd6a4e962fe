"""Trials, ships and data sets in one form: SI units, radians, positive to starboard."""

import csv
import dataclasses
import pathlib

import numpy as np

STATES = ("u", "v", "r")
PLACE = ("psi", "x", "y")
UNITS = {"t": "s", "x": "m", "y": "m", "psi": "rad", "u": "m_s", "v": "m_s", "r": "rad_s",
         "delta": "rad", "n": "rps", "n_p": "rps", "n_s": "rps"}


class Missing(Exception):
    """A data set whose folder is not on this machine."""


@dataclasses.dataclass
class Trial:
    """One run: channels of equal length at equal steps of time; `measured` lacks derived ones."""
    name: str
    channels: dict
    measured: tuple = STATES + PLACE

    def __getitem__(self, channel):
        return self.channels[channel]

    def __len__(self):
        return len(self.channels["t"])

    @property
    def dt(self):
        return float(self["t"][1] - self["t"][0])

    def columns(self, names):
        """Channels side by side, one row per sample."""
        return np.stack([self[name] for name in names], axis=1)

    def part(self, start, stop):
        """Samples from `start` up to `stop`."""
        cut = {name: values[start:stop] for name, values in self.channels.items()}
        return Trial(f"{self.name}@{start}", cut, self.measured)


@dataclasses.dataclass
class Window:
    """A piece of a trial to be predicted: its first state, its controls, the samples before it."""
    trial: Trial
    start: int
    stop: int

    @property
    def truth(self):
        return self.trial.part(self.start, self.stop)

    @property
    def before(self):
        return self.trial.part(0, self.start)


@dataclasses.dataclass
class Ship:
    """What a user knows of a ship; `zoo` names its published model in the program's zoo."""
    name: str
    category: str
    particulars: dict
    zoo: str = ""
    published: str = ""
    actuators: str = ""
    # Whether the published model has made the data: its errors are shown, not compared.
    made_by_published: bool = False

    @property
    def length(self):
        return self.particulars["lpp_m"]


@dataclasses.dataclass
class Task:
    """A fixed split; `restart_s` adds predictions that restart from the measured state."""
    name: str
    kind: str
    train: list
    test: list
    restart_s: float = 0.0


@dataclasses.dataclass
class DataSet:
    """Trials of one ship with the controls that moved it and the splits to be judged by."""
    name: str
    ship: Ship
    controls: tuple
    trials: list
    tasks: list

    def select(self, names):
        by_name = {trial.name: trial for trial in self.trials}
        return [by_name[name] for name in names]


def uniform_trial(name, channels, dt, measured=STATES + PLACE):
    """Means over steps of `dt`, heading and positions integrated where they were not measured.

    Rows without a time are left out (blank lines at the end of a recording)."""
    dated = np.isfinite(np.asarray(channels["t"], float))
    channels = {name: np.asarray(values, float)[dated] for name, values in channels.items()}
    t = channels["t"]
    edges = np.arange(t[0], t[-1] + 1e-9, dt)
    half = max(dt, float(np.median(np.diff(t)))) / 2
    means = {name: _means(t, values, edges, half)
             for name, values in channels.items() if name != "t"}
    means["t"] = edges - edges[0]
    if "psi" not in means:
        means["psi"] = integrate(means["r"], dt)
    if "x" not in means:
        means["x"], means["y"] = track(means["u"], means["v"], means["psi"], dt)
    return Trial(name, means, tuple(c for c in measured if c in channels))


def _means(t, values, centres, half):
    good = np.isfinite(values)
    t, values = t[good], values[good]
    sums = np.concatenate([[0.0], np.cumsum(values)])
    low = np.searchsorted(t, centres - half + 1e-9)
    high = np.searchsorted(t, centres + half - 1e-9)
    count = high - low
    mean = (sums[high] - sums[low]) / np.maximum(count, 1)
    return np.where(count > 0, mean, np.interp(centres, t, values))


def integrate(rate, dt):
    """Trapezoidal integral along the first axis, from zero."""
    steps = (rate[1:] + rate[:-1]) * dt / 2
    return np.concatenate([np.zeros((1,) + rate.shape[1:]), np.cumsum(steps, axis=0)])


def track(u, v, psi, dt):
    """Positions relative to the first one."""
    return (integrate(u * np.cos(psi) - v * np.sin(psi), dt),
            integrate(u * np.sin(psi) + v * np.cos(psi), dt))


def read_columns(path, delimiter=","):
    """Columns of a CSV file by name; blank cells become NaN."""
    with open(path, newline="") as file:
        names, *rows = csv.reader(file, delimiter=delimiter)
    columns = zip(*(row for row in rows if row))
    return {name: np.array([cell.strip() or "nan" for cell in column]).astype(float)
            for name, column in zip(names, columns)}


def write_canonical(trial, controls, path, place=PLACE):
    """Writes a trial with the program's canonical column names, heading and position if measured."""
    names = ["t", *STATES, *[name for name in place if name in trial.measured], *controls]
    header = [f"{name}_{UNITS[name]}" for name in names]
    np.savetxt(path, trial.columns(names), delimiter=",", header=",".join(header), comments="",
               fmt="%.9g")
    return pathlib.Path(path)
