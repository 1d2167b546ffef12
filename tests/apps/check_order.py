#!/usr/bin/env python3
"""check_order.py PROGRAM SWEEPS STRIDE   what a batch does to the disk, seen by strace. Order, for power may fail: no file
gets its final name before its content is on the disk, tables come after the journal and the stores are on it, and a
result is stored before the journal tells of it, in one write. Faults: every STRIDE-th write, fsync, fdatasync and rename
fails in turn; the sweep ends in words, and --resume gives the tables of an undisturbed one. Needs strace (else 77)."""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

program, sweeps, stride = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve(), int(sys.argv[3])
if shutil.which("strace") is None or subprocess.run(["strace", "-o", "/dev/null", "true"]).returncode != 0:
    print("strace cannot be used here")
    sys.exit(77)
CALLS = "write,pwrite64,fsync,fdatasync,rename,renameat,renameat2,ftruncate,unlink,unlinkat"
TABLES = ["batch.csv", "batch.json", "batch.html", "cost.csv"]
failures = []
checks = 0


def check(good, what):
    global checks
    checks += 1
    if not good:
        failures.append(what)


def sweep_file(folder, cases):
    file = folder / "sweep.json"
    file.write_text(json.dumps({
        "schema_version": 1, "scene": str(sweeps.parent / "scenarios" / "pendulum.json"),
        "set": [{"pointer": "/analysis/end_time", "value": 0.02}, {"pointer": "/expected", "value": []}],
        "designs": [{"kind": "random", "samples": cases, "variables": [
            {"name": "g", "pointer": "/gravity/2", "distribution": {"kind": "uniform", "low": -10, "high": -9}}]}]}))
    return file


def events(trace):
    """(call, files, result) in the order of their ends; -y shows the files of descriptors."""
    pending = {}
    for line in trace.read_text(errors="replace").splitlines():
        process, _, text = line.partition(" ")
        text = text.strip()
        if text.endswith("<unfinished ...>"):
            pending[process] = text[:-len("<unfinished ...>")]
            continue
        resumed = re.match(r"<\.\.\. \w+ resumed>", text)
        if resumed:
            text = pending.pop(process, "") + text[resumed.end():]
        call = re.match(r"(\w+)\((.*)\)\s+= (-?\d+)", text)
        if call:
            name, words = call.group(1), call.group(2)
            files = re.findall(r"\d+<([^>]*)>", words)[:1] if name in ("write", "pwrite64", "fsync", "fdatasync", "ftruncate") \
                else re.findall(r"\"((?:[^\"\\]|\\.)*)\"", words)
            yield name, [pathlib.Path(f).name for f in files], files, int(call.group(3))


def look_at_order(what, words, out):
    trace = out.parent / "trace"
    subprocess.run(["strace", "-f", "-y", "-s", "0", "-e", f"trace={CALLS}", "-o", str(trace), program, *map(str, words), "--out",
                    str(out)], stdout=subprocess.DEVNULL)
    written, stores, folders, journal = {}, 0, 0, 0
    last_store_sync = last_journal_sync = True
    names_renamed = []
    for name, short, files, result in events(trace):
        if result < 0 or not files:
            continue
        if name in ("write", "pwrite64"):
            written[files[0]] = False
            if short[0] == "journal.jsonl":
                journal += 1
                last_journal_sync = False
                check(max(stores, folders) >= journal, f"{what}: the journal tells of a result before it is there")
            if short[0].startswith("store_"):
                stores += 1
                last_store_sync = False
        elif name in ("fsync", "fdatasync"):
            written[files[0]] = True
            last_journal_sync |= short[0] == "journal.jsonl"
            last_store_sync |= short[0].startswith("store_")
        elif name.startswith("rename"):
            begin, end = files[0], files[-1]
            inside = [file for file in written if file == begin or file.startswith(begin + "/")]
            if re.fullmatch(r"\..*\.bough-new", short[0]):  # a folder that takes its place
                folders += 1
                check(all(written[file] for file in inside),
                      f"{what}: {short[-1]} got its name before {[f for f in inside if not written[f]]} were on the disk")
            elif ".bough-new/" not in begin and short[-1] != "manifest.json":  # that only lists names, and is made again
                check(all(written[file] for file in inside), f"{what}: {short[-1]} got its name before its content was on the disk")
            for file in inside:
                written[end + file[len(begin):]] = written.pop(file)
            names_renamed.append(short[-1])
            if short[-1] == "batch.csv":
                check(last_journal_sync, f"{what}: the table came before the journal was on the disk")
                check(last_store_sync, f"{what}: the table came before the stores were on the disk")
    check("batch.csv" in names_renamed and journal > 0, f"{what}: nothing was seen of the table or the journal")
    return stores, folders, journal


def same(whole, out):
    return all((whole / name).read_bytes() == (out / name).read_bytes() for name in TABLES if name != "cost.csv")


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    many = sweep_file(folder, 205)
    stores, _, journal = look_at_order("stored", ["sweep", many, "--quiet", "--threads", "1"], folder / "many")
    check(stores == journal == 205, f"stored: {stores} writes to stores and {journal} to the journal of 205 cases")
    _, folders, journal = look_at_order("folders", ["sweep", sweep_file(folder, 4), "--quiet", "--threads", "1"], folder / "few")
    check(folders == journal == 4, f"folders: {folders} took their place, and {journal} lines are in the journal, of 4 cases")
    words = ["sweep", sweep_file(folder, 4), "--quiet", "--threads", "1"]
    for keep in ["all", "none"]:
        out = folder / f"whole {keep}"
        check(subprocess.run([program, *map(str, words), "--out", str(out), "--keep", keep]).returncode == 0, "undisturbed")
    for keep in ["all", "none"]:
        whole = folder / f"whole {keep}"
        for call in ["write", "fsync", "fdatasync", "rename", "renameat2"]:
            for number in range(1, 400, stride):
                out = folder / "out"
                shutil.rmtree(out, ignore_errors=True)
                trace = folder / "trace"
                done = subprocess.run(
                    ["strace", "-f", "-o", str(trace), "-e", f"trace={call}", "-e", f"inject={call}:error=ENOSPC:when={number}",
                     program, *map(str, words), "--out", str(out), "--keep", keep], capture_output=True, text=True)
                if "INJECTED" not in trace.read_text(errors="replace"):
                    break  # past the last call
                what = f"{call} {number}, --keep {keep}"
                check(done.returncode in (0, 1, 2, 3), f"{what}: status {done.returncode}")
                check(done.returncode == 0 or done.stderr or call == "write", f"{what}: not a word")
                done = subprocess.run([program, *map(str, words), "--out", str(out), "--keep", keep, "--resume"],
                                      capture_output=True, text=True)
                check(done.returncode == 0, f"{what}: --resume ends with {done.returncode}: {done.stderr[-200:]}")
                check(done.returncode != 0 or same(whole, out), f"{what}: the tables are not those of an undisturbed sweep")
for failure in failures[:20]:
    print("FAIL:", failure)
print(f"{checks} checks, {len(failures)} failures")
sys.exit(1 if failures else 0)
