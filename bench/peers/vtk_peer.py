# SPDX-License-Identifier: BSD-3-Clause
"""Draws by VTK's depth peeling, sphere mapper, points and ambient occlusion, as a child process of `rastrum
bench transparency`, `spheres`, `points` and `effects`.

Debian's package (python3-vtk9) is built for X11, so Xvfb is started if there is no DISPLAY. Each line on
stdin is a command; one line on stdout answers it, "done" or "error …":

    mesh FILE VERTICES TRIANGLES   positions, normals (float32 × 3), indices (uint32 × 3), raw
    spheres FILE COUNT             instead: places (float32 × 3), radii (float32), raw
    points FILE COUNT              instead: places (float32 × 3), raw; one pixel each
    view WIDTH HEIGHT FOV_RAD EX EY EZ TX TY TZ UX UY UZ
    occlusion RADIUS               later frames with its screen-space ambient occlusion; 0: without
    draw OPACITY                   one finished frame; peeled if OPACITY is not 1
    picture FILE                   the frame as RGBA8, row 0 at the top, raw

The peers' `phong` (gl_context.cpp) replaces VTK's own light. Normals are in camera space here, so the light's
direction is transformed into it.
"""

import array
import math
import os
import subprocess
import sys

answers = os.fdopen(os.dup(1), "w", buffering=1)
os.dup2(2, 1)  # output of libraries must not mix with answers

PHONG = """
  vec3 to_eye = cameraParallel != 0 ? vec3(0.0, 0.0, 1.0) : normalize(-vertexVC.xyz);
  vec3 way = normalize(normalVCVSOutput);
  if (dot(way, to_eye) < 0.0) way = -way;
  vec3 towards = normalize(vec3(TOWARDS));
  vec3 halfway = normalize(towards + to_eye);
  float lit = 0.1 + 0.8 * max(dot(way, towards), 0.0);
  float highlight = 0.3 * pow(max(dot(way, halfway), 0.0), 32.0);
  gl_FragData[0] = vec4(vec3(0.8, 0.7, 0.6) * lit + highlight, opacity);
"""


def start_display():
    if os.environ.get("DISPLAY"):
        return None
    end, other = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(other), "-screen", "0", "64x64x24", "-nolisten", "tcp"],
        pass_fds=[other], stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(other)
    number = os.fdopen(end).readline().strip()
    if not number:
        raise RuntimeError("Xvfb gives no display")
    os.environ["DISPLAY"] = ":" + number
    return server


class Peer:
    def __init__(self):
        import vtk

        self.vtk = vtk
        self.towards = (0.4, 0.6, 1.0)
        self.occluded = None
        self.actor = vtk.vtkActor()
        self.draw_by(vtk.vtkPolyDataMapper())
        self.actor.GetProperty().SetInterpolationToPhong()
        self.renderer = vtk.vtkRenderer()
        self.renderer.AddActor(self.actor)
        self.renderer.SetBackground(0, 0, 0)
        self.renderer.SetBackgroundAlpha(0)
        self.renderer.SetUseDepthPeeling(True)
        # Peels until nothing is left. 0 is documented as "no limit", but then dual depth peeling (9.1) peels
        # nothing and blends unsorted.
        self.renderer.SetMaximumNumberOfPeels(1 << 20)
        self.renderer.SetOcclusionRatio(0)
        self.window = vtk.vtkRenderWindow()
        self.window.SetOffScreenRendering(True)
        self.window.SetAlphaBitPlanes(True)
        self.window.SetMultiSamples(0)
        self.window.AddRenderer(self.renderer)

    def light(self):
        shader = self.actor.GetShaderProperty()
        shader.ClearAllFragmentShaderReplacements()
        if self.phong:
            # The occlusion pass writes places and normals at VTK's light, which ours then overwrites.
            text = ("//VTK::Light::Impl\n" if self.occluded else "") + PHONG.replace("TOWARDS", ", ".join(f"{v:.9f}" for v in self.towards))
            shader.AddFragmentShaderReplacement("//VTK::Light::Impl", True, text, False)

    def draw_by(self, mapper, phong=True):
        self.phong = phong
        self.light()
        self.actor.GetProperty().SetLighting(phong)
        self.actor.SetMapper(mapper)

    def describe(self):
        self.window.SetSize(64, 64)
        self.window.Render()
        capabilities = self.window.ReportCapabilities().splitlines()
        renderer = [line.split(":", 1)[1].strip() for line in capabilities
                    if line.startswith("OpenGL renderer string")]
        return "VTK " + self.vtk.vtkVersion().GetVTKVersion() + " on " + " ".join(renderer)

    def mesh(self, file, vertices, triangles):
        vtk = self.vtk
        vertices, triangles = int(vertices), int(triangles)
        with open(file, "rb") as data:
            positions, normals = array.array("f"), array.array("f")
            positions.fromfile(data, 3 * vertices)
            normals.fromfile(data, 3 * vertices)
            indices = array.array("i")
            indices.fromfile(data, 3 * triangles)
        offsets = array.array("i", range(0, 3 * triangles + 1, 3))

        data = self.data(positions)
        cells = vtk.vtkCellArray()
        cells.SetData(self.array(vtk.vtkTypeInt32Array, offsets, 1),
                      self.array(vtk.vtkTypeInt32Array, indices, 1))
        data.SetPolys(cells)
        data.GetPointData().SetNormals(self.array(vtk.vtkFloatArray, normals, 3))
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(data)
        self.draw_by(mapper)
        self.kept = positions, normals, indices, offsets  # VTK borrows them

    def spheres(self, file, count):
        vtk = self.vtk
        count = int(count)
        with open(file, "rb") as data:
            places, radii = array.array("f"), array.array("f")
            places.fromfile(data, 3 * count)
            radii.fromfile(data, count)
        data = self.data(places)
        scale = self.array(vtk.vtkFloatArray, radii, 1)
        scale.SetName("radius")
        data.GetPointData().AddArray(scale)
        offsets, numbers = array.array("i", range(count + 1)), array.array("i", range(count))
        cells = vtk.vtkCellArray()  # the mapper draws vertices, not points
        cells.SetData(self.array(vtk.vtkTypeInt32Array, offsets, 1),
                      self.array(vtk.vtkTypeInt32Array, numbers, 1))
        data.SetVerts(cells)
        mapper = vtk.vtkOpenGLSphereMapper()
        mapper.SetInputData(data)
        mapper.SetScaleArray("radius")
        mapper.SetScalarVisibility(False)
        self.draw_by(mapper)
        self.kept = places, radii, offsets, numbers  # VTK borrows them

    def points(self, file, count):
        vtk = self.vtk
        places = array.array("f")
        with open(file, "rb") as data:
            places.fromfile(data, 3 * int(count))
        mapper = vtk.vtkPointGaussianMapper()
        mapper.SetInputData(self.data(places))
        mapper.SetScaleFactor(0)  # documented: points of one pixel in place of splats
        mapper.SetEmissive(False)
        mapper.SetScalarVisibility(False)
        self.draw_by(mapper, phong=False)
        self.kept = (places,)  # VTK borrows them

    @staticmethod
    def array(kind, values, components):
        out = kind()
        out.SetNumberOfComponents(components)
        out.SetVoidArray(values, len(values), 1)
        return out

    def data(self, places):
        points = self.vtk.vtkPoints()
        points.SetData(self.array(self.vtk.vtkFloatArray, places, 3))
        data = self.vtk.vtkPolyData()
        data.SetPoints(points)
        return data

    def view(self, width, height, fov, *where):
        width, height = int(width), int(height)
        where = [float(w) for w in where]
        self.window.SetSize(width, height)
        camera = self.renderer.GetActiveCamera()
        camera.SetPosition(where[0:3])
        camera.SetFocalPoint(where[3:6])
        camera.SetViewUp(where[6:9])
        camera.SetViewAngle(math.degrees(float(fov)))
        camera.SetUseHorizontalViewAngle(width < height)
        self.renderer.ResetCameraClippingRange()
        to_camera = camera.GetViewTransformMatrix()
        towards = tuple(sum(to_camera.GetElement(i, j) * v for j, v in enumerate((0.4, 0.6, 1.0))) for i in range(3))
        if any(abs(a - b) > 1e-9 for a, b in zip(towards, self.towards)):
            self.towards = towards
            self.light()

    def occlusion(self, radius):
        radius = float(radius)
        if radius == 0:
            self.renderer.SetPass(None)
            return
        if self.occluded is None:
            steps, self.occluded = self.vtk.vtkRenderStepsPass(), self.vtk.vtkSSAOPass()
            self.occluded.SetDelegatePass(steps)
            self.occluded.SetKernelSize(16)  # the same number as ours
            self.occluded.SetBlur(True)
            self.light()
        self.occluded.SetRadius(radius)
        self.occluded.SetBias(0.02 * radius)
        self.renderer.SetPass(self.occluded)

    def draw(self, opacity):
        opacity = float(opacity)
        self.actor.GetProperty().SetOpacity(opacity)
        self.window.Render()
        self.window.WaitForCompletion()
        if opacity != 1 and not self.renderer.GetLastRenderingUsedDepthPeeling():
            raise RuntimeError("VTK did not peel")

    def picture(self, file):
        width, height = self.window.GetSize()
        pixels = self.vtk.vtkUnsignedCharArray()
        self.window.GetRGBACharPixelData(0, 0, width - 1, height - 1, 0, pixels)
        data = bytes(memoryview(pixels))
        row = 4 * width
        with open(file, "wb") as out:
            for y in reversed(range(height)):
                out.write(data[y * row:(y + 1) * row])


def main():
    server = None
    try:
        server = start_display()
        peer = Peer()
        print("done", peer.describe(), file=answers)
        commands = {"mesh": peer.mesh, "spheres": peer.spheres,
                    "points": peer.points, "view": peer.view, "occlusion": peer.occlusion,
                    "draw": peer.draw, "picture": peer.picture}
        for line in sys.stdin:
            command, *arguments = line.split()
            commands[command](*arguments)
            print("done", file=answers)
    except Exception as e:  # the bench reports any failure
        print("error", type(e).__name__ + ":", " ".join(str(e).split()), file=answers)
    finally:
        if server:
            server.terminate()
            server.wait()
        os._exit(0)  # skips VTK's cleanup, which would use the display


main()
