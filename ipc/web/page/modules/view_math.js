// Moving a view: {viewpoint_m, lookpoint_m, twist_rad, opening_angle_rad}. z is up in the world. Pure functions.

const kSteepest = (89 * Math.PI) / 180;
const kNearest_m = 0.05;
const kFarthest_m = 500;
const kVertical = 1e-6;  // of the gateway: below, up in the picture is the world's y axis

export const kHomeView = Object.freeze(
  {viewpoint_m: [6, -9, 6], lookpoint_m: [4, 0, 0.5], twist_rad: 0, opening_angle_rad: 0.7});

const plus = (a, b) => a.map((value, i) => value + b[i]);
const minus = (a, b) => a.map((value, i) => value - b[i]);
const times = (a, factor) => a.map((value) => value * factor);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

export function distance(view) {
  return Math.hypot(...minus(view.viewpoint_m, view.lookpoint_m));
}

// A copy of what may be read from the gateway, with what is missing or impossible replaced.
export function sound_view(view) {
  const points = [view?.viewpoint_m, view?.lookpoint_m];
  const fine = points.every((point) => Array.isArray(point) && point.length === 3 && point.every(Number.isFinite));
  if (!fine || distance(view) < 1e-6) return structuredClone(kHomeView);
  return {
    viewpoint_m: [...view.viewpoint_m],
    lookpoint_m: [...view.lookpoint_m],
    twist_rad: Number.isFinite(view.twist_rad) ? view.twist_rad : 0,
    opening_angle_rad: view.opening_angle_rad > 0.01 && view.opening_angle_rad < 3 ? view.opening_angle_rad : 0.7,
  };
}

// From straight above or below no direction is to be seen: the one in which the picture does not turn when it tilts.
function azimuth_of(offset, reach) {
  if (Math.hypot(offset[0], offset[1]) >= kVertical * reach) return Math.atan2(offset[1], offset[0]);
  return offset[2] > 0 ? -Math.PI / 2 : Math.PI / 2;
}

// Turns the viewpoint about the lookpoint: `turn` about the world's z axis, `rise` upwards, both in rad.
export function orbit(view, turn, rise) {
  const offset = minus(view.viewpoint_m, view.lookpoint_m);
  const reach = Math.hypot(...offset);
  const azimuth = azimuth_of(offset, reach) + turn;
  const elevation = Math.max(-kSteepest, Math.min(kSteepest, Math.asin(offset[2] / reach) + rise));
  const flat = reach * Math.cos(elevation);
  const turned = [flat * Math.cos(azimuth), flat * Math.sin(azimuth), reach * Math.sin(elevation)];
  return {...view, viewpoint_m: plus(view.lookpoint_m, turned)};
}

// Right and up of the picture, in the world, with the twist in it.
export function picture_axes(view) {
  const forward = times(minus(view.lookpoint_m, view.viewpoint_m), 1 / distance(view));
  let right = cross(forward, [0, 0, 1]);
  const size = Math.hypot(...right);
  right = size < kVertical ? [forward[2] < 0 ? 1 : -1, 0, 0] : times(right, 1 / size);
  const up = cross(right, forward);
  const c = Math.cos(view.twist_rad);
  const s = Math.sin(view.twist_rad);
  return {right: plus(times(right, c), times(up, s)), up: plus(times(up, c), times(right, -s))};
}

// Shifts both points so that what is seen follows the hand; x to the right, y down, in heights of the picture.
export function pan(view, x, y) {
  const height_m = 2 * distance(view) * Math.tan(view.opening_angle_rad / 2);
  const {right, up} = picture_axes(view);
  const shift = plus(times(right, -x * height_m), times(up, y * height_m));
  return {...view, viewpoint_m: plus(view.viewpoint_m, shift), lookpoint_m: plus(view.lookpoint_m, shift)};
}

// factor < 1: nearer.
export function zoom(view, factor) {
  const reach = Math.max(kNearest_m, Math.min(kFarthest_m, distance(view) * factor));
  const offset = times(minus(view.viewpoint_m, view.lookpoint_m), reach / distance(view));
  return {...view, viewpoint_m: plus(view.lookpoint_m, offset)};
}

// The same direction, so that the box between two corners fills the picture.
export function fitted(view, low, high) {
  const lookpoint_m = low.map((value, i) => (value + high[i]) / 2);
  const radius = Math.hypot(...minus(high, low)) / 2;
  const reach = Math.max(kNearest_m, Math.min(kFarthest_m, radius / Math.sin(view.opening_angle_rad / 2)));
  const offset = times(minus(view.viewpoint_m, view.lookpoint_m), reach / distance(view));
  return {...view, lookpoint_m, viewpoint_m: plus(lookpoint_m, offset)};
}

// The SCRIPT command that makes a view of the gateway look like this one; SCRIPT has mm and degrees.
export function as_command(view, id, seconds = 1) {
  const mm = (point) => point.map((value) => (value * 1000).toFixed(1)).join(" ");
  const degrees = (angle) => ((angle * 180) / Math.PI).toFixed(2);
  return `STVW ${id} VP ${mm(view.viewpoint_m)} LP ${mm(view.lookpoint_m)} TW ${degrees(view.twist_rad)}` +
    ` VA ${degrees(view.opening_angle_rad)} TIME ${seconds}`;
}
