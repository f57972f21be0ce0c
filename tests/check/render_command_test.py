"""`probewarp render` of many pictures, its compressions and timings: many at once give what one at a time gives, one bad
picture stops no other, and what cannot be meant is refused before anything is written.
Run: render_command_test.py PROGRAM"""

import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from png_file import read_png, write_png

PROGRAM = None
IMAGES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "images")
OCTOPUS = os.path.join(IMAGES, "octopus.probewarp")


def contents(path):
    with open(path, "rb") as file:
        return file.read()


def shades(width, height, seed, holes=False):
    """RGBA, smooth; a hole in the right half where asked for."""
    samples = []
    for y in range(height):
        for x in range(width):
            hole = holes and x > width // 2 and y > height // 3
            samples += [(x * seed) & 255, (y * 3 + seed) & 255, (x + y) & 255, 0 if hole else 255]
    return samples


class Info(unittest.TestCase):
    def test_it_tells_who_deforms_and_both_times(self):
        output = subprocess.run([PROGRAM, "info", OCTOPUS, "--backend", "osmesa"], capture_output=True, text=True,
                                check=True, timeout=120).stdout
        self.assertIn("deforms by: processor; llvmpipe draws in software\n", output)
        times = re.search(r"10201 vertices by 8 probes: processor ([\d.]+) ms, shader ([\d.]+) ms\n", output)
        self.assertTrue(all(float(time) > 0 for time in times.groups()), output)

    def test_the_windows_option_is_not_a_commands(self):
        done = subprocess.run([PROGRAM, "--deform", "shader", "info", OCTOPUS], capture_output=True, text=True, timeout=120)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertEqual(done.stderr, "probewarp: --deform: before a command it has no meaning; "
                         "expected it after render, or without a command\n")


class Render(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="probewarp-render-")
        self.addCleanup(shutil.rmtree, self.folder)
        self.pictures = [self.picture("a", 90, 61, 2), self.picture("b", 90, 61, 5), self.picture("c", 90, 61, 3, True),
                         self.picture("d", 61, 90, 7), self.picture("e", 90, 61, 11), self.picture("f", 200, 150, 1)]
        self.input = self.picture("input", 90, 61, 1)
        self.probes = "--probe", "20,15:28,18,30", "--probe", "70,20", "--weights", "harmonic"

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def picture(self, name, width, height, seed, holes=False):
        return write_png(self.path(name + ".png"), width, height, shades(width, height, seed, holes), 8, 6)

    def run_program(self, *arguments):
        done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=120)
        return done.returncode, done.stdout, done.stderr

    def run_well(self, *arguments):
        self.assertEqual(self.run_program(*arguments), (0, "", ""))

    def refused(self, *arguments, says):
        """Exit code 2, one line, and nothing written."""
        code, out, err = self.run_program(*arguments)
        self.assertEqual((code, out, err.count("\n")), (2, "", 1), err)
        self.assertIn(says, err)
        self.assertFalse(os.path.exists(self.path("out")), "something was made")

    def names(self, folder):
        return sorted(os.listdir(self.path(folder)))

    def test_many_are_what_each_one_is(self):
        for input in (self.input, OCTOPUS):
            probes = self.probes if input == self.input else ()
            with self.subTest(input=input):
                self.run_well("render", input, *probes, "--image", *self.pictures, "-o", self.path("out", "{name}.png"))
                self.assertEqual(self.names("out"), [name + ".png" for name in "abcdef"])
                for picture in self.pictures:
                    one = self.path("one.png")
                    self.run_well("render", input, *probes, "--image", picture, "-o", one)
                    self.assertEqual(contents(self.path("out", os.path.basename(picture))), contents(one), picture)

    def test_the_name_may_stand_anywhere(self):
        self.run_well("render", self.input, *self.probes, "--image", *self.pictures[:2], "-o",
                      self.path("out", "{name}", "small-{name}.jpg"), "--size", "20x20")
        self.assertEqual(self.names("out"), ["a", "b"])
        self.assertEqual(self.names("out/a"), ["small-a.jpg"])
        self.run_well("render", self.input, *self.probes, "--image", self.pictures[0], "-o", self.path("{name}.bmp"))
        self.assertTrue(os.path.exists(self.path("a.bmp")))

    def test_one_bad_picture_stops_no_other(self):
        bad, missing = self.path("bad.png"), self.path("missing.png")
        with open(bad, "w") as file:
            file.write("no picture")
        code, out, err = self.run_program("render", self.input, *self.probes, "--image", self.pictures[0], bad,
                                          self.pictures[1], missing, self.pictures[3], "-o",
                                          self.path("out", "{name}.png"))
        self.assertEqual((code, out), (1, ""))
        lines = err.splitlines()
        self.assertEqual(len(lines), 2, err)
        self.assertIn(bad, lines[0])
        self.assertIn(missing, lines[1])
        self.assertEqual(self.names("out"), ["a.png", "b.png", "d.png"])

    def test_one_that_cannot_be_written_stops_no_other(self):
        os.makedirs(self.path("out", "b.png"))
        code, _, err = self.run_program("render", self.input, *self.probes, "--image", *self.pictures[:3], "-o",
                                        self.path("out", "{name}.png"))
        self.assertEqual((code, err.count("\n")), (1, 1), err)
        self.assertIn(self.path("out", "b.png"), err)
        self.assertTrue(os.path.isfile(self.path("out", "a.png")) and os.path.isfile(self.path("out", "c.png")))

    def test_what_cannot_be_meant(self):
        out = self.path("out", "{name}.png")
        os.mkdir(self.path("other"))
        twin = shutil.copy(self.pictures[0], self.path("other", "a.png"))
        several = "render", self.input, *self.probes, "--image", *self.pictures[:2]
        self.refused(*several, twin, "-o", out, says="both would be written to")
        self.refused(*several, "-o", self.path("out", "x.png"), says="{name}")
        self.refused(*several, "-o", self.path("out", "{name}.obj"), says="picture's format")
        self.refused(*several, "-o", self.path("out", "{name}.probewarp"), says="picture's format")
        self.refused(*several, "-o", out, "--heat", "Nobody", says="Probe 1")
        self.refused(*several, "-o", out, "--compression", "tiny", says="compression")
        before = contents(self.pictures[1])
        self.refused(*several, "-o", self.path("{name}.png"), says="one of the pictures")
        self.assertEqual(contents(self.pictures[1]), before)
        self.refused("render", self.input, *self.probes, "--image", self.path("other", "input.bmp"), "-o",
                     self.path("{name}.png"), says="the input itself")

    def test_compressions_keep_every_pixel(self):
        sizes = []
        for name in "fast", "default", "small":
            path = self.path(name + ".png")
            self.run_well("render", os.path.join(IMAGES, "octopus.png"), "-o", path, "--compression", name, "--size",
                          "300x250")
            sizes.append(os.path.getsize(path))
            self.assertEqual(read_png(path), read_png(self.path("fast.png")))
        self.assertLess(sizes[2], min(sizes[:2]))
        self.run_well("render", os.path.join(IMAGES, "octopus.png"), "-o", self.path("plain.png"), "--size", "300x250")
        self.assertEqual(contents(self.path("plain.png")), contents(self.path("default.png")))

    def test_alpha_that_leaves_the_frame_leaves_the_file(self):
        # The clear column on the left is pulled out of the frame: that nothing clear is left shows at the end, when much
        # is written already. The picture takes several strips and bands.
        width, height = 700, 900
        samples = [(x * 5 + y * y // 7 + c * 40) & 255 if c < 3 else 0 if x == 0 else 255
                   for y in range(height) for x in range(width) for c in range(4)]
        picture = write_png(self.path("wide.png"), width, height, samples, 8, 6)
        pulled = "--probe", "150,450:90,450", "--probe", "550,450:610,450"
        for output in self.path("out.png"), "-":
            done = subprocess.run([PROGRAM, "render", picture, *pulled, "-o", output, "--format", "png"],
                                  capture_output=True, timeout=120)
            self.assertEqual((done.returncode, done.stderr), (0, b""))
            file = contents(output) if output != "-" else done.stdout
            self.assertEqual(file[25], 2, "RGB: there is nothing to see through")
        self.assertEqual(file, contents(self.path("out.png")))
        filled = self.path("filled.png")
        self.run_well("render", picture, *pulled, "-o", filled, "--background", "#ff00ff")
        self.assertEqual(contents(filled), file)

    def test_timings_are_of_their_stages(self):
        picture = write_png(self.path("noise.png"), 900, 700, random.Random(3).randbytes(900 * 700 * 4), 8, 6)
        code, _, err = self.run_program("render", picture, "--probe", "20,15:28,18,30", "--mesh", "200", "--timings",
                                        "-o", self.path("x.png"))
        self.assertEqual(code, 0, err)
        told = {name: float(value) for name, value in re.findall(r"^timings: ([a-z ]+) (\d+\.\d{3}) s$", err, re.M)}
        # Each takes milliseconds at least: 630000 pixels of noise, 31000 vertices.
        for stage in "decode", "weights", "draw":
            self.assertGreater(told[stage], 0, err)
        # Half a thousandth each may have been rounded up.
        self.assertLess(told["decode"] + told["weights"] + told["draw"], told["in all"] + 0.002, err)

    def test_timings_are_told(self):
        for images in ((), ("--image", *self.pictures)):
            with self.subTest(images=len(images)):
                code, out, err = self.run_program("render", self.input, *self.probes, *images, "--timings", "-o",
                                                  self.path("out", "{name}.png") if images else self.path("x.png"))
                self.assertEqual((code, out), (0, ""), err)
                told = re.findall(r"^timings: ([a-z ]+) \d+\.\d{3} s$", err, re.M)
                self.assertEqual(told, ["decode", "weights", "draw", "encode", "write", "in all"])


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
