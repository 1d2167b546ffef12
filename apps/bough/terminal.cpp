#include "terminal.hpp"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>
#include <system_error>
#include <thread>

#include "bough/io/number_text.hpp"
#include "bough/io/program_hash.hpp"
#include "bough/version.hpp"
#include "standard_streams.hpp"

namespace bough::app {
namespace {

volatile std::sig_atomic_t stop_asked = 0;

extern "C" void ask_to_stop(int) { stop_asked = 1; }

std::string duration_text(double seconds) {
  if (seconds < 60.0)
    return io::rounded_text(seconds < 10.0 ? std::max(seconds, 0.0) : static_cast<double>(static_cast<int>(seconds)),
                            2) +
           " s";
  const long minutes = static_cast<long>(seconds / 60.0);
  if (minutes < 60) return std::to_string(minutes) + " min";
  return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
}

std::string words(const records::Progress& progress, double remaining) {
  std::string text = "t = " + io::rounded_text(progress.time, 4) + " of " + io::rounded_text(progress.end_time, 4) +
                     ", h = " + io::rounded_text(progress.step_size, 3) + ", " + std::to_string(progress.iterations) +
                     " iterations";
  if (remaining > 0.0) text += ", " + duration_text(remaining) + " left";
  return text;
}

}  // namespace

void catch_interrupts(Repeated repeated) {
  struct sigaction action = {};
  action.sa_handler = ask_to_stop;
  action.sa_flags = static_cast<int>(repeated == Repeated::ends ? SA_RESETHAND | SA_RESTART : SA_RESTART);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGUSR1, &action, nullptr);
  struct sigaction former = {};
  sigaction(SIGHUP, nullptr, &former);
  if (former.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup asks for that
}

bool interrupted() { return stop_asked != 0; }

int default_threads() { return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 1024u)); }

std::string cause_of(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr)
    return "out of memory: the scene takes more than this process gets (bough plan says how much)";
  if (const auto* system = dynamic_cast<const std::system_error*>(&error);
      system != nullptr && system->code() == std::errc::resource_unavailable_try_again)
    return "the system gives this process no more threads or memory (ulimit -u, ulimit -v)";
  return error.what();
}

ProgressBar::ProgressBar(bool quiet) : quiet_(quiet), on_terminal_(isatty(STDERR_FILENO) != 0) {}

void ProgressBar::show(const records::Progress& progress) {
  if (quiet_) return;
  constexpr std::chrono::milliseconds redraw{100};
  constexpr std::chrono::seconds next_line{2};
  const auto now = Clock::now();
  if (now - shown_at_ < redraw) return;
  const double part = progress.end_time > 0.0 ? std::clamp(progress.time / progress.end_time, 0.0, 1.0) : 0.0;
  const std::chrono::duration<double> elapsed = now - start_;
  const double remaining = part > 0.0 ? elapsed.count() * (1.0 - part) / part : 0.0;
  if (on_terminal_) {
    shown_at_ = now;
    show_bar(progress, part, remaining);
  } else if (static_cast<int>(10.0 * part) > tenths_ && now - shown_at_ >= next_line) {
    shown_at_ = now;
    tenths_ = static_cast<int>(10.0 * part);
    std::cerr << words(progress, remaining) << "\n";
  }
}

void ProgressBar::show_bar(const records::Progress& progress, double part, double remaining) {
  constexpr int width = 24;
  const int filled = static_cast<int>(part * width);
  std::string line = std::string(line_start) + "[" + std::string(static_cast<std::size_t>(filled), '#') +
                     std::string(static_cast<std::size_t>(width - filled), '.') + "] ";
  line += words(progress, remaining) + std::string(line_rest_erased);
  write_to_terminal(true, line);
  bar_is_shown_ = true;
}

void ProgressBar::clear() {
  if (bar_is_shown_) clear_line();
  bar_is_shown_ = false;
}

void tell_if_beside(const io::OutputFolder& folder) {
  if (folder.stands_beside())
    std::cerr << "bough: " << folder.why_beside() << "; what is new stands in " << folder.folder().string() << "\n";
}

void clear_line() { write_to_terminal(true, std::string(line_start) + std::string(line_rest_erased)); }

void print_problems(const std::filesystem::path& file, const std::vector<io::Problem>& problems,
                    const std::vector<io::Problem>& warnings) {
  for (const io::Problem& problem : problems) std::cerr << file.string() << ": " << problem.long_text();
  for (const io::Problem& warning : warnings)
    std::cerr << file.string() << ": warning: " << warning.text() << " [" << warning.code << "]\n";
}

io::RunOrigin origin_of(const std::filesystem::path& scene, const io::SceneFile& file,
                        const std::vector<std::string>& overrides) {
  return {scene, file.hash, overrides, std::string(commit), io::program_hash()};
}

void print_problems(const std::filesystem::path& file, const io::SceneFile& scene, bool quiet) {
  print_problems(file, scene.problems, quiet ? std::vector<io::Problem>{} : scene.warnings);
}

}  // namespace bough::app
