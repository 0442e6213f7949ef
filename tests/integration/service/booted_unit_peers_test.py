"""The unit under a systemd that is process 1: exits in quick succession, errors in the cell file, a late interface.

The system is this machine's files under an overlay, in namespaces of its own; needs root and overlayfs."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import gateway as g

sys.path.insert(0, str(g.SOURCE / "tests" / "integration" / "package"))

UNIT = g.SOURCE / "config" / "systemd" / "cellmirror@.service"
PROGRAMS = ("cellmirror", "cellmirror-dds", "cellmirror-mesh-reader", "cellmirror-mqtt", "cellmirror-volume-reader")
LATE = "203.0.113.77"  # for documents (RFC 5737): no machine has it
# Five exits must fit into ten seconds; the unit's own pause alone would keep them apart. Where this machine lets nobody raise
# limits, the loop runs without real time.
QUICK = "[Service]\nRestartSec=100ms\n"


class BootedUnit(unittest.TestCase):
    cells = 0

    @classmethod
    def setUpClass(cls):
        if os.geteuid() != 0:
            raise unittest.SkipTest("skipped: needs root, to boot a system")
        g.require("systemd-analyze", "systemd is missing (package systemd)")
        from packages_peers_test import INSTEAD_OF_LIMITS, Booted, may_raise_limits

        if Booted.CGROUPS is None:
            raise unittest.SkipTest("skipped: there is no cgroup2 file system")
        cls.base = pathlib.Path(tempfile.mkdtemp(prefix="cellmirror-booted-"))
        cls.addClassCleanup(shutil.rmtree, cls.base, ignore_errors=True)
        cls.folder = cls.base / "root"
        cls.folder.mkdir()
        # The layers of what is changed are in memory: an overlay cannot have another one as its upper layer.
        cls.mounted("mount", "-t", "tmpfs", "tmpfs", cls.base / "root")
        for name in ("upper", "work", "system"):
            (cls.folder / name).mkdir()
        cls.mounted("mount", "-t", "overlay", "overlay", "-o",
                    f"lowerdir=/,upperdir={cls.folder}/upper,workdir={cls.folder}/work", cls.folder / "system")
        cls.folder = cls.folder / "system"
        cls.more = "" if may_raise_limits() else INSTEAD_OF_LIMITS.replace("\\n", "\n")
        cls.install()
        cls.system = Booted(cls)
        cls.addClassCleanup(cls.system.close)

    @classmethod
    def mounted(cls, *command):
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if done.returncode != 0:
            raise unittest.SkipTest(f"skipped: no overlay here: {done.stderr.strip()}")
        cls.addClassCleanup(subprocess.run, ["umount", "--lazy", str(command[-1])], capture_output=True)

    @classmethod
    def install(cls):
        root = cls.folder
        for name in PROGRAMS:
            place = root / "usr" / "bin" if name == "cellmirror" else root / "usr" / "libexec" / "cellmirror"
            place.mkdir(parents=True, exist_ok=True)
            shutil.copy(g.BIN / name, place / name)
        units = root / "etc" / "systemd" / "system"
        shutil.rmtree(units, ignore_errors=True)  # nothing of this machine is started
        (units / "cellmirror@.service.d").mkdir(parents=True)
        (units / "cellmirror@.service.d" / "quick.conf").write_text(QUICK + cls.more)
        shutil.copy(UNIT, units / UNIT.name)
        (root / "etc" / "machine-id").write_text("0123456789abcdef0123456789abcdef\n")
        subprocess.run(["systemd-sysusers", f"--root={root}", g.SOURCE / "config" / "systemd" / "cellmirror.sysusers"], check=True,
                       capture_output=True)

    def setUp(self):
        type(self).cells += 1
        self.cell = f"cell_{self.cells}"
        self.unit = f"cellmirror@{self.cell}"
        home = pathlib.Path("/etc/cellmirror/cells") / self.cell
        inside = self.folder / str(home).lstrip("/")
        shutil.copytree(g.CELLS / "transfer_cell", inside, ignore=shutil.ignore_patterns("records"))
        (inside / "scripts" / "startup.spt").write_text("# empty for tests\n")
        self.file = inside / "cell.toml"
        self.good = self.file.read_text()

    def tearDown(self):
        self.sh(f"systemctl stop {self.unit} || true; systemctl reset-failed {self.unit} || true")

    def sh(self, command):
        return self.system.sh(command)

    def shown(self, name):
        return self.sh(f"systemctl show {self.unit} -p {name} --value").strip()

    def becomes(self, name, condition, timeout=g.PATIENCE_S):
        self.assertTrue(g.eventually(lambda: condition(self.shown(name)), timeout=timeout),
                        f"{name} is {self.shown(name)}\n" + self.sh(f"journalctl -u {self.unit} --no-pager | tail -n 20"))

    def start(self):
        self.sh(f"systemctl start {self.unit} || {{ journalctl -u {self.unit} --no-pager; exit 1; }}")
        return self.shown("MainPID")

    def test_an_error_in_the_cell_file_does_not_leave_it_failed(self):
        self.file.write_text(self.good + "\n[loop\n")
        self.sh(f"systemctl start --no-block {self.unit}")
        self.becomes("NRestarts", lambda count: int(count) >= 6)
        self.assertNotEqual(self.shown("ActiveState"), "failed")
        self.file.write_text(self.good)
        self.becomes("ActiveState", lambda state: state == "active")

    def test_exits_in_quick_succession_do_not_leave_it_failed(self):
        before = self.start()
        for count in range(1, 7):
            self.sh(f"systemctl kill --kill-whom=main -s KILL {self.unit}")
            self.becomes("NRestarts", lambda restarts, count=count: int(restarts) >= count)
            self.becomes("MainPID", lambda pid, before=before: pid not in ("0", before))
            before = self.shown("MainPID")
        self.becomes("ActiveState", lambda state: state == "active")
        # One that ends in order, but was not asked to by systemd.
        self.sh(f"kill -TERM {self.shown('MainPID')}")
        self.becomes("NRestarts", lambda restarts: int(restarts) >= 7)
        self.becomes("ActiveState", lambda state: state == "active")
        self.sh(f"systemctl stop {self.unit}")
        self.assertEqual(self.shown("ActiveState"), "inactive", "it ends for those who ask")

    def test_a_reload_checks_the_cell_before_it_ends_the_gateway(self):
        before = self.start()
        self.file.write_text(self.good + "\n[loop\n")
        self.sh(f"if systemctl reload {self.unit}; then exit 1; fi")
        self.assertEqual((self.shown("ActiveState"), self.shown("MainPID")), ("active", before), "it goes on")
        journal = self.sh(f"journalctl -u {self.unit} --no-pager")
        self.assertRegex(journal, r"cell\.toml:\d+:\d+: error")
        self.file.write_text(self.good)
        self.sh(f"systemctl reload {self.unit}")
        self.becomes("MainPID", lambda pid: pid not in ("0", before))
        self.becomes("ActiveState", lambda state: state == "active")

    def test_it_leaves_no_core(self):
        limits = self.sh(f"cat /proc/{self.start()}/limits")
        self.assertRegex(limits, r"Max core file size +0 +0 ")

    def test_it_waits_for_the_address_of_dds(self):
        late = "203.0.113.78"
        self.file.write_text(self.good.replace("[dds_output]\n", f'[dds_output]\ninterface_address = "{late}"\n'))
        self.assertIn(late, self.file.read_text())
        self.sh(f"systemctl start --no-block {self.unit}")
        self.becomes("NRestarts", lambda count: int(count) >= 6)
        self.assertNotEqual(self.shown("ActiveState"), "failed")
        self.sh(f"ip address add {late}/32 dev lo")
        self.becomes("ActiveState", lambda state: state == "active")

    def test_an_address_may_come_after_the_gateway(self):
        port = 8467
        self.file.write_text(self.good + f'\n[web]\naddress = "{LATE}"\nport = {port}\nallow_remote = true\n')
        self.start()
        checked = self.sh(f"cellmirror check /etc/cellmirror/cells/{self.cell} 2>&1")
        self.assertRegex(checked, rf"cell\.toml:\d+:\d+: warning: .*no network interface of this machine has the address {LATE}")
        ask = (f"exec 3<>/dev/tcp/{LATE}/{port} && printf 'GET /healthz HTTP/1.1\\r\\nHost: {LATE}:{port}\\r\\n\\r\\n' >&3 && cat <&3")
        self.assertNotIn("HTTP/1.1", self.sh(f"timeout 5 bash -c \"{ask}\" 2>&1 || true"))
        self.sh(f"ip address add {LATE}/32 dev lo")
        self.assertTrue(g.eventually(lambda: "HTTP/1.1" in self.sh(f"timeout 5 bash -c \"{ask}\" 2>&1 || true")))


if __name__ == "__main__":
    g.main()
