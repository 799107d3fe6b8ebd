# SPDX-License-Identifier: BSD-3-Clause
"""Numbers as colours."""

import os
import subprocess

import numpy as np
import pytest

import rastrum as rr

SIZE = (160, 120)


def heat(vertices):
    return vertices[:, 0] * 3 + vertices[:, 1]


def test_a_file_and_arrays_agree(sheet, tmp_path):
    """The program's picture of a PLY with a property, byte for byte."""
    vertices, triangles = sheet
    values = heat(vertices).astype(np.float32)
    file = tmp_path / "heat.ply"
    rows = "".join(f"{x!r} {y!r} {z!r} {v!r}\n" for (x, y, z), v in zip(vertices.tolist(), values.tolist()))
    faces = "".join(f"3 {a} {b} {c}\n" for a, b, c in triangles.tolist())
    file.write_text(f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\n"
                    f"property float z\nproperty float heat\nelement face {len(triangles)}\n"
                    f"property list uchar int vertex_indices\nend_header\n{rows}{faces}")
    program = os.environ.get("RASTRUM_PROGRAM")
    if not program:
        pytest.skip("RASTRUM_PROGRAM does not name the program")
    said = subprocess.run([program, "render", "--look", "plain", file, "--scalars", "heat", "--cmap", "plasma", "--range", "-2,2.5", "--steps", "9",
                           "--shader", "flat", "--size", "160x120", "--hash", "--normals", "face"], capture_output=True, text=True, check=True)
    mapping = rr.ColorMapping("plasma", (-2, 2.5), steps=9)
    mesh = rr.Mesh(vertices, triangles, scalars=values, cmap=mapping)
    picture = rr.render(mesh, size=SIZE, shader="flat")
    assert rr.digest(picture.color) in said.stdout
    loaded = rr.load(file, crease=None, scalars="heat", cmap=mapping)
    assert (rr.render(loaded, size=SIZE, shader="flat").color == picture.color).all()


def test_numbers_of_files_by_name(obj, sheet):
    vertices, triangles = sheet
    options = {"size": SIZE, "outputs": ("color", "scalars")}
    shown = rr.render(rr.load(obj, scalars="z", cmap="plasma", clim=(0, 0.2)), **options)
    assert np.array_equal(shown.scalars, rr.render(rr.Mesh(vertices, triangles, scalars=vertices[:, 2]), **options).scalars,
                          equal_nan=True)
    assert (shown.color != rr.render(obj, **options).color).any()
    # Beside other things, and one range for all that share a mapping.
    shared = rr.ColorMapping("viridis")
    ball = rr.Spheres([[3, 0, 0]], 0.5, scalars=[2.0], cmap=shared)
    both = rr.Scene([ball, obj], scalars="z", cmap=shared)
    alone = rr.Scene([ball, rr.Mesh(vertices, triangles, scalars=vertices[:, 2], cmap=shared)])
    assert np.nanmax(rr.render(both, **options).scalars) == 2
    colors = [rr.render(s, shader="flat", **options).color for s in (both, alone)]
    assert (colors[0] == colors[1]).all()


def test_what_is_wrong_with_names_of_numbers_is_said(obj, sheet):
    with pytest.raises(rr.NotFoundError, match="pressure"):
        rr.load(obj, scalars="pressure")
    with pytest.raises(rr.ArgumentTypeError, match="^scalars"):
        rr.load(obj, scalars=[1, 2])
    with pytest.raises(rr.ArgumentError, match="^scalars: .*files"):
        rr.Scene([sheet], scalars="z")
    with pytest.raises(rr.ArgumentError, match="^clim"):
        rr.load(obj, scalars="z", cmap=rr.ColorMapping(), clim=(0, 1))


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.int8, np.uint8, np.int16, np.uint16, np.int32, np.uint32, np.int64,
                                   np.uint64])
def test_numbers_of_any_type_are_read_in_place(sheet, dtype):
    vertices, triangles = sheet
    wide = np.zeros((len(vertices), 3), dtype)
    wide[:, 1] = np.arange(len(vertices)) % 100
    expected = rr.render(rr.Mesh(vertices, triangles, scalars=wide[:, 1].astype(np.float64)), size=SIZE).color
    mesh = rr.Mesh(vertices, triangles, scalars=wide[:, 1], copy=False)
    assert np.shares_memory(mesh.scalars, wide)
    assert (rr.render(mesh, size=SIZE).color == expected).all()


def test_scalars_of_each_thing(sheet):
    vertices, triangles = sheet
    at = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], np.float32)
    values = [0.0, 1.0, 2.0, 3.0]
    for thing in (rr.Mesh(at, [[0, 1, 2], [1, 3, 2]], scalars=[1, 2]), rr.Mesh(at, [[0, 1, 2], [1, 3, 2]], scalars=values),
                  rr.Points(at, size=20, scalars=values), rr.Lines(at, width=9, scalars=values),
                  rr.Spheres(at, 0.4, scalars=values), rr.Cylinders(at, radius=0.3, scalars=values),
                  rr.Tubes(at, radius=0.3, scalars=values), rr.Discs(at, np.tile([0, 0, 1.0], (4, 1)), 0.4, scalars=values)):
        picture = rr.render(thing, size=SIZE, outputs=("color", "scalars"))
        seen = picture.scalars[np.isfinite(picture.scalars)]
        assert len(seen) > 100 and seen.min() >= 0 and seen.max() <= 3 and seen.max() > seen.min()
        assert len(np.unique(picture.color[picture.color[..., 3] > 0][:, :3], axis=0)) > 1


def test_one_mapping_is_one_range(sheet):
    vertices, triangles = sheet
    mapping = rr.ColorMapping("gray")
    two = [rr.Mesh(vertices, triangles, scalars=0.0, cmap=mapping, transform=np.diag([0.4, 0.4, 0.4, 1])),
           rr.Mesh(vertices + [2, 0, 0], triangles, scalars=1.0, cmap=mapping)]
    color = rr.render(two, size=SIZE, shader="flat").color
    assert {tuple(c) for c in color[color[..., 3] == 255][:, :3]} == {(0, 0, 0), (255, 255, 255)}


def test_pick_has_the_number(sheet):
    vertices, triangles = sheet
    picture = rr.render(rr.Mesh(vertices, triangles, scalars=vertices[:, 0].astype(np.float64)), size=SIZE)
    hit = picture.pick(SIZE[0] // 2, SIZE[1] // 2)
    assert hit.scalar == pytest.approx(hit.position[0], abs=1e-5)
    assert rr.render(rr.Mesh(vertices, triangles), size=SIZE).pick(SIZE[0] // 2, SIZE[1] // 2).scalar is None


def test_maps(sheet):
    vertices, triangles = sheet
    assert {"viridis", "coolwarm", "tab10"} <= set(rr.color_maps())
    values = heat(vertices)

    def draw(cmap, **more):
        return rr.render(rr.Mesh(vertices, triangles, scalars=values, cmap=cmap, **more), size=SIZE, shader="flat").color

    assert (draw(["black", "white"]) == draw(rr.ColorMapping(["#000000", (1.0, 1.0, 1.0)]))).all()
    assert (draw("viridis") != draw("viridis_r")).any()
    assert (draw("gray", clim=(0, 1)) != draw("gray")).any()

    class Like:  # matplotlib's
        N = 256

        def __call__(self, i):
            return (i / 255, i / 255, i / 255, 1.0)
    assert np.abs(draw(Like()).astype(int) - draw(["black", "white"])).max() <= 1
    lined = draw(rr.ColorMapping("viridis", isolines=[0.0, 1.0], isoline_color="red", isoline_width=2))
    assert (lined[..., :3] == (255, 0, 0)).all(-1).sum() > 50
    glass = draw(rr.ColorMapping("viridis", opacity=[(-3, 0.0), (3, 1.0)]))
    assert len(np.unique(glass[..., 3])) > 20


def test_a_bar_is_drawn(sheet):
    vertices, triangles = sheet
    mesh = rr.Mesh(vertices, triangles, scalars=heat(vertices))
    camera = rr.Camera.fit(mesh)
    plain = rr.render(mesh, camera, size=(320, 240)).color
    barred = rr.render(mesh, camera, size=(320, 240), annotate={"bar": {"title": "Heat", "unit": "K"}}).color
    other = np.argwhere((plain != barred).any(-1))
    assert len(other) > 500 and other[:, 1].min() > 160  # at the right
    assert (rr.render(mesh, camera, size=(320, 240), annotate={"bar": "Heat"}).color != barred).any()
    with pytest.raises(rr.ArgumentError, match="bar"):
        rr.render(rr.Mesh(vertices, triangles), size=SIZE, annotate="bar")


@pytest.mark.parametrize("bad", [
    dict(cmap="nomap"), dict(cmap=[]), dict(clim=(1, 0)), dict(clim=(1,)), dict(clim=(float("nan"), 1)), dict(log=True, clim=(-1, 1)),
    dict(steps=-1), dict(categories=[1, 1]), dict(opacity=[(1, 1), (0, 1)]), dict(opacity=[(0, 2)]), dict(isolines=[float("inf")]),
    dict(isolines=[1], isoline_width=-1), dict(nan="nocolour"), dict(below=(2, 0, 0))])
def test_bad_mappings(bad):
    with pytest.raises(rr.Error):
        rr.ColorMapping(**bad)


@pytest.mark.parametrize("bad, says", [
    (dict(cmap="viridi"), "did you mean 'viridis'"), (dict(cmap="coolwarn_r"), "'coolwarm_r'"), (dict(cmap=[]), "^cmap: .*no colours"),
    (dict(cmap=3), "^cmap: must be a name"), (dict(clim=(1, 0)), "^clim: upside down: 1 to 0"), (dict(clim=(0, np.inf)), "^clim: not finite"),
    (dict(clim=(-1e308, 1e308)), "^clim: too wide"), (dict(log=True, clim=(0, 1)), "^clim: must lie above 0"),
    (dict(log=True, symmetric=True), "^log: "), (dict(steps=10**9), "^steps: "), (dict(steps=10**12), "^steps: "), (dict(steps=2.5), "^steps: "),
    (dict(isolines=[1], isoline_width=65), "^isoline_width: ")])
def test_bad_mappings_are_said_of_their_argument(bad, says):
    with pytest.raises(rr.Error, match=says):
        rr.ColorMapping(**bad)


def test_a_logarithm_without_a_range_takes_the_numbers_above_0(sheet):
    """Its range is not known before there are numbers; where there are none above 0, all have the colour of NaN."""
    vertices, triangles = sheet
    mapping = rr.ColorMapping("gray", log=True, nan="red")
    rr.render(rr.Mesh(vertices, triangles, scalars=np.exp(heat(vertices)), cmap=mapping), size=SIZE)
    below = rr.render(rr.Mesh(vertices, triangles, scalars=np.full(len(vertices), -1.0), cmap=mapping), size=SIZE, shader="flat").color
    seen = below[below[..., 3] > 0]
    assert len(seen) > 1000 and (seen == (255, 0, 0, 255)).all()


def test_bad_scalars(sheet):
    vertices, triangles = sheet
    for scalars in (np.zeros(7), np.zeros((len(vertices), 2)), np.array(["a"] * len(vertices)), np.zeros(len(vertices), complex)):
        with pytest.raises(rr.Error, match="scalars"):
            rr.Mesh(vertices, triangles, scalars=scalars)
    with pytest.raises(rr.Error, match="clim"):
        rr.Mesh(vertices, triangles, scalars=heat(vertices), cmap=rr.ColorMapping(), clim=(0, 1))
    with pytest.raises(rr.Error):
        rr.render(rr.Spheres(vertices, 0.1, scalars=[1.0]), size=SIZE)


def test_a_number_of_isolines_lies_at_round_numbers():
    def drawn(isolines):
        scene = rr.Scene("builtin:sphere", scalars="z", cmap=rr.ColorMapping(clim=(-1, 1), isolines=isolines))
        return rr.render(scene, size=(60, 40)).color
    assert (drawn(4) == drawn([-1, -0.5, 0, 0.5, 1])).all() and (drawn(4) != drawn([])).any()
    for bad in (0, -1, 1001, True, 1.5):
        with pytest.raises(rr.ArgumentError, match="isolines"):
            rr.ColorMapping(isolines=bad)


def test_a_bar_shows_the_colour_of_no_number(sheet):
    scene = rr.Scene("builtin:sphere", scalars="z", cmap=rr.ColorMapping(nan="red"))
    plain, more = (rr.render(scene, size=(120, 90), annotate={"bar": {"nan": nan}}).color for nan in (False, True))
    red = (255, 0, 0, 255)
    assert not (plain == red).all(-1).any() and (more == red).all(-1).any()
    with pytest.raises(rr.ArgumentTypeError, match="nan"):
        rr.render(scene, size=(12, 9), annotate={"bar": {"nan": "red"}})
