#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times contenders that draw pictures from Python and prints a table (README.md beside this file).

usage: contest.py [--only NAME…] [--wheel FILE] [--rounds N] [--seconds S] [--out DIR]
"""
import argparse
import hashlib
import json
import pathlib
import statistics
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
OURS = ("rastrum", "rastrum_normals")  # share an environment
ALL = (*OURS, "opencv", "trimesh", "vtk", "pyvista", "pyrender", "open3d", "mitsuba")
SIZES = (512, 1024)
TRIANGLES = (1_000, 70_000, 1_000_000)
TIMEOUT_S = 180
# A contender whose picture differs is left out: one with a smaller share of common pixels, or a larger median
# relative difference of depth. Mitsuba's rays go through random places in their pixels.
LEAST_SHARE, MOST_OFF = 0.99, 1e-3


def requirements(name):
    """Returns two lists: what pip installs, and what it installs with --no-deps."""
    scope = {"WITHOUT_DEPENDENCIES": []}
    for line in (HERE / "contenders" / f"{name}.py").read_text().splitlines():
        if line.startswith(("REQUIREMENTS", "WITHOUT_DEPENDENCIES")):
            exec(line, scope)
    return scope["REQUIREMENTS"], scope["WITHOUT_DEPENDENCIES"]


class Contender:
    def __init__(self, name, out, wheel):
        self.name, self.folder = name, out / (OURS[0] if name in OURS else name)
        self.python = self.folder / "bin" / "python"
        wanted, alone = ([str(wheel)], []) if name in OURS else requirements(name)
        marker, text = self.folder / "installed.txt", "\n".join(wanted + alone)
        if name in OURS:  # a rebuilt wheel keeps its name
            text += hashlib.sha256(wheel.read_bytes()).hexdigest()
        if not marker.exists() or marker.read_text() != text:
            subprocess.run([sys.executable, "-m", "venv", "--clear", self.folder], check=True)
            pip = [self.python, "-m", "pip", "install", "-q", "--disable-pip-version-check"]
            subprocess.run([*pip, *wanted], check=True)
            if alone:
                subprocess.run([*pip, "--no-deps", *alone], check=True)
            marker.write_text(text)
        packages = next((self.folder / "lib").glob("python*")) / "site-packages"
        files = [f for f in packages.rglob("*") if f.is_file() and "pip" not in f.relative_to(packages).parts[0]
                 and "setuptools" not in f.relative_to(packages).parts[0]]
        self.installed_mb = sum(f.stat().st_size for f in files) / 1e6

    def measure(self, size, triangles, seconds, picture="-"):
        done = subprocess.run([self.python, HERE / "measure.py", self.name, str(size), str(triangles), str(seconds),
                               str(picture)], capture_output=True, text=True, timeout=TIMEOUT_S)
        if done.returncode != 0:
            raise RuntimeError((done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1])
        return json.loads(done.stdout.splitlines()[-1])

    def process_s(self):
        """Times a whole process: interpreter, imports, one small mesh, one picture."""
        begin = time.perf_counter()
        self.measure(512, 1000, 0)
        return time.perf_counter() - begin


def compare(python, ours, theirs):
    """Returns (both / either of the covered pixels, median relative difference of depth where both cover)."""
    code = """
import json, sys, numpy as np
a, b = (np.load(f) for f in sys.argv[1:])
def seen(x): return x["id"] >= 0 if "id" in x else x["depth"] > 0 if "depth" in x else None
sa, sb, worst = a["id"] >= 0, seen(b), None
if sb is not None and "depth" in b:
    far = b["depth"].max()
    sb = (b["depth"] > 0) & (b["depth"] < far)
    both = sa & sb
    worst = float(np.median(abs(a["depth"] - b["depth"])[both] / a["depth"][both]))
print(json.dumps([None if sb is None else float((sa & sb).sum() / (sa | sb).sum()), worst]))
"""
    said = subprocess.run([python, "-c", code, ours, theirs], capture_output=True, text=True, check=True).stdout
    return json.loads(said)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--only", nargs="*", default=ALL)
    parser.add_argument("--wheel", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=1.0)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out" / "python")
    options = parser.parse_args()
    wheel = options.wheel or max((ROOT / "out" / "release").glob("*x86_64.whl"), default=None)
    if wheel is None:
        raise SystemExit("there is no wheel: ./dev release wheels makes some")
    options.out.mkdir(parents=True, exist_ok=True)
    contenders, wrong = [], []
    for name in dict.fromkeys([*OURS, *options.only]):
        try:
            contenders.append(Contender(name, options.out, wheel.resolve()))
        except (subprocess.CalledProcessError, OSError) as e:
            wrong.append(f"{name}: not installed: {e}")
    ours = contenders[0].python
    # Draws all pictures and compares them with ours before anything is timed.
    agreement = {}
    for c in list(contenders):
        try:
            c.measure(1024, 70_000, 0, options.out / f"{c.name}.npz")
            share, off = compare(ours, options.out / "rastrum.npz", options.out / f"{c.name}.npz")
            if share is None or not share > LEAST_SHARE or not (off is None or off < MOST_OFF):
                raise RuntimeError(f"draws another picture: same pixels {share}, depth off by {off}")
            agreement[c.name] = share, off
        except (RuntimeError, subprocess.SubprocessError) as e:
            contenders.remove(c)
            wrong.append(f"{c.name}: {e}")
    figures = {c.name: {} for c in contenders}
    for _ in range(options.rounds):
        for size in SIZES:
            for triangles in TRIANGLES:
                for c in contenders:
                    figures[c.name].setdefault((size, triangles), []).append(c.measure(size, triangles, options.seconds))
        for c in contenders:
            figures[c.name].setdefault("process", []).append(c.process_s())
    head = ["", "installed MB", "import s", "process s", *(f"{s}², {t:,}" for s in SIZES for t in TRIANGLES),
            "1,000 depth maps s", "peak MB", "same pixels", "depth off by"]
    print("ms a frame by size and triangles; medians of", options.rounds, "rounds\n")
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    middle = statistics.median
    for c in contenders:
        f = figures[c.name]
        largest = f[SIZES[-1], TRIANGLES[-1]]
        maps = [m["maps_s"] for m in largest if m["maps_s"] is not None]
        share, off = agreement[c.name]
        row = [c.name, f"{c.installed_mb:.0f}", f"{middle(m['import_s'] for m in largest):.2f}", f"{middle(f['process']):.2f}",
               *(f"{middle(m['frame_ms'] for m in f[s, t]):.1f}" for s in SIZES for t in TRIANGLES),
               f"{middle(maps):.2f}" if maps else "", f"{middle(m['peak_mb'] for m in largest):.0f}",
               f"{share:.4f}", "" if off is None else f"{off:.1e}"]
        print("| " + " | ".join(row) + " |")
    print("\ntimes what rastrum takes in the same round, medians of the rounds; in brackets rastrum_normals\n")
    columns = [(size, t) for size in SIZES for t in TRIANGLES]
    print("| | " + " | ".join(f"{s}², {t:,}" for s, t in columns) + " |\n|" + "---|" * (1 + len(columns)))
    for c in contenders:
        if c.name in OURS:
            continue
        ratios = [[middle(mine["frame_ms"] / own["frame_ms"] for mine, own in zip(figures[c.name][column], figures[own_name][column]))
                   for own_name in OURS if own_name in figures] for column in columns]
        print(f"| {c.name} | " + " | ".join(f"{r[0]:.1f}" + "".join(f" ({x:.1f})" for x in r[1:]) for r in ratios) + " |")
    for w in wrong:
        print(f"left out: {w}", file=sys.stderr)


if __name__ == "__main__":
    main()
