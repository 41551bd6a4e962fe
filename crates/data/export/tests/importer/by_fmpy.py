"""Validates an FMU by FMPy and sails it under a rudder order: FILE RUDDER_DEG DURATION_S STEP_S."""

import contextlib
import math
import sys

import numpy
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu

STATES = ["u", "v", "r", "p", "phi", "psi", "x", "y", "delta"]

file, rudder_deg, duration_s, step_s = sys.argv[1], *map(float, sys.argv[2:])
problems = validate_fmu(file)
for problem in problems:
    print(problem, file=sys.stderr)
if problems:
    sys.exit(2)
known = {v.name for v in read_model_description(file, validate=True).modelVariables}
states = [name for name in STATES if name in known]
order = numpy.array([(0.0, math.radians(rudder_deg))], dtype=[("time", "f8"), ("delta_order", "f8")])
# FMPy says on standard output which inputs are left at their starts.
with contextlib.redirect_stdout(sys.stderr):
    result = simulate_fmu(file, stop_time=duration_s, step_size=step_s, output_interval=step_s,
                          fmi_type="CoSimulation", input=order, output=states)
print("t")
for row in result:
    values = [row["time"]] + [row[name] if name in states else 0.0 for name in STATES]
    print(",".join(repr(float(value)) for value in values))
