#!/usr/bin/env python3
"""ratios.py FOLDER   reads those of FOLDER/solve.json, matrices.json, step.json, scaling.json, second_thread.json,
motion.json and start.json that exist, and prints tables. All figures are medians over the repetitions.

solve, matrices: one factorization and one solution in wall milliseconds, on one thread and on two, each in its own
table: bough, the fastest of all peers that took part, its name, and the ratio of their times; CPU ratio: the same in
CPU time, which is more reliable if the machine was busy. On two threads every solver has the better of its times with
one and two. A third table has what the ratio leaves out: analysis, solution alone and memory (by each solver's own
account), with the best of the peers in each, and the backward errors. Memory over 8 bytes for each nonzero of L and U:
that of bough's solver, with and without the element matrices, by the least count of a peer (scenes, unsymmetric).
step: bough over KLU's refactorization and solution of the same chain, in six unknowns a node and in the unknowns of the
plan (planar). second_thread: its gain, and the bound of that gain apart from caches, 2 x the time of one thread alone
over that of two at the same time, each with its own work; for arithmetic and reading alone from
benchmarks/bench_machine.json. motion: CPU nanoseconds of one motion, and Eigen's time over bough's. A figure that misses
its bar is marked with '<' or '>'. Exit status 0 whatever the figures are, 2 if no file can be read.
"""
import json
import os
import re
import sys

STEP_BARS = {"chain_128": 0.27, "chain_512": 0.26, "chain_2048": 0.32}
SPEED_UP_BAR = 1.7
MEMORY_BAR = 2.5  # all that the solver holds over 8 bytes for each nonzero of L and U in the best ordering seen
VERSION_BAR, RUN_BAR = 4.0, 5.0  # milliseconds of `bough --version`, and of a run of ten unknowns beyond that


def bar_of(case):
    """Least required ratio of a case such as chain_128_u; None: none is required."""
    match = re.fullmatch(r"(chain|star|lat2|lat3)_(\d+)_([us])", case)
    if not match:
        return None
    family, size, values = match.groups()
    if family in ("chain", "star"):
        if values == "s":
            return 5.0
        return 8.0 if family == "star" else {"32": 5.0, "8192": 6.0}.get(size, 8.0)
    return 1.5 if family == "lat2" else 1.2


def wants_speed_up(case):
    if bar_of(case) is None and case not in STEP_BARS:
        return False
    family, size = case.split("_")[:2]
    return (family == "chain" and int(size) >= 128) or (family.startswith("lat") and int(size) >= 50)


def read_medians(path):
    """{case: {(solver, threads): (wall, CPU) ms}} of the medians in a file of Google Benchmark, in order of size."""
    with open(path, encoding="utf-8") as file:
        data = json.load(file)
    unit = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}
    table = {}
    for row in data["benchmarks"]:
        match = re.match(r"(\w+)/(\w+)/threads:(\d+)", row["run_name"])
        if not match or row.get("aggregate_name") != "median" or row.get("error_occurred"):
            continue
        solver, case, threads = match.groups()
        table.setdefault(case, {})[solver, int(threads)] = tuple(
            row[time] * unit[row["time_unit"]] for time in ("real_time", "cpu_time"))

    def order(case):
        parts = re.fullmatch(r"(\D+?\d?)_(\d+)_?([us]?)", case)
        return ("us".find(parts[3]), parts[1], int(parts[2])) if parts else (9, case, 0)

    return {case: table[case] for case in sorted(table, key=order)}


def speed_up_text(times, case, solver="bough"):
    if (solver, 1) not in times or (solver, 2) not in times:
        return "-"
    ratio = times[solver, 1][0] / times[solver, 2][0]
    return f"{ratio:.2f}" + (" <" if wants_speed_up(case) and ratio < SPEED_UP_BAR else "")


def print_table(head, rows):
    widths = [max(len(row[k]) for row in [head, *rows]) for k in range(len(head))]
    for row in [head, *rows]:
        print(" | ".join(text.ljust(width) for text, width in zip(row, widths)).rstrip())
    print()


def least(times, solvers, kind=0):
    """((solver, threads), milliseconds) of the fastest among the solvers; kind 0: wall, 1: CPU of one thread."""
    found = [(key, t[kind]) for key, t in times.items() if key[0] in solvers and (kind == 0 or key[1] == 1)]
    return min(found, key=lambda item: item[1]) if found else (None, None)


def number(value, digits=3):
    return "-" if value is None else f"{value:.{digits}f}"


def read_entries(path):
    """{case: {(solver, threads): row of Google Benchmark}} of the medians, or of the failures of bough."""
    with open(path, encoding="utf-8") as file:
        data = json.load(file)
    table = {}
    for row in data["benchmarks"]:
        match = re.match(r"(\w+)/([^/]+)/threads:(\d+)", row["run_name"])
        if match and (row.get("aggregate_name") == "median" or row.get("error_occurred")):
            table.setdefault(match[2], {})[match[1], int(match[3])] = row
    return table


def best_of(rows, key, most_threads):
    """(figure, solver) that is least among rows of the solvers that have it on at most so many threads."""
    found = [(row[key], solver) for (solver, threads), row in rows
             if threads <= most_threads and row.get(key, 0.0) > 0.0 and not row.get("error_occurred")]
    return min(found) if found else (None, "-")


def solve_rows(entries, threads):
    rows = []
    for case, found in entries.items():
        own = [item for item in found.items() if item[0][0] == "bough"]
        peers = [item for item in found.items() if item[0][0] != "bough"]
        bar = bar_of(case)
        row, ratios = [case], []
        for key in ("real_time", "cpu_time"):
            (mine, _), (best, who) = best_of(own, key, threads), best_of(peers, key, threads)
            ratios.append(best / mine if best and mine else None)
            if key == "real_time":
                row += [number(mine) if mine else error_of(own), number(best), who]
        ratio = number(ratios[0], 2) + (" <" if ratios[0] and bar and ratios[0] < bar else "")
        row += [ratio, f"{bar:g}" if bar else "-"]
        if threads == 1:
            row.append(number(ratios[1], 2))
        else:
            times = {key: (r["real_time"], r["cpu_time"]) for key, r in own if not r.get("error_occurred")}
            row.append(speed_up_text(times, case))
        rows.append(tuple(row))
    return rows


def error_of(own):
    return next((row.get("error_message", "failed") for _, row in own if row.get("error_occurred")), "-")


def other_rows(entries):
    """Analysis, solution alone, memory and backward error on one thread, each beside the best of the peers."""
    rows = []
    for case, found in entries.items():
        own = [item for item in found.items() if item[0][0] == "bough"]
        peers = [item for item in found.items() if item[0][0] != "bough"]
        row = [case]
        for key, scale, digits in (("analysis_ms", 1.0, 2), ("solve_ms", 1.0, 4), ("memory_bytes", 1e-6, 2)):
            rivals = [item for item in peers if key != "analysis_ms" or item[0][0] != "superlu"]  # it orders later
            (mine, _), (best, who) = best_of(own, key, 1), best_of(rivals, key, 1)
            row += [number(mine * scale if mine else None, digits),
                    number(best * scale if best else None, digits) + ("" if best is None else f" {who}")]
        for group in (own, peers):
            worst = [r["backward_error"] for (_, threads), r in group if threads == 1 and "backward_error" in r]
            row.append(f"{max(worst):.1e}" if worst else "-")
        label = next((r.get("label", "") for _, r in own), "")
        rows.append((*row, label.partition(", ")[2] or "-"))
    return rows


def memory_rows(path):
    """Unsymmetric cases: memory of bough, and the least nonzeros of L and U among the peers that report them."""
    with open(path, encoding="utf-8") as file:
        data = json.load(file)
    found = {}
    for row in data["benchmarks"]:
        case = row["run_name"].split("/")[1]
        if row.get("aggregate_name") == "median" and case.endswith("_u"):
            if not row["run_name"].startswith("bough"):
                row = {"factor_entries": row.get("factor_entries", float("inf"))}
            memory, matrix, entries = found.get(case, (0.0, 0.0, float("inf")))
            found[case] = (row.get("memory_bytes", memory), row.get("matrix_bytes", matrix),
                           min(entries, row.get("factor_entries", entries)))
    rows = []
    def share(count, entries):
        ratio = count / (8.0 * entries)
        return f"{ratio:.2f}" + (" >" if ratio > MEMORY_BAR else "")
    for case, (memory, matrix, entries) in sorted(found.items(), key=lambda of: of[1][2]):
        if memory > 0.0 and entries < float("inf"):
            rows.append((case, f"{memory / 1e6:.2f}", f"{entries / 1e6:.3f}", share(memory, entries), share(memory - matrix, entries)))
    return rows


def step_rows(table):
    rows = []
    for case, times in table.items():
        own, same, klu = (least(times, (solver,))[1] for solver in ("bough", "bough_klu", "klu"))
        own_cpu, klu_cpu = (least(times, (solver,), 1)[1] for solver in ("bough", "klu"))
        bar = STEP_BARS.get(case)
        ratio = own / klu if own and klu else None
        planar = least(times, ("klu_planar",))[1]
        rows.append((case, number(own), number(same), number(klu),
                     number(ratio) + (" >" if ratio and bar and ratio > bar else ""), f"{bar:g}" if bar else "-",
                     number(planar), number(own / planar if own and planar else None),
                     speed_up_text(times, case), number(own_cpu / klu_cpu if own_cpu and klu_cpu else None)))
    return rows


def split_rows(path):
    """Times of the phases of a step, and its work: the counters of bench_step on one thread."""
    names = ("evaluate_ms", "factor_ms", "solve_ms", "update_ms", "output_ms", "iterations_a_step", "factorizations_a_step")
    with open(path, encoding="utf-8") as file:
        rows = json.load(file)["benchmarks"]
    return [(re.sub("/threads:1.*", "", row["run_name"]), *(number(row[name], 2) for name in names)) for row in rows
            if row.get("aggregate_name") == "median" and "/threads:1" in row["run_name"] and names[0] in row]


def print_scaling(path):
    """CPU time of a step over the number of links; largest over smallest shows how far growth is from linear."""
    table = read_medians(path)
    rows = []
    for case, times in table.items():
        links = int(case.split("_")[1])
        one, two = times["bough", 1], times.get(("bough", 2), (None, None))
        rows.append((case, number(one[0]), number(two[0]), number(1e3 * one[1] / links)))
    print_table(("step of", "1 thread ms", "2 threads ms", "CPU us a link"), rows)
    costs = [float(row[3]) for row in rows]
    print(f"most over least: {max(costs) / min(costs):.2f} (bar 1.5)")


def second_thread_rows(paths):
    """Gain by a second thread, and its bound apart from caches: medians of the counters of rows second_thread/WORK."""
    rows = []
    for path in paths:
        if not os.path.exists(path):
            continue
        with open(path, encoding="utf-8") as file:
            found = json.load(file)["benchmarks"]
        for row in found:
            match = re.match(r"second_thread/(\w+(?:/KiB:\d+)?)", row["run_name"])
            if match and row.get("aggregate_name") == "median" and not row.get("error_occurred"):
                gained, bound = row.get("gained"), row["bound"]
                rows.append((match[1], number(row["alone"], 4), number(row["side_by_side"], 4), number(row.get("together"), 4),
                             number(gained, 2), number(bound, 2), number(gained / bound if gained else None, 2)))

    def order(row):
        return row[4] == "-", [int(size) for size in re.findall(r"\d+", row[0])]

    return sorted(rows, key=order)


def motion_rows(path):
    """CPU time of one motion, by bough in double, in a lane of eight, and by Eigen."""
    with open(path, encoding="utf-8") as file:
        rows = json.load(file)["benchmarks"]
    times = {}
    for row in rows:
        if row.get("aggregate_name") == "median":
            who, operator = row["run_name"].split("/")[:2]
            times.setdefault(operator, {})[who] = 1e9 * row["each"]
    return [(operator, number(t["bough"], 1), number(t["lanes"], 1), number(t["eigen"], 1), number(t["eigen"] / t["bough"], 2),
             number(t["eigen"] / t["lanes"], 2)) for operator, t in times.items()]


def start_rows(path):
    """Medians of whole processes; for a run also the time beyond that of `bough --version`."""
    with open(path, encoding="utf-8") as file:
        rows = json.load(file)["benchmarks"]
    times = {row["run_name"].split("/")[1]: (row["real_time"], row["cpu_ms"], row["faults"]) for row in rows
             if row.get("aggregate_name") == "median" and not row.get("error_occurred")}

    def with_bar(value, bar):
        return f"{bar:g}" + (" >" if value > bar else "")

    out = [(name, *(number(value, 2) for value in t[:2]), f"{t[2]:.0f}",
            with_bar(t[0], VERSION_BAR) if name == "version" else "-") for name, t in times.items()]
    if "version" in times and "ten_unknowns" in times:
        wall, cpu, faults = (b - a for a, b in zip(times["version"], times["ten_unknowns"]))
        out.append(("ten_unknowns less version", number(wall, 2), number(cpu, 2), f"{faults:.0f}",
                    with_bar(wall, RUN_BAR)))
    return out


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    found = False
    paths = {name: os.path.join(sys.argv[1], name + ".json") for name in ("solve", "matrices", "step", "scaling", "second_thread", "motion", "start")}
    for name, path in paths.items():
        if not os.path.exists(path):
            continue
        found = True
        with open(path, encoding="utf-8") as file:
            context = json.load(file)["context"]
        load = context.get("load_avg", [0.0])[0]
        print(f"{path}: {context.get('commit', 'unknown')}, load at the start {load:.1f} on {context['num_cpus']} processors")
        if name in ("solve", "matrices"):
            entries = read_entries(path)
            print_table(("one thread", "bough ms", "fastest peer ms", "which", "ratio", "bar", "CPU ratio"),
                        solve_rows(entries, 1))
            print_table(("two threads", "bough ms", "fastest peer ms", "which", "ratio", "bar", "gain by the second"),
                        solve_rows(entries, 2))
            print_table(("case", "analysis ms", "peer", "solution ms", "peer", "MB", "peer", "backward error",
                         "worst of peers", "bough found"), other_rows(entries))
            if name == "solve":
                print_table(("memory", "bough MB", "million nonzeros of L+U", "MB / 8 bytes of each",
                             "without the matrix"), memory_rows(path))
        elif name == "step":
            print_table(("step of", "bough ms", "bough_klu ms", "klu solve ms", "ratio", "bar", "planar klu ms", "ratio",
                         "2-thread speed-up", "CPU ratio"), step_rows(read_medians(path)))
            print_table(("1 thread, CPU ms a step", "evaluate", "factor", "solve", "update", "output", "iterations",
                         "factorizations"), split_rows(path))
        elif name == "second_thread":
            machine = os.path.join(sys.argv[1], "benchmarks", "bench_machine.json")
            print_table(("second thread", "alone ms", "side by side ms", "together ms", "gained", "bound", "gained / bound"),
                        second_thread_rows((path, machine)))
        elif name == "motion":
            print_table(("motion", "bough ns", "a lane ns", "eigen ns", "eigen/bough", "eigen/lane"), motion_rows(path))
        elif name == "start":
            print_table(("process", "wall ms", "CPU ms", "page faults", "bar"), start_rows(path))
        else:
            print_scaling(path)
    if not found:
        print(f"ratios.py: none of {', '.join(n + '.json' for n in paths)} in {sys.argv[1]}; `make bench` writes all but scaling.json", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
