# SPDX-License-Identifier: BSD-3-Clause
"""The rastrum contender with normals, in one frame."""
from contenders import rastrum

REQUIREMENTS = rastrum.REQUIREMENTS


def prepare(scene):
    return rastrum.prepare(scene, ("color", "id", "normal"))
