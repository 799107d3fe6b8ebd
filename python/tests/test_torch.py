# SPDX-License-Identifier: BSD-3-Clause
"""torch beside us: its tensors drawn where they lie, our pictures as tensors, its DataLoader's workers that draw."""

import os
import signal

import numpy as np
import pytest

import rastrum as rr

torch = pytest.importorskip("torch")
SIZE = (64, 48)


def digest(what, camera=None, **frame):
    return rr.digest(rr.render(what, camera, size=SIZE, **frame).color)


@pytest.mark.parametrize("of", [torch.float32, torch.float64])
@pytest.mark.parametrize("index", [torch.int32, torch.int64, torch.uint32])
def test_tensors_are_drawn_where_they_lie(sheet, of, index):
    vertices, triangles = torch.tensor(sheet[0], dtype=of), torch.from_numpy(sheet[1].astype(np.int64)).to(index)
    mesh = rr.Mesh(vertices, triangles, copy=False)
    before = digest(mesh)
    assert before == digest(sheet)
    vertices[:, 0] *= 0.5  # read anew each frame
    narrow = sheet[0] * np.float32([0.5, 1, 1])
    assert digest(mesh, rr.Camera.fit(sheet)) == digest((narrow, sheet[1]), rr.Camera.fit(sheet)) != before


def test_the_mesh_keeps_its_tensors(sheet):
    mesh = rr.Mesh(torch.from_numpy(sheet[0].copy()), torch.from_numpy(sheet[1].astype(np.int64)), copy=False)
    _ = [torch.zeros(len(sheet[0]), 3) for _ in range(50)]  # what was freed would be one of these
    assert digest(mesh) == digest(sheet)


def test_columns_gradients_and_what_cannot_stay(sheet):
    vertices, triangles = torch.from_numpy(sheet[0]), torch.from_numpy(sheet[1].astype(np.int64))
    expected = digest(sheet)
    wide = torch.cat([torch.rand(len(vertices), 2), vertices], 1)
    for good in (wide[:, 2:], vertices.clone().requires_grad_(), torch.nn.Parameter(vertices)):
        assert digest(rr.Mesh(good, triangles, copy=False)) == expected
    with pytest.raises(rr.ArgumentError, match="positions: copy=False, but the numbers of a value lie apart"):
        rr.Mesh(vertices.T.contiguous().T, triangles, copy=False)
    assert digest(rr.Mesh(vertices.T.contiguous().T, triangles)) == expected
    with pytest.raises(rr.ArgumentError, match="float16"):
        rr.Mesh(vertices.half(), triangles, copy=False)
    # These two are in this process's memory already, so the message must not say .cpu().
    with pytest.raises(rr.ArgumentTypeError, match=r"positions: NumPy cannot take this array.*\.float\(\)"):
        rr.Mesh(vertices.bfloat16(), triangles)
    with pytest.raises(rr.ArgumentTypeError, match=r"positions: NumPy cannot take this array.*\.to_dense\(\)"):
        rr.Mesh(vertices.to_sparse(), triangles)
    with pytest.raises(rr.ArgumentTypeError, match=r"positions: is not in this process's memory.*\.cpu\(\)"):
        rr.Mesh(vertices.to("meta"), triangles)


def test_attributes(sheet):
    vertices, triangles = torch.from_numpy(sheet[0]), torch.from_numpy(sheet[1].astype(np.int64))
    colors = (torch.rand(len(vertices), 3) * 255).to(torch.uint8)
    assert (digest(rr.Mesh(vertices, triangles, colors=colors, copy=False)) ==
            digest(rr.Mesh(*sheet, colors=colors.numpy())))
    heights = vertices.clone().requires_grad_()[:, 2]
    assert digest(rr.Mesh(vertices, triangles, scalars=heights, copy=False)) == digest(rr.Mesh(*sheet, scalars=sheet[0][:, 2]))


@pytest.mark.parametrize("gradient", [False, True])
def test_cameras_and_lights_of_tensors(sheet, gradient):
    def tensor(values):
        return torch.tensor(values, dtype=torch.float64, requires_grad=gradient)

    k, turn, move = [[60.0, 0, 32], [0, 60, 24], [0, 0, 1]], [[1.0, 0, 0], [0, -1, 0], [0, 0, -1]], [0.1, 0.2, 4.0]
    assert (digest(sheet, rr.Camera.opencv(tensor(k), tensor(turn), tensor(move))) ==
            digest(sheet, rr.Camera.opencv(k, turn, move)))
    clip = np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1.02, 3.8], [0, 0, -1, 4]])
    assert digest(sheet, tensor(clip.tolist())) == digest(sheet, clip)
    both = [clip.tolist(), (clip * [[0.5], [0.5], [1], [1]]).tolist()]
    assert digest(sheet, tensor(both)) == digest(sheet, np.array(both))
    shift = [[1.0, 0, 0, 0.25], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    assert digest(rr.Mesh(*sheet, transform=tensor(shift)), clip) == digest(rr.Mesh(*sheet, transform=shift), clip)
    lit = dict(shader="lambert", lights=[rr.Light.directional(tensor([0.2, -1.0, -0.5]))])
    assert digest(sheet, **lit) == digest(sheet, shader="lambert", lights=[rr.Light.directional([0.2, -1.0, -0.5])])


def test_a_camera_keeps_its_intrinsics(sheet):
    k = np.array([[60.0, 0, 32], [0, 60, 24], [0, 0, 1]])
    camera = rr.Camera.opencv(k, np.diag([1.0, -1, -1]), (0, 0, 4))
    expected = digest(sheet, rr.Camera.opencv(k.copy(), np.diag([1.0, -1, -1]), (0, 0, 4)))
    k[0, 0] = k[1, 1] = 20  # before it has drawn anything
    assert digest(sheet, camera) == expected


def test_pictures_are_tensors(sheet):
    cameras = rr.orbit(sheet, 3)
    pictures = rr.render(sheet, cameras, size=(320, 240), outputs=("color", "depth", "id", "normal"))
    color, depth = torch.from_numpy(pictures.color), torch.from_dlpack(pictures.depth)
    assert color.shape == (3, 240, 320, 4) and color.dtype == torch.uint8 and depth.shape == (3, 240, 320)
    assert color.data_ptr() == pictures.color.ctypes.data and depth.data_ptr() == pictures.depth.ctypes.data
    assert torch.as_tensor(pictures.id).dtype == torch.int32 and torch.as_tensor(pictures.normal).shape[-1] == 3
    # The memory of pictures is taken again where nobody has them: a tensor does.
    kept, then = (color.clone(), depth.clone()), pictures
    del pictures, then
    for _ in range(5):
        rr.render(sheet, cameras, size=(320, 240), outputs=("color", "depth", "id", "normal"), background="red")
    assert torch.equal(color, kept[0]) and torch.equal(depth, kept[1])
    # And into memory of torch's.
    own = torch.zeros(3, 240, 320)
    rr.render(sheet, cameras, size=(320, 240), out={"depth": own.numpy()})
    assert torch.equal(own, depth)


class Drawn(torch.utils.data.Dataset):
    """The sheet from `count` sides."""

    def __init__(self, sheet, count, killed=None):
        self.sheet, self.count, self.killed = sheet, count, killed

    def __len__(self):
        return self.count

    def __getitem__(self, i):
        if i == self.killed:
            os.kill(os.getpid(), signal.SIGKILL)
        picture = rr.render(self.sheet, rr.orbit(self.sheet, self.count)[i], size=SIZE, outputs=("color", "depth"), threads=2)
        return torch.from_numpy(picture.color), picture.depth


def loaded(data, **how):
    batches = list(torch.utils.data.DataLoader(data, batch_size=2, timeout=120 if how.get("num_workers") else 0, **how))
    return rr.digest(torch.cat([b[0] for b in batches]).numpy()), rr.digest(torch.cat([b[1] for b in batches]).numpy())


@pytest.mark.parametrize("context", ["fork", "spawn"])
def test_workers_draw(sheet, context):
    data = Drawn(sheet, 6)
    expected = loaded(data)  # this process has threads by now
    assert loaded(data, num_workers=2, multiprocessing_context=context) == expected
    assert loaded(data) == expected


def test_a_killed_worker_takes_nothing_with_it(sheet):
    expected = loaded(Drawn(sheet, 6))
    with pytest.raises(RuntimeError, match="killed|exited"):
        loaded(Drawn(sheet, 6, killed=3), num_workers=2, multiprocessing_context="fork")
    assert loaded(Drawn(sheet, 6)) == expected
    assert loaded(Drawn(sheet, 6), num_workers=1, multiprocessing_context="fork") == expected


def test_an_environment_with_a_gradient():
    around = torch.rand(8, 16, 3, requires_grad=True)
    ball = rr.Spheres(np.zeros((1, 3)))
    lit = [digest(ball, shader="lambert", lights=rr.Light.environment(e)) for e in (around, around.detach().numpy())]
    assert lit[0] == lit[1]
