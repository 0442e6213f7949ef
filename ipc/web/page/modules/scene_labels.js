// Texts at points of the cell, over the 3D view: as elements of the page, so that they are sharp and follow its colours.
import {byId, element, setText} from "./dom.js";

const kMost = 60;

export class SceneLabels {
  constructor() {
    this.area_ = byId("scene-labels");
    this.rows_ = [];
    this.labels_ = [];
  }

  // [{at_m, text, mark}]
  set(labels) {
    this.labels_ = labels.slice(0, kMost);
    while (this.rows_.length < this.labels_.length) {
      const row = element("span", {class: "scene-label"});
      this.rows_.push(row);
      this.area_.append(row);
    }
    this.rows_.forEach((row, i) => {
      const label = this.labels_[i];
      row.hidden = !label;
      if (!label) return;
      setText(row, label.text);
      row.dataset.mark = label.mark ?? "";
    });
  }

  // `place(at_m)`: [x, y] in pixels of the area, or null where it is not in sight.
  place(place) {
    this.labels_.forEach((label, i) => {
      const at = place(label.at_m);
      this.rows_[i].hidden = at === null;
      if (at) this.rows_[i].style.transform = `translate(${at[0].toFixed(1)}px, ${at[1].toFixed(1)}px) translate(-50%, -140%)`;
    });
  }
}
