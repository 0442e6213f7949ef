import assert from "node:assert/strict";
import {test} from "node:test";

import {decode_tissue_motion, decode_tissue_shape, is_tissue_shape, unpack_colours, unpack_normals, unpack_places} from "./modules/tissue_format.js";

function bytes(...parts) {
  const all = parts.flatMap((part) => {
    const raw = [...new Uint8Array(part.buffer ?? part)];
    return [...raw, ...new Array((4 - (raw.length % 4)) % 4).fill(0)];
  });
  return new Uint8Array(all).buffer;
}
const text = (word) => new TextEncoder().encode(word);

// A triangle of skin and one of a cut, and a clip of one triangle; the C++ test writes the same.
const shape = () => bytes(text("CMT1"), new Uint32Array([7, 1, 1]), new Uint32Array([4, 2, 1]), new Uint32Array([0, 1, 2, 0, 2, 3]),
  new Uint8Array([255, 0, 128, 0, 255, 0, 128, 0, 255, 0, 128, 0, 255, 0, 128, 0]), new Uint32Array([3, 1]), new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]),
  new Uint32Array([0, 1, 2]));
const motion = () => bytes(text("CMM1"), new Uint32Array([7, 1, 1, 1, 1]), new Float32Array([1, 2, 3, 2, 0, 1]), new Uint32Array([3]),
  new Uint16Array([0, 0, 0, 65535, 0, 65535, 0, 0, 32768, 65535, 0, 0]), new Int8Array([0, 0, 127, 0, 0, -127, 64, 63]), new Uint8Array([0, 128, 255, 0]),
  new Float32Array([0, 0, 1, 0, 0, 0, 1]), new Float32Array([0.5, 0.25, 0.125, 0.002]), new Uint32Array([2]),
  new Float32Array([0, 0, 0, 0, 0, 0, 1]), new Float32Array([0.2, 0.1, 0.01]), new Uint32Array([0xff0000ff]));

test("a shape is read as it lies in the message", () => {
  const read = decode_tissue_shape(shape());
  assert.equal(read.number, 7);
  assert.deepEqual([read.surfaces[0].vertices, read.surfaces[0].skin], [4, 1]);
  assert.deepEqual([...read.surfaces[0].corners], [0, 1, 2, 0, 2, 3]);
  assert.deepEqual([...read.surfaces[0].colours.slice(0, 4)], [255, 0, 128, 0]);
  assert.deepEqual([...read.clips[0].points], [0, 0, 0, 1, 0, 0, 0, 1, 0]);
  assert.deepEqual([...read.clips[0].corners], [0, 1, 2]);
});

test("a motion is read as it lies in the message", () => {
  const read = decode_tissue_motion(motion(), [4]);
  assert.equal(read.number, 7);
  const [surface] = read.surfaces;
  assert.deepEqual([surface.shown, surface.wet], [true, true]);
  const places = new Float32Array(12);
  unpack_places(surface, places);
  assert.deepEqual([...places].map((value) => Math.round(1000 * value) / 1000), [1, 2, 3, 3, 2, 4, 1, 2, 3.5, 3, 2, 3]);
  const normals = new Float32Array(12);
  unpack_normals(surface.normals, normals);
  const rounded = [...normals].map((value) => Math.round(100 * value) / 100 + 0);
  assert.deepEqual(rounded.slice(0, 9), [0, 0, 1, 1, 0, 0, 0, -1, 0]);
  assert.ok(Math.abs(Math.hypot(...normals.slice(9)) - 1) < 1e-6);
  assert.deepEqual([...read.clips], [0, 0, 1, 0, 0, 0, 1]);
  assert.deepEqual(read.particles[0].at, [0.5, 0.25, 0.125]);
  assert.equal(read.particles[0].kind, 2);
  assert.ok(Math.abs(read.pool.size[2] - 0.01) < 1e-6);
  assert.equal(read.pool.colour, 0xff0000ff);
  assert.equal(decode_tissue_motion(motion(), [3, 1]), null, "of another shape");
});

test("what is cut or lies about its counts is none", () => {
  for (const [whole, decode, head] of [[shape(), decode_tissue_shape, 4], [motion(), (buffer) => decode_tissue_motion(buffer, [4]), 6]]) {
    for (let size = 0; size < whole.byteLength; size += 1) assert.equal(decode(whole.slice(0, size)), null, String(size));
    for (let i = 2; i < head; ++i) {
      const more = whole.slice(0);
      new DataView(more).setUint32(4 * i, 0xffffffff, true);
      assert.equal(decode(more), null, String(i));
    }
  }
  assert.equal(is_tissue_shape("CMT1"), false);
  assert.equal(decode_tissue_shape(motion()), null);
});

test("burns turn flesh brown, then black", () => {
  const colours = new Float32Array(9);
  unpack_colours(new Uint8Array([255, 128, 128, 0, 255, 128, 128, 0, 255, 128, 128, 0]), new Uint8Array([0, 128, 255]), colours);
  assert.equal(colours[0], 1);
  assert.ok(colours[3] < 0.5 && colours[3] > 0.4, String(colours[3]));
  assert.ok(colours[6] < 0.08, String(colours[6]));
});
