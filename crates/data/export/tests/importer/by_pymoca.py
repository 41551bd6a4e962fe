"""Reads a Modelica export by pymoca and sails it under a rudder order as CSV.

FOLDER MODEL RUDDER_DEG DURATION_S STEP_S; the folder holds MODEL.mo. pymoca 0.12 does not know
`noEvent`, which stands for nothing here, nor `atan2`.
"""

import math
import pathlib
import re
import sys

import casadi
import numpy
from pymoca.backends.casadi import generator
from pymoca.backends.casadi.api import transfer_model

casadi.MX.__div__ = lambda a, b: a / b
casadi.MX.arctan2 = lambda a, b: casadi.atan2(a, b)
generator.OP_MAP["atan2"] = "arctan2"
STATES = ["u", "v", "r", "p", "phi", "psi", "x", "y", "delta"]

folder, name = pathlib.Path(sys.argv[1]), sys.argv[2]
rudder_deg, duration_s, step_s = map(float, sys.argv[3:])
text = (folder / f"{name}.mo").read_text().replace("noEvent(", "(")
plain = folder / "plain"
plain.mkdir(exist_ok=True)
(plain / f"{name}.mo").write_text(text)
options = {"replace_constant_values": True, "replace_parameter_values": True}
model = transfer_model(str(plain), name, options)


def symbols(variables):
    return casadi.vertcat(*[variable.symbol for variable in variables])


def starts(variables):
    return [float(casadi.evalf(casadi.MX(variable.start))) for variable in variables]


unknown = [v.symbol.name() for v in model.der_states + model.alg_states]
states = [v.symbol.name() for v in model.states]
given = numpy.array(starts(model.inputs))
given[[v.symbol.name() for v in model.inputs].index("delta_order")] = math.radians(rudder_deg)
residual = casadi.Function(
    "residual",
    [symbols(model.der_states + model.alg_states), symbols(model.states + model.inputs)],
    [casadi.vertcat(*model.equations)],
)
# Each equation gives one unknown, in an order in which it needs only earlier ones.
equations = text.split("\nequation\n")[1]
gives = re.findall(r"^  (t\d+|der\(\w+\)) = ", equations, re.M)
places = [unknown.index(name) for name in gives]
assert len(places) == len(unknown) == len(model.equations)
solution = numpy.full(len(unknown), 0.1)


def rates(state):
    for _ in range(len(unknown) + 1):
        left = numpy.array(residual(solution, numpy.concatenate([state, given]))).ravel()
        solution[places] -= left
        if not left.any():
            return solution[: len(states)].copy()
    raise ArithmeticError("the equations are not solved")


state = numpy.array(starts(model.states))
print("t")
for step in range(round(duration_s / step_s) + 1):
    values = [step * step_s] + [state[states.index(name)] for name in STATES]
    print(",".join(repr(float(value)) for value in values))
    k1 = rates(state)
    k2 = rates(state + 0.5 * step_s * k1)
    k3 = rates(state + 0.5 * step_s * k2)
    k4 = rates(state + step_s * k3)
    state = state + step_s / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
