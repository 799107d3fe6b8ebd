#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# The example on ranks writes the same pictures on one rank and on several.
# usage: wave_test.sh WAVE MPIEXEC NUMPROC_FLAG
set -u
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
for n in 1 3 5; do
  mkdir "$here/$n" && cd "$here/$n" || exit 1
  timeout 100 "$2" "$3" "$n" "$1" || exit 1
done
[ "$(find "$here" -name 'wave*.png' | wc -l)" = 9 ] || exit 1
cmp "$here/1/wave1.png" "$here/1/wave2.png" && exit 1  # it moves
for n in 3 5; do
  for picture in wave1.png wave2.png wave3.png; do
    cmp "$here/1/$picture" "$here/$n/$picture" || exit 1
  done
done
