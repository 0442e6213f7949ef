// Labels that are cut where room is short: those that begin alike lose what they have in common, so that the part in which they
// differ is what is seen. Pure.

const kShort = 10;  // characters: shorter ones need nothing

function common_start(texts) {
  let common = texts[0];
  for (const text of texts) {
    while (!text.startsWith(common)) common = common.slice(0, -1);
  }
  return common;
}

// At a border of words, so that what is left is a word: behind one of _ . - / and spaces.
export function short_labels(texts) {
  if (texts.length < 2 || texts.every((text) => text.length <= kShort)) return texts;
  const common = common_start(texts);
  const cut = Math.max(...["_", ".", "-", "/", " "].map((border) => common.lastIndexOf(border))) + 1;
  if (cut < 3) return texts.map(shortened_);
  return texts.map((text) => shortened_(`\u2026${text.slice(cut)}`));
}

// A long one keeps its beginning and its end.
function shortened_(text) {
  const kLongest = 28;
  return text.length <= kLongest ? text : `${text.slice(0, 13)}\u2026${text.slice(-14)}`;
}
