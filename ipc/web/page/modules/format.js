// Quantities as people read them. The wire is SI throughout; angles are shown in degrees, lengths in millimetres, as
// SCRIPT has them.

const kDegrees = 180 / Math.PI;
const kMinus = "\u2212";

export function number(value, digits) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const text = value.toFixed(digits);
  const magnitude = text.startsWith("-") ? text.slice(1) : text;
  return text.startsWith("-") && Number(magnitude) !== 0 ? kMinus + magnitude : magnitude;
}

// `unit` is rad or m, or per second of them.
export function scaled(value, unit) {
  if (value === null || value === undefined) return null;
  return value * (unit.startsWith("rad") ? kDegrees : 1000);
}

export function shown_unit(unit) {
  return unit.startsWith("rad") ? (unit === "rad" ? "°" : "°/s") : unit === "m" ? "mm" : "mm/s";
}

export function joint_unit(joint) {
  if (joint.unit) return joint.unit;
  return /prism|slid|linear|trans/i.test(joint.kind ?? "") ? "m" : "rad";
}

export function joint_value(value, unit) {
  return number(scaled(value, unit), 1);
}

export function length(metres) {
  if (metres === null || metres === undefined) return "–";
  return Math.abs(metres) >= 1 ? `${number(metres, 3)} m` : `${number(metres * 1000, 1)} mm`;
}

export function age(seconds) {
  if (seconds === null || seconds === undefined) return "–";
  if (seconds < 0.9995) return `${number(seconds * 1000, 0)} ms`;
  if (seconds < 60) return `${number(seconds, 1)} s`;
  return duration(seconds);
}

export function duration(seconds) {
  const whole = Math.max(0, Math.floor(seconds));
  const parts = [Math.floor(whole / 86400), Math.floor(whole / 3600) % 24, Math.floor(whole / 60) % 60, whole % 60];
  if (parts[0]) return `${parts[0]} d ${parts[1]} h`;
  if (parts[1]) return `${parts[1]} h ${parts[2]} min`;
  if (parts[2]) return `${parts[2]} min ${parts[3]} s`;
  return `${parts[3]} s`;
}

export function microseconds(value) {
  if (value === null || value === undefined) return "–";
  return value < 10000 ? `${number(value, 0)} µs` : `${number(value / 1000, 1)} ms`;
}

export function count(value) {
  return value === null || value === undefined ? "–" : String(value).replace(/\B(?=(\d{3})+(?!\d))/g, "\u202f");
}

export function clock_time(date = new Date()) {
  return date.toTimeString().slice(0, 8);
}

export function norm(force) {
  if (force === null || force === undefined) return null;
  return Array.isArray(force) ? Math.hypot(...force) : force;
}
