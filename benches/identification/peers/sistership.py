"""The program by its command line: `init`, `import`, `refine`, `simulate`, default settings."""

import json
import os

import numpy as np

from program import Program
from trials import PLACE, STATES, UNITS

DIAGNOSES = True
# Models drawn from the posterior for the bands of headings.
DRAWS = 40


def fit(task, *flags):
    program = Program(task)
    ship = program.init(task.ship)
    files = program.write(task.trials, "fitted")
    manifest = os.path.join(task.scratch, "trials.yaml")
    program.call("import", *files, "--ship", ship, "--out", manifest)
    model = os.path.join(task.scratch, "model.yaml")
    report = program.call("refine", "--ship", ship, "--trials", manifest, "--out", model, "--json",
                          *flags)
    return Model(program, model, report)


class Model:
    """A refined model, or one of the zoo, simulated by `simulate`."""

    def __init__(self, program, model, report=None):
        self.program, self.model = program, model
        document = json.loads(report) if report else {}
        self.parameters = count(document)
        self.settings = describe(document)

    def simulate(self, windows):
        """All windows by one call. Positions are not given: a fix that jumps would have the file
        refused. A run that leaves the physical range has a shorter file and exit status 1."""
        files = self.program.write([w.truth for w in windows], "window", ("psi",))
        out = os.path.join(self.program.task.scratch, "simulated")
        self.program.call("simulate", "--model", self.model, "--trials", *files, "--out", out)
        found = [read(os.path.join(out, os.path.basename(f)), w) for f, w in zip(files, windows)]
        return [run and {**run, **self.band(window)} for run, window in zip(found, windows)]

    def band(self, window):
        """Band of headings of a whole run, by `predict`, which starts from a steady course ahead
        under one rudder; empty for other runs and for models without a posterior."""
        truth, controls = window.truth, self.program.task.controls
        u, v, r = (truth[name][0] for name in STATES)
        length = self.program.task.ship.length
        if (window.start or self.parameters == 0 or controls[0] != "delta"
                or max(abs(v), abs(r) * length) > 0.05 * u):
            return {}
        orders = os.path.join(self.program.task.scratch, "orders.csv")
        names = ["delta", "n"][:len(controls)]
        header = ",".join(["t_s", *(f"{name}_{UNITS[name]}" for name in names)])
        np.savetxt(orders, truth.columns(["t", *names]), delimiter=",", header=header, comments="")
        answer = self.program.answer(
            "predict", "--model", self.model, "--orders", orders, "--speed-m-s", str(u),
            "--heading-deg", "0", "--duration-s", str(truth["t"][-1] - truth["t"][0]), "--dt-s",
            str(truth.dt), "--draws", str(DRAWS), "--json")
        band = answer.get("band") or {}
        if len(answer.get("trajectory", {}).get("t_s", ())) != len(truth) or not band:
            return {}
        ends = {f"psi_{end}": np.array(band[end]["psi_rad"], float) for end in ("low", "high")}
        return {name: values for name, values in ends.items() if np.isfinite(values).all()}

    def diagnose(self, trials):
        """Effects that `diagnose` names, in its order."""
        files = self.program.write(trials, "diagnosed")
        answer = self.program.answer("diagnose", "--model", self.model, "--trials", *files, "--json")
        return named_effects(answer)


def read(path, window):
    """States of a simulation; None where it stopped before the end of the window."""
    if not os.path.exists(path):
        return None
    table = np.genfromtxt(path, delimiter=",", names=True)
    if table.size != len(window.truth):
        return None
    return {name.split("_")[0]: table[name] for name in table.dtype.names
            if name.split("_")[0] in (*STATES, *PLACE)}


def named_effects(answer):
    """Names of the effects of a diagnosis; `unexplained` where something remains without a name."""
    named = [found["name"] for found in answer.get("effects", [])]
    return named + ["unexplained"] * (answer.get("verdict") == "unexplained")


def count(document):
    """Coefficients of the refined model that are not zero."""
    rows = document.get("coefficients", [])
    return sum(row["refined"] != 0.0 for row in rows) if rows else None


def describe(document):
    """Source, law and method that the model selection chose."""
    if not document:
        return ""
    return f"{document['source']}, {document['model']['law']}, {document['method']}"
