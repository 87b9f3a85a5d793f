#!/usr/bin/python3
"""Parameters that change while the node runs."""
import math
import unittest

import rospy
import rostest
from dynamic_reconfigure.client import Client
from sand_test import SCENE, RunningNode, World, wait_for_depth

# A cone of 30 degrees in the middle of the map.
CONE = dict(SCENE, sand=[{"cone": {"center": [0.5, 0.5], "height": 0.2, "slope_angle": 30.0}}],
            material={"friction_angle": 35.0, "dilute_layer": {"depth": math.inf}}, gravity=[0.0, 0.0, -9.0],
            robot_description="", publish_rate=8.0)


class Parameters(unittest.TestCase):
    def reconfigure(self, node):
        return Client(node.name + "/reconfigure", timeout=10.0)

    def test_starts_with_its_parameters_not_with_the_defaults_nor_with_what_was_left(self):
        parameters = dict(CONE, reconfigure={"friction_angle": 3.0, "max_body_speed": 1.0})
        with World({}), RunningNode("started", parameters) as node:
            start = self.reconfigure(node).get_configuration(timeout=10.0)
            self.assertAlmostEqual(start["friction_angle"], 35.0, places=9)
            self.assertEqual(start["layer_depth"], math.inf)
            self.assertEqual([start["gravity_x"], start["gravity_y"], start["gravity_z"]], [0.0, 0.0, -9.0])
            self.assertEqual([start["publish_rate"], start["height_field_rate"], start["max_body_speed"]], [8.0, 10.0, 10.0])
            node.assert_well(self)
            self.assertEqual(node.error_lines(), [])

    def test_sand_flows_when_friction_drops(self):
        with World({}), RunningNode("loose", CONE) as node:
            client = self.reconfigure(node)
            rested = node.status(lambda status: status.simulated_time > 1.0)
            self.assertEqual(rested.active_cells, 0)
            self.assertEqual(client.update_configuration({"friction_angle": 15.0})["friction_angle"], 15.0)
            # The top stood at 0.2 m.
            wait_for_depth(node, 0.5, 0.5, lambda depth: depth < 0.14)
            after = node.status(lambda status: status.active_cells == 0)
            self.assertAlmostEqual(after.volume / rested.volume, 1.0, places=6)
            # Gravity that leans by 45 degrees brings it to the wall.
            client.update_configuration({"gravity_x": 7.0, "gravity_z": -7.0})
            wait_for_depth(node, 0.97, 0.5, lambda depth: depth > 0.1)
            node.assert_well(self)
            self.assertEqual(node.error_lines(), [])

    def test_what_is_refused_stays_as_it_was_and_is_told_in_one_line(self):
        with World({}), RunningNode("refusing", CONE) as node:
            client = self.reconfigure(node)
            before = client.get_configuration(timeout=10.0)
            for change, word in (({"friction_angle": 90.0}, "friction_angle"), ({"layer_fraction": 0.0}, "fraction"),
                                 ({"layer_depth": 0.0}, "dilute_layer.depth"), ({"gravity_z": 0.0}, "gravity"),
                                 ({"publish_rate": math.nan}, "publish_rate"),
                                 ({"pour_rate": 0.1, "pour_x": 5.0}, "(5, "),
                                 ({"pour_rate": 0.1, "pour_radius": 2.0}, "radius"),
                                 ({"frame_rate": math.nan}, "frame_rate"),
                                 # One bad value among good ones.
                                 ({"friction_angle": 20.0, "max_body_speed": math.nan}, "max_body_speed")):
                answer = client.update_configuration(change)
                for name, value in before.items():
                    if name != "groups":
                        self.assertEqual(answer[name], value, (change, name))
                self.assertEqual(len(node.wait_for_error("reconfigure:", word)), 1, node.error_lines())
            self.assertEqual(len(node.error_lines()), 9, node.error_lines())
            # Friction is what it was: nothing slides.
            time_now = node.status().simulated_time
            self.assertEqual(node.status(lambda status: status.simulated_time > time_now).active_cells, 0)
            node.assert_well(self)

    def test_the_pace_is_another(self):
        with World({}), RunningNode("paced", CONE) as node:
            client = self.reconfigure(node)
            before = node.status(lambda status: status.simulated_time > 0.0)
            for rate in (16.0, 125.0, 4.0):
                self.assertEqual(client.update_configuration({"frame_rate": rate})["frame_rate"], rate)
                changed = node.status(lambda status, start=node.status().simulated_time: status.simulated_time > start + 0.3)
                after = node.status(lambda status: status.simulated_time > changed.simulated_time)
                # Below ten hertz frames are cut.
                frame = round(1e9 / rate) if rate > 10.0 else round(1e9 / 12.0)
                for status in (changed, after):
                    self.assertEqual(status.header.stamp.to_nsec() % frame, 0)
                passed = (after.header.stamp - before.header.stamp).to_sec()
                given_up = after.time_given_up - before.time_given_up
                self.assertAlmostEqual(after.simulated_time - before.simulated_time + given_up, passed, delta=1e-5)
            self.assertEqual(node.error_lines("ERROR"), [])
            node.assert_well(self)

    def test_sand_is_poured_all_the_time(self):
        with World({}), RunningNode("pouring", dict(CONE, pour_rate=0.02, pour_x=0.3, pour_y=0.6, pour_radius=0.15)) as node:
            client = self.reconfigure(node)
            self.assertEqual(client.get_configuration(timeout=10.0)["pour_rate"], 0.02)
            start = node.status(lambda status: status.simulated_time > 0.5)
            # From the first frame on.
            self.assertAlmostEqual(start.volume_poured, 0.02 * start.simulated_time, delta=1e-5)
            client.update_configuration({"pour_rate": 0.0})
            still = node.status(lambda status: status.simulated_time > start.simulated_time)
            still = node.status(lambda status: status.simulated_time > still.simulated_time)
            later = node.status(lambda status: status.simulated_time > still.simulated_time)
            self.assertEqual(later.volume_poured, still.volume_poured)
            # Where it is poured it grows, where it is taken it goes.
            client.update_configuration({"pour_rate": 0.05, "pour_x": 0.8, "pour_y": 0.2})
            wait_for_depth(node, 0.8, 0.2, lambda depth: depth > 0.1)
            client.update_configuration({"pour_rate": -0.5})
            wait_for_depth(node, 0.8, 0.2, lambda depth: depth < 0.02)
            self.assertGreater(node.status(lambda status: status.volume_left > 0.0).volume_left, 0.0)
            node.assert_well(self)
            self.assertEqual(node.error_lines(), [])

    def test_a_slow_rate_becomes_a_fast_one_at_once(self):
        # A message in 100 s.
        with World({}), RunningNode("slow", dict(CONE, publish_rate=0.01)) as node:
            wait_for_depth(node, 0.5, 0.5, lambda depth: depth > 0.1)
            self.reconfigure(node).update_configuration({"friction_angle": 15.0, "publish_rate": 50.0})
            wait_for_depth(node, 0.5, 0.5, lambda depth: depth < 0.14)


if __name__ == "__main__":
    rospy.init_node("test_parameters")
    rostest.rosrun("shallow_sand", "parameters", Parameters)
