"""Figures of IMO's criteria (MSC.137(76)) of runs with their recorded rudder: advance and tactical
diameter of turns, the first two overshoot angles of zigzags."""

import numpy as np

from trials import track


def imo_error(truths, predictions):
    """Mean relative error (percent) over all figures of the runs; None where there are none."""
    errors = []
    for truth, prediction in zip(truths, predictions):
        if "delta" not in truth.channels or prediction is None:
            continue
        true, found = figures(truth, truth), figures(truth, prediction)
        errors += [abs(found.get(name, np.inf) / value - 1) for name, value in true.items()]
    return 100 * float(np.mean(np.minimum(errors, 1.0))) if errors else None


def figures(truth, run):
    """Figures by name, in metres and radians; none where the rudder steers neither manoeuvre."""
    rudder = truth["delta"]
    large = np.flatnonzero(abs(rudder) > 0.5 * abs(rudder).max())
    if abs(rudder).max() < np.radians(3) or not len(large):
        return {}
    sides = np.sign(rudder[large])
    reversals = large[1:][np.diff(sides) != 0]
    heading = (run["psi"] - run["psi"][0]) * sides[0]
    if len(reversals):
        return overshoots(heading, np.append(reversals, len(rudder)))
    return turn(truth, run, heading, large[0]) if len(large) > 0.5 * len(rudder) else {}


def overshoots(heading, reversals):
    """Headings beyond those at the first two reversals, on the side they were reached."""
    found = {}
    for k, (start, stop) in enumerate(zip(reversals[:2], reversals[1:3])):
        if stop - start > 3:
            beyond = (heading[start:stop] - heading[start]) * (-1)**k
            found[f"overshoot {k + 1}"] = max(float(beyond.max()), 1e-3)
    return found


def turn(truth, run, heading, start):
    """Advance at a change of heading of 90 deg, tactical diameter at 180 deg."""
    x, y = track(run["u"], run["v"], run["psi"] - run["psi"][0], truth.dt)
    found = {}
    for name, change, way in (("advance", np.pi / 2, x), ("tactical diameter", np.pi, y)):
        beyond = np.flatnonzero(heading > change)
        if len(beyond):
            found[name] = max(abs(float(way[beyond[0]] - way[start])), 1e-6)
    return found
