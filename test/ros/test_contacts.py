#!/usr/bin/python3
"""What bodies do to the sand, as ~contacts tells it: of one that stands in it, one that carries some, and one far above."""
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import Point, PointStamped, Pose, PoseStamped, Quaternion
from sand_test import SCENE, Place, RunningNode, World, link, robot
from shallow_sand.msg import Contacts, PourSand
from shallow_sand.srv import MoveBody

DEPTH = SCENE["sand"][0]["depth"]
SIDE, PRESSED = 0.2, 0.05  # of the post, and how deep it stands [m]
TRAY_TOP = 0.65
CARRIED = 5e-4  # m³ that is poured on the tray


def box(name, size, position):
    return {"name": name, "shape": {"box": size}, "motion": [{"time": 0.0, "position": position}]}


BODIES = [box("tray", [0.4, 0.4, 0.1], [0.25, 0.25, TRAY_TOP - 0.05]),
          box("post", [SIDE, SIDE, 0.4], [0.7, 0.7, DEPTH - PRESSED + 0.2])]


def wait_for_contacts(node, condition, limit=10.0):
    """The first message that is as wanted, and its bodies by name."""
    deadline = time.monotonic() + limit
    while time.monotonic() < deadline:
        message = rospy.wait_for_message(node.name + "/contacts", Contacts, timeout=limit)
        bodies = {body.name: body for body in message.bodies}
        if condition(message, bodies):
            return message, bodies
    raise AssertionError(f"no such contacts within {limit} s; the last were {message}")


class ContactsOfBodies(unittest.TestCase):
    def test_figures(self):
        rospy.set_param("/robot_description", robot("lonely", link("blade")))
        scene = dict(SCENE, bodies=BODIES, publish_rate=10.0)
        with World({"blade": lambda _: Place(0.5, 0.5, 2.0)}), RunningNode("touched", scene) as node:
            message, bodies = wait_for_contacts(
                node, lambda _, bodies: "blade" in bodies and bodies["post"].submerged_volume > 0.0)
            self.assertEqual([body.name for body in message.bodies], ["blade", "post", "tray"])
            self.assertEqual(message.header.frame_id, "sand")
            self.assertGreater(message.header.stamp.to_sec(), 99.0)
            for name in ("blade", "tray"):
                self.assert_no_contact(bodies[name])
            post = bodies["post"]
            # The sand that it displaced stands around it.
            self.assertGreater(post.submerged_volume, SIDE**2 * PRESSED)
            self.assertLess(post.submerged_volume, 2.0 * SIDE**2 * PRESSED)
            self.assertAlmostEqual(post.touching_area, SIDE**2, delta=1e-6)
            self.assertAlmostEqual(post.contact_center.x, 0.7, delta=1e-6)
            self.assertAlmostEqual(post.contact_center.y, 0.7, delta=1e-6)
            self.assertGreater(post.contact_center.z, DEPTH - PRESSED)
            self.assertLess(post.contact_center.z, DEPTH)
            self.assertEqual(post.carried_volume, 0.0)
            self.assertAlmostEqual(message.dug_volume, SIDE**2 * PRESSED, delta=1e-5)
            self.assertAlmostEqual(message.heaped_volume, message.dug_volume, delta=1e-7)
            self.check_pour(node)
            self.check_lift(node)
            self.check_rate(node)
            node.assert_well(self)
            self.assertEqual(node.error_lines(), [])

    def test_given_momentum(self):
        rospy.set_param("/robot_description", robot("lonely", link("blade")))
        # Faster than waves, and then up and away.
        low, high = DEPTH - PRESSED + 0.2, 1.0
        path = [(0.0, [0.25, 0.5, low]), (0.25, [0.75, 0.5, low]), (0.3, [0.75, 0.5, high])]
        plough = {"name": "plough", "shape": {"box": [SIDE, SIDE, 0.4]},
                  "motion": [{"time": time, "position": position} for time, position in path]}
        scene = dict(SCENE, bodies=[box("tray", [0.1, 0.1, 0.1], [0.1, 0.1, 1.0]), plough], publish_rate=10.0)
        with World({"blade": lambda _: Place(0.5, 0.5, 2.0)}), RunningNode("ploughed", scene) as node:
            _, bodies = wait_for_contacts(node, lambda _, bodies: "blade" in bodies and bodies["plough"].given_momentum_x > 0.0)
            for name in ("blade", "tray"):
                self.assertEqual((bodies[name].given_momentum_x, bodies[name].given_momentum_y), (0.0, 0.0), name)
            _, bodies = wait_for_contacts(node, lambda _, bodies: bodies["plough"].submerged_volume == 0.0)
            given = bodies["plough"]
            # Once more than the sand that it stood in at the start has got its speed.
            self.assertGreater(given.given_momentum_x, SIDE**2 * PRESSED * 2.0)
            self.assertLess(abs(given.given_momentum_y), 0.1 * given.given_momentum_x)
            # It touches no sand any more.
            _, later = wait_for_contacts(node, lambda message, _: True)
            self.assertEqual(later["plough"].given_momentum_x, given.given_momentum_x)
            node.assert_well(self)

    def assert_no_contact(self, body):
        figures = (body.submerged_volume, body.touching_area, body.carried_volume, body.contact_momentum_x,
                   body.contact_momentum_y)
        self.assertEqual((figures, body.contact_center), ((0.0,) * 5, Point()), body.name)

    def check_pour(self, node):
        topic = rospy.Publisher(node.name + "/pour", PourSand, queue_size=10)
        while topic.get_num_connections() == 0:
            rospy.rostime.wallsleep(0.02)
        topic.publish(PourSand(position=PointStamped(point=Point(0.25, 0.25, 0.0)), radius=0.06, volume=CARRIED))
        message, bodies = wait_for_contacts(node, lambda _, bodies: bodies["tray"].carried_volume > 0.0)
        tray = bodies["tray"]
        self.assertAlmostEqual(tray.carried_volume, CARRIED, delta=1e-7)
        self.assertEqual(tray.submerged_volume, 0.0)
        self.assertTrue(0.0 < tray.touching_area < 0.16, tray)
        self.assertAlmostEqual(tray.contact_center.x, 0.25, delta=0.01)
        self.assertAlmostEqual(tray.contact_center.z, TRAY_TOP, delta=0.001)
        # It is above the first surface.
        self.assertAlmostEqual(message.heaped_volume - message.dug_volume, CARRIED, delta=1e-7)

    def check_lift(self, node):
        move = rospy.ServiceProxy(node.name + "/move_body", MoveBody)
        move.wait_for_service(10.0)
        pose = PoseStamped(pose=Pose(Point(0.7, 0.7, 1.0), Quaternion(0.0, 0.0, 0.0, 1.0)))
        self.assertTrue(move(name="post", pose=pose).success)
        message, bodies = wait_for_contacts(node, lambda _, bodies: bodies["post"].touching_area == 0.0)
        self.assert_no_contact(bodies["post"])
        self.assertGreater(message.dug_volume, 0.0)

    def check_rate(self, node):
        messages = []
        subscriber = rospy.Subscriber(node.name + "/contacts", Contacts, messages.append, queue_size=1000)
        begin = time.monotonic()
        while len(messages) < 10:
            self.assertLess(time.monotonic() - begin, 10.0)
            rospy.rostime.wallsleep(0.02)
        # Nine periods of 0.1 s, between the first and the tenth.
        self.assertGreater(time.monotonic() - begin, 0.85)
        stamps = [message.header.stamp for message in messages]
        self.assertEqual(stamps, sorted(set(stamps)))
        subscriber.unregister()


if __name__ == "__main__":
    rospy.init_node("test_contacts")
    rostest.rosrun("shallow_sand", "contacts", ContactsOfBodies)
