#!/usr/bin/env python3
"""clusters.py PROGRAM SWEEPS [slurm] [snakemake]   runs the job files that `bough sweep --export` writes with the
engines of Debian's packages slurm-wlm and snakemake, and checks that the collected tables equal those of one
machine, byte for byte. Slurm runs as one node on this machine, with daemons in a scratch folder that end with this
script; it needs root and an address other than loopback. Slurm's time limit stops a shard, which continues when it
is submitted again."""
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time

program, sweeps = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
engines = sys.argv[3:] or ["slurm", "snakemake"]
failures = []


def run(words, cwd, **more):
    done = subprocess.run(list(map(str, words)), cwd=cwd, capture_output=True, text=True, **more)
    print("$", " ".join(map(str, words)).replace(str(cwd), "."), f"  [{done.returncode}]")
    print((done.stdout + done.stderr).replace(str(cwd), ".").rstrip()[-2000:])
    return done


def compare(what, whole, out):
    for name in ["batch.csv", "batch.json"]:
        same = (whole / name).read_bytes() == (out / name).read_bytes()
        print(f"{what}: {name} {'is byte-equal to' if same else 'IS NOT'} that of one machine")
        if not same:
            failures.append(f"{what}: {name}")


def configuration(folder):
    host = socket.gethostname()
    address = subprocess.run(["hostname", "-I"], capture_output=True, text=True).stdout.split()
    text = f"""ClusterName=bough
SlurmctldHost={host}({address[0] if address else "127.0.0.1"})
AuthType=auth/none
CredType=cred/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SlurmUser=root
SlurmctldPort=46817
SlurmdPort=46818
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmdSpoolDir={folder}/spool
StateSaveLocation={folder}/state
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SchedulerType=sched/builtin
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
JobAcctGatherType=jobacct_gather/none
JobCompType=jobcomp/filetxt
JobCompLoc={folder}/jobs
OverTimeLimit=0
KillWait=30
NodeName={host} CPUs={os.cpu_count()} RealMemory=2000 State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""
    for name in ["spool", "state"]:
        (folder / name).mkdir()
    (folder / "slurm.conf").write_text(text)


def wait_for_node(environment, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        done = subprocess.run(["sinfo", "-h", "-o", "%T"], capture_output=True, text=True, env=environment)
        if "idle" in done.stdout:
            return True
        time.sleep(0.5)
    return False


def with_slurm(folder, sweep, whole):
    configuration(folder)
    environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}
    daemons = [subprocess.Popen([shutil.which(name), "-D"], env=environment, stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL) for name in ["slurmctld", "slurmd"]]
    try:
        if not wait_for_node(environment, 60):
            failures.append("slurm: the node did not come up: " + (folder / "slurmctld.log").read_text()[-1000:])
            return
        run(["sinfo", "--version"], folder, env=environment)
        out = folder / "array's results"
        run([program, "sweep", sweep, "--out", out, "--export", "slurm", "--tasks", 4], folder)
        done = run(["sbatch", "-W", out / "job.slurm"], folder, env=environment)
        if done.returncode != 0:
            failures.append("slurm: the array failed")
        run([program, "batch", "--collect", out, "--out", out], folder)
        compare("slurm array", whole, out)
        # `auto` finds the same from the array itself
        auto = folder / "auto"
        script = folder / "auto.sh"
        script.write_text(f"#!/bin/sh\nexec {program} sweep \"{sweep}\" --out \"{auto}\" --shard auto --threads 1\n")
        run(["sbatch", "-W", "--array=0-2", script], folder, env=environment)
        run([program, "batch", "--collect", auto, "--out", auto], folder)
        compare("slurm --shard auto", whole, auto)
        for log in sorted(folder.glob("slurm-*_*.out")):
            first = log.read_text().splitlines()[:1]
            if first and "shard" in first[0]:
                print(log.name, first[0])
        # A limit of time, with SIGTERM before it: about 70 s of cases in one task, submitted until they are done.
        # Slurm looks at limits every half a minute only, so shorter ones may end before the signal.
        slow, step = folder / "slow", 2e-5
        options = lambda step: ["--set", f"/analysis/step_size={step:g}", "--keep", "none"]
        start = time.monotonic()
        run([program, "sweep", sweep, "--out", folder / "timed", "--threads", 1, "--quiet", *options(step)], folder)
        words = options(step * (time.monotonic() - start) / 70.0)
        run([program, "sweep", sweep, "--out", folder / "slow whole", "--threads", 2, "--quiet", *words], folder)
        run([program, "sweep", sweep, "--out", slow, "--export", "slurm", "--tasks", 1, "--threads", 1, *words], folder)
        for attempt in range(10):
            done = run(["sbatch", "-W", "--time=1", "--signal=B:TERM@50", slow / "job.slurm"], folder, env=environment)
            if done.returncode != 3:
                break
        print(f"the slow shard ended with status {done.returncode} after {attempt + 1} submissions")
        if done.returncode != 0 or attempt == 0:
            failures.append("slurm: the limit of time did not stop the shard, or it did not go on")
        run([program, "batch", "--collect", slow, "--out", slow, "--quiet"], folder)
        compare("slurm with a limit of time", folder / "slow whole", slow)
        print((folder / "jobs").read_text())
    finally:
        for daemon in reversed(daemons):
            daemon.terminate()
        for daemon in daemons:
            daemon.wait(timeout=30)


def with_snakemake(folder, sweep, whole):
    out = folder / "rules' results"
    run([program, "sweep", sweep, "--out", out, "--export", "snakemake", "--tasks", 4], folder)
    environment = {**os.environ, "PATH": "/usr/bin:" + os.environ["PATH"], "HOME": str(folder)}
    run(["snakemake", "--version"], folder, env=environment)
    done = run(["snakemake", "--keep-going", "--cores", 2, "--snakefile", out / "Snakefile"], folder, env=environment)
    if done.returncode != 0:
        failures.append("snakemake failed")
    compare("snakemake", whole, out)


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    sweep = sweeps / "rod_chain_lengths.json"
    whole = folder / "whole"
    run([program, "sweep", sweep, "--out", whole, "--quiet"], folder)
    for engine in engines:
        place = folder / engine
        place.mkdir()
        if shutil.which("slurmctld" if engine == "slurm" else engine) is None:
            print(engine, "is not there")
            failures.append(f"{engine} is not there")
            continue
        {"slurm": with_slurm, "snakemake": with_snakemake}[engine](place, sweep, whole)
for failure in failures:
    print("FAIL:", failure)
print(f"{', '.join(engines)}: {len(failures)} failures")
sys.exit(1 if failures else 0)
