// Texts of the page without a connection, and in a replay.
import assert from "node:assert/strict";
import test from "node:test";
import {Presence} from "./modules/presence.js";

// Enough of a document for the parts that Presence writes into.
function stand_in() {
  const nodes = new Map();
  const make = () => {
    const classes = new Set();
    const attributes = new Map();
    return {hidden: true, textContent: "", open: false, addEventListener() {}, close() {}, showModal() {},
      classList: {add: (one) => classes.add(one), remove: (one) => classes.delete(one), contains: (one) => classes.has(one),
        toggle: (one, on) => (on ? classes.add(one) : classes.delete(one))},
      hasAttribute: (name) => attributes.has(name), getAttribute: (name) => attributes.get(name) ?? null,
      setAttribute: (name, value) => attributes.set(name, String(value)), removeAttribute: (name) => attributes.delete(name)};
  };
  const node = (id) => {
    if (!nodes.has(id)) nodes.set(id, make());
    return nodes.get(id);
  };
  globalThis.document = {getElementById: node, documentElement: node("html"), title: ""};
  globalThis.setInterval = () => 0;
  return node;
}

function made(answer) {
  const node = stand_in();
  const handlers = new Map();
  const connection = {open: false, start() {}, hello() {}, on: (kind, handler) => handlers.set(kind, handler)};
  const sut = new Presence(connection, {fetch: answer});
  return {node, connection, sut, emit: (kind, what = {}) => handlers.get(kind)(what)};
}

const turn = () => new Promise((resolve) => setImmediate(resolve));
const line = (node) => [node("line-text").textContent, node("line-badge").getAttribute("data-state")];

test("a refused page says that the gateway accepts no further page", async () => {
  const {node, emit} = made(async () => ({status: 200}));
  emit("closed", {retry_s: 1});
  await turn();
  assert.equal(node("gone").hidden, false);
  assert.equal(node("gone-title").textContent, "The gateway accepts no further page.");
  assert.equal(node("gone-full").hidden, false);
  assert.equal(node("gone-help").hidden, true);
  assert.deepEqual(line(node), ["too many pages", "lost"]);
});

test("the page reports the gateway as gone only if nothing answers", async () => {
  const {node, connection, emit} = made(async () => {
    throw new TypeError("refused");
  });
  connection.open = true;
  emit("opened");
  connection.open = false;
  emit("closed", {retry_s: 1});
  await turn();
  assert.equal(node("gone-title").textContent, "The gateway is gone.");
  assert.equal(node("gone-full").hidden, true);
  assert.equal(node("gone-help").hidden, false);
});

test("a page that lost its connection does not claim that there are too many pages", async () => {
  const {node, connection, emit} = made(async () => ({status: 200}));
  connection.open = true;
  emit("opened");
  connection.open = false;
  emit("closed", {retry_s: 1});
  await turn();
  assert.equal(node("gone-title").textContent, "The gateway is gone.");
});

test("an answer other than 200 does not mean that there are too many pages", async () => {
  for (const status of [429, 502, 503]) {
    const {node, emit} = made(async () => ({status}));
    emit("closed", {retry_s: 1});
    await turn();
    assert.equal(node("gone-title").textContent, "There is no connection to the gateway.", String(status));
  }
});

test("a replay is not shown as a live cell", () => {
  const {node, connection, sut, emit} = made(async () => ({status: 200}));
  connection.open = true;
  emit("opened");
  assert.deepEqual(line(node), ["connecting", "none"], "no data has arrived yet");
  sut.live({cell: "c", replay: {state: "playing"}});
  sut.show_line_();
  assert.deepEqual(line(node), ["replay, not live", "replay"]);
  assert.equal(node("html").classList.contains("replay"), true);
  sut.live({cell: "c"});
  sut.show_line_();
  assert.deepEqual(line(node), ["live", "fresh"]);
  assert.equal(node("html").classList.contains("replay"), false);
});
