# SPDX-License-Identifier: BSD-3-Clause
# Part of release.sh: Pythons, zig, and the libraries that packages contain, compiled for their systems.

# python_of VERSION: a Python of this version, on the PATH, of pyenv, or compiled here.
python_of() {
  local found
  for found in "$(command -v "python$1" || true)" "$HOME"/.pyenv/versions/"${1%t}".*[0-9]"${1//[0-9.]/}"/bin/python "$work/$1/bin/python$1"; do
    [[ -x "$found" ]] && "$found" -c '' 2>/dev/null && { echo "$found"; return; }
  done
  return 1
}

# Debian 13 has the sources of a Python without the global lock, and no package of it. One of Debian's patches loses the folder of
# that Python's packages.
python_3_13t() {
  python_of 3.13t >/dev/null && return
  rm -rf "$work/3.13t-source"  # the patch can be taken back once
  fetch_sources trixie 3.13t-source python3.13
  (cd "$work"/3.13t-source/python*/ && patch -s -R -p1 <debian/patches/distutils-install-layout.diff &&
    ./configure -q --disable-gil --without-ensurepip "--prefix=$work/3.13t" && make -s -j "$(nproc)" && make -s install) >"$work/3.13t.log" 2>&1 ||
    { tail -n 40 "$work/3.13t.log" >&2; return 1; }
}

# new_environment PYTHON FOLDER: a virtual environment. Debian's sources of Python have no pip in them, and virtualenv brings one.
new_environment() {
  if [[ $1 == *t ]]; then
    "$(tools)/bin/virtualenv" -q --clear -p "$(python_of "$1")" "$2" >&2
  else
    "$(python_of "$1")" -m venv --clear "$2" >&2
  fi
}

# environment PYTHON: a virtual environment with what wheels are built with; prints its folder.
environment() {
  local folder="$work/python-$1"
  if [[ ! -x $folder/bin/auditwheel ]]; then
    new_environment "$1" "$folder"
    "$folder/bin/pip" install -q --disable-pip-version-check -r packaging/requirements.txt "ziglang==$zig_version" >&2
  fi
  echo "$folder"
}

# The environment of the scripts, of zig and of pip: that of the first Python that is here and can make one.
tools() {
  local python
  for python in "${pythons[@]}"; do
    [[ $python != *t ]] && python_of "$python" >/dev/null && { environment "$python"; return; }
  done
  echo "release: there is no Python here, of ${pythons[*]}" >&2
  exit 2
}

zig() { echo "$(tools)"/lib/python*/site-packages/ziglang/zig; }

# fetch_sources RELEASE FOLDER PACKAGE…: Debian's source packages of the libraries, unpacked into $work/FOLDER. The machine's own
# lists stay as they are.
fetch_sources() {
  [[ "$(cat "$work/$2/complete" 2>/dev/null)" == "$*" ]] && return
  local lists="$work/apt"
  rm -rf "${work:?}/$2" "$lists"
  mkdir -p "$work/$2" "$lists/lists/partial" "$lists/cache/archives/partial"
  echo "deb-src http://deb.debian.org/debian $1 main" >"$lists/sources.list"
  local options=(-o "Dir::Etc::SourceList=$lists/sources.list" -o Dir::Etc::SourceParts=/dev/null
    -o "Dir::State::Lists=$lists/lists" -o "Dir::Cache=$lists/cache" -o APT::Sandbox::User=)
  apt-get "${options[@]}" -qq update
  (cd "$work/$2" && apt-get "${options[@]}" -qq source "${@:3}")
  echo "$*" >"$work/$2/complete"
}

# configure FOLDER SOURCE TARGET OPTION…: for zig's TARGET, with the libraries for files of that target.
configure() {
  local folder="$1" source="$2" target="$3"
  mkdir -p "$(dirname "$folder")"
  cmake --no-warn-unused-cli -G Ninja -S "$source" -B "$folder" -DCMAKE_BUILD_TYPE=Release "-DCMAKE_TOOLCHAIN_FILE=$PWD/packaging/zig.cmake" \
    "-DRASTRUM_ZIG=$(zig)" "-DRASTRUM_ZIG_TARGET=$target" "-DCMAKE_FIND_ROOT_PATH=$work/$target/prefix" \
    -DCMAKE_{C,CXX}_COMPILER_LAUNCHER=ccache "-DCMAKE_INSTALL_PREFIX=$work/$target/prefix" "-DCMAKE_INSTALL_LIBDIR=$work/$target/prefix/lib" "${@:4}" >"$folder.log"
}

# library TARGET NAME SOURCE OPTION…: compiles and installs a library of others for TARGET, once.
library() {
  local folder="$work/$1/$2" made_of
  made_of="$* $(cat "$work/sources/complete") $(sha256sum <"$3/CMakeLists.txt")"
  [[ "$(cat "$folder/complete" 2>/dev/null)" == "$made_of" ]] && return
  rm -rf "$folder"
  configure "$folder" "$3" "$1" -DBUILD_SHARED_LIBS=OFF -DBUILD_TESTING=OFF -DCMAKE_POSITION_INDEPENDENT_CODE=ON \
    -DCMAKE_{C,CXX}_VISIBILITY_PRESET=hidden -DCMAKE_POLICY_DEFAULT_CMP0063=NEW "${@:4}"
  cmake --build "$folder" --target install >>"$folder.log"
  echo "$made_of" >"$folder/complete"
}

# needed_libraries TARGET OPTION…: the libraries that Rastrum needs.
needed_libraries() {
  library "$1" third packaging/third_parties "-DSOURCES=$work/sources" "${@:2}"
  library "$1" jpeg "$(echo "$work"/sources/libjpeg-turbo-*/)" -DENABLE_SHARED=OFF -DWITH_SIMD=OFF -DWITH_TURBOJPEG=OFF
}

# Those that a file or a terrain may ask for.
more_libraries() {
  library "$1" imath "$(echo "$work"/sources/imath-*/)"
  library "$1" openexr "$(echo "$work"/sources/openexr-*/)" -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_{EXAMPLES,TOOLS}=OFF
  library "$1" muparser "$(echo "$work"/sources/muparser-*/)" -DENABLE_{SAMPLES,OPENMP}=OFF
}

# For systems that are not here.
libraries_elsewhere() {
  local target
  for target in x86_64-windows-gnu aarch64-macos; do
    needed_libraries "$target"
    more_libraries "$target"
  done
}

# The licence of each library in the programs: NAME=FILE.
program_licences() {
  local name zig
  zig="$(dirname "$(zig)")"
  echo "rastrum=LICENSE"
  echo "font=rastrum/overlay/font/LICENSE"
  echo "colour_maps=rastrum/scene/color_maps/LICENSE"
  for name in "${sources[@]}"; do echo "$name=$(echo "$work/sources/$name"-*/debian/copyright)"; done
  for name in hwy nlohmann-json3 cli11; do echo "$name=$(echo /usr/share/doc/*"$name"-dev/copyright)"; done
  echo "libc++=$zig/lib/libcxx/LICENSE.TXT"
  echo "musl=$zig/lib/libc/musl/COPYRIGHT"
  echo "zig=$zig/LICENSE"
}
