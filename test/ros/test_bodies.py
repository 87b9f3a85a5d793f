#!/usr/bin/python3
"""Which bodies are in the sand: links of several robots, chosen by patterns; bodies of the scene; bodies added, moved and removed
while the node runs."""
import math
import unittest

import rospy
import rostest
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from sand_test import SCENE, Place, RunningNode, World, link, robot, wait_for_depth
from shallow_sand.msg import BodyStatus
from shallow_sand.srv import AddBody, MoveBody, RemoveBody
from shape_msgs.msg import SolidPrimitive

DEPTH = SCENE["sand"][0]["depth"]


def pose(x, y, z, frame="", orientation=(0.0, 0.0, 0.0, 0.0)):
    stamped = PoseStamped(pose=Pose(Point(x, y, z), Quaternion(*orientation)))
    stamped.header.frame_id = frame
    return stamped


def box(*size):
    return SolidPrimitive(type=SolidPrimitive.BOX, dimensions=size)


class Services:
    def __init__(self, node):
        self.calls = {}
        for name, kind in (("add_body", AddBody), ("move_body", MoveBody), ("remove_body", RemoveBody)):
            rospy.wait_for_service(f"{node.name}/{name}", timeout=20.0)
            self.calls[name] = rospy.ServiceProxy(f"{node.name}/{name}", kind)

    def __call__(self, service, **request):
        return self.calls[service](**request)


def is_state(state):
    return lambda body: body.state == state


class Bodies(unittest.TestCase):
    def setUp(self):
        rospy.set_param("/robot_description", robot("lonely", link("blade")))

    def refuse(self, response, *words):
        self.assertFalse(response.success, response.message)
        for word in words:
            self.assertIn(word, response.message)

    def test_two_robots(self):
        rospy.set_param("/left/robot_description", robot("rover", link("wheel_1"), link("wheel_2"), link("arm")))
        rospy.set_param("/right/robot_description", robot("digger", link("arm"), link("scoop")))
        robots = [
            {"description": "/left/robot_description", "tf_prefix": "left/", "include": ["wheel_*", "track_*"]},
            {"description": "/right/robot_description", "tf_prefix": "right_", "name": "miner", "exclude": ["scoop"]},
            {"description": "/nobody/robot_description"},
        ]
        frames = {name: lambda _: Place(0.5, 0.5, 0.5) for name in ("left/wheel_1", "left/wheel_2", "right_arm")}
        with World(frames), RunningNode("two_robots", dict(SCENE, robots=robots)) as node:
            status = node.status(lambda status: len(status.bodies) == 3
                                 and all(body.state == BodyStatus.MOVING for body in status.bodies))
            self.assertEqual(
                sorted((body.name, body.robot, body.frame) for body in status.bodies),
                [("left/wheel_1", "left", "left/wheel_1"), ("left/wheel_2", "left", "left/wheel_2"),
                 ("miner/arm", "miner", "right_arm")])
            self.assertEqual(len(node.wait_for_error("/nobody/robot_description", "not set")), 1)
            # A pattern that matches nothing is told with what there is.
            self.assertEqual(len(node.wait_for_error("robot rover", "'track_*'", "wheel_1, wheel_2, arm")), 1)
            node.assert_well(self)
            self.assertEqual(len(node.error_lines()), 2, node.error_lines())

    def test_a_robot_without_chosen_links(self):
        with World({}), RunningNode("nothing", dict(SCENE, include=["nothing"])) as node:
            self.assertEqual(len(node.wait_for_error("robot lonely", "no trace in the sand")), 1)
            self.assertEqual(node.status().bodies, [])
            node.assert_well(self)

    def test_bodies_come_move_and_go(self):
        frames = {"blade": lambda _: Place(0.5, 0.5, 2.0), "tool": lambda _: Place(0.5, 0.5, 0.6)}
        scene_body = {"name": "post", "shape": {"box": [0.2, 0.2, 0.4]},
                      "motion": [{"time": 0.0, "position": [0.2, 0.2, 0.2]}]}
        with World(frames), RunningNode("services", dict(SCENE, bodies=[scene_body])) as node:
            call = Services(node)
            node.body("blade", is_state(BodyStatus.MOVING))
            node.body("post", is_state(BodyStatus.PLACED))

            # A block is put into the sand, which makes way, goes elsewhere at once, and then step by step.
            added = call("add_body", name="block", shape=box(0.3, 0.3, 0.4), pose=pose(0.7, 0.7, 0.2))
            self.assertTrue(added.success, added.message)
            wait_for_depth(node, 0.7, 0.7, lambda depth: depth < 0.1 * DEPTH)
            self.assertEqual(node.body("block").state, BodyStatus.PLACED)
            moved = call("move_body", name="block", pose=pose(0.0, 0.0, 0.2, frame="tool"), duration=0.0)
            self.assertTrue(moved.success, moved.message)  # to the height 0.8: out of the sand
            wait_for_depth(node, 0.7, 0.7, lambda depth: depth > 0.2 * DEPTH)
            moved = call("move_body", name="block", pose=pose(0.7, 0.3, 0.2), duration=1.0)
            self.assertTrue(moved.success, moved.message)
            wait_for_depth(node, 0.7, 0.3, lambda depth: depth < 0.1 * DEPTH)
            node.assert_well(self)

            # What follows a frame cannot be moved otherwise; what the scene or the robot brought can be taken away.
            followed = call("add_body", name="tip", shape=SolidPrimitive(type=SolidPrimitive.SPHERE, dimensions=[0.05]),
                            pose=pose(0.0, 0.0, -0.5, frame="tool"), follow=True)
            self.assertTrue(followed.success, followed.message)
            self.assertEqual(node.body("tip", is_state(BodyStatus.MOVING)).frame, "tool")
            self.refuse(call("move_body", name="tip", pose=pose(0.0, 0.0, 0.0)), "tip", "tf frame tool")
            for name in ("post", "blade", "block"):
                removed = call("remove_body", name=name)
                self.assertTrue(removed.success, removed.message)
            node.status(lambda status: [body.name for body in status.bodies] == ["tip"])
            wait_for_depth(node, 0.2, 0.2, lambda depth: depth > 0.2 * DEPTH)
            node.assert_well(self)
            self.assertEqual(len(node.error_lines()), 1, node.error_lines())  # the refusal

    def test_a_tool_without_tf(self):
        frames = {"blade": lambda _: Place(0.5, 0.5, 2.0)}
        with World(frames) as world, RunningNode("poses", SCENE) as node:
            call = Services(node)
            topic = rospy.Publisher("/hand", PoseStamped, queue_size=10)
            added = call("add_body", name="tool", shape=box(0.3, 0.3, 0.4), pose_topic="/hand")
            self.assertTrue(added.success, added.message)
            self.assertEqual(node.body("tool").state, BodyStatus.WAITING)

            def hand(stamp, z=0.2, length=1.0):
                message = pose(0.6 + 0.1 * math.sin(stamp), 0.4, z, orientation=(0.0, 0.0, 0.0, length))
                message.header.stamp = rospy.Time.from_sec(stamp)
                topic.publish(message)
            world.frames["hand"] = hand
            self.assertEqual(node.body("tool", is_state(BodyStatus.MOVING)).jumps, 0)
            wait_for_depth(node, 0.6, 0.27, lambda depth: depth < 0.1 * DEPTH)
            # What is no pose is refused, and said of the body.
            world.frames["hand"] = lambda stamp: hand(stamp, length=3.0)
            self.assertIn("length 1", node.body("tool", is_state(BodyStatus.STALE)).problem)
            world.frames["hand"] = hand
            node.body("tool", is_state(BodyStatus.MOVING))
            self.refuse(call("add_body", name="other", shape=box(0.1, 0.1, 0.1), pose_topic="no topic"), "pose_topic", "no topic")
            self.refuse(call("add_body", name="other", shape=box(0.1, 0.1, 0.1), pose_topic="/hand", handle=True),
                        "pose_topic", "one of them")
            self.assertTrue(call("remove_body", name="tool").success)
            # Sand slides back to where the edge was, not always to the middle.
            wait_for_depth(node, 0.6, 0.27, lambda depth: depth > 0.2 * DEPTH)
            node.assert_well(self)

    def test_what_services_refuse(self):
        with World({"blade": lambda _: Place(0.5, 0.5, 2.0)}), RunningNode("refusals", SCENE) as node:
            call = Services(node)
            node.body("blade")
            solid, here = box(0.1, 0.1, 0.1), pose(0.5, 0.5, 0.5)
            add = dict(name="new", shape=solid, pose=here)
            mesh = dict(name="new", pose=here)
            refusals = [
                (dict(add, name=""), ("name", "empty")),
                (dict(add, name="blade"), ("name", "blade", "no other body")),
                (dict(add, shape=SolidPrimitive()), ("shape.type", "BOX")),
                (dict(add, shape=box(0.1, 0.1)), ("shape.dimensions", "2 numbers")),
                (dict(add, shape=box(0.1, -0.1, 0.1)), ("shape.box", "-0.1", "positive")),
                (dict(add, mesh="file:///a.stl"), ("shape.dimensions", "one of the two")),
                (dict(mesh, mesh="file:///no/such.stl"), ("mesh", "/no/such.stl")),
                (dict(mesh, mesh="package://shallow_sand/package.xml"), ("mesh", "triangles")),
                (dict(add, pose=pose(0.5, 0.5, 0.5, orientation=(0.0, 0.0, 0.0, 2.0))), ("orientation", "length 1")),
                (dict(add, pose=pose(float("nan"), 0.5, 0.5)), ("position", "nan", "finite")),
                (dict(add, pose=pose(1e300, 0.5, 0.5)), ("pose", "1e+300", "1e9")),
                (dict(add, name="long" * 100), ("name", "at most 255 bytes")),
                (dict(add, name="two\nlines"), ("name", "two lines", "control characters")),
                (dict(add, pose=pose(0.0, 0.0, 0.0, frame="limbo")), ("limbo",)),
                (dict(add, follow=True), ("frame_id", "empty")),
            ]
            for request, words in refusals:
                self.refuse(call("add_body", **request), *words)
            self.assertTrue(call("add_body", **add).success)
            self.refuse(call("move_body", name="gone", pose=here), "gone", "blade, new")
            self.refuse(call("move_body", name="new", pose=here, duration=-1.0), "duration", "-1")
            self.refuse(call("move_body", name="new", pose=pose(9.0, 0.5, 0.5), duration=0.1), "duration", "0.85 s")
            self.refuse(call("remove_body", name="gone"), "gone", "blade, new")
            self.assertEqual([body.name for body in node.status(lambda status: len(status.bodies) == 2).bodies],
                             ["blade", "new"])
            node.assert_well(self)


if __name__ == "__main__":
    rospy.init_node("test_bodies")
    rostest.rosrun("shallow_sand", "bodies", Bodies)
