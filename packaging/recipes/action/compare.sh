#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Draws pictures and compares their digests with recorded ones.
#
# usage: compare.sh PROGRAM DIGESTS FOLDER
#
# Each line of the file DIGESTS: a digest and the arguments of `rastrum render` (without spaces in any). The pictures, and
# digests.txt with the digests that they have, go to FOLDER. Ends with 1 if any differs.
set -euo pipefail
(($# == 3)) || { sed -n '3,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 2; }
readonly program="$1" digests="$2" folder="$3"

mkdir -p "$folder"
: >"$folder/digests.txt"
count=0 different=0
while read -r -a words; do
  ((${#words[@]})) && [[ ${words[0]} != '#'* ]] || continue
  count=$((count + 1))
  said="$("$program" render "${words[@]:1}" --quiet --hash -o "$folder/$count.png" </dev/null)"
  echo "${said%% *}  ${words[*]:1}" >>"$folder/digests.txt"
  if [[ ${said%% *} != "${words[0]}" ]]; then
    different=$((different + 1))
    echo "$count.png differs: ${words[*]:1}"
  fi
done <"$digests"
echo "$count pictures, $different of them differ"
((count > 0 && different == 0))
