// One chart of values over time, by uPlot (vendor/). Colours come from the style sheet, so that light and dark fit.
import {element, setText} from "./dom.js";
import {number} from "./format.js";

// Okabe and Ito's palette, suited to colour-blind people; more series repeat it with dashes.
// Orange, light blue and purple are darker than theirs: every curve stands out from white and from dark by 3 to 1.
export const kColours = ["#0072b2", "#b87f00", "#009e73", "#d55e00", "#3a93c9", "#bd6496", "#8a8f00", "#7f7f7f"];

export function colour(i) {
  return kColours[i % kColours.length];
}

function style_colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim() || "#888";
}

// Colours given by light-dark() are known only as those of an element.
function resolved(name) {
  const probe = element("span", {hidden: true});
  probe.style.color = style_colour(name);
  document.body.append(probe);
  const found = getComputedStyle(probe).color;
  probe.remove();
  return found;
}

export class StripChart {
  constructor(parent, {title, digits}) {
    this.digits_ = digits;
    this.title_ = element("span", {class: "title"}, title);
    this.unit_ = element("span", {class: "unit"});
    this.until_ = element("span", {class: "unit"});
    this.plot_area_ = element("div", {class: "plot", hidden: true});
    this.legend_ = element("div", {class: "legend"});
    this.empty_ = element("p", {class: "empty"}, "nothing to show");
    this.node = element("figure", {class: "chart", role: "img", "aria-label": title},
      element("figcaption", {}, this.title_, this.unit_, this.until_), this.plot_area_, this.empty_, this.legend_);
    parent.append(this.node);
    this.name_ = title;
    this.labels_ = null;
    this.plot_ = null;
    new ResizeObserver(() => this.resize_()).observe(this.plot_area_);
  }

  // labels, titles, units: one for each value column of `columns`; times in s. A second unit has the scale on the right.
  // The axis ends `until`, and begins `span` before; `end`: "now", or the time of day.
  show({labels, titles, units}, columns, {span, until, end}) {
    const key = `${labels.join("\n")}\n${titles.join("\n")}\n${units.join("\n")}`;
    const renamed = this.end_ !== end;
    this.end_ = end;
    setText(this.until_, end === "now" ? "" : `until ${end}`);
    const kinds = [...new Set(units)];
    setText(this.unit_, kinds.length > 1 ? `${kinds[0]}; right: ${kinds[1]}` : kinds[0] ?? "");
    this.empty_.hidden = labels.length > 0;
    this.plot_area_.hidden = labels.length === 0;
    this.legend_.hidden = labels.length === 0;
    if (labels.length === 0) return;
    if (key !== this.labels_) {
      this.labels_ = key;
      this.make_({labels, titles}, units.map((unit) => (unit === kinds[0] ? "left" : "right")), columns);
    }
    this.plot_.batch(() => {
      this.plot_.setData(columns, false);
      this.plot_.setScale("x", {min: until - span, max: until});
    });
    if (renamed) this.plot_.redraw(false, true);  // the same times would keep their names
    this.show_values_(columns);
  }

  restyle() {
    this.labels_ = null;
  }

  make_({labels, titles}, sides, columns) {
    this.plot_?.destroy();
    const text = resolved("--text-soft");
    const grid = {stroke: resolved("--line-soft"), width: 1};
    const values = (_plot, splits) => splits.map((value) => number(value, decimals(splits)));
    const axis = {stroke: text, grid, ticks: {show: false}, font: "11px system-ui, sans-serif", labelSize: 0};
    const relative = (plot, splits) => splits.map((time) => {
      const back = Math.round(plot.scales.x.max - time);
      return back === 0 ? (this.end_ === "now" ? "now" : "0 s") : `\u2212${back} s`;
    });
    this.plot_ = new window.uPlot({
      width: Math.max(120, this.plot_area_.clientWidth),
      height: this.plot_area_.clientHeight || 100,
      legend: {show: false},
      cursor: {show: false},
      scales: {x: {time: false}, left: {range: padded}, right: {range: padded}},
      padding: [6, sides.includes("right") ? 0 : 14, 0, 0],
      axes: [
        {...axis, size: 20, gap: 2, splits: (plot) => even_splits(plot.scales.x.min, plot.scales.x.max), values: relative},
        {...axis, values, scale: "left", size: 44, gap: 3, space: 24},
        ...(sides.includes("right") ? [{...axis, values, scale: "right", side: 1, size: 44, gap: 3, space: 24, grid: {show: false}}] : []),
      ],
      series: [{}, ...labels.map((label, i) => ({
        label, scale: sides[i], stroke: colour(i), width: 1.5, points: {show: false}, dash: i < kColours.length ? undefined : [5, 3]}))],
    }, columns, this.plot_area_);
    this.values_ = labels.map(() => element("output", {}));
    this.legend_.replaceChildren(...labels.map((label, i) => {
      const swatch = element("i", {class: i < kColours.length ? "swatch" : "swatch dashed"});
      swatch.style.color = colour(i);
      return element("span", {class: "entry", title: titles[i]}, swatch, element("span", {class: "label"}, label), this.values_[i]);
    }));
  }

  show_values_(columns) {
    const texts = this.values_.map((node, i) => {
      const column = columns[i + 1];
      const text = number(column.length ? column[column.length - 1] : null, this.digits_);
      setText(node, text);
      return text;
    });
    const now = Date.now();
    if (this.end_ === this.announced_end_ && now - (this.announced_ ?? 0) < 5000) return;  // for those who listen, not ten times a second
    this.announced_ = now;
    this.announced_end_ = this.end_;
    const until = this.end_ === "now" ? "" : `, until ${this.end_}`;
    this.node.setAttribute("aria-label", `${this.name_}${until}: ${texts.slice(0, 8).join(", ")}`);
  }

  resize_() {
    if (this.plot_ && this.plot_area_.clientWidth > 0) {
      this.plot_.setSize({width: this.plot_area_.clientWidth, height: this.plot_area_.clientHeight});
    }
  }
}

// Decimal places that distinguish neighbouring labels of the axis.
function decimals(splits) {
  const step = splits.length > 1 ? Math.abs(splits[1] - splits[0]) : 1;
  return Math.max(0, Math.min(6, Math.ceil(-Math.log10(step) - 1e-9)));
}

// Four even parts ending now: lines that stand still while the curves pass.
function even_splits(from, to) {
  return [0, 0.25, 0.5, 0.75, 1].map((part) => from + part * (to - from));
}

// A little room above and below; a value that stands still gets a scale of its own size.
function padded(_plot, low, high) {
  if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
  const room = Math.max((high - low) * 0.08, Math.abs(high) * 0.002, 0.05);
  return [low - room, high + room];
}
