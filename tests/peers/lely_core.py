"""The drives of a [[device]] commanded by lely-core, a master that nobody here wrote.

    /usr/bin/python3 tests/peers/lely_core.py FOLDER [INTERFACE]

FOLDER is where https://gitlab.com/lely_industries/lely-core was installed: bin/coctl, include and lib. Needs SocketCAN: INTERFACE is
vcan0 unless given; and g++ for lely_master.cpp, our master of lely's C++ library. Starts a gateway of build/bin on a copy of can_cell.
Prints what was done; the exit code is 1 where something failed."""

import os
import pathlib
import re
import subprocess
import sys
import threading
import time

import drive_walk as d
import lely_dcf

MASTER = 1  # its own node number

class Coctl(d.Commander):
    """coctl, asked on its standard input. It answers a command when it is done, and tells of the nodes in between."""

    def __init__(self, folder, interface, scratch):
        dcf = lely_dcf.write(scratch, list(d.NODES))
        command = ["stdbuf", "-oL", folder / "bin" / "coctl", "--inhibit=0", interface, dcf]
        self.process = subprocess.Popen(command, env=environment(folder), stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, text=True, bufsize=1)
        self.lines, self.count, self.told = [], 0, threading.Condition()
        threading.Thread(target=self.listen, daemon=True).start()
        self.do("set network 1")
        self.do("set sdo_timeout 1000")

    def listen(self):
        for line in self.process.stdout:
            with self.told:
                if re.match(r"\[\d|\d", line):
                    self.lines.append(line.strip())
                self.told.notify_all()

    def close(self):
        self.process.stdin.close()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()

    def ask(self, command, timeout=60.0):
        self.count += 1
        sign = f"[{self.count}] "
        self.process.stdin.write(f"{command}\n")
        end = time.monotonic() + timeout
        with self.told:
            while not (answers := [line for line in self.lines if line.startswith(sign)]):
                if not self.told.wait(end - time.monotonic()):
                    raise AssertionError(f"coctl does not answer {command}: {self.lines[-3:]}")
        answer = answers[0].removeprefix(sign)
        return ("", answer) if "ERROR" in answer else (answer, "")

    def heard(self, pattern):
        self.ask(f"{MASTER} r 0x1001 0 u8")  # coctl prints what it has heard before the next command
        with self.told:
            return any(re.fullmatch(pattern, line) for line in self.lines)

    def scan(self):
        data, answer = self.ask("_lss_fastscan 0 0 0 0 0 0 0 0")
        print(f"ok: _lss_fastscan: {data}{answer}")
        return data.split()


def environment(folder):
    return {**os.environ, "LD_LIBRARY_PATH": str(folder / "lib")}


def drive_all(commander):
    commander.do("init 0")
    for node in d.NODES:
        d.wait(f"coctl has booted node {node}", lambda node=node: commander.heard(rf"1 {node} USER BOOT (PREOP|OPER)"))
        d.wait(f"node {node} answers", lambda node=node: commander.is_there(node))
        commander.do(f"{node} start")
    drive = d.Drive(commander, d.FIRST)
    d.walk(drive)
    d.move(drive)
    d.fault(drive)
    d.wait("coctl has heard the emergency", lambda: commander.heard(rf"1 {d.FIRST} EMCY 8611 .*"))
    for node in list(d.NODES)[1:]:
        d.walk(d.Drive(commander, node))
    commander.do(f"lss_identity 0 0 0 0 {d.FIRST} {d.FIRST}")
    print("ok: LSS identify remote slave")
    if commander.ask("lss_identity 0 0 0 0 100 127")[0] == "OK":
        raise AssertionError("somebody identified himself with a serial number that nobody has")
    d.lss(commander, 14, 44)


def find_node(commander):
    commander.do("init 0")
    d.wait(f"node {d.FIRST} answers", lambda: commander.is_there(d.FIRST))
    commander.do("lss_ident_nonconf")
    print("ok: LSS identify non-configured remote slave")
    d.take_number(commander, commander.scan)


def with_coctl(folder, interface, without_number, task):
    cell = d.Cell(interface, without_number)
    try:
        cell.power(True)
        commander = Coctl(folder, interface, cell.scratch.root)
        try:
            task(commander)
        except AssertionError:
            print("\n".join(commander.lines[-10:]))
            raise
        finally:
            commander.close()
    finally:
        cell.close()


def with_library(folder, interface):
    """lely_master.cpp boots the drives, and moves all of them by SYNC and PDOs."""
    cell = d.Cell(interface)
    try:
        program = cell.scratch.root / "lely_master"
        source = pathlib.Path(__file__).with_name("lely_master.cpp")
        subprocess.run(["g++", "-std=c++17", "-O1", f"-I{folder}/include", "-o", program, source, f"-L{folder}/lib", "-llely-coapp", "-llely-co",
                        "-llely-io2", "-llely-ev", "-llely-util", "-llely-can", "-llely-libc"], check=True)
        dcf = lely_dcf.write(cell.scratch.root, list(d.NODES), cyclic=True)
        cell.power(True)
        subprocess.run([program, interface, dcf, *map(str, d.NODES)], env=environment(folder), check=True, timeout=120)
    finally:
        cell.close()


def main():
    if len(sys.argv) not in (2, 3):
        print(__doc__)
        return 2
    folder, interface = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2] if len(sys.argv) == 3 else "vcan0"
    with_coctl(folder, interface, False, drive_all)
    with_coctl(folder, interface, True, find_node)
    with_library(folder, interface)
    print("all done with lely-core")
    return 0


if __name__ == "__main__":
    sys.exit(main())
