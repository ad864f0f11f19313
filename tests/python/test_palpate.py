"""The Python module: the same numbers as the programs, from every way in. Usage: test_palpate.py PROGRAMS ROOT"""

import csv
import os
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np

import palpate

PROGRAMS, ROOT = sys.argv[1:3]
MALLET = os.path.join(ROOT, "config", "scenes", "ellipsoid_mallet_springs.toml")


def command(*words):
    done = subprocess.run([os.path.join(PROGRAMS, "palpate"), *words], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


class Wall:
    """A device whose hand follows a script: down into the body, along it, and up; its own compliance is none."""

    def __init__(self, lost=()):
        self.calls, self.lost, self.felt_N = 0, set(lost), []

    def __call__(self, time_s, force_N, torque_Nm):
        self.felt_N.append(float(np.linalg.norm(force_N)))
        self.calls += 1
        if self.calls in self.lost:
            return None
        down = 0.090 - 0.030 * min(time_s, 0.6, max(0.0, 1.2 - time_s)) / 0.6
        return [-0.010 + 0.01 * time_s, down, 0.0]


class Module(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = palpate.Scene(MALLET)
        cls.folder = tempfile.TemporaryDirectory()
        cls.recording = os.path.join(cls.folder.name, "driven.plr")
        cls.wall = Wall(lost=[700])
        cls.driven = cls.scene.drive(cls.wall, 1.3, record=cls.recording)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def test_press_gives_the_numbers_of_the_command(self):
        table = self.path("forces.csv")
        code, said = command("press", MALLET, "--out", table)
        self.assertEqual(code, 0, said)
        with open(table, encoding="ascii") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        ticks = self.scene.press().ticks
        self.assertEqual(len(rows), len(ticks))
        self.assertGreater(ticks["contact_force_N"].max(), 0.5)
        for axis, name in enumerate("xyz"):
            told = np.array([float(row[f"f{name}_N"]) for row in rows])
            # The table has nine digits or fewer.
            np.testing.assert_allclose(told, ticks["contact_force_N"][:, axis], rtol=1e-6, atol=1e-9)

    def test_a_recording_reads_as_it_was_made_and_as_it_replays(self):
        recording = palpate.Recording(self.recording)
        self.assertEqual((recording.damage, recording.lost), ("", 0))
        self.assertEqual(recording.header["scene_hash"], self.scene.hash)
        self.assertEqual(recording.ticks.tobytes(), self.driven.ticks.tobytes())
        self.assertEqual(recording.regions.tobytes(), self.driven.regions.tobytes())
        said, replayed = recording.replay()
        self.assertTrue(said["identical"], said)
        self.assertEqual(replayed.ticks.tobytes(), recording.ticks.tobytes())
        self.assertEqual(replayed.regions.tobytes(), recording.regions.tobytes())

    def test_numpy_reads_what_the_replay_command_writes(self):
        """Every field of every tick and region, bit for bit; tests/host/test_record_csv.cpp holds the same for C++."""
        ticks, regions = self.path("ticks.csv"), self.path("regions.csv")
        code, said = command("replay", self.recording, "--dump", ticks, "--dump-regions", regions)
        self.assertEqual(code, 0, said)
        recording = palpate.Recording(self.recording)
        self.assertGreater(len(recording.regions), 100)
        for path, rows in ((ticks, recording.ticks), (regions, recording.regions)):
            with open(path, encoding="ascii") as file:
                table = list(csv.DictReader(file))
            self.assertEqual(len(table), len(rows))
            left = set(table[0])
            for name in rows.dtype.names:
                values = rows[name].reshape(len(rows), -1)
                count = values.shape[1]
                parts = {1: [""], 3: ["_x", "_y", "_z"], 4: ["_w", "_x", "_y", "_z"]}.get(
                    count, [f"_{i}" for i in range(count)])
                for i, part in enumerate(parts):
                    told = np.array([rows.dtype[name].base.type(row[name + part]) for row in table])
                    self.assertEqual(told.tobytes(), values[:, i].tobytes(), name + part)
                    left.remove(name + part)
            self.assertEqual(left, set())

    def test_a_device_feels_the_body_and_nothing_before_it(self):
        felt = np.array(self.wall.felt_N)
        self.assertEqual(felt[:100].max(), 0)  # 85 mm above: nothing touched yet
        self.assertGreater(felt.max(), 0.5)
        self.assertLess(felt[-1], 1e-9)
        np.testing.assert_array_equal(np.linalg.norm(self.driven.ticks["device_force_N"][:-1], axis=1), felt[1:])
        self.assertLessEqual(felt.max(), self.scene.params["force_max_N"] * (1 + 1e-9))
        self.assertEqual(self.driven.ticks["stale_ticks"].max(), 1)
        self.assertIn("SampleBridged", palpate.bits(self.driven.ticks["status"][699]))

    def test_regions_add_up_to_the_contact(self):
        deep = self.driven.ticks[np.argmax(self.driven.ticks["penetration_m"])]
        regions = palpate.Recording(self.recording).regions_of(deep["sequence"])
        self.assertEqual(len(regions), deep["region_count"])
        np.testing.assert_allclose(regions["force_w"].sum(axis=0), deep["contact_force_N"], rtol=1e-12, atol=1e-12)

    def test_a_silent_device_is_a_fault_and_no_force(self):
        silent = Wall(lost=range(650, 10_000))
        ended = self.scene.drive(silent, 2.0).ticks[-1]
        self.assertIn("DeviceSilent", palpate.bits(ended["fault"], palpate.FAULT_BITS))
        self.assertLess(silent.calls, 1_000)

    def test_a_run_is_the_programs_own_and_repeats(self):
        first, second = self.path("one.plr"), self.path("two.plr")
        looks = []
        summary = palpate.run(MALLET, 0.5, record=first, programs=PROGRAMS, goes_on=lambda: looks.append(1) or True)
        palpate.run(MALLET, 0.5, record=second, programs=PROGRAMS)
        self.assertGreater(len(looks), 5)
        self.assertEqual(summary["fault"], 0)
        hashes = [palpate.Recording(path).ticks["state_hash"] for path in (first, second)]
        self.assertGreaterEqual(len(hashes[0]), 490)
        np.testing.assert_array_equal(*(h[:490] for h in hashes))

    def test_a_run_is_watched_while_it_goes_on(self):
        door, recording = self.path("door"), self.path("watched.plr")
        run = subprocess.Popen([os.path.join(PROGRAMS, "palpate"), "run", MALLET, "--device", "loopback", "--duration",
                                "1.5", "--telemetry", door, "--record", recording], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True)
        try:
            while not os.path.exists(door) and run.poll() is None:
                time.sleep(0.01)
            telemetry = palpate.Telemetry(door)
            self.assertFalse(telemetry.has_ended)
            self.assertEqual(telemetry.header["scene_hash"], self.scene.hash)
            seen = list(telemetry.follow())
        finally:
            said = run.communicate(timeout=60)[0]
        self.assertEqual(run.returncode, 0, said)
        self.assertTrue(telemetry.has_ended)
        self.assertGreater(len(seen), 3, "while it ran, and not all of it at the end")
        recorded = palpate.Recording(recording)
        self.assertEqual((telemetry.lost, recorded.lost), (0, 0))
        for parts, whole in (([part.ticks for part in seen], recorded.ticks),
                             ([part.regions for part in seen], recorded.regions)):
            self.assertTrue(b"".join(part.tobytes() for part in parts) == whole.tobytes())  # padding included
        self.assertEqual(telemetry.newest.ticks.tobytes(), recorded.ticks[-1:].tobytes())

    def test_the_tick_by_itself(self):
        controller = palpate.Controller(self.scene)
        self.assertEqual(len(controller.last.ticks), 0)
        rest = controller.surface_m
        np.testing.assert_array_equal(rest, self.scene.vertices_m)
        poses = np.array([[-0.010, 0.090 - 0.0001 * i, 0] for i in range(220)])
        for pose in poses:
            controller.tick(pose)
        pressed = self.scene.press(poses)
        self.assertEqual(controller.last.ticks["state_hash"][0], pressed.ticks["state_hash"][-1])
        self.assertEqual(controller.state_hash, pressed.ticks["state_hash"][-1])
        self.assertGreater(np.abs(controller.surface_m - rest).max(), 1e-4)
        controller.reset()
        self.assertEqual(len(controller.last.ticks), 0)

    def test_softer_is_softer(self):
        soft = palpate.Scene(MALLET, settings={"body.material.youngs_modulus_Pa": 3e5})
        self.assertEqual(soft.params["youngs_modulus_Pa"], 3e5)
        self.assertNotEqual(soft.hash, self.scene.hash)
        self.assertLess(soft.press().ticks["contact_force_N"].max(), self.scene.press().ticks["contact_force_N"].max())

    def test_an_image_is_the_one_the_command_bakes(self):
        mine, theirs = self.path("mine.pal"), self.path("theirs.pal")
        palpate.bake(MALLET, mine)
        code, said = command("bake", MALLET, "-o", theirs)
        self.assertEqual(code, 0, said)
        with open(mine, "rb") as a, open(theirs, "rb") as b:
            self.assertEqual(a.read(), b.read())
        self.assertEqual(palpate.Scene(mine).hash, self.scene.hash)

    def test_mistakes_are_told(self):
        for wrong, error, words in (
            (lambda: palpate.Scene("/nonexistent.toml"), RuntimeError, "/nonexistent.toml"),
            (lambda: palpate.Scene(MALLET, settings={"body.colour": 1}), RuntimeError, "body.colour"),
            (lambda: palpate.Recording(MALLET), RuntimeError, ""),
            (lambda: palpate.Telemetry("./no.telemetry"), RuntimeError, "./no.telemetry"),
            (lambda: palpate.Telemetry(os.getpid()), RuntimeError, str(os.getpid())),
            (lambda: self.scene.press(np.zeros((3, 2))), ValueError, "(3, 2)"),
            (lambda: self.scene.press([[np.nan, 0, 0]]), ValueError, "finite"),
            (lambda: palpate.Controller(self.scene).tick([0, 0]), ValueError, "pose"),
            (lambda: palpate.run("/nonexistent.toml", programs=PROGRAMS), RuntimeError, "/nonexistent.toml"),
        ):
            with self.assertRaises(error) as caught:
                wrong()
            self.assertIn(words, str(caught.exception))

    def test_every_name_and_field_is_explained(self):
        self.assertEqual(set(palpate.TICK_DTYPE.names), set(palpate.TICK_FIELDS))
        self.assertEqual(set(palpate.REGION_DTYPE.names), set(palpate.REGION_FIELDS))
        for name in palpate.__all__:
            thing = getattr(palpate, name)
            if callable(thing):
                self.assertTrue(thing.__doc__, name)
                for member, value in vars(thing).items():
                    if callable(value) and not member.startswith("_") and member not in Exempt:
                        self.assertTrue(value.__doc__, f"{name}.{member}")


Exempt = {"count", "index"}  # of a tuple

if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
