#!/usr/bin/python3
"""What one node did, tf and calls of services alike, another does again from a bag: with the same bits."""
import io
import math
import os
import random
import signal
import subprocess
import tempfile
import time
import unittest
import xmlrpc.client

import rosgraph
import roslib.packages
import rospy
import rostest
from dynamic_reconfigure.client import Client
from geometry_msgs.msg import Point, PointStamped, Pose, PoseStamped, Quaternion, Vector3
from rosgraph_msgs.msg import Clock
from sand_test import SCENE, Place, RunningNode, World, link, robot, service, wait_until
from shallow_sand.msg import BodyStatus, PourSand, ServiceCall, Status
from shallow_sand.srv import AddBody, AddBodyRequest, EditSand, EditSandRequest, MoveBody, RemoveBody, StateFile
from shape_msgs.msg import SolidPrimitive
from std_msgs.msg import Header
from std_srvs.srv import SetBool, Trigger

FRAME = 0.02  # s, of the sand
FRAMES = {"blade": lambda now: Place(0.5 + 0.3 * math.sin(now), 0.5, 0.1), "hand": lambda now: Place(0.5, 0.5 + 0.2 * math.cos(now), 0.3)}
LAG, DELAY = 0.4, 3.0  # s, of the sand behind the clock, and behind that of a bag


def at(x, y, z, frame):
    return PoseStamped(Header(frame_id=frame), Pose(Point(x, y, z), Quaternion(0.0, 0.0, 0.0, 1.0)))


def serialised(request):
    buffer = io.BytesIO()
    request.serialize(buffer)
    return buffer.getvalue()


class Everything:
    """Calls and pours at random."""

    def __init__(self, node, chance):
        self.chance = chance
        self.calls = {name: service(node, name, kind) for name, kind in
                      (("edit_sand", EditSand), ("add_body", AddBody), ("move_body", MoveBody), ("remove_body", RemoveBody))}
        self.pour = rospy.Publisher(node.name + "/pour", PourSand, queue_size=100)
        self.bodies = []
        self.made = 0
        wait_until(lambda: self.pour.get_num_connections() > 0, "a subscriber of ~pour")

    def place(self, frame):
        x, y = self.chance.uniform(0.2, 0.8), self.chance.uniform(0.2, 0.8)
        return (x - 0.5, y - 0.5) if frame == "hand" else (x, y)

    def do_one(self):
        frame = self.chance.choice(("sand", "hand"))
        x, y = self.place(frame)
        action = self.chance.choice((self.edit, self.pour_some, self.add, self.move, self.remove))
        answer = action(frame, x, y)
        assert answer is None or answer.success, answer.message

    def edit(self, frame, x, y):
        operation = self.chance.choice((EditSandRequest.ADD, EditSandRequest.REMOVE, EditSandRequest.SET))
        return self.calls["edit_sand"](center=PointStamped(Header(frame_id=frame), Point(x, y, 0.0)), shape=EditSandRequest.RECTANGLE,
                                       size_x=self.chance.uniform(0.1, 0.3), size_y=self.chance.uniform(0.1, 0.3), operation=operation,
                                       value=self.chance.uniform(0.0, 0.1))

    def pour_some(self, frame, x, y):
        for _ in range(self.chance.randrange(1, 5)):
            self.pour.publish(PourSand(position=PointStamped(Header(frame_id=frame), Point(x, y, 0.0)),
                                       radius=self.chance.uniform(0.06, 0.2), volume=self.chance.uniform(-1e-3, 2e-3)))

    def add(self, frame, x, y):
        self.made += 1
        self.bodies.append(f"body_{self.made}")
        follow = frame == "hand" and self.chance.random() < 0.5
        shape = SolidPrimitive(type=SolidPrimitive.BOX, dimensions=[self.chance.uniform(0.08, 0.2) for _ in range(3)])
        return self.calls["add_body"](name=self.bodies[-1], shape=shape, pose=at(x, y, -0.2 if frame == "hand" else 0.1, frame), follow=follow,
                                      scale=Vector3())

    def move(self, frame, x, y):
        if self.bodies:
            self.calls["move_body"](name=self.chance.choice(self.bodies), pose=at(x, y, -0.2 if frame == "hand" else 0.1, frame),
                                    duration=self.chance.choice((0.0, self.chance.uniform(0.2, 1.0))))

    def remove(self, frame, x, y):
        if self.bodies:
            return self.calls["remove_body"](name=self.bodies.pop(self.chance.randrange(len(self.bodies))))


class Told:
    """The ~status of a node that left no time out since its last ~reset."""

    def __init__(self, node):
        self.messages = []
        self.subscriber = rospy.Subscriber(node.name + "/status", Status, self.messages.append)

    def time_given_up(self):
        resets = [status for status in self.messages if status.simulated_time == 0.0]
        return self.messages[-1].time_given_up - resets[-1].time_given_up


class Recorder:
    """rosbag record, and both topics connected."""

    def __init__(self, path, node, world):
        topic = node.name + "/calls"
        # Not through the command rosbag, which may keep a signal to itself.
        record = roslib.packages.find_node("rosbag", "record")[0]
        self.process = subprocess.Popen([record, "-O", path, "/tf", topic, "__name:=recorder"], stdout=subprocess.DEVNULL)
        master = rosgraph.Master("/test")

        def connected():
            info = xmlrpc.client.ServerProxy(master.lookupNode(node.name)).getBusInfo("/test")[2]
            return any(connection[4] == topic and connection[1] == "/recorder" for connection in info)

        wait_until(connected, "a recorder of " + topic)
        wait_until(lambda: world.tf.get_num_connections() == 2, "a recorder of /tf")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=20)


class Replay(unittest.TestCase):
    def setUp(self):
        rospy.set_param("/robot_description", robot("digger", link("blade")))
        self.folder = tempfile.TemporaryDirectory()
        seed = random.randrange(2**32)
        print("seed", seed)
        self.chance = random.Random(seed)

    def tearDown(self):
        self.folder.cleanup()

    def parameters(self, **others):
        return dict(SCENE, state_folder=self.folder.name, **others)

    def saved(self, node, name):
        answer = service(node, "save", StateFile)(name)
        self.assertTrue(answer.success, answer.message)
        with open(os.path.join(self.folder.name, name), "rb") as file:
            return file.read()

    def record(self, bag, name):
        """Returns the time of the sand at the end and its state; None if time was left out."""
        with World(FRAMES) as world, RunningNode(name, self.parameters(tf_delay=LAG)) as node:
            told = Told(node)
            node.body("blade", lambda body: body.state == BodyStatus.MOVING)
            everything = Everything(node, self.chance)
            reconfigure = Client(node.name + "/reconfigure", timeout=10.0)
            with Recorder(bag, node, world):
                # The bag has tf from before ~reset on, in the time of the sand.
                begin = world.now
                wait_until(lambda: world.now > begin + 2.0 * LAG, "time goes on")
                self.assertTrue(service(node, "reset", Trigger)().success)
                # Not before: volumes of the ledger keep the roundings of what was poured before ~reset.
                reconfigure.update_configuration({"pour_rate": 0.002, "pour_x": 0.3, "pour_y": 0.7})
                end = time.monotonic() + 2.0
                while time.monotonic() < end:
                    everything.do_one()
                    rospy.rostime.wallsleep(self.chance.uniform(0.0, 0.1))
                self.assertTrue(service(node, "pause", SetBool)(True).success)
                status = node.status(lambda status: status.paused)
                state = self.saved(node, name + ".tif")
            self.assertLess(status.volume_error, 1e-6)
            self.assertGreater(status.volume_poured, 0.0)
            return (status.header.stamp, state) if told.time_given_up() == 0.0 else None

    def play(self, bag, recorded, name, stamp):
        """The state at a time of the sand; None if time was left out, or calls came too late."""
        clock = rospy.Publisher("/clock", Clock, queue_size=100)
        times = []
        rospy.Subscriber("/clock", Clock, lambda message: times.append(message.clock))
        with RunningNode(name, self.parameters(tf_delay=DELAY, replay_calls=recorded + "/calls")) as node:
            told = Told(node)
            # The link is read before tf comes.
            wait_until(lambda: clock.publish(Clock(rospy.Time(50))) or told.messages and told.messages[-1].bodies, "the link")
            subprocess.run(["rosbag", "play", "--clock", "--queue", "1000", "-r", "2", bag], stdout=subprocess.DEVNULL, check=True, timeout=30)
            now = times[-1]
            while now < stamp + rospy.Duration(DELAY + 0.25 * FRAME):
                now = min(now + rospy.Duration(FRAME), stamp + rospy.Duration(DELAY + 0.25 * FRAME))
                clock.publish(Clock(now))
                rospy.rostime.wallsleep(0.5 * FRAME)
            status = node.status(lambda status: status.header.stamp >= stamp)
            self.assertEqual(status.header.stamp, stamp)
            state = self.saved(node, name + ".tif")
            clock.unregister()
            if told.time_given_up() > 0.0 or node.error_lines("/calls", "too late"):
                return None
            self.assertEqual(node.error_lines("/calls"), [])
            return state

    def test_the_same_bits_from_a_bag(self):
        # On a machine that other things hold up time may be left out, or calls come late, which is told; then there is nothing to compare.
        for attempt in range(3):
            bag = os.path.join(self.folder.name, f"{attempt}.bag")
            recorded = self.record(bag, f"recorded_{attempt}")
            if recorded is None:
                continue
            stamp, state = recorded
            again = self.play(bag, f"/recorded_{attempt}", f"replayed_{attempt}", stamp)
            if again is None:
                continue
            self.assertEqual(state, again)
            return
        self.fail("the machine was held up again and again")

    def test_calls_take_effect_between_the_frames_that_they_name(self):
        with World({}) as world, RunningNode("punctual", dict(SCENE, robot_description="", tf_delay=2.0, replay_calls="/bag")) as node:
            done = []
            rospy.Subscriber(node.name + "/calls", ServiceCall, done.append)
            bag = rospy.Publisher("/bag", ServiceCall, queue_size=1000)
            wait_until(lambda: bag.get_num_connections() == 1, "a subscriber of /bag")
            node.status(lambda status: status.simulated_time > 0.0)
            wanted = []
            now = world.now
            for k in range(200):
                frame = math.floor((now - self.chance.uniform(0.0, 1.0)) / FRAME)
                stamp = rospy.Time(frame // 50, frame % 50 * 20000000)
                message = PourSand(position=PointStamped(point=Point(0.5, 0.5, 0.0)), radius=0.1, volume=1e-5 * k)
                wanted.append(ServiceCall(Header(stamp=stamp, frame_id="sand"), "pour", serialised(message)))
                bag.publish(wanted[-1])
            wait_until(lambda: len(done) == len(wanted), "all calls")
            wanted.sort(key=lambda call: call.header.stamp)  # stable: of one time in their order
            self.assertEqual([(call.header.stamp, call.request) for call in done], [(call.header.stamp, call.request) for call in wanted])
            self.assertAlmostEqual(node.status(lambda status: status.volume_poured > 0.19).volume_poured, 1e-5 * 199 * 100, delta=1e-6)
            self.assertEqual(node.error_lines("/bag"), [])

    def test_calls_that_are_late_or_malformed(self):
        good = EditSandRequest(center=PointStamped(Header(frame_id="sand"), Point(0.5, 0.5, 0.0)), radius=0.2, value=0.1)
        body = AddBodyRequest(name="box", shape=SolidPrimitive(type=SolidPrimitive.BOX, dimensions=[0.1, 0.1, 0.1]), pose=at(0.5, 0.5, 0.5, ""))
        edit, add = serialised(good), serialised(body)
        lengths = add.index(bytes([SolidPrimitive.BOX, 3, 0, 0, 0])) + 1
        malformed = [
            ("set_sand", edit, "service: set_sand", "edit_sand"),
            ("", b"", "service: ;"),
            ("edit_sand", edit[:self.chance.randrange(len(edit))], "edit_sand is refused", "the message has ended"),
            ("edit_sand", edit + bytes(3), "3 bytes too many"),
            ("edit_sand", bytes(70000), "70000 bytes"),
            # Thirty gigabytes of dimensions.
            ("add_body", add[:lengths] + b"\xff\xff\xff\xff" + add[lengths + 4:], "add_body is refused", "a list is longer than its message"),
            ("edit_sand", serialised(EditSandRequest()), "center.header.frame_id: "),
        ]
        with World({}) as world, RunningNode("careful", dict(SCENE, robot_description="", tf_delay=0.1, replay_calls="/bag")) as node:
            bag = rospy.Publisher("/bag", ServiceCall, queue_size=1000)
            wait_until(lambda: bag.get_num_connections() == 1, "a subscriber of /bag")
            start = node.status(lambda status: status.simulated_time > 0.0)
            late = node.status().header.stamp - rospy.Duration(1.0)
            for _ in range(5):
                bag.publish(ServiceCall(Header(stamp=late), "edit_sand", edit))
            self.assertEqual(len(node.wait_for_error("/bag", "edit_sand", "too late", "~tf_delay")), 1)
            poured = node.status(lambda status: status.volume_poured > 0.0)
            self.assertAlmostEqual(poured.volume_poured, 5 * 0.1 * math.pi * 0.2**2, delta=0.01)
            for name, request, *words in malformed:
                call = ServiceCall(Header(stamp=start.header.stamp), name, request)
                # The log tells again after five seconds.
                world.set_time(world.now + 5.1)
                wait_until(lambda: bag.publish(call) or node.error_lines("/bag", "refused", *words), words)
            after = node.status(lambda status: status.simulated_time > poured.simulated_time)
            self.assertEqual((after.volume_poured, after.bodies), (poured.volume_poured, []))
            # While it replays, others may call.
            self.assertTrue(service(node, "edit_sand", EditSand)(good).success)
            node.assert_well(self)

    def test_topics_that_are_refused(self):
        for number, topic in enumerate(("not a name", "/own_1/calls")):
            with RunningNode(f"own_{number}", dict(SCENE, replay_calls=topic)) as node:
                self.assertEqual(node.process.wait(timeout=20), 2)
                self.assertEqual(len(node.error_lines("replay_calls", topic)), 1, node.error_lines())


if __name__ == "__main__":
    rospy.init_node("test_replay", disable_rostime=True)
    rostest.rosrun("shallow_sand", "replay", Replay)
