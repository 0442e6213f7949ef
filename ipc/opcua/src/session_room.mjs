// Keeps a place for the next client: sessions that nobody closed would else lock all clients out until they time out, which
// node-opcua allows after up to 50 minutes.

// The session to close so that a client gets in, null while there is a free place. `sessions`: {address, silent_ms}
// with the newest one at the end, which is never chosen. The address with the most sessions gives one up, so that a client
// cannot push out those of other machines; of its sessions the one that has been silent for the longest time.
export function session_to_close(sessions, most) {
  if (sessions.length < most) return null;
  const older = sessions.slice(0, -1);
  const count = new Map();
  for (const {address} of sessions) count.set(address, (count.get(address) ?? 0) + 1);
  const before = (a, b) => count.get(b.address) - count.get(a.address) || b.silent_ms - a.silent_ms;
  return older.sort(before)[0] ?? null;
}

// Closes sessions of `server`, an OPCUAServer, so that one of its `most` places is free after each new session.
export function keep_room(server, most, say) {
  const open = new Map(); // address by session
  server.on("session_closed", (session) => open.delete(session));
  server.on("create_session", (session) => {
    // The address is kept: a session whose connection was lost has none any more.
    open.set(session, session.channel?.remoteAddress ?? "");
    const sessions = [...open].map(([one, address]) => ({session: one, address, silent_ms: one.clientLastContactTime}));
    const chosen = session_to_close(sessions, most);
    if (!chosen) return;
    open.delete(chosen.session);
    server.engine.closeSession(chosen.session.authenticationToken, true, "Terminated");
    say(`the session of ${chosen.address || "an unknown address"} that was silent for the longest time is closed: ${most} sessions are open`);
  });
}
