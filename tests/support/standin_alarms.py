"""Alarms of the stand-in of the gateway: some of each state, which can be acknowledged."""

import datetime
import time


def utc(at_s):
    return datetime.datetime.fromtimestamp(at_s, datetime.timezone.utc).isoformat(timespec="milliseconds").replace("+00:00", "Z")


class Alarms:
    def __init__(self):
        self.revision = 1
        self.start_s = time.time()
        self.open = [
            self.alarm(4, "stream", "ROBOT_7", "the data of ROBOT_7 are lost: silent for 2.0 s", "high", 5),
            self.alarm(3, "near", "ROBOT_1.link \u2013 Table_1.top", "ROBOT_1.link and Table_1.top are nearer than 100 mm", "low", 20, times=3),
            self.alarm(2, "tear", "<b>liver</b>", "<b>liver</b> tears", "medium", 95, over=94)]
        self.history = [self.alarm(1, "problem", "recording", "the disk was full", "medium", 4000, over=3900, by="Ada_Lovelace")]

    def alarm(self, number, kind, subject, text, priority, ago_s, over=None, by="", times=1):
        at = self.start_s - ago_s
        state = "normal" if by else "cleared_unacknowledged" if over else "active_unacknowledged"
        return {"id": number, "kind": kind, "subject": subject, "text": text, "priority": priority, "state": state, "time": utc(at),
                "age_s": ago_s, "first_time": utc(at - 30), "occurrences": times, "cleared_time": utc(self.start_s - over) if over else None,
                "acknowledged_time": utc(at + 10) if by else None, "acknowledged_by": by}

    def counts(self):
        waiting = [alarm for alarm in self.open if not alarm["acknowledged_by"]]
        highest = next((word for word in ("high", "medium", "low") if any(alarm["priority"] == word for alarm in waiting)), None)
        return {"revision": self.revision, "unacknowledged": len(waiting), "highest_priority": highest,
                "active": sum(alarm["cleared_time"] is None for alarm in self.open)}

    def document(self):
        return {**self.counts(), "open": self.open, "open_count": len(self.open), "history": self.history,
                "history_count": len(self.history), "not_listed": 0, "file": "", "problem": "", "refused_lines": 0}

    def acknowledge(self, _, rest):
        """ALARM_ACK <name> [alarm]: what is wrong with it, or None."""
        if not rest or rest[0][0].isdigit():
            return "a name does not begin with a digit"
        for alarm in list(self.open):
            if rest[1:] not in ([], [str(alarm["id"])]) or alarm["acknowledged_by"]:
                continue
            alarm.update(acknowledged_by=rest[0], acknowledged_time=utc(time.time()), state="active_acknowledged")
            if alarm["cleared_time"]:
                self.open.remove(alarm)
                self.history.insert(0, {**alarm, "state": "normal"})
        self.revision += 1
        return None
