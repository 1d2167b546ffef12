#!/usr/bin/env python3
"""check_shards.py PROGRAM SWEEPS [ENGINE...]   one sweep and one folder of scenes in shards: started by hand, by GNU
parallel, by mpirun, and with the environments of Slurm arrays and of indexed jobs of Kubernetes. The collected tables are
those of one machine, byte for byte. Engines that are not there are told and left out; `hand` needs none. A shard that is
told to stop, as queues do ahead of their limit of time, ends with status 3 and goes on."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

program, sweeps = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
engines = sys.argv[3:] or ["hand", "environments", "parallel", "mpirun"]
failures, told = [], []
TABLES = ["batch.csv", "batch.json", "sensitivities.csv"]
QUEUE = ("SLURM_", "OMPI_", "JOB_COMPLETION")


def run(words, environment=None, cwd=None):
    clean = {k: v for k, v in os.environ.items() if not k.startswith(QUEUE)}
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, cwd=cwd,
                          env={**clean, **(environment or {})})
    return done.returncode, done.stdout + done.stderr


def expect(what, got, status, word=""):
    if got[0] != status or word not in got[1]:
        failures.append(f"{what}: status {got[0]} instead of {status}, or without \"{word}\": {got[1][-300:]}")


def same_tables(what, whole, collected):
    for name in TABLES:
        if (whole / name).exists() and (collected / name).read_bytes() != (whole / name).read_bytes():
            failures.append(f"{what}: {name} is not that of one machine")


def by_hand(folder, sweep, whole):
    out = folder / "by hand"
    expect("collect nothing", run(["batch", "--collect", folder / "none", "--out", out]), 2, "cannot read")
    # any mixture of partitions will do, and what is missing is named
    for shard in ["1/3", "2/4", "4/4"]:
        expect(shard, run(["sweep", sweep, "--out", out, "--shard", shard, "--threads", "2"]), 0, "from the command line")
    expect("not whole", run(["batch", "--collect", out, "--out", folder / "part"]), 3, "cases are missing")
    for shard in ["2/3", "3/3"]:
        expect(shard, run(["sweep", sweep, "--out", out, "--shard", shard, "--quiet"]), 0)
    expect("collect", run(["batch", "--collect", out, "--out", out]), 0)
    same_tables("by hand", whole, out)
    moved = folder / "moved"
    shutil.copytree(out, moved)
    expect("moved", run(["batch", "--collect", moved, "--out", folder / "of moved"]), 0)
    same_tables("moved", whole, folder / "of moved")
    # a shard of other arithmetic is marked, one of another program or scene is refused
    other = next(moved.glob("shard_004*")) / "shard.json"
    record = json.loads(other.read_text())
    other.write_text(json.dumps({**record, "instruction_set": "other"}))
    expect("mixed", run(["batch", "--collect", moved, "--out", folder / "mixed"]), 0, "different arithmetic")
    if not (folder / "mixed" / "batch.csv").read_text().splitlines()[0].endswith(",machine"):
        failures.append("rows of different machines are not marked")
    for name, word in [("program", "another build"), ("content", "another scene"), ("cases", "another list")]:
        other.write_text(json.dumps({**record, name: "other"}))
        expect(name, run(["batch", "--collect", moved, "--out", folder / "refused"]), 2, word)
    for shard in ["0/3", "4/3", "x/3", "3", "3/", "/3", "auto/0", "-1/3"]:
        expect(shard, run(["sweep", sweep, "--out", folder / "bad", "--shard", shard]), 2, "shard")
    expect("another list", run(["sweep", sweeps / "rotor_clearance.json", "--out", out, "--shard", "1/2"]), 2,
           "the cases of another batch")


def of_folders(folder):
    scenes = folder / "scenes's"
    scenes.mkdir()
    for name in ["pendulum", "double_pendulum", "elastica", "free_body"]:
        shutil.copy(sweeps.parent / "scenarios" / f"{name}.json", scenes)
    (scenes / "bad.json").write_text("{")
    expect("whole batch", run(["batch", scenes, "--out", folder / "batch"]), 1)
    out = folder / "batch's shards"
    statuses = [run(["batch", scenes, "--out", out, "--shard", f"{i}/3"])[0] for i in (1, 2, 3)]
    if sorted(statuses) != [0, 0, 1]:
        failures.append(f"statuses of the shards of a batch: {statuses}")
    expect("collect batch", run(["batch", "--collect", out, "--out", folder / "batch collected"]), 1)
    same_tables("batch", folder / "batch", folder / "batch collected")


def environments(folder, sweep, whole):
    out = folder / "arrays"
    array = {"SLURM_ARRAY_TASK_MIN": "0", "SLURM_ARRAY_TASK_MAX": "2", "SLURM_ARRAY_TASK_COUNT": "3"}
    auto = ["sweep", sweep, "--shard", "auto", "--out"]
    for k in range(3):
        expect("slurm", run([*auto, out], {**array, "SLURM_ARRAY_TASK_ID": str(k)}), 0,
               f"shard {k + 1} of 3, from SLURM_ARRAY_TASK_ID")
    expect("collect array", run(["batch", "--collect", out, "--out", out]), 0)
    same_tables("slurm", whole, out)
    if "SLURM_ARRAY_TASK_ID" not in (out / "shard_002_of_003" / "shard.json").read_text():
        failures.append("where the shard came from is not recorded")
    again = folder / "again"
    for what, environment, word in [
            ("nothing", {}, "none of SLURM"),
            ("part", {"SLURM_ARRAY_TASK_ID": "4", "SLURM_ARRAY_TASK_MIN": "4", "SLURM_ARRAY_TASK_MAX": "4",
                      "SLURM_ARRAY_TASK_COUNT": "1"}, "may be a part of another"),
            ("gaps", {"SLURM_ARRAY_TASK_ID": "1", "SLURM_ARRAY_TASK_MIN": "1", "SLURM_ARRAY_TASK_MAX": "9",
                      "SLURM_ARRAY_TASK_COUNT": "2"}, "may be a part of another"),
            ("no count", {"SLURM_ARRAY_TASK_ID": "1"}, "does not say how many"),
            ("two engines", {"SLURM_ARRAY_TASK_ID": "1", "OMPI_COMM_WORLD_RANK": "0"}, "both"),
            ("no size", {"OMPI_COMM_WORLD_RANK": "0"}, "OMPI_COMM_WORLD_SIZE"),
            ("no completions", {"JOB_COMPLETION_INDEX": "0"}, "not how many")]:
        expect(what, run([*auto, again], environment), 2, word)
    expect("no number", run(["sweep", sweep, "--shard", "auto/2", "--out", again], {"JOB_COMPLETION_INDEX": "one"}), 2, "no count")
    expect("index", run(["sweep", sweep, "--shard", "auto/2", "--out", again], {"JOB_COMPLETION_INDEX": "2"}), 2, "there are 2")
    for k in range(2):
        expect("kubernetes", run(["sweep", sweep, "--shard", "auto/2", "--out", again], {"JOB_COMPLETION_INDEX": str(k)}),
               0, f"shard {k + 1} of 2, from JOB_COMPLETION_INDEX")
    expect("collect index", run(["batch", "--collect", again, "--out", again]), 0)
    same_tables("kubernetes", whole, again)


def stopped(folder, sweep):
    """A queue says SIGTERM ahead of its limit of time."""
    out, words = folder / "stopped", ["sweep", str(sweep), "--set", "/analysis/step_size=1e-5", "--quiet", "--keep", "none"]
    child = subprocess.Popen([program, *words, "--out", str(out), "--shard", "2/2"], stdout=subprocess.DEVNULL)
    while not list(out.glob("shard*/keys.csv")) and child.poll() is None:
        time.sleep(0.01)
    time.sleep(0.5)
    child.send_signal(signal.SIGTERM)
    start = time.monotonic()
    status = child.wait()
    if status != 3 or time.monotonic() - start > 30.0:
        failures.append(f"SIGTERM: status {status} after {time.monotonic() - start:.1f} s")
    for shard in ["2/2", "1/2"]:
        expect("goes on", run([*words, "--out", out, "--shard", shard, "--resume"]), 0)
    expect("collect", run(["batch", "--collect", out, "--out", out]), 0)
    expect("whole", run([*words, "--out", folder / "not stopped"]), 0)
    same_tables("stopped", folder / "not stopped", out)


def exported(folder, sweep, engine):
    out = folder / f"it's {engine}"
    expect(engine, run(["sweep", sweep, "--out", out, "--export", engine, "--tasks", "4", "--threads", "1"]), 0)
    return out


def parallel(folder, sweep, whole):
    out = exported(folder, sweep, "parallel")
    commands = (out / "job.parallel").read_text()
    if commands.count("\n") != 4 or " --shard 3/4\n" not in commands:
        failures.append("the commands for parallel do not name their shards")
    done = subprocess.run(["parallel", "--jobs", "2", "--joblog", folder / "jobs.log"], input=commands, text=True,
                          capture_output=True)
    expect("parallel", (done.returncode, done.stderr), 0)
    expect("collect parallel", run(["batch", "--collect", out, "--out", out]), 0)
    same_tables("parallel", whole, out)


def mpirun(folder, sweep, whole):
    out = folder / "ranks"
    done = subprocess.run(["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", "3", program, "sweep", str(sweep),
                           "--out", str(out), "--shard", "auto", "--threads", "1"], capture_output=True, text=True)
    expect("mpirun", (done.returncode, done.stdout + done.stderr), 0, "of 3, from OMPI_COMM_WORLD_RANK")
    expect("collect ranks", run(["batch", "--collect", out, "--out", out]), 0)
    same_tables("mpirun", whole, out)


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    sweep = folder / "sweep's file.json"
    text = json.loads((sweeps / "rod_chain_lengths.json").read_text())
    # one design that draws, so that there are sensitivities, too
    text["designs"] = [{"kind": "sobol", "samples": 24, "variables": [
        {"name": "N", "distribution": {"kind": "discrete", "values": [2, 5, 10]}},
        {"name": "l", "distribution": {"kind": "uniform", "low": 0.25, "high": 0.5}},
        text["designs"][1]["variables"][0]]}]
    text["scene"] = str(sweeps.parent / "scenarios" / "rod_chain.json")
    sweep.write_text(json.dumps(text))
    whole = folder / "whole"
    expect("whole", run(["sweep", sweep, "--out", whole, "--threads", "2"]), 0)
    for engine in engines:
        if engine == "hand":
            by_hand(folder, sweep, whole)
            of_folders(folder)
            stopped(folder, sweep)
        elif engine == "environments":
            environments(folder, sweep, whole)
        elif shutil.which(engine) is None:
            told.append(f"{engine} is not there")
        else:
            {"parallel": parallel, "mpirun": mpirun}[engine](folder, sweep, whole)
for failure in failures:
    print("FAIL:", failure)
print(f"{', '.join(engines)}: {len(failures)} failures", *told, sep="; ")
sys.exit(1 if failures else 0)
