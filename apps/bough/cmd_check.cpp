/// bough check SCENE, bough schema.
#include <filesystem>
#include <fstream>
#include <iostream>

#include "arguments.hpp"
#include "bough/elements/coupling_kinds.hpp"
#include "bough/io/atomic_file.hpp"
#include "bough/io/fix_scene.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/read_frames.hpp"
#include "bough/io/read_motion.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/read_study.hpp"
#include "bough/io/read_sweep.hpp"
#include "bough/plan/undriven.hpp"
#include "memory_limit.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

/// Lists of a scene whose items are counted, as written: those before and those after couplings.
struct CountedList {
  std::string_view key;
  const char *one, *many;
};
constexpr CountedList structure[] = {{"nodes", "node", "nodes"},
                                     {"bodies", "body", "bodies"},
                                     {"beams", "beam", "beams"},
                                     {"joints", "joint", "joints"}};
constexpr CountedList others[] = {{"actuators", "actuator", "actuators"},
                                  {"loads", "load", "loads"},
                                  {"motions", "prescribed motion", "prescribed motions"},
                                  {"signals", "signal", "signals"},
                                  {"sensors", "sensor", "sensors"},
                                  {"expected", "expected figure", "expected figures"},
                                  {"measures", "measure", "measures"}};

void count(std::string& text, std::size_t number, const char* one, const char* many) {
  if (number == 0) return;
  text += (text.empty() ? " " : ", ") + std::to_string(number) + " " + (number == 1 ? one : many);
}

/// Whether a plan of the scene is made in no time.
bool is_small(const scene::Scene& s) {
  constexpr std::size_t most = 5000;
  std::size_t parts = s.nodes.size() + s.bodies.size() + s.joints.size() + s.couplings.size() + s.point_loads.size() +
                      s.line_loads.size() + s.frames.size();
  for (const scene::Beam& b : s.beams)
    parts += static_cast<std::size_t>(b.elements) * static_cast<std::size_t>(b.order);
  return parts <= most;
}

/// What the plan finds locked, loose or without inertia: hints, which change no verdict, but for motions that the
/// analysis cannot leave free. Returns the number of these.
std::size_t print_mobility(const std::filesystem::path& file, const scene::Scene& s) {
  if (!is_small(s)) return 0;
  const plan::Plan plan = plan::make_plan(s);
  const plan::Mobility& mobility = plan.mobility;
  for (const auto* list : {&mobility.locked, &mobility.free, &mobility.massless})
    for (const std::string& text : *list) std::cerr << file.string() << ": warning: " << text << " [mobility]\n";
  if (const plan::IdleMotions idle = plan::idle_motions(s, plan); idle.count > 0)
    std::cerr << file.string() << ": warning: " << idle.note << " [mobility]\n";
  const std::vector<std::string> refused = plan::undriven_motions(s, plan);
  for (const std::string& text : refused) std::cerr << file.string() << ": " << text << " [undriven]\n";
  return refused.size();
}

/// Changes the file, or shows how it would be changed. A link is followed: the file that it leads to is written.
int fix_file(const CheckArguments& arguments) {
  if (arguments.scene == "-") {
    std::cerr << "bough: what comes from standard input has no file that could be changed\n";
    return exit_bad_input;
  }
  const std::filesystem::path folder = arguments.scene.has_parent_path() ? arguments.scene.parent_path() : ".";
  std::string before;
  try {
    before = io::read_text(arguments.scene, io::max_file_bytes);
  } catch (const io::Unreadable& error) {
    std::cerr << arguments.scene.string() << ": " << error.why() << "\n";
    return exit_bad_input;
  }
  const io::FixedScene fixed = io::fixed_scene(before, folder);
  if (arguments.dry_run) {
    std::cout << io::diff_of(arguments.scene.string(), before, fixed.text) << std::flush;
    return std::cout.good() ? exit_done : exit_failed;
  }
  if (fixed.text != before) {
    const std::filesystem::path file = std::filesystem::canonical(arguments.scene);
    const std::filesystem::perms permissions = std::filesystem::status(file).permissions();
    io::write_file(file, fixed.text);
    std::filesystem::permissions(file, permissions);
  }
  for (const io::FixDone& f : fixed.done)
    std::cout << arguments.scene.string() << ": line " << f.problem.line << ", column " << f.problem.column << ": "
              << io::shown(f.before)
              << (f.problem.fix->text.empty() ? " left out" : " changed to " + f.problem.fix->text) << " ["
              << f.problem.code << "]\n";
  if (fixed.done.empty()) std::cout << arguments.scene.string() << ": nothing that is sure to be changed\n";
  std::cout << std::flush;
  return exit_done;
}

}  // namespace

int check(const CheckArguments& arguments) {
  if (arguments.fix)
    if (const int status = fix_file(arguments); status != exit_done || arguments.dry_run) return status;
  const io::SceneFile file = io::read_scene(arguments.scene, arguments.overrides);
  print_problems(arguments.scene, file, false);
  const auto refuse = [](std::size_t problems) {
    std::cerr << problems << (problems == 1 ? " problem\n" : " problems\n");
    return exit_bad_input;
  };
  if (!file.ok()) return refuse(file.problems.size());
  if (refuse_for_memory(arguments.scene, file.scene, arguments.memory_limit)) return exit_bad_input;
  const scene::Scene& s = file.scene;
  if (const std::size_t refused = print_mobility(arguments.scene, s); refused > 0) return refuse(refused);
  std::string parts;
  const auto count_list = [&](const CountedList& list) {
    if (const auto written = file.counts.find(list.key); written != file.counts.end())
      count(parts, written->second, list.one, list.many);
  };
  for (const CountedList& list : structure) count_list(list);
  for (const scene::CouplingKind* kind : elements::coupling_kinds()) count_list({kind->list, kind->name, kind->list});
  for (const CountedList& list : others) count_list(list);
  std::cout << "ok:" << (parts.empty() ? " an empty scene" : parts) << "\n";
  return exit_done;
}

int schema(const SchemaArguments& arguments) {
  std::cout << (arguments.chain    ? io::frames_schema_text()
                : arguments.motion ? io::motion_schema_text()
                : arguments.study  ? io::study_schema_text()
                : arguments.sweep  ? io::sweep_schema_text()
                                   : io::schema_text())
            << std::flush;
  return std::cout.good() ? exit_done : exit_failed;
}

}  // namespace bough::app
