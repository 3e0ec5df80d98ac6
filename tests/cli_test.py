#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The contract of the command line: results, exit statuses, messages, and that no half file is ever left behind.

Usage: cli_test.py PATH_OF_GISCHT [TestCase.test_name]
"""
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

GISCHT = None
SMALL = ["--set", "domain.resolution=32", "--size", "48x32", "--spp", "1"]


class CliCase(unittest.TestCase):
    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="gischt-"))
        self.addCleanup(shutil.rmtree, self.dir)

    def run_gischt(self, *arguments, status=0):
        done = subprocess.run([GISCHT, *map(str, arguments)], cwd=self.dir, capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, status, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def files(self):
        return sorted(p.relative_to(self.dir).as_posix() for p in self.dir.rglob("*") if p.is_file())

    def write(self, name, content):
        path = self.dir / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path


class Usage(CliCase):
    def test_version_help_and_lists(self):
        self.assertIn("gischt", self.run_gischt("--version").stdout)
        self.assertIn("render", self.run_gischt("--help").stdout)
        scenes = self.run_gischt("scenes").stdout
        for name in ("plume", "smoke-2d", "jets", "cloud"):
            self.assertIn(name, scenes)
        self.assertIn("march", self.run_gischt("methods").stdout)
        self.assertIn("1/m", self.run_gischt("doc", "medium.extinction").stdout)
        json.loads(self.run_gischt("doc", "--json-schema").stdout)

    def test_printed_scene_is_a_scene(self):
        self.write("mine.toml", self.run_gischt("scenes", "plume").stdout)
        self.run_gischt("check", "mine.toml")

    def test_unknown_words_name_the_nearest(self):
        self.assertIn("did you mean 'render'", self.run_gischt("rendr", "x", status=2).stderr)
        self.assertIn("did you mean 'plume'", self.run_gischt("check", "plum", status=2).stderr)
        self.assertIn("did you mean 'march'", self.run_gischt("render", "cloud", "--method", "mrach", status=2).stderr)
        self.assertIn("did you mean 'medium'", self.run_gischt("check", "plume", "--set", "medum.g=0", status=2).stderr)

    def test_bad_flags(self):
        for flags in (["--frames", "5-2"], ["--size", "axb"], ["--size", "0x9"], ["--spp", "0"], ["--time", "soon"],
                      ["--samples", "4:2"], ["--preset", "lava"], ["--nonsense"]):
            self.run_gischt("render", "cloud", "-o", "x.png", *flags, status=2)
        self.run_gischt("render", "cloud", "-o", "x.jpg", status=2)
        self.run_gischt(status=2)
        self.assertEqual(self.files(), [])


class BadScenes(CliCase):
    def fails(self, text, *words):
        self.write("bad.toml", text)
        error = self.run_gischt("check", "bad.toml", status=2).stderr
        for word in words:
            self.assertIn(word, error)

    def test_messages_name_place_fact_and_mend(self):
        self.fails('[[fluid]]\ntype = "smoke"\nviscosty = 3\n', "bad.toml:3:1", "viscosty", "did you mean")
        self.fails('[fluid]\ntype = "smoke"\n[fluid.domain]\nresolution = "big"\n', "bad.toml:4", "whole number")
        self.fails('[fluid]\ntype = "smoke"\n[fluid.domain]\nresolution = -4\n', "bad.toml:4", "resolution")
        self.fails('[fluid]\ntype = "smok"\n', "did you mean 'smoke'")
        self.fails("frames = [1,\n", "bad.toml:")
        self.fails("\x00\xff\xfe", "bad.toml")
        self.fails("[film]\nwidth = 0\n", "width")

    def test_impossible_sizes_are_refused_before_the_work(self):
        self.fails('[fluid]\ntype = "smoke"\n[fluid.domain]\nmin = [1,1,1]\nmax = [0,2,2]\n', "domain")

    def test_missing_scene(self):
        self.run_gischt("run", "nowhere.toml", status=2)
        self.assertEqual(self.files(), [])


class BadInputs(CliCase):
    def test_broken_volumes(self):
        self.run_gischt("sim", "plume", "--set", "domain.resolution=32", "--frames", "1-1", "-o", "c")
        whole = (self.dir / "c/smoke_0001.vdb").read_bytes()
        shutil.rmtree(self.dir / "c")
        noise = random.Random(1)
        broken = {"empty.vdb": b"", "noise.vdb": noise.randbytes(5000), "head.vdb": whole[:200], "half.vdb": whole[: len(whole) // 2],
                  "tail.vdb": whole[:-9]}
        for name, content in broken.items():
            self.write(name, content)
            for command in (["render", name, "-o", "x.png"], ["info", name]):
                error = self.run_gischt(*command, status=3).stderr
                self.assertIn(name, error)
        self.run_gischt("render", "missing.vdb", "-o", "x.png", status=3)
        self.assertEqual(self.files(), sorted(broken))

    def test_empty_grids(self):
        self.write("still.toml", """frames = [1, 1]
[fluid]
type = "smoke"
[fluid.domain]
resolution = 16
[[light]]
type = "constant"
radiance = 0.5
[film]
width = 32
height = 24
""")
        self.run_gischt("sim", "still.toml", "-o", "c")
        self.assertIn("0 active voxels", self.run_gischt("info", "c/fluid_0001.vdb").stdout)
        # A bare one has nothing to show, and says so; with fire as well.
        for flags in ([], ["--preset", "fire"], ["--preset", "smoke", "--method", "path"]):
            self.assertIn("c/fluid_0001.vdb", self.run_gischt("render", "c/fluid_0001.vdb", *flags, status=3).stderr)
        self.assertFalse((self.dir / "fluid_0001.png").exists())
        # In a scene it is empty air before the sky.
        for method in ("march", "path"):
            self.run_gischt("render", "c", "--method", method, "--spp", 2, "-o", f"{method}.exr")
            self.run_gischt("render", "still.toml", "--set", "fluid.file=c/fluid_0001.vdb", "--method", method, "--spp", 2, "-o",
                            f"{method}_file.exr")
            self.run_gischt("compare", f"{method}.exr", f"{method}_file.exr", "--tol", 0)
        self.run_gischt("compare", "march.exr", "path.exr", "--tol", 1e-6)
        self.run_gischt("render", "cloud", "--set", "fluid.file=c/fluid_0001.vdb", "--size", "32x24", "--spp", 1, "-o", "sky.png")
        for quantity in ("density", "temperature"):
            self.run_gischt("render", "c", "--method", "field", "--set", f"render.field.quantity={quantity}", "-o", f"{quantity}.png")

    def test_broken_images(self):
        self.write("a.png", b"not a picture")
        self.write("a.exr", b"\x76\x2f\x31\x01")
        for name in ("a.png", "a.exr", "b.png"):
            self.run_gischt("compare", name, name, status=3)

    def test_unwritable_output(self):
        self.write("file", b"")
        self.run_gischt("render", "cloud", *SMALL[2:], "--set", "fluid.resolution=16", "-o", "file/x.png", status=4)
        self.assertEqual(self.files(), ["file"])


class Work(CliCase):
    def test_run_makes_frames_pictures_and_a_film(self):
        self.run_gischt("run", "plume", *SMALL, "--frames", "1-3", "-o", "p", "--stats", "s.json")
        expected = ["p/plume.mp4"] + [f"p/plume_000{i}.png" for i in (1, 2, 3)] + [f"p/smoke_000{i}.vdb" for i in (1, 2, 3)]
        for name in expected:
            self.assertIn(name, self.files())
        stats = json.loads((self.dir / "s.json").read_text())
        for key in ("version", "command", "scene_hash", "threads", "wall_seconds", "peak_memory_bytes", "phases"):
            self.assertIn(key, stats)
        self.assertEqual([f["frame"] for f in stats["frames"]], [1, 2, 3])
        for frame in stats["frames"]:
            self.assertGreater(frame["mass"], 0)
            self.assertGreaterEqual(frame["steps"], 1)
            self.assertLess(frame["pressure_residual"], 1e-2)
        self.assertIn("command = gischt run plume", self.run_gischt("info", "p/plume_0001.png").stdout)
        # A second run computes nothing again.
        self.run_gischt("run", "plume", *SMALL, "--frames", "1-3", "-o", "p", "--stats", "s.json")
        self.assertEqual(json.loads((self.dir / "s.json").read_text())["frames"], [])
        # Another look at the cache leaves its scene alone.
        scene = (self.dir / "p/scene.toml").read_text()
        self.run_gischt("render", "p", "--exposure", "2", "-o", "bright.png")
        self.assertEqual((self.dir / "p/scene.toml").read_text(), scene)
        # Another simulation may not mix with it.
        self.run_gischt("run", "plume", *SMALL, "--set", "seed=5", "--frames", "1-3", "-o", "p", status=2)

    def test_a_preview_is_coarse_and_keeps_to_itself(self):
        flags = ["--set", "domain.resolution=40", "--size", "48x32", "--frames", "1-2"]
        self.run_gischt("run", "plume", *flags, "--spp", 1, "-o", "p")
        final = {name: (self.dir / name).read_bytes() for name in self.files()}
        for command in (["run", "plume", "-o", "p"], ["sim", "plume", "-o", "p"], ["render", "plume", "--cache", "p", "-o", "x.png"]):
            self.run_gischt(*command, "--preview", *flags[:2], *(flags[2:] if command[0] != "sim" else flags[4:]))
        for name, content in final.items():
            self.assertEqual((self.dir / name).read_bytes(), content, name)
        self.assertIn("p/preview/plume.mp4", self.files())
        cells = [self.run_gischt("info", f"{folder}/smoke_0001.vdb").stdout for folder in ("p", "p/preview")]
        self.assertIn("0.1 m", cells[0])
        self.assertIn("0.2 m", cells[1])
        # The folder of the final frames is still what it says.
        self.run_gischt("render", "p", "--preview", "-o", "y.png", *flags[2:4])

    def test_threads_give_the_same_bytes(self):
        for threads in (1, 2):
            self.run_gischt("run", "plume", *SMALL, "--frames", "1-4", "-o", f"t{threads}", "--threads", threads)
        for name in ("smoke_0004.vdb", "plume_0004.png"):
            a, b = (self.dir / f"t{t}" / name for t in (1, 2))
            if name.endswith(".vdb"):
                self.assertEqual(a.read_bytes(), b.read_bytes(), name)
            else:
                self.run_gischt("compare", "--tol", 0, a, b)

    def test_stop_and_resume_give_the_same_bytes(self):
        flags = ["--set", "domain.resolution=48", "--frames", "1-16"]
        self.run_gischt("sim", "plume", *flags, "-o", "whole")
        for _ in range(3):
            process = subprocess.Popen([GISCHT, "sim", "plume", *flags, "-o", "parts", "-q"], cwd=self.dir)
            time.sleep(0.7)
            process.send_signal(signal.SIGINT)
            self.assertIn(process.wait(timeout=30), (0, 130))
        self.run_gischt("sim", "plume", *flags, "-o", "parts")
        for i in range(1, 17):
            name = f"smoke_{i:04}.vdb"
            self.assertEqual((self.dir / "whole" / name).read_bytes(), (self.dir / "parts" / name).read_bytes(), name)
        leftovers = [f for f in self.files() if not f.endswith((".vdb", ".state", "scene.toml"))]
        self.assertEqual(leftovers, [])

    def test_bare_volume_and_compare(self):
        self.run_gischt("sim", "plume", "--set", "domain.resolution=32", "--frames", "1-20x1", "-o", "c")
        done = self.run_gischt("render", "c/smoke_0020.vdb", "-o", "a.png", "--size", "64x48", "--spp", 2)
        self.assertIn("assumed", done.stderr)
        self.run_gischt("render", "c", "-o", "b.exr", "--size", "64x48", "--spp", 2, "--frames", "20")
        self.run_gischt("compare", "a.png", "a.png", "--tol", 0)
        self.run_gischt("compare", "a.png", "b.exr", "--tol", 0, status=1)
        self.assertIn("density", self.run_gischt("info", "c/smoke_0020.vdb").stdout)
        self.assertIn("20 frames", self.run_gischt("info", "c").stdout)

    def test_flipbook_of_a_scene_and_of_its_cache(self):
        small = ["--cell", "24x16", "--spp", "1", "--frames", "1-5", "--loop", "1", "--grid", "3x2"]
        self.run_gischt("flipbook", "plume", "--set", "domain.resolution=32", *small, "--cache", "cache", "--fit", "-o", "a.png")
        sheets = [f"a_{s}.png" for s in ("color", "depth", "light_a", "light_b", "motion")]
        self.assertEqual([f for f in self.files() if f.startswith("a")], sorted(["a.json", *sheets]))
        about = json.loads((self.dir / "a.json").read_text())
        self.assertEqual((about["cells"], about["sheet"]), (4, {"width": 72, "height": 32}))
        # The same from the cache, on one thread: the same pictures.
        self.run_gischt("flipbook", "cache", *small, "--fit", "--threads", "1", "--layers", "color,depth", "-o", "b.png", "-o", "b.exr")
        for sheet in ("color", "depth"):
            self.run_gischt("compare", f"a_{sheet}.png", f"b_{sheet}.png", "--tol", "0")
        self.assertIn("--grid", self.run_gischt("flipbook", "cache", "--grid", "1x2", "--frames", "1-5", status=2).stderr)
        self.assertIn("'light'", self.run_gischt("flipbook", "cache", "--layers", "ligth", status=2).stderr)

    def test_particles_go_between_vdb_and_ply(self):
        sets = ["--set", "domain.resolution=24", "--frames", "1-3", "-q"]
        self.run_gischt("sim", "fountain", "-o", "a", *sets, "--threads", "1")
        self.run_gischt("sim", "fountain", "-o", "b", *sets, "--threads", "2")
        last = "water_0003.vdb"
        self.assertEqual((self.dir / "a" / last).read_bytes(), (self.dir / "b" / last).read_bytes())
        line = [x for x in self.run_gischt("info", f"a/{last}").stdout.splitlines() if "points with" in x][0]
        count = line.split()[1]
        for name in ("age", "id", "life", "pscale", "v"):
            self.assertIn(name, line)

        self.run_gischt("convert", f"a/{last}", "-o", "drops.ply")
        self.assertIn(f"{count} points", self.run_gischt("info", "drops.ply").stdout)
        self.run_gischt("convert", "drops.ply", "-o", "drops.vdb", "--cell", "0.1")
        back = self.run_gischt("info", "drops.vdb").stdout
        self.assertIn(f"{count} points", back)
        self.assertIn("density", back)
        self.run_gischt("render", "drops.ply", "--set", "up=z", "-o", "drops.png", "--size", "32x24", "--spp", "1")
        self.run_gischt("convert", "a/water_####.vdb", "--frames", "1-3", "-o", "c.ply")
        self.assertTrue(all((self.dir / f"c_000{i}.ply").exists() for i in (1, 2, 3)))

        self.assertIn("did you mean '.ply'", self.run_gischt("convert", "drops.ply", "-o", "x.plt", status=2).stderr)
        self.run_gischt("convert", "missing.ply", "-o", "x.vdb", status=3)
        self.write("mesh.ply", "ply\nformat ascii 1.0\nelement face 0\nend_header\n")
        self.assertIn("no points", self.run_gischt("convert", "mesh.ply", "-o", "x.vdb", status=3).stderr)
        self.assertFalse((self.dir / "x.vdb").exists())

    def test_bad_particles_are_refused_by_name(self):
        for change, word in (
            ("motion=inertal", "did you mean 'inertial'"),
            ("contact.kind=bonce", "did you mean 'bounce'"),
            ("flow.fluid=smoke", "no fluid 'smoke'"),
            ("fluid.water.source.0.shape=disk", "did you mean 'disc'"),
            ("fluid.water.source.0.rates=3", "did you mean 'rate'"),
            ("fluid.water.source.0.speed=nan", "speed"),
            ("most_particles=10", "raise 'most_particles'"),
        ):
            out = self.dir / change.split("=")[0]
            done = self.run_gischt("sim", "fountain", "-o", out, "--frames", "1-1", "--set", change, status=2)
            self.assertIn(word, done.stderr, change)

    def test_cloud_takes_a_real_volume(self):
        self.run_gischt("render", "cloud", "--set", "fluid.resolution=24", "--size", "32x20", "--spp", 1, "-o", "a.exr")
        self.run_gischt("sim", "plume", "--set", "domain.resolution=32", "--frames", "1-8", "-o", "c")
        self.run_gischt("render", "cloud", "--set", "fluid.file=c/smoke_0008.vdb", "--size", "32x20", "--spp", 1, "-o", "b.exr")

    def picture_of_small_cloud(self, *flags):
        self.run_gischt("render", "cloud", "--set", "fluid.resolution=32", "-o", "x.exr", "--stats", "s.json", *flags)
        return json.loads((self.dir / "s.json").read_text())["images"][0]

    def test_time_limit(self):
        # The light's grids and a first sample of every pixel are always made: how long they take depends on the machine.
        first = self.picture_of_small_cloud("--size", "480x270", "--spp", 1)["wall_seconds"]
        picture = self.picture_of_small_cloud("--size", "480x270", "--spp", 100000, "--time", "3s")
        self.assertGreater(picture["wall_seconds"], 3)
        self.assertLess(picture["wall_seconds"], 3 + 2 * first + 1)
        self.assertGreater(picture["samples_per_pixel"], 1)
        self.assertLess(picture["samples_per_pixel"], 100000)

    def test_noise_limit(self):
        rough, fine = (self.picture_of_small_cloud("--size", "96x64", "--spp", 4096, "--noise", noise) for noise in (0.05, 0.01))
        self.assertLessEqual(rough["noise"], 0.05)
        self.assertLessEqual(fine["noise"], 0.01)
        self.assertLess(rough["samples_per_pixel"], fine["samples_per_pixel"])
        self.assertLess(fine["samples_per_pixel"], 4096)

    def test_field_pictures(self):
        self.run_gischt("render", "smoke-2d", "--set", "domain.resolution=48", "--frames", "4", "-o", "f.png")
        self.assertEqual(self.files(), ["f.png"])

    def test_interrupted_render_leaves_whole_files_only(self):
        process = subprocess.Popen([GISCHT, "render", "cloud", "--spp", "4096", "-o", "x.exr", "-q"], cwd=self.dir)
        time.sleep(2.5)
        asked = time.time()
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=20), 130)
        self.assertLess(time.time() - asked, 5)
        self.assertEqual(self.files(), [])


class Films(CliCase):
    SCENE = ["cloud", "--set", "fluid.resolution=24", "--set", "film.height=32", "--set", "film.width=48"]

    def render(self, *arguments, status=0):
        return self.run_gischt("render", *self.SCENE, *arguments, status=status)

    def pixels_of(self, name):
        """The bytes of a film behind its head, which tells the command."""
        return (self.dir / name).read_bytes()[-48 * 32 * 30:-8]

    def test_parts_merge_to_the_bits_of_the_whole(self):
        self.render("--spp", 64, "-o", "whole.exr", "-o", "whole.film")
        parts = []
        for first in (48, 0, 32, 16):
            parts.append(f"p{first}.film")
            self.render("--samples", f"{first}:{first + 16}", "-o", parts[-1], "--threads", 1 + first // 16 % 2)
        self.run_gischt("merge", *parts, "-o", "sum.exr", "-o", "sum.film", "-o", "sum.png")
        self.run_gischt("compare", "sum.exr", "whole.exr", "--tol", 0)
        self.assertEqual(self.pixels_of("sum.film"), self.pixels_of("whole.film"))
        self.assertIn("samples 0:64\n", self.run_gischt("info", "sum.film").stdout)
        # The sum can be gone on with; the same samples cannot be counted twice.
        self.render("--spp", 72, "-o", "sum.film", "-o", "more.exr")
        self.render("--spp", 72, "-o", "fresh.exr")
        self.run_gischt("compare", "more.exr", "fresh.exr", "--tol", 0)
        error = self.run_gischt("merge", parts[0], parts[0], "-o", "x.exr", status=3).stderr
        self.assertIn("48:64", error)
        self.assertFalse((self.dir / "x.exr").exists())

    def test_interrupted_renders_go_on_to_the_same_bits(self):
        for flags in (["--spp", 1500], ["--noise", "0.006"]):
            self.render(*flags, "-o", "whole.exr", "--restart")
            stops = 0
            for attempt in range(4):
                process = subprocess.Popen([GISCHT, "render", *self.SCENE, *map(str, flags), "-o", "x.film", "-o", "x.exr", "-q"],
                                           cwd=self.dir)
                time.sleep(0.5 + 0.3 * attempt)
                process.send_signal((signal.SIGINT, signal.SIGTERM)[attempt % 2])
                stops += process.wait(timeout=30) == 130
            self.assertGreater(stops, 0)
            self.render(*flags, "-o", "x.film", "-o", "x.exr")
            self.run_gischt("compare", "x.exr", "whole.exr", "--tol", 0)
            self.assertEqual(self.files(), ["whole.exr", "x.exr", "x.film"])
            (self.dir / "x.film").unlink()

    def test_films_of_other_pictures_are_refused(self):
        self.render("--spp", 2, "-o", "a.film")
        for other in (["--seed", 5], ["--set", "film.width=32"], ["--set", "fluid.seed=7"]):
            self.render("--spp", 4, "-o", "a.film", *other, status=2)
            self.render("--samples", "2:4", "-o", "b.film", *other)
            self.run_gischt("merge", "a.film", "b.film", "-o", "x.film", status=3)
            (self.dir / "b.film").unlink()
        self.render("--spp", 1, "-o", "a.film", status=2)  # it has more already
        self.render("--spp", 1, "-o", "a.film", "--restart")
        self.render("--samples", "8:9", "-o", "a.film", status=2)
        # What only shows the picture may change.
        self.render("--spp", 2, "-o", "a.film", "-o", "a.png", "--exposure", 1)
        whole = (self.dir / "a.film").read_bytes()
        for name, content in {"empty.film": b"", "short.film": whole[:-100], "noise.film": b"x" * 500}.items():
            self.write(name, content)
            for command in (["render", *self.SCENE, "-o", name], ["merge", "a.film", name, "-o", "y.film"], ["info", name]):
                self.assertIn(name, self.run_gischt(*command, status=3).stderr)
        self.run_gischt("render", "smoke-2d", "--set", "domain.resolution=16", "--frames", 1, "-o", "f.film", status=2)
        self.run_gischt("merge", "a.film", "-o", "y.jpg", status=2)

    def test_layers_of_an_exr(self):
        self.render("--spp", 4, "--set", 'film.aovs=["all"]', "-o", "a.exr")
        channels = self.run_gischt("info", "a.exr").stdout.splitlines()[0]
        for name in ("samples.Y", "variance.Y", "transmittance.R"):
            self.assertIn(name, channels)
        error = self.render("--spp", 1, "--set", 'film.aovs=["indirect"]', "-o", "a.exr", status=2).stderr
        self.assertIn("indirect", error)
        error = self.render("--spp", 1, "--set", 'film.aovs=["smaples"]', "-o", "a.exr", status=2).stderr
        self.assertIn("did you mean 'samples'", error)

    def test_time_limit_is_kept(self):
        self.render("--time", "2s", "-o", "a.exr", "--stats", "s.json")
        seconds = json.loads((self.dir / "s.json").read_text())["images"][0]["wall_seconds"]
        self.assertGreater(seconds, 1.9)
        self.assertLess(seconds, 3)


class Paths(CliCase):
    SCENE = ["cloud", "--method", "path", "--set", "fluid.resolution=24", "--size", "32x20"]

    def render(self, *arguments, status=0):
        return self.run_gischt("render", *self.SCENE, *arguments, status=status)

    def test_killed_renders_go_on_to_the_same_bits(self):
        flags = ["--spp", 600]
        self.render(*flags, "-o", "whole.exr", "--threads", 1)

        def stop(how, after):
            process = subprocess.Popen([GISCHT, "render", *self.SCENE, *map(str, flags), "-o", "x.film", "-o", "x.exr", "-q",
                                        "--threads", "2"], cwd=self.dir, stderr=subprocess.DEVNULL)
            time.sleep(after)
            process.send_signal(how)
            return process.wait(timeout=30)

        # One that is asked to stop leaves its film; what is killed has no time to say good-bye.
        wait = 0.5
        while "x.film" not in self.files():
            self.assertEqual(stop(signal.SIGTERM, wait), 130)
            wait += 0.5
        for _ in range(2):
            self.assertEqual(stop(signal.SIGKILL, wait), -signal.SIGKILL)
        done = self.run_gischt("info", "x.film").stdout
        self.assertNotIn("samples 0:600\n", done)
        self.render(*flags, "-o", "x.film", "-o", "x.exr", "--threads", 2)
        self.run_gischt("compare", "x.exr", "whole.exr", "--tol", 0)
        self.assertEqual(self.files(), ["whole.exr", "x.exr", "x.film"])

    def test_parts_merge_to_the_bits_of_the_whole(self):
        self.render("--spp", 64, "-o", "whole.exr", "--threads", 2)
        for first in (48, 0, 32, 16):
            self.render("--samples", f"{first}:{first + 16}", "-o", f"p{first}.film", "--threads", 1 + first // 16 % 2)
        self.run_gischt("merge", "p48.film", "p0.film", "p32.film", "p16.film", "-o", "sum.exr")
        self.run_gischt("compare", "sum.exr", "whole.exr", "--tol", 0)

    def test_what_it_cannot_do_is_refused_by_name(self):
        self.write("bulb.toml", """[[solid]]
name = "bulb"
type = "sphere"
material = "dielectric"
[solid.medium]
extinction = 1
[[light]]
name = "candle"
type = "point"
position = [0, -2, 0]
[render]
method = "path"
""")
        error = self.run_gischt("render", "bulb.toml", "-o", "x.exr", status=2).stderr
        for word in ("candle", "bulb", "no size", "sphere", "march"):
            self.assertIn(word, error)


if __name__ == "__main__":
    GISCHT = os.path.abspath(sys.argv[1])
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
