// The tree of the cell, with the levels of detail that can be switched by SCRIPT commands.
import {byId, element, setText, setAttribute} from "./dom.js";
import {TreeModel} from "./tree_model.js";

const kActions = {
  "tree-more": "LEVEL_DOWN", "tree-less": "LEVEL_UP", "tree-swap": "SWAP_NODE", "tree-show": "ACTIVATE",
  "tree-hide": "DEACTIVATE",
};

export class Tree {
  constructor({command, selected}) {
    this.model_ = new TreeModel();
    this.list_ = byId("tree-list");
    this.filter_ = byId("tree-filter");
    this.chosen_ = null;
    this.selected_ = selected;
    this.filter_.addEventListener("input", () => this.draw_());
    this.list_.addEventListener("click", (event) => this.click_(event));
    this.list_.addEventListener("keydown", (event) => this.key_(event));
    for (const [id, command_name] of Object.entries(kActions)) {
      byId(id).addEventListener("click", () => this.chosen_ && command(`${command_name} ${this.chosen_}`));
    }
    this.show_chosen_();
  }

  set(tree) {
    const nodes = Array.isArray(tree?.nodes) ? tree.nodes : [];
    const first = this.model_.size === 0;
    this.model_.set(nodes);
    const roots = this.model_.children("");
    if (first && roots.length < 3) for (const root of roots) this.model_.set_open(root.path, true);
    if (this.chosen_ && !this.model_.get(this.chosen_)) this.chosen_ = null;
    this.draw_();
    this.show_chosen_();
  }

  show(path) {
    const below = this.known_(path);
    if (!below) return;
    this.filter_.value = "";
    this.model_.reveal(below);
    this.choose_(below);
    this.draw_();
    const row = this.row_of_(below);
    row?.scrollIntoView({block: "nearest"});
    row?.focus({preventScroll: true});  // what was pressed may be out of sight now
  }

  // The node, or the one above it; null: the tree has neither.
  known_(path) {
    return [path ?? "", (path ?? "").split(".").slice(0, -1).join(".")].find((known) => this.model_.get(known)) ?? null;
  }

  // Without taking the focus or opening the panel; null, or what the tree does not have: nothing is chosen.
  choose(path) {
    const known = this.known_(path);
    if (known) this.model_.reveal(known);
    this.choose_(known);
    this.draw_();
  }

  draw_() {
    const focused = this.list_.contains(document.activeElement) ? document.activeElement.dataset.path : null;
    const rows = this.model_.rows(this.filter_.value);
    this.list_.replaceChildren(...rows.map((row) => this.row_(row)));
    byId("no-tree").hidden = rows.length > 0;
    setText(byId("tree-count"), this.model_.size ? `${this.model_.size} nodes` : "");
    const tabbed = this.list_.querySelector('[aria-selected="true"]') ?? this.list_.firstElementChild;
    if (tabbed) tabbed.tabIndex = 0;
    if (focused) this.row_of_(focused)?.focus();
  }

  row_({node, level, open, leaf}) {
    const row = element("li", {
      role: "treeitem", tabindex: "-1", "aria-level": level, "data-path": node.path, "aria-selected": String(node.path === this.chosen_),
      "aria-expanded": leaf ? null : String(open), class: node.shown === false ? "hidden-node" : null, title: node.path,
    },
      element("span", {class: "twist", "aria-hidden": "true"}, leaf ? "" : open ? "▾" : "▸"),
      element("span", {class: "name"}, this.filter_.value.trim() ? node.path : node.name),
      node.has_detail ? element("span", {class: "detail", title: "has levels of detail"}, "detail") : null,
      node.shown === false ? element("span", {class: "hidden-mark"}, "not shown") : null,
      element("span", {class: "kind"}, node.kind ?? ""));
    row.style.paddingInlineStart = `${(level - 1) * 14 + 4}px`;
    return row;
  }

  row_of_(path) {
    return [...this.list_.children].find((row) => row.dataset.path === path);
  }

  click_(event) {
    const row = event.target.closest("li");
    if (!row) return;
    const path = row.dataset.path;
    if (event.target.classList.contains("twist") || this.chosen_ === path) this.model_.set_open(path, !this.model_.is_open(path));
    this.choose_(path);
    this.draw_();
    this.row_of_(path)?.focus();
  }

  key_(event) {
    const row = event.target.closest("li");
    if (!row) return;
    const rows = [...this.list_.children];
    const i = rows.indexOf(row);
    const path = row.dataset.path;
    const go = (to) => to && (this.choose_(to.dataset.path), this.draw_(), this.row_of_(to.dataset.path)?.focus());
    if (event.key === "ArrowDown") go(rows[i + 1]);
    else if (event.key === "ArrowUp") go(rows[i - 1]);
    else if (event.key === "Home") go(rows[0]);
    else if (event.key === "End") go(rows[rows.length - 1]);
    else if (event.key === "ArrowRight" || event.key === "ArrowLeft") this.fold_(path, event.key === "ArrowRight", go, rows, i);
    else if (event.key === "Enter" || event.key === " ") this.click_(event);
    else return;
    event.preventDefault();
  }

  fold_(path, open, go, rows, i) {
    if (open !== this.model_.is_open(path) && this.model_.children(path).length) {
      this.model_.set_open(path, open);
      this.draw_();
      this.row_of_(path)?.focus();
    } else if (open) go(rows[i + 1]);
    else go(this.row_of_(this.model_.get(path)?.parent));
  }

  choose_(path) {
    if (this.chosen_ === path) return;
    this.chosen_ = path;
    this.show_chosen_();
    this.selected_?.(path);
  }

  show_chosen_() {
    const node = this.chosen_ && this.model_.get(this.chosen_);
    setText(byId("tree-chosen"), node ? node.path : "Choose a node to switch its detail.");
    for (const id of Object.keys(kActions)) byId(id).disabled = !node;
    if (!node) return;
    byId("tree-show").hidden = node.shown !== false;
    byId("tree-hide").hidden = node.shown === false;
    setAttribute(byId("tree-chosen"), "title", node.path);
  }
}
