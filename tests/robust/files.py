"""Small sound files of every format, built by hand or, where that is long work, by the program under test.
The tests break them one by one; what is whole here is opened first, so that a refusal means something."""

import io
import json
import os
import struct
import zipfile
import zlib


def png_chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png_header(width, height, bits=8, colour=6, interlaced=0):
    return b"\x89PNG\r\n\x1a\n" + png_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, interlaced))


def png(width, height, bits=8, colour=6, interlaced=0, extra=b"", seed=7):
    """Pixels that do not compress much, so that the file is not all headers."""
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour]
    passes = [(0, 0, 1, 1)]
    if interlaced:
        passes = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]
    rows = bytearray()
    for left, top, right, down in passes:
        columns = len(range(left, width, right))
        for _ in range(top, height, down) if columns else ():
            rows.append(0)
            for _ in range((columns * channels * bits + 7) // 8):
                seed = (seed * 1103515245 + 12345) & 0x7FFFFFFF
                rows.append(seed >> 16 & (0x33 if colour == 3 else 0xFF))
    if colour == 3:
        extra += png_chunk(b"PLTE", bytes(range(4 * 3))) + png_chunk(b"tRNS", b"\x00\x80")
    return (png_header(width, height, bits, colour, interlaced) + extra + png_chunk(b"IDAT", zlib.compress(bytes(rows)))
            + png_chunk(b"IEND", b""))


def behind_the_pixels(data):
    """How many bytes of a PNG, from its end, stand behind its pixels."""
    at = 8
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        if kind == b"IDAT":
            end = at + 12 + length
        at += 12 + length
    return len(data) - end


def described_png(width=3, height=2):
    """Every chunk that describes the picture, and EXIF that turns it."""
    exif = (b"II*\0" + struct.pack("<IH", 8, 3) + struct.pack("<HHIHH", 0x112, 3, 1, 6, 0)
            + struct.pack("<HHII", 0x13B, 2, 4, int.from_bytes(b"Ann\0", "little"))
            + struct.pack("<HHII", 0x8769, 4, 1, 50) + bytes(4)
            + struct.pack("<HHHII", 1, 0x9003, 2, 20, 68) + bytes(4) + b"2020:01:02 03:04:05\0")
    chunks = [(b"cICP", bytes([12, 13, 0, 1])), (b"sRGB", b"\0"), (b"gAMA", struct.pack(">I", 45455)),
              (b"cHRM", struct.pack(">8I", 31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000)),
              (b"pHYs", struct.pack(">IIB", 2, 1, 0)), (b"eXIf", exif), (b"oFFs", struct.pack(">iiB", -3, 4, 0)),
              (b"tEXt", b"Comment\0of no matter"), (b"bKGD", bytes(6))]
    return png(width, height, colour=2, extra=b"".join(png_chunk(kind, data) for kind, data in chunks))


def bmp(width, height, bits=24):
    palette = bytes(range(16)) if bits == 8 else b""
    row = bytes(i % 4 for i in range(width * bits // 8))
    pixels = (row + bytes(-len(row) % 4)) * abs(height)
    start = 54 + len(palette)
    return (b"BM" + struct.pack("<IHHI", start + len(pixels), 0, 0, start)
            + struct.pack("<IiiHHIIIIII", 40, width, height, 1, bits, 0, len(pixels), 2835, 2835, len(palette) // 4, 0)
            + palette + pixels)


def bmp_of_runs():
    """RLE8, 6 x 2: runs, pixels one by one, and a step over others."""
    palette, runs = bytes(range(12)), b"\x03\x01\x00\x03\x02\x01\x00\x63\x00\x00\x01\x02\x00\x02\x03\x00\x02\x01\x00\x01"
    start = 54 + len(palette)
    return (b"BM" + struct.pack("<IHHI", start + len(runs), 0, 0, start)
            + struct.pack("<IiiHHIIIIII", 40, 6, 2, 1, 8, 1, len(runs), 2835, 2835, 3, 0) + palette + runs)


def bmp_of_masks():
    """Three masks of ten bits, and the longest header, with a profile behind the pixels."""
    pixels, profile = bytes(range(40, 64)), bytes(200)
    header = struct.pack("<IiiHHIIIIIIIIII", 124, 3, 2, 1, 32, 3, len(pixels), 2835, 2835, 0, 0, 0x3FF, 0xFFC00,
                         0x3FF00000, 0xC0000000) + b"DEBM" + bytes(48)
    header += struct.pack("<IIII", 4, 124 + len(pixels), len(profile), 0)
    return b"BM" + struct.pack("<IHHI", 138 + len(pixels) + len(profile), 0, 0, 138) + header + pixels + profile


def bmp_of_os2():
    """Two bits a pixel, and a header that ends early."""
    start, pixels = 14 + 16 + 16, bytes(range(4, 12))
    return (b"BM" + struct.pack("<IHHI", start + len(pixels), 0, 0, start) + struct.pack("<IIIHH", 16, 9, 2, 1, 2)
            + bytes(range(16)) + pixels)


def tga_of_palette(signed=False):
    """Numbers of 16 bits in runs; signed: with what the second version appends."""
    file = (struct.pack("<BBBHHBHHHHBB", 3, 1, 9, 5, 2, 16, 0, 0, 2, 3, 16, 0x21) + b"an!" + b"\1\2\3\x84"
            + b"\x84\x06\0\0\x05\0")
    if not signed:
        return file
    extension = bytearray(495)
    struct.pack_into("<H", extension, 0, 495)
    struct.pack_into("<HHHH", extension, 474, 2, 1, 22, 10)
    extension[494] = 4
    return file + bytes(extension) + struct.pack("<II", len(file), 0) + b"TRUEVISION-XFILE.\0"


def tga(width, height, packed=False):
    header = struct.pack("<BBBHHBHHHHBB", 0, 0, 10 if packed else 2, 0, 0, 0, 0, 0, width, height, 24, 0x20)
    if packed:
        return header + (bytes([0x80 | (width - 1)]) + b"\x10\x80\xf0") * height
    return header + bytes(i * 11 & 255 for i in range(width * height * 3))


def gif(width, height):
    """Nine-bit codes, with a clear code before the table would grow."""
    codes = []
    for i in range(width * height):
        codes += [256] * (i % 100 == 0) + [i % 4]
    bits = 0
    for i, code in enumerate(codes + [257]):
        bits |= code << (9 * i)
    data = bits.to_bytes(((len(codes) + 1) * 9 + 7) // 8, "little")
    blocks = b"".join(bytes([len(data[i:i + 255])]) + data[i:i + 255] for i in range(0, len(data), 255))
    return (b"GIF89a" + struct.pack("<HHBBB", width, height, 0x81, 0, 0) + bytes(range(12))
            + b"\x21\xf9\x04\x01\x00\x00\x03\x00" + b"\x2c" + struct.pack("<HHHHB", 0, 0, width, height, 0)
            + b"\x08" + blocks + b"\x00\x3b")


def psd(width, height, packed=False, bits=8):
    header = b"8BPS" + struct.pack(">H6xHIIHH", 1, 3, height, width, bits, 3) + struct.pack(">III", 0, 0, 0)
    if packed:
        row = struct.pack("BB", 257 - width, 90)
        return header + struct.pack(">H", 1) + struct.pack(">H", len(row)) * height * 3 + row * height * 3
    return header + struct.pack(">H", 0) + bytes(i * 7 & 255 for i in range(width * height * 3 * bits // 8))


def psd_resource(number, data):
    return b"8BIM" + struct.pack(">HHI", number, 0, len(data)) + data + bytes(len(data) % 2)


def psd_of(mode, channels, bits=8, compression=0, large=False, layers=0):
    """A small Photoshop file of any mode and packing, with what its sections can hold; `layers`: their count, as it is stored."""
    width, height = 5, 3
    row_bytes = (width * bits + 7) // 8
    palette = bytes(range(256)) * 3 if mode == 2 else b""
    resources = (psd_resource(1005, struct.pack(">IHHIHH", 300 << 16, 1, 1, 300 << 16, 1, 1)) + psd_resource(1039, bytes(130))
                 + psd_resource(1047, b"\0\3") + psd_resource(1053, struct.pack(">II", 1, 2))
                 + psd_resource(1057, struct.pack(">IBIII", 1, 1, 0, 0, 1)) + psd_resource(1064, struct.pack(">Id", 1, 2.0)))
    wide = ">Q" if large else ">I"
    block = struct.pack(wide, 2) + struct.pack(">h", layers)
    section = struct.pack(wide, 0) + bytes(4) + b"8BIMLr16" + block if bits > 8 else block + bytes(4)
    row = b"".join(bytes([i * 7 & 255]) for i in range(row_bytes))
    if bits == 32:
        row = struct.pack(">5f", 0, 0.25, 0.5, 1, 2)
    rows = row * height * channels
    if compression == 1:
        packed = bytes([row_bytes - 1]) + row
        rows = struct.pack(">I" if large else ">H", len(packed)) * height * channels + packed * height * channels
    elif compression > 1:
        rows = zlib.compress(rows)
    return (b"8BPS" + struct.pack(">H6xHIIHH", 2 if large else 1, channels, height, width, bits, mode)
            + struct.pack(">I", len(palette)) + palette + struct.pack(">I", len(resources)) + resources
            + struct.pack(wide, len(section)) + section + struct.pack(">H", compression) + rows)


PSD = {
    "bitmap.psd": psd_of(0, 1, 1), "grey.psd": psd_of(1, 2, 8, 1, layers=-1), "indexed.psd": psd_of(2, 1),
    "cmyk.psd": psd_of(4, 5, 8, 1, layers=-1), "cmyk-16.psd": psd_of(4, 4, 16), "inks.psd": psd_of(7, 3, 16),
    "duotone.psd": psd_of(8, 1), "lab.psd": psd_of(9, 4, 8, layers=-1), "lab-16.psd": psd_of(9, 3, 16, 1),
    "light.psd": psd_of(3, 4, 32, 1, layers=-1), "zip.psd": psd_of(3, 3, 8, 2), "zip-16.psd": psd_of(3, 3, 16, 3),
    "zip-32.psd": psd_of(1, 1, 32, 3), "large.psb": psd_of(3, 4, 16, 1, True, -2), "large-zip.psb": psd_of(3, 3, 8, 3, True),
}

PNM = {
    "p1.pbm": b"P1 4 3\n0110 1001 0110",
    "p2.pgm": b"P2 2 2 255\n0 80 160 255\n",
    "p3.ppm": b"P3\n# a comment\n2 1 255\n255 0 0 0 255 0\n",
    "p4.pbm": b"P4 9 3\n\x00\x80\x55\x00\xff\x80",
    "p5.pgm": b"P5 3 2 255\nabcdef",
    "p5-16.pgm": b"P5 2 2 65535\nabcdefgh",
    "p6.ppm": b"P6 2 2 255\nabcdefghijkl",
    "p7.pam": b"P7\nWIDTH 2\nHEIGHT 2\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\nabcdefghijklmnop",
    "p7-16.pam": b"P7\nMAXVAL 1000\nDEPTH 2\nHEIGHT 1\nWIDTH 2\n# no type\nENDHDR\n\0\1\2\3\1\1\0\2",
    "rgb.pfm": b"PF\n2 1\n-1.0\n" + struct.pack("<6f", 0, 0.25, 0.5, 1, 2, -1),
    "grey.pfm": b"Pf 1 2 1\n" + struct.pack(">2f", 0.75, 0.1),
}

# Bytes at their ends that these can do without: the rest of the end code, an empty sub-block and the trailer; the end
# mark; what follows the last pixel.
SPARE = {"small.gif": 3, "runs.bmp": 2, "masks.bmp": 200, "signed.tga": 495 + 26}

MIMETYPE = b"application/x-probewarp"
PIXEL = PNM["p6.ppm"]


def fields():
    """project.json of a small project, as a value to be changed."""
    probe = {"id": 1, "name": "Probe 1", "colour": "#e69f00", "rest": [1.0, 1.0], "now": [2.0, 2.0],
             "angle_radians": 0.5, "radius": 1.0, "locked": False, "visible": True}
    return {"format": 1, "image": {"file": "image.ppm", "name": "a.ppm"}, "mesh": {"cells": 4},
            "weights": "inverse-distance", "blend": "dlb", "probes": [probe, dict(probe, id=2, rest=[0.0, 0.0])]}


def painted_fields():
    """Likewise of the second format, with paint on the first probe and with stiffness."""
    first, second = fields()["probes"]
    return dict(fields(), format=2, mesh={"cells": 4, "from_alpha": True, "threshold": 0, "margin": 2.0},
                weights={"scheme": "geodesic", "exponent": 2.0, "falloff": 0.0, "most": 0},
                stiffness={"file": "stiffness.png", "extent": [1.0, 1.0]},
                probes=[dict(first, paint={"file": "paint/1.png", "extent": [1.0, 0.5]}), dict(second, paint=None)])


def painted_members(paint=None, stiffness=None):
    """The members of such a project; the paint may be other bytes."""
    return [("mimetype", MIMETYPE), ("project.json", json.dumps(painted_fields()).encode()), ("image.ppm", PIXEL),
            ("paint/1.png", png(6, 3, 16, 4) if paint is None else paint),
            ("stiffness.png", png(3, 3, 16, 4) if stiffness is None else stiffness)]


def project_of(text, image=PIXEL, image_name="image.ppm"):
    """A project around the text of its project.json."""
    return archive([("mimetype", MIMETYPE), ("project.json", text if isinstance(text, bytes) else text.encode()),
                    (image_name, image)])


def project(**changes):
    return project_of(json.dumps(dict(fields(), **changes)))


def archive(members, method=zipfile.ZIP_STORED):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", method) as z:
        for name, data in members:
            # A ZipInfo, so that names go in as they are.
            info = zipfile.ZipInfo("x", (1980, 1, 1, 0, 0, 0))
            info.filename, info.compress_type = name, method
            z.writestr(info, data)
    return out.getvalue()


def zip_records(members, crc=None, count=None):
    """A ZIP by hand, to lie in: members are (name, packed bytes, method, packed size, size, crc, flags)."""
    out, directory = bytearray(), bytearray()
    for name, data, method, packed, size, check, flags in members:
        common = struct.pack("<HHHHHIIIHH", 20, flags, method, 0, 0x21, check, packed, size, len(name), 0)
        directory += b"PK\x01\x02" + struct.pack("<H", 20) + common + struct.pack("<HHHII", 0, 0, 0, 0, len(out)) + name
        out += b"PK\x03\x04" + common + name + data
    number = len(members) if count is None else count
    return bytes(out + directory + b"PK\x05\x06" + struct.pack("<HHHHIIH", 0, 0, number, number, len(directory), len(out), 0))


def record(name, data, size=None, packed=None, check=None, flags=0, method=0, raw=None):
    """One member for zip_records, honest where nothing is said."""
    stored = data if raw is None else raw
    return (name, stored, method, len(stored) if packed is None else packed, len(data) if size is None else size,
            zlib.crc32(data) if check is None else check, flags)


def deflated_zeros(total, container=zlib.MAX_WBITS):
    """`total` zeros, packed, without ever holding them; the checksum too. container: as zlib's wbits."""
    packer, block, crc, out = zlib.compressobj(9, zlib.DEFLATED, container), bytes(1 << 20), 0, []
    for _ in range(total >> 20):
        out.append(packer.compress(block))
        crc = zlib.crc32(block, crc)
    return b"".join(out) + packer.flush(), crc


def sound(program, folder):
    """Every small sound file: a list of (name, bytes)."""
    made = [
        ("rgba8.png", png(5, 4)), ("grey8.png", png(6, 5, 8, 0)), ("rgb16.png", png(4, 3, 16, 2)),
        ("rgba16.png", png(3, 3, 16, 6)), ("palette.png", png(6, 4, 2, 3)), ("interlaced.png", png(7, 6, 8, 2, 1)),
        ("bits.png", png(9, 4, 1, 0)), ("described.png", described_png()),
        ("rgb.bmp", bmp(5, 3)), ("down.bmp", bmp(3, -2)), ("palette.bmp", bmp(5, 3, 8)),
        ("runs.bmp", bmp_of_runs()), ("masks.bmp", bmp_of_masks()), ("os2.bmp", bmp_of_os2()),
        ("raw.tga", tga(5, 4)), ("packed.tga", tga(9, 5, True)),
        ("palette.tga", tga_of_palette()), ("signed.tga", tga_of_palette(True)),
        ("small.gif", gif(12, 10)), ("raw.psd", psd(5, 3)), ("packed.psd", psd(9, 3, True)), ("deep.psd", psd(3, 2, bits=16)),
        ("hand.probewarp", project()), ("painted.probewarp", archive(painted_members())),
    ] + list(PSD.items()) + list(PNM.items())
    source = os.path.join(folder, "source.png")
    with open(source, "wb") as f:
        f.write(png(9, 8))
    for name in "made.jpg", "made.bmp", "made.tga", "made.png", "made.probewarp":
        path = os.path.join(folder, name)
        result = program.run("render", source, "--probe", "2,2:3,4,20", "-o", path)
        assert result.code == 0, f"{name} could not be made: {result}"
        with open(path, "rb") as f:
            made.append((name, f.read()))
        os.unlink(path)
    os.unlink(source)
    return made
