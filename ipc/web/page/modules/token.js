// The token that lets a client command. `cellmirror page` prints an address that ends in #token=...; the part behind #
// is never sent to a server. It is kept for this tab only and removed from the address bar.

const kKey = "cellmirror.token";

export function token_in(fragment) {
  const found = /(?:^#|&)token=([^&]*)/.exec(fragment ?? "");
  if (!found) return null;
  try {
    return decodeURIComponent(found[1]);
  } catch {
    return null;
  }
}

// Where nothing can be stored; it lasts as long as the page.
let unstored = null;

// Browsers that forbid storage throw at the mere name of it.
function tabs_store() {
  try {
    return window.sessionStorage;
  } catch {
    return null;
  }
}

export function take_token(place = window.location, store = tabs_store(), history = window.history) {
  const given = token_in(place.hash);
  if (given !== null) {
    keep_token(given, store);
    const rest = place.hash.replace(/([#&])token=[^&]*&?/, "$1").replace(/[#&]$/, "");
    history.replaceState(null, "", place.pathname + place.search + rest);
  }
  return kept_token(store);
}

export function keep_token(token, store = tabs_store()) {
  unstored = null;
  try {
    if (token) store.setItem(kKey, token);
    else store.removeItem(kKey);
  } catch {
    unstored = token || null;
  }
}

export function kept_token(store = tabs_store()) {
  if (unstored !== null) return unstored;
  try {
    return store.getItem(kKey);
  } catch {
    return null;
  }
}
