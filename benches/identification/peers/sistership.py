"""The program by its command line: `init`, `import`, `refine`, `simulate`, default settings."""

import json
import os
import subprocess

import numpy as np

from job import CannotDo
from trials import PLACE, STATES, write_canonical

NEEDS = ("numpy",)


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


class Program:
    """Commands in the scratch folder of a task."""

    def __init__(self, task):
        self.task = task
        if not task.program:
            raise CannotDo("no program: name it in SISTERSHIP_PROGRAM")

    def call(self, *arguments):
        done = subprocess.run([self.task.program, *arguments], capture_output=True, text=True,
                              cwd=self.task.scratch, env={**os.environ, "RAYON_NUM_THREADS": "1"})
        errors = [line for line in done.stderr.splitlines() if line.startswith("error")]
        if errors or done.returncode == 2:
            raise CannotDo(f"`{arguments[0]}` refused: {' '.join(errors)}")
        return done.stdout

    def init(self, ship):
        """Particulars as a user states them; the zoo's file where it has the ship without model."""
        path = os.path.join(self.task.scratch, "ship.yaml")
        values = [f"{name}={value}" for name, value in ship.particulars.items()]
        self.call("init", ship.name, "--category", ship.category, *values, "--out", path)
        if ship.actuators:
            with open(path, "a") as file:
                file.write(f"actuators:\n{ship.actuators}")
        return path

    def write(self, trials, prefix, place=PLACE):
        paths = [os.path.join(self.task.scratch, f"{prefix}-{k:03}.csv") for k in range(len(trials))]
        for trial, path in zip(trials, paths):
            write_canonical(trial, self.task.controls, path, place)
        return paths


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
        return [read(os.path.join(out, os.path.basename(f)), w) for f, w in zip(files, windows)]


def read(path, window):
    """States of a simulation; None where it stopped before the end of the window."""
    if not os.path.exists(path):
        return None
    table = np.genfromtxt(path, delimiter=",", names=True)
    if table.size != len(window.truth):
        return None
    return {name.split("_")[0]: table[name] for name in table.dtype.names
            if name.split("_")[0] in (*STATES, *PLACE)}


def count(document):
    """Coefficients of the refined model that are not zero."""
    rows = document.get("coefficients", [])
    return sum(row["refined"] != 0.0 for row in rows) if rows else None


def describe(document):
    """Source, law and method that the model selection chose."""
    if not document:
        return ""
    return f"{document['source']}, {document['model']['law']}, {document['method']}"
