#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Draws the pictures of digests.txt by a program, and prints that table as the program makes it.
#
# usage: packaging/digests.sh COMMAND…     COMMAND… runs `rastrum`
set -euo pipefail
while read -r _ shape look; do
  # shellcheck disable=SC2086
  digest="$("$@" make "$shape" --quiet -o - </dev/null | "$@" render - --format ply --look plain $look --size 320x240 --hash)"
  echo "${digest%% *}  $shape $look"
done <"$(dirname "${BASH_SOURCE[0]}")/digests.txt"
