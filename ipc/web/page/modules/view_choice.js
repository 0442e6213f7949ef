// The bar above the picture: what it shows and how it is drawn. Viewing needs no token; changes of the gateway's own
// display (STDP, STVW, SET_MODE) are sent as SCRIPT commands.
import {byId, element, setText, setAttribute} from "./dom.js";
import {as_command} from "./view_math.js";

const kModeTexts = {
  WFRM_display: "workframes", SMEAR: "trace of the TCP", BFRM: "hide back faces", CPU_BFRM: "hide back faces (processor)",
  CAM_MAINVIEW: "camera fills the display", LGT_TWOSIDE: "light on both sides", TCP_DRAW: "frame of the TCP",
  ZPF_DRAW: "frame of the zero point", FLDR: "floor", GEO_VIS_TEST: "leave out what is out of sight", SHAD: "shadows",
  BEEP: "bell with messages", TEXTURES: "textures", ANTIALIAS: "smooth edges", LEGEND: "legend",
};

export function choice_of(value) {
  if (value.startsWith("view:")) return {kind: "view", id: Number(value.slice(5))};
  if (value.startsWith("camera:")) return {kind: "camera", name: value.slice(7)};
  return {kind: "display"};
}

export function value_of(choice) {
  if (choice.kind === "view") return `view:${choice.id}`;
  if (choice.kind === "camera") return `camera:${choice.name}`;
  return choice.kind;
}

export class ViewChoice {
  constructor({choose, current, command}) {
    this.choose_ = choose;
    this.current_ = current;
    this.command_ = command;
    this.select_ = byId("view-choice");
    this.cameras_ = byId("camera-choices");
    this.known_cameras_ = "";
    this.known_modes_ = "";
    this.mode_boxes_ = new Map();
    this.select_.addEventListener("change", () => {
      if (this.select_.value !== "free") choose(choice_of(this.select_.value));
    });
    byId("view-home").addEventListener("click", () => choose({kind: "display"}));
    this.display_choice_ = byId("display-choice");
    this.display_choice_.addEventListener("change", () => this.choose_display_());
    byId("view-full").addEventListener("click", () =>
      command(`STDP ${this.display_?.display ?? 1} ${this.display_?.full_screen ? "FULL_OFF" : "FULL"}`));
    byId("view-keep").addEventListener("click", () => this.keep_());
    this.chosen(current());
  }

  // While the gateway has not answered, what was chosen stands there; where it refuses, what is so.
  async choose_display_() {
    const chosen = this.display_choice_.value;
    this.display_asked_ = chosen;
    const done = await this.command_(`STDP ${chosen}`);
    if (this.display_asked_ !== chosen) return;  // another one was chosen meanwhile
    this.display_asked_ = null;
    if (done) this.display_known_ = chosen;
    else this.display_choice_.value = this.display_known_ ?? "1";
  }

  // Written only when it changes: a list that is open would be disturbed.
  show_display_(display) {
    if ((this.display_asked_ ?? null) !== null || display === this.display_known_) return;
    this.display_known_ = display;
    this.display_choice_.value = display;
  }

  // The free view becomes view N of the gateway, for all users.
  keep_() {
    const choice = this.current_();
    if (choice.kind === "free") this.command_(as_command(choice.view, byId("view-keep-id").value));
  }

  chosen(choice) {
    const free = choice.kind === "free";
    byId("free-choice").hidden = !free;
    this.select_.value = value_of(choice);
    byId("view-keep-group").hidden = !free;
    byId("view-home").disabled = choice.kind === "display";
  }

  update(live) {
    this.display_ = live.display ?? null;
    const cameras = (live.cameras ?? []).map((camera) => camera.name ?? camera);
    if (cameras.join("\n") !== this.known_cameras_) {
      this.known_cameras_ = cameras.join("\n");
      this.cameras_.replaceChildren(...cameras.map((name) => element("option", {value: `camera:${name}`}, name)));
      this.cameras_.hidden = cameras.length === 0;
      this.select_.value = value_of(this.current_());
    }
    if (!this.display_) return;
    this.show_displays_(this.display_choice_, this.display_.displays ?? []);
    this.show_display_(String(this.display_.display ?? 1));
    setAttribute(byId("view-full"), "aria-pressed", String(this.display_.full_screen === true));
    this.show_views_(this.display_.views ?? []);
    this.show_modes_(this.display_.modes ?? {});
  }

  show_views_(views) {
    for (const view of views) {
      const option = this.select_.querySelector(`option[value="view:${Number(view.id)}"]`);
      if (!option) continue;
      const note = view.camera ? `, at ${view.camera}` : view.moving ? ", moving" : "";
      option.dataset.title ??= option.textContent;
      const title = view.name ? `View ${Number(view.id)}, ${view.name}` : option.dataset.title;
      setText(option, title + note);
    }
  }

  // As the cell's layout file names them.
  show_displays_(select, displays) {
    for (const {id, name} of displays) {
      const option = select.querySelector(`option[value="${Number(id)}"]`);
      if (option) setText(option, `${Number(id)}, ${name}`);
    }
  }

  show_modes_(modes) {
    const names = Object.keys(modes);
    if (names.join("\n") !== this.known_modes_) {
      this.known_modes_ = names.join("\n");
      this.mode_boxes_.clear();
      byId("mode-list").replaceChildren(...names.map((name) => this.mode_row_(name)));
    }
    for (const name of names) this.mode_boxes_.get(name).checked = modes[name] === true;
  }

  mode_row_(name) {
    const box = element("input", {type: "checkbox"});
    box.addEventListener("change", () => this.command_(`SET_MODE ${name} ${box.checked ? "on" : "off"}`));
    this.mode_boxes_.set(name, box);
    const known = Object.entries(kModeTexts).find(([key]) => key.toLowerCase() === name.toLowerCase());
    return element("label", {class: "mode"}, box, element("span", {}, known?.[1] ?? ""), element("code", {}, name));
  }
}
