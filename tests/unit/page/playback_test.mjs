import assert from "node:assert/strict";
import {test} from "node:test";
import {speed_text} from "./modules/playback.js";
import {mark_places, mark_text} from "./modules/playback_marks.js";
import {utc_time} from "./modules/playback_time.js";

test("a time is told without the day that everybody knows", () => {
  assert.equal(utc_time("2026-11-24T10:00:00.123Z"), "2026-11-24 10:00:00.123");
  assert.equal(utc_time("2026-11-24T10:00:07.000Z", "2026-11-24T10:00:00.123Z"), "10:00:07.000");
  assert.equal(utc_time("2026-11-25T00:00:07.000Z", "2026-11-24T23:59:00.123Z"), "2026-11-25 00:00:07.000");
});

test("a speed is told without zeros that say nothing", () => {
  assert.equal(speed_text(1), "1×");
  assert.equal(speed_text(0.25), "0.25×");
  assert.equal(speed_text(12), "12×");
});

test("an event is told with its time and what it is", () => {
  const mark = {position_s: 7.25, time: "2026-11-24T09:41:07.250Z", kind: "collision", text: "ROBOT_1.hand, table"};
  assert.equal(mark_text(mark, "2026-11-24T09:41:00.000Z"), "09:41:07.250 collision: ROBOT_1.hand, table");
});

test("marks are where their times are on the slider, and those that are too near are one", () => {
  const at = (position_s, kind = "collision") => ({position_s, kind});
  assert.deepEqual(mark_places([at(0), at(5), at(10)], 10), [
    {at: 0, kind: "collision"}, {at: 0.5, kind: "collision"}, {at: 1, kind: "collision"}]);
  assert.deepEqual(mark_places([at(5), at(5.01, "fault"), at(5.02)], 10), [{at: 0.5, kind: "fault"}]);
  assert.deepEqual(mark_places([at(-3), at(30)], 10), [{at: 0, kind: "collision"}, {at: 1, kind: "collision"}]);
  assert.deepEqual(mark_places([at(1)], 0), [{at: 0, kind: "collision"}]);
});
