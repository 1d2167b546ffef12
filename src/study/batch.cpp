#include "bough/study/batch.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "bough/io/read_scene.hpp"
#include "bough/io/run_directory.hpp"
#include "cases/case_report.hpp"

namespace bough::study {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t max_cause = 4000;  // [bytes]
constexpr int poll_milliseconds = 20;
constexpr double least_grace = 2.0, part_of_limit = 0.1;  // wall time to end by itself past the time limit [s], [-]

struct Child {
  std::size_t index = 0;
  pid_t process = -1;
  int pipe = -1;
  Clock::time_point started;
  std::string told;  ///< what came through the pipe so far
  bool timed_out = false, killed = false;
};

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "; ");
  return text;
}

/// The child must not outlive its parent, which may have ended before this was asked for.
void end_with_parent(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
}

bool write_all(int pipe, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(pipe, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

[[noreturn]] void run_in_child(const BatchCase& which, const RunCase& run_case, int pipe) {
  CaseReport report;
  int code = 1;
  try {
    code = run_case(which, report);
  } catch (const std::exception& error) {
    report.cause = error.what();
  } catch (...) {
    report.cause = "unknown failure";
  }
  if (report.cause.size() > max_cause) report.cause.resize(max_cause);
  (void)write_all(pipe, text_of(report));
  ::_exit(code);  // nothing of the parent's is flushed or destroyed twice
}

/// Nothing where no process can be started; errno says why.
std::optional<Child> start(const BatchCase& which, std::size_t index, const RunCase& run_case) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return std::nullopt;
  const pid_t parent = ::getpid(), process = ::fork();
  if (process < 0) {
    const int error = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    errno = error;
    return std::nullopt;
  }
  if (process == 0) {
    end_with_parent(parent);
    ::close(ends[0]);
    run_in_child(which, run_case, ends[1]);
  }
  ::close(ends[1]);
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return Child{index, process, ends[0], Clock::now(), {}};
}

/// Takes what is there, without waiting; false at the end of the pipe.
bool read_some(Child& child) {
  char buffer[4096];
  while (true) {
    const ssize_t count = ::read(child.pipe, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno == EAGAIN;
    if (count == 0) return false;
    child.told.append(buffer, static_cast<std::size_t>(count));
  }
}

CaseStatus status_of(const Child& child, int wait_status) {
  if (child.timed_out) return CaseStatus::timed_out;
  if (WIFSIGNALED(wait_status)) return CaseStatus::crashed;
  switch (WEXITSTATUS(wait_status)) {
    case 0:
      return CaseStatus::ok;
    case 2:
      return CaseStatus::bad_input;
    default:
      return CaseStatus::failed;
  }
}

/// What is kept of a case that was killed, in words.
std::string kept_rows(const BatchCase& which) {
  try {
    const std::optional<fs::path> kept = io::RunDirectory::keep_rows_of_killed(which.directory);
    return kept ? "its rows to the last flush are in " + kept->string() : "there are no rows of it";
  } catch (const std::exception& error) {
    return std::string("its rows are lost: ") + error.what();
  }
}

CaseCost cost_of(const Child& child, const rusage& usage) {
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  const std::chrono::duration<double> age = Clock::now() - child.started;
  return {age.count(), seconds(usage.ru_utime) + seconds(usage.ru_stime),
          1024.0 * static_cast<double>(usage.ru_maxrss)};
}

CaseResult result_of(Child& child, const BatchCase& which, int wait_status, const rusage& usage) {
  CaseResult result;
  result.which = which;
  result.status = status_of(child, wait_status);
  result.cost = cost_of(child, usage);
  (void)read_some(child);
  ::close(child.pipe);
  if (!report_of(child.told, result.report) && result.status != CaseStatus::crashed &&
      result.status != CaseStatus::timed_out) {
    result.status = CaseStatus::failed;
    result.report.cause = "what it told of its end did not arrive whole";
  }
  const CaseReport& report = result.report;
  result.cause = one_line(report.cause);
  if (result.status == CaseStatus::timed_out && (child.killed || WIFSIGNALED(wait_status)))
    result.cause = "killed at the time limit, since it did not stop by itself; " + kept_rows(which);
  if (result.status == CaseStatus::crashed)
    result.cause = "ended by signal " + std::to_string(WTERMSIG(wait_status)) + "; " + kept_rows(which);
  if (result.status == CaseStatus::ok && report.expected_fails > 0) {
    result.status = CaseStatus::figures_fail;
    result.cause = report.failing;
  }
  if (report.was_interrupted && result.status == CaseStatus::failed) result.status = CaseStatus::interrupted;
  if (!report.directory.empty() && report.directory != which.directory)
    result.cause += " (the former results were good and are kept; see " + report.directory.string() + ")";
  return result;
}

}  // namespace

std::string_view text_of(CaseStatus status) {
  switch (status) {
    case CaseStatus::ok:
      return "ok";
    case CaseStatus::figures_fail:
      return "figures_fail";
    case CaseStatus::failed:
      return "failed";
    case CaseStatus::interrupted:
      return "interrupted";
    case CaseStatus::bad_input:
      return "bad_input";
    case CaseStatus::crashed:
      return "crashed";
    case CaseStatus::timed_out:
      return "timed_out";
  }
  return "failed";
}

std::vector<BatchCase> cases_in(const fs::path& folder, const fs::path& out) {
  std::error_code error;
  std::vector<BatchCase> cases;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() != ".json" || it->is_directory()) continue;
    const std::string name = io::name_of_file(it->path());
    cases.push_back({name, it->path(), out / name});
  }
  if (error) throw std::runtime_error("cannot read the folder " + folder.string() + ": " + error.message());
  if (cases.empty()) throw std::runtime_error("no scene (*.json) in " + folder.string());
  std::sort(cases.begin(), cases.end(), [](const BatchCase& a, const BatchCase& b) { return a.name < b.name; });
  return cases;
}

namespace {

/// A case past its limit is asked to stop, and killed when it has had time to.
void keep_to_limit(Child& child, double limit) {
  const std::chrono::duration<double> age = Clock::now() - child.started;
  if (limit <= 0.0 || age.count() <= limit) return;
  if (!child.timed_out) ::kill(child.process, SIGTERM);
  child.timed_out = true;
  if (child.killed || age.count() <= limit + std::max(least_grace, part_of_limit * limit)) return;
  child.killed = true;
  ::kill(child.process, SIGKILL);
}

CaseResult not_started(const BatchCase& which, int error) {
  CaseResult result;
  result.which = which;
  result.cause = "no process could be started for it: " + std::generic_category().message(error);
  return result;
}

/// Waits until a case tells something or ends, but no longer than limits are looked at.
void wait_for(std::vector<Child>& running) {
  std::vector<pollfd> pipes;
  for (const Child& child : running) pipes.push_back({child.pipe, POLLIN, 0});
  (void)::poll(pipes.data(), pipes.size(), poll_milliseconds);
  for (std::size_t k = 0; k < running.size(); ++k)
    if (pipes[k].revents != 0 && !read_some(running[k])) std::this_thread::yield();  // it is about to end
}

/// One batch as it goes.
class Batch {
 public:
  Batch(const std::vector<BatchCase>& cases, const BatchOptions& options, const RunCase& run_case, const CaseDone& done)
      : cases_(cases), options_(options), run_case_(run_case), done_(done), results_(cases.size()) {
    order_ = options.order;
    for (std::size_t k = order_.size(); k < cases.size(); ++k) order_.push_back(k);
  }

  std::vector<CaseResult> run(const std::function<bool()>& stop) {
    bool stopping = false;
    while (next_ < order_.size() || !running_.empty()) {
      if (!stopping && stop()) {
        stopping = true;
        for (const Child& child : running_) ::kill(child.process, SIGTERM);
      }
      if (stopping && running_.empty()) break;
      while (!stopping && next_ < order_.size() && running_.size() < static_cast<std::size_t>(options_.threads))
        start_next();
      if (!collect()) wait_for(running_);
    }
    for (; next_ < order_.size(); ++next_) {
      CaseResult& result = results_[order_[next_]];
      result.which = cases_[order_[next_]];
      result.status = CaseStatus::interrupted;
      result.cause = "not started";
    }
    return std::move(results_);
  }

 private:
  void start_next() {
    const std::size_t index = order_[next_++];
    if (std::optional<Child> child = start(cases_[index], index, run_case_)) {
      running_.push_back(std::move(*child));
      return;
    }
    results_[index] = not_started(cases_[index], errno);
    done_(results_[index], ++num_done_, cases_.size());
  }

  /// True where a case has ended.
  bool collect() {
    bool any_ended = false;
    for (std::size_t k = 0; k < running_.size();) {
      Child& child = running_[k];
      int wait_status = 0;
      rusage usage{};
      if (::wait4(child.process, &wait_status, WNOHANG, &usage) == child.process) {
        CaseResult& result = results_[child.index] = result_of(child, cases_[child.index], wait_status, usage);
        running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(k));
        done_(result, ++num_done_, cases_.size());
        any_ended = true;
        continue;
      }
      keep_to_limit(child, options_.time_limit);
      ++k;
    }
    return any_ended;
  }

  const std::vector<BatchCase>& cases_;
  const BatchOptions& options_;
  const RunCase& run_case_;
  const CaseDone& done_;
  std::vector<CaseResult> results_;
  std::vector<std::size_t> order_;
  std::vector<Child> running_;
  std::size_t next_ = 0, num_done_ = 0;
};

}  // namespace

std::vector<CaseResult> run_batch(const std::vector<BatchCase>& cases, const BatchOptions& options,
                                  const RunCase& run_case, const CaseDone& done, const std::function<bool()>& stop) {
  return Batch(cases, options, run_case, done).run(stop);
}

}  // namespace bough::study
