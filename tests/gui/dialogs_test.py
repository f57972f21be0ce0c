#!/usr/bin/env python3
"""The window's dialogs, messages, drops and bars under Xvfb, with real mouse and key events.

    dialogs_test.py --program PATH --images DIR --scratch DIR
"""
import argparse
import faulthandler
import pathlib
import shutil
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from desk import PATIENCE, Desk
from png_file import write_png

options = None

# Places in the dialogs at scale 1 in a window of 1280 x 800.
ROW = lambda i: (600, 222 + 28 * i)  # of the file dialog's list
ACCENT = 934, 616                    # the file dialog's button at the right
RAISED = bytes((0x36, 0x2f, 0x2b))   # what messages lie on in the dark theme; blue, green, red


class DialogsTest(unittest.TestCase):
    def desk(self, *arguments, scale=1, files=()):
        """A window on a home with these files: small pictures, each of its own grey."""
        self.home = pathlib.Path(options.scratch) / self.id().split(".")[-1]
        self.pictures = pathlib.Path(options.scratch) / (self.id().split(".")[-1] + "-pictures")
        shutil.rmtree(self.pictures, ignore_errors=True)
        self.pictures.mkdir(parents=True)
        for k, name in enumerate(files):
            path = self.pictures / name
            path.parent.mkdir(parents=True, exist_ok=True)
            write_png(path, 60, 40, [40 + k] * 2400, 8)
        desk = Desk(options.program, self.home, arguments, scale)
        self.addCleanup(desk.close)
        desk.wait(lambda: desk.title() != "", "a title")
        return desk

    def open(self, desk, path):
        desk.key("ctrl+o")
        desk.type_path(path)
        desk.wait_title(f"{path.name} – Probewarp")
        desk.settle()

    def list(self, desk, folder):
        """The Open dialog on a folder."""
        desk.key("ctrl+o")
        desk.type_path(folder)
        desk.settle()

    def click(self, desk, place, count=1):
        desk.ask("mousemove", *place, "sleep", "0.1", "click", "--repeat", count, "--delay", "150", "1")
        desk.settle()

    def hidden(self):
        return [path for path in self.pictures.rglob(".*")]

    def test_a_double_click_on_a_folder_enters_it_and_does_no_more(self):
        for count in (2, 4):
            desk = self.desk(files=["sub/a.png", "sub/b.png", "top.png"])
            self.list(desk, self.pictures)
            self.click(desk, ROW(0), count)
            self.assertEqual(desk.title(), "Probewarp")
            # Nothing is picked either: a name that is typed is of the folder that was entered.
            desk.ask("type", "b.png")
            desk.key("Return")
            desk.wait_title("b.png – Probewarp")
            desk.close()

    def test_a_double_click_is_two_clicks_on_one_file(self):
        desk = self.desk(files=["a.png", "b.png"])
        self.list(desk, self.pictures)
        desk.ask("mousemove", *ROW(0), "sleep", "0.1", "click", "1", "mousemove", *ROW(1), "click", "1")
        desk.settle()
        self.assertEqual(desk.title(), "Probewarp")
        self.click(desk, ROW(1), 2)
        desk.wait_title("b.png – Probewarp")

    def test_a_folder_is_no_name_to_save_by(self):
        desk = self.desk(files=["a.png", "sub/b.png"])
        self.open(desk, self.pictures / "a.png")
        before = sorted(self.pictures.rglob("*"))
        desk.key("ctrl+shift+s")
        for name in (f"{self.pictures}/sub/", f"{self.pictures}/sub", f"{self.pictures}/missing/", "missing/x", ".", "..",
                     "   ", ".probewarp", " .probewarp", "...", "x" * 252):
            desk.type_path(name)
            self.assertEqual(sorted(self.pictures.rglob("*")), before, name)
            self.assertEqual(desk.title(), "a.png – Probewarp", name)
        desk.type_path("good.")  # in the folder that was entered first
        desk.wait_title("good.probewarp – Probewarp")
        self.assertTrue((self.pictures / "sub/good.probewarp").exists())
        self.assertEqual(self.hidden(), [])

    def test_saving_replaces_by_the_button_that_says_so(self):
        desk = self.desk(files=["a.png"])
        self.open(desk, self.pictures / "a.png")
        there = self.pictures / "there.probewarp"
        for way in ("button", "keys"):
            there.write_bytes(b"precious")
            desk.key("ctrl+shift+s")
            desk.type_path(there)
            desk.key("Return", "Return", "Return", "Return")
            self.assertEqual(there.read_bytes(), b"precious")
            desk.key("Escape", "Escape")  # the question, should there be one, and the dialog
            desk.key("ctrl+shift+s")
            desk.type_path(there)
            if way == "keys":
                desk.key("Left", "Return")
            else:
                desk.key("Escape")
                self.click(desk, ACCENT)
            desk.wait(lambda: there.read_bytes() != b"precious", "the project in the old file's place")

    def test_exporting_replaces_by_the_button_that_says_so(self):
        desk = self.desk(files=["a.png"])
        self.open(desk, self.pictures / "a.png")
        there = self.pictures / "there.png"
        there.write_bytes(b"precious")
        desk.key("ctrl+e")
        desk.type_path(there)
        desk.key("Return", "Return", "Return")
        self.assertEqual(there.read_bytes(), b"precious")
        desk.key("Escape", "Escape")
        desk.key("ctrl+e")
        desk.type_path(there)
        desk.key("Left", "Return")
        desk.wait(lambda: there.read_bytes() != b"precious", "the picture in the old file's place")

    def test_nothing_is_written_over_the_picture_that_is_open(self):
        desk = self.desk(files=["a.png"])
        self.open(desk, self.pictures / "a.png")
        picture = self.pictures / "a.png"
        before = picture.read_bytes()
        (self.pictures / "link.png").symlink_to(picture)
        (self.pictures / "hard.png").hardlink_to(picture)
        for name in ("a.png", "link.png", "hard.png"):
            desk.key("ctrl+e")
            desk.type_path(self.pictures / name)
            desk.key("Left", "Return", "Escape", "Escape")
        self.assertEqual(picture.read_bytes(), before)
        self.assertTrue((self.pictures / "link.png").is_symlink())
        self.assertEqual((self.pictures / "hard.png").read_bytes(), before)

    def test_dialogs_begin_beside_the_picture_then_where_one_was_last(self):
        desk = self.desk(files=["sub/a.png", "other/b.png"])
        self.open(desk, self.pictures / "sub/a.png")
        desk.key("ctrl+e", "Return")
        desk.wait((self.pictures / "sub/a-deformed.png").exists, "the export beside the picture")
        desk.key("ctrl+shift+s", "Return")
        desk.wait((self.pictures / "sub/a.probewarp").exists, "the project beside the picture")
        self.open(desk, self.pictures / "other/b.png")
        desk.key("ctrl+n")
        desk.wait_title("Probewarp")
        desk.key("ctrl+o")
        desk.ask("type", "b.png")  # of the folder that was used last
        desk.key("Return")
        desk.wait_title("b.png – Probewarp")

    def drop(self, desk, *paths):
        script = pathlib.Path(__file__).with_name("drop_file.py")
        subprocess.run([sys.executable, str(script), desk.window, "\n".join(map(str, paths)), "400", "300"],
                       env=desk.environment, check=True, timeout=PATIENCE)

    def says_something(self, desk, panel=308):
        """Whether a message lies at the canvas's lower right."""
        right, bottom = 1280 - panel - 8, 800 - 26 - 32 - 8
        return all(row == RAISED * 40 for row in desk.seen(right - 60, bottom - 8, right - 20, bottom - 4))

    def test_dropped_files(self):
        desk = self.desk(files=["a.png", "b c.png", "d.png"])
        a, bc, d = (self.pictures / name for name in ("a.png", "b c.png", "d.png"))
        self.drop(desk, f"file:{a}")
        desk.wait_title("a.png – Probewarp")
        self.drop(desk, "file://localhost" + str(bc).replace(" ", "%20"))
        desk.wait_title("b c.png – Probewarp")
        self.drop(desk, f"FILE:{d}")
        desk.wait_title("d.png – Probewarp")
        desk.settle()
        self.assertFalse(self.says_something(desk))
        self.drop(desk, a, bc, d)
        desk.wait_title("a.png – Probewarp")
        desk.wait(lambda: self.says_something(desk), "a word on the others")
        desk.wait(lambda: not self.says_something(desk), "its end")
        self.drop(desk, "http://example.org/a.png")
        desk.wait(lambda: self.says_something(desk), "why it was not opened")
        desk.key("Escape")
        desk.wait(lambda: not self.says_something(desk), "its end by Escape")
        # While a dialog is open, that is said and nothing is opened.
        desk.key("ctrl+e")
        self.drop(desk, d)
        desk.settle()
        desk.key("Escape")
        self.assertEqual(desk.title(), "a.png – Probewarp")

    def test_errors_close_by_click_or_escape_and_leave_the_panel_free(self):
        desk = self.desk(files=["a.png"])
        self.open(desk, self.pictures / "a.png")
        panel = 1280 - 308, 32, 1280, 774
        bad = self.pictures / ("long-" * 45 + ".png")
        bad.write_bytes(b"no picture")
        desk.ask("mousemove", 400, 300)
        desk.settle()
        free = desk.seen(*panel)
        for way in ("click", "key"):
            self.drop(desk, bad)
            desk.wait(lambda: self.says_something(desk), "the error")
            self.assertEqual(desk.seen(*panel), free)
            if way == "key":
                desk.key("Escape")
            else:
                self.click(desk, (1280 - 308 - 40, 800 - 26 - 32 - 14))
            desk.wait(lambda: not self.says_something(desk), f"the error's end by {way}")
        self.assertEqual(desk.title(), "a.png – Probewarp")

    def test_many_messages_stay_on_the_canvas(self):
        desk = self.desk(files=["a.png"])
        self.open(desk, self.pictures / "a.png")
        bars = (0, 0, 1280, 32), (1280 - 308, 32, 1280, 774), (500, 775, 1280, 800)
        desk.ask("mousemove", 400, 300)
        desk.settle()
        free = [desk.seen(*bar) for bar in bars]
        for k in range(12):
            bad = self.pictures / f"{k}.png"
            bad.write_bytes(b"no picture")
            self.drop(desk, bad)
        desk.wait(lambda: self.says_something(desk), "the errors")
        desk.ask("mousemove", 400, 300)
        desk.settle()
        self.assertEqual([desk.seen(*bar) for bar in bars], free)
        desk.screenshot("many")

    def test_a_picture_damaged_at_its_end_is_offered(self):
        desk = self.desk(files=["a.png"])
        self.open(desk, self.pictures / "a.png")
        whole = (pathlib.Path(options.images) / "gingerbread.png").read_bytes()
        (self.pictures / "cut.png").write_bytes(whole[:len(whole) * 2 // 3])
        desk.key("ctrl+o")
        desk.type_path(self.pictures / "cut.png")
        desk.settle()
        desk.key("Escape")
        self.assertEqual(desk.title(), "a.png – Probewarp")
        desk.key("ctrl+o")
        desk.type_path(self.pictures / "cut.png")
        desk.settle()
        desk.key("Return")
        desk.wait_title("cut.png – Probewarp")
        desk.key("ctrl+shift+s", "Return")
        desk.wait_title("cut.probewarp – Probewarp")
        self.open(desk, self.pictures / "a.png")
        self.open(desk, self.pictures / "cut.probewarp")

    def test_long_names_lie_over_nothing(self):
        for scale, size in ((1, (640, 480)), (1, (800, 500)), (1.5, (960, 720)), (2, (1280, 960)), (3, (640, 480))):
            bars, names = [], ("a.png", "x" * 251 + ".png", "長" * 80 + ".png")
            desk = self.desk(scale=scale, files=names)
            desk.ask("windowsize", desk.window, *size)
            desk.settle()
            desk.ask("windowfocus", desk.window)
            for name in names:
                self.drop(desk, self.pictures / name)
                desk.wait_title(f"{name} – Probewarp")
                desk.settle()
                wide = min(scale, size[0] / 640)
                menus, right, status = round(270 * wide), size[0] - round(170 * wide), round(26 * wide)
                bars.append([desk.seen(0, 0, menus, round(32 * wide)), desk.seen(right, 0, size[0], round(32 * wide)),
                             desk.seen(0, size[1] - status, round(60 * wide), size[1])])
            desk.close()
            self.assertEqual(bars[0], bars[1], (scale, size))
            self.assertEqual(bars[0], bars[2], (scale, size))

    def test_other_scripts_are_drawn(self):
        """Two names of as many characters differ on the screen: a sign for what is missing would be the same."""
        pairs = (("東京", "日本"), ("かな", "けの"), ("서울", "한국"), ("ابج", "دهو"), ("אבג", "דהו"), ("กขค", "งจฉ"),
                 ("कखग", "घङच"), ("Ạ", "Ế"))
        desk = self.desk(files=[f"{name}.png" for pair in pairs for name in pair])
        for one, other in pairs:
            titles = []
            for name in (one, other):
                self.drop(desk, self.pictures / f"{name}.png")
                desk.wait_title(f"{name}.png – Probewarp")
                desk.settle()
                titles.append(desk.seen(500, 0, 780, 32))
            self.assertNotEqual(*titles, (one, other))


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    for name in ("program", "images", "scratch"):
        parser.add_argument(f"--{name}", required=True)
    options, rest = parser.parse_known_args()
    faulthandler.dump_traceback_later(340, exit=True)  # says where it hangs, should it hang
    unittest.main(argv=[sys.argv[0], *rest], verbosity=2)
