#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the commands in README.md and docs/*.md, and compares the pictures that they draw with the pages'.

usage: docs.py check|accept [--build DIR] [PAGE...]
       docs.py links
       docs.py compile COMPILER [FLAG...]

`check` runs every ```sh block of a page, in order, in an empty folder for the page. A picture that a command leaves
there must equal the page's picture of the same name (images/NAME.png) within 1/255 a channel, and each picture of a
page must be drawn. Files that a reader does not have (dragon.ply, alps.png, ...) are docs_files.py's stand-ins;
launchers that start programs elsewhere (sbatch, mpirun, docker, ssh) are stand-ins that start them here, once. Commands
that cannot run here are not in ```sh blocks. DIR is where the program was built (build/release).
`accept` makes the drawn pictures the pages'.
`links` checks that the files and headings that pages name exist, and the pages that sources name, and that every
picture is used.
`compile` compiles all ```cpp blocks as one source, each in a namespace of its own. A block with a function is at file
scope, any other is the inside of a function. Names that it does not declare come from tests/docs/pages.hpp. Blocks that
use MPI are left out if there is no mpi.h.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import docs_files

ROOT = pathlib.Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"
TIMEOUT_S = 240
DRAWN_ELSEWHERE = {"front.png"}  # by tools/front_picture.py, which python/tests/test_pages.py runs
TOLERANCE = 1  # of 255, between instruction sets (conventions.md)
TOLERANCE_MAGNIFIED = 16  # of *_difference.png, which shows the differences of two pictures times 8

LINK = re.compile(r"!?\[[^\]]*\]\(([^)#\s]*)(?:#([^)\s]*))?[^)]*\)")
HEADING = re.compile(r"^#+ (.*)$", re.MULTILINE)
NAMED_PAGE = re.compile(r"\bdocs/[\w/]+\.md\b")  # in comments of sources
PICTURE = re.compile(r"!\[[^\]]*\]\((?:docs/)?images/([^)]+)\)")
INCLUDE = re.compile(r"^#include .*$", re.MULTILINE)
FUNCTION = re.compile(r"^(?:void|int|auto|bool|rastrum::\w+) \w+\(.*\) \{$", re.MULTILINE)  # at file scope
TYPED = re.compile(r"(?: {4,}|\t)(?:\$ )?(?:\./dev|rastrum) ")


def pages():
    """Returns the pages whose commands are run."""
    return ["README.md"] + sorted(f"docs/{p.name}" for p in (ROOT / "docs").glob("*.md"))


def all_pages():
    """Returns the pages whose links are checked: also the log, the decisions, other pages of the root and READMEs of folders."""
    inside = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*/*.md")]
    return pages() + sorted(str(p.relative_to(ROOT)) for p in inside if p.name != "README.md" or p.parent != ROOT) + [
        str(p.relative_to(ROOT)) for folder in ("*", "papers/*") for p in sorted(ROOT.glob(f"{folder}/README.md"))]


def sources():
    """Returns the files whose comments may name pages."""
    folders = ("apps", "bench", "cmake", "examples", "include", "papers", "rastrum", "tests", "tools")
    endings = {".hpp", ".cpp", ".h", ".c", ".f90", ".inl", ".cuh", ".cu", ".cmake", ".txt", ".py"}
    return [file for folder in folders for file in sorted((ROOT / folder).rglob("*"))
            if file.suffix in endings and file.name not in ("docs_test.py", "site_test.py")]


def split(text, wanted="sh"):
    """Returns ([(line, block)] of the blocks in a language, [line] of commands outside of blocks)."""
    blocks, stray = [], []
    language = None
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            if language is None:
                language = line[3:].strip()
                if language == wanted:
                    blocks.append((number + 1, []))
            else:
                language = None
        elif language == wanted:
            blocks[-1][1].append(line)
        elif language is None and TYPED.match(line):
            stray.append(number)
    return [(number, "\n".join(lines)) for number, lines in blocks], stray


def put_script(file, text):
    file.write_text("#!/usr/bin/env bash\n" + text, encoding="utf-8")
    file.chmod(0o755)


def furnish(folder, build, text):
    """Puts into the folder what a page's commands need: the program, `./dev`, launchers, built programs, stand-ins.
    Returns the folder of the launchers, for PATH."""
    tools = folder / ".tools"
    tools.mkdir()
    program = build / "apps" / "rastrum" / "rastrum"
    (tools / "quit.json").write_text('{"events": [{"time": 0.1, "quit": true}]}', encoding="utf-8")
    # A window that is invisible and closes by itself. Without window support there is none.
    put_script(tools / "rastrum", f"""
[[ "$1" == view ]] || exec {program} "$@"
script=(--script {tools}/quit.json)
[[ " $* " != *" --script "* ]] || script=()
said="$(SDL_VIDEODRIVER=dummy {program} "$@" "${{script[@]}}" 2>&1)" && exit
[[ "$said" == *"built without a window"* ]] || {{ echo "$said" >&2; exit 1; }}
""")
    for launcher in ("srun", "mpirun", "docker", "ssh", "xvfb-run"):
        put_script(tools / launcher, """
[[ "$1" != build ]] || exit 0
while (($#)) && [[ "$1" != rastrum && "$1" != build/* ]]; do shift; done
exec "$@"
""")
    put_script(tools / "sbatch", """
array="$(grep -o -- '--array=[0-9-]*' "$1")" array="${array#*=}"
for ((i = ${array%-*}; i <= ${array#*-}; ++i)); do
  SLURM_ARRAY_TASK_ID=$i SLURM_CPUS_PER_TASK=2 bash -eu "$1"
done
""")
    # The real `./dev` would build. This one runs the same demo. For other commands it checks that they exist.
    put_script(folder / "dev", f"""set -e
program=rastrum
case "$1" in
  run) mkdir -p out
       if (($# > 1)); then rastrum render "${{@:2}}" -o out/render.png; exit; fi
       eval "$(sed -n '/^demo() {{/,/^}}/p' {ROOT}/dev)"; demo ;;
  *) grep -q "^cmd_$1() {{" {ROOT}/dev ;;
esac
""")
    (folder / "build").mkdir()
    (folder / "build" / "release").symlink_to(build)
    docs_files.put(folder, text)
    return tools


def run(folder, tools, block):
    """Runs the block. Returns what is wrong, or ''."""
    place = 'trap \'echo "failed: $BASH_COMMAND" >&2\' ERR\n'
    # Waiting ranks yield their core to ranks that compute.
    environment = dict(os.environ, PATH=f"{tools}:{os.environ['PATH']}", OMPI_MCA_mpi_yield_when_idle="1")
    try:
        done = subprocess.run(["bash", "-eEuo", "pipefail", "-c", place + block], cwd=folder,
                              env=environment, stdin=subprocess.DEVNULL, capture_output=True,
                              timeout=TIMEOUT_S)
    except subprocess.TimeoutExpired:
        return f"runs for more than {TIMEOUT_S} s"
    return "" if done.returncode == 0 else done.stderr.decode(errors="replace").strip()


def difference(build, drawn, shown):
    """Returns the largest difference of a channel, or None if the pictures cannot be compared."""
    if drawn.read_bytes() == shown.read_bytes():
        return 0
    tool = build / "tests" / "docs" / "picture_difference"
    done = subprocess.run([tool, drawn, shown], capture_output=True, text=True)
    return int(done.stdout) if done.returncode == 0 else None


def check_pictures(folder, build, page, text, accept):
    drawn = {}
    for file in sorted(folder.rglob("*.png")):
        drawn.setdefault(file.name, file)
    wrong = []
    for name in dict.fromkeys(PICTURE.findall(text)):
        if name in DRAWN_ELSEWHERE:
            continue
        shown = IMAGES / name
        if name not in drawn:
            wrong.append(f"{page}: no command of the page draws {name}")
            continue
        much = difference(build, drawn[name], shown) if shown.exists() else None
        if much is not None and much <= (TOLERANCE_MAGNIFIED if "_difference" in name else TOLERANCE):
            continue
        if accept:
            shutil.copyfile(drawn[name], shown)
            print(f"accepted {shown.relative_to(ROOT)}")
        else:
            how = "is not there or of another size" if much is None else f"differs by {much}/255"
            wrong.append(f"{page}: {name} {how}; look at what is drawn, then ./dev docs accept")
    return wrong


def check(page, build, accept):
    """Returns a list of messages: what is wrong with a page."""
    text = (ROOT / page).read_text(encoding="utf-8")
    blocks, stray = split(text)
    wrong = [f"{page}:{line}: a command outside of a ```sh block is never run" for line in stray]
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        tools = furnish(folder, build, "\n".join(block for _, block in blocks))
        for line, block in blocks:
            if problem := run(folder, tools, block):
                wrong.append(f"{page}:{line}: the block does not run:\n{problem}")
        return wrong + check_pictures(folder, build, page, text, accept)


def prose(page):
    """Returns the text without ``` blocks."""
    return re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)


def anchors(page):
    """Returns the anchors that GitHub makes of a page's headings."""
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")
            for heading in HEADING.findall(prose(page))}


def check_links():
    wrong, linked = [], set()
    for page in all_pages():
        for target, anchor in LINK.findall(prose(ROOT / page)):
            if "://" in target:
                continue
            file = (ROOT / page).parent / target if target else ROOT / page
            linked.add(file.resolve())
            if not file.exists():
                wrong.append(f"{page}: {target} is not there")
            elif anchor and anchor not in anchors(file):
                wrong.append(f"{page}: {target}#{anchor} is no heading there")
    for source in sources():
        for named in NAMED_PAGE.findall(source.read_text(encoding="utf-8", errors="replace")):
            if not (ROOT / named).exists():
                wrong.append(f"{source.relative_to(ROOT)}: {named} is not there")
    wrong += [f"{image.relative_to(ROOT)}: no page shows it"
              for image in sorted(IMAGES.iterdir()) if image.resolve() not in linked]
    return wrong


def cpp_source():
    """Returns one source of the C++ blocks of all pages, with line markers that name the pages' lines."""
    source = ['#include "pages.hpp"']
    for page in pages():
        for line, block in split((ROOT / page).read_text(encoding="utf-8"), "cpp")[0]:
            includes = INCLUDE.findall(block)
            inside = f'#line {line} "{page}"\n' + INCLUDE.sub("", block)
            if not FUNCTION.search(block):
                inside = f"void block() {{\n{inside}\n}}"
            name = re.sub(r"\W", "_", f"{page}_{line}")
            with_mpi = ["#if __has_include(<mpi.h>)", "#endif"] if "rastrum::mpi" in block else ["", ""]
            source += [with_mpi[0], *includes, f"namespace {name} {{", inside, "}", with_mpi[1]]
    return "\n".join(source) + "\n"


def compile_blocks(compiler, flags):
    command = [compiler, "-std=c++20", "-fsyntax-only", "-w", "-x", "c++", f"-I{ROOT}/include", f"-I{ROOT}/papers/include",
               f"-I{ROOT}/rastrum/mpi/include", f"-I{ROOT}/tests/docs", *flags, "-"]
    done = subprocess.run(command, input=cpp_source(), text=True, capture_output=True)
    return [] if done.returncode == 0 else [done.stderr]


def main(arguments):
    build = ROOT / "build" / "release"
    if "--build" in arguments:
        at = arguments.index("--build")
        build = pathlib.Path(arguments[at + 1]).resolve()
        del arguments[at:at + 2]
    if not arguments or arguments[0] not in ("check", "accept", "links", "compile") or arguments == ["compile"]:
        print(__doc__, file=sys.stderr)
        return 2
    command, *named = arguments
    if command == "links":
        wrong = check_links()
    elif command == "compile":
        wrong = compile_blocks(named[0], named[1:])
    else:
        wrong = [message for page in named or pages() for message in check(page, build, command == "accept")]
    for message in wrong:
        print(message, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
