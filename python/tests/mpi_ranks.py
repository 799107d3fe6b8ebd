# SPDX-License-Identifier: BSD-3-Clause
"""The program that test_mpi.py starts on ranks of MPI, by mpirun."""

import os
import signal
import sys
import time

import numpy as np
from mpi4py import MPI

import rastrum as rr
from test_mpi import CAMERA, FRAMES, SIZE, sheet, things

comm = MPI.COMM_WORLD
own = list(range(comm.rank, 5, comm.size))
all_of_them = things()
mine = [all_of_them[i] for i in own]


def pictures():
    for name, frame in FRAMES.items():
        if name == "lit" and comm.size != 3:
            continue
        frame = {"camera": CAMERA, "size": SIZE, **frame}
        picture = rr.mpi.render(comm, mine, parts=own, root=comm.size - 1, **frame)
        if picture is None:
            continue
        one = rr.render(things(), **frame)
        for output, array in one.arrays.items():
            assert array.tobytes() == picture.arrays[output].tobytes(), (name, output)
    # Ranks that are kept, of a part of all, in another order, with a timeout.
    half = comm.Split(comm.rank % 2, -comm.rank)
    with rr.mpi.Ranks(half, timeout=60) as ranks:
        for _ in range(2):
            picture = rr.mpi.render(ranks, sheet(half.rank), size=SIZE)
    if picture is not None:
        assert np.array_equal(picture.color, rr.render([sheet(r) for r in range(half.size)], size=SIZE).color)
    for r in range(comm.size):
        try:
            rr.mpi.render(comm, (np.zeros((3, 3)), [[0, 1, 9]]) if comm.rank == r else mine, CAMERA, size=SIZE)
            raise AssertionError("not refused")
        except rr.ArgumentError as e:
            assert str(e).startswith(f"rank {r}: "), e
    comm.Barrier()
    if comm.rank == 0:
        print("equal")


def interrupt():
    # To one rank, in the middle of a frame.
    class Sends(rr.mpi.Ranks):
        def begin_phase(self, name):
            if name == "shade" and self.rank == 1:
                os.kill(os.getpid(), signal.SIGINT)
    try:
        with Sends(comm) as ranks:
            rr.mpi.render(ranks, mine, size=SIZE)
            print(f"rank {comm.rank}: not interrupted", flush=True)
    except KeyboardInterrupt as e:
        print(f"rank {comm.rank}: KeyboardInterrupt: {e}", flush=True)


def die():
    if comm.rank == 1:
        os.kill(os.getpid(), signal.SIGKILL)
    rr.mpi.render(comm, mine, size=SIZE)
    print("drawn")


def hang():
    if comm.rank == 1:
        time.sleep(60)
    rr.mpi.render(comm, mine, size=SIZE, timeout=1)
    print("drawn")


globals()[sys.argv[1]]()
