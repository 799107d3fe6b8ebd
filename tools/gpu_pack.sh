#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# gpu_pack.sh BUILD TO: copies the programs of a build with CUDA and their shared libraries into the
# folder TO, for gpu_part.sh on a machine with a GPU. Fails above 64 MiB.
set -euo pipefail

(($# == 2)) || { echo "usage: gpu_pack.sh BUILD TO" >&2; exit 2; }
readonly build="$1" to="$2" most_mib=64
tools="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
readonly tools

programs=()
for name in cuda_device_test cuda_rasterizer_on_device cuda_terrain_on_device; do
  programs+=("$build/tests/cuda/$name")
done
programs+=("$build/apps/rastrum/rastrum" "$build/apps/rastrum/rastrum-bench")
# Opened by name, so no program lists it.
module="$(find "$build" -name librastrum_cuda.so -type f -print -quit)"
for file in "${programs[@]}" "${module:-$build/…/librastrum_cuda.so}"; do
  [[ -f "$file" ]] || { echo "gpu_pack.sh: $file is not there; build it first" >&2; exit 1; }
done

rm -rf "$to"
mkdir -p "$to/bin" "$to/lib"
cp "${programs[@]}" "$to/bin"
cp "$module" "$to/lib"
strip "$to"/bin/* "$to"/lib/*

# Without the C library, which must fit the loader of each machine.
needed="$(ldd "${programs[@]}" "$module")"
if grep -F 'not found' <<<"$needed" >&2; then
  echo "gpu_pack.sh: these libraries are missing here" >&2
  exit 1
fi
awk '$2 == "=>" && $3 ~ /^\// { print $3 }' <<<"$needed" | sort -u |
  grep -vE '/(libc|libm|libdl|librt|libpthread|libcuda)\.so' | xargs -r cp -L -t "$to/lib"

cp "$tools/gpu_part.sh" "$tools/../tests/cuda/sanitized.txt" "$to"
bytes="$(du -sb "$to" | cut -f1)"
printf '%s: %d MiB\n' "$to" $((bytes / 1048576))
if ((bytes > most_mib * 1048576)); then
  echo "gpu_pack.sh: that is more than $most_mib MiB" >&2
  exit 1
fi
