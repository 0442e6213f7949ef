// One chart of values over time, by dygraphs (lib/). Colours come from the style sheet, so that light and dark fit.
import {element, setText} from "./dom.js";
import {clock_time, number} from "./format.js";

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
  // `zoomed([from, to])`: a part was chosen with the mouse, s; null: all again.
  constructor(parent, {title, digits, zoomed}) {
    this.digits_ = digits;
    this.zoomed_ = zoomed;
    this.title_ = element("span", {class: "title"}, title);
    this.unit_ = element("span", {class: "unit"});
    this.until_ = element("span", {class: "unit"});
    this.plot_area = element("div", {class: "plot", role: "img", "aria-label": title, hidden: true});
    this.legend_ = element("div", {class: "legend"});
    this.empty_ = element("p", {class: "empty"}, "nothing to show");
    this.node = element("figure", {class: "chart"},
      element("figcaption", {}, this.title_, this.unit_, this.until_), this.plot_area, this.empty_, this.legend_);
    parent.append(this.node);
    this.name = title;
    this.labels_ = null;
    this.plot_ = null;
    this.cursor_px_ = null;
    this.shown = {title, labels: [], units: [], columns: [[]]};
    new ResizeObserver(() => this.resize_()).observe(this.plot_area);
  }

  // labels, titles, units: one for each value column of `columns`; times in s. A second unit has the scale on the right.
  // The axis ends `until`, and begins `span` before; `end`: "now", or the time of day.
  show({labels, titles, units}, columns, {span, until, end}) {
    const key = `${labels.join("\n")}\n${titles.join("\n")}\n${units.join("\n")}`;
    this.end_ = end;
    this.shown = {title: this.name, labels, units, columns};
    const kinds = [...new Set(units)];
    setText(this.unit_, kinds.length > 1 ? `${kinds[0]}; right: ${kinds[1]}` : kinds[0] ?? "");
    this.empty_.hidden = labels.length > 0;
    this.plot_area.hidden = labels.length === 0;
    this.legend_.hidden = labels.length === 0;
    if (labels.length === 0 || this.plot_area.clientWidth === 0) return;
    const rows = rows_of(columns);
    const window_s = [until - span, until];
    if (key !== this.labels_) {
      this.labels_ = key;
      this.make_({labels, titles}, units.map((unit) => (unit === kinds[0] ? "y" : "y2")), rows, window_s);
    } else if (!this.dragging_()) {
      this.plot_.updateOptions({file: rows, dateWindow: window_s});
    }
    this.show_values_();
  }

  restyle() {
    this.labels_ = null;
  }

  // A redraw would end the drag.
  dragging_() {
    return this.pressed_ === true;
  }

  make_({labels, titles}, sides, rows, window_s) {
    this.plot_?.destroy();
    const Dygraph = library();
    const ids = labels.map((_, i) => `s${i}`);
    const with_two = sides.includes("y2");
    const axis = {axisLineColor: "transparent", gridLineColor: resolved("--line-soft"), gridLineWidth: 1, axisLabelFontSize: 11};
    const values = (value, _granularity, _options, plot) => number(value, decimals(plot.yAxisRange()));
    const press = Dygraph.defaultInteractionModel.mousedown;
    this.plot_ = new Dygraph(this.plot_area, rows, {
      labels: ["time", ...ids],
      colors: labels.map((_, i) => colour(i)),
      series: Object.fromEntries(ids.map((id, i) => [id, {axis: sides[i], strokePattern: i < kColours.length ? null : [5, 3]}])),
      axes: {
        x: {...axis, axisLabelWidth: 56, ticker: (from, to, pixels) => even_splits(from, to, pixels).map((v) => ({v, label: this.time_name_(v, from, to)}))},
        y: {...axis, axisLabelWidth: 42, pixelsPerLabel: 24, axisLabelFormatter: values},
        y2: {...axis, axisLabelWidth: 56, pixelsPerLabel: 24, independentTicks: true, drawGrid: false,
          axisLabelFormatter: (value, _granularity, _options, plot) => number(value, decimals(plot.yAxisRange(1)))},
      },
      dateWindow: window_s,
      legend: "never",
      strokeWidth: 1.5,
      yRangePad: 6,
      rightGap: with_two ? 0 : 14,
      highlightCircleSize: 0,
      interactionModel: {
        mousedown: (event, plot, context) => {
          this.pressed_ = true;
          window.addEventListener("mouseup", () => { this.pressed_ = false; }, {once: true});
          press(event, plot, context);
        },
        willDestroyContextMyself: true,
        dblclick: () => this.zoomed_(null),
      },
      zoomCallback: (from, to) => this.zoomed_([from, to]),
      highlightCallback: (event) => {
        this.cursor_px_ = event.clientX - this.plot_area.getBoundingClientRect().left;
        this.show_values_();
      },
      unhighlightCallback: () => {
        this.cursor_px_ = null;
        this.show_values_();
      },
    });
    this.values_ = labels.map(() => element("output", {}));
    this.legend_.replaceChildren(...labels.map((label, i) => {
      const swatch = element("i", {class: i < kColours.length ? "swatch" : "swatch dashed"});
      swatch.style.color = colour(i);
      return element("span", {class: "entry", title: titles[i]}, swatch, element("span", {class: "label"}, label), this.values_[i]);
    }));
  }

  time_name_(time, from, to) {
    if (this.end_ !== "now" && this.end_ !== undefined) return clock_time(new Date(time * 1000));
    const back = Math.round(to - time);
    return back === 0 ? "now" : `\u2212${back} s`;
  }

  // Those under the cursor, else the newest.
  show_values_() {
    const {columns} = this.shown;
    const times = columns[0];
    let row = times.length - 1;
    let of = this.end_ === "now" ? "" : `until ${this.end_}`;
    if (this.cursor_px_ !== null && times.length > 0) {
      const time = this.plot_.toDataXCoord(this.cursor_px_);
      row = nearest(times, time);
      of = `at ${clock_time(new Date(times[row] * 1000))}`;
    }
    setText(this.until_, of);
    const texts = this.values_.map((node, i) => {
      const text = number(columns[i + 1]?.[row] ?? null, this.digits_);
      setText(node, text);
      return text;
    });
    const now = Date.now();
    if (of === this.announced_of_ && now - (this.announced_ ?? 0) < 5000) return;  // for those who listen, not ten times a second
    this.announced_ = now;
    this.announced_of_ = of;
    this.plot_area.setAttribute("aria-label", `${this.name}${of ? `, ${of}` : ""}: ${texts.slice(0, 8).join(", ")}`);
  }

  // For a picture of the chart.
  get caption() {
    return [this.name, this.unit_.textContent, this.until_.textContent].filter(Boolean).join("   ");
  }

  get entries() {
    return this.shown.labels.map((label, i) => ({text: `${label} ${this.values_[i].textContent}`, colour: colour(i)}));
  }

  resize_() {
    if (this.plot_ && this.plot_area.clientWidth > 0) this.plot_.resize();
  }
}

// Without its legend: ours stands in the page, and theirs writes styles into the document, which the page's policy refuses.
function library() {
  const {Dygraph} = window;
  Dygraph.PLUGINS = Dygraph.PLUGINS.filter((plugin) => plugin !== Dygraph.Plugins.Legend);
  return Dygraph;
}

// Rows as dygraphs takes them, from columns.
function rows_of(columns) {
  return columns[0].map((time, row) => columns.map((column, i) => (i === 0 ? time : column[row])));
}

// The place of the time in `times`, which grow.
export function nearest(times, time) {
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < time) low = middle + 1;
    else high = middle;
  }
  return low > 0 && time - times[low - 1] < times[low] - time ? low - 1 : low;
}

// Decimal places for labels of an axis with this range.
function decimals([low, high]) {
  const step = Math.max((high - low) / 4, 1e-9);
  return Math.max(0, Math.min(6, Math.ceil(-Math.log10(step) - 1e-9)));
}

// Even parts ending now: lines that stand still while the curves pass. The last one lies within, or it would be dropped.
function even_splits(from, to, pixels) {
  const parts = pixels < 180 ? [0, 0.5, 0.9999] : [0, 0.25, 0.5, 0.75, 0.9999];
  return parts.map((part) => from + part * (to - from));
}
