#!/usr/bin/env python3
"""Wake-up latency of our cyclic thread against cyclictest's (package rt-tests), in turns within one run.

bench_tick_latency.py [--bin FOLDER] [--seconds 60] [--rounds 6] [--priority 80] [--period-us 1000] [--json]

Each of the two runs --seconds in all, divided into --rounds turns, so that a busy quarter of an hour of the machine hits
both. Both count whole microseconds, rounded down. Exit code 1 where the ratio of the p99.9 is above --limit.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
from collections import Counter


def run_ours(program, seconds, options):
    output = subprocess.run([program, str(seconds), str(options.priority), str(options.period_us)],
                            check=True, capture_output=True, text=True, timeout=seconds + 30).stdout
    result = json.loads(output)
    if result["scheduler"] != "SCHED_FIFO":
        sys.exit("our thread got no SCHED_FIFO: run as root (the comparison would be unfair)")
    return result


def run_cyclictest(seconds, options):
    """Histogram {us: count}; cyclictest prints 'us count' lines, everything else begins with '#'."""
    command = ["cyclictest", "--mlockall", "--threads=1", f"--priority={options.priority}", "--policy=fifo",
               f"--interval={options.period_us}", f"--duration={seconds}", "--histogram=20000", "--quiet"]
    output = subprocess.run(command, check=True, capture_output=True, text=True, timeout=seconds + 30).stdout
    histogram = Counter()
    for line in output.splitlines():
        fields = line.split()
        if len(fields) == 2 and fields[0].isdigit() and fields[1].isdigit():
            histogram[int(fields[0])] += int(fields[1])
        elif line.startswith("# Histogram Overflows:"):
            histogram[20000] += sum(int(field) for field in fields[3:])
    return histogram


def percentile(histogram, percent):
    wanted = -(-sum(histogram.values()) * percent // 100)  # rounded up
    seen = 0
    for us in sorted(histogram):
        seen += histogram[us]
        if seen >= wanted:
            return us
    return 0


def summary(histogram):
    return {"samples": sum(histogram.values()), "p50_us": percentile(histogram, 50), "p99_us": percentile(histogram, 99),
            "p999_us": percentile(histogram, 99.9), "max_us": max((us for us in histogram if histogram[us]), default=0)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    here = os.path.dirname(os.path.abspath(__file__))
    parser.add_argument("--bin", default=os.path.join(here, "../../../build/bin"), help="folder of rt_tick_latency")
    parser.add_argument("--seconds", type=int, default=60, help="of each of the two, in all")
    parser.add_argument("--rounds", type=int, default=6)
    parser.add_argument("--priority", type=int, default=80)
    parser.add_argument("--period-us", type=int, default=1000)
    parser.add_argument("--limit", type=float, default=1.25, help="largest ratio of the p99.9 that passes")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    if shutil.which("cyclictest") is None:
        sys.exit("cyclictest is missing; install rt-tests")
    turn = max(1, options.seconds // options.rounds)
    program = os.path.join(options.bin, "rt_tick_latency")

    ours, theirs = Counter(), Counter()
    disturbed = Counter()
    ratios = []
    for number in range(options.rounds):
        def turn_of_ours():
            result = run_ours(program, turn, options)
            for key in ("cycles", "missed", "minor_faults", "major_faults", "voluntary_switches"):
                disturbed[key] += result[key]
            return Counter({int(us): count for us, count in result["wakeup_us"].items()})
        # Who is first alternates.
        if number % 2 == 0:
            mine = turn_of_ours()
            other = run_cyclictest(turn, options)
        else:
            other = run_cyclictest(turn, options)
            mine = turn_of_ours()
        ours += mine
        theirs += other
        ratios.append(percentile(mine, 99.9) / max(1, percentile(other, 99.9)))
    result = {"cellmirror": summary(ours), "cyclictest": summary(theirs), "counters": dict(disturbed),
              "p999_ratio_by_round": [round(ratio, 2) for ratio in ratios]}
    result["p999_ratio"] = round(result["cellmirror"]["p999_us"] / max(1, result["cyclictest"]["p999_us"]), 3)
    if options.json:
        print(json.dumps(result, indent=2))
    else:
        print(f"{'':12}{'samples':>9}{'p50 us':>9}{'p99 us':>9}{'p99.9 us':>10}{'max us':>9}")
        for name in ("cellmirror", "cyclictest"):
            row = result[name]
            print(f"{name:12}{row['samples']:>9}{row['p50_us']:>9}{row['p99_us']:>9}{row['p999_us']:>10}{row['max_us']:>9}")
        print(f"ratio of p99.9: {result['p999_ratio']} (limit {options.limit}); by round {result['p999_ratio_by_round']}")
        print("counters: " + ", ".join(f"{key} {value}" for key, value in result["counters"].items()))
    return 0 if result["p999_ratio"] <= options.limit else 1


if __name__ == "__main__":
    sys.exit(main())
