"""A recording that the stand-in of the gateway plays: paused, with a collision, two faults, and one more far behind them."""

from standin_alarms import utc

BEGIN_S = 1_795_000_000.0
LENGTH_S = 60.0


class Playback:
    def __init__(self):
        self.position_s, self.speed, self.playing, self.seeks = 0.0, 1, False, 0
        self.marks = [{"position_s": at, "time": utc(BEGIN_S + at), "kind": kind, "text": text} for at, kind, text in (
            (12.5, "collision", "ROBOT_1.link, <b>table</b>"), (12.6, "fault", "the data of ROBOT_2 are lost"),
            (30.0, "fault", "the loop missed 40 periods"), (48.25, "collision", "ROBOT_1.link, fence"))]

    def state(self):
        return {"file": "/tmp/day.mcap", "state": "playing" if self.playing else "paused", "speed": self.speed, "from": utc(BEGIN_S),
                "to": utc(BEGIN_S + LENGTH_S), "now": utc(BEGIN_S + self.position_s), "now_ns": int(1e9 * (BEGIN_S + self.position_s)),
                "position_s": self.position_s, "length_s": LENGTH_S, "seeks": self.seeks, "gaps": 0, "note": "",
                "mark_count": len(self.marks)}

    def follow(self, message):
        self.playing = message.get("play", self.playing)
        self.speed = message.get("speed", self.speed)
        if "seek_s" in message:
            self.position_s = min(LENGTH_S, max(0.0, message["seek_s"]))
            self.seeks += 1
