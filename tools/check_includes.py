#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the includes of the sources: which files may include which.

usage: check_includes.py [--picture] ROOT

docs/architecture.md explains the floors, which are the folders of rastrum/. A folder of rastrum/raster/, papers/ or
apps/rastrum/ is a room. The rules:

- A file of rastrum/ includes files of the project as <rastrum/...>, and only from the floors listed for its own.
  Nothing of rastrum/ includes papers/.
- A file of a room includes its own room and the rooms before it in ROOMS. --picture prints the picture of the rooms in
  docs/frames.md, which must be equal.
- A public header (include/rastrum/) includes only public and standard headers and belongs to a floor. The C header,
  include/rastrum.h, includes only C's headers and belongs to the floor c.
- Programs and examples include public headers, and the exceptions that are listed here with their reason.
- A header that is compiled for each instruction set, NAME-inl.hpp, has Highway's guard, named by its path, and a
  namespace of its own. Code of an instruction set includes only bodies (NAME.inl), which include nothing (decision
  0124).
- A module of python/rastrum imports other modules of it at its top, without a circle. Imports inside of functions are
  for optional packages, and for Python's own that few calls need.

Prints one line per violation; exits with 1 if there are any.
"""
import ast
import graphlib
import pathlib
import re
import sys

MAY_INCLUDE = {
    "core": set(),
    "parallel": {"core"},
    "scene": {"core", "parallel"},
    "raster": {"core", "parallel", "scene"},
    "transparency": {"core", "parallel", "scene", "raster"},
    "terrain": {"core", "parallel", "scene"},
    # Works on finished pictures, whatever drew them.
    "overlay": {"core", "parallel", "scene"},
    # Files in, images out. It includes nothing that draws, so a reader can be used alone.
    "io": {"core", "parallel", "scene"},
    "render": {"core", "parallel", "scene", "raster", "transparency", "terrain", "overlay",
               "io"},
    "ranks": {"core", "parallel", "scene", "raster", "transparency", "overlay", "render"},
    # Part of rastrum_io, the library of files.
    "out_of_core": {"core", "parallel", "scene", "raster", "transparency", "render", "ranks", "io"},
    # A library of its own, built if there is an MPI. Nothing includes it.
    "mpi": {"core", "ranks"},
    # The C interface, <rastrum.h>: nothing includes it.
    "c": {"core", "parallel", "scene", "raster", "render"},
    # The library of device code, opened by its file's name: nothing includes it.
    "cuda": {"core", "parallel", "render", "terrain"},
}
# Folders in the order of their rooms, in which a frame's data passes through them. A paper may build on an
# earlier one.
ROOMS = {
    "rastrum/raster": ["rules", "kernels", "draws", "surface", "shade", "context", "setup", "cull", "cover", "bin", "resolve", "frame",
                       "cuda"],
    "papers": ["include", "axes", "paper1", "paper2", "paper3", "paper4", "paper5", "table", "models"],
}
# The rooms of apps/rastrum/, from the command line to files. The files beside them and window/ include all of
# them.
PROGRAM_ROOMS = ["parse", "job", "frame", "files"]
PAGE = "docs/frames.md"
# The public headers, include/rastrum/NAME.hpp, by the floor of their sources.
PUBLIC = {
    "core": {"array", "color", "config", "digest", "error", "function", "held", "image", "mat", "path", "scalars", "transform",
             "vec", "version"},
    "parallel": {"device", "stop"},
    "scene": {"camera", "color_map", "environment", "fit", "light", "mesh", "motion", "points_and_lines", "prepared_mesh", "scene",
              "shapes", "surfaces"},
    "raster": {"frame", "primitives", "program"},
    "terrain": {"terrain", "terrain_light"},
    "overlay": {"effects", "overlay"},
    "io": {"io"},
    "render": {"annotate", "on_terrain", "pick", "render", "tone"},
    "ranks": {"ranks"},
    "out_of_core": {"out_of_core"},
}
FLOOR_OF = {f"{name}.hpp": floor for floor, names in PUBLIC.items() for name in names}
# Internal headers, which are not installed. Decision 0025 says why the program may include them.
PROGRAMS_MAY = {
    "apps": {"rastrum/core/angle.hpp", "rastrum/core/elementary.hpp", "rastrum/core/nearest_word.hpp", "rastrum/core/srgb.hpp",
             "rastrum/io/files.hpp", "rastrum/io/mapped_file.hpp", "rastrum/mpi/mpi_ranks.hpp", "rastrum/parallel/exec.hpp",
             "rastrum/raster/context/target_table.hpp", "rastrum/raster/rules/clip.hpp", "rastrum/raster/rules/srgb.hpp"},
    # Not installed, since it needs the MPI of the machine it is built on.
    "examples": {"rastrum/mpi/mpi_ranks.hpp"},
}
C_HEADER = "rastrum.h"
OF_C = {"stddef.h", "stdint.h"}
ENDINGS = {".hpp", ".cpp", ".h", ".c", ".inl", ".cu", ".cuh"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def violations_of_line(root, file, floor, line):
    """Yields what is wrong with one line of a file under rastrum/<floor>/."""
    match = INCLUDE.match(line)
    if not match:
        return
    quote, path = match.groups()
    if quote == '"':
        inside = any((base / path).is_file() for base in (file.parent, root))
        if path.startswith("rastrum/") or inside:
            yield f'"{path}" must be written <rastrum/...>'
        return
    if path == C_HEADER and floor != "c":
        yield f"{floor} may not include <{path}>, which is for C"
    if not path.startswith("rastrum/"):
        if (root / path).is_file():
            yield f"the library may not include <{path}>"
        return
    target = path.split("/")[1]
    target = FLOOR_OF.get(target, target)
    if target != floor and target not in MAY_INCLUDE[floor]:
        yield f"{floor} may not include {target} (<{path}>)"


def room_of(path):
    """Returns the folder of rooms and the room of a path such as rastrum/raster/bin/groups.hpp, or None."""
    for folder in ROOMS:
        if path.startswith(f"{folder}/") and path.count("/") > folder.count("/") + 1:
            return folder, path[len(folder) + 1:].split("/")[0]
    return None


def violations_of_room(path, line):
    """Yields what is wrong with one line of a file of a room."""
    match = INCLUDE.match(line)
    room, target = room_of(path), room_of(match.group(2)) if match else None
    if room is None or target is None or target == room or target[0] != room[0]:
        return
    order = ROOMS[room[0]]
    for _, name in (room, target):
        if name not in order:
            yield f"'{name}' is no room of {room[0]}/ (tools/check_includes.py)"
            return
    if order.index(target[1]) > order.index(room[1]):
        yield f"{room[1]} may not include {target[1]}, which comes after it (<{match.group(2)}>)"


def picture(root):
    """Returns a table of rooms (down) and the rooms that they include (across). A mark above the diagonal is a way back."""
    folder = "rastrum/raster"
    marks, rooms = set(), ROOMS[folder]
    for file in sorted((root / folder).rglob("*")):
        if file.suffix in ENDINGS and (room := room_of(file.relative_to(root).as_posix())):
            for line in file.read_text(encoding="utf-8", errors="replace").splitlines():
                if (match := INCLUDE.match(line)) and (target := room_of(match.group(2))):
                    marks.add((room[1], target[1]))
    wide = max(map(len, rooms))
    lines = [" " * wide + "  " + " ".join(rooms)]
    for room in rooms:
        cells = (("●" if (room, other) in marks and other != room else "·").center(len(other)) for other in rooms)
        lines.append(f"{room:<{wide}}  " + " ".join(cells).rstrip())
    return "\n".join(lines) + "\n"


def violations_of_page(root):
    """Yields where the page's picture of the rooms differs from the includes."""
    page = root / PAGE
    if page.is_file() and picture(root) not in page.read_text(encoding="utf-8"):
        yield f"{PAGE}:1: its picture of the rooms is not what `tools/check_includes.py --picture .` prints"


def is_public(path):
    """Returns whether an include names a public header."""
    return path.startswith("rastrum/") and path.count("/") == 1


def violations_of_public_line(line):
    """Yields what is wrong with one line of a public header, apart from floors."""
    match = INCLUDE.match(line)
    if match and not is_public(match.group(2)) and re.search(r"[/.]", match.group(2)):
        yield f"a public header may not include <{match.group(2)}>, which is not installed"


def violations_of_lanes(path, text):
    """Yields line and message for each violation of the rules of SIMD code."""
    is_body = path.endswith(".inl")
    in_lanes = is_body
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith(("HWY_BEFORE_NAMESPACE", "HWY_AFTER_NAMESPACE")):
            in_lanes = "BEFORE" in line
        match = INCLUDE.match(line)
        if match and in_lanes and not match.group(2).endswith(".inl"):
            yield number, f"<{match.group(2)}> is included inside a namespace: bodies (.inl) alone are"
    if not path.endswith("-inl.hpp"):
        return
    guard = re.sub(r"\W", "_", path.upper())
    if (f"#if defined({guard}) == defined(HWY_TARGET_TOGGLE)\n#ifdef {guard}\n#undef {guard}\n#else\n"
            f"#define {guard}\n#endif\n") not in text:
        yield 1, f"Highway's guard {guard} is not there"
    if "HWY_BEFORE_NAMESPACE" not in text:
        yield 1, "has no namespace of an instruction set"


def violations_of_program_room(root, file, path):
    """Yields what is wrong if `file` includes `path`, both of rooms of apps/rastrum/."""
    program = root / "apps" / "rastrum"
    room = file.relative_to(program).parts[0] if file.is_relative_to(program) else ""
    if room not in PROGRAM_ROOMS or (file.parent / path).is_file() or not (program / path).is_file():
        return
    if path.split("/")[0] not in PROGRAM_ROOMS[:PROGRAM_ROOMS.index(room)]:
        yield f"{room} may not include {path}, which comes after it"


def violations_of_programs(root):
    """The same as violations() for programs and examples, which use the library as users do."""
    for folder, may in PROGRAMS_MAY.items():
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in ENDINGS or "inside" in file.relative_to(root).parts:
                continue
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                match = INCLUDE.match(line)
                path = match.group(2) if match else ""
                if path.startswith("rastrum/") and not is_public(path) and path not in may:
                    yield (f"{file.relative_to(root)}:{number}: <{path}> is no public header "
                           f"({folder} use the library as others do)")
                for message in violations_of_program_room(root, file, path) if path else ():
                    yield f"{file.relative_to(root)}:{number}: {message}"


def violations_of_modules(root):
    """Yields imports of python/rastrum's own modules inside of functions, and a circle of modules."""
    imports = {}
    for file in sorted((root / "python" / "rastrum").rglob("*.py")):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if not isinstance(node, ast.ImportFrom) or not node.level:
                continue
            base = file.parents[node.level - 1].joinpath(*(node.module or "").split("."))
            for name in (alias.name for alias in node.names if alias.name != "_rastrum"):  # compiled
                places = base / f"{name}.py", base.with_suffix(".py"), base / "__init__.py"
                imports.setdefault(file, set()).update([p for p in places if p.is_file()][:1])
            if node not in tree.body:
                yield f"{file.relative_to(root)}:{node.lineno}: imports the package's own modules inside of a function"
    try:
        graphlib.TopologicalSorter(imports).prepare()
    except graphlib.CycleError as e:
        circle = [file.relative_to(root).as_posix() for file in reversed(e.args[1])]
        yield f"{circle[0]}:1: imports itself through other modules: {' -> '.join(circle)}"


def violations_of_c_header(root):
    """Yields what the C header includes that is not C's."""
    file = root / "include" / C_HEADER
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines() if file.is_file() else (), 1):
        if (match := INCLUDE.match(line)) and match.group(2) not in OF_C:
            yield f"{file.relative_to(root)}:{number}: <{match.group(2)}> is none of the headers of C that it may include"


def violations(root):
    """Yields 'file:line: message' for the whole tree."""
    for folder in ("include/rastrum", "rastrum", "papers"):
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in ENDINGS:
                for place, message in violations_of_file(root, folder, file):
                    yield f"{file.relative_to(root)}:{place}: {message}"


def violations_of_file(root, folder, file):
    """Yields (line, message) for each violation of a file."""
    path = file.relative_to(root).as_posix()
    public = folder == "include/rastrum"
    floor = FLOOR_OF.get(file.name) if public else path.split("/")[1]
    if public and floor is None:
        yield 1, "a public header that tools/check_includes.py does not know"
        return
    if folder == "rastrum" and floor not in MAY_INCLUDE:
        yield 1, f"'{floor}' is no floor of rastrum/ (tools/check_includes.py)"
        return
    text = file.read_text(encoding="utf-8", errors="replace")
    for number, line in enumerate(text.splitlines(), 1):
        for message in violations_of_line(root, file, floor, line) if folder != "papers" else ():
            yield number, message
        for message in violations_of_public_line(line) if public else ():
            yield number, message
        for message in violations_of_room(path, line):
            yield number, message
    yield from violations_of_lanes(path, text)


def main():
    arguments = [a for a in sys.argv[1:] if a != "--picture"]
    if len(arguments) != 1:
        sys.exit(__doc__)
    root = pathlib.Path(arguments[0]).resolve()
    if "--picture" in sys.argv:
        print(picture(root), end="")
        return
    found = [*violations(root), *violations_of_c_header(root), *violations_of_programs(root), *violations_of_page(root),
             *violations_of_modules(root)]
    for line in found:
        print(line)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
