#!/usr/bin/python3
"""Sand is edited and asked about through services, in any tf frame; what makes no sense is refused and changes nothing."""
import math
import os
import struct
import tempfile
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import Point, Point32, PointStamped, Polygon, PolygonStamped
from sand_test import SCENE, Place, RunningNode, transform
from sensor_msgs.msg import PointCloud2, PointField
from shallow_sand.srv import EditSand, EditSandRequest, QuerySurface, SetSand, SetSandRequest, StateFile, VolumeInPolygon
from std_msgs.msg import Header, String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker

PARAMETERS = dict(SCENE, robot_description="")
DEPTH = SCENE["sand"][0]["depth"]
SPACING = SCENE["grid"]["spacing"]
NAN, INFINITY = math.nan, math.inf
# Turned by a right angle about z: x is the sand's y.
FRAMES = {"turned": Place(0.5, 0.2, 1.0, rotation=(0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))}


def stamped(frame, x, y, z=0.0):
    return PointStamped(Header(frame_id=frame), Point(x, y, z))


def edit(**fields):
    request = EditSandRequest(center=stamped("sand", 0.5, 0.5), shape=EditSandRequest.RECTANGLE, size_x=0.2, size_y=0.4, value=0.05)
    for name, value in fields.items():
        setattr(request, name, value)
    return request


def polygon(frame, *corners):
    return PolygonStamped(Header(frame_id=frame), Polygon([Point32(x, y, 0.0) for x, y in corners]))


def cloud(frame, points):
    message = PointCloud2(header=Header(frame_id=frame), height=1, width=len(points), point_step=12, row_step=12 * len(points), is_dense=True)
    message.fields = [PointField(name, 4 * k, PointField.FLOAT32, 1) for k, name in enumerate("xyz")]
    message.data = b"".join(struct.pack("<fff", *point) for point in points)
    return message


def middles(x_min, x_max, y_min, y_max):
    """Of the cells of a rectangle."""
    def along(low, high):
        return [low + (k + 0.5) * SPACING for k in range(round((high - low) / SPACING))]
    return [(x, y) for x in along(x_min, x_max) for y in along(y_min, y_max)]


class Services:
    def __init__(self, node):
        kinds = {"edit_sand": EditSand, "query_surface": QuerySurface, "volume_in_polygon": VolumeInPolygon,
                 "set_sand": SetSand, "save": StateFile}
        for name, kind in kinds.items():
            rospy.wait_for_service(f"{node.name}/{name}", timeout=20.0)
            setattr(self, name, rospy.ServiceProxy(f"{node.name}/{name}", kind))


class Editing(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.tf = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        cls.tf.publish(TFMessage([transform(frame, place, 0.0) for frame, place in FRAMES.items()]))

    def wait_for_frame(self, services):
        """tf comes when it comes."""
        deadline = rospy.get_time() + 20.0
        while rospy.get_time() < deadline:
            if services.query_surface(Header(frame_id="turned"), []).success:
                return
            rospy.rostime.wallsleep(0.02)
        self.fail("no tf within 20 s")

    def assert_refused(self, response, node, service, *words):
        self.assertFalse(response.success)
        for word in words:
            self.assertIn(word, response.message)
        node.wait_for_error(f"~{service} is refused")

    def test_edits_do_what_they_say(self):
        with RunningNode("edits", PARAMETERS) as node:
            services = Services(node)
            self.wait_for_frame(services)
            area = 0.2 * 0.4
            volume = DEPTH * 1.0
            # In the turned frame, the middle of the map is at (0.3, 0), and the rectangle is not turned.
            cases = [
                (edit(operation=EditSandRequest.ADD), 0.05 * area),
                (edit(operation=EditSandRequest.SET, value=DEPTH, center=stamped("turned", 0.3, 0.0, 7.0)), None),
                (edit(operation=EditSandRequest.REMOVE, value=1e6, size_x=2.0, size_y=2.0), None),
                (edit(operation=EditSandRequest.LEVEL, value=0.08), 0.08 * area),
                (edit(operation=EditSandRequest.LEVEL, value=-3.0, size_x=2.0, size_y=2.0), None),
                (edit(operation=EditSandRequest.ADD, shape=EditSandRequest.DISC, radius=1.0), 0.05),
            ]
            for request, expected in cases:
                response = services.edit_sand(request)
                self.assertTrue(response.success, response.message)
                if expected is not None:
                    self.assertAlmostEqual(response.volume, expected, delta=1e-6)
                volume += response.volume
                status = node.status(lambda status: abs(status.volume - volume) < 1e-6)
                self.assertLess(status.volume_error, 1e-6)
            self.assertAlmostEqual(volume, 0.05, delta=1e-6)

    def test_edits_that_are_refused(self):
        with RunningNode("bad_edits", PARAMETERS) as node:
            services = Services(node)
            before = node.status()
            cases = [
                (edit(center=stamped("", 0.5, 0.5)), "frame_id", "empty", "tf frame"),
                (edit(center=stamped("nowhere", 0.5, 0.5)), "frame_id", "nowhere"),
                (edit(center=stamped("sand", NAN, 0.5)), "center"),
                (edit(center=stamped("sand", 0.5, INFINITY)), "center"),
                (edit(center=stamped("sand", 0.5, 0.5, NAN)), "center"),
                (edit(center=stamped("sand", 5.0, 0.5)), "center", "a place on the grid"),
                (edit(center=stamped("sand", -1e300, 0.5)), "center", "-1e+300"),
                (edit(size_x=0.0), "size", "positive"),
                (edit(size_y=NAN), "size"),
                (edit(size_y=INFINITY), "size"),
                (edit(size_y=1e300), "size"),
                (edit(shape=EditSandRequest.DISC), "radius", "positive"),
                (edit(shape=EditSandRequest.DISC, radius=-1.0), "radius", "-1"),
                (edit(shape=EditSandRequest.DISC, radius=NAN), "radius"),
                (edit(shape=2), "shape", "2", "DISC or RECTANGLE"),
                (edit(operation=4), "operation", "4", "LEVEL"),
                (edit(value=NAN), "value"),
                (edit(value=-INFINITY), "value"),
                (edit(value=-0.1), "value", "-0.1", "not negative"),
                (edit(value=1e7), "value", "million"),
            ]
            for request, *words in cases:
                response = services.edit_sand(request)
                self.assert_refused(response, node, "edit_sand", *words)
                self.assertEqual(response.volume, 0.0)
            # All within less than five seconds, or told once more.
            self.assertLessEqual(len(node.error_lines("~edit_sand is refused")), 3)
            after = node.status(lambda status: status.simulated_time > before.simulated_time)
            self.assertEqual(after.volume_poured, 0.0)
            self.assertEqual(after.volume_left, 0.0)
            self.assertAlmostEqual(after.volume, before.volume, delta=1e-9)

    def test_the_surface_is_known(self):
        # A bed that falls by 0.1 along x, under sand that is even.
        slope = dict(PARAMETERS, bed={"slope": [-0.1, 0.0]})
        with RunningNode("queries", slope) as node:
            services = Services(node)
            self.wait_for_frame(services)
            places = [(0.01, 0.99), (0.5, 0.5), (0.73, 0.21), (1.0, 0.0), (1.01, 0.5), (0.5, -0.01)]
            answer = services.query_surface(Header(frame_id="sand"), [Point(x, y, 5.0) for x, y in places])
            self.assertTrue(answer.success, answer.message)
            self.assertEqual(list(answer.inside), [True] * 4 + [False] * 2)
            for (x, y), surface, depth, normal, inside in zip(places, answer.surface, answer.depth, answer.normal, answer.inside):
                if not inside:
                    for value in (surface.x, surface.y, surface.z, depth, normal.x, normal.y, normal.z):
                        self.assertTrue(math.isnan(value))
                    continue
                self.assertAlmostEqual(surface.x, x)
                self.assertAlmostEqual(surface.y, y)
                self.assertAlmostEqual(surface.z, DEPTH - 0.1 * x, delta=1e-5)
                self.assertAlmostEqual(depth, DEPTH, delta=1e-5)
                self.assertAlmostEqual(normal.x, 0.1 / math.sqrt(1.01), delta=1e-4)
                self.assertAlmostEqual(normal.z, 1.0 / math.sqrt(1.01), delta=1e-4)
            # The sand's x is the turned frame's -y.
            turned = services.query_surface(Header(frame_id="turned"), [Point(0.1, -0.2, 0.0)])
            self.assertAlmostEqual(turned.surface[0].x, 0.1, delta=1e-6)
            self.assertAlmostEqual(turned.surface[0].y, -0.2, delta=1e-6)
            self.assertAlmostEqual(turned.surface[0].z, DEPTH - 0.1 * 0.7 - 1.0, delta=1e-5)
            self.assertAlmostEqual(turned.normal[0].y, -0.1 / math.sqrt(1.01), delta=1e-4)
            many = services.query_surface(Header(frame_id="sand"), [Point(0.5, 0.5, 0.0)] * 100000)
            self.assertEqual(len(many.depth), 100000)
            point = [Point(0.5, 0.5, 0.0)]
            for header, points, *words in [
                (Header(), point, "frame_id", "empty"),
                (Header(frame_id="nowhere"), point, "frame_id", "nowhere"),
                (Header(frame_id="sand"), point + [Point(NAN, 0.0, 0.0)], "points[1]", "finite"),
                (Header(frame_id="sand"), [Point(0.0, 0.0, INFINITY)], "points[0]", "finite"),
                (Header(frame_id="sand"), point * 100001, "100001", "at most 100000"),
            ]:
                refused = services.query_surface(header, points)
                self.assert_refused(refused, node, "query_surface", *words)
                self.assertEqual(len(refused.surface), 0)
            node.assert_well(self)

    def test_volumes_are_known(self):
        with RunningNode("volumes", PARAMETERS) as node:
            services = Services(node)
            self.wait_for_frame(services)
            volume_of = services.volume_in_polygon
            whole = volume_of(polygon("sand", (-1, -1), (2, -1), (2, 2), (-1, 2)))
            self.assertTrue(whole.success, whole.message)
            self.assertAlmostEqual(whole.area, 1.0, delta=1e-6)
            self.assertAlmostEqual(whole.on_ground, node.status().volume, delta=1e-9)
            self.assertEqual(whole.on_bodies, 0.0)
            triangle = volume_of(polygon("sand", (0.11, 0.13), (0.81, 0.17), (0.33, 0.77)))
            self.assertAlmostEqual(triangle.area, 0.5 * (0.70 * 0.64 - 0.04 * 0.22), delta=1e-6)
            self.assertAlmostEqual(triangle.on_ground, DEPTH * triangle.area, delta=1e-6)
            # Half a metre about the turned frame's origin, of which a part lies beside the map.
            turned = volume_of(polygon("turned", (-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)))
            self.assertAlmostEqual(turned.area, 0.7, delta=1e-6)
            square = ((0, 0), (1, 0), (1, 1), (0, 1))
            for request, *words in [
                (polygon("", *square), "frame_id", "empty"),
                (polygon("nowhere", *square), "frame_id", "nowhere"),
                (polygon("sand", (0, 0), (1, 0)), "2 corners", "from 3"),
                (polygon("sand"), "0 corners"),
                (polygon("sand", (0, 0), (1, 1), (1, 0), (0, 1)), "meets"),
                (polygon("sand", (0, 0), (1, NAN), (1, 0)), "nan"),
                (polygon("sand", (0, 0), (INFINITY, 1), (1, 0)), "inf"),
                (polygon("sand", *(square * 5000)), "20000 corners"),
            ]:
                self.assert_refused(volume_of(request), node, "volume_in_polygon", *words)
            node.assert_well(self)

    def test_the_sand_is_set(self):
        with tempfile.TemporaryDirectory() as folder, RunningNode("sets", dict(PARAMETERS, state_folder=folder)) as node:
            services = Services(node)
            self.wait_for_frame(services)
            latched = {}

            def publish(name, message):
                latched[name] = rospy.Publisher("/" + name, type(message), queue_size=1, latch=True)
                latched[name].publish(message)
                return "/" + name

            def set_sand(expected, **fields):
                response = services.set_sand(SetSandRequest(timeout=10.0, **fields))
                self.assertTrue(response.success, response.message)
                self.assertAlmostEqual(response.volume, expected, delta=1e-6, msg=fields)

            # A part of the map; the rest keeps its sand. In the turned frame, x' = y - 0.2, y' = 0.5 - x, z' = z - 1.
            part = middles(0.2, 0.4, 0.3, 0.8)
            topic = publish("part", cloud("turned", [(y - 0.2, 0.5 - x, 0.3 - 1.0) for x, y in part]))
            set_sand(0.2 * 0.1, topic=topic, heights_as="surface")
            # Its own surface, as points and as a mesh: nothing changes.
            changed = rospy.Time.now()
            for own, kind in (("points", PointCloud2), ("mesh", Marker)):
                while rospy.wait_for_message(f"{node.name}/{own}", kind, timeout=20.0).header.stamp <= changed:
                    pass
                set_sand(0.0, topic=f"{node.name}/{own}", heights_as="surface")
            everywhere = middles(0.0, 1.0, 0.0, 1.0)
            topic = publish("shallow", cloud("sand", [(x, y, 0.05) for x, y in everywhere]))
            set_sand(0.05 - DEPTH - 0.02, topic=topic, heights_as="depth")
            square = Marker(header=Header(frame_id="sand"), type=Marker.TRIANGLE_LIST)
            square.scale.x = square.scale.y = square.scale.z = square.pose.orientation.w = 1.0
            square.points = [Point(x, y, 0.15) for x, y in ((0, 0), (1, 0), (1, 0.5), (0, 0), (1, 0.5), (0, 0.5))]
            set_sand(0.5 * 0.1, topic=publish("square", square), heights_as="surface")
            # A state is a terrain, too; its first band is the bed, which is at zero.
            self.assertTrue(services.save("bed.tif").success)
            set_sand(-0.5 * 0.05 - 0.5 * 0.15, file=os.path.join(folder, "bed.tif"), heights_as="depth")
            status = node.status(lambda status: status.volume < 1e-6)
            self.assertLess(status.volume_error, 1e-6)

    def test_sand_that_is_refused(self):
        with RunningNode("sets_badly", PARAMETERS) as node:
            services = Services(node)
            before = node.status()
            lies = cloud("sand", [(0.5, 0.5, 1.0)])
            lies.width = 1000000000
            messages = {"lies": lies, "no_frame": cloud("", [(0.5, 0.5, 1.0)]), "no_tf": cloud("nowhere", [(0.5, 0.5, 1.0)]),
                        "nan": cloud("sand", [(0.5, 0.5, NAN)]), "beside": cloud("sand", [(5.0, 5.0, 1.0)]),
                        "negative": cloud("sand", [(0.51, 0.51, -1.0)]), "high": cloud("sand", [(0.5, 0.5, 1e7)]),
                        "empty": cloud("sand", []), "text": String("hello"), "lines": Marker(header=Header(frame_id="sand"), type=Marker.LINE_LIST)}
            publishers = []
            for name, message in messages.items():
                publishers.append(rospy.Publisher("/" + name, type(message), queue_size=1, latch=True))
                publishers[-1].publish(message)
            for fields, *words in (
                ({"heights_as": "height", "topic": "/nan"}, "heights_as", "height", "depth or surface"),
                ({"heights_as": ""}, "heights_as", "empty"),
                ({}, "file", "topic", "none"),
                ({"topic": "/nan", "file": "/tmp"}, "both"),
                ({"file": "relative.tif"}, "relative.tif", "absolute"),
                ({"file": "/missing.tif"}, "/missing.tif"),
                ({"file": "/vsicurl/http://localhost/x.tif"}, "file"),
                ({"file": os.path.abspath(__file__)}, "file", os.path.basename(__file__)),
                ({"topic": "/nan", "timeout": 0.0}, "timeout", "above 0"),
                ({"topic": "/nan", "timeout": NAN}, "timeout"),
                ({"topic": "/nan", "timeout": 1e9}, "timeout", "60"),
                ({"topic": "/silent", "timeout": 0.3}, "topic", "/silent", "0.3"),
                ({"topic": "not a name"}, "topic", "not a name"),
                ({"topic": "/lies"}, "width 1000000000"),
                ({"topic": "/no_frame"}, "frame_id", "empty"),
                ({"topic": "/no_tf"}, "frame_id", "nowhere"),
                ({"topic": "/nan"}, "nan"),
                ({"topic": "/beside"}, "no cell"),
                ({"topic": "/empty"}, "no cell"),
                ({"topic": "/negative"}, "-1 in cell (10, 10)", "not negative"),
                ({"topic": "/high"}, "million"),
                ({"topic": "/text"}, "std_msgs/String", "PointCloud2"),
                ({"topic": "/lines"}, "marker", "TRIANGLE_LIST"),
            ):
                response = services.set_sand(SetSandRequest(**{"heights_as": "depth", "timeout": 10.0, **fields}))
                self.assert_refused(response, node, "set_sand", *words)
            # While one waits for a topic, the sand runs and others are answered.
            started = time.monotonic()
            after = node.status(lambda status: status.simulated_time > before.simulated_time)
            self.assertLess(time.monotonic() - started, 5.0)
            self.assertAlmostEqual(after.volume, before.volume, delta=1e-9)
            self.assertEqual(after.volume_poured, 0.0)
            self.assertEqual(after.volume_left, 0.0)


if __name__ == "__main__":
    rospy.init_node("test_editing")
    rostest.rosrun("shallow_sand", "editing", Editing)
