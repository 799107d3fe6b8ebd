#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the showcase: first pictures of real and procedural data, beside those of f3d and VTK by default.

usage: showcase.py [--build DIR] [--data DIR] [--out DIR] [--no-peers] [--new-peers] [--only NAME]

Writes DIR/index.html and DIR/showcase.md: thumbnails that link to the pictures, each with its command, and, if f3d and
VTK are installed (Debian: f3d, python3-vtk9, xvfb), their pictures of the same file. DATA is ../shared/data; entries
without their file are left out, with a message. Peers' pictures are kept only in DIR and used again unless --new-peers
is given. tools/showcase_data.py, which also needs VTK's Python package, converts scientific files to PLY files with
numbers.
"""
import argparse
import dataclasses
import html
import pathlib
import shlex
import shutil
import subprocess
import sys
import time

import showcase_entries

ROOT = pathlib.Path(__file__).resolve().parent.parent
TIMEOUT_S = 120
THUMBNAIL = "320:-2"
PYTHON = "/usr/bin/python3"  # Debian's, which has Debian's VTK

# A program that draws a file with VTK's defaults: reader, mapper, actor, renderer.
VTK = """
import sys, vtk
file, picture, width, height = sys.argv[1:]
readers = {".obj": vtk.vtkOBJReader, ".ply": vtk.vtkPLYReader, ".stl": vtk.vtkSTLReader}
ending = file[file.rindex("."):]
renderer, window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
window.SetOffScreenRendering(True)
window.SetSize(int(width), int(height))
window.AddRenderer(renderer)
if ending in readers:
    reader, mapper, actor = readers[ending](), vtk.vtkPolyDataMapper(), vtk.vtkActor()
    reader.SetFileName(file)
    mapper.SetInputConnection(reader.GetOutputPort())
    actor.SetMapper(mapper)
    renderer.AddActor(actor)
else:
    importer = vtk.vtkGLTFImporter()
    importer.SetFileName(file)
    importer.SetRenderWindow(window)
    importer.Update()
renderer.ResetCamera()
window.Render()
grab, writer = vtk.vtkWindowToImageFilter(), vtk.vtkPNGWriter()
grab.SetInput(window)
writer.SetInputConnection(grab.GetOutputPort())
writer.SetFileName(picture)
writer.Write()
"""


@dataclasses.dataclass
class Picture:
    file: str
    thumbnail: str
    command: str
    seconds: float


def run(command, **more):
    """Runs a command. Returns (seconds, its output if it failed)."""
    begin = time.monotonic()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S, **more)
        wrong = done.stderr.strip() or f"exit status {done.returncode}" if done.returncode else ""
    except (OSError, subprocess.TimeoutExpired) as e:
        wrong = str(e)
    return time.monotonic() - begin, wrong


class Maker:
    def __init__(self, options):
        self.program = options.build / "apps" / "rastrum" / "rastrum"
        self.data, self.out, self.new_peers = options.data, options.out, options.new_peers
        self.made = options.out / "made"
        self.peers = [] if options.no_peers else self.find_peers()

    @staticmethod
    def find_peers():
        if not shutil.which("xvfb-run"):
            print("note: no xvfb-run, so no pictures of f3d and VTK", file=sys.stderr)
            return []
        peers = []
        if shutil.which("f3d"):
            peers.append(("f3d", lambda file, picture, size: [
                "f3d", file, f"--output={picture}", f"--resolution={size[0]},{size[1]}"]))
        if subprocess.run([PYTHON, "-c", "import vtk"], capture_output=True).returncode == 0:
            peers.append(("VTK", lambda file, picture, size: [
                PYTHON, "-c", VTK, file, picture, str(size[0]), str(size[1])]))
        for name in {"f3d", "VTK"} - {name for name, _ in peers}:
            print(f"note: {name} is not installed", file=sys.stderr)
        return peers

    def make_data(self):
        """Makes the PLY files of the scientific data."""
        _, wrong = run([PYTHON, ROOT / "tools" / "showcase_data.py", self.data, self.made])
        if wrong:
            print(f"note: showcase_data.py: {wrong.splitlines()[-1]}", file=sys.stderr)

    def path(self, file):
        """The path of a file that an entry names as DATA/… or MADE/…."""
        folder, name = file.split("/", 1)
        return (self.data if folder == "DATA" else self.made) / name

    def thumbnail(self, name):
        small = f"small/{name}.png"
        _, wrong = run(["ffmpeg", "-v", "error", "-y", "-i", self.out / f"{name}.png",
                        "-vf", f"scale={THUMBNAIL}:flags=area", self.out / small])
        if wrong:
            raise SystemExit(f"{name}: no thumbnail: {wrong}")
        return small

    def ours(self, entry):
        words = [word.replace("DATA/", f"{self.data}/").replace("MADE/", f"{self.made}/")
                 for word in shlex.split(entry.command)]
        seconds, wrong = run([self.program, *words, "-o", f"{entry.name}.png"], cwd=self.out)
        if wrong:
            raise SystemExit(f"{entry.name}: rastrum {entry.command}\n{wrong}")
        return Picture(f"{entry.name}.png", self.thumbnail(entry.name),
                       f"rastrum {entry.command} -o {entry.name}.png", seconds)

    def of_peers(self, entry):
        made = {}
        if entry.peer_file:
            for peer, command in self.peers:
                name = f"{entry.name}_{peer.lower()}"
                took = self.out / f"{name}.seconds"
                if took.exists() and (self.out / f"{name}.png").exists() and not self.new_peers:
                    made[peer] = Picture(f"{name}.png", f"small/{name}.png", f"{peer}, by default", float(took.read_text()))
                    continue
                line = command(str(self.path(entry.peer_file)), f"{name}.png", entry.size)
                seconds, wrong = run(["xvfb-run", "-a", *line], cwd=self.out)
                if wrong or not (self.out / f"{name}.png").exists():
                    print(f"note: {peer} draws no {entry.peer_file}: {wrong.splitlines()[-1:]}", file=sys.stderr)
                else:
                    made[peer] = Picture(f"{name}.png", self.thumbnail(name), f"{peer}, by default", seconds)
                    took.write_text(f"{seconds:.3f}")
        return made


def as_html(made):
    rows = []
    for entry, ours, peers in made:
        cells = "".join(
            f'<figure><a href="{p.file}"><img src="{p.thumbnail}" alt=""></a>'
            f"<figcaption><code>{html.escape(p.command)}</code> {p.seconds:.2f} s</figcaption></figure>"
            for p in [ours, *peers.values()])
        rows.append(f"<section><h2>{html.escape(entry.title)}</h2><div>{cells}</div></section>")
    return ("<!doctype html><meta charset=utf-8><title>Rastrum: showcase</title><style>"
            "body{font:15px sans-serif;margin:2em;background:#fafafa;color:#222}section{margin-bottom:2em}"
            "h2{font-size:1.1em;margin:0 0 .4em}div{display:flex;flex-wrap:wrap;gap:1em}figure{margin:0;width:320px}"
            "img{width:320px;background:#fff;border:1px solid #ddd}figcaption{font-size:12px;word-break:break-word}"
            "</style><h1>Rastrum: showcase</h1>" + "\n".join(rows) + "\n")


def as_markdown(made):
    lines = ["# Showcase", ""]
    for entry, ours, peers in made:
        lines += [f"## {entry.title}", ""]
        lines += [f"[![]({p.thumbnail})]({p.file})" for p in [ours, *peers.values()]]
        lines += ["", "```sh", ours.command, "```"]
        lines += [f"Beside it: {p.command}, {p.seconds:.2f} s." for p in peers.values()] + [""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared" / "data")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out" / "showcase")
    parser.add_argument("--no-peers", action="store_true")
    parser.add_argument("--new-peers", action="store_true")
    parser.add_argument("--only", help="the entries whose name contains this")
    options = parser.parse_args()
    for name in ("build", "data", "out"):
        setattr(options, name, getattr(options, name).resolve())
    (options.out / "small").mkdir(parents=True, exist_ok=True)
    maker, made, left_out = Maker(options), [], []
    maker.make_data()
    entries = [e for e in showcase_entries.ENTRIES if (options.only or "") in e.name]
    for number, entry in enumerate(entries, 1):
        if not all(maker.path(file).exists() for file in entry.files):
            left_out.append(entry.name)
            continue
        if sys.stderr.isatty():
            print(f"\r\033[K{number} of {len(entries)}: {entry.name}", end="", file=sys.stderr)
        made.append((entry, maker.ours(entry), maker.of_peers(entry)))
    if sys.stderr.isatty():
        print("\r\033[K", end="", file=sys.stderr)
    (options.out / "index.html").write_text(as_html(made), encoding="utf-8")
    (options.out / "showcase.md").write_text(as_markdown(made), encoding="utf-8")
    if left_out:
        print(f"left out, without their data: {', '.join(left_out)}", file=sys.stderr)
    print(options.out / "index.html")


if __name__ == "__main__":
    main()
