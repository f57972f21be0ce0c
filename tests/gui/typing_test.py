#!/usr/bin/env python3
"""What is typed into the real window: numbers in fields, shortcuts on several keyboards, clicks and double-clicks.

    typing_test.py --program PATH --scratch DIR
"""
import argparse
import faulthandler
import json
import pathlib
import subprocess
import sys
import unittest
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from desk import Desk
from png_file import read_png, write_png

options = None

# The panel's fields at scale 1, below a list of one probe.
NOW_X, NOW_Y, REST_X, TURN, REACH = (1080, 171), (1190, 171), (1080, 203), (1100, 235), (1100, 267)
CELLS = (1240, 425)
LAYOUTS = "us", "de", "fr", "us(dvorak)", "ru", "gr"


class TypingTest(unittest.TestCase):
    SIZE = 400, 300

    def open(self, probe="160,140"):
        """A grey picture of its own size in the middle of the canvas, and one probe on it, which is chosen."""
        home = pathlib.Path(options.scratch).absolute() / self.id().split(".")[-1]
        files = home.parent / (home.name + "-files")
        files.mkdir(parents=True, exist_ok=True)
        width, height = self.SIZE
        picture = write_png(files / "grey.png", width, height, [128] * (width * height * 3), 8, 2)
        self.project = files / "a.probewarp"
        subprocess.run([options.program, "render", picture, "--probe", probe, "-o", self.project], check=True)
        desk = Desk(options.program, home, [str(self.project)])
        self.addCleanup(desk.close)
        desk.wait_title("a.probewarp – Probewarp")
        desk.settle()
        corner = 48 + round((1280 - 48 - 308 - width) / 2), 32 + round((800 - 32 - 26 - height) / 2)
        desk.at = lambda x, y: (corner[0] + x, corner[1] + y)
        self.click(desk, desk.at(*(float(k) for k in probe.split(":")[0].split(","))))
        desk.settle()
        return desk

    def click(self, desk, place):
        desk.ask("mousemove", *place, "sleep", "0.05", "click", "1")

    def write(self, desk, text):
        desk.ask("type", "--delay", "0", "--", text)

    def layout(self, desk, name):
        """Chooses a keyboard's layout, and lets the program hear of it."""
        subprocess.run(["setxkbmap", *name.replace("(", " ").replace(")", "").split()], env=desk.environment, check=True)
        desk.settle()

    def project_file(self):
        with zipfile.ZipFile(self.project) as archive:
            return json.loads(archive.read("project.json"))

    def saved(self, desk):
        """The project as it is saved now; the number that is typed is taken as it stands."""
        desk.key("ctrl+s")
        desk.wait_title("a.probewarp – Probewarp")
        return self.project_file()

    def probe(self, desk):
        return self.saved(desk)["probes"][0]

    def copy(self, desk, *text):
        """Puts a text into the clipboard; without one its owner never answers."""
        owner = subprocess.Popen([sys.executable, str(pathlib.Path(__file__).with_name("clipboard.py")), *text],
                                 env=desk.environment, stdout=subprocess.PIPE, text=True)
        self.addCleanup(owner.wait)
        self.addCleanup(owner.kill)
        self.addCleanup(owner.stdout.close)
        self.assertEqual(owner.stdout.readline(), "ready\n")

    def canvas(self, desk):
        return desk.seen(60, 40, 960, 700)

    # Numbers

    def test_one_click_types_over_the_number(self):
        desk = self.open()
        for text, value in (("300", 300), ("600.5", 600.5), ("600,5", 600.5), ("1.234,5", 1234.5), ("100+20", 120),
                            ("1024/4", 256), ("(1+2)*3", 9), ("-7", -7), ("12 px", 12)):
            self.click(desk, NOW_X)
            self.write(desk, text)
            desk.key("Return")
            self.assertEqual(self.probe(desk)["now"], [value, 140], text)

    def test_everything_at_once_keeps_its_order(self):
        """Click, text, Tab, text, Return, and then shortcuts, without waiting for the window."""
        desk = self.open()
        # GLFW drops the second of two presses of one key within a millisecond.
        desk.ask("mousemove", *NOW_X, "click", "1", "type", "--delay", "3", "700")
        desk.ask("key", "--delay", "3", "Tab", "3", "0", "0", "Tab", "1", "0", "Tab", "2", "5", "shift+Tab", "1", "1",
                 "Return", "m", "ctrl+s")
        desk.wait(lambda: self.project_file()["probes"][0]["rest"] == [11, 25], "the numbers in the file")
        self.assertEqual(self.project_file()["probes"][0]["now"], [700, 300])

    def test_tab_goes_round_and_back(self):
        desk = self.open()
        self.click(desk, NOW_X)
        for text in "161", "142", "163", "144", "45", "66":
            self.write(desk, text)
            desk.key("Tab")
        self.write(desk, "50")  # the mesh
        desk.key("Tab")
        self.write(desk, "171")  # round again
        desk.key("shift+Tab")
        self.write(desk, "60")
        desk.key("KP_Enter")
        project = self.saved(desk)
        probe = project["probes"][0]
        self.assertEqual((probe["now"], probe["rest"], probe["radius"]), ([171, 142], [163, 144], 66))
        self.assertAlmostEqual(probe["angle_radians"], 0.25 * 3.141592653589793, places=12)
        self.assertEqual(project["mesh"]["cells"], 60)

    def test_escape_takes_back_and_return_without_a_change_changes_nothing(self):
        desk = self.open("160.123456,140:160.123456,140,33.3")
        before = self.project.read_bytes()
        for field in NOW_X, TURN, REACH, CELLS:
            self.click(desk, field)
            self.write(desk, "77")
            desk.key("Escape")
            self.click(desk, field)
            desk.key("Return")
        self.assertEqual(desk.title(), "a.probewarp – Probewarp")
        self.saved(desk)
        self.assertEqual(self.project.read_bytes(), before)

    def test_typing_is_one_step(self):
        desk = self.open()
        self.click(desk, NOW_X)
        self.write(desk, "123")
        desk.key("Tab")
        self.write(desk, "45")
        desk.key("Return")
        self.assertEqual(self.probe(desk)["now"], [123, 45])
        desk.key("ctrl+z")
        self.assertEqual(self.probe(desk)["now"], [123, 140])
        desk.key("ctrl+z")
        self.assertEqual(self.probe(desk)["now"], [160, 140])

    def test_what_is_no_number_is_refused(self):
        desk = self.open()
        frame = NOW_X[0] - 30, NOW_X[1] - 14, NOW_X[0] + 50, NOW_X[1] - 10  # its upper edge
        orange = bytes([0x5c, 0x9d, 0xff])
        refused = lambda: any(orange in row for row in desk.seen(*frame))
        for text in "12a", "1/0", "1e999", "nan", "1.2.3", "5 cm":
            self.click(desk, NOW_X)
            self.write(desk, text)
            desk.wait(refused, f"the frame that refuses {text!r}")
            desk.key("Return", "Tab")
            self.assertTrue(refused(), text)  # it is still typed in
            self.assertEqual(desk.title(), "a.probewarp – Probewarp", text)
            desk.key("ctrl+a")
            self.write(desk, "160")
            desk.wait(lambda: not refused(), "the frame of a number")
            desk.key("Return")
        self.click(desk, NOW_X)
        self.write(desk, "12a")
        desk.wait(refused, "the frame that refuses")
        self.click(desk, NOW_Y)  # leaves it
        self.write(desk, "150")
        desk.key("Return")
        self.assertFalse(refused())
        self.assertEqual(self.probe(desk)["now"], [160, 150])
        self.click(desk, NOW_X)
        self.write(desk, "12a")
        self.assertEqual(self.probe(desk)["now"], [160, 150])

    def test_pairs_are_pasted_into_x(self):
        desk = self.open()
        for text in "210.5\t77.25", "210.5, 77.25", "210,5; 77,25\n", "210.5\n77.25", "(210.5 77.25)":
            self.copy(desk, text)
            self.click(desk, NOW_X)
            desk.key("ctrl+v", "Return")
            self.assertEqual(self.probe(desk)["now"], [210.5, 77.25], text)
            desk.key("ctrl+z")
            self.assertEqual(self.probe(desk)["now"], [160, 140], text)
        self.copy(desk, "\u221212\u00a0px")
        self.click(desk, NOW_X)
        desk.key("ctrl+v", "Return")
        self.assertEqual(self.probe(desk)["now"], [-12, 140])

    def test_a_clipboard_that_never_answers_keeps_nobody(self):
        desk = self.open()
        self.copy(desk)
        self.click(desk, NOW_X)
        desk.key("ctrl+v", "7", "Return")
        self.assertEqual(self.probe(desk)["now"], [7, 140])

    def test_what_is_copied_here_is_pasted_here(self):
        desk = self.open()
        self.click(desk, NOW_X)
        desk.key("ctrl+c", "Tab", "ctrl+v", "Return")
        self.assertEqual(self.probe(desk)["now"], [160, 160])

    def test_nothing_typed_is_a_shortcut(self):
        desk = self.open()
        self.click(desk, NOW_X)
        desk.key("Tab")  # the number stays, so the canvas does
        desk.ask("mousemove", 1100, 740)
        desk.settle()
        plain = self.canvas(desk)
        for keys in ("2", "5", "w", "m", "h", "b", "minus", "equal", "bracketleft", "Delete", "Left", "space"):
            desk.key("ctrl+a", keys)
        desk.key("Escape")
        self.assertEqual(self.canvas(desk), plain)
        self.assertEqual(self.probe(desk)["now"], [160, 140])

    def test_a_drag_changes_and_a_click_does_not(self):
        desk = self.open()
        x, y = NOW_X
        desk.drag([(x, y), (x + 10, y), (x + 30, y)])
        dragged = self.probe(desk)["now"][0]
        self.assertGreater(dragged, 165)
        desk.drag([(x, y), (x + 10, y), (x + 30, y)], release=False)
        desk.key("Escape")
        desk.ask("mouseup", "1")
        desk.settle()
        self.assertEqual(self.probe(desk)["now"], [dragged, 140])
        desk.key("ctrl+z")
        self.assertEqual(self.probe(desk)["now"], [160, 140])

    def test_tab_goes_through_a_dialog(self):
        desk = self.open()
        path = self.project.parent / "half.png"
        path.unlink(missing_ok=True)
        desk.key("ctrl+e", "ctrl+a")
        self.write(desk, path)
        desk.key("Tab")
        self.write(desk, "100/2 %")
        desk.key("Tab")  # from the last field to the first, whose text is chosen
        self.write(desk, path)
        desk.key("Return")
        desk.wait(path.exists, "the export")
        self.assertEqual(read_png(path)[:2], (200, 150))

    # Keyboards

    def test_letters_and_signs_follow_the_layout(self):
        desk = self.open()
        desk.ask("mousemove", 1100, 740)
        desk.settle()
        plain = self.canvas(desk)
        # On a Russian and a Greek keyboard the letter's key writes another one.
        letters = {"ru": "Cyrillic_softsign", "gr": "Greek_mu"}
        for layout in LAYOUTS:
            self.layout(desk, layout)
            for on, off in ((letters.get(layout, "m"), letters.get(layout, "m")), ("2", "2"), ("equal", "minus"),
                            ("plus", "minus")):
                desk.key(on)
                desk.wait(lambda: self.canvas(desk) != plain, f"what {on} does on {layout}")
                desk.key(off)
                if off == "minus":
                    desk.key("1")  # one to one
                desk.wait(lambda: self.canvas(desk) == plain, f"what {off} does on {layout}")

    def test_ctrl_follows_the_layout(self):
        desk = self.open()
        letters = {"ru": dict(z="Cyrillic_ya", a="Cyrillic_ef", c="Cyrillic_es", v="Cyrillic_em", x="Cyrillic_che"),
                   "gr": dict(z="Greek_zeta", a="Greek_alpha", c="Greek_psi", v="Greek_omega", x="Greek_chi")}
        for layout in LAYOUTS:
            self.layout(desk, layout)
            key = lambda letter: "ctrl+" + letters.get(layout, {}).get(letter, letter)
            self.click(desk, NOW_X)
            self.write(desk, "123")
            desk.key(key("a"), key("c"), "Tab", key("v"), "Tab", key("v"), key("a"), key("x"), key("v"), "Return")
            desk.wait_title("● a.probewarp – Probewarp")
            # Three fields, three steps.
            desk.key(key("z"), key("z"), key("z"))
            desk.wait_title("a.probewarp – Probewarp")
            desk.key("ctrl+y" if layout not in letters else key("z").replace("ctrl", "ctrl+shift"))
            desk.wait_title("● a.probewarp – Probewarp")
            desk.key(key("z"))
            desk.wait_title("a.probewarp – Probewarp")

    def test_brackets_follow_the_layout(self):
        desk = self.open()
        desk.key("b")

        def dab():
            desk.drag([desk.at(200, 150)] * 2)
            desk.wait_title("● a.probewarp – Probewarp")
            with_paint = self.saved(desk)["probes"][0]["paint"]["file"]
            with zipfile.ZipFile(self.project) as archive:
                width, height, _, _, samples = read_png(archive.read(with_paint))
            desk.key("ctrl+z")
            desk.wait_title("● a.probewarp – Probewarp")
            self.saved(desk)
            return sum(any(samples[2 * (y * width + x) + 1] for y in range(height)) for x in range(width))

        size = dab()
        for layout in "us", "de", "fr", "us(dvorak)", "ru":
            self.layout(desk, layout)
            smaller, larger = ("Cyrillic_ha", "Cyrillic_hardsign") if layout == "ru" else ("bracketleft", "bracketright")
            desk.key(*[smaller] * 4)
            self.layout(desk, "us")
            less = dab()
            self.assertLess(less, 0.7 * size, layout)
            self.layout(desk, layout)
            desk.key(*[larger] * 4)
            self.layout(desk, "us")
            self.assertEqual(dab(), size, layout)

    def test_the_keypad_types(self):
        desk = self.open()
        self.click(desk, NOW_X)
        desk.key("KP_1", "KP_2", "KP_Decimal", "KP_5", "KP_Add", "KP_1", "KP_Enter")
        self.assertEqual(self.probe(desk)["now"][0], 13.5)

    def test_a_held_arrow_is_one_step(self):
        desk = self.open()
        whole = self.canvas(desk)
        desk.ask("keydown", "Right")
        seen = [whole]

        def repeated():
            now = self.canvas(desk)
            if now not in seen:
                seen.append(now)
            return len(seen) > 4

        desk.wait(repeated, "the key to repeat")
        desk.ask("keyup", "Right")
        desk.settle()
        self.assertGreater(self.probe(desk)["now"][0], 163)
        desk.key("ctrl+z")
        self.assertEqual(self.probe(desk)["now"], [160, 140])

    # Clicks

    def test_two_slow_clicks_are_a_double_click(self):
        desk = self.open()
        count = lambda: len(self.saved(desk)["probes"])
        for attempt in range(5):  # a loaded machine may stretch the pause beyond half a second
            desk.ask("mousemove", *desk.at(300 - 30 * attempt, 250), "sleep", "0.1", "click", "--repeat", "2", "--delay",
                     "370", "1")
            desk.settle()
            if count() > 1:
                break
        self.assertEqual(count(), 2)

    def test_a_third_click_adds_no_probe(self):
        desk = self.open()
        desk.ask("mousemove", *desk.at(300, 250), "sleep", "0.1", "click", "--repeat", "3", "--delay", "60", "1")
        desk.settle()
        self.assertEqual(len(self.saved(desk)["probes"]), 2)

    def test_a_double_click_on_the_reach_adds_a_probe(self):
        desk = self.open()
        reach = self.probe(desk)["radius"]
        desk.double_click(*desk.at(160 + reach, 140))
        probes = self.saved(desk)["probes"]
        self.assertEqual([probe["radius"] for probe in probes[:1]], [reach])
        self.assertEqual(len(probes), 2)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    for name in ("program", "images", "scratch"):
        parser.add_argument(f"--{name}", required=True)
    options, rest = parser.parse_known_args()
    faulthandler.dump_traceback_later(880, exit=True)  # says where it hangs, should it hang
    unittest.main(argv=[sys.argv[0], *rest], verbosity=2)
