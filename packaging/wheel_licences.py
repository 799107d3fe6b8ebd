#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Puts the licences of the libraries that a wheel contains into it.

usage: wheel_licences.py WHEEL NAME=LICENCE…     LICENCE is the file of the library NAME
"""
import base64
import hashlib
import pathlib
import sys
import zipfile


def main():
    if len(sys.argv) < 3:
        raise SystemExit(__doc__)
    wheel, *pairs = sys.argv[1:]
    with zipfile.ZipFile(wheel) as old:
        contents = {entry: old.read(entry) for entry in old.infolist()}
    record = next(entry for entry in contents if entry.filename.endswith(".dist-info/RECORD"))
    lines = contents.pop(record).decode()
    for pair in pairs:
        name, _, file = pair.partition("=")
        entry = zipfile.ZipInfo(f"{record.filename.rpartition('/')[0]}/licenses/{name}.txt", record.date_time)
        contents[entry] = pathlib.Path(file).read_bytes()
        digest = base64.urlsafe_b64encode(hashlib.sha256(contents[entry]).digest()).rstrip(b"=").decode()
        lines += f"{entry.filename},sha256={digest},{len(contents[entry])}\n"
    contents[record] = lines.encode()
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as new:
        for entry, data in contents.items():
            new.writestr(entry, data, zipfile.ZIP_DEFLATED)


if __name__ == "__main__":
    main()
