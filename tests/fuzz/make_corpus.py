#!/usr/bin/env python3
"""Makes the fuzz targets' seeds: make_corpus.py FOLDER fills FOLDER/image, FOLDER/project and FOLDER/csv.

The first byte of an image or project seed says how the target reads the rest: see fuzz_image.cpp and fuzz_project.cpp.
"""

import json
import os
import sys
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
    for data in files.psd(5, 3), files.psd(9, 3, True), files.psd(3, 2, bits=16):
        yield "psd", data
    for data in files.PNM.values():
        yield "ppm", data


def csvs():
    head = b"#vertices ix,iy,x,y\n0,0,0,0\n#probes ix,iy,itheta,x,y,theta,radius\n"
    return [head, head + b"0,0,0,1,1,0.5,10\n", head + b"-100.5,20,0.1,1e2,-3,-6.28,120\r\n 1 , 2 , 3 , 4 , 5 , 6 , 7 \n",
            b"#probes\n1,2,3,4,5,6,7", b"1,2,3\n"]


def save(folder, data, number):
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, f"{number:02}"), "wb") as f:
        f.write(data)


def main(folder):
    for i, (ending, data) in enumerate(images()):
        # 1: as TGA; 2: checksums of a PNG are put right first.
        save(os.path.join(folder, "image"), bytes([{"tga": 1, "png": 2}.get(ending, 0)]) + data, i)
    text = json.dumps(files.fields()).encode()
    seeds = [b"\0" + files.project(), b"\1" + text, b"\1" + json.dumps(dict(files.fields(), probes=[])).encode(),
             b"\0" + files.project_of(text, files.png(2, 2), "image.png"), b"\1{}"]
    # Of the second format: with paint, with paint of other kinds of PNG, and the text alone with none.
    seeds += [b"\2" + files.archive(files.painted_members()),
              b"\2" + files.archive(files.painted_members(files.png(70, 3, 8, 0), files.png(2, 2)))]
    plain = dict(files.painted_fields(), stiffness=None)
    plain["probes"] = [dict(probe, paint=None) for probe in plain["probes"]]
    seeds += [b"\1" + json.dumps(plain).encode(), b"\1" + json.dumps(files.painted_fields()).encode()]
    for i, data in enumerate(seeds):
        save(os.path.join(folder, "project"), data, i)
    for i, data in enumerate(csvs()):
        save(os.path.join(folder, "csv"), data, i)


if __name__ == "__main__":
    main(sys.argv[1])
