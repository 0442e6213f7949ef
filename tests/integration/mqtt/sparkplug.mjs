// Messages of Sparkplug B by npm's sparkplug-payload; one JSON document on standard output.
//   node sparkplug.mjs decode FILE     lines "TOPIC HEXADECIMAL"
//   node sparkplug.mjs rebirth FILE    writes the command that asks for the birth messages
import { readFile, writeFile } from "node:fs/promises";

import sparkplug from "sparkplug-payload";

const { decodePayload, encodePayload } = sparkplug.get("spBv1.0");
const plain = (key, value) => (value !== null && typeof value === "object" && "low" in value && "high" in value
  ? value.high * 2 ** 32 + (value.low >>> 0) : value);

const [what, file] = process.argv.slice(2);
if (what === "decode") {
  const lines = (await readFile(file, "utf8")).split("\n").filter((line) => line.includes(" "));
  const out = lines.map((line) => {
    const [topic, bytes] = line.split(" ");
    return { topic, payload: decodePayload(Buffer.from(bytes, "hex")) };
  });
  console.log(JSON.stringify(out, plain));
} else {
  await writeFile(file, encodePayload({
    timestamp: Date.now(),
    metrics: [{ name: "Node Control/Rebirth", type: "Boolean", value: true, timestamp: Date.now() }],
  }));
  console.log("{}");
}
