#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the GPU resources of each of our kernels with the recorded ones.

usage: kernel_budget.py check|record [all] ROOT

Compiles every .cu file to PTX, and the files of the library of device code on to machine code of the H100 (sm_90). This
takes a minute or more a file and needs nvcc, not a GPU. A file whose text and headers equal the record's, without
comments, is only compiled if `all` is given. Results are cached in build/budget. RASTRUM_JOBS files are compiled at
once.

`record` writes tests/cuda/kernels.txt: for each kernel registers, bytes of stack, of spills and of code. `check` fails,
and names the kernel, if one is new, needs more registers or stack, spills more, or has a tenth more code. Both print
all differences. Both fail if PTX has a float instruction whose rounding is not fixed: fma, mad, .approx, .ftz.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import cuda_sources

RECORD = pathlib.Path("tests/cuda/kernels.txt")
CACHE = pathlib.Path("build/budget")
FORMAT = "1"  # changes with `compiled`, so that older results are not used
LIBRARIES = ("rastrum", "papers")  # folders whose kernels are counted; other kernels belong to tests and
                                   # benchmarks
FLAGS = re.compile(r"set\(cuda_flags\s+([^)]*)\)")
FIGURES = ("registers", "bytes of stack", "bytes of spills", "bytes of code")
# A PTX instruction with its types, after an optional predicate. It is not a name or a directive.
INSTRUCTION = re.compile(r"^\s*(?:@!?%\w+\s+)?([a-z]\w*(?:\.\w+)+)\s", re.MULTILINE)
OURS = re.compile(r"\bcuda_system::(?:on_gpu::)?(\w+_kernel)<")
ENTRY = re.compile(r"Compiling entry function '(\w+)'")
USED = re.compile(r"Used (\d+) registers")
STACK = re.compile(r"(\d+) bytes stack frame, (\d+) bytes spill stores")


def run(command):
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}\n{result.stdout}{result.stderr}")
    return result.stdout + result.stderr


def rounds_freely(instruction):
    """Returns whether the processor may round it in more than one way: a fused operation, an estimate, or flushed
    denormals. Integers' mad is exact, and so are other instructions with .rn."""
    name, *parts = instruction.split(".")
    floats = any(re.fullmatch(r"f(16|32|64)(x2)?|bf16(x2)?", part) for part in parts)
    return (name in ("fma", "mad") and floats) or "approx" in parts or "ftz" in parts


def instructions_of(ptx):
    """Returns the number of float instructions, and those with free rounding with their numbers."""
    floats, free = 0, {}
    for instruction in INSTRUCTION.findall(ptx):
        floats += bool(re.search(r"\.f(32|64)\b", instruction))
        if rounds_freely(instruction):
            free[instruction] = free.get(instruction, 0) + 1
    return floats, free


def short(name):
    """Shortens a kernel's name: drops what all names have, and other than the project's types."""
    name = re.sub(r"\(anonymous namespace\)::|<unnamed>::", "", name)
    name = re.sub(r"\b(?:rastrum|parallel|raster|terrain|family|transparency|cuda_detail|cuda_system|on_gpu)::", "", name)
    name = re.sub(r"^void\s+|, 18446744073709551615ul(?=>)", "", name)  # the latter is in every span
    depth = 0
    for at, letter in enumerate(name):  # the parameters, which repeat the template's arguments
        depth += {"<": 1, ">": -1}.get(letter, 0)
        if letter == "(" and depth == 0:
            name = name[:at]
            break
    return re.sub(r"\s+", " ", name)


def code_bytes(cubin):
    """Returns {mangled name: bytes of machine code}."""
    sizes = {}
    for line in run(["readelf", "-S", "-W", cubin]).splitlines():
        words = line.replace("[ ", "[").split()
        if len(words) > 5 and words[1].startswith(".text."):
            sizes[words[1][len(".text."):]] = int(words[5], 16)
    return sizes


def kernels_of(log, sizes):
    """Returns {short name: figures} of our kernels in ptxas's log. Equal names have the largest figures."""
    found, entry, stack = {}, "", (0, 0)
    for line in log.splitlines():
        if match := ENTRY.search(line):
            entry, stack = match[1], (0, 0)
        elif match := STACK.search(line):
            stack = (int(match[1]), int(match[2]))
        elif match := USED.search(line):
            found[entry] = (int(match[1]), *stack, sizes.get(entry, 0))
    names = run(["c++filt", *found]).splitlines() if found else []
    ours = {}
    for name, figures in zip(names, found.values()):
        if OURS.search(name):
            key = short(name)
            ours[key] = [max(a, b) for a, b in zip(ours.get(key, figures), figures)]
    return ours


def compiled(root, source, flags):
    """Compiles a source and returns its figures."""
    with tempfile.TemporaryDirectory() as folder:
        ptx, cubin = pathlib.Path(folder) / "k.ptx", pathlib.Path(folder) / "k.cubin"
        run(["nvcc", "-ptx", "-arch=compute_90", *flags, "-I", root, "-I", root / "include", "-I", root / "papers/include", source, "-o", ptx])
        floats, free = instructions_of(ptx.read_text(encoding="utf-8"))
        kernels = {}
        if source.relative_to(root).parts[0] in LIBRARIES:
            log = run(["ptxas", "-arch=sm_90", "-v", ptx, "-o", cubin])
            kernels = kernels_of(log, code_bytes(cubin))
    return {"floats": floats, "free": free, "kernels": kernels}


def of_source(root, source, flags, digest):
    """The same, from build/budget if it was compiled before."""
    kept = root / CACHE / f"{digest}.json"
    if kept.is_file():
        return json.loads(kept.read_text(encoding="utf-8"))
    result = compiled(root, source, flags)
    kept.parent.mkdir(parents=True, exist_ok=True)
    kept.write_text(json.dumps(result), encoding="utf-8")
    return result


class Record:
    """tests/cuda/kernels.txt: a digest per source, and figures per 'source: kernel'."""

    def __init__(self, file):
        self.digests, self.kernels = {}, {}
        for line in file.read_text(encoding="utf-8").splitlines() if file.is_file() else []:
            if line.startswith("## "):
                source, digest = line[3:].split()
                self.digests[source] = digest
            elif not line.startswith("#"):
                figures, name = line.split("\t")
                self.kernels[name] = [int(figure) for figure in figures.split()]

    def text(self):
        lines = ["# Written by tools/kernel_budget.py record, with nvcc for sm_90: a line with ## for each",
                 "# source and what it was, then registers, bytes of stack, of spills, of code a kernel."]
        for source, digest in sorted(self.digests.items()):
            lines.append(f"## {source} {digest}")
            lines += [f"{' '.join(map(str, figures))}\t{name}" for name, figures in sorted(self.kernels.items())
                      if name.startswith(f"{source}: ")]
        return "\n".join(lines) + "\n"


def differences(before, now):
    """Returns (lines of what is worse, lines of what is better or gone)."""
    worse, other = [], []
    for name, figures in sorted(now.items()):
        known = before.get(name)
        if known is None:
            worse.append(f"{name}: is new, {', '.join(f'{n} {what}' for n, what in zip(figures, FIGURES))}")
            continue
        changes = [f"{may} → {has} {what}" for has, may, what in zip(figures, known, FIGURES) if has != may]
        grown = any(has > may for has, may in zip(figures[:3], known)) or figures[3] > known[3] * 1.1
        if changes:
            (worse if grown else other).append(f"{name}: {', '.join(changes)}")
    other += [f"{name}: is gone" for name in sorted(before.keys() - now.keys())]
    return worse, other


def compare(root, command, everything):
    record = Record(root / RECORD)
    text = (root / cuda_sources.BUILD[0]).read_text(encoding="utf-8")
    flags = ["-std=c++20", "-O3", "-DNDEBUG",
             *(flag for flag in FLAGS.search(text)[1].split() if not flag.startswith("-Werror"))]
    how = " ".join([FORMAT, *flags]) + run(["nvcc", "--version"])
    digests, todo = {}, []
    for source in cuda_sources.device_files(root):
        where = str(source.relative_to(root))
        files = cuda_sources.digest(root, cuda_sources.closure(root, [source]))
        digests[where] = hashlib.sha256((how + files).encode()).hexdigest()[:16]
        if everything or record.digests.get(where) != digests[where]:
            todo.append(source)
    jobs = int(os.environ.get("RASTRUM_JOBS", os.cpu_count() or 1))
    print(f"{len(digests) - len(todo)} of {len(digests)} files are as they were recorded", flush=True)
    changed, free = {}, []
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        results = {str(source.relative_to(root)): pool.submit(
            of_source, root, source, flags, digests[str(source.relative_to(root))]) for source in todo}
        for where, future in results.items():
            result = future.result()
            changed.update({f"{where}: {name}": figures for name, figures in result["kernels"].items()})
            free += [f"{where}: PTX has {count} × {name}" for name, count in result["free"].items()]
            print(f"{where}: {len(result['kernels'])} kernels of ours, "
                  f"{result['floats']} instructions of floats", flush=True)
    now = {name: figures for name, figures in record.kernels.items()
           if name.split(": ")[0] in digests and name.split(": ")[0] not in results}
    now.update(changed)
    worse, other = differences(record.kernels, now)
    for line in free + worse + other:
        print(line)
    print(f"{len(now)} kernels: {len(worse)} new or larger, {len(other)} smaller or gone; "
          f"{len(free)} kinds of instructions that round freely")
    if command == "check":
        return 1 if free or worse else 0
    if free:
        print(f"{RECORD} is not written")
        return 1
    record.digests, record.kernels = digests, now
    (root / RECORD).write_text(record.text(), encoding="utf-8")
    return 0


def main(arguments):
    everything = arguments[1:2] == ["all"]
    if len(arguments) != 2 + everything or arguments[0] not in ("check", "record"):
        print(__doc__.split("\n\n")[1], file=sys.stderr)
        return 2
    return compare(pathlib.Path(arguments[-1]).resolve(), arguments[0], everything)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
