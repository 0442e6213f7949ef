// The program: command line, server, a feed for each gateway, an end in order.
import fs from "node:fs";

import {kHelp, parse} from "./command_line.mjs";
import {in_words, Refusal} from "./refusal.mjs";

const kTidy_ms = 2000;

function say(line) {
  process.stdout.write(`${line}\n`);
}

function version() {
  return JSON.parse(fs.readFileSync(new URL("../package.json", import.meta.url), "utf8")).version;
}

async function modules() {
  try {
    return await Promise.all(["node-opcua", "./certificates.mjs", "./server.mjs", "./node_factory.mjs", "./cell_nodes.mjs", "./feed.mjs", "./nameplates.mjs", "./session_room.mjs"].map((name) => import(name)));
  } catch (error) {
    if (error.code === "ERR_MODULE_NOT_FOUND" && /node-opcua/.test(error.message)) throw new Refusal("the npm package node-opcua is not installed", "run npm ci --omit=dev in the program's folder");
    throw error;
  }
}

// Resolves with the signal that ends the program.
function asked_to_end() {
  return new Promise((resolve) => {
    for (const name of ["SIGINT", "SIGTERM", "SIGHUP"]) process.on(name, () => resolve(name));
  });
}

// Looks after the certificates of clients, and says when another one waits to be trusted.
function tidier(options, forget) {
  let known = 0;
  return async () => {
    try {
      const waiting = await forget();
      if (waiting > known) say(`${waiting} client certificates are not trusted: see ${options.state}/pki/rejected`);
      known = waiting;
    } catch (error) {
      say(`the certificates in ${options.state}: ${in_words(error)}`);
    }
  };
}

// The server with the nodes of all cells, not listening yet, and what feeds them.
async function made(options) {
  const [{default: opcua}, {certificate_manager, forget_unasked}, {kLimits, make_server}, {NodeFactory}, {CellNodes}, {Feed}, {read_nameplates}, {keep_room}] = await modules();
  opcua.setLogLevel(opcua.LogLevel.Error);
  const nameplates = options.nameplates ? read_nameplates(options.nameplates) : new Map();
  const certificates = await certificate_manager(options.state, options.loopback);
  const server = await make_server(options, certificates, version());
  keep_room(server, kLimits.sessions, say);
  const factory = new NodeFactory(server.engine.addressSpace);
  const feeds = options.instances.map((instance) => new Feed({instance, period_ms: options.period_ms, cell: new CellNodes(factory, instance, nameplates, Date.now()), say}));
  return {server, feeds, tidy: tidier(options, () => forget_unasked(certificates, options.state, options.loopback))};
}

async function serve(options) {
  const ended = asked_to_end();
  process.umask(0o077);
  const {server, feeds, tidy} = await made(options);
  try {
    await server.start();
  } catch (error) {
    throw new Refusal(`${options.bind}:${options.port} cannot be listened on: ${in_words(error)}`, "choose another --port");
  }
  say(`OPC UA at opc.tcp://${options.hostname}:${options.port}${options.unencrypted ? "" : ", encrypted"}; certificates are in ${options.state}; Ctrl-C ends it`);
  const tidying = setInterval(tidy, kTidy_ms);
  for (const feed of feeds) feed.run();
  await ended;
  clearInterval(tidying);
  for (const feed of feeds) feed.end(); // one that still waits for an answer reports nothing any more
  await server.shutdown(0);
}

// The exit status: 0; 1 for a failure; 2 for a wrong command line.
export async function main(args) {
  let options;
  try {
    options = parse(args);
  } catch (error) {
    process.stderr.write(`cellmirror-opcua: ${in_words(error)}\n`);
    return 2;
  }
  if (options.help || options.version) {
    process.stdout.write(options.help ? kHelp : `cellmirror-opcua ${version()}\n`);
    return 0;
  }
  try {
    await serve(options);
    return 0;
  } catch (error) {
    process.stderr.write(`cellmirror-opcua: ${error instanceof Refusal ? in_words(error) : error.stack}\n`);
    return 1;
  }
}
