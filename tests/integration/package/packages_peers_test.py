"""The Debian packages: lintian, the same twice, and installed, upgraded, removed and purged in a fresh Debian.

Takes as long as two builds, so only ./check --peers runs it (CELLMIRROR_PEERS). Needs root and the package mirror."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import gateway as g
from sbom_test import check_form

WORK = g.SOURCE / "build-package-test"
UPGRADE = "99.0.0"
CELL = "/usr/share/cellmirror/cells/transfer_cell"
TISSUE = "/usr/share/cellmirror/cells/trainer"
EXPOSURE = 20  # of systemd-analyze security, in tenths
LARGEST_PROGRAM = 16 << 20  # bytes; a build for development has six times as many


def run(*command, timeout=3600, **keywords):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=timeout, **keywords)
    if done.returncode != 0:
        raise AssertionError(f"{command} gives {done.returncode}:\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    return done.stdout


def build():
    """Folders of the packages: of this version, and of a later one."""
    run(g.SOURCE / "package", "--folder", WORK, "--twice", timeout=5400)
    first = WORK / "first"
    shutil.rmtree(first, ignore_errors=True)
    shutil.copytree(WORK / "out", first)
    run(g.SOURCE / "package", "--folder", WORK, "--version", UPGRADE, "--no-lint")
    return first, WORK / "out"


class Root:
    """A fresh Debian in a folder. Commands run in namespaces of their own: what they mount and start ends with them."""

    IN_IT = r"""
      mount --make-rprivate /
      mount -t proc proc "$root/proc"
      mount -t tmpfs tmpfs "$root/dev/shm"
      for name in null zero random urandom; do touch "$root/dev/$name"; mount --bind "/dev/$name" "$root/dev/$name"; done
      for folder in /etc/apt/apt.conf.d /etc/apt/trusted.gpg.d /etc/apt/keyrings; do
        [ ! -d "$folder" ] || { mkdir -p "$root$folder"; mount --bind "$folder" "$root$folder"; }
      done
      mkdir -p "$root/packages"
      mount --bind "$packages" "$root/packages"
      cp /etc/resolv.conf /etc/hosts "$root/etc/"
      cp /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"
      exec chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive sh -euc "$command"
    """

    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="cellmirror-root-"))
        sources = sorted(pathlib.Path("/etc/apt/sources.list.d").glob("*.sources")) or ["/etc/apt/sources.list"]
        run("mmdebstrap", "--quiet", "--variant=apt", "--mode=root", "--include=ca-certificates", "bookworm", self.folder, *sources, timeout=600)

    def sh(self, command, packages=WORK / "first", check=True):
        done = subprocess.run(["unshare", "--mount", "--ipc", "--pid", "--fork", "--kill-child", "bash", "-euc", self.IN_IT],
                              env=dict(os.environ, root=str(self.folder), packages=str(packages), command=command),
                              capture_output=True, text=True, timeout=1200)
        if check and done.returncode != 0:
            raise AssertionError(f"{command}\ngives {done.returncode}:\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
        return done.stdout if check else done

    def named_after_us(self):
        """Files and folders of that name, but for those that dpkg keeps on packages."""
        found = self.sh("find / -xdev -name '*cellmirror*' -not -path '/var/lib/dpkg/*' -not -path '/packages*' -not -path '/proc/*'")
        return sorted(found.split())

    def remove(self):
        shutil.rmtree(self.folder, ignore_errors=True)


# Where this machine lets nobody raise limits (no CAP_SYS_RESOURCE), LimitRTPRIO= has no effect; then the capabilities show
# that the rest of the unit leaves the loop real time.
INSTEAD_OF_LIMITS = "AmbientCapabilities=CAP_SYS_NICE CAP_IPC_LOCK\\nCapabilityBoundingSet=CAP_SYS_NICE CAP_IPC_LOCK\\n"


def may_raise_limits():
    return subprocess.run(["prlimit", "--rtprio=99:99", "true"], capture_output=True).returncode == 0


class Booted:
    """The same Debian with its systemd running."""

    CGROUPS = next((pathlib.Path(line.split()[1]) for line in pathlib.Path("/proc/mounts").read_text().splitlines()
                    if line.split()[2] == "cgroup2"), None)

    def __init__(self, root):
        self.log = open(tempfile.mktemp(prefix="cellmirror-boot-"), "w+b")
        self.cgroup = self.CGROUPS / f"cellmirror-test-{os.getpid()}"
        self.child = subprocess.Popen(["bash", pathlib.Path(__file__).parent / "boot.sh", root.folder, self.cgroup],
                                      stdin=subprocess.DEVNULL, stdout=self.log, stderr=subprocess.STDOUT)
        self.system = g.eventually(self.first_process, timeout=20)
        if not self.system or not g.eventually(lambda: self.sh("systemctl is-system-running || true").strip() in ("running", "degraded"), timeout=60):
            raise AssertionError(f"systemd does not run:\n{self.output()}")

    def output(self):
        return pathlib.Path(self.log.name).read_text(errors="replace")[-4000:]

    def first_process(self):
        """Of its namespaces: the child of unshare, once it has become systemd."""
        children = pathlib.Path(f"/proc/{self.child.pid}/task/{self.child.pid}/children")
        for pid in children.read_text().split() if children.exists() else ():
            if pathlib.Path(f"/proc/{pid}/comm").read_text().strip() == "systemd":
                return int(pid)
        return None

    def sh(self, command, check=True):
        done = subprocess.run(["nsenter", "--target", str(self.system), "--all", "--root", "--wd", "env", "-i", "PATH=/usr/sbin:/usr/bin:/sbin:/bin",
                               "LANG=C.UTF-8", "bash", "-euc", command], capture_output=True, text=True, timeout=120)
        if check and done.returncode != 0:
            raise AssertionError(f"{command}\ngives {done.returncode}:\n{done.stdout}\n{done.stderr}\n{self.output()}")
        return done.stdout

    def close(self):
        self.child.kill()  # and with it, by --kill-child, process 1 and all of its namespace
        self.child.wait()
        self.log.close()
        pathlib.Path(self.log.name).unlink()
        for folder in sorted((path for path in self.cgroup.rglob("*") if path.is_dir()), reverse=True):
            g.eventually(lambda folder=folder: not (folder / "cgroup.procs").read_text(), timeout=10)
            folder.rmdir()
        self.cgroup.rmdir()


@unittest.skipUnless(os.environ.get("CELLMIRROR_PEERS"), "skipped: builds packages twice; ./check --peers runs it")
class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if os.geteuid() != 0:
            raise unittest.SkipTest("skipped: needs root, for a fresh Debian")
        g.require("mmdebstrap", "mmdebstrap is missing")
        cls.first, cls.later = build()
        cls.root = Root()

    @classmethod
    def tearDownClass(cls):
        cls.root.remove()

    def installed(self, package):
        return self.root.sh(f"dpkg-query --show --showformat '${{Version}} ${{db:Status-Status}}' {package} || true").strip()

    def test_a_life_of_the_packages(self):
        before = self.root.named_after_us()
        self.assertEqual(before, [])
        self.root.sh("apt-get update -qq; apt-get install -y -qq --no-install-recommends /packages/*.deb")
        self.check_what_is_installed()
        self.check_that_it_runs()
        self.check_the_bill()
        # The owner's cell and what a gateway wrote survive an upgrade, and removal too.
        self.root.sh(f"cp -r {CELL} /etc/cellmirror/cells/mine; mkdir -p /var/lib/cellmirror/mine/records; echo x >/var/lib/cellmirror/mine/records/a")
        self.root.sh("apt-get install -y -qq --no-install-recommends /packages/*.deb", self.later)
        self.assertEqual(self.installed("cellmirror"), f"{UPGRADE} installed")
        self.assertIn(f"cellmirror ({UPGRADE})", self.root.sh("zcat /usr/share/doc/cellmirror/changelog.gz"))
        self.root.sh("test -f /etc/cellmirror/cells/mine/cell.toml -a -f /var/lib/cellmirror/mine/records/a")
        self.root.sh("apt-get remove -y -qq cellmirror cellmirror-doc")
        self.root.sh("test -f /etc/cellmirror/cells/mine/cell.toml -a -f /var/lib/cellmirror/mine/records/a -a ! -e /usr/bin/cellmirror")
        self.root.sh("apt-get purge -y -qq cellmirror cellmirror-doc")
        self.assertEqual(self.installed("cellmirror"), "")
        self.assertEqual(self.root.named_after_us(), ["/etc/cellmirror"], "only the owner's own cell")
        self.root.sh("rm -r /etc/cellmirror; apt-get install -y -qq --no-install-recommends /packages/*.deb; apt-get purge -y -qq cellmirror cellmirror-doc")
        self.assertEqual(self.root.named_after_us(), [], "nothing is left")

    def check_what_is_installed(self):
        self.assertEqual(self.root.sh("dpkg --verify cellmirror cellmirror-doc"), "")
        files = [pathlib.PurePath(name) for name in self.root.sh("dpkg -L cellmirror cellmirror-doc").split("\n") if name]
        for file in files:
            self.assertNotIn("records", file.parts, file)
            self.assertNotIn(file.suffix, (".pyc", ".jsonl", ".gz.tmp"), file)
        for name in ("/usr/share/man/man1/cellmirror.1.gz", "/usr/share/bash-completion/completions/cellmirror",
                     "/usr/lib/systemd/system/cellmirror@.service", "/usr/share/cellmirror/grafana/cellmirror.json",
                     "/usr/share/doc/cellmirror-doc/install.md", "/usr/share/doc/cellmirror-doc/html/index.html",
                     "/usr/share/doc/cellmirror-doc/html/search/search_index.js", "/etc/cellmirror/cells"):
            self.assertTrue({pathlib.PurePath(name), pathlib.PurePath(name.removeprefix("/usr"))} & set(files), name)
        self.assertLess((self.root.folder / "usr/bin/cellmirror").stat().st_size, LARGEST_PROGRAM)
        # Figures and examples are there once, for the pages as for the Markdown files.
        for name in ("figures/tick.svg", "examples/send_command.c"):
            self.assertTrue((self.root.folder / "usr/share/doc/cellmirror-doc/html" / name).is_file(), name)
        # No path of the builder's tree.
        for file in files:
            path = self.root.folder / str(file).lstrip("/")
            if path.is_file():
                self.assertFalse(str(g.SOURCE).encode() in path.read_bytes(), f"{file} names the tree of its builder")
        self.assertRegex(self.root.sh("getent passwd cellmirror"), "^cellmirror:.*:/nonexistent:/usr/sbin/nologin$")

    def check_that_it_runs(self):
        """As the service's user, with its arguments, and a folder of cells that it may not write. Meshes need their reader."""
        out = self.root.sh(f"""
          cp -r {CELL} /etc/cellmirror/cells/first
          install -d -o cellmirror -g cellmirror /run/cellmirror /var/lib/cellmirror/first
          chmod 0700 /run/cellmirror
          export CELLMIRROR_RUNTIME_DIR=/run/cellmirror
          setpriv --reuid cellmirror --regid cellmirror --clear-groups cellmirror run /etc/cellmirror/cells/first/cell.toml \
            --instance first --state /var/lib/cellmirror/first --no-web --for 20 &
          gateway=$!
          for i in $(seq 100); do cellmirror status --instance first >/tmp/status 2>&1 && break; sleep 0.1; done
          cat /tmp/status
          cellmirror send --instance first 'ROBACT MANTEC_R3'
          kill -TERM $gateway
          wait $gateway
          ls /var/lib/cellmirror/first/records
          cellmirror snapshot --cell {CELL}/cell.toml --size 320x240 -o /tmp/cell.png
          rm -r /etc/cellmirror/cells/first /var/lib/cellmirror/first
        """)
        self.assertIn("cell transfer_cell", out)
        self.assertIn("commands-first.jsonl", out)
        self.assertIn("320 x 240", out)

    def test_a_service_under_systemd(self):
        if Booted.CGROUPS is None:
            self.fail("there is no cgroup2 file system")
        more = "" if may_raise_limits() else INSTEAD_OF_LIMITS
        self.root.sh(f"""
          apt-get update -qq; apt-get install -y -qq --no-install-recommends systemd iproute2 /packages/*.deb
          cp -r {CELL} /etc/cellmirror/cells/first
          cp -r {TISSUE} /etc/cellmirror/cells/second
          printf '\\n[web]\\nport = 8431\\n' >>/etc/cellmirror/cells/first/cell.toml
          cp /lib/systemd/system/cellmirror@.service /tmp/cellmirror@first.service
          systemd-analyze security --offline=yes --no-pager --threshold={EXPOSURE} /tmp/cellmirror@first.service >/dev/null
          mkdir -p /etc/systemd/system/cellmirror@.service.d
          printf '[Service]\\nWatchdogSec=2\\n{more}' >/etc/systemd/system/cellmirror@.service.d/soon.conf
        """)
        booted = Booted(self.root)
        try:
            self.check_the_service(booted)
            self.check_the_priority_of_tissue(booted)
            self.check_upgrade_and_removal(booted)
        finally:
            booted.close()
            self.root.sh("apt-get purge -y -qq cellmirror cellmirror-doc; rm -r /etc/cellmirror /etc/systemd/system/cellmirror@.service.d")

    def check_the_service(self, booted):
        booted.sh("systemctl start cellmirror@first || { journalctl -u cellmirror@first --no-pager; exit 1; }")
        shown = booted.sh("systemctl show cellmirror@first -p ActiveState -p StatusText -p MainPID")
        self.assertIn("ActiveState=active", shown)
        self.assertIn("StatusText=cell transfer_cell with 8 robots", shown)
        self.assertIn("monitor page http://127.0.0.1:8431/", shown)
        status = json.loads(booted.sh("cellmirror status --json --instance first"))
        self.assertRegex(status["loop"]["scheduler"], "^SCHED_FIFO")
        self.assertTrue(booted.sh("ls /var/lib/cellmirror/first/records").startswith("commands-first.jsonl"))

        def ask(path):
            return booted.sh(f"exec 3<>/dev/tcp/127.0.0.1/8431; printf 'GET {path} HTTP/1.1\\r\\nHost: 127.0.0.1:8431\\r\\n\\r\\n' >&3; cat <&3 | tr -d '\\0'")

        self.assertTrue(g.eventually(lambda: ask("/healthz").startswith("HTTP/1.1 200 "), timeout=30), ask("/healthz"))
        booted.sh("cellmirror snapshot --instance first --size 320x240 -o /tmp/a.png")  # the renderer runs in the sandbox
        # A loop that stands still is started again.
        before = re.search(r"MainPID=(\d+)", shown)[1]
        booted.sh(f"kill -STOP {before}")
        after = g.eventually(lambda: self.restarted(booted, before), timeout=40)
        self.assertTrue(after, booted.sh("journalctl -u cellmirror@first --no-pager | tail -n 20"))
        booted.sh("systemctl stop cellmirror@first")
        self.assertIn("Result=success", booted.sh("systemctl show cellmirror@first -p Result"))

    def check_the_priority_of_tissue(self, booted):
        """LimitRTPRIO= lets its thread go before all but the loop."""
        booted.sh("systemctl start cellmirror@second || { journalctl -u cellmirror@second --no-pager; exit 1; }")
        # Behind the name in stat, which may contain blanks: fields 38 and 39 are the real-time priority and the policy.
        threads = """for task in /proc/$(systemctl show --value -p MainPID cellmirror@second)/task/*; do
                       echo "$(cat $task/comm) $(sed 's/.*) //' $task/stat | cut -d' ' -f38,39)"; done"""
        found = g.eventually(lambda: re.search(r"^tissue (\d+) (\d+)$", booted.sh(threads), re.MULTILINE), timeout=20)
        self.assertTrue(found, booted.sh(threads))
        self.assertEqual(found.groups(), ("60", "1"), "SCHED_FIFO, 20 below the loop")
        booted.sh("systemctl stop cellmirror@second")

    def check_upgrade_and_removal(self, booted):
        """A running gateway stays through an upgrade of the packages, and stops when they are removed."""
        state = "systemctl show cellmirror@first -p ActiveState -p MainPID"
        booted.sh("systemctl start cellmirror@first")
        before = booted.sh(state)
        shutil.copytree(self.later, self.root.folder / "var/later")
        booted.sh("dpkg --install /var/later/*.deb")
        self.assertEqual(booted.sh(state), before)
        booted.sh("dpkg --remove cellmirror cellmirror-doc")
        self.assertIn("ActiveState=inactive", booted.sh(state))
        shutil.rmtree(self.root.folder / "var/later")

    def restarted(self, booted, before):
        shown = dict(line.split("=", 1) for line in booted.sh(
            "systemctl show cellmirror@first -p MainPID -p NRestarts -p ActiveState").splitlines())
        return shown["MainPID"] != before and shown["NRestarts"] == "1" and shown["ActiveState"] == "active"

    def check_the_bill(self):
        document = json.loads(self.root.sh("cat /usr/share/doc/cellmirror/cellmirror.spdx.json"))
        check_form(self, document)
        # What the package needs to be installed is in it.
        needed = self.root.sh("dpkg-query --show --showformat '${Depends}' cellmirror")
        names = {package["name"] for package in document["packages"]}
        libraries = " ".join(word for word in (part.split("|")[0].split()[0] for part in needed.split(",")) if word.startswith("lib"))
        # Not those that other packages provide.
        real = self.root.sh(f"dpkg-query --show --showformat '${{db:Status-Status}} ${{binary:Package}}\\n' {libraries} 2>/dev/null || true")
        real = {line.split()[1].split(":")[0] for line in real.splitlines() if line.startswith("installed ")}
        self.assertGreater(len(real), 10)
        self.assertLessEqual(real, names)


if __name__ == "__main__":
    g.main()
