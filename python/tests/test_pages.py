# SPDX-License-Identifier: BSD-3-Clause
"""The Python of README.md, docs/python.md, docs/coming_from.md, docs/python_tools.md and docs/tour.ipynb runs."""

import json
import pathlib
import re
import subprocess
import sys
import types

import numpy as np
import pytest

import rastrum as rr

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
TOUR = DOCS / "tour.ipynb"


def ball(n=24):
    """A mesh as trimesh has them, without trimesh."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 2 * n), np.linspace(0, np.pi, n))
    points = np.stack([np.cos(u) * np.sin(v), np.cos(v), np.sin(u) * np.sin(v)], -1).reshape(-1, 3)
    i = (np.arange(n - 1)[:, None] * 2 * n + np.arange(2 * n - 1)).reshape(-1)
    faces = np.concatenate([np.stack([i, i + 1, i + 2 * n], -1), np.stack([i + 1, i + 2 * n + 1, i + 2 * n], -1)])
    return points, faces


def blocks_of(page):
    if not (DOCS / page).exists():
        pytest.skip("the pages are not beside the tests")
    return re.findall(r"^```python\n(.*?)^```", (DOCS / page).read_text(encoding="utf-8"), re.M | re.S)


def run_blocks(page, blocks, names):
    for block in blocks:
        exec(compile(block, page, "exec"), names)


def test_the_guide_runs(tmp_path, monkeypatch):
    blocks = blocks_of("python.md")
    assert len(blocks) == 12
    monkeypatch.chdir(tmp_path)
    vertices, faces = ball()
    rows = [*(f"v {x} {y} {z}" for x, y, z in vertices), *(f"f {a} {b} {c}" for a, b, c in faces + 1)]
    (tmp_path / "bunny.obj").write_text("\n".join(rows))
    (tmp_path / "beam.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property float pressure\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0 1\n1 0 0 2\n0 1 0 4\n3 0 1 2\n")
    lamp = {"asset": {"version": "2.0"}, "nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0}}}],
            "scenes": [{"nodes": [0]}], "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional"}]}}}
    (tmp_path / "room.gltf").write_text(json.dumps(lamp))
    heights = 40 * np.sin(np.arange(128) / 9)[:, None] * np.cos(np.arange(128) / 7)
    np.save(tmp_path / "alps.npy", heights * 20 + 1000)
    centers = np.array([[0.0, 2, 0], [1, 2, 0], [2, 2, 0]])
    names = {
        "trimesh_mesh": types.SimpleNamespace(vertices=vertices.copy(), faces=faces), "part": (vertices, faces),
        "room": (vertices, faces), "scene": [(vertices, faces)] * 4, "pressure": vertices[:, 1], "centers": centers,
        "radii": np.array([0.3, 0.2, 0.1]), "per_atom": np.eye(3), "pairs": np.array([[0, 1], [1, 2]]), "paths": centers,
        "offsets": np.array([0, 3]), "speed": np.arange(3.0), "charge": np.arange(3.0), "fx": 600, "fy": 600, "cx": 320, "cy": 240,
        "R": np.eye(3), "t": [0, 0, 4], "world_to_camera": np.eye(4), "model_to_world": np.eye(4), "trajectory": [(np.eye(3), [0, 0, 4 + i]) for i in range(4)],
        "heights": heights, "photo": np.full((64, 64, 3), 128, np.uint8)}
    run_blocks("python.md", blocks, names)
    assert (tmp_path / "bunny.png").stat().st_size > 1000
    assert len(list(tmp_path.glob("step_*.png"))) == 3 and np.load(tmp_path / "depth.npy").max() > 1
    assert len(names["pictures"]) == 64 and (names["pictures"].color[0] != names["pictures"].color[63]).any()
    assert names["depth"].shape == (4, 128, 128) and names["picture"].color.std() > 10


def test_every_block_runs(tmp_path, monkeypatch):
    blocks = blocks_of("coming_from.md")
    assert len(blocks) == 5
    vertices, faces = ball()
    try:
        import trimesh
        part = trimesh.Trimesh(vertices, faces, process=False)
    except ImportError:
        visual = types.SimpleNamespace(kind=None)
        part = types.SimpleNamespace(vertices=vertices, faces=faces, vertex_normals=vertices, visual=visual)
        blocks[1] = blocks[1].replace("rr.render(part,", "rr.render((part.vertices, part.faces),")
        blocks[3] = blocks[3].replace("[part,", "[(part.vertices, part.faces),")
    pose = np.eye(4)
    pose[:3, 3] = 0.2, -0.1, 4
    tri = np.array([[0, 1, 2]])
    names = {"part": part, "pose": pose, "tri": tri, "attributes": np.eye(3),
             "pos": np.array([[[-1, -1, 0, 1], [1, -1, 0, 1], [0, 1, 0, 1]]], np.float32)}
    monkeypatch.chdir(tmp_path)
    run_blocks("coming_from.md", blocks, names)
    assert (names["depth"] > 0).sum() > 20000 and names["color"].shape == (1, 512, 512, 3) and names["color"].max() > 0.9
    assert (tmp_path / "points.png").stat().st_size > 1000
    assert names["mask"].any(axis=(1, 2)).all() and len(names["points"]) > 1000
    assert isinstance(names["p"], rr.Pictures)


def block_of_tool(tool):
    """The one block of a tool's section in python_tools.md."""
    if not (DOCS / "python_tools.md").exists():
        pytest.skip("the pages are not beside the tests")
    sections = re.split(r"^## (.*)\n", (DOCS / "python_tools.md").read_text(encoding="utf-8"), flags=re.M)
    blocks = {name: re.findall(r"^```python\n(.*?)^```", text, re.M | re.S) for name, text in zip(sections[1::2], sections[2::2])}
    assert {name for name, found in blocks.items() if found} == {"PyVista", "Jupyter", "matplotlib", "trimesh", "pytest"}
    block, = blocks[tool]
    return block


def test_the_block_of_pyvista_runs(tmp_path, monkeypatch):
    block = block_of_tool("PyVista")
    pv = pytest.importorskip("pyvista")
    import rastrum.pyvista_plugin  # noqa: F401  where no wheel is installed there are no entry points
    plotter = pv.Plotter(off_screen=True, window_size=(160, 120))
    plotter.add_mesh(pv.Sphere())
    monkeypatch.chdir(tmp_path)
    run_blocks("python_tools.md", [block], {"mesh": pv.Sphere(), "plotter": plotter})
    assert (tmp_path / "p.png").stat().st_size > 300


def test_the_block_of_jupyter_runs():
    block = block_of_tool("Jupyter")
    pytest.importorskip("anywidget")
    names = {"rr": rr, "scene": ball()}
    run_blocks("python_tools.md", [block], names)
    assert names["seen"].color.std() > 10


def test_the_block_of_matplotlib_runs(tmp_path):
    block = block_of_tool("matplotlib")
    pytest.importorskip("matplotlib").use("Agg")
    from matplotlib import pyplot
    names = {"rr": rr, "pyplot": pyplot, "things": ball()}
    run_blocks("python_tools.md", [block], names)
    names["ax"].figure.savefig(tmp_path / "shown.png")
    shown = pyplot.imread(tmp_path / "shown.png")
    names["ax"].clear()
    names["ax"].figure.savefig(tmp_path / "empty.png")
    pyplot.close(names["ax"].figure)
    assert (pyplot.imread(tmp_path / "empty.png") != shown).any(-1).sum() > 1000


def test_the_block_of_trimesh_runs():
    block = block_of_tool("trimesh")
    trimesh = pytest.importorskip("trimesh")
    names = {"rr": rr, "scene": trimesh.Scene(trimesh.Trimesh(*ball(), process=False))}
    run_blocks("python_tools.md", [block], names)
    assert names["picture"].color.std() > 10


def test_the_block_of_pytest_runs(tmp_path, monkeypatch):
    names, taken = {"rr": rr}, []
    run_blocks("python_tools.md", [block_of_tool("pytest")], names)
    (tmp_path / "part.stl").write_text(
        "solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid part\n")
    monkeypatch.chdir(tmp_path)
    names["test_part"](lambda picture, name: taken.append((picture, name)))  # test_plugins.py tests the fixture itself
    (picture, name), = taken
    assert name == "part" and picture.color[..., 3].any()


def test_the_block_of_the_readme_runs(tmp_path, monkeypatch):
    if not (ROOT / "README.md").exists():
        pytest.skip("the pages are not beside the tests")
    blocks = re.findall(r"^```python\n(.*?)^```", (ROOT / "README.md").read_text(encoding="utf-8"), re.M | re.S)
    assert len(blocks) == 1
    names = {"part": ball()}
    monkeypatch.chdir(tmp_path)
    exec(compile(blocks[0], "README.md", "exec"), names)
    assert names["picture"].depth.max() > 0 and (tmp_path / "part.png").exists()


def test_the_tour_shows_what_it_holds(tmp_path):
    pytest.importorskip("PIL")
    tool = ROOT / "tools" / "notebook.py"
    if not TOUR.exists() or not tool.exists():
        pytest.skip("the notebook is not beside the tests")
    def check(file):
        return subprocess.run([sys.executable, tool, "check", file], capture_output=True, text=True, cwd=tmp_path)
    done = check(TOUR)
    assert done.returncode == 0, done.stderr
    # Another picture, and other words, are seen.
    for old, new, cell in (("#c8a070", "#70a0c8", 1), ("nearest:", "farthest:", 4)):
        notebook = json.loads(TOUR.read_text(encoding="utf-8"))
        changed = json.dumps(notebook).replace(old, new, 1)
        (tmp_path / "other.ipynb").write_text(changed)
        done = check(tmp_path / "other.ipynb")
        assert done.returncode == 1 and f"cell {cell} " in done.stderr, done.stderr


def test_the_front_picture_is_what_its_tool_draws(tmp_path):
    image = pytest.importorskip("PIL.Image")
    tool, shown = ROOT / "tools" / "front_picture.py", ROOT / "docs" / "images" / "front.png"
    if not tool.exists() or not shown.exists():
        pytest.skip("the picture is not beside the tests")
    drawn = tmp_path / "front.png"
    subprocess.run([sys.executable, tool, "-o", drawn], check=True)
    a, b = (np.asarray(image.open(file), np.int16) for file in (drawn, shown))
    assert a.shape == b.shape and np.abs(a - b).max() <= 1
