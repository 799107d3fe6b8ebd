# SPDX-License-Identifier: BSD-3-Clause
# Part of release.sh: tries packages where there is nothing else.

# inside ROOT PROCESSOR COMMAND…: runs a command where there is nothing but ROOT, and no network.
inside() {
  local emulator=() name="qemu-$2-static"
  if [[ $2 != "$(uname -m)" ]]; then
    # Two of a pipe come here at once, and a file that runs cannot be written.
    [[ -e $1/$name ]] || { cp "/usr/bin/$name" "$1/$name.$BASHPID" && mv "$1/$name.$BASHPID" "$1/$name"; }
    emulator=("/$name")
  fi
  unshare -n env -i "PATH=$PATH" HOME=/ PYTHONPATH=/site PYTHONDONTWRITEBYTECODE=1 chroot "$1" "${emulator[@]}" "${@:3}"
}
export -f inside  # for digests.sh

# shapes FOLDER PROGRAM: what digests.py reads.
shapes() {
  local shape
  mkdir -p "$1"
  while read -r _ shape _; do
    [[ -e $1/$shape.ply ]] || "$2" make "$shape" --quiet -o "$1/$shape.ply"
  done <packaging/digests.txt
}

# try_wheel RELEASE PROCESSOR PACKAGE…: a wheel and its PACKAGEs from PyPI, beside the Python of a Debian that has nothing else,
# draw the pictures of digests.txt. NumPy wants libstdc++. Prints the root's folder.
try_wheel() {
  local root="$work/root-$1-$2" python environment
  local -A architectures=([x86_64]=amd64 [aarch64]=arm64)
  [[ -e $root/usr/bin/python3 ]] || mmdebstrap --quiet --variant=extract --skip=check/qemu \
    "--architectures=${architectures[$2]}" --include=base-files,python3,libstdc++6 "$1" "$root" >&2
  python="$(basename "$(readlink "$root/usr/bin/python3")")"
  environment="$(tools)"
  rm -rf "$root"/{site,shapes}
  shapes "$root/shapes" "$out/rastrum-linux-$(uname -m)"
  cp packaging/digests.{py,txt} "$root"
  "$environment/bin/pip" install -q --disable-pip-version-check --target "$root/site" --only-binary :all: \
    --python-version "${python#python}" --platform "manylinux2014_$2" --platform "manylinux_2_27_$2" --platform "manylinux_2_28_$2" \
    --find-links "$out" "rastrum==$(version)" "${@:3}" >&2
  diff <(inside "$root" "$2" "/usr/bin/$python" /digests.py /digests.txt /shapes) packaging/digests.txt >&2
  inside "$root" "$2" "/usr/bin/$python" -c "
import numpy, time
start = time.perf_counter()
import rastrum
print(f'Debian $1, $2, $python: the digests are equal; import rastrum took {time.perf_counter() - start:.3f} s')" >&2
  echo "$root"
}

# Each program, alone in an empty folder, draws the pictures of digests.txt. So does the wheel where Debian has a Python for
# it. Each wheel of this processor passes the package's tests, and that for AArch64 those of pictures.
make_try() {
  local processor python root folder="$work/try"
  for processor in "${processors[@]}"; do
    echo "rastrum-linux-$processor"
    rm -rf "$folder"
    mkdir -p "$folder"
    cp "$out/rastrum-linux-$processor" "$folder/rastrum"
    diff <(packaging/digests.sh inside "$folder" "$processor" /rastrum) packaging/digests.txt
  done
  echo rastrum-windows-x86_64.exe
  local wine=(env WINEDEBUG=-all "WINEPREFIX=$work/wine" /usr/lib/wine/wine64 "$out/rastrum-windows-x86_64.exe")
  "${wine[@]}" --version  # makes wine's folder, which two of a pipe cannot
  diff <(packaging/digests.sh "${wine[@]}") packaging/digests.txt
  try_wheel trixie x86_64 >/dev/null
  try_wheel bookworm x86_64 >/dev/null
  root="$(try_wheel bookworm aarch64 pytest pillow)"
  rm -rf "$root"/{python,tests}
  mkdir "$root/python"
  cp -r python/tests "$root/python"
  cp -r tests "$root"
  # A process that Python itself starts has no emulator.
  inside "$root" aarch64 /usr/bin/python3 -m pytest -q -p no:cacheprovider -k "not ctrl_c" /python/tests/test_pictures.py
  for python in "${pythons[@]}" 3.13; do
    python_of "$python" >/dev/null || { echo "note: there is no Python $python here"; continue; }
    echo "Python $python"
    new_environment "$python" "$folder"
    "$folder/bin/pip" install -q --disable-pip-version-check numpy pytest pillow trimesh
    "$folder/bin/pip" install -q --disable-pip-version-check --no-index --find-links "$out" rastrum
    (cd /tmp && "$folder/bin/python" -m pytest -q -p no:cacheprovider "$OLDPWD/python/tests")
  done
}

# try_deb ROOT: in a Debian that has nothing else, the program draws, and the library's users are built.
try_deb() {
  local root="$1" inside=(chroot "$1" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive)
  mmdebstrap --quiet --variant=minbase bookworm "$root"
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  cp "$out"/*_"$(version)"-1_*.deb "$root/tmp"
  cp -r tests/install/user "$root/tmp/user"
  "${inside[@]}" sh -c 'apt-get -qq update && apt-get -qq install -y --no-install-recommends /tmp/rastrum_*.deb' >"$work/deb_try.log"
  diff <(packaging/digests.sh "${inside[@]}" rastrum) packaging/digests.txt
  "${inside[@]}" sh -ec 'apt-get -qq install -y --no-install-recommends /tmp/librastrum-dev_*.deb g++ cmake make pkgconf
    cmake -S /tmp/user -B /tmp/built -DCMAKE_BUILD_TYPE=Release && cmake --build /tmp/built && cd /tmp/built && ./core && ./io && ./family
    g++ -std=c++20 /tmp/user/core.cpp -o core-pc $(pkg-config --cflags --libs rastrum) && ./core-pc' >>"$work/deb_try.log"
  tail -n 1 "$work/deb_try.log"
}
