// Names what was picked in the picture, beside the place.
import {byId, setText} from "./dom.js";

const kNothing_ms = 3000;

export class PickedLabel {
  constructor({show_robot, show_node}) {
    this.node_ = byId("picked");
    this.found_ = null;
    byId("picked-robot").addEventListener("click", () => show_robot(this.found_.robot));
    byId("picked-node").addEventListener("click", () => show_node(this.found_.path));
    byId("picked-close").addEventListener("click", () => this.show(null));
  }

  show(found) {
    this.found_ = found;
    this.node_.hidden = found === null;
    clearTimeout(this.timer_);
    if (!found) return;
    if (!found.path) this.timer_ = setTimeout(() => this.show(null), kNothing_ms);
    setText(byId("picked-path"), found.path ?? (found.text || "nothing is there"));
    setText(byId("picked-robot"), found.robot ? `Robot ${found.robot}` : "");
    byId("picked-robot").hidden = !found.robot;
    byId("picked-node").hidden = !found.path;
    const area = this.node_.offsetParent;
    const left = Math.max(4, Math.min(found.x + 12, (area?.clientWidth ?? 400) - this.node_.offsetWidth - 4));
    const top = Math.max(4, Math.min(found.y + 12, (area?.clientHeight ?? 300) - this.node_.offsetHeight - 4));
    this.node_.style.transform = `translate(${left}px, ${top}px)`;
  }
}
