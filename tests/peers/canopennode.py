"""The drives of a [[device]] commanded by CANopenNode, a master that nobody here wrote.

    /usr/bin/python3 tests/peers/canopennode.py FOLDER [INTERFACE]

FOLDER holds canopend and cocomm/cocomm, built from https://github.com/CANopenNode/CANopenLinux. Needs SocketCAN: INTERFACE is
vcan0 unless given. Starts a gateway of build/bin on a copy of can_cell. Prints what was done; the exit code is 1 where something
failed."""

import pathlib
import subprocess
import sys

import drive_walk as d

MASTER = 1  # its own node number


class Canopend(d.Commander):
    """canopend, asked by cocomm."""

    def __init__(self, folder, interface, scratch):
        self.socket = scratch / "commander"
        self.cocomm = folder / "cocomm" / "cocomm"
        self.daemon = subprocess.Popen([folder / "canopend", interface, "-i", str(MASTER), "-c", f"local-{self.socket}", "-s", f"{scratch}/"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        d.wait("canopend answers", self.socket.exists)

    def close(self):
        self.daemon.terminate()
        self.daemon.wait(10)

    def ask(self, command):
        done = subprocess.run([self.cocomm, "-s", self.socket, command], capture_output=True, text=True, timeout=60)
        return done.stdout.strip(), done.stderr.strip()

    def scan(self):
        data, answer = self.ask("_lss_fastscan 100")
        print(f"ok: _lss_fastscan: {data} {answer}")
        return data.split()


def drive_all(commander):
    for node in d.NODES:
        d.wait(f"node {node} answers", lambda node=node: commander.is_there(node))
        commander.do(f"{node} start")
    commander.do("set sdo_block 1")
    d.wait("block upload", lambda: commander.is_there(d.FIRST))
    commander.do("set sdo_block 0")
    drive = d.Drive(commander, d.FIRST)
    d.walk(drive)
    d.move(drive)
    d.fault(drive)
    d.lss(commander, 14, 44)


def main():
    if len(sys.argv) not in (2, 3):
        print(__doc__)
        return 2
    folder, interface = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2] if len(sys.argv) == 3 else "vcan0"
    for without_number in (False, True):
        cell = d.Cell(interface, without_number)
        commander = Canopend(folder, interface, cell.scratch.root)
        try:
            cell.power(True)
            if without_number:
                d.wait(f"node {d.FIRST} answers", lambda: commander.is_there(d.FIRST))
                d.take_number(commander, commander.scan)
            else:
                drive_all(commander)
        finally:
            commander.close()
            cell.close()
    print("all done with CANopenNode")
    return 0


if __name__ == "__main__":
    sys.exit(main())
