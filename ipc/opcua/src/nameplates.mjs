// What the maker's plate of each robot says: a JSON file that the user writes, because no stream reports it.
//   {"ROBOT_ID": {"manufacturer": "...", "model": "...", "product_code": "...", "serial_number": "...", "category": "articulated"}}
import fs from "node:fs";

import {kLongestName, kMostRobots, plain_object, plain_text} from "./cell_image.mjs";
import {kCategories} from "./cell_values.mjs";
import {in_words, Refusal} from "./refusal.mjs";

const kMostBytes = 1_000_000;
const kTexts = ["manufacturer", "model", "product_code", "serial_number"];

function plate_of(id, value) {
  if (plain_object(value) !== value) throw new Refusal(`the nameplate of ${id} is not an object`, 'write {"manufacturer": "...", ...}');
  const plate = {};
  for (const [key, text] of Object.entries(value)) {
    if (key === "category" && Object.hasOwn(kCategories, text)) plate.category = text;
    else if (key === "category") throw new Refusal(`the category of ${id} is not known`, `choose one of ${Object.keys(kCategories).join(", ")}`);
    else if (!kTexts.includes(key)) throw new Refusal(`the nameplate of ${id} has the unknown key ${plain_text(key)}`, `known are ${kTexts.join(", ")}, category`);
    else if (typeof text !== "string" || text.length > kLongestName) throw new Refusal(`${key} of ${id} is not a text of at most ${kLongestName} characters`);
    else plate[key] = plain_text(text);
  }
  return plate;
}

// A map by robot.
export function nameplates_of(text) {
  let document;
  try {
    document = JSON.parse(text);
  } catch (error) {
    throw new Refusal(`the nameplates are not JSON: ${error.message}`);
  }
  if (plain_object(document) !== document) throw new Refusal("the nameplates are not one JSON object", 'write {"ROBOT_ID": {...}, ...}');
  const entries = Object.entries(document);
  if (entries.length > kMostRobots) throw new Refusal(`there are more than ${kMostRobots} nameplates`);
  return new Map(entries.map(([id, value]) => [plain_text(id), plate_of(plain_text(id), value)]));
}

export function read_nameplates(file) {
  try {
    if (fs.statSync(file).size > kMostBytes) throw new Refusal(`it has more than ${kMostBytes} bytes`);
    return nameplates_of(fs.readFileSync(file, "utf8"));
  } catch (error) {
    throw new Refusal(`${file}: ${in_words(error)}`);
  }
}
