// A foreseeable failure: what is wrong, and what helps.
export class Refusal extends Error {
  constructor(what, remedy = "") {
    super(what);
    this.remedy = remedy;
  }
}

// One line for people.
export function in_words(error) {
  const text = error instanceof Error ? error.message : String(error);
  return error instanceof Refusal && error.remedy ? `${text}; ${error.remedy}` : text;
}
