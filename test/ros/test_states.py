#!/usr/bin/python3
"""States of the sand are saved to files in one folder and loaded from there; snapshots outlive a node that is killed at any time."""
import os
import random
import tempfile
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import Point, PointStamped
from sand_test import SCENE, RunningNode, service, wait_until
from shallow_sand.srv import EditSand, EditSandRequest, StateFile
from std_msgs.msg import Header

VOLUME = SCENE["sand"][0]["depth"]


def add_sand(node, depth):
    """Within the walls of the map, so that none is lost."""
    center = PointStamped(Header(frame_id="sand"), Point(0.5, 0.5, 0.0))
    answer = service(node, "edit_sand", EditSand)(center=center, shape=EditSandRequest.RECTANGLE, size_x=0.2, size_y=0.2,
                                                  operation=EditSandRequest.ADD, value=depth)
    assert answer.success, answer.message
    return answer.volume


class States(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = os.path.join(self.temporary.name, "states")
        self.parameters = dict(SCENE, robot_description="", state_folder=self.folder)
        self.seed = random.randrange(2**32)
        print("seed", self.seed)
        self.random = random.Random(self.seed)

    def tearDown(self):
        self.temporary.cleanup()

    def path(self, name="latest.tif"):
        return os.path.join(self.folder, name)

    def content(self, name="latest.tif"):
        with open(self.path(name), "rb") as file:
            return file.read()

    def test_states_are_saved_and_loaded(self):
        with RunningNode("saves", self.parameters) as node:
            save, load = service(node, "save", StateFile), service(node, "load", StateFile)
            grown = add_sand(node, 0.1)
            saved = save("a.tif")
            self.assertTrue(saved.success, saved.message)
            self.assertIn(self.path("a.tif"), saved.message)
            then = node.status()
            grown_later = add_sand(node, 0.2)
            later = node.status(lambda status: status.volume > VOLUME + grown + 0.5 * grown_later)
            self.assertTrue(save("deeper/b.tif").success)
            loaded = load("a.tif")
            self.assertTrue(loaded.success, loaded.message)
            back = node.status(lambda status: status.volume < later.volume - 0.5 * grown_later)
            self.assertAlmostEqual(back.volume, VOLUME + grown, delta=1e-6)
            self.assertAlmostEqual(back.volume_poured, grown, delta=1e-9)
            self.assertLess(back.volume_error, 1e-6)
            self.assertLess(back.simulated_time, then.simulated_time + 3.0)
            self.assertTrue(load("deeper/b.tif").success)
            node.status(lambda status: abs(status.volume - VOLUME - grown - grown_later) < 1e-6)
            node.assert_well(self)
            self.assertEqual(sorted(os.listdir(self.folder)), ["a.tif", "deeper"])

    def test_files_that_are_refused(self):
        outside = os.path.join(self.temporary.name, "outside.tif")
        os.makedirs(self.folder)
        os.symlink(outside, self.path("link.tif"))
        os.symlink(self.temporary.name, self.path("up"))
        with open(outside, "w") as file:
            file.write("precious")
        with open(self.path("text.tif"), "w") as file:
            file.write("This is no state.\n" * 100)
        other_grid = dict(self.parameters, grid={"size": [1.0, 1.0], "spacing": 0.1, "frame": "sand"})
        with RunningNode("other_grid", other_grid) as node:
            self.assertTrue(service(node, "save", StateFile)("coarse.tif").success)
        with RunningNode("refuses", self.parameters) as node:
            save, load = service(node, "save", StateFile), service(node, "load", StateFile)
            self.assertTrue(save("good.tif").success)
            with open(self.path("half.tif"), "wb") as file:
                file.write(self.content("good.tif")[:len(self.content("good.tif")) // 2])
            for name in ("", ".", "..", "/etc/passwd", outside, "../outside.tif", "a/../../outside.tif", "up/outside.tif", "link.tif"):
                for kind in (save, load):
                    answer = kind(name)
                    self.assertFalse(answer.success, name)
                    self.assertIn(name, answer.message)
                    self.assertIn(self.folder, answer.message)
            for name, *words in (("missing.tif",), ("text.tif",), ("half.tif",), ("coarse.tif", "grid.spacing")):
                answer = load(name)
                self.assertFalse(answer.success, name)
                for word in (self.path(name), *words):
                    self.assertIn(word, answer.message)
            self.assertFalse(save("text.tif/x.tif").success)
            node.wait_for_error("~save is refused")
            node.wait_for_error("~load is refused")
            self.assertLessEqual(len(node.error_lines("is refused")), 6)
            node.assert_well(self)
        with open(outside) as file:
            self.assertEqual(file.read(), "precious")

    def test_snapshots_outlive_a_node_that_is_killed(self):
        restoring = dict(self.parameters, snapshot_period=0.02, restore=True)
        volume, restored = VOLUME, -1.0
        for number in range(12):
            with RunningNode(f"killed_{number}", restoring) as node:
                start = node.status()
                self.assertGreater(start.simulated_time, restored, "an older state than was known to be saved")
                self.assertAlmostEqual(start.volume, volume, delta=1e-6)
                self.assertLess(start.volume_error, 1e-6)
                restored = start.simulated_time
                volume += add_sand(node, 0.02)
                # Two snapshots are begun after the sand was added; the first of them is whole when the second is there.
                for _ in range(3):
                    before = os.stat(self.path()).st_mtime_ns if os.path.exists(self.path()) else 0
                    wait_until(lambda: os.path.exists(self.path()) and os.stat(self.path()).st_mtime_ns != before, "a snapshot")
                time.sleep(self.random.uniform(0.0, 0.05))
                node.process.kill()
                node.process.wait(timeout=20)
                self.assertEqual(node.error_lines("restore"), [])
        names = os.listdir(self.folder)
        self.assertIn("latest.tif", names)
        # What was not finished is no more than one part, and is cleared away by whoever saves next.
        self.assertLessEqual(len(names), 2, names)

    def test_broken_snapshots_are_kept_aside(self):
        os.makedirs(self.folder)
        with RunningNode("once", dict(self.parameters, snapshot_period=0.02)) as node:
            wait_until(lambda: os.path.exists(self.path()), "a snapshot")
        good = self.content()
        restoring = dict(self.parameters, restore=True, snapshot_period=0.02)
        for number, broken in enumerate((b"", b"This is no state.", good[:len(good) // 2])):
            with open(self.path(), "wb") as file:
                file.write(broken)
            with RunningNode(f"broken_{number}", restoring) as node:
                start = node.status()
                self.assertEqual(start.simulated_time, 0.0)
                self.assertAlmostEqual(start.volume, VOLUME, delta=1e-6)
                lines = node.wait_for_error("restore", self.path())
                self.assertEqual(len(lines), 1)
                self.assertIn(f"latest.broken{number}.tif", lines[0])
                self.assertEqual(self.content(f"latest.broken{number}.tif"), broken)
                wait_until(lambda: os.path.exists(self.path()), "a new snapshot")
                node.assert_well(self)
        # Without a file the sand starts anew, and nothing is wrong.
        os.remove(self.path())
        with RunningNode("none_yet", dict(self.parameters, restore=True)) as node:
            self.assertEqual(node.status().simulated_time, 0.0)
            self.assertEqual(node.error_lines(), [])

    def test_parameters_that_are_refused(self):
        for number, (changes, *words) in enumerate((
            ({"snapshot_file": "../x.tif"}, "snapshot_file", "../x.tif", self.folder),
            ({"snapshot_period": -1.0}, "snapshot_period", "-1"),
            ({"state_folder": "states"}, "state_folder", "absolute"),
            ({"restore": "maybe"}, "restore", "maybe", "true or false"),
        )):
            with RunningNode(f"refused_{number}", dict(self.parameters, **changes)) as node:
                self.assertEqual(node.process.wait(timeout=20), 2)
                lines = node.error_lines()
                self.assertEqual(len(lines), 1, lines)
                for word in words:
                    self.assertIn(word, lines[0])


if __name__ == "__main__":
    rospy.init_node("test_states")
    rostest.rosrun("shallow_sand", "states", States)
