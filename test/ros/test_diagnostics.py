#!/usr/bin/python3
"""/diagnostics says of each part of the node whether it is well."""
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from sand_test import SCENE, Place, RunningNode, World, link, robot


class Diagnosed:
    """What /diagnostics said last of each part of a node."""

    def __init__(self, name):
        self.last = {}
        self.prefix = name.strip("/") + ": "
        self.subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, self.take)

    def take(self, message):
        for status in message.status:
            if status.name.startswith(self.prefix) and status.message != "Node starting up":
                self.last[status.name[len(self.prefix):]] = status

    def wait(self, part, level, *words, limit=15.0):
        deadline = time.monotonic() + limit
        while time.monotonic() < deadline:
            status = self.last.get(part)
            if status is not None and status.level == level and all(word in status.message for word in words):
                return status
            rospy.rostime.wallsleep(0.05)
        raise AssertionError(f"{part}: not {level!r} with {words} within {limit} s; the last was {self.last.get(part)}")


class Diagnostics(unittest.TestCase):
    def test_bodies_are_missed_while_tf_is_silent(self):
        rospy.set_param("/robot_description", robot("arm", link("shovel"), link("wrist")))
        frames = {"shovel": lambda _: Place(0.3, 0.3, 0.5), "wrist": lambda _: Place(0.7, 0.7, 0.5)}
        diagnosed = Diagnosed("diagnosed")
        with World(frames) as world, RunningNode("diagnosed", SCENE):
            diagnosed.wait("bodies", DiagnosticStatus.OK, "2 bodies")
            diagnosed.wait("solver", DiagnosticStatus.OK, "keeps up")
            diagnosed.wait("volume", DiagnosticStatus.OK)
            diagnosed.wait("backend", DiagnosticStatus.OK, "CPU")
            diagnosed.wait("publishers", DiagnosticStatus.OK)
            world.frames["shovel"] = lambda _: None
            lost = diagnosed.wait("bodies", DiagnosticStatus.WARN, "1 of 2", "shovel STALE")
            self.assertNotIn("wrist", lost.message)
            world.frames["shovel"] = frames["shovel"]
            diagnosed.wait("bodies", DiagnosticStatus.OK, "2 bodies")
        rospy.delete_param("/robot_description")

    def test_time_that_does_not_run(self):
        diagnosed = Diagnosed("waiting")
        with RunningNode("waiting", dict(SCENE, robot_description="")):
            diagnosed.wait("solver", DiagnosticStatus.WARN, "/clock")
            with World({}):
                diagnosed.wait("solver", DiagnosticStatus.OK, "keeps up")
            diagnosed.wait("solver", DiagnosticStatus.OK, "stands still")


if __name__ == "__main__":
    rospy.init_node("test_diagnostics")
    rostest.rosrun("shallow_sand", "diagnostics", Diagnostics)
