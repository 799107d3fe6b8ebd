#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Breaks rows of the coverage × visibility table on purpose and checks that only their tests fail.

usage: break_rows.py [--list] [NAME...]

A break replaces one text of one source file and builds table_test and the tests of the broken axis.
The rows whose tests fail must be those that it should break. Code that rows share is broken too, to
show which rows it reaches. Without names all breaks run: half an hour on two busy cores, less with
a warm ccache.

Works on HEAD in a Git worktree of its own, build/break-rows, which is removed at the end and after
^C; the caller's sources are not touched. Prints a table in Markdown. Exits with 1 if other rows
failed than should.
"""
import dataclasses
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
TREE = ROOT / "build" / "break-rows"
BUILD = TREE / "build" / "release"

COVERAGES = ("scanline", "pineda", "tiled", "hybrid", "binned", "grouped")
VISIBILITIES = ("atomic", "search", "tuple", "sorted", "hashed")
OWNING = ("tiled", "hybrid", "grouped")  # coverages with regions that one thread owns …
SHARING = ("scanline", "pineda", "hybrid", "binned")  # … and that all share
# Tests of single rows, in papers_test, by the axis. POINTS, in render_test, draws all points of the table.
TESTS = {"coverage": "Coverages/*:Order.*:Tiled.*:Tilings.*:Binned.*:TileMask.*",
         "visibility": "All/Methods.*:Layers/Counted.*"}
POINTS = "Points/Table.*"


COVERAGE_FILES = ("binned", "bins", "boxes", "groups", "hybrid", "pineda", "rows", "sorted_tiles", "tile_mask", "tiled")


@dataclasses.dataclass(frozen=True)
class Break:
    name: str
    file: str
    text: str
    broken: str
    coverages: tuple = COVERAGES  # the points of the table that fail: coverages …
    visibilities: tuple = VISIBILITIES  # … × visibilities
    units: tuple = ()  # rows whose own tests fail, where they are not those of the broken axis
    why: str = ""  # more or less than one whole row fails

    @property
    def axis(self):
        return "coverage" if pathlib.Path(self.file).stem in COVERAGE_FILES else "visibility"

    def expected_points(self):
        return {f"{c}_{v}" for c in self.coverages for v in self.visibilities}

    def expected_units(self):
        return set(self.units or (self.coverages if self.axis == "coverage" else self.visibilities))


BREAKS = (
    # --- Coverages --------------------------------------------------------------------------------
    Break("scanline", "papers/paper1/rows.hpp",
          "static_cast<std::size_t>(box.y1 - box.y0);",
          "static_cast<std::size_t>(box.y1 - box.y0 - 1);",  # a triangle's last row
          ("scanline",), units=("scanline", "hybrid"),
          why="hybrid's tuning `small_path = rows`, in its own tests, is scanline"),
    Break("pineda, small", "papers/paper1/pineda.cpp",
          "all.first(parted.first_count)", "all.first(parted.first_count / 2)", ("pineda",)),
    Break("pineda, large", "papers/paper1/pineda.cpp",
          "add_tile(frame, tiles, pair.piece,",
          "if (j != 0) add_tile(frame, tiles, pair.piece,",
          ("pineda",)),
    Break("tiled", "papers/paper1/tiled.cpp",
          "pieces.data(), which);", "pieces.data(), std::span(which).first(which.size() / 2));",
          ("tiled",)),
    Break("hybrid, small", "papers/paper1/hybrid.cpp",
          "all.first(parted.first_count)", "all.first(parted.first_count / 2)", ("hybrid",)),
    Break("hybrid, large", "papers/paper1/hybrid.cpp",
          "all.subspan(parted.first_count)", "all.last((all.size() - parted.first_count) / 2)",
          ("hybrid",)),
    Break("binned, small", "papers/paper2/binned.cpp",
          "[&](int bx, int by) { emitter.add_uncovered(piece, bx, by); }",
          "[&](int bx, int by) { if (piece % 2 == 0) emitter.add_uncovered(piece, bx, by); }",
          ("binned",)),
    Break("binned, queue", "papers/paper2/binned.cpp",
          "if (store) queue[tail++] = {piece, bin};",
          "if (store) queue[tail++] = {piece, bin & ~1U};", ("binned",)),
    Break("binned, tile mask", "papers/paper2/tile_mask.hpp",
          "row <= last_row;", "row < last_row;", ("binned",)),
    Break("binned, persistent", "papers/paper2/binned.cpp",
          "          draw_tile(piece, rect, tile, emitter);",
          "          if (tile != 0) draw_tile(piece, rect, tile, emitter);",
          (), units=("binned",), why="the table draws in the two-stage schedule, the default"),
    Break("grouped, bins of large", "rastrum/raster/bin/groups.cpp",
          "for (int by = by0; by <= by1; ++by)\n    for (int bx = bx0; bx <= bx1; ++bx) {\n      const int x0",
          "for (int by = by0; by < by1; ++by)\n    for (int bx = bx0; bx <= bx1; ++bx) {\n      const int x0",
          ("grouped",)),
    Break("grouped, lists", "rastrum/raster/bin/groups.hpp",
          "const PieceList pieces{group.pieces.data.data(), list.data(), list.size()};",
          "const PieceList pieces{group.pieces.data.data(), list.data(), list.size() - 1};",
          ("grouped",)),
    Break("grouped, micro triangles", "rastrum/raster/bin/groups.hpp",
          "return sink.fragments(bin, fragments);",
          "return sink.fragments(bin, fragments.first(fragments.size() / 2));",
          ("grouped",), ("atomic", "search", "sorted", "hashed"),
          why="tuple takes no finished keys: it has to shade"),

    # Code that coverages share: the papers build on each other.
    Break("blocks of small boxes", "papers/axes/boxes.hpp",
          "(box.x1 - 1) / kBlockSize - bx + 1,", "(box.x1 - 1) / kBlockSize - bx,",
          ("pineda", "hybrid"), why="both draw small triangles so (paper 1, table 5)"),
    Break("bins and tiles", "papers/paper1/bins.hpp",
          "return !box.empty() && may_touch(edges_of(piece), box);",
          "return j != 0 && !box.empty() && may_touch(edges_of(piece), box);",
          ("pineda", "tiled", "hybrid"), why="the hierarchy of all three (paper 1, section 3.1.3)"),
    Break("tiles sorted", "papers/paper1/sorted_tiles.cpp",
          "end - begins_[segment]);", "end - begins_[segment] - 1);",
          ("tiled", "hybrid"), why="hybrid is tiled for large triangles (paper 1, section 3.3)"),

    # --- Visibilities -----------------------------------------------------------------------------
    Break("atomic, owned", "rastrum/raster/cover/bin_keys.cpp",
          "blocks.data(), blocks.size(), surface_);",
          "blocks.data(), blocks.size() / 2, surface_);",
          OWNING, ("atomic",), why="coverages with tiles"),
    Break("atomic, shared", "papers/axes/atomic.cpp",
          "raise_atomically(out[i], keys[i]);",
          "if (i % 2 == 0) raise_atomically(out[i], keys[i]);",
          SHARING, ("atomic",), why="coverages without tiles; hybrid for small triangles"),
    Break("atomic, micro triangles", "rastrum/raster/cover/bin_keys.cpp",
          "surface_.keys[f.pixel] = std::max(surface_.keys[f.pixel], f.key);",
          "surface_.keys[f.pixel] = f.key;",
          ("grouped",), ("atomic",), why="only grouped makes fragments of its own"),
    Break("search, second pass", "papers/paper1/search.cpp",
          "if (step_ == Step::searching) return std::nullopt;",
          "if (step_ == Step::maximum) return std::nullopt;", visibilities=("search",)),
    Break("search, micro triangles", "papers/paper1/search.cpp",
          "raise<kSharing>(depth_[pixel], depth_of_key(f.key));",
          "depth_[pixel] = depth_of_key(f.key);",
          ("grouped",), ("search",), why="only grouped makes fragments of its own"),
    Break("tuple, keys", "papers/paper1/tuple.cpp",
          "if (keys[i] <= out[i]) continue;", "if (out[i] != 0) continue;",
          visibilities=("tuple",)),
    Break("tuple, colours", "papers/paper1/tuple.cpp",
          "{colors.r[i], colors.g[i], colors.b[i], colors.a[i]}",
          "{colors.r[i], colors.b[i], colors.g[i], colors.a[i]}", visibilities=("tuple",)),
    Break("sorted, segments", "papers/paper5/sorted.cpp",
          "maximum = std::max(maximum, keys[i]);", "maximum = keys[i];",
          visibilities=("sorted",)),
    Break("sorted, owned", "papers/paper5/sorted.cpp",
          "slices_.add(exec_, first + i, key);", "slices_.add(exec_, first, key);",
          OWNING, ("sorted",), why="coverages with tiles"),
    Break("sorted, shared", "papers/paper5/sorted.cpp",
          "sort_keys_[to] = static_cast<SortKey>(first + i);", "sort_keys_[to] = static_cast<SortKey>(first);",
          SHARING, ("sorted",), why="coverages without tiles; hybrid for small triangles"),
    Break("sorted, micro triangles", "papers/paper5/sorted.cpp",
          "slices_.add(exec_, pixels_.pixel(f), f.key);",
          "slices_.add(exec_, pixels_.pixel(f) & ~1U, f.key);",
          ("grouped",), ("sorted",), why="only grouped makes fragments of its own"),
    Break("hashed, maximum", "papers/paper5/hashed.cpp",
          "family::raise<kSharing>(keys_[slot], key);",
          "if (found == Slot::taken) family::raise<kSharing>(keys_[slot], key);",
          visibilities=("hashed",)),
    Break("hashed, owned", "papers/paper5/hashed.cpp",
          "        raise(home, block * 64 + i, key);", "        raise(home, block * 64, key);",
          OWNING, ("hashed",), why="coverages with tiles"),
    Break("hashed, shared", "papers/paper5/hashed.cpp",
          "probes += table_.raise(home, block * 64 + i, key);",
          "probes += table_.raise(home, block * 64, key);",
          SHARING, ("hashed",), why="coverages without tiles; hybrid for small triangles"),
    Break("hashed, micro triangles", "papers/paper5/hashed.cpp",
          "const std::uint32_t pixel = pixels_.pixel(f);",
          "const std::uint32_t pixel = pixels_.pixel(f) & ~1U;",
          ("grouped",), ("hashed",), why="only grouped makes fragments of its own"),

    # Code that visibilities share.
    Break("fragments one by one", "papers/axes/fragments.hpp",
          "make_key(depth, piece.low)", "make_key(depth / 2, piece.low)",
          visibilities=("search", "sorted", "hashed"),
          why="atomic and tuple take the keys of a whole block"),
)


class Failure(Exception):
    """Something other than a row is broken."""


def run(*command, **options):
    """Runs a command; shows its output only where it fails."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          **options)
    if done.returncode != 0:
        raise Failure(f"{' '.join(map(str, command))}\n{done.stdout[-6000:]}")


def build():
    run("cmake", "--build", BUILD, "-j", os.environ.get("RASTRUM_JOBS", str(os.cpu_count())),
        "--target", "render_test", "family_test")


def failed_cases(program, tests):
    """Returns the names of a program's tests that failed."""
    report = BUILD / f"{program}.json"
    report.unlink(missing_ok=True)
    command = [BUILD / "tests" / program.removesuffix("_test") / program,
               f"--gtest_filter={tests}", f"--gtest_output=json:{report}"]
    subprocess.run(command, env={**os.environ, "RASTRUM_TEST_SHARE": "15"}, timeout=600,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    if not report.exists():
        raise Failure(f"{program} did not come to its end")
    suites = json.loads(report.read_text())["testsuites"]
    return {f"{suite['name']}.{case['name']}"
            for suite in suites for case in suite["testsuite"] if case.get("failures")}


def row_of(case):
    """Returns the row that a unit test's case is about, or the case's own name."""
    for row in COVERAGES + VISIBILITIES:
        if re.search(rf"/{row}$|\b{row}|\.{row}", case, re.IGNORECASE):
            return row
    return "binned" if case.startswith("TileMask.") else case


def broken_rows(axis):
    """(points of the table, rows of the axis) whose tests fail, or raises."""
    points = {case.rpartition("/")[2] for case in failed_cases("render_test", POINTS)}
    units = {row_of(case) for case in failed_cases("papers_test", TESTS[axis])}
    return points, units


def check(b):
    """Breaks, builds, tests and restores. Returns (points, units)."""
    file = TREE / b.file
    source = file.read_text()
    if source.count(b.text) != 1:
        raise Failure(f"{b.name}: {b.file} has {source.count(b.text)} times, not once: {b.text}")
    try:
        file.write_text(source.replace(b.text, b.broken))
        build()
        return broken_rows(b.axis)
    finally:
        file.write_text(source)


def describe(points):
    """Describes points as rows × columns where they are a full rectangle."""
    coverages = [c for c in COVERAGES if any(p.startswith(c + "_") for p in points)]
    visibilities = [v for v in VISIBILITIES if any(p.endswith("_" + v) for p in points)]
    if len(points) != len(coverages) * len(visibilities):
        return ", ".join(sorted(points))
    if not points:
        return "none"
    name = lambda rows, all_rows: "all" if len(rows) == len(all_rows) else ", ".join(rows)
    return f"{name(coverages, COVERAGES)} × {name(visibilities, VISIBILITIES)}"


def break_all(breaks):
    run("cmake", "-S", TREE, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
        "-DRASTRUM_BUILD_APPS=OFF", "-DRASTRUM_BUILD_EXAMPLES=OFF", "-DRASTRUM_BUILD_BENCH=OFF",
        "-DRASTRUM_CUDA=OFF")
    axes = sorted({b.axis for b in breaks})
    build()
    for axis in axes:
        if any(broken_rows(axis)):
            raise Failure(f"before anything was broken: {broken_rows(axis)}")
    print("| broken | points that failed | rows whose own tests failed | as expected |")
    print("|---|---|---|---|", flush=True)
    wrong = 0
    for b in breaks:
        points, units = check(b)
        right = points == b.expected_points() and units == b.expected_units()
        wrong += not right
        verdict = "yes" + (f": {b.why}" if b.why else "") if right else (
            f"**no**: {describe(b.expected_points())}; {', '.join(sorted(b.expected_units()))}")
        rows = ", ".join(sorted(units)) or "none"
        print(f"| {b.name} | {describe(points)} | {rows} | {verdict} |", flush=True)
    print(f"\n{len(breaks) - wrong} of {len(breaks)} breaks were seen by their rows' tests alone")
    return wrong


def main(arguments):
    if arguments == ["--list"]:
        print("\n".join(b.name for b in BREAKS))
        return 0
    unknown = set(arguments) - {b.name for b in BREAKS}
    if unknown:
        print(f"break_rows.py: no break is called {', '.join(unknown)}; see --list",
              file=sys.stderr)
        return 2
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    git = ("git", "-C", ROOT, "worktree")
    try:
        run(*git, "add", "--force", "--detach", TREE, "HEAD")
        return 1 if break_all([b for b in BREAKS if not arguments or b.name in arguments]) else 0
    except (Failure, subprocess.TimeoutExpired) as failure:
        print(f"break_rows.py: {failure}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    finally:
        shutil.rmtree(TREE, ignore_errors=True)
        subprocess.run((*git, "prune"), check=False)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
