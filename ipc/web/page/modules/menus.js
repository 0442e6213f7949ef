// Menus are <details class="menu">: one is open at a time, and closes by Escape or by a touch beside it.

export function watch_menus() {
  const open_menus = () => [...document.querySelectorAll("details.menu[open]")];
  document.addEventListener("pointerdown", (event) => {
    for (const menu of open_menus()) if (!menu.contains(event.target)) menu.open = false;
  });
  document.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    for (const menu of open_menus()) {
      menu.open = false;
      menu.querySelector("summary").focus();
    }
  });
}
