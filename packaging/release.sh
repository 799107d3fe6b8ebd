#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes packages that ask nothing of the system, in out/release (`./dev release`).
#
# usage: packaging/release.sh [PART…]     (all parts without a PART)
#   wheels    Python's, for x86-64 and AArch64 with glibc 2.17 or later; for Windows and macOS, where nobody has tried them
#   programs  `rastrum` as one static file, for both; for Windows; for macOS, where nobody has run it
#   try       all but that, where they have nothing else (root; qemu-user-static for AArch64; wine64)
#   sdist     the source package for Python, built and tried without network
#   deb       Debian's packages, tried in a Debian that has nothing else (root, mmdebstrap)
#   image     the programs as images of containers (umoci), tried by podman
#   sbom      which libraries wheels and programs contain (CycloneDX)
#   wasm      the library for browsers, as an npm package, tried in chromium
#   quick_wheel, quick_wasm  not of all: compiled in minutes and tried, for `./dev check`
#
# zig's clang compiles them (PyPI's ziglang), which has the libraries of old systems. The libraries for files are static,
# of Debian's source packages (third_parties/CMakeLists.txt), whose licences travel along.
set -euo pipefail
shopt -s inherit_errexit
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly work="$PWD/build/packages" out="$PWD/out/release" zig_version=0.17.0
readonly processors=(x86_64 aarch64)
# Debian's source packages that packages contain. Draco is not there, because it takes minutes, nor what is loaded by its name
# when a file asks for it (libwebp, GDAL).
readonly sources=(zlib libpng1.6 libdeflate libjpeg-turbo meshoptimizer imath openexr muparser)
# The wheel for 3.12 serves all later Pythons that have the global lock; a `t` is for one without.
readonly pythons=(3.10 3.11 3.12 3.13t 3.14t)

version() { sed -n 's/^#define RASTRUM_VERSION_.* //p' include/rastrum/version.hpp | paste -sd.; }

source packaging/compile.sh
source packaging/trials.sh

# wheel TARGET PLATFORM PYTHON BUILD FOLDER OPTION…: compiled in BUILD, into FOLDER; PLATFORM is Python's name of zig's TARGET;
# OPTIONs are pip's.
wheel() {
  local target="$1" platform="$2" environment name zig licences=()
  environment="$(environment "$3")"
  zig="$(zig)"
  local options=(
    "build-dir=$4"
    "cmake.define.CMAKE_TOOLCHAIN_FILE=$PWD/packaging/zig.cmake"
    "cmake.define.CMAKE_FIND_ROOT_PATH=$work/$target/prefix"
    "cmake.define.RASTRUM_ZIG=$zig"
    "cmake.define.RASTRUM_ZIG_TARGET=$target"
    cmake.define.RASTRUM_TBB=OFF
    cmake.define.CMAKE_DISABLE_FIND_PACKAGE_{OpenEXR,muparser}=OFF
  )
  rm -rf "$work/$target/wheel"
  _PYTHON_HOST_PLATFORM="$platform" SETUPTOOLS_EXT_SUFFIX=".cpython-${3/./}-${target%%-*}-linux-gnu.so" CMAKE_GENERATOR=Ninja \
    "$environment/bin/pip" wheel . -q --no-deps --disable-pip-version-check --no-build-isolation -w "$work/$target/wheel" "${options[@]/#/--config-settings=}" "${@:6}"
  for name in "${sources[@]}"; do licences+=("$name=$(echo "$work/sources/$name"-*/debian/copyright)"); done
  licences+=("libc++=$(dirname "$zig")/lib/libcxx/LICENSE.TXT")
  [[ $target != *-windows-* ]] || licences+=("mingw-w64=$(dirname "$zig")/lib/libc/mingw/COPYING")
  licences+=("nanobind=$(echo "$environment"/lib/python*/site-packages/nanobind-*/licenses/LICENSE)")
  "$environment/bin/python" packaging/wheel_licences.py "$work/$target/wheel"/*.whl "${licences[@]}"
  if [[ $platform == linux-* ]]; then
    PATH="$environment/bin:$PATH" auditwheel repair --plat auto -w "$5" "$work/$target/wheel"/*.whl
  else
    mv "$work/$target/wheel"/*.whl "$5"
  fi
}

# stable_wheel TARGET PLATFORM: a wheel for a system whose Python is not here. The headers are those of this system's Python 3.12
# with another pyconfig.h. Windows also wants a library of the stable ABI's names.
stable_wheel() {
  local folder="$work/$1/python" source
  fetch_sources trixie 3.13t-source python3.13
  source="$(echo "$work"/3.13t-source/python3*/PC)"
  rm -rf "$folder"
  mkdir -p "$work/$1"
  cp -r "$("$(python_of 3.12)" -c "import sysconfig; print(sysconfig.get_path('include'))")" "$folder"
  local options=(
    "Python_INCLUDE_DIR=$folder"
    # The build cannot run the program that writes it.
    "RASTRUM_OUTPUTS_PYI=$work/x86_64-linux-gnu.2.17/build-3.12/python/site/rastrum/_outputs.pyi"
  )
  if [[ $1 == *-windows-* ]]; then
    cp "$source/pyconfig.h.in" "$folder/pyconfig.h"
    (echo EXPORTS && sed -nE 's/^EXPORT_FUNC\((.*)\)$/\1/p; s/^EXPORT_DATA\((.*)\)$/\1 DATA/p' "$source/python3dll.c") >"$folder/python3.def"
    "$(zig)" dlltool -m i386:x86-64 -D python3.dll -d "$folder/python3.def" -l "$folder/libpython3.a"
    # CMake asks for a library of this version, which is not linked. Modules are called .pyd there.
    ln -s libpython3.a "$folder/libpython312.a"
    options+=("Python_SABI_LIBRARY=$folder/libpython3.a" "Python_LIBRARY=$folder/libpython312.a" SKBUILD_SOSABI=)
  else
    cp packaging/pyconfig_macos.h "$folder/pyconfig.h"
  fi
  wheel "$1" "$2" 3.12 "$work/$1/build-3.12" "$out" "${options[@]/#/--config-settings=cmake.define.}"
}

make_wheels() {
  local processor python
  python_3_13t
  for processor in "${processors[@]}"; do
    needed_libraries "$processor-linux-gnu.2.17"
    more_libraries "$processor-linux-gnu.2.17"
    for python in "${pythons[@]}"; do
      python_of "$python" >/dev/null || { echo "note: there is no Python $python here, so no wheel for it"; continue; }
      wheel "$processor-linux-gnu.2.17" "linux-$processor" "$python" "$work/$processor-linux-gnu.2.17/build-$python" "$out"
    done
  done
  python_of 3.12 >/dev/null || { echo "note: there is no Python 3.12 here, so no wheels for Windows and macOS"; return; }
  libraries_elsewhere
  stable_wheel x86_64-windows-gnu win-amd64
  stable_wheel aarch64-macos macosx-15.0-arm64
}

# program TARGET NAME [SUFFIX]: NAME in $out; SUFFIX is what the system adds to a program's name.
program() {
  configure "$work/$1/program" . "$1" -DRASTRUM_TBB=OFF -DRASTRUM_UNITY=ON -DRASTRUM_PYTHON=OFF \
    -DRASTRUM_BUILD_TESTS=OFF -DRASTRUM_BUILD_EXAMPLES=OFF -DRASTRUM_BUILD_BENCH=OFF -DRASTRUM_INSTALL=OFF \
    -DCMAKE_EXE_LINKER_FLAGS=-s
  cmake --build "$work/$1/program" --target rastrum_program
  cp "$work/$1/program/apps/rastrum/rastrum${3:-}" "$out/$2"
}

make_programs() {
  local processor target
  for processor in "${processors[@]}"; do
    target="$processor-linux-musl"
    needed_libraries "$target"
    more_libraries "$target"
    program "$target" "rastrum-linux-$processor"
  done
  libraries_elsewhere
  program x86_64-windows-gnu rastrum-windows-x86_64.exe .exe
  program aarch64-macos rastrum-macos-arm64
}

# The source package for Python, of the last commit. It is compiled without network and passes the test whose digests all
# machines share.
make_sdist() {
  local environment folder="$work/sdist"
  environment="$(tools)"
  rm -rf "$folder"
  mkdir -p "$folder"/{tree,unpacked}
  git archive HEAD | tar -x -C "$folder/tree"
  (cd "$folder/tree" && "$environment/bin/python" -c "import scikit_build_core.build as b; b.build_sdist('$out')" >"$folder/log")
  tar -xf "$out/rastrum-$(version).tar.gz" -C "$folder/unpacked" --strip-components 1
  "$environment/bin/python" -m venv --clear "$folder/try"
  "$folder/try/bin/pip" install -q --disable-pip-version-check -r packaging/requirements.txt ninja numpy pytest
  PATH="$folder/try/bin:$PATH" unshare -n "$folder/try/bin/pip" install -q --disable-pip-version-check --no-index \
    --no-build-isolation "$out/rastrum-$(version).tar.gz"
  (cd "$folder/unpacked" && unshare -n "$folder/try/bin/python" -m pytest -q -p no:cacheprovider python/tests/test_pictures.py)
}

# Which libraries the wheels and the programs contain, as CycloneDX.
make_sbom() {
  local environment
  environment="$(tools)"
  "$environment/bin/pip" install -q --disable-pip-version-check 'cyclonedx-python-lib[json-validation]>=11,<12'
  "$environment/bin/python" packaging/sbom.py "$(version)" "$out/rastrum-$(version).cdx.json" "$work/sources" "${sources[@]}"
}

# The programs as images for podman and its like, which hold nothing else but licences; the one for this processor is tried.
make_image() {
  local processor file library licence image root folder="$work/image" when name
  local -A architectures=([x86_64]=amd64 [aarch64]=arm64)
  when="$(date -u -d "@$SOURCE_DATE_EPOCH" +%Y-%m-%dT%H:%M:%SZ)"
  name="rastrum:$(version)"
  rm -rf "$folder"
  for processor in "${processors[@]}"; do
    image="$folder/$processor/layout" root="$folder/$processor/bundle/rootfs" file="$out/rastrum-image-$processor.tar"
    mkdir -p "$folder/$processor"
    umoci init --layout "$image"
    umoci new --image "$image:new"
    umoci unpack --rootless --image "$image:new" "$folder/$processor/bundle"
    mkdir "$root/licences"
    cp "$out/rastrum-linux-$processor" "$root/rastrum"
    while IFS='=' read -r library licence; do
      cp "$licence" "$root/licences/$library.txt"
    done < <(program_licences)
    find "$root" -exec touch -d "@$SOURCE_DATE_EPOCH" {} +
    # `umoci insert` would do in one step, and leaves out the end of the layer's archive, which tar misses.
    umoci repack --image "$image:new" --history.created "$when" --history.author rastrum --history.created_by packaging/release.sh \
      "$folder/$processor/bundle"
    umoci config --image "$image:new" --no-history --created "$when" --os linux --architecture "${architectures[$processor]}" \
      --config.entrypoint /rastrum --config.workingdir /work --config.label org.opencontainers.image.licenses=BSD-3-Clause
    umoci gc --layout "$image"
    sed -i "s/\"new\"/\"$name\"/" "$image/index.json"
    tar -C "$image" --sort=name "--mtime=@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner --mode=u=rwX,go=rX -cf "$file" .
  done
  # What containers want of a kernel is turned down, so that these run in a container, too.
  local podman=(podman --cgroup-manager=cgroupfs --events-backend=file --storage-driver=vfs --root "$folder/podman"
    --runroot "$folder/run" --runtime runc)
  "${podman[@]}" load -q -i "$out/rastrum-image-$(uname -m).tar"
  diff <(packaging/digests.sh "${podman[@]}" run -i --rm --network none --ulimit nofile=1024:1024 --ulimit nproc=1024:1024 \
    "localhost/$name") packaging/digests.txt
  # What the GitHub Action runs.
  packaging/recipes/action/compare.sh "$out/rastrum-linux-$(uname -m)" \
    <(sed 's/  \([^ ]*\) / builtin:\1 --look plain --size 320x240 /' packaging/digests.txt) "$folder/pictures"
}

# wasm FOLDER OPTION…: the package for browsers in FOLDER/package, tried in Chromium; OPTIONs are CMake's. Debian 12's Highway
# refuses some kernels for WebAssembly, Debian 13's does not.
wasm() {
  local target=wasm32-wasi folder="$1" library licence
  fetch_sources trixie highway highway
  needed_libraries "$target" "-DHIGHWAY=$(echo "$work"/highway/highway-*/)"
  configure "$folder/module" packaging/wasm "$target" "${@:2}"
  cmake --build "$folder/module" --target module
  rm -rf "$folder/package"
  mkdir -p "$folder/package/licences"
  cp packaging/wasm/{index.html,package.json,rastrum.d.ts,rastrum.mjs,wasi.mjs,worker.mjs} "$folder/module/rastrum.wasm" "$folder/package"
  sed -i "s/\"version\": .*,/\"version\": \"$(version)\",/" "$folder/package/package.json"
  while IFS='=' read -r library licence; do
    cp "$licence" "$folder/package/licences/$library.txt"
  done < <(program_licences | grep -vE '^(imath|openexr|muparser|cli11)='; echo "wasi-libc=$(dirname "$(zig)")/lib/libc/wasi/LICENSE")
  python3 packaging/wasm/try.py "$folder/package"
}

make_wasm() {
  wasm "$work/wasm"
  tar -C "$work/wasm" --sort=name "--mtime=@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner --mode=u=rwX,go=rX -cf - package |
    gzip -n9 >"$out/rastrum-wasm-$(version).tgz"
}

# Debian's packages for this Debian, of the last commit: the library is compiled by its g++.
make_deb() {
  local folder="$work/deb" tree
  tree="$folder/rastrum-$(version)"
  rm -rf "$folder"
  mkdir -p "$tree"
  git archive HEAD | tar -x -C "$tree"
  cp -r packaging/debian "$tree/debian"
  (
    cd "$tree"
    printf 'rastrum (%s-1) bookworm; urgency=medium\n\n  * What is new: changelog.gz.\n\n -- %s  %s\n' "$(version)" \
      "$(sed -n 's/^Maintainer: //p' debian/control)" "$(date -u -R -d "@$SOURCE_DATE_EPOCH")" >debian/changelog
    {
      cat LICENSE
      printf '\nThe font that the library contains:\n\n'
      cat rastrum/overlay/font/LICENSE
      printf '\nThe colour maps that it contains:\n\n'
      sed '/^ *Apache License$/,$d' rastrum/scene/color_maps/LICENSE
      printf 'On Debian these licences are in /usr/share/common-licenses/Apache-2.0 and .../CC0-1.0.\n'
    } >debian/copyright
    dpkg-buildpackage -b -us -uc
  ) >"$work/deb.log" 2>&1 || { tail -n 40 "$work/deb.log" >&2; return 1; }
  # No bug of Debian's asked for the package.
  lintian --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs "$folder"/*.changes
  cp "$folder"/*rastrum*_*.deb "$out"
  try_deb "$folder/root"
}

# A wheel for this Debian's Python, little optimised and with the libraries that are needed, draws the pictures of digests.txt.
make_quick_wheel() {
  local folder="$work/quick_wheel"
  rm -rf "$folder"
  needed_libraries "$(uname -m)-linux-gnu.2.17"
  wheel "$(uname -m)-linux-gnu.2.17" "linux-$(uname -m)" 3.11 "$folder/build" "$folder" "--config-settings=cmake.define.CMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG -DRASTRUM_ONE_SIMD_TARGET"
  shapes "$folder/shapes" build/release/apps/rastrum/rastrum
  new_environment 3.11 "$folder/python"
  "$folder/python/bin/pip" install -q --disable-pip-version-check "$folder"/*.whl
  diff <("$folder/python/bin/python" packaging/digests.py packaging/digests.txt "$folder/shapes") packaging/digests.txt
}
make_quick_wasm() { wasm "$work/quick_wasm" "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG"; }

main() {
  SOURCE_DATE_EPOCH="$(git log -1 --format=%ct)"
  export SOURCE_DATE_EPOCH
  local part parts=("$@")
  ((${#parts[@]})) || { parts=(wheels programs try sdist deb image sbom wasm); rm -rf "$out"; }
  mkdir -p "$work" "$out"
  fetch_sources bookworm sources "${sources[@]}"
  for part in "${parts[@]}"; do
    case "$part" in
      wheels | programs | try | sdist | deb | image | sbom | wasm | quick_wheel | quick_wasm)
        SECONDS=0
        "make_$part"
        echo "release: $part took $SECONDS s"
        ;;
      *) echo "release: there is no part '$part'; the parts are wheels, programs, try, sdist, deb, image, sbom, wasm" >&2; exit 2 ;;
    esac
  done
  [[ -z "$(ls "$out")" ]] || (cd "$out" && rm -f SHA256SUMS && sha256sum -- * >"$work/sums" && mv "$work/sums" SHA256SUMS && ls -l)
}
main "$@"; exit  # the script may change meanwhile
