#!/usr/bin/python3
"""Whoever follows ~height_field and its updates has the sand of the node, to the bit: late, with losses, after a restart, at rest."""
import json
import math
import signal
import subprocess
import time
import unittest

import numpy
import rospy
import rostest
from geometry_msgs.msg import Point, PointStamped
from roslib.packages import find_node
from sand_test import RunningNode, World
from sensor_msgs.msg import PointCloud2
from shallow_sand.msg import HeightField, HeightFieldUpdate, PourSand

# The blade goes to and fro, then out of the sand, which comes to rest.
BLADE = {"name": "blade", "shape": {"box": [0.1, 1.0, 0.5]},
         "motion": [{"time": 0.5 * k, "position": [1.0 + 0.5 * math.sin(0.5 * k), 1.0, 0.4]} for k in range(13)]
         + [{"time": 7.0, "position": [1.0, 1.0, 1.5]}]}
SCENE = {"grid": {"size": [4.0, 3.0], "spacing": 0.02, "frame": "sand"}, "sand": [{"depth": 0.3}], "bodies": [BLADE],
         "backend": "cpu", "threads": 1}


def lists(field):
    return {name: numpy.array(getattr(field, name), numpy.float32).tobytes()
            for name in ("bed", "depth", "speed", "load", "load_elevation")}


def same(a, b):
    return (a.map, a.sequence, lists(a)) == (b.map, b.sequence, lists(b))


class Follower:
    """A process that follows."""

    def __init__(self, name, topic, lose=0):
        self.name = "/" + name
        self.process = subprocess.Popen(
            [find_node("shallow_sand", "follow_height_field")[0], topic, str(lose), "__name:=" + name],
            stdout=subprocess.PIPE, text=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()

    def copies(self):
        return [rospy.wait_for_message(f"{self.name}/{name}", HeightField, timeout=2.0) for name in ("copy", "second_copy")]

    def wait_until_same(self, node, limit=15.0):
        """As the node has it; returns that."""
        deadline = time.monotonic() + limit
        truth, copies = None, []
        while time.monotonic() < deadline:
            try:
                truth, copies = whole(node), self.copies()
            except rospy.ROSException:
                continue
            if all(same(truth, copy) for copy in copies):
                return truth
            rospy.rostime.wallsleep(0.1)
        raise AssertionError(f"{self.name} has not the sand of the node within {limit} s, but of " + ", ".join(
            f"map {copy.map - truth.map} sequence {copy.sequence} instead of {truth.sequence}" for copy in copies))

    def figures(self):
        self.process.send_signal(signal.SIGINT)
        return json.loads(self.process.communicate(timeout=20)[0])


def whole(node):
    """Nobody else in this process may subscribe to it: only a new connection gets it."""
    return rospy.wait_for_message(node.name + "/height_field", HeightField, timeout=10.0)


def wait_for_points(node, field, limit=10.0):
    """Until ~points shows the same sand."""
    bed, depth, load, top = (numpy.array(values, numpy.float32)
                             for values in (field.bed, field.depth, field.load, field.load_elevation))
    seen = numpy.where(load >= numpy.float32(0.001), top + load, bed + depth)
    deadline = time.monotonic() + limit
    while time.monotonic() < deadline:
        cloud = rospy.wait_for_message(node.name + "/points", PointCloud2, timeout=10.0)
        values = numpy.frombuffer(cloud.data, numpy.float32).reshape(cloud.height * cloud.width, -1)
        if (values[:, 2] == seen).all() and (values[:, 3] == depth + load).all():
            return
    raise AssertionError(f"~points shows other sand than ~height_field after {limit} s")


class StoppedWorld(World):
    """Its clock can be stopped."""

    running = True

    def run(self):
        while not self.stopped.wait(self.WALL_STEP):
            with self.lock:
                self.now += self.STEP if self.running else 0.0
                self.clock.publish(rospy.Time.from_sec(self.now))


class HeightFields(unittest.TestCase):
    def setUp(self):
        rospy.set_param("/use_sim_time", True)
        rospy.set_param("/robot_description", '<robot name="none"><link name="base"/></robot>')

    def test_followers_have_the_sand_of_the_node(self):
        with StoppedWorld({}) as world, RunningNode("followed", SCENE) as node:
            topic = node.name + "/height_field"
            node.status(lambda status: status.simulated_time > 0.2)
            with Follower("early", topic) as early, Follower("lossy", topic, 3) as lossy:
                node.status(lambda status: status.simulated_time > 2.0)
                with Follower("late", topic) as late:
                    node.status(lambda status: status.simulated_time > 3.0)
                    world.running = False
                    for follower in (early, lossy, late):
                        field = follower.wait_until_same(node)
                    self.assertGreater(max(field.speed), 0.0)
                    self.assertGreater(field.sequence, 10)
                    self.assertEqual((field.columns, field.rows, field.header.frame_id), (200, 150, "sand"))
                    wait_for_points(node, field)

                    # Time stands still, but sand that is poured is seen.
                    pours = rospy.Publisher(node.name + "/pour", PourSand, queue_size=1, latch=True)
                    pours.publish(PourSand(position=PointStamped(point=Point(3.0, 2.0, 0.0)), radius=0.2, volume=0.01))
                    deadline = time.monotonic() + 10.0
                    while whole(node).sequence == field.sequence and time.monotonic() < deadline:
                        pass
                    poured = late.wait_until_same(node)
                    self.assertAlmostEqual((numpy.sum(poured.depth) - numpy.sum(field.depth)) * 0.02**2, 0.01, delta=1e-5)
                    wait_for_points(node, poured)
                    world.running = True

                    # In the end all rests: nothing is sent, and all have the same.
                    node.status(lambda status: status.active_cells == 0 and status.simulated_time > 8.5, limit=40.0)
                    for follower in (early, lossy, late):
                        rest = follower.wait_until_same(node)
                    updates = []
                    subscriber = rospy.Subscriber(topic + "_updates", HeightFieldUpdate, updates.append)
                    node.status(lambda status, start=node.status().simulated_time: status.simulated_time > start + 2.0)
                    self.assertEqual([(u.map, u.sequence, u.columns, u.rows) for u in updates],
                                     [(rest.map, rest.sequence, 0, 0)])
                    subscriber.unregister()

                # The node starts anew.
                node.__exit__()
                with RunningNode("followed", SCENE) as again:
                    again.status(lambda status: status.simulated_time > 1.0)
                    world.running = False
                    for follower in (early, lossy):
                        field = follower.wait_until_same(again, limit=30.0)
                    self.assertGreater(field.map, rest.map)
                    world.running = True

    def test_how_late_and_how_often_of_a_million_cells(self):
        rospy.set_param("/use_sim_time", False)
        # As wide as an excavator's bucket, and as fast.
        motion = [{"time": float(k), "position": [5.0 + 0.25 * k, 5.0, 0.45]} for k in range(60)]
        scene = dict(SCENE, grid={"size": [20.48, 20.48], "spacing": 0.02, "frame": "sand"},
                     bodies=[dict(BLADE, motion=motion)])
        with RunningNode("large", scene) as node, Follower("measuring", node.name + "/height_field") as follower:
            node.status(lambda status: status.simulated_time > 5.0, limit=60.0)
            figures = follower.figures()
            rate = (figures["instants"] - 1) / figures["duration"]
            # Stamps lie ~tf_delay behind the time at which the frame began.
            print("1024 x 1024 cells: %.1f instants a second (%d updates in %.1f s), %.1f ms after their frame began (median), at most "
                  "%.1f ms" % (rate, figures["updates"], figures["duration"], 1e3 * (figures["median"] - 0.1),
                               1e3 * (figures["max"] - 0.1)))
            self.assertGreater(figures["instants"], 5)
            self.assertLess(rate, 10.5)


if __name__ == "__main__":
    rospy.init_node("test_height_field")
    rostest.rosrun("shallow_sand", "height_field", HeightFields)
