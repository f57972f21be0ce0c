#!/usr/bin/env python3
"""Ends the real program by a signal while it writes: the old file stands, nothing lies beside it, and it ended by that
signal. What SIGKILL leaves is removed by the next save of the same file, and nothing else is.

    signals_test.py --program build/release/app/probewarp [unittest's options]
"""

import fcntl
import os
import resource
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
import zlib

import files
import harness

ENDING = signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGXCPU
TEMPORARY = ".probewarp-tmp"
PATIENCE = 60  # seconds that a busy machine may take to begin with writing

program = None


def no_core():
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def contents(path):
    with open(path, "rb") as f:
        return f.read()


def noise_png(side):
    rows = b"".join(b"\0" + os.urandom(side * 3) for _ in range(side))
    return files.png_header(side, side, 8, 2) + files.png_chunk(b"IDAT", zlib.compress(rows, 0)) + files.png_chunk(b"IEND", b"")


class Signals(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory(prefix="probewarp-signals-")
        cls.addClassCleanup(scratch.cleanup)
        cls.scratch = scratch.name
        cls.large, cls.small = (os.path.join(cls.scratch, name) for name in ("large.png", "small.png"))
        for path, side in (cls.large, 1500), (cls.small, 30):
            with open(path, "wb") as f:
                f.write(noise_png(side))

    def setUp(self):
        self.folder = os.path.join(self.scratch, self.id().split(".")[-1])
        os.mkdir(self.folder)
        self.addCleanup(shutil.rmtree, self.folder)

    def at(self, name):
        return os.path.join(self.folder, name)

    def render(self, name, picture=None):
        slowly = ["--compression", "small"] if name.endswith(".png") else []
        return ["render", picture or self.large, "--probe", "3,3:9,9", "-o", self.at(name), *slowly]

    def temporaries(self):
        return [name for name in os.listdir(self.folder) if name.endswith(TEMPORARY)]

    def interrupted(self, number, arguments, ready=None, preexec=no_core):
        """Runs until a temporary file is there, sends the signal, and returns how the program ended: the code, and
        whether it was still writing."""
        process = program.start(*arguments, preexec=preexec)
        end = time.monotonic() + PATIENCE
        while process.poll() is None and not (ready or self.temporaries)():
            self.assertLess(time.monotonic(), end, "nothing was written")
            time.sleep(0.0005)
        process.send_signal(number)
        return process.wait()

    def check_interrupted(self, number, name):
        before = contents(self.at(name)) if os.path.exists(self.at(name)) else None
        # At any moment the program may just have come to its end: then it is tried again.
        for _ in range(20):
            code = self.interrupted(number, self.render(name))
            if code != 0:
                break
            if before is None:
                os.unlink(self.at(name))
            else:
                with open(self.at(name), "wb") as f:
                    f.write(before)
        self.assertEqual(code, -number)
        self.assertEqual(os.listdir(self.folder), [] if before is None else [name])
        if before is not None:
            self.assertEqual(contents(self.at(name)), before)

    def test_ending_signals_leave_nothing(self):
        for number in ENDING:
            for name in "x.png", "x.probewarp", "x.bmp":
                with self.subTest(signal=number, name=name):
                    self.check_interrupted(number, name)
                    with open(self.at(name), "wb") as f:
                        f.write(b"the old file")
                    self.check_interrupted(number, name)
                    os.unlink(self.at(name))

    def test_an_ignored_signal_stays_ignored(self):
        def ignoring():
            for number in signal.SIGHUP, signal.SIGINT:  # as nohup does, and a shell without job control
                signal.signal(number, signal.SIG_IGN)
        for number in signal.SIGHUP, signal.SIGINT:
            self.assertEqual(self.interrupted(number, self.render("x.png"), preexec=ignoring), 0)
            self.assertEqual(os.listdir(self.folder), ["x.png"])

    def interrupted_between_files(self, number, out, arguments):
        """As check_interrupted, once the first of several files is there."""
        for _ in range(20):
            os.mkdir(out)
            code = self.interrupted(number, arguments, ready=lambda: any(name.endswith(".png") for name in os.listdir(out)))
            if code != 0:
                return self.assertEqual(code, -number)
            shutil.rmtree(out)
        self.fail("no signal hit the time between two files")

    def test_maps_that_are_whole_stay(self):
        probes = [word for i in range(12) for word in ("--probe", f"{100 + 100 * i},300")]
        whole = program.run("weights", self.large, *probes, "-o", self.at("all"), "--quiet")
        self.assertEqual(whole.code, 0, whole)
        out = self.at("some")
        self.interrupted_between_files(signal.SIGTERM, out, ["weights", self.large, *probes, "-o", out])
        self.assertGreater(len(os.listdir(out)), 0)
        for name in os.listdir(out):
            self.assertEqual(contents(os.path.join(out, name)), contents(self.at("all/" + name)), name)

    def test_a_batch(self):
        pictures = []
        for i in range(8):
            pictures.append(self.at(f"{i}.png"))
            os.link(self.large, pictures[-1])
        out = self.at("out")
        self.interrupted_between_files(signal.SIGINT, out, ["render", self.small, "--probe", "3,3:9,9", "--image", *pictures,
                                                            "-o", out + "/{name}.png"])
        left = os.listdir(out)
        self.assertEqual([name for name in left if name.startswith(".")], [])
        for name in left:
            self.assertEqual(contents(os.path.join(out, name))[-8:-4], b"IEND", name)

    # ---- what SIGKILL leaves ----

    def kill_while_writing(self, name):
        for _ in range(20):
            self.interrupted(signal.SIGKILL, self.render(name))
            if left := self.temporaries():
                return left
        self.fail("no kill hit the moment of writing")

    def test_the_next_save_removes_what_a_kill_left(self):
        for name in "x.png", "x.probewarp", "n" * 251 + ".png", "\u00e4" * 120 + ".png":
            with self.subTest(name=name):
                left = self.kill_while_writing(name)
                result = program.run(*self.render("other.png", self.small))
                self.assertEqual(result.code, 0, result)
                self.assertEqual(self.temporaries(), left, "it is no left-over of that other file")
                os.unlink(self.at("other.png"))
                result = program.run(*self.render(name, self.small))
                self.assertEqual(result.code, 0, result)
                self.assertEqual(os.listdir(self.folder), [name])
                os.unlink(self.at(name))

    def test_only_what_is_surely_a_left_over_is_removed(self):
        left, = self.kill_while_writing("x.png")
        number = left.removesuffix(TEMPORARY).rpartition(".")
        like = lambda n: f"{number[0]}.{n}{TEMPORARY}"
        shutil.copy(self.at(left), self.at(left + ".kept"))      # a longer name
        shutil.copy(self.at(left), self.at(".y.png.0" + TEMPORARY))  # of another target
        os.symlink(self.large, self.at(like(3)))                 # a link
        shutil.copy(self.large, self.at("two-names"))
        os.link(self.at("two-names"), self.at(like(4)))          # a file that has another name
        os.mkdir(self.at(like(5)))                               # a folder
        os.mkfifo(self.at(like(6)))                              # a pipe
        locked = open(self.at(like(7)), "wb")                    # another program's that is just being written
        fcntl.flock(locked, fcntl.LOCK_EX)
        if os.geteuid() == 0:
            shutil.copy(self.at(left), self.at(like(8)))         # another user's
            os.chown(self.at(like(8)), 65534, 65534)
        before = harness.files_in(self.folder, folder_times=False)
        result = program.run(*self.render("x.png", self.small))
        locked.close()
        self.assertEqual(result.code, 0, result)
        after = harness.files_in(self.folder, folder_times=False)
        del before[left], after["x.png"]
        self.assertEqual(after, before)

    def test_saves_at_once_do_not_take_each_other_for_left_overs(self):
        result = program.run(*self.render("right.png", self.small))
        self.assertEqual(result.code, 0, result)
        for _ in range(3):
            processes = [subprocess.Popen([program.path, *self.render("x.png", self.small)]) for _ in range(24)]
            self.assertEqual([process.wait() for process in processes], [0] * len(processes))
            self.assertEqual(sorted(os.listdir(self.folder)), ["right.png", "x.png"])
            self.assertEqual(contents(self.at("x.png")), contents(self.at("right.png")))


if __name__ == "__main__":
    program = harness.Program(harness.options().program)
    unittest.main()
