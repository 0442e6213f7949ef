// The name by which others see what this person acknowledges: asked for once, kept in this browser.
import {byId, setText} from "./dom.js";

const kKey = "cellmirror.name";
const kMostBytes = 64;

// One word, as SCRIPT takes it: "Ada Lovelace" is sent as Ada_Lovelace. Empty: nothing of it can be a name.
export function name_word(text) {
  let word = String(text ?? "").normalize("NFC").replace(/[^\p{L}\p{M}\p{N}._-]+/gu, "_").replace(/^[_\p{N}.-]+|_+$/gu, "");
  while (new TextEncoder().encode(word).length > kMostBytes) word = [...word].slice(0, -1).join("");
  return word;
}

export function shown_name(word) {
  return String(word ?? "").replace(/_/g, " ");
}

function stored() {
  try {
    return localStorage.getItem(kKey) ?? "";
  } catch {
    return "";
  }
}

export class UserName {
  constructor() {
    this.name_ = name_word(stored());
    this.answer_ = null;
    byId("name-form").addEventListener("submit", (event) => this.given_(event));
    byId("name-cancel").addEventListener("click", () => byId("name-dialog").close());
    byId("name-dialog").addEventListener("close", () => this.answered_());
    byId("alarm-name").addEventListener("click", () => this.ask_());
    this.show_();
  }

  // Resolves to the name, asked for where there is none yet; null: the person gives none.
  asked() {
    return this.name_ ? Promise.resolve(this.name_) : this.ask_();
  }

  ask_() {
    const dialog = byId("name-dialog");
    if (dialog.open) return Promise.resolve(null);
    byId("name-input").value = shown_name(this.name_);
    setText(byId("name-note"), "");
    this.taken_ = false;
    dialog.showModal();
    return new Promise((resolve) => { this.answer_ = resolve; });
  }

  given_(event) {
    event.preventDefault();
    const name = name_word(byId("name-input").value);
    if (!name) {
      setText(byId("name-note"), "A name begins with a letter.");
      return;
    }
    this.name_ = name;
    this.taken_ = true;
    try {
      localStorage.setItem(kKey, name);
    } catch {
      // Then it lasts as long as the page.
    }
    this.show_();
    byId("name-dialog").close();
  }

  answered_() {
    this.answer_?.(this.taken_ ? this.name_ : null);
    this.answer_ = null;
  }

  show_() {
    setText(byId("alarm-name"), this.name_ ? `You are ${shown_name(this.name_)}` : "Your name");
  }
}
