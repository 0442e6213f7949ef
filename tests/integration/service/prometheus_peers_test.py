"""Debian's Prometheus scrapes a running gateway, with the configuration and the alarms of docs/install.md, and understands every
expression of the dashboard for Grafana."""

import json
import pathlib
import re
import subprocess
import tempfile
import unittest
import urllib.error
import urllib.parse
import urllib.request

import gateway as g
from page_client import Page

GUIDE = (g.SOURCE / "docs" / "install.md").read_text()
DASHBOARD = json.loads((g.SOURCE / "config" / "grafana" / "cellmirror.json").read_text())


def documented(first_line):
    """The block of the guide that begins so."""
    return next(block for block in re.findall(r"```yaml\n(.*?)```", GUIDE, re.DOTALL) if block.startswith(first_line))


class Prometheus(g.Process):
    def __init__(self, folder, port_of_the_page):
        self.port = g.free_port()
        self.configuration = folder / "prometheus.yml"
        text = documented("scrape_configs:").replace("127.0.0.1:8420", f"127.0.0.1:{port_of_the_page}").replace("scrape_interval: 5s", "scrape_interval: 1s")
        (folder / "rules.yml").write_text(documented("groups:"))
        self.configuration.write_text(f"global:\n  evaluation_interval: 1s\nrule_files: [rules.yml]\n{text}")
        super().__init__(["prometheus", f"--config.file={self.configuration}", f"--storage.tsdb.path={folder / 'data'}",
                          f"--web.listen-address=127.0.0.1:{self.port}", "--log.level=warn"])

    def ask(self, path, **parameters):
        query = "?" + urllib.parse.urlencode(parameters) if parameters else ""
        try:
            with urllib.request.urlopen(f"http://127.0.0.1:{self.port}/api/v1/{path}{query}", timeout=60) as answer:
                return json.load(answer)["data"]
        except urllib.error.HTTPError as error:
            if error.code == 503:  # "Service Unavailable": it reads its storage
                return None
            raise AssertionError(f"{path}{query}: {error.code} {error.read().decode()}") from None
        except OSError:
            return None  # it starts

    def value(self, expression):
        answer = self.ask("query", query=expression)
        return float(answer["result"][0]["value"][1]) if answer and answer["result"] else None


class Watched(unittest.TestCase):
    """A gateway and its Prometheus."""

    @classmethod
    def setUpClass(cls):
        g.require("prometheus", "prometheus is missing")
        g.require("promtool", "promtool is missing (package prometheus)")
        cls.folder = tempfile.TemporaryDirectory(prefix="cellmirror-prometheus-")
        cls.addClassCleanup(cls.folder.cleanup)
        cls.scratch = g.Scratch()
        cls.addClassCleanup(cls.scratch.remove)
        cls.gateway = g.Gateway(cls.scratch, page=True)
        cls.addClassCleanup(cls.gateway.close)
        cls.page = Page(json.loads(cls.scratch.cellmirror("page", "--json", "--instance", cls.scratch.instance).stdout))
        cls.scratch.send("SET_USSPAR active USS_6 1")
        cls.prometheus = Prometheus(pathlib.Path(cls.folder.name), cls.page.port)
        cls.addClassCleanup(cls.prometheus.close)


class Scraped(Watched):
    def promtool(self, *arguments, text=None):
        done = subprocess.run(["promtool", *arguments], input=text, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_the_documented_configuration_and_alarms_are_valid(self):
        self.promtool("check", "config", str(self.prometheus.configuration))

    def test_metrics_are_as_prometheus_wants_them(self):
        """Names, units, types and help texts."""
        self.promtool("check", "metrics", text=self.page.ask("/metrics")[2].decode())

    def test_the_gateway_is_scraped(self):
        healthy = lambda: [target for target in (self.prometheus.ask("targets") or {"activeTargets": []})["activeTargets"] if target["health"] == "up"]
        self.assertTrue(g.eventually(healthy), self.prometheus.output())
        self.assertTrue(g.eventually(lambda: (self.prometheus.value("cellmirror_loop_ticks_total") or 0) > 100))
        before = self.prometheus.value("cellmirror_loop_ticks_total") or 0
        # None where no scrape of the last five minutes is there; the next one may be late.
        self.assertTrue(g.eventually(lambda: (self.prometheus.value("cellmirror_loop_ticks_total") or 0) > before), "the loop stands")
        self.assertTrue(g.eventually(lambda: self.prometheus.value('count(cellmirror_info{job="cellmirror"})') == 1))
        rules = [rule["name"] for group in g.eventually(lambda: self.prometheus.ask("rules"))["groups"] for rule in group["rules"]]
        self.assertEqual(len(rules), documented("groups:").count("alert:"))

    def test_every_expression_of_the_dashboard_is_understood(self):
        self.assertTrue(g.eventually(lambda: self.prometheus.value("up") == 1))
        expressions = {target["expr"] for panel in DASHBOARD["panels"] for target in panel.get("targets", [])}
        self.assertGreater(len(expressions), 10)
        for expression in expressions:
            query = expression.replace("$job", "cellmirror").replace("$instance", ".*")
            answer = g.eventually(lambda query=query: self.prometheus.ask("query", query=query))
            self.assertEqual(answer["resultType"], "vector", expression)


class Gone(Watched):
    def test_the_death_of_a_gateway_is_shown_and_alarmed(self):
        panel = next(panel for panel in DASHBOARD["panels"] if panel["title"] == "Gateways")
        shown = panel["targets"][0]["expr"].replace("$job", "cellmirror").replace("$instance", ".*")
        self.assertTrue(g.eventually(lambda: self.prometheus.value(shown) == 1), self.prometheus.output())
        self.gateway.child.kill()
        self.assertTrue(g.eventually(lambda: self.prometheus.value(shown) == 0), "the panel says so")
        alarm = 'ALERTS{alertname="CellmirrorGatewayGone",alertstate="firing"}'
        self.assertTrue(g.eventually(lambda: self.prometheus.value(alarm) == 1, timeout=30))


if __name__ == "__main__":
    g.main()
