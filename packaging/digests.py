# SPDX-License-Identifier: BSD-3-Clause
"""Draws the pictures of digests.txt by the Python package, and prints that table as the package makes it.

usage: digests.py TABLE FOLDER     FOLDER has SHAPE.ply for each SHAPE of the table
"""
import pathlib
import sys

import rastrum

table, folder = map(pathlib.Path, sys.argv[1:])
numbers = {"opacity": float, "samples": int}
for line in table.read_text().splitlines():
    _, shape, *words = line.split()
    look = {name[2:]: numbers.get(name[2:], str)(value) for name, value in zip(words[::2], words[1::2])}
    picture = rastrum.render(rastrum.load(folder / f"{shape}.ply"), size=(320, 240), **look)
    print(f"{rastrum.digest(picture.color)}  {shape} {' '.join(words)}")
