# SPDX-License-Identifier: BSD-3-Clause
"""rr.View: what the mouse does becomes pictures; no browser, and no Jupyter but its model."""

import io
import math
import os
import pathlib
import shutil
import subprocess

import numpy as np
import pytest

import rastrum as rr
from rastrum import _view

SIZE = (160, 120)


class Clock:
    """Each frame takes as long as it says: fixed + per_pixel of the newest size."""

    def __init__(self):
        self.now, self.step_ms, self.odd = 0.0, 0.0, False

    def __call__(self):
        if self.odd:
            self.now += self.step_ms / 1000
        self.odd = not self.odd
        return self.now


def session(what, camera=None, target_ms=33.0, clock=None, **frame):
    more = {} if clock is None else {"clock": clock}
    return _view._Session(rr.as_scene(what), camera, SIZE, target_ms, rr.Renderer(threads=1), frame, **more)


def decoded(png):
    image = pytest.importorskip("PIL.Image")
    return np.asarray(image.open(io.BytesIO(png)))


def test_at_rest_the_picture_is_renders(sheet):
    s = session(sheet, shader="lambert")
    answer, (png,) = s.receive({})
    assert answer["whole"] and answer["ms"] > 0
    assert np.array_equal(decoded(png), rr.render(sheet, rr.orbit(sheet, 1, fov=30)[0], size=SIZE, shader="lambert").color)


def eye(camera):
    return np.asarray(camera._for_size(SIZE).eye)


def test_turning(sheet):
    s = session(sheet, rr.Camera.look_at((0, 0, 4), fov=40))
    s.receive({"turn": (0.5, 0)})  # half a turn is one side, so a quarter; to the right the eye goes to the left
    assert np.allclose(eye(s.camera), (-4, 0, 0), atol=1e-6)
    s.receive({"turn": (0, 1 / 6)})  # down: the eye goes up
    assert np.allclose(eye(s.camera), (-4 * math.cos(math.pi / 6), 2, 0), atol=1e-6)
    s.receive({"turn": (0, 9)})  # the pole is not passed
    assert 3.99 < eye(s.camera)[1] < 4 and eye(s.camera)[0] < 0
    s.receive({"home": True})
    assert np.array_equal(eye(s.camera), (0, 0, 4))


@pytest.mark.parametrize("camera", [rr.Camera.look_at((0, 0, 4), fov=40), rr.Camera.orthographic((0, 0, 4), height=3)])
def test_what_is_panned_stays_under_the_pointer(camera):
    ball = rr.Spheres([[0, 0, 0]], 0.05)
    s = session(ball, camera)

    def place():
        y, x = np.nonzero(rr.render(ball, s.camera, size=SIZE, outputs="id").id >= 0)
        return np.array((x.mean(), y.mean())) / min(SIZE)
    before = place()
    s.receive({"pan": (0.25, -0.125)})
    assert np.allclose(place() - before, (0.25, -0.125), atol=0.01)
    count = (rr.render(ball, s.camera, size=SIZE, outputs="id").id >= 0).sum()
    s.receive({"pan": (-0.25, 0.125)})
    s.receive({"zoom": 2.0})
    assert np.isclose((rr.render(ball, s.camera, size=SIZE, outputs="id").id >= 0).sum(), 4 * count, rtol=0.2)


@pytest.mark.parametrize("parallel", [False, True])
def test_the_planes_follow(sheet, parallel):
    camera = rr.Camera.orthographic((0, 0, 4), height=3) if parallel else rr.Camera.look_at((0, 0, 4), near=3.5)
    s = session(sheet, camera)
    for message in ({"turn": (0.3, 0.2)}, {"pan": (0.1, 0.3)}, {"zoom": 0.2}, {"turn": (0.9, -0.3)}):
        s.receive(message)
    seen = rr.render(sheet, s.camera, size=SIZE, outputs=("face", "depth"))
    assert len(np.unique(seen.face)) > 50 and seen.depth.max() > 0


def test_pixels_by_the_time_they_take(sheet):
    clock = Clock()
    s = session(sheet, target_ms=33.0, clock=clock)

    def move(fixed, each):
        """The step that is drawn at, where a frame takes fixed + each * pixels of the whole one."""
        drawn = []
        plain = s.draw

        def draw(step=0):
            drawn.append(step)
            clock.step_ms = fixed + each * _view._SCALES[step] ** 2
            return plain(step)
        s.draw = draw
        answer, (png,) = s.receive({"turn": (0.01, 0)})
        s.draw = plain
        assert decoded(png).shape[:2] == (round(120 * _view._SCALES[drawn[0]]), round(160 * _view._SCALES[drawn[0]]))
        assert answer["whole"] == (drawn[0] == 0)
        return _view._SCALES[drawn[0]], answer["ms"]
    slow = [move(2, 500) for _ in range(6)]
    assert slow[-1][0] == 0.1875 and slow[-1][1] <= 33
    fast = [move(2, 10) for _ in range(8)]
    assert fast[-1][0] == 1
    stuck = [move(400, 10) for _ in range(12)]  # fewer pixels would not help
    assert stuck[-1][0] == 1


def test_what_is_wrong_is_told(sheet):
    s = session(sheet)
    for message, words in (({"turn": (1,)}, "turn must be 2"), ({"pan": (math.nan, 0)}, "pan"), ({"zoom": 0}, "zoom"),
                           ({"zoom": "2"}, "zoom"), ({"spin": 1}, "'spin'"), ("turn", "dict"), ({"turn": None}, "turn")):
        answer, pictures = s.receive(message)
        assert words in answer["error"] and not pictures
    assert s.receive({})[0]["whole"]
    with pytest.raises(rr.ArgumentError, match="camera"):
        session(sheet, rr.Camera.opencv(np.diag((100.0, 100, 1))))


def test_the_widget(sheet):
    pytest.importorskip("anywidget")
    view = rr.View(sheet, size=SIZE, threads=1)
    sent = []
    view.widget.send = lambda answer, buffers=None: sent.append((answer, buffers))
    view.widget._handle_custom_msg({"turn": [0.2, 0.1]}, [])
    view.widget._handle_custom_msg({}, [])
    assert sent[-1][0]["whole"] and (view.widget.width, view.widget.height) == SIZE
    assert np.array_equal(decoded(sent[-1][1][0]), view.picture().color)
    assert np.array_equal(view.picture().color, rr.render(sheet, view.camera, size=SIZE).color)
    view.camera = rr.Camera.look_at((0, 0, 9))
    assert len(sent) == 3 and np.array_equal(eye(view.camera), (0, 0, 9))
    data, _ = view._repr_mimebundle_()
    assert np.array_equal(decoded(data["image/png"]), view.picture().color)
    for wrong in ({"outputs": "id"}, {"target_ms": 0}, {"size": (0, 1)}, {"shader": 3}, {"no_such": 1}):
        with pytest.raises(rr.Error):
            rr.View(sheet, **wrong).picture()


def test_the_browsers_half():
    node = shutil.which("node")
    if node is None:
        pytest.skip("no node here")
    here = pathlib.Path(__file__).resolve().parent
    done = subprocess.run([node, here / "view_test.mjs", pathlib.Path(_view.__file__).resolve().with_name("_view.js")],
                          capture_output=True, text=True,
                          env={k: v for k, v in os.environ.items() if k != "LD_PRELOAD"})  # a sanitizer's, of the module
    assert done.returncode == 0, done.stderr


def test_in_a_kernel(tmp_path):
    """Jupyter's own messages: the widget is shown, what the mouse did goes in, a picture comes back."""
    pytest.importorskip("anywidget")
    pytest.importorskip("ipykernel")
    jupyter = pytest.importorskip("jupyter_client")
    manager, client = jupyter.manager.start_new_kernel(kernel_name="python3", cwd=str(tmp_path))
    try:
        def messages(until):
            """Yields the kernel's messages, up to the first for which `until` holds."""
            while True:
                message = client.get_iopub_msg(timeout=60)
                yield message
                if until(message):
                    return
        asked = client.execute("import numpy as np, rastrum as rr\n"
                               "rr.View((np.eye(3), np.array([[0, 1, 2]])), size=(64, 48), background='white')")
        said = list(messages(lambda m: m["msg_type"] == "status" and m["content"]["execution_state"] == "idle" and
                             m["parent_header"].get("msg_id") == asked))
        assert not [m["content"] for m in said if m["msg_type"] == "error"]
        (shown,) = [m["content"]["data"] for m in said if m["msg_type"] == "execute_result"]
        model = shown["application/vnd.jupyter.widget-view+json"]["model_id"]
        assert shown["image/png"]
        (opened,) = [m["content"] for m in said if m["msg_type"] == "comm_open" and m["content"]["comm_id"] == model]
        assert opened["data"]["state"]["width"] == 64 and "export default" in opened["data"]["state"]["_esm"]
        client.shell_channel.send(client.session.msg("comm_msg", {
            "comm_id": model, "data": {"method": "custom", "content": {"turn": [0.1, 0.05]}}}))
        *_, answer = messages(lambda m: m["msg_type"] == "comm_msg" and m["content"]["data"].get("method") == "custom")
        assert set(answer["content"]["data"]["content"]) == {"whole", "ms"}
        picture = decoded(bytes(answer["buffers"][0]))
        assert picture.shape == (24, 32, 4) and len(np.unique(picture[..., :3])) > 5
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)
