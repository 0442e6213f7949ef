// What scrolls can be reached by the keyboard, and the search has a name for those who do not see it.
"use strict";
addEventListener("load", () => {
  document.querySelector(".md-search").setAttribute("aria-label", "Search");
  for (const area of document.querySelectorAll(".md-search__scrollwrap, .md-typeset__scrollwrap, .md-typeset__table, pre > code")) area.tabIndex = 0;
});
