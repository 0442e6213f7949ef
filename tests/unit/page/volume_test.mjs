// What the panel of voxel volumes says and sends.
import test from "node:test";
import assert from "node:assert/strict";
import {Newest, histogram_path, parameter_command, parameters_of, plane_commands, position_command, surface_command, table_command, volume_text} from "./modules/volume.js";

test("commands are those of SCRIPT, with a volume's name where one was chosen", () => {
  assert.equal(table_command("RAINBOW_LUT", ""), "VV_SET_LUT RAINBOW_LUT");
  assert.equal(table_command("RAINBOW_LUT", "table.head"), "VV_SET_LUT RAINBOW_LUT table.head");
  assert.equal(parameter_command("MEDICAL_LUT", [0, 0.1, 0.30000000000000004, 1], ""), "VV_SET_LUT_PAR MEDICAL_LUT 0 0.1 0.3 1");
  assert.equal(position_command("CLP2", {elevation: -90, azimuth: 45.04, distance: -12.5}, "ct"), "VV_CLIP_POS CLP2 ELE -90 AZI 45 DIST -12.5 ct");
  assert.equal(surface_command(true, -300, ""), "VV_ISO on VALUE -300");
  assert.equal(surface_command(false, 300, "ct"), "VV_ISO off VALUE 300 ct");
});

test("a plane takes no more commands than it needs", () => {
  const commands = (now, wanted) => plane_commands("CLP1", now, wanted, "");
  const off = {side: "off", framed: false};
  assert.deepEqual(commands(off, off), []);
  assert.deepEqual(commands(off, {side: "active", framed: false}), ["VV_CLIP CLP1 active"]);
  assert.deepEqual(commands({side: "active", framed: true}, {side: "reverse", framed: true}), ["VV_CLIP CLP1 reverse"]);
  assert.deepEqual(commands({side: "active", framed: false}, {side: "active", framed: true}), ["VV_CLIP CLP1 visible"]);
  assert.deepEqual(commands({side: "active", framed: true}, {side: "active", framed: false}), ["VV_CLIP CLP1 off", "VV_CLIP CLP1 active"]);
  assert.deepEqual(commands({side: "active", framed: true}, {side: "off", framed: true}), ["VV_CLIP CLP1 off", "VV_CLIP CLP1 visible"]);
  assert.deepEqual(plane_commands("CLP6", {side: "active", framed: true}, off, "ct"), ["VV_CLIP CLP6 off ct"]);
});

test("sliders have the ranges of the manual", () => {
  assert.deepEqual(parameters_of("MEDICAL_LUT").map(({name, low, high}) => [name, low, high]),
    [["air", 0, 1], ["fat", 0, 1], ["tissue", 0, 1], ["bone", 0, 1]]);
  assert.deepEqual(parameters_of("USER2_LUT").map(({name, low, high}) => [name, low, high]),
    [["opacity", 0, 3], ["gain", 0, 20], ["level", 1, 3], ["window", 0, 1.57]]);
});

test("the histogram is as high as the logarithm of the counts", () => {
  assert.equal(histogram_path([0, 99, 9], 3, 10), "M0 10L0 10L1 10L1 0L2 0L2 5L3 5L3 10Z");
  assert.equal(histogram_path([0, 0], 2, 10), "M0 10L0 10L1 10L1 10L2 10L2 10Z");
});

test("a volume says its size, and what is unusual", () => {
  const volume = {shown: true, isosurface: false, iso_value: 300};
  const content = {voxels: [512, 512, 1024], unit: "HU"};
  assert.equal(volume_text(volume, content), "512 × 512 × 1\u202f024 voxels");
  assert.equal(volume_text({...volume, shown: false, isosurface: true}, content), "512 × 512 × 1\u202f024 voxels, hidden, isosurface at 300 HU");
  assert.equal(volume_text(volume, undefined), "");
});

test("while a command is under way only the newest of the next is kept", async () => {
  const sent = [];
  const answers = [];
  const newest = new Newest((command) => new Promise((answer) => {
    sent.push(command);
    answers.push(answer);
  }));
  const first = newest.want("1");
  newest.want("2");
  newest.want("3");
  assert.deepEqual(sent, ["1"]);
  answers[0]();
  await new Promise((later) => setTimeout(later));
  assert.deepEqual(sent, ["1", "3"]);
  answers[1]();
  await first;
  assert.deepEqual(sent, ["1", "3"]);
});
