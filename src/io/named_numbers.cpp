#include "named_numbers.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/number_text.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/laws/formula.hpp"
#include "bough/laws/law_error.hpp"

namespace bough::io {
namespace {

bool is_word_of_formulas(std::string_view name) {
  const std::vector<std::string>& words = laws::formula_words();
  return std::find(words.begin(), words.end(), name) != words.end();
}

/// Text of a whole number; empty where it is none.
std::string whole_text(double x) {
  std::string text;
  if (std::abs(x) < 1e15 && std::abs(x - std::round(x)) <= 1e-9) append_number(text, std::llround(x));
  return text;
}

}  // namespace

std::string NamedNumbers::fault_of_name(const std::string& name) {
  if (!laws::is_formula_name(name)) return "a name in formulas is a letter or _, then letters, digits and _";
  if (is_word_of_formulas(name)) return "\"" + name + "\" means something else in formulas";
  if (name == "comment") return "\"comment\" is for remarks and names no number";
  if (name.size() > 100) return "a name has at most 100 characters";
  return "";
}

std::string NamedNumbers::hint_for(const std::string& name) {
  if (name.empty() || ++num_hints_ > max_problems) return "";
  std::vector<std::string> known = laws::formula_words();
  constexpr std::size_t most = 1000;  // limit of the names compared, since every fault searches all of them
  for (const auto& [other, value] : values_)
    if (known.size() < most) known.push_back(other);
  std::sort(known.begin(), known.end());  // the order in the table has no meaning
  const std::string near = search_.nearest(name.substr(0, 100), known);
  return near.empty() ? "names are those of \"parameters\" and the index of copies" : "did you mean \"" + near + "\"?";
}

std::optional<NamedFault> NamedNumbers::put_into_formula(std::string& formula, const JsonValue* own) {
  return put_numbers(formula, own, false);
}

std::optional<NamedFault> NamedNumbers::put_into_signal(std::string& formula) {
  if (formula.find_first_of("{}") != std::string::npos)
    if (std::optional<NamedFault> fault = put_into_text(formula)) return fault;
  return put_numbers(formula, nullptr, true);
}

std::optional<NamedFault> NamedNumbers::put_numbers(std::string& formula, const JsonValue* own, bool keeps_unknown) {
  std::string made;
  std::size_t done = 0;
  for (const laws::NamePlace& place : laws::names_in(formula)) {
    const std::string name = formula.substr(place.position, place.length);
    if (is_word_of_formulas(name) || (own != nullptr && own->find(name) != nullptr)) continue;
    if (defective_.count(name) > 0) return NamedFault{"", "", "", true};
    const auto at = values_.find(name);
    if (at == values_.end() && keeps_unknown) continue;
    if (at == values_.end()) return NamedFault{"no number has the name \"" + shown(name) + "\"", "", name};
    used_.insert(name);
    made.append(formula, done, place.position - done);
    made += '(';
    append_number(made, at->second);
    made += ')';
    done = place.position + place.length;
  }
  made.append(formula, done, std::string::npos);
  std::replace(made.begin(), made.end(), '{', '(');
  std::replace(made.begin(), made.end(), '}', ')');
  formula = std::move(made);
  return std::nullopt;
}

std::optional<NamedFault> NamedNumbers::put_into_text(std::string& text) {
  std::string made;
  for (std::size_t i = 0; i < text.size();) {
    const bool is_double = i + 1 < text.size() && text[i + 1] == text[i];
    if (text[i] == '}' || (text[i] == '{' && is_double)) {
      made += text[i];
      i += is_double ? 2 : 1;
      continue;
    }
    if (text[i] != '{') {
      const std::size_t next = std::min(text.find_first_of("{}", i), text.size());
      made.append(text, i, next - i);
      i = next;
      continue;
    }
    const std::size_t end = text.find('}', i);
    if (end == std::string::npos)
      return NamedFault{"a \"{\" without a \"}\"", "braces hold a number, as {i+1}; write {{ for a brace"};
    std::string formula = text.substr(i + 1, end - i - 1);
    const std::string written = formula;
    if (std::optional<NamedFault> fault = put_into_formula(formula)) return fault;
    try {
      const std::string number = whole_text(laws::eval_constant(formula));
      if (number.empty())
        return NamedFault{"what {" + shown(written) + "} gives is no whole number", "braces in names hold an index"};
      made += number;
    } catch (const laws::LawError& e) {
      return NamedFault{std::string("{") + shown(written) + "}: " + e.what(), "write {{ for a brace"};
    }
    i = end + 1;
  }
  text = std::move(made);
  return std::nullopt;
}

}  // namespace bough::io
