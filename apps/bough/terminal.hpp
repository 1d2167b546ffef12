#pragma once
/// What the verbs share: the stop flag of Ctrl-C, progress on the terminal, problems of scenes.
#include <chrono>
#include <exception>
#include <string>

#include "bough/io/output_folder.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/summary.hpp"
#include "bough/records/run.hpp"

namespace bough::app {

/// From now on Ctrl-C, SIGTERM, SIGUSR1 (by which queues tell that time is running out) and SIGHUP only set a flag; a
/// second one of the same kind ends the process at once.
/// Under nohup SIGHUP stays ignored. Repeated::ignored: a second one sets the flag again; for a process whose parent
/// ends it where it has to.
enum class Repeated { ends, ignored };
void catch_interrupts(Repeated repeated = Repeated::ends);
bool interrupted();

int default_threads();

/// What an exception says, in words for whoever runs the program.
std::string cause_of(const std::exception& error);

/// Simulated time, step size, Newton iterations and remaining time on standard error: a bar that redraws itself on a
/// terminal, a plain line every tenth of the way (and at most every two seconds) elsewhere, nothing when quiet.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  void show(const records::Progress& progress);
  void clear();  ///< ends the bar's line; call it before printing anything else

 private:
  using Clock = std::chrono::steady_clock;
  void show_bar(const records::Progress& progress, double part, double remaining);

  bool quiet_, on_terminal_;
  Clock::time_point start_ = Clock::now(), shown_at_ = start_;
  int tenths_ = 0;
  bool bar_is_shown_ = false;
};

/// Empties the last line of a terminal on standard error.
void clear_line();

/// All problems and then all warnings, one to a line, on standard error. Warnings are left out when quiet.
void print_problems(const std::filesystem::path& file, const std::vector<io::Problem>& problems,
                    const std::vector<io::Problem>& warnings);
void print_problems(const std::filesystem::path& file, const io::SceneFile& scene, bool quiet);

/// Says on standard error where results stand that could not take the place of what is under their name.
void tell_if_beside(const io::OutputFolder& folder);

/// What the results of a scene are made from, for their summary.
io::RunOrigin origin_of(const std::filesystem::path& scene, const io::SceneFile& file,
                        const std::vector<std::string>& overrides);

}  // namespace bough::app
