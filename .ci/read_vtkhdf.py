"""Reads beam.vtkhdf with VTK itself and compares it with the frames of beam.pvd.

    pip install vtk numpy
    python read_vtkhdf.py RESULTS

RESULTS is the directory of a run with `[output] vtk = true` by a program built with the feature `vtkhdf`. At every
time the grid must have the points, the cells and the point data of the frame (.vtu), bit for bit. Exits with 1 if
not.
"""

import sys
import xml.etree.ElementTree as tree
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

ARRAYS = {"displacement", "deflection", "axial", "rotation", "arc_length"}


def watched(reader, path):
    errors = []
    for event in (vtkCommand.ErrorEvent, vtkCommand.WarningEvent):
        reader.AddObserver(event, lambda *_: errors.append(path))
    reader.SetFileName(str(path))
    return errors


def contents(grid):
    if grid.IsA("vtkPartitionedDataSet"):
        if grid.GetNumberOfPartitions() != 1:
            sys.exit(f"{grid.GetNumberOfPartitions()} parts")
        grid = grid.GetPartition(0)
    data = grid.GetPointData()
    found = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    if not ARRAYS <= found.keys():
        sys.exit(f"point data are {sorted(found)}")
    cells = grid.GetCells()
    found = {name: found[name] for name in ARRAYS}
    found["points"] = vtk_to_numpy(grid.GetPoints().GetData())
    found["connectivity"] = vtk_to_numpy(cells.GetConnectivityArray())
    found["offsets"] = vtk_to_numpy(cells.GetOffsetsArray())
    found["types"] = np.array([grid.GetCellType(i) for i in range(grid.GetNumberOfCells())])
    return found


def main(results):
    path = results / "beam.vtkhdf"
    reader = vtkHDFReader()
    errors = watched(reader, path)
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(Pipeline.TIME_STEPS()) or ()
    sets = tree.parse(results / "beam.pvd").getroot().findall("Collection/DataSet")
    if list(times) != [float(data_set.get("timestep")) for data_set in sets]:
        sys.exit(f"times are {times}")
    values = 0
    # Not in order, as when a user moves the time slider.
    for step in sorted(range(len(sets)), key=lambda i: (i % 3, i)):
        reader.UpdateTimeStep(times[step])
        frame = vtkXMLUnstructuredGridReader()
        frame_errors = watched(frame, results / sets[step].get("file"))
        frame.Update()
        if errors or frame_errors:
            sys.exit(f"VTK cannot read {(errors + frame_errors)[0]} at {times[step]} s")
        ours, theirs = contents(reader.GetOutputDataObject(0)), contents(frame.GetOutput())
        for name, expected in theirs.items():
            if ours[name].shape != expected.shape or not np.array_equal(ours[name], expected):
                sys.exit(f"{name} differs from {sets[step].get('file')}")
            values += expected.size
    print(f"beam.vtkhdf: {len(sets)} times, {values} values, all those of the frames")
    if not sets:
        sys.exit("no time")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
