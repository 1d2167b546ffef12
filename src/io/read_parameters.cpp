#include "read_parameters.hpp"

#include <cmath>
#include <unordered_map>

#include "bough/laws/formula.hpp"
#include "bough/laws/law_error.hpp"

namespace bough::io {
namespace {

/// A parameter given by a formula, the formulas that it needs, and those that need it.
struct Formula {
  std::string name, pointer;
  const JsonValue* text = nullptr;
  std::vector<std::size_t> needs, needed_by;
  std::size_t open = 0;  ///< number of `needs` that have no value yet
};

class ParameterReader {
 public:
  ParameterReader(NamedNumbers& names, const TellFault& tell) : names_(names), tell_(tell) {}

  void read(const JsonValue& parameters) {
    for (std::size_t i = 0; i < parameters.items.size(); ++i) take(parameters.items.key(i), parameters.items[i]);
    for (std::size_t i = 0; i < formulas_.size(); ++i)
      for (const laws::NamePlace& place : laws::names_in(formulas_[i].text->text.str())) {
        const auto other = index_of_.find(formulas_[i].text->text.str().substr(place.position, place.length));
        if (other == index_of_.end()) continue;
        formulas_[i].needs.push_back(other->second);
        formulas_[other->second].needed_by.push_back(i);
        ++formulas_[i].open;
      }
    evaluate_all();
    tell_of_cycles();
  }

 private:
  void take(const std::string& name, const JsonValue& value) {
    if (name == "comment" && value.is(JsonKind::string)) return;
    const std::string pointer = pointer_to("/parameters", name);
    const std::string rule = NamedNumbers::fault_of_name(name);
    if (!rule.empty()) return tell_(value, pointer, rule, "", true);
    if (value.is(JsonKind::number)) return value.sound ? names_.set(name, value.number) : names_.set_defective(name);
    const JsonValue* formula = value.is(JsonKind::object) ? formula_of(value, pointer) : nullptr;
    if (formula == nullptr) {
      names_.set_defective(name);
      if (!value.is(JsonKind::object))
        tell_(value, pointer, "has to be a number or an object with \"expression\"", "", false);
      return;
    }
    index_of_.emplace(name, formulas_.size());
    formulas_.push_back({name, pointer, formula, {}, {}, 0});
  }

  /// The text of {"expression": text}; nullptr if the object has another form, which is reported.
  const JsonValue* formula_of(const JsonValue& value, const std::string& pointer) {
    const JsonValue* formula = nullptr;
    for (std::size_t i = 0; i < value.items.size(); ++i) {
      const std::string& key = value.items.key(i);
      if (key == "expression") formula = &value.items[i];
      if (key != "expression" && key != "comment") {
        tell_(value.items[i], pointer_to(pointer, key), "this key is not known here",
              "a parameter is a number or an object with \"expression\"", true);
        return nullptr;
      }
    }
    if (formula != nullptr && formula->is(JsonKind::string)) return formula;
    if (formula == nullptr)
      tell_(value, pointer, "needs the key \"expression\"", "", false);
    else
      tell_(*formula, pointer + "/expression", "has to be a string", "", false);
    return nullptr;
  }

  void evaluate_all() {
    std::vector<std::size_t> ready;
    for (std::size_t i = 0; i < formulas_.size(); ++i)
      if (formulas_[i].open == 0) ready.push_back(i);
    for (std::size_t k = 0; k < ready.size(); ++k) {
      const Formula& f = formulas_[ready[k]];
      evaluate(f);
      for (const std::size_t i : f.needed_by)
        if (--formulas_[i].open == 0) ready.push_back(i);
    }
  }

  void evaluate(const Formula& f) {
    std::string text = f.text->text;
    const std::string at = f.pointer + "/expression";
    std::optional<NamedFault> fault = names_.put_into_formula(text);
    if (fault) {
      names_.set_defective(f.name);
      if (!fault->was_told) tell_(*f.text, at, fault->rule, names_.hint_for(fault->unknown), false);
      return;
    }
    try {
      const double x = laws::eval_constant(text);
      if (std::isfinite(x)) return names_.set(f.name, x);
      tell_(*f.text, at,
            std::string("gives ") +
                (std::isnan(x) ? "nan"
                 : x > 0.0     ? "inf"
                               : "-inf") +
                ", and numbers are finite",
            "with numbers: " + shown(text), false);
    } catch (const laws::LawError& e) {
      tell_(*f.text, at, e.what(), "", false);
    }
    names_.set_defective(f.name);
  }

  /// Formulas that have no value in the end belong to a cycle, or need one that does.
  void tell_of_cycles() {
    std::vector<std::size_t> walk_of(formulas_.size(), 0);
    std::size_t walk = 0;
    for (std::size_t i = 0; i < formulas_.size(); ++i) {
      if (formulas_[i].open == 0) continue;
      names_.set_defective(formulas_[i].name);
      std::size_t at = i;
      for (++walk; walk_of[at] == 0; at = open_need(at)) walk_of[at] = walk;
      if (walk_of[at] == walk) tell_of_cycle(at);
    }
  }

  std::size_t open_need(std::size_t i) const {
    for (const std::size_t other : formulas_[i].needs)
      if (formulas_[other].open > 0) return other;
    return i;
  }

  void tell_of_cycle(std::size_t first) {
    constexpr int shown_names = 6;
    std::string way = formulas_[first].name;
    int count = 0;
    for (std::size_t at = open_need(first); at != first; at = open_need(at))
      if (++count < shown_names) way += " needs " + formulas_[at].name + ", which";
    if (count >= shown_names) way += " needs " + std::to_string(count - shown_names + 1) + " others, which";
    way += " needs " + formulas_[first].name;
    tell_(*formulas_[first].text, formulas_[first].pointer + "/expression", "this parameter depends on itself: " + way,
          "give one of them a number", false);
  }

  NamedNumbers& names_;
  const TellFault& tell_;
  std::vector<Formula> formulas_;
  std::unordered_map<std::string, std::size_t> index_of_;
};

}  // namespace

void read_parameters(const JsonValue& parameters, NamedNumbers& names, const TellFault& tell) {
  ParameterReader(names, tell).read(parameters);
}

}  // namespace bough::io
