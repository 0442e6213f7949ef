"""The device description of a master made with lely-core, for drives of a [[device]]: it boots them, and exchanges one PDO with each
on each SYNC. Objects 0x5800, 0x5A00, 0x5C00 and 0x5E00 are lely's: whose PDO it is, and what is mapped there."""

import struct

HEADER = """[DeviceInfo]
VendorName=cellmirror
LSS_Supported=1
BaudRate_1000=1
NrOfRxPDO={count}
NrOfTxPDO={count}

[DeviceComissioning]
NodeID=1

[DummyUsage]
Dummy0002=1
"""

U8, U16, U32, I32, DOMAIN = 5, 6, 7, 4, 15
HEARTBEAT_MS = 100
STATUS, POSITION = (0x6041, 16, U16), (0x6064, 32, I32)
CONTROL, TARGET = (0x6040, 16, U16), (0x607A, 32, I32)


def variable(name, kind, value=None, access="rw", mapped=False, parameter=False):
    lines = [f"ParameterName={name}", f"DataType={kind:#06x}", f"AccessType={access}"]
    if mapped:
        lines.append("PDOMapping=1")
    if value is not None:
        lines.append(f"{'Parameter' if parameter else 'Default'}Value={value}")
    return lines


def record(name, members):
    """The sections of an object of several members; sub 0 is added."""
    sections = [("", [f"ParameterName={name}", "ObjectType=0x09", f"SubNumber={len(members) + 1}"]),
                ("sub0", variable("highest sub-index", U8, len(members)))]
    return sections + [(f"sub{number:X}", lines) for number, lines in enumerate(members, 1)]


def mapping(name, entries):
    return record(name, [variable("entry", U32, f"{entry:#010x}") for entry in entries])


def pdo(objects, number, node, receives):
    """The master receives TPDO2 of the node (0x280), and sends its RPDO2 (0x300), both with SYNC."""
    mapped = (STATUS, POSITION) if receives else (CONTROL, TARGET)
    parameters, local, base = (0x1400, 0x2000, 0x280) if receives else (0x1800, 0x2200, 0x300)
    remote = 0x5800 if receives else 0x5C00
    access = "rww" if receives else "rwr"
    objects[parameters + number] = record("communication", [variable("COB-ID", U32, f"{base + node:#x}"), variable("type", U8, 1)])
    objects[parameters + 0x200 + number] = mapping(
        "mapping", [(local + number) << 16 | sub << 8 | bits for sub, (_, bits, _) in enumerate(mapped, 1)])
    objects[local + number] = record("process data", [variable(f"{index:#06x}", kind, access=access, mapped=True) for index, _, kind in mapped])
    objects[remote + number] = [("", variable("remote PDO and node", U32, f"{2 << 8 | node:#010x}"))]
    objects[remote + 0x200 + number] = mapping("remote mapping", [index << 16 | bits for index, bits, _ in mapped])


def write(folder, nodes, cyclic=False):
    """The file in the folder. The master makes the nodes send heartbeats, and watches them; `cyclic`: it has their PDOs, and sends SYNC
    once 0x1006 is written."""
    concise = folder / "heartbeat.bin"  # what it writes to a node that it boots: one entry, 0x1017 sub 0, two bytes
    concise.write_bytes(struct.pack("<IHBIH", 1, 0x1017, 0, 2, HEARTBEAT_MS))
    setting = ["ParameterName=node", f"DataType={DOMAIN:#06x}", "AccessType=ro", f"UploadFile={concise}"]
    highest = max(nodes)
    objects = {
        0x1000: [("", variable("device type", U32, 0, "ro"))], 0x1001: [("", variable("error register", U8, 0, "ro"))],
        0x1005: [("", variable("COB-ID SYNC", U32, "0x40000080"))], 0x1006: [("", variable("cycle period", U32, 0))],
        0x1014: [("", variable("COB-ID EMCY", U32, "$NODEID+0x80"))],
        0x1017: [("", variable("producer heartbeat", U16, 0))],
        0x1018: record("identity", [variable(part, U32, 0, "ro") for part in ("vendor", "product", "revision", "serial")]),
        0x1028: record("emergency consumers", [variable("node", U32, f"{0x80 + node if node in nodes else 0x80000000:#x}")
                                               for node in range(1, highest + 1)]),
        0x1F80: [("", variable("NMT startup", U32, 1, parameter=True))],
        # A slave of this master that it boots (bits 0 and 2).
        0x1F81: record("NMT slave assignment", [variable("node", U32, 5 if node in nodes else 0) for node in range(1, highest + 1)]),
    }
    objects[0x1016] = record("consumer heartbeats", [variable("node", U32, f"{node << 16 | 5 * HEARTBEAT_MS:#010x}") for node in nodes])
    objects[0x1F22] = record("concise DCF", [setting if node in nodes else variable("node", DOMAIN) for node in range(1, highest + 1)])
    if cyclic:
        for number, node in enumerate(nodes):
            pdo(objects, number, node, True)
            pdo(objects, number, node, False)
    mandatory = [0x1000, 0x1001, 0x1018]
    groups = {"MandatoryObjects": mandatory, "OptionalObjects": [i for i in objects if i not in mandatory and not 0x2000 <= i < 0x6000],
              "ManufacturerObjects": [i for i in objects if 0x2000 <= i < 0x6000]}
    text = [HEADER.format(count=len(nodes) if cyclic else 0)]
    for group, indices in groups.items():
        text += [f"[{group}]", f"SupportedObjects={len(indices)}"]
        text += [f"{place}={index:#06x}" for place, index in enumerate(sorted(indices), 1)] + [""]
    for index, sections in sorted(objects.items()):
        for suffix, lines in sections:
            text += [f"[{index:04X}{suffix}]", *lines, ""]
    path = folder / "master.dcf"
    path.write_text("\n".join(text))
    return path
