#!/usr/bin/python3
"""Links follow tf; whatever tf does, the node says it in one line, goes on, and loses no sand."""
import math
import unittest

import rospy
import rostest
from sand_test import SCENE, Place, RunningNode, World, link, robot
from shallow_sand.msg import BodyStatus


def sweep(time):
    """To and fro through the sand, at most 0.3 m/s."""
    return Place(0.5 + 0.15 * math.sin(2.0 * time), 0.5, 0.1)


def is_moving(body):
    return body.state == BodyStatus.MOVING


def is_stale(body):
    return body.state == BodyStatus.STALE


class Motion(unittest.TestCase):
    def setUp(self):
        rospy.set_param("/robot_description", robot("digger", link("blade")))

    def assert_told_once(self, node, *words):
        self.assertEqual(len(node.wait_for_error(*words)), 1, node.error_lines())

    def test_tf_stops_and_comes_back(self):
        with World({"blade": sweep}) as world, RunningNode("stops", SCENE) as node:
            moving = node.body("blade", is_moving)
            self.assertLess(moving.age, 0.5)
            self.assertEqual((moving.robot, moving.frame, moving.jumps), ("digger", "blade", 0))
            world.frames["blade"] = lambda _: None
            stale = node.body("blade", is_stale)
            self.assertIn("newest pose", stale.problem)
            self.assertGreater(stale.age, SCENE["tf_timeout"])
            self.assert_told_once(node, "link blade", "tf frame blade", "frame sand", "rests where it was last seen")
            world.frames["blade"] = sweep
            self.assertEqual(node.body("blade", is_moving).problem, "")
            node.assert_well(self)
            self.assert_told_once(node, "link blade")

    def test_tf_comes_late(self):
        with World({"blade": sweep}) as world, RunningNode("late", SCENE) as node:
            world.latency = 0.3  # of which the node waits 0.1
            self.assert_told_once(node, "frame blade", "too late", "~tf_delay of at least 0.3")
            late = node.body("blade", is_moving)
            self.assertGreater(late.age, 0.25)
            node.assert_well(self)
            self.assertEqual(len(node.error_lines()), 1, node.error_lines())

    def test_tf_jumps(self):
        with World({"blade": sweep}) as world, RunningNode("jumps", SCENE) as node:
            node.body("blade", is_moving)
            world.frames["blade"] = lambda time: Place(sweep(time).position[0] - 5.0, 0.5, 0.1)
            self.assertEqual(node.body("blade", lambda body: body.jumps > 0).jumps, 1)
            self.assert_told_once(node, "link blade jumped", "~max_body_speed 10 m/s", "tf frame blade")
            node.assert_well(self)
            self.assertEqual(node.body("blade").jumps, 1)
            self.assertEqual(len(node.error_lines()), 1, node.error_lines())

    def test_all_links_of_a_robot_share_a_line(self):
        names = ["boom", "stick", "bucket"]
        rospy.set_param("/robot_description", robot("digger", *map(link, names)))
        frames = {name: lambda _: Place(parent="base") for name in names}
        with World(dict(frames, base=sweep)) as world, RunningNode("together", SCENE) as node:
            node.status(lambda status: len(status.bodies) == 3 and all(map(is_moving, status.bodies)))
            world.frames["base"] = lambda time: Place(sweep(time).position[0] - 5.0, 0.5, 0.1)
            node.status(lambda status: all(body.jumps == 1 for body in status.bodies))
            self.assert_told_once(node, "jumped", "likewise links", *names)
            world.frames["base"] = lambda _: None
            node.status(lambda status: all(map(is_stale, status.bodies)))
            self.assert_told_once(node, "rests where it was last seen", "likewise links", *names)
            node.assert_well(self)
            self.assertEqual(len(node.error_lines()), 2, node.error_lines())

    def test_time_goes_back(self):
        # As a bag that loops: from one cycle to the next, everything that moves is elsewhere.
        with World({"blade": sweep}, start=1000.0) as world, RunningNode("loops", SCENE) as node:
            node.body("blade", is_moving)
            for loops in (1, 2):
                simulated = node.status().simulated_time
                world.set_time(20.0)
                again = node.status(lambda status: 20.0 < status.header.stamp.to_sec() < 900.0
                                    and status.simulated_time > simulated and is_moving(status.bodies[0]))
                self.assertEqual(again.bodies[0].jumps, 0)
                self.assertLess(again.bodies[0].age, 0.5)
                self.assertEqual(len(node.wait_for_error("time went back")), loops)
                world.set_time(1000.0)
                node.status(lambda status: status.header.stamp.to_sec() > 1000.0 and is_moving(status.bodies[0]))
            node.assert_well(self)
            self.assertEqual(node.error_lines("link blade: no pose"), [])

    def test_frame_is_missing_and_then_without_root(self):
        with World({"other": sweep}) as world, RunningNode("roots", SCENE) as node:
            waiting = node.body("blade", lambda body: body.problem != "")
            self.assertEqual(waiting.state, BodyStatus.WAITING)
            self.assertIn("blade", waiting.problem)
            self.assert_told_once(node, "link blade", "tf frame blade", "frame sand", "stays out of the sand")
            # Now there are two trees: sand with other, and island with blade.
            world.frames["blade"] = lambda _: Place(parent="island")
            node.body("blade", lambda body: "tree" in body.problem and body.state == BodyStatus.WAITING)
            world.frames["island"] = lambda _: Place(0.5, 0.5, 0.1)
            node.body("blade", is_moving)
            node.assert_well(self)
            self.assertEqual(len(node.error_lines("link blade")), 1, "said more than once")

    def test_bad_rotations_and_positions_are_refused(self):
        bad = {
            "not a number": (Place(0.5, 0.5, 0.1, rotation=(float("nan"), 0.0, 0.0, 1.0)), "length 1"),
            "not of length 1": (Place(0.5, 0.5, 0.1, rotation=(0.0, 0.0, 0.0, 0.5)), "length 1"),
            "nowhere": (Place(float("inf"), 0.5, 0.1), "finite"),
        }
        with World({"base": lambda _: Place(), "blade": lambda time: Place(*sweep(time).position, parent="base")}
                   ) as world, RunningNode("refused", SCENE) as node:
            good = world.frames["blade"]
            for name, (place, words) in bad.items():
                node.body("blade", is_moving)
                # What the link hangs on is bad: the reason is found there.
                world.frames["base"] = lambda time, place=place: place
                stale = node.body("blade", is_stale)
                self.assertIn("tf frame base", stale.problem, name)
                self.assertIn(words, stale.problem, name)
                world.frames["base"] = lambda _: Place()
            world.frames["blade"] = good
            node.body("blade", is_moving)
            self.assert_told_once(node, "tf frame base", "is refused")
            self.assertEqual(len(node.error_lines("link blade", "tf frame base")), len(bad))
            self.assertEqual(len(node.error_lines()), 1 + len(bad), node.error_lines())
            node.assert_well(self)


if __name__ == "__main__":
    rospy.init_node("test_motion")
    rostest.rosrun("shallow_sand", "motion", Motion)
