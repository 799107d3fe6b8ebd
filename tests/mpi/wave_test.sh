#!/bin/bash
# The simulation of the examples writes the same pictures on one rank and on several.
# usage: wave_test.sh WAVE MPIEXEC NUMPROC_FLAG
set -u
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
cd "$here" || exit 1
for n in 1 3 5; do
  timeout 100 "$2" "$3" "$n" "$1" 60 90 45 "of_${n}_" 160 90 || exit 1
done
[ "$(find . -name 'of_*.png' | wc -l)" = 6 ] || exit 1
cmp of_1_00045.png of_1_00090.png && exit 1  # it moves
for n in 3 5; do
  for step in 00045 00090; do cmp "of_1_$step.png" "of_${n}_$step.png" || exit 1; done
done
