"""Steps rigidtap's control FMU against a plant FMU with FMPy, the control first in each period, and writes e(k).

    together.py CONTROL.fmu PLANT.fmu OUT.csv
"""

import shutil
import sys

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave


class Model:
    """One FMU with its variables by name."""

    def __init__(self, path):
        self.folder = extract(path)
        description = read_model_description(path)
        self.step_s = float(description.defaultExperiment.stepSize)
        self.variables = {variable.name: variable for variable in description.modelVariables}
        self.fmu = FMU2Slave(
            guid=description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=description.modelName,
        )
        self.fmu.instantiate()
        self.fmu.setupExperiment(startTime=0.0)

    def names(self, causality):
        return {name for name, variable in self.variables.items() if variable.causality == causality}

    def begin(self):
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def lists(self, names):
        """Numbers of the real variables and of the switches."""
        names = sorted(names)
        of = lambda kind: [self.variables[name].valueReference for name in names if self.variables[name].type == kind]
        return of("Real"), of("Boolean")

    def get(self, lists):
        reals, switches = lists
        return self.fmu.getReal(reals), self.fmu.getBoolean(switches)

    def set(self, lists, values):
        self.fmu.setReal(lists[0], values[0])
        self.fmu.setBoolean(lists[1], values[1])

    def end(self):
        self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)


def main(control_path, plant_path, out_path):
    control, plant = Model(control_path), Model(plant_path)
    if "z_start_mm" in plant.variables:
        # Programs start 100 mm up.
        plant.fmu.setReal([plant.variables["z_start_mm"].valueReference], [100.0])
    control.begin()
    plant.begin()
    setpoints = control.names("output") & plant.names("input")
    feedback = plant.names("output") & control.names("input")
    from_control, to_plant = control.lists(setpoints), plant.lists(setpoints)
    from_plant, to_control = plant.lists(feedback), control.lists(feedback)
    error = [control.variables["error_um"].valueReference]
    flags = [control.variables[name].valueReference for name in ("synchronous", "done")]
    alarm = [control.variables["alarm"].valueReference]
    k, step_s = 0, control.step_s
    with open(out_path, "w") as out:
        out.write("k,error_um\n")
        while True:
            control.set(to_control, plant.get(from_plant))
            control.fmu.doStep(k * step_s, step_s)
            synchronous, done = control.fmu.getBoolean(flags)
            if done:
                break
            if synchronous:
                out.write(f"{k},{control.fmu.getReal(error)[0]!r}\n")
            plant.set(to_plant, control.get(from_control))
            plant.fmu.doStep(k * step_s, step_s)
            k += 1
    code = int(control.fmu.getReal(alarm)[0])
    control.end()
    plant.end()
    print(f"{k} periods" + (f", ended by alarm A{code}" if code else ""))


main(*sys.argv[1:])
