#!/usr/bin/env python3
"""The command line while memory is short or no thread starts: it does what it was asked or says in one sentence why not,
with exit code 1, and leaves no half file.

    failures_test.py --program build/release/app/probewarp --failing-calls libfailing_calls.so [unittest's options]
"""

import os
import tempfile
import unittest

import files
import harness

program = failing_calls = None
# From what the smallest picture takes up to more than everything here: where the limit lies each step fails once.
LIMITS = [2 ** k for k in range(12, 25)]


class Failures(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="probewarp-failures-")
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        self.control = self.at("control")
        for name in "control", "in", "out":
            os.mkdir(self.at(name))
        for name in "a.png", "b.png":
            with open(self.at("in/" + name), "wb") as f:
                f.write(files.png(600, 400))
        self.probes = "--probe", "100,100:120,90,30", "--probe", "400,300:380,310"
        self.project = self.at("in/pose.probewarp")
        result = program.run("render", self.at("in/a.png"), *self.probes, "-o", self.project)
        self.assertEqual(result.code, 0, result)

    def at(self, name):
        return os.path.join(self.folder, name)

    def commands(self):
        """What is done, and the files that it makes."""
        for name in "x.png", "x.jpg", "x.tga", "x.obj", "x.probewarp":
            beside = ["x-texture.png", "x.mtl"] if name == "x.obj" else []
            yield ["render", self.project, "-o", self.at("out/" + name)], [*beside, name]
        yield ["render", self.project, "-o", self.at("out/x.png"), "--weights", "harmonic"], ["x.png"]
        yield ["weights", self.project, "-o", self.at("out"), "--quiet"], ["01-Probe_1.png", "02-Probe_2.png"]
        yield ["render", self.project, "--image", self.at("in/a.png"), self.at("in/b.png"), "-o",
               self.at("out/{name}.png")], ["a.png", "b.png"]
        yield ["info", self.project, "--json"], []

    def outputs(self):
        found = {}
        for name in os.listdir(self.at("out")):
            with open(self.at("out/" + name), "rb") as f:
                found[name] = f.read()
            os.unlink(self.at("out/" + name))
        return found

    def run_failing(self, arguments, **limits):
        for name, limit in limits.items():
            with open(os.path.join(self.control, name), "w") as f:
                f.write(str(limit))
        result = program.run(*arguments, env={"LD_PRELOAD": failing_calls, "FAILING_CALLS": self.control})
        for name in limits:
            os.unlink(os.path.join(self.control, name))
        return result

    def check(self, arguments, whole, **limits):
        """It is done, wholly, or refused. Of a batch every picture is whole or missing."""
        with self.subTest(arguments=arguments, limits=limits):
            result = self.run_failing(arguments, **limits)
            made = self.outputs()
            self.assertIn(result.code, (0, 1), result)
            for name, data in made.items():
                self.assertEqual(data, whole[name], name)
            if result.code == 0:
                self.assertEqual((sorted(made), result.err), (sorted(whole), b""), result)
                return True
            for line in result.err.splitlines(keepends=True):
                self.assertIsNone(harness.one_line(line), result)
            self.assertIn(result.err.count(b"\n"), (1, 2) if "--image" in arguments else (1,), result)
            return False

    def whole(self, arguments, names):
        result = program.run(*arguments)
        self.assertEqual(result.code, 0, result)
        made = self.outputs()
        self.assertEqual(sorted(made), names)
        return made

    def test_no_memory(self):
        for arguments, names in self.commands():
            whole = self.whole(arguments, names)
            # info opens a context, and Mesa's drivers do not survive a malloc that fails.
            for kind in ("new",) if arguments[0] == "info" else ("new", "malloc"):
                done = [self.check(arguments, whole, **{kind: limit}) for limit in LIMITS]
                self.assertTrue(done[-1], "nothing is that large")
                if kind == "new":
                    self.assertFalse(done[0], "the smallest limit was not met")

    def test_no_thread(self):
        for arguments, names in self.commands():
            whole = self.whole(arguments, names)
            self.assertTrue(self.check(arguments, whole, threads=0), "it can be done by one thread")
            for count in range(1, 8):
                self.check(arguments, whole, threads=count)


if __name__ == "__main__":
    options = harness.options("--failing-calls")
    program, failing_calls = harness.Program(options.program), os.path.abspath(options.failing_calls)
    unittest.main()
