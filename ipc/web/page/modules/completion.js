// What may come next in a SCRIPT command, and the line that explains it. Made from the command table
// (/api/commands) and the names of the cell (/api/names). Pure functions.

// Positions of a syntax: "POS_ROB <Robot_id> JOINT_ABS <j1> ... <jn>" -> [{text, keywords, parameter}].
export function positions(syntax) {
  const parts = syntax.match(/<[^>]*>|\[[^\]]*\]|\([^)]*\)|\{|\}|[^\s<>[\](){}]+/g) ?? [];
  return parts.filter((part) => part !== "{" && part !== "}").map((text) => {
    if (text.startsWith("<") || text.startsWith("(")) return {text, keywords: [], parameter: text.replace(/[<>()]/g, "")};
    if (text.startsWith("[")) {
      const inside = text.slice(1, -1);
      const first_words = inside.split("|").map((choice) => choice.trim().split(/\s+/)[0].replace(/[<>]/g, ""));
      const is_name = inside.includes("<");
      return {text, keywords: is_name ? first_words.filter((word) => word === word.toUpperCase()) : first_words, parameter: inside};
    }
    return {text, keywords: text === "..." ? [] : [text], parameter: null};
  });
}

const kKinds = [
  [/robot/i, "robots"], [/cam_id|camera/i, "cameras"], [/uss_id|sensor/i, "sensors"], [/script_file/i, "scripts"],
  [/view_file/i, "views"], [/frame|node|wfrm/i, "frames"],
];

export function names_for(parameter, names) {
  const kind = kKinds.find(([pattern]) => pattern.test(parameter ?? ""))?.[1];
  return kind ? names[kind] ?? [] : [];
}

// The words up to the cursor; the last one is being written and may be "".
export function words_before(text, cursor) {
  return text.slice(0, cursor).split(/[\s,]+/).filter((word, i, all) => word !== "" || i === all.length - 1);
}

const same = (a, b) => a.toLowerCase() === b.toLowerCase();

// Forms of the command that the words so far can still become.
export function forms_of(words, commands) {
  const named = commands.filter((command) => words[0] && same(command.name.split(" ")[0], words[0]));
  const fitting = named.filter((command) => {
    const wanted = positions(command.syntax);
    return words.slice(0, -1).every((word, i) => {
      const position = wanted[i];
      const fixed = position && position.parameter === null && position.keywords.length;
      return !fixed || same(position.keywords[0], word);
    });
  });
  return fitting.length ? fitting : named;
}

// Best first: those that begin with what is written, the shortest before all, then those that contain it.
export function ranked(candidates, written, most) {
  const low = written.toLowerCase();
  const begin = [];
  const contain = [];
  const seen = new Set();
  for (const candidate of candidates) {
    if (seen.has(candidate.text)) continue;
    seen.add(candidate.text);
    const at = candidate.text.toLowerCase().indexOf(low);
    if (at === 0) begin.push(candidate);
    else if (at > 0) contain.push(candidate);
  }
  begin.sort((a, b) => a.text.length - b.text.length);
  return [...begin, ...contain].slice(0, most);
}

// [{text, note}] for the word at the cursor.
export function completions(text, cursor, commands, names, most = 10) {
  const words = words_before(text, cursor);
  const written = words[words.length - 1] ?? "";
  if (words.length <= 1) {
    const usable = commands.filter((command) => command.kind === "command");
    return ranked(usable.map((command) => ({text: command.name.split(" ")[0], note: command.help})), written, most);
  }
  const candidates = [];
  for (const form of forms_of(words, commands)) {
    const wanted = positions(form.syntax);
    const position = wanted[Math.min(words.length - 1, wanted.length - 1)];
    const here = words.length - 1 < wanted.length ? [position] : wanted.slice(1).filter(({text: part}) => part.startsWith("["));
    for (const {keywords, parameter} of here) {
      for (const keyword of keywords) candidates.push({text: keyword, note: ""});
      for (const name of names_for(parameter, names)) candidates.push({text: name, note: ""});
    }
  }
  return ranked(candidates, written, most).filter(({text: found}) => found !== written);
}

// The text and cursor after a completion was taken.
export function completed(text, cursor, choice) {
  const begin = text.slice(0, cursor).search(/[^\s,]*$/);
  const end = cursor + text.slice(cursor).search(/[\s,]|$/);
  const rest = text.slice(end);
  const gap = rest === "" ? " " : "";
  return {text: text.slice(0, begin) + choice + gap + rest, cursor: begin + choice.length + 1};
}

// {parts: [{text, here}], help, note}, or null where no command is named yet.
export function help_for(text, cursor, commands) {
  const words = words_before(text, cursor);
  const [form] = forms_of(words, commands);
  if (!form) return null;
  const at = words.length - 1;
  const wanted = positions(form.syntax);
  const here = Math.min(at, wanted.length - 1);
  const meaning = form.parameters?.find(({name}) => name === wanted[here]?.parameter)?.meaning ?? "";
  return {
    parts: wanted.map((position, i) => ({text: position.text, here: i === here})),
    help: form.help ?? "",
    note: [meaning && at > 0 ? `here: ${meaning}` : "", form.missing ? `not there yet: ${form.missing}` : "",
      form.example ? `e.g. ${form.example}` : ""].filter(Boolean).join("; "),
  };
}
