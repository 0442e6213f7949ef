// What the console offers and explains.
import test from "node:test";
import assert from "node:assert/strict";
import * as sut from "./modules/completion.js";

const commands = [
  {name: "ROBOT", syntax: "ROBOT <Robot_id> [online | offline]", kind: "command", help: "follows", parameters: [{name: "Robot_id", meaning: "robot"}]},
  {name: "ROBOT", syntax: "ROBOT <Robot_id> [send_on | send_off]", kind: "command", help: "sends", parameters: []},
  {name: "ROBACT", syntax: "ROBACT <Robot_id>", kind: "command", help: "activates", parameters: []},
  {name: "POS_ROB", syntax: "POS_ROB <Robot_id> JOINT_ABS <j1> ... <jn>", kind: "command", help: "joints", parameters: []},
  {name: "POS_ROB", syntax: "POS_ROB <Robot_id> FRAME_INC [X x] [Y y]", kind: "command", help: "frame", parameters: []},
  {name: "LEVEL_DOWN", syntax: "LEVEL_DOWN <frame_node>", kind: "command", help: "detail", parameters: []},
  {name: "COVW", syntax: "COVW <view_id> <cam_id>", kind: "command", help: "camera", parameters: [], missing: "a later issue"},
  {name: "LOAD_VIEWS", syntax: "LOAD_VIEWS <view_filename>", kind: "command", help: "views", parameters: []},
  {name: "#", syntax: "# text", kind: "convention", help: "comment", parameters: []},
];
const names = {robots: ["PUMA_762", "MANTEC_R3"], frames: ["Cell.Table", "Puma.J_1"], cameras: ["CAMERA_5"], views: ["gate.vws"]};
const offered = (text) => sut.completions(text, text.length, commands, names).map(({text: word}) => word);

test("commands come first, each once, without regard to case", () => {
  assert.deepEqual(offered("rob"), ["ROBOT", "ROBACT", "POS_ROB"]);
});

test("conventions are not offered", () => assert.ok(!offered("").includes("#")));

test("names are of the kind that is wanted there", () => {
  assert.deepEqual(offered("ROBOT "), ["PUMA_762", "MANTEC_R3"]);
  assert.deepEqual(offered("LEVEL_DOWN ").sort(), ["Cell.Table", "Puma.J_1"]);
  assert.deepEqual(offered("COVW 0 "), ["CAMERA_5"]);
  assert.deepEqual(offered("LOAD_VIEWS "), ["gate.vws"]);
});

test("a part of a name is enough", () => assert.deepEqual(offered("LEVEL_DOWN table"), ["Cell.Table"]));

test("choices of all forms are offered", () => {
  assert.deepEqual(offered("ROBOT PUMA_762 "), ["online", "offline", "send_on", "send_off"]);
  assert.deepEqual(offered("POS_ROB PUMA_762 "), ["JOINT_ABS", "FRAME_INC"]);
});

test("groups in any order stay on offer", () => assert.ok(offered("POS_ROB PUMA_762 FRAME_INC X 1 ").includes("Y")));

test("what is complete is not offered again", () => assert.deepEqual(offered("ROBACT PUMA_762"), []));

test("a choice replaces the word at the cursor", () => {
  assert.deepEqual(sut.completed("ROBOT PU online", 8, "PUMA_762"), {text: "ROBOT PUMA_762 online", cursor: 15});
  assert.deepEqual(sut.completed("rob", 3, "ROBOT"), {text: "ROBOT ", cursor: 6});
});

test("help follows the cursor and says what is missing", () => {
  const help = sut.help_for("ROBOT P", 7, commands);
  assert.equal(help.parts.find(({here}) => here).text, "<Robot_id>");
  assert.match(help.note, /here: robot/);
  assert.match(sut.help_for("COVW 1 ", 7, commands).note, /not there yet/);
  assert.equal(sut.help_for("", 0, commands), null);
});

test("words that fix a form choose it", () => {
  assert.equal(sut.help_for("POS_ROB PUMA_762 FRAME_INC ", 27, commands).help, "frame");
});

test("hostile text is only text", () => {
  for (const text of ["<[({", "[[[[", "\u0000 a", " ".repeat(1000), "ROBOT <img src=x>"]) assert.ok(Array.isArray(offered(text)));
});
