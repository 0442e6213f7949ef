// The search field of the charts: what is chosen there gets a chart of its own.
import {byId, element} from "./dom.js";
import {found_keys} from "./chart_keys.js";

const kMostChosen = 24;

export class ChartSearch {
  // `keys()`: all that are recorded; `words_of(key)`; `changed(keys)`.
  constructor({keys, words_of, changed}) {
    this.keys_ = keys;
    this.words_of_ = words_of;
    this.changed_ = changed;
    this.chosen = [];
    this.input_ = byId("chart-search");
    this.found_ = byId("chart-found");
    this.list_ = byId("chart-chosen");
    this.input_.addEventListener("input", () => this.offer_());
    this.input_.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.close_();
      else if (event.key === "Enter") this.found_.querySelector("button")?.click();
      else if (event.key === "ArrowDown") this.found_.querySelector("button")?.focus();
      else return;
      event.preventDefault();
    });
    this.found_.addEventListener("keydown", (event) => this.key_(event));
    byId("chart-search-part").addEventListener("focusout", (event) => {
      if (!byId("chart-search-part").contains(event.relatedTarget)) this.close_();
    });
  }

  set(keys) {
    this.chosen = [...new Set(keys)].slice(0, kMostChosen);
    this.list_.replaceChildren(...this.chosen.map((key) => {
      const remove = element("button", {type: "button", class: "small", "aria-label": `Remove ${this.words_of_(key)}`}, "×");
      remove.addEventListener("click", () => this.set(this.chosen.filter((other) => other !== key)));
      return element("li", {}, this.words_of_(key), remove);
    }));
    this.list_.hidden = this.chosen.length === 0;
    this.changed_(this.chosen);
  }

  offer_() {
    const found = found_keys(this.input_.value, this.keys_(), this.words_of_);
    this.found_.replaceChildren(...found.map(({key, words}) => {
      const add = element("button", {type: "button", class: "small"}, words);
      add.addEventListener("click", () => {
        this.set([...this.chosen, key]);
        this.input_.value = "";
        this.close_();
        this.input_.focus();
      });
      return element("li", {}, add);
    }));
    if (found.length === 0 && this.input_.value.trim()) this.found_.append(element("li", {class: "empty"}, "nothing of that name is recorded"));
    this.found_.hidden = this.found_.children.length === 0;
  }

  key_(event) {
    const rows = [...this.found_.querySelectorAll("button")];
    const i = rows.indexOf(document.activeElement);
    if (event.key === "ArrowDown") rows[i + 1]?.focus();
    else if (event.key === "ArrowUp") (rows[i - 1] ?? this.input_).focus();
    else if (event.key === "Escape") this.close_(this.input_.focus());
    else return;
    event.preventDefault();
  }

  close_() {
    this.found_.hidden = true;
  }
}
