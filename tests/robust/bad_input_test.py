#!/usr/bin/env python3
"""Gives the real program every bad file and every wrong usage we can think of. Each has to end, and small, with one
line that names the file, the right exit code, and no trace on the disk.

    bad_input_test.py --program build/release/app/probewarp [unittest's options]
"""

import io
import json
import os
import random
import resource
import socket
import struct
import sys
import tempfile
import unittest
import zipfile
import zlib

import files
import harness

MIB = 512.0  # what the program promises for bad input
SEED = 20240611
GIB = 1 << 30
# A word on what is expected belongs to every message, unless the system refused and gave its reason.
EXPECTED = ("expected", "this version reads", "choose", "cannot be opened: ", "cannot be read: ")

program = None  # the harness.Program under test


def write(path, data):
    if callable(data):
        data(path)
        return
    with open(path, "wb") as f:
        f.write(data)


class BadFiles(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="probewarp-bad-")
        self.addCleanup(scratch.cleanup)
        self.inputs, self.outputs = (os.path.join(scratch.name, name) for name in ("in", "out"))
        os.mkdir(self.inputs)
        os.mkdir(self.outputs)
        self.output = os.path.join(self.outputs, "out.png")
        self.turn = 0

    def place(self, name):
        return os.path.join(self.inputs, name)

    def ways(self, path, quick, options):
        """The command lines that a bad input is tried with, and whether the output is there before."""
        render = ["render", path, "-o", self.output]
        every = [(render, True), (render, False), (["info", path, "--backend", "osmesa"], True),
                 (["info", path, "--json"], False)]
        if options:
            return [(render + options, True), (render + options, False)]
        self.turn += 1
        return [every[self.turn % 4]] if quick else every[:3]

    def check(self, arguments, there, code, named, says, expected, **settings):
        """Runs the program once and fails with all that is wrong with how it ended."""
        if os.path.exists(self.output):
            os.unlink(self.output)
        if there:
            write(self.output, b"the old picture")
        folder = os.path.dirname(self.inputs)
        before = harness.files_in(folder, folder_times=code == 2)
        result = program.measured(*arguments, **settings)
        found = []
        if result.code != code:
            found.append(f"exit code {result.code} instead of {code}")
        if result.out:
            found.append("stdout is not empty")
        if (trouble := harness.one_line(result.err)):
            found.append("stderr " + trouble)
        text = result.err.decode("utf-8", "replace")
        if named not in text:
            found.append(f"stderr does not name {named}")
        if says not in text:
            found.append(f"stderr does not say '{says}'")
        if expected and not any(word in text for word in EXPECTED):
            found.append("stderr does not say what is expected")
        if result.mib > MIB:
            found.append(f"took more than {MIB} MiB")
        if harness.files_in(folder, folder_times=code == 2) != before:
            found.append("files were left or touched")
        if found:
            self.fail("; ".join(found) + f"\n    {' '.join(arguments)!r}\n    {result}")

    def refused(self, name, data=None, says="", quick=False, code=1, named=None, options=None, keep=False,
                expected=True, **settings):
        """Puts `data` (bytes, or a function that makes the file; None: it is there) at `name` and expects a refusal."""
        path = self.place(name)
        if data is not None:
            write(path, data)
        for arguments, there in self.ways(path, quick, options):
            with self.subTest(file=name, command=arguments[0], output_there=there):
                self.check(arguments, there, code, path if named is None else named, says, expected, **settings)
        if data is not None and not keep:
            os.unlink(path)

    def all_refused(self, cases, **how):
        for name, data, *says in cases:
            self.refused(name, data, *says, **how)

    def harmless(self, name, data):
        """A file whose excess may be passed over: refused, or read within the limits."""
        path = self.place(name)
        write(path, data)
        with self.subTest(file=name):
            result = program.measured("render", path, "-o", self.output)
            self.assertIn(result.code, (0, 1), result)
            self.assertLessEqual(result.mib, MIB, result)
            if result.code == 0:
                self.assertEqual((result.out, result.err), (b"", b""), result)
                self.assertLess(os.path.getsize(self.output), 4096, "the excess was carried over")
                os.unlink(self.output)
            else:
                self.assertIsNone(harness.one_line(result.err), result)
        os.unlink(path)

    # ---- files that end too soon, or never began ----

    def test_sound_files_open(self):
        for name, data in files.sound(program, self.inputs):
            with self.subTest(file=name):
                write(self.place(name), data)
                result = program.run("info", self.place(name), "--json")
                self.assertEqual((result.code, result.err), (0, b""), result)
                self.assertGreater(json.loads(result.out)["width"], 0)

    def test_truncated_at_every_byte(self):
        cut = 0
        for name, data in files.sound(program, self.inputs):
            end = len(data) - files.SPARE.get(name, 0)
            if name.endswith(".png"):
                end -= files.behind_the_pixels(data)
            lengths = set(range(end)) if len(data) <= 400 else set(range(0, end, 7))
            lengths |= set(range(max(0, end - 16), end))
            for length in sorted(lengths):
                self.refused(name, data[:length], "is empty" if length == 0 else "", quick=True)
                cut += 1
        print(f"  {cut} truncated files", flush=True)

    def test_cut_behind_the_pixels(self):
        """A PNG whose pixels are all there opens, whatever of its end is missing."""
        for name, data in files.sound(program, self.inputs):
            if name.endswith(".png"):
                for missing in range(1, files.behind_the_pixels(data) + 1):
                    write(self.place(name), data[:-missing])
                    result = program.run("info", self.place(name), "--json")
                    self.assertEqual((result.code, result.err), (0, b""), f"{name} without its last {missing}")

    def test_truncated_where_nothing_shows(self):
        """The picture is drawn while it is decoded, and here its lower half has left the frame."""
        data = files.png(200, 2000, colour=2)
        pulled = ["--probe", "100,0:100,1500"]
        self.refused("tall.png", data[: len(data) * 4 // 5], "is truncated", options=pulled)
        self.refused("tall.png", data[:-20], "is truncated", options=pulled)
        broken = bytearray(data)
        broken[len(data) * 4 // 5] ^= 1
        self.refused("tall.png", bytes(broken), "is damaged", options=pulled)

    def test_empty(self):
        for ending in "png jpg bmp tga gif psd ppm probewarp xyz".split():
            self.refused("empty." + ending, b"", "is empty")

    def test_wrong_magic(self):
        for name, data in files.sound(program, self.inputs):
            if name.endswith(".tga"):
                continue  # has none
            self.refused(name, b"X" + data[1:], "expected")
            self.refused(name, b"\0\0\0\0" + data[4:], "expected")
        self.refused("a.png", b"\xef\xbb\xbf" + files.png(2, 2))
        self.refused("a.png", files.png(2, 2).replace(b"\r\n", b"\n"))
        self.refused("a.txt", b"a text\n")
        self.refused("a.svg", b'<svg xmlns="http://www.w3.org/2000/svg"/>')
        self.refused("a.ppm", b"P8\nWIDTH 1\nHEIGHT 1\nDEPTH 3\nMAXVAL 255\nENDHDR\nabc")
        self.refused("a.probewarp", b"{}")
        self.refused("a.probewarp", json.dumps(files.fields()).encode())

    def test_random_bytes(self):
        print(f"  seed {SEED}", flush=True)
        chance = random.Random(SEED)
        magics = [("png", b"\x89PNG\r\n\x1a\n"), ("png", files.png_header(4, 4)), ("jpg", b"\xff\xd8\xff"), ("bmp", b"BM"),
                  ("gif", b"GIF89a"), ("psd", b"8BPS"), ("ppm", b"P6 "), ("ppm", b"P3\n"), ("probewarp", b"PK\x03\x04"),
                  ("png", b""), ("tga", b""), ("xyz", b"")]
        for i in range(20):
            for ending, magic in magics:
                size = chance.choice((1, 10, 100, 1000, 30000))
                self.refused(f"random{i}.{ending}", magic + chance.randbytes(size), quick=True)

    # ---- what is no file ----

    def test_not_a_file(self):
        os.mkdir(self.place("folder.png"))
        self.refused("folder.png", None, "is a folder")
        self.refused("missing.png", None, "No such file")
        self.refused("folder.png/missing.png", None, "No such file")
        write(self.place("file.png"), files.png(2, 2))
        self.refused("file.png/below.png", None, "Not a directory")
        os.symlink("nowhere.png", self.place("dangling.png"))
        self.refused("dangling.png", None, "No such file")
        os.symlink("loop.png", self.place("loop.png"))
        self.refused("loop.png", None, "cannot be opened")
        self.refused("n" * 300 + ".png", None, "too long")
        with socket.socket(socket.AF_UNIX) as door:
            door.bind(self.place("socket.png"))
            self.refused("socket.png", None, "is a socket")

    def test_fifo(self):
        os.mkfifo(self.place("pipe.png"))
        self.refused("pipe.png", None, "is a pipe")
        os.symlink("pipe.png", self.place("link.png"))
        self.refused("link.png", None, "is a pipe")
        # Somebody holds it open and writes nothing.
        writer = os.open(self.place("pipe.png"), os.O_RDWR)
        self.refused("pipe.png", None, "is a pipe")
        os.close(writer)

    def test_devices(self):
        for device in "/dev/zero", "/dev/null", "/dev/urandom", "/dev/full":
            self.refused(device, None, "is a device", named=device)
        os.symlink("/dev/zero", self.place("zero.png"))
        self.refused("zero.png", None, "is a device")

    def test_unreadable(self):
        write(self.place("secret.png"), files.png(2, 2))
        os.chmod(self.place("secret.png"), 0)
        self.refused("secret.png", None, "Permission denied", preexec=harness.without_privileges)

    def test_too_large_a_file(self):
        for name in "large.png", "large.probewarp":
            magic = b"\x89PNG\r\n\x1a\n" if name.endswith("png") else b"PK\x03\x04"
            self.refused(name, sparse(magic, 64 * GIB))

    def test_strange_names(self):
        for name in "a\nb.png", "\x1b[31mred.png", "\u009b31mred.png", "caf\u00e9 \u0001.png":
            self.refused(name, b"", "is empty", named="is empty")
        self.refused(os.fsdecode(b"latin\xe9.png"), b"", "is empty", named="is empty")
        self.refused("\x1b[31m\u009b.probewarp", files.project(format=3), named="format 3")
        self.refused(os.fsdecode(b"\xe9.probewarp"), files.project(format=3), named="format 3")

    # ---- sizes beyond the limits ----

    def test_dimensions_past_the_limit(self):
        sizes = [(32769, 1), (1, 32769), (20000, 20000), (65535, 65535), (0, 1), (1, 0)]
        larger = sizes + [(2**31 - 1, 2**31 - 1), (2**31, 1), (2**32 - 1, 2**32 - 1), (65536, 65536)]
        for w, h in larger:
            end = files.png_chunk(b"IDAT", zlib.compress(b"\0" * 100)) + files.png_chunk(b"IEND", b"")
            self.refused("a.png", files.png_header(w, h) + end)
            self.refused("a.png", files.png_header(w, h, 1, 0, 1) + end)
            self.refused("a.psd", b"8BPS" + struct.pack(">H6xHIIHH", 1, 3, h, w, 8, 3) + bytes(200))
            self.refused("a.ppm", f"P6 {w} {h} 255\n".encode() + bytes(200))
            self.refused("a.pbm", f"P1 {w} {h}\n".encode() + b"1" * 200)
        for w, h in [(32769, 1), (1, 32769), (1, -32769), (20000, 20000), (20000, -20000), (0, 1), (1, 0), (-1, 1),
                     (2**31 - 1, 2**31 - 1), (1, -2**31), (-2**31, 1), (-2**31, -2**31)]:
            head = b"BM" + struct.pack("<IHHIIiiHHIIIIII", 300, 0, 0, 54, 40, w, h, 1, 24, 0, 0, 0, 0, 0, 0)
            self.refused("a.bmp", head + bytes(200))
        for w, h in sizes:
            self.refused("a.tga", struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, w, h, 24, 0x20) + bytes(200))
            self.refused("a.gif", b"GIF89a" + struct.pack("<HHBBB", w, h, 0x80, 0, 0) + bytes(6) + b"\x2c"
                         + struct.pack("<HHHHB", 0, 0, w, h, 0) + b"\x02\x02\x4c\x01\x00\x3b")
        for number in "99999999999", "-5", "1e3", "0x10", "18446744073709551617":
            self.refused("a.ppm", f"P6 {number} 1 255\nabc".encode())
            self.refused("a.ppm", f"P6 1 1 {number}\nabc".encode())

    def test_jpeg_dimensions(self):
        data = dict(files.sound(program, self.inputs))["made.jpg"]
        frame = data.index(b"\xff\xc0") + 5
        for w, h in (65535, 65535), (40000, 1), (1, 40000), (32768, 32768), (0, 5), (5, 0), (10000, 10000):
            self.refused("a.jpg", data[:frame] + struct.pack(">HH", h, w) + data[frame + 4:])

    # ---- bombs ----

    def test_png_of_huge_dimensions(self):
        # 32768 x 32768 zeros, and all of them in the file: a gigabyte, packed to a megabyte.
        packed, _ = files.deflated_zeros(GIB + (1 << 20))
        self.refused("bomb.png", files.png_header(32768, 32768, 8, 0) + files.png_chunk(b"IDAT", packed)
                     + files.png_chunk(b"IEND", b""))
        self.refused("bomb.png", files.png_header(30000, 30000, 16, 6) + files.png_chunk(b"IDAT", packed)
                     + files.png_chunk(b"IEND", b""))

    def test_small_png_with_a_gigabyte_inside(self):
        packed, _ = files.deflated_zeros(GIB)
        end = files.png_chunk(b"IEND", b"")
        self.harmless("idat.png", files.png_header(16, 16) + files.png_chunk(b"IDAT", packed) + end)
        head, body = files.png_header(2, 2, 8, 0), files.png_chunk(b"IDAT", zlib.compress(bytes(6))) + end
        for kind, start in ((b"zTXt", b"Comment\0\0"), (b"iCCP", b"Profile\0\0"), (b"iTXt", b"Comment\0\1\0\0\0")):
            self.harmless(kind.decode() + ".png", head + files.png_chunk(kind, start + packed) + body)
        many = files.png_chunk(b"zTXt", b"Comment\0\0" + packed[:100000]) * 500
        self.harmless("many.png", head + many + body)

    def test_the_same_said_very_often(self):
        # What costs time to look at is looked at once, however often a file says it.
        icc, _ = files.deflated_zeros(8 << 20)  # more than a profile may have
        head, body = files.png_header(2, 2, 8, 0), files.png_chunk(b"IDAT", zlib.compress(bytes(6)))
        profiles = files.png_chunk(b"iCCP", b"Profile\0\0" + icc) * 2000
        self.harmless("profiles.png", head + profiles + body + files.png_chunk(b"IEND", b""))
        gif = files.gif(2, 2)
        block = b"\x21\xff\x0bICCRGBG1012" + (b"\xff" + bytes(255)) * 2000 + b"\0"
        at = gif.index(b"\x2c", 13)
        self.harmless("profiles.gif", gif[:at] + block * 40 + gif[at:])
        jpeg = dict(files.sound(program, self.inputs))["made.jpg"]
        for marker in b"\xff\xe1\0\2", b"\xff\xe2\0\2":
            self.refused("markers.jpg", jpeg[:2] + marker * 2000000 + jpeg[2:], "application markers", quick=True)

    def test_channels_that_are_no_part_of_the_picture(self):
        rows, _ = files.deflated_zeros(1 << 20)  # gigabytes could follow in some megabytes
        for before in 54, 11:
            channels = struct.pack(">I", 5) * before + bytes(4)
            resource = files.psd_resource(1053, channels)
            self.refused("between.psd", b"8BPS" + struct.pack(">H6xHIIHH", 1, 56, 10000, 10000, 8, 1) + bytes(4)
                         + struct.pack(">I", len(resource)) + resource + bytes(4) + b"\0\2" + rows,
                         f"behind {before} large channels", quick=True)

    def test_large_pictures_bad_at_the_end(self):
        # As large as is allowed, small as files, and wrong at their ends only: all of the work, and then nothing.
        def late(width, height, bits, colour, interlaced, total):
            packed, _ = files.deflated_zeros(total << 20)  # the last rows are missing
            return (files.png_header(width, height, bits, colour, interlaced) + files.png_chunk(b"IDAT", packed)
                    + files.png_chunk(b"IEND", b""))
        self.refused("rgba.png", late(10000, 10000, 8, 6, 0, 381))
        self.refused("bits.png", late(10000, 10000, 1, 0, 0, 11))
        self.refused("deep.png", late(7000, 7000, 16, 6, 0, 373))
        self.refused("interlaced.png", late(10000, 10000, 8, 6, 1, 381))
        self.refused("interlaced bits.png", late(10000, 10000, 1, 0, 1, 11))
        runs = 10000 * 79  # of 128 pixels
        self.refused("runs.tga", struct.pack("<BBBHHBHHHHBB", 0, 0, 11, 0, 0, 0, 0, 0, 10000, 10000, 8, 0x20)
                     + b"\xff\x55" * (runs - 9000))
        self.refused("codes.gif", b"GIF89a" + struct.pack("<HHBBB", 10000, 10000, 0x80, 0, 0) + bytes(6) + b"\x2c"
                     + struct.pack("<HHHHB", 0, 0, 10000, 10000, 0) + b"\x08" + (b"\xff" + bytes(255)) * 9000 + b"\0\x3b")
        row = b"\x81\x00" * 78 + b"\xf1\x00"
        rows = 30000
        for mode in 3, 9:  # RGB, and Lab, whose conversion is slow
            self.refused("rows.psd", b"8BPS" + struct.pack(">H6xHIIHH", 1, 3, 10000, 10000, 8, mode) + bytes(12) + b"\0\1"
                         + struct.pack(">H", len(row)) * rows + row * (rows - 1) + bytes(len(row) - 2) + b"\x7f\x00")
        self.refused("bits.pbm", b"P1 10000 10000\n" + b"1" * (10**8 - 1) + b"x")

    def test_long_files_of_large_pictures(self):
        # The file and the pixels are in memory together: each within its limit, and wrong at the end.
        self.refused("long.ppm", sparse(b"P6 9400 9400 254\n", 17 + 9400 * 9400 * 3, b"\xff"), "expected at most")
        self.refused("long.tga", sparse(struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, 9400, 9400, 24, 0x20),
                                        9400 * 9400 * 3))
        packed, _ = files.deflated_zeros(381 << 20)
        body = files.png_chunk(b"IDAT", packed) + files.png_chunk(b"IEND", b"")
        passed_over = files.png_header(10000, 10000) + struct.pack(">I4s", 240 << 20, b"teXt")
        self.refused("long.png", sparse(passed_over, len(passed_over) + (240 << 20) + 4 + len(body), body))

    # ---- projects: JSON ----

    def json_refused(self, text, says=""):
        self.refused("a.probewarp", files.project_of(text), says, quick=True)

    def changed(self, place, value):
        """project.json with one value put in as text, so that it may be what Python would not write."""
        marker = "@@"
        tree = files.fields()
        target = tree
        for key in place[:-1]:
            target = target[key]
        target[place[-1]] = marker
        return json.dumps(tree).replace(f'"{marker}"', value)

    def test_json_numbers(self):
        places = [["format"], ["mesh", "cells"], ["probes", 0, "id"], ["probes", 0, "rest", 0], ["probes", 0, "now", 1],
                  ["probes", 0, "angle_radians"], ["probes", 0, "radius"]]
        for place in places:
            for value in ("NaN", "Infinity", "-Infinity", "nan", "1e999", "-1e999", "1e400", "0x10", "01", "1.", ".5", "+1",
                          "1e", "--1", "1,5", '"1"', "null", "true", "[]", "{}", "1e300", "-1e300", "9" * 400):
                self.json_refused(self.changed(place, value))
        for place, values in [(["mesh", "cells"], "0 -1 -0 -0.0 1001 2147483648 4294967297 18446744073709551616 "
                                                  "18446744073709551617 1e2 4.0 4.5 -9223372036854775808"),
                              (["probes", 0, "id"], "0 -1 -0 2147483647 2147483648 4294967297 18446744073709551615 1.0 1.5"),
                              (["probes", 0, "radius"], "0 -1 -0.0 1e-300 1e8"),
                              (["probes", 0, "rest", 0], "1e8 -1e8"), (["probes", 0, "angle_radians"], "1e7 -1e7"),
                              (["format"], "0 -1 3 1000000 1.0 1.5 4294967297 18446744073709551617")]:
            for value in values.split():
                self.json_refused(self.changed(place, value))

    def test_json_types_and_fields(self):
        for key in files.fields():
            for value in ("null", "true", "[]", "{}", '"x"', "-7", "[[]]", '""'):
                if (key, value) != ("probes", "[]"):
                    self.json_refused(self.changed([key], value))
            tree = files.fields()
            del tree[key]
            self.json_refused(json.dumps(tree), key)
        for key in files.fields()["probes"][0]:
            tree = files.fields()
            del tree["probes"][1][key]
            self.json_refused(json.dumps(tree), key)
            self.json_refused(self.changed(["probes", 1, key], "[0]"))
        for place in [], ["image"], ["mesh"], ["probes", 0]:
            self.json_refused(self.changed(place + ["future"], "1"), "future")
            self.json_refused(self.changed(place + [""], "1"))
            self.json_refused(self.changed(place + ["\u001b[31m\u009b"], "1"))
            self.json_refused(self.changed(place + ["\u00e9" * 200], "1"))
            self.json_refused(self.changed(place + ["x" * 1000000], "1"))
        self.json_refused(self.changed(["format"], "3"), "format 3")
        for colour in '"red"', '"#12345"', '"#1234567"', '"#gggggg"', '"#-12345"', '"# 12345"', '"#0x1234"':
            self.json_refused(self.changed(["probes", 0, "colour"], colour), "colour")
        for name in '"a\\nb"', '"\\u001b[31m"', '"\\u0000"', '"\\u007f"', f'"{"x" * 201}"':
            self.json_refused(self.changed(["probes", 0, "name"], name), "name")
        for text in '"\\ud800"', '"\\x"', '"open', "'x'":
            self.json_refused(self.changed(["probes", 0, "name"], text))

    def test_json_duplicates(self):
        text = json.dumps(files.fields())
        self.json_refused('{"format": 1, ' + text[1:], "format")
        self.json_refused(text[:-1] + ', "probes": []}', "probes")
        self.json_refused(text.replace('"cells"', '"cells": 3, "cells"'), "cells")
        self.json_refused(text.replace('"radius"', '"radius": 3, "r\\u0061dius"'), "radius")
        self.json_refused(text.replace('"id": 2', '"id": 1'), "id")

    def test_json_shape(self):
        for text in "", " ", "{", "}", "[]", "null", "1", '"x"', "{}", "{}{}", "nul", "\0", "\ufeff", "// x\n{}", "{'a':1}":
            self.json_refused(text)
        sound = json.dumps(files.fields())
        for text in sound + "x", sound + sound, sound[:-1], sound.replace(",", ",,", 1), sound[:-1] + ",}", "/**/" + sound:
            self.json_refused(text)
        self.json_refused(sound.encode("utf-16"))
        self.json_refused(sound.encode().replace(b"Probe 1", b"Probe \xff"))
        for opening, closing in ("[", "]"), ('{"a":', "}"), ("[[{},", "]]"):
            self.json_refused(opening * 100000)
            self.json_refused(opening * 100000 + "1" + closing * 100000)
            self.json_refused(self.changed(["probes"], opening * 100000 + "1" + closing * 100000), "deep")

    def test_json_counts(self):
        probe = files.fields()["probes"][0]
        many = [dict(probe, id=i + 1) for i in range(10001)]
        self.json_refused(json.dumps(dict(files.fields(), probes=many)), "probes")
        dense = dict(files.fields(), probes=many[:10000], mesh={"cells": 1000})
        self.json_refused(json.dumps(dense))
        self.json_refused(json.dumps(dict(files.fields(), probes=[0] * 1000000)), "probes")

    def test_json_size(self):
        # 16 MiB is what project.json may have; these stay just below it, the last one goes beyond.
        limit = (16 << 20) - 2000
        texts = {
            "empty lists": "[" + "[]," * (limit // 3) + "0]",
            "empty objects": "[" + "{}," * (limit // 3) + "0]",
            "empty strings": "[" + '"",' * (limit // 3) + "0]",
            "zeros": "[" + "0," * (limit // 2) + "0]",
            "one string": '"' + "x" * limit + '"',
            "one number": "1" * limit,
            "white space": " " * limit,
            "half": "[" * 7 + "0," * (limit // 2),
            "too long": " " * (17 << 20),
        }
        for what, text in texts.items():
            with self.subTest(what=what):
                self.json_refused(text)
                if text.startswith("["):
                    self.json_refused(self.changed(["probes"], text))

    def test_json_with_very_many_fields(self):
        fields = ",".join(f'"{i:x}":0' for i in range(1500000))
        self.json_refused("{" + fields + "}")

    # ---- projects: ZIP ----

    def members(self):
        return [("mimetype", files.MIMETYPE), ("project.json", json.dumps(files.fields()).encode()),
                ("image.ppm", files.PIXEL)]

    def zip_refused(self, members, says=""):
        self.refused("a.probewarp", files.archive(members), says)

    def test_zip_members(self):
        good = self.members()
        self.refused("a.probewarp", b"PK\x05\x06" + bytes(18))
        for i, (name, _) in enumerate(good):
            self.zip_refused(good[:i] + good[i + 1:], "" if i == 0 else name)
            self.refused("a.probewarp", files.zip_records([files.record(n.encode(), d) for n, d in good + [good[i]]]))
            self.zip_refused(good[:i] + [(name, b"")] + good[i + 1:])
        self.assertEqual(self.open_quietly(files.archive([good[1], good[0], good[2]])), 0)  # as other archivers order them
        self.zip_refused([("mimetype", b"application/zip")] + good[1:], "mimetype")
        self.zip_refused(good + [("future.txt", b"x")], "future.txt")
        for name in ("../x", "/x", "a\\b", "..", ".", "a/../../x", "a/./b", "a//b", "C:x", "x/", "", "a\0b", "\x1b[31m", "a\nb",
                     "\u009b31m"):
            self.refused("a.probewarp", files.zip_records([files.record(n.encode(), d) for n, d in good + [(name, b"x")]]))
        raw = [files.record(n.encode(), d) for n, d in good]
        self.refused("a.probewarp", files.zip_records(raw + [files.record(b"\xff\xfe", b"x")]))
        self.refused("a.probewarp", files.zip_records(raw + [files.record(b"\xff\xfe\x9b", b"x", flags=1 << 11)]))
        for name in ("../image.ppm", "/etc/passwd", "other.ppm", "", "mimetype", "project.json", "IMAGE.PPM"):
            self.json_refused(self.changed(["image", "file"], json.dumps(name)))
        self.json_refused(self.changed(["image", "file"], '"\\u009b31m.ppm"'))
        self.zip_refused(good + [(f"m{i}", b"") for i in range(5000)])

    def test_zip_lies(self):
        good = [files.record(n.encode(), d) for n, d in self.members()]
        name, data = "image.ppm", files.PIXEL
        squeezed = zlib.compress(data, 9, -15)

        def with_image(**lie):
            return files.zip_records(good[:2] + [files.record(name.encode(), data, **lie)])
        self.assertEqual(self.open_quietly(with_image(method=8, raw=squeezed)), 0)  # the honest one
        for lie in (dict(check=1), dict(size=5), dict(size=500), dict(packed=5), dict(packed=500), dict(flags=1),
                    dict(flags=0x41), dict(method=99), dict(method=12), dict(method=14), dict(size=0xFFFFFFFF),
                    dict(packed=0xFFFFFFFF, size=0xFFFFFFFF), dict(method=8, raw=squeezed, size=5),
                    dict(method=8, raw=squeezed, size=5000), dict(method=8, raw=squeezed[:-2]), dict(method=8),
                    dict(method=8, raw=squeezed, check=1), dict(method=8, raw=b""), dict(method=8, raw=squeezed, flags=1)):
            with self.subTest(lie=lie):
                self.refused("a.probewarp", with_image(**lie))
        whole = files.zip_records(good)
        for count in 0, 1, 2, 4, 65535:
            self.refused("a.probewarp", files.zip_records(good, count=count))
        self.refused("a.probewarp", whole + b"junk")
        self.refused("a.probewarp", whole + bytes(100000))
        start = whole.index(b"PK\x01\x02")
        self.refused("a.probewarp", whole[:start] + b"junk" + whole[start:])
        for at in range(0, len(whole) - start, 3):  # every third byte of the directory turned over
            broken = bytearray(whole)
            broken[start + at] ^= 0xFF
            if self.open_quietly(bytes(broken)) != 0:  # times, attributes and versions may say anything
                self.refused("a.probewarp", bytes(broken), quick=True)

    def open_quietly(self, data):
        write(self.place("quiet.probewarp"), data)
        result = program.run("info", self.place("quiet.probewarp"))
        os.unlink(self.place("quiet.probewarp"))
        return result.code

    def test_zip_of_other_archivers(self):
        class Stream(io.RawIOBase):  # that cannot be sought in: sizes stand behind the members
            def __init__(self):
                self.written = bytearray()

            def writable(self):
                return True

            def write(self, data):
                self.written += data
                return len(data)
        for method in zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED:
            for streamed in False, True:
                for wrapped in "", "dance/", "./":
                    out = Stream() if streamed else io.BytesIO()
                    with zipfile.ZipFile(out, "w", method) as z:
                        z.writestr(zipfile.ZipInfo((wrapped or "paint/") + "more/"), b"")
                        for name, data in sorted(self.members()):
                            with z.open(wrapped + name, "w", force_zip64=True) as member:
                                member.write(data)
                        z.comment = b"zipped again"
                    with self.subTest(method=method, streamed=streamed, wrapped=wrapped):
                        self.assertEqual(self.open_quietly(bytes(out.written) if streamed else out.getvalue()), 0)
        for method, name in (zipfile.ZIP_LZMA, "LZMA"), (zipfile.ZIP_BZIP2, "bzip2"):
            self.refused("a.probewarp", files.archive(self.members(), method), name)

    def test_zip_bombs(self):
        good = [files.record(n.encode(), d) for n, d in self.members()]
        packed, crc = files.deflated_zeros(GIB, -15)
        for size in GIB, 12, 23, 1 << 20, 255 << 20:
            for at, name in enumerate((b"mimetype", b"project.json", b"image.ppm")):
                bomb = (name, packed, 8, len(packed), size, crc, 0)
                self.refused("bomb.probewarp", files.zip_records(good[:at] + [bomb] + good[at + 1:]))
            self.refused("bomb.probewarp", files.zip_records(good + [(b"more", packed, 8, len(packed), size, crc, 0)]))
        part, part_crc = files.deflated_zeros(64 << 20, -15)
        parts = [(f"m{i}".encode(), part, 8, len(part), 64 << 20, part_crc, 0) for i in range(40)]
        self.refused("bomb.probewarp", files.zip_records(good + parts))

    def test_zip_with_a_large_picture_bad_at_the_end(self):
        head, pixels = b"P6 9400 9400 254\n", 9400 * 9400 * 3
        packer, crc, out, size = zlib.compressobj(9, zlib.DEFLATED, -15), 0, [], len(head) + pixels
        blocks = [head] + [bytes(1 << 20)] * ((pixels - 1) >> 20) + [bytes((pixels - 1) % (1 << 20)), b"\xff"]
        for block in blocks:
            out.append(packer.compress(block))
            crc = zlib.crc32(block, crc)
        packed = b"".join(out) + packer.flush()
        good = [files.record(n.encode(), d) for n, d in self.members()]
        self.refused("late.probewarp", files.zip_records(good[:2] + [(b"image.ppm", packed, 8, len(packed), size, crc, 0)]))

    def test_zip_with_very_many_members(self):
        # One local header, three million entries in the directory that all point to it.
        count, name, data = 3000000, b"m", b""
        local = b"PK\x03\x04" + struct.pack("<HHHHHIIIHH", 20, 0, 0, 0, 0x21, 0, 0, 0, 1, 0) + name
        entry = b"PK\x01\x02" + struct.pack("<HHHHHHIIIHHHHHII", 20, 20, 0, 0, 0, 0x21, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0) + name

        def make(path):
            with open(path, "wb") as f:
                f.write(local)
                for _ in range(count // 10000):
                    f.write(entry * 10000)
                size, start = len(entry) * count, len(local)
                f.write(struct.pack("<IQHHIIQQQQ", 0x06064B50, 44, 45, 45, 0, 0, count, count, size, start))
                f.write(struct.pack("<IIQI", 0x07064B50, 0, start + size, 1))
                f.write(b"PK\x05\x06" + struct.pack("<HHHHIIH", 0, 0, 65535, 65535, 0xFFFFFFFF, 0xFFFFFFFF, 0))
        self.refused("many.probewarp", make)

    # ---- projects: paint ----

    def test_paint(self):
        sound = files.png(6, 3, 16, 4)
        self.assertEqual(self.open_quietly(files.archive(files.painted_members())), 0)
        for paint in (b"", b"P5 1 1 255\nx", files.bmp(5, 3), sound[:-1], sound[:-12], sound[:40], sound[:8],
                      sound[:60] + bytes([sound[60] ^ 0xFF]) + sound[61:], sound[:29] + bytes(4) + sound[33:]):
            self.refused("a.probewarp", files.archive(files.painted_members(paint)), "paint/1.png", quick=True)
            self.refused("a.probewarp", files.archive(files.painted_members(None, paint)), "stiffness.png", quick=True)
        good = files.painted_members()
        for i in 3, 4:
            self.zip_refused(good[:i] + good[i + 1:], good[i][0])
        self.zip_refused(good + [("paint/2.png", sound)], "paint/2.png")
        self.refused("a.probewarp", files.zip_records([files.record(n.encode(), d) for n, d in good + [good[3]]]))
        text = good[1][1].decode()
        for name in "stiffness.png", "image.ppm", "project.json", "mimetype", "../paint", "/etc/passwd", "\u009b31m", "":
            changed = text.replace('"paint/1.png"', json.dumps(name))
            self.zip_refused([good[0], ("project.json", changed.encode())] + good[2:])
        for value in "NaN", "0", "-1", "1e-7", "1e7", "1e999", "null", '"1"', "[]":
            changed = text.replace("[1.0, 0.5]", f"[1.0, {value}]")
            self.zip_refused([good[0], ("project.json", changed.encode())] + good[2:])

    def test_paint_bombs(self):
        def paint(width, height, bits, colour, total):
            """Small as a file: `total` bytes of zeros."""
            packed, _ = files.deflated_zeros(-(-total // (1 << 20)) << 20)
            return (files.png_header(width, height, bits, colour) + files.png_chunk(b"IDAT", packed)
                    + files.png_chunk(b"IEND", b""))

        def project(data):
            return files.archive(files.painted_members(data))

        self.harmless("line.probewarp", project(paint(30000, 1, 16, 4, 120001)))
        self.harmless("column.probewarp", project(paint(1, 30000, 16, 4, 150000)))
        self.harmless("wide.probewarp", project(paint(32768, 3000, 8, 0, 32769 * 3000)))
        self.harmless("deep.probewarp", project(paint(32768, 1500, 16, 4, 131073 * 1500)))
        for size in (32768, 3100, 16, 4), (30000, 30000, 16, 4), (32769, 1, 16, 4), (1, 40000, 8, 0), (0, 4, 16, 4):
            self.refused("large.probewarp", project(paint(*size, 1 << 20)), "paint/1.png")
        self.refused("late.probewarp", project(paint(32768, 3000, 8, 0, 32769 * 2900)), "paint/1.png")

    # ---- the other inputs ----

    def test_csv(self):
        write(self.place("good.png"), files.png(4, 4))
        row = "0,0,0,1,1,0.5,10\n"
        head = "#vertices ix,iy,x,y\n0,0,0,0\n#probes ix,iy,itheta,x,y,theta,radius\n"
        cases = ["", "\n", "a text", "#vertices\n0,0,0,0\n", row, head + "0,0,0,1,1,0.5\n", head + "0,0,0,1,1,0.5,10,1\n",
                 head + "0,0,0,1,1,0.5,\n", head + "0;0;0;1;1;0.5;1.000,5\n", head + "0,0,0,1,1,0.5,0x10\n", head + "\0,", head + "\x1b[31m",
                 head + ",,,,,,1\n", head + row * 10001, head + "1" * 1000000, head + "," * 1000000 + "1"]
        for value in "nan", "inf", "-inf", "1e999", "-1e999", "1e300", "abc", "", "1e7":
            cases += [head + f"{value},0,0,1,1,0.5,10\n", head + f"0,0,0,1,1,0.5,{value}\n", head + row + f"0,0,{value},1,1,0,10\n"]
        cases += [head + f"0,0,0,1,1,0.5,{radius}\n" for radius in ("0", "-1", "-0.0")]
        good, csv = self.place("good.png"), self.place("bad.csv")
        for text in cases:
            write(csv, text.encode())
            with self.subTest(csv=text[-60:]):
                self.refused("good.png", None, named=csv, options=["--probes", csv])
        os.unlink(csv)
        os.mkdir(csv)
        os.mkfifo(self.place("pipe.csv"))
        for path in csv, self.place("pipe.csv"), "/dev/zero", self.place("missing.csv"):
            self.refused("good.png", None, named=path, options=["--probes", path])
            self.refused("good.png", None, named=path, options=["--image", path])
        write(self.place("bad.png"), files.png(4, 4)[:-13])
        self.refused("good.png", None, named=self.place("bad.png"), options=["--image", self.place("bad.png")])
        write(self.place("project.probewarp"), files.project())
        path = self.place("project.probewarp")
        self.refused("good.png", None, named=path, options=["--image", path])
        self.assertTrue(os.path.exists(good))

    # ---- wrong usage ----

    def wrong_usage(self, *arguments, says="", **settings):
        with self.subTest(arguments=arguments):
            self.check(list(arguments), True, 2, "", says, False, **settings)

    def test_wrong_usage(self):
        good = self.place("good.png")
        write(good, files.png(4, 4))
        out = self.output
        for arguments in (["render"], ["render", good], ["render", "-o", out], ["render", good, "-o"], ["info"],
                          ["render", good, good, "-o", out], ["info", good, good], ["--bogus"], ["-x"], ["info", good, "--bogus"],
                          ["info", good, "-o", out], ["render", good, "-o", out, "--bogus"], ["render", good, "-o", out, "--prob", "1,1"],
                          ["info", good, "--backend", "vulkan"], ["render", good, "info", "-o", out],
                          ["render", good, "-o", out, "--\x1b[31m\n\u009b"], ["render", good, "-o", out, os.fsdecode(b"--\xff")]):
            self.wrong_usage(*arguments)
        for target in "out", "out.gif", "out.psd", "out.xyz", "out.png.", ".png", "-", "", "out.\x1b[31m", "out.\u009b":
            path = target if target in ("-", "") else os.path.join(self.outputs, target)
            self.wrong_usage("render", good, "-o", path)
        self.wrong_usage("render", good, "-o", good, says="input")
        for kind in "gif", "psd", "PNM", "png ", "x\ny":
            self.wrong_usage("render", good, "-o", out, "--format", kind)

    def test_wrong_values(self):
        good = self.place("good.png")
        write(good, files.png(4, 4))
        numbers = ["nan", "NaN", "inf", "-inf", "infinity", "1e999", "-1e999", "abc", "", " ", "1 2", "1,5", "1e", "\x1b[31m"]
        values = {
            "--probe": ["1", "1,", ",1", "1,2,3", "1,2:", "1,2:3", "1,2:3,4,", "1,2:3,4,5,0", "1,2:3,4,5,-1", "1,2:3,4,5,nan", "1,2:3,4,5,inf",
                        "1,2:3,4,5,1e-9", "1,2:3,4,5,6,7", "1,2:3,4:5", "1e999,0", "nan,0", "0,nan", "inf,0", "0,-inf", "1e300,0",
                        "1,2:nan,4", "1,2:3,inf", "1,2:3,4,nan", "1,2:3,4,inf", "1,2:3,4,1e999", " 1,2", "1, 2", "1;2", "+1,2", ":", ""],
            "--size": ["0x0", "0x5", "5x0", "-1x5", "5x-1", "5", "5x", "x5", "5x5x5", "nanxnan", "infx5", "99999999999x1", "1e3x10", "5 x 5",
                       "5X5x", "0x10", "2147483648x1", "", "\x1b[31m"],
            "--background": ["red", "#12", "#12345", "#1234567", "#gggggg", "123456", "#-12345", "nan", "", "#", "#+1+1+1", "\x1b[31m"],
            "--samples": ["0", "-1", "17", "1.5", "2147483648", "99999999999999999999"] + numbers,
            "--mesh": ["0", "-1", "1001", "1.5", "2147483648", "99999999999999999999"] + numbers,
            "--scale": ["0", "-1", "-0", "1e-9", "1e9"] + numbers,
            "--canvas": ["fill", "", "IMAGE "], "--weights": ["bogus", ""], "--blend": ["bogus", ""],
            "--backend": ["vulkan", "", "auto "],
        }
        for option, bad in values.items():
            for value in bad:
                self.wrong_usage("render", good, "-o", self.output, f"{option}={value}") \
                    if option != "--backend" else self.wrong_usage("render", good, "-o", self.output, f"{option}={value}")
            self.wrong_usage("render", good, "-o", self.output, option)
        self.wrong_usage("render", good, "-o", self.output, "--size", "5x5", "--scale", "2")
        self.wrong_usage("render", good, "-o", self.output, env={"PROBEWARP_BACKEND": "vulkan"})

    def test_export_past_the_limit(self):
        # Right as words, but not with this picture.
        for options in (["--size", "40000x1"], ["--size", "30000x30000"], ["--scale", "10000"],
                        ["--canvas", "fit", "--probe", "0,0:9000000,0", "--probe", "30,30"]):
            write(self.place("good.png"), files.png(40, 40))
            self.refused("good.png", None, options=options, named="pixels", expected=False)


def sparse(head, size, tail=b""):
    """A function that makes a file of `size` bytes with a beginning and an end, and nothing on the disk between."""
    def make(path):
        with open(path, "wb") as f:
            f.write(head)
            f.truncate(size)
            f.seek(size - len(tail))
            f.write(tail)
    return make


def main():
    global program
    program = harness.Program(harness.options().program)
    outcome = unittest.main(exit=False)
    print(f"{program.runs} runs; the slowest took {program.slowest[0]:.2f} s: {' '.join(program.slowest[1])[-120:]!r}; "
          f"the largest {program.largest[0]:.0f} MiB: {' '.join(program.largest[1])[-120:]!r}" if program.slowest else "")
    # A child's peak begins at its parent's: ours must not be what was measured.
    own = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    assert own < MIB, f"the test itself took {own:.0f} MiB"
    sys.exit(not outcome.result.wasSuccessful())


if __name__ == "__main__":
    main()
