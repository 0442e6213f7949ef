"""A running gateway under mutated DDS datagrams and mutated packets of its MQTT broker: the loop, the CAN robot and the force do not
notice. FUZZ_SECONDS=600 for longer; CELLMIRROR_SEED repeats a run (default: the day, so that each day tries others)."""

import datetime
import os
import random
import socket
import struct
import time
import unittest

import gateway as g
import guarded_cell
import hostile

SECONDS = float(os.environ.get("FUZZ_SECONDS", "8"))
SEED = int(os.environ.get("CELLMIRROR_SEED", datetime.date.today().strftime("%Y%m%d")))
CORPUS = g.SOURCE / "tests" / "fuzz" / "network"
BATCH = 20
PAUSE_S = 0.05  # between two batches: harm is to be seen, not a full network


def corpus(kind):
    return [path.read_bytes() for path in sorted((CORPUS / kind).iterdir())]


def heard(domain, seconds):
    """What the programs of the domain announce to its group: real datagrams to begin with. Nothing where there is no multicast."""
    found = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as group:
        group.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        group.bind(("", hostile.ports(domain)[0]))
        group.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                         struct.pack("4s4s", socket.inet_aton(hostile.GROUP), socket.inet_aton("127.0.0.1")))
        group.settimeout(0.2)
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                found.append(group.recv(65536))
            except OSError:
                pass
    return found


class NetworkFuzz(unittest.TestCase):
    def test_the_gateway_lives_through_any_bytes_of_the_network(self):
        print(f"CELLMIRROR_SEED={SEED}", flush=True)
        chance = random.Random(SEED)
        cell = guarded_cell.GuardedCell()
        self.addCleanup(cell.close)
        datagrams, packets = corpus("rtps"), corpus("mqtt")
        datagrams += heard(cell.domain, 2.0)
        cell.broker.fault = lambda: b"".join(hostile.mutated(chance, chance.choice(packets)) for _ in range(3))
        end, sent, can_states, forces = time.monotonic() + SECONDS, 0, [], []
        while time.monotonic() < end:
            for _ in range(BATCH):
                packet = chance.choice(datagrams)
                cell.datagrams.send(packet if chance.random() < 0.1 else hostile.mutated(chance, packet))
                sent += 1
            if sent % (10 * BATCH) == 0:
                cell.broker.drop()
                can_states.append(cell.scratch.robot("MANTEC_R3")["stream"]["state"])
                forces.append(cell.force())
            time.sleep(PAUSE_S)
        processes = {one["subject"]: (one["restarts"], one["last_exit"]) for one in cell.scratch.status()["processes"]}
        print(f"{sent} datagrams, {cell.broker.connections} connections: {processes}", flush=True)
        self.assertTrue(cell.gateway.running(), cell.gateway.output())
        self.assertNotIn("lost", can_states)
        self.assertGreaterEqual(can_states.count("fresh"), guarded_cell.FRESH_LOOKS * len(can_states), can_states)
        felt = [force for force in forces if force > guarded_cell.NO_FORCE_N]
        self.assertGreaterEqual(len(felt), guarded_cell.FORCE_LOOKS * len(forces), forces)
        self.assertTrue(cell.page_answers())
        cell.broker.fault = None
        cell.broker.drop()
        self.assertTrue(g.eventually(lambda: cell.fresh("PUMA_762")), "DDS recovers by itself")
        self.assertTrue(g.eventually(lambda: not any(problem["kind"] == "mqtt" for problem in cell.scratch.status()["problems"])))


if __name__ == "__main__":
    g.main()
