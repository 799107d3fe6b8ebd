"""The Python that the program's window writes beside a screenshot draws the same picture."""

import json
import os
import subprocess
import sys

import pytest


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
])
def test_the_lines_of_a_window_draw_its_picture(tmp_path, options):
    program = os.environ.get("RASTRUM_PROGRAM")
    if not program:
        pytest.skip("RASTRUM_PROGRAM does not name the program")
    subprocess.run([program, "make", "torus_knot", "-o", "knot.ply", "--quiet"], cwd=tmp_path, check=True)
    script = {"fps": 50, "events": [{"time": 0.1, "key_down": "right"}, {"time": 0.4, "key_up": "right"},
                                    {"time": 0.5, "screenshot": "shown.png"}, {"time": 0.6, "quit": True}]}
    (tmp_path / "script.json").write_text(json.dumps(script))
    run = subprocess.run([program, "view", "knot.ply", "--size", "160x120", "--script", "script.json", *options.split()],
                         cwd=tmp_path, env={**os.environ, "SDL_VIDEODRIVER": "dummy"}, capture_output=True, text=True)
    if "without a window" in run.stderr:
        pytest.skip(run.stderr)
    assert run.returncode == 0, run.stderr
    shown = (tmp_path / "shown.png").read_bytes()
    (tmp_path / "shown.png").unlink()
    assert "no words" not in (tmp_path / "shown.py").read_text()
    done = subprocess.run([sys.executable, "shown.py"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr + (tmp_path / "shown.py").read_text()
    now = (tmp_path / "shown.png").read_bytes()
    assert now == shown, (tmp_path / "shown.py").read_text()
