"""Cells of a plant: gateways, discovery servers and a control room on machines of their own (network namespaces on one bridge)."""

import json
import pathlib
import shutil
import tempfile
import time
import unittest

import gateway as g
import plant

CYCLONE_PEERS = """<Domain><General><Interfaces><NetworkInterface address="{own}"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General><Discovery><Peers><Peer address="{peer}"/></Peers></Discovery></Domain>"""


def setUpModule():
    g.require(g.BIN / "dds_summary_peer", "the DDS peers of the tests are not built")
    if not plant.is_possible() or not plant.enter():
        raise unittest.SkipTest("skipped: network namespaces cannot be made here")


class PlantCase(unittest.TestCase):
    host = 10  # of the next machine: every test has addresses of its own

    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="cellmirror-plant-"))
        self.addCleanup(shutil.rmtree, self.root, ignore_errors=True)

    def place(self):
        PlantCase.host += 1
        return plant.Place(PlantCase.host)

    def keep(self, process):
        self.addCleanup(process.close)
        return process

    def gateway(self, cell, place):
        process = self.keep(place.start(cell.command(), cell.environment()))
        self.assertTrue(g.eventually(lambda: "Ctrl-C ends it" in process.output()), process.output())
        return process

    def hears(self, reader, cells, since=0.0):
        self.assertTrue(g.eventually(lambda: cells <= reader.cells_since(since)), reader.process.output())


class DiscoveryServers(PlantCase):
    """Two of them, as Debian's fastdds-tools has them."""

    def setUp(self):
        super().setUp()
        g.require("fast-discovery-server", "fastdds-tools is not installed")
        self.server_places = [self.place(), self.place()]
        self.dds = f"discovery_servers = {plant.servers_text(self.server_places)}"

    def start_servers(self, **settings):
        self.servers = [self.server(number, **settings) for number in (0, 1)]

    def server(self, number, **settings):
        return self.keep(plant.start_server(self.server_places[number], number, **settings))

    def cell(self, name, place):
        return plant.PlantCell(self.root, name, 2, place.address, self.dds)

    def newcomer_hears(self, cells):
        reader = plant.SummaryReader(self.place(), self.server_places)
        self.addCleanup(reader.close)
        self.hears(reader, cells)

    def test_1_servers_may_die_and_come_back(self):
        self.start_servers()
        for name in ("left", "right"):
            place = self.place()
            self.gateway(self.cell(name, place), place)
        early = self.keep(plant.SummaryReader(self.place(), self.server_places))
        self.hears(early, {"left", "right"})

        self.servers[0].kill()
        self.newcomer_hears({"left", "right"})
        time.sleep(plant.SERVER_PAUSE_S)
        self.servers[0] = self.server(0)
        self.newcomer_hears({"left", "right"})
        self.servers[1].kill()
        # By the one that was started again.
        self.newcomer_hears({"left", "right"})

        self.servers[0].kill()
        # Those who know each other need no server.
        time.sleep(plant.SERVER_PAUSE_S)
        self.hears(early, {"left", "right"}, time.monotonic())
        self.assertEqual(early.events("rejected"), [])
        self.start_servers()
        self.newcomer_hears({"left", "right"})

    def test_2_a_gateway_that_was_cut_off_or_moved_is_found_again(self):
        self.start_servers(settings=())  # as those of a ROS 2 system
        place, room = self.place(), self.place()
        gateway = self.gateway(self.cell("welding", place), place)
        reader = self.keep(plant.SummaryReader(room, self.server_places))
        self.hears(reader, {"welding"})
        runs = {event["run"] for event in reader.events()}

        # Shorter than the lease of a server, 20 s: it may not have forgotten a gateway that remembers it.
        place.connect(False)
        time.sleep(6)
        newcomer = self.keep(plant.SummaryReader(self.place(), self.server_places))
        time.sleep(6)
        place.connect(True)
        self.hears(newcomer, {"welding"})
        self.hears(reader, {"welding"}, time.monotonic())
        self.assertEqual({event["run"] for event in reader.events()}, runs, "the gateway was not started again")

        gateway.kill()
        moved = self.place()
        self.gateway(self.cell("welding", moved), moved)
        self.assertTrue(g.eventually(lambda: {event["run"] for event in reader.events()} > runs))

    def test_3_a_robot_is_mirrored_over_the_servers(self):
        self.start_servers()
        place, robot_place = self.place(), self.place()
        cell = plant.PlantCell(
            self.root, "mirroring", 1, place.address, self.dds,
            more=f'[[stream]]\nrobot = "R0"\nkind = "dds"\ninterface_address = "{place.address}"\npartition = "robots"\n')
        (cell.home / "scripts" / "startup.spt").write_text("ROBOT R0 online;\n")
        with (cell.home / "cell.toml").open("a") as file:
            file.write('[startup]\nscript = "startup.spt"\n')
        self.gateway(cell, place)
        servers = ",".join(json.loads(plant.servers_text(self.server_places)))
        robot = self.keep(robot_place.start(
            [g.BIN / "sim_robot", "dds", "--interface-address", robot_place.address, "--joint-names", "J_1,J_2,J_3,J_4,J_5,J_6",
             "--discovery-servers", servers, "--partition", "robots", "--rate", "50"]))
        reader = self.keep(plant.SummaryReader(self.place(), self.server_places))
        self.assertTrue(g.eventually(lambda: any(event["health"] == "ok" for event in reader.events()[-1:])), reader.process.output())
        robot.kill()
        self.assertTrue(g.eventually(lambda: any(event["health"] == "attention" for event in reader.events()[-1:])),
                        reader.process.output())


class UnicastPeers(PlantCase):
    def test_cyclone_dds_finds_a_gateway_without_multicast(self):
        g.require(g.BIN / "dds_cyclone_peer", "cyclonedds-dev is not installed")
        place, room = self.place(), self.place()
        cell = plant.PlantCell(self.root, "unicast", 2, place.address, f'multicast = false\npeers = ["{room.address}"]')
        self.gateway(cell, place)
        uri = CYCLONE_PEERS.format(own=room.address, peer=place.address)
        peer = self.keep(room.start([g.BIN / "dds_cyclone_peer", "description", "0", "rt/cellmirror/summary"],
                                    {**cell.environment(), "CYCLONEDDS_URI": uri}))
        self.assertTrue(g.eventually(lambda: '"cell":"unicast"' in peer.output()), peer.output())


class LossyLink(PlantCase):
    """A fifth of all frames to and from the cell is lost."""

    def test_summaries_are_repeated_until_they_arrive(self):
        if not pathlib.Path("/dev/net/tun").exists():
            self.skipTest("skipped: there is no /dev/net/tun")
        PlantCase.host += 1
        place, room = plant.Place(PlantCase.host, loss=0.2), self.place()
        self.gateway(plant.PlantCell(self.root, "radio", 2, place.address, 'link = "lossy"'), place)
        reader = self.keep(plant.SummaryReader(room))
        self.assertTrue(g.eventually(lambda: len(reader.events()) >= 60), reader.process.output())
        sequences = [event["sequence"] for event in reader.events()]
        span = max(sequences) - min(sequences) + 1
        # Without repetition it would be a fifth.
        self.assertLess(span - len(set(sequences)), 0.05 * span, sequences)


if __name__ == "__main__":
    g.main()
