/// bough doctor: what this program was built with, what the machine offers, and a small run of its own.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>

#include "arguments.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/lanes/instruction_set.hpp"
#include "bough/run/simulate.hpp"
#include "bough/schedule/threads.hpp"
#include "bough/version.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

/// A ball that falls freely; all figures are exact in binary.
constexpr std::string_view falling_ball = R"({
  "schema_version": 1, "title": "falling", "gravity": [0, 0, -8],
  "bodies": [{"name": "ball", "kind": "point_mass", "mass": 2, "position": [0, 0, 0]}],
  "sensors": [{"name": "ball", "kind": "position", "at": "ball"}],
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.0625}
})";

struct InMemory final : records::Recorder {
  std::vector<records::HistoryRow> rows;
  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow& row) override { rows.push_back(row); }
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override {}
};

#if defined(__x86_64__)
/// What the processor has, as the kernel lists it. __builtin_cpu_supports would ask the processor at every start of the
/// program, which virtual machines take long to answer.
std::string processor_flags() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("flags")) return line + " ";
  return {};
}
#endif

std::string instruction_sets() {
  const lanes::InstructionSet used = lanes::instruction_set();
  const std::string text =
      std::string(used.name) + ", " + std::to_string(used.register_doubles) + " doubles to a register";
#if defined(__x86_64__)
  const std::string flags = processor_flags();
  std::string offered;
  if (flags.find(" avx2 ") != std::string::npos) offered += " AVX2";
  if (flags.find(" fma ") != std::string::npos) offered += " FMA";
  if (flags.find(" avx512f ") != std::string::npos) offered += " AVX-512";
  return text + "; the processor offers" + (offered.empty() ? " SSE2" : offered);
#else
  return text;
#endif
}

bool line(bool good, const std::string& text) {
  std::cout << (good ? "  ok    " : "  FAIL  ") << text << "\n";
  return good;
}

bool test_run() {
  const io::SceneFile file = io::read_scene_text(falling_ball, "falling");
  for (const io::Problem& problem : file.problems) std::cerr << problem.text() << "\n";
  if (!line(file.ok(), "a scene in memory is read")) return false;
  InMemory one, two;
  const records::Summary summary = run::simulate(file.scene, {.threads = 1}, one);
  (void)run::simulate(file.scene, {.threads = 2}, two);
  bool good = line(summary.status == records::RunStatus::ok && !one.rows.empty(),
                   "it is simulated" + (summary.cause.empty() ? "" : ": " + summary.cause));
  if (!good) return false;
  const double height = one.rows.back().values.at(2);
  good = line(std::abs(height + 4.0) < 1e-9, "a free fall ends where g t^2 / 2 says") && good;
  const auto same = [](const records::HistoryRow& a, const records::HistoryRow& b) {
    return a.values == b.values && a.time == b.time;
  };
  return line(std::equal(one.rows.begin(), one.rows.end(), two.rows.begin(), two.rows.end(), same),
              "one and two threads give the same bits") &&
         good;
}

}  // namespace

int doctor(const DoctorArguments&) {
  std::cout << "bough " << version << " (" << commit << ")\n"
            << "  built   " << compiler << ", " << compiler_flags << "\n"
            << "  with    " << BOUGH_LIBRARIES << "\n"
            << "  lanes   " << instruction_sets() << "\n"
            << "  threads " << default_threads() << " on this machine\n";
  bool good = line(schedule::Threads(2).count() == 2, "two threads can be had");
  good = test_run() && good;
  std::cout << (good ? "all is well\n" : "something is wrong: see the lines marked FAIL\n");
  return good ? exit_done : exit_failed;
}

}  // namespace bough::app
