"""Reads the published node sets (UANodeSet XML) and tells what an instance of a type lacks.

A node is named "URI|id", as client.mjs names it."""

import re
import xml.etree.ElementTree as ElementTree

NAMESPACE = "{http://opcfoundation.org/UA/2011/03/UANodeSet.xsd}"
BASE = "http://opcfoundation.org/UA/"
MANDATORY, SOME = f"{BASE}|i=78", f"{BASE}|i=11510"  # modelling rules Mandatory, MandatoryPlaceholder
HAS_SUBTYPE, HAS_RULE, HAS_TYPE = (f"{BASE}|i={number}" for number in (45, 37, 40))
PARTS = {f"{BASE}|i={number}" for number in (46, 47, 49, 35)}  # HasProperty, HasComponent, HasOrderedComponent, Organizes


class Node:
    def __init__(self, element, name, named):
        self.id = named(element.get("NodeId"))
        self.name = name(element.get("BrowseName"))
        self.kind = element.tag.removeprefix(NAMESPACE).removeprefix("UA")
        self.abstract = element.get("IsAbstract") == "true"
        self.data_type = named(element.get("DataType") or "i=24")
        self.rule = self.type = self.supertype = None
        self.parts = set()


class NodeSets:
    def __init__(self, files):
        self.nodes = {}
        for file in files:
            self.read(file)

    def read(self, file):
        root = ElementTree.parse(file).getroot()
        uris = [BASE] + [uri.text for uri in root.iterfind(f"{NAMESPACE}NamespaceUris/{NAMESPACE}Uri")]
        aliases = {alias.get("Alias"): alias.text for alias in root.iterfind(f"{NAMESPACE}Aliases/{NAMESPACE}Alias")}

        def named(text):
            found = re.fullmatch(r"(?:ns=(\d+);)?(.*)", aliases.get(text, text).strip())
            return f"{uris[int(found[1] or 0)]}|{found[2]}"

        def name(text):
            found = re.fullmatch(r"(?:(\d+):)?(.*)", text)
            return f"{uris[int(found[1] or 0)]}|{found[2]}"

        elements = [element for element in root if element.get("NodeId")]
        for element in elements:
            node = Node(element, name, named)
            self.nodes[node.id] = node
        for element in elements:
            for reference in element.iter(f"{NAMESPACE}Reference"):
                forward = reference.get("IsForward") != "false"
                ends = [named(element.get("NodeId")), named(reference.text)]
                self.connect(named(reference.get("ReferenceType")), *(ends if forward else reversed(ends)))

    def connect(self, by, start, end):
        if start not in self.nodes:
            return
        if by == HAS_RULE:
            self.nodes[start].rule = end
        elif by == HAS_TYPE:
            self.nodes[start].type = end
        elif by == HAS_SUBTYPE and end in self.nodes:
            self.nodes[end].supertype = start
        elif by in PARTS:
            self.nodes[start].parts.add(end)

    def is_a(self, kind, wanted):
        while kind and kind != wanted:
            kind = self.nodes[kind].supertype if kind in self.nodes else None
        return kind == wanted

    def declared(self, kind):
        """What a type and those that it is made of declare."""
        while kind in self.nodes:
            yield from (self.nodes[part] for part in self.nodes[kind].parts if part in self.nodes)
            kind = self.nodes[kind].supertype


class Judge:
    """Compares instances, {id: node of client.mjs}, with what the node sets demand of them."""

    def __init__(self, sets, nodes):
        self.sets, self.nodes = sets, nodes
        self.faults = []

    def judge_all(self):
        for node in self.nodes.values():
            if not node["type"]:
                continue
            if node["type"] not in self.sets.nodes:
                self.faults.append(f"{node['id']}: the type {node['type']} is not in the node sets")
            elif self.sets.nodes[node["type"]].abstract:
                self.faults.append(f"{node['id']}: its type {node['type']} is abstract")
            else:
                self.judge(node, self.sets.declared(node["type"]))
        return self.faults

    def parts(self, node):
        return [self.nodes[child["id"]] for child in node["children"] if child["by"] in PARTS and child["id"] in self.nodes]

    def judge(self, node, declarations):
        for wanted in declarations:
            if wanted.rule == SOME:
                if not any(self.sets.is_a(part["type"], wanted.type) for part in self.parts(node)):
                    self.faults.append(f"{node['id']} has none of {wanted.name}")
            found = next((part for part in self.parts(node) if part["name"] == wanted.name), None)
            if found is None and wanted.rule == MANDATORY:
                self.faults.append(f"{node['id']} lacks {wanted.name}")
            elif found is not None:
                self.judge_part(found, wanted)

    def judge_part(self, found, wanted):
        if found["kind"] != wanted.kind:
            self.faults.append(f"{found['id']} is a {found['kind']}, not a {wanted.kind}")
        elif wanted.type and not self.sets.is_a(found["type"], wanted.type):
            self.faults.append(f"{found['id']} is of the type {found['type']}, not {wanted.type}")
        elif wanted.kind == "Variable" and not self.sets.is_a(found["data_type"], wanted.data_type):
            self.faults.append(f"{found['id']} has the data type {found['data_type']}, not {wanted.data_type}")
        self.judge(found, (self.sets.nodes[part] for part in wanted.parts if part in self.sets.nodes))
