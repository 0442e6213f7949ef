// The variants of the conformance suite of MCAP (repository foxglove/mcap, tests/conformance), made with the record builders of
// @mcap/core, which fix every byte; and what @mcap/core reads in files, for comparison.
//   node conformance.mjs make FOLDER      writes NAME.mcap of all variants; prints {name: sha256}
//   node conformance.mjs read FILE...     prints {file: {records, contents}}: all records in order, as texts, and what users see
import { createHash } from "node:crypto";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import path from "node:path";

import { crc32, crc32Final, crc32Init, crc32Update } from "@foxglove/crc";
import { McapChunkBuilder, McapIndexedReader, McapRecordBuilder, McapStreamReader, Opcode } from "@mcap/core";
import { loadDecompressHandlers } from "@mcap/support";

const schema = { type: "Schema", id: 1, name: "Example", encoding: "c", data: Uint8Array.of(4, 5, 6) };
const channel = { type: "Channel", id: 1, topic: "example", schemaId: 1, messageEncoding: "a", metadata: new Map([["foo", "bar"]]) };
const message = (sequence, logTime, publishTime) => ({
  type: "Message", channelId: 1, sequence, logTime, publishTime, data: Uint8Array.of(1, 2, 3),
});
const INPUTS = {
  NoData: [],
  OneSchemalessMessage: [{ ...channel, schemaId: 0, messageEncoding: "text", metadata: new Map() }, message(10, 2n, 1n)],
  OneMessage: [schema, channel, message(10, 2n, 1n)],
  OneAttachment: [{ type: "Attachment", name: "myFile", mediaType: "application/octet-stream", logTime: 2n, createTime: 1n,
    data: Uint8Array.of(1, 2, 3) }],
  OneMetadata: [{ type: "Metadata", name: "myMetadata", metadata: new Map([["foo", "bar"]]) }],
  TenMessages: [schema, channel, ...[0n, 2n, 1n, 3n, 3n, 5n, 4n, 7n, 8n, 9n].map((time, i) => message(i, time, time))],
};
const FEATURES = ["ch", "mx", "st", "rsh", "rch", "ax", "mdx", "chx", "sum", "pad"];

// Whether the suite has this combination for these records.
function exists(on, records) {
  const some = (...types) => records.some((record) => types.includes(record.type));
  const needs = { ax: some("Attachment"), mdx: some("Metadata"), rsh: some("Schema"), rch: some("Channel"),
    ch: some("Message", "Channel", "Schema"), chx: on.has("ch"), mx: on.has("ch"),
    sum: ["chx", "rsh", "rch", "mdx", "ax", "st"].some((feature) => on.has(feature)) };
  return Object.entries(needs).every(([feature, possible]) => possible || !on.has(feature));
}

// The data section. What the summary says of it is collected in `seen`.
function writeData(builder, on, records, seen) {
  const chunk = on.has("ch") ? new McapChunkBuilder({ useMessageIndex: on.has("mx") }) : undefined;
  for (const record of records) {
    seen.of(record.type).push(record);
    const offset = BigInt(builder.length);
    if (record.type === "Schema") chunk ? chunk.addSchema(record) : builder.writeSchema(record);
    if (record.type === "Channel") chunk ? chunk.addChannel(record) : builder.writeChannel(record);
    if (record.type === "Message") chunk ? chunk.addMessage(record) : builder.writeMessage(record);
    if (record.type === "Attachment")
      seen.attachments.push({ ...record, offset, length: builder.writeAttachment(record), dataSize: BigInt(record.data.byteLength) });
    if (record.type === "Metadata") seen.metadata.push({ name: record.name, offset, length: builder.writeMetadata(record) });
  }
  if (!chunk) return;
  const size = BigInt(chunk.buffer.byteLength);
  const common = { compression: "", messageStartTime: chunk.messageStartTime, messageEndTime: chunk.messageEndTime, uncompressedSize: size };
  const chunkStartOffset = BigInt(builder.length);
  const chunkLength = builder.writeChunk({ ...common, uncompressedCrc: crc32(chunk.buffer), records: chunk.buffer });
  const messageIndexOffsets = new Map();
  let messageIndexLength = 0n;
  for (const index of chunk.indices) {
    messageIndexOffsets.set(index.channelId, BigInt(builder.length));
    messageIndexLength += builder.writeMessageIndex(index);
  }
  seen.chunks.push({ ...common, compressedSize: size, chunkStartOffset, chunkLength, messageIndexLength, messageIndexOffsets });
}

function statistics(seen) {
  const messages = seen.of("Message");
  const times = messages.map((one) => one.logTime).sort((a, b) => (a < b ? -1 : a > b ? 1 : 0));
  const counts = new Map();
  for (const one of messages) counts.set(one.channelId, (counts.get(one.channelId) ?? 0n) + 1n);
  return { messageCount: BigInt(messages.length), channelCount: seen.of("Channel").length, schemaCount: seen.of("Schema").length,
    attachmentCount: seen.of("Attachment").length, metadataCount: seen.of("Metadata").length, chunkCount: seen.chunks.length,
    messageStartTime: times[0] ?? 0n, messageEndTime: times.at(-1) ?? 0n, channelMessageCounts: counts };
}

function file(on, records) {
  const builder = new McapRecordBuilder({ padRecords: on.has("pad") });
  const lists = {};
  const seen = { attachments: [], metadata: [], chunks: [], of: (type) => (lists[type] ??= []) };
  builder.writeMagic();
  builder.writeHeader({ profile: "", library: "" });
  writeData(builder, on, records, seen);
  builder.writeDataEnd({ dataSectionCrc: crc32(builder.buffer) });
  const summaryStart = BigInt(builder.length);
  const groups = [];
  const group = (groupOpcode, wanted, write) => {
    const groupStart = BigInt(builder.length);
    if (wanted) write();
    const groupLength = BigInt(builder.length) - groupStart;
    if (groupLength > 0n) groups.push({ groupOpcode, groupStart, groupLength });
  };
  group(Opcode.SCHEMA, on.has("rsh"), () => seen.of("Schema").forEach((one) => builder.writeSchema(one)));
  group(Opcode.CHANNEL, on.has("rch"), () => seen.of("Channel").forEach((one) => builder.writeChannel(one)));
  group(Opcode.STATISTICS, on.has("st"), () => builder.writeStatistics(statistics(seen)));
  group(Opcode.METADATA_INDEX, on.has("mdx"), () => seen.metadata.forEach((one) => builder.writeMetadataIndex(one)));
  group(Opcode.ATTACHMENT_INDEX, on.has("ax"), () => seen.attachments.forEach((one) => builder.writeAttachmentIndex(one)));
  group(Opcode.CHUNK_INDEX, on.has("chx"), () => seen.chunks.forEach((one) => builder.writeChunkIndex(one)));
  const start = groups.length > 0 ? summaryStart : 0n;
  const offsets = on.has("sum") ? BigInt(builder.length) : 0n;
  if (on.has("sum")) groups.forEach((one) => builder.writeSummaryOffset(one));
  // The CRC reaches into the footer, up to itself.
  const footer = new DataView(new ArrayBuffer(25));
  footer.setUint8(0, Opcode.FOOTER);
  [20n, start, offsets].forEach((value, i) => footer.setBigUint64(1 + 8 * i, value, true));
  const crc = crc32Update(crc32Update(crc32Init(), builder.buffer.slice(Number(summaryStart))), footer);
  builder.writeFooter({ summaryStart: start, summaryOffsetStart: offsets, summaryCrc: crc32Final(crc) });
  builder.writeMagic();
  return builder.buffer;
}

async function make(folder) {
  await mkdir(folder, { recursive: true });
  const hashes = {};
  for (const [input, records] of Object.entries(INPUTS)) {
    for (let bits = 0; bits < 1 << FEATURES.length; bits++) {
      const on = new Set(FEATURES.filter((_, i) => bits & (1 << i)));
      if (!exists(on, records)) continue;
      const name = [input, ...[...on].sort()].join("-");
      const bytes = file(on, records);
      await writeFile(path.join(folder, `${name}.mcap`), bytes);
      hashes[name] = createHash("sha256").update(bytes).digest("hex");
    }
  }
  return hashes;
}

const plain = (_, value) => {
  if (ArrayBuffer.isView(value)) return Array.from(value);
  if (value instanceof Map) return Object.fromEntries(value);
  return typeof value === "bigint" ? String(value) : value;
};

// Data records as texts in the order of the file, chunks opened; what both sides can say of any file.
async function records(name, decompressHandlers) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(await readFile(name));
  const out = [];
  let summary = false;
  for (let record; (record = reader.nextRecord()); ) {
    summary ||= record.type === "DataEnd";
    if (!summary && ["Schema", "Channel", "Message", "Attachment", "Metadata"].includes(record.type)) out.push(JSON.parse(JSON.stringify(record, plain)));
  }
  if (!reader.done()) throw new Error(`${name} is not whole`);
  return out;
}

// Messages in the order of time by the index; null where the file has none.
async function indexed(name, decompressHandlers) {
  const bytes = await readFile(name);
  const readable = {
    size: async () => BigInt(bytes.byteLength),
    read: async (offset, size) => new Uint8Array(bytes.buffer, bytes.byteOffset + Number(offset), Number(size)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  if (reader.chunkIndexes.length === 0) return null;
  const out = [];
  for await (const one of reader.readMessages({ validateCrcs: true })) out.push(JSON.parse(JSON.stringify(one, plain)));
  return { messages: out, statistics: reader.statistics && JSON.parse(JSON.stringify(reader.statistics, plain)) };
}

const [, , action, ...names] = process.argv;
if (action === "make") {
  console.log(JSON.stringify(await make(names[0])));
} else {
  const handlers = await loadDecompressHandlers();
  const out = {};
  for (const name of names) out[path.basename(name, ".mcap")] = { records: await records(name, handlers), indexed: await indexed(name, handlers).catch(() => null) };
  console.log(JSON.stringify(out));
}
