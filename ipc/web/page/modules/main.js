// Puts the page together: what comes from the gateway goes to the panels, what people do goes to the gateway.
import {AddressBar, read_address} from "./address.js";
import {Alarms} from "./alarms.js";
import {allow_bell} from "./bell.js";
import {Charts} from "./charts.js";
import {CommandLog} from "./command_log.js";
import {Connection} from "./connection.js";
import {Console} from "./console.js";
import {byId, setText} from "./dom.js";
import {Proximity} from "./proximity.js";
import {LiveView} from "./live_view.js";
import {watch_menus} from "./menus.js";
import {Messages} from "./messages.js";
import {PickedLabel} from "./picked_label.js";
import {Playback} from "./playback.js";
import {Presence} from "./presence.js";
import {Problems} from "./problems.js";
import {Programs} from "./programs.js";
import {Robots} from "./robots.js";
import {SceneMode} from "./scene_mode.js";
import {ShortNames} from "./short_names.js";
import {System} from "./system.js";
import {Tabs} from "./tabs.js";
import {watch_theme} from "./theme.js";
import {Tissue} from "./tissue.js";
import {kept_token, take_token} from "./token.js";
import {Tree} from "./tree.js";
import {UserName} from "./user_name.js";
import {ViewChoice} from "./view_choice.js";
import {Volume} from "./volume.js";

take_token();
const first_hash = window.location.hash;
window.addEventListener("hashchange", () => {
  if (take_token()) connection.hello();
});

const live_address = new URL("live", window.location.href);
live_address.protocol = live_address.protocol === "https:" ? "wss:" : "ws:";
live_address.hash = "";
const connection = new Connection(live_address.href, kept_token);

const presence = new Presence(connection, {quiet: (whether) => {
  for (const panel of [charts, proximity, alarms]) panel.show_quiet(whether);
}});
const script = new Console(connection, {
  may_command: () => presence.may_command, why_not: () => presence.why_not()});
const command = (text) => script.run(text);

let selected = null;  // path of the node that was picked or chosen in the tree
const tabs = new Tabs(byId("side-tabs"), {opened: (id) => id === "tab-messages" && messages.read()});
const show_node = (path) => {
  tabs.open("tab-tree");
  tree.show(path);
};
const tree = new Tree({command, selected: (path) => {
  selected = path;
  scene.select(path);
  address.changed();
}});
const names = new ShortNames();
const charts = new Charts({names});
const robots = new Robots({select: (id) => charts.select(id), command});
const proximity = new Proximity({show_node, names});
const programs = new Programs({command});
const tissue = new Tissue({command, left: () => tabs.current === "tab-tissue" && tabs.open("tab-near")});
const volume = new Volume({command, left: () => tabs.current === "tab-volume" && tabs.open("tab-near")});
const system = new System();
const playback = new Playback(connection, fetched);
const problems = new Problems();
const command_log = new CommandLog({fetched});
const alarms = new Alarms({command, fetched, name: new UserName(), open: () => {
  tabs.open("tab-alarms");
  byId("side-panel").scrollIntoView({block: "nearest"});
}});
const messages = new Messages({
  unread: (n) => {
    if (n > 0 && tabs.current === "tab-messages") messages.read();
    else setText(byId("message-count"), n ? String(n) : "");
  }});
connection.on("welcome", ({run}) => messages.of_run(run));
const picked = new PickedLabel({show_robot: (id) => robots.highlight(id), show_node});
const view = new LiveView(connection, {
  changed: (choice, moved) => {
    if (!moved) {
      picked.show(null);
      choices.chosen(choice);
    }
    scene.look();
    address.changed();
  },
  picked: (found) => {
    picked.show(found);
    if (found?.path) select(found.path);
  },
});
const scene = new SceneMode({
  connection, view, picked: (found) => picked.show(found), selected: (path) => select(path), changed: () => {
    picked.show(null);
    address.changed();
  }});
// What was picked is chosen in the tree, and what is chosen there stands out in 3D.
function select(path) {
  tree.choose(path);
  selected = path;  // the tree may know only the node above it
  scene.select(path);
  address.changed();
}
const choices = new ViewChoice({choose: (choice) => view.choose(choice), current: () => view.choice, command});
watch_menus();
watch_theme(byId("theme-button"), () => {
  charts.restyle();
  scene.restyle();
});
const address = new AddressBar({
  state: () => ({
    mode: scene.chosen, choice: view.choice, select: selected, robot: charts.chosen_robot, quantity: byId("chart-quantity").value,
    span: byId("chart-span").value, values: charts.chosen}),
  apply: (wanted) => apply(wanted),
});
charts.on_change(() => address.changed());

// What an address says; a node that is not known yet is chosen when the tree has come.
function apply({mode, choice, select: path, robot, quantity, span, values}) {
  if (choice) view.choose(choice);
  if (quantity) byId("chart-quantity").value = quantity;
  if (span) byId("chart-span").value = span;
  if (robot) charts.select(robot);
  if (values.length > 0) charts.choose(values);
  if (path) select(path);
  scene.begin(mode);
}
apply(read_address(first_hash));

// One update a frame at most, with the newest; what was recorded is not left out.
let newest = null;
connection.on("live", (live) => {
  const start = performance.now();
  names.learn_from(live);
  charts.record(live);
  presence.live(live);
  messages.update(live);
  if (newest === null) draw_soon();
  newest = live;
  measured("cellmirror.record", start);
});

// While a slow renderer turns the view, the rest of the page waits for it.
const kInHaste_ms = 250;
function draw_soon() {
  if (scene.hasty) setTimeout(() => requestAnimationFrame(draw), kInHaste_ms);
  else requestAnimationFrame(draw);
}

function draw() {
  const start = performance.now();
  const live = newest;
  newest = null;
  robots.update(live);
  proximity.update(live, tabs.current === "tab-near");
  tissue.update(live, tabs.current === "tab-tissue");
  volume.update(live, tabs.current === "tab-volume");
  programs.update(live, tabs.current === "tab-programs");
  system.update(live, tabs.current === "tab-system");
  playback.update(live);
  problems.update(live);
  alarms.update(live, tabs.current === "tab-alarms");
  command_log.update(live, tabs.current === "tab-messages");
  view.update(live);
  if (view.choice.kind !== "free") scene.look();
  choices.update(live);
  charts.update();
  const revision = live.tree_revision ?? live.revision;
  if (revision !== known_revision) learn_tree(revision);
  measured("cellmirror.update", start);
}

// For observers (developer tools, the browser test); not stored.
function measured(name, start) {
  performance.measure(name, {start});
  performance.clearMeasures(name);
}

let known_revision = null;

async function fetched(path) {
  const answer = await fetch(path, {cache: "no-store"});
  if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
  return answer.json();
}

async function learn_tree(revision) {
  known_revision = revision;
  try {
    const document_of_tree = await fetched("api/tree");
    tree.set(document_of_tree);
    if (selected) select(selected);
    volume.know(document_of_tree.volumes);
    script.know_names(await fetched("api/names"));
  } catch {
    setTimeout(() => known_revision === revision && (known_revision = null), 2000);
  }
}

async function learn_commands() {
  try {
    script.know_commands((await fetched("api/commands")).commands ?? []);
  } catch {
    setTimeout(learn_commands, 2000);
  }
}

connection.on("opened", () => {
  known_revision = null;
  command_log.forget();
  alarms.forget();
  learn_commands();
});

for (const kind of ["pointerdown", "keydown"]) window.addEventListener(kind, allow_bell, {once: true});
window.addEventListener("keydown", (event) => {
  const writing = /^(INPUT|TEXTAREA|SELECT)$/.test(event.target.tagName ?? "");
  if (event.key === "/" && !writing && !event.ctrlKey) {
    event.preventDefault();
    byId("console-input").focus();
  }
});

connection.start();
