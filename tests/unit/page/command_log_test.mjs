import assert from "node:assert/strict";
import test from "node:test";
import {source_text} from "./modules/command_log.js";

test("who sent a command is told in a few words", () => {
  assert.equal(source_text({source: "message", process: 12, user: 1000}), "process 12 of uid 1000");
  assert.equal(source_text({source: "message", process: 12}), "process 12");
  assert.equal(source_text({source: "message"}), "a message");
  assert.equal(source_text({source: "page", session: 3, peer: "uid 1000"}), "page session 3, uid 1000");
  assert.equal(source_text({source: "file", place: "scripts/a.spt:12"}), "scripts/a.spt:12");
  assert.equal(source_text({source: "program", place: "K1/BOX.src:3"}), "K1/BOX.src:3");
  assert.equal(source_text({}), "");
});
