import assert from "node:assert/strict";
import {test} from "node:test";

import {is_loopback, kHelp, parse} from "../../../ipc/opcua/src/command_line.mjs";
import {nameplates_of} from "../../../ipc/opcua/src/nameplates.mjs";
import {escaped, node_id} from "../../../ipc/opcua/src/node_ids.mjs";

test("by default it listens on this machine only, unencrypted too", () => {
  const options = parse([]);
  assert.deepEqual([options.instances, options.bind, options.port, options.period_ms, options.unencrypted, options.loopback], [["default"], "127.0.0.1", 4840, 100, true, true]);
});

test("beyond this machine it is encrypted unless asked otherwise", () => {
  for (const address of ["0.0.0.0", "192.168.7.10"]) {
    const options = parse(["--bind", address]);
    assert.deepEqual([options.unencrypted, options.loopback], [false, false]);
    assert.equal(parse(["--bind", address, "--allow-unencrypted"]).unencrypted, true);
  }
  assert.ok(is_loopback("127.8.0.1") && is_loopback("localhost") && !is_loopback("127.evil.example") && !is_loopback("128.0.0.1"));
});

test("what cannot be meant is refused with its option", () => {
  for (const [args, words] of [[["--port", "0"], /--port 0/], [["--port", "1e3"], /--port 1e3/], [["--period", "1"], /--period 1 .*50 to 10000/], [["--bind", "::"], /--bind ::/], [["--bind", "1.2.3.400"], /IPv4/],
    [["--instance", "../x"], /instance/], [["--hostname", "a b"], /--hostname/], [["--nonsense"], /nonsense/], [["stray"], /stray/]]) {
    assert.throws(() => parse(args), words);
  }
});

test("every option is in the help", () => {
  for (const option of ["instance", "bind", "port", "hostname", "period", "state", "nameplates", "allow-unencrypted"]) assert.match(kHelp, new RegExp(`--${option} `));
});

test("an id says which node it is, whatever the names hold", () => {
  assert.equal(node_id("left", "PUMA_762", "Axes", "J-1"), "s=left/PUMA_762/Axes/J-1");
  assert.equal(escaped("a/b.c;d=\u00e4"), "a%2Fb%2Ec%3Bd%3D%C3%A4");
  const names = ["a/b", "a", "b", "a.b", "a%2Fb", "A", "a b", "ab", "\u00e4", "a\u0308"];
  const ids = names.flatMap((one) => names.map((other) => node_id(one, other)));
  assert.equal(new Set(ids).size, names.length ** 2);
});

test("nameplates are taken as written, and mistakes are named", () => {
  const plates = nameplates_of('{"R": {"manufacturer": "M", "serial_number": "7", "category": "articulated"}}');
  assert.deepEqual(plates.get("R"), {manufacturer: "M", serial_number: "7", category: "articulated"});
  for (const [text, words] of [["{", /not JSON/], ["[]", /not one JSON object/], ['{"R": 1}', /of R/], ['{"R": {"colour": "x"}}', /colour/], ['{"R": {"category": "toString"}}', /category/], ['{"R": {"model": 7}}', /model of R/]]) {
    assert.throws(() => nameplates_of(text), words);
  }
});
