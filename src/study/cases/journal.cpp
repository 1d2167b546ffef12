#include "bough/study/journal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "bough/io/atomic_file.hpp"
#include "bough/io/digest.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/json_value.hpp"
#include "bough/io/program_hash.hpp"
#include "bough/lanes/instruction_set.hpp"
#include "case_report.hpp"

namespace bough::study {
namespace {

constexpr std::array statuses{CaseStatus::ok,          CaseStatus::figures_fail, CaseStatus::failed,
                              CaseStatus::interrupted, CaseStatus::bad_input,    CaseStatus::crashed,
                              CaseStatus::timed_out};

/// Bits of functions whose last digit differs between mathematical libraries.
std::string library_bits() {
  io::Digest digest;
  for (int k = 1; k <= 200; ++k) {
    const double x = 0.37 * k;
    for (const double y : {std::sin(x), std::cos(x), std::tan(x), std::exp(-x), std::log(x), std::pow(x, 0.3),
                           std::atan(x), std::erfc(0.1 * x)}) {
      std::array<char, sizeof(double)> bytes{};
      std::memcpy(bytes.data(), &y, sizeof y);
      digest.add({bytes.data(), bytes.size()});
    }
  }
  return digest.text();
}

/// JSON on one line. Line ends occur only between values, since strings escape theirs.
std::string joined_lines(const std::string& json) {
  std::string line;
  for (std::size_t i = 0; i < json.size(); ++i) {
    if (json[i] != '\n') {
      line += json[i];
      continue;
    }
    while (i + 1 < json.size() && json[i + 1] == ' ') ++i;
  }
  return line;
}

std::string record_of(const std::string& key, const CaseResult& r) {
  io::JsonText json;
  json.begin_object();
  json.member("key", std::string_view(key));
  json.member("case", std::string_view(r.which.name));
  json.member("status", text_of(r.status));
  json.member("cause", std::string_view(r.cause));
  json.key("cost");
  json.begin_array();
  for (const double x : {r.cost.wall_seconds, r.cost.cpu_seconds, r.cost.peak_bytes}) json.value(x);
  json.end_array();
  json.member("report", std::string_view(joined_lines(text_of(r.report))));
  json.end_object();
  const std::string line = joined_lines(json.text());
  return io::digest_of(line) + " " + line + "\n";
}

/// False where the line is damaged.
bool read_record(std::string_view line, std::string& key, CaseResult& r) {
  const std::size_t blank = line.find(' ');
  if (blank == std::string_view::npos || io::digest_of(line.substr(blank + 1)) != line.substr(0, blank)) return false;
  std::vector<io::JsonFault> faults;
  const std::optional<io::JsonValue> root = io::parse_json(line.substr(blank + 1), io::source_file, faults);
  if (!root || !faults.empty() || !root->is(io::JsonKind::object)) return false;
  for (const char* name : {"key", "case", "status", "cause", "cost", "report"})
    if (root->find(name) == nullptr) return false;
  const io::JsonValue& cost = *root->find("cost");
  if (cost.items.size() != 3 || !report_of(root->find("report")->text.str(), r.report)) return false;
  key = root->find("key")->text;
  r.which.name = root->find("case")->text;
  r.cause = root->find("cause")->text;
  r.cost = {cost.items[0].number, cost.items[1].number, cost.items[2].number};
  for (const CaseStatus status : statuses)
    if (text_of(status) == root->find("status")->text) r.status = status;
  return true;
}

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
  throw std::runtime_error("cannot write the journal " + file.string() + ": " + std::generic_category().message(error));
}

}  // namespace

const Machine& this_machine() {
  static const Machine machine{io::program_hash(), std::string(lanes::instruction_set().name), library_bits()};
  return machine;
}

std::string key_of(const std::string& scene, std::span<const std::string> overrides) {
  static const std::string machine =
      this_machine().program + " " + this_machine().instruction_set + " " + this_machine().library;
  io::Digest digest;
  digest.add(machine);
  digest.add(scene);
  for (const std::string& o : overrides) {
    digest.add(std::string_view("\0", 1));
    digest.add(o);
  }
  return digest.text();
}

bool is_final(const CaseResult& result) {
  const CaseStatus status = result.status;
  if (result.report.is_unwritten) return false;
  return status == CaseStatus::ok || status == CaseStatus::figures_fail || status == CaseStatus::failed ||
         status == CaseStatus::bad_input || status == CaseStatus::crashed;
}

void for_each_record(
    const std::filesystem::path& file,
    const std::function<void(const std::string& key, const CaseResult& result, std::string_view line)>& call) {
  if (std::error_code ignored; !std::filesystem::exists(file, ignored)) return;
  io::InputFile in(file);
  for (std::string line; in.next_line(line) && in.ends_with_line_end();) {
    std::string key;
    CaseResult result;
    if (!read_record(line, key, result)) continue;
    line += '\n';
    call(key, result, line);
  }
}

void Records::add(const std::string& key, const CaseResult& result) {
  const auto [at, is_new] = row_of_.try_emplace(key, rows_.size());
  if (is_new)
    rows_.add(result);
  else
    rows_.set(at->second, result);
}

std::optional<CaseResult> Records::find(const std::string& key) const {
  const auto at = row_of_.find(key);
  return at == row_of_.end() ? std::nullopt : std::optional(rows_.at(at->second));
}

Records read_records(const std::filesystem::path& file) {
  Records records;
  for_each_record(file, [&records](const std::string& key, const CaseResult& result, std::string_view) {
    records.add(key, result);
  });
  return records;
}

Journal::Journal(std::filesystem::path file, bool resumes) : file_(std::move(file)) {
  io::AtomicFile kept(file_);
  if (resumes)
    for_each_record(file_, [&](const std::string& key, const CaseResult& result, std::string_view line) {
      records_.add(key, result);
      kept.write(line);
    });
  kept.commit();  // complete records, durable before any is added
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor_ < 0) fail(file_, errno);
}

Journal::~Journal() {
  if (descriptor_ < 0) return;
  (void)::fdatasync(descriptor_);
  ::close(descriptor_);
}

void Journal::add(const std::string& key, const CaseResult& result) {
  const std::string record = record_of(key, result);
  for (std::string_view left = record; !left.empty();) {
    const ssize_t count = ::write(descriptor_, left.data(), left.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(file_, errno);
    left.remove_prefix(static_cast<std::size_t>(count));
  }
  const auto now = std::chrono::steady_clock::now();
  if (now - synced_at_ < std::chrono::milliseconds(200)) return;
  if (::fdatasync(descriptor_) != 0) fail(file_, errno);
  synced_at_ = std::chrono::steady_clock::now();
}

}  // namespace bough::study
