// Small helpers for the document. Texts always go in as text, never as markup: names come from cell files.

export function byId(id) {
  return document.getElementById(id);
}

// element("li", {class: "row", "aria-label": "x"}, child, "text", ...)
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === true) made.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

const kText = Symbol("text");

// Writes only what changed: unchanged text costs no layout. What was written is remembered, since reading it back from
// the document costs more than all the rest; so no other code may write into that node.
export function setText(node, text) {
  if (node[kText] === text) return;
  node[kText] = text;
  node.textContent = text;
}

export function setAttribute(node, name, value) {
  if (value === null || value === false) {
    if (node.hasAttribute(name)) node.removeAttribute(name);
  } else if (node.getAttribute(name) !== String(value)) {
    node.setAttribute(name, value);
  }
}

// True while the element takes room on the screen, as of the last change that the browser reported.
export class Visibility {
  constructor(root = null) {
    this.visible_ = new WeakMap();
    this.observer_ = new IntersectionObserver((entries) => {
      for (const entry of entries) this.visible_.set(entry.target, entry.isIntersecting);
    }, {root, rootMargin: "100px"});
  }

  watch(node) {
    this.visible_.set(node, true);
    this.observer_.observe(node);
  }

  forget(node) {
    this.observer_.unobserve(node);
  }

  sees(node) {
    return this.visible_.get(node) === true;
  }
}

// Keeps one row for each key, in the order of `items`; `make` builds a row, `update` fills it.
export class KeyedRows {
  constructor(parent, make, update) {
    this.parent_ = parent;
    this.make_ = make;
    this.update_ = update;
    this.rows_ = new Map();
    this.order_ = [];  // [{key, row}] as it stands in the document
  }

  show(items, key_of) {
    const same = items.length === this.order_.length && items.every((item, i) => key_of(item) === this.order_[i].key);
    if (same) items.forEach((item, i) => this.update_(this.order_[i].row, item));
    else this.rearrange_(items, key_of);
  }

  rearrange_(items, key_of) {
    this.order_ = [];
    const gone = new Set(this.rows_.keys());
    let before = this.parent_.firstElementChild;
    for (const item of items) {
      const key = key_of(item);
      if (gone.has(key)) gone.delete(key);
      else if (this.rows_.has(key)) continue;  // twice the same key: the first one counts
      let row = this.rows_.get(key);
      if (!row) {
        row = this.make_(item);
        this.rows_.set(key, row);
      }
      if (row.node !== before) this.parent_.insertBefore(row.node, before);
      else before = before.nextElementSibling;
      this.order_.push({key, row});
      this.update_(row, item);
    }
    for (const key of gone) {
      this.rows_.get(key).node.remove();
      this.rows_.delete(key);
    }
  }

  get(key) {
    return this.rows_.get(key);
  }
}
