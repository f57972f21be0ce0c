"""`probewarp weights` and what goes with it: what is exported and imported again is the same, maps of any size are read
bilinearly, and what is wrong is said in one sentence. Run: weights_command_test.py PROGRAM"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from png_file import read_png, write_png

PROGRAM = None
IMAGES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "images")
GINGERBREAD = os.path.join(IMAGES, "gingerbread.probewarp")
ONE = 65535


def grey(path):
    width, height, bits, colour, samples = read_png(path)
    assert (bits, colour) == (16, 0), f"{path} is not 16-bit grey"
    return width, height, samples


def bilinear(width, height, samples, x, y):
    """At (x, y), from 0 to 1, of a map; the outermost texels continue to its edge."""
    x = min(max(x * width - 0.5, 0), width - 1)
    y = min(max(y * height - 0.5, 0), height - 1)
    left, top = int(x), int(y)
    right, bottom = min(left + 1, width - 1), min(top + 1, height - 1)
    x, y = x - left, y - top
    upper = samples[top * width + left] * (1 - x) + samples[top * width + right] * x
    lower = samples[bottom * width + left] * (1 - x) + samples[bottom * width + right] * x
    return upper * (1 - y) + lower * y


def noise(count, seed):
    values = []
    for _ in range(count):
        seed = (seed * 1103515245 + 12345) & 0x7FFFFFFF
        values.append(seed >> 8 & ONE)
    return values


class Weights(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="probewarp-weights-")
        self.addCleanup(shutil.rmtree, self.folder)
        self.size = 90, 61
        self.picture = write_png(self.path("picture.png"), *self.size, [s >> 8 for s in noise(90 * 61 * 3, 5)], 8, 2)
        self.probes = "--probe", "20,15", "--probe", "70,20", "--probe", "40,50"

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def run_program(self, *arguments):
        result = subprocess.run([PROGRAM, *map(str, arguments)], stdin=subprocess.DEVNULL, capture_output=True)
        return result.returncode, result.stdout.decode(), result.stderr.decode()

    def run_well(self, *arguments):
        code, out, err = self.run_program(*arguments)
        self.assertEqual((code, err), (0, ""), arguments)
        return out

    def refused(self, expected, *arguments):
        """Returns the sentence."""
        before = sorted(os.listdir(self.folder))
        code, out, err = self.run_program(*arguments)
        self.assertEqual((code, out), (expected, ""), (arguments, err))
        self.assertRegex(err, r"\Aprobewarp: [^\n]+\n\Z")
        self.assertEqual(sorted(os.listdir(self.folder)), before, "something was written")
        return err

    def exported(self, into, *arguments):
        """The names in the folder, and what each file holds, in the probes' order."""
        self.run_well("weights", *arguments, "-o", self.path(into), "--quiet")
        names = sorted(os.listdir(self.path(into)))
        return names, [self.path(into, name) for name in names]

    def assert_same(self, one, other):
        with open(one, "rb") as a, open(other, "rb") as b:
            if a.read() == b.read():
                return
        one, other = grey(one), grey(other)
        self.assertEqual(one[:2], other[:2])
        most = max(abs(a - b) for a, b in zip(one[2], other[2]))
        # The shares sum to 65535 steps in every pixel, so painting them changes nothing.
        self.assertEqual(most, 0, "samples differ")

    def round_trip(self, *document):
        names, first = self.exported("first", *document)
        everything = []
        for number, path in enumerate(first, 1):
            everything += ["--import", f"{number}={path}"]
        again_names, again = self.exported("again", *document, *everything)
        self.assertEqual(again_names, names)
        for a, b in zip(first, again):
            self.assert_same(a, b)
        _, single = self.exported("single", *document, *everything[2:4])
        self.assert_same(first[1], single[1])

    def test_round_trip_of_a_project(self):
        self.round_trip(GINGERBREAD)

    def test_round_trip_of_an_opaque_picture(self):
        self.round_trip(self.picture, *self.probes)

    def test_what_is_written(self):
        out = self.run_well("weights", GINGERBREAD, "-o", self.path("a", "b"), "--size", "120x142")
        names = ["01-Head.png", "02-Left_hand.png", "03-Right_hand.png", "04-Belly.png", "05-Left_foot.png",
                 "06-Right_foot.png"]
        self.assertEqual(out.splitlines(), [self.path("a", "b", name) for name in names])
        self.assertEqual(sorted(os.listdir(self.path("a", "b"))), names)
        maps = [grey(self.path("a", "b", name)) for name in names]
        for width, height, _ in maps:
            self.assertEqual((width, height), (120, 142))
        self.assertEqual({sum(values) for values in zip(*(m[2] for m in maps))}, {ONE})
        head = maps[0][2]  # its rest is at 512, 300 of 1024 x 1210
        self.assertGreater(head[300 * 142 // 1210 * 120 + 60], 0.99 * ONE)

    def test_size_is_the_pictures(self):
        _, paths = self.exported("out", self.picture, *self.probes)
        self.assertEqual(grey(paths[0])[:2], self.size)

    def test_maps_of_any_size(self):
        width, height = self.size
        for across, down in ((45, 30), (7, 5), (1, 1), (200, 3)):
            with self.subTest(size=(across, down)):
                samples = noise(across * down, across)
                write_png(self.path("map.png"), across, down, samples)
                _, paths = self.exported(f"{across}", self.picture, *self.probes, "--import",
                                         f"Probe 2={self.path('map.png')}")
                found = grey(paths[1])[2]
                for y in range(height):
                    for x in range(width):
                        wanted = bilinear(across, down, samples, (x + 0.5) / width, (y + 0.5) / height)
                        # Rounded up or down, and a 64th of a step aside where it is as good as whole.
                        self.assertLess(abs(found[y * width + x] - wanted), 1.02, (x, y))

    def test_alpha_is_where_it_is_painted(self):
        width, height = self.size
        samples = [s for y in range(height) for x in range(width) for s in (200, 255 if x < 30 else 0)]
        write_png(self.path("map.png"), width, height, samples, 8, 4)
        _, bare = self.exported("bare", self.picture, *self.probes)
        _, paths = self.exported("out", self.picture, *self.probes, "--import", f"1={self.path('map.png')}")
        before, after = grey(bare[0])[2], grey(paths[0])[2]
        for y in range(height):
            row = after[y * width:(y + 1) * width]
            self.assertEqual(set(row[:30]), {200 * 257})
            self.assertEqual(row[30:], before[y * width + 30:(y + 1) * width])

    def test_settings_change_the_weights(self):
        seen = set()
        for number, settings in enumerate(((), ("--exponent", "4"), ("--falloff", "2"), ("--most", "1"),
                                           ("--weights", "gaussian"), ("--mesh", "3"))):
            _, paths = self.exported(f"{number}", self.picture, *self.probes, *settings)
            with open(paths[0], "rb") as file:
                seen.add(file.read())
        self.assertEqual(len(seen), 6)

    def test_the_saved_project_holds_the_paint(self):
        write_png(self.path("map.png"), 7, 5, noise(35, 3))
        arguments = self.picture, *self.probes, "--exponent", "3", "--import", f"Probe 3={self.path('map.png')}"
        _, first = self.exported("first", *arguments)
        saved = self.path("saved.probewarp")
        self.assertEqual(self.run_well("weights", *arguments, "--save", saved), "")
        _, second = self.exported("second", saved)
        for a, b in zip(first, second):
            self.assert_same(a, b)
        info = json.loads(self.run_well("info", saved, "--json"))
        self.assertEqual([probe["painted"] for probe in info["probes"]], [False, False, True])
        self.assertEqual(info["weights"], {"scheme": "inverse-distance", "exponent": 3, "falloff": 0, "most": 0})
        self.assertEqual((info["mesh"]["islands"], info["mesh"]["lone_islands"], info["stiffness"]), (1, 0, False))
        self.assertIn("reach 11.25, painted\n", self.run_well("info", saved))

    def named(self, *names):
        """A project with probes of these names."""
        path = self.path("named.probewarp")
        with zipfile.ZipFile(GINGERBREAD) as old, zipfile.ZipFile(path, "w") as new:
            for member in old.infolist():
                data = old.read(member)
                if member.filename == "project.json":
                    project = json.loads(data)
                    for probe, name in zip(project["probes"], names, strict=True):
                        probe["name"] = name
                    data = json.dumps(project)
                new.writestr(member, data)
        return path

    def test_names_fit_every_file_system(self):
        project = self.named("../etc", "a=b", "Größe 2", "Голова", "CON", "\u202e😀.\u00d7?*")
        names, _ = self.exported("out", project, "--size", "9x9")
        self.assertEqual(names, ["01-___etc.png", "02-a_b.png", "03-Größe_2.png", "04-Голова.png", "05-CON.png",
                                 "06-______.png"])

    def test_a_probe_is_found_by_its_name_before_its_number(self):
        white = write_png(self.path("white=.png"), 1, 1, [ONE])
        project = self.named("2", "b", "a=b", "a", "x", "")
        for name, number in (("2", 1), ("b", 2), ("3", 3), ("a=b", 3), ("a", 4)):
            with self.subTest(name=name):
                _, paths = self.exported(f"out {name}", project, "--size", "5x5", "--import", f"{name}={white}")
                self.assertEqual(set(grey(paths[number - 1])[2]), {ONE})

    def test_wrong_maps(self):
        text = self.path("notes.txt")
        with open(text, "w") as file:
            file.write("no picture")
        empty = self.path("empty.png")
        open(empty, "w").close()
        short = self.path("short.png")
        with open(write_png(self.path("map.png"), 9, 9, noise(81, 1)), "rb") as file:
            data = file.read()
        with open(short, "wb") as file:
            file.write(data[:-30])
        for file in text, empty, short, self.path("missing.png"), self.folder:
            with self.subTest(file=file):
                self.assertIn(os.path.basename(file), self.refused(
                    1, "weights", self.picture, *self.probes, "-o", self.path("out"), "--import", f"1={file}"))

    def test_wrong_words(self):
        white = write_png(self.path("white.png"), 1, 1, [ONE])
        out = "-o", self.path("out")
        for name in "Nobody", "0", "4", "-1", "1 ":
            said = self.refused(2, "weights", self.picture, *self.probes, *out, "--import", f"{name}={white}")
            self.assertIn("Probe 1, Probe 2, Probe 3", said)
        for wrong in (("--import", white), ("--import", "=" + white), ("--import", "1="), ("--exponent", "nan"),
                      ("--exponent", "0.4"), ("--falloff", "-1"), ("--falloff", "nan"), ("--most", "-1"),
                      ("--most", "1.5"), ("--alpha-threshold", "255"), ("--alpha-threshold", "1x"),
                      ("--alpha-margin", "nan"), ("--alpha-margin", "1001"), ("--mesh", "0"), ("--weights", "magic"),
                      ("--size", "0x5"), ("--size", "40000x1"), ("--size", "30000x30000"), ("--save", "x.png")):
            with self.subTest(arguments=wrong):
                self.refused(2, "weights", self.picture, *self.probes, *out, *wrong)
        self.refused(2, "weights", self.picture, *self.probes)
        self.assertIn("no probes", self.refused(1, "weights", self.picture, *out))
        self.assertIn("picture.png", self.refused(1, "weights", self.picture, *self.probes, "-o", self.picture))

    def test_the_input_is_not_overwritten(self):
        os.mkdir(self.path("out"))
        name = self.path("out", "02-Probe_2.png")
        shutil.copy(self.picture, name)
        code, _, err = self.run_program("weights", name, *self.probes, "-o", self.path("out"), "--quiet")
        self.assertEqual(code, 2)
        self.assertIn("the input itself", err)
        with open(name, "rb") as kept, open(self.picture, "rb") as picture:
            self.assertEqual(kept.read(), picture.read())

    def test_the_mesh_takes_the_alpha(self):
        # Two blots, 20 pixels apart; a probe in one of them.
        samples = [s for y in range(40) for x in range(80) for s in (9, 9, 9, 100 if 5 <= x < 30 or x >= 50 else 0)]
        picture = write_png(self.path("blots.png"), 80, 40, samples, 8, 6)
        project = self.path("p.probewarp")

        def mesh(*settings):
            self.run_well("render", picture, "--probe", "15,20", "--mesh", "80", "-o", project, *settings)
            return json.loads(self.run_well("info", project, "--json"))["mesh"]

        self.assertEqual([mesh()[key] for key in ("islands", "from_alpha", "threshold", "margin")], [2, True, 0, 2])
        self.assertEqual(mesh("--alpha-margin", "10")["islands"], 1)
        self.assertEqual(mesh("--alpha-threshold", "99", "--alpha-margin", "0")["vertices"], 26 * 41 + 31 * 41)
        self.assertEqual(mesh("--alpha-threshold", "100")["vertices"], 81 * 41)  # nothing is visible: all of it
        whole = mesh("--alpha-threshold", "none")
        self.assertEqual((whole["islands"], whole["from_alpha"], whole["vertices"]), (1, False, 81 * 41))

    def test_the_heat_map(self):
        def rendered(*arguments):
            self.run_well("render", self.picture, "-o", self.path("heat.png"), *arguments)
            width, height, bits, colour, samples = read_png(self.path("heat.png"))
            channels = {2: 3, 6: 4}[colour]
            return [tuple(samples[i:i + 3]) for i in range(0, len(samples), channels)]

        one = "--probe", "45,30"
        plain = rendered(*one)
        self.assertEqual(rendered(*one, "--heat", "Probe 1", "--opacity", "0"), plain)
        # The share of a lone probe is 1 everywhere: the heat map's last colour, and no line.
        self.assertEqual(set(rendered(*one, "--heat", "1", "--opacity", "1", "--iso-lines")), {(0xF0, 0xF9, 0x21)})
        self.assertEqual(set(rendered(*one, "--heat", "all", "--opacity", "1")), {(0xE6, 0x9F, 0x00)})
        # The shader moves the colours along: the same within rounding, but for a pixel of an edge or an iso-line.
        moved = "--probe", "20,15:28,18,30", "--probe", "70,20"
        for heat in ("--heat", "1", "--iso-lines"), ("--heat", "all", "--opacity", "1"):
            pairs = list(zip(rendered(*moved, *heat, "--deform", "shader"), rendered(*moved, *heat)))
            far = sum(max(abs(a - b) for a, b in zip(*pair)) > 2 for pair in pairs)
            self.assertLess(far, len(pairs) / 100)
        self.assertNotEqual(rendered(*self.probes, "--heat", "2"),
                            rendered(*self.probes, "--heat", "2", "--iso-lines"))

    def test_wrong_words_about_the_heat_map(self):
        out = "-o", self.path("out.png")
        for arguments in ((*self.probes, *out, "--iso-lines"), (*self.probes, *out, "--opacity", "0.5"),
                          (*self.probes, *out, "--heat", "1", "--opacity", "1.1"),
                          (*self.probes, *out, "--heat", "1", "--opacity", "nan"),
                          (*self.probes, *out, "--heat", "all", "--iso-lines"),
                          (*self.probes, *out, "--heat", "Nobody"), (*out, "--heat", "all"),
                          (*self.probes, "-o", self.path("out.obj"), "--heat", "1")):
            with self.subTest(arguments=arguments):
                self.refused(2, "render", self.picture, *arguments)


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
