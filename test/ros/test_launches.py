#!/usr/bin/python3
"""Launch files for the ways people use the node do what they say."""
import math
import os
import subprocess
import tempfile
import time
import unittest

import rosbag
import rospy
import rostest
from geometry_msgs.msg import Point, PointStamped
from sand_test import Place, World, link, robot, transform
from shallow_sand.msg import Status
from shallow_sand.srv import EditSand
from std_msgs.msg import Header
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage


class Launched:
    """roslaunch of one of our launch files, as users call it."""

    def __init__(self, name, **arguments):
        self.log = tempfile.NamedTemporaryFile("w+", suffix=".log")
        self.process = subprocess.Popen(["roslaunch", "shallow_sand", name + ".launch"]
                                        + [f"{key}:={value}" for key, value in arguments.items()],
                                        stdout=self.log, stderr=subprocess.STDOUT)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()
        self.log.close()

    def stop(self):
        if self.process.poll() is None:
            self.process.send_signal(2)
        self.process.wait(timeout=30)

    def status(self, topic, condition=lambda status: True, limit=40.0):
        deadline = time.monotonic() + limit
        while time.monotonic() < deadline and self.process.poll() is None:
            try:
                status = rospy.wait_for_message(topic, Status, timeout=5.0)
            except rospy.ROSException:
                continue
            if condition(status):
                return status
        with open(self.log.name) as log:
            raise AssertionError(f"no such status on {topic} within {limit} s:\n" + log.read())


class WallWorld(World):
    """Transforms with stamps of the wall clock, and no /clock."""

    def run(self):
        while not self.stopped.wait(self.WALL_STEP):
            now = time.time()
            self.tf.publish(TFMessage([transform(f, place(now), now) for f, place in self.frames.items()]))


class Launches(unittest.TestCase):
    def test_several_in_namespaces(self):
        with Launched("several") as launched:
            for side in ("left", "right"):
                status = launched.status(f"/{side}/sand_node/status", lambda status: status.simulated_time > 0.0)
                self.assertEqual(status.header.frame_id, side + "/sand")

    def test_a_dem(self):
        with Launched("dem", band="rock", depth=0.3) as launched:
            status = launched.status("/sand_node/status")
            self.assertAlmostEqual(status.volume_start, 0.3 * 8.0 * 6.0, delta=1e-3)
            self.assertEqual(status.cells, 160 * 120)

    def test_recorded_and_replayed(self):
        rospy.set_param("/robot_description", robot("digger", link("blade")))
        scene = tempfile.NamedTemporaryFile("w", suffix=".yaml")
        scene.write("grid: {size: [1.0, 1.0], spacing: 0.05, frame: sand}\nsand: [{depth: 0.1}]\nbackend: cpu\nthreads: 1\n")
        scene.flush()
        folder = tempfile.TemporaryDirectory()
        bag = os.path.join(folder.name, "dig.bag")
        report = os.path.join(folder.name, "report.json")

        def digs(status):
            return any(body.name == "blade" and body.state == 0 for body in status.bodies) and status.max_speed > 0.0
        with WallWorld({"blade": lambda now: Place(0.5 + 0.2 * math.sin(now), 0.5, 0.1)}):
            with Launched("recorded", bag=bag, scene=scene.name, report=report) as recorded:
                recorded.status("/sand_node/status", digs)
                time.sleep(1.0)  # the bag has tf of the time of the sand
                self.assertTrue(rospy.ServiceProxy("/sand_node/reset", Trigger)().success)
                self.assertTrue(rospy.ServiceProxy("/sand_node/edit_sand", EditSand)(
                    center=PointStamped(Header(frame_id="sand"), Point(0.5, 0.5, 0.0)), radius=0.2, value=0.05).success)
                poured = recorded.status("/sand_node/status", lambda status: status.volume_poured > 0.0).volume_poured
                time.sleep(3.0)  # what is replayed ends before the bag
        self.assertTrue(os.path.exists(report))
        topics = rosbag.Bag(bag).get_type_and_topic_info().topics
        for topic in ("/tf", "/sand_node/calls", "/sand_node/status", "/sand_node/height_field"):
            self.assertIn(topic, topics)
        self.assertGreater(topics["/tf"].message_count, 10)
        self.addCleanup(rospy.delete_param, "/use_sim_time")
        with Launched("replay", bag=bag, scene=scene.name) as replayed:
            again = replayed.status("/sand_node/status", lambda status: digs(status) and status.volume_poured > 0.0)
            # That bits are the same where nothing is held up is a matter of test_replay.py.
            self.assertAlmostEqual(again.volume_poured, poured, delta=1e-6)


if __name__ == "__main__":
    rospy.init_node("test_launches", disable_rostime=True)
    rostest.rosrun("shallow_sand", "launches", Launches)
