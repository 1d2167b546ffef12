// fuzz_inputs FOLDER: reads inputs from standard input, one after the other, and says what came of each, for
// tests/tools/campaign/fuzz.py. an input:  KIND NUMBER_OF_OVERRIDES\n, then the text and each override as
// LENGTH\nBYTES;  KIND: scene, study, sweep, motion or frames an answer: ok|refused CPU_SECONDS PEAK_MEGABYTES FAULT\n,
// FAULT in words, empty where the input was dealt with as it must A study's files lie in FOLDER. Scenes that are
// small are run for some steps as well. A crash ends the process before the answer.
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "bough/io/read_frames.hpp"
#include "bough/io/read_motion.hpp"
#include "bough/io/read_study.hpp"
#include "bough/io/read_sweep.hpp"
#include "bough/run/estimate.hpp"
#include "bough/run/memory_run.hpp"
#include "bough/run/simulate.hpp"

namespace {

using bough::io::Problem;
using bough::scene::Scene;

struct Input {
  std::string kind, text;
  std::vector<std::string> overrides;
};

bool read_block(std::istream& in, std::string& block) {
  std::size_t length = 0;
  if (!(in >> length)) return false;
  in.get();
  block.resize(length);
  in.read(block.data(), static_cast<std::streamsize>(length));
  return static_cast<bool>(in);
}

bool read_input(std::istream& in, Input& input) {
  std::size_t count = 0;
  if (!(in >> input.kind >> count) || !read_block(in, input.text)) return false;
  input.overrides.assign(count, "");
  for (std::string& o : input.overrides)
    if (!read_block(in, o)) return false;
  return true;
}

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

long peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

/// What a message may not hold: nothing at all, control characters, bytes that are not UTF-8.
std::string fault_of(const std::string& message) {
  if (message.empty()) return "a problem without a word";
  for (std::size_t i = 0; i < message.size(); ++i) {
    const auto c = static_cast<unsigned char>(message[i]);
    const std::size_t more = c < 0x80                ? 0
                             : c >= 0xC2 && c < 0xE0 ? 1
                             : c >= 0xE0 && c < 0xF0 ? 2
                             : c >= 0xF0 && c < 0xF5 ? 3
                                                     : 9;
    if (c < 0x20 || c == 0x7F) return "a message holds a control character";
    if (more == 9 || i + more >= message.size()) return "a message is not UTF-8";
    for (std::size_t k = 1; k <= more; ++k)
      if ((static_cast<unsigned char>(message[i + k]) & 0xC0u) != 0x80u) return "a message is not UTF-8";
    i += more;
  }
  return "";
}

std::string fault_of(const std::vector<Problem>& problems, const std::vector<Problem>& warnings) {
  for (const auto* list : {&problems, &warnings})
    for (const Problem& p : *list)
      for (std::string message : {p.text(), p.long_text()}) {
        std::replace(message.begin(), message.end(), '\n', ' ');  // the long text has lines
        if (const std::string fault = fault_of(message); !fault.empty()) return fault;
      }
  return "";
}

/// Runs a scene for some steps: good results hold finite numbers only.
std::string run_fault(Scene scene) {
  constexpr double most_unknowns = 3000.0, most_seconds = 0.5;
  constexpr long most_steps = 12;
  if (bough::run::estimate_run(scene).unknowns > most_unknowns) return "";
  scene.analysis.end_time = std::min(scene.analysis.end_time, 8.0 * scene.analysis.step_size);
  scene.analysis.load_steps = std::min(scene.analysis.load_steps, 2);
  const double start = cpu_seconds();
  long attempts = 0;
  bough::run::SimulateOptions options;
  options.before_step = [&](auto&, const auto&, const auto&) {
    return ++attempts < most_steps && cpu_seconds() - start < most_seconds;
  };
  const bough::run::MemoryRun run = bough::run::run_in_memory(scene, options);
  if (!run.ok()) return run.summary.cause.empty() ? "a run failed without a cause" : fault_of(run.summary.cause);
  for (const auto& row : run.rows)
    for (const double x : row.values)
      if (!std::isfinite(x)) return "a run is ok, and a value is not finite";
  return "";
}

std::string deal_with(const Input& input, const std::string& folder, bool& is_ok) {
  if (input.kind == "scene") {
    const auto file = bough::io::read_scene_text(input.text, "fuzz", input.overrides);
    is_ok = file.ok();
    const std::string fault = fault_of(file.problems, file.warnings);
    return fault.empty() && is_ok ? run_fault(file.scene) : fault;
  }
  if (input.kind == "study") {
    const auto file = bough::io::read_study_text(input.text, "fuzz", folder);
    is_ok = file.ok();
    return fault_of(file.problems, file.warnings);
  }
  if (input.kind == "sweep") {
    const auto file = bough::io::read_sweep_text(input.text, "fuzz", folder);
    is_ok = file.ok();
    return fault_of(file.problems, file.warnings);
  }
  if (input.kind == "frames") {
    const auto file = bough::io::read_frames_text(input.text, "fuzz");
    is_ok = file.ok();
    return fault_of(file.problems, {});
  }
  const auto file = bough::io::read_motion_text(input.text);
  is_ok = file.ok();
  return fault_of(file.problems, {});
}

}  // namespace

int main(int count, char** values) {
  const std::string folder = count > 1 ? values[1] : ".";
  std::ios::sync_with_stdio(false);
  Input input;
  while (read_input(std::cin, input)) {
    const double start = cpu_seconds();
    bool is_ok = false;
    std::string fault;
    try {
      fault = deal_with(input, folder, is_ok);
    } catch (const std::exception& error) {
      fault = std::string("an exception: ") + error.what();
    }
    std::cout << (is_ok ? "ok " : "refused ") << cpu_seconds() - start << " " << peak_megabytes() << " " << fault
              << std::endl;
  }
  return 0;
}
