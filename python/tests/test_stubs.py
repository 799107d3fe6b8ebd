# SPDX-License-Identifier: BSD-3-Clause
"""The stubs agree with the package: the names, and the parameters of each function."""

import ast
import inspect
import pathlib
import subprocess
import sys

import pytest

import rastrum as rr
import rastrum.dataset

STUB = pathlib.Path(__file__).resolve().parents[1] / "rastrum" / "__init__.pyi"
STUBS = {rr: STUB, rr.mpi: STUB.with_name("mpi.pyi"), rr.dataset: STUB.with_name("dataset.pyi")}


def parameters(function):
    a = function.args
    return [p.arg for p in a.posonlyargs + a.args] + ([a.vararg.arg] if a.vararg else []) + [
        p.arg for p in a.kwonlyargs] + ([a.kwarg.arg] if a.kwarg else [])


def actual(function):
    return list(inspect.signature(function).parameters)


@pytest.mark.parametrize("module", STUBS, ids=lambda module: module.__name__)
def test_the_stub_is_the_package(module):
    tree = ast.parse(STUBS[module].read_text(encoding="utf-8"))
    functions = {n.name: n for n in tree.body if isinstance(n, ast.FunctionDef)}
    classes = {n.name: n for n in tree.body if isinstance(n, ast.ClassDef)}
    public = {n for n in module.__all__ if callable(getattr(module, n))}
    assert public == {n for n in (*functions, *classes) if not n.startswith("_")}
    for name, function in functions.items():
        assert parameters(function) == actual(getattr(module, name)), name
    for name, cls in classes.items():
        if name.startswith("_"):
            continue
        said = {getattr(m, "name", getattr(getattr(m, "target", None), "id", None)) for m in cls.body}
        methods = {n for n, v in vars(getattr(module, name)).items() if not n.startswith("_") and v.__doc__ and isinstance(v, (staticmethod, classmethod, type(parameters)))}
        assert methods <= said, f"{name}: {methods - said}"
        for member in cls.body:
            if not isinstance(member, ast.FunctionDef):
                continue
            there = inspect.getattr_static(getattr(module, name), member.name)
            if isinstance(there, property):
                continue
            if isinstance(there, (staticmethod, classmethod)):
                there = there.__func__
            assert parameters(member) == actual(there), f"{name}.{member.name}"


def test_the_stub_has_all_outputs():
    tree = ast.parse(pathlib.Path(rr.__file__).with_name("_outputs.pyi").read_text(encoding="utf-8"))
    (names,) = (ast.literal_eval(n.value.slice) for n in tree.body if isinstance(n, ast.Assign))
    (fields,) = (n.body for n in tree.body if isinstance(n, ast.ClassDef))
    assert list(names) == list(rr.OUTPUTS) == [f.target.id for f in fields[1:]]


@pytest.mark.parametrize("module", STUBS, ids=lambda module: module.__name__)
def test_everything_public_is_documented(module):
    for name in module.__all__:
        if callable(getattr(module, name)):
            assert inspect.getdoc(getattr(module, name)), name


def test_an_import_loads_nothing_that_few_calls_need():
    few = {"dataclasses", "difflib", "hashlib", "pathlib", "subprocess", "tempfile", "trimesh", "PIL"}
    code = ("import sys, numpy; before = set(sys.modules); import rastrum; "
            f"print(*sorted((set(sys.modules) - before) & {few}))")
    asked = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert asked.stdout.split() == []


def test_no_blas_is_on_the_way_to_a_pixel():
    # BLAS adds in an order of its own on each machine. _view.py may use it, since it follows a hand's movements.
    for file in (STUB.parent).rglob("*.py"):
        if file.name != "_view.py":
            for word in (" @ ", "np.matmul", "np.dot", "einsum", "linalg.inv", "linalg.solve"):
                assert word not in "\n".join(line for line in file.read_text(encoding="utf-8").split("\n")
                                             if '"""' not in line), f"{file.name}: {word}"
