/// The command line: verbs, options, examples.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <iterator>
#include <string_view>

#include "arguments.hpp"
#include "bough/scene/nearest_name.hpp"
#include "bough/version.hpp"
#include "shared_options.hpp"

namespace bough::app {
namespace {

void add_run(CLI::App& app, RunArguments& a, int& code) {
  CLI::App& verb = add_verb(app, "run", "Simulate a scene and write the results",
                            "  bough run four_bar.json\n"
                            "  bough run four_bar.json --out results --threads 4\n"
                            "  bough run four_bar.json --set /analysis/step_size=1e-4 --set /output/motion=true\n"
                            "  bough run four_bar.json --out results --resume\n"
                            "  bough run braked.json --from results --time 0.5\n"
                            "Exit status: 0 done, 1 the run failed, 2 bad input, 3 stopped: --resume goes on.");
  verb.add_option("SCENE", a.scene, "Scene file (JSON); -: standard input")->required();
  verb.add_option("--out", a.out, "Directory of the results (default: ./<scene>.out)")->type_name("DIR");
  add_replace(verb, a.replace);
  verb.add_flag(
      "--resume", a.resume,
      "Go on from the last checkpoint of the same scene and --set in the directory, or begin where there is none; "
      "nothing is done where the run has ended, unless --replace is given");
  CLI::Option* from =
      verb.add_option("--from", a.from,
                      "Start dynamics from a state of the run in this directory, by the names of nodes, bodies and "
                      "beams; time goes on from there")
          ->type_name("DIR");
  verb.add_option("--time", a.time,
                  "Time of that state [s], or load factor: the end, a picture of output.motion or a checkpoint "
                  "(default: the last one there is)")
      ->type_name("T")
      ->needs(from);
  add_threads(verb, a.threads, "Threads");
  add_overrides(verb, a.overrides);
  add_memory_limit(verb, a.memory_limit);
  add_without(verb, a.overrides);
  add_errors(verb, a.overrides);
  verb.add_flag("--quiet", a.quiet, "Print problems and doubts only");
  verb.add_flag("--check-expected", a.check_expected, "Exit with 1 also where an expected figure does not hold");
  verb.add_flag("--strict", a.strict, "Exit with 1 also where the run is not to be trusted without a closer look");
  verb.callback([&] { code = run(a); });
}

void add_view(CLI::App& app, ViewArguments& a, int& code) {
  CLI::App& verb = add_verb(app, "view", "Draw the motion and the sensors of a run as one page",
                            "  bough view four_bar.out\n"
                            "  bough view four_bar.out --view xz --out page.html --svg four_bar.svg\n"
                            "  bough view coarse.out fine.out --png end.png --time 0.5\n"
                            "The page is one file: it needs no network, and can be read without scripts.");
  verb.add_option("DIR", a.directory, "Directory of the results")->required();
  verb.add_option("OTHER", a.other, "Directory of a second run, laid over the first; their differences are plotted");
  verb.add_option("--case", a.which, "Case of the batch or sweep whose results DIR holds")->type_name("NAME");
  verb.add_option("--out", a.out, "Page to write (default: DIR/view.html)")->type_name("FILE");
  verb.add_option("--svg", a.svg, "Write the drawing of the motion alone, too")->type_name("FILE");
  verb.add_option("--view", a.view, "auto, xy, xz, yz or iso (default: auto)")
      ->check(CLI::IsMember({"auto", "xy", "xz", "yz", "iso"}));
  verb.add_option("--positions", a.positions,
                  "Positions laid over each other in drawings, 1 to 9 (default: 3 in the page, 9 of --svg)")
      ->type_name("N")
      ->check(CLI::Range(1, 9));
  CLI::Option* png =
      verb.add_option("--png", a.png, "Write a picture of one instant, too, 1000 x 700 pixels")->type_name("FILE");
  verb.add_option("--time", a.time, "Instant of --png [s], or load factor (default: the end)")
      ->type_name("T")
      ->needs(png);
  verb.callback([&] { code = view(a); });
}

/// What batches and sweeps share.
void add_case_options(CLI::App& verb, CaseArguments& a) {
  verb.add_option("--out", a.out, "Directory of the results")->type_name("DIR");
  add_threads(verb, a.threads, "Cases at a time");
  verb.add_option("--time-limit", a.time_limit, "Stop a case after so many seconds (default: none)")
      ->type_name("S")
      ->check(between(0.001, 1e9));
  add_overrides(verb, a.overrides);
  add_errors(verb, a.overrides);
  add_memory_limit(verb, a.memory_limit, "all cases at a time");
  verb.add_flag("--quiet", a.quiet, "Print failed cases and the number of doubted ones only");
  verb.add_flag("--check-expected", a.check_expected, "Exit with 1 also where an expected figure does not hold");
  verb.add_flag("--strict", a.strict, "Exit with 1 also where a case is not to be trusted without a closer look");
  verb.add_option("--retries", a.retries,
                  "Try a case that fails so many times again, each time with steps half as long")
      ->type_name("N")
      ->check(CLI::Range(0, 10));
  verb.add_flag("--resume", a.resume,
                "Go on where a batch into this directory was stopped or killed: what is done stays")
      ->excludes(add_replace(verb, a.replace));
  verb.add_option("--stop-after", a.stop_after, "Stop the whole after so many seconds, so that --resume goes on")
      ->type_name("S")
      ->check(between(0.001, 1e9));
  verb.add_option(
          "--keep", a.keep,
          "Results of cases: all, in a folder each; few, folders of up to 200 cases, of more those of failed "
          "ones, and the others in a store that view reads; none: neither, and no checkpoints, so that --resume "
          "begins a case anew that was cut (default: few)")
      ->check(CLI::IsMember({"all", "none", "few"}));
  verb.add_option("--keep-case", a.keep_cases,
                  "A case that has a folder whatever --keep says; may be given several times")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  CLI::Option* shard =
      verb.add_option("--shard", a.shard,
                      "Run part I of N, into DIR/shard_I_of_N; auto: as a Slurm array or Open MPI tells, auto/N: or "
                      "an indexed job of Kubernetes");
  shard->type_name("I/N");
  CLI::Option* job = verb.add_option("--export", a.job_engine,
                                     "Write a job file that runs all shards, and run nothing: slurm, parallel, "
                                     "snakemake or kubernetes");
  job->check(CLI::IsMember({"slurm", "parallel", "snakemake", "kubernetes"}))->excludes(shard);
  verb.add_option("--tasks", a.tasks, "Number of shards of a job file (default: some 300 cases each, up to an hour)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000))
      ->needs(job);
}

void add_batch(CLI::App& app, BatchArguments& a, int& code) {
  CLI::App& verb =
      add_verb(app, "batch", "Run every scene of a folder, one thread a case; put shards together",
               "  bough batch scenes --out results --threads 8\n"
               "  bough batch scenes --out results --shard 3/20\n"
               "  bough batch --collect results --out results\n"
               "Writes results/NAME for every NAME.json, the tables batch.csv and batch.json, and cost.csv.\n"
               "Exit status: 0 all done, 1 a case failed, 2 nothing could be run, 3 stopped, or shards are missing:\n"
               "--resume goes on.");
  CLI::Option* folder = verb.add_option("FOLDER", a.folder, "Folder of scene files");
  add_case_options(verb, a);
  verb.get_option("--out")->required();
  CLI::Option* collect =
      verb.add_option("--collect", a.shards,
                      "Make the tables of these shards, of batches and sweeps alike: folders of shards, or of many; "
                      "FOLDER: where the sweep lies now, if it was moved");
  collect->type_name("DIR")->excludes("--shard")->excludes("--export")->excludes("--resume")->excludes("--replace");
  verb.callback([&a, &code, folder, collect] {
    if (folder->count() == 0 && collect->count() == 0) throw CLI::RequiredError("FOLDER or --collect");
    code = batch(a);
  });
}

void add_sweep(CLI::App& app, SweepArguments& a, int& code) {
  CLI::App& verb = add_verb(
      app, "sweep", "Run one scene in many cases: grids, tables, draws of distributions",
      "  bough sweep data/sweeps/beam.json --dry-run\n"
      "  bough sweep data/sweeps/beam.json --out results --threads 8\n"
      "  bough sweep data/sweeps/beam.json --out one --case 0042\n"
      "  bough sweep data/sweeps/beam.json --out results --export slurm\n"
      "Writes cases.csv (what varies), batch.csv and batch.json (what came of it), cost.csv (times and memory), and a\n"
      "folder a case where there are no more than 200. `bough schema --sweep` prints the format.\n"
      "Exit status: 0 all done, 1 a case failed, 2 bad input, 3 stopped: --resume goes on.");
  verb.add_option("FILE", a.file, "Sweep (JSON)")->required();
  add_case_options(verb, a);
  verb.add_flag("--dry-run", a.dry_run, "List the cases and what they will take, and run none");
  verb.add_option("--case", a.only, "Only this case; may be given several times")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->excludes("--shard")
      ->excludes("--export");
  verb.callback([&] { code = sweep(a); });
}

void add_export_matrix(CLI::App& app, ExportMatrixArguments& a, int& code) {
  CLI::App& verb =
      add_verb(app, "export-matrix", "Write the tangent of one step as a Matrix Market file",
               "  bough export-matrix four_bar.json --out four_bar.mtx --rhs four_bar_rhs.mtx\n"
               "  bough export-matrix four_bar.json --time 0.5\n"
               "  bough export-matrix rod_chain.json --interface 0.1 --matrix F --out flexibility.npy\n"
               "It is the matrix of the first Newton iteration of a step; the comments name the unknowns. Of the\n"
               "interface of a sub-domain of the solver's tree: S, the sub-domain condensed to its interface, the\n"
               "penalty P, and the flexibility F = (S + P)^-1, in the scene's units.\n"
               "Exit status: 0 written, 1 there is no such step or the run fails before it, 2 bad input.");
  verb.add_option("SCENE", a.scene, "Scene file (JSON); -: standard input")->required();
  verb.add_option("--out", a.out, "Matrix to write; of an interface also .npy (default: ./<scene>.mtx)")
      ->type_name("FILE");
  CLI::Option* rhs = verb.add_option("--rhs", a.rhs, "Write the right-hand side, too")->type_name("FILE");
  CLI::Option* interface = verb.add_option("--interface", a.interface,
                                           "Path of a sub-domain, as 0.1: write a matrix of its "
                                           "interface instead")
                               ->type_name("PATH")
                               ->excludes(rhs);
  verb.add_option("--matrix", a.matrix, "Which one (default: F)")
      ->check(CLI::IsMember({"F", "S", "P"}))
      ->needs(interface);
  CLI::Option* step = verb.add_option("--step", a.step, "Number of the step (default: 1)")
                          ->type_name("N")
                          ->check(CLI::Range(1L, 1000000000L));
  verb.add_option("--time", a.time, "Time that the step reaches; statics: load factor")
      ->type_name("T")
      ->check(between(0.0, 1e300))
      ->excludes(step);
  add_threads(verb, a.threads, "Threads");
  add_overrides(verb, a.overrides);
  add_memory_limit(verb, a.memory_limit);
  add_without(verb, a.overrides);
  verb.callback([&] { code = export_matrix(a); });
}

void add_study(CLI::App& app, StudyArguments& a, int& code) {
  CLI::App& verb = add_verb(
      app, "study", "Measure errors and run times of a scene over grids of choices",
      "  bough study data/studies/heavy_top.json --out results/heavy_top\n"
      "  bough study data/studies --out results --threads 2\n"
      "  bough schema --study > study.schema.json\n"
      "Writes study.csv, study.json and study.html; of a folder, one directory a study and index.html.\n"
      "Computed references are kept in DIR/references under a hash of all that they depend on.\n"
      "Exit status: 0 done; 1 an order of convergence is not that of theory, a reference could not be computed,\n"
      "or it was stopped; 2 bad input. Runs that fail are results: they are listed with their cause.");
  verb.add_option("SPEC", a.spec, "Study (JSON), or a folder of them")->required();
  verb.add_option("--out", a.out, "Directory of the results")->type_name("DIR")->required();
  add_replace(verb, a.replace);
  add_threads(verb, a.threads, "Runs at a time while errors are measured; timed runs go one at a time");
  verb.add_option("--repetitions", a.repetitions, "Timed runs of every choice (default: as the study says)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  add_memory_limit(verb, a.memory_limit, "all runs side by side");
  verb.add_option("--cache", a.cache, "Folder of computed references (default: DIR/references)")->type_name("DIR");
  verb.add_flag("--quiet", a.quiet, "Print problems only");
  verb.callback([&] { code = study_scene(a); });
}

void add_profile(CLI::App& app, ProfileArguments& a, int& code) {
  CLI::App& verb =
      add_verb(app, "profile", "Show the tree of sub-domains as it runs: sizes, times, threads, other trees",
               "  bough profile four_bar.json --out four_bar.profile --steps 50\n"
               "  bough profile chain.json --set /solver/leaf_size=8\n"
               "Writes profile.html, profile.json and trace.json (opens in Perfetto); the tree is printed.\n"
               "Exit status: 0 done, 1 the run failed (what ran is shown), 2 bad input.");
  verb.add_option("SCENE", a.scene, "Scene file (JSON); -: standard input")->required();
  verb.add_option("--out", a.out, "Directory to write (default: ./<scene>.profile)")->type_name("DIR");
  add_replace(verb, a.replace);
  verb.add_option("--steps", a.steps, "Most steps (default: 200)")->type_name("N")->check(CLI::Range(1L, 1000000000L));
  add_threads(verb, a.threads, "Threads");
  add_overrides(verb, a.overrides);
  add_memory_limit(verb, a.memory_limit);
  verb.add_flag("--quiet", a.quiet, "Print problems only");
  verb.callback([&] { code = profile(a); });
}

void add_tune(CLI::App& app, TuneArguments& a, int& code) {
  CLI::App& verb = add_verb(app, "tune", "Measure which solver options run a scene fastest here",
                            "  bough tune chain.json --out solver.json\n"
                            "  bough run chain.json --set /solver=\"$(bough tune chain.json)\"\n"
                            "The table goes to standard error, the block \"solver\" to standard output.\n"
                            "Exit status: 0 done, 1 no options run the scene, 2 bad input.");
  verb.add_option("SCENE", a.scene, "Scene file (JSON); -: standard input")->required();
  verb.add_option("--out", a.out, "Write the block, too")->type_name("FILE");
  verb.add_option("--steps", a.steps, "Steps of each short run (default: 20)")
      ->type_name("N")
      ->check(CLI::Range(1L, 1000000L));
  verb.add_option("--seconds", a.seconds, "Start no further round after so long, but for the first three (default: 60)")
      ->type_name("S")
      ->check(between(0.0, 1e6));
  add_threads(verb, a.threads, "Threads");
  add_overrides(verb, a.overrides);
  add_memory_limit(verb, a.memory_limit);
  verb.callback([&] { code = tune(a); });
}

void add_plan(CLI::App& app, PlanArguments& a, int& code) {
  CLI::App& verb =
      add_verb(app, "plan", "Say what a run leaves out and why, and what it will take",
               "  bough plan four_bar.json\n"
               "  bough plan four_bar.json --without planar --json plan.json\n"
               "Iterations are counted over at most 2048 trial steps, of 0.2 s in all; seconds come from a model\n"
               "with the costs of one machine: others are slower or faster by a common factor.");
  verb.add_option("SCENE", a.scene, "Scene file (JSON); -: standard input")->required();
  verb.add_option("--json", a.json, "Write all of it")->type_name("FILE");
  add_overrides(verb, a.overrides);
  add_memory_limit(verb, a.memory_limit);
  add_without(verb, a.overrides);
  add_errors(verb, a.overrides);
  verb.callback([&] { code = plan(a); });
}

void add_check(CLI::App& app, CheckArguments& a, int& code) {
  CLI::App& verb = add_verb(app, "check", "Say what is wrong with a scene, without running it",
                            "  bough check four_bar.json\n  bough check four_bar.json --set /analysis/step_size=0\n"
                            "  bough check four_bar.json --fix --dry-run\n"
                            "Exit status: 0 nothing is wrong, 2 something is.");
  verb.add_option("SCENE", a.scene, "Scene file (JSON); -: standard input")->required();
  add_overrides(verb, a.overrides);
  add_memory_limit(verb, a.memory_limit);
  CLI::Option* fix = verb.add_flag("--fix", a.fix,
                                   "Change in the file what is sure, as a misspelt key or name of which only one is "
                                   "near, tell what was changed, and check it");
  fix->excludes("--set");
  verb.add_flag("--dry-run", a.dry_run, "With --fix: print the difference and write nothing")->needs(fix);
  verb.callback([&] { code = check(a); });
}

void add_new(CLI::App& app, NewArguments& a, int& code) {
  CLI::App& verb =
      add_verb(app, "new", "Write a commented scene to begin with",
               "  bough new\n  bough new beam\n  bough new rotor --out fan.json\n"
               "Exit status: 0 done, 1 it cannot be written, 2 there is no such kind, or the file is there.");
  verb.add_option("KIND", a.kind, "What the scene shows; all kinds are listed where none is given");
  verb.add_option("--out", a.out, "File to write; -: standard output (default: KIND.json)")->type_name("FILE");
  verb.callback([&] { code = new_scene(a); });
}

void add_expand(CLI::App& app, ExpandArguments& a, int& code) {
  CLI::App& verb =
      add_verb(app, "expand", "Print a scene with numbers for its parameters and formulas, and all copies",
               "  bough expand data/scenarios/rod_chain.json --set /parameters/N=3\n"
               "What is printed is a scene that gives the same results. Exit status: 0 done, 2 bad input.");
  verb.add_option("SCENE", a.scene, "Scene file (JSON); -: standard input")->required();
  add_overrides(verb, a.overrides);
  verb.callback([&] { code = expand(a); });
}

void add_compare(CLI::App& app, CompareArguments& a, int& code) {
  CLI::App& verb = add_verb(app, "compare", "Compare two runs, column by column",
                            "  bough compare four_bar.out reference.out --rel 1e-6\n"
                            "  bough compare a/history.csv b/history.csv\n"
                            "Exit status: 0 equal within the tolerance, 1 not, 2 bad input. NaN is never equal.");
  verb.add_option("A", a.a, "Directory or history.csv; differences are measured by its ranges")->required();
  verb.add_option("B", a.b, "Directory or history.csv")->required();
  verb.add_option("--rel", a.relative, "Largest difference over the sensor's range (default: 1e-9)")
      ->type_name("TOL")
      ->check(between(0.0, 1e300));
  verb.add_option("--abs", a.absolute, "Differences up to this are equal (default: 0)")
      ->type_name("TOL")
      ->check(between(0.0, 1e300));
  verb.callback([&] { code = compare(a); });
}

void add_status(CLI::App& app, StatusArguments& a, int& code) {
  CLI::App& verb = add_verb(app, "status", "Tell how far a run, batch or sweep has come, while it goes on or later",
                            "  bough status four_bar.out\n"
                            "Exit status: 0 told, 2 there is nothing to tell of.");
  verb.add_option("DIR", a.directory, "Directory that was given by --out")->required();
  verb.callback([&] { code = status(a); });
}

void add_schema(CLI::App& app, SchemaArguments& a, int& code) {
  CLI::App& verb = add_verb(app, "schema", "Print the JSON Schema of scenes",
                            "  bough schema > scene.schema.json\n  bough schema --chain > chain.schema.json");
  verb.add_flag("--chain", a.chain, "Of the chains of frames of bough kinematics razi");
  verb.add_flag("--motion", a.motion, "Of the poses of bough kinematics motion")->excludes("--chain");
  verb.add_flag("--study", a.study, "Of the studies of bough study")->excludes("--chain")->excludes("--motion");
  verb.add_flag("--sweep", a.sweep, "Of the sweeps of bough sweep")
      ->excludes("--chain")
      ->excludes("--motion")
      ->excludes("--study");
  verb.callback([&] { code = schema(a); });
}

void add_doctor(CLI::App& app, DoctorArguments& a, int& code) {
  add_verb(app, "doctor", "Say what this program was built with and test itself", "  bough doctor").callback([&] {
    code = doctor(a);
  });
}

void add_stress(CLI::App& app, StressArguments& a, int& code) {
  CLI::App& verb =
      add_verb(app, "stress", "Measure the stiff and extreme cases of the standing table",
               "  bough stress --out stress --threads 2\n"
               "  bough stress --out stress --quick\n"
               "  bough stress --out stress --case elastica\n"
               "Writes stress.json and stress.html. Exit status: 0 every case ends as the table lists it, or better;\n"
               "1 one does not, or the table was stopped; 2 bad input.");
  verb.add_option("--out", a.out, "Directory of the report")->type_name("DIR")->required();
  add_replace(verb, a.replace);
  verb.add_flag("--quick", a.quick, "Every family, long runs shortened and marked");
  add_threads(verb, a.threads, "Cases side by side");
  add_memory_limit(verb, a.memory_limit, "all cases side by side");
  verb.add_option("--case", a.only, "Only this case, or the cases of this family")->type_name("NAME");
  verb.add_flag("--quiet", a.quiet, "Print only what is not as the table lists it");
  verb.callback([&] { code = stress(a); });
}

void add_razi(CLI::App& kinematics, RaziArguments& a, int& code) {
  CLI::App& verb = add_verb(
      kinematics, "razi", "Split the acceleration of a point in nested frames into its parts",
      "  bough kinematics razi --svg razi.svg\n"
      "  bough kinematics razi --spin 5 --precession 1 --tilt 30 --points 25 --csv razi.csv\n"
      "  bough kinematics razi --chain rotor.json --json rotor.out.json\n"
      "Without --chain: a point of a disc that spins on a turning shaft, over one turn of the spin angle psi,\n"
      "seen from the ground; without speeds for the pairs (5,1) (4,2) (3,3) (2,4) (1,5) (5,0) rad/s.\n"
      "Exit status: 0 done, 1 a law is not finite or a file cannot be written, 2 bad input.");
  CLI::Option* chain = verb.add_option("--chain", a.chain, "Chain of moving frames with a point (JSON)");
  chain->type_name("FILE");
  const auto disc_option = [&](const std::string& name, auto& value, const std::string& what, const char* unit) {
    return verb.add_option(name, value, what)->type_name(unit)->excludes(chain);
  };
  // Bounds far beyond any disc, so that no product overflows.
  const CLI::Validator speeds = between(-1e9, 1e9);
  CLI::Option* spin = disc_option("--spin", a.spin, "Spin of the disc on the shaft", "RAD/S")->check(speeds);
  CLI::Option* precession = disc_option("--precession", a.precession, "Speed of the shaft", "RAD/S")->check(speeds);
  spin->needs(precession);
  precession->needs(spin);
  disc_option("--tilt", a.tilt, "Angle between their axes (default: 45)", "DEG")->check(between(-360.0, 360.0));
  disc_option("--radius", a.radius, "Distance of the point from the axis (default: 1)", "M")->check(between(1e-9, 1e9));
  disc_option("--points", a.points, "Values of psi from 0 to 360 degrees, both among them (default: 361)", "N")
      ->check(CLI::Range(2, 1000000));
  verb.add_option("--csv", a.files.csv, "Write the magnitudes")->type_name("FILE");
  verb.add_option("--json", a.files.json, "Write magnitudes and vectors")->type_name("FILE");
  verb.add_option("--svg", a.files.svg, "Draw the magnitudes")->type_name("FILE");
  verb.callback([&] { code = kinematics_razi(a); });
}

void add_motion(CLI::App& kinematics, MotionArguments& a, int& code) {
  CLI::App& verb = add_verb(
      kinematics, "motion", "Everything about one motion: rotation, screw, parameters, motion tensor",
      "  bough kinematics motion --to 1 0 0  0 0 1.5707963\n"
      "  bough kinematics motion --from 0 0 1 --to 1,0,0,0.6,0,0,0.8 --json motion.json\n"
      "  bough kinematics motion poses.json\n"
      "A pose is 3 numbers (position [m]), 6 (position, rotation vector [rad]) or 7 (position, quaternion with\n"
      "the scalar first). Exit status: 0 done, 1 a file cannot be written, 2 bad input.");
  CLI::Option* file = verb.add_option("FILE", a.file, "Poses (JSON), instead of --from and --to");
  const auto pose_option = [&](const std::string& name, std::vector<double>& numbers, const std::string& what) {
    return verb.add_option(name, numbers, what)
        ->type_name("NUMBERS")
        ->delimiter(',')
        ->expected(3, 7)
        ->check(between(-1e100, 1e100))
        ->excludes(file);
  };
  CLI::Option* to = pose_option("--to", a.to, "Pose after the motion");
  CLI::Option* from = pose_option("--from", a.from, "Pose before it (default: the inertial frame)")->needs(to);
  verb.add_option("--seen-from", a.seen_from,
                  "With --from: inertial, or first for the axes of that pose (default: inertial)")
      ->check(CLI::IsMember({"inertial", "first"}))
      ->needs(from);
  verb.add_option("--json", a.json, "Write all numbers")->type_name("FILE");
  verb.callback([&a, &code] {
    if (a.file.empty() && a.to.empty()) throw CLI::RequiredError("FILE or --to");
    code = kinematics_motion(a);
  });
}

struct KinematicsArguments {
  RaziArguments razi;
  MotionArguments motion;
};

void add_kinematics(CLI::App& app, KinematicsArguments& a, int& code) {
  CLI::App& verb = add_verb(app, "kinematics", "Kinematics without a simulation: razi, motion",
                            "  bough kinematics razi --help\n  bough kinematics motion --help");
  verb.require_subcommand(1);
  add_razi(verb, a.razi, code);
  add_motion(verb, a.motion, code);
}

struct Arguments {
  ExplainArguments explain;
  NewArguments new_scene;
  RunArguments run;
  ViewArguments view;
  BatchArguments batch;
  SweepArguments sweep;
  ExportMatrixArguments export_matrix;
  ProfileArguments profile;
  TuneArguments tune;
  PlanArguments plan;
  CheckArguments check;
  ExpandArguments expand;
  CompareArguments compare;
  StatusArguments status;
  SchemaArguments schema;
  DoctorArguments doctor;
  StudyArguments study;
  StressArguments stress;
  KinematicsArguments kinematics;
};

std::string help_of_verb(const std::string& word);
std::vector<std::string> verb_names();

void add_explaining(CLI::App& app, const std::string& name, const std::string& what, ExplainArguments& a, int& code) {
  CLI::App& verb = add_verb(app, name, what,
                            "  bough " + name + " step_size\n  bough " + name + " unknown-name\n  bough " + name +
                                " prismatic\n  bough " + name +
                                " 'load factor'\n"
                                "Exit status: 0 done, 2 there is no such entry.");
  verb.add_option("WORD", a.word, "A key, kind, verb, code of a message, doubt, or a heading of the manual")
      ->required();
  verb.callback([&] {
    a.verb_help = help_of_verb(a.word);
    a.verbs = verb_names();
    code = explain(a);
  });
}

void add_explain(CLI::App& app, ExplainArguments& a, int& code) {
  add_explaining(app, "explain", "Say what a word of a file, a message or the manual means", a, code);
}

void add_help(CLI::App& app, ExplainArguments& a, int& code) {
  add_explaining(app, "help", "The same as explain", a, code);
}

struct Verb {
  std::string_view name;
  void (*add)(CLI::App& app, Arguments& a, int& code);
};

template <auto part, auto add>
void add_verb_of(CLI::App& app, Arguments& a, int& code) {
  add(app, a.*part, code);
}

/// In the order in which they are listed.
constexpr Verb verbs[] = {
    {"new", add_verb_of<&Arguments::new_scene, add_new>},
    {"explain", add_verb_of<&Arguments::explain, add_explain>},
    {"help", add_verb_of<&Arguments::explain, add_help>},
    {"run", add_verb_of<&Arguments::run, add_run>},
    {"view", add_verb_of<&Arguments::view, add_view>},
    {"batch", add_verb_of<&Arguments::batch, add_batch>},
    {"sweep", add_verb_of<&Arguments::sweep, add_sweep>},
    {"export-matrix", add_verb_of<&Arguments::export_matrix, add_export_matrix>},
    {"profile", add_verb_of<&Arguments::profile, add_profile>},
    {"tune", add_verb_of<&Arguments::tune, add_tune>},
    {"plan", add_verb_of<&Arguments::plan, add_plan>},
    {"check", add_verb_of<&Arguments::check, add_check>},
    {"expand", add_verb_of<&Arguments::expand, add_expand>},
    {"compare", add_verb_of<&Arguments::compare, add_compare>},
    {"status", add_verb_of<&Arguments::status, add_status>},
    {"schema", add_verb_of<&Arguments::schema, add_schema>},
    {"doctor", add_verb_of<&Arguments::doctor, add_doctor>},
    {"study", add_verb_of<&Arguments::study, add_study>},
    {"stress", add_verb_of<&Arguments::stress, add_stress>},
    {"kinematics", add_verb_of<&Arguments::kinematics, add_kinematics>},
};

bool is_verb(std::string_view word) {
  return std::any_of(std::begin(verbs), std::end(verbs), [&](const Verb& verb) { return verb.name == word; });
}

std::vector<std::string> verb_names() {
  std::vector<std::string> names;
  for (const Verb& verb : verbs) names.emplace_back(verb.name);
  return names;
}

/// What `bough WORD --help` prints; empty if the word is not a verb.
std::string help_of_verb(const std::string& word) {
  CLI::App app{"", "bough"};
  Arguments arguments;
  int code = exit_done;
  for (const Verb& verb : verbs)
    if (verb.name == word) verb.add(app, arguments, code);
  return is_verb(word) ? app.get_subcommand(word)->help("bough") : std::string();
}

int explain_verb(const std::string& word) {
  std::cerr << "bough: '" << word << "' is not a verb";
  const std::vector<std::string> names = verb_names();
  const std::string nearest = scene::nearest_name(word, names);
  if (!nearest.empty()) std::cerr << "; did you mean '" << nearest << "'?";
  std::cerr << "\nVerbs:";
  for (const std::string& name : names) std::cerr << ' ' << name;
  std::cerr << "\n";
  return exit_bad_input;
}

}  // namespace

int dispatch(int count, char** values) {
  if (count == 2 && std::string_view(values[1]) == "help") {  // of no word: what there is
    char all[] = "--help";
    char* with_help[] = {values[0], all, nullptr};
    return dispatch(2, with_help);
  }
  const std::string first = count > 1 ? values[1] : "";
  const bool names_verb = is_verb(first);
  if (!names_verb && !first.empty() && first.front() != '-') return explain_verb(first);
  CLI::App app{"Flexible multibody dynamics: beams, rigid bodies and joints on a tree of sub-domains.", "bough"};
  app.set_version_flag("--version", "bough " + std::string(version));
  app.require_subcommand(1);
  app.footer("Examples:\n  bough run four_bar.json\n  bough view four_bar.out\n  bough VERB --help");

  int code = exit_done;
  Arguments arguments;
  // Options of all verbs take longer to make than many a scene to run: they are made where all verbs are listed.
  for (const Verb& verb : verbs)
    if (!names_verb || verb.name == first) verb.add(app, arguments, code);
  try {
    app.parse(count, values);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_done : exit_bad_input;  // --help and --version are 0, all else 100 to 127
  }
  return code;
}

}  // namespace bough::app
