# SPDX-License-Identifier: BSD-3-Clause
"""Draws many views of a scene by the processes of a Dask cluster: colours, depth and ids, as one .npz for each view.

    python3 views_by_dask.py mesh.ply out --views 1000 --size 256
    python3 views_by_dask.py mesh.ply out --scheduler tcp://head:8786      # a cluster that runs already

Needs `distributed` (PyPI) beside rastrum. The scene goes to each worker once. While another worker has the scene, one may die:
Dask draws its views again elsewhere, with the same bytes. digests.txt has a line for each view, the same for any number of workers.
"""

import argparse
import pathlib

import numpy as np

import rastrum as rr

OUTPUTS = ("color", "depth", "instance")


def draw(number, camera, scene, size, folder):
    """Draws a view into folder/NUMBER.npz; returns the digests of its outputs. Workers call it."""
    picture = rr.render(scene, camera, size=(size, size), outputs=OUTPUTS, threads=1)
    np.savez_compressed(pathlib.Path(folder) / f"{number:06d}.npz", **picture.arrays)
    return [rr.digest(picture.arrays[name]) for name in OUTPUTS]


def draw_all(client, scene, cameras, size, folder):
    """Returns the digests of all views."""
    there = client.scatter(scene, broadcast=True)
    return client.gather(client.map(draw, range(len(cameras)), cameras, scene=there, size=size, folder=str(folder), pure=False))


def main():
    from distributed import Client, LocalCluster
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--views", type=int, default=1000)
    parser.add_argument("--size", type=int, default=256, help="pixels across (256)")
    parser.add_argument("--workers", type=int, default=None, help="processes here (one for each core)")
    parser.add_argument("--scheduler", help="the address of a running cluster, which sees the same folders")
    o = parser.parse_args()
    scene = rr.load(o.mesh)
    cameras = rr.orbit(scene, o.views)
    o.folder.mkdir(parents=True, exist_ok=True)
    folder = o.folder.resolve()
    address = o.scheduler or LocalCluster(n_workers=o.workers, threads_per_worker=1, dashboard_address=None)
    with Client(address) as client:
        digests = draw_all(client, scene, cameras, o.size, folder)
    (folder / "digests.txt").write_text("".join(" ".join((f"{i:06d}", *row)) + "\n" for i, row in enumerate(digests)))
    print(f"{len(digests)} views: {folder}")


if __name__ == "__main__":
    main()
