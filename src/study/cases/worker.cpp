#include "worker.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include "bough/io/number_text.hpp"
#include "case_report.hpp"

namespace bough::study {
namespace {

constexpr std::size_t max_cause = 4000;  // [bytes]

bool write_all(int pipe, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(pipe, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

/// Reads the number of the next case; false if the parent has no more.
bool read_case(int pipe, std::size_t& which) {
  char bytes[sizeof which];
  for (std::size_t got = 0; got < sizeof bytes;) {
    const ssize_t count = ::read(pipe, bytes + got, sizeof bytes - got);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    got += static_cast<std::size_t>(count);
  }
  std::memcpy(&which, bytes, sizeof which);
  return true;
}

double cpu_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Resets the peak memory of the process, which the system otherwise keeps.
void forget_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

double peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:") {
      double kilobytes = 0.0;
      status >> kilobytes;
      return 1024.0 * kilobytes;
    }
  return 0.0;
}

std::string answer_text(const BatchCase& which, const RunCase& run_case, io::SharedText& rows) {
  CaseReport report;
  int code = 1;
  const double start = cpu_seconds();
  forget_peak();
  try {
    code = run_case(which, report, rows);
  } catch (const std::exception& error) {
    report.cause = error.what();
  } catch (...) {
    report.cause = "unknown failure";
  }
  if (report.cause.size() > max_cause) report.cause.resize(max_cause);
  const std::string text = text_of(report);
  std::string head = std::to_string(code) + ' ';
  io::append_number(head, cpu_seconds() - start);
  head += ' ';
  io::append_number(head, peak_bytes());
  return head + ' ' + std::to_string(text.size()) + '\n' + text;
}

}  // namespace

Worker::Worker(const CaseList& cases, const RunCase& run_case, const std::vector<Worker>& others) {
  int to[2], from[2];
  if (::pipe2(to, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category());
  if (::pipe2(from, O_CLOEXEC) != 0) {
    const int error = errno;
    ::close(to[0]);
    ::close(to[1]);
    throw std::system_error(error, std::generic_category());
  }
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ < 0) {
    const int error = errno;
    for (const int end : {to[0], to[1], from[0], from[1]}) ::close(end);
    throw std::system_error(error, std::generic_category());
  }
  const bool is_child = process_ == 0;
  to_ = is_child ? to[0] : to[1];
  from_ = is_child ? from[1] : from[0];
  ::close(is_child ? to[1] : to[0]);
  ::close(is_child ? from[0] : from[1]);
  if (is_child) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // the parent had ended before this call
    for (const Worker& other : others) {
      ::close(other.to_);
      ::close(other.from_);
    }
    serve(cases, run_case);
  }
  ::fcntl(from_, F_SETFL, O_NONBLOCK);
}

void Worker::serve(const CaseList& cases, const RunCase& run_case) {
  std::size_t which = 0;
  while (read_case(to_, which) && write_all(from_, answer_text(cases.at(which), run_case, rows_))) {
  }
  ::_exit(0);  // no buffers or objects of the parent are flushed or destroyed twice
}

Worker& Worker::operator=(Worker&& other) noexcept {
  std::swap(rows_, other.rows_);
  std::swap(process_, other.process_);
  std::swap(to_, other.to_);
  std::swap(from_, other.from_);
  std::swap(case_, other.case_);
  std::swap(given_at_, other.given_at_);
  std::swap(told_, other.told_);
  std::swap(resident_, other.resident_);
  std::swap(has_ended_, other.has_ended_);
  std::swap(asked_, other.asked_);
  std::swap(killed_, other.killed_);
  return *this;
}

double Worker::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - given_at_).count();
}

bool Worker::give(std::size_t which) {
  rows_.clear();
  if (!write_all(to_, {reinterpret_cast<const char*>(&which), sizeof which})) return false;
  case_ = which;
  given_at_ = std::chrono::steady_clock::now();
  told_.clear();
  return true;
}

std::optional<WorkerAnswer> Worker::answer() {
  char buffer[4096];
  for (;;) {
    const ssize_t count = ::read(from_, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count == 0) has_ended_ = true;
    if (count <= 0) break;
    told_.append(buffer, static_cast<std::size_t>(count));
  }
  const std::size_t head_end = told_.find('\n');
  if (!case_ || head_end == std::string::npos) return std::nullopt;
  std::vector<double> head;
  for (std::size_t begin = 0; begin < head_end;) {
    const std::size_t end = std::min(told_.find(' ', begin), head_end);
    head.push_back(0.0);
    if (!io::read_number(std::string_view(told_).substr(begin, end - begin), head.back())) return std::nullopt;
    begin = end + 1;
  }
  if (head.size() != 4 || told_.size() < head_end + 1 + static_cast<std::size_t>(head[3])) return std::nullopt;
  case_.reset();
  return WorkerAnswer{static_cast<int>(head[0]), head[1], head[2], told_.substr(head_end + 1)};
}

int Worker::reap() {
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  return status;
}

void Worker::ask_to_stop() {
  asked_ = true;
  ::kill(process_, SIGTERM);
}

void Worker::kill() {
  killed_ = true;
  ::kill(process_, SIGKILL);
}

void Worker::kill_above(double bytes) {
  std::ifstream file("/proc/" + std::to_string(process_) + "/statm");
  double size = 0.0, resident = 0.0;  // in pages
  if (!(file >> size >> resident)) return;
  resident *= static_cast<double>(::sysconf(_SC_PAGESIZE));
  if (resident <= bytes) return;
  resident_ = resident;
  kill();
}

void Worker::end() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);  // it is idle, or its result is no longer wanted
    (void)reap();
  }
  for (int* end : {&to_, &from_}) {
    if (*end >= 0) ::close(*end);
    *end = -1;
  }
}

}  // namespace bough::study
