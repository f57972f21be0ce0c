#!/usr/bin/env python3
"""Draws the small input pictures of the golden tests, byte for byte the same each time. Standard library only."""
import math
import pathlib
import struct
import zlib

here = pathlib.Path(__file__).resolve().parent / "input"


def png(path, width, height, pixel, depth=8):
    """Writes RGBA of 8 or 16 bits; pixel(x, y) gives four numbers from 0 to 1."""
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

    header = struct.pack(">IIBBBBB", width, height, depth, 6, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) +
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


png(here / "card.png", 96, 96, card)
png(here / "soft.png", 64, 64, soft)
png(here / "deep.png", 48, 48, deep, 16)
png(here / "wide.png", 1100, 40, wide)
png(here / "checks.png", 128, 96, checks)
