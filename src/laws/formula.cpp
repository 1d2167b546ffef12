#include "bough/laws/formula.hpp"

#include <algorithm>
#include <charconv>

#include "bough/laws/law_error.hpp"
#include "eval_program.hpp"
#include "program.hpp"
#include "traps_masked.hpp"

namespace bough::laws {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

std::size_t end_of_number(std::string_view text, std::size_t at) {
  double number = 0.0;
  const char* begin = text.data() + at;
  const auto [end, status] = std::from_chars(begin, text.data() + text.size(), number);
  return at + std::max<std::size_t>(1, static_cast<std::size_t>(end - begin));
}

}  // namespace

std::vector<NamePlace> names_in(std::string_view formula) {
  std::vector<NamePlace> places;
  for (std::size_t i = 0; i < formula.size();) {
    if (is_digit(formula[i]) || formula[i] == '.') {
      i = end_of_number(formula, i);
    } else if (is_letter(formula[i])) {
      const std::size_t begin = i;
      while (i < formula.size() && (is_letter(formula[i]) || is_digit(formula[i]))) ++i;
      places.push_back({begin, i - begin});
    } else {
      ++i;
    }
  }
  return places;
}

bool is_formula_name(std::string_view text) {
  return !text.empty() && is_letter(text.front()) &&
         std::all_of(text.begin(), text.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

Formula::Formula(const std::string& text, std::span<const std::string> names) {
  const TrapsMasked masked;
  Program program = parse_formula(text, names);
  if (std::any_of(program.code.begin(), program.code.end(), [](const Instruction& i) { return i.op == Op::time; })) {
    for (const NamePlace& name : names_in(text))
      if (text.compare(name.position, name.length, "t") == 0)
        throw LawError(text, name.position, "t stands in laws of time only, and here a number is needed");
  }
  program_ = std::make_shared<const Program>(std::move(program));
}

Formula::Formula() : Formula("0", {}) {}

double Formula::operator()(std::span<const double> values) const {
  const TrapsMasked masked;
  return eval_program(*program_, values);
}

double Formula::operator()(std::span<const double> values, std::span<double> slopes) const {
  const TrapsMasked masked;
  for (std::size_t i = 0; i < values.size(); ++i) slopes[i] = eval_slope(*program_, values, i);
  return eval_program(*program_, values);
}

LawValue Formula::along(std::span<const LawValue> values) const {
  const TrapsMasked masked;
  const Jet<double> f = eval_along(*program_, values);
  return {f.value, f.rate, f.acceleration};
}

double eval_constant(const std::string& formula) { return Formula(formula, {})({}); }

}  // namespace bough::laws
