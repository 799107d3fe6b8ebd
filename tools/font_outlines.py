#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the outlines of a TrueType font as the table rastrum/overlay/font/outlines.inc.

usage: font_outlines.py FONT.ttf OUT.inc      (needs fontTools; no build runs this)

The table has each glyph's advance and the points of each contour, in the font's units. A point's x is stored as x · 2,
plus 1 if the point lies on the curve. The font is DejaVu Sans 2.37 of Debian's fonts-dejavu-core 2.37-6; its licence is
beside the table.
"""
import sys

from fontTools.ttLib import TTFont

CODES = [
    *range(0x20, 0x7F), *range(0xA0, 0x180),                 # ASCII, Latin-1, Latin Extended-A
    *range(0x391, 0x3A2), *range(0x3A3, 0x3AA), *range(0x3B1, 0x3CA),  # Greek
    0x3D1, 0x3D5, 0x3D6, 0x3F1, 0x3F5,                       # and its mathematical variants
    0x2013, 0x2014, 0x2018, 0x2019, 0x201C, 0x201D, 0x2020, 0x2022, 0x2026, 0x2030, 0x2032, 0x2033,
    *range(0x2070, 0x2072), *range(0x2074, 0x208F),          # superscripts and subscripts
    0x20AC, 0x2103, 0x2113, 0x2122, 0x2126, 0x212B, 0x2190, 0x2191, 0x2192, 0x2193, 0x2194,
    0x2202, 0x2205, 0x2206, 0x2207, 0x2208, 0x220F, 0x2211, 0x2212, 0x2213, 0x2218, 0x221A, 0x221D,
    0x221E, 0x2220, 0x2225, 0x2227, 0x2228, 0x222B, 0x2248, 0x2260, 0x2261, 0x2264, 0x2265, 0x226A,
    0x226B, 0x2299, 0x22A5, 0x22C5, 0x27E8, 0x27E9, 0xFFFD,
]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    font = TTFont(sys.argv[1])
    glyphs, names, advances = font["glyf"], font.getBestCmap(), font["hmtx"]
    codes = [code for code in sorted(CODES) if code in names]
    points, rows = [], []
    for code in [0, *codes]:
        name = ".notdef" if code == 0 else names[code]
        coordinates, ends, flags = glyphs[name].getCoordinates(glyphs)
        rows.append((code, advances[name][0], len(points)))
        points.append(len(ends))
        begin = 0
        for end in ends:
            points.append(end + 1 - begin)
            for (x, y), on in zip(coordinates[begin:end + 1], flags[begin:end + 1]):
                points += [2 * x + (on & 1), y]
            begin = end + 1
    assert all(-32768 <= p < 32768 for p in points)
    with open(sys.argv[2], "w", encoding="utf-8") as out:
        out.write(f"// Made by tools/font_outlines.py from {font['name'].getDebugName(4)} "
                  f"{font['name'].getDebugName(5)}; its licence is LICENSE.\n")
        out.write(f"inline constexpr int kUnitsPerEm = {font['head'].unitsPerEm};\n")
        hhea = font["hhea"]
        out.write(f"inline constexpr int kAscent = {hhea.ascent}, kDescent = {-hhea.descent};\n")
        capital = glyphs["H"].yMax
        out.write(f"inline constexpr int kCapitalHeight = {capital};\n")
        out.write("// Code point (0: what stands for those that are not here), advance, place in kPoints.\n")
        out.write("inline constexpr Glyph kGlyphs[] = {\n")
        wrap(out, [f"{{{c},{a},{p}}}" for c, a, p in rows])
        out.write("};\n// Contours; of each the number of its points, then 2 x + on curve, y.\n")
        out.write("inline constexpr std::int16_t kPoints[] = {\n")
        wrap(out, [str(p) for p in points])
        out.write("};\n")


def wrap(out, items):
    line = ""
    for item in items:
        if len(line) + len(item) + 1 > 118:
            out.write(line + "\n")
            line = ""
        line += item + ","
    out.write(line + "\n")


if __name__ == "__main__":
    main()
