#!/usr/bin/env python3
"""Draws the small inputs of the golden tests, byte for byte the same each time. Standard library only."""
import json
import math
import pathlib
import struct
import zipfile
import zlib

here = pathlib.Path(__file__).resolve().parent / "input"


def png(width, height, pixel, depth=8, colour=6):
    """RGBA, or with colour 4 grey and alpha, of 8 or 16 bits; pixel(x, y) gives as many numbers from 0 to 1."""
    most = 255 if depth == 8 else 65535
    code = "B" if depth == 8 else ">H"
    rows = b""
    for y in range(height):
        row = b"\0"
        for x in range(width):
            for value in pixel(x, y):
                row += struct.pack(code, int(min(max(value, 0), 1) * most + 0.5))
        rows += row

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) +
            chunk(b"IEND", b""))


def card(x, y):
    """A test card: gradients, rings, a grid, an arrow that tells up from down, every corner another colour."""
    u, v = x / 95, y / 95
    r = math.hypot(x - 47.5, y - 47.5)
    colour = [0.2 + 0.7 * u, 0.25 + 0.6 * v, 0.9 - 0.6 * u]
    if 20 < r < 24 or 36 < r < 38:
        colour = [0.95, 0.95, 0.9]
    if x % 16 == 0 or y % 16 == 0:
        colour = [c * 0.6 for c in colour]
    if abs(x - 47.5) < (y - 14) * 0.5 and 14 < y < 34:
        colour = [0.95, 0.2, 0.15]
    if x < 10 and y < 10:
        colour = [1, 1, 0]
    return (*colour, 1)


def soft(x, y):
    """A disc of one colour with a wide soft edge, over the complementary colour at no alpha at all."""
    alpha = min(max((26 - math.hypot(x - 31.5, y - 31.5)) / 8, 0), 1)
    return (0.9, 0.5, 0.1, alpha) if alpha > 0 else (0.1, 0.5, 0.9, 0)


def deep(x, y):
    """16 bits: steps that 8 bits cannot tell apart."""
    return (0.5 + x / 65535, y / 47, (x * 48 + y) / 2304, 0.25 + 0.75 * y / 47)


def wide(x, y):
    """Wider than a tile of the renderer."""
    return (x / 1099, 0.5 + 0.5 * math.sin(x / 17), 0.5 + 0.5 * math.cos(y / 5 + x / 60), 1)


def checks(x, y):
    """The finest checkerboard there is: shrunk, it must become an even grey."""
    return ((x + y) % 2,) * 3 + (1,)


def fork(x, y):
    """The card cut to two arms that only a foot joins, with soft edges: near is not near within the shape."""
    x, y = x + 0.5, y + 0.5

    def bar(left, top, right, bottom):
        """How far inside a bar, pixels."""
        return min(x - left, right - x, y - top, bottom - y)

    inside = max(bar(14, 8, 40, 88), bar(56, 8, 82, 88), bar(14, 62, 82, 88))
    red, green, blue, _ = card(x - 0.5, y - 0.5)
    return red, green, blue, min(max(inside / 2, 0), 1)


def probe(number, name, colour, rest, now, degrees, paint=None):
    return {"id": number, "name": name, "colour": colour, "rest": rest, "now": now, "angle_radians": math.radians(degrees),
            "radius": 16.0, "locked": False, "visible": True, "paint": paint}


def painted():
    """The fork with probes in its arms' ends and its foot. The left arm's is painted over the arm's lower half, softly
    below, and away from its upper left edge; the upper part of the right arm is stiff."""
    def arm(x, y):
        if x < 10:
            return 0, (y < 40) * 0.8
        return 1, (x < 48) * min(max((80 - y) / 40, 0), 1) * (y > 30)

    def stiff(x, y):
        return 1, (x > 48) * min(max((44 - y) / 8, 0), 1)

    project = {
        "format": 2, "image": {"file": "image.png", "name": "fork.png"},
        "mesh": {"cells": 24, "from_alpha": True, "threshold": 0, "margin": 2.0},
        "weights": {"scheme": "harmonic", "exponent": 2.0, "falloff": 0.0, "most": 0}, "blend": "dlb",
        "stiffness": {"file": "stiffness.png", "extent": [1.0, 1.0]},
        "probes": [probe(1, "Left", "#e69f00", [27.0, 18.0], [23.0, 20.0], -15, {"file": "paint/1.png", "extent": [1.0, 1.0]}),
                   probe(2, "Right", "#56b4e9", [69.0, 18.0], [74.0, 20.0], 20),
                   probe(3, "Foot", "#009e73", [48.0, 76.0], [48.0, 76.0], 0)]}
    return [("mimetype", b"application/x-probewarp"), ("project.json", json.dumps(project, indent=1).encode()),
            ("image.png", png(96, 96, fork)), ("paint/1.png", png(96, 96, arm, 16, 4)),
            ("stiffness.png", png(48, 48, lambda x, y: stiff(2 * x, 2 * y), 16, 4))]


def write_zip(path, members):
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in members:
            archive.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), data)


for name, width, height, pixel, depth in (("card", 96, 96, card, 8), ("soft", 64, 64, soft, 8), ("deep", 48, 48, deep, 16),
                                          ("wide", 1100, 40, wide, 8), ("checks", 128, 96, checks, 8),
                                          ("fork", 96, 96, fork, 8)):
    (here / f"{name}.png").write_bytes(png(width, height, pixel, depth))
write_zip(here / "painted.probewarp", painted())
