#!/usr/bin/env python3
"""Runs a command with one of the instruction sets: the limit is in its environment.

    under_set.py PROGRAM SET COMMAND...

Where this machine lacks the set, or it is the widest and so what every test runs with anyway, it says so and exits
with 77, which CTest tells as skipped. PROGRAM is the probewarp that is asked.
"""
import json
import os
import subprocess
import sys
import tempfile


def main():
    program, wanted, *command = sys.argv[1:]
    widest, used = used_by(program, None), used_by(program, wanted)
    if used != wanted:
        print(f"skipped: this machine lacks {wanted}")
        sys.exit(77)
    if used == widest:
        print(f"skipped: {wanted} is the widest of this machine's sets, which the other tests run with")
        sys.exit(77)
    sys.exit(subprocess.run(command, env=limited_to(wanted)).returncode)


def limited_to(name):
    settings = dict(os.environ)
    settings.pop("PROBEWARP_INSTRUCTION_SET", None)
    return settings | ({"PROBEWARP_INSTRUCTION_SET": name} if name else {})


def used_by(program, limit):
    """What the program itself says that it uses."""
    with tempfile.NamedTemporaryFile(suffix=".pgm") as picture:
        picture.write(b"P5 1 1 255\n\x00")
        picture.flush()
        done = subprocess.run([program, "info", picture.name, "--json", "--backend", "osmesa"], env=limited_to(limit),
                              stdout=subprocess.PIPE, check=True)
    return json.loads(done.stdout)["instruction_set"]


if __name__ == "__main__":
    main()
