// Voxel volumes: how often values occur, the look-up table with its parameters, the six clipping planes. Every change
// goes out as the SCRIPT command that it is. There only in cells that have a volume.
import {byId, element, setText, setAttribute, KeyedRows} from "./dom.js";
import {count, number} from "./format.js";

const kDegrees = 180 / Math.PI;
const kHeld_ms = 600;  // for so long news do not change back what a person has changed
const kWidth = 128;  // of the histogram's drawing, and its height
const kHeight = 40;

const kMedical = "MEDICAL_LUT";
const kTables = {
  MEDICAL_LUT: "medical, by CT value", LIN_LUT: "linear", EXP_LUT: "exponential", RAINBOW_LUT: "rainbow",
  USER1_LUT: "user's 1", USER2_LUT: "user's 2",
};
const kMedicalParameters = ["air", "fat", "tissue", "bone"].map((name) => ({name, low: 0, high: 1}));
const kOtherParameters = [
  {name: "opacity", low: 0, high: 3}, {name: "gain", low: 0, high: 20}, {name: "level", low: 1, high: 3}, {name: "window", low: 0, high: 1.57},
];
export const parameters_of = (table) => (table === kMedical ? kMedicalParameters : kOtherParameters);

// As SCRIPT reads numbers, without needless digits.
const script_number = (value, digits) => String(Number(value.toFixed(digits)));

// `volume`: a name, or empty for all.
const with_volume = (command, volume) => (volume ? `${command} ${volume}` : command);
export const table_command = (table, volume) => with_volume(`VV_SET_LUT ${table}`, volume);
export const parameter_command = (table, values, volume) =>
  with_volume(`VV_SET_LUT_PAR ${table} ${values.map((value) => script_number(value, 3)).join(" ")}`, volume);
export const position_command = (plane, {elevation, azimuth, distance}, volume) =>
  with_volume(`VV_CLIP_POS ${plane} ELE ${script_number(elevation, 1)} AZI ${script_number(azimuth, 1)} DIST ${script_number(distance, 1)}`, volume);

export const surface_command = (on, value, volume) => with_volume(`VV_ISO ${on ? "on" : "off"} VALUE ${script_number(value, 1)}`, volume);

// What makes of a plane that is `now` one that hides `side` and whose outline is drawn or not. `off` ends both.
export function plane_commands(plane, now, {side, framed}, volume) {
  const words = [];
  const ends = (now.framed && !framed) || (now.side !== "off" && side === "off");
  if (ends) words.push("off");
  if (side !== "off" && (ends || side !== now.side)) words.push(side);
  if (framed && (ends || !now.framed)) words.push("visible");
  return words.map((word) => with_volume(`VV_CLIP ${plane} ${word}`, volume));
}

// A path around the bars, as high as the logarithm of the counts: air is most of a scan.
export function histogram_path(counts, width = kWidth, height = kHeight) {
  const top = Math.log1p(Math.max(1, ...counts));
  const step = width / counts.length;
  const bars = counts.map((n, i) => {
    const y = script_number(height * (1 - Math.log1p(n) / top), 2);
    return `L${script_number(i * step, 2)} ${y}L${script_number((i + 1) * step, 2)} ${y}`;
  });
  return `M0 ${height}${bars.join("")}L${width} ${height}Z`;
}

export function volume_text(volume, content) {
  const words = [];
  if (content) words.push(`${content.voxels.map(count).join(" × ")} voxels`);
  if (!volume.shown) words.push("hidden");
  if (volume.isosurface) words.push(`isosurface at ${number(volume.iso_value, 0)}${content?.unit ? ` ${content.unit}` : ""}`);
  return words.join(", ");
}

// One command at a time: while its answer is awaited only the newest of the next is kept.
export class Newest {
  constructor(send) {
    this.send_ = send;
    this.busy_ = false;
    this.next_ = null;
  }

  async want(command) {
    this.next_ = command;
    if (this.busy_) return;
    this.busy_ = true;
    try {
      while (this.next_ !== null) {
        const now = this.next_;
        this.next_ = null;
        await this.send_(now);
      }
    } finally {
      this.busy_ = false;
    }
  }
}

// When a person has changed something last.
class Touch {
  constructor() {
    this.time_ = -Infinity;
  }

  note() {
    this.time_ = performance.now();
  }

  get holds() {
    return performance.now() - this.time_ < kHeld_ms;
  }
}

// A slider with its value beside it. `set` by news, unless a person moves it.
class Slider {
  constructor({label, low, high, step, digits, unit = "", changed}) {
    this.digits_ = digits;
    this.unit_ = unit;
    this.touch_ = new Touch();
    this.input = element("input", {type: "range", min: low, max: high, step, "aria-label": label});
    this.output_ = element("output");
    this.input.addEventListener("input", () => {
      this.touch_.note();
      this.write_();
      changed();
    });
  }

  get value() {
    return Number(this.input.value);
  }

  set(value) {
    if (this.touch_.holds) return;
    const text = script_number(value, this.digits_ + 2);
    if (this.input.value !== text) this.input.value = text;
    this.write_();
  }

  bound(low, high) {
    setAttribute(this.input, "min", low);
    setAttribute(this.input, "max", high);
  }

  write_() {
    const text = `${number(this.value, this.digits_)}${this.unit_}`;
    setText(this.output_, text);
    setAttribute(this.input, "aria-valuetext", text);
  }

  row(name) {
    return element("label", {class: "volume-slider"}, element("span", {class: "name"}, name), this.input, this.output_);
  }
}

export class Volume {
  // `left`: called when the panel is no longer there.
  constructor({command, left}) {
    this.command_ = command;
    this.left_ = left;
    this.there_ = false;
    this.contents_ = new Map();
    this.choice_ = byId("volume-choice");
    this.choice_.addEventListener("change", () => this.now_ && this.show_(this.now_));
    this.table_ = byId("volume-table");
    this.table_.append(...Object.entries(kTables).map(([table, meaning]) => element("option", {value: table}, `${table}, ${meaning}`)));
    this.table_.addEventListener("change", () => command(table_command(this.table_.value, this.named_())));
    byId("volume-reload").addEventListener("click", () => command(with_volume("VV_RELOAD_LUTS", this.named_())));
    this.parameters_ = new Newest(command);
    this.surface_on_ = byId("volume-surface");
    this.surface_ = new Newest(command);
    const sends_surface = () => this.surface_.want(surface_command(this.surface_on_.checked, this.surface_value_.value, this.named_()));
    this.surface_value_ = new Slider({label: "value of the surface", low: -1024, high: 3071, step: 1, digits: 0, changed: sends_surface});
    this.surface_touch_ = new Touch();
    this.surface_on_.addEventListener("change", () => {
      this.surface_touch_.note();
      sends_surface();
    });
    byId("volume-surface-part").append(this.surface_value_.row("value"));
    this.sliders_ = [];
    this.planes_ = new KeyedRows(byId("volume-planes"), (plane) => this.plane_row_(plane), (row, plane) => this.show_plane_(row, plane));
  }

  // What does not change while a volume is loaded, from the tree.
  know(contents) {
    this.contents_ = new Map((contents ?? []).map((content) => [content.name, content]));
    this.drawn_ = null;
    if (this.now_) this.show_(this.now_);
  }

  update(live, visible) {
    this.now_ = live.volumes ?? null;
    const there = this.now_ !== null;
    if (there !== this.there_) {
      this.there_ = there;
      byId("tab-volume").hidden = !there;
      if (!there) this.left_();
    }
    if (there && visible) this.show_(this.now_);
  }

  // Empty: a command is for all volumes.
  named_() {
    return this.choice_.value;
  }

  shown_volume_(volumes) {
    return volumes.find(({name}) => name === this.choice_.value) ?? volumes[0];
  }

  show_(volumes) {
    this.offer_(volumes);
    const volume = this.shown_volume_(volumes);
    const content = this.contents_.get(volume.name);
    setText(byId("volume-facts"), volume_text(volume, content));
    if (this.drawn_ !== volume.name) this.draw_histogram_(volume.name, content?.histogram, content?.unit ?? "");
    if (document.activeElement !== this.table_) this.table_.value = volume.table;
    this.show_parameters_(volume);
    if (content?.histogram) this.surface_value_.bound(Math.floor(content.histogram.low), Math.ceil(content.histogram.high));
    if (!this.surface_touch_.holds && this.surface_on_.checked !== volume.isosurface) this.surface_on_.checked = volume.isosurface;
    this.surface_value_.set(volume.iso_value);
    const [x, y, z] = content?.half_extent_m ?? [0.5, 0.5, 0.5];
    this.reach_mm_ = Math.ceil(1000 * Math.hypot(x, y, z));
    this.planes_.show(volume.planes, ({plane}) => plane);
  }

  offer_(volumes) {
    const names = volumes.map(({name}) => name);
    const key = names.join("\n");
    if (key === this.offered_) return;
    this.offered_ = key;
    const chosen = this.choice_.value;
    this.choice_.replaceChildren(element("option", {value: ""}, "all volumes"), ...names.map((name) => element("option", {value: name}, name)));
    this.choice_.value = names.includes(chosen) ? chosen : "";
    byId("volume-choice-part").hidden = names.length < 2;
  }

  draw_histogram_(name, histogram, unit) {
    const there = histogram !== null && histogram !== undefined;
    byId("volume-histogram-part").hidden = !there;
    if (!there) return;
    this.drawn_ = name;
    byId("volume-histogram-path").setAttribute("d", histogram_path(histogram.counts));
    const text = (value) => `${number(value, 0)}${unit ? ` ${unit}` : ""}`;
    setText(byId("volume-low"), text(histogram.low));
    setText(byId("volume-high"), text(histogram.high));
  }

  show_parameters_(volume) {
    if (this.parameter_table_ !== volume.table) {
      this.parameter_table_ = volume.table;
      this.sliders_ = parameters_of(volume.table).map(({name, low, high}) =>
        ({name, slider: new Slider({label: `${name} of ${volume.table}`, low, high, step: 0.01, digits: 2, changed: () => this.send_parameters_()})}));
      byId("volume-parameters").replaceChildren(...this.sliders_.map(({name, slider}) => slider.row(name)));
    }
    const values = volume.parameters[volume.table];
    this.sliders_.forEach(({slider}, i) => slider.set(values[i]));
  }

  send_parameters_() {
    this.parameters_.want(parameter_command(this.parameter_table_, this.sliders_.map(({slider}) => slider.value), this.named_()));
  }

  plane_row_({plane}) {
    const row = {now: null, sent: new Newest(this.command_), touch: new Touch()};
    const sends_position = () => row.sent.want(position_command(plane,
      {elevation: row.elevation.value, azimuth: row.azimuth.value, distance: row.distance.value}, this.named_()));
    const angle = (name) => new Slider({label: `${name} of ${plane}`, low: -90, high: 90, step: 1, digits: 0, unit: "°", changed: sends_position});
    row.elevation = angle("elevation");
    row.azimuth = angle("azimuth");
    row.distance = new Slider({label: `distance of ${plane}`, low: -100, high: 100, step: 1, digits: 0, unit: " mm", changed: sends_position});
    row.side = element("select", {"aria-label": `what ${plane} hides`},
      ...[["off", "off"], ["active", "hides beyond"], ["reverse", "hides before"]].map(([value, text]) => element("option", {value}, text)));
    row.framed = element("input", {type: "checkbox"});
    const sends_mode = async () => {
      row.touch.note();
      const wanted = {side: row.side.value, framed: row.framed.checked};
      for (const command of plane_commands(plane, row.now, wanted, this.named_())) await this.command_(command);
    };
    for (const control of [row.side, row.framed]) control.addEventListener("change", sends_mode);
    row.node = element("li", {class: "volume-plane", "data-plane": plane},
      element("span", {class: "name"}, plane), row.side, element("label", {}, row.framed, " outline"),
      element("div", {class: "volume-position"}, row.elevation.row("ELE"), row.azimuth.row("AZI"), row.distance.row("DIST")));
    return row;
  }

  show_plane_(row, plane) {
    row.now = {side: plane.side, framed: plane.framed};
    if (!row.touch.holds) {
      if (row.side.value !== plane.side) row.side.value = plane.side;
      if (row.framed.checked !== plane.framed) row.framed.checked = plane.framed;
    }
    row.distance.bound(-this.reach_mm_, this.reach_mm_);
    row.elevation.set(plane.elevation_rad * kDegrees);
    row.azimuth.set(plane.azimuth_rad * kDegrees);
    row.distance.set(plane.distance_m * 1000);
    row.node.classList.toggle("idle", plane.side === "off" && !plane.framed);
  }
}
