// Light or dark: that of the system until the user chooses.

const kKey = "cellmirror.theme";

export function watch_theme(button, changed) {
  const system = window.matchMedia("(prefers-color-scheme: dark)");
  const chosen = () => {
    try {
      return localStorage.getItem(kKey);
    } catch {
      return document.documentElement.dataset.theme ?? null;
    }
  };
  const dark = () => (chosen() ? chosen() === "dark" : system.matches);
  const apply = () => {
    if (chosen()) document.documentElement.dataset.theme = chosen();
    button.setAttribute("aria-pressed", String(dark()));
    changed();
  };
  button.addEventListener("click", () => {
    const next = dark() ? "light" : "dark";
    document.documentElement.dataset.theme = next;
    try {
      localStorage.setItem(kKey, next);
    } catch {
      // Then the choice lasts as long as the page.
    }
    apply();
  });
  system.addEventListener("change", apply);
  apply();
}
