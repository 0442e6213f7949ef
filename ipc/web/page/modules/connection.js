// The WebSocket to the gateway: reconnects by itself, with growing pauses. Events, through `on(kind, f)`: opened,
// closed({retry_s}), welcome, live, reply, picked, refused, marks (the messages), picture, poses, tissue_shape, tissue_motion (an ArrayBuffer).
import {is_poses} from "./scene_format.js";
import {is_tissue_motion, is_tissue_shape} from "./tissue_format.js";

const kFirstPause_s = 0.5;
const kLongestPause_s = 8;
const kSilent_s = 8;  // `live` comes ten times a second: after so long the connection is dead

export function pause_after(failures, random = Math.random) {
  const pause = Math.min(kLongestPause_s, kFirstPause_s * 2 ** Math.min(failures, 10));
  return pause * (0.8 + 0.4 * random());  // so that many pages do not reconnect in the same moment
}

// The token is sent with the opening, so that its holder gets the place that is kept for the token. Browsers can send it
// there only as the name of a subprotocol; the server selects the first one.
export function subprotocols(token) {
  return /^[0-9a-f]{32}$/.test(token ?? "") ? ["cellmirror.live", `cellmirror.token.${token}`] : [];
}

function kind_of(data) {
  if (is_poses(data)) return "poses";
  if (is_tissue_shape(data)) return "tissue_shape";
  return is_tissue_motion(data) ? "tissue_motion" : "picture";
}

export class Connection {
  constructor(address, token_of, Socket = WebSocket) {
    this.address_ = address;
    this.token_of_ = token_of;
    this.Socket_ = Socket;
    this.handlers_ = new Map();
    this.waiting_ = new Map();
    this.next_id_ = 1;
    this.failures_ = 0;
    this.socket_ = null;
    this.open_ = false;
    this.timer_ = null;
    this.heard_ = 0;
  }

  on(kind, handler) {
    this.handlers_.set(kind, [...(this.handlers_.get(kind) ?? []), handler]);
  }

  get open() {
    return this.open_;
  }

  start() {
    clearTimeout(this.timer_);
    this.timer_ = null;
    if (this.socket_) return;
    const socket = new this.Socket_(this.address_, subprotocols(this.token_of_()));
    this.socket_ = socket;
    this.heard_ = Date.now();
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.opened_();
    socket.onmessage = (event) => this.received_(event.data);
    socket.onclose = () => this.closed_(socket);
    socket.onerror = () => {};  // close follows
    this.watch_ ??= setInterval(() => this.check_silence_(), 1000);
  }

  hello() {
    this.send({do: "hello", token: this.token_of_() ?? ""});
  }

  send(message) {
    if (!this.open_) return false;
    this.socket_.send(JSON.stringify(message));
    return true;
  }

  // The reply: {done, text} of a command, {path, robot} of a pick; {done: false, text} where none will come.
  ask(message) {
    const id = this.next_id_++;
    return new Promise((resolve) => {
      if (!this.send({...message, id})) {
        resolve({done: false, text: "no connection to the gateway: nothing was sent"});
        return;
      }
      this.waiting_.set(id, resolve);
    });
  }

  opened_() {
    this.open_ = true;
    this.failures_ = 0;
    this.hello();
    this.emit_("opened", {});
  }

  received_(data) {
    this.heard_ = Date.now();
    if (data instanceof ArrayBuffer) {
      this.emit_(kind_of(data), data);
      return;
    }
    let message;
    try {
      message = JSON.parse(data);
    } catch {
      return;
    }
    const asked = ["reply", "picked", "refused"].includes(message.is) && this.waiting_.get(message.id);
    if (asked) {
      this.waiting_.delete(message.id);
      asked(message.is === "refused" ? {done: false, ...message} : message);
    } else {
      this.emit_(message.is, message);
    }
  }

  closed_(socket) {
    if (socket !== this.socket_) return;
    this.socket_ = null;
    this.open_ = false;
    for (const resolve of this.waiting_.values()) {
      resolve({done: false, text: "the connection ended before the gateway answered: whether this was done is not known"});
    }
    this.waiting_.clear();
    const retry_s = pause_after(this.failures_++);
    this.timer_ = setTimeout(() => this.start(), retry_s * 1000);
    this.emit_("closed", {retry_s, failures: this.failures_});
  }

  check_silence_() {
    if (this.socket_ && Date.now() - this.heard_ > kSilent_s * 1000) {
      const socket = this.socket_;
      socket.close();
      this.closed_(socket);  // a dead connection confirms close only after a minute
    }
  }

  emit_(kind, what) {
    for (const handler of this.handlers_.get(kind) ?? []) handler(what);
  }
}
