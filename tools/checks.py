# SPDX-License-Identifier: BSD-3-Clause
"""The command line of the checks of the tree: each names a folder and prints what it finds, a line each."""
import pathlib
import sys


def main(usage, violations):
    """Prints violations(root) and exits with 1 where there are any; `usage`: for another command line."""
    if len(sys.argv) != 2:
        sys.exit(usage)
    found = list(violations(pathlib.Path(sys.argv[1]).resolve()))
    for line in found:
        print(line)
    sys.exit(1 if found else 0)
