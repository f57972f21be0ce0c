"""A real window under Xvfb, and what a person does at it: real mouse and key events, looking, waiting."""
import os
import pathlib
import shutil
import struct
import subprocess
import time

from Xlib.display import Display
from Xlib.ext import damage

PATIENCE = 20  # seconds until something that must happen counts as not happening; a loaded machine is slow


class Desk:
    """An X server of its own with the program on it."""

    def __init__(self, program, home, arguments, scale=1):
        self.home = pathlib.Path(home)
        shutil.rmtree(self.home, ignore_errors=True)
        self.home.mkdir(parents=True)
        self.processes = []
        self.errors = open(self.home / "errors.txt", "w+")
        try:
            self.start(program, arguments, scale)
        except BaseException:
            self.close()
            raise

    def start(self, program, arguments, scale):
        read, write = os.pipe()
        # Nothing of it may hold the test's own output open: who waits for that would wait for ever.
        silent = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL}
        self.processes.append(subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "2560x1600x24", "-nolisten", "tcp", "-noreset"],
            pass_fds=[write], stderr=subprocess.DEVNULL, **silent))
        os.close(write)
        with os.fdopen(read) as pipe:
            display = ":" + pipe.readline().strip()
        self.environment = dict(os.environ, DISPLAY=display, HOME=str(self.home), PROBEWARP_UI_SCALE=str(scale))
        self.program = subprocess.Popen([program, *arguments], env=self.environment, stderr=self.errors,
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
        path = self.home / f"{name}.xwd"
        subprocess.run(["xwd", "-root", "-silent", "-out", str(path)], env=self.environment)
        return path

    def seen(self, left, top, right, bottom):
        """The screen's pixels in a rectangle, row by row."""
        data = self.screenshot("seen").read_bytes()
        header = struct.unpack(">25I", data[:100])
        start, length, pixel = header[0] + 12 * header[19], header[12], header[11] // 8
        return [data[start + y * length + left * pixel:start + y * length + right * pixel] for y in range(top, bottom)]


class Drawings:
    """Counts what is drawn into a window, as the X server sees it."""

    def __init__(self, desk):
        self.display = Display(desk.environment["DISPLAY"])
        self.display.damage_query_version()
        self.display.create_resource_object("window", int(desk.window)).damage_create(damage.DamageReportRawRectangles)
        self.display.sync()

    def count(self):
        """Since the last time."""
        self.display.sync()
        found = 0
        while self.display.pending_events():
            found += self.display.next_event().type == self.display.extension_event.DamageNotify
        return found
