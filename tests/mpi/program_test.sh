#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# `mpirun rastrum render` writes the bytes of one process, says once what fails, and ends where a
# rank hangs or dies. usage: program_test.sh RASTRUM MPIEXEC NUMPROC_FLAG
set -u
rastrum=$1 flag=$3
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
cd "$here" || exit 1
failed=0
fail() { echo "FAILED: $*"; failed=1; }
ranks() { local n=$1; shift; timeout 60 "$mpiexec" "$flag" "$n" "$rastrum" render "$@"; }
mpiexec=$2

"$rastrum" make 'torus_knot?p=2,q=5' -o a.ply --quiet 2> /dev/null || exit 1
"$rastrum" make 'sphere?x=1.5' -o b.ply --quiet 2> /dev/null || exit 1

# The bytes are the same whichever rank reads which input, with fewer inputs than ranks, too.
same() {
  local n=$1; shift
  "$rastrum" render "$@" --quiet -o one.png --depth one.npy --ids one_ids.npy --objects one_objects.npy || fail "one: $*"
  ranks "$n" "$@" --quiet -o many.png --depth many.npy --ids many_ids.npy --objects many_objects.npy || fail "$n ranks: $*"
  for end in .png .npy _ids.npy _objects.npy; do cmp one$end many$end || fail "$n ranks, $end: $*"; done
}
inputs=(a.ply b.ply@color=#88aaff,opacity=0.4 'builtin:teapot?x=-2' a.ply@y=1,rx=40)
same 3 "${inputs[@]}" --size 200x150
same 2 "${inputs[@]}" --size 130x170 --look studio
same 5 "${inputs[@]}" --size 90x90 --opacity 0.5 --eye 3,2,5 --background white --shader phong
same 3 a.ply --size 64x64 --orthographic fit --azimuth 30
# Ranks must agree on shadows, ranges of numbers, boxes, and on what effects look at.
same 3 "${inputs[@]}" --size 120x90 --lights studio --light directional:-1,-1.5,-0.6 --shadows --bounds --axes
same 2 a.ply b.ply --size 120x90 --scalars distance --log --cmap turbo --bar Away --isolines 4 --occlusion
same 3 "${inputs[@]}" --size 120x90 --edges --edge-angle 20 --edge-width 1.5 --samples 4
same 2 a.ply 'builtin:boxes?count=3' --size 120x90 --edges --look plain --opacity 0.5
cat > numbers.ply << 'E'
ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property float heat
element face 1
property list uchar int vertex_indices
end_header
0 0 0 -7
4 1 0 20
1 1 1 5
3 0 1 2
E
same 2 b.ply numbers.ply --size 80x60 --scalars heat --bar Heat
# In bands of rows, of which each rank and the first hold one at a time: by the limit, not by default.
rows() {
  local n=$1; shift
  "$rastrum" render "$@" --quiet -o one.png --depth one.npy --ids one_ids.npy --objects one_objects.npy --image normals=one_normals.npy || fail "one: $*"
  ranks "$n" "$@" --memory-limit 24M --quiet -o many.png --depth many.npy --ids many_ids.npy --objects many_objects.npy --image normals=many_normals.npy --stats stats.json || fail "$n ranks in bands: $*"
  for end in .png .npy _ids.npy _objects.npy _normals.npy; do cmp one$end many$end || fail "$n ranks in bands, $end: $*"; done
  python3 -c 'import json; s = json.load(open("stats.json")); assert 0 < s["rows_at_once"] < 500 and s["of_ranks"]["peak_bytes"]["min"] > 2**20, s' || fail "not in bands: $*"
}
rows 3 "${inputs[@]}" --size 400x500 --look plain --depth-unit world
rows 2 a.ply b.ply --size 400x500 --look plain --lights studio --samples 4 --opacity 0.6
# Cameras and lights of files, counted on from rank to rank.
gltf() {
  cat > "$1" << E
{"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"], "scene": 0, "scenes": [{"nodes": [0, 1]}],
 "nodes": [{"camera": 0, "translation": [$2, 0.5, 6]}, {"translation": [$2, 2, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
 "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}],
 "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "color": [1, 0.6, 0.4], "intensity": 20}]}}}
E
}
gltf first.gltf -1
gltf second.gltf 1
same 2 a.ply first.gltf b.ply second.gltf --size 80x60 --camera 1 --lights file
ranks 2 a.ply b.ply --size 60x40 --quiet -o many.png --stats stats.json || fail "--stats"
python3 - << 'E' || fail "what --stats says"
import json
s = json.load(open("stats.json"))
assert s["ranks"] == 2 and [i["rank"] for i in s["inputs"]] == [0, 1], s
assert s["primitives"] == sum(i["triangles"] for i in s["inputs"]) == 2 * s["of_ranks"]["primitives"]["mean"], s
assert s["of_ranks"]["won"]["min"] > 0 and len(s["cameras"]) == 1, s
E
# The way of people who give nothing but files.
"$rastrum" render a.ply b.ply --size 120x80 --quiet -o one.png || fail "one by default"
ranks 3 a.ply b.ply --size 120x80 --quiet -o many.png || fail "ranks by default"
cmp one.png many.png || fail "the default picture"
rm -f ./*.png ./*.npy

# A failure is reported once, by the rank that has it, and leaves no file.
says() {
  local n=$1 text=$2; shift 2
  ranks "$n" "$@" 2> err.txt && fail "not refused: $*"
  [ "$(grep -c 'rastrum: error:' err.txt)" = 1 ] || { fail "said not once: $*"; cat err.txt; }
  grep -qF -- "$text" err.txt || { fail "does not say '$text': $*"; cat err.txt; }
  [ -z "$(find . -name '*.png')" ] || fail "left a file: $*"
}
says 3 'rank 1: nofile.ply: cannot be read' a.ply nofile.ply a.ply -o x.png
head -c 900 a.ply > cut.ply
printf '%80s\377\377\377\377' '' > many.stl
printf 'glTF\002\000\000\000\377\377\377\377\377\377\377\377JSON' > long.glb
says 3 'rank 2: cut.ply: ' a.ply a.ply cut.ply -o x.png
says 3 'rank 0: many.stl: the header says 4294967295 triangles' many.stl a.ply b.ply -o x.png
says 3 'rank 1: long.glb: is not a valid GLB' a.ply long.glb a.ply -o x.png
says 2 'rank 0: --turntable: cannot be used with several ranks' a.ply b.ply --turntable 4 -o x%d.png
says 2 "there are no scalars called 'cold'" a.ply b.ply --scalars cold -o x.png
says 2 'have no camera' a.ply b.ply --camera 0 -o x.png
says 3 'have no lights of their own' a.ply b.ply --lights file -o x.png
says 2 'there is no option --bogus' a.ply --bogus
says 2 '--target: eye and target must differ' a.ply --eye 1,1,1 --target 1,1,1 -o x.png
says 2 'no/where' a.ply b.ply -o no/where/x.png

# A rank that reads a pipe to which nobody writes: the other waits, and says in what.
mkfifo pipe.ply
begin=$SECONDS
says 2 "phase 'load inputs'" a.ply pipe.ply --format ply --timeout 2 -o x.png
[ $((SECONDS - begin)) -lt 30 ] || fail "the timeout took $((SECONDS - begin)) s"
# A rank stands still while the first has a picture half written: that ends the job and leaves nothing.
"$mpiexec" "$flag" 2 "$rastrum" render a.ply b.ply --look plain --samples 16 --size 1500x30000 --memory-limit 100M --threads 1 --timeout 10 --quiet -o half.png 2> err.txt &
job=$!
for _ in $(seq 300); do
  [ -n "$(find . -name '.half.png.*')" ] && break
  sleep 0.1
done
[ -n "$(find . -name '.half.png.*')" ] || fail "no picture was begun: the test sees nothing"
for process in $(pgrep -P "$job" -x rastrum); do
  tr '\0' '\n' < "/proc/$process/environ" | grep -qE '^(OMPI_COMM_WORLD_RANK|PMI_RANK)=1$' && kill -STOP "$process"
done
wait "$job" && fail "a rank that stands still is no failure"
grep -q 'has waited' err.txt || { fail "the timeout is not said"; cat err.txt; }
[ -z "$(find . -name '*half.png*')" ] || fail "left $(find . -name '*half.png*')"
# It is killed: the job ends.
"$mpiexec" "$flag" 2 "$rastrum" render a.ply pipe.ply --format ply -o x.png 2> err.txt &
job=$!
for _ in $(seq 100); do
  victim=$(pgrep -P "$job" -x rastrum | tail -1)
  [ -n "$victim" ] && grep -q State:.S "/proc/$victim/status" 2> /dev/null && break
  sleep 0.1
done
sleep 1
kill -9 "$victim"
begin=$SECONDS
wait "$job" && fail "a killed rank is no failure"
[ $((SECONDS - begin)) -lt 10 ] || fail "the job outlived a rank by $((SECONDS - begin)) s"
exit $failed
