#!/usr/bin/env python3
"""Drives the real window under Xvfb with real mouse and key events, as a person would, and looks at what it leaves.

    window_test.py --program PATH --images DIR --scratch DIR
"""
import argparse
import faulthandler
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import time
import unittest
import zipfile

options = None
PATIENCE = 20  # seconds until something that must happen counts as not happening; a loaded machine is slow


class Desk:
    """An X server of its own with the program on it."""

    def __init__(self, name, arguments, scale=1):
        self.home = pathlib.Path(options.scratch) / name
        shutil.rmtree(self.home, ignore_errors=True)
        self.home.mkdir(parents=True)
        self.processes = []
        self.errors = open(self.home / "errors.txt", "w+")
        try:
            self.start(arguments, scale)
        except BaseException:
            self.close()
            raise

    def start(self, arguments, scale):
        read, write = os.pipe()
        # Nothing of it may hold the test's own output open: who waits for that would wait for ever.
        silent = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL}
        self.processes.append(subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "2560x1600x24", "-nolisten", "tcp"],
            pass_fds=[write], stderr=subprocess.DEVNULL, **silent))
        os.close(write)
        with os.fdopen(read) as pipe:
            display = ":" + pipe.readline().strip()
        self.environment = dict(os.environ, DISPLAY=display, HOME=str(self.home), PROBEWARP_UI_SCALE=str(scale))
        self.program = subprocess.Popen([options.program, *arguments], env=self.environment, stderr=self.errors,
                                        **silent)
        self.processes.append(self.program)
        self.scale = scale
        self.window = self.wait(lambda: self.ask("search", "--onlyvisible", "--name", "Probewarp").split())[0]

    def close(self):
        for process in reversed(self.processes):
            process.kill()
            process.wait()
        self.errors.close()

    def ask(self, *words):
        return subprocess.run(["xdotool", *map(str, words)], env=self.environment, capture_output=True, text=True,
                              timeout=PATIENCE).stdout

    def wait(self, condition, what="the window"):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            found = condition()
            if found:
                return found
            if self.program.poll() is not None:
                raise AssertionError(f"the program ended with {self.program.returncode}: "
                                     + (self.home / "errors.txt").read_text())
            time.sleep(0.05)
        self.screenshot("failed")
        raise AssertionError(f"waited {PATIENCE} s in vain for {what}; title: {self.title()!r}; see {self.home}/failed.png")

    def title(self):
        return self.ask("getwindowname", self.window).strip()

    def wait_title(self, text):
        self.wait(lambda: self.title() == text, f"the title {text!r}")

    def settle(self):
        """Lets the program draw what the last events changed."""
        time.sleep(0.35)

    def key(self, *keys):
        for key in keys:
            self.ask("key", key)
            self.settle()

    def type_path(self, path):
        self.key("ctrl+a")
        self.ask("type", "--delay", "15", str(path))
        self.key("Return")

    def double_click(self, x, y):
        self.ask("mousemove", x, y, "sleep", "0.1", "click", "--repeat", "2", "--delay", "60", "1")
        self.settle()

    def drag(self, points, release=True):
        words = ["mousemove", *points[0], "sleep", "0.1", "mousedown", "1"]
        for point in points[1:]:
            words += ["sleep", "0.04", "mousemove", *point]
        if release:
            words += ["sleep", "0.1", "mouseup", "1"]
        self.ask(*words)
        self.settle()

    def screenshot(self, name):
        subprocess.run(["xwd", "-root", "-silent", "-out", str(self.home / f"{name}.xwd")], env=self.environment)


def project_of(path):
    with zipfile.ZipFile(path) as archive:
        return json.loads(archive.read("project.json"))


class WindowTest(unittest.TestCase):
    def desk(self, *arguments, scale=1):
        desk = Desk(self.id().split(".")[-1], arguments, scale)
        self.addCleanup(desk.close)
        return desk

    def open_sample(self, scale=1):
        desk = self.desk(f"{options.images}/gingerbread.png", scale=scale)
        desk.wait_title("gingerbread.png – Probewarp")
        desk.settle()
        # Where the picture lies: fitted into the canvas with a margin of 40 (look.md's sizes).
        width, height = (1280 - 48 - 308) * scale, (800 - 32 - 26) * scale
        desk.zoom = min((width - 80 * scale) / 1024, (height - 80 * scale) / 1210, max(1, scale))
        desk.corner = (48 * scale + round((width - desk.zoom * 1024) / 2), 32 * scale + round((height - desk.zoom * 1210) / 2))
        desk.at = lambda x, y: (round(desk.corner[0] + desk.zoom * x), round(desk.corner[1] + desk.zoom * y))
        return desk

    def save(self, desk, name):
        path = desk.home / name
        desk.key("ctrl+shift+s")
        desk.type_path(path)
        desk.wait_title(f"{name} – Probewarp")
        return path

    def export(self, desk, name):
        path = desk.home / name
        desk.key("ctrl+e")
        desk.type_path(path)
        desk.wait(path.exists, f"the export {name}")
        return path

    def render(self, project, output, *more):
        subprocess.run([options.program, "render", str(project), "-o", str(output), *more], check=True)
        return output.read_bytes()

    def test_main_job(self):
        """Open, add three probes, drag and turn them, undo, redo, save, export: the export is the command line's."""
        desk = self.desk()
        desk.wait_title("Probewarp")
        desk.settle()
        desk.key("ctrl+o")
        desk.type_path(f"{options.images}/gingerbread.png")
        desk.wait_title("gingerbread.png – Probewarp")
        desk.close()

        desk = self.open_sample()
        places = [(512, 300), (820, 468), (334, 1004)]
        for place in places:
            desk.double_click(*desk.at(*place))
        desk.wait_title("● gingerbread.png – Probewarp")
        # The second probe is dragged by 60, -80 window pixels, then turned by its knob through a right angle.
        x, y = desk.at(*places[1])
        desk.drag([(x, y), (x + 20, y - 30), (x + 40, y - 60), (x + 60, y - 80)])
        x, y = x + 60, y - 80
        knob = [(x + round(34 * math.sin(a)), y - round(34 * math.cos(a))) for a in (0, 0.4, 0.8, 1.2, math.pi / 2)]
        desk.drag(knob)
        # The third is dragged and taken back, taken up again, taken back.
        x, y = desk.at(*places[2])
        desk.drag([(x, y), (x - 30, y - 10), (x - 60, y - 20)])
        desk.key("ctrl+z", "ctrl+shift+z", "ctrl+z", "ctrl+y")
        project = self.save(desk, "three.probewarp")
        probes = project_of(project)["probes"]
        self.assertEqual(len(probes), 3)
        for probe, place in zip(probes, places):
            for k in (0, 1):
                self.assertLess(abs(probe["rest"][k] - place[k]), 1 / desk.zoom)
        way = [(b - a) * desk.zoom for a, b in zip(probes[1]["rest"], probes[1]["now"])]
        self.assertAlmostEqual(way[0], 60, places=6)
        self.assertAlmostEqual(way[1], -80, places=6)
        self.assertAlmostEqual(probes[1]["angle_radians"], math.pi / 2, delta=0.03)  # of whole pixels at the knob
        self.assertAlmostEqual((probes[2]["now"][0] - probes[2]["rest"][0]) * desk.zoom, -60, places=6)
        self.assertEqual(probes[0]["now"], probes[0]["rest"])

        exported = self.export(desk, "three.png")
        self.assertEqual(exported.read_bytes(), self.render(project, desk.home / "same.png"))
        mesh = self.export(desk, "three.obj")
        self.assertEqual(mesh.read_bytes(), self.render(project, desk.home / "same.obj"))
        desk.key("ctrl+z")
        desk.wait_title("● three.probewarp – Probewarp")
        again = self.export(desk, "fewer.png")
        self.assertNotEqual(again.read_bytes(), exported.read_bytes())
        desk.screenshot("end")

    def test_turning_counts_whole_turns_and_shift_snaps(self):
        desk = self.open_sample()
        x, y = desk.at(512, 694)
        desk.double_click(x, y)
        steps = [k * 2 * math.pi / 12 for k in range(0, 31)]  # two turns and a half
        desk.drag([(x + round(60 * math.sin(a)) if k else x, y - (round(60 * math.cos(a)) if k else 34))
                   for k, a in enumerate(steps)], release=False)
        desk.ask("keydown", "shift", "mousemove_relative", "--", "0", "3", "sleep", "0.2", "mouseup", "1", "keyup", "shift")
        desk.settle()
        angle = project_of(self.save(desk, "turned.probewarp"))["probes"][0]["angle_radians"]
        self.assertAlmostEqual(angle, 5 * math.pi, places=9)

    def test_escape_takes_a_drag_back_and_delete_removes(self):
        desk = self.open_sample()
        x, y = desk.at(512, 694)
        desk.double_click(x, y)
        first = self.save(desk, "a.probewarp").read_bytes()
        desk.drag([(x, y), (x + 20, y + 5), (x + 50, y + 40)], release=False)
        desk.key("Escape")
        desk.ask("mouseup", "1")
        desk.settle()
        self.assertEqual(self.save(desk, "b.probewarp").read_bytes(), first)
        desk.key("Delete")
        desk.wait_title("● b.probewarp – Probewarp")
        self.assertEqual(project_of(self.save(desk, "c.probewarp"))["probes"], [])

    def test_numbers_can_be_typed(self):
        desk = self.open_sample()
        desk.double_click(*desk.at(512, 694))
        # The panel's fields at scale 1: Now x is the first below the list's one row.
        desk.double_click(1080, 171)
        desk.key("ctrl+a")
        desk.ask("type", "600.5")
        desk.key("Return")
        project = project_of(self.save(desk, "typed.probewarp"))
        self.assertEqual(project["probes"][0]["now"][0], 600.5)
        desk.key("ctrl+z")
        project = project_of(self.save(desk, "back.probewarp"))
        self.assertNotEqual(project["probes"][0]["now"][0], 600.5)

    def test_a_bad_file_leaves_the_document(self):
        desk = self.open_sample()
        desk.double_click(*desk.at(512, 694))
        project = self.save(desk, "good.probewarp")
        bad = desk.home / "bad.png"
        bad.write_bytes((pathlib.Path(options.images) / "gingerbread.png").read_bytes()[:5000])
        desk.key("ctrl+o")
        desk.type_path(bad)
        desk.settle()
        desk.screenshot("message")
        desk.wait_title("good.probewarp – Probewarp")
        self.assertEqual(self.save(desk, "after.probewarp").read_bytes(), project.read_bytes())

    def test_a_second_picture_has_a_mesh_of_its_own(self):
        desk = self.open_sample()
        desk.double_click(*desk.at(512, 694))
        self.save(desk, "first.probewarp")
        desk.key("ctrl+o")
        desk.type_path(f"{options.images}/lighthouse.png")
        desk.wait_title("lighthouse.png – Probewarp")
        desk.settle()
        desk.double_click(500, 400)
        desk.drag([(500, 400), (520, 410), (560, 430)])
        project = self.save(desk, "second.probewarp")
        exported = self.export(desk, "second.png")
        self.assertEqual(exported.read_bytes(), self.render(project, desk.home / "same.png"))

    def test_a_number_being_typed_is_part_of_the_work(self):
        """A click elsewhere, or a command for files, takes the number as it stands; nothing swallows the next click."""
        desk = self.open_sample()
        desk.double_click(*desk.at(512, 694))
        desk.double_click(1080, 171)
        desk.key("ctrl+a")
        desk.ask("type", "600.5")
        desk.settle()
        self.assertEqual(project_of(self.save(desk, "typed.probewarp"))["probes"][0]["now"][0], 600.5)
        desk.double_click(1080, 171)
        desk.key("ctrl+a")
        desk.ask("type", "512")
        desk.settle()
        x, y = desk.at(512, project_of(desk.home / "typed.probewarp")["probes"][0]["now"][1])
        desk.drag([(x, y), (x + 20, y - 30), (x + 40, y - 60)])
        now = project_of(self.save(desk, "dragged.probewarp"))["probes"][0]["now"]
        self.assertAlmostEqual(now[0], 512 + 40 / desk.zoom, places=6)

    def test_a_dropped_file_opens(self):
        desk = self.desk()
        desk.wait_title("Probewarp")
        desk.settle()
        drop = pathlib.Path(__file__).with_name("drop_file.py")
        subprocess.run([sys.executable, str(drop), desk.window, f"{options.images}/lighthouse.png", "500", "400"],
                       env=desk.environment, check=True, timeout=PATIENCE)
        desk.wait_title("lighthouse.png – Probewarp")

    def test_unsaved_work_is_asked_about(self):
        desk = self.open_sample()
        desk.double_click(*desk.at(512, 694))
        desk.key("ctrl+q")
        desk.screenshot("question")
        desk.key("Escape")
        self.assertIsNone(desk.program.poll())
        self.save(desk, "kept.probewarp")
        desk.key("ctrl+q")
        end = time.monotonic() + PATIENCE
        while desk.program.poll() is None and time.monotonic() < end:
            time.sleep(0.05)
        self.assertEqual(desk.program.poll(), 0)

    def test_idle_uses_no_processor_time(self):
        desk = self.open_sample()
        time.sleep(1)

        def ticks():
            fields = pathlib.Path(f"/proc/{desk.program.pid}/stat").read_text().rsplit(")", 1)[1].split()
            return int(fields[11]) + int(fields[12])

        before = ticks()
        time.sleep(3)
        self.assertLessEqual(ticks() - before, 1)  # a tick is 10 ms; one may fall in by the clock's grain

    def test_scale_two(self):
        desk = self.open_sample(scale=2)
        desk.double_click(*desk.at(512, 694))
        desk.screenshot("window")
        rest = project_of(self.save(desk, "large.probewarp"))["probes"][0]["rest"]
        self.assertLess(math.dist(rest, (512, 694)), 1.5)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    for name in ("program", "images", "scratch"):
        parser.add_argument(f"--{name}", required=True)
    options, rest = parser.parse_known_args()
    faulthandler.dump_traceback_later(280, exit=True)  # says where it hangs, should it hang
    unittest.main(argv=[sys.argv[0], *rest], verbosity=2)
