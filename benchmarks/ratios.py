#!/usr/bin/env python3
"""ratios.py FOLDER   reads FOLDER/solve.json and FOLDER/step.json and prints, for every case,

    case | bough ms | best peer ms (which) | ratio | bar | 2-thread speed-up

bough ms: the better of one and two threads. Ratio: best rival over bough; the rivals are those that the bar names. Steps: bough's step over
KLU's refactorization and solution of the same chain (smaller is better). A figure that misses its bar is marked with '<' (or '>' for
steps). Medians over the repetitions, wall time. Exit 0 whatever the figures are, 2 where no file can be read.
"""
import json
import os
import re
import sys

LATTICE_RIVALS = ("cholmod", "umfpack", "mumps", "superlu")
STEP_BARS = {"chain_128": 0.27, "chain_512": 0.26, "chain_2048": 0.32}
SPEED_UP_BAR = 1.7


def rule(case):
    """(bar, rivals) of a case such as chain_128_u."""
    family, size, values = re.fullmatch(r"(\w+?)_(\d+)_([us])", case).groups()
    if family in ("chain", "star"):
        if values == "s":
            return 5.0, ("eigen_ldlt",)
        if family == "star":
            return 8.0, ("klu",)
        return {"32": 5.0, "8192": 6.0}.get(size, 8.0), ("klu",)
    return (1.5 if family == "lat2" else 1.2), LATTICE_RIVALS


def wants_speed_up(case):
    family, size = case.split("_")[:2]
    return (family == "chain" and int(size) >= 128) or (family.startswith("lat") and int(size) >= 50)


def read_medians(path):
    """{case: {(solver, threads): milliseconds}} of the medians in a file of Google Benchmark, cases in order of size."""
    with open(path, encoding="utf-8") as file:
        data = json.load(file)
    unit = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}
    table = {}
    for row in data["benchmarks"]:
        match = re.match(r"(\w+)/(\w+)/threads:(\d+)", row["run_name"])
        if not match or row.get("aggregate_name") != "median" or row.get("error_occurred"):
            continue
        solver, case, threads = match.groups()
        table.setdefault(case, {})[solver, int(threads)] = row["real_time"] * unit[row["time_unit"]]

    def order(case):
        parts = re.fullmatch(r"(\D+?\d?)_(\d+)_?([us]?)", case)
        return ("us".find(parts[3]), parts[1], int(parts[2])) if parts else (9, case, 0)

    return {case: table[case] for case in sorted(table, key=order)}


def speed_up_text(times, case, solver="bough"):
    if (solver, 1) not in times or (solver, 2) not in times:
        return "-"
    ratio = times[solver, 1] / times[solver, 2]
    return f"{ratio:.2f}" + (" <" if wants_speed_up(case) and ratio < SPEED_UP_BAR else "")


def print_table(head, rows):
    widths = [max(len(row[k]) for row in [head, *rows]) for k in range(len(head))]
    for row in [head, *rows]:
        print(" | ".join(text.ljust(width) for text, width in zip(row, widths)).rstrip())
    print()


def solve_rows(table):
    rows = []
    for case, times in table.items():
        bar, rivals = rule(case)
        own = min((t for (s, _), t in times.items() if s == "bough"), default=None)
        peers = {key: t for key, t in times.items() if key[0] in rivals}
        own_text = f"{own:.3f}" if own else "-"
        if not peers:
            rows.append((case, own_text, "-", "-", f"{bar:g}", speed_up_text(times, case)))
            continue
        (name, threads), best = min(peers.items(), key=lambda item: item[1])
        ratio = f"{best / own:.2f}" + (" <" if best / own < bar else "") if own else "-"
        which = name if threads == 1 else f"{name}, {threads} threads"
        rows.append((case, own_text, f"{best:.3f} ({which})", ratio, f"{bar:g}", speed_up_text(times, case)))
    return rows


def step_rows(table):
    rows = []
    for case, times in table.items():
        own = min((t for (s, _), t in times.items() if s == "bough"), default=None)
        same = min((t for (s, _), t in times.items() if s == "bough_klu"), default=None)
        klu = times.get(("klu", 1))
        if own is None:
            continue
        bar = STEP_BARS.get(case)
        ratio = f"{own / klu:.3f}" + (" >" if bar and own / klu > bar else "") if klu else "-"
        rows.append((case, f"{own:.3f}", f"{same:.3f}" if same else "-", f"{klu:.3f}" if klu else "-", ratio,
                     f"{bar:g}" if bar else "-", speed_up_text(times, case)))
    return rows


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    found = False
    for name, head, make in (
            ("solve.json", ("case", "bough ms", "best peer ms (which)", "ratio", "bar", "2-thread speed-up"), solve_rows),
            ("step.json", ("step of", "bough ms", "bough_klu ms", "klu solve ms", "ratio", "bar", "2-thread speed-up"),
             step_rows)):
        path = os.path.join(sys.argv[1], name)
        if not os.path.exists(path):
            continue
        found = True
        print(path)
        print_table(head, make(read_medians(path)))
    if not found:
        print(f"ratios.py: neither solve.json nor step.json in {sys.argv[1]}; `make bench` writes them", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
