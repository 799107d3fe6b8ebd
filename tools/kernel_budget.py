#!/usr/bin/env python3
"""What each kernel of ours takes of a GPU, held to what it took when that was last written down.

usage: kernel_budget.py check|record ROOT

Compiles the library of device code to PTX and from there for the H100 (sm_90): a minute or more a
source, and needs nvcc, not a GPU. `record` writes tests/cuda/kernels.txt: registers, bytes of stack,
of spills, of code a kernel. `check` fails, and names the kernel, where one takes more registers or
stack, spills more, has a tenth more code than that, or is new; and where PTX has an instruction that
would round as the processor likes (fma, .approx, .ftz).
"""
import pathlib
import re
import subprocess
import sys
import tempfile

RECORD = pathlib.Path("tests/cuda/kernels.txt")
FLAGS = ["-std=c++20", "-O3", "-DNDEBUG", "--fmad=false", "--expt-relaxed-constexpr",
         "-Xcompiler=-ffp-contract=off", "-DRASTRUM_CUDA_LIBRARY_VERSION=\"budget\""]
ROUNDS_FREELY = re.compile(r"^\s*(?:@%?!?\w+\s+)?((?:fma\.\w+\.f\w+|mad\.\w+\.f\w+|\S*\.approx\S*|\S*\.ftz\S*))\s",
                           re.MULTILINE)
OURS = re.compile(r"\b(index_kernel|team_kernel)<")
ENTRY = re.compile(r"Compiling entry function '(\w+)'")
USED = re.compile(r"Used (\d+) registers")
STACK = re.compile(r"(\d+) bytes stack frame, (\d+) bytes spill stores")


def run(command):
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}\n{result.stdout}{result.stderr}")
    return result.stdout + result.stderr


def short(name):
    """Without what every kernel's name has; types of the project alone."""
    name = re.sub(r"\(anonymous namespace\)::|<unnamed>::", "", name)
    name = re.sub(r"\b(?:rastrum|parallel|raster|terrain|family|transparency|cuda_detail|cuda_system|on_gpu)::", "", name)
    name = re.sub(r"^void\s+", "", name)
    depth = 0
    for at, letter in enumerate(name):  # the parameters, which repeat the template's arguments
        depth += {"<": 1, ">": -1}.get(letter, 0)
        if letter == "(" and depth == 0:
            name = name[:at]
            break
    return re.sub(r"\s+", " ", name)


def kernels_of(root, source, folder):
    """{name: (registers, stack, spills, code)} of one source, and the instructions that it may not have."""
    ptx, cubin = folder / "k.ptx", folder / "k.cubin"
    run(["nvcc", "-ptx", "-arch=compute_90", *FLAGS, "-I", root, source, "-o", ptx])
    free = sorted(set(ROUNDS_FREELY.findall(ptx.read_text(encoding="utf-8"))))
    log = run(["ptxas", "-arch=sm_90", "-v", ptx, "-o", cubin])
    sizes = {}
    for line in run(["readelf", "-S", "-W", cubin]).splitlines():
        words = line.replace("[ ", "[").split()
        if len(words) > 5 and words[1].startswith(".text."):
            sizes[words[1][len(".text."):]] = int(words[5], 16)
    found, entry, stack = {}, "", (0, 0)
    for line in log.splitlines():
        if match := ENTRY.search(line):
            entry = match[1]
        elif match := STACK.search(line):
            stack = (int(match[1]), int(match[2]))
        elif match := USED.search(line):
            found[entry] = (int(match[1]), *stack, sizes.get(entry, 0))
    names = run(["c++filt", *found]).splitlines()
    ours = {}
    for name, figures in zip(names, found.values()):
        if not OURS.search(name):
            continue
        before = ours.get(short(name), figures)
        ours[short(name)] = tuple(map(max, before, figures))
    return ours, free


def main(arguments):
    if len(arguments) != 2 or arguments[0] not in ("check", "record"):
        print(__doc__.split("\n\n")[1], file=sys.stderr)
        return 2
    root = pathlib.Path(arguments[1])
    now, wrong = {}, []
    for source in sorted((root / "rastrum").rglob("*.cu")):
        with tempfile.TemporaryDirectory() as folder:
            ours, free = kernels_of(root, source, pathlib.Path(folder))
        where = source.relative_to(root)
        wrong += [f"{where}: PTX has {instruction}" for instruction in free]
        now.update({f"{where.stem}: {name}": figures for name, figures in ours.items()})
    text = ["# registers, bytes of stack, of spills, of code on sm_90; written by tools/kernel_budget.py record"]
    text += [f"{' '.join(map(str, figures))}\t{name}" for name, figures in sorted(now.items())]
    if arguments[0] == "record":
        (root / RECORD).write_text("\n".join(text) + "\n", encoding="utf-8")
    else:
        known = {}
        for line in (root / RECORD).read_text(encoding="utf-8").splitlines()[1:]:
            figures, name = line.split("\t")
            known[name] = tuple(map(int, figures.split()))
        for name, figures in now.items():
            allowed = known.get(name)
            if allowed is None:
                wrong.append(f"{name}: is not in {RECORD}")
                continue
            for what, has, may in zip(("registers", "bytes of stack", "bytes of spills"), figures, allowed):
                if has > may:
                    wrong.append(f"{name}: {has} {what}, {may} before")
            if figures[3] > allowed[3] * 1.1:
                wrong.append(f"{name}: {figures[3]} bytes of code, {allowed[3]} before")
    for line in wrong:
        print(line)
    print(f"{len(now)} kernels")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
