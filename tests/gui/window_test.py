#!/usr/bin/env python3
"""Drives the real window under Xvfb with real mouse and key events, as a person would, and looks at what it leaves.

    window_test.py --program PATH --images DIR --scratch DIR
"""
import argparse
import faulthandler
import json
import math
import pathlib
import subprocess
import sys
import time
import unittest
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from desk import PATIENCE, Desk, Drawings
from png_file import read_png, write_png

options = None


def project_of(path):
    with zipfile.ZipFile(path) as archive:
        return json.loads(archive.read("project.json"))


def covered_columns(path, member):
    """Of the paint in a project: how many columns of texels have any coverage."""
    with zipfile.ZipFile(path) as archive:
        width, height, _, _, samples = read_png(archive.read(member))
    return sum(any(samples[2 * (y * width + x) + 1] for y in range(height)) for x in range(width))


def distance(point, a, b):
    """From a point to the segment from a to b."""
    way = b[0] - a[0], b[1] - a[1]
    along = ((point[0] - a[0]) * way[0] + (point[1] - a[1]) * way[1]) / (way[0] ** 2 + way[1] ** 2)
    along = min(max(along, 0), 1)
    return math.dist(point, (a[0] + along * way[0], a[1] + along * way[1]))


class WindowTest(unittest.TestCase):
    def desk(self, *arguments, scale=1):
        home = pathlib.Path(options.scratch) / self.id().split(".")[-1]
        desk = Desk(options.program, home, arguments, scale)
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
        (desk.home / "same").mkdir()
        self.assertEqual(mesh.read_bytes(), self.render(project, desk.home / "same" / "three.obj"))
        for companion in "three.mtl", "three-texture.png":
            self.assertEqual((desk.home / companion).read_bytes(), (desk.home / "same" / companion).read_bytes())
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
        desk.key("Escape")  # what is there of it is offered
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

    def test_nothing_is_drawn_where_nothing_changes(self):
        desk = self.open_sample()
        desk.double_click(*desk.at(512, 694))
        desk.ask("mousemove", 1100, 740)  # an empty part of the panel
        time.sleep(1)
        drawings = Drawings(desk)
        drawings.count()  # the first is of what was there

        def switches():
            """How often any of the program's threads went to sleep: one that is never woken draws nothing."""
            return sum(int(line.split()[1]) for status in pathlib.Path(f"/proc/{desk.program.pid}/task").glob("*/status")
                       for line in status.read_text().splitlines() if line.startswith("voluntary_ctxt_switches"))

        before = switches()
        time.sleep(2)
        self.assertEqual(switches(), before)
        self.assertEqual(drawings.count(), 0)
        # Events that change nothing.
        desk.key("F9")
        desk.ask("mousemove", 1110, 745)
        desk.settle()
        self.assertGreater(switches(), before)
        self.assertEqual(drawings.count(), 0)
        # Over the canvas the status bar tells where the pointer is.
        desk.ask("mousemove", *desk.at(512, 300))
        desk.settle()
        self.assertGreater(drawings.count(), 0)

    def test_the_vertex_shader_drags_as_the_processor_does(self):
        x, y = 240, 100
        drags, projects = [], []
        for deform in ("processor", "shader"):
            desk = self.open_ramp("60,100", f"{x},{y}:{x + 6},{y + 4}", "150,30", more=["--deform", deform])
            everything = *desk.at(-60, -60), *desk.at(360, 260)
            path = [desk.at(x + 6 + k * 5, y + 4 - k * 4) for k in range(9)]
            desk.drag(path[:1], release=False)  # chosen, and the pointer is there
            desk.ask("mouseup", "1")
            desk.settle()
            seen = []
            for key in "", "w", "w":  # the second time with the weights over the picture
                if key:
                    desk.key(key)
                still = desk.seen(*everything)
                desk.drag(path, release=False)
                seen += desk.seen(*everything)
                desk.key("Escape")
                desk.ask("mouseup", "1", "mousemove", *path[0])
                desk.settle()
                self.assertEqual(desk.seen(*everything), still)
                self.assertNotEqual(seen[-len(still):], still)
            drags.append(seen)
            desk.drag(path)
            projects.append(self.save(desk, "dragged.probewarp"))
            exported = self.export(desk, "dragged.png")
            self.assertEqual(exported.read_bytes(), self.render(projects[-1], desk.home / "same.png"))
            desk.close()
        self.assertEqual(*(project_of(project)["probes"] for project in projects))
        # Shades of 8 bits rise by one a pixel or less, and both are within a hundredth of a pixel; an edge may take
        # in a pixel more.
        far = sum(abs(a - b) > 1 for rows in zip(*drags) for a, b in zip(*rows))
        self.assertLess(far, 3 * 50)

    # A picture that says of each pixel where it was: red is x and green y, in 65535ths of the side.
    RAMP = 300, 200
    BRUSH = 300 / 16  # image pixels: the radius that the brush has on it at first
    PATH = (150, 80), (150, 120)
    WAY = 20, 12  # how far the second probe is moved

    def open_ramp(self, *probes, more=()):
        """A project with the ramp, shown at its own size."""
        scratch = pathlib.Path(options.scratch)
        scratch.mkdir(parents=True, exist_ok=True)
        width, height = self.RAMP
        samples = [s for y in range(height) for x in range(width)
                   for s in (65535 * x // (width - 1), 65535 * y // (height - 1), 0)]
        picture = write_png(scratch / "ramp.png", width, height, samples, 16, 2)
        words = [word for probe in probes for word in ("--probe", probe)]
        subprocess.run([options.program, "render", picture, *words, "-o", scratch / "ramp.probewarp"], check=True)
        desk = self.desk(scratch / "ramp.probewarp", *more)
        desk.wait_title("ramp.probewarp – Probewarp")
        desk.settle()
        desk.corner = 48 + round((1280 - 48 - 308 - width) / 2), 32 + round((800 - 32 - 26 - height) / 2)
        desk.at = lambda x, y: (desk.corner[0] + x, desk.corner[1] + y)
        return desk

    def take_brush(self, desk, probe):
        """Takes the brush and chooses the probe that is at this place now."""
        desk.key("b")
        desk.ask("keydown", "alt", "mousemove", *desk.at(*probe), "sleep", "0.1", "click", "1", "sleep", "0.1",
                 "keyup", "alt")
        desk.settle()

    def pixels(self, path):
        """Of an exported ramp: each pixel's red, green, blue and perhaps alpha, row-major."""
        width, height, bits, colour, samples = read_png(path)
        self.assertEqual((width, height, bits), (*self.RAMP, 16))
        step = {2: 3, 6: 4}[colour]
        return [samples[i:i + step] for i in range(0, len(samples), step)]

    def place(self, pixel):
        """Where in the picture it was."""
        return tuple(sample / 65535 * (side - 1) + 0.5 for sample, side in zip(pixel, self.RAMP))

    def test_painting_changes_what_is_under_the_brush_and_nothing_else(self):
        width, height = self.RAMP
        desk = self.open_ramp("60,100", f"240,100:{240 + self.WAY[0]},{100 + self.WAY[1]}")
        before = self.export(desk, "before.png")
        self.take_brush(desk, (60, 100))
        desk.drag([desk.at(150, y) for y in range(80, 121, 5)])
        desk.wait_title("● ramp.probewarp – Probewarp")
        painted = self.export(desk, "painted.png")
        desk.key("ctrl+z")
        desk.wait_title("ramp.probewarp – Probewarp")
        self.assertEqual(self.export(desk, "undone.png").read_bytes(), before.read_bytes())
        desk.key("ctrl+shift+z")
        project = self.save(desk, "painted.probewarp")
        self.assertEqual(self.render(project, desk.home / "same.png"), painted.read_bytes())
        probes = project_of(project)["probes"]
        self.assertEqual([probe["paint"] is None for probe in probes], [False, True])

        # Translations blend to the mean by shares, so what is under the brush moves back by at most all the way.
        old, new = self.pixels(before), self.pixels(painted)
        swept = [[tuple(p[k] - part / 10 * self.WAY[k] for k in (0, 1)) for p in self.PATH] for part in range(11)]
        cell = 3  # image pixels; two of them, as the picture is stretched, and a vertex moves the cells around it
        changed = 0
        for i, (was, now) in enumerate(zip(old, new)):
            if was == now:
                continue
            changed += 1
            pixel = i % width + 0.5, i // width + 0.5
            self.assertLess(min(distance(pixel, *path) for path in swept), self.BRUSH + 2 * cell, pixel)
        self.assertGreater(changed, 2 * self.BRUSH * 40)
        # What was painted whole stays with the probe that does not move: it is where it was in the picture.
        for y in range(85, 116, 5):
            x, y = (int(k) for k in self.place(old[y * width + 150]))
            pixel = x + 0.5, y + 0.5
            self.assertGreater(math.dist(self.place(old[y * width + x]), pixel), 8)
            # The dabs lie 2.8 pixels apart and the vertices 3: near a dab's centre, but not on it.
            self.assertLess(math.dist(self.place(new[y * width + x]), pixel), 1.5)

    def test_brackets_change_the_brush_and_escape_takes_a_stroke_back(self):
        desk = self.open_ramp("60,100", "240,100")
        clean = self.save(desk, "clean.probewarp").read_bytes()
        self.take_brush(desk, (60, 100))
        desk.drag([desk.at(150, y) for y in range(80, 121, 5)], release=False)
        desk.key("Escape")
        desk.ask("mouseup", "1")
        desk.settle()
        self.assertEqual(self.save(desk, "escaped.probewarp").read_bytes(), clean)

        def dab(name):
            desk.drag([desk.at(150, 100)] * 2)
            project = self.save(desk, name)
            columns = covered_columns(project, project_of(project)["probes"][0]["paint"]["file"])
            desk.key("ctrl+z")
            return columns

        # A texel is a pixel here. The last of a dab is less than a 65535th.
        self.assertAlmostEqual(dab("first.probewarp"), 2 * self.BRUSH, delta=1.5)
        desk.ask("key", "--delay", "60", *["bracketright"] * 5)
        desk.settle()
        self.assertAlmostEqual(dab("larger.probewarp"), 2 * self.BRUSH * 1.15 ** 5, delta=1.5)
        desk.ask("key", "--delay", "60", *["bracketleft"] * 8)
        desk.settle()
        self.assertAlmostEqual(dab("smaller.probewarp"), 2 * self.BRUSH / 1.15 ** 3, delta=1.5)

    def test_w_shows_the_weights_and_hides_them(self):
        desk = self.open_ramp("60,100", "240,100:250,110")
        desk.ask("mousemove", *desk.at(60, 100), "sleep", "0.1", "click", "1")  # chooses the probe
        desk.ask("mousemove", *desk.at(150, -60))
        desk.settle()
        rectangle = *desk.at(100, 60), *desk.at(200, 140)  # of the picture, between the probes
        plain = desk.seen(*rectangle)
        desk.key("w")
        desk.wait(lambda: desk.seen(*rectangle) != plain, "the weights on the canvas")
        desk.key("w")
        desk.wait(lambda: desk.seen(*rectangle) == plain, "the picture without its weights")

    def test_blends_are_switched_undone_and_compared(self):
        """The blend's list, undo, and another blend beside it, whose divider is dragged; exports are the document's."""
        desk = self.desk(f"{options.images}/octopus.probewarp")
        desk.wait_title("octopus.png – Probewarp")
        desk.settle()
        as_it_was = self.export(desk, "dlb.png").read_bytes()
        # A line, nearly white, which begins above the picture, where there is nothing else.
        divider = lambda x: all(max(row) > 220 for row in desk.seen(x - 1, 34, x + 1, 42))
        middle = 48 + (1280 - 48 - 308) // 2
        self.assertFalse(divider(middle))
        desk.key("2")
        self.assertTrue(divider(middle))
        desk.drag([(middle, 700), (middle - 60, 700), (middle - 120, 700)])
        self.assertTrue(divider(middle - 120))
        self.assertFalse(divider(middle))
        self.assertEqual(self.export(desk, "compared.png").read_bytes(), as_it_was)
        desk.key("2")
        self.assertFalse(divider(middle - 120))
        # The list's fifth row is the spiral.
        for place in ((1160, 388), (1110, 509)):
            desk.ask("mousemove", *place, "sleep", "0.2", "click", "1")
            desk.settle()
        desk.wait_title("● octopus.png – Probewarp")
        project = self.save(desk, "spiral.probewarp")
        self.assertEqual(project_of(project)["blend"], "spiral")
        spiral = self.export(desk, "spiral.png").read_bytes()
        self.assertEqual(spiral, self.render(project, desk.home / "same.png"))
        self.assertNotEqual(spiral, as_it_was)
        desk.key("ctrl+z")
        self.assertEqual(self.export(desk, "undone.png").read_bytes(), as_it_was)

    def test_compressions_are_the_command_lines(self):
        octopus = f"{options.images}/octopus.probewarp"
        desk = self.desk(octopus)
        desk.wait_title("octopus.png – Probewarp")
        desk.settle()
        desk.key("ctrl+e")
        for place in ((686, 457), (510, 534), (640, 297)):  # the list, its third row, and back to the path
            desk.ask("mousemove", *place, "sleep", "0.2", "click", "1")
            desk.settle()
        path = desk.home / "small.png"
        desk.type_path(path)
        desk.wait(path.exists, "the export small.png")
        self.assertEqual(path.read_bytes(), self.render(octopus, desk.home / "same.png", "--compression", "small"))
        self.assertNotEqual(path.read_bytes(), self.render(octopus, desk.home / "default.png"))

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
    faulthandler.dump_traceback_later(340, exit=True)  # says where it hangs, should it hang
    unittest.main(argv=[sys.argv[0], *rest], verbosity=2)
