// The wall: a tile a cell, the worst first.
import {Connection} from "./connection.js";
import {byId, KeyedRows, setAttribute, setText, Visibility} from "./dom.js";
import {clock_time, count} from "./format.js";
import {watch_theme} from "./theme.js";
import {WallModel} from "./wall_model.js";
import {Tile} from "./wall_tile.js";

const kTick_ms = 500;
const kRetry_ms = 1000;

export const model = new WallModel();
const connection = new Connection(`${window.location.protocol === "https:" ? "wss" : "ws"}://${window.location.host}/live`, () => "");
const visibility = new Visibility();
const rows = new KeyedRows(byId("cells"), () => {
  const tile = new Tile();
  visibility.watch(tile.node);
  return tile;
}, (row, tile) => row.show(tile, performance.now(), visibility.sees(row.node)));
let fetching = false;

function show() {
  const began = performance.now();
  rows.show(model.ordered(byId("search").value), ({number}) => number);
  for (const [level, number] of Object.entries(model.counts())) {
    setText(byId(`count-${level}`), `${count(number)} ${level}`);
    setAttribute(byId(`count-${level}`), "hidden", number > 0 ? null : "");
  }
  const {left_out, rejected, rejected_why} = model.totals;
  const told = [left_out > 0 ? `${count(left_out)} summaries left out` : "", rejected > 0 ? `${count(rejected)} messages refused (${rejected_why})` : ""];
  setText(byId("left-out"), told.filter((text) => text).join(", "));
  setAttribute(byId("no-cells"), "hidden", model.tiles.size === 0 ? null : "");
  performance.measure("cellmirror.wall", {start: began});
}

async function fetch_whole() {
  if (fetching) return;
  fetching = true;
  let again_ms = 0;
  try {
    const answer = await fetch("api/wall", {cache: "no-store"});
    if (!answer.ok) throw new Error(answer.statusText);
    const document = await answer.json();
    if (document.version) setText(byId("version"), `cellmirror ${document.version}`);
    if (!model.take_whole(document, performance.now())) again_ms = kRetry_ms;
    show();
  } catch {
    again_ms = kRetry_ms;
  }
  fetching = false;
  if (again_ms && connection.open) setTimeout(fetch_whole, again_ms);
}

connection.on("opened", () => {
  setText(byId("line-text"), "live");
  setAttribute(byId("line-badge"), "data-level", "ok");
  byId("gone").hidden = true;
  document.body.classList.remove("wall-gone");
  fetch_whole();
});
connection.on("closed", () => {
  model.forget_revision();
  setText(byId("line-text"), "gone");
  setAttribute(byId("line-badge"), "data-level", "fault");
  if (byId("gone").hidden) setText(byId("gone-since"), `Since ${clock_time()}.`);
  byId("gone").hidden = false;
  document.body.classList.add("wall-gone");
});
connection.on("live", (message) => {
  if (model.take_changes(message, performance.now())) show();
  else fetch_whole();
});

byId("gone-now").addEventListener("click", () => connection.start());
byId("search").addEventListener("input", show);
setInterval(() => {
  const now = performance.now();
  for (const tile of model.tiles.values()) {
    const row = rows.get(tile.number);
    if (row && visibility.sees(row.node)) row.tick(tile, now);
  }
}, kTick_ms);
watch_theme(byId("theme-button"), () => {});
connection.start();
