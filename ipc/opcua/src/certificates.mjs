// The folder with this server's key and certificate, and those of clients. On the loopback interface every client is accepted; its
// folder is another one, so that a client that was accepted there is not trusted beyond this machine.
import fs from "node:fs/promises";
import path from "node:path";
import opcua from "node-opcua";

import {Refusal} from "./refusal.mjs";

const kKeyBits = 3072;
const kLookAtFolders_ms = 1000;
export const kMostUnasked = 64; // certificates that clients have sent unasked: the oldest go

export async function certificate_manager(state, loopback) {
  const folder = path.join(state, loopback ? "pki-loopback" : "pki");
  await make_private(state);
  await make_private(folder);
  await drop_trusted(folder);
  const manager = new opcua.OPCUACertificateManager({rootFolder: folder, automaticallyAcceptUnknownCertificate: loopback, keySize: kKeyBits});
  manager.folderPoolingInterval = kLookAtFolders_ms;
  await manager.initialize();
  // What others could read would be no secret; a folder of another user is none of ours.
  await fs.chmod(path.join(folder, "own", "private", "private_key.pem"), 0o600);
  return manager;
}

async function make_private(folder) {
  try {
    await fs.mkdir(folder, {recursive: true, mode: 0o700});
    const found = await fs.lstat(folder);
    if (!found.isDirectory() || found.uid !== process.geteuid()) throw new Refusal("it is not a folder of this user");
    await fs.chmod(folder, 0o700);
  } catch (error) {
    throw new Refusal(`the folder ${folder} cannot be used: ${error.code ?? error.message}`, "choose another --state FOLDER");
  }
}

// A client that was trusted while it tried again lies in both folders, and the package would look at the rejected ones first.
async function drop_trusted(folder) {
  const trusted = await fs.readdir(path.join(folder, "trusted", "certs")).catch(() => []);
  for (const name of trusted) await fs.rm(path.join(folder, "rejected", name), {force: true});
}

// Keeps the newest `most` files of a folder; how many there are then.
export async function keep_newest(folder, most) {
  const found = [];
  for (const name of await fs.readdir(folder).catch(() => [])) {
    const file = path.join(folder, name);
    const {mtimeMs} = await fs.lstat(file).catch(() => ({}));
    if (mtimeMs !== undefined) found.push({file, mtimeMs});
  }
  found.sort((a, b) => b.mtimeMs - a.mtimeMs);
  for (const {file} of found.slice(most)) await fs.rm(file, {force: true});
  return Math.min(found.length, most);
}

// Call it now and then: a client that reaches the port can send certificates. How many clients wait to be trusted.
export async function forget_unasked(manager, state, loopback) {
  // The package remembers what it rejected, without a bound, and would not look again for one that was moved to the trusted.
  const {rejected} = manager._thumbs;
  for (const fingerprint of Object.keys(rejected)) delete rejected[fingerprint];
  const folder = path.join(state, loopback ? "pki-loopback" : "pki");
  await drop_trusted(folder);
  if (loopback) await keep_newest(path.join(folder, "trusted", "certs"), kMostUnasked);
  return keep_newest(path.join(folder, "rejected"), kMostUnasked);
}
