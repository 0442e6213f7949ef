import assert from "node:assert/strict";
import {test} from "node:test";

import {session_to_close} from "../../../ipc/opcua/src/session_room.mjs";

const at = (address, silent_ms) => ({address, silent_ms});

test("no session is closed while there is a free place", () => {
  assert.equal(session_to_close([], 3), null);
  assert.equal(session_to_close([at("a", 1), at("a", 2)], 3), null);
});

test("the session that was silent for the longest time is closed, never the new one", () => {
  const sessions = [at("a", 1), at("a", 5), at("a", 9)];
  assert.equal(session_to_close(sessions, 3), sessions[1]);
  assert.equal(session_to_close([at("a", 1)], 1), null);
});

test("a client with many sessions does not push out another machine", () => {
  const sessions = [at("plant", 99), at("x", 1), at("x", 6), at("x", 0)];
  assert.equal(session_to_close(sessions, 4), sessions[2]);
  const fresh = [at("x", 6), at("x", 7), at("plant", 0)];
  assert.equal(session_to_close(fresh, 3), fresh[1]);
});
