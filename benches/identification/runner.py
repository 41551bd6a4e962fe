"""One peer on one task in a process of its own, with limits of time and memory."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent


class OutOfTime(Exception):
    """The whole run is over its time."""


def run_job(name, task, peer, options):
    """Rows of one peer on one task; a peer that cannot do it, fails or is too slow has a reason."""
    with tempfile.TemporaryDirectory() as scratch:
        outcome = outcome_of(name, task, peer, options, scratch)
    common = {"data": name, "task": task.name, "kind": task.kind, "peer": peer,
              "program": options.identity if peer in PROGRAM_PEERS else ""}
    rows = outcome.get("rows", [{"prediction": "-", "cannot": outcome.get("cannot")}])
    return [{**common, **row} for row in rows]


# Limit of wall time over that of processor time: the machine may be shared.
WALL = 15
PROGRAM_PEERS = ("sistership", "sistership_accurate", "published")


def outcome_of(name, task, peer, options, scratch):
    """Answer of `job.py`: rows, or the reason why there are none."""
    answer = os.path.join(scratch, "answer.json")
    request = {"data": name, "task": task.name, "peer": peer, "shared": options.shared,
               "scratch": scratch, "answer": answer, "seconds": options.seconds,
               "memory_gb": options.memory_gb,
               "program": os.path.abspath(options.program) if options.program else ""}
    interpreter = python_of(peer)
    if interpreter is None:
        return {"cannot": "no environment of its own; benches/identification/run makes it"}
    # A session of its own: what the peer has started ends with it.
    process = subprocess.Popen([interpreter, "-B", str(HERE / "job.py"), json.dumps(request)],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                               env=environment(), start_new_session=True)
    left = options.deadline - time.monotonic()
    try:
        _, errors = process.communicate(timeout=min(WALL * options.seconds, max(left, 0.1)))
    except subprocess.TimeoutExpired as late:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        if left <= WALL * options.seconds:
            raise OutOfTime from late
        return {"cannot": f"took longer than {options.seconds:g} s"}
    if process.returncode == -signal.SIGXCPU:
        return {"cannot": f"took longer than {options.seconds:g} s"}
    if process.returncode != 0:
        last = (errors.strip().splitlines() or [f"ended by signal {-process.returncode}"])[-1]
        return {"cannot": f"failed: {last}"}
    with open(answer) as file:
        return json.load(file)


def environment():
    """Environment of a peer: one thread."""
    single = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS",
                            "RAYON_NUM_THREADS"), "1")
    return {**os.environ, **single, "JAX_PLATFORMS": "cpu", "MPLBACKEND": "Agg",
            "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"}


def python_of(peer):
    """The interpreter of a peer: `NAME_...` has that of requirements-NAME.txt, where there is one."""
    family = peer.split("_")[0]
    if not (HERE / f"requirements-{family}.txt").exists():
        return sys.executable
    place = os.environ.get("SISTERSHIP_BENCHMARK_ENV", str(HERE / ".venv"))
    path = os.path.join(f"{place}-{family}", "bin", "python")
    return path if os.path.exists(path) else None
