"""The gateway beside a Fast DDS of another version: who finds whom how soon, and whether data stop while others come and go.

    python3 tests/peers/fast_dds.py FOLDER [PASSERS_BY]

FOLDER is where that Fast DDS is installed (include, lib, bin; /usr for Debian's own), or the root of another Debian, made of its
packages libfastdds-dev, fastdds-tools, libc6-dev, libstdc++-14-dev and what they need by `dpkg -x` (lib and lib64 are links into usr).
Needs clang++-19, and the rights to make network namespaces. Builds fast_dds_peer.cpp there, runs a gateway of build/bin with one
mirrored robot on one machine and the peer on another (tests/support/plant.py), found by multicast and then by a discovery server of
that version. Prints a table; the exit code is 1 where data did not come through."""

import json
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "support")]
sys.dont_write_bytecode = True

import gateway as g  # noqa: E402
import plant  # noqa: E402

OUTPUT_HZ = 50
QUIET_S = 20.0
BETWEEN_S, STAY_S = 0.5, 2.0  # of those who pass by
LEASE_S = 20.0  # of a participant of Fast DDS: those who were killed are missed after it
ECHO = "rt/cellmirror/joint_states"
# Other work on this machine is not to be taken for a stall of DDS.
FIRST = ["chrt", "--fifo", "1"]


class Library:
    """The Fast DDS in the folder."""

    def __init__(self, folder, scratch):
        loader = folder / "lib64" / "ld-linux-x86-64.so.2"
        self.foreign = loader.exists() and (folder / "usr" / "include").exists()
        self.prefix = folder / "usr" if self.foreign else folder
        self.libraries = [path for path in (self.prefix / "lib" / "x86_64-linux-gnu", self.prefix / "lib") if path.exists()]
        # Before a program that was linked without the path of its libraries.
        self.run = [loader, "--library-path", self.libraries[0]] if self.foreign else \
            ["env", f"LD_LIBRARY_PATH={':'.join(map(str, self.libraries))}"]
        self.peer = scratch / "fast_dds_peer"
        self.build(folder, loader)
        self.version = subprocess.run([self.peer, "version"], check=True, capture_output=True, text=True).stdout.strip()

    def build(self, folder, loader):
        three = any((path / "libfastdds.so").exists() for path in self.libraries)
        rpath = ":".join(map(str, self.libraries))
        # Not --enable-new-dtags: what the library needs is found by the same path.
        options = [f"-L{path}" for path in self.libraries] + [f"-Wl,--disable-new-dtags,-rpath,{rpath}"]
        if self.foreign:
            compilers = sorted((self.prefix / "lib" / "gcc" / "x86_64-linux-gnu").iterdir())
            options += [f"--sysroot={folder}", f"--gcc-install-dir={compilers[-1]}", f"-Wl,--dynamic-linker={loader}"]
        elif self.prefix != pathlib.Path("/usr"):
            options += ["-isystem", self.prefix / "include"]
        subprocess.run(["clang++-19", "-std=c++17", "-O1", "-Wall", "-Wextra", ROOT / "tests" / "peers" / "fast_dds_peer.cpp", "-o",
                        self.peer, *options, "-lfastdds" if three else "-lfastrtps", "-lfastcdr"], check=True)

    def server(self):
        """The command of its discovery server."""
        found = sorted((self.prefix / "bin").glob("fast-discovery-server*"))
        if not found:
            sys.exit(f"no fast-discovery-server in {self.prefix / 'bin'}")
        # Since 3.2 the program behind `fastdds discovery` has commands, and this number is that of a server.
        command = ["42"] if tuple(map(int, self.version.split(".")[:2])) >= (3, 2) else []
        return [*self.run, found[0], *command]


class Talk:
    """What the peer wrote: its events by kind."""

    def __init__(self, text):
        self.events = [json.loads(line) for line in text.splitlines() if line.startswith("{")]
        self.other = [line for line in text.splitlines() if not line.startswith("{")]
        self.started_s = next(iter(self.times("started")), 0.0)

    def times(self, kind, since=0.0, until=float("inf")):
        return [event["at_s"] for event in self.events if event["event"] == kind and since <= event["at_s"] < until]

    def first(self, kind, **wanted):
        """Seconds from the peer's start to its first event of that kind, or None."""
        for event in self.events:
            if event["event"] == kind and all(event[key] == value for key, value in wanted.items()):
                return event["at_s"] - self.started_s
        return None

    def echoes(self, since=0.0, until=float("inf")):
        """When a new position of the peer came back."""
        times, last = [], 0.0
        for event in self.events:
            if event["event"] == "joints" and event["position"] > last:
                last = event["position"]
                if since <= event["at_s"] < until:
                    times.append(event["at_s"])
        return times

    def slowest_write(self, since, until):
        return max((event["took_s"] for event in self.events if event["event"] == "written" and since <= event["at_s"] < until), default=None)


class Trial:
    """One gateway and one peer, that find each other in that way."""

    host = 10

    def __init__(self, library, root, server):
        self.library, self.kept = library, []
        self.gateway_place, self.peer_place = self.place(), self.place()
        self.environment, dds = dict(g.os.environ), ""
        if server:
            where = self.place()
            self.server = self.keep(where.start([*library.server(), "-i", "0", "-l", where.address, "-p", str(plant.SERVER_PORT)]))
            dds = f"discovery_servers = {plant.servers_text([where])}"
            self.environment["ROS_DISCOVERY_SERVER"] = f"{where.address}:{plant.SERVER_PORT}"
        self.cell = plant.PlantCell(root, "server" if server else "multicast", 1, self.gateway_place.address, dds, output_hz=OUTPUT_HZ, more=(
            f'[[stream]]\nrobot = "R0"\nkind = "dds"\ninterface_address = "{self.gateway_place.address}"\n'
            '[startup]\nscript = "startup.spt"\n'))
        (self.cell.home / "scripts" / "startup.spt").write_text("ROBOT R0 online;\nROBOT R0 send_on;\n")
        self.gateway = self.keep(self.gateway_place.start([*FIRST, *self.cell.command()], self.cell.environment()))
        if not g.eventually(lambda: "Ctrl-C ends it" in self.gateway.output()):
            raise AssertionError(self.gateway.output())

    def place(self):
        Trial.host += 1
        return plant.Place(Trial.host)

    def keep(self, process):
        self.kept.append(process)
        return process

    def close(self):
        for process in reversed(self.kept):
            process.close()

    def run(self, passers_by):
        peer = self.keep(self.peer_place.start([*FIRST, self.library.peer, "talker"], self.environment))

        def talk():
            return Talk(peer.output().rpartition("\n")[0])

        if not g.eventually(lambda: talk().echoes() and talk().times("summary"), every=0.5):
            return talk(), None
        quiet = (time.monotonic(), time.monotonic() + QUIET_S)
        time.sleep(QUIET_S)
        busy_from = time.monotonic()
        self.pass_by(passers_by)
        time.sleep(LEASE_S)
        busy = (busy_from, time.monotonic())
        self.status = json.loads(subprocess.run([g.BIN / "cellmirror", "status", "--json", "--instance", self.cell.name], check=True,
                                                env=self.cell.environment(), capture_output=True, text=True).stdout)
        return talk(), {"quiet": quiet, "busy": busy}

    def pass_by(self, number):
        """Half of them leave in order, the others are killed, each STAY_S after it has found the gateway."""
        def visit(index):
            visitor = self.peer_place.start([self.library.peer, "passer-by"], self.environment)
            if g.eventually(lambda: '"matched"' in visitor.output()):
                met.append(index)
            time.sleep(STAY_S)
            visitor.child.send_signal(signal.SIGKILL if index % 2 else signal.SIGTERM)
            visitor.child.wait()
            visitor.close()

        met, visits = [], []
        for index in range(number):
            visits.append(threading.Thread(target=visit, args=(index,)))
            visits[-1].start()
            time.sleep(BETWEEN_S)
        for thread in visits:
            thread.join()
        self.met = len(met)


def milliseconds(value):
    return "-" if value is None else f"{1000 * value:.0f}"


def gaps(times, since, until):
    """The longest, and how many are longer than 100 ms."""
    all_of_them = sorted(after - before for before, after in zip([since, *times], [*times, until]))
    return f"{milliseconds(all_of_them[-1])} ({sum(gap > 0.1 for gap in all_of_them)})"


def report_start(way, talk):
    matched = [talk.first("matched", topic=topic) for topic in ("rt/joint_states", ECHO, "rt/cellmirror/summary")]
    back = talk.echoes()
    print(f"{way}, ms after the start of the peer: its participant {milliseconds(talk.first('made'))}; matched: its writer "
          f"{milliseconds(matched[0])}, reader of joint states {milliseconds(matched[1])}, of summaries {milliseconds(matched[2])}; first joint states "
          f"{milliseconds(talk.first('joints'))}, first summary {milliseconds(talk.first('summary'))}, own position back "
          f"{milliseconds(back[0] - talk.started_s if back else None)}")
    for line in talk.other[:5]:
        print(f"  the peer says: {line}")


def report_span(talk, what, since, until):
    series = {"from the gateway": talk.times("joints", since, until), "to it and back": talk.echoes(since, until),
              "of the peer's own clock": talk.times("written", since, until)}
    print(f"  {what}, {until - since:.0f} s: longest gap in ms (and how many over 100): " +
          ", ".join(f"{name} {gaps(times, since, until)}" for name, times in series.items()) +
          f"; longest write() {milliseconds(talk.slowest_write(since, until))}")


def report_gateway(status):
    stream, loop = status["robots"][0]["stream"], status["loop"]
    print(f"  the gateway: {stream['received']} messages, lost {stream['lost']}, rejected {stream['rejected']}, {stream['condition']}; "
          f"its loop woke up at most {loop['wakeup_latency_us']['max'] / 1000:.0f} ms late, missed {loop['missed']} of {loop['ticks']} periods")


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    passers_by = int(sys.argv[2]) if len(sys.argv) == 3 else 20
    if not plant.is_possible() or not plant.enter():
        sys.exit("network namespaces cannot be made here")
    # Shared memory of peers that were killed, and of other versions, is not to be met.
    subprocess.run(["mount", "-t", "tmpfs", "none", "/dev/shm"], check=True)
    root = pathlib.Path(tempfile.mkdtemp(prefix="cellmirror-fast-dds-"))
    good = True
    try:
        library = Library(pathlib.Path(sys.argv[1]).resolve(), root)
        own = subprocess.run(["ldd", g.BIN / "cellmirror"], capture_output=True, text=True).stdout
        print(f"peer: Fast DDS {library.version}; gateway: {', '.join(sorted(set(re.findall(r'libfast(?:rtps|dds)[.]so[.][0-9.]+', own))))}", flush=True)
        for server in (False, True):
            trial = Trial(library, root, server)
            try:
                talk, spans = trial.run(passers_by)
                report_start(trial.cell.name, talk)
                if spans is None:
                    print("  data did not come through")
                    good = False
                    continue
                report_span(talk, "alone", *spans["quiet"])
                report_span(talk, f"while {trial.met} of {passers_by} others find the gateway and go", *spans["busy"])
                report_gateway(trial.status)
                sys.stdout.flush()
            finally:
                trial.close()
    finally:
        shutil.rmtree(root, ignore_errors=True)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
