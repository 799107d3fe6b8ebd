#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Puts the licences of the libraries that auditwheel copies into a wheel there too.

usage: wheel_licences.py WHEEL

The licences are Debian's (/usr/share/doc/PACKAGE/copyright), for every library that the wheel's modules link and that
manylinux systems lack. A library without a licence is an error.
"""
import base64
import hashlib
import pathlib
import subprocess
import sys
import tempfile
import zipfile

# Libraries that every manylinux system has (PEP 600), so wheels do not contain them.
OF_THE_SYSTEM = ("libc.so", "libm.so", "libpthread.so", "libdl.so", "librt.so", "libstdc++.so", "libgcc_s.so",
                 "ld-linux", "linux-vdso")


def libraries(module):
    """Returns the paths of the libraries that a module needs beyond the system's."""
    said = subprocess.run(["ldd", module], capture_output=True, text=True, check=True).stdout
    for line in said.splitlines():
        name, arrow, rest = line.strip().partition(" => ")
        if arrow and not name.startswith(OF_THE_SYSTEM):
            yield pathlib.Path(rest.split()[0]).resolve()


def licence(library):
    """Returns (package, its licence)."""
    # On systems with a merged /usr, dpkg may know the file by its older name, without /usr.
    for name in (str(library), str(library).removeprefix("/usr")):
        found = subprocess.run(["dpkg", "-S", name], capture_output=True, text=True)
        if found.returncode == 0:
            package = found.stdout.split(":")[0]
            return package, pathlib.Path(f"/usr/share/doc/{package}/copyright").read_bytes()
    raise SystemExit(f"{library}: of no Debian package, so its licence is not known")


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    wheel = pathlib.Path(sys.argv[1])
    texts = {}
    with zipfile.ZipFile(wheel) as old, tempfile.TemporaryDirectory() as folder:
        contents = {name: old.read(name) for name in old.namelist()}
        for name in contents:
            if name.endswith(".so"):
                for library in libraries(old.extract(name, folder)):
                    package, text = licence(library)
                    texts[package] = text
    record = next(name for name in contents if name.endswith(".dist-info/RECORD"))
    info = record.rpartition("/")[0]
    lines = contents.pop(record).decode()
    for package, text in sorted(texts.items()):
        name = f"{info}/licenses/{package}.txt"
        contents[name] = text
        digest = base64.urlsafe_b64encode(hashlib.sha256(text).digest()).rstrip(b"=").decode()
        lines += f"{name},sha256={digest},{len(text)}\n"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as new:
        for name, data in contents.items():
            new.writestr(name, data)
        new.writestr(record, lines)
    print(f"licences of {', '.join(sorted(texts))}")


if __name__ == "__main__":
    main()
