#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Converts the scientific files of ../shared/data for tools/showcase.py: to PLY files with numbers.

usage: showcase_data.py DATA OUT

Molecules are read here. VTK's files need its Python package (Debian: python3-vtk9), else they are left out. Prints the
names of the written files.
"""
import array
import math
import pathlib
import sys

ELEMENTS = {"H": 1, "C": 6, "N": 7, "O": 8, "P": 15, "S": 16}


def write_ply(file, points, scalars, triangles=(), face_scalars=()):
    """`points`, `triangles`: three numbers each. `scalars`, `face_scalars`: (name, PLY type, values)."""
    kinds = {"float": "f", "double": "d", "uchar": "B", "int": "i"}
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    lines += [f"property float {axis}" for axis in "xyz"] + [f"property {kind} {name}" for name, kind, _ in scalars]
    if triangles:
        lines += [f"element face {len(triangles)}", "property list uchar int vertex_indices"]
        lines += [f"property {kind} {name}" for name, kind, _ in face_scalars]
    body = bytearray()
    for i, point in enumerate(points):
        body += array.array("f", point).tobytes()
        for _, kind, values in scalars:
            body += array.array(kinds[kind], [values[i]]).tobytes()
    for i, corners in enumerate(triangles):
        body += b"\3" + array.array("i", corners).tobytes()
        for _, kind, values in face_scalars:
            body += array.array(kinds[kind], [values[i]]).tobytes()
    file.write_bytes("\n".join([*lines, "end_header", ""]).encode() + bytes(body))


def molecule(pdb, file):
    """Writes the first model's atoms with their element, chain and temperature factor."""
    points, element, chain, factor = [], [], [], []
    for line in pdb.read_text(encoding="ascii", errors="replace").splitlines():
        if line.startswith("ENDMDL"):
            break
        if line.startswith("ATOM"):
            points.append([float(line[i:i + 8]) for i in (30, 38, 46)])
            name = line[76:78].strip() or line[12:16].strip()[:1]
            element.append(ELEMENTS.get(name, 0))
            chain.append(ord(line[21]))
            factor.append(float(line[60:66]))
    write_ply(file, points, [("element", "uchar", element), ("chain", "uchar", chain), ("bfactor", "float", factor)])


def balls(file):
    """Writes two rows of three balls as OBJ and MTL: metal above, varnished below, rougher to the right."""
    materials, lines, rows, columns = [], [f"mtllib {file.stem}.mtl"], 48, 96
    for k in range(6):
        metal, rough = k < 3, k % 3 * 0.3 + 0.06
        materials += [f"newmtl m{k}", f"Kd {'0.95 0.78 0.5' if metal else '0.6 0.06 0.05'}", f"Pm {int(metal)}", f"Pr {rough:g}"]
        lines.append(f"usemtl m{k}")
        for j in range(rows + 1):
            for i in range(columns + 1):
                down, across = math.pi * j / rows, 2 * math.pi * i / columns
                x, y, z = math.sin(down) * math.sin(across), math.cos(down), math.sin(down) * math.cos(across)
                lines += [f"v {x + k % 3 * 2.3:.6f} {y - k // 3 * 2.3:.6f} {z:.6f}", f"vn {x:.6f} {y:.6f} {z:.6f}"]
        for j in range(rows):
            for i in range(columns):
                a = k * (rows + 1) * (columns + 1) + j * (columns + 1) + i + 1
                lines.append("f " + " ".join(f"{c}//{c}" for c in (a, a + columns + 1, a + columns + 2, a + 1)))
    file.write_text("\n".join([*lines, ""]))
    file.with_suffix(".mtl").write_text("\n".join([*materials, ""]))


class OfVtk:
    def __init__(self, data, out):
        import vtk

        self.vtk, self.data, self.out = vtk, data, out

    def read(self, reader, file):
        reader.SetFileName(str(self.data / "sci" / file))
        reader.Update()
        return reader.GetOutput()

    def then(self, step, data, **settings):
        step.SetInputData(data)
        for name, value in settings.items():
            getattr(step, name)(*value)
        step.Update()
        return step.GetOutput()

    def write(self, name, mesh, point_arrays, face_arrays=()):
        """Arrays: (VTK's name, the file's name, type); a vector's length is written."""
        mesh = self.then(self.vtk.vtkTriangleFilter(), mesh, PassVertsOff=(), PassLinesOff=())

        def values(arrays, of, count):
            found = []
            for there, named, kind in arrays:
                a = of.GetArray(there)
                length = [sum(v * v for v in a.GetTuple(i)) ** 0.5 if a.GetNumberOfComponents() > 1
                          else a.GetTuple1(i) for i in range(count)]
                found.append((named, kind, [int(v) for v in length] if kind in ("int", "uchar") else length))
            return found

        points, cells = mesh.GetNumberOfPoints(), mesh.GetNumberOfCells()
        triangles = [[mesh.GetCell(i).GetPointId(k) for k in range(3)] for i in range(cells)]
        write_ply(self.out / name, [mesh.GetPoint(i) for i in range(points)],
                  values(point_arrays, mesh.GetPointData(), points), triangles,
                  values(face_arrays, mesh.GetCellData(), cells))

    def make(self):
        vtk = self.vtk
        grid = self.read(vtk.vtkDataSetReader(), "notch_stress.vtk")
        surface = self.then(vtk.vtkDataSetSurfaceFilter(), grid, SetNonlinearSubdivisionLevel=(1,))
        self.write("notch.ply", surface, [("Nodal Stress-normed", "stress", "double")])
        grid = self.read(vtk.vtkXMLUnstructuredGridReader(), "can.vtu")
        # As in the file: the mesh before it moved, with its displacement and speed.
        self.write("can.ply", self.then(vtk.vtkDataSetSurfaceFilter(), grid), [("DISPL", "displacement", "double"), ("VEL", "speed", "float")],
                   [("EQPS", "strain", "float")])
        disk = self.read(vtk.vtkXMLPolyDataReader(), "disk_out_ref_surface.vtp")
        self.write("disk.ply", disk, [("Temp", "temperature", "float"), ("Pres", "pressure", "float"),
                                      ("GlobalNodeId", "node", "int")])
        flow = self.read(vtk.vtkDataSetReader(), "carotid.vtk")
        self.write("carotid.ply", self.then(vtk.vtkContourFilter(), flow, SetValue=(0, 150)),
                   [("vectors", "speed", "float")])
        density = self.read(vtk.vtkXMLImageDataReader(), "hydrogen.vti")
        contour = vtk.vtkContourFilter()
        for i, level in enumerate((0.02, 0.06, 0.15, 0.3, 0.6)):
            contour.SetValue(i, level)
        brain = self.data / "big" / "brain_iso126_1033k.ply"
        if brain.exists():
            reader = vtk.vtkPLYReader()
            reader.SetFileName(str(brain))
            reader.Update()
            points = reader.GetOutput().GetPoints()
            write_ply(self.out / "brain_points.ply", [points.GetPoint(i) for i in range(points.GetNumberOfPoints())], [])
        self.write("hydrogen.ply", self.then(contour, density), [("probability_density", "density", "float")])


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    data, out = map(pathlib.Path, sys.argv[1:])
    out.mkdir(parents=True, exist_ok=True)
    balls(out / "balls.obj")
    (out / "floor.obj").write_text("v -8 0 -8\nv -8 0 8\nv 8 0 8\nv 8 0 -8\nf 1 2 3 4\n")
    if (data / "mol").is_dir():
        molecule(data / "mol" / "7DDO.pdb", out / "protein.ply")
        molecule(data / "mol" / "1LCD.pdb", out / "dna.ply")
    try:
        of_vtk = OfVtk(data, out)
    except ImportError as e:
        print(f"note: no files of VTK's: {e}", file=sys.stderr)
    else:
        if (data / "sci").is_dir():
            of_vtk.make()
    print(*sorted(file.name for file in out.iterdir()))


if __name__ == "__main__":
    main()
