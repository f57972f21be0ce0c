#!/usr/bin/env python3
"""The real window while memory is short, while no thread starts, and when a signal ends it: what failed is said, the
document is what it was before, and it can be saved.

    window_failures_test.py --program PATH --failing-calls PATH --images DIR --scratch DIR
"""
import json
import os
import pathlib
import signal
import sys
import time
import unittest
import zipfile
import zlib

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "gui"), str(HERE)]
import files
import harness
from desk import PATIENCE, Desk

options = None
MIDDLE = 510, 430  # of the window at its first size: on the gingerbread man's belly
MESSAGES = 616, 560, 956, 760  # where messages appear
ERROR = bytes((0x5c, 0x9d, 0xff))  # the colour of an error's sign as the X server has it: blue, green, red


def project_of(path):
    with zipfile.ZipFile(path) as archive:
        return json.loads(archive.read("project.json")), archive.namelist()


class WindowFailures(unittest.TestCase):
    def desk(self, *arguments):
        self.home = pathlib.Path(options.scratch) / self.id().split(".")[-1]
        self.control = self.home / "control"
        desk = Desk("env", self.home, [f"LD_PRELOAD={os.path.abspath(options.failing_calls)}", f"FAILING_CALLS={self.control}",
                                       os.path.abspath(options.program), *map(str, arguments)])
        self.addCleanup(desk.close)
        self.control.mkdir()
        return desk

    def open_sample(self):
        """With one probe on it."""
        desk = self.desk(f"{options.images}/gingerbread.png")
        desk.wait_title("gingerbread.png – Probewarp")
        desk.settle()
        desk.double_click(*MIDDLE)
        desk.wait_title("● gingerbread.png – Probewarp")
        return desk

    def limit(self, name, value):
        (self.control / name).write_text(str(value))

    def unlimited(self):
        for file in self.control.iterdir():
            file.unlink()

    def shows_error(self, desk):
        return any(ERROR in row for row in desk.seen(*MESSAGES))

    def save(self, desk, name):
        path = self.home / name
        desk.key("ctrl+shift+s")
        desk.type_path(path)
        desk.wait_title(f"{name} – Probewarp")
        return project_of(path)

    def test_a_stroke_without_memory(self):
        desk = self.open_sample()
        desk.key("b")
        self.limit("new", 1 << 16)
        x, y = MIDDLE
        desk.drag([(x, y), (x + 30, y + 10), (x + 60, y + 30)])
        desk.wait(lambda: self.shows_error(desk), "a message")
        self.unlimited()
        project, members = self.save(desk, "x.probewarp")
        self.assertEqual(len(project["probes"]), 1)
        self.assertFalse([name for name in members if "paint" in name], "nothing was painted")
        # And a stroke works again.
        desk.drag([(x, y), (x + 30, y + 10), (x + 60, y + 30)])
        desk.wait_title("● x.probewarp – Probewarp")

    def test_a_drag_without_any_memory(self):
        desk = self.open_sample()
        before, _ = self.save(desk, "before.probewarp")
        x, y = MIDDLE
        desk.drag([(x, y), (x + 20, y)], release=False)
        self.limit("new", 32)
        desk.drag([(x + 40, y + 40), (x + 60, y + 60)])
        desk.key("Delete", "ctrl+d")
        self.unlimited()
        desk.wait(lambda: self.shows_error(desk), "a message")
        desk.wait_title("before.probewarp – Probewarp")  # the document is the saved one again
        after, _ = self.save(desk, "after.probewarp")
        self.assertEqual(after, before)

    def test_the_menus_stay_where_the_picture_cannot_be_drawn(self):
        desk = self.open_sample()
        self.limit("new", 32)
        desk.ask("mousemove", 400, 300, "sleep", "0.2", "mousemove", 420, 300)
        picture = 500, 560, 540, 600
        desk.wait(lambda: len(set(b"".join(desk.seen(*picture)))) <= 4, "a frame without the picture: of one colour")
        self.unlimited()
        project, _ = self.save(desk, "x.probewarp")
        self.assertEqual(len(project["probes"]), 1)

    def test_no_thread_starts(self):
        desk = self.open_sample()
        self.limit("threads", 0)
        x, y = MIDDLE
        desk.drag([(x, y), (x + 40, y - 20)])
        desk.double_click(x, y - 150)
        project, _ = self.save(desk, "x.probewarp")
        self.assertEqual(len(project["probes"]), 2)
        desk.key("ctrl+e")
        desk.type_path(self.home / "x.png")
        desk.wait((self.home / "x.png").exists, "the export")
        desk.key("ctrl+o")
        desk.type_path(pathlib.Path(options.images).resolve() / "octopus.png")
        desk.wait_title("octopus.png – Probewarp")

    def test_a_signal_while_it_saves(self):
        side = 1500
        picture = pathlib.Path(options.scratch) / "noise.png"
        rows = b"".join(b"\0" + os.urandom(side * 3) for _ in range(side))
        picture.write_bytes(files.png_header(side, side, 8, 2) + files.png_chunk(b"IDAT", zlib.compress(rows, 0))
                            + files.png_chunk(b"IEND", b""))
        for number in signal.SIGTERM, signal.SIGHUP:
            with self.subTest(signal=number):
                desk = self.desk(picture)
                desk.wait_title("noise.png – Probewarp")
                folder = self.home / "saved"
                folder.mkdir()
                desk.key("ctrl+e")
                desk.key("ctrl+a")
                desk.ask("type", "--delay", "15", str(folder / "x.png"))
                desk.settle()
                desk.ask("key", "Return")
                end = time.monotonic() + PATIENCE
                while not list(folder.iterdir()) and time.monotonic() < end:
                    pass
                desk.program.send_signal(number)
                self.assertEqual(desk.program.wait(), -number)
                self.assertEqual([path.name for path in folder.iterdir() if path.name.startswith(".")], [])
                desk.close()


if __name__ == "__main__":
    options = harness.options("--failing-calls", "--images", "--scratch")
    unittest.main()
