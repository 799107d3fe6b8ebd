#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the colour maps' table, rastrum/scene/color_maps/tables.inc, and samples of the published maps for its
test, tests/scene/color_maps_published.inc.

usage: color_maps.py ROOT      (needs matplotlib; no build runs this)

Reads the tables of Matplotlib 3.9.2 (matplotlib/_cm.py, _cm_listed.py), which has the maps as their authors published
them; rastrum/scene/color_maps/LICENSE names authors and licences. Published colours are kept at even steps and
blended linearly: 256 or 510 of listed maps, 9 or 11 of ColorBrewer's, the 33 of coolwarm. Maps made of line segments
whose corners lie at uneven steps (jet, hot, bone, hsv) are sampled at 256. Colours are rounded to 8 bits.
"""
import pathlib
import sys

import matplotlib
import numpy as np
from matplotlib import _cm, colormaps

# In the order of color_map_names().
SEQUENTIAL = ["viridis", "plasma", "inferno", "magma", "cividis", "turbo", "gray", "hot", "bone", "jet",
              "Blues", "Greens", "Greys", "Oranges", "Purples", "Reds", "YlGnBu", "YlOrRd"]
DIVERGING = ["coolwarm", "RdBu", "RdYlBu", "Spectral", "PiYG"]
CYCLIC = ["twilight", "hsv"]
QUALITATIVE = ["tab10", "tab20", "Set1", "Set2", "Dark2", "Paired"]
SAMPLES = 18


def published(name):
    """Returns Matplotlib's own colours of a map, N × 3, float64: colour i is that of the value i/(N − 1)."""
    colors = colormaps[name].copy()
    return np.array([colors(i)[:3] for i in range(colors.N)])


def kept(name):
    """Returns the colours for the table."""
    data = _cm.datad.get(name)
    if isinstance(data, tuple):  # ColorBrewer's
        return np.array(data)
    if isinstance(data, dict) and "red" in data:
        corners = [np.array(data[c])[:, 0] for c in ("red", "green", "blue")] \
            if not any(callable(data[c]) for c in ("red", "green", "blue")) else [np.zeros(0)]
        n = len(corners[0])
        if all(len(c) == n and np.allclose(c, np.linspace(0, 1, n)) for c in corners):
            return np.array([[row[1] for row in data[c]] for c in ("red", "green", "blue")]).T
    return published(name)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[1])
    by = f"// Made by tools/color_maps.py from Matplotlib {matplotlib.__version__}'s tables"
    table = [by + "; whose they are: LICENSE.",
             "// Name, whether its colours are categories, and they as RRGGBB.",
             "inline constexpr PublishedMap kPublishedMaps[] = {"]
    samples = [by + ".",
               "// Name, colours of its own table, and of these some: place, then R, G, B in 1/65535."]
    for name in SEQUENTIAL + DIVERGING + CYCLIC + QUALITATIVE:
        digits = "".join("%02x%02x%02x" % tuple(np.rint(c * 255).astype(int)) for c in kept(name))
        discrete = "true" if name in QUALITATIVE else "false"
        table.append(f'    {{"{name}", {discrete},')
        table += [f'     "{digits[i:i + 90]}"' for i in range(0, len(digits), 90)]
        table[-1] += "},"
        own = published(name)
        at = sorted({int(i) for i in np.rint(np.linspace(0, len(own) - 1, SAMPLES))})
        samples.append(f'    {{"{name}", {len(own)}, {{')
        samples += [f"      {{{i}, {', '.join(str(int(v)) for v in np.rint(own[i] * 65535))}}},"
                    for i in at]
        samples.append("    }},")
    (root / "rastrum/scene/color_maps/tables.inc").write_text("\n".join([*table, "};", ""]))
    (root / "tests/scene/color_maps_published.inc").write_text("\n".join([*samples, ""]))


main()
