# SPDX-License-Identifier: BSD-3-Clause
"""The shared command line of the tree's checks: the argument is a folder, and each line of output is a finding."""
import pathlib
import sys


def main(usage, violations):
    """Prints violations(root) and exits with 1 if there are any. Prints `usage` for a wrong command line."""
    if len(sys.argv) != 2:
        sys.exit(usage)
    found = list(violations(pathlib.Path(sys.argv[1]).resolve()))
    for line in found:
        print(line)
    sys.exit(1 if found else 0)
