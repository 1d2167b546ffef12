#pragma once
/// What the command line says, verb by verb, as plain data.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace bough::app {

/// Exit statuses of all verbs.
enum Exit : int {
  exit_done = 0,
  exit_failed = 1,     ///< a run failed, or is doubted where that counts (--strict); histories differ
  exit_bad_input = 2,  ///< bad input, bad options, a file that cannot be read
  exit_stopped = 3,    ///< a run, batch or sweep was stopped; --resume goes on with it
};

struct RunArguments {
  std::filesystem::path scene, out;  ///< out empty: ./<scene>.out
  int threads = 0;                   ///< 0: as many as the machine has
  std::vector<std::string> overrides;
  double memory_limit = 0.0;  ///< of a run [bytes]; 0: what is available
  bool quiet = false, replace = false, resume = false;
  bool check_expected = false, strict = false;
  std::filesystem::path from;  ///< folder of a run in a state of which this one starts; empty: the scene's own start
  std::optional<double> time;  ///< of that state [s], or load factor; none: the last one there is
};
struct ViewArguments {
  std::filesystem::path directory, other, out, svg, png;
  std::string which;  ///< case of a batch; empty: the directory is that of a run
  std::string view = "auto";
  int positions = 0;           ///< laid over each other; 0: three in the page, nine of --svg
  std::optional<double> time;  ///< of --png; none: the end
};
/// What `bough batch` and `bough sweep` share.
struct CaseArguments {
  std::filesystem::path out;
  int threads = 0;  ///< cases at a time; 0: as many as the machine has
  double time_limit = 0.0;
  std::vector<std::string> overrides;
  double memory_limit = 0.0;  ///< of all cases at a time [bytes]; 0: what is available
  bool quiet = false, check_expected = false, strict = false;
  double stop_after = 0.0;  ///< of the whole batch [s]; 0: never
  int retries = 0;          ///< of a case that fails
  bool resume = false, replace = false;
  std::string keep = "few";             ///< folders of cases: all; few: up to 200, of more a store; none: neither
  std::vector<std::string> keep_cases;  ///< that have folders in any case
  std::string shard;                    ///< "I/N", "auto", "auto/N"; empty: all cases
  std::string job_engine;               ///< whose job files are written, and nothing is run; else empty
  int tasks = 0;                        ///< of these; 0: some hundred cases each
};
struct BatchArguments : CaseArguments {
  std::filesystem::path folder;
  std::vector<std::filesystem::path>
      shards;  ///< put together, and nothing is run; folder: where the scenes or the sweep lie now
};
struct SweepArguments : CaseArguments {
  std::filesystem::path file;
  std::vector<std::string> only;  ///< names of cases; empty: all
  bool dry_run = false;
};
struct ExportMatrixArguments {
  std::filesystem::path scene, out, rhs;  ///< out empty: ./<scene>.mtx; rhs empty: not written
  std::string interface;                  ///< path of a sub-domain whose interface is written; empty: the tangent is
  std::string matrix = "F";               ///< of the interface: F, S or P
  std::optional<long> step;
  std::optional<double> time;
  int threads = 0;
  std::vector<std::string> overrides;
  double memory_limit = 0.0;  ///< of a run [bytes]; 0: what is available
};
struct ProfileArguments {
  std::filesystem::path scene, out;  ///< out empty: ./<scene>.profile
  long steps = 200;
  int threads = 0;
  std::vector<std::string> overrides;
  double memory_limit = 0.0;  ///< of a run [bytes]; 0: what is available
  bool quiet = false, replace = false;
};
struct TuneArguments {
  std::filesystem::path scene, out;  ///< out empty: standard output only
  long steps = 20;
  double seconds = 60.0;
  int threads = 0;
  std::vector<std::string> overrides;
  double memory_limit = 0.0;  ///< of a run [bytes]; 0: what is available
};
struct PlanArguments {
  std::filesystem::path scene, json;  ///< json empty: not written
  std::vector<std::string> overrides;
  double memory_limit = 0.0;  ///< of a run [bytes]; 0: what is available
};
struct CheckArguments {
  std::filesystem::path scene;
  std::vector<std::string> overrides;
  double memory_limit = 0.0;  ///< of a run [bytes]; 0: what is available
  bool fix = false;           ///< change in the file what is sure
  bool dry_run = false;       ///< of fix: the difference is printed, and nothing is written
};
struct ExplainArguments {
  std::string word;
  std::string verb_help;           ///< of the verb of this name; empty: there is none
  std::vector<std::string> verbs;  ///< of the program
};
struct NewArguments {
  std::string kind;           ///< empty: the kinds are listed
  std::filesystem::path out;  ///< empty: ./<kind>.json; "-": standard output
};
struct ExpandArguments {
  std::filesystem::path scene;
  std::vector<std::string> overrides;
};
struct CompareArguments {
  std::filesystem::path a, b;
  double relative = 1e-9, absolute = 0.0;
};
struct StatusArguments {
  std::filesystem::path directory;
};
/// What a verb of numbers writes besides its table.
struct NumberFiles {
  std::filesystem::path csv, json, svg;  ///< empty: not written
};
struct RaziArguments {
  std::filesystem::path chain;  ///< empty: the disc
  std::optional<double> spin, precession, tilt, radius;
  std::optional<int> points;
  NumberFiles files;
};
struct MotionArguments {
  std::filesystem::path file;    ///< empty: from and to
  std::vector<double> from, to;  ///< poses in numbers (io::read_pose); from empty: the inertial frame
  std::string seen_from = "inertial";
  std::filesystem::path json;  ///< empty: not written
};
struct SchemaArguments {
  bool chain = false, motion = false;  ///< of the files of bough kinematics, not of scenes
  bool study = false, sweep = false;   ///< of the files of bough study and bough sweep
};
struct StudyArguments {
  std::filesystem::path spec, out, cache;  ///< spec: a file or a folder of them; cache empty: out/references
  int threads = 0;                         ///< 0: as many as the machine has
  int repetitions = 0;                     ///< 0: as the study says
  double memory_limit = 0.0;               ///< of the runs side by side [bytes]; 0: what is available
  bool quiet = false, replace = false;
};
struct DoctorArguments {};
struct StressArguments {
  std::filesystem::path out;
  bool quick = false;
  int threads = 0;
  std::string only;           ///< a case or a family; empty: all
  double memory_limit = 0.0;  ///< of the cases side by side [bytes]; 0: what is available
  bool quiet = false, replace = false;
};

/// One page per verb: cmd_<verb>.cpp. Each returns the exit status.
int run(const RunArguments& arguments);
int view(const ViewArguments& arguments);
int batch(const BatchArguments& arguments);
int sweep(const SweepArguments& arguments);
int export_matrix(const ExportMatrixArguments& arguments);
int profile(const ProfileArguments& arguments);
int tune(const TuneArguments& arguments);
int plan(const PlanArguments& arguments);
int check(const CheckArguments& arguments);
int explain(const ExplainArguments& arguments);
int new_scene(const NewArguments& arguments);
int expand(const ExpandArguments& arguments);
int compare(const CompareArguments& arguments);
int status(const StatusArguments& arguments);
int kinematics_razi(const RaziArguments& arguments);
int kinematics_motion(const MotionArguments& arguments);
int study_scene(const StudyArguments& arguments);
int schema(const SchemaArguments& arguments);
int doctor(const DoctorArguments& arguments);
int stress(const StressArguments& arguments);

/// Reads the command line and calls the verb.
int dispatch(int count, char** values);

}  // namespace bough::app
