#!/usr/bin/env python3
"""A file that is read is never one that is written, by whatever path, link or option it is named: exit code 2, one
sentence, and not a byte changed anywhere.

    files_apart_test.py --program build/release/app/probewarp [unittest's options]
"""

import os
import subprocess
import tempfile
import unittest

import files
import harness

program = None
PROBE = "--probe", "3,3:5,4,10,6"


def write(path, data):
    with open(path, "wb") as f:
        f.write(data)


def contents(path):
    with open(path, "rb") as f:
        return f.read()


class FilesApart(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="probewarp-apart-")
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        write(self.at("in.png"), files.png(16, 12))
        write(self.at("photo.png"), files.png(18, 14))
        write(self.at("probes.csv"), b"3,3,3,3,0,6\n")
        for arguments in (["render", self.at("in.png"), *PROBE, "-o", self.at("pose.probewarp")],
                          ["weights", self.at("in.png"), *PROBE, "-o", self.at("maps"), "--quiet"]):
            result = program.run(*arguments)
            self.assertEqual(result.code, 0, result)
        self.map = self.at("maps/01-Probe_1.png")

    def at(self, name):
        return os.path.join(self.folder, name)

    def everything(self):
        return {path: contents(path) for path in
                (os.path.join(place, name) for place, _, names in os.walk(self.folder) for name in names)
                if os.path.isfile(path)}

    def refused(self, *arguments, **settings):
        before = self.everything()
        with self.subTest(arguments=arguments):
            result = program.run(*arguments, **settings)
            self.assertEqual((result.code, result.out), (2, b""), result)
            self.assertIsNone(harness.one_line(result.err), result)
            self.assertIn(b"expected another file", result.err)
            self.assertEqual(self.everything(), before)

    def names_of(self, path):
        """The file by every other name we can think of."""
        folder, name = os.path.split(path)
        ways = {"hard": os.link, "soft": os.symlink}
        for way, make in ways.items():
            make(path, self.at(f"{way}-{name}"))
            yield self.at(f"{way}-{name}")
        os.symlink(f"soft-{name}", self.at(f"twice-{name}"))
        os.symlink(folder, self.at(f"folder-{name}.d"))
        yield from (path, self.at(f"twice-{name}"), self.at(f"folder-{name}.d/{name}"), f"{folder}/./{name}",
                    f"{folder}//../{os.path.basename(folder)}/{name}", f"/proc/self/root{path}")

    def test_render(self):
        for output in self.names_of(self.at("in.png")):
            self.refused("render", self.at("in.png"), *PROBE, "-o", output)
            self.refused("render", self.at("in.png"), *PROBE, "-o", output, "--format", "probewarp")
            self.refused("render", self.at("in.png"), *PROBE, "-o", output, "--format", "obj")
        for output in self.names_of(self.at("photo.png")):
            self.refused("render", self.at("pose.probewarp"), "--image", self.at("photo.png"), "-o", output)
        for output in self.names_of(self.at("probes.csv")):
            self.refused("render", self.at("in.png"), "--probes", self.at("probes.csv"), "-o", output, "--format", "png")
        for output in self.names_of(self.at("pose.probewarp")):
            self.refused("render", self.at("pose.probewarp"), "-o", output)
        self.refused("render", "in.png", *PROBE, "-o", self.at("in.png"), cwd=self.folder)
        self.refused("render", self.at("in.png"), *PROBE, "-o", "./in.png", cwd=self.folder)

    def test_many_pictures(self):
        os.mkdir(self.at("out"))
        os.symlink("../probes.csv", self.at("out/in.png"))
        several = "render", self.at("pose.probewarp"), "--image", self.at("in.png"), self.at("photo.png")
        self.refused(*several, "-o", self.at("{name}.png"))
        self.refused(*several, "--probes", self.at("probes.csv"), "-o", self.at("out/{name}.png"))
        os.unlink(self.at("out/in.png"))
        os.symlink("in.png", self.at("out/photo.png"))  # two outputs that lead to one file, which is not there yet
        self.refused(*several, "-o", self.at("out/{name}.png"))

    def test_weights(self):
        base = "weights", self.at("pose.probewarp")
        for output in self.names_of(self.at("pose.probewarp")):
            if output.endswith(".probewarp"):
                self.refused(*base, "--save", output)
        imported = "--import", "1=" + self.map
        self.refused(*base, *imported, "-o", self.at("maps"))
        os.symlink(self.map, self.at("map.probewarp"))
        self.refused(*base, *imported, "--save", self.at("map.probewarp"))
        os.mkdir(self.at("links"))
        os.link(self.at("pose.probewarp"), self.at("links/01-Probe_1.png"))
        self.refused(*base, "-o", self.at("links"))
        os.symlink("fresh/01-Probe_1.png", self.at("both.probewarp"))  # of a folder that is not there yet
        self.refused(*base, "-o", self.at("fresh"), "--save", self.at("both.probewarp"))
        self.assertFalse(os.path.exists(self.at("fresh")))

    def redirected(self, flags, stream, *arguments):
        """Standard output or error goes to the input, opened with the flags as a shell does."""
        before = self.everything()
        descriptor = os.open(self.at("in.png"), flags)
        try:
            result = subprocess.run([program.path, *arguments], **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE,
                                                                   stream: descriptor})
        finally:
            os.close(descriptor)
        self.assertEqual(result.returncode, 2, result)
        self.assertEqual(self.everything(), before)
        if stream == "stdout":
            self.assertIsNone(harness.one_line(result.stderr), result)

    def test_streams_that_go_to_the_input(self):
        for flags in os.O_WRONLY | os.O_APPEND, os.O_RDWR:  # >> and 1<>
            for stream in "stdout", "stderr":
                for arguments in (["render", self.at("in.png"), *PROBE, "-o", "-", "--format", "png"],
                                  ["render", self.at("in.png"), *PROBE, "-o", self.at("new.png")],
                                  ["info", self.at("in.png")], ["info", self.at("in.png"), "--json"],
                                  ["weights", self.at("in.png"), *PROBE, "-o", self.at("new")]):
                    with self.subTest(flags=flags, stream=stream, arguments=arguments):
                        self.redirected(flags, stream, *arguments)

    def test_what_is_apart_is_written(self):
        for arguments in (["render", self.at("in.png"), *PROBE, "-o", self.at("out.png")],
                          ["render", self.at("in.png"), *PROBE, "-o", self.at("out.png")],
                          ["render", self.at("pose.probewarp"), "--image", self.at("photo.png"), self.at("in.png"), "-o",
                           self.at("new/{name}.png")],
                          ["weights", self.at("pose.probewarp"), "-o", self.at("maps"), "--save", self.at("x.probewarp"),
                           "--quiet"]):
            with self.subTest(arguments=arguments):
                result = program.run(*arguments)
                self.assertEqual((result.code, result.err), (0, b""), result)


if __name__ == "__main__":
    program = harness.Program(harness.options().program)
    unittest.main()
