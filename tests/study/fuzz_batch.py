#!/usr/bin/env python3
"""fuzz_batch.py FUZZER COUNT [SECONDS]   feeds the readers of batches (fuzz_batch.cpp) with COUNT inputs, grown from sound
ones: no crash, no leak, no input that takes ten seconds. SECONDS:
not longer than this."""
import json
import pathlib
import subprocess
import sys
import tempfile

fuzzer, count = str(pathlib.Path(sys.argv[1]).resolve()), int(sys.argv[2])
seconds = sys.argv[3] if len(sys.argv) > 3 else "0"


def variable(name, **more):
    return {"name": name, **more}


def sweep(designs, **more):
    return json.dumps({"schema_version": 1, "scene": "scene.json", "designs": designs, **more})


uniform = {"kind": "uniform", "low": 1, "high": 2}
drawn = [variable("L", distribution=uniform), variable("m", distribution={"kind": "normal", "mean": 2, "standard_deviation": 0.1})]
seeds = [sweep([{"kind": kind, number: 4, "variables": drawn}]) for kind, number in [
    ("random", "samples"), ("latin_hypercube", "samples"), ("sobol", "samples"), ("morris", "trajectories"), ("saltelli", "samples")]]
seeds += [
    sweep([{"kind": "grid", "variables": [variable("L", values=[1, 2]), variable("y", pointer="/gravity/2", values=[-1, -9.81])]}],
          where=[{"expression": "L*2", "high": 3}], measures=[{"name": "low", "quantity": "bob.z", "figure": "min"}]),
    sweep([{"kind": "list", "variables": [variable("L"), variable("m")], "rows": [[1, 2], [3, 4]]}],
          set=[{"pointer": "/analysis/end_time", "value": 0.05}]),
    sweep([{"kind": "one_at_a_time", "variables": [variable("L", nominal=1, values=[1, 2, 3])]}]),
    sweep([{"kind": "random", "samples": 3, "seed": 7, "variables": [
        variable("L", distribution={"kind": "discrete", "values": [1, 2], "weights": [1, 3]}),
        variable("m", distribution={"kind": "lognormal", "log_mean": 0, "log_standard_deviation": 1})]}])]
report = {"cause": "", "directory": "out/1", "stored": ["store_000.pack", 12], "interrupted": False, "counts": [1, 2, 3, 0, 0],
          "failing": "", "doubts": ["energy"], "checks": [1e-9, False], "measures": ["low", -1.5, "none", False]}
record = json.dumps({"key": "k1", "case": "1", "status": "ok", "cause": "", "cost": [0.1, 0.2, 3e7], "report": json.dumps(report)})
shard = json.dumps({"format": "bough shard 1", "verb": "sweep", "title": "t", "source": "s", "cases": "@", "content": "c",
                    "number": 1, "count": 1, "origin": "o", "program": "p", "instruction_set": "i", "library": "l"})
inputs = [b"\0" + text.encode() for text in seeds]
inputs += [b"\1" + f"{record}\n{record}\n".encode(), b"\2bough run [[\"a\",1,\"00\"]]\nx\n", b"\2bough run []\n\n",
           b"\3" + f"case,L\n1,2.5\n2,\"[1, 2]\"\n\f{shard}\fcase,key\n1,k1\n2,k2\n\f{record}\n".encode()]
words = ["schema_version", "scene", "designs", "variables", "values", "distribution", "pointer", "samples", "where", "expression",
         "measures", "latin_hypercube", "saltelli", "store_000.pack", "bough run ", "report", "counts", "@"]
with tempfile.TemporaryDirectory() as folder:
    corpus = pathlib.Path(folder) / "corpus"
    corpus.mkdir()
    for number, data in enumerate(inputs):
        (corpus / str(number)).write_bytes(data)
    dictionary = pathlib.Path(folder) / "words"
    dictionary.write_text("".join(f'"{word}"\n' for word in words))
    done = subprocess.run([fuzzer, str(corpus), f"-runs={count}", f"-max_total_time={seconds}", f"-dict={dictionary}", "-max_len=4096", "-timeout=10", "-seed=28",
                           "-print_final_stats=1", "-verbosity=0"], capture_output=True, text=True, cwd=folder)
print(done.stderr[-3000:])
sys.exit(1 if done.returncode != 0 else 0)
