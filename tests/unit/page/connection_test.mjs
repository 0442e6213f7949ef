// The connection against a socket that does what the test says.
import test from "node:test";
import assert from "node:assert/strict";
import {Connection, pause_after, subprotocols} from "./modules/connection.js";

class FakeSocket {
  static made = [];
  constructor(address, protocols) {
    this.address = address;
    this.protocols = protocols;
    this.sent = [];
    FakeSocket.made.push(this);
  }
  send(text) {
    this.sent.push(JSON.parse(text));
  }
  close() {}
}

function started(context, token = "secret") {
  const timers = ["setTimeout", "setInterval"];
  const before_20 = Number(process.versions.node.split(".")[0]) < 20;  // Debian 12's node took the bare list
  context.mock.timers.enable(before_20 ? timers : {apis: timers});
  FakeSocket.made = [];
  const sut = new Connection("ws://here/live", () => token, FakeSocket);
  sut.start();
  return {sut, socket: FakeSocket.made[0]};
}

test("it says hello with the token when it opens", (context) => {
  const {socket} = started(context);
  socket.onopen();
  assert.deepEqual(socket.sent, [{do: "hello", token: "secret"}]);
});

test("it opens with the token where there is one", (context) => {
  const token = "0123456789abcdef0123456789abcdef";
  assert.deepEqual(started(context, token).socket.protocols, ["cellmirror.live", `cellmirror.token.${token}`]);
  for (const none of [null, "", "secret", "a b", token.toUpperCase()]) assert.deepEqual(subprotocols(none), []);
});

test("an answer finds the one who asked", async (context) => {
  const {sut, socket} = started(context);
  socket.onopen();
  const first = sut.ask({do: "command", text: "A"});
  const second = sut.ask({do: "command", text: "B"});
  const [a, b] = socket.sent.slice(1);
  socket.onmessage({data: JSON.stringify({is: "reply", id: b.id, done: true, text: ""})});
  socket.onmessage({data: JSON.stringify({is: "refused", id: a.id, text: "why"})});
  assert.equal((await second).done, true);
  assert.deepEqual([(await first).done, (await first).text], [false, "why"]);
});

test("who asks a gateway that is not there is told so", async (context) => {
  const {sut} = started(context);
  assert.match((await sut.ask({do: "command", text: "A"})).text, /no connection/);
});

test("when the gateway goes away, open questions are answered and it tries again", async (context) => {
  const {sut, socket} = started(context);
  let pause = null;
  sut.on("closed", ({retry_s}) => (pause = retry_s));
  socket.onopen();
  const asked = sut.ask({do: "command", text: "A"});
  socket.onclose();
  assert.match((await asked).text, /not known/);
  assert.equal(FakeSocket.made.length, 1);
  context.mock.timers.tick(pause * 1000 + 1);
  assert.equal(FakeSocket.made.length, 2);
});

test("what is not JSON is passed over", (context) => {
  const {socket} = started(context);
  socket.onopen();
  socket.onmessage({data: "no JSON"});
});

test("pauses grow up to a limit", () => {
  const pauses = [0, 1, 2, 3, 4, 5, 50].map((failures) => pause_after(failures, () => 0.5));
  assert.deepEqual(pauses, [0.5, 1, 2, 4, 8, 8, 8]);
});
