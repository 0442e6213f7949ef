// How fast @mcap/core writes what record_bench writes: the same sizes and numbers of messages, in chunks of 1 MiB with CRC and message
// indexes, without compression. One JSON document on standard output: messages and bytes of content a second.
//   node mcap_core_bench.mjs FILE
import { open, rm } from "node:fs/promises";

import { McapWriter } from "@mcap/core";
import { FileHandleWritable } from "@mcap/nodejs";

const FILE_BYTES = 64 << 20;
const ROUNDS = 5;
const [, , file] = process.argv;

// Half of the bytes are noise, as in record_bench.
function content(size) {
  let seed = 1;
  const noise = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) >>> 24;
  return Uint8Array.from({ length: size }, (_, i) => (i % 8 < 4 ? noise() : 0x3f));
}

async function once(size) {
  await rm(file, { force: true });
  const handle = await open(file, "wx");
  const begin = process.hrtime.bigint();
  const writer = new McapWriter({ writable: new FileHandleWritable(handle), chunkSize: 1 << 20 });
  await writer.start({ profile: "", library: "" });
  const channelId = await writer.registerChannel({ topic: "/a", schemaId: 0, messageEncoding: "cdr", metadata: new Map() });
  const data = content(size);
  const messages = Math.ceil(FILE_BYTES / size);
  for (let i = 1; i <= messages; i++) await writer.addMessage({ channelId, sequence: i, logTime: BigInt(i), publishTime: BigInt(i), data });
  await writer.end();
  const seconds = Number(process.hrtime.bigint() - begin) / 1e9;
  await handle.close();
  await rm(file, { force: true });
  return { messages_per_s: messages / seconds, bytes_per_s: (messages * size) / seconds };
}

const out = {};
for (const size of [100, 10240]) {
  const rounds = [];
  for (let i = 0; i < ROUNDS; i++) rounds.push(await once(size));
  rounds.sort((a, b) => a.messages_per_s - b.messages_per_s);
  out[size] = rounds[ROUNDS >> 1];
}
console.log(JSON.stringify(out));
