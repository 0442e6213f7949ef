// Where the control socket of a gateway is, and whose it must be: the rules of ipc/runtime and ipc/control for clients.
import fs from "node:fs/promises";
import path from "node:path";

import {Refusal} from "./refusal.mjs";

const kLongestSocketPath = 107; // bytes of sun_path without its end
const kOtherFolder = "set CELLMIRROR_RUNTIME_DIR to the runtime folder of the gateway's user";

export function is_instance_name(name) {
  return /^[A-Za-z0-9_-]{1,32}$/.test(name);
}

// $CELLMIRROR_RUNTIME_DIR, else $XDG_RUNTIME_DIR/cellmirror, else /run/cellmirror for root, else /tmp/cellmirror-<uid>.
export function runtime_folder(environment, user) {
  const ours = environment.CELLMIRROR_RUNTIME_DIR;
  if (ours) {
    if (!path.isAbsolute(ours)) throw new Refusal(`CELLMIRROR_RUNTIME_DIR is ${ours}, which is not an absolute path`, "begin it with /");
    return ours;
  }
  const of_user = environment.XDG_RUNTIME_DIR;
  if (of_user && path.isAbsolute(of_user)) return path.join(of_user, "cellmirror");
  return user === 0 ? "/run/cellmirror" : `/tmp/cellmirror-${user}`;
}

function check_owner(what, place, found, user) {
  if (user !== 0 && found.uid !== user && found.uid !== 0) {
    throw new Refusal(`the ${what} ${place} belongs to user ${found.uid}, whose gateway is not trusted`, kOtherFolder);
  }
}

async function found_at(place) {
  try {
    return await fs.lstat(place);
  } catch (error) {
    if (error.code === "ENOENT") return null;
    throw new Refusal(`${place} cannot be read: ${error.code}`, kOtherFolder);
  }
}

// The path of the socket; Refusal where no gateway runs there, or where another user made the folder or the socket.
export async function control_socket(instance, environment = process.env, user = process.geteuid()) {
  const folder = runtime_folder(environment, user);
  const not_running = new Refusal(`no gateway of the instance ${instance} is running`, `start one with cellmirror run CELL.toml --instance ${instance}`);
  const runtime = await found_at(folder);
  if (!runtime) throw not_running;
  if (!runtime.isDirectory()) throw new Refusal(`the runtime folder ${folder} is not a folder`, kOtherFolder);
  check_owner("runtime folder", folder, runtime, user);
  const place = path.join(folder, instance, "control.sock");
  if (Buffer.byteLength(place) > kLongestSocketPath) {
    throw new Refusal(`the socket's path ${place} is longer than ${kLongestSocketPath} bytes`, "set CELLMIRROR_RUNTIME_DIR to a shorter folder");
  }
  const socket = await found_at(place);
  if (!socket) throw not_running;
  if (!socket.isSocket()) throw new Refusal(`${place} is not a socket`, kOtherFolder);
  check_owner("control socket", place, socket, user);
  return place;
}
