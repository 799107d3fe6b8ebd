# SPDX-License-Identifier: BSD-3-Clause
"""The Python that the program's window writes beside a screenshot draws the same picture."""

import base64
import json
import os
import subprocess
import sys

import numpy as np
import pytest

import rastrum as rr


# A triangle under a lamp of its own.
POSITIONS = base64.b64encode(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4").tobytes()).decode()
LAMP = {"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 2, "color": [0.2, 0.7, 0.9]}]}},
        "scenes": [{"nodes": [0, 1]}], "scene": 0,
        "nodes": [{"mesh": 0}, {"translation": [0.3, 0.3, 0.8], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + POSITIONS}]}


@pytest.mark.parametrize("options", [
    "--look plain",
    "",
    "--look plain --shader material --opacity 0.4 --samples 4 --background #eef",
    "--look plain --scalars z --cmap plasma --range -0.5,0.5 --bar Height --silhouettes",
    "--look plain --scalars distance --cmap magma --range 0.5,2 --log --isolines 1,1.5 --isoline-color white"
    " --isoline-width 2 --below red --above #00ff00 --bar Far --bar-unit m",
    "--look plain --scalars z --cmap #ff0000,#0000ff --steps 5 --symmetric --scalar-opacity -1:0.2,1:1 --title Knot"
    " --caption a --text-scale 1.5 --occlusion --occlusion-radius 0.2 --occlusion-strength 2 --edges --edge-angle 20"
    " --edge-width 2 --cull back",
    "--look plain --shader material --tone aces --exposure 0.5 --lights headlight --edl --edl-strength 2",
    "--look plain --lights studio --shadows --occlusion --edges --clip-plane 1,0,0,0.2 --orthographic fit",
    "--look plain --light point:1,2,3:intensity=9:color=#ff8040:range=7 --light hemisphere:0,0,1:below=#402000:color=skyblue"
    " --light spot:0,3,3:towards=0,-1,-1:inner=5:outer=33.3:intensity=9 --lights headlight --shadows",
    "--look plain --light environment:sky:turn=30:up=0,0,1:color=gold --light ambient:intensity=0.1 --environment-behind"
    " --shader material",
    "--look plain --light directional:0.3,-1,-1:of=camera:intensity=0.7 --light headlight:color=#102030",
    "--look plain --scalars z --isolines 7 --isoline-color white --bar z --nan-color red",
    "--look plain --scalars x --isolines 5 --log --range 0.2,2 --cmap coolwarm",
    "lamp.gltf --look plain --shader material --lights file --light ambient:intensity=0.05",
    "builtin:teapot?n=5 builtin:tube?radius=0.05,segments=64 --look plain",
])
def test_the_lines_of_a_window_draw_its_picture(tmp_path, options):
    subject(tmp_path)
    (tmp_path / "lamp.gltf").write_text(json.dumps(LAMP))
    shown_again(tmp_path, f"knot.ply {options}", "right")


def subject(tmp_path):
    """A mesh to look at."""
    subprocess.run([program(), "make", "torus_knot", "-o", "knot.ply", "--quiet"], cwd=tmp_path, check=True)


def program():
    found = os.environ.get("RASTRUM_PROGRAM")
    if not found:
        pytest.skip("RASTRUM_PROGRAM does not name the program")
    return found


def shown_again(tmp_path, options, key):
    """Looks at what the options say, moves by a key, and draws the picture with the Python beside it."""
    script = {"fps": 50, "events": [{"time": 0.1, "key_down": key}, {"time": 0.4, "key_up": key},
                                    {"time": 0.5, "screenshot": "shown.png"}, {"time": 0.6, "quit": True}]}
    (tmp_path / "script.json").write_text(json.dumps(script))
    run = subprocess.run([program(), "view", "--size", "160x120", "--script", "script.json", *options.split()],
                         cwd=tmp_path, env={**os.environ, "SDL_VIDEODRIVER": "dummy"}, capture_output=True, text=True)
    if "without a window" in run.stderr:
        pytest.skip(run.stderr)
    assert run.returncode == 0, run.stderr
    shown = (tmp_path / "shown.png").read_bytes()
    (tmp_path / "shown.png").unlink()
    assert "Left out here" not in (tmp_path / "shown.py").read_text()
    done = subprocess.run([sys.executable, "shown.py"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr + (tmp_path / "shown.py").read_text()
    now = (tmp_path / "shown.png").read_bytes()
    assert now == shown, (tmp_path / "shown.py").read_text()


@pytest.mark.parametrize(("key", "options"), [
    ("a", "--height hills.png"),
    ("left", "--height hills.png --color colors.png --shadows sharp --sun 200,20 --fog 0.003,20,#405060 --sky #ffb070"),
    ("a", "--height hills.npy --height-scale 0.3 --filter mip --tile mirror --projection cylindrical --clearance 5 --roll 7"
     " --dim-sky --sky #ffb070 --sun 270,6 --fov 71.3"),
    ("a", "--height hills.npy --height-scale 0.3 --scalars height --bar Height --bar-unit m --bounds --axes --sun 200,20"),
    ("left", "--height hills.npy --height-scale 0.3 --cmap #204080,#ffffff --range 20,90 --below #ff0000 --steps 4"
     " --nan-color #00ff00 --bar Height --filter none"),
    ("o", "--height hills.npy --height-scale 0.7 --shadows soft --sun-radius 2 --filter none --scale 90 --distance 333"),
])
def test_the_lines_of_a_terrain_draw_its_picture(tmp_path, key, options):
    x, y = np.meshgrid(np.arange(60), np.arange(60))
    heights = (16 + 15 * np.sin(x * 0.21) * np.cos(y * 0.17)).astype(np.uint8)
    np.save(tmp_path / "hills.npy", heights * np.float32(3.3))
    for name, channels in (("hills.png", (heights, heights, heights)), ("colors.png", (4 * x, 4 * y, 0 * x + 90))):
        rr._rastrum.write_png(str(tmp_path / name), np.dstack([*channels, 0 * x + 255]).astype(np.uint8))
    shown_again(tmp_path, f"--terrain {options}", key)
