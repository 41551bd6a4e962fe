"""Varies the values of a package of SSP and sails it: TOOL FILE RUDDER_DEG DURATION_S STEP_S [NAME=VALUE]...

TOOL is `fmpy`, which checks the package by the schemas of the standard, or `osp`, the Open
Simulation Platform's libcosim.
"""

import contextlib
import math
import pathlib
import shutil
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
import zipfile

STATES = ["u", "v", "r", "p", "phi", "psi", "x", "y", "delta"]
SSV = "{http://ssp-standard.org/SSP1/SystemStructureParameterValues}"
VALUES = "resources/parameters.ssv"


def varied(folder, values):
    """Changes values of an unpacked package, and packs it again."""
    tree = ElementTree.parse(folder / VALUES)
    known = {one.get("name"): one.find(f"{SSV}Real") for one in tree.iter(f"{SSV}Parameter")}
    for name, value in values.items():
        known[name].set("value", repr(value))
    # libcosim knows the prefixes of the standard's examples only.
    ElementTree.register_namespace("ssv", SSV[1:-1])
    ElementTree.register_namespace("ssc", SSV[1:-1].replace("ParameterValues", "Common"))
    tree.write(folder / VALUES, encoding="UTF-8", xml_declaration=True)
    return shutil.make_archive(str(folder), "zip", folder)


def by_fmpy(file, duration_s, step_s):
    from fmpy import read_model_description, simulate_fmu
    from fmpy.ssp.ssd import read_ssd, read_ssv

    component = read_ssd(file).system.elements[0]
    values = {one.name: float(one.value) for one in read_ssv(file, VALUES).parameters}
    with tempfile.TemporaryDirectory() as folder:
        unit = zipfile.ZipFile(file).extract(component.source, folder)
        known = {one.name for one in read_model_description(unit).modelVariables}
        kinds = {one.name: one.kind for one in component.connectors}
        if not (set(kinds) <= known and set(values) <= set(kinds)):
            sys.exit("the package names variables that its FMU lacks")
        states = [name for name in STATES if name in known]
        result = simulate_fmu(unit, stop_time=duration_s, step_size=step_s, output_interval=step_s,
                              fmi_type="CoSimulation", start_values=values, output=states)
    for row in result:
        yield [row["time"]] + [row[name] if name in states else 0.0 for name in STATES]


def by_osp(file, duration_s, step_s):
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver

    log_output_level(CosimLogLevel.ERROR)
    execution = CosimExecution.from_ssp_file(file)
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    ship = execution.slave_index_from_instance_name("ship")
    variables = {one.name.decode(): one.reference for one in execution.slave_variables(ship)}
    states = [name for name in STATES if name in variables]
    # An observer has values after the first step only.
    yield [0.0] + [starts(file).get(name, 0.0) for name in STATES]
    for k in range(round(duration_s / step_s)):
        execution.step()
        values = observer.last_real_values(ship, [variables[name] for name in states])
        row = dict(zip(states, values))
        yield [(k + 1) * step_s] + [row.get(name, 0.0) for name in STATES]


def starts(file):
    """Start values of the variables of the FMU of a package."""
    package = zipfile.ZipFile(file)
    unit = next(name for name in package.namelist() if name.endswith(".fmu"))
    with zipfile.ZipFile(package.open(unit)) as archive:
        variables = ElementTree.parse(archive.open("modelDescription.xml")).iter("ScalarVariable")
        reals = {one.get("name"): one.find("Real").get("start") for one in variables}
    return {name: float(start) for name, start in reals.items() if start}


def main():
    tool, file = sys.argv[1:3]
    rudder_deg, duration_s, step_s = map(float, sys.argv[3:6])
    values = {name: float(value) for name, value in (one.split("=") for one in sys.argv[6:])}
    values["delta_order"] = math.radians(rudder_deg)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch, "package")
        zipfile.ZipFile(file).extractall(folder)
        package = shutil.move(varied(folder, values), folder.with_suffix(".ssp"))
        with contextlib.redirect_stdout(sys.stderr):
            run = {"fmpy": by_fmpy, "osp": by_osp}[tool]
            rows = list(run(str(package), duration_s, step_s))
    print("t")
    for row in rows:
        print(",".join(repr(float(value)) for value in row))


main()
