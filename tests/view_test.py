#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The window under Xvfb: opens, plays, stirs, orbits, switches the method, saves, closes; and says so without a display.

    tests/view_test.py GISCHT [--keep FOLDER]      with --keep, screenshots stay there (needs ImageMagick)
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import tomllib
import unittest

GISCHT = os.path.abspath(sys.argv[1]) if len(sys.argv) > 1 else ""
KEEP = pathlib.Path(sys.argv[3]).resolve() if len(sys.argv) > 3 else None
PATIENCE = 120  # s, for what must come; a pass does not wait for it


def without_display():
    return {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}


class Screen:
    """A display that nobody sees."""

    def __enter__(self):
        reading, writing = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writing), "-screen", "0", "1280x720x24", "-nolisten", "tcp"],
            pass_fds=[writing], stderr=subprocess.DEVNULL)
        os.close(writing)
        with os.fdopen(reading) as pipe:
            self.env = dict(os.environ, DISPLAY=":" + pipe.readline().strip())
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()

    def do(self, *words):
        return subprocess.run(["xdotool", *map(str, words)], env=self.env, capture_output=True, text=True, check=False)

    def title(self, name):
        found = self.do("search", "--name", name).stdout.split()
        return found[-1] if found else None

    def keep(self, name):
        if KEEP:
            KEEP.mkdir(parents=True, exist_ok=True)
            subprocess.run(["import", "-window", "root", str(KEEP / name)], env=self.env, check=False)


class View(unittest.TestCase):
    def until(self, holds, what):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if holds():
                return
            time.sleep(0.1)
        self.fail(f"{what} did not come within {PATIENCE} s")

    def saved(self, screen, folder, key, pattern):
        """Presses a key that saves, and gives the new file."""
        def there():  # whole files: those being written have other names
            return {p for p in folder.iterdir() if re.fullmatch(pattern, p.name)}

        before = there()
        screen.do("key", key)
        self.until(lambda: there() - before, pattern)
        return (there() - before).pop()

    def differ(self, a, b):
        """The root mean square of the difference of two pictures."""
        result = subprocess.run([GISCHT, "compare", a, b], capture_output=True, text=True, check=False)
        return result.returncode, result.stdout

    def test_no_display_is_told_in_a_line(self):
        result = subprocess.run([GISCHT, "view", "plume"], env=without_display(), capture_output=True, text=True,
                                timeout=PATIENCE, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stderr.count("\n"), 1)
        self.assertIn("display", result.stderr)

    def test_a_wrong_name_is_told_before_a_window_opens(self):
        result = subprocess.run([GISCHT, "view", "plumme"], env=without_display(), capture_output=True, text=True,
                                timeout=PATIENCE, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertIn("plume", result.stderr)

    def test_it_is_driven(self):
        with Screen() as screen, tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            with open(folder / "log", "w", encoding="utf-8") as log:
                view = subprocess.Popen(
                    [GISCHT, "view", "plume", "--set", "fluid.domain.resolution=32",
                     "--set", "render.slices.resolution=32", "--size", "960x540"],
                    env=screen.env, cwd=folder, stderr=log)
            self.addCleanup(view.wait)
            self.addCleanup(view.kill)
            self.until(lambda: screen.title("gischt: plume"), "the window")
            screen.do("windowfocus", screen.title("gischt: plume"))
            screen.do("mousemove", 600, 250)

            def shown():
                """The frame of a picture that is saved now."""
                text = subprocess.run([GISCHT, "info", picture()], capture_output=True, text=True, check=False).stdout
                return int(re.search(r"frame = (\d+)", text).group(1))

            def picture():
                """Saves one that shows what was done so far."""
                time.sleep(1)
                saved = self.saved(screen, folder, "s", r"plume-\d+\.exr")
                self.assertTrue(saved.with_suffix(".png").exists())  # written before
                return str(saved)

            self.assertEqual(shown(), 1)
            time.sleep(3)  # the final picture grows
            screen.do("key", "Right")  # a step forward
            self.until(lambda: shown() == 2, "frame 2")
            time.sleep(3)
            screen.do("key", "space")  # play
            self.until(lambda: shown() > 4, "frame 5")
            screen.do("key", "f")  # no final picture for now
            screen.keep("playing.png")

            screen.do("mousemove", 480, 430)
            screen.do("keydown", "shift", "mousedown", 1)
            for _ in range(8):  # stir
                screen.do("mousemove_relative", "--", 15, -6)
                time.sleep(0.15)
            screen.keep("stirred.png")
            screen.do("mouseup", 1, "keyup", "shift")
            screen.do("key", "space")  # pause
            time.sleep(2)

            at_rest = picture()
            screen.do("mousemove", 600, 200)
            time.sleep(0.5)
            screen.do("mousedown", 1)
            time.sleep(0.5)
            for _ in range(6):  # orbit
                screen.do("mousemove_relative", "--", 20, 4)
                time.sleep(0.15)
            screen.do("mouseup", 1)
            turned = picture()
            self.assertNotEqual(self.differ(at_rest, turned)[1], self.differ(turned, turned)[1])

            screen.do("key", "2")  # another method
            picture()
            scene = self.saved(screen, folder, "ctrl+s", r"plume-\d+\.toml")
            with open(scene, "rb") as file:
                content = tomllib.load(file)
            self.assertEqual(content["fluid"][0]["domain"]["resolution"], 32)
            self.assertEqual(subprocess.run([GISCHT, "check", scene], capture_output=True, check=False).returncode, 0)

            screen.do("key", "f")  # the final picture grows
            time.sleep(6)
            screen.keep("final.png")
            screen.do("key", "q")
            self.assertEqual(view.wait(PATIENCE), 0, (folder / "log").read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
