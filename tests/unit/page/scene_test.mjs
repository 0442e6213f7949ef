import assert from "node:assert/strict";
import {test} from "node:test";

import {colour_of, decode_poses, rotated, state_of, twist_of, view_of_camera} from "./modules/scene_format.js";
import {fitted, orbit, picture_axes} from "./modules/view_math.js";

// A message with one body, one line and one camera.
function message() {
  const floats = [1, 2, 3, 0, 0, 0, 1, /* line */ 0, 0, 0, 1, 1, 1, 2.5, 0, 0, /* camera */ 5, 6, 7, 0, 0, 0, 1, 0.8, 2];
  const buffer = new ArrayBuffer(48 + 4 * floats.length + 1);
  const view = new DataView(buffer);
  view.setUint32(0, 0x31534d43, true);
  view.setUint32(4, 9, true);
  view.setUint32(8, 0x89abcdef, true);
  view.setUint32(12, 0x01234567, true);
  view.setFloat64(16, 0.25, true);
  [1, 1, 0, 0, 0, 1].forEach((count, i) => view.setUint32(24 + 4 * i, count, true));
  floats.forEach((value, i) => view.setFloat32(48 + 4 * i, value, true));
  view.setUint32(48 + 4 * 14, 0x80ff0040, true);
  view.setUint32(48 + 4 * 15, 3, true);
  view.setUint8(buffer.byteLength - 1, 0x12);
  return buffer;
}

test("poses are read as they lie in the message", () => {
  const poses = decode_poses(message());
  assert.equal(poses.sequence, 9);
  assert.equal(poses.geometry, "0123456789abcdef");
  assert.equal(poses.age_s, 0.25);
  assert.deepEqual([...poses.bodies.numbers], [1, 2, 3, 0, 0, 0, 1]);
  assert.deepEqual(colour_of(poses.lines.bits[7]).map((part) => Math.round(255 * part)), [0x40, 0, 0xff, 0x80]);
  assert.equal(poses.lines.bits[8], 3);
  assert.deepEqual(state_of(poses.states[0]), {mark: "touching", drawn: "flat"});
});

test("a message that is cut or lies about its counts is none", () => {
  const whole = message();
  for (let size = 0; size < whole.byteLength; ++size) assert.equal(decode_poses(whole.slice(0, size)), null, String(size));
  for (let i = 0; i < 6; ++i) {
    const more = whole.slice(0);
    new DataView(more).setUint32(24 + 4 * i, 0xffffffff, true);
    assert.equal(decode_poses(more), null);
  }
  assert.equal(decode_poses("CMS1"), null);
});

test("a camera looks along its z axis, with y down", () => {
  const view = view_of_camera(decode_poses(message()).cameras, 0);
  assert.deepEqual(view.viewpoint_m, [5, 6, 7]);
  assert.deepEqual(view.lookpoint_m, [5, 6, 9]);
  assert.deepEqual(view.up, [0, -1, 0]);
  assert.equal(view_of_camera(decode_poses(message()).cameras, 1), null);
  assert.equal(view_of_camera(decode_poses(message()).cameras, -1), null);
});

test("the twist gives a view the camera's direction up", () => {
  const view = {viewpoint_m: [1, 2, 3], lookpoint_m: [4, 0, 1], twist_rad: 0, opening_angle_rad: 0.7};
  for (const twist_rad of [-2, -0.3, 0, 1, 3]) {
    const {up} = picture_axes({...view, twist_rad});
    assert.ok(Math.abs(twist_of(up, picture_axes(view)) - twist_rad) < 1e-9);
  }
  assert.deepEqual(rotated([0, 0, Math.SQRT1_2, Math.SQRT1_2], [1, 0, 0]).map((value) => Math.round(value) + 0), [0, 1, 0]);
});

test("all of a box is in sight, from the same direction", () => {
  const view = {viewpoint_m: [10, 0, 0], lookpoint_m: [0, 0, 0], twist_rad: 0, opening_angle_rad: 0.7};
  const seen = fitted(orbit(view, 0.5, 0.2), [-1, -1, -1], [3, 1, 1]);
  assert.deepEqual(seen.lookpoint_m, [1, 0, 0]);
  const reach = Math.hypot(...seen.viewpoint_m.map((value, i) => value - seen.lookpoint_m[i]));
  assert.ok(Math.abs(reach * Math.sin(0.35) - Math.hypot(4, 2, 2) / 2) < 1e-9);
});
