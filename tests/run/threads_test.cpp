/// Scenes that run beside each other in one process, each on several threads, have the bits that they have alone. Under
/// the thread sanitizer this is the search for races in the library as a whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "bough/io/history.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/run/estimate.hpp"
#include "bough/run/memory_run.hpp"
#include "bough/run/simulate.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "support/source_dir.hpp"

namespace bough::run {
namespace {

/// Long scenes are cut short, and tasks are made however small the scene is.
scene::Scene shortened(scene::Scene s, double steps) {
  constexpr double large = 5000.0;  // unknowns
  const double most = estimate_run(s).unknowns > large ? 2.0 : steps;
  if (scene::type_of(s.analysis.kind).is_in_time)
    s.analysis.end_time = std::min(s.analysis.end_time, most * s.analysis.step_size);
  else
    s.analysis.load_steps = std::min(s.analysis.load_steps, static_cast<int>(most));
  s.expected.clear();
  s.without.emplace_back("small");
  return s;
}

std::string rows_of(const scene::Scene& scene, int threads) {
  SimulateOptions options;
  options.threads = threads;
  options.want_motion = true;
  const MemoryRun run = run_in_memory(scene, options);
  std::string text = run.summary.cause;
  for (const records::HistoryRow& row : run.rows) io::append_history_row(text, row);
  return text;
}

TEST(Threads, scenes_beside_each_other_have_the_bits_that_they_have_alone) {
  const char* asked = std::getenv("BOUGH_TEST_STEPS");
  const double steps = asked != nullptr ? std::atof(asked) : 6.0;
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"data/scenarios", "data/gallery"})
    for (const auto& entry : std::filesystem::directory_iterator(support::source_dir() / folder))
      if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_GE(files.size(), 40u);
  std::vector<std::string> alone(files.size()), beside(files.size());
  const auto read = [&](std::size_t i) { return shortened(io::read_scene(files[i], {}).scene, steps); };
  for (std::size_t i = 0; i < files.size(); ++i) alone[i] = rows_of(read(i), 1);
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> threads;
  constexpr int side_by_side = 4, of_each = 4;
  for (int k = 0; k < side_by_side; ++k)
    threads.emplace_back([&] {
      for (std::size_t i = next++; i < files.size(); i = next++) beside[i] = rows_of(read(i), of_each);
    });
  for (std::thread& t : threads) t.join();
  for (std::size_t i = 0; i < files.size(); ++i) {
    EXPECT_FALSE(alone[i].empty()) << files[i];
    EXPECT_TRUE(alone[i] == beside[i]) << files[i];
  }
}

}  // namespace
}  // namespace bough::run
