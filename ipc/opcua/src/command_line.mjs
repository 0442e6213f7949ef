// The command line of cellmirror-opcua.
import os from "node:os";
import path from "node:path";
import {parseArgs} from "node:util";

import {is_instance_name} from "./control_socket.mjs";
import {Refusal} from "./refusal.mjs";

export const kHelp = `cellmirror-opcua [OPTIONS]

Shows the robots of running cellmirror gateways to clients of OPC UA, by the companion specification
Robotics (OPC 40010-1). Nothing can be written or called. Run it as the gateway's user.

  --instance NAME        the gateway; again for each further one (default: default)
  --bind ADDRESS         IPv4 address to listen on; 0.0.0.0: all (default: 127.0.0.1)
  --port PORT            (default: 4840)
  --hostname NAME        the address for clients to connect to (default: the address, or this machine's name)
  --period MS            between two requests to a gateway, 50 to 10000 (default: 100)
  --state FOLDER         own certificate and those of clients (default: $XDG_STATE_HOME/cellmirror-opcua,
                         else ~/.local/state/cellmirror-opcua)
  --nameplates FILE      JSON with manufacturer, model, product_code, serial_number, category of robots
  --allow-unencrypted    beyond this machine too; anybody in the network can then read, and alter what is read
  --help, --version

Examples:
  cellmirror-opcua                                      one gateway, for clients on this machine
  cellmirror-opcua --instance left --instance right     two gateways, two motion device systems
  cellmirror-opcua --bind 192.168.7.10                  for the plant; clients are encrypted and must be trusted:
                                                        move their certificate from FOLDER/pki/rejected to
                                                        FOLDER/pki/trusted/certs after their first try

docs/opc-ua.md explains what is shown. Ctrl-C ends it.
`;

const kMostInstances = 16;
const kOptions = {
  instance: {type: "string", multiple: true, default: ["default"]},
  bind: {type: "string", default: "127.0.0.1"},
  port: {type: "string", default: "4840"},
  hostname: {type: "string"},
  period: {type: "string", default: "100"},
  state: {type: "string"},
  nameplates: {type: "string"},
  "allow-unencrypted": {type: "boolean", default: false},
  help: {type: "boolean", short: "h", default: false},
  version: {type: "boolean", default: false},
};

function whole_number(name, text, least, greatest) {
  const number = /^\d{1,9}$/.test(text) ? Number(text) : NaN;
  if (!(number >= least && number <= greatest)) throw new Refusal(`--${name} ${text} is not a whole number from ${least} to ${greatest}`);
  return number;
}

export function is_loopback(address) {
  return address === "localhost" || /^127(\.\d{1,3}){3}$/.test(address);
}

function bind_of(address) {
  const parts = address.split(".");
  if (address !== "localhost" && !(parts.length === 4 && parts.every((part) => /^\d{1,3}$/.test(part) && Number(part) < 256))) {
    throw new Refusal(`--bind ${address} is not an IPv4 address`, "0.0.0.0 listens on all");
  }
  return address;
}

function hostname_of(name, bind) {
  const found = name ?? (bind === "0.0.0.0" ? os.hostname() : bind);
  if (!/^[A-Za-z0-9]([A-Za-z0-9.-]{0,251}[A-Za-z0-9])?$/.test(found)) throw new Refusal(`--hostname ${found} is not a name of a machine`);
  return found;
}

export function default_state(environment, home) {
  const base = environment.XDG_STATE_HOME;
  return path.join(base && path.isAbsolute(base) ? base : path.join(home, ".local", "state"), "cellmirror-opcua");
}

// Refusal for what cannot be meant.
export function parse(args, environment = process.env) {
  let values;
  try {
    ({values} = parseArgs({args, options: kOptions, strict: true}));
  } catch (error) {
    throw new Refusal(error.message.split("\n")[0], "cellmirror-opcua --help lists the options");
  }
  const instances = [...new Set(values.instance)];
  for (const name of instances) {
    if (!is_instance_name(name)) throw new Refusal("the instance's name is not 1 to 32 letters, digits, _ and -", "choose another --instance NAME");
  }
  if (instances.length > kMostInstances) throw new Refusal(`more than ${kMostInstances} instances`, "start a second bridge on another port");
  const bind = bind_of(values.bind);
  return {
    help: values.help,
    version: values.version,
    instances,
    bind,
    port: whole_number("port", values.port, 1, 65535),
    hostname: hostname_of(values.hostname, bind),
    period_ms: whole_number("period", values.period, 50, 10_000),
    state: path.resolve(values.state ?? default_state(environment, os.homedir())),
    nameplates: values.nameplates,
    unencrypted: is_loopback(bind) || values["allow-unencrypted"],
    loopback: is_loopback(bind),
  };
}
