# SPDX-License-Identifier: BSD-3-Clause
"""Small stand-ins for the files that the documentation's commands name. docs.py puts them beside a page's
commands."""
import base64
import json
import math
import struct
import zlib


def ball(n=24):
    """Returns a bumpy ball: (positions, triangles), counter-clockwise."""
    positions = []
    for j in range(n + 1):
        for i in range(2 * n):
            theta, phi = math.pi * j / n, math.pi * i / n
            r = 1 + 0.1 * math.sin(3 * phi) * math.sin(theta) ** 3
            positions.append((r * math.sin(theta) * math.cos(phi), r * math.cos(theta),
                              r * math.sin(theta) * math.sin(phi)))
    triangles = []
    for j in range(n):
        for i in range(2 * n):
            a, b = j * 2 * n + i, j * 2 * n + (i + 1) % (2 * n)
            triangles += [(a, b, b + 2 * n), (a, b + 2 * n, a + 2 * n)]
    return positions, triangles


def obj():
    positions, triangles = ball()
    lines = ["v %.6f %.6f %.6f" % p for p in positions]
    return "\n".join(lines + ["f %d %d %d" % tuple(i + 1 for i in t) for t in triangles]).encode()


def ply():
    positions, triangles = ball()
    header = ("ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\n"
              "property float y\nproperty float z\nelement face %d\n"
              "property list uchar int vertex_indices\nend_header\n")
    return ((header % (len(positions), len(triangles))).encode() +
            b"".join(struct.pack("<3f", *p) for p in positions) +
            b"".join(struct.pack("<B3i", 3, *t) for t in triangles))


def stl():
    positions, triangles = ball()
    return b"\0" * 80 + struct.pack("<I", len(triangles)) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *positions[a], *positions[b], *positions[c], 0)
        for a, b, c in triangles)


def gltf_parts():
    positions, triangles = ball()
    data = (b"".join(struct.pack("<3f", *p) for p in positions) +
            b"".join(struct.pack("<3I", *t) for t in triangles))
    vertices = 12 * len(positions)
    axes = list(zip(*positions))
    # Two balls of two colours, one of them translucent.
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"mesh": 1, "translation": [1.5, 0, 0.5]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": m}]}
                   for m in (0, 1)],
        "materials": [
            {"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.5, 0.2, 1]}},
            {"pbrMetallicRoughness": {"baseColorFactor": [0.3, 0.5, 0.9, 0.5]}, "alphaMode": "BLEND"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3",
             "min": [min(a) for a in axes], "max": [max(a) for a in axes]},
            {"bufferView": 1, "componentType": 5125, "count": 3 * len(triangles), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": vertices},
                        {"buffer": 0, "byteOffset": vertices, "byteLength": len(data) - vertices}],
        "buffers": [{"byteLength": len(data)}]}
    return document, data


def gltf():
    document, data = gltf_parts()
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    document["buffers"][0]["uri"] = uri
    return json.dumps(document).encode()


def glb():
    document, data = gltf_parts()
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    body = (struct.pack("<II", len(text), 0x4E4F534A) + text +
            struct.pack("<II", len(data), 0x004E4942) + data)
    return struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body


def height(x, y):
    """Returns the height of hills, from 0 to 1."""
    h = math.sin(x / 9) * math.cos(y / 11) + 0.5 * math.sin(x / 4 + y / 7) + 0.2 * math.sin(y / 2)
    return (h + 1.7) / 3.4


def png(width, rows, bits, kind):
    def chunk(name, data):
        return (struct.pack(">I", len(data)) + name + data +
                struct.pack(">I", zlib.crc32(name + data)))
    raw = b"".join(b"\0" + row for row in rows)
    return (b"\x89PNG\r\n\x1a\n" +
            chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(rows), bits, kind, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


def heights(n=128):
    """Returns heights as a PNG of 16 bits, in the lower half of their range."""
    return png(n, [b"".join(struct.pack(">H", int(32000 * height(x, y))) for x in range(n))
                   for y in range(n)], 16, 0)


def colors(n=256):
    """Returns colours as a PNG, finer than the heights."""
    def texel(x, y):
        h = height(x / 2, y / 2)
        return bytes((int(90 + 140 * h), int(110 + 90 * h), int(60 + 150 * h * h)))
    return png(n, [b"".join(texel(x, y) for x in range(n)) for y in range(n)], 8, 2)


def npy(n=96):
    """Returns heights in metres as a float32 array file."""
    header = "{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d), }" % (n, n)
    header += " " * (-(len(header) + 11) % 64) + "\n"
    return (b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() +
            b"".join(struct.pack("<f", 2000 * height(x, y)) for y in range(n) for x in range(n)))


FILES = {
    "dragon.ply": ply, "bunny.stl": stl, "lamp.obj": obj, "room.gltf": gltf, "engine.glb": glb,
    "hair.ply": ply, "scan.ply": ply, "shell.ply": ply, "core.stl": stl, "scene.glb": glb, "alps.png": heights,
    "alps.jpg": colors, "valley.npy": npy,
}


def put(folder, commands):
    """Writes the files that the commands name."""
    for name, make in FILES.items():
        if name in commands:
            (folder / name).write_bytes(make())
    if "parts/*.ply" in commands:
        (folder / "parts").mkdir()
        for part in ("0.ply", "1.ply"):
            (folder / "parts" / part).write_bytes(ply())
