// The picture of the cell: asks for pictures as large as there is room, draws them, says how old they are. What is
// shown is a choice: {kind: "display"}, {kind: "view", id}, {kind: "camera", name} or {kind: "free", view}.
import {byId, setText, setAttribute} from "./dom.js";
import {age} from "./format.js";
import {watch_gestures} from "./gestures.js";
import {decode_picture} from "./picture_format.js";
import * as math from "./view_math.js";

const kStale_s = 2;
const kMostPixels = 1280 * 960;
const kMostEdges = [1920, 1200];  // of the gateway
const kRate_hz = 15;
const kRateBeside_hz = 5;
const kPartBeside = 0.4;  // of the edges of the area, as the style sheet has it
const kWishEvery_ms = 40;
const kAskAgain_ms = 5000;

// As large as the area in true pixels, no larger than is worth drawing, both even.
export function picture_size(width, height, density, most_pixels = kMostPixels) {
  const wanted = [Math.max(64, width * density), Math.max(64, height * density)];
  const scale = Math.min(1, Math.sqrt(most_pixels / (wanted[0] * wanted[1])), ...wanted.map((edge, i) => kMostEdges[i] / edge));
  return wanted.map((edge) => Math.max(64, 2 * Math.floor((edge * scale) / 2)));
}

// How old the posture is that is seen now, `since_s` after the picture came.
export function stamp_of(shown, since_s) {
  return `picture ${age(shown.age_s + since_s)}`;
}

// Whether the text that is drawn into pictures can be read there: it has a size in the picture's pixels.
export function text_is_readable(picture_width, area_width) {
  return picture_width <= 1.25 * area_width;
}

// Pictures are decoded in no particular order. begin(): a connection counts from the beginning; is_newer(): the one to be
// drawn, as of the same begin().
export class PictureOrder {
  constructor() {
    this.connection = 0;
    this.begin();
  }

  begin() {
    ++this.connection;
    this.drawn_ = 0;
  }

  is_newer(sequence) {
    if (sequence <= this.drawn_) return false;
    this.drawn_ = sequence;
    return true;
  }
}

export function request_of(choice, [width, height], rate_hz = kRate_hz) {
  const request = {do: "picture", width, height, rate_hz, quality: 80};
  if (choice.kind === "view") request.view = choice.id;
  if (choice.kind === "camera") request.camera = choice.name;
  if (choice.kind === "free") request.free = choice.view;
  return request;
}

// Of the gateway's display.
function main_view(display) {
  return display?.displays?.find(({id}) => id === display.display)?.views?.[0] ?? 0;
}

// Where a free view begins when the hand first moves what is shown.
export function start_of_free_view(choice, display) {
  const views = display?.views ?? [];
  if (choice.kind === "free") return choice.view;
  let found = null;
  if (choice.kind === "display") found = views.find((view) => view.id === main_view(display));
  if (choice.kind === "view") found = views.find((view) => view.id === choice.id);
  if (choice.kind === "camera") found = views.find((view) => view.camera === choice.name);
  return math.sound_view(found ?? views.find((view) => view.id === 0) ?? views[0]);
}

export class LiveView {
  // `changed(choice, moved)` is called when a hand made the view free, moved a free one (`moved`), or went back.
  constructor(connection, {changed, picked}) {
    this.connection_ = connection;
    this.changed_ = changed;
    this.picked_ = picked;
    this.area_ = byId("view-area");
    this.canvas_ = byId("view-canvas");
    this.pen_ = this.canvas_.getContext("2d", {alpha: false});
    this.choice_ = {kind: "display"};
    this.before_ = this.choice_;
    this.display_ = null;
    this.draws_ = true;
    this.beside_ = false;  // a small picture beside what another part draws
    this.shown_ = null;   // {sequence, age_s, at}
    this.order_ = new PictureOrder();
    this.asked_at_ = 0;
    this.sent_ = "";
    this.size_ = [640, 480];
    watch_gestures(this.canvas_, this.hand());
    new ResizeObserver(() => this.resized_()).observe(this.area_);
    document.addEventListener("visibilitychange", () => this.ask_());
    connection.on("opened", () => {
      this.order_.begin();
      this.ask_(true);
    });
    connection.on("picture", (data) => this.draw_(data));
    connection.on("refused", (message) => !/token/.test(message.text) && this.refused_(message));
    connection.on("closed", () => {
      this.sent_ = "";
      this.show_age();
    });
    setInterval(() => {
      this.show_age();
      // Where there were too many pictures there may be room now.
      if (this.problem_ && performance.now() - this.asked_at_ > kAskAgain_ms) this.ask_(true);
    }, 250);
  }

  get choice() {
    return this.choice_;
  }

  choose(choice) {
    if (choice.kind !== "free") this.before_ = choice;
    this.choice_ = choice;
    this.problem_ = null;
    this.ask_();
    this.changed_(choice);
  }

  update(live) {
    this.display_ = live.display ?? null;
  }

  // `start(choice, otherwise)` may know better where a view is now: as a camera that moves.
  follow(start) {
    this.start_ = start;
  }

  current_view() {
    const otherwise = start_of_free_view(this.choice_, this.display_);
    return this.start_ ? this.start_(this.choice_, otherwise) : otherwise;
  }

  // "whole"; "none": another part draws, and tells by shown_now() and report(); "beside": so too, with a small picture of the
  // same viewpoint beside it.
  show_pictures(how) {
    this.beside_ = how === "beside";
    if (this.draws_ === (how === "whole")) {
      this.ask_();
      return;
    }
    this.draws_ = how === "whole";
    this.shown_ = null;
    this.problem_ = null;
    this.waiting_since_ = performance.now();
    this.ask_();
  }

  shown_now(age_s, sequence) {
    this.shown_ = {sequence, age_s, at: performance.now(), width: 0};
    this.problem_ = null;
  }

  report(problem) {
    this.problem_ = problem;
  }

  move(change) {
    const view = change(this.current_view());
    const was_free = this.choice_.kind === "free";
    this.choice_ = {kind: "free", view};
    this.changed_(this.choice_, was_free);
    this.ask_soon_();
  }

  // What movements by hand do; `pick(x, y)`: in place of asking the gateway.
  hand(pick = (x, y) => this.pick_(x, y)) {
    return {
      orbit: (turn, rise) => this.move((view) => math.orbit(view, turn, rise)),
      pan: (x, y) => this.move((view) => math.pan(view, x, y)),
      zoom: (factor) => this.move((view) => math.zoom(view, factor)),
      home: () => this.choose(this.before_),
      leave: () => this.picked_(null),
      pick,
    };
  }

  async pick_(x, y) {
    if (!this.shown_) return;
    const [px, py] = [x / this.canvas_.clientWidth, y / this.canvas_.clientHeight];
    const answer = await this.connection_.ask({
      do: "pick", x: Math.floor(px * this.canvas_.width), y: Math.floor(py * this.canvas_.height)});
    this.picked_({x, y, path: answer.path ?? null, robot: answer.robot ?? "",
      text: answer.is === "picked" ? "" : answer.text ?? "nothing came back"});
  }

  resized_() {
    const [width, height] = [this.area_.clientWidth, this.area_.clientHeight];
    if (width < 2 || height < 2) return;
    this.width_ = width;
    this.size_ = picture_size(width, height, window.devicePixelRatio || 1);
    this.ask_soon_();
  }

  // Not more often than the gateway draws: only the newest request counts.
  ask_soon_() {
    if (this.timer_) return;
    const wait = Math.max(0, this.asked_at_ + kWishEvery_ms - performance.now());
    this.timer_ = setTimeout(() => {
      this.timer_ = null;
      this.ask_();
    }, wait);
  }

  ask_(again = false) {
    const request = document.hidden || !(this.draws_ || this.beside_) ? {do: "no_picture"} : this.draws_ ? request_of(this.choice_, this.size_) : this.request_beside_();
    const text = JSON.stringify(request);
    if (text === this.sent_ && !again) return;
    if (!this.connection_.send(request)) return;
    if (document.hidden || this.sent_ === "" || again) this.waiting_since_ = performance.now();
    this.sent_ = text;
    this.asked_at_ = performance.now();
  }

  request_beside_() {
    const choice = this.choice_.kind === "display" ? {kind: "view", id: main_view(this.display_)} : this.choice_;
    const size = this.size_.map((edge) => Math.max(64, 2 * Math.floor((kPartBeside * edge) / 2)));
    return request_of(choice, size, kRateBeside_hz);
  }

  async draw_(data) {
    const picture = decode_picture(data);
    if (!picture) return;
    const at = performance.now();
    const connection = this.order_.connection;
    let bitmap = null;
    try {
      bitmap = await createImageBitmap(new Blob([picture.jpeg], {type: "image/jpeg"}));
    } catch {
      this.problem_ = "a picture came that cannot be read";
    }
    if (connection !== this.order_.connection) return;  // the gateway of now never sent it
    if (bitmap && (this.draws_ || this.beside_) && this.order_.is_newer(picture.sequence)) this.show_(picture, bitmap, at);
    bitmap?.close();
    this.connection_.send({do: "shown", sequence: picture.sequence});
  }

  show_(picture, bitmap, at) {
    performance.mark("cellmirror.picture");
    if (this.canvas_.width !== bitmap.width || this.canvas_.height !== bitmap.height) {
      this.canvas_.width = bitmap.width;
      this.canvas_.height = bitmap.height;
    }
    this.pen_.drawImage(bitmap, 0, 0);
    performance.clearMarks("cellmirror.picture");
    if (this.draws_) {
      this.shown_ = {sequence: picture.sequence, age_s: picture.age_s, at, width: bitmap.width};
      this.problem_ = null;
    }
    setAttribute(this.canvas_, "data-sequence", picture.sequence);
  }

  refused_(message) {
    this.problem_ = message.text ?? "the gateway refused";
    this.show_age();
  }

  // Shows every problem as text; a picture without text beside it is current.
  show_age() {
    const note = byId("view-note");
    const now = performance.now();
    const since = this.shown_ ? (now - this.shown_.at) / 1000 : null;
    let text = "";
    if (!this.connection_.open) text = this.shown_ ? `The gateway is gone. What is shown is ${age(since + this.shown_.age_s)} old.` : "No connection to the gateway yet.";
    else if (this.problem_) text = `${this.draws_ ? "No new picture" : "3D"}: ${this.problem_}`;
    else if (!this.shown_) text = now - (this.waiting_since_ ?? now) > 1500 ? `No ${this.draws_ ? "picture" : "3D"} has come yet.` : "";
    else if (since > kStale_s) text = `${this.draws_ ? "This picture" : "What is shown"} is ${age(since + this.shown_.age_s)} old: nothing newer has come.`;
    else if (this.shown_.age_s > kStale_s) text = `The posture shown is ${age(this.shown_.age_s)} old.`;
    setText(note, text);
    note.hidden = text === "";
    this.area_.classList.toggle("stale", text !== "" && this.shown_ !== null);
    const current = this.shown_ !== null && text === "";
    this.area_.classList.toggle("speaks", current && this.draws_ && text_is_readable(this.shown_.width, this.width_ ?? this.shown_.width));
    const stamp = current && this.draws_ ? stamp_of(this.shown_, since) : "";
    setText(byId("view-age"), stamp);
  }
}
