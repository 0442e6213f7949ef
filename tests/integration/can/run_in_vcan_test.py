"""run-in-vcan.sh says why a guest kernel ran nothing, and goes on to the next one."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import gateway as g  # noqa: E402

SUPPORT = g.SOURCE / "tests" / "support"
# Stand-ins for the guest kernels: the tests need no kernel, and no processor on which User-Mode Linux fails.
PANICS = "#!/bin/sh\necho booting\necho 'Kernel panic - not syncing: no state of AMX'\nexit 1\n"
ANSWERS = """#!/bin/sh
for word in $*; do case $word in VCAN_RUN=*) run=${word#*=} ;; esac; done
echo seen > "$run/io/stdout"
echo 7 > "$run/io/status"
"""


class Engines(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.cache = pathlib.Path(folder.name)
        self.programs = self.cache / "programs"
        self.programs.mkdir()
        sources = [(SUPPORT / "vcan" / name).read_bytes() for name in ("guest_kernels.sh", "qemu_init.sh")]
        version = subprocess.run(["cksum"], input=b"".join(sources), stdout=subprocess.PIPE, check=True).stdout
        for engine in ("uml", "qemu"):
            (self.cache / engine).mkdir()
            (self.cache / engine / "ready").write_bytes(version)
        self.write(self.cache / "uml" / "linux", PANICS)
        for tool in ("cpio", "modprobe", "depmod"):
            self.write(self.programs / tool, "#!/bin/sh\nexit 1\n")

    def write(self, path, text):
        path.write_text(text)
        path.chmod(0o755)

    def run_in_vcan(self, engines):
        environment = dict(os.environ, CELLMIRROR_VCAN_CACHE=str(self.cache), PATH=f"{self.programs}:{os.environ['PATH']}")
        return subprocess.run([SUPPORT / "run-in-vcan.sh", "--timeout", "20", "--engine", engines, "true"], env=environment,
                              text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60)

    def test_a_panic_is_a_skip_that_names_it(self):
        done = self.run_in_vcan("uml")
        self.assertEqual(done.returncode, 77, done.stderr)
        self.assertIn("uml: the guest kernel ended without a status: Kernel panic - not syncing: no state of AMX", done.stderr)

    def test_after_a_panic_the_next_kernel_runs_the_command(self):
        self.write(self.programs / "qemu-system-x86_64", ANSWERS)
        done = self.run_in_vcan("uml qemu")
        self.assertEqual((done.returncode, done.stdout), (7, "seen\n"), done.stderr)

    def test_each_kernel_is_named_where_none_runs_it(self):
        self.write(self.programs / "qemu-system-x86_64", PANICS)
        done = self.run_in_vcan("uml qemu")
        self.assertEqual(done.returncode, 77, done.stderr)
        last = done.stderr.splitlines()[-1]
        self.assertIn("uml: ", last)
        self.assertIn("qemu: ", last)

    def test_the_folders_of_the_runs_are_removed(self):
        self.run_in_vcan("uml")
        self.assertEqual(sorted(path.name for path in self.cache.glob("run.*")), [])


if __name__ == "__main__":
    g.main()
