#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Lists golden pictures that failed, writes a page that flickers them, or accepts the new ones.

usage: golden.py [accept [NAME...]]

A golden test compares its picture with tests/golden/NAME.png. If they differ it writes NAME.expected.png,
NAME.actual.png and NAME.diff.png into golden-failures/ of its build folder (without the first if there is no golden
yet). `accept` copies the actual pictures to tests/golden/ and removes the failures. A picture that need not be looked at
is kept as a digest, a line of tests/golden/hashes.txt; its test writes NAME.actual.sha256, which `accept` takes too.
"""
import html
import pathlib
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
GOLDEN = ROOT / "tests" / "golden"
HASHES = GOLDEN / "hashes.txt"
PAGE = ROOT / "build" / "golden.html"
KINDS = ("expected", "actual", "diff")

HEAD = """<!doctype html><meta charset="utf-8"><title>Golden pictures that differ</title>
<style>
body { font: 15px sans-serif; margin: 2em; background: #777; color: #fff }
figure { display: inline-block; margin: 0 1em 2em 0; vertical-align: top }
img { image-rendering: pixelated; max-width: 45vw; min-width: 256px }
.flicker { position: relative } .flicker .over { position: absolute; left: 0; top: 0 }
.flicker .over { animation: flicker 1s steps(1) infinite }
@keyframes flicker { 50% { opacity: 0 } }
</style>
"""


def failures():
    """Returns (build folder's name, golden name, {kind: file}) of every failure, in order."""
    found = {}
    for folder in sorted((ROOT / "build").glob("*/golden-failures")):
        for file in sorted([*folder.rglob("*.png"), *folder.rglob("*.sha256")]):
            name, _, kind = file.relative_to(folder).with_suffix("").as_posix().rpartition(".")
            if name and kind in KINDS:
                found.setdefault((folder.parent.name, name), {})[kind] = file
    return [(build, name, files) for (build, name), files in sorted(found.items())]


def is_hash(files):
    return files.get("actual", pathlib.Path()).suffix == ".sha256"


def accept_hash(name, digest):
    lines = dict(reversed(line.split()) for line in HASHES.read_text().splitlines()) \
        if HASHES.exists() else {}
    lines[name] = digest
    HASHES.write_text("".join(f"{lines[n]}  {n}\n" for n in sorted(lines)))


def figure(caption, *files):
    images = "".join(
        f'<img src="{html.escape(f.as_uri())}"{" class=over" if i else ""}>'
        for i, f in enumerate(files))
    return f"<figure><div class=flicker>{images}</div><figcaption>{caption}</figcaption></figure>"


def write_page(found):
    parts = [HEAD]
    for build, name, files in found:
        parts.append(f"<h2>{html.escape(name)} <small>({html.escape(build)})</small></h2>")
        if is_hash(files):
            parts.append("<p>another digest</p>")
            continue
        if "expected" in files and "actual" in files:
            parts.append(figure("expected ↔ actual", files["expected"], files["actual"]))
        parts += [figure(kind, files[kind]) for kind in KINDS if kind in files]
    PAGE.write_text("\n".join(parts), encoding="utf-8")


def show():
    found = failures()
    if not found:
        print("no golden picture failed (run ./dev test first)")
        return 0
    for build, name, files in found:
        print(f"{name} ({build})")
        for kind in KINDS:
            print(f"  {kind:8} {files.get(kind, 'none')}")
    write_page(found)
    print(f"{len(found)} differ; flicker them: {PAGE}\naccept: ./dev golden accept [NAME...]")
    return 0


def accept(names):
    found = [f for f in failures() if "actual" in f[2] and (not names or f[1] in names)]
    unknown = set(names) - {name for _, name, _ in found}
    if unknown:
        print("no such failure: " + ", ".join(sorted(unknown)), file=sys.stderr)
        return 1
    actual = {}
    for build, name, files in found:
        picture = files["actual"].read_bytes()
        if actual.setdefault(name, (build, picture))[1] != picture:
            print(f"{name}: {actual[name][0]} and {build} drew different pictures; accept neither",
                  file=sys.stderr)
            return 1
    for _, name, files in found:
        target = HASHES if is_hash(files) else GOLDEN / f"{name}.png"
        target.parent.mkdir(parents=True, exist_ok=True)
        if is_hash(files):
            accept_hash(name, files["actual"].read_text().strip())
        else:
            shutil.copyfile(files["actual"], target)
        for file in files.values():
            file.unlink()
        print(f"accepted {target.relative_to(ROOT)}")
    return 0


def main(arguments):
    if not arguments:
        return show()
    if arguments[0] == "accept":
        return accept(arguments[1:])
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
