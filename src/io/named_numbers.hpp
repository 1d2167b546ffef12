#pragma once
/// Names that stand for numbers in a scene, and their replacement in strings and formulas.
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "bough/io/json_value.hpp"
#include "bough/scene/nearest_name.hpp"

namespace bough::io {

/// A fault in a text with names.
struct NamedFault {
  std::string rule, hint;
  std::string unknown = {};  ///< a name without a number
  bool was_told = false;     ///< a name belongs to a parameter whose own fault was reported
};

class NamedNumbers {
 public:
  void set(const std::string& name, double value) { values_[name] = value; }
  void set_defective(const std::string& name) { defective_.insert(name); }
  /// Removes the index of copies when its scope ends.
  void remove(const std::string& name) { values_.erase(name); }
  bool holds(const std::string& name) const { return values_.count(name) > 0 || defective_.count(name) > 0; }
  /// The rule that a name of a number breaks; empty if it is allowed.
  static std::string fault_of_name(const std::string& name);

  /// Replaces all names but t, pi, e and functions by numbers in parentheses. Braces become parentheses, so that {i}
  /// means the same as in other strings. own: names that are not replaced.
  std::optional<NamedFault> put_into_formula(std::string& formula, const JsonValue* own = nullptr);
  /// The same of a formula of a signal, whose other names are those of signals: they stay. Braces hold formulas for
  /// whole numbers, as in other strings, so that "angle_{i}" is a name.
  std::optional<NamedFault> put_into_signal(std::string& formula);
  /// Replaces all formulas in braces by whole numbers (to 1e-9); {{ and }} become single braces.
  std::optional<NamedFault> put_into_text(std::string& text);

  /// Whether some text used a name.
  bool is_used(const std::string& name) const { return used_.count(name) > 0; }
  /// A hint for an unknown name, such as a similar known one. Empty after the first hundreds of faults, since later
  /// ones are not shown.
  std::string hint_for(const std::string& name);

 private:
  std::optional<NamedFault> put_numbers(std::string& formula, const JsonValue* own, bool keeps_unknown);
  std::unordered_map<std::string, double> values_;
  std::unordered_set<std::string> defective_, used_;
  std::size_t num_hints_ = 0;
  scene::NameSearch search_;
};

}  // namespace bough::io
