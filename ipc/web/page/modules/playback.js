// The bar below the page where the gateway plays a recording: play, pause, speed, and the time as a slider.
import {byId, setText, setAttribute} from "./dom.js";
import {duration, number} from "./format.js";
import {PlaybackMarks} from "./playback_marks.js";
import {utc_time} from "./playback_time.js";

const kSendEvery_ms = 100;  // while the slider is dragged
const kSettled_ms = 700;    // after that the slider shows what the gateway says again

export function speed_text(speed) {
  return `${Number(number(speed, 2).replace("\u2212", "-"))}×`;
}

export class Playback {
  constructor(connection, fetched, {now = () => performance.now()} = {}) {
    this.connection_ = connection;
    this.marks_ = new PlaybackMarks((seek_s) => this.send_({seek_s}), fetched);
    this.now_ = now;
    this.touched_ = -Infinity;
    this.sent_ = -Infinity;
    this.playing_ = false;
    byId("replay-play").addEventListener("click", () => this.send_({play: !this.playing_}));
    byId("replay-speed").addEventListener("change", (event) => this.send_({speed: Number(event.target.value)}));
    const slider = byId("replay-slider");
    slider.addEventListener("input", () => this.drag_(Number(slider.value), false));
    slider.addEventListener("change", () => this.drag_(Number(slider.value), true));
  }

  send_(what) {
    this.connection_.send({do: "playback", ...what});
  }

  drag_(seconds, last) {
    this.touched_ = this.now_();
    if (!last && this.now_() - this.sent_ < kSendEvery_ms) return;
    this.sent_ = this.now_();
    this.send_({seek_s: seconds});
  }

  update(live) {
    const replay = live.replay;
    byId("replay-bar").hidden = !replay;
    if (!replay) return;
    this.playing_ = replay.state === "playing";
    setText(byId("replay-play"), this.playing_ ? "Pause" : replay.state === "ended" ? "Play again" : "Play");
    setText(byId("replay-from"), utc_time(replay.from));
    setText(byId("replay-to"), utc_time(replay.to, replay.from));
    setText(byId("replay-now"), `${utc_time(replay.now, replay.from)} UTC, ${replay.state}`);
    setText(byId("replay-note"), replay.note);
    const slider = byId("replay-slider");
    setAttribute(slider, "max", replay.length_s);
    setAttribute(slider, "aria-valuetext", `${utc_time(replay.now, replay.from)} UTC, ${duration(replay.position_s)} after the beginning`);
    if (this.now_() - this.touched_ > kSettled_ms) slider.value = String(replay.position_s);
    this.show_speed_(replay.speed);
    this.marks_.update(replay);
  }

  // The speed may be one that the list does not have: another client or the command line has set it.
  show_speed_(speed) {
    const list = byId("replay-speed");
    if (Number(list.value) === speed) return;
    const known = [...list.options].find((option) => Number(option.value) === speed);
    if (!known) {
      const added = document.createElement("option");
      added.value = String(speed);
      added.textContent = speed_text(speed);
      list.append(added);
    }
    list.value = known ? known.value : String(speed);
  }
}
