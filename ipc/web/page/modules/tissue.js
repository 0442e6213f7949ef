// Deformable objects: what they are, what instruments do to them, what happened; with the buttons that freeze and
// restore them, and switch effects. There only in cells that have such objects.
import {byId, element, setText, setAttribute, KeyedRows} from "./dom.js";
import {age, count, length, microseconds, number} from "./format.js";

const kShownEffects = ["PULSE", "BLEEDING", "POOL_RIPPLES"];  // the others need a robot, which the console names

const plural = (n, word) => `${count(n)} ${word}${n === 1 ? "" : "s"}`;
const percent = (share) => `${number(100 * share, 1)} %`;

export function object_text(object) {
  const words = [plural(object.nodes, "node"), plural(object.contacts, "contact")];
  if (object.parts > 1) words.push(`cut into ${object.parts} parts`);
  if (object.coagulated_share > 0) words.push(`${percent(object.coagulated_share)} coagulated`);
  if (object.frozen) words.push("frozen");
  return words.join(", ");
}

export function instrument_text(instrument) {
  const words = [instrument.kind];
  if (instrument.acting) words.push("acting");
  if (instrument.held > 0) words.push(`holds ${plural(instrument.held, "point")}`);
  return words.join(", ");
}

export function vessel_text(vessel) {
  const words = [plural(vessel.clips, "clip")];
  if (vessel.severed) words.push("cut");
  if (vessel.bleeding_ml_min > 0) words.push(`bleeds ${number(vessel.bleeding_ml_min, 1)} ml/min`);
  return words.join(", ");
}

const place_text = (at) => `(${at.map((value) => number(1000 * value, 1)).join(", ")}) mm`;

// What and where; the time is beside it.
export function event_text(event) {
  const of = [event.part, event.object].filter(Boolean).join(" of ");
  return [event.kind.replace("_", " "), event.limit, event.robot && `by ${event.robot}`, of && `on ${of}`,
    `at ${place_text(event.at_m)}`].filter(Boolean).join(" ");
}

// What the simulation is doing, and what it costs.
export function step_text(tissue) {
  if (!tissue.calculating) return "off: everything keeps its shape";
  const late = tissue.late_steps ? `, ${plural(tissue.late_steps, "step")} late` : "";
  return `${number(tissue.rate_hz, 0)} Hz, a step ${microseconds(tissue.step_p50_us)}, p99 ${microseconds(tissue.step_p99_us)}${late}`;
}

export function fluid_text(tissue) {
  const words = [];
  if (tissue.bleeding_ml_min > 0) words.push(`bleeds ${number(tissue.bleeding_ml_min, 1)} ml/min`);
  if (tissue.blood_loss_ml > 0) words.push(`${number(tissue.blood_loss_ml, 1)} ml lost`);
  if (tissue.pool_level_m !== null && tissue.pool_level_m !== undefined) words.push(`pool ${length(tissue.pool_level_m)}`);
  if (tissue.smoke > 0) words.push(`smoke ${percent(tissue.smoke)}`);
  if (tissue.lens_fog > 0) words.push(`lens fogged ${percent(tissue.lens_fog)}`);
  if (tissue.connections_torn > 0) words.push(`${plural(tissue.connections_torn, "connection")} torn`);
  if (tissue.excesses > 0) words.push(`${plural(tissue.excesses, "value")} beyond limits`);
  return words.join(", ");
}

const named_row = (kind) => () => {
  const row = {name: element("span", {class: "name"}), value: element("span", {class: "value"}), more: element("span", {class: "more"})};
  row.node = element("li", {class: kind}, row.name, row.value, row.more);
  return row;
};

function event_row() {
  const row = {text: element("span"), time: element("time")};
  row.node = element("li", {class: "tissue-event"}, row.time, row.text);
  return row;
}

export class Tissue {
  // `left`: called when the panel is no longer there.
  constructor({command, left}) {
    this.left_ = left;
    this.there_ = false;
    const on = (id, text) => byId(id).addEventListener("click", () => command(text()));
    on("tissue-calc", () => `eladyn_calc ${this.now_?.calculating ? "off" : "on"}`);
    on("tissue-reset", () => "eladyn_model_reset");
    on("tissue-network", () => `eladyn_show_def ${this.now_?.network_shown ? 0 : 1}`);
    on("tissue-reset-pool", () => "EFFECTS RESET_POOL");
    on("tissue-clean-lens", () => "EFFECTS CLEAN_ENDOSCOPIC_LENSE");
    this.effects_ = kShownEffects.map((effect) => {
      const button = element("button", {type: "button", class: "small", title: `EFFECTS ${effect}`, "data-effect": effect},
        effect.toLowerCase().replace("_", " "));
      button.addEventListener("click", () => command(`EFFECTS ${effect} ${this.now_?.effects[effect] ? "OFF" : "ON"}`));
      return {effect, button};
    });
    byId("tissue-effects").append(...this.effects_.map(({button}) => button));
    this.objects_ = new KeyedRows(byId("tissue-objects"), named_row("tissue-object"), (row, object) => {
      setText(row.name, object.name);
      setText(row.value, object_text(object));
    });
    this.instruments_ = new KeyedRows(byId("tissue-instruments"), named_row("instrument"), (row, instrument) => {
      setText(row.name, instrument.robot);
      setText(row.value, `${number(instrument.force_n, 2)} N`);
      setText(row.more, instrument_text(instrument));
    });
    this.vessels_ = new KeyedRows(byId("tissue-vessels"), named_row("vessel"), (row, vessel) => {
      setText(row.name, `${vessel.name} of ${vessel.object}`);
      setText(row.value, vessel_text(vessel));
      row.node.classList.toggle("warning", vessel.bleeding_ml_min > 0);
    });
    this.events_ = new KeyedRows(byId("tissue-events"), event_row, (row, event) => {
      setText(row.time, `${age(event.age_s)} ago`);
      setText(row.text, event_text(event));
    });
  }

  update(live, visible) {
    this.now_ = live.tissue ?? null;
    const there = this.now_ !== null;
    if (there !== this.there_) {
      this.there_ = there;
      byId("tab-tissue").hidden = !there;
      if (!there) this.left_();
    }
    if (there && visible) this.show_(this.now_);
  }

  show_(tissue) {
    setText(byId("tissue-step"), step_text(tissue));
    setText(byId("tissue-fluids"), fluid_text(tissue));
    setText(byId("tissue-calc"), tissue.calculating ? "Freeze" : "Calculate");
    setAttribute(byId("tissue-network"), "aria-pressed", String(tissue.network_shown));
    for (const {effect, button} of this.effects_) setAttribute(button, "aria-pressed", String(tissue.effects[effect]));
    this.objects_.show(tissue.objects, (object) => object.name);
    this.instruments_.show(tissue.instruments, (instrument) => instrument.robot);
    this.vessels_.show(tissue.vessels, (vessel) => `${vessel.object}\n${vessel.name}`);
    this.events_.show([...tissue.events].reverse(), (event) => event.number);
    byId("tissue-instrument-part").hidden = tissue.instruments.length === 0;
    byId("tissue-vessel-part").hidden = tissue.vessels.length === 0;
    byId("no-tissue-events").hidden = tissue.events.length > 0;
    setText(byId("no-tissue-events"), "Nothing has happened yet.");
    byId("no-tissue-events").classList.remove("unknown");
  }
}
