#include "bough/study/case_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace bough::study {
namespace {

/// Appends a text with its length, so that several are one.
void pack(std::string& packed, std::string_view text) {
  packed += std::to_string(text.size());
  packed += ':';
  packed += text;
}

/// Takes the next text from the front.
std::string unpack(std::string_view& packed) {
  std::size_t size = 0;
  const auto [end, status] = std::from_chars(packed.data(), packed.data() + packed.size(), size);
  packed.remove_prefix(static_cast<std::size_t>(end - packed.data()) + 1);
  std::string text(packed.substr(0, size));
  packed.remove_prefix(size);
  return text;
}

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::optional<double> optional_of(double x) { return std::isnan(x) ? std::nullopt : std::optional<double>(x); }

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

CaseList::CaseList(std::vector<BatchCase> cases) : size_(cases.size()) {
  const auto shared = std::make_shared<const std::vector<BatchCase>>(std::move(cases));
  make_ = [shared](std::size_t i) { return (*shared)[i]; };
}

CaseList chosen(const CaseList& cases, std::vector<std::size_t> indices) {
  const std::size_t size = indices.size();
  const auto shared = std::make_shared<const std::vector<std::size_t>>(std::move(indices));
  return {size, [cases, shared](std::size_t i) { return cases.at((*shared)[i]); }};
}

const PackedResults::Shape* PackedResults::shape_of(const CaseReport& report) {
  std::string key;
  for (const records::MeasureResult& m : report.measures) pack(key, m.name);
  key += '/';
  for (const std::string& unit : report.units) pack(key, unit);
  for (const std::size_t k : report.indicators) key += ' ' + std::to_string(k);
  const auto [at, is_new] = shapes_.try_emplace(std::move(key));
  Shape& shape = at->second;
  if (is_new) {
    for (const records::MeasureResult& m : report.measures) shape.names.push_back(m.name);
    shape.units = report.units;
    shape.indicators = report.indicators;
  }
  return &shape;
}

void PackedResults::set(std::size_t i, const CaseResult& result) {
  const CaseReport& report = result.report;
  std::string texts;
  for (const std::string& text : {result.cause, report.cause, report.failing, report.directory.string(),
                                  report.stored ? report.stored->store : std::string()})
    pack(texts, text);
  for (const std::string& doubt : report.doubts) pack(texts, doubt);
  Row& row = rows_[i];
  row.texts = &*texts_.insert(std::move(texts)).first;
  row.shape = shape_of(report);
  row.cost = result.cost;
  row.energy_error = report.energy_error.value_or(none);
  row.constraint_error = report.constraint_error.value_or(none);
  row.accepted = report.accepted;
  row.rejected = report.rejected;
  row.newton_iterations = report.newton_iterations;
  row.expected_holds = report.expected_holds;
  row.expected_fails = report.expected_fails;
  row.stored_offset = report.stored ? report.stored->offset : 0;
  row.status = result.status;
  row.was_interrupted = report.was_interrupted;
  row.is_unwritten = report.is_unwritten;
  row.first_value = num_values_;
  for (const records::MeasureResult& m : report.measures) {
    if (num_values_ == blocks_.size() * block_size) blocks_.push_back(std::make_unique<double[]>(block_size));
    blocks_.back()[num_values_++ % block_size] = m.value.value_or(none);
  }
}

void PackedResults::add(const CaseResult& result) {
  rows_.emplace_back();
  set(rows_.size() - 1, result);
}

CaseResult PackedResults::at(std::size_t i) const {
  const Row& row = rows_[i];
  CaseResult result;
  CaseReport& report = result.report;
  std::string_view texts = *row.texts;
  result.cause = unpack(texts);
  report.cause = unpack(texts);
  report.failing = unpack(texts);
  report.directory = unpack(texts);
  if (std::string store = unpack(texts); !store.empty())
    report.stored = io::StoredPlace{std::move(store), row.stored_offset};
  while (!texts.empty()) report.doubts.push_back(unpack(texts));
  result.status = row.status;
  result.cost = row.cost;
  report.energy_error = optional_of(row.energy_error);
  report.constraint_error = optional_of(row.constraint_error);
  report.accepted = row.accepted;
  report.rejected = row.rejected;
  report.newton_iterations = row.newton_iterations;
  report.expected_holds = row.expected_holds;
  report.expected_fails = row.expected_fails;
  report.was_interrupted = row.was_interrupted;
  report.is_unwritten = row.is_unwritten;
  for (std::size_t k = 0; k < row.shape->names.size(); ++k)
    report.measures.push_back({row.shape->names[k], optional_of(value(i, k))});
  report.units = row.shape->units;
  report.indicators = row.shape->indicators;
  return result;
}

CaseTable::CaseTable(const std::vector<CaseResult>& results) {
  std::vector<BatchCase> cases;
  for (const CaseResult& r : results) cases.push_back(r.which);
  *this = CaseTable(CaseList(std::move(cases)));
  for (std::size_t i = 0; i < results.size(); ++i) set(i, results[i]);
}

CaseResult CaseTable::at(std::size_t i) const {
  CaseResult result;
  if (has(i)) {
    result = results_.at(i);
  } else {
    result.status = CaseStatus::interrupted;
    result.cause = "not started";
  }
  result.which = cases_.at(i);
  return result;
}

std::vector<CaseTable::Measure> CaseTable::measures() const {
  std::vector<Measure> measures;
  std::unordered_map<std::string, std::size_t> place_of;
  std::unordered_set<const PackedResults::Shape*> met;
  for (std::size_t i = 0; i < size(); ++i) {
    if (!has(i) || !met.insert(&results_.shape(i)).second) continue;
    const PackedResults::Shape& shape = results_.shape(i);
    for (std::size_t k = 0; k < shape.names.size(); ++k) {
      const bool is_indicator = std::binary_search(shape.indicators.begin(), shape.indicators.end(), k);
      const auto [at, is_new] = place_of.try_emplace(shape.names[k], measures.size());
      if (is_new) measures.push_back({shape.names[k], {}, is_indicator});
      Measure& measure = measures[at->second];
      if (measure.unit.empty() && k < shape.units.size()) measure.unit = shape.units[k];
      measure.is_indicator = measure.is_indicator && is_indicator;
    }
  }
  return measures;
}

std::vector<std::optional<double>> CaseTable::values_of(const std::string& measure) const {
  std::vector<std::optional<double>> values(size());
  std::unordered_map<const PackedResults::Shape*, std::size_t> place_in;
  for (std::size_t i = 0; i < size(); ++i) {
    if (!has(i)) continue;
    const PackedResults::Shape& shape = results_.shape(i);
    const auto [at, is_new] = place_in.try_emplace(&shape, 0);
    if (is_new)
      at->second =
          static_cast<std::size_t>(std::find(shape.names.begin(), shape.names.end(), measure) - shape.names.begin());
    if (at->second < shape.names.size()) values[i] = optional_of(results_.value(i, at->second));
  }
  return values;
}

}  // namespace bough::study
