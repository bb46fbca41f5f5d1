"""Reads the shapes of a run with VTK itself and compares them with the columns of its trajectory.

    pip install vtk numpy
    python read_vtk.py RESULTS

RESULTS is the directory of a run with `[output] vtk = true`. Every frame named in beam.pvd must be read
without an error, consist of valid quadrilaterals, and at the tip and at each recorded station its point data
must be the recorded deflection, axial displacement and rotation of that time. Exits with 1 if not.
"""

import sys
import xml.etree.ElementTree as tree
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkFiltersVerdict import vtkMeshQuality
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

TOLERANCE = 1e-12  # relative to the length of the beam, or in radians


def read(path):
    errors = []
    reader = vtkXMLUnstructuredGridReader()
    reader.AddObserver(vtkCommand.ErrorEvent, lambda *_: errors.append(path))
    reader.SetFileName(str(path))
    reader.Update()
    if errors:
        sys.exit(f"VTK cannot read {path}")
    return reader.GetOutput()


def main(results):
    trajectory = np.load(results / "trajectory.npz")
    time = trajectory["time"]
    names = [name.removesuffix(".deflection") for name in trajectory.files if name.endswith(".deflection")]
    sets = tree.parse(results / "beam.pvd").getroot().findall("Collection/DataSet")
    worst, compared, cells = 0.0, 0, 0
    for data_set in sets:
        grid = read(results / data_set.get("file"))
        t = float(data_set.get("timestep"))
        row = int(np.argmin(abs(time - t)))
        field = vtk_to_numpy(grid.GetFieldData().GetArray("TimeValue"))[0]
        if time[row] != t or field != t:
            sys.exit(f"{data_set.get('file')}: time {t} s is not a recorded one")
        data = {grid.GetPointData().GetArrayName(i): vtk_to_numpy(grid.GetPointData().GetArray(i))
                for i in range(grid.GetPointData().GetNumberOfArrays())}
        points = vtk_to_numpy(grid.GetPoints().GetData())
        quality = vtkMeshQuality()
        quality.SetInputData(grid)
        quality.SetQuadQualityMeasureToArea()
        quality.Update()
        area = vtk_to_numpy(quality.GetOutput().GetCellData().GetArray("Quality"))
        if not (area > 0).all():
            sys.exit(f"{data_set.get('file')}: {np.sum(area <= 0)} quadrilaterals without area")
        cells += grid.GetNumberOfCells()
        axis = slice(1, None, 3)  # lower fibre, axis, upper fibre
        x = data["arc_length"][axis]
        angle = trajectory["hub.angle"][row]
        along, across = np.array([np.cos(angle), np.sin(angle), 0]), np.array([-np.sin(angle), np.cos(angle), 0])
        radius = points[axis][0] @ along
        for name in names:
            at = x[-1] if name == "tip" else float(name.removeprefix("x="))
            i = int(np.argmin(abs(x - at)))
            if abs(x[i] - at) > 1e-9 * x[-1]:
                sys.exit(f"no section at {name}")
            expected = {key: trajectory[f"{name}.{key}"][row] for key in ("deflection", "axial", "rotation")}
            for key, value in expected.items():
                scale = 1.0 if key == "rotation" else x[-1]
                worst = max(worst, abs(data[key][axis][i] - value) / scale)
            # The position itself, not only what is written beside it.
            position = (radius + x[i] + expected["axial"]) * along + expected["deflection"] * across
            worst = max(worst, np.abs(points[axis][i] - position).max() / x[-1])
            moved = expected["axial"] * along + expected["deflection"] * across
            worst = max(worst, np.abs(data["displacement"][axis][i] - moved).max() / x[-1])
            compared += 1
    print(f"{len(sets)} frames, {cells} cells, {compared} sections compared; largest difference {worst:.1e}")
    if not sets or worst > TOLERANCE:
        sys.exit(f"the shapes differ from the trajectory by more than {TOLERANCE:.0e}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
