#pragma once
/// What files ask of formulas beside the laws that these make: the names in them, and their value where it is a number.

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bough::laws {

/// Names with a meaning in every formula: t, pi, e and the functions of make_expression.
const std::vector<std::string>& formula_words();

/// Where a name stands in a formula [bytes].
struct NamePlace {
  std::size_t position = 0, length = 0;
};

/// All names in a formula, known or not, in the order of the text. Numbers end where the reader of formulas ends them,
/// so 1e3 holds no name and 2ex holds "ex". Does not fail, whatever the text is.
std::vector<NamePlace> names_in(std::string_view formula);

/// True for a letter or _, then letters, digits and _.
bool is_formula_name(std::string_view text);

/// A formula of numbers that are given by name when it is evaluated. An immutable value; copies share data.
class Formula {
 public:
  /// Throws LawError where make_expression does, and at a t. names: none of formula_words().
  Formula(const std::string& text, std::span<const std::string> names);
  /// values: by names. May give infinities and NaN. Does not allocate.
  double operator()(std::span<const double> values) const;

 private:
  std::shared_ptr<const struct Program> program_;
};

/// The number that a formula without t stands for; it may be infinite or NaN. Throws LawError where make_expression
/// does, and at a t.
double eval_constant(const std::string& formula);

}  // namespace bough::laws
