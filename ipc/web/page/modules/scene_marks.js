// What is drawn beside the bodies: lines of near and touching pairs, frames, cones of sensors, arrows, traces, the floor.
import * as THREE from "../lib/three/build/three.module.js";
import {colour_of, rotated} from "./scene_format.js";

const kAxisColours = [[0.8, 0.16, 0.12, 1], [0.1, 0.56, 0.24, 1], [0.1, 0.34, 0.84, 1]];
const kGrid_m = 0.5;
const kMostGridLines = 400;
const kWidestCone_rad = 1.4;

// Segments of lines whose number changes: the buffers grow and are used again.
class Segments {
  constructor(on_top) {
    const material = new THREE.LineBasicMaterial({vertexColors: THREE.VertexColors, depthTest: !on_top, transparent: on_top});
    this.node = new THREE.LineSegments(new THREE.BufferGeometry(), material);
    this.node.frustumCulled = false;
    if (on_top) this.node.renderOrder = 1;
    this.room_ = 0;
    this.begin();
  }

  begin() {
    this.points_ = [];
    this.colours_ = [];
  }

  add(from, to, colour) {
    this.points_.push(...from, ...to);
    this.colours_.push(colour[0], colour[1], colour[2], colour[0], colour[1], colour[2]);
  }

  end() {
    const {geometry} = this.node;
    if (this.points_.length > this.room_) {
      this.room_ = 2 * this.points_.length;
      for (const name of ["position", "color"]) geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(this.room_), 3));
    }
    if (this.room_ > 0) {
      geometry.attributes.position.array.set(this.points_);
      geometry.attributes.color.array.set(this.colours_);
      geometry.attributes.position.needsUpdate = true;
      geometry.attributes.color.needsUpdate = true;
    }
    geometry.setDrawRange(0, this.points_.length / 3);
    this.node.visible = this.points_.length > 0;
  }
}

const point = (numbers, at) => [numbers[at], numbers[at + 1], numbers[at + 2]];
const moved = (from, by, length) => from.map((value, i) => value + length * by[i]);

export class SceneMarks {
  constructor() {
    this.group = new THREE.Group();
    this.lines_ = new Segments(false);
    this.on_top_ = new Segments(true);
    this.traces_ = new Segments(false);
    this.floor_ = new THREE.Group();
    this.cones_ = [];
    // Apex at the origin, opening along z, of radius and length 1.
    this.cone_geometry_ = new THREE.ConeBufferGeometry(1, 1, 48, 1, true).rotateX(-Math.PI / 2).translate(0, 0, 0.5);
    this.group.add(this.lines_.node, this.on_top_.node, this.traces_.node, this.floor_);
    this.floor_text_ = "";
  }

  // `poses`: a decoded message.
  place(poses) {
    this.lines_.begin();
    this.on_top_.begin();
    this.add_lines_(poses.lines);
    this.add_axes_(poses.axes);
    this.add_arrows_(poses.arrows);
    this.lines_.end();
    this.on_top_.end();
    this.place_cones_(poses.cones);
  }

  add_lines_({count, stride, numbers, bits}) {
    for (let i = 0; i < count; ++i) {
      const at = i * stride;
      const colour = colour_of(bits[at + 7]);
      const from = point(numbers, at);
      const to = point(numbers, at + 3);
      const into = (bits[at + 8] & 2) !== 0 ? this.on_top_ : this.lines_;
      if ((bits[at + 8] & 1) === 0) into.add(from, to, colour);
      else dashes(from, to, (a, b) => into.add(a, b, colour));
    }
  }

  add_axes_({count, stride, numbers}) {
    for (let i = 0; i < count; ++i) {
      const at = i * stride;
      const origin = point(numbers, at);
      const turn = Array.from(numbers.subarray(at + 3, at + 7));
      const into = numbers[at + 8] > 0 ? this.on_top_ : this.lines_;
      for (let axis = 0; axis < 3; ++axis) {
        const along = rotated(turn, [Number(axis === 0), Number(axis === 1), Number(axis === 2)]);
        into.add(origin, moved(origin, along, numbers[at + 7]), kAxisColours[axis]);
      }
    }
  }

  add_arrows_({count, stride, numbers, bits}) {
    for (let i = 0; i < count; ++i) {
      const at = i * stride;
      const from = point(numbers, at);
      const along = point(numbers, at + 3);
      const length = Math.hypot(...along);
      if (!(length > 1e-4)) continue;
      const colour = colour_of(bits[at + 6]);
      const tip = moved(from, along, 1);
      this.on_top_.add(from, tip, colour);
      const unit = along.map((value) => value / length);
      const side = Math.abs(unit[2]) < 0.9 ? [-unit[1], unit[0], 0] : [0, -unit[2], unit[1]];
      const heads = bits[at + 7] === 1 ? [0, 0.12 * length] : [0];
      for (const back of heads) {
        const end = moved(tip, unit, -back);
        const base = moved(end, unit, -0.15 * length);
        for (const way of [1, -1]) this.on_top_.add(end, moved(base, side, way * 0.06 * length), colour);
      }
    }
  }

  place_cones_({count, stride, numbers, bits}) {
    while (this.cones_.length < count) {
      const cone = new THREE.Mesh(this.cone_geometry_, new THREE.MeshBasicMaterial({transparent: true, depthWrite: false, side: THREE.DoubleSide}));
      cone.matrixAutoUpdate = false;
      this.cones_.push(cone);
      this.group.add(cone);
    }
    this.cones_.forEach((cone, i) => {
      cone.visible = i < count;
      if (!cone.visible) return;
      const at = i * stride;
      const angle = Math.min(numbers[at + 7], kWidestCone_rad);
      const radius = numbers[at + 8] * Math.sin(angle);
      const [red, green, blue, alpha] = colour_of(bits[at + 9]);
      cone.material.color.setRGB(red, green, blue);
      cone.material.opacity = alpha;
      cone.matrix.compose(new THREE.Vector3(...point(numbers, at)), new THREE.Quaternion(...numbers.subarray(at + 3, at + 7)),
        new THREE.Vector3(radius, radius, numbers[at + 8] * Math.cos(angle)));
      cone.matrixWorldNeedsUpdate = true;
    });
  }

  // `marks`: a message; `line`: the colour of the floor's lines.
  show(marks, line) {
    this.traces_.begin();
    for (const {points_m, rgba} of marks.traces ?? []) {
      for (let at = 3; at + 2 < points_m.length; at += 3) this.traces_.add(points_m.slice(at - 3, at), points_m.slice(at, at + 3), rgba);
    }
    this.traces_.end();
    const text = JSON.stringify([marks.floor ?? null, line]);
    if (text === this.floor_text_) return;
    this.floor_text_ = text;
    this.lay_floor_(marks.floor, line);
  }

  lay_floor_(floor, line) {
    for (const old of this.floor_.children) {
      old.geometry.dispose();
      old.material.dispose();
    }
    this.floor_.remove(...this.floor_.children);
    if (!floor?.shown) return;
    const [x0, y0, x1, y1] = [...floor.low_m, ...floor.high_m];
    const step = Math.max(kGrid_m, (x1 - x0 + y1 - y0) / kMostGridLines);
    const points = [];
    for (let x = x0; x <= x1 + step / 2; x += step) points.push(x, y0, floor.z_m, x, y1, floor.z_m);
    for (let y = y0; y <= y1 + step / 2; y += step) points.push(x0, y, floor.z_m, x1, y, floor.z_m);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points), 3));
    this.floor_.add(new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({color: line, transparent: true, opacity: 0.6})));
  }
}

function dashes(from, to, add) {
  const kPieces = 15;
  const along = to.map((value, i) => value - from[i]);
  for (let i = 0; i < kPieces; i += 2) add(moved(from, along, i / kPieces), moved(from, along, (i + 1) / kPieces));
}
