#!/usr/bin/python3
"""What hands do to the sand: it is poured and taken away by messages; bodies are seen as markers, and dragged by their handles."""
import math
import unittest

import numpy
import rospy
import rostest
from geometry_msgs.msg import Point, PointStamped, Pose, PoseStamped, Quaternion
from sand_test import SCENE, Place, RunningNode, World, link, robot, wait_for_depth, wait_until
from shallow_sand.msg import HeightField, HeightFieldUpdate, PourSand
from shallow_sand.srv import AddBody, MoveBody, RemoveBody
from shape_msgs.msg import SolidPrimitive
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit, Marker, MarkerArray

DEPTH = SCENE["sand"][0]["depth"]
FRAMES = {"blade": lambda _: Place(0.5, 0.5, 2.0)}  # of a robot that stays out of the sand
VOLUME = DEPTH * SCENE["grid"]["size"][0] * SCENE["grid"]["size"][1]


def pour(x, y, radius, volume, frame=""):
    message = PourSand(position=PointStamped(point=Point(x, y, 0.0)), radius=radius, volume=volume)
    message.position.header.frame_id = frame
    return message


def connected(publisher):
    wait_until(lambda: publisher.get_num_connections() > 0, "a subscriber of " + publisher.name)
    return publisher


class Latest:
    """Messages of a topic, all of them."""

    def __init__(self, topic, kind):
        self.messages = []
        self.subscriber = rospy.Subscriber(topic, kind, self.messages.append, queue_size=1000)

    def wait(self, condition, what):
        wait_until(lambda: self.messages and condition(self.messages[-1]), what)
        return self.messages[-1]


def box(*size):
    return SolidPrimitive(type=SolidPrimitive.BOX, dimensions=size)


def at(x, y, z, frame=""):
    stamped = PoseStamped(pose=Pose(Point(x, y, z), Quaternion(0.0, 0.0, 0.0, 1.0)))
    stamped.header.frame_id = frame
    return stamped


class Handling(unittest.TestCase):
    def setUp(self):
        rospy.set_param("/robot_description", robot("lonely", link("blade")))

    def test_sand_is_poured_and_taken_away(self):
        frames = dict(FRAMES, hand=lambda _: Place(0.5, 0.5, 1.0))
        with World(frames), RunningNode("pours", SCENE) as node:
            topic = connected(rospy.Publisher(node.name + "/pour", PourSand, queue_size=100))
            # More than come between two frames; all are taken.
            for _ in range(100):
                topic.publish(pour(0.3, 0.6, 0.2, 1e-4))
            poured = node.status(lambda status: status.volume_poured > 0.00999)
            self.assertAlmostEqual(poured.volume_poured, 0.01, delta=1e-6)
            self.assertAlmostEqual(poured.volume, VOLUME + 0.01, delta=1e-6)
            # In a frame of tf, and no more than there is.
            topic.publish(pour(-0.3, -0.3, 0.1, -1000.0, frame="hand"))
            taken = node.status(lambda status: status.volume_left > 0.0)
            self.assertLess(taken.volume_left, 2.0 * math.pi * 0.1**2 * DEPTH)
            wait_for_depth(node, 0.3, 0.6, lambda depth: depth > DEPTH)
            node.assert_well(self)
            self.assertEqual(node.error_lines(), [])

    def test_pours_that_are_refused(self):
        nan = float("nan")
        refusals = [
            (pour(nan, 0.5, 0.1, 0.1), ("position", "nan", "million")),
            (pour(0.5, 0.5, nan, 0.1), ("radius", "nan", "above 0")),
            (pour(0.5, 0.5, 0.0, 0.1), ("radius", "above 0")),
            (pour(0.5, 0.5, 1.5, 0.1), ("radius", "1.5", "at most the grid's 1.0")),
            (pour(0.5, 1.5, 0.1, 0.1), ("position", "(0.5, 1.5, 0)", "covers cells of the grid")),
            (pour(0.5, 0.5, 0.1, nan), ("volume", "nan", "cubic metres")),
            (pour(0.5, 0.5, 0.1, math.inf), ("volume", "inf", "cubic metres")),
            (pour(0.5, 0.5, 0.1, 0.1, frame="limbo"), ("limbo",)),
        ]
        with World(FRAMES):
            for start in range(0, len(refusals), 4):
                # Refusals that follow each other soon are not told: each has a node of its own.
                nodes = [RunningNode(f"refuses_{start + k}", SCENE) for k in range(4)]
                for node, (message, words) in zip(nodes, refusals[start:start + 4]):
                    with node:
                        topic = connected(rospy.Publisher(node.name + "/pour", PourSand, queue_size=10))
                        for _ in range(5):
                            topic.publish(message)
                        topic.publish(pour(0.5, 0.5, 0.1, 0.001))
                        status = node.status(lambda status: status.volume_poured > 0.0)
                        self.assertAlmostEqual(status.volume_poured, 0.001, delta=1e-6)
                        self.assertEqual(len(node.wait_for_error(node.name + "/pour", *words)), 1)
                        self.assertEqual(len(node.error_lines()), 1, node.error_lines())

    def test_bodies_are_seen(self):
        frames = dict(FRAMES, tool=lambda now: Place(0.5, 0.5, 0.6 + 0.1 * math.sin(now)))
        post = {"name": "post", "shape": {"cylinder": {"radius": 0.1, "length": 0.4}},
                "motion": [{"time": 0.0, "position": [0.2, 0.2, 0.2]}]}
        with World(frames), RunningNode("seen", dict(SCENE, bodies=[post])) as node:
            seen = Latest(node.name + "/bodies", MarkerArray)
            first = seen.wait(lambda array: len(array.markers) == 1, "the post").markers[0]
            self.assertEqual((first.ns, first.type, first.action, first.header.frame_id),
                             ("post", Marker.CYLINDER, Marker.ADD, "sand"))
            self.assertEqual((first.scale.x, first.scale.y, first.scale.z), (0.2, 0.2, 0.4))
            self.assertEqual(first.pose.position, Point(0.2, 0.2, 0.2))
            # It rests: nothing more is said.
            count = len(seen.messages)
            node.status(lambda status, start=node.status().simulated_time: status.simulated_time > start + 1.0)
            self.assertEqual(len(seen.messages), count)

            call = {name: rospy.ServiceProxy(f"{node.name}/{name}", kind)
                    for name, kind in (("add_body", AddBody), ("move_body", MoveBody), ("remove_body", RemoveBody))}
            for proxy in call.values():
                proxy.wait_for_service(20.0)
            mesh = "package://shallow_sand/config/excavator/meshes/bucket.stl"
            self.assertTrue(call["add_body"](name="ball", pose=at(0.0, 0.0, 0.0, "tool"), follow=True,
                                             shape=SolidPrimitive(type=SolidPrimitive.SPHERE, dimensions=[0.1])).success)
            self.assertTrue(call["add_body"](name="bucket", pose=at(0.7, 0.7, 0.8), mesh=mesh).success)
            shown = seen.wait(lambda array: len(array.markers) == 3, "three bodies")
            looks = {marker.ns: marker for marker in shown.markers}
            self.assertEqual((looks["ball"].type, looks["ball"].scale.x), (Marker.SPHERE, 0.2))
            self.assertEqual((looks["bucket"].type, looks["bucket"].mesh_resource, looks["bucket"].scale.z),
                             (Marker.MESH_RESOURCE, mesh, 1.0))
            heights = set()

            def ball_moves(array):
                heights.update(marker.pose.position.z for marker in array.markers if marker.ns == "ball")
                return len(heights) > 3

            seen.wait(ball_moves, "the ball follows tf")
            self.assertTrue(all(0.5 <= z <= 0.7 for z in heights), heights)
            self.assertTrue(call["move_body"](name="post", pose=at(0.3, 0.2, 0.2)).success)
            seen.wait(lambda array: any(m.ns == "post" and m.pose.position.x == 0.3 for m in array.markers), "the move")
            self.assertTrue(call["remove_body"](name="ball").success)
            seen.wait(lambda array: any(marker.action == Marker.DELETE for marker in array.markers), "the ball has gone")
            self.assertEqual(sorted(m.ns for m in seen.messages[-1].markers if m.action == Marker.ADD), ["bucket", "post"])
            removed = [m for array in seen.messages for m in array.markers if m.action == Marker.DELETE]
            self.assertEqual([(m.ns, m.id) for m in removed], [("ball", looks["ball"].id)])
            node.assert_well(self)
            self.assertEqual(node.error_lines(), [])

    def test_a_body_is_dragged(self):
        with World(dict(FRAMES, other=lambda _: Place(0.1, 0.0, 0.0))), RunningNode("dragged", SCENE) as node:
            add = rospy.ServiceProxy(node.name + "/add_body", AddBody)
            add.wait_for_service(20.0)
            refused = add(name="tip", shape=box(0.1, 0.1, 0.1), pose=at(0.0, 0.0, 1.0, "other"), follow=True, handle=True)
            self.assertFalse(refused.success)
            self.assertIn("handle", refused.message)
            self.assertTrue(add(name="plate", shape=box(0.1, 0.4, 0.4), pose=at(0.2, 0.5, 0.2), handle=True).success)
            init = Latest(node.name + "/body_handles/update_full", InteractiveMarkerInit)
            handle = init.wait(lambda message: len(message.markers) == 1, "a handle").markers[0]
            self.assertEqual((handle.name, handle.header.frame_id), ("plate", "sand"))
            shapes = [marker for control in handle.controls for marker in control.markers]
            self.assertEqual([(m.type, m.scale.x, m.scale.y, m.scale.z) for m in shapes], [(Marker.CUBE, 0.1, 0.4, 0.4)])
            self.assertEqual(len(handle.controls), 7)

            feedback = connected(rospy.Publisher(node.name + "/body_handles/feedback", InteractiveMarkerFeedback,
                                                 queue_size=100))
            seen = Latest(node.name + "/bodies", MarkerArray)

            def drag(x, frame="sand"):
                message = InteractiveMarkerFeedback(client_id="hand", marker_name="plate", control_name="0",
                                                    event_type=InteractiveMarkerFeedback.POSE_UPDATE)
                message.header.frame_id = frame
                message.pose = at(x, 0.5, 0.2).pose
                feedback.publish(message)

            fields = []
            rospy.Subscriber(node.name + "/height_field_updates", HeightFieldUpdate, fields.append)
            # 0.2 m/s of simulated time, by a hand that tells of itself 15 times a second of it.
            start = rospy.get_time()
            x = 0.2
            while x < 0.5:
                rospy.sleep(1.0 / 15.0)
                x = 0.2 + 0.2 * (rospy.get_time() - start)
                drag(x)
            field = rospy.wait_for_message(node.name + "/height_field", HeightField, timeout=20.0)
            fastest = max(max(update.speed, default=0.0) for update in list(fields))
            self.assertGreater(fastest, 0.1)  # the sand goes as fast as the plate, not as fast as a jump would throw it
            self.assertLess(fastest, 0.6)
            seen.wait(lambda array: any(abs(m.pose.position.x - x) < 1e-9 for m in array.markers), "the plate is there")
            # In its way it has heaped sand up; a pose that is none is refused, and the plate stays.
            depth = numpy.array(field.depth).reshape(field.rows, field.columns)
            spacing = SCENE["grid"]["spacing"]
            self.assertGreater(depth[10, int(0.6 / spacing)], 1.1 * DEPTH)
            drag(float("nan"))
            self.assertEqual(len(node.wait_for_error("~body_handles/feedback", "plate", "pose.position", "finite")), 1)
            # A hand in another frame.
            drag(x, frame="other")
            seen.wait(lambda array: any(abs(m.pose.position.x - x - 0.1) < 1e-9 for m in array.markers), "it moved on")
            remove = rospy.ServiceProxy(node.name + "/remove_body", RemoveBody)
            self.assertTrue(remove(name="plate").success)
            init.wait(lambda message: not message.markers, "the handle goes with the body")
            node.assert_well(self)


if __name__ == "__main__":
    rospy.init_node("test_handling")
    rostest.rosrun("shallow_sand", "handling", Handling)
