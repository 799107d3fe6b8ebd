#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the cells of a notebook in this process, one after the other, without Jupyter.

usage: notebook.py run FILE    stores their output in FILE
       notebook.py check FILE  exits with 1 if their output differs from FILE's

`check` allows other numbers and digests, and one differing pixel in 200: cells use sines from NumPy, whose last bits
depend on the processor. The value of a cell's last line is shown as PNG if it has one (_repr_png_), else as text. Needs
Pillow.
"""
import ast
import base64
import contextlib
import io
import json
import pathlib
import re
import sys


def run_cell(source, names):
    """Runs a cell by statements, as Jupyter does. Returns (printed text, value of the last line)."""
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        exec(compile(tree, "cell", "exec"), names)
        value = None if last is None else eval(compile(ast.Expression(last.value), "cell", "eval"), names)
    return said.getvalue(), value


def outputs_of(source, names, number):
    said, value = run_cell(source, names)
    outputs = []
    if said:
        outputs.append({"name": "stdout", "output_type": "stream", "text": said.splitlines(True)})
    if value is not None:
        shown = getattr(value, "_repr_png_", lambda: None)()
        data = {"text/plain": [repr(value)]} if shown is None else {"image/png": base64.b64encode(shown).decode() + "\n"}
        outputs.append({"data": data, "execution_count": number, "metadata": {}, "output_type": "execute_result"})
    return outputs


def pixels(png):
    import numpy as np
    from PIL import Image
    with Image.open(io.BytesIO(base64.b64decode(png))) as image:
        return np.asarray(image.convert("RGBA")).astype(int)


def alike(a, b):
    p, q = pixels(a), pixels(b)
    return p.shape == q.shape and (abs(p - q).max(-1) > 8).mean() < 1 / 200


def without_numbers(output):
    return re.sub(r"[0-9a-f]{16}|-?\d+(\.\d*)?", "#", json.dumps(output, sort_keys=True))


def same(a, b):
    if len(a) != len(b):
        return False
    for x, y in zip(a, b):
        p, q = (o.get("data", {}).get("image/png") for o in (x, y))
        if (p is None) != (q is None) or not (alike(p, q) if p else without_numbers(x) == without_numbers(y)):
            return False
    return True


def main(arguments):
    if len(arguments) != 2 or arguments[0] not in ("run", "check"):
        print(__doc__, file=sys.stderr)
        return 2
    path = pathlib.Path(arguments[1])
    notebook = json.loads(path.read_text(encoding="utf-8"))
    names, number, wrong = {"__name__": "__main__"}, 0, 0
    for cell in notebook["cells"]:
        if cell["cell_type"] != "code":
            continue
        number += 1
        outputs = outputs_of("".join(cell["source"]), names, number)
        if arguments[0] == "check" and not same(outputs, cell["outputs"]):
            wrong += 1
            print(f"{path}: cell {number} does not show what is stored; look at it, then {sys.argv[0]} run {path}", file=sys.stderr)
        cell["outputs"], cell["execution_count"] = outputs, number
    if arguments[0] == "run":
        path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
