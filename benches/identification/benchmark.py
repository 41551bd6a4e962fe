"""Every peer on the same data: runs peers on tasks, one process at a time, and writes the table.

`benches/identification/run --help` lists the choices; docs/benchmark.md describes data and peers.
"""

import argparse
import datetime
import importlib.metadata
import json
import os
import pathlib
import platform
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import loaders
import results
from trials import Missing

QUICK_DATA = ("kvlcc2-hsva", "gunnerus", "made-cargo-1", "made-outboard-1")
QUICK_PEERS = ("nomoto", "ridge", "pysindy", "mmg_scipy", "published", "sistership")
QUICK_TASKS = ("held-out", "small-to-large", "trials-4", "zigzags-to-turns")
TIMEOUT_S = 1800


def main():
    options = arguments()
    names = options.data.split(",") if options.data else loaders.NAMES
    peers = options.peers.split(",") if options.peers else all_peers()
    check_peers(peers)
    if options.quick:
        names = names if options.data else QUICK_DATA
        peers = peers if options.peers else QUICK_PEERS
    previous = read_previous(options.out) if options.add else []
    rows = list(previous)
    done = {(row["data"], row["task"], row["peer"]) for row in previous}
    for name in names:
        for task in tasks_of(name, options):
            for peer in peers:
                if (name, task.name, peer) not in done:
                    rows += run_job(name, task, peer, options)
                    results.write(options.out, results.with_ratios(rows), about(options.program))
    if not rows:
        sys.exit("error: no task was run; see --data and --tasks")
    print(pathlib.Path(options.out, "results.md").read_text())


def arguments():
    parser = argparse.ArgumentParser(prog="benches/identification/run", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="few data sets, tasks and peers")
    parser.add_argument("--peers", help=f"of {','.join(all_peers())}")
    parser.add_argument("--data", help=f"of {','.join(loaders.NAMES)}, or folders (with a slash) "
                                       "that hold trials.yaml and benchmark.yaml")
    parser.add_argument("--tasks", help="names of tasks, such as held-out,trials-4")
    parser.add_argument("--out", default="benchmark-results", help="folder of the results")
    parser.add_argument("--add", action="store_true", help="keep the rows that --out already has")
    parser.add_argument("--shared", default=os.environ.get("SISTERSHIP_SHARED", default_shared()),
                        help="folder of the measured data")
    parser.add_argument("--program", default=os.environ.get("SISTERSHIP_PROGRAM", ""),
                        help="the program `sistership`")
    return parser.parse_args()


def default_shared():
    """The first `shared/data` beside or above this tree."""
    found = [up / "shared/data" for up in HERE.parents if (up / "shared/data").is_dir()]
    return str(found[0]) if found else "shared/data"


def all_peers():
    return sorted(path.stem for path in (HERE / "peers").glob("*.py") if path.stem != "__init__")


def check_peers(peers):
    unknown = set(peers) - set(all_peers())
    if unknown:
        sys.exit(f"error: no peer {', '.join(sorted(unknown))}; there are {', '.join(all_peers())}")


def tasks_of(name, options):
    """The tasks of a data set that were asked for; none, said plainly, where it is missing."""
    try:
        data = loaders.load(name, options.shared)
    except Missing as reason:
        print(f"skipped: {name}: {reason}", file=sys.stderr)
        return []
    wanted = options.tasks.split(",") if options.tasks else QUICK_TASKS if options.quick else None
    return [task for task in data.tasks if wanted is None or task.name in wanted]


def run_job(name, task, peer, options):
    """Rows of one peer on one task; a peer that cannot do it, fails or is too slow has a reason."""
    with tempfile.TemporaryDirectory() as scratch:
        answer = os.path.join(scratch, "answer.json")
        request = {"data": name, "task": task.name, "peer": peer, "shared": options.shared,
                   "scratch": scratch, "answer": answer,
                   "program": os.path.abspath(options.program) if options.program else ""}
        environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1",
                       "PYTHONDONTWRITEBYTECODE": "1"}
        try:
            subprocess.run([sys.executable, str(HERE / "job.py"), json.dumps(request)], check=True,
                           timeout=TIMEOUT_S, capture_output=True, text=True, env=environment)
            with open(answer) as file:
                outcome = json.load(file)
        except subprocess.TimeoutExpired:
            outcome = {"cannot": f"not finished within {TIMEOUT_S} s"}
        except subprocess.CalledProcessError as error:
            outcome = {"cannot": f"failed: {error.stderr.strip().splitlines()[-1]}"}
    common = {"data": name, "task": task.name, "kind": task.kind, "peer": peer}
    rows = outcome.get("rows", [{"prediction": "-", "cannot": outcome.get("cannot")}])
    rows = [{**common, **row} for row in rows]
    for row in rows:
        print(f"{name} {task.name} {peer}: {row['prediction']} "
              f"{row.get('cannot') or format(row['standardised_error'], '.4g')}", file=sys.stderr)
    return rows


def read_previous(folder):
    path = pathlib.Path(folder, "results.json")
    return json.loads(path.read_text())["rows"] if path.exists() else []


def about(program):
    """Date, machine and versions of everything that took part."""
    version = "no program"
    if program:
        version = subprocess.run([program, "--version"], capture_output=True, text=True,
                                 check=True).stdout.strip()
    pinned = (HERE / "requirements.txt").read_text().split()
    versions = {}
    for name in (line.split("==")[0] for line in pinned):
        try:
            versions[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            continue
    return {"date": datetime.date.today().isoformat(), "machine": processor(),
            "cores": os.cpu_count(), "program": version, "python": platform.python_version(),
            "versions": versions}


def processor():
    try:
        with open("/proc/cpuinfo") as file:
            names = [line.split(":")[1].strip() for line in file if line.startswith("model name")]
        return names[0]
    except (OSError, IndexError):
        return platform.machine()


if __name__ == "__main__":
    main()
