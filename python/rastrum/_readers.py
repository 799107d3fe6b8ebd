# SPDX-License-Identifier: BSD-3-Clause
"""Files that the library does not read: by the vtk wheel, trimesh or meshio, where these are installed."""

import contextlib
import io
import os

import numpy as np

from ._errors import ArgumentError, FormatError, UnsupportedError
from ._locks import lock_in

_OURS = {".obj", ".ply", ".stl", ".off", ".gltf", ".glb", ".npy"}
# The reader of vtkmodules for what a name ends with.
_VTK = {".vtp": ("vtkIOXML", "vtkXMLPolyDataReader"), ".vtu": ("vtkIOXML", "vtkXMLUnstructuredGridReader"),
        ".vti": ("vtkIOXML", "vtkXMLImageDataReader"), ".vts": ("vtkIOXML", "vtkXMLStructuredGridReader"),
        ".vtr": ("vtkIOXML", "vtkXMLRectilinearGridReader"), ".vtk": ("vtkIOLegacy", "vtkDataSetReader"),
        ".e": ("vtkIOExodus", "vtkExodusIIReader"), ".ex2": ("vtkIOExodus", "vtkExodusIIReader"),
        ".exo": ("vtkIOExodus", "vtkExodusIIReader")}
# Endings among these that meshio reads, too.
_MESHIO = {".vtu", ".vtk", ".e", ".ex2", ".exo"}
# One file at a time has its messages caught, because sys.stdout and VTK's window are the process's. Two threads would put
# each other's back.
_locks = {}


def reads(path):
    """Whether the file is for read(): its name ends with a type, and that is none of the library's."""
    ending = os.path.splitext(path)[1].lower()
    if ending in _VTK:
        return True
    if not ending or ending in _OURS:
        return False
    return _by_trimesh(ending) or _by_meshio(ending)


def _is_there(package):
    from importlib.util import find_spec
    return find_spec(package) is not None


def _by_trimesh(ending):
    try:
        import trimesh
    except ImportError:
        return False
    return ending[1:] in trimesh.available_formats()


def _by_meshio(ending):
    if not _is_there("meshio"):
        return False
    import meshio
    return ending in meshio.extension_to_filetypes and ending != ".svg"


def read(path):
    """Reads the file by another library and returns its object: a vtkPolyData, a thing of trimesh, a meshio.Mesh.
    Raises FormatError where the library reads nothing, UnsupportedError where it is not installed."""
    ending = os.path.splitext(path)[1].lower()
    if ending in _VTK and (ending not in _MESHIO or _is_there("vtkmodules") or not _by_meshio(ending)):
        return _vtk(path, *_VTK[ending])
    if _by_meshio(ending):  # trimesh names what it would have meshio read
        return _meshio(path)
    import trimesh
    try:
        return trimesh.load(path)
    except Exception as e:  # of any kind, by reader
        raise FormatError(f"{path}: trimesh: {e}") from e


def _meshio(path):
    import meshio
    said = io.StringIO()
    try:
        # meshio prints what is wrong, and exits the interpreter.
        with lock_in(_locks), contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            return meshio.read(path)
    except ImportError as e:
        raise UnsupportedError(f"{path}: meshio needs {e.name or e} for it, which is not installed") from e
    except (Exception, SystemExit) as e:  # of any kind, by reader
        why = (" ".join(said.getvalue().split()) if isinstance(e, SystemExit) else
               f"nothing is known of {e}" if isinstance(e, KeyError) else str(e))
        raise FormatError(f"{path}: meshio: {why}") from e


def _vtk(path, module, reader):
    try:
        import importlib
        made = getattr(importlib.import_module(f"vtkmodules.{module}"), reader)()
        from vtkmodules.vtkCommonCore import vtkStringOutputWindow, vtkOutputWindow
        from vtkmodules.vtkFiltersGeometry import vtkCompositeDataGeometryFilter, vtkGeometryFilter
    except ImportError as e:
        raise UnsupportedError(f"{path}: needs the vtk wheel to be read, which is not installed (pip install rastrum[vtk])") from e
    # VTK's messages go into the exception, not to stderr.
    with lock_in(_locks):
        said, before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
        vtkOutputWindow.SetInstance(said)
        try:
            made.SetFileName(path)
            blocks = hasattr(made, "GetNumberOfTimeSteps") and hasattr(made, "SetAllArrayStatus")
            if blocks:  # Exodus: several blocks, of which all numbers are read
                made.UpdateInformation()
                for kind in (made.NODAL, made.ELEM_BLOCK):
                    made.SetAllArrayStatus(kind, 1)
            surface = vtkCompositeDataGeometryFilter() if blocks else vtkGeometryFilter()
            surface.SetInputConnection(made.GetOutputPort())
            surface.Update()
        finally:
            vtkOutputWindow.SetInstance(before)
    found = surface.GetOutput()
    if found is None or found.GetNumberOfPoints() == 0:
        words = [line for line in (said.GetOutput() or "").splitlines() if line.strip()]
        raise FormatError(f"{path}: VTK reads nothing from it" + (f": {words[0].strip()}" if words else ""))
    return found


def numbers_of(data, name):
    """(at points, at cells) of a vtkPolyData: those of that name, or without one the active ones of the points; one of
    them is None."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    of_points, of_cells = data.GetPointData(), data.GetCellData()
    if name is None:
        active = of_points.GetScalars()
        one = active is not None and active.GetNumberOfComponents() == 1
        return (vtk_to_numpy(active) if one else None), None
    for place, of in enumerate((of_points, of_cells)):
        array = of.GetArray(name)
        if array is None:
            continue
        if array.GetNumberOfComponents() != 1:
            raise ArgumentError(f"scalars: {name} has {array.GetNumberOfComponents()} numbers at each place, not one")
        return (vtk_to_numpy(array), None) if place == 0 else (None, np.asarray(vtk_to_numpy(array)))
    known = [of.GetArrayName(i) for of in (of_points, of_cells) for i in range(of.GetNumberOfArrays())]
    raise ArgumentError(f"scalars: there is no {name!r}; there are {', '.join(map(str, known)) or 'none'}")
