// Deformable objects in 3D: surfaces with cuts and burns, clips, drops of blood and smoke, the pool of fluid.
import * as THREE from "../lib/three/build/three.module.js";
import {colour_of} from "./scene_format.js";
import {decode_tissue_motion, decode_tissue_shape, unpack_colours, unpack_normals, unpack_places} from "./tissue_format.js";

const kRaw = 0x780d0f;       // of a face that was cut
const kClip = 0xb9c0c6;
const kParticles = [0x8a0b10, 0xb8bcc0, 0x9fc4d6];  // blood, smoke, water
const kMostParticles = 1000;

function attribute(count) {
  const out = new THREE.BufferAttribute(new Float32Array(3 * count), 3);
  out.setUsage?.(THREE.DynamicDrawUsage ?? 35048);
  return out;
}

export class SceneTissue {
  constructor() {
    this.group = new THREE.Group();
    this.surfaces_ = [];
    this.clips_ = [];
    this.number_ = null;
    this.motion_ = null;
    const drops = new THREE.BufferGeometry();
    drops.setAttribute("position", attribute(kMostParticles));
    drops.setAttribute("color", attribute(kMostParticles));
    this.drops_ = new THREE.Points(drops, new THREE.PointsMaterial({size: 0.003, vertexColors: THREE.VertexColors}));
    this.drops_.frustumCulled = false;
    this.drops_.visible = false;
    this.pool_ = new THREE.Mesh(new THREE.PlaneBufferGeometry(1, 1),
      new THREE.MeshBasicMaterial({transparent: true, depthWrite: false, side: THREE.DoubleSide}));
    this.pool_.matrixAutoUpdate = false;
    this.pool_.visible = false;
  }

  // True where something is to be drawn again. A motion of another shape waits for it.
  take_shape(buffer) {
    const shape = decode_tissue_shape(buffer);
    if (!shape) return false;
    this.clear_();
    this.number_ = shape.number;
    this.surfaces_ = shape.surfaces.map((surface) => this.make_surface_(surface));
    this.clips_ = shape.clips.map((clip) => this.make_clip_(clip));
    this.group.add(...this.surfaces_.map(({mesh}) => mesh), ...this.clips_, this.drops_, this.pool_);
    return false;
  }

  take_motion(buffer) {
    const motion = decode_tissue_motion(buffer, this.surfaces_.map(({vertices}) => vertices));
    if (!motion || motion.number !== this.number_) return false;
    motion.surfaces.forEach((surface, i) => this.move_(this.surfaces_[i], surface));
    this.place_clips_(motion.clips);
    this.place_drops_(motion.particles);
    this.fill_(motion.pool);
    return true;
  }

  clear_() {
    for (const mesh of [...this.surfaces_.map(({mesh: one}) => one), ...this.clips_]) {
      mesh.geometry.dispose();
      for (const material of [mesh.material].flat()) material.dispose();
    }
    this.group.remove(...this.group.children);
  }

  make_surface_({vertices, skin, corners, colours}) {
    const geometry = new THREE.BufferGeometry();
    for (const name of ["position", "normal", "color"]) geometry.setAttribute(name, attribute(vertices));
    geometry.setIndex(new THREE.BufferAttribute(corners, 1));
    geometry.addGroup(0, 3 * skin, 0);
    geometry.addGroup(3 * skin, corners.length - 3 * skin, 1);
    const side = THREE.DoubleSide;
    const mesh = new THREE.Mesh(geometry, [new THREE.MeshPhongMaterial({side, vertexColors: THREE.VertexColors, specular: 0x333333, shininess: 60}),
      new THREE.MeshPhongMaterial({side, color: kRaw, specular: 0x222222})]);
    mesh.frustumCulled = false;
    mesh.visible = false;
    return {vertices, colours, mesh, burnt: null};
  }

  move_(surface, motion) {
    surface.mesh.visible = motion.shown && surface.vertices > 0;
    if (!surface.mesh.visible) return;
    const {position, normal, color} = surface.mesh.geometry.attributes;
    unpack_places(motion, position.array);
    unpack_normals(motion.normals, normal.array);
    position.needsUpdate = true;
    normal.needsUpdate = true;
    surface.mesh.geometry.boundingSphere = null;  // for picks
    if (surface.burnt !== null && surface.burnt.every((burn, i) => burn === motion.burns[i])) return;
    surface.burnt = motion.burns.slice();
    unpack_colours(surface.colours, motion.burns, color.array);
    color.needsUpdate = true;
  }

  make_clip_({points, corners}) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
    geometry.setIndex(new THREE.BufferAttribute(corners, 1));
    geometry.computeVertexNormals();
    const mesh = new THREE.Mesh(geometry, new THREE.MeshPhongMaterial({color: kClip, side: THREE.DoubleSide, flatShading: true}));
    mesh.matrixAutoUpdate = false;
    mesh.frustumCulled = false;
    return mesh;
  }

  place_clips_(poses) {
    this.clips_.forEach((clip, i) => {
      const n = poses.subarray(7 * i, 7 * i + 7);
      clip.visible = n.length === 7;
      if (clip.visible) clip.matrix.compose(new THREE.Vector3(n[0], n[1], n[2]), new THREE.Quaternion(n[3], n[4], n[5], n[6]), new THREE.Vector3(1, 1, 1));
      clip.matrixWorldNeedsUpdate = true;
    });
  }

  place_drops_(particles) {
    const {position, color} = this.drops_.geometry.attributes;
    const count = Math.min(particles.length, kMostParticles);
    const colour = new THREE.Color();
    for (let i = 0; i < count; ++i) {
      position.array.set(particles[i].at, 3 * i);
      colour.setHex(kParticles[particles[i].kind] ?? kParticles[0]).toArray(color.array, 3 * i);
    }
    position.needsUpdate = color.needsUpdate = true;
    this.drops_.geometry.setDrawRange(0, count);
    this.drops_.visible = count > 0;
  }

  fill_(pool) {
    this.pool_.visible = pool !== null && pool.size[2] > 0;
    if (!this.pool_.visible) return;
    const {pose: n, size} = pool;
    const turn = new THREE.Quaternion(n[3], n[4], n[5], n[6]);
    const at = new THREE.Vector3(0, 0, size[2]).applyQuaternion(turn).add(new THREE.Vector3(n[0], n[1], n[2]));
    const [red, green, blue, alpha] = colour_of(pool.colour);
    this.pool_.material.color.setRGB(red, green, blue);
    this.pool_.material.opacity = alpha;
    this.pool_.matrix.compose(at, turn, new THREE.Vector3(size[0], size[1], 1));
    this.pool_.matrixWorldNeedsUpdate = true;
  }

  // What was drawn last, for observers: vertices that are seen.
  get vertices() {
    return this.surfaces_.reduce((sum, {vertices, mesh}) => sum + (mesh.visible ? vertices : 0), 0);
  }
}
