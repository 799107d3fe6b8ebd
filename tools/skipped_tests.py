#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Says in one line how many tests were skipped, why, and what would run them.

usage: skipped_tests.py JUNIT.XML   (from `ctest --output-junit`)
"""
import collections
import re
import sys
import xml.etree.ElementTree

# A reason that tests give, and its remedy.
REMEDIES = (
    (r"is not (t)?here|shared data|shared/data|there is no /|no file", "want meshes that are not the project's own"
     " (RASTRUM_SHARED names their folder; generated scenes test the same code)"),
    (r"RASTRUM_FULL|check --full", "take long (./dev check --full)"),
    (r"\bGPU\b|device", "want an NVIDIA GPU (./dev gpu)"),
    (r"CCCL|DEVICE_CODE", "want the headers of CUDA's toolkit (-DRASTRUM_TEST_DEVICE_CODE=ON)"),
    (r"built without|is missing|sanitizer", "want what this build has not"),
)


def remedy(output):
    return next((what for pattern, what in REMEDIES if re.search(pattern, output)), "say why themselves (ctest -V)")


def summary(file):
    """Returns the line, empty if nothing was skipped."""
    tests = list(xml.etree.ElementTree.parse(file).iter("testcase"))
    skipped = [test for test in tests if test.find("skipped") is not None]
    reasons = collections.Counter(remedy(test.findtext("system-out") or "") for test in skipped)
    python = sum(int(count) for test in tests if test.get("name", "").startswith("python")
                 for count in re.findall(r"(\d+) skipped", test.findtext("system-out") or ""))
    if python:
        reasons["are Python's and want packages or data that are not here (pytest -rs python/tests)"] = python
    if not reasons:
        return ""
    parts = ", ".join(f"{count} {what}" for what, count in reasons.most_common())
    return f"{sum(reasons.values())} tests were skipped: {parts}"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    if line := summary(sys.argv[1]):
        print(line)
