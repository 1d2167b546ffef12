#include "bough/laws/formula.hpp"

#include <algorithm>
#include <cfenv>
#include <charconv>

#include "bough/laws/law_error.hpp"
#include "program.hpp"

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

double eval_constant(const std::string& formula) {
  std::fenv_t environment;
  std::feholdexcept(&environment);  // 1/0 is for the caller to judge, not to trap
  Program program;
  try {
    program = parse_formula(formula);
  } catch (...) {
    std::fesetenv(&environment);
    throw;
  }
  std::fesetenv(&environment);
  if (program.code.size() == 1 && program.code[0].op == Op::number) return program.code[0].number;
  // The reader evaluates what is constant at once, so what is left depends on t.
  for (const NamePlace& name : names_in(formula))
    if (formula.compare(name.position, name.length, "t") == 0)
      throw LawError(formula, name.position, "t stands in laws of time only, and here a number is needed");
  throw LawError(formula, 0, "this is not a constant");
}

}  // namespace bough::laws
