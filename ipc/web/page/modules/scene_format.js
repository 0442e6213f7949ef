// Poses as they come over the WebSocket: little-endian, a head of 24 bytes, six counts, then numbers of 4 bytes each and one
// byte a body (docs/monitor-page.md). Pure.

const kMagic = 0x31534d43;  // "CMS1"
const kHeadBytes = 48;      // with the counts
const kParts = [["bodies", 7], ["lines", 9], ["axes", 9], ["cones", 10], ["arrows", 8], ["cameras", 9]];

export function is_poses(buffer) {
  return buffer instanceof ArrayBuffer && buffer.byteLength >= kHeadBytes && new DataView(buffer).getUint32(0, true) === kMagic;
}

// {sequence, geometry: 16 hexadecimal digits, age_s, states: bytes, bodies, lines, ...}, each of these a part {count, stride,
// numbers, bits}: the same memory as floats and as whole numbers. Null where it is something else or cut.
export function decode_poses(buffer) {
  if (!is_poses(buffer)) return null;
  const head = new DataView(buffer);
  const hex = (at) => head.getUint32(at, true).toString(16).padStart(8, "0");
  const out = {sequence: head.getUint32(4, true), geometry: hex(12) + hex(8), age_s: head.getFloat64(16, true)};
  let at = kHeadBytes;
  for (const [i, [name, stride]] of kParts.entries()) {
    const count = head.getUint32(24 + 4 * i, true);
    const length = count * stride;
    if (at + 4 * length > buffer.byteLength) return null;
    out[name] = {count, stride, numbers: new Float32Array(buffer, at, length), bits: new Uint32Array(buffer, at, length)};
    at += 4 * length;
  }
  if (at + out.bodies.count > buffer.byteLength) return null;
  out.states = new Uint8Array(buffer, at, out.bodies.count);
  return out;
}

// A colour of the message, red in the lowest byte: [red, green, blue, alpha], 0 to 1.
export function colour_of(bits) {
  return [bits & 255, (bits >>> 8) & 255, (bits >>> 16) & 255, bits >>> 24].map((value) => value / 255);
}

export const kMarks = ["", "near", "touching", "ghost"];
export const kDrawn = ["smooth", "flat", "wireframe", "transparent"];

export function state_of(byte) {
  return {mark: kMarks[byte & 15] ?? "", drawn: kDrawn[byte >> 4] ?? "smooth"};
}

// Rotates a vector by a quaternion x y z w.
export function rotated([x, y, z, w], v) {
  const t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
  return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0]];
}

// The view of camera i of a message, as views are described elsewhere; null: there is none. The optical axis is the z axis, y
// points down in the picture.
export function view_of_camera(cameras, i) {
  if (!(i >= 0 && i < cameras.count)) return null;
  const n = Array.from(cameras.numbers.subarray(i * cameras.stride, (i + 1) * cameras.stride));
  const turn = n.slice(3, 7);
  const forward = rotated(turn, [0, 0, 1]);
  const up = rotated(turn, [0, -1, 0]);
  const distance = n[8] > 0.01 ? n[8] : 1;
  const viewpoint_m = n.slice(0, 3);
  return {viewpoint_m, lookpoint_m: viewpoint_m.map((value, k) => value + distance * forward[k]), up,
    twist_rad: 0, opening_angle_rad: n[7] > 0.01 && n[7] < 3 ? n[7] : 0.7};
}

// The twist that gives a view this direction up, where `axes` are its right and up without twist.
export function twist_of(up, axes) {
  const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);
  return Math.atan2(-dot(up, axes.right), dot(up, axes.up));
}
