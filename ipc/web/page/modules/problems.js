// What is wrong around the gateway and lasts: a banner, for as long as it does.
import {byId, element} from "./dom.js";

export class Problems {
  constructor() {
    this.shown_ = "";
  }

  update(live) {
    const texts = (live.problems ?? []).map((problem) => problem.text ?? "");
    const all = texts.join("\n");
    if (all === this.shown_) return;
    this.shown_ = all;
    byId("problem-list").replaceChildren(...texts.map((text) => element("li", {}, text)));
    byId("problems").hidden = texts.length === 0;
  }
}
