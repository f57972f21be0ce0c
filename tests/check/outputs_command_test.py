"""What `probewarp render` writes besides pixels: an OBJ with its material and its texture, a report, what a picture that
ends too soon still holds; and that an option which means nothing for an output is refused, never passed over.
Run: outputs_command_test.py PROGRAM"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from png_file import CHANNELS, read_png, write_png

PROGRAM = None


def contents(path):
    with open(path, "rb") as file:
        return file.read()


def with_shadow(width, height):
    """RGBA: an opaque block in the middle, and a faint frame around it far from the block."""
    samples = []
    for y in range(height):
        for x in range(width):
            block = abs(2 * x - width) < width // 3 and abs(2 * y - height) < height // 3
            samples += [200, x, y, 255 if block else 30 if x < 3 or y < 2 or x >= width - 3 or y >= height - 2 else 0]
    return samples


class Outputs(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="probewarp-outputs-")
        self.addCleanup(shutil.rmtree, self.folder)
        self.picture = write_png(self.path("cat.png"), 60, 40, with_shadow(60, 40), 8, 6)
        self.probe = "--probe", "30,20:33,22,10"

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def run_program(self, *arguments, **settings):
        done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=120, **settings)
        return done.returncode, done.stdout, done.stderr

    def run_well(self, *arguments, **settings):
        code, out, err = self.run_program(*arguments, **settings)
        self.assertEqual((code, err), (0, ""))
        return out

    def refused(self, *arguments, says, code=2):
        """One line, and nothing written."""
        before = {name: contents(self.path(name)) for name in os.listdir(self.folder)}
        got, out, err = self.run_program(*arguments)
        self.assertEqual((got, out, err.count("\n")), (code, "", 1), err)
        self.assertIn(says, err)
        self.assertEqual({name: contents(self.path(name)) for name in os.listdir(self.folder)}, before)

    # ---- options ----

    GIVEN = {"--scale": "2", "--size": "20x20", "--samples": "2", "--canvas": "fit", "--background": "white",
             "--compression": "small", "--heat": "1", "--backend": "osmesa", "--deform": "processor"}

    def test_an_option_is_obeyed_or_refused(self):
        for ending in "png", "jpg", "bmp", "tga", "obj", "probewarp":
            plain = self.path("plain." + ending)
            self.run_well("render", self.picture, *self.probe, "-o", plain)
            for option, value in self.GIVEN.items():
                with self.subTest(ending=ending, option=option):
                    output = self.path("with." + ending)
                    arguments = "render", self.picture, *self.probe, "-o", output, option, value
                    if ending in ("obj", "probewarp") or (option == "--compression" and ending != "png"):
                        kind = {"obj": "OBJ", "probewarp": "a project", "jpg": "JPEG"}.get(ending, ending.upper())
                        self.refused(*arguments, says=f"{option}: has no meaning for {kind}; expected ")
                        continue
                    self.run_well(*arguments)
                    if option not in ("--backend", "--deform"):
                        self.assertNotEqual(contents(output), contents(plain))
                    os.unlink(output)

    def test_the_usual_value_is_refused_too(self):
        for option, value in ("--scale", "1"), ("--canvas", "image"), ("--background", "none"), ("--samples", "1"):
            for arguments in (option, value), (f"{option}={value}",):
                self.refused("render", self.picture, "-o", self.path("x.obj"), *arguments, says=f"{option}: has no meaning")
        self.refused("render", self.picture, "-o", self.path("x.bmp"), "--compression", "default", says="expected png")
        self.refused("render", self.picture, "-o", "-", "--format", "obj", "--scale", "2", says="--scale: has no meaning")

    def test_what_the_environment_says_is_not_refused(self):
        environment = dict(os.environ, PROBEWARP_BACKEND="osmesa")
        self.run_well("render", self.picture, "-o", self.path("x.obj"), env=environment)
        code, _, err = self.run_program("render", self.picture, "-o", self.path("y.obj"), "--backend", "osmesa",
                                        env=environment)
        self.assertEqual(code, 2, err)

    def test_weights_have_no_size_where_no_maps_are_written(self):
        save = self.path("x.probewarp")
        self.refused("weights", self.picture, *self.probe, "--save", save, "--size", "10x10", says="expected -o FOLDER")
        self.run_well("weights", self.picture, *self.probe, "--save", save, "-o", self.path("maps"), "--size", "10x10",
                      "--quiet")

    # ---- OBJ ----

    def check_mesh(self, obj):
        """It and its material name what is there; it stands upright and faces the viewer. Returns the texture's path."""
        v, vt, f, library = [], [], [], None
        for line in contents(obj).decode().splitlines():
            words = line.split()
            if words[0] == "mtllib":
                library = line.split(" ", 1)[1]
            elif words[0] in ("v", "vt"):
                (v if words[0] == "v" else vt).append([float(word) for word in words[1:]])
            elif words[0] == "f":
                f.append([int(word.split("/")[0]) - 1 for word in words[1:]])
        self.assertGreater(len(f), 100)
        top, bottom = (pick(range(len(vt)), key=lambda i: vt[i][1]) for pick in (max, min))
        self.assertGreater(v[top][1], v[bottom][1])
        for a, b, c in f:
            area = (v[b][0] - v[a][0]) * (v[c][1] - v[a][1]) - (v[b][1] - v[a][1]) * (v[c][0] - v[a][0])
            self.assertGreater(area, 0)
        self.assertNotIn(" ", library)
        material = contents(os.path.join(os.path.dirname(obj), library)).decode().splitlines()
        maps = dict(line.split(" ", 1) for line in material if line.startswith("map_"))
        self.assertEqual(maps["map_Kd"], maps["map_d"])
        return os.path.join(os.path.dirname(obj), maps["map_Kd"])

    def test_an_obj_comes_with_its_picture(self):
        obj = self.path("cat.obj")
        self.run_well("render", self.picture, *self.probe, "-o", obj)
        self.assertEqual(sorted(os.listdir(self.folder)), ["cat-texture.png", "cat.mtl", "cat.obj", "cat.png"])
        self.assertEqual(read_png(self.check_mesh(obj)), read_png(self.picture))

    def test_so_does_that_of_a_project(self):
        project, obj = self.path("cat.probewarp"), self.path("my cat.obj")
        self.run_well("render", self.picture, *self.probe, "-o", project)
        os.mkdir(self.path("elsewhere"))
        os.rename(project, self.path("elsewhere", "moved.probewarp"))
        self.run_well("render", self.path("elsewhere", "moved.probewarp"), "-o", obj)
        texture = self.check_mesh(obj)
        self.assertEqual(os.path.basename(texture), "my_cat-texture.png")
        self.assertEqual(read_png(texture), read_png(self.picture))

    def test_on_standard_output_it_comes_alone(self):
        text = self.run_well("render", self.picture, *self.probe, "-o", "-", "--format", "obj", cwd=self.folder)
        self.assertNotIn("mtl", text)
        self.assertIn("\nf ", text)
        self.assertEqual(os.listdir(self.folder), ["cat.png"])

    def test_what_comes_with_it_replaces_nothing(self):
        shutil.copy(self.picture, self.path("a-texture.png"))
        self.refused("render", self.path("a-texture.png"), "-o", self.path("a.obj"), says="this is the input itself")
        with open(self.path("b.mtl"), "w") as file:
            file.write("newmtl fur\n")
        self.refused("render", self.picture, "-o", self.path("b.obj"), says="b.mtl: would be written with b.obj", code=1)

    # ---- report ----

    def test_the_report_tells_where_the_canvas_lies(self):
        output = self.path("out.png")
        moved = "--probe", "30,20:42,11"
        line = self.run_well("render", self.picture, *moved, "-o", output, "--canvas", "fit", "--scale", "2", "--report")
        report = json.loads(line)
        self.assertEqual(line.count("\n"), 1)
        width, height, _, channels, pixels = self.decoded(output)
        self.assertEqual((report["output"], report["format"], report["width"], report["height"]),
                         (output, "png", width, height))
        self.assertEqual((report["picture"], report["incomplete"], report["companions"]), ("cat.png", False, []))
        self.assertEqual(report["scale"], [2, 2])
        self.assertEqual(report["offset"], [2 * value for value in report["origin"]])
        self.assertEqual((report["folded_triangles"], report["cancelled_vertices"]), (0, 0))
        # On the picture's own rectangle the same pixels lie where the report says.
        own = self.path("own.png")
        own_line = self.run_well("render", self.picture, *moved, "-o", own, "--scale", "2", "--report")
        self.assertEqual(json.loads(own_line)["offset"], [0, 0])
        own_width, own_height, _, own_channels, own_pixels = self.decoded(own)
        dx, dy = report["offset"]
        seen = 0
        for y in range(own_height):
            for x in range(own_width):
                pixel = own_pixels[own_channels * (y * own_width + x):][:own_channels]
                if pixel[3] == 0:
                    continue
                seen += 1
                self.assertTrue(0 <= x - dx < width and 0 <= y - dy < height, (x, y))
                at = channels * ((y - dy) * width + x - dx)
                self.assertEqual(pixels[at:at + channels], pixel)
        self.assertGreater(seen, 100)

    def decoded(self, path):
        width, height, bits, colour, samples = read_png(path)
        return width, height, bits, CHANNELS[colour], samples

    def test_the_report_of_other_outputs(self):
        for ending, format in ("obj", "obj"), ("probewarp", "probewarp"), ("jpg", "jpeg"):
            output = self.path("out." + ending)
            report = json.loads(self.run_well("render", self.picture, "--probe", "25,20:40,20", "--probe", "35,20:20,20",
                                              "-o", output, "--report"))
            self.assertEqual((report["output"], report["format"]), (output, format))
            self.assertGreater(report["folded_triangles"], 0)
            self.assertEqual(report["companions"],
                             [self.path(name) for name in ("out-texture.png", "out.mtl")] if ending == "obj" else [])

    def test_the_folds_are_those_of_the_mesh(self):
        probes = "--probe", "25,20:40,20", "--probe", "35,20:20,20"
        report = json.loads(self.run_well("render", self.picture, *probes, "-o", self.path("x.obj"), "--report"))
        v, f = [], []
        for line in contents(self.path("x.obj")).decode().splitlines():
            words = line.split()
            if words[0] == "v":
                v.append([float(word) for word in words[1:3]])
            elif words[0] == "f":
                f.append([v[int(word.split("/")[0]) - 1] for word in words[1:]])
        turned = sum((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < -1e-5 for a, b, c in f)
        self.assertLess(abs(report["folded_triangles"] - turned), 3)  # of hardly any area
        self.assertGreater(turned, 50)
        project = self.path("x.probewarp")
        self.run_well("render", self.picture, *probes, "-o", project)
        self.assertEqual(json.loads(self.run_well("info", project, "--json"))["folded_triangles"],
                         report["folded_triangles"])
        self.assertIn(f"triangles that lie folded over: {report['folded_triangles']}\n", self.run_well("info", project))

    def test_a_line_for_each_of_many(self):
        other = write_png(self.path("dog.png"), 30, 50, with_shadow(30, 50), 8, 6)
        with open(self.path("bad.png"), "w") as file:
            file.write("no picture")
        code, out, err = self.run_program("render", self.picture, *self.probe, "--image", self.picture, self.path("bad.png"),
                                          other, "-o", self.path("out", "{name}.png"), "--report")
        self.assertEqual((code, err.count("\n")), (1, 1), err)
        self.assertEqual([(line["output"], line["width"]) for line in map(json.loads, out.splitlines())],
                         [(self.path("out", "cat.png"), 60), (self.path("out", "dog.png"), 30)])

    def test_no_report_where_the_file_goes(self):
        self.refused("render", self.picture, "-o", "-", "--format", "png", "--report", says="--report")

    # ---- what the mesh leaves out ----

    def test_nothing_vanishes(self):
        for threshold in "0", "50":
            images = []
            for place in "30,20", "30.001,20":
                output = self.path("x.png")
                self.run_well("render", self.picture, "--alpha-threshold", threshold, "--probe", f"30,20:{place}", "-o", output)
                images.append(self.decoded(output)[4])
            self.assertEqual([a for a in images[0][3::4]], [a for a in images[1][3::4]])

    # ---- salvage ----

    def test_what_ends_too_soon_is_opened_where_that_is_asked_for(self):
        cut = self.path("cut.png")
        noise = bytes(zlib.crc32(bytes([i & 255, i >> 8])) & 255 for i in range(60 * 40 * 4))
        write_png(cut, 60, 40, list(noise), 8, 6)
        whole = contents(cut)
        with open(cut, "wb") as file:
            file.write(whole[:len(whole) * 3 // 4])
        hint = "; --salvage opens what is there\n"
        out = self.path("out.png")
        self.refused("info", cut, says=hint, code=1)
        self.refused("render", cut, "-o", out, says=hint, code=1)
        self.refused("render", self.picture, "--image", cut, "-o", out, says=hint, code=1)
        self.refused("weights", cut, *self.probe, "-o", self.path("maps"), says=hint, code=1)
        several = "render", self.picture, "--image", self.picture, cut, "-o", self.path("out", "{name}.png")
        code, _, err = self.run_program(*several)
        self.assertEqual((code, err.count("\n"), hint in err), (1, 1, True), err)
        self.assertFalse(json.loads(self.run_well("info", self.picture, "--json"))["incomplete"])
        self.assertTrue(json.loads(self.run_well("info", cut, "--json", "--salvage"))["incomplete"])
        self.assertIn(", incomplete\n", self.run_well("info", cut, "--salvage"))
        report = json.loads(self.run_well("render", cut, "-o", out, "--salvage", "--report"))
        self.assertTrue(report["incomplete"])
        self.assertEqual(self.decoded(out)[4][:400], list(noise[:400]))
        self.run_well("weights", cut, *self.probe, "-o", self.path("maps"), "--salvage", "--quiet")
        self.run_well(*several, "--salvage")
        self.assertTrue(os.path.exists(self.path("out", "cut.png")))


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
