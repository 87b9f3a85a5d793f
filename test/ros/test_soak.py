#!/usr/bin/python3
"""Everything at once, at random and for as long as one likes: `seconds` as private parameter (scripts/soak sets it).

Services, messages, hostile ones too, tf that stops (as when a robot starts anew), jumps and lies, a clock that stops, races, leaps and goes back,
subscribers that come and vanish. Meanwhile and afterwards: the node lives and answers, its ledger is even, its memory does not grow."""
import math
import os
import random
import tempfile
import time
import unittest

import rospy
import rostest
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from geometry_msgs.msg import Point, Point32, PointStamped, PolygonStamped, Pose, PoseStamped, Quaternion
from sand_test import SCENE, Place, RunningNode, World, link, robot
from sensor_msgs.msg import PointCloud2
from shallow_sand.msg import HeightField, HeightFieldUpdate, PourSand
from shallow_sand.srv import (AddBody, EditSand, EditSandRequest, MoveBody, QuerySurface, QuerySurfaceRequest, RemoveBody, SetSand,
                              StateFile, Step, VolumeInPolygon)
from shape_msgs.msg import SolidPrimitive
from std_srvs.srv import SetBool, Trigger
from visualization_msgs.msg import Marker

HOSTILE = [float("nan"), float("inf"), -float("inf"), 1e300, -1e300, 0.0, -1.0]


class Chaos:
    """Does random things to a node. What it did last is kept, to be told when something breaks."""

    def __init__(self, node, world, seed):
        self.node, self.world = node, world
        self.chance = random.Random(seed)
        self.added = set()
        self.done = []
        self.longest = 0.0
        self.pours = rospy.Publisher(node.name + "/pour", PourSand, queue_size=1000)
        self.subscribers = []

    def service(self, name, kind, *arguments):
        begin = time.monotonic()
        answer = rospy.ServiceProxy(self.node.name + "/" + name, kind)(*arguments)
        self.longest = max(self.longest, time.monotonic() - begin)
        return answer

    def number(self, low, high):
        return self.chance.choice(HOSTILE) if self.chance.random() < 0.15 else self.chance.uniform(low, high)

    def pose(self):
        half = self.chance.uniform(0.0, math.pi)
        turn = Quaternion(0.0, math.sin(half), 0.0, math.cos(half)) if self.chance.random() < 0.8 else Quaternion()
        pose = PoseStamped(pose=Pose(Point(self.number(0, 1), self.number(0, 1), self.number(-0.1, 0.4)), turn))
        pose.header.frame_id = self.chance.choice(["", "", "sand", "blade", "nowhere"])
        return pose

    def add_body(self):
        name = "body%d" % self.chance.randrange(5)
        shape = SolidPrimitive(type=self.chance.choice([1, 2, 3, 3, 4, 77]))
        shape.dimensions = [self.number(0.02, 0.3) for _ in range(self.chance.choice([0, 1, 2, 3, 3]))]
        answer = self.service("add_body", AddBody, name, shape, "", Point(0, 0, 0), "", self.pose(),
                              self.chance.random() < 0.2, self.chance.choice(["", "", "", "/tool", "no topic"]), self.chance.random() < 0.2)
        if answer.success:
            self.added.add(name)

    def move_body(self):
        self.service("move_body", MoveBody, "body%d" % self.chance.randrange(6), self.pose(), self.number(0.0, 2.0))

    def remove_body(self):
        name = "body%d" % self.chance.randrange(6)
        if self.service("remove_body", RemoveBody, name).success:
            self.added.discard(name)

    def pour(self):
        for _ in range(self.chance.choice([1, 1, 10, 300])):
            message = PourSand(radius=self.number(0.05, 0.3), volume=self.number(-1e-3, 1e-3))
            message.position = PointStamped(point=Point(self.number(0, 1), self.number(0, 1), 0.0))
            message.position.header.frame_id = self.chance.choice(["", "", "", "blade", "nowhere"])
            self.pours.publish(message)

    def pause_and_step(self):
        self.service("pause", SetBool, True)
        for _ in range(3):
            self.service("step", Step, self.number(0.0, 0.2))
        self.service("pause", SetBool, False)

    def reset(self):
        self.service("reset", Trigger)

    def region(self):
        center = PointStamped(point=Point(self.number(0, 1), self.number(0, 1), 0.0))
        center.header.frame_id = self.chance.choice(["sand", "sand", "blade", "", "nowhere"])
        return dict(center=center, shape=self.chance.choice([0, 1, 9]), radius=self.number(0.01, 0.3),
                    size_x=self.number(0.01, 0.5), size_y=self.number(0.01, 0.5))

    def edit_sand(self):
        self.service("edit_sand", EditSand, EditSandRequest(operation=self.chance.choice([0, 1, 2, 3, 9]),
                                                            value=self.number(0.0, 0.3), **self.region()))

    def set_sand(self):
        self.service("set_sand", SetSand, self.chance.choice(["depth", "surface", "height"]),
                     self.chance.choice(["", "", "", "/etc/passwd", "no.tif"]),
                     self.chance.choice([self.node.name + "/points", self.node.name + "/mesh", "/nothing", "/tf"]),
                     self.chance.choice([0.1, 0.1, -1.0, float("nan")]))

    def ask(self):
        request = QuerySurfaceRequest(points=[Point(self.number(0, 1), self.number(0, 1), 0.0) for _ in range(20)])
        request.header.frame_id = self.chance.choice(["sand", "blade", "", "nowhere"])
        self.service("query_surface", QuerySurface, request)
        polygon = PolygonStamped()
        polygon.header.frame_id = request.header.frame_id
        corners = [(self.number(0, 1), self.number(0, 1)) for _ in range(self.chance.randrange(6))]
        # 32 bits hold no 1e300.
        polygon.polygon.points = [Point32(*(1e30 if abs(c) == 1e300 else c for c in corner), 0.0) for corner in corners]
        self.service("volume_in_polygon", VolumeInPolygon, polygon)

    def save_and_load(self):
        self.service(self.chance.choice(["save", "load"]), StateFile,
                     self.chance.choice(["a.tif", "a.tif", "b/c.tif", "../x.tif", "/etc/passwd", "", "none.tif"]))

    def reconfigure(self):
        names = ["friction_angle", "layer_depth", "gravity_x", "gravity_z", "publish_rate"]
        request = Config(doubles=[DoubleParameter(self.chance.choice(names), self.number(-20.0, 40.0))])
        self.service("reconfigure/set_parameters", Reconfigure, request)

    def subscribe(self):
        topic, kind = self.chance.choice([("points", PointCloud2), ("mesh", Marker), ("height_field", HeightField),
                                          ("height_field_updates", HeightFieldUpdate)])
        self.subscribers.append(rospy.Subscriber(self.node.name + "/" + topic, kind, lambda _: None))

    def unsubscribe(self):
        if self.subscribers:
            self.subscribers.pop(self.chance.randrange(len(self.subscribers))).unregister()

    def disturb_tf(self):
        self.world.frames["blade"] = self.chance.choice([
            sweep, sweep, lambda _: None, lambda _: Place(0.5, 0.5, 5.0), lambda _: Place(float("nan"), 0.5, 0.1),
            lambda _: Place(0.5, 0.5, 0.1, rotation=(0.0, 0.0, 0.0, 0.2)), lambda _: Place(0.5, 0.5, 0.1, parent="blade"),
            lambda time: Place(random.uniform(-1.0, 1.0), 0.5, 0.1)])

    def disturb_clock(self):
        self.chance.choice([
            lambda: setattr(self.world, "STEP", self.chance.choice([0.0, 0.001, 0.01, 0.02, 0.1])),
            lambda: self.world.set_time(self.world.now + self.chance.uniform(1.0, 500.0)),
            lambda: self.world.set_time(100.0)])()

    def act(self):
        action = self.chance.choice([self.add_body, self.move_body, self.remove_body, self.pour, self.pour, self.pause_and_step,
                                     self.edit_sand, self.set_sand, self.ask, self.save_and_load, self.reconfigure, self.reset, self.subscribe, self.unsubscribe, self.disturb_tf, self.disturb_clock])
        self.done = self.done[-20:] + [action.__name__]
        action()

    def calm(self):
        self.world.frames["blade"] = sweep
        self.world.STEP = 0.02
        while self.subscribers:
            self.subscribers.pop().unregister()
        for name in sorted(self.added):
            self.service("remove_body", RemoveBody, name)
        self.added.clear()


def sweep(now):
    return Place(0.5 + 0.2 * math.sin(now), 0.5, 0.1)


def memory(process):
    """Resident [bytes]."""
    with open(f"/proc/{process.pid}/statm") as figures:
        return int(figures.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


class Soak(unittest.TestCase):
    def test_everything_at_once(self):
        seconds = rospy.get_param("~seconds", 20.0)
        seed = rospy.get_param("~seed", random.randrange(1 << 31))
        print("seed", seed)
        rospy.set_param("/robot_description", robot("digger", link("blade")))
        states = tempfile.TemporaryDirectory()
        # Else each thread that ever asked for much keeps some MB for itself, which would hide a leak.
        os.environ["MALLOC_ARENA_MAX"] = "1"
        parameters = dict(SCENE, threads=2, state_folder=states.name, snapshot_period=0.5)
        with World({"blade": sweep}) as world, RunningNode("soaked", parameters) as node:
            node.body("blade", lambda body: body.state == body.MOVING)
            chaos = Chaos(node, world, seed)
            memories = []
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                calm = time.monotonic() + max(5.0, min(60.0, seconds / 8.0))
                while time.monotonic() < min(calm, end):
                    chaos.act()
                    self.assertIsNone(node.process.poll(), f"it ended; before that: {chaos.done}; {node.error_lines()[-3:]}")
                    rospy.rostime.wallsleep(0.01)
                chaos.calm()
                status = node.status(lambda status: not status.paused)
                self.assertLess(status.volume_error, 1e-6, chaos.done)
                self.assertTrue(math.isfinite(status.volume) and math.isfinite(status.max_speed), status)
                memories.append(memory(node.process))
            node.assert_well(self)
            print("longest answer %.2f s; resident memory, MB: %s" % (chaos.longest, [m >> 20 for m in memories]))
            self.assertLess(chaos.longest, 10.0 * float(os.environ.get("SLOWER", "1")))
            if "NO_MEMORY_LAW" not in os.environ:
                # Its first third is spent on getting warm.
                warm = memories[len(memories) // 3]
                self.assertLess(memories[-1] - warm, 0.1 * warm + (16 << 20), memories)


if __name__ == "__main__":
    rospy.init_node("test_soak", disable_rostime=True)
    rostest.rosrun("shallow_sand", "soak", Soak)
