// "2026-11-24T10:00:00.123Z" as people read it, without the day where `like` is of the same.
export function utc_time(text, like = "") {
  const [day, time = ""] = String(text ?? "").split("T");
  const shown = time.replace("Z", "");
  return day === String(like).split("T")[0] ? shown : `${day} ${shown}`;
}
