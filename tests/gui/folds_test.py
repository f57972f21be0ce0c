#!/usr/bin/env python3
"""What the window says and shows of triangles that lie folded over, and that what the mesh leaves out stays in view.

    folds_test.py --program PATH --images DIR --scratch DIR
"""
import argparse
import faulthandler
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from desk import Desk
from png_file import write_png

options = None

# Window pixels at scale 1: menu 32, tools 48, panel 308, status bar 26 of a window of 1280 x 800.
CANVAS = 48, 32, 1280 - 308, 800 - 26
STATUS = 0, 800 - 26, 1280, 800


def pixels(desk, area):
    """Blue, green and red of each."""
    for row in desk.seen(*area):
        step = len(row) // (area[2] - area[0])
        for i in range(0, len(row), step):
            yield row[i:i + 3]


def count(desk, area, colour):
    """How many have that colour."""
    return sum(pixel == colour for pixel in pixels(desk, area))


def reddish(desk, area, by):
    """How many have that much more red than blue: the warning's text, a red picture."""
    return sum(pixel[2] > pixel[0] + by for pixel in pixels(desk, area))


def warns(desk):
    return reddish(desk, STATUS, 80) > 50


class FoldsTest(unittest.TestCase):
    def desk(self, *arguments):
        desk = Desk(options.program, pathlib.Path(options.scratch) / self.id().split(".")[-1], arguments)
        self.addCleanup(desk.close)
        return desk

    def project(self, name, picture, *more):
        pathlib.Path(options.scratch).mkdir(parents=True, exist_ok=True)
        path = pathlib.Path(options.scratch) / name
        subprocess.run([options.program, "render", str(picture), "-o", str(path), *more], check=True)
        return path

    def opened(self, path):
        desk = self.desk(path)
        desk.wait_title(f"{path.name} – Probewarp")
        desk.settle()
        desk.ask("mousemove", 700, 787)  # the pointer is no part of what is looked at
        desk.settle()
        return desk

    def test_folds_are_told_and_shown(self):
        desk = self.opened(self.project("folded.probewarp", f"{options.images}/gingerbread.png", "--probe",
                                        "400,700:650,700", "--probe", "600,700:350,700"))
        desk.wait(lambda: warns(desk), "the warning in the status bar")
        plain = desk.seen(*CANVAS)
        white, dark = bytes((0xff, 0xff, 0xff)), bytes((0x12, 0x0f, 0x0d))
        before = count(desk, CANVAS, white), count(desk, CANVAS, dark)
        desk.key("shift+m")
        self.assertGreater(count(desk, CANVAS, white), before[0] + 1000)
        self.assertGreater(count(desk, CANVAS, dark), before[1] + 1000)
        desk.screenshot("marked")
        desk.key("shift+m")
        self.assertEqual(desk.seen(*CANVAS), plain)
        desk.key("ctrl+shift+r")  # all probes at rest
        desk.wait(lambda: not warns(desk), "the warning to go")
        desk.key("ctrl+z")
        desk.wait(lambda: warns(desk), "the warning to come back")

    def test_a_sound_pose_has_no_warning(self):
        desk = self.opened(self.project("sound.probewarp", f"{options.images}/gingerbread.png", "--probe",
                                        "400,700:410,705", "--probe", "600,700"))
        self.assertFalse(warns(desk))
        plain = desk.seen(*CANVAS)
        desk.key("shift+m")
        self.assertEqual(desk.seen(*CANVAS), plain)

    def test_what_the_mesh_leaves_out_stays_in_view(self):
        # A block amid a faint red frame, which the threshold leaves out of the mesh.
        size, samples = 200, []
        for y in range(size):
            for x in range(size):
                block, frame = max(abs(x - 100), abs(y - 100)) < 40, max(abs(x - 100), abs(y - 100)) > 80
                samples += [255, 0, 0, 255 if block else 40 if frame else 0]
        pathlib.Path(options.scratch).mkdir(parents=True, exist_ok=True)
        picture = write_png(pathlib.Path(options.scratch) / "frame.png", size, size, samples, 8, 6)

        seen = []
        for name, probe in ("still", "100,100"), ("moved", "100,100:100.001,100"):
            desk = self.opened(self.project(f"{name}.probewarp", picture, "--alpha-threshold", "50", "--probe", probe))
            desk.key("h")  # without the probes
            seen.append(reddish(desk, CANVAS, 12))
            desk.key("shift+w")  # over the block lie the weights, in an orange that is reddish too
            seen.append(reddish(desk, CANVAS, 12))
        self.assertEqual(seen, 4 * [200 * 200 - 161 * 161 + 79 * 79])


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    for name in ("program", "images", "scratch"):
        parser.add_argument(f"--{name}", required=True)
    options, rest = parser.parse_known_args()
    faulthandler.dump_traceback_later(170, exit=True)  # says where it hangs, should it hang
    unittest.main(argv=[sys.argv[0], *rest], verbosity=2)
