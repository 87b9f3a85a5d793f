#!/usr/bin/python3
"""What goes wrong is said in one clear line, and the node lives on, or ends with exit code 2 if it cannot start."""
import subprocess
import tempfile
import unittest

import rospy
import rostest
from roslib.packages import find_node
from shallow_sand.msg import BodyStatus, Status

SCENE = {
    "grid": {"size": [1.0, 1.0], "spacing": 0.05, "frame": "sand"},
    "sand": [{"depth": 0.1}],
    "backend": "cpu",
    "threads": 1,
    "tf_timeout": 0.5,
}
URDF = """<robot name="ghost_robot"><link name="ghost"><collision><geometry><box size="0.2 0.2 0.2"/></geometry>
</collision></link></robot>"""


class RunningNode:
    """sand_node as a child process; what it writes to its standard error is kept in a file."""

    def __init__(self, name, parameters):
        self.name = "/" + name
        if rospy.has_param(self.name):
            rospy.delete_param(self.name)
        rospy.set_param(self.name, parameters)
        self.errors = tempfile.NamedTemporaryFile("w+", suffix=".log")
        self.process = subprocess.Popen(
            [find_node("shallow_sand", "sand_node")[0], "__name:=" + name],
            stdout=subprocess.DEVNULL,
            stderr=self.errors,
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.terminate()
        self.process.wait(timeout=20)
        self.errors.close()

    def error_lines(self):
        with open(self.errors.name) as log:
            return [line for line in log.read().splitlines() if line.strip()]

    def wait_for_error(self, *words, limit=20.0):
        deadline = rospy.Time.now() + rospy.Duration(limit)
        while rospy.Time.now() < deadline:
            lines = [line for line in self.error_lines() if all(word in line for word in words)]
            if lines:
                return lines
            rospy.sleep(0.05)
        raise AssertionError("no line with %s within %g s, only %s" % (words, limit, self.error_lines()))

    def status(self, condition=lambda status: True, limit=20.0):
        deadline = rospy.Time.now() + rospy.Duration(limit)
        while rospy.Time.now() < deadline:
            status = rospy.wait_for_message(self.name + "/status", Status, timeout=limit)
            if condition(status):
                return status
        raise AssertionError("no such status within %g s; the last was %s" % (limit, status))


class Faults(unittest.TestCase):
    def setUp(self):
        if rospy.has_param("/robot_description"):
            rospy.delete_param("/robot_description")

    def assert_alive(self, node):
        before = node.status().simulated_time
        node.status(lambda status: status.simulated_time > before)

    def test_missing_robot_description_then_missing_tf(self):
        with RunningNode("no_robot", SCENE) as node:
            lines = node.wait_for_error("/robot_description", "URDF")
            self.assertEqual(len(lines), 1)
            self.assert_alive(node)
            # It comes later; its link never gets a pose.
            rospy.set_param("/robot_description", URDF)
            node.wait_for_error("link ghost", "tf frame ghost", "frame sand")
            waiting = node.status(lambda status: any(body.problem for body in status.bodies))
            self.assertEqual([body.state for body in waiting.bodies], [BodyStatus.WAITING])
            self.assert_alive(node)
            self.assertEqual(len(node.wait_for_error("link ghost")), 1, "said more than once")

    def test_broken_robot_description(self):
        rospy.set_param("/robot_description", "<robot name='broken'>")
        with RunningNode("broken_robot", SCENE) as node:
            self.assertEqual(len(node.wait_for_error("/robot_description")), 1)
            self.assert_alive(node)
            self.assertEqual(len(node.wait_for_error("/robot_description")), 1, "said more than once")

    def expect_refusal(self, name, changes, *words):
        with RunningNode(name, dict(SCENE, **changes)) as node:
            self.assertEqual(node.process.wait(timeout=20), 2)
            lines = node.error_lines()
            self.assertEqual(len(lines), 1, lines)
            for word in words:
                self.assertIn(word, lines[0])

    def test_bad_parameters_end_the_node(self):
        self.expect_refusal("angle", {"material": {"friction_angle": 95.0}}, "material.friction_angle", "95")
        self.expect_refusal("typo", {"sands": []}, "sands", "sand")
        self.expect_refusal("rate", {"frame_rate": -1.0}, "frame_rate", "hertz")


if __name__ == "__main__":
    rospy.init_node("test_faults")
    rostest.rosrun("shallow_sand", "faults", Faults)
