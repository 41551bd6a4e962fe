"""Errors of predictions: the metrics of the table."""

import numpy as np

from imo import imo_error
from trials import STATES, integrate

CHANNELS = (*STATES, "psi")
# Standardised error that a run counts which left the limits of motion, and the most of any run.
CAP = 10.0


def windows_of(trial, restart_s):
    """Indices of the pieces of a trial; one piece where nothing restarts."""
    step = round(restart_s / trial.dt) if restart_s else len(trial)
    starts = range(0, len(trial), step)
    return [(k, min(k + step + 1, len(trial))) for k in starts
            if min(k + step + 1, len(trial)) - k > max(5, 0.5 * step if restart_s else 5)]


def turned(truth):
    """Heading relative to the first sample."""
    return truth["psi"] - truth["psi"][0]


def channel(truth, name):
    return turned(truth) if name == "psi" else truth[name]


def score(windows, predictions, limit):
    """Metrics over all windows; `predictions` are dictionaries of u, v, r and perhaps psi."""
    truths = [window.truth for window in windows]
    spread = {name: np.concatenate([channel(t, name) for t in truths]).std() for name in CHANNELS}
    used = [name for name in CHANNELS if name != "psi" or "psi" in truths[0].measured]
    each, squares, diverged = [], {name: [] for name in CHANNELS}, 0
    for truth, prediction in zip(truths, predictions):
        if has_diverged(prediction, limit):
            diverged += 1
            each.append(CAP)
            continue
        errors = errors_of(truth, prediction)
        mean = np.mean([np.mean(errors[name]**2) / spread[name]**2 for name in used])
        each.append(min(CAP, float(np.sqrt(mean))))
        for name in CHANNELS:
            squares[name].append(errors[name]**2)
    rms = {name: float(np.sqrt(np.concatenate(s).mean())) if s else None
           for name, s in squares.items()}
    degrees = lambda value: None if value is None else float(np.degrees(value))
    return {"standardised_error": float(np.mean(each)), "heading_deg": degrees(rms["psi"]),
            "u_m_s": rms["u"], "v_m_s": rms["v"], "r_deg_s": degrees(rms["r"]),
            "runs": len(windows), "diverged": diverged / len(windows),
            "imo_percent": imo_error(truths, [headed(t, p) for t, p in zip(truths, predictions)]),
            "coverage": coverage(truths, predictions)}


def headed(truth, prediction):
    """A prediction with a heading, that of its yaw rate where it has none."""
    if prediction is None:
        return None
    return {"psi": integrate(prediction["r"], truth.dt), **prediction}


def coverage(truths, predictions):
    """Share of headings within the predicted bands of 95 %; None where none were predicted."""
    inside = [(prediction["psi_low"] <= turned(truth)) & (turned(truth) <= prediction["psi_high"])
              for truth, prediction in zip(truths, predictions)
              if prediction is not None and "psi_low" in prediction]
    return float(np.concatenate(inside).mean()) if inside else None


def has_diverged(prediction, limit):
    """Whether a prediction is missing, not finite or beyond the limits of motion."""
    if prediction is None:
        return True
    states = np.stack([prediction[name] for name in STATES], axis=1)
    return not np.all(np.isfinite(states)) or bool(np.any(np.abs(states) >= 0.999 * limit))


def errors_of(truth, prediction):
    """Errors of each channel; the heading follows from the yaw rate where none was predicted."""
    heading = prediction.get("psi", None)
    heading = integrate(prediction["r"], truth.dt) if heading is None else heading - heading[0]
    errors = {name: prediction[name] - truth[name] for name in STATES}
    return {**errors, "psi": heading - turned(truth)}
