// Asks before something is done that is easily done by a slip.
import {byId, setText} from "./dom.js";

// True where the person agrees; Escape and Cancel are a no.
export function confirmed(question, consequence, agree) {
  const dialog = byId("confirm-dialog");
  if (dialog.open) return Promise.resolve(false);
  setText(byId("confirm-title"), question);
  setText(byId("confirm-text"), consequence);
  setText(byId("confirm-yes"), agree);
  dialog.returnValue = "";
  dialog.showModal();
  byId("confirm-no").focus();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => resolve(dialog.returnValue === "yes"), {once: true});
  });
}
