#!/usr/bin/env python3
"""Saves with the real program while things go wrong: it is killed, the disk is full, the folder is read-only. The target
is always the old or the new file, whole.

    save_test.py --program build/release/app/probewarp [unittest's options]

A program that was killed by SIGKILL may leave its temporary (".NAME.*") behind; that is counted and cleaned up here (what
the next save does about it is signals_test.py's). Every other failure has to leave nothing.
"""

import os
import random
import resource
import signal
import subprocess
import tempfile
import time
import unittest
import zlib

import files
import harness

SEED = 20240611
LOOPS = 200  # kills, half of them while a project is saved and half while a picture is

program = None


class Saving(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="probewarp-save-")
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        self.source = os.path.join(self.folder, "source.png")

    def make_source(self, width, height):
        """Noise, so that what is saved is as long as the picture is large."""
        with open(self.source, "wb") as f:
            f.write(noise_png(width, height))

    def command(self, target, version):
        """Two versions of the same document, told apart by their probe."""
        return ["render", self.source, "--probe", f"3,3:{4 + version},3", "-o", target]

    def whole(self, name):
        """Both versions' bytes, and the seconds that saving takes at most."""
        seconds, versions = [], []
        for version in 0, 1:
            target = os.path.join(self.folder, f"{version}{os.path.splitext(name)[1]}")
            result = program.run(*self.command(target, version))
            self.assertEqual(result.code, 0, result)
            seconds.append(result.seconds)
            versions.append(contents(target))
            os.unlink(target)
        self.assertNotEqual(*versions)
        return versions, max(seconds)

    # ---- killed ----

    def kill_loop(self, name, loops, chance):
        """Kills one half of the runs at any moment and the other half while the temporary is there."""
        folder = os.path.join(self.folder, "target")
        os.mkdir(folder)
        target = os.path.join(folder, name)
        (old, new), longest = self.whole(name)
        standing, counts = old, {"old": 0, "new": 0, "temporaries": 0}
        with open(target, "wb") as f:
            f.write(old)
        for i in range(loops):
            version = int(standing == old)  # write the other one
            process = program.start(*self.command(target, version))
            if i % 2 == 0:
                time.sleep(chance.uniform(0, longest * 1.1))
            else:
                while process.poll() is None and len(os.listdir(folder)) == 1:
                    pass
                time.sleep(chance.uniform(0, 0.003))
            process.kill()
            process.wait()
            now = contents(target)
            self.assertIn(now, (old, new), f"{name}, loop {i}: {len(now)} bytes that are neither the old file nor the new one")
            counts["old" if now == standing else "new"] += 1
            standing = now
            for left in os.listdir(folder):
                if left != name:
                    self.assertTrue(left.startswith(f".{name}."), f"a stray file {left}")
                    counts["temporaries"] += 1
                    os.unlink(os.path.join(folder, left))
        print(f"  {name}: {loops} kills within {longest:.2f} s: {counts['old']} times the old file, {counts['new']} times the "
              f"new one; {counts['temporaries']} temporaries left by SIGKILL and cleaned up", flush=True)
        # Otherwise the kills all came at moments that prove nothing.
        self.assertGreater(counts["old"], 0)
        self.assertGreater(counts["new"], 0)
        self.assertGreater(counts["temporaries"], 0, "no kill hit the moment between creating and renaming")
        result = program.run(*self.command(target, int(standing == old)))  # and the next save simply works
        self.assertEqual((result.code, os.listdir(folder)), (0, [name]), result)

    def test_killed_while_saving_a_project(self):
        print(f"  seed {SEED}", flush=True)
        self.make_source(1000, 700)
        self.kill_loop("x.probewarp", LOOPS // 2, random.Random(SEED))

    def test_killed_while_saving_a_picture(self):
        print(f"  seed {SEED + 1}", flush=True)
        self.make_source(160, 120)
        self.kill_loop("x.png", LOOPS // 2, random.Random(SEED + 1))

    # ---- refused by the system ----

    def check_failure(self, folder, name, why, old=b"the old file", **settings):
        """The save fails with one line that says why; the folder is as before."""
        target = os.path.join(folder, name)
        before = harness.files_in(folder) if os.path.isdir(folder) else None
        with self.subTest(target=name, why=why):
            result = program.run(*self.command(target, 0), **settings)
            self.assertEqual((result.code, result.out), (1, b""), result)
            self.assertIsNone(harness.one_line(result.err), result)
            self.assertIn(target.encode(), result.err, "the line does not name the file")
            self.assertIn(why.encode(), result.err)
            self.assertEqual(harness.files_in(folder) if os.path.isdir(folder) else None, before)
            if old is not None:
                self.assertEqual(contents(target), old)

    def old_files(self, folder):
        for name in "x.probewarp", "x.png":
            with open(os.path.join(folder, name), "wb") as f:
                f.write(b"the old file")

    def fresh(self, name):
        folder = os.path.join(self.folder, name)
        os.mkdir(folder)
        return folder

    def check_both(self, folder, why, **settings):
        """Over an old file and as a new one, a project and a picture, a mesh besides."""
        self.old_files(folder)
        for name in "x.probewarp", "x.png":
            self.check_failure(folder, name, why, **settings)
        for name in "new.probewarp", "new.png", "new.obj":
            self.check_failure(folder, name, why, old=None, **settings)

    def mounted(self, name, options):
        """A tmpfs of its own; skips where mounting is not permitted."""
        folder = self.fresh(name)
        if os.geteuid() != 0:
            self.skipTest("SKIPPED: only root may mount a small disk here")
        mount = subprocess.run(["mount", "-t", "tmpfs", "-o", options, "probewarp-test", folder], capture_output=True, text=True)
        if mount.returncode != 0:
            self.skipTest(f"SKIPPED: no small disk can be mounted here: {mount.stderr.strip()}")
        self.addCleanup(subprocess.run, ["umount", folder], check=True)
        return folder

    def test_full_disk(self):
        self.make_source(160, 120)
        folder = self.mounted("full", "size=16k,mode=755")
        self.check_both(folder, "No space left on device")

    def test_no_room_for_a_name(self):
        self.make_source(160, 120)
        folder = self.mounted("inodes", "size=10m,nr_inodes=3,mode=755")  # the folder itself and the two old files
        self.check_both(folder, "No space left on device")

    def test_file_size_limit(self):
        # As a full disk, for everybody: writing fails after 10000 bytes. First as where the signal is ignored, then with it.
        self.make_source(160, 120)
        quiet = {"MESA_SHADER_CACHE_DISABLE": "true"}
        for what, restored in (("ignored", False), ("default", True)):
            with self.subTest(SIGXFSZ=what):
                self.check_both(self.fresh("limit " + what), "File too large", preexec=harness.limit_file_size(10000),
                                restore_signals=restored, env=quiet)

    def test_read_only_folder(self):
        self.make_source(16, 12)
        folder = self.fresh("closed")
        self.old_files(folder)
        os.chmod(folder, 0o555)
        self.addCleanup(os.chmod, folder, 0o755)
        for name in "x.probewarp", "x.png":
            self.check_failure(folder, name, "Permission denied", preexec=harness.without_privileges)
        self.check_failure(folder, "new.png", "Permission denied", old=None, preexec=harness.without_privileges)

    def test_read_only_file(self):
        self.make_source(16, 12)
        folder = self.fresh("file")
        self.old_files(folder)
        for name in "x.probewarp", "x.png":
            os.chmod(os.path.join(folder, name), 0o444)
            self.check_failure(folder, name, "Permission denied", preexec=harness.without_privileges)

    def test_read_only_disk(self):
        self.make_source(16, 12)
        folder = self.mounted("disk", "size=1m,mode=755")
        self.old_files(folder)
        subprocess.run(["mount", "-o", "remount,ro", folder], check=True)
        for name in "x.probewarp", "x.png":
            self.check_failure(folder, name, "Read-only file system")
        self.check_failure(folder, "new.png", "Read-only file system", old=None)

    def test_target_is_no_file(self):
        self.make_source(16, 12)
        folder = self.fresh("kinds")
        for name in "folder.png", "folder.probewarp":
            os.mkdir(os.path.join(folder, name))
            self.check_failure(folder, name, "folder", old=None)
        os.mkfifo(os.path.join(folder, "pipe.png"))
        self.check_failure(folder, "pipe.png", "pipe", old=None)
        os.symlink("/dev/full", os.path.join(folder, "device.png"))
        self.check_failure(folder, "device.png", "device", old=None)
        os.symlink("loop.png", os.path.join(folder, "loop.png"))
        self.check_failure(folder, "loop.png", "symbolic links", old=None)

    def test_missing_folder(self):
        self.make_source(16, 12)
        for name in "x.png", "x.probewarp":
            self.check_failure(os.path.join(self.folder, "missing"), name, "No such file or directory", old=None)
        self.check_failure(self.source, "x.png", "Not a directory", old=None)

    def test_through_a_link(self):
        # The file that the link leads to is replaced, or left whole; the link stays.
        self.make_source(160, 120)
        folder = self.fresh("links")
        self.old_files(folder)
        os.symlink("x.png", os.path.join(folder, "link.png"))
        self.check_failure(folder, "link.png", "File too large", preexec=harness.limit_file_size(10000), restore_signals=False,
                           env={"MESA_SHADER_CACHE_DISABLE": "true"})
        result = program.run(*self.command(os.path.join(folder, "link.png"), 0))
        self.assertEqual(result.code, 0, result)
        self.assertEqual(os.readlink(os.path.join(folder, "link.png")), "x.png")
        self.assertEqual(contents(os.path.join(folder, "x.png"))[:4], b"\x89PNG")

    def test_a_fresh_name_is_made_whole(self):
        # Without an old file there is none or the new one.
        self.make_source(160, 120)
        folder, chance = self.fresh("new"), random.Random(SEED + 2)
        target = os.path.join(folder, "x.probewarp")
        (new, _), longest = self.whole("x.probewarp")
        for i in range(20):
            process = program.start(*self.command(target, 0))
            time.sleep(chance.uniform(0, longest * 1.1))
            process.kill()
            process.wait()
            if os.path.exists(target):
                self.assertEqual(contents(target), new, f"loop {i}")
            for left in os.listdir(folder):
                os.unlink(os.path.join(folder, left))

    def test_interrupted_by_hand(self):
        # SIGINT and SIGTERM end the program; the old file is whole.
        self.make_source(160, 120)
        folder, chance = self.fresh("signals"), random.Random(SEED + 3)
        target = os.path.join(folder, "x.png")
        (old, new), longest = self.whole("x.png")
        with open(target, "wb") as f:
            f.write(old)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP) * 4:
            process = program.start(*self.command(target, 1))
            time.sleep(chance.uniform(0, longest))
            process.send_signal(number)
            process.wait()
            self.assertIn(contents(target), (old, new))


def noise_png(width, height):
    chance = random.Random(SEED)
    rows = b"".join(b"\0" + chance.randbytes(width * 3) for _ in range(height))
    return (files.png_header(width, height, 8, 2) + files.png_chunk(b"IDAT", zlib.compress(rows, 1)) + files.png_chunk(b"IEND", b""))


def contents(path):
    with open(path, "rb") as f:
        return f.read()


if __name__ == "__main__":
    program = harness.Program(harness.options().program)
    unittest.main()
