#pragma once
/// Collects the faults of a document from all checks and finds their positions in the text. Used for scenes and for
/// chains of frames.
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "bough/io/json_value.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/schema_rule.hpp"
#include "excerpts.hpp"
#include "expand_scene.hpp"
#include "read_values.hpp"

namespace bough::io {

/// Collects faults with their positions in the texts. Keeps references to the constructor's arguments.
class Report {
 public:
  /// origins: sources of the items of the document that are copies; nullptr: there are no copies.
  Report(std::string_view text, const JsonValue* root, const std::vector<std::string>& overrides,
         const CopyOrigins* origins = nullptr)
      : text_(text), lines_(text), root_(root), overrides_(overrides), origins_(origins) {}

  void add(const JsonFault& f);
  void add(const CheckFault& f);
  void add(const ExpansionFault& f, bool is_warning);
  void add_override(const PlacedFault& f);
  void add(const PlacedFault& f, bool is_warning);
  void add(const PlacedFaults& faults, bool is_warning);

  /// Counts further faults that were not stored.
  void count_others(std::size_t number, bool is_warning = false) {
    (is_warning ? warnings_left_out_ : left_out_) += number;
  }

  bool empty() const { return problems_.empty(); }

  /// Writes all faults in the order of the file, those of overrides last.
  void write(std::vector<Problem>& problems, std::vector<Problem>& warnings);

 private:
  struct Placed {
    Problem problem;
    bool in_file;
    std::size_t offset;
    bool is_expanded = true;  ///< its pointer refers to the document as checked, not to the file
    std::size_t other_copies = 0;
    std::size_t length = 0;  ///< of the value in the file [bytes]; 0: one token
    std::string word = {};   ///< the string at fault as it reads; empty: none
    std::string meant = {};  ///< JSON: what it can only have been meant to be
  };

  Placed& put(std::vector<Placed>& list, Problem p, int source, std::size_t offset);
  bool is_of_another_copy(std::vector<Placed>& list, const Problem& p, int source, std::size_t offset);
  void finish(std::vector<Placed>& list, std::size_t left_out, std::vector<Problem>& out);
  void show_place(Placed& placed);
  void show_second_places(std::vector<Problem>& problems);
  const JsonValue* second_place(const Placed& placed, std::string& about);
  void suggest_fix(Placed& placed);
  const DefinedNames& names();
  std::string_view source_text(int source) const;
  std::string excerpt(int source, std::size_t offset, std::size_t length) const;
  std::string token(int source, std::size_t offset) const;
  std::string summary(const JsonValue& v) const;
  /// Name, as written in the file, of the innermost named object that contains the value at a pointer; empty: none.
  std::string owner(const std::string& pointer) const;
  const JsonValue* member(const JsonValue& object, const std::string& key) const;
  const JsonValue* locate(const std::string& pointer, std::string* reached, std::string* owner = nullptr) const;

  std::string_view text_;
  LineIndex lines_;
  const JsonValue* root_;
  const std::vector<std::string>& overrides_;
  const CopyOrigins* origins_;
  mutable std::unordered_map<const JsonValue*, std::unordered_map<std::string_view, const JsonValue*>> members_;
  std::map<std::string, std::size_t> of_copies_;  ///< index in its list, by list, place and rule
  std::vector<Placed> problems_, warnings_;
  std::optional<DefinedNames> names_;  ///< made where a fault is about a name
  std::size_t names_compared_ = 0;     ///< with misspelt ones
  struct SecondPlace {
    std::size_t problem, offset, length;
  };
  std::vector<SecondPlace> second_places_;
  std::size_t left_out_ = 0, warnings_left_out_ = 0;
};

/// The content of a file ("-": of standard input). If it cannot be read, `problem.rule` says why.
std::string read_whole_file(const std::filesystem::path& file, Problem& problem);

/// Parses a document, checks it by the given rules, and converts it if it is an object. converter: has `convert(root)`,
/// `faults` and `warnings`. Faults are written to the members `problems` and `warnings` of `file`.
template <class File, class Converter>
void read_document(std::string_view text, const RuleTable& rules, Converter& converter, File& file) {
  std::vector<JsonFault> text_faults;
  std::optional<JsonValue> root = parse_json(text, source_file, text_faults);
  std::vector<CheckFault> check_faults;
  const std::size_t more_faults = root ? check_rules(rules, *root, check_faults) : 0;
  const std::vector<std::string> no_overrides;
  Report report(text, root ? &*root : nullptr, no_overrides);
  for (const JsonFault& f : text_faults) report.add(f);
  for (const CheckFault& f : check_faults) report.add(f);
  report.count_others(more_faults);
  if (root && root->is(JsonKind::object)) {
    converter.convert(*root);
    report.add(converter.faults, false);
    report.add(converter.warnings, true);
  }
  report.write(file.problems, file.warnings);
}

/// Result of read_text for the text of a file, or the problem that keeps the file from being read.
template <class File, class ReadText>
File read_document_file(const std::filesystem::path& file, const ReadText& read_text) {
  Problem problem;
  const std::string text = read_whole_file(file, problem);
  if (problem.rule.empty()) return read_text(text);
  File r;
  problem.value = shown(file.string(), 200);
  problem.code = "unreadable";
  r.problems.push_back(std::move(problem));
  return r;
}

}  // namespace bough::io
