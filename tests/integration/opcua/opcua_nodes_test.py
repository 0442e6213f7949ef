"""What a client finds: nodes as the node sets of OPC 40010-1 (Robotics) and DI demand, values as the gateway has them, nothing that
can be written."""

import json
import math
import unittest

import bridge as b
import gateway as g
from nodesets import BASE, Judge, NodeSets

ROBOTICS = BASE + "Robotics/"
CURRENT_READ = 1


class Nodes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch("transfer_cell", startup=True)
        cls.gateway = g.Gateway(cls.scratch)
        plates = cls.scratch.root / "plates.json"
        plates.write_text(json.dumps({"PUMA_762": {"manufacturer": "Unimation", "model": "PUMA 762", "serial_number": "7",
                                                   "category": "articulated"}}))
        cls.bridge = b.Bridge(cls.scratch, "--nameplates", plates)
        cls.bridge.wait_for("answers: 8 robots")
        cls.nodes = cls.bridge.nodes()
        cls.status = cls.scratch.status()

    @classmethod
    def tearDownClass(cls):
        cls.bridge.close()
        cls.gateway.close()
        cls.scratch.remove()

    def node(self, *names, below=""):
        return self.nodes[f"ns=1;s={'/'.join([self.scratch.instance, *names])}{below}"]

    def test_every_instance_has_what_its_type_demands(self):
        sets = NodeSets([b.NODESETS / f"Opc.Ua.{name}NodeSet2.xml" for name in ("", "Di.", "Robotics.")])
        self.assertGreater(len(sets.nodes), 5000)
        self.assertEqual(Judge(sets, self.nodes).judge_all(), [])
        counts = {}
        for node in self.nodes.values():
            counts[node["type"]] = counts.get(node["type"], 0) + 1
        joints = sum(len(robot["joints"]) for robot in self.status["robots"])
        for number, count in ((1002, 1), (1004, 8), (16601, joints), (16794, joints), (1019, joints), (1003, 1), (1011, 8), (1013, 8)):
            self.assertEqual(counts[f"{ROBOTICS}|i={number}"], count)

    def test_the_judge_sees_what_is_missing(self):
        sets = NodeSets([b.NODESETS / f"Opc.Ua.{name}NodeSet2.xml" for name in ("", "Di.", "Robotics.")])
        for gone, words in ((".SerialNumber", "lacks http://opcfoundation.org/UA/DI/|SerialNumber"), (".Axes", "lacks"),
                            ("/PowerTrains/J_1/Motor", "has none of")):
            less = {name: node for name, node in self.nodes.items() if not name.endswith(f"/PUMA_762{gone}")}
            faults = Judge(sets, less).judge_all()
            self.assertTrue(any(words in fault for fault in faults), (gone, faults[:3]))

    def test_positions_are_those_of_the_gateway(self):
        for robot in self.status["robots"]:
            for joint in robot["joints"]:
                below = ".ParameterSet.ActualPosition"
                position = self.node(robot["id"], "Axes", joint["name"], below=below)
                unit = self.node(robot["id"], "Axes", joint["name"], below=below + ".EngineeringUnits")["value"]
                linear = joint["unit"] == "m"
                self.assertEqual(unit["unitId"], 0x4D4D54 if linear else 0x4444)  # MMT, DD
                if robot["mode"] == "simulated":
                    self.assertEqual(position["status"], "Good")
                    expected = joint["position"] * (1000 if linear else 180 / math.pi)
                    self.assertAlmostEqual(position["value"], expected, places=6)
                else:
                    self.assertEqual((position["status"], position["value"]), ("BadWaitingForInitialData", None))

    def test_what_is_not_known_is_not_told(self):
        for names, below in ((["PUMA_762"], ".ParameterSet.SpeedOverride"), (["", "SafetyStates", "PUMA_762"], ".ParameterSet.EmergencyStop"),
                             (["ZELLENKRAN"], ".SerialNumber"), (["PUMA_762", "PowerTrains", "J_1", "Motor"], ".ParameterSet.MotorTemperature")):
            node = self.node(*names, below=below)
            self.assertEqual((node["status"], node["value"]), ("BadNotSupported", None), node["id"])

    def test_nameplates_are_told(self):
        self.assertEqual(self.node("PUMA_762", below=".Manufacturer")["value"]["text"], "Unimation")
        self.assertEqual(self.node("PUMA_762", below=".SerialNumber")["value"], "7")
        category = self.node("PUMA_762", below=".MotionDeviceCategory")
        self.assertEqual((category["value"], category["status"]), (1, "Good"))
        self.assertEqual(self.node("ZELLENKRAN", below=".MotionDeviceCategory")["status"], "UncertainInitialValue")

    def test_power_trains_move_their_axes(self):
        moves = [child["id"] for child in self.node("PUMA_762", "PowerTrains", "J_1")["children"] if child["by"] == f"{ROBOTICS}|i=18178"]
        self.assertEqual(moves, [self.node("PUMA_762", "Axes", "J_1")["id"]])

    def test_nothing_can_be_written_or_called(self):
        variables = [node for node in self.nodes.values() if node["kind"] == "Variable"]
        self.assertEqual({node["access"] for node in variables}, {CURRENT_READ})
        found = self.bridge.ask("write")
        self.assertEqual((found["outcomes"], found["methods"]), ({"BadNotWritable": len(variables)}, []))


if __name__ == "__main__":
    b.main()
