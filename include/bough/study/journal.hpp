#pragma once
/// What a batch has done so far, in a file that survives kills and power failures.
#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "bough/study/batch.hpp"

namespace bough::study {

/// What results depend on besides the scene.
struct Machine {
  std::string program;          ///< hash of its build IDs (io::program_hash)
  std::string instruction_set;  ///< that the library was compiled for
  std::string library;          ///< hash of the bits of functions of the mathematical library
};
const Machine& this_machine();

/// What a case is: a hash of its scene, of what is still to be changed there, and of the machine. Equal keys give equal
/// results.
std::string key_of(const std::string& scene, std::span<const std::string> overrides = {});

/// Whether a case that ended so is done for good: it would end so again. Cases that were stopped, by a user or by a
/// limit of time, are not, nor are those whose results could not be written.
bool is_final(const CaseResult& result);

using Records = std::unordered_map<std::string, CaseResult>;  ///< by key

/// The whole records of a journal that this process does not write: none where there is no file. whole: their text.
Records read_records(const std::filesystem::path& file, std::string& whole);

/// One line a case: a hash, a blank, the record as JSON. A record counts when its line is whole and its hash fits, so
/// that what a kill or a full disk cut off is as if it had not been written. Children that are forked hold the file,
/// too, and so the folder is free only when the last worker of a batch that was killed has ended.
class Journal {
 public:
  /// resumes: takes over the records that are there, and drops what is damaged; else starts empty. Throws
  /// std::runtime_error where the file cannot be written, io::OutputRefused where another process has it open.
  Journal(std::filesystem::path file, bool resumes);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The result of a case of this key, with `which` as it is asked for; nothing where there is none.
  const CaseResult* find(const std::string& key) const;
  std::size_t size() const { return records_.size(); }

  /// Returns when the system has the record, so that no kill loses it; it is on the disk within a fifth of a second,
  /// for waiting for the disk after every case would be most of the time of small ones. What a power failure takes
  /// runs again. Throws std::runtime_error where it cannot be written.
  void add(const std::string& key, const CaseResult& result);

 private:
  std::filesystem::path file_;
  Records records_;
  int descriptor_ = -1;
  std::chrono::steady_clock::time_point synced_at_{};
};

}  // namespace bough::study
