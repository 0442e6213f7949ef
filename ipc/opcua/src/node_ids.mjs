// Names of nodes. A NodeId is text made of the instance and the names of robots and joints: the same after every start.
// Children that a type brings along have the id of their parent, kChildMark and their BrowseName.
export const kChildMark = "."; // escaped in names

// Letters, digits, _ and - stay; of everything else the bytes of UTF-8 as %XX.
export function escaped(name) {
  let text = "";
  for (const byte of Buffer.from(name, "utf8")) {
    const character = String.fromCharCode(byte);
    text += /[A-Za-z0-9_-]/.test(character) ? character : `%${byte.toString(16).toUpperCase().padStart(2, "0")}`;
  }
  return text;
}

export function node_id(...names) {
  return `s=${names.map(escaped).join("/")}`;
}
