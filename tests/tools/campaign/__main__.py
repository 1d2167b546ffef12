"""Campaigns against the program, for faults that tests of single cases do not find.

    python3 tests/tools/campaign --program build/release/bough [PART ...] [--seed N] [--scale X]

Every part is a module of this folder with two functions: add_arguments(parser) adds options of its own, each named
--<part>-...; run(options) returns an Outcome. Counts of cases grow with --scale; --scale 1 is a run of minutes. Equal
seeds give equal cases.
Exit status: 0 all cases ended as required, 1 some did not, 2 bad arguments, 77 a part cannot run here.
"""
import argparse
import importlib
import pathlib
import sys
import time

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER))

PARTS = ("fuzz", "limits", "kills", "faults", "nonsense", "checkpoints", "nights", "races")


def main():
    present = [part for part in PARTS if (FOLDER / f"{part}.py").exists()]
    modules = {part: importlib.import_module(part) for part in present}
    parser = argparse.ArgumentParser(prog="campaign", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"of {', '.join(present)} (default: all)")
    parser.add_argument("--program", type=pathlib.Path, required=True, help="the program bough")
    parser.add_argument("--seed", type=int, default=1, help="of the random cases (default: 1)")
    parser.add_argument("--scale", type=float, default=1.0, help="factor on the number of cases (default: 1)")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the inputs of cases that fail (default: none)")
    for module in modules.values():
        module.add_arguments(parser)
    options = parser.parse_args()
    options.program = options.program.resolve()
    options.source = FOLDER.parents[2]
    unknown = [part for part in options.parts if part not in present]
    if unknown:
        parser.error(f"there is no part {', '.join(unknown)}")
    if not options.program.exists():
        parser.error(f"there is no program {options.program}")

    num_failures, skipped = 0, False
    for part in options.parts or present:
        start = time.monotonic()
        outcome = modules[part].run(options)
        counts = ", ".join(f"{count} {what}" for what, count in outcome.counts.items())
        print(f"{part}: {counts}; {len(outcome.failures)} did not end as they must, {time.monotonic() - start:.1f} s",
              flush=True)
        for failure in outcome.failures:
            print(f"  {failure}")
        if outcome.skipped:
            print(f"  cannot run here: {outcome.skipped}")
        num_failures += len(outcome.failures)
        skipped = skipped or bool(outcome.skipped)
    return 1 if num_failures else 77 if skipped else 0


sys.exit(main())
