// Orbit, pan and zoom of a view; expected values are from geometry on paper.
import test from "node:test";
import assert from "node:assert/strict";
import * as sut from "./modules/view_math.js";

const near = (actual, expected, tolerance = 1e-9) =>
  actual.forEach((value, i) => assert.ok(Math.abs(value - expected[i]) < tolerance, `${actual} is not ${expected}`));

const view = {viewpoint_m: [0, -5, 0], lookpoint_m: [0, 0, 0], twist_rad: 0, opening_angle_rad: Math.PI / 2};

test("an orbit by a quarter goes round z at the same distance", () => {
  near(sut.orbit(view, Math.PI / 2, 0).viewpoint_m, [5, 0, 0]);
});

test("an orbit never goes over the top", () => {
  const steep = sut.orbit(view, 0, 10);
  assert.ok(steep.viewpoint_m[2] < 5 && steep.viewpoint_m[2] > 4.9);
  assert.ok(Math.abs(sut.distance(steep) - 5) < 1e-9);
});

test("a touch does not turn a picture from straight above or below", () => {
  // rt_core/cell/view.cpp: up in such a picture is the world's y axis.
  for (const [height, right, up] of [[5, [1, 0, 0], [0, 1, 0]], [-5, [-1, 0, 0], [0, 1, 0]]]) {
    const steep = {...view, viewpoint_m: [0, 0, height]};
    near(sut.picture_axes(steep).right, right);
    near(sut.picture_axes(steep).up, up);
    const touched = sut.picture_axes(sut.orbit(steep, 0, 0));
    near(touched.right, right);
    near(touched.up, up, 0.02);
  }
});

test("an orbit leaves the lookpoint alone", () => {
  const moved = {...view, viewpoint_m: [1, -4, 3], lookpoint_m: [1, 1, 3]};
  near(sut.orbit(moved, 1, 0.3).lookpoint_m, [1, 1, 3]);
});

test("a pan to the right moves both points to the left", () => {
  // The picture is 10 m high at the lookpoint: 2 * 5 * tan(45 deg).
  const moved = sut.pan(view, 0.1, 0);
  near(moved.viewpoint_m, [-1, -5, 0]);
  near(moved.lookpoint_m, [-1, 0, 0]);
});

test("a pan downwards moves both points up", () => {
  near(sut.pan(view, 0, 0.1).lookpoint_m, [0, 0, 1]);
});

test("a twisted view pans along its own axes", () => {
  const twisted = {...view, twist_rad: Math.PI / 2};
  near(sut.picture_axes(twisted).right, [0, 0, 1]);
});

test("a zoom changes the distance only, and within bounds", () => {
  near(sut.zoom(view, 0.5).viewpoint_m, [0, -2.5, 0]);
  assert.ok(sut.distance(sut.zoom(view, 1e-9)) >= 0.05 - 1e-12);
  assert.ok(sut.distance(sut.zoom(view, 1e9)) <= 500 + 1e-9);
});

test("a view that is impossible becomes the home view", () => {
  for (const broken of [null, {}, {viewpoint_m: [1, 2, 3], lookpoint_m: [1, 2, 3]}, {viewpoint_m: [NaN, 0, 0], lookpoint_m: [0, 0, 0]}]) {
    assert.deepEqual(sut.sound_view(broken), structuredClone(sut.kHomeView));
  }
});

test("the command has millimetres and degrees", () => {
  assert.equal(sut.as_command(view, 3, 2), "STVW 3 VP 0.0 -5000.0 0.0 LP 0.0 0.0 0.0 TW 0.00 VA 90.00 TIME 2");
});
