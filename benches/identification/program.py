"""The program `sistership` by its command line, in the scratch folder of a task."""

import json
import os
import subprocess

from job import CannotDo
from trials import PLACE, write_canonical


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

    def answer(self, *arguments):
        """The JSON document of a command; empty where it has refused."""
        try:
            return json.loads(self.call(*arguments))
        except (CannotDo, json.JSONDecodeError):
            return {}

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
