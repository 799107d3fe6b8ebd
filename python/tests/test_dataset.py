# SPDX-License-Identifier: BSD-3-Clause
"""Ground truth for data sets."""

import json

import numpy as np
import pytest

import rastrum as rr
from rastrum import dataset

K = np.array([[80, 0, 31.5], [0, 80, 23.5], [0, 0, 1]])


def square(x, z, **look):
    return rr.Mesh([(x - 0.5, -0.5, z), (x + 0.5, -0.5, z), (x + 0.5, 0.5, z), (x - 0.5, 0.5, z)], [[0, 1, 2, 3]], **look)


def two():
    """One in front of another, half beside it, in OpenCV's axes."""
    return [square(0, 4), square(0.5, 5, id=9), square(30, 5)]


def test_masks_and_visibility():
    seen = dataset.objects(two(), rr.Camera.opencv(K), size=(64, 48))
    assert list(seen) == [0, 2, 9]
    front, back = seen[0], seen[9]
    assert front.visibility == 1 and (front.visible == front.mask).all()
    assert back.mask.sum() == 16 * 16 and (back.visible == back.mask & ~front.mask).all()
    assert back.visibility == back.visible.sum() / 256
    assert 0 < back.visibility < 1
    assert seen[2].visibility == 0 and not seen[2].mask.any()


def test_things_of_one_id_are_one_object():
    seen = dataset.objects([square(-1, 4, id=3), square(1, 4, id=3), square(0, 9, id=1, visible=False)], rr.Camera.opencv(K), size=(64, 48))
    assert list(seen) == [3] and seen[3].mask.sum() == 2 * 20 * 20


def test_parts_of_files_are_refused(obj):
    with pytest.raises(rr.UnsupportedError, match="sheet.obj cannot be drawn alone"):
        dataset.objects(obj)


def test_millimetres():
    depth = np.array([[0, 0.0004, 0.0006, 1.2344], [65.535, 70, np.inf, np.nan]], np.float32)
    with pytest.warns(rr.OddInputWarning, match="1 pixels lie beyond 65.535 m"):
        assert dataset.millimetres(depth).tolist() == [[0, 0, 1, 1234], [65535, 0, 0, 0]]
    assert dataset.millimetres(depth[:, :1], unit=0.01).tolist() == [[0], [655]]
    with pytest.raises(rr.ArgumentError, match="depth: must be"):
        dataset.millimetres(np.zeros((2, 2), int))


@pytest.mark.parametrize("rows", [["0110", "0100"], ["1111", "1111"], ["0000", "0000"], ["1000", "0001"]])
def test_run_lengths(rows):
    mask = np.array([[c == "1" for c in row] for row in rows])
    made = dataset.run_lengths(mask)
    assert made["size"] == [2, 4] and sum(made["counts"]) == 8
    flat = np.repeat(np.arange(len(made["counts"])) % 2, made["counts"])
    assert (flat.reshape(4, 2).T == mask).all()


def test_run_lengths_are_those_of_pycocotools():
    coco = pytest.importorskip("pycocotools.mask")
    mask = np.random.default_rng(1).random((37, 53)) < 0.3
    assert (coco.decode(coco.frPyObjects(dataset.run_lengths(mask), 37, 53)) == mask).all()


def test_a_folder_of_bop(tmp_path):
    image = pytest.importorskip("PIL.Image")
    things, pose = two(), np.eye(4)
    camera = rr.Camera.opencv(K)
    picture = rr.render(things, camera, size=(64, 48), outputs=("color", "depth"))
    seen = dataset.objects(things, camera, size=(64, 48))
    away = np.diag([1.0, 1, 1, 1])
    away[2, 3] = 4
    with dataset.BopScene(tmp_path / "000001") as scene:
        for _ in range(2):
            scene.add(picture.color, picture.depth, K, pose, iter([(5, away, seen[0]), (6, away, seen[9]), (7, away, seen[2])]))
    folder = tmp_path / "000001"
    about = json.loads((folder / "scene_gt_info.json").read_text())["1"]
    assert [o["px_count_all"] for o in about] == [400, 256, 0]
    assert about[1]["px_count_visib"] == about[1]["px_count_valid"] - (seen[9].mask & seen[0].mask).sum()
    assert about[0]["bbox_obj"] == [22, 14, 20, 20] and about[2]["bbox_obj"] == [-1] * 4
    truth = json.loads((folder / "scene_gt.json").read_text())["0"]
    assert truth[0] == {"cam_R_m2c": np.eye(3).ravel().tolist(), "cam_t_m2c": [0, 0, 4000], "obj_id": 5}
    assert json.loads((folder / "scene_camera.json").read_text())["0"]["cam_K"] == K.ravel().tolist()
    depth = np.asarray(image.open(folder / "depth" / "000001.png"))
    assert depth.max() == 5000 and (depth == dataset.millimetres(picture.depth)).all()
    mask = np.asarray(image.open(folder / "mask_visib" / "000000_000001.png"))
    assert ((mask == 255) == seen[9].visible).all()
    with pytest.raises(rr.ArgumentError, match="is not empty"):
        dataset.BopScene(folder)
    with pytest.raises(rr.ArgumentError, match=r"depth: is \(1, 64\), and the picture is \(48, 64\)"):
        dataset.BopScene(tmp_path / "3").add(picture.color, picture.depth[:1], K, pose, [])
    with pytest.raises(rr.ArgumentError, match="rotation must not scale"):
        dataset.BopScene(tmp_path / "2").add(picture.color, picture.depth, K, 2 * np.diag([1, 1, 1, 0.5]), [])
