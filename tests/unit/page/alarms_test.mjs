import assert from "node:assert/strict";
import test from "node:test";
import {alarms_in_brief, state_text} from "./modules/alarms.js";
import {commands_of} from "./modules/presence.js";
import {name_word, shown_name} from "./modules/user_name.js";

test("the head counts what nobody has acknowledged", () => {
  assert.equal(alarms_in_brief(undefined), null, "an older gateway");
  assert.equal(alarms_in_brief({unacknowledged: 0, active: 3, highest_priority: null}), null);
  assert.deepEqual(alarms_in_brief({unacknowledged: 1, highest_priority: "low"}), {text: "1 alarm", state: "stale"});
  assert.deepEqual(alarms_in_brief({unacknowledged: 2, highest_priority: "high"}), {text: "2 alarms", state: "lost"});
});

test("a state is told in words", () => {
  const time = "2026-11-24T05:00:00.000Z";
  const now_s = Date.parse(time) / 1000;
  const alarm = {time, first_time: time, occurrences: 1, cleared_time: null, acknowledged_time: null, acknowledged_by: ""};
  assert.equal(state_text(alarm, now_s + 0.2), "active now");
  assert.equal(state_text(alarm, now_s + 72.9), "active for 1 min 12 s");
  assert.match(state_text({...alarm, occurrences: 3}, now_s), /^active now, 3 times since \d\d:\d\d:\d\d$/);
  assert.match(state_text({...alarm, cleared_time: time}, now_s), /^over since \d\d:\d\d:\d\d$/);
  assert.match(state_text({...alarm, acknowledged_time: time, acknowledged_by: "Ada_Lovelace"}, now_s + 5),
    /^active for 5\.0 s; acknowledged by Ada Lovelace at \d\d:\d\d:\d\d$/);
});

test("a name is one word that SCRIPT takes", () => {
  assert.equal(name_word("Ada"), "Ada");
  assert.equal(name_word(" Åsa  Berg; STOP_ALL"), "Åsa_Berg_STOP_ALL");
  assert.equal(name_word("12 Ada"), "Ada");
  assert.equal(name_word("a,b\n#c"), "a_b_c");
  assert.equal(name_word("12"), "");
  assert.equal(name_word(null), "");
  assert.ok(new TextEncoder().encode(name_word("é".repeat(60))).length <= 64);
  assert.equal(shown_name("Ada_Lovelace"), "Ada Lovelace");
});

test("the banner names the service of this gateway", () => {
  assert.deepEqual(commands_of("default"), {status: "cellmirror status", start: "cellmirror run"});
  assert.deepEqual(commands_of("press"), {status: "cellmirror status --instance press", start: "systemctl start cellmirror@press"});
});
