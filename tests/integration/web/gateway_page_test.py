"""The monitor page of a running gateway, without a browser: address, token, documents, metrics, commands, /live."""

import json
import re
import socket
import stat
import unittest

import gateway as g
from glb_reader import Glb, read_poses
from page_client import Live, Page, picture_number

SAMPLE = re.compile(r'^[a-zA-Z_:][a-zA-Z0-9_:]*(\{([a-zA-Z_][a-zA-Z0-9_]*="(\\.|[^"\\\n])*",?)*\})? '
                    r'(NaN|[+-]Inf|[-+]?[0-9.]+([eE][-+]?[0-9]+)?)$')


def page_of(scratch):
    done = scratch.cellmirror("page", "--json", "--instance", scratch.instance)
    assert done.returncode == 0, done.stderr
    return Page(json.loads(done.stdout))


class GatewayPage(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.gateway = g.Gateway(self.scratch, page=True)
        self.page = page_of(self.scratch)

    def tearDown(self):
        self.gateway.close()
        self.scratch.remove()

    def test_the_address_is_told_to_all_and_the_token_to_its_owner(self):
        self.assertIn(self.page.address, self.gateway.output())
        self.assertNotIn(self.page.token, self.gateway.output())
        status = self.scratch.status()["page"]
        self.assertEqual(status["address"], self.page.address)
        self.assertNotIn(self.page.token, json.dumps(status))
        shown = self.scratch.cellmirror("page", "--instance", self.scratch.instance).stdout.strip()
        self.assertEqual(shown, f"{self.page.address}#token={self.page.token}")
        file = self.scratch.runtime / self.scratch.instance / "page.json"
        self.assertEqual(stat.S_IMODE(file.stat().st_mode), 0o600)

    def test_the_token_outlives_a_restart_and_the_address_does_not(self):
        self.gateway.stop()
        gone = self.scratch.cellmirror("page", "--instance", self.scratch.instance)
        self.assertEqual(gone.returncode, 1)
        self.assertIn("cellmirror run", gone.stderr)
        self.gateway.close()
        self.gateway = g.Gateway(self.scratch, page=True)
        self.assertEqual(page_of(self.scratch).token, self.page.token)

    def test_documents_are_what_they_say(self):
        status, headers, body = self.page.ask("/")
        self.assertEqual(status, 200)
        self.assertIn(b"<html", body)
        self.assertIn("default-src 'none'", headers["Content-Security-Policy"])
        tree = self.page.json("/api/tree")
        paths = [node["path"] for node in tree["nodes"]]
        self.assertEqual(paths, sorted(paths))
        self.assertTrue(any(node["has_detail"] for node in tree["nodes"]))
        self.assertTrue(all(node["parent"] in paths for node in tree["nodes"] if node["parent"] is not None))
        names = self.page.json("/api/names")
        self.assertIn("MANTEC_R3", names["robots"])
        self.assertIn("startup.spt", names["scripts"])
        self.assertEqual(self.page.json("/api/status")["instance"], self.scratch.instance)
        self.assertIn("POS_ROB", [command["name"] for command in self.page.json("/api/commands")["commands"]])

    def test_the_cell_in_three_dimensions(self):
        status, headers, body = self.page.ask("/scene.glb")
        self.assertEqual((status, headers["Content-Type"]), (200, "model/gltf-binary"))
        glb = Glb(body)
        self.assertGreater(glb.triangles, 1000)
        paths = {node["path"] for node in self.page.json("/api/tree")["nodes"]}
        for node in glb.bodies:
            self.assertIn(node["extras"]["path"], paths)
        robots = {node["extras"]["robot"] for node in glb.bodies}
        self.assertIn("MANTEC_R3", robots)
        self.assertEqual(self.page.ask("/scene.glb", headers={"If-None-Match": headers["ETag"]})[0], 304)
        # Poses belong to this file, and a moved joint moves its bodies and no others.
        live = Live(self.page)
        self.addCleanup(live.close)
        live.say(do="scene")
        marks = live.until_is("marks")
        self.assertTrue(marks["cameras"])
        poses = read_poses(live.until(lambda message: isinstance(message, bytes)))
        self.assertEqual(f'"{poses["geometry"]:016x}"', headers["ETag"])
        self.assertEqual(len(poses["bodies"]), len(glb.bodies))
        self.assertEqual(len(poses["cameras"]), len(marks["cameras"]))
        self.assertLess(poses["age_s"], 10)
        for pose, node in zip(poses["bodies"], glb.bodies):
            self.assertAlmostEqual(sum(value * value for value in pose[3:7]), 1, places=4)
        live.say(do="posed", sequence=poses["sequence"])
        status, answer = self.page.command("POS_ROB PUMA_762 JOINT_INC 20")
        self.assertTrue(json.loads(answer)["done"], answer)
        end, moved = poses, set()
        for _ in range(40):
            end = read_poses(live.until(lambda message: isinstance(message, bytes)))
            live.say(do="posed", sequence=end["sequence"])
            moved |= {i for i, (a, b) in enumerate(zip(poses["bodies"], end["bodies"])) if max(map(abs, (x - y for x, y in zip(a, b)))) > 1e-3}
            if moved and end["sequence"] > poses["sequence"] + 2:
                break
        self.assertTrue(moved, answer)
        self.assertIn("PUMA_762", {glb.bodies[i]["extras"]["robot"] for i in moved})
        self.assertTrue(any(glb.bodies[i]["extras"]["robot"] == "" and i not in moved for i in range(len(glb.bodies))), "all of the cell moved")

    def test_metrics_are_in_the_text_format(self):
        status, headers, body = self.page.ask("/metrics")
        self.assertEqual(status, 200)
        self.assertTrue(headers["Content-Type"].startswith("text/plain; version=0.0.4"))
        families, seen = {}, set()
        for line in body.decode().splitlines():
            if line.startswith("# TYPE "):
                _, _, name, kind = line.split(" ")
                self.assertNotIn(name, families, "a family stands in one place")
                self.assertIn(kind, ("counter", "gauge", "summary"))
                families[name] = kind
            elif not line.startswith("# HELP "):
                self.assertRegex(line, SAMPLE)
                series = line.rsplit(" ", 1)[0]
                self.assertNotIn(series, seen)
                seen.add(series)
                name = series.split("{")[0]
                owner = name if name in families else re.sub("_(sum|count)$", "", name)
                self.assertEqual(owner, list(families)[-1], "samples stand behind their family")
                self.assertTrue(families[owner] != "counter" or name.endswith("_total"))
        self.assertIn("cellmirror_loop_ticks_total", families)
        self.assertIn('cellmirror_robot_mirrored{robot="MANTEC_R3"}', seen)

    def test_commands_need_the_token_and_are_acknowledged(self):
        self.assertEqual(self.page.command("ROBACT MANTEC_R3"), (200, '{"done":true}'))
        self.assertTrue(self.scratch.robot("MANTEC_R3")["active"])
        status, body = self.page.command("ROBACT MANTEC_R33")
        self.assertEqual(status, 200)
        self.assertFalse(json.loads(body)["done"])
        self.assertIn("MANTEC_R3", json.loads(body)["text"])
        self.assertEqual(self.page.command("ROBACT MANTEC_R3", "0" * 32)[0], 401)
        refused = json.loads(self.page.command("@7 ROBACT MANTEC_R3")[1])
        self.assertFalse(refused["done"])

    def test_live_shows_and_commands(self):
        live = Live(self.page)
        self.addCleanup(live.close)
        welcome = live.until_is("welcome")
        self.assertFalse(welcome["may_command"])
        self.assertTrue(welcome["run"])
        live.say(do="hello", token=self.page.token)
        self.assertTrue(live.until_is("welcome")["may_command"])
        live.say(do="command", id=1, text="hot_message  look here")
        self.assertTrue(live.until_is("reply", id=1)["done"])
        seen = live.until(lambda m: isinstance(m, dict) and m["is"] == "live" and m["messages"])
        self.assertIn("look here", seen["messages"][-1]["text"])
        for key in ("time_s", "uptime_s", "revision", "tree_revision", "loop", "robots", "touching", "near", "ranges", "forces",
                    "queues", "display", "cameras", "bell", "warning_distance_m", "collision_age_s", "within_warning_count"):
            self.assertIn(key, seen)
        robot = next(robot for robot in seen["robots"] if robot["id"] == "MANTEC_R3")
        self.assertEqual(robot["mode"], "simulated")
        self.assertEqual(set(robot["joints"][0]),
                         {"name", "kind", "unit", "position", "velocity", "state", "lower", "upper"})
        self.assertEqual(len(seen["display"]["views"]), 7)
        before = seen["tree_revision"]
        live.say(do="command", id=2, text="SET_FRAME nowhere PLACEMENT 0 0 0 0 0 0")
        self.assertFalse(live.until_is("reply", id=2)["done"])
        self.assertEqual(live.until_is("live")["tree_revision"], before)
        live.say(do="picture")
        self.assertIn("--headless", live.until_is("refused")["text"])

    def test_a_port_in_use_is_told_and_everything_else_goes_on(self):
        other = g.Scratch()
        self.addCleanup(other.remove)
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            port = taken.getsockname()[1]
            command = [g.BIN / "cellmirror", "run", other.cell_file, "--headless", "--instance", other.instance, "--port", str(port)]
            gateway = g.Process(command, other.environment)
            self.addCleanup(gateway.close)
            self.assertTrue(g.eventually(lambda: "Ctrl-C ends it" in gateway.output()), gateway.output())
            self.assertIn("--port", gateway.output())
            self.assertIn("port", other.status()["page"]["problem"])
            self.assertEqual(other.cellmirror("page", "--instance", other.instance).returncode, 1)
            self.assertEqual(gateway.stop(), 0)

    def test_without_the_page_there_is_none(self):
        other = g.Scratch()
        self.addCleanup(other.remove)
        gateway = g.Gateway(other)
        self.addCleanup(gateway.close)
        self.assertFalse(other.status()["page"]["on"])
        done = other.cellmirror("page", "--instance", other.instance)
        self.assertEqual(done.returncode, 1)
        self.assertIn("--no-web", done.stderr)


class PagesPictures(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.addCleanup(self.scratch.remove)
        self.gateway = g.Gateway(self.scratch, pictures=True, page=True)
        self.addCleanup(self.gateway.close)
        if self.scratch.cellmirror("snapshot", "--instance", self.scratch.instance, "-o",
                                   self.scratch.root / "first.png").returncode != 0:
            self.skipTest("skipped: no OpenGL without a display here")
        self.live = Live(page_of(self.scratch))
        self.addCleanup(self.live.close)

    def picture(self):
        """The next one, acknowledged."""
        number = picture_number(self.live.until(picture_number))
        self.live.say(do="shown", sequence=number)

    def test_a_camera_that_is_not_there_is_told_and_ends_nothing(self):
        self.live.say(do="picture", width=64, height=48)
        self.picture()
        self.live.say(do="picture", width=64, height=48, camera="CAMERA_55")
        self.assertIn("there is no camera CAMERA_55", self.live.until_is("refused")["text"])
        self.live.say(do="picture", width=64, height=48)
        self.picture()

    def test_a_low_rate_holds_back_nothing_that_is_wished_later(self):
        self.live.say(do="picture", width=64, height=48, rate_hz=0.01)
        self.picture()
        self.live.say(do="picture", width=64, height=48, rate_hz=60, view=3)
        self.picture()

if __name__ == "__main__":
    g.main()
