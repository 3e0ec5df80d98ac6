#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the world does to a program: signals, full disks, little memory, closed streams, a second process. gischt ends with one clear line
and the status that docs/cli.md promises, and leaves nothing half done.

Usage: hard_knocks_test.py PATH_OF_GISCHT [TestCase[.test_name]]
"""
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

GISCHT = None
SMALL = ["--set", "domain.resolution=32", "--size", "48x32", "--spp", "1"]
CLOUD = ["cloud", "--set", "fluid.resolution=24", "--size", "64x48"]
NOBODY = 65534
# Seconds within which a signal is answered; twice the second that is promised, as tests share their machine.
AT_ONCE = 2.0


class KnocksCase(unittest.TestCase):
    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="gischt-"))
        self.dir.chmod(0o755)
        self.addCleanup(shutil.rmtree, self.dir)

    def start(self, *arguments, **options):
        return subprocess.Popen([GISCHT, *map(str, arguments)], cwd=self.dir, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)

    def run_gischt(self, *arguments, status=0, **options):
        options.setdefault("capture_output", True)
        done = subprocess.run([GISCHT, *map(str, arguments)], cwd=self.dir, timeout=300, **options)
        self.assertEqual(done.returncode, status, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return (done.stderr or b"").decode()

    def refused(self, status, *arguments, **options):
        """The one line that was said."""
        said = self.run_gischt(*arguments, "-q", status=status, **options)
        self.assertEqual(len(said.splitlines()), 1, said)
        return said

    def files(self, folder="."):
        return sorted(p.relative_to(self.dir).as_posix() for p in (self.dir / folder).rglob("*") if p.is_file())


class Signals(KnocksCase):
    def stops(self, seconds, *arguments, by=signal.SIGINT):
        process = self.start(*arguments)
        try:
            said = process.communicate(timeout=seconds)
            self.fail(f"{arguments} was done within {seconds} s: {said}")
        except subprocess.TimeoutExpired:
            pass
        asked = time.monotonic()
        process.send_signal(by)
        said = process.communicate(timeout=60)[1].decode()
        taken = time.monotonic() - asked
        # Before main() has begun the system ends it, which a shell calls 130 too.
        self.assertIn(process.returncode, (130, -by), f"{arguments}\n{said}")
        self.assertLess(taken, AT_ONCE, arguments)
        return taken

    def test_simulation_stops_and_keeps_its_state(self):
        flags = ["sim", "plume", "--set", "domain.resolution=128", "--frames", "1-99", "-o", "c"]
        for by in (signal.SIGINT, signal.SIGTERM):
            self.stops(2.5, *flags, by=by)
            left = [f for f in self.files() if not f.endswith((".vdb", ".state", "scene.toml"))]
            self.assertEqual(left, [])
        self.assertIn("c/smoke.state", self.files())

    def test_pictures_stop(self):
        for method in ("path", "march", "zonal", "photon"):
            self.stops(1.2, "render", "cloud", "--method", method, "--spp", 4096, "-o", "x.exr")
            self.assertEqual(self.files(), [])

    def test_a_second_signal_ends_it_too(self):
        process = self.start("render", "cloud", "--spp", 4096, "-o", "x.exr", "-q")
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=20)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(self.files(), [])


class SignalsLong(Signals):
    """Each command that can take long, at several moments."""

    def test_every_method(self):
        listed = subprocess.run([GISCHT, "methods"], capture_output=True, text=True, check=True).stdout
        methods = [w for w in ("path", "bdpt", "mlt", "march", "photon", "zonal", "diffusion") if w in listed]
        for method in methods:
            for seconds in (0.4, 1.5, 4):
                self.stops(seconds, "render", "cloud", "--method", method, "--spp", 100000, "-o", "x.exr")
                self.assertEqual(self.files(), [])

    def test_photons_and_zones(self):
        for scene, method in (("volume-caustic", "photon"), ("glass-smoke", "photon"), ("misty-court", "zonal")):
            for seconds in (1, 3):
                self.stops(seconds, "render", scene, "--method", method, "--spp", 100000, "-o", "x.exr")

    def test_flipbook_and_ladder(self):
        for seconds in (1, 3):
            self.stops(seconds, "flipbook", "plume", "--frames", "1-48", "--spp", 256, "--cache", "c", "-o", "a.png")
            self.stops(seconds, "ladder", "cloud", "--spp", 256, "-o", "l")

    def test_reading_and_converting_volumes(self):
        self.run_gischt("sim", "plume", "--set", "domain.resolution=256", "--frames", "1-1", "-o", "c", "-q")
        process = self.start("info", "c/smoke_0001.vdb")  # writes nothing: the signal's own way to end it
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=AT_ONCE)
        self.assertIn(process.returncode, (0, -signal.SIGINT))

    def test_denoising(self):
        self.run_gischt("render", "cloud", "--set", 'film.aovs=["variance"]', "--set", "fluid.resolution=24", "--size", "1280x720", "--spp", 4,
                        "-o", "n.exr", "-q")
        self.stops(1, "denoise", "n.exr", "-o", "d.exr")
        self.assertEqual(self.files(), ["n.exr"])


class Disk(KnocksCase):
    def limited(self, *arguments, most=4096):
        """With a limit on the size of files, which stands for a full disk."""
        before = self.files()
        said = self.refused(4, *arguments, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))
        left = [f for f in self.files() if f not in before and not f.endswith((".vdb", ".state", "scene.toml"))]
        self.assertEqual(left, [], arguments)
        return said

    def test_files_that_cannot_grow(self):
        self.assertIn("c/smoke_0001.vdb", self.limited("sim", "plume", "--set", "domain.resolution=32", "--frames", "1-2", "-o", "c"))
        for name in ("x.png", "x.exr", "x.hdr", "x.film"):
            self.assertIn(name, self.limited("render", *CLOUD, "--spp", 1, "-o", name, most=2000))
        self.limited("render", "plume", *SMALL, "--frames", "1-2", "-o", "x.mp4", most=500)
        self.limited("flipbook", "plume", "--set", "domain.resolution=32", "--cell", "24x16", "--spp", 1, "--frames", "1-2", "-o", "b.png", most=300)

    def test_state_that_cannot_grow(self):
        # The frame fits, the state of 32^3 cells does not.
        said = self.limited("sim", "plume", "--set", "domain.resolution=32", "--frames", "1-2", "-o", "c", most=300_000)
        self.assertIn("smoke.state", said)
        self.run_gischt("sim", "plume", "--set", "domain.resolution=32", "--frames", "1-2", "-o", "c")

    def test_full_disk(self):
        place = self.dir / "small"
        place.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", place], capture_output=True).returncode != 0:
            self.skipTest("only root may mount a small disk")
        try:
            said = self.refused(4, "sim", "plume", "--set", "domain.resolution=64", "--frames", "1-9", "-o", place / "c")
            self.assertIn("small/c", said)
            hidden = [f for f in self.files("small") if pathlib.Path(f).name.startswith(".")]
            self.assertEqual(hidden, [])
            self.refused(4, "render", *CLOUD[:3], "--size", "640x480", "--spp", 1, "-o", place / "x.film")
        finally:
            subprocess.run(["umount", place], check=True)

    def test_folders_that_may_not_be_written(self):
        closed = self.dir / "closed"
        closed.mkdir()
        closed.chmod(0o555)
        as_other = {"preexec_fn": lambda: os.setuid(NOBODY)} if os.getuid() == 0 else {}
        if as_other and subprocess.run([GISCHT, "--version"], capture_output=True, **as_other).returncode != 0:
            self.skipTest("others may not run this program")
        for arguments in (["sim", "plume", *SMALL[:2], "--frames", "1-1", "-o", "closed"],
                          ["sim", "plume", *SMALL[:2], "--frames", "1-1", "-o", "closed/c"],
                          ["render", *CLOUD, "--spp", 1, "-o", "closed/x.png"],
                          ["run", "plume", *SMALL, "--frames", "1-1", "-o", "closed/r"]):
            self.assertIn("closed", self.refused(4, *arguments, **as_other))
        # Told before the work: this would take hours.
        begin = time.monotonic()
        self.refused(4, "render", "cloud", "--spp", 1_000_000, "-o", "closed/x.exr", **as_other)
        self.assertLess(time.monotonic() - begin, 20)
        # Whose frames are all there may be looked at where nothing can be written.
        self.run_gischt("sim", "plume", *SMALL[:2], "--frames", "1-1", "-o", "c", "-q")
        (self.dir / "c").chmod(0o555)
        self.dir.chmod(0o777)
        self.run_gischt("render", "c", "--frames", 1, "--size", "32x24", "--spp", 1, "-o", "x.png", **as_other)
        (self.dir / "c").chmod(0o755)

    def test_paths_of_the_wrong_kind(self):
        (self.dir / "folder.png").mkdir()
        (self.dir / "file").write_text("mine")
        self.assertIn("folder.png", self.refused(2, "render", *CLOUD, "--spp", 1, "-o", "folder.png"))
        self.assertIn("file", self.refused(4, "sim", "plume", "--frames", "1-1", "-o", "file"))
        self.assertEqual((self.dir / "file").read_text(), "mine")


class Memory(KnocksCase):
    def setUp(self):
        super().setUp()
        # The libraries take memory and threads before main(): what is less than that is not for gischt to answer.
        self.least = next(m for m in range(100, 1000, 20) if self.limited(m, "methods").returncode == 0)

    def limited(self, megabytes, *arguments):
        most = megabytes << 20
        return subprocess.run([GISCHT, *map(str, arguments)], cwd=self.dir, capture_output=True, timeout=300,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (most, most)))

    def with_megabytes(self, megabytes, *arguments):
        done = self.limited(self.least + megabytes, *arguments, "-q")
        said = done.stderr.decode()
        self.assertIn(done.returncode, (0, 4), f"{megabytes} MB: {arguments}\n{said}")
        if done.returncode == 4:
            self.assertEqual(len(said.splitlines()), 1, f"{megabytes} MB: {arguments}\n{said}")
        return done.returncode

    def sweep(self, limits, *arguments):
        outcomes = [self.with_megabytes(m, *arguments) for m in limits]
        self.assertIn(4, outcomes, arguments)
        left = [f for f in self.files() if pathlib.Path(f).name.startswith(".") and not f.endswith("/.lock")]
        self.assertEqual(left, [])

    def test_simulation(self):
        self.sweep((0, 60), "sim", "plume", "--set", "domain.resolution=128", "--frames", "1-1", "-o", "c", "--restart")

    def test_pictures(self):
        self.sweep((20, 100), "render", "cloud", "--size", "8000x6000", "--spp", 1, "--time", "1s", "-o", "x.exr")


class MemoryLong(Memory):
    def test_every_limit(self):
        for arguments in (["sim", "plume", "--set", "domain.resolution=128", "--frames", "1-1", "-o", "c", "--restart"],
                          ["render", "cloud", "--size", "1000x800", "--spp", 1, "-o", "x.exr", "--restart"],
                          ["render", "volume-caustic", "--method", "photon", "--spp", 1, "--size", "64x48", "-o", "x.exr"]):
            self.sweep(range(0, 600, 20), *arguments)


class Streams(KnocksCase):
    def run_shell(self, redirection, *arguments):
        line = " ".join([GISCHT, *map(str, arguments), redirection])
        return subprocess.run(["bash", "-c", line], cwd=self.dir, capture_output=True, text=True, timeout=120)

    def test_closed_streams_get_no_file(self):
        for redirection in (">&-", "2>&-", "<&- >&- 2>&-"):
            done = self.run_shell(redirection, "render", *CLOUD, "--spp", 1, "-o", "a.png")
            self.assertEqual(done.returncode, 0, redirection)
            self.run_gischt("info", "a.png")

    def test_a_listener_that_goes_away(self):
        self.assertEqual(self.run_shell("--progress json 2>&1 >/dev/null | head -c 1; exit ${PIPESTATUS[0]}", "sim", "plume", *SMALL[:2], "--frames",
                                        "1-5", "-o", "c").returncode, 0)
        self.assertIn("c/smoke_0005.vdb", self.files())
        done = self.run_shell("| head -c 10 >/dev/null; exit ${PIPESTATUS[0]}", "doc")
        self.assertIn(done.returncode, (0, 128 + signal.SIGPIPE))
        self.assertEqual(done.stderr, "")

    def test_results_that_cannot_be_told(self):
        for arguments in (["doc"], ["scenes"], ["methods"], ["scenes", "plume"]):
            done = self.run_shell("> /dev/full", *arguments)
            self.assertEqual(done.returncode, 4, arguments)
            self.assertEqual(len(done.stderr.splitlines()), 1)

    def test_no_home(self):
        self.run_gischt("render", *CLOUD, "--spp", 1, "-o", "a.png", env={})


class Processes(KnocksCase):
    def wait_for(self, path):
        for _ in range(600):
            if (self.dir / path).exists():
                return
            time.sleep(0.02)
        self.fail(f"{path} did not come")

    def test_one_cache_has_one_writer(self):
        flags = ["sim", "plume", "--set", "domain.resolution=64", "-o", "c"]
        first = self.start(*flags, "--frames", "1-500", "-q")
        try:
            self.wait_for("c/smoke_0001.vdb")
            begin = time.monotonic()
            said = self.refused(2, *flags, "--frames", "1-500")
            self.assertIn(f"process {first.pid} ", said)
            self.assertLess(time.monotonic() - begin, AT_ONCE)
            # Who only looks at what is there may.
            self.run_gischt("render", "c", "--frames", 1, "--size", "32x24", "--spp", 1, "-o", "x.png")
            self.assertIn("writes to this cache", self.refused(2, "render", "c", "--frames", 499, "-o", "y.png"))
        finally:
            first.kill()
            first.communicate()
        self.run_gischt(*flags, "--frames", "1-2")
        self.assertEqual([f for f in self.files("c") if pathlib.Path(f).name.startswith(".")], [])

    def test_what_killed_ones_left_is_removed(self):
        (self.dir / "c").mkdir()
        (self.dir / "c/.smoke_0007.gischt-999999999-1.vdb").write_text("half")
        self.run_gischt("sim", "plume", *SMALL[:2], "--frames", "1-1", "-o", "c")
        self.assertEqual(self.files(), ["c/scene.toml", "c/smoke.state", "c/smoke_0001.vdb"])

    def test_statistics_of_a_resumed_run_are_of_what_it_did(self):
        flags = ["sim", "plume", *SMALL[:2], "-o", "c", "--stats", "s.json"]
        self.run_gischt(*flags, "--frames", "1-2")
        self.run_gischt(*flags, "--frames", "1-3")
        self.assertEqual([f["frame"] for f in json.loads((self.dir / "s.json").read_text())["frames"]], [3])


if __name__ == "__main__":
    GISCHT = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
