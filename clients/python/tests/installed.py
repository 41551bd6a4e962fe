"""The package as people get it: in an environment that holds nothing else it runs the README's
lines, and with the extras the tour. Run in a folder with `my-ship.yaml` and `zigzag.csv`:

    python installed.py served | local | tour

`served` and `tour` need the server that `SISTERSHIP_URL` names, `local` and `tour` the program.
`SISTERSHIP_WHEEL` names the wheel to install; without it the sources are copied, and the program is
that of `SISTERSHIP_PROGRAM`. `python installed.py ready`, which needs neither, says why the tour
would be left out.

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
WHEEL = os.environ.get("SISTERSHIP_WHEEL")
PIP = [sys.executable, "-m", "pip"]
EXTRAS = ["pandas>=1.5", "matplotlib>=3.6"]
TOUR = ["pandas", "matplotlib", "nbclient", "ipykernel"]
# What `pip --python` needs.
SINCE = "import pip; assert tuple(map(int, pip.__version__.split('.')[:2])) >= (22, 3)"
SITE = "import sysconfig; print(sysconfig.get_path('purelib'))"
WHERE = "\nimport sistership; print(sistership.__file__)\n"
SERVED = "\nprint(track['t_s'][-1], track['psi_rad'][-1])" + WHERE
LOCAL = "\nprint(track['t_s'][-1], track['psi_rad'][-1])\n" \
        "print(report.held_out['source']['r'], len(report._repr_html_()) > 10000)" + WHERE


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


def need_pip():
    need(runs([sys.executable, "-c", SINCE]),
         "python3 has no pip of version 22.3 or later (Debian: apt-get install python3-pip)")


def environment(folder):
    """An environment that holds the package alone, without even pip."""
    run([sys.executable, "-m", "venv", "--without-pip", folder])
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    if WHEEL:
        need_pip()
        run([*PIP, "--python", python, "install", "-q", "--no-index", WHEEL])
    else:
        site = pathlib.Path(run([python, "-I", "-c", SITE]).strip())
        shutil.copytree(HERE / "src" / "sistership", site / "sistership",
                        ignore=shutil.ignore_patterns("__pycache__"))
    return python


def block(number):
    """A block of Python in the README."""
    return re.findall(r"```python\n(.*?)```", (HERE / "README.md").read_text(), re.DOTALL)[number]


def check_track(line, where, folder):
    """The ship has turned, by the installed package."""
    duration_s, heading_rad = map(float, line.split())
    assert duration_s == 600.0 and heading_rad > 3.2, line
    assert pathlib.Path(where).is_relative_to(folder / "alone"), where
    return f"turned {heading_rad:.2f} rad in {duration_s:g} s"


def local(folder):
    """The README's lines without a server."""
    code = block(0)
    assert len(code.splitlines()) == 5, code
    python = environment(folder / "alone")
    refined, line, report, where = run([python, "-I", "-c", code + LOCAL]).splitlines()
    source, shown = report.split()
    assert float(refined) <= float(source) and shown == "True", (refined, report)
    assert pathlib.Path("my-ship.fmu").read_bytes()[:2] == b"PK"
    version = run([python, "-I", "-m", "sistership", "--version"])
    assert re.fullmatch(r"sistership \d+\.\d+\.\d+", version.strip()), version
    print(f"without a server: refined r {float(refined):.2g} rad/s, "
          f"{check_track(line, where, folder)}")


def served(folder):
    """The README's lines with a server."""
    code = block(1)
    address = "http://127.0.0.1:8080"
    assert code.count(address) == 1 and len(code.splitlines()) == 6, code
    python = environment(folder / "alone")
    code = code.replace(address, os.environ["SISTERSHIP_URL"]) + SERVED
    held_out, line, where = run([python, "-I", "-c", code]).splitlines()
    held_out = ast.literal_eval(held_out)
    assert held_out["refined"].keys() == held_out["source"].keys() >= {"u", "r", "psi"}, held_out
    print(f"with a server: refined r {held_out['refined']['r']:.2g} rad/s, "
          f"{check_track(line, where, folder)}")


def ready(_):
    """Whether the notebook's packages are here, or may be taken from an index."""
    need(REQUIRED or all(map(importlib.util.find_spec, TOUR)),
         f"the tour needs {', '.join(TOUR)}; SISTERSHIP_REQUIRE_PIP=1 takes them from an index")


def tour(folder):
    """The notebook, with packages from an index, or with those of this interpreter."""
    ready(folder)
    python, path = sys.executable, str(HERE / "src")
    if REQUIRED:
        need_pip()
        python, path = environment(folder / "tour"), ""
        run([*PIP, "--python", python, "install", "-q", "--no-compile", *EXTRAS, *TOUR[2:]])
    print(run([python, HERE / "tests" / "execute.py", pathlib.Path.cwd() / "tour.ipynb"],
              env={**os.environ, "PYTHONPATH": path}))


def main():
    try:
        with tempfile.TemporaryDirectory() as folder:
            asked = {"local": local, "served": served, "tour": tour, "ready": ready}[sys.argv[1]]
            asked(pathlib.Path(folder).resolve())
    except Skipped as reason:
        if REQUIRED:
            sys.exit(f"SISTERSHIP_REQUIRE_PIP is set, and {reason}")
        print(f"skipped: {reason}")


if __name__ == "__main__":
    main()
