// The cell in three dimensions, drawn by WebGL: loaded when the 3D mode is chosen for the first time. Draws when something has
// changed, never else.
import * as THREE from "../lib/three/build/three.module.js";
import {Haste, kRests_ms} from "./haste.js";
import {SceneBodies} from "./scene_bodies.js";
import {SceneLabels} from "./scene_labels.js";
import {SceneMarks} from "./scene_marks.js";
import {SceneTissue} from "./scene_tissue.js";
import {picture_axes} from "./view_math.js";

const kMostDensity = 2;
const kCoarse = 0.6;  // of the pixels along an edge

export class SceneView {
  // `canvas`: of the page; `lost()`: WebGL is gone. Throws where there is none.
  constructor(canvas, {lost, drawn}) {
    this.canvas_ = canvas;
    this.drawn_ = drawn;
    this.renderer_ = new THREE.WebGLRenderer({canvas, antialias: true});
    this.scene_ = new THREE.Scene();
    this.camera_ = new THREE.PerspectiveCamera(40, 1, 0.05, 100);
    this.camera_.matrixAutoUpdate = false;
    this.bodies = new SceneBodies();
    this.marks_ = new SceneMarks();
    this.tissue_ = new SceneTissue();
    this.labels_ = new SceneLabels();
    this.light_ = new THREE.DirectionalLight(0xffffff, 0.55);
    const sky = new THREE.HemisphereLight(0xffffff, 0x8f969c, 0.62);
    sky.position.set(0, 0, 1);  // z is up
    this.scene_.add(this.bodies.group, this.tissue_.group, this.marks_.group, sky, this.light_, this.light_.target);
    this.plane_ = new THREE.Plane(new THREE.Vector3(-1, 0, 0), 0);
    this.haste_ = new Haste();
    this.coarse_ = false;
    this.density_ = 1;
    this.gateway_labels_ = [];
    this.own_labels_ = [];
    this.measured_ = new THREE.Group();
    this.scene_.add(this.measured_);
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      lost();
    });
  }

  resize(width, height, density) {
    this.density_ = Math.min(density, kMostDensity);
    this.size_ = [width, height];
    this.set_size_();
    this.camera_.aspect = width / height;
    this.draw_soon();
  }

  set_size_() {
    this.renderer_.setPixelRatio(this.density_ * (this.coarse_ ? kCoarse : 1));
    this.renderer_.setSize(...this.size_, false);
  }

  // A view as of view_math.js; `up` in place of its twist, where a camera of the cell is followed.
  look(view) {
    const {right, up} = picture_axes(view);
    const x = new THREE.Vector3(...right);
    const y = new THREE.Vector3(...up);
    const z = new THREE.Vector3().crossVectors(x, y);
    const at = new THREE.Vector3(...view.viewpoint_m);
    const reach = at.distanceTo(new THREE.Vector3(...view.lookpoint_m));
    const camera = this.camera_;
    camera.matrix.makeBasis(x, y, z).setPosition(at);
    camera.matrixWorldNeedsUpdate = true;
    camera.fov = (view.opening_angle_rad * 180) / Math.PI;
    camera.near = Math.max(0.002, Math.min(0.05, reach / 50));
    camera.far = 100 + 4 * reach;
    camera.updateProjectionMatrix();
    this.light_.position.copy(at).addScaledVector(x, 0.4 * reach).addScaledVector(y, 0.7 * reach);
    this.light_.target.position.set(...view.lookpoint_m);
    this.haste_.turned(performance.now());
    this.draw_soon();
  }

  async load(buffer) {
    const good = await this.bodies.load(buffer);
    this.draw_soon();
    return good;
  }

  place(poses) {
    this.bodies.place(poses.bodies, poses.states);
    this.marks_.place(poses);
    this.draw_soon();
  }

  take_tissue_shape(data) {
    this.tissue_.take_shape(data);
  }

  take_tissue_motion(data) {
    if (this.tissue_.take_motion(data)) this.draw_soon();
  }

  show_marks(marks, line_colour) {
    this.marks_.show(marks, line_colour);
    this.gateway_labels_ = marks.labels ?? [];
    this.labels_.set([...this.own_labels_, ...this.gateway_labels_]);
    this.draw_soon();
  }

  // Colours of the theme, as style sheets give them.
  restyle(ground) {
    this.renderer_.setClearColor(new THREE.Color(ground));
    this.draw_soon();
  }

  select(path) {
    this.bodies.select(path);
    this.draw_soon();
  }

  // What lies behind the plane, on the positive side of `axis` (0, 1, 2) at `at_m`, is not drawn; null: all is drawn. `flipped`:
  // the other side.
  cut(axis, at_m = 0, flipped = false) {
    if (axis === null) {
      this.renderer_.clippingPlanes = [];
    } else {
      const normal = [0, 0, 0];
      normal[axis] = flipped ? 1 : -1;
      this.plane_.normal.set(...normal);
      this.plane_.constant = flipped ? -at_m : at_m;
      this.renderer_.clippingPlanes = [this.plane_];
    }
    this.bodies.open(axis !== null);
    this.draw_soon();
  }

  // {point, path, robot} at a place of the canvas in CSS pixels; null: nothing is there.
  pick(x, y) {
    if (!this.size_) return null;
    const ray = new THREE.Raycaster();
    this.camera_.updateMatrixWorld();
    ray.setFromCamera(new THREE.Vector2((2 * x) / this.size_[0] - 1, 1 - (2 * y) / this.size_[1]), this.camera_);
    this.scene_.updateMatrixWorld();
    const cuts = this.renderer_.clippingPlanes;
    const found = this.bodies.hit(ray, (point) => cuts.every((plane) => plane.distanceToPoint(point) >= 0));
    return found && {point: found.point.toArray(), path: found.body.path, robot: found.body.robot};
  }

  // A line between points with a text at its middle; no points: removes it.
  measure(points, text) {
    for (const old of this.measured_.children) {
      old.geometry.dispose();
      old.material.dispose();
    }
    this.measured_.remove(...this.measured_.children);
    this.own_labels_ = [];
    if (points.length > 0) {
      const geometry = new THREE.BufferGeometry().setFromPoints(points.map((point) => new THREE.Vector3(...point)));
      const look = {color: 0x0072b2, depthTest: false, transparent: true};
      const dots = new THREE.Points(geometry, new THREE.PointsMaterial({...look, size: 8, sizeAttenuation: false}));
      dots.renderOrder = 2;
      this.measured_.add(dots);
      if (points.length > 1) {
        const line = new THREE.Line(geometry, new THREE.LineBasicMaterial(look));
        line.renderOrder = 2;
        this.measured_.add(line);
        const middle = points[0].map((value, i) => (value + points[1][i]) / 2);
        this.own_labels_ = [{at_m: middle, text, mark: "measured"}];
      }
    }
    this.labels_.set([...this.own_labels_, ...this.gateway_labels_]);
    this.draw_soon();
  }

  // Of all bodies: [low, high], or null.
  bounds() {
    this.scene_.updateMatrixWorld();
    const box = this.bodies.bounds();
    return box.isEmpty() ? null : [box.min.toArray(), box.max.toArray()];
  }

  draw_soon() {
    if (this.waiting_) return;
    this.waiting_ = true;
    requestAnimationFrame(() => {
      this.waiting_ = false;
      this.draw();
    });
  }

  draw() {
    if (!this.size_) return;
    const coarse = this.haste_.drawing(performance.now());
    if (coarse !== this.coarse_) {
      this.coarse_ = coarse;
      this.set_size_();
    }
    if (coarse) {
      clearTimeout(this.rest_);
      this.rest_ = setTimeout(() => this.draw_soon(), kRests_ms + 50);  // nothing else may come
    }
    this.camera_.updateMatrixWorld();
    this.renderer_.render(this.scene_, this.camera_);
    this.labels_.place((at_m) => this.on_screen_(at_m));
    this.drawn_();
  }

  on_screen_(at_m) {
    const at = new THREE.Vector3(...at_m).project(this.camera_);
    if (at.z > 1 || Math.abs(at.x) > 1 || Math.abs(at.y) > 1) return null;
    return [((at.x + 1) / 2) * this.size_[0], ((1 - at.y) / 2) * this.size_[1]];
  }

  get hasty() {
    return this.coarse_;
  }

  // Of deformable objects that are drawn.
  get tissue_vertices() {
    return this.tissue_.vertices;
  }

  // Of the last drawing.
  get triangles() {
    return this.renderer_.info.render.triangles;
  }
}
