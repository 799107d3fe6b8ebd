#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Fetches Rastrum's dependencies for AArch64 from Debian's mirrors and unpacks them, without root.
# The machine's package manager keeps its one architecture.
#
# usage: aarch64_root.sh FOLDER   (FOLDER/usr is then what cmake/aarch64.cmake looks into)
set -euo pipefail

readonly folder="${1:?usage: aarch64_root.sh FOLDER}"
# Packages that find_package looks for, then those that programs linked with these need to run.
readonly packages=(
  libtbb-dev libhwy-dev libpng-dev libdeflate-dev libjpeg62-turbo-dev nlohmann-json3-dev libmuparser-dev libgtest-dev
  libtbb12 libtbbmalloc2 libtbbbind-2-5 libhwy1 libpng16-16 libdeflate0 libjpeg62-turbo zlib1g zlib1g-dev libmuparser2v5
)
readonly done_mark="$folder/packages"
[[ "$(cat "$done_mark" 2>/dev/null)" != "${packages[*]}" ]] || exit 0

rm -rf "$folder"
mkdir -p "$folder/apt/lists/partial" "$folder/apt/cache/archives/partial" "$folder/debs"
: >"$folder/apt/status"
root="$(cd "$folder" && pwd)"
readonly root
options=(-o APT::Architecture=arm64 -o APT::Architectures=arm64 -o "Dir::State::lists=$root/apt/lists"
  -o "Dir::State::status=$root/apt/status" -o "Dir::Cache=$root/apt/cache" -o APT::Sandbox::User=)
apt-get "${options[@]}" -qq update
(cd "$root/debs" && apt-get "${options[@]}" -qq download "${packages[@]}")
for deb in "$root"/debs/*.deb; do dpkg -x "$deb" "$root"; done
# Headers that depend on the architecture are one folder deeper, where the cross compiler looks only
# in its own root.
cp -r "$root"/usr/include/aarch64-linux-gnu/. "$root/usr/include/"
# /lib is /usr/lib, as on an installed system.
cp -a "$root/lib/." "$root/usr/lib/"
rm -rf "$root/apt" "$root/debs"
echo "${packages[*]}" >"$done_mark"
