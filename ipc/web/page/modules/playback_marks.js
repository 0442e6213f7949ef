// Where collisions and faults began in the recording that is played: marks above the time's slider, and a list that goes there.
import {byId, element, setAttribute} from "./dom.js";
import {utc_time} from "./playback_time.js";

const kAskAgain_ms = 2000;
const kTogether = 0.004;  // of the length: marks that are nearer are drawn as one

// "09:41:07.250 collision: ROBOT_1.hand, table"
export function mark_text(mark, like) {
  return `${utc_time(mark.time, like)} ${mark.kind}: ${mark.text}`;
}

// Places of what is drawn, 0 to 1 of the length; a fault hides a collision that is too near beside it.
export function mark_places(marks, length_s) {
  const places = [];
  for (const {position_s, kind} of marks) {
    const at = length_s > 0 ? Math.min(1, Math.max(0, position_s / length_s)) : 0;
    const last = places.at(-1);
    if (last && at - last.at < kTogether) {
      if (kind === "fault") last.kind = kind;
    } else {
      places.push({at, kind});
    }
  }
  return places;
}

export class PlaybackMarks {
  // `seek`: to so many seconds after the beginning.
  constructor(seek, fetched) {
    this.fetched_ = fetched;
    this.known_ = null;
    this.marks_ = [];
    byId("replay-events").addEventListener("change", (event) => {
      const mark = this.marks_[Number(event.target.value)];
      if (event.target.value !== "" && mark) seek(mark.position_s);
      event.target.value = "";
    });
  }

  // They do not change while a recording is played: asked for once.
  update(replay) {
    const key = `${replay.file} ${replay.from} ${replay.mark_count ?? 0}`;
    if (key === this.known_) return;
    this.known_ = key;
    if (replay.mark_count > 0) this.learn_(key);
    else this.show_([], replay);
  }

  async learn_(key) {
    try {
      const {replay} = await this.fetched_("api/status");
      this.show_(replay.marks ?? [], replay);
    } catch {
      setTimeout(() => this.known_ === key && (this.known_ = null), kAskAgain_ms);
    }
  }

  show_(marks, replay) {
    this.marks_ = marks;
    byId("replay-marks").replaceChildren(...mark_places(marks, replay.length_s).map(({at, kind}) => {
      const drawn = element("i", {"data-kind": kind});
      drawn.style.left = `${100 * at}%`;
      return drawn;
    }));
    const list = byId("replay-events");
    const label = byId("replay-events-label");
    const count = `${marks.length} event${marks.length === 1 ? "" : "s"}`;
    list.replaceChildren(element("option", {value: ""}, count),
                         ...marks.map((mark, i) => element("option", {value: String(i)}, mark_text(mark, replay.from))));
    setAttribute(label, "hidden", marks.length === 0);
  }
}
