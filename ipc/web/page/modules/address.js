// What is looked at, as the part of the page's address behind #: a link shows another person the same. Only what differs from a
// fresh page stands there. Pure, but for AddressBar.

const kModes = {"3d": "scene", pictures: "picture"};
const kLongest = 4000;  // characters that are read

function numbers(text, count) {
  const values = text.split(",").map(Number);
  return values.length === count && values.every((value) => Number.isFinite(value) && Math.abs(value) <= 1e4) ? values : null;
}

function choice_of(see, at) {
  const view = /^view:([0-6])$/.exec(see);
  if (view) return {kind: "view", id: Number(view[1])};
  if (see.startsWith("camera:") && see.length > 7) return {kind: "camera", name: see.slice(7)};
  const values = see === "free" ? numbers(at, 8) : null;
  if (!values) return null;
  return {kind: "free", view: {viewpoint_m: values.slice(0, 3), lookpoint_m: values.slice(3, 6), twist_rad: values[6], opening_angle_rad: values[7]}};
}

// {mode, choice, select, robot, quantity, span, values}; null, or an empty list, for what is not said or makes no sense.
export function read_address(hash) {
  const parts = new URLSearchParams(String(hash).slice(1, kLongest));
  const text = (name) => parts.get(name) || null;
  return {
    mode: kModes[parts.get("mode")] ?? null,
    choice: choice_of(parts.get("see") ?? "", parts.get("at") ?? ""),
    select: text("select"),
    robot: text("robot"),
    quantity: ["position", "velocity", "effort"].find((one) => one === parts.get("quantity")) ?? null,
    span: ["20", "60", "120"].find((one) => one === parts.get("span")) ?? null,
    values: parts.getAll("value").slice(0, 24),
  };
}

export function write_address({mode = null, choice = null, select = null, robot = null, quantity = null, span = null, values = []}) {
  const parts = new URLSearchParams();
  const put = (name, value) => value !== null && value !== undefined && value !== "" && parts.append(name, value);
  put("mode", Object.keys(kModes).find((word) => kModes[word] === mode) ?? null);
  if (choice?.kind === "view") put("see", `view:${choice.id}`);
  if (choice?.kind === "camera") put("see", `camera:${choice.name}`);
  if (choice?.kind === "free") {
    const {viewpoint_m, lookpoint_m, twist_rad, opening_angle_rad} = choice.view;
    put("see", "free");
    put("at", [...viewpoint_m, ...lookpoint_m, twist_rad, opening_angle_rad].map((value) => Number(value.toFixed(4))).join(","));
  }
  put("select", select);
  put("robot", robot);
  put("quantity", quantity === "position" ? null : quantity);
  put("span", span === "60" ? null : span);
  for (const value of values) put("value", value);
  const text = parts.toString();
  return text ? `#${text.replaceAll("%2C", ",").replaceAll("%3A", ":")}` : "";
}

const kWriteAfter_ms = 400;  // browsers refuse many changes a second

export class AddressBar {
  // `state()`: as write_address() takes it; `apply(address)`: another one was entered.
  constructor({state, apply}) {
    this.state_ = state;
    this.written_ = window.location.hash;
    window.addEventListener("hashchange", () => {
      // Links within the page have no "=".
      if (window.location.hash === this.written_ || !/^#[a-z]+=/.test(window.location.hash) || /[#&]token=/.test(window.location.hash)) return;
      this.written_ = window.location.hash;
      apply(read_address(window.location.hash));
    });
  }

  changed() {
    clearTimeout(this.timer_);
    this.timer_ = setTimeout(() => {
      const hash = write_address(this.state_());
      if (hash === this.written_) return;
      this.written_ = hash;
      window.history.replaceState(null, "", window.location.pathname + window.location.search + hash);
    }, kWriteAfter_ms);
  }
}
