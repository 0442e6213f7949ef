// The 3D mode of the view: when it is on, who draws, what comes for it. Without WebGL the pictures of the gateway stay.
import {byId, setText, setAttribute} from "./dom.js";
import {decode_poses, twist_of, view_of_camera} from "./scene_format.js";
import {SceneTools} from "./scene_tools.js";
import {watch_gestures} from "./gestures.js";
import * as math from "./view_math.js";

const kKey = "cellmirror.view_mode";
const kSoftware = /swiftshader|llvmpipe|softpipe|software|basic render/i;  // names of renderers without a graphics card
const kLost = "The graphics system has stopped WebGL: the gateway's pictures are shown. Load the page again for 3D.";
const kFetchAgain_ms = 400;

// `quick`: not by a software renderer, which is no better than the gateway's pictures unless the user asks for it.
export function webgl_is_there(quick = false) {
  try {
    const context = document.createElement("canvas").getContext("webgl", {failIfMajorPerformanceCaveat: quick});
    const names = context?.getExtension("WEBGL_debug_renderer_info");
    const name = names ? String(context.getParameter(names.UNMASKED_RENDERER_WEBGL)) : "";
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return Boolean(context) && !(quick && kSoftware.test(name));
  } catch {
    return false;
  }
}

function stored() {
  try {
    return localStorage.getItem(kKey);
  } catch {
    return null;
  }
}

function store(mode) {
  try {
    localStorage.setItem(kKey, mode);
  } catch {
    // Then the choice lasts as long as the page.
  }
}

export class SceneMode {
  // `view`: LiveView; `picked(found)`: as of a picture; `selected(path)`: a body was picked, null: none; `changed()`: the mode is
  // another one.
  constructor({connection, view, picked, selected, changed}) {
    this.connection_ = connection;
    this.view_ = view;
    this.picked_ = picked;
    this.selected_ = selected;
    this.changed_ = changed;
    this.canvas_ = byId("scene-canvas");
    this.area_ = byId("view-area");
    this.on_ = false;
    this.scene_ = null;     // SceneView, once there is one
    this.geometry_ = null;  // hash of what is loaded
    this.camera_names_ = [];
    this.tools_ = new SceneTools({mode: this});
    watch_gestures(this.canvas_, view.hand((x, y) => this.pick_(x, y)));
    new ResizeObserver(() => this.resize_()).observe(this.area_);
    byId("mode-scene").addEventListener("click", () => this.choose("scene"));
    byId("mode-picture").addEventListener("click", () => this.choose("picture"));
    byId("scene-picture").addEventListener("click", () => this.choose("picture"));
    document.addEventListener("visibilitychange", () => this.ask_());
    connection.on("opened", () => this.ask_());
    connection.on("poses", (data) => this.take_(data));
    connection.on("tissue_shape", (data) => this.scene_?.take_tissue_shape(data));
    connection.on("tissue_motion", (data) => this.on_ && this.scene_.take_tissue_motion(data));
    connection.on("marks", (marks) => this.take_marks_(marks));
    view.follow((choice, otherwise) => this.start_of_view_(choice, otherwise));
    this.show_mode_();
  }

  get mode() {
    return this.on_ ? "scene" : "picture";
  }

  // As the user chose it; null: not yet.
  get chosen() {
    return this.chosen_ ?? null;
  }

  // The renderer is slower than the hand that turns the view.
  get hasty() {
    return this.on_ && this.scene_.hasty;
  }

  get scene() {
    return this.on_ ? this.scene_ : null;
  }

  // By the address, else as chosen before, else 3D where it is drawn by a graphics card.
  begin(wanted) {
    if (wanted) this.chosen_ = wanted;
    const mode = wanted ?? stored() ?? (webgl_is_there(true) ? "scene" : "picture");
    this.set_(mode, wanted === "scene");
  }

  choose(mode) {
    store(mode);
    this.chosen_ = mode;
    this.set_(mode, true);
  }

  // `say`: where it cannot be had, a note tells why.
  async set_(mode, say) {
    this.wanted_ = mode;
    const on = mode === "scene" && (await this.prepare_(say));
    if (this.wanted_ !== mode) return;  // another one was chosen meanwhile
    if (on !== this.on_) this.switch_(on);
    this.show_mode_();
  }

  switch_(on) {
    this.on_ = on;
    this.area_.classList.toggle("in-scene", this.on_);
    this.view_.show_pictures(this.pictures_());
    this.ask_();
    this.resize_();
    this.looked_ = "";
    this.look();
    this.changed_();
  }

  // Voxel volumes are cast by the gateway alone: where there are some, its picture from the same viewpoint is shown in a corner.
  pictures_() {
    if (!this.on_) return "whole";
    return this.marks_?.volumes > 0 ? "beside" : "none";
  }

  async prepare_(say) {
    if (this.scene_ && !this.lost_context_) return true;
    const refuse = (why) => {
      this.problem_ = say ? why : "";
      this.show_mode_();
      return false;
    };
    if (this.lost_context_) return refuse(kLost);
    if (!webgl_is_there()) return refuse("3D needs WebGL, which this browser does not have or has switched off: the gateway's pictures are shown.");
    try {
      const {SceneView} = await import("./scene_view.js");
      this.scene_ ??= new SceneView(this.canvas_, {lost: () => this.lost_(), drawn: () => this.drawn_()});
    } catch (error) {
      return refuse(`3D cannot be drawn here (${error.message}): the gateway's pictures are shown.`);
    }
    this.problem_ = "";
    this.restyle();
    return true;
  }

  lost_() {
    this.lost_context_ = true;
    this.problem_ = kLost;
    this.set_("picture", false);
  }

  show_mode_() {
    for (const [id, mode] of [["mode-scene", "scene"], ["mode-picture", "picture"]]) {
      setAttribute(byId(id), "aria-pressed", String(this.mode === mode));
    }
    this.canvas_.hidden = !this.on_;
    byId("view-canvas").hidden = this.pictures_() === "none";
    this.area_.classList.toggle("with-inset", this.pictures_() === "beside");
    byId("scene-labels").hidden = !this.on_;
    this.tools_.show(this.on_);
    const note = this.pictures_() === "beside" ? "Voxel volumes are only in the gateway's picture: see the corner." : this.problem_ ?? "";
    setText(byId("scene-note-text"), note);
    byId("scene-note").hidden = note === "";
    byId("scene-picture").hidden = !this.on_;
  }

  // Asks for poses, or ends them; the gateway makes none for a page that nobody sees.
  ask_() {
    this.connection_.send({do: this.on_ && !document.hidden ? "scene" : "no_scene"});
  }

  resize_() {
    const [width, height] = [this.area_.clientWidth, this.area_.clientHeight];
    if (this.on_ && width > 1 && height > 1) this.scene_.resize(width, height, window.devicePixelRatio || 1);
  }

  restyle() {
    this.scene_?.restyle(getComputedStyle(this.area_).backgroundColor);
    if (this.scene_ && this.marks_) this.scene_.show_marks(this.marks_, this.line_colour_());
  }

  line_colour_() {
    return getComputedStyle(byId("scene-labels")).borderTopColor;  // of the theme, resolved
  }

  take_(data) {
    const poses = decode_poses(data);
    if (!poses) return;
    this.connection_.send({do: "posed", sequence: poses.sequence});
    if (!this.on_) return;
    this.poses_ = poses;
    if (poses.geometry !== this.geometry_) {
      this.fetch_(poses.geometry);
      return;
    }
    this.place_(poses);
    if (this.view_.choice.kind === "camera") this.look();
    performance.mark("cellmirror.poses");
    performance.clearMarks("cellmirror.poses");
  }

  place_(poses) {
    if (!this.readable_) {
      this.view_.report("the geometry of the cell cannot be read");
      return;
    }
    this.scene_.place(poses);
    this.view_.shown_now(poses.age_s, poses.sequence);
  }

  // One at a time; where the file is another one than the poses want, newer poses ask again.
  async fetch_() {
    if (this.fetching_) return;
    this.fetching_ = true;
    try {
      const answer = await fetch("scene.glb", {cache: "no-cache"});
      if (!answer.ok) throw new Error(String(answer.status));
      const hash = (answer.headers.get("ETag") ?? "").replace(/\W/g, "");
      const good = await this.scene_.load(await answer.arrayBuffer());
      this.readable_ = good;
      this.geometry_ = hash;
      if (this.poses_?.geometry === hash && this.on_) {
        this.place_(this.poses_);
        this.tools_.loaded();
      } else {
        await pause(kFetchAgain_ms);
      }
    } catch (error) {
      this.view_.report(`the geometry of the cell did not come (${error.message})`);
      await pause(kFetchAgain_ms);
    }
    this.fetching_ = false;
  }

  take_marks_(marks) {
    this.marks_ = marks;
    this.camera_names_ = marks.cameras ?? [];
    if (this.scene_) this.scene_.show_marks(marks, this.line_colour_());
    this.view_.show_pictures(this.pictures_());
    this.show_mode_();
  }

  // Where a movement by hand begins, and what is looked at: a camera as it is now, else what the view says.
  start_of_view_(choice, otherwise) {
    if (!this.on_ || choice.kind !== "camera" || !this.poses_) return otherwise;
    const seen = view_of_camera(this.poses_.cameras, this.camera_names_.indexOf(choice.name));
    if (!seen) return otherwise;
    const {up, ...view} = seen;
    return {...view, twist_rad: twist_of(up, math.picture_axes(view))};
  }

  look() {
    if (!this.on_) return;
    const view = this.view_.current_view();
    const text = JSON.stringify(view);
    if (text === this.looked_) return;  // nothing is drawn for nothing
    this.looked_ = text;
    this.scene_.look(view);
  }

  // All that lies between the corners, from where the eye looks now.
  fit(low, high) {
    this.view_.move((view) => math.fitted(view, low, high));
  }

  select(path) {
    this.scene_?.select(path);
  }

  pick_(x, y) {
    if (!this.on_) return;
    const found = this.scene_.pick(x, y);
    if (this.tools_.takes(found)) return;
    this.picked_({x, y, path: found?.path ?? null, robot: found?.robot ?? "", text: ""});
    this.selected_(found?.path ?? null);
  }

  // For observers: what was drawn last.
  drawn_() {
    if (this.poses_) setAttribute(this.canvas_, "data-sequence", this.poses_.sequence);
    setAttribute(this.canvas_, "data-triangles", this.scene_.triangles);
    setAttribute(this.canvas_, "data-tissue", this.scene_.tissue_vertices);
    performance.mark("cellmirror.scene");
    performance.clearMarks("cellmirror.scene");
  }
}

function pause(ms) {
  return new Promise((resolve) => setTimeout(resolve, ms));
}
