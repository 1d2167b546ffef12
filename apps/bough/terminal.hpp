#pragma once
/// What the verbs share: the stop flag of Ctrl-C, progress on the terminal, problems of scenes.
#include <chrono>
#include <string>

#include "bough/io/read_scene.hpp"
#include "bough/results/records.hpp"

namespace bough::app {

/// From now on Ctrl-C and SIGTERM only set a flag; a second one ends the process at once.
void catch_interrupts();
bool interrupted();

int default_threads();

/// Simulated time, step size, Newton iterations and remaining time on standard error: a bar that redraws itself on a terminal, a plain line
/// every tenth of the way (and at most every two seconds) elsewhere, nothing when quiet.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  void show(const results::Progress& progress);
  void clear();  ///< ends the bar's line; call it before printing anything else

 private:
  using Clock = std::chrono::steady_clock;
  void show_bar(const results::Progress& progress, double part, double remaining);

  bool quiet_, on_terminal_;
  Clock::time_point start_ = Clock::now(), shown_at_ = start_;
  int tenths_ = 0;
  bool bar_is_shown_ = false;
};

/// All problems and then all warnings, one to a line, on standard error. Warnings are left out when quiet.
void print_problems(const std::filesystem::path& file, const std::vector<io::Problem>& problems,
                    const std::vector<io::Problem>& warnings);
void print_problems(const std::filesystem::path& file, const io::SceneFile& scene, bool quiet);

}  // namespace bough::app
