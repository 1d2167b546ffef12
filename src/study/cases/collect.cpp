#include "bough/study/collect.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <unordered_map>

#include "bough/io/csv_table.hpp"
#include "bough/io/digest.hpp"
#include "bough/io/history.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/json_value.hpp"
#include "bough/io/number_text.hpp"
#include "case_report.hpp"

namespace bough::study {
namespace {

namespace fs = std::filesystem;

constexpr const char* format_name = "bough shard 1";

io::CsvTable table_of_file(const fs::path& file, const std::string& text) {
  io::CsvTable table;
  const std::string rule = table.read(text);
  if (!rule.empty()) throw std::runtime_error(file.string() + ": " + rule);
  if (table.columns.front() != "case") throw std::runtime_error(file.string() + ": the first column is not \"case\"");
  return table;
}

/// The texts that identify a shard, with their names in the file.
std::vector<std::pair<const char*, std::string ShardRecord::*>> texts_of_record() {
  return {{"verb", &ShardRecord::verb},
          {"title", &ShardRecord::title},
          {"source", &ShardRecord::source},
          {"cases", &ShardRecord::cases},
          {"content", &ShardRecord::content}};
}

ShardRecord read_record(const fs::path& file) {
  std::vector<io::JsonFault> faults;
  const std::string text = io::read_text(file, io::max_file_bytes);
  const std::optional<io::JsonValue> root = io::parse_json(text, io::source_file, faults);
  const auto fail = [&]() -> ShardRecord { throw std::runtime_error(file.string() + " was not written by bough"); };
  if (!root || !faults.empty() || !root->is(io::JsonKind::object)) return fail();
  const auto text_at = [&](const io::JsonValue& object, const char* name) {
    const io::JsonValue* value = object.find(name);
    return value != nullptr && value->is(io::JsonKind::string) ? value->text.str() : std::string();
  };
  if (text_at(*root, "format") != format_name) return fail();
  ShardRecord record;
  for (const auto& [name, member] : texts_of_record()) record.*member = text_at(*root, name);
  const io::JsonValue* number = root->find("number");
  const io::JsonValue* count = root->find("count");
  if (number == nullptr || count == nullptr || !(number->number >= 1.0 && number->number <= count->number) ||
      !(count->number <= 1e6))
    return fail();
  record.shard = {static_cast<std::size_t>(number->number), static_cast<std::size_t>(count->number),
                  text_at(*root, "origin")};
  record.machine = {text_at(*root, "program"), text_at(*root, "instruction_set"), text_at(*root, "library")};
  return record;
}

/// Folders that hold a shard.
std::vector<fs::path> shard_folders(const std::vector<fs::path>& folders) {
  std::vector<fs::path> found;
  for (const fs::path& folder : folders) {
    std::error_code error;
    if (fs::exists(folder / shard_file, error)) {
      found.push_back(folder);
      continue;
    }
    const std::size_t before = found.size();
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      std::error_code ignored;
      if (fs::exists(it->path() / shard_file, ignored)) found.push_back(it->path());
    }
    if (error) throw std::runtime_error("cannot read the folder " + folder.string() + ": " + error.message());
    if (found.size() == before) throw std::runtime_error("no shard in " + folder.string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// The list of all cases, from the parent folder of a shard or from a folder that was named.
std::string case_list(const std::vector<fs::path>& shards, const std::vector<fs::path>& named,
                      const ShardRecord& record) {
  std::vector<fs::path> places = named;
  for (const fs::path& shard : shards) places.push_back(fs::absolute(shard).lexically_normal() / "..");
  for (const fs::path& place : places) {
    std::error_code ignored;
    const fs::path file = place / cases_file;
    if (!fs::exists(file, ignored)) continue;
    std::string text = io::read_text(file);
    if (io::digest_of(text) == record.cases) return text;
  }
  throw std::runtime_error(
      std::string("the list of all cases, ") + cases_file +
      ", is not there: it lies in the folder that the shards were written into; copy it beside them");
}

void require_same(const fs::path& first, const ShardRecord& a, const fs::path& other, const ShardRecord& b) {
  std::string what;
  for (const auto& [is_same, name] : {std::pair{a.verb == b.verb && a.cases == b.cases, "another list of cases"},
                                      std::pair{a.content == b.content, "another scene, or other options"},
                                      std::pair{a.machine.program == b.machine.program, "another build of bough"}})
    if (!is_same) what += (what.empty() ? "" : ", ") + std::string(name);
  if (!what.empty())
    throw std::runtime_error(other.string() + " is not of one batch with " + first.string() + ": " + what);
}

/// The content of a row except costs and paths.
std::string content_of(const CaseResult& result) {
  CaseReport report = result.report;
  report.directory.clear();
  report.stored.reset();
  return std::string(text_of(result.status)) + '\n' + text_of(report);
}

}  // namespace

std::string shard_text(const ShardRecord& record) {
  io::JsonText json;
  json.begin_object();
  json.member("format", std::string_view(format_name));
  for (const auto& [name, member] : texts_of_record()) json.member(name, std::string_view(record.*member));
  json.member("number", static_cast<long long>(record.shard.number));
  json.member("count", static_cast<long long>(record.shard.count));
  json.member("origin", std::string_view(record.shard.origin));
  json.member("program", std::string_view(record.machine.program));
  json.member("instruction_set", std::string_view(record.machine.instruction_set));
  json.member("library", std::string_view(record.machine.library));
  json.end_object();
  return json.text();
}

std::string keys_csv(const CaseList& cases, const std::vector<std::string>& keys) {
  std::string text = "case,key\n";
  for (std::size_t i = 0; i < cases.size(); ++i) text += io::csv_field(cases.at(i).name) + ',' + keys[i] + '\n';
  return text;
}

std::string cases_csv(const SweepCases& cases) {
  std::string text = "case";
  for (const std::string& name : cases.variables()) text += ',' + io::csv_field(name);
  text += '\n';
  for (std::size_t i = 0; i < cases.size(); ++i) {
    text += io::csv_field(cases.name(i));
    for (const io::SweepValue& v : cases.inputs(i)) text += ',' + io::csv_field(v.text);
    text += '\n';
  }
  return text;
}

std::string adopt_cases(const std::string& text, SweepCases& cases) {
  constexpr double last_digits = 1e-9;  // relative, of values drawn with 12 digits
  io::CsvTable table;
  if (std::string rule = table.read(text); !rule.empty()) return rule;
  const std::vector<std::string>& variables = cases.variables();
  if (table.columns.size() != variables.size() + 1 || table.rows.size() != cases.size())
    return "it has " + std::to_string(table.rows.size()) + " cases of " + std::to_string(table.columns.size() - 1) +
           " variables, and there are " + std::to_string(cases.size()) + " of " + std::to_string(variables.size());
  for (std::size_t k = 0; k < variables.size(); ++k)
    if (table.columns[k + 1] != variables[k])
      return "it has the variable " + table.columns[k + 1] + " in the place of " + variables[k];
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const SweepCase c = cases.at(i);
    if (table.rows[i][0] != c.name) return "it has case " + table.rows[i][0] + " in the place of " + c.name;
    for (std::size_t k = 0; k < c.inputs.size(); ++k) {
      const std::string& given = table.rows[i][k + 1];
      const io::SweepValue& value = c.inputs[k];
      double x = 0.0;
      if (given == value.text) continue;
      if (!value.number || !io::read_number(given, x) ||
          !(std::abs(x - *value.number) <= last_digits * std::abs(*value.number)))
        return "case " + c.name + " has " + variables[k] + " = " + given + " there and " + value.text + " here";
      cases.set(i, k, {given, x});
    }
  }
  return "";
}

Collected collect_shards(const std::vector<fs::path>& folders) {
  const std::vector<fs::path> shards = shard_folders(folders);
  Collected all;
  all.num_shards = shards.size();
  all.record = read_record(shards.front() / shard_file);
  all.list = case_list(shards, folders, all.record);
  const auto cases = std::make_shared<const io::CsvTable>(table_of_file(cases_file, all.list));
  std::unordered_map<std::string_view, std::size_t> place_of;
  for (std::size_t i = 0; i < cases->rows.size(); ++i) place_of.emplace(cases->rows[i][0], i);
  all.results = CaseTable(CaseList(cases->rows.size(), [cases](std::size_t i) {
    BatchCase one;
    one.name = cases->rows[i][0];
    for (std::size_t k = 1; k < cases->rows[i].size(); ++k)
      one.inputs.emplace_back(cases->columns[k], cases->rows[i][k]);
    return one;
  }));
  all.machine_of.assign(all.results.size(), 0);
  for (const fs::path& folder : shards) {
    const ShardRecord record = read_record(folder / shard_file);
    require_same(shards.front(), all.record, folder, record);
    const std::string machine = record.machine.instruction_set + " " + record.machine.library;
    auto at = std::find(all.machines.begin(), all.machines.end(), machine);
    if (at == all.machines.end()) at = all.machines.insert(at, machine);
    const auto number = static_cast<std::size_t>(at - all.machines.begin());
    const Records records = read_records(folder / journal_file);
    const io::CsvTable keys = table_of_file(folder / keys_file, io::read_text(folder / keys_file));
    if (keys.columns.size() != 2) throw std::runtime_error((folder / keys_file).string() + " has not two columns");
    for (const std::vector<std::string>& row : keys.rows) {
      const auto place = place_of.find(row[0]);
      const std::optional<CaseResult> found = records.find(row[1]);
      if (place == place_of.end())
        throw std::runtime_error(folder.string() + ": no case of the list is called " + row[0]);
      if (!found) continue;
      const std::size_t i = place->second;
      if (all.results.has(i) && all.machine_of[i] == number && content_of(all.results[i]) != content_of(*found))
        throw std::runtime_error("case " + row[0] + " is in two shards, one of them " + folder.string() +
                                 ", with rows that differ");
      if (all.results.has(i)) continue;
      all.machine_of[i] = number;
      all.results.set(i, *found);
    }
  }
  for (std::size_t i = 0; i < all.results.size(); ++i)
    if (!all.results.has(i)) all.missing.push_back(cases->rows[i][0]);
  if (all.machines.size() == 1) all.machines.clear();
  return all;
}

}  // namespace bough::study
