#!/usr/bin/env python3
"""Standard streams that are closed or cannot be written: the program ends by itself, a batch goes on, and lost output is
exit code 1.

    streams_test.py --program build/release/app/probewarp [unittest's options]
"""

import os
import signal
import subprocess
import tempfile
import unittest

import files
import harness

program = None
PROBE = "--probe", "3,3:5,4,10,6"


class Streams(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="probewarp-streams-")
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        self.picture = self.at("in.png")
        with open(self.picture, "wb") as f:
            f.write(files.png(16, 12))

    def at(self, name):
        return os.path.join(self.folder, name)

    def run_with(self, *arguments, out=None, err=None, closed=()):
        """Runs with the streams replaced; those that are `closed` are so from the program's first moment."""
        # Python leaves SIGPIPE ignored; a shell's commands get it.
        def child():
            signal.signal(signal.SIGPIPE, signal.SIG_DFL)
            for stream in closed:
                os.close(stream)
        return subprocess.run([program.path, *arguments], stdin=subprocess.DEVNULL, stdout=out or subprocess.PIPE,
                              stderr=err or subprocess.PIPE, preexec_fn=child, timeout=60)

    def unwritable(self):
        """A full disk, a pipe that nobody reads, a file that is only open for reading."""
        with open("/dev/full", "wb") as full, open("/dev/null", "rb") as read_only:
            yield "full", full
            yield "read-only", read_only
        reader, writer = os.pipe()
        os.close(reader)
        yield "pipe", writer
        os.close(writer)

    def printing(self):
        yield "--version",
        yield "--help",
        yield "render", "--help"
        yield "info", self.picture
        yield "info", self.picture, "--json"
        yield "render", self.picture, *PROBE, "-o", "-", "--format", "png"
        yield "render", self.picture, *PROBE, "-o", "-", "--format", "obj"
        yield "render", self.picture, *PROBE, "-o", "-", "--format", "probewarp"
        yield "weights", self.picture, *PROBE, "-o", self.at("maps")

    def test_lost_output_is_told(self):
        for arguments in self.printing():
            for what, stream in self.unwritable():
                with self.subTest(arguments=arguments, stream=what):
                    result = self.run_with(*arguments, out=stream)
                    self.assertEqual(result.returncode, 1, result)
                    self.assertIsNone(harness.one_line(result.stderr), result)
                    self.assertIn(b"cannot write to standard output: ", result.stderr)
            with self.subTest(arguments=arguments, stream="closed"):
                result = self.run_with(*arguments, closed=[1])
                self.assertEqual(result.returncode, 1, result)
                self.assertIsNone(harness.one_line(result.stderr), result)

    def test_output_that_arrives(self):
        for arguments in self.printing():
            with self.subTest(arguments=arguments):
                result = self.run_with(*arguments, closed=[0])
                self.assertEqual((result.returncode, result.stderr), (0, b""), result)
                self.assertNotEqual(result.stdout, b"")

    def test_all_maps_are_written_where_their_names_cannot_be(self):
        result = self.run_with("weights", self.picture, *PROBE, "--probe", "9,9", "-o", self.at("maps"), closed=[1])
        self.assertEqual(result.returncode, 1, result)
        self.assertEqual(len(os.listdir(self.at("maps"))), 2)

    def test_messages_that_are_lost_change_nothing(self):
        cases = (1, ["render", self.at("none.png"), "-o", self.at("x.png")]), (2, ["render"]), (2, ["--nonsense"]), \
                (0, ["render", self.picture, *PROBE, "-o", self.at("x.png")]), (0, ["info", self.picture]), \
                (1, ["info", self.at("none.png")])
        for code, arguments in cases:
            for what, stream in self.unwritable():
                with self.subTest(arguments=arguments, stream=what):
                    self.assertEqual(self.run_with(*arguments, err=stream).returncode, code)
            for closed in [2], [1, 2], [0, 1, 2]:
                with self.subTest(arguments=arguments, closed=closed):
                    lost = arguments[0] == "info" and 1 in closed
                    self.assertEqual(self.run_with(*arguments, closed=closed).returncode, 1 if lost else code)

    def test_timings_that_are_lost_are_told(self):
        arguments = ["render", self.picture, *PROBE, "-o", self.at("x.png"), "--timings"]
        for what, stream in self.unwritable():
            with self.subTest(stream=what):
                self.assertEqual(self.run_with(*arguments, err=stream).returncode, 1)
        self.assertEqual(self.run_with(*arguments).returncode, 0)

    def test_a_batch_goes_on(self):
        os.mkdir(self.at("in"))
        names = [f"{i:02}.png" for i in range(8)]
        for name in names:
            with open(self.at(f"in/{name}"), "wb") as f:
                f.write(b"junk" if name in ("02.png", "05.png") else files.png(16, 12))
        arguments = "render", self.picture, *PROBE, "--image", *(self.at(f"in/{name}") for name in names), "-o"
        whole = [name for name in names if name not in ("02.png", "05.png")]
        for what, stream in self.unwritable():
            with self.subTest(stream=what):
                out = self.at("out-" + what)
                result = self.run_with(*arguments, out + "/{name}.png", err=stream)
                self.assertEqual((result.returncode, sorted(os.listdir(out))), (1, whole))
        result = self.run_with(*arguments, self.at("closed/{name}.png"), closed=[0, 1, 2])
        self.assertEqual((result.returncode, sorted(os.listdir(self.at("closed")))), (1, whole))

    def test_no_file_becomes_a_stream(self):
        # With everything closed the first file that is opened would be standard input, the next one standard output.
        good = self.run_with("render", self.picture, *PROBE, "-o", self.at("good.png"))
        self.assertEqual(good.returncode, 0, good)
        for closed in [0], [1], [2], [0, 1], [0, 2], [1, 2], [0, 1, 2]:
            with self.subTest(closed=closed):
                result = self.run_with("render", self.picture, *PROBE, "-o", self.at("x.png"), "--timings", closed=closed)
                self.assertEqual(result.returncode, 1 if 2 in closed else 0, result)  # the timings are lost
                with open(self.at("good.png"), "rb") as a, open(self.at("x.png"), "rb") as b:
                    self.assertEqual(a.read(), b.read())
                with open(self.picture, "rb") as f:
                    self.assertEqual(f.read(), files.png(16, 12))


if __name__ == "__main__":
    program = harness.Program(harness.options().program)
    unittest.main()
