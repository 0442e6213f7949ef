import assert from "node:assert/strict";
import fs from "node:fs";
import net from "node:net";
import os from "node:os";
import path from "node:path";
import {test} from "node:test";
import {setTimeout as wait} from "node:timers/promises";

import {ask} from "../../../ipc/opcua/src/control_request.mjs";
import {control_socket, runtime_folder} from "../../../ipc/opcua/src/control_socket.mjs";
import {Feed} from "../../../ipc/opcua/src/feed.mjs";
import {status} from "./status_sample.mjs";

// A stand-in for the gateway's socket; `answer(socket)` is called for each request line.
async function with_socket(answer, body) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "cellmirror-opcua-"));
  const place = path.join(folder, "default", "control.sock");
  fs.mkdirSync(path.dirname(place));
  const sockets = new Set();
  const server = net.createServer({allowHalfOpen: true}, (socket) => {
    sockets.add(socket);
    socket.on("error", () => {});
    socket.on("data", () => answer(socket));
  });
  await new Promise((resolve) => server.listen(place, resolve));
  const close = () => {
    for (const socket of sockets) socket.destroy();
    return new Promise((resolve) => server.close(resolve));
  };
  try {
    await body({folder, place, close});
  } finally {
    if (server.listening) await close();
    fs.rmSync(folder, {recursive: true, force: true});
  }
}

async function eventually(condition) {
  for (let i = 0; i < 6000 && !condition(); ++i) await wait(10);
  assert.ok(condition());
}

test("an answer that is cut, no JSON, too long, too late or an error is refused with its reason", async () => {
  for (const [answer, words] of [[(socket) => socket.end('{"robots"'), /truncated/], [(socket) => socket.end("no\n"), /not JSON/], [(socket) => socket.end(`${"x".repeat(5000)}\n`), /more than 1000 bytes/],
    [() => {}, /within 0.3 s/], [(socket) => socket.end('{"error":"not now","remedy":"later"}\n'), /not now/]]) {
    await with_socket(answer, ({place}) => assert.rejects(ask(place, {request: "status"}, {timeout_ms: 300, most_bytes: 1000}), words));
  }
});

test("the folder is found as the gateway's own clients find it", () => {
  assert.equal(runtime_folder({CELLMIRROR_RUNTIME_DIR: "/a/b"}, 5), "/a/b");
  assert.equal(runtime_folder({XDG_RUNTIME_DIR: "/run/user/5"}, 5), "/run/user/5/cellmirror");
  assert.equal(runtime_folder({XDG_RUNTIME_DIR: "relative"}, 5), "/tmp/cellmirror-5");
  assert.equal(runtime_folder({}, 0), "/run/cellmirror");
  assert.throws(() => runtime_folder({CELLMIRROR_RUNTIME_DIR: "relative"}, 5), /absolute/);
});

test("a socket or folder of another user, a link and a file are refused", async () => {
  await with_socket(() => {}, async ({folder, place}) => {
    const environment = {CELLMIRROR_RUNTIME_DIR: folder};
    const me = process.geteuid();
    assert.equal(await control_socket("default", environment, me), place);
    if (me !== 0) await assert.rejects(control_socket("default", environment, me + 1), /belongs to user/);
    await assert.rejects(control_socket("other", environment, me), /no gateway of the instance other/);
    fs.writeFileSync(path.join(folder, "file"), "");
    await assert.rejects(control_socket("default", {CELLMIRROR_RUNTIME_DIR: path.join(folder, "file")}, me), /not a folder/);
    fs.symlinkSync(folder, path.join(folder, "link"));
    await assert.rejects(control_socket("default", {CELLMIRROR_RUNTIME_DIR: path.join(folder, "link")}, me), /not a folder/);
  });
});

class Heard {
  reported = [];
  report(image) {
    this.reported.push(image.robots.length);
  }
  report_late() {
    this.reported.push("late");
  }
  report_gone() {
    this.reported.push("gone");
  }
}

async function with_feed(folder, limits, body) {
  process.env.CELLMIRROR_RUNTIME_DIR = folder;
  const cell = new Heard();
  const lines = [];
  const feed = new Feed({instance: "default", period_ms: 50, cell, say: (line) => lines.push(line), limits});
  const running = feed.run();
  try {
    await body({cell, lines});
  } finally {
    feed.end();
    await running;
    delete process.env.CELLMIRROR_RUNTIME_DIR;
  }
}

test("a gateway that answers, goes and comes back is reported as that, and the log names each change once", async () => {
  let says = () => status();
  await with_socket((socket) => socket.end(`${JSON.stringify(says())}\n`), async ({folder}) => {
    await with_feed(folder, {first_pause_ms: 20, longest_pause_ms: 40}, async ({cell, lines}) => {
      await eventually(() => cell.reported.filter((one) => one === 1).length >= 3);
      says = () => ({error: "it starts", remedy: "wait"});
      await eventually(() => cell.reported.filter((one) => one === "gone").length >= 3);
      says = () => status([]);
      await eventually(() => cell.reported.includes(0));
      assert.deepEqual(lines, ["the gateway default answers: 1 robots", "the gateway default is not shown: it starts; wait", "the gateway default answers: 0 robots"]);
    });
  });
});

test("a gateway that does not answer is late first, then gone", async () => {
  await with_socket(() => {}, async ({folder}) => {
    await with_feed(folder, {longest_answer_ms: 1500}, async ({cell}) => {
      await eventually(() => cell.reported.includes("gone"));
      assert.equal(cell.reported[0], "late");
    });
  });
});
