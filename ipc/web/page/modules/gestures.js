// Mouse, touch and keys on the picture, as movements of a view. Calls of `target`: orbit(turn, rise) in rad,
// pan(x, y) in heights of the picture, zoom(factor), pick(x, y) in CSS pixels of the element, home(), leave().

const kTap_px = 5;
const kTurn_per_height = 3.2;  // rad for a drag over the height of the picture
const kKeyTurn = Math.PI / 24;
const kKeyPan = 0.06;
const kKeyZoom = 1.15;

export function watch_gestures(area, target) {
  const fingers = new Map();
  let travelled = 0;
  let most_fingers = 0;
  let panning = false;

  const height = () => Math.max(1, area.clientHeight);
  const centre_and_spread = () => {
    const points = [...fingers.values()];
    const x = points.reduce((sum, point) => sum + point.x, 0) / points.length;
    const y = points.reduce((sum, point) => sum + point.y, 0) / points.length;
    const spread = points.length < 2 ? 0 : Math.hypot(points[0].x - points[1].x, points[0].y - points[1].y);
    return {x, y, spread};
  };

  area.addEventListener("pointerdown", (event) => {
    if (fingers.size === 0) {
      travelled = 0;
      most_fingers = 0;
      panning = event.button !== 0 || event.shiftKey;
    }
    fingers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    most_fingers = Math.max(most_fingers, fingers.size);
    area.setPointerCapture(event.pointerId);
    area.focus({preventScroll: true});
    event.preventDefault();
  });

  area.addEventListener("pointermove", (event) => {
    const finger = fingers.get(event.pointerId);
    if (!finger) return;
    const before = centre_and_spread();
    finger.x = event.clientX;
    finger.y = event.clientY;
    const now = centre_and_spread();
    const x = (now.x - before.x) / height();
    const y = (now.y - before.y) / height();
    travelled += Math.hypot(now.x - before.x, now.y - before.y) + Math.abs(now.spread - before.spread);
    if (travelled < kTap_px) return;
    if (fingers.size >= 2) {
      if (now.spread > 1 && before.spread > 1) target.zoom(before.spread / now.spread);
      target.pan(x, y);
    } else if (panning) {
      target.pan(x, y);
    } else {
      target.orbit(-x * kTurn_per_height, y * kTurn_per_height);
    }
  });

  const lifted = (event) => {
    if (!fingers.delete(event.pointerId) || fingers.size > 0) return;
    const tapped = event.type === "pointerup" && travelled < kTap_px && most_fingers === 1 && event.button === 0;
    if (!tapped) return;
    const box = area.getBoundingClientRect();
    target.pick(event.clientX - box.left, event.clientY - box.top);
  };
  area.addEventListener("pointerup", lifted);
  area.addEventListener("pointercancel", lifted);
  area.addEventListener("contextmenu", (event) => event.preventDefault());

  area.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? event.deltaY * 20 : event.deltaY;
    target.zoom(Math.exp(Math.max(-200, Math.min(200, lines)) * 0.0015));
  }, {passive: false});

  area.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (follow_key(event.key, event.shiftKey, area, target)) event.preventDefault();
  });
}

function follow_key(key, shift, area, target) {
  const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
  if (arrows[key]) {
    const [x, y] = arrows[key];
    if (shift) target.pan(-x * kKeyPan, -y * kKeyPan);
    else target.orbit(x * kKeyTurn, -y * kKeyTurn);
  } else if (key === "+" || key === "=") target.zoom(1 / kKeyZoom);
  else if (key === "-" || key === "_") target.zoom(kKeyZoom);
  else if (key === "Home" || key === "0") target.home();
  else if (key === "Enter" || key === " ") target.pick(area.clientWidth / 2, area.clientHeight / 2);
  else if (key === "Escape") target.leave();
  else return false;
  return true;
}
