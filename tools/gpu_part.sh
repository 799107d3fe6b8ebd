#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs one part of the checks that need a GPU, with the programs that `./dev gpu --pack` put beside
# this script. The machine needs only a driver. Each part ends within RASTRUM_PART_S seconds (570).
#
#   gpu_part.sh            list the parts, the most telling first
#   gpu_part.sh PART OUT   run one; its log and what it writes go to the folder OUT
#   gpu_part.sh all OUT    run all in that order, within RASTRUM_ALL_S seconds (1800) together; a failure
#                          stops no other part, and a part without time left fails
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
readonly here self="$here/$(basename "${BASH_SOURCE[0]}")"
readonly limit="${RASTRUM_PART_S:-570}"
export LD_LIBRARY_PATH="$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"

readonly parts=(words rasterizer terrain bench memcheck racecheck synccheck initcheck)

limited() { timeout --kill-after=10 "$limit" "$@"; }

# All programs share one limit: each one gets the rest of it.
sanitize() {
  local tool="$1" exit_code="$2" binary filter end=$((SECONDS + limit)) left status=0
  if ! command -v compute-sanitizer >/dev/null; then
    echo "ERROR: this machine has no compute-sanitizer (package cuda-sanitizer)"
    return 1
  fi
  while read -r binary filter; do
    left=$((end - SECONDS))
    ((left > 0)) || { echo "ERROR: no time was left for $binary"; return 124; }
    timeout --kill-after=10 "$left" compute-sanitizer --tool "$tool" --error-exitcode "$exit_code" \
      "$here/bin/$binary" --gtest_filter="$filter" </dev/null || status=$?
  done <"$here/sanitized.txt"
  return "$status"
}

run_part() {
  case "$1" in
    # All scenes of layers in every budget, down to a turn a block, would take the part's whole
    # time.
    words) RASTRUM_TEST_SHARE="${RASTRUM_TEST_SHARE:-10}" limited "$here/bin/cuda_device_test" </dev/null ;;
    rasterizer) limited "$here/bin/cuda_rasterizer_on_device" </dev/null ;;
    terrain) limited "$here/bin/cuda_terrain_on_device" </dev/null ;;
    bench) limited "$here/bin/rastrum" bench cuda --quick --out "$out" </dev/null ;;
    memcheck | racecheck | synccheck) sanitize "$1" 1 ;;
    # Padding and CUB's own tiles are known false alarms, so its reports need a reader.
    initcheck) sanitize "$1" 0 ;;
    *) echo "gpu_part.sh: no part $1; there are ${parts[*]}" >&2; return 2 ;;
  esac
}

run_all() {
  local part left end=$((SECONDS + ${RASTRUM_ALL_S:-1800})) failed=0
  for part in "${parts[@]}"; do
    left=$((end - SECONDS))
    if ((left <= 0)); then
      echo "$part: FAILED: no time was left" | tee -a "$out/results"
      failed=$((failed + 1))
    else
      RASTRUM_PART_S=$((left < limit ? left : limit)) bash "$self" "$part" "$out" || failed=$((failed + 1))
    fi
  done
  printf '\n%s:\n' "$out/results"
  cat "$out/results"
  ((failed == 0))
}

if (($# == 0)); then
  printf "%s\n" "${parts[@]}"
  exit
fi
(($# == 2)) || { echo "usage: gpu_part.sh [PART OUT]" >&2; exit 2; }
mkdir -p "$2"
out="$(cd "$2" && pwd)"
if [[ $1 == all ]]; then
  : >"$out/results"
  run_all
  exit
fi
log="$out/$1.log"
started=$SECONDS
status=0
{
  command -v nvidia-smi >/dev/null && nvidia-smi -L || echo "no nvidia-smi"
  date -u +%FT%TZ
} >"$log" 2>&1
run_part "$1" > >(tee -a "$log") 2>&1 || status=$?
wait  # for the log
# A test that finds no device is skipped. Here that is a failure.
if ((status == 0)) && grep -q 'no device: ' "$log"; then
  echo "ERROR: tests found no device that they could use" | tee -a "$log"
  status=1
fi
case "$status" in
  0) result=passed ;;
  124 | 137) result="FAILED: not done within $limit s" ;;
  *) result="FAILED: exit status $status" ;;
esac
printf '%s: %s after %d s\n' "$1" "$result" $((SECONDS - started)) | tee -a "$out/results"
exit "$status"
