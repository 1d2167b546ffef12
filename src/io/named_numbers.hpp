#pragma once
/// Names that stand for numbers in the texts of a scene, and what they make of its strings and formulas.
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "bough/io/json_value.hpp"

namespace bough::io {

/// What is wrong with a text that holds names.
struct NamedFault {
  std::string rule, hint;
  std::string unknown = {};  ///< a name that no number has
  bool was_told = false;     ///< it names a parameter whose own fault is reported
};

class NamedNumbers {
 public:
  void set(const std::string& name, double value) { values_[name] = value; }
  void set_defective(const std::string& name) { defective_.insert(name); }
  /// For the index of copies: taken away when their scope ends.
  void remove(const std::string& name) { values_.erase(name); }
  bool holds(const std::string& name) const { return values_.count(name) > 0 || defective_.count(name) > 0; }
  /// Empty where a number may have this name, else the rule that it breaks.
  static std::string fault_of_name(const std::string& name);

  /// The formula with numbers, in parentheses, for all names but t, pi, e and functions; braces are parentheses, so
  /// that {i} reads as in other strings.
  /// own: names that are left as they are.
  std::optional<NamedFault> put_into_formula(std::string& formula, const JsonValue* own = nullptr);
  /// The text with whole numbers for all formulas in braces; {{ and }} are single braces. A number is whole to 1e-9.
  std::optional<NamedFault> put_into_text(std::string& text);

  /// Names that some text used.
  bool is_used(const std::string& name) const { return used_.count(name) > 0; }
  /// What may have been meant by a name that no number has; empty after the first hundreds, which nobody reads.
  std::string hint_for(const std::string& name);

 private:
  std::unordered_map<std::string, double> values_;
  std::unordered_set<std::string> defective_, used_;
  std::size_t num_hints_ = 0;
};

}  // namespace bough::io
