// What the panel of deformable objects says.
import test from "node:test";
import assert from "node:assert/strict";
import {event_text, fluid_text, instrument_text, object_text, step_text, vessel_text} from "./modules/tissue.js";

test("an object says what was done to it, and nothing else", () => {
  const whole = {name: "liver", nodes: 2200, contacts: 1, parts: 1, coagulated_share: 0, frozen: false};
  assert.equal(object_text(whole), "2\u202f200 nodes, 1 contact");
  assert.equal(object_text({...whole, contacts: 0, parts: 2, coagulated_share: 0.0125, frozen: true}),
    "2\u202f200 nodes, 0 contacts, cut into 2 parts, 1.3 % coagulated, frozen");
});

test("an instrument says what it does", () => {
  assert.equal(instrument_text({kind: "gripper", acting: false, held: 0}), "gripper");
  assert.equal(instrument_text({kind: "gripper", acting: true, held: 7}), "gripper, acting, holds 7 points");
});

test("a vessel that bleeds says how much", () => {
  assert.equal(vessel_text({clips: 1, severed: false, bleeding_ml_min: 0}), "1 clip");
  assert.equal(vessel_text({clips: 0, severed: true, bleeding_ml_min: 12.34}), "0 clips, cut, bleeds 12.3 ml/min");
});

test("events say what, who, on what and where", () => {
  const event = {number: 1, kind: "clip", robot: "APPLIER", object: "liver", part: "cystic_artery", limit: "", at_m: [0.125, -0.5, 1]};
  assert.equal(event_text(event), "clip by APPLIER on cystic_artery of liver at (125.0, \u2212500.0, 1000.0) mm");
  assert.equal(event_text({...event, kind: "bleed_end", robot: "", part: ""}), "bleed end on liver at (125.0, \u2212500.0, 1000.0) mm");
  assert.match(event_text({...event, kind: "limit", limit: "STRAIN", part: ""}), /^limit STRAIN by APPLIER on liver at/);
});

test("the simulation says its step, and that it is off", () => {
  const tissue = {calculating: true, rate_hz: 999.8, step_p50_us: 210, step_p99_us: 290, late_steps: 0};
  assert.equal(step_text(tissue), "1000 Hz, a step 210 µs, p99 290 µs");
  assert.equal(step_text({...tissue, late_steps: 3}), "1000 Hz, a step 210 µs, p99 290 µs, 3 steps late");
  assert.match(step_text({...tissue, calculating: false}), /^off/);
});

test("what is not there is not said", () => {
  const nothing = {bleeding_ml_min: 0, blood_loss_ml: 0, pool_level_m: null, smoke: 0, lens_fog: 0, connections_torn: 0, excesses: 0};
  assert.equal(fluid_text(nothing), "");
  assert.equal(fluid_text({...nothing, bleeding_ml_min: 5, blood_loss_ml: 1.25, pool_level_m: 0.002, excesses: 1}),
    "bleeds 5.0 ml/min, 1.3 ml lost, pool 2.0 mm, 1 value beyond limits");
});
