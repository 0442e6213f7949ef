// One request line to the control socket of a gateway, one JSON document back (docs/messages.md, "The control socket").
import net from "node:net";

import {Refusal} from "./refusal.mjs";

export const kMostBytes = 16 * 1024 * 1024; // kMaxControlReplyBytes of ipc/control

function document_of(text) {
  let document;
  try {
    document = JSON.parse(text);
  } catch {
    throw new Refusal("the gateway's answer is not JSON", "use a bridge of the gateway's version");
  }
  if (typeof document?.error === "string") throw new Refusal(document.error, String(document.remedy ?? ""));
  return document;
}

function reason(error) {
  return error.code === "ECONNREFUSED" || error.code === "ENOENT" ? "the gateway has ended" : `the gateway cannot be asked: ${error.code ?? error.message}`;
}

// The document that answers `request`, a plain object. Refusal: no gateway there, no whole answer within `timeout_ms`, more than
// `most_bytes`, an error of the gateway.
export function ask(place, request, {timeout_ms, most_bytes = kMostBytes}) {
  return new Promise((resolve, reject) => {
    const socket = net.createConnection({path: place});
    const parts = [];
    let bytes = 0;
    const end = (failure) => {
      clearTimeout(limit);
      socket.destroy();
      reject(failure);
    };
    const limit = setTimeout(() => end(new Refusal(`the gateway did not answer within ${timeout_ms / 1000} s`, "look at its log")), timeout_ms);
    socket.on("error", (error) => end(new Refusal(reason(error))));
    socket.on("connect", () => socket.write(`${JSON.stringify(request)}\n`));
    socket.on("data", (part) => {
      bytes += part.length;
      if (bytes > most_bytes) return end(new Refusal(`the gateway's answer has more than ${most_bytes} bytes`));
      parts.push(part);
    });
    socket.on("end", () => {
      clearTimeout(limit);
      socket.destroy();
      const text = Buffer.concat(parts).toString("utf8");
      if (!text.endsWith("\n")) return reject(new Refusal(`the gateway's answer was truncated after ${bytes} bytes`, "it may just have ended"));
      try {
        resolve(document_of(text));
      } catch (error) {
        reject(error);
      }
    });
  });
}
