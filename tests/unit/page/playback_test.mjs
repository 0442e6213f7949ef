import assert from "node:assert/strict";
import {test} from "node:test";
import {speed_text, utc_time} from "./modules/playback.js";

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
