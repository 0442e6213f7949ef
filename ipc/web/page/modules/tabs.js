// Tabs as ARIA describes them: arrow keys walk, one panel is there at a time.

export class Tabs {
  constructor(list, {opened} = {}) {
    this.tabs_ = [...list.querySelectorAll('[role="tab"]')];
    this.opened_ = opened;
    for (const tab of this.tabs_) tab.addEventListener("click", () => this.open(tab.id));
    list.addEventListener("keydown", (event) => {
      const there = this.tabs_.filter((tab) => !tab.hidden);
      const at = there.indexOf(document.activeElement);
      const to = {ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: there.length - 1}[event.key];
      if (at < 0 || to === undefined) return;
      event.preventDefault();
      const tab = there[(to + there.length) % there.length];
      this.open(tab.id);
      tab.focus();
    });
    this.open(this.tabs_.find((tab) => tab.getAttribute("aria-selected") === "true").id);
  }

  open(id) {
    for (const tab of this.tabs_) {
      const chosen = tab.id === id;
      tab.setAttribute("aria-selected", String(chosen));
      tab.tabIndex = chosen ? 0 : -1;
      document.getElementById(tab.getAttribute("aria-controls")).hidden = !chosen;
    }
    this.current = id;
    this.opened_?.(id);
  }
}
