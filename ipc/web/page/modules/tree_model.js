// The tree of the cell as rows that can be seen. Pure.

export class TreeModel {
  constructor() {
    this.set([]);
    this.open_ = new Set();
  }

  // nodes: {path, name, parent, kind, shown, has_detail}; `parent` is a path, or null or "" at the top.
  set(all) {
    const nodes = all.filter((node) => node.path !== "");  // the world itself has no name and no switch
    this.nodes_ = new Map(nodes.map((node) => [node.path, node]));
    this.children_ = new Map();
    for (const node of nodes) {
      const parent = this.nodes_.has(node.parent) && node.parent !== node.path ? node.parent : "";
      if (!this.children_.has(parent)) this.children_.set(parent, []);
      this.children_.get(parent).push(node);
    }
  }

  get size() {
    return this.nodes_.size;
  }

  get(path) {
    return this.nodes_.get(path);
  }

  children(path) {
    return this.children_.get(path) ?? [];
  }

  is_open(path) {
    return this.open_.has(path);
  }

  set_open(path, open) {
    if (open) this.open_.add(path);
    else this.open_.delete(path);
  }

  // Opens what is above it.
  reveal(path) {
    const passed = new Set();
    for (let node = this.nodes_.get(path); node && !passed.has(node.path); node = this.nodes_.get(node.parent)) {
      passed.add(node.path);
      if (node.path !== path) this.open_.add(node.path);
    }
  }

  // [{node, level, open, leaf}], at most `most`; with a filter, all nodes whose path has it in them, without levels.
  rows(filter = "", most = 2000) {
    const low = filter.trim().toLowerCase();
    if (low) {
      const found = [...this.nodes_.values()].filter((node) => node.path.toLowerCase().includes(low));
      return found.slice(0, most).map((node) => ({node, level: 1, open: false, leaf: true}));
    }
    const rows = [];
    const waiting = this.children("").map((node) => ({node, level: 1})).reverse();
    const seen = new Set();  // a ring of parents must not run for ever
    while (waiting.length && rows.length < most) {
      const {node, level} = waiting.pop();
      if (seen.has(node.path)) continue;
      seen.add(node.path);
      const below = this.children(node.path);
      const open = below.length > 0 && this.open_.has(node.path);
      rows.push({node, level, open, leaf: below.length === 0});
      if (open) for (let i = below.length - 1; i >= 0; --i) waiting.push({node: below[i], level: level + 1});
    }
    return rows;
  }
}
