#pragma once
/// Cases of a batch and their results, in memory that a million of them do not exceed: cases are made when they are
/// asked for, and results are kept in about a hundred bytes and eight for each measure.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "bough/io/run_store.hpp"
#include "bough/records/run.hpp"
#include "bough/scene/scene.hpp"

namespace bough::study {

struct BatchCase {
  std::string name;
  std::filesystem::path scene, directory;  ///< directory: of the case's results
  std::vector<std::string> overrides = {};
  std::vector<std::pair<std::string, std::string>> inputs = {};  ///< the varied inputs and their values as JSON, for
                                                                 ///< tables
  int threads = 1;       ///< number of threads that the case asks for; it gets no more than there are
  std::string key = {};  ///< its identity (key_of); empty: not known yet
  /// Of the folder of its results.
  [[nodiscard]] io::Owner owner() const { return {"run", scene, key}; }
};

/// figures_fail: the run is complete, and an expected figure of its scene does not hold.
enum class CaseStatus : std::uint8_t { ok, figures_fail, failed, interrupted, bad_input, crashed, timed_out };

std::string_view text_of(CaseStatus status);

/// Report of a case at its end. It is passed from the process of the case to the process that collects results.
/// Ending of the names of columns that hold the errors of measures, where twins measure them; no name of a measure has a
/// dot.
inline constexpr std::string_view error_ending = ".error";

struct CaseReport {
  std::string cause;                ///< what to report
  std::filesystem::path directory;  ///< directory of its results; empty: it left none, or they are stored
  std::optional<io::StoredPlace> stored;
  bool was_interrupted = false;
  bool is_unwritten = false;  ///< its results could not be written; the case may succeed when there is space
  long accepted = 0, rejected = 0, newton_iterations = 0;
  int expected_holds = 0, expected_fails = 0;
  std::string failing;              ///< the first expected figures that do not hold, in words
  std::vector<std::string> doubts;  ///< subjects of the doubts
  std::vector<records::MeasureResult> measures;
  std::vector<std::string> units;       ///< of the measures, in their order; empty text: a pure number, or not known
  std::vector<std::size_t> indicators;  ///< measures that are 1 where something happens and 0 elsewhere, ascending
  std::optional<double> energy_error,
      constraint_error;  ///< largest energy error over the largest energy; largest violation over the size of the parts
  /// Copies counts, figures and measures from the summary of a run.
  void take(const records::Summary& summary, const scene::Scene& scene);
};

/// Measured times and memory of a case. They differ from run to run.
struct CaseCost {
  double wall_seconds = 0.0, cpu_seconds = 0.0;
  double peak_bytes = 0.0;
};

struct CaseResult {
  BatchCase which;
  CaseStatus status = CaseStatus::failed;
  std::string cause;  ///< in one line; empty where ok
  CaseReport report;
  CaseCost cost;
};

/// The cases of a batch. A copy shares what they are made from.
class CaseList {
 public:
  CaseList() = default;
  CaseList(std::vector<BatchCase> cases);
  /// make: the case with an index below `size`, whenever it is asked for.
  CaseList(std::size_t size, std::function<BatchCase(std::size_t)> make) : size_(size), make_(std::move(make)) {}
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] BatchCase at(std::size_t i) const { return make_(i); }

 private:
  std::size_t size_ = 0;
  std::function<BatchCase(std::size_t)> make_;
};

/// The cases with these indices.
CaseList chosen(const CaseList& cases, std::vector<std::size_t> indices);

/// Results by index, without the cases that they belong to. Texts, names and units that occur again are kept once.
class PackedResults {
 public:
  explicit PackedResults(std::size_t size = 0) : rows_(size) {}
  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] bool has(std::size_t i) const { return rows_[i].texts != nullptr; }
  void set(std::size_t i, const CaseResult& result);
  void add(const CaseResult& result);
  /// The result with its bits; all but `which` is set. Precondition: has(i).
  [[nodiscard]] CaseResult at(std::size_t i) const;
  [[nodiscard]] CaseStatus status(std::size_t i) const { return rows_[i].status; }

  /// The measures of one or more results.
  struct Shape {
    std::vector<std::string> names, units;
    std::vector<std::size_t> indicators;
  };
  [[nodiscard]] const Shape& shape(std::size_t i) const { return *rows_[i].shape; }
  /// Of the k-th measure of its shape; NaN: none.
  [[nodiscard]] double value(std::size_t i, std::size_t k) const { return number(rows_[i].first_value + k); }

 private:
  struct Row {
    CaseCost cost;
    double energy_error = 0.0, constraint_error = 0.0;  ///< NaN: none
    std::int64_t accepted = 0, rejected = 0, newton_iterations = 0;
    std::int32_t expected_holds = 0, expected_fails = 0;
    const std::string* texts = nullptr;  ///< cause, report's cause, failing figures, directory, store, doubts
    const Shape* shape = nullptr;
    std::uint64_t stored_offset = 0, first_value = 0;
    CaseStatus status = CaseStatus::failed;
    bool was_interrupted = false, is_unwritten = false;
  };
  static constexpr std::size_t block_size = std::size_t{1} << 15u;
  double number(std::size_t at) const { return blocks_[at / block_size][at % block_size]; }
  const Shape* shape_of(const CaseReport& report);

  std::vector<Row> rows_;
  std::unordered_set<std::string> texts_;
  std::unordered_map<std::string, Shape> shapes_;
  std::vector<std::unique_ptr<double[]>> blocks_;  ///< values of all measures; blocks never move
  std::size_t num_values_ = 0;
};

/// All cases of a batch, with the results that are there so far. Elements are values, made when they are read.
class CaseTable {
 public:
  CaseTable() = default;
  explicit CaseTable(CaseList cases) : cases_(std::move(cases)), results_(cases_.size()) {}
  CaseTable(const std::vector<CaseResult>& results);
  CaseTable(std::initializer_list<CaseResult> results) : CaseTable(std::vector<CaseResult>(results)) {}

  [[nodiscard]] const CaseList& cases() const { return cases_; }
  [[nodiscard]] std::size_t size() const { return cases_.size(); }
  [[nodiscard]] bool has(std::size_t i) const { return results_.has(i); }
  void set(std::size_t i, const CaseResult& result) { results_.set(i, result); }
  /// A case without a result is interrupted, since it was not started.
  [[nodiscard]] CaseResult at(std::size_t i) const;
  [[nodiscard]] CaseResult operator[](std::size_t i) const { return at(i); }
  [[nodiscard]] CaseStatus status(std::size_t i) const { return has(i) ? results_.status(i) : CaseStatus::interrupted; }

  /// A column of measures. An indicator is 1 where something happens and 0 elsewhere, whatever the case.
  struct Measure {
    std::string name, unit;
    bool is_indicator = false;
  };
  /// In the order of their first occurrence among the cases.
  [[nodiscard]] std::vector<Measure> measures() const;
  /// The values of a measure by case.
  [[nodiscard]] std::vector<std::optional<double>> values_of(const std::string& measure) const;

  class Iterator {
   public:
    using value_type = CaseResult;
    using difference_type = std::ptrdiff_t;
    using reference = CaseResult;
    using pointer = void;
    using iterator_category = std::input_iterator_tag;
    Iterator(const CaseTable& table, std::size_t at) : table_(&table), at_(at) {}
    CaseResult operator*() const { return table_->at(at_); }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.at_ == b.at_; }
    friend bool operator!=(const Iterator& a, const Iterator& b) { return a.at_ != b.at_; }

   private:
    const CaseTable* table_;
    std::size_t at_;
  };
  [[nodiscard]] Iterator begin() const { return {*this, 0}; }
  [[nodiscard]] Iterator end() const { return {*this, size()}; }

 private:
  CaseList cases_;
  PackedResults results_;
};

}  // namespace bough::study
