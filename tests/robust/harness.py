"""Runs the real program under watch: exit code, what it said, the time and the memory it took."""

import argparse
import ctypes
import os
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unicodedata
from dataclasses import dataclass

HANGS = 60  # seconds after which a run is killed: it hangs. A slow machine takes a tenth of it for the slowest run


@dataclass
class Result:
    code: int  # negative: killed by that signal
    out: bytes
    err: bytes
    seconds: float
    mib: float  # the peak of its resident memory

    def __str__(self):
        return (f"exit code {self.code}, {self.seconds:.2f} s, {self.mib:.0f} MiB, stdout {self.out[:200]!r}, "
                f"stderr {self.err[:600]!r}")


def without_privileges():
    """Runs in the child: takes the right to pass over file permissions away from root. Changes nothing for others."""
    PR_CAPBSET_DROP, CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH = 24, 1, 2
    libc = ctypes.CDLL(None)
    for capability in CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH:
        libc.prctl(PR_CAPBSET_DROP, capability, 0, 0, 0)


def options(*more):
    """The values of --program and of what else a test asks for; unittest's own options are left to it."""
    parser = argparse.ArgumentParser(add_help=False)
    for name in ("--program", *more):
        parser.add_argument(name, required=True)
    found, sys.argv[1:] = parser.parse_known_args()
    return found


class Program:
    def __init__(self, path):
        self.path = os.path.abspath(path)
        self.runs = 0
        self.slowest = self.largest = None
        self.out, self.err = tempfile.TemporaryFile(), tempfile.TemporaryFile()

    def start(self, *arguments, env=None, preexec=None, restore_signals=True, cwd=None):
        for file in self.out, self.err:
            file.seek(0)
            file.truncate()
        settings = {k: v for k, v in os.environ.items() if k not in ("PROBEWARP_BACKEND", "DISPLAY", "WAYLAND_DISPLAY")}
        settings.update(env or {})
        return subprocess.Popen([self.path, *map(os.fsencode, arguments)], stdin=subprocess.DEVNULL, stdout=self.out,
                                stderr=self.err, env=settings, preexec_fn=preexec, restore_signals=restore_signals,
                                cwd=cwd)

    def run(self, *arguments, **settings):
        start = time.monotonic()
        process = self.start(*arguments, **settings)
        watchdog = threading.Timer(HANGS, os.kill, (process.pid, signal.SIGKILL))
        watchdog.start()
        _, status, usage = os.wait4(process.pid, 0)
        watchdog.cancel()
        seconds = time.monotonic() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        for file in self.out, self.err:
            file.seek(0)
        result = Result(process.returncode, self.out.read(1 << 20), self.err.read(1 << 20), seconds, usage.ru_maxrss / 1024)
        self.runs += 1
        return result

    def measured(self, *arguments, **settings):
        """As run; the slowest and the largest are remembered."""
        result = self.run(*arguments, **settings)
        if not self.slowest or result.seconds > self.slowest[0]:
            self.slowest = result.seconds, arguments
        if not self.largest or result.mib > self.largest[0]:
            self.largest = result.mib, arguments
        return result


def one_line(err):
    """What is wrong with these bytes as the one line of a message; None where nothing is."""
    try:
        text = err.decode("utf-8")
    except UnicodeDecodeError:
        return "is not UTF-8"
    if text.count("\n") != 1 or not text.endswith("\n"):
        return "is not exactly one line"
    if any(unicodedata.category(c) == "Cc" for c in text[:-1]):
        return "has control characters"
    if not text.startswith("probewarp: "):
        return "does not begin with 'probewarp: '"
    if len(text) > 6000:
        return "is endless"
    return None


def files_in(folder, folder_times=True):
    """Every file below the folder, with what shows that it was touched. Without `folder_times` it may have been beside
    its place for a while, as a picture is that is written while it is decoded."""
    found = {}
    for place, folders, files in os.walk(folder):
        for name in folders + files:
            path = os.path.join(place, name)
            status = os.lstat(path)
            when = status.st_mtime_ns if folder_times or name in files else None
            found[os.path.relpath(path, folder)] = (status.st_mode, status.st_ino, status.st_size, when)
    return found


def limit_file_size(size):
    """Runs in the child: writing beyond `size` bytes fails."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
