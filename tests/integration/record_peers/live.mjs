// A client of the live server by @foxglove/ws-protocol; one JSON document on standard output.
//   node live.mjs URL SUBPROTOCOL TOKEN ASSET
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import protocol from "@foxglove/ws-protocol";
import WebSocket from "ws";

const { FoxgloveClient } = protocol;
const [, , url, subprotocol, token, asset] = process.argv;
const socket = new WebSocket(url, [subprotocol]);
const client = new FoxgloveClient({ ws: socket });
const out = { errors: [], statuses: [], topics: {}, messages: {}, times: 0 };
const channels = new Map(); // by topic
const subscriptions = new Map(); // topic by subscription

// Resolves with the first event for which `wanted` gives something.
function event(name, wanted) {
  return new Promise((resolve) => {
    const listener = (value) => {
      const found = wanted(value);
      if (found === undefined) return;
      client.off(name, listener);
      resolve(found);
    };
    client.on(name, listener);
  });
}

client.on("error", (error) => out.errors.push(String(error)));
client.on("status", (status) => out.statuses.push(status));
client.on("time", () => out.times++);
client.on("advertise", (added) => {
  for (const channel of added) {
    channels.set(channel.topic, channel);
    out.topics[channel.topic] = [channel.encoding, channel.schemaName, channel.schemaEncoding];
  }
});
client.on("message", ({ subscriptionId, timestamp, data }) => {
  const topic = subscriptions.get(subscriptionId);
  const channel = channels.get(topic);
  const value = channel.encoding === "json" ? JSON.parse(new TextDecoder().decode(data))
    : new MessageReader(parse(channel.schema, { ros2: true })).readMessage(data);
  out.messages[topic] ??= { value, timestamp };
});

async function command(service, callId, request) {
  const answer = Promise.race([
    event("serviceCallResponse", (one) => (one.callId === callId ? JSON.parse(new TextDecoder().decode(one.data)) : undefined)),
    event("serviceCallFailure", (one) => (one.callId === callId ? { failure: one.message } : undefined)),
  ]);
  client.sendServiceCallRequest({ serviceId: service.id, callId, encoding: "json", data: new DataView(new TextEncoder().encode(JSON.stringify(request)).buffer) });
  return answer;
}

async function main() {
  const info = event("serverInfo", (one) => one);
  const services = event("advertiseServices", (one) => one);
  out.info = await info;
  out.protocol = socket.protocol;
  const service = (await services).find((one) => one.name === "/cellmirror/command");
  for (const topic of ["/joint_states", "/tf", "/cellmirror/status", "/cellmirror/commands"]) {
    while (!channels.has(topic)) await event("advertise", (one) => one);
    subscriptions.set(client.subscribe(channels.get(topic).id), topic);
  }
  out.without = await command(service, 1, { command: "ROBACT PUMA_762" });
  out.with = await command(service, 2, { command: "ROBACT PUMA_762", token });
  const all = event("parameterValues", (one) => (one.id === "all" ? one.parameters : undefined));
  client.getParameters([], "all");
  out.parameters = Object.fromEntries((await all).map((one) => [one.name, typeof one.value]));
  const changed = event("parameterValues", (one) => one.parameters.find((p) => p.value === 0.2));
  client.subscribeParameterUpdates(["/cellmirror/warning_distance_m"]);
  client.setParameters([{ name: "/cellmirror/warning_distance_m", value: 0.2 }]);
  out.changed = (await changed).name;
  for (const [name, uri] of [["asset", asset], ["refused", "package://cell/../cell.toml"]]) {
    const fetched = event("fetchAssetResponse", (one) => one);
    client.fetchAsset(uri, 7);
    const { status, error, data } = await fetched;
    out[name] = { status, error, bytes: data?.byteLength };
  }
  while (Object.keys(out.messages).length < subscriptions.size) await event("message", () => true);
  client.close();
}

const limit = setTimeout(() => {
  console.error(`no answer in time; so far: ${JSON.stringify(out, replacer)}`);
  process.exit(1);
}, 60_000);
function replacer(_, value) {
  if (typeof value === "bigint") return Number(value);
  return ArrayBuffer.isView(value) && !(value instanceof DataView) ? Array.from(value) : value;
}
await Promise.race([main(), event("close", () => true)]);
clearTimeout(limit);
console.log(JSON.stringify(out, replacer));
