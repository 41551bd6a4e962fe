"""Any folder with a manifest of the program: `trials.yaml`, and beside it `benchmark.yaml`.

`benchmark.yaml` states the ship and the splits (docs/benchmark.md). Files are CSV; columns, units,
the sense of the rudder and `from`, `to` of a trial are read as the manifest says, dates and
positions on the globe are not.
"""

import os

import numpy as np

from trials import STATES, DataSet, Missing, Ship, Task, read_columns, uniform_trial

FACTORS = {"s": 1, "ms": 1e-3, "m": 1, "rad": 1, "deg": np.pi / 180, "m/s": 1, "kn": 0.514444,
           "rad/s": 1, "deg/s": np.pi / 180, "rps": 1, "rpm": 1 / 60}
CHANNELS = ("t", "x", "y", "psi", "u", "v", "r", "delta", "n", "n_p", "n_s")


def load(path, _shared):
    import yaml
    try:
        with open(os.path.join(path, "trials.yaml")) as file:
            manifest = yaml.safe_load(file)
        with open(os.path.join(path, "benchmark.yaml")) as file:
            judged = yaml.safe_load(file)
    except FileNotFoundError as error:
        raise Missing(f"{error.filename} is missing") from error
    absent = {"t", *STATES, *judged["controls"]} - set(manifest["columns"])
    if absent:
        raise ValueError(f"{path}/trials.yaml: no column for {sorted(absent)}; each of t, u, v, r and "
                         "the controls needs one under `columns`")
    step = float(judged["step_s"])
    trials = [read_trial(path, entry, manifest, step) for entry in manifest["trials"]]
    names = [trial.name for trial in trials]
    tasks = [read_task(entry, names) for entry in judged["tasks"]]
    given = judged["ship"]
    ship = Ship(given["name"], given["category"], given["particulars"], given.get("zoo", ""),
                given.get("published", ""), given.get("actuators", ""))
    return DataSet(given["name"], ship, tuple(judged["controls"]), trials, tasks)


def read_trial(path, entry, manifest, step):
    columns = read_columns(os.path.join(path, entry["file"]))
    channels = {}
    for channel, about in manifest["columns"].items():
        if channel in CHANNELS:
            channels[channel] = columns[about["column"]] * FACTORS[about["unit"]]
    if manifest.get("conventions", {}).get("rudder_positive") == "port_turn":
        channels["delta"] = -channels["delta"]
    if "psi" in channels:
        channels["psi"] = np.unwrap(channels["psi"])
    t = channels["t"]
    inside = (t >= entry.get("from", -np.inf)) & (t <= entry.get("to", np.inf))
    cut = {name: values[inside] for name, values in channels.items()}
    return uniform_trial(entry.get("name", entry["file"]), cut, step)


def read_task(entry, names):
    test = entry["test"]
    train = entry.get("train", [name for name in names if name not in test])
    unknown = set(train + test) - set(names)
    if unknown:
        raise ValueError(f"benchmark.yaml: task `{entry['name']}` names {sorted(unknown)}, which "
                         f"trials.yaml has not; it has {names}")
    return Task(entry["name"], entry["kind"], train, test, float(entry.get("restart_s", 0)))
