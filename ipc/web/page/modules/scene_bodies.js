// The bodies of the cell as meshes of three.js, from a glTF file: where they are, how they are marked and drawn.
import * as THREE from "../lib/three/build/three.module.js";
import {GLTFLoader} from "../lib/three/examples/jsm/loaders/GLTFLoader.js";
import {state_of} from "./scene_format.js";

// As in the gateway's pictures: the colour of a mark and its share in the body's own.
const kMarkColours = {near: [0xf2b81f, 0.8], touching: [0xcc380a, 0.85], ghost: [0x858fa8, 0.75]};
const kGhostAlpha = 0.4;
const kSeeThrough = 0.35;
const kSelected = 0x04303e;  // added to the colour

function parsed(buffer) {
  return new Promise((resolve, reject) => new GLTFLoader().parse(buffer, "", resolve, reject));
}

function material_of(body, {mark, drawn}, open) {
  const alpha = Math.min(body.alpha, drawn === "transparent" ? kSeeThrough : 1, mark === "ghost" ? kGhostAlpha : 1);
  const color = body.colour.clone();
  const [over, share] = kMarkColours[mark] ?? [0, 0];
  color.lerp(new THREE.Color(over), share);
  const settings = {color, side: open ? THREE.DoubleSide : body.side, transparent: alpha < 1, opacity: alpha, depthWrite: alpha >= 1, wireframe: drawn === "wireframe"};
  // Lambert's light is computed by vertex here: a software renderer has to be quick. Flat faces need it by pixel.
  return drawn === "flat" ? new THREE.MeshPhongMaterial({...settings, flatShading: true, shininess: 0}) : new THREE.MeshLambertMaterial(settings);
}

export class SceneBodies {
  constructor() {
    this.group = new THREE.Group();
    this.bodies = [];
    this.selected_ = null;
    this.open_ = false;
  }

  // Replaces all bodies; false where the file cannot be read.
  async load(buffer) {
    let file;
    try {
      file = await parsed(buffer);
    } catch {
      return false;
    }
    this.clear();
    file.scene.traverse((node) => {
      if (Number.isInteger(node.userData.index)) this.add_(node);
    });
    file.scene.traverse((node) => node.material?.dispose?.());
    return true;
  }

  clear() {
    for (const body of this.bodies) {
      body?.mesh?.material.dispose();
      body?.mesh?.geometry.dispose();
    }
    this.group.remove(...this.group.children);
    this.bodies = [];
    this.shown_ = null;
  }

  add_(node) {
    const {index, path, robot} = node.userData;
    const body = {path, robot, mesh: null, colour: new THREE.Color(0xb8b8bd), alpha: 1, side: THREE.FrontSide, state: -1, scale: node.scale.clone()};
    if (node.isMesh) {
      body.colour = node.material.color.clone().convertLinearToSRGB();
      body.alpha = node.material.opacity;
      body.side = node.material.side;
      body.mesh = new THREE.Mesh(node.geometry, material_of(body, state_of(0), this.open_));
      body.mesh.matrixAutoUpdate = false;
      body.mesh.userData.body = body;
      this.group.add(body.mesh);
    }
    this.bodies[index] = body;
  }

  // Only what has changed is touched. `bodies`: a part of a message; `states`: its bytes.
  place({numbers, count, stride}, states) {
    const before = this.shown_;
    const at = new THREE.Vector3();
    const turn = new THREE.Quaternion();
    for (let i = 0; i < count; ++i) {
      const body = this.bodies[i];
      if (!body?.mesh) continue;
      if (body.state !== states[i]) this.restate_(body, states[i]);
      const from = i * stride;
      let same = before !== null && before.length === numbers.length;
      for (let k = from; same && k < from + stride; ++k) same = before[k] === numbers[k];
      if (same) continue;
      at.set(numbers[from], numbers[from + 1], numbers[from + 2]);
      turn.set(numbers[from + 3], numbers[from + 4], numbers[from + 5], numbers[from + 6]);
      body.mesh.matrix.compose(at, turn, body.scale);
      body.mesh.matrixWorldNeedsUpdate = true;
    }
    this.shown_ = numbers;
  }

  restate_(body, state) {
    body.state = state;
    body.mesh.material.dispose();
    body.mesh.material = material_of(body, state_of(state), this.open_);
    this.light_(body);
  }

  // Whether bodies are cut open, so that their inner sides are seen.
  open(open) {
    if (open === this.open_) return;
    this.open_ = open;
    for (const body of this.bodies) if (body?.mesh) this.restate_(body, Math.max(0, body.state));
  }

  // Highlights the bodies of a node and of what is below it; null: none.
  select(path) {
    if (path === this.selected_) return;
    this.selected_ = path;
    for (const body of this.bodies) if (body?.mesh) this.light_(body);
  }

  light_(body) {
    const chosen = this.selected_ !== null && (body.path === this.selected_ || body.path.startsWith(`${this.selected_}.`));
    body.mesh.material.emissive.setHex(chosen ? kSelected : 0);
  }

  // The first body that a ray meets at a point for which `seen` is true: {point, body}, or null.
  hit(ray, seen) {
    const found = ray.intersectObjects(this.group.children).find(({point}) => seen(point));
    return found ? {point: found.point, body: found.object.userData.body} : null;
  }

  bounds() {
    return new THREE.Box3().setFromObject(this.group);
  }
}
