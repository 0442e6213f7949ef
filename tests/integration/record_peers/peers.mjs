// Reads and writes MCAP files with the packages of others; one JSON document on standard output.
//   node peers.mjs read FILE            by index and as a stream; ROS messages are decoded by their schemas
//   node peers.mjs write FILE VARIANT   VARIANT: JSON of the writer's options
import { createHash } from "node:crypto";
import { open, readFile } from "node:fs/promises";

import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader, McapWriter } from "@mcap/core";
import { FileHandleReadable, FileHandleWritable } from "@mcap/nodejs";
import { loadDecompressHandlers } from "@mcap/support";

// Order-independent: files with overlapping chunks are read in different orders.
class Contents {
  constructor() {
    this.topics = {};
    this.digests = [];
    this.last = {};
    this.readers = new Map();
  }
  add(message, channel, schema) {
    this.topics[channel.topic] = (this.topics[channel.topic] ?? 0) + 1;
    const hash = createHash("sha256").update(`${channel.topic} ${message.sequence} ${message.logTime} ${message.publishTime} `);
    this.digests.push(hash.update(message.data).digest("hex"));
    if (schema?.encoding === "ros2msg") {
      if (!this.readers.has(schema.id)) {
        const definitions = parse(new TextDecoder().decode(schema.data), { ros2: true });
        this.readers.set(schema.id, new MessageReader(definitions));
      }
      this.last[channel.topic] = this.readers.get(schema.id).readMessage(message.data);
    } else if (channel.messageEncoding === "json") {
      this.last[channel.topic] = JSON.parse(new TextDecoder().decode(message.data));
    }
  }
  document() {
    return { topics: this.topics, digest: createHash("sha256").update(this.digests.sort().join()).digest("hex"), last: this.last };
  }
}

async function readIndexed(file, decompressHandlers) {
  const handle = await open(file, "r");
  const reader = await McapIndexedReader.Initialize({ readable: new FileHandleReadable(handle), decompressHandlers });
  const contents = new Contents();
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    contents.add(message, channel, reader.schemasById.get(channel.schemaId));
  }
  const attachments = {};
  for await (const attachment of reader.readAttachments({ validateCrcs: true }))
    attachments[attachment.name] = createHash("sha256").update(attachment.data).digest("hex");
  const metadata = {};
  for await (const one of reader.readMetadata()) metadata[one.name] = Object.fromEntries(one.metadata);
  await handle.close();
  return {
    ...contents.document(),
    profile: reader.header.profile,
    chunks: reader.chunkIndexes.length,
    messages: Number(reader.statistics.messageCount),
    attachments,
    metadata,
  };
}

async function readStream(file, decompressHandlers) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  const contents = new Contents();
  const channels = new Map();
  const schemas = new Map();
  reader.append(await readFile(file));
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Schema") schemas.set(record.id, record);
    if (record.type === "Channel") channels.set(record.id, record);
    if (record.type === "Message") {
      const channel = channels.get(record.channelId);
      contents.add(record, channel, schemas.get(channel.schemaId));
    }
  }
  return { ...contents.document(), done: reader.done() };
}

async function write(file, options) {
  const handle = await open(file, "wx");
  const writer = new McapWriter({ writable: new FileHandleWritable(handle), ...options });
  await writer.start({ profile: "x", library: "@mcap/core" });
  const encode = (text) => new TextEncoder().encode(text);
  const schemaId = await writer.registerSchema({ name: "one", encoding: "jsonschema", data: encode('{"type":"object"}') });
  const topics = ["/a", "/b"];
  const channels = [];
  for (const topic of topics)
    channels.push(await writer.registerChannel({ topic, schemaId, messageEncoding: "json", metadata: new Map([["key", topic]]) }));
  const contents = new Contents();
  for (let i = 0; i < 500; i++) {
    const data = encode(JSON.stringify({ i, text: "x".repeat(i % 50), list: [1.5, i] }));
    const message = { channelId: channels[i % 2], sequence: i, logTime: BigInt(1000 + i), publishTime: BigInt(i), data };
    await writer.addMessage(message);
    contents.add(message, { topic: topics[i % 2] });
  }
  await writer.addAttachment({ name: "a.txt", logTime: 1n, createTime: 2n, mediaType: "text/plain", data: encode("content") });
  await writer.addMetadata({ name: "m", metadata: new Map([["k", "v"]]) });
  await writer.end();
  await handle.close();
  return contents.document();
}

const [, , action, file, variant] = process.argv;
const handlers = await loadDecompressHandlers();
const result =
  action === "read"
    ? { indexed: await readIndexed(file, handlers), stream: await readStream(file, handlers) }
    : await write(file, JSON.parse(variant));
console.log(JSON.stringify(result, (_, value) => {
  if (typeof value === "bigint") return Number(value);
  return ArrayBuffer.isView(value) ? Array.from(value) : value;
}));
