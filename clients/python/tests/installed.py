"""The client as people get it: a wheel in an environment that holds nothing else runs the README's
lines, and with the extras the tour. Run in a folder with `my-ship.yaml` and `zigzag.csv` against
the server that `SISTERSHIP_URL` names:

    python installed.py lines | tour

`python installed.py ready`, which needs neither, says why the tour would be left out.

The tour's packages (70 MB) come from an index only where `SISTERSHIP_REQUIRE_PIP=1` asks for it;
without it, what is not there is told and left out."""

import ast
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent.parent
REQUIRED = os.environ.get("SISTERSHIP_REQUIRE_PIP") == "1"
PIP = [sys.executable, "-m", "pip"]
INDEX = [*PIP, "download", "-q", "--no-deps", "--retries", "0", "--timeout", "5"]
# What setuptools needs for a wheel without an index: itself, and before its version 70.1 `wheel`.
BUILDS = ("import setuptools, importlib.util as u; "
          "assert u.find_spec('setuptools.command.bdist_wheel') or u.find_spec('wheel')")
TOUR = ["pandas", "matplotlib", "nbclient", "ipykernel"]
HELD = "import importlib.metadata as m; print(*(d.metadata['Name'] for d in m.distributions()))"
# What `pip --python` needs.
SINCE = "import pip; assert tuple(map(int, pip.__version__.split('.')[:2])) >= (22, 3)"
TAIL = "\nprint(track['t_s'][-1], track['psi_rad'][-1])\n" \
       "import sistership_client; print(sistership_client.__file__)\n"


class Skipped(Exception):
    """Something is not installed; its message says what to do."""


def runs(command):
    return subprocess.run(command, capture_output=True).returncode == 0


def run(command, **how):
    """What a command prints; its errors are shown where it fails."""
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, text=True, **how)
    if done.returncode:
        sys.exit(f"{' '.join(str(part) for part in command)}\n{done.stdout}")
    return done.stdout


def need(there, what):
    if not there:
        raise Skipped(what)


def wheel(folder):
    """A wheel of the client, from a copy: building leaves files beside the sources."""
    copy = shutil.copytree(HERE, folder / "client",
                           ignore=shutil.ignore_patterns("build", "*.egg-info", "__pycache__"))
    offline = runs([sys.executable, "-c", BUILDS])
    need(offline or REQUIRED or runs([*INDEX, "-d", str(folder), "setuptools>=68"]),
         "no package index is reachable, and without one a wheel needs setuptools and wheel here "
         "(Debian: apt-get install python3-setuptools python3-wheel)")
    further = ["--no-index", "--no-build-isolation"] if offline else []
    run([*PIP, "wheel", "-q", "--no-deps", *further, "-w", folder, copy])
    found = list(folder.glob("sistership_client-*-py3-none-any.whl"))
    assert len(found) == 1, found
    return found[0]


def environment(folder):
    """An empty environment, without even pip: the one outside installs into it."""
    run([sys.executable, "-m", "venv", "--without-pip", folder])
    return folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


def lines(folder):
    """The README's lines, by the wheel alone."""
    python = environment(folder / "alone")
    run([*PIP, "--python", python, "install", "-q", "--no-index", wheel(folder)])
    held = run([python, "-I", "-c", HELD]).split()
    assert held == ["sistership-client"], held
    block = re.search(r"```python\n(.*?)```", (HERE / "README.md").read_text(), re.DOTALL).group(1)
    local = "http://127.0.0.1:8080"
    assert block.count(local) == 1 and len(block.splitlines()) == 6, block
    code = block.replace(local, os.environ["SISTERSHIP_URL"]) + TAIL
    held_out, last, where = run([python, "-I", "-c", code]).splitlines()
    held_out = ast.literal_eval(held_out)
    assert held_out["refined"].keys() == held_out["source"].keys() >= {"u", "r", "psi"}, held_out
    duration_s, heading_rad = map(float, last.split())
    assert duration_s == 600.0 and heading_rad > 3.2, last
    assert pathlib.Path(where).is_relative_to(folder / "alone"), where
    print(f"the README's lines: refined r {held_out['refined']['r']:.2g} rad/s, "
          f"turned {heading_rad:.2f} rad in {duration_s:g} s")


def ready(_):
    """Whether the notebook's packages are here, or may be taken from an index."""
    need(REQUIRED or all(map(importlib.util.find_spec, TOUR)),
         f"the tour needs {', '.join(TOUR)}; SISTERSHIP_REQUIRE_PIP=1 takes them from an index")


def tour(folder):
    """The notebook, with packages from an index, or with those of this interpreter."""
    ready(folder)
    if REQUIRED:
        python, path = environment(folder / "tour"), ""
        run([*PIP, "--python", python, "install", "-q", "--no-compile",
             f"{wheel(folder)}[frames,plots]", *TOUR[2:]])
    else:
        python, path = sys.executable, str(folder / "tour")
        run([*PIP, "install", "-q", "--no-deps", "--no-index", "--target", path, wheel(folder)])
    print(run([python, HERE / "tests" / "execute.py", pathlib.Path.cwd() / "tour.ipynb"],
              env={**os.environ, "PYTHONPATH": path}))


def main():
    try:
        need(runs([sys.executable, "-c", SINCE]),
             "python3 has no pip of version 22.3 or later (Debian: apt-get install python3-pip)")
        with tempfile.TemporaryDirectory() as folder:
            asked = {"lines": lines, "tour": tour, "ready": ready}[sys.argv[1]]
            asked(pathlib.Path(folder).resolve())
    except Skipped as reason:
        if REQUIRED:
            sys.exit(f"SISTERSHIP_REQUIRE_PIP is set, and {reason}")
        print(f"skipped: {reason}")


if __name__ == "__main__":
    main()
