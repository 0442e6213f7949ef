"""A robot mirrored over RTDE: from the simulated controller, and from a server written here from the protocol's guide."""

import socket
import struct
import threading
import time
import unittest

import gateway as g
import mcap_structure

JOINTS = 6
VARIABLES = b"timestamp,actual_q,actual_qd,robot_mode,safety_mode"
TYPES = b"DOUBLE,VECTOR6D,VECTOR6D,INT32,INT32"
ALL_VARIABLES = VARIABLES + b",actual_current,target_moment,speed_scaling,runtime_state"
ALL_TYPES = TYPES + b",VECTOR6D,VECTOR6D,DOUBLE,UINT32"


def package(kind, payload=b""):
    return struct.pack(">HB", len(payload) + 3, kind) + payload


class Controller(threading.Thread):
    """Answers one client after another. `types` is what it answers for the variables; an older one does not know all."""

    def __init__(self, port, types=TYPES, rate=125.0, knows_all=False):
        super().__init__(daemon=True)
        self.types, self.rate, self.q0, self.knows_all = types, rate, 0.0, knows_all
        self.ahead, self.recipe = 0.0, b"\x07"
        self.requests, self.sent, self.stop = [], [], threading.Event()
        self.listener = socket.create_server(("127.0.0.1", port))
        self.listener.settimeout(0.2)

    def run(self):
        while not self.stop.is_set():
            try:
                client, _ = self.listener.accept()
            except TimeoutError:
                continue
            with client:
                client.settimeout(60)
                try:
                    self.serve(client)
                except OSError:
                    pass
        self.listener.close()

    def request(self, client):
        def exactly(count):
            data = b""
            while len(data) < count:
                more = client.recv(count - len(data))
                if not more:
                    raise ConnectionError
                data += more
            return data

        length, kind = struct.unpack(">HB", exactly(3))
        payload = exactly(length - 3)
        self.requests.append((kind, payload))
        return payload

    def serve(self, client):
        self.request(client)
        client.sendall(package(86, b"\x01"))
        variables = self.request(client)[8:]
        if variables == ALL_VARIABLES and not self.knows_all:
            client.sendall(package(79, b"\x07" + TYPES + b",NOT_FOUND" * 4))
            variables = self.request(client)[8:]
        has_all = variables == ALL_VARIABLES
        client.sendall(package(79, b"\x07" + (ALL_TYPES if has_all else self.types)))
        self.request(client)
        client.sendall(package(83, b"\x01"))
        start = time.monotonic()
        while not self.stop.wait(1 / self.rate):
            q = [self.q0, 0.2, 0.3, 0.4, 0.5, 0.6]
            stamp = 100 + time.monotonic() - start + self.ahead
            more = struct.pack(">6d6ddI", *[1.5] * 6, *[20.0] * 6, 0.25, 2) if has_all else b""
            self.sent.append(self.recipe + struct.pack(">d6d6dii", stamp, *q, *[0.0] * 6, 7, 1) + more)
            client.sendall(package(85, self.sent[-1]))

    def close(self):
        self.stop.set()
        self.join()


class Rtde(unittest.TestCase):
    def setUp(self):
        self.port = g.free_port()
        self.scratch = g.Scratch("ros2_cell")
        text = self.scratch.cell_file.read_text()
        begin = text.index("[[stream]]")
        end = text.index("[dds_output]")
        self.scratch.cell_file.write_text(
            text[:begin] + f'[[stream]]\nrobot = "demo_arm"\nkind = "rtde"\naddress = "127.0.0.1"\nport = {self.port}\n'
            'stale_after_s = 0.3\nlost_after_s = 1.0\nplausibility = false\n' + text[text.index("\n[startup]", end):])
        checked = self.scratch.cellmirror("check", str(self.scratch.cell_file))
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        self.gateway = g.Gateway(self.scratch)
        done = self.scratch.send("ROBOT demo_arm online")
        self.assertEqual(done.returncode, 0, done.stderr)

    def tearDown(self):
        self.gateway.close()
        self.scratch.remove()

    def stream(self):
        return self.scratch.robot("demo_arm")["stream"]

    def fresh(self):
        self.assertTrue(g.eventually(lambda: self.stream()["state"] == "fresh"), self.stream())

    def position(self):
        return self.scratch.robot("demo_arm")["joints"][0]["position"]

    def record(self, seconds, *arguments):
        """The structure of a recording of so many seconds."""
        file = self.scratch.root / "a.mcap"
        done = self.scratch.cellmirror("record", "-o", str(file), "--for", str(seconds), "--compression", "none", "--attach-mb", "0",
                                       "--instance", self.scratch.instance, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return mcap_structure.Recording(file.read_bytes())

    def packages(self, recording):
        """(receive time in ns, package) of each."""
        channel, = [one for one in recording.channels.values() if one[2] == "/inputs/rtde/demo_arm"]
        self.assertEqual((channel[3], recording.schemas[channel[1]][1]), ("cellmirror.rtde", "cellmirror.RtdeData"))
        return [(published, data) for topic, _, _, published, data in recording.messages if topic == channel[2]]

    def test_the_simulated_controller_is_mirrored_and_comes_back(self):
        self.assertEqual(self.stream()["state"], "none")
        sim = g.sim_robot("rtde", "--port", str(self.port), "--rate", "125", "--motion", "sine:amplitude=0.3,period=2")
        self.addCleanup(sim.close)
        self.fresh()
        self.assertIn("running", self.stream()["condition"])
        first = self.position()
        self.assertTrue(g.eventually(lambda: abs(self.position() - first) > 0.02))
        packages = self.packages(self.record(1.5, "--topics", "/inputs/rtde/*"))
        self.assertGreater(len(packages), 20)
        decoded = [struct.unpack_from(">Bd6d6dii", data) for _, data in packages]
        for before, after in zip(decoded, decoded[1:]):
            self.assertGreater(after[1], before[1], "the controller's time")
            self.assertLess(max(abs(a - b) for a, b in zip(before[2:8], after[2:8])), 0.61, "actual_q, rad")
        self.assertGreater(max(one[2] for one in decoded) - min(one[2] for one in decoded), 0.05)
        received = [time for time, _ in packages]
        self.assertLess(abs(received[0] - time.time_ns()), 60e9)
        # Most arrive as late as the quickest one.
        delays = sorted(received[i] * 1e-9 - decoded[i][1] for i in range(len(decoded)))
        self.assertLess(delays[len(delays) // 2] - delays[0], 0.3)
        sim.close()
        self.assertTrue(g.eventually(lambda: self.stream()["state"] == "lost"), self.stream())
        again = g.sim_robot("rtde", "--port", str(self.port), "--rate", "125")
        self.fresh()
        again.close()

    def test_faults_of_the_controller_are_counted(self):
        sim = g.sim_robot("rtde", "--port", str(self.port), "--rate", "125", "--fault", "nan:p=0.1,joint=2", "--fault", "loss:p=0.2")
        self.fresh()
        self.assertTrue(g.eventually(lambda: self.stream()["rejected"] > 3 and self.stream()["lost"] > 3), self.stream())
        sim.close()

    def test_a_controller_of_others(self):
        controller = Controller(self.port)
        controller.start()
        try:
            self.fresh()
            controller.q0 = 0.4
            self.assertTrue(g.eventually(lambda: abs(self.position() - 0.4) < 1e-9), self.position())
            self.assertEqual([kind for kind, _ in controller.requests[:4]], [86, 79, 79, 83])
            self.assertEqual(controller.requests[0][1], b"\x00\x02")
            self.assertEqual(controller.requests[1][1], struct.pack(">d", 125.0) + ALL_VARIABLES)
            self.assertEqual(controller.requests[2][1], struct.pack(">d", 125.0) + VARIABLES)
            recorded = [data for _, data in self.packages(self.record(1, "--topics", "/inputs/rtde/*"))]
            self.assertGreater(len(recorded), 10)
            begin = controller.sent.index(recorded[0])
            self.assertEqual(recorded, controller.sent[begin:begin + len(recorded)], "each package, byte by byte")
        finally:
            controller.close()

    def test_effort_speed_and_program_are_shown(self):
        controller = Controller(self.port, knows_all=True)
        controller.start()
        try:
            self.fresh()
            self.assertAlmostEqual(self.scratch.robot("demo_arm")["joints"][0]["effort"], 20.0)
            details = self.stream()["details"]
            self.assertEqual(details["speed scaling"], "25 %")
            self.assertEqual(details["program"], "playing")
        finally:
            controller.close()

    def test_a_time_that_jumps_and_packages_that_are_refused(self):
        controller = Controller(self.port)
        controller.start()
        try:
            self.fresh()
            controller.ahead = -50.0
            controller.q0 = 0.3
            self.assertTrue(g.eventually(lambda: abs(self.position() - 0.3) < 1e-9), self.stream())
            controller.ahead = 5000.0
            controller.q0 = 0.1
            self.assertTrue(g.eventually(lambda: abs(self.position() - 0.1) < 1e-9), self.stream())
            controller.recipe = b"\x09"
            self.assertTrue(g.eventually(lambda: "another length or recipe" in self.stream()["condition"]), self.stream())
            controller.recipe = b"\x07"
            self.fresh()
        finally:
            controller.close()

    def test_a_controller_without_the_variables_is_refused_with_the_reason(self):
        controller = Controller(self.port, types=b"DOUBLE,VECTOR6D,NOT_FOUND,INT32,INT32")
        controller.start()
        try:
            self.assertTrue(g.eventually(lambda: "NOT_FOUND" in self.stream()["condition"]), self.stream())
            self.assertEqual(self.stream()["state"], "none")
        finally:
            controller.close()


if __name__ == "__main__":
    g.main()
