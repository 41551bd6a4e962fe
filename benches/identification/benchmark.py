"""Every peer on the same data: runs peers on tasks, one process at a time, and writes the table.

`benches/identification/run --help` lists the choices; docs/benchmark.md describes data and peers.
"""

import argparse
import datetime
import hashlib
import importlib.metadata
import os
import pathlib
import platform
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import loaders
import results
from runner import OutOfTime, run_job
from trials import Missing

# Two measured ships, two made ones and the peers that fit in seconds: within ten minutes.
QUICK_DATA = ("gunnerus", "kvlcc2-hsva", "made-cargo-1", "made-outboard-1")
QUICK_PEERS = ("nomoto", "ridge", "published", "sistership", "mmg_scipy", "pysindy")
QUICK_TASKS = ("held-out", "trials-4")
QUICK_SECONDS, SECONDS = 60, 900
# The whole of `--quick` by the clock; what is left then is run by `--add`.
QUICK_LIMIT_S = 570


def main():
    options = arguments()
    names = options.data.split(",") if options.data else loaders.NAMES
    peers = options.peers.split(",") if options.peers else all_peers()
    check_peers(peers)
    if options.quick:
        names = names if options.data else QUICK_DATA
        peers = peers if options.peers else QUICK_PEERS
    options.seconds = options.seconds or (QUICK_SECONDS if options.quick else SECONDS)
    options.deadline = time.monotonic() + QUICK_LIMIT_S if options.quick else float("inf")
    options.identity = identity(options.program)
    rows = results.read_rows(options.out) if options.add else []
    done = {(row["data"], row["task"], row["peer"]) for row in rows}
    jobs = [(name, task, peer) for name in names for task in tasks_of(name, options)
            for peer in peers if (name, task.name, peer) not in done]
    for at, job in enumerate(jobs):
        try:
            rows += announced(run_job(*job, options))
        except OutOfTime:
            print(f"stopped after {QUICK_LIMIT_S} s: {len(jobs) - at} of {len(jobs)} fits are left, "
                  "which --add runs", file=sys.stderr)
            break
        # Written after each job: a run that was broken off goes on by --add.
        results.write(options.out, results.with_ratios(rows), about(options.identity))
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
    parser.add_argument("--add", action="store_true",
                        help="keep the rows that --out already has, and run the others")
    parser.add_argument("--seconds", type=float, default=0,
                        help=f"most processor time of one peer on one task (default {SECONDS}, "
                             f"with --quick {QUICK_SECONDS})")
    parser.add_argument("--memory-gb", type=float, default=8.0,
                        help="most memory of one peer on one task (default 8)")
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
    except ValueError as reason:
        sys.exit(f"error: {name}: {reason}")
    wanted = options.tasks.split(",") if options.tasks else QUICK_TASKS if options.quick else None
    return [task for task in data.tasks if wanted is None or task.name in wanted]


def announced(rows):
    """The rows of a job, which it prints."""
    for row in rows:
        outcome = row.get("cannot") or row.get("named") or f"{row['standardised_error']:.4g}"
        print(f"{row['data']} {row['task']} {row['peer']}: {row['prediction']} {outcome}",
              file=sys.stderr, flush=True)
    return rows


def identity(program):
    """Version and SHA-256 (its first eight digits) of the program: builds share a version."""
    if not program:
        return "no program"
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True)
    with open(program, "rb") as file:
        return f"{version.stdout.strip()} {hashlib.file_digest(file, 'sha256').hexdigest()[:8]}"


def about(program):
    """Date, machine and versions of everything that took part."""
    return {"date": datetime.date.today().isoformat(), "machine": processor(),
            "cores": os.cpu_count(), "program": program, "python": platform.python_version(),
            "versions": versions()}


def versions():
    """Versions of this interpreter's packages, and the pins of each family of peers."""
    found = {"": {}}
    for name, _ in pins("requirements.txt"):
        try:
            found[""][name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            continue
    for path in sorted(HERE.glob("requirements-*.txt")):
        found[path.stem.removeprefix("requirements-") + "_*"] = dict(pins(path.name))
    return found


def pins(name):
    return [line.split("==") for line in (HERE / name).read_text().split()]


def processor():
    try:
        with open("/proc/cpuinfo") as file:
            names = [line.split(":")[1].strip() for line in file if line.startswith("model name")]
        return names[0]
    except (OSError, IndexError):
        return platform.machine()


if __name__ == "__main__":
    main()
