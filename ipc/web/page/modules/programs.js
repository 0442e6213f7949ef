// Robot programs: what runs where, for how long, and what it waits for; with the buttons that hold and stop it.
import {byId, element, setText, KeyedRows} from "./dom.js";
import {age} from "./format.js";

const kGoingOn = new Set(["queued", "delayed", "running", "waiting", "held"]);

export function state_text(program) {
  const waits = program.waits_for ? ` for ${program.waits_for}` : "";
  const backward = program.direction === "backward" ? ", backward" : "";
  return `${program.state}${waits}${backward}`;
}

export function time_text(program) {
  if (!program.runs && !program.elapsed_s) return "";
  return program.expected_s === null || program.expected_s === undefined ? age(program.elapsed_s)
    : `${age(program.elapsed_s)} of ${age(program.expected_s)}`;
}

export class Programs {
  constructor({command}) {
    this.rows_ = new KeyedRows(byId("program-list"), (program) => program_row(program, command), update_program);
  }

  update(live, visible) {
    const programs = live.programs ?? [];
    const going = programs.filter((program) => kGoingOn.has(program.state)).length;
    setText(byId("program-count"), going ? String(going) : "");
    if (!visible) return;
    this.rows_.show(programs, (program) => `${program.robot}\n${program.program}`);
    byId("no-programs").hidden = programs.length > 0;
    setText(byId("deadlock-note"), live.deadlock ?? "");
    byId("deadlock-note").hidden = !live.deadlock;
  }
}

function program_row(program, command) {
  const row = {state: element("span", {class: "value"}), step: element("span", {class: "more"}), time: element("span", {class: "soft"})};
  const button = (text, name) => {
    const made = element("button", {type: "button", class: "small", title: `${name} ${program.robot}`}, text);
    made.addEventListener("click", () => command(`${name} ${program.robot}`));
    return made;
  };
  row.hold = button("Hold", "TF_HOLD");
  row.resume = button("Resume", "TF_RESUME");
  row.step_on = button("Step", "TF_STEP");
  row.stop = button("Stop", "TF_STOP");
  row.tools = element("span", {class: "commands tools"}, row.hold, row.resume, row.step_on, row.stop);
  row.node = element("li", {class: "program"}, element("span", {class: "name"}, `${program.program} of ${program.robot}`),
    row.state, row.time, row.tools, row.step);
  return row;
}

function update_program(row, program) {
  setText(row.state, state_text(program));
  setText(row.time, time_text(program));
  setText(row.step, program.error || (program.step ? `at ${program.step}` : ""));
  row.node.classList.toggle("warning", program.state === "failed");
  const on_robot = kGoingOn.has(program.state) && program.state !== "queued";
  row.tools.hidden = !on_robot;
  row.hold.hidden = program.state === "held";
  row.resume.hidden = program.state !== "held";
  row.step_on.hidden = program.state !== "held";
}
