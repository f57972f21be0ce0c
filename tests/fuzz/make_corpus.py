#!/usr/bin/env python3
"""Makes the fuzz targets' seeds: make_corpus.py FOLDER fills FOLDER/image, FOLDER/project and FOLDER/csv.

The first byte of an image or project seed says how the target reads the rest: see fuzz_image.cpp and fuzz_project.cpp.
"""

import json
import os
import struct
import sys
import zipfile
import zlib

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "robust"))
import files

JPEG = ("ffd8ffe000104a46494600010101004800480000ffdb004300" + "01" * 64 + "ffc0000b080008000801011100"
        "ffc4001f0000010501010101010100000000000000000102030405060708090a0b"
        "ffc400b5100002010303020403050504040000017d01020300041105122131410613516107227114328191a1082342b1c11552d1f02433627282090a"
        "161718191a25262728292a3435363738393a434445464748494a535455565758595a636465666768696a737475767778797a838485868788898a9293"
        "9495969798999aa2a3a4a5a6a7a8a9aab2b3b4b5b6b7b8b9bac2c3c4c5c6c7c8c9cad2d3d4d5d6d7d8d9dae1e2e3e4e5e6e7e8e9eaf1f2f3f4f5f6f7"
        "f8f9fa" "ffda0008010100003f002b" "ffd9")
EXIF = "ffe100224578696600004d4d002a00000008000101120003000000010006000000000000"


def described_images():
    """PNG and JPEG with what describes them, and of unusual kinds that are sound."""
    described = files.described_png()
    yield "png", described
    yield "png", described[:-files.behind_the_pixels(described)]
    pixels = files.png_chunk(b"IDAT", zlib.compress(bytes([0, 1, 2, 3, 0, 4, 5, 6])))
    key = files.png_chunk(b"tRNS", bytes([0, 1, 0, 2, 0, 3]))
    yield "png", files.png_header(1, 2, 8, 2) + key + files.png_chunk(b"PLTE", bytes(6)) + pixels
    plain = bytes.fromhex(JPEG)
    profile = b"\xff\xe2\0\x20ICC_PROFILE\0\1\1" + bytes(16)
    adobe = b"\xff\xee\0\x0eAdobe\0\x64\0\0\0\0\2"
    yield "jpg", plain[:20] + profile + adobe + plain[20:]
    yield "jpg", plain[:2] + plain[20:]
    # The resolution and the rest in EXIF, big end first.
    tiff = (b"MM\0*" + struct.pack(">IH", 8, 3) + struct.pack(">HHIHH", 0x112, 3, 1, 8, 0)
            + struct.pack(">HHII", 0x11A, 5, 1, 50) + struct.pack(">HHI4s", 0x8298, 2, 3, b"me") + bytes(4)
            + struct.pack(">II", 300, 1))
    yield "jpg", plain[:20] + b"\xff\xe1" + struct.pack(">H", len(tiff) + 8) + b"Exif\0\0" + tiff + plain[20:]


def salvaged_images():
    """What is there of files that end too soon."""
    for data in files.png(40, 30), files.png(40, 30, interlaced=1), files.described_png(40, 30):
        yield "png", data[:len(data) * 2 // 3]
    yield "jpg", bytes.fromhex(JPEG)[:-3]


def images():
    for bits, colour, interlaced in ((8, 6, 0), (8, 0, 0), (16, 2, 0), (16, 6, 1), (2, 3, 0), (8, 2, 1), (1, 0, 0), (8, 4, 0)):
        yield "png", files.png(5, 4, bits, colour, interlaced)
    yield "png", files.png(2, 2, extra=files.png_chunk(b"pHYs", bytes(3) + b"\x10" + bytes(3) + b"\x10\x01"))
    yield "png", files.png(2, 2, extra=files.png_chunk(b"iCCP", b"P\0\0" + zlib.compress(bytes(200))))
    plain = bytes.fromhex(JPEG)
    yield "jpg", plain
    yield "jpg", plain[:20] + bytes.fromhex(EXIF) + plain[20:]
    for data in (files.bmp(5, 3), files.bmp(3, -2), files.bmp(5, 3, 8), files.bmp(2, 2, 32), files.bmp_of_runs(),
                 files.bmp_of_masks(), files.bmp_of_os2()):
        yield "bmp", data
    for data in files.tga(5, 4), files.tga(9, 5, True), files.tga_of_palette(), files.tga_of_palette(True):
        yield "tga", data
        yield "any name", data
    yield "gif", files.gif(12, 10)
    for data in [files.psd(5, 3), files.psd(9, 3, True), files.psd(3, 2, bits=16)] + list(files.PSD.values()):
        yield "psd", data
    for data in files.PNM.values():
        yield "ppm", data


def cut_images():
    """Of formats that are salvaged: what is left of a file that lost its end."""
    for ending, data in images():
        if ending in ("bmp", "tga", "gif", "ppm"):
            yield ending, data[: len(data) - 2 - len(data) // 8]


def csvs():
    head = b"#vertices ix,iy,x,y\n0,0,0,0\n#probes ix,iy,itheta,x,y,theta,radius\n"
    return [head, head + b"0,0,0,1,1,0.5,10\n", head + b"-100.5,20,0.1,1e2,-3,-6.28,120\r\n 1 , 2 , 3 , 4 , 5 , 6 , 7 \n",
            b"#probes\n1,2,3,4,5,6,7", b"1,2,3\n",
            b"sep=;\r\n#probes;;;;;;\r\nix;iy;itheta;x;y;theta;radius\r\n1,5;-2;+0;3;4,25;5E-1;60;;\r\n;;;;;;\r\n",
            b'\xef\xbb\xbf"#probes ix"\t"iy"\r"1,5"\t2\t3\t4\t5\t6\t7\r"1,2,3,4,5,6,7"\r',
            "#probes\n1\t2\t3\t4\t5\t\u22126\t7\n".encode("utf-16")]


def save(folder, data, number):
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, f"{number:02}"), "wb") as f:
        f.write(data)


def main(folder):
    # 1: as TGA; 2: checksums of a PNG are put right first; 8: what is there of the file is opened.
    kinds = {"tga": 1, "png": 2}
    seeds = [bytes([kinds.get(ending, 0)]) + data for ending, data in [*images(), *described_images()]]
    seeds += [bytes([kinds.get(ending, 0) | 8]) + data for ending, data in salvaged_images()]
    seeds += [bytes([kinds["tga"] | 8 if ending == "tga" else 8]) + data for ending, data in cut_images()]
    for i, data in enumerate(seeds):
        save(os.path.join(folder, "image"), data, i)
    text = json.dumps(files.fields()).encode()
    seeds = [b"\0" + files.project(), b"\1" + text, b"\1" + json.dumps(dict(files.fields(), probes=[])).encode(),
             b"\0" + files.project_of(text, files.png(2, 2), "image.png"), b"\1{}"]
    # Of the second format: with paint, with paint of other kinds of PNG, and the text alone with none.
    seeds += [b"\2" + files.archive(files.painted_members()),
              b"\2" + files.archive(files.painted_members(files.png(70, 3, 8, 0), files.png(2, 2)))]
    plain = dict(files.painted_fields(), stiffness=None)
    plain["probes"] = [dict(probe, paint=None) for probe in plain["probes"]]
    seeds += [b"\1" + json.dumps(plain).encode(), b"\1" + json.dumps(files.painted_fields()).encode()]
    # As other archivers make them: in a folder, with folders and what desktops add, in another order, packed.
    rezipped = [("dance/", b""), ("__MACOSX/._x", b"x")] + [("dance/" + n, d) for n, d in reversed(files.painted_members())]
    seeds += [b"\2" + files.archive(rezipped), b"\0" + files.archive(rezipped, zipfile.ZIP_DEFLATED)]
    for i, data in enumerate(seeds):
        save(os.path.join(folder, "project"), data, i)
    for i, data in enumerate(csvs()):
        save(os.path.join(folder, "csv"), data, i)


if __name__ == "__main__":
    main(sys.argv[1])
