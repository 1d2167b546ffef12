#pragma once
/// A record of the finished cases of a batch, in a file that survives kills and power failures.
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "bough/study/case_table.hpp"

namespace bough::study {

/// Everything besides the scene on which results depend.
struct Machine {
  std::string program;          ///< hash of its build IDs (io::program_hash)
  std::string instruction_set;  ///< that the library was compiled for
  std::string library;          ///< hash of the bits of functions of the mathematical library
};
const Machine& this_machine();

/// Identity of a case: a hash of its scene, of the overrides to be applied to it, and of the machine. Equal keys give
/// equal results.
std::string key_of(const std::string& scene, std::span<const std::string> overrides = {});

/// Whether a result is final, because the case would end in the same way again. Cases that were stopped by the user or
/// by a time limit are not final, nor are those whose results could not be written.
bool is_final(const CaseResult& result);

/// Calls with each complete record of a journal in turn, with its key and line; with none if there is no file. Of the
/// case its name is set.
void for_each_record(
    const std::filesystem::path& file,
    const std::function<void(const std::string& key, const CaseResult& result, std::string_view line)>& call);

/// Results by key, in little memory.
class Records {
 public:
  /// Replaces one with the same key.
  void add(const std::string& key, const CaseResult& result);
  /// Nothing if there is none; all but `which` is set.
  [[nodiscard]] std::optional<CaseResult> find(const std::string& key) const;
  [[nodiscard]] std::size_t size() const { return row_of_.size(); }

 private:
  std::unordered_map<std::string, std::size_t> row_of_;
  PackedResults rows_;
};

/// All complete records of a journal.
Records read_records(const std::filesystem::path& file);

/// The file has one line per case: a hash, a blank, and the record as JSON. A record counts only if its line is
/// complete and its hash matches, so a line cut off by a kill or a full disk is ignored. Its writer holds the lock of the
/// folder (io::Writers::one).
class Journal {
 public:
  /// resumes: keeps the existing records and drops damaged ones; otherwise the journal starts empty. Throws
  /// std::runtime_error where the file cannot be written.
  Journal(std::filesystem::path file, bool resumes);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The records that were there; they may be dropped once they are taken over.
  [[nodiscard]] const Records& records() const { return records_; }
  void forget_records() { records_ = {}; }

  /// Returns when the operating system has the record, so that no kill can lose it. It is on the disk within a fifth of
  /// a second: waiting for the disk after every case would dominate the time of small cases. Cases lost in a power
  /// failure run again. Throws std::runtime_error where the record cannot be written.
  void add(const std::string& key, const CaseResult& result);

 private:
  std::filesystem::path file_;
  Records records_;
  int descriptor_ = -1;
  std::chrono::steady_clock::time_point synced_at_{};
};

}  // namespace bough::study
