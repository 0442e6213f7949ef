// The tools of the 3D view: show all, cut, measure.
import {byId, setText, setAttribute} from "./dom.js";
import {length} from "./format.js";

const kAxes = {x: 0, y: 1, z: 2};
const kSteps = 200;  // of the slider

// What lies between two points, in words.
export function distance_in_words(a, b) {
  const parts = ["x", "y", "z"].map((name, i) => `${name} ${length(b[i] - a[i])}`);
  return `${length(Math.hypot(...a.map((value, i) => b[i] - value)))} (${parts.join(", ")})`;
}

export class SceneTools {
  // `mode`: SceneMode.
  constructor({mode}) {
    this.mode_ = mode;
    this.points_ = [];
    this.measuring_ = false;
    this.cut_axis_ = byId("scene-cut");
    this.cut_at_ = byId("scene-cut-at");
    this.cut_flip_ = byId("scene-cut-flip");
    for (const control of [this.cut_axis_, this.cut_at_]) control.addEventListener("input", () => this.cut_now_());
    this.cut_flip_.addEventListener("click", () => {
      setAttribute(this.cut_flip_, "aria-pressed", String(this.cut_flip_.getAttribute("aria-pressed") !== "true"));
      this.cut_now_();
    });
    byId("scene-measure").addEventListener("click", () => this.measure_(!this.measuring_));
    byId("scene-fit").addEventListener("click", () => this.fit_());
    this.show_measuring_();
  }

  show(on) {
    byId("scene-tools").hidden = !on;
    if (!on && this.measuring_) this.measure_(false);
  }

  // Another cell, or other bodies: the range of the cut is another one.
  loaded() {
    this.cut_now_();
  }

  cut_now_() {
    const axis = kAxes[this.cut_axis_.value] ?? null;
    this.cut_at_.hidden = axis === null;
    this.cut_flip_.hidden = axis === null;
    const scene = this.mode_.scene;
    const bounds = axis === null ? null : scene?.bounds();
    if (!bounds) {
      scene?.cut(null);
      return;
    }
    const [low, high] = [bounds[0][axis], bounds[1][axis]];
    const at_m = low + ((high - low) * Number(this.cut_at_.value)) / kSteps;
    scene.cut(axis, at_m, this.cut_flip_.getAttribute("aria-pressed") === "true");
    setAttribute(this.cut_at_, "aria-valuetext", length(at_m));
  }

  fit_() {
    const bounds = this.mode_.scene?.bounds();
    if (bounds) this.mode_.fit(...bounds);
  }

  measure_(on) {
    this.measuring_ = on;
    this.points_ = [];
    this.mode_.scene?.measure([], "");
    this.show_measuring_();
  }

  // True: the picked place belongs to a measurement.
  takes(found) {
    if (!this.measuring_) return false;
    if (!found) return true;
    if (this.points_.length === 2) this.points_ = [];
    this.points_.push(found.point);
    const text = this.points_.length === 2 ? distance_in_words(...this.points_) : "";
    this.mode_.scene.measure(this.points_, text);
    this.show_measuring_(text);
    return true;
  }

  show_measuring_(text = "") {
    setAttribute(byId("scene-measure"), "aria-pressed", String(this.measuring_));
    const steps = ["Click the first point.", "Click the second point.", text];
    setText(byId("scene-measured"), this.measuring_ ? steps[this.points_.length] : "");
  }
}
