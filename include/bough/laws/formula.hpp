#pragma once
/// Functions for files in which formulas stand for numbers: the names in a formula, and its value if it is constant.

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bough/laws/law.hpp"

namespace bough::laws {

/// Names with a meaning in every formula: t, pi, e and the functions of make_expression.
const std::vector<std::string>& formula_words();

/// Position and length of a name in a formula [bytes].
struct NamePlace {
  std::size_t position = 0, length = 0;
};

/// All names in a formula, known or not, in the order of the text. A number ends where the parser ends it: 1e3 contains
/// no name, 2ex contains "ex". Never fails, whatever the text is.
std::vector<NamePlace> names_in(std::string_view formula);

/// True for a letter or _, then letters, digits and _.
bool is_formula_name(std::string_view text);

/// A formula in named variables, whose values are given when it is evaluated. An immutable value; copies share data.
class Formula {
 public:
  /// The number 0.
  Formula();
  /// Throws LawError where make_expression does, and where the formula contains t. None of the names may be among
  /// formula_words().
  Formula(const std::string& text, std::span<const std::string> names);
  /// The values are in the order of the names. The result may be infinite or NaN. Does not allocate.
  double operator()(std::span<const double> values) const;
  /// The same, with its derivative by each variable. Where a branch changes, a derivative is that of the side on which
  /// its variable grows.
  double operator()(std::span<const double> values, std::span<double> slopes) const;
  /// Value, rate and acceleration in time, from those of the variables.
  LawValue along(std::span<const LawValue> values) const;

  /// Unit of the value, from those of the variables in the order of their names (empty: a pure number). Empty if the
  /// value is a pure number, or if its unit does not follow: sides of sums, min and max have one unit, which numbers
  /// in them take; numbers in products with a unit may have one of their own, so that 2*x has none that is known.
  [[nodiscard]] std::string unit(std::span<const std::string> units) const;
  /// The same where the units of some variables are not known (nothing), which are then taken as those of numbers are;
  /// nothing if the unit does not follow.
  [[nodiscard]] std::optional<std::string> unit_if_known(std::span<const std::optional<std::string>> units) const;
  /// Whether the value, where it is finite, is 0 or 1 whatever the variables are: made of `step`, products, min, max,
  /// and 1 minus such.
  [[nodiscard]] bool is_zero_or_one() const;

 private:
  std::shared_ptr<const struct Program> program_;
};

/// The value of a formula without t; it may be infinite or NaN. Throws LawError where make_expression does, and where
/// the formula contains t.
double eval_constant(const std::string& formula);

}  // namespace bough::laws
