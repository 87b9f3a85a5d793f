#!/usr/bin/python3
"""Time: the sand keeps pace with any clock, stops and goes on when told to, and gives the same bits from the same poses."""
import math
import random
import time
import unittest

import numpy
import rospy
import rostest
from rosgraph_msgs.msg import Clock
from sand_test import SCENE, Place, RunningNode, World, link, robot, service, transform
from sensor_msgs.msg import PointCloud2
from shallow_sand.msg import BodyStatus, Status
from shallow_sand.srv import MoveBody, Step
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage

HEAP = dict(SCENE, sand=[{"depth": 0.1}, {"cylinder": {"center": [0.5, 0.5], "radius": 0.2, "depth": 0.3}}])
SWEEP = {"name": "sweep", "shape": {"box": [0.1, 0.4, 0.3]},
         "motion": [{"time": 0.0, "position": [0.2, 0.5, 0.15]}, {"time": 2.0, "position": [0.8, 0.5, 0.15]}]}


def points(node, stamp):
    """The cloud of a time of the sand, as bytes."""
    deadline = time.monotonic() + 20.0
    while time.monotonic() < deadline:
        cloud = rospy.wait_for_message(node.name + "/points", PointCloud2, timeout=10.0)
        if cloud.header.stamp >= stamp:
            return cloud.data
    raise AssertionError("no cloud of time %s" % stamp)


class Pace(unittest.TestCase):
    def setUp(self):
        rospy.set_param("/robot_description", robot("digger", link("blade")))

    def test_any_rate_of_the_clock(self):
        with World({"blade": lambda _: Place(0.5, 0.5, 2.0)}) as world, RunningNode("rates", HEAP) as node:
            node.status(lambda status: status.simulated_time > 0.0)
            given_up = 0.0
            for rate in (0.1, 10.0, 1.0):
                world.STEP = rate * world.WALL_STEP
                start = node.status()
                begin = time.monotonic()
                end = node.status(lambda status: status.header.stamp - start.header.stamp > rospy.Duration(2.0 * rate))
                passed = (end.header.stamp - start.header.stamp).to_sec()
                went = end.simulated_time - start.simulated_time
                given_up = end.time_given_up - start.time_given_up
                # What the sand went is what the clock went, or it is told.
                self.assertAlmostEqual(went + given_up, passed, delta=1e-6)
                self.assertLess(given_up, 0.5 * passed)
                self.assertLess(time.monotonic() - begin, 20.0)
            node.assert_well(self)

    def test_the_clock_stops_and_leaps(self):
        with World({"blade": lambda _: Place(0.5, 0.5, 2.0)}) as world, RunningNode("leaps", HEAP) as node:
            node.status(lambda status: status.simulated_time > 0.2)
            world.STEP = 0.0
            still = node.status(lambda status: status.behind < 0.021)
            still = node.status(lambda status: status.header.stamp == node.status().header.stamp)
            self.assertEqual(node.status().simulated_time, still.simulated_time)
            world.set_time(world.now + 1000.0)
            world.STEP = 0.02
            after = node.status(lambda status: status.header.stamp - still.header.stamp > rospy.Duration(1000.0))
            # It did not race, and says what it left out; a frame of 20 ms is half a nanosecond off.
            self.assertLess(after.simulated_time - still.simulated_time, 60.0)
            self.assertAlmostEqual(after.time_given_up - still.time_given_up,
                                   (after.header.stamp - still.header.stamp).to_sec()
                                   - (after.simulated_time - still.simulated_time), delta=5e-5)
            node.wait_for_error("left out", "s of ROS time")
            node.assert_well(self)

    def test_pause_step_and_reset(self):
        scene = dict(HEAP, bodies=[SWEEP], paused=True, robot_description="")
        with World({}, start=0.0), RunningNode("steps", scene) as node:
            pause, step, reset = (service(node, *call) for call in
                                  (("pause", SetBool), ("step", Step), ("reset", Trigger)))
            self.assertTrue(node.status().paused)
            self.assertEqual(node.status().simulated_time, 0.0)
            # Further than time has come.
            self.assertAlmostEqual(step(9.0).simulated_time, 9.0, delta=1e-6)
            self.assertTrue(reset().success)
            clouds = []
            for _ in range(2):
                for k in range(1, 26):
                    answer = step(0.02)
                    self.assertTrue(answer.success, answer.message)
                    self.assertAlmostEqual(answer.simulated_time, 0.02 * k, delta=1e-6)
                status = node.status(lambda status: status.simulated_time > 0.499)
                self.assertGreater(status.max_speed, 0.0)
                clouds.append(points(node, status.header.stamp))
                self.assertTrue(reset().success)
                self.assertEqual(node.status(lambda status: status.simulated_time == 0.0).volume_error, 0.0)
            self.assertEqual(clouds[0], clouds[1], "the same steps after ~reset gave other bits")
            # At most ten seconds, at least a frame; and not while it runs.
            for bad in (-1.0, 10.1, float("nan"), float("inf")):
                answer = step(bad)
                self.assertFalse(answer.success)
                self.assertIn("duration", answer.message)
            self.assertAlmostEqual(step(0.0).simulated_time, 0.02, delta=1e-6)
            self.assertTrue(pause(False).success)
            node.status(lambda status: not status.paused and status.simulated_time > 0.1)
            self.assertIn("~pause", step(0.1).message)
            # What passed while it was paused is not given up, nor caught up.
            self.assertTrue(pause(True).success)
            stopped = node.status(lambda status: status.paused)
            rospy.sleep(1.0)
            self.assertTrue(pause(False).success)
            again = node.status(lambda status: status.simulated_time > stopped.simulated_time)
            self.assertEqual(again.time_given_up, stopped.time_given_up)
            self.assertEqual(node.error_lines("ERROR"), [])

    def test_the_same_poses_give_the_same_bits(self):
        """Frames lie at the same instants of ROS time however the clock ticks and whenever transforms come."""

        def path(stamp):
            """Above the sand at first, then through it."""
            return Place(0.5 + 0.3 * math.sin(stamp), 0.5, max(0.1, 0.1 + 2.0 * (101.0 - stamp)))

        def play(name, seed):
            chance = random.Random(seed)
            clock = rospy.Publisher("/clock", Clock, queue_size=100)
            tf = rospy.Publisher("/tf", TFMessage, queue_size=100)
            now = sent = 95.0
            with RunningNode(name, dict(SCENE, tf_delay=0.2)) as node:
                latest = []
                listener = rospy.Subscriber(node.name + "/status", Status, latest.append)
                deadline = time.monotonic() + 60.0
                while now < 103.0:
                    self.assertLess(time.monotonic(), deadline)
                    # The node hears the first of all, and at 100 the link has been read.
                    ready = [body.state for status in latest[-1:] for body in status.bodies] == [BodyStatus.MOVING]
                    if clock.get_num_connections() > 0 and tf.get_num_connections() > 0 and (now < 100.0 or ready):
                        now = min(103.0, now + chance.uniform(0.0, 0.03))
                    while sent < now:
                        sent = round(sent + 0.04, 6)
                        tf.publish(TFMessage([transform("blade", path(sent), sent)]))
                    clock.publish(Clock(rospy.Time.from_sec(now)))
                    rospy.rostime.wallsleep(chance.uniform(0.0, 0.02))
                listener.unregister()
                stamp = rospy.Time.from_sec(102.8)
                status = node.status(lambda status: status.header.stamp >= stamp)
                self.assertEqual([(body.jumps, body.state) for body in status.bodies], [(0, BodyStatus.MOVING)])
                return points(node, stamp) if status.time_given_up == 0.0 else None

        seed = random.randrange(1 << 32)
        print("seed", seed)
        # On a machine that other things hold up sand may be left out, which is told; then there is nothing to compare.
        clouds = []
        for attempt in range(5):
            cloud = play("play_%d" % attempt, seed + attempt)
            if cloud is not None:
                clouds.append(cloud)
            if len(clouds) == 2:
                break
        self.assertEqual(len(clouds), 2, "time was given up again and again")
        self.assertEqual(clouds[0], clouds[1])
        depths = numpy.frombuffer(clouds[0], dtype=numpy.float32).reshape(400, -1)[:, 3]
        self.assertGreater(depths.max() - depths.min(), 0.05, "nothing was dug")


if __name__ == "__main__":
    rospy.init_node("test_pace", disable_rostime=True)
    rostest.rosrun("shallow_sand", "pace", Pace)
