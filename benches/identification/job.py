"""One peer on one task, in a process of its own: fits, predicts, and writes the scores as JSON."""

import dataclasses
import importlib
import json
import resource
import sys

import numpy as np

import loaders
from motion import limits
from scores import score, windows_of
from trials import Window


class CannotDo(Exception):
    """A task that a peer has no way to do, with the reason."""


@dataclasses.dataclass
class Training:
    """All that a peer is given: the ship, the controls and the trials of the training side."""
    ship: object
    controls: tuple
    trials: list
    scratch: str
    program: str


def run(request):
    """Scores of a request: one row for whole runs and one for restarts, where the task has both."""
    data = loaders.load(request["data"], request["shared"])
    task = next(task for task in data.tasks if task.name == request["task"])
    training = Training(data.ship, data.controls, data.select(task.train), request["scratch"],
                        request["program"])
    np.random.seed(1)
    peer = importlib.import_module(f"peers.{request['peer']}")
    if task.kind == "diagnosis" and not getattr(peer, "DIAGNOSES", False):
        raise CannotDo("names no effects")
    started = processor_seconds()
    model = peer.fit(training)
    if task.kind == "diagnosis":
        return [diagnosis(model, data.select(task.test), started)]
    seconds = processor_seconds() - started
    limit = limits(training.trials)
    rows = []
    for restart in [0.0] + [task.restart_s] * (task.restart_s > 0):
        windows = [Window(trial, start, stop) for trial in data.select(task.test)
                   for start, stop in windows_of(trial, restart)]
        rows.append({"prediction": "restarts" if restart else "whole runs", "restart_s": restart,
                     **score(windows, model.simulate(windows), limit),
                     "parameters": model.parameters, "seconds": seconds,
                     "settings": str(getattr(model, "settings", ""))})
    for row in rows:
        row["memory_mb"] = memory_mb()
        row["reference"] = data.ship.made_by_published and request["peer"] == "published"
        if row["restart_s"]:
            row["imo_percent"] = None
    return rows


def diagnosis(model, trials, started):
    """The effects that a model names in trials it was not fitted on."""
    named = ", ".join(model.diagnose(trials)) or "nothing"
    return {"prediction": "diagnosis", "named": named, "parameters": model.parameters,
            "seconds": processor_seconds() - started, "memory_mb": memory_mb()}


def processor_seconds():
    """Processor time of this process and the programs it ran: wall time depends on neighbours."""
    both = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(usage.ru_utime + usage.ru_stime for usage in both)


def memory_mb():
    """Peak memory of this process, or of a program that it ran."""
    most = max(resource.getrusage(who).ru_maxrss
               for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return most / 1024


def set_limits(request):
    """Processor time and memory of this process, and of each program that it runs."""
    seconds, most = int(request["seconds"]), int(request["memory_gb"] * 2**30)
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    resource.setrlimit(resource.RLIMIT_DATA, (most, most))


if __name__ == "__main__":
    sys.modules["job"] = sys.modules["__main__"]
    request = json.loads(sys.argv[1])
    set_limits(request)
    try:
        answer = {"rows": run(request)}
    except CannotDo as reason:
        answer = {"cannot": str(reason)}
    with open(request["answer"], "w") as file:
        json.dump(answer, file)
