#!/usr/bin/python3
"""Reads a .pvd index or a .vtu file of Udar with VTK and prints what it holds as JSON.

usage: read_back.py FILE

For each file: time, counts, range of every array, smallest triangle area. Exit status 1 where VTK cannot read a file,
a bodies file holds anything but triangles of positive area, or an array holds a number that is none.
"""

import json
import math
import os
import sys
import xml.etree.ElementTree

from vtkmodules.vtkCommonDataModel import VTK_TRIANGLE
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def flat(array):
    """All numbers of a VTK array as one Python sequence, without a copy."""
    return memoryview(array).cast("B").cast(memoryview(array).format) if array.GetNumberOfValues() else []


def array_ranges(data):
    ranges = {}
    for i in range(data.GetNumberOfArrays()):
        array = data.GetArray(i)
        values = flat(array)
        limits = [min(values), max(values)] if values else None
        if not math.isfinite(sum(values)):
            limits = [math.nan, math.nan]
        ranges[array.GetName()] = {"components": array.GetNumberOfComponents(), "range": limits}
    return ranges


def smallest_area(grid):
    """Of all triangles in the plane; negative where corners run clockwise."""
    if grid.GetNumberOfCells() == 0:
        return None
    places = flat(grid.GetPoints().GetData())
    points = list(zip(places[0::3], places[1::3]))
    corners = flat(grid.GetCells().GetConnectivityArray())
    smallest = math.inf
    for a, b, c in zip(corners[0::3], corners[1::3], corners[2::3]):
        (ax, ay), (bx, by), (cx, cy) = points[a], points[b], points[c]
        smallest = min(smallest, ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2)
    return smallest


def read(path, part):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    failures = []
    reader.AddObserver("ErrorEvent", lambda *_: failures.append("VTK reports an error"))
    reader.Update()
    grid = reader.GetOutput()
    out = {"file": path, "part": part, "points": grid.GetNumberOfPoints(), "cells": grid.GetNumberOfCells()}
    time = grid.GetFieldData().GetArray("TimeValue")
    out["time"] = time.GetValue(0) if time else None
    out["point_data"] = array_ranges(grid.GetPointData())
    out["cell_data"] = array_ranges(grid.GetCellData())
    if part == 0:
        kinds = {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())}
        if kinds - {VTK_TRIANGLE}:
            failures.append("not all cells are triangles")
        else:
            out["smallest_area"] = smallest_area(grid)
            if out["smallest_area"] is not None and not out["smallest_area"] > 0:
                failures.append("a triangle has no positive area")
    for name, array in {**out["point_data"], **out["cell_data"]}.items():
        if array["range"] and not all(math.isfinite(limit) for limit in array["range"]):
            array["range"] = None  # not JSON
            failures.append(f"{name} is not finite")
    if time is None:
        failures.append("no time")
    out["failures"] = failures
    return out


def files_of(path):
    """(file, part, time) of each entry of an index; one entry for a single frame."""
    if not path.endswith(".pvd"):
        return [(path, 1 if os.path.basename(path).startswith("obstacles") else 0, None)]
    folder = os.path.dirname(path)
    entries = xml.etree.ElementTree.parse(path).getroot().iter("DataSet")
    return [(os.path.join(folder, e.get("file")), int(e.get("part")), float(e.get("timestep"))) for e in entries]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    frames = []
    for file, part, time in files_of(sys.argv[1]):
        frame = read(file, part)
        if time is not None and frame["time"] != time:
            frame["failures"].append(f"the index says time {time}")
        frames.append(frame)
    failed = any(frame["failures"] for frame in frames)
    json.dump({"frames": frames, "good": not failed and bool(frames)}, sys.stdout, indent=1)
    print()
    sys.exit(1 if failed or not frames else 0)


if __name__ == "__main__":
    main()
