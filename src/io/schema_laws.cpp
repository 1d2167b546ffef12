#include <utility>

#include "bough/laws/make_law.hpp"
#include "law_kinds.hpp"
#include "schema_parts.hpp"

namespace bough::io {

namespace {

using Value = JsonValue;

std::vector<double> numbers(const Value& list) {
  std::vector<double> r;
  for (const Value& x : list.items) r.push_back(x.number);
  return r;
}

std::vector<laws::Law> laws_in(const Value& list, const std::string& at, const ReadLaw& read) {
  std::vector<laws::Law> r;
  for (std::size_t i = 0; i < list.items.size(); ++i) r.push_back(read(list.items[i], at + "/" + std::to_string(i)));
  return r;
}

/// A law from one value to another.
template <laws::Law (*make)(double start, double end, double from, double to)>
laws::Law make_step(const Value& v, const std::string&, const ReadLaw&) {
  return make(v.find("start_time")->number, v.find("end_time")->number, v.find("from")->number, v.find("to")->number);
}

laws::Law make_table(const Value& v, const std::string&, const ReadLaw&) {
  const std::string& way = v.find("interpolation")->text;
  return laws::make_table(numbers(*v.find("times")), numbers(*v.find("values")),
                          way == "cubic"      ? laws::Interpolation::cubic
                          : way == "monotone" ? laws::Interpolation::monotone
                                              : laws::Interpolation::linear);
}

laws::Law make_piecewise(const Value& v, const std::string& at, const ReadLaw& read) {
  std::vector<laws::Segment> pieces;
  const Value& list = *v.find("pieces");
  for (std::size_t i = 0; i < list.items.size(); ++i)
    pieces.push_back({list.items[i].find("start")->number,
                      read(*list.items[i].find("law"), at + "/pieces/" + std::to_string(i) + "/law")});
  return laws::make_piecewise(pieces);
}

/// Multiplies neighbours in pairs, so that a product of thousands of factors is not nested thousands of levels deep.
laws::Law make_product(const Value& v, const std::string& at, const ReadLaw& read) {
  std::vector<laws::Law> factors = laws_in(*v.find("factors"), at + "/factors", read);
  for (; factors.size() > 1; factors.resize((factors.size() + 1) / 2))
    for (std::size_t i = 0; i < factors.size(); i += 2)
      factors[i / 2] = i + 1 < factors.size() ? laws::make_product(factors[i], factors[i + 1]) : factors[i];
  return factors.front();
}

}  // namespace

const std::vector<LawKind>& law_kinds() {
  static const RuleRef any = number_rule(""), law = named_rule("law"), some_numbers = array_rule("", any, 1);
  static const std::vector<Field> step = {need("end_time", any, "Time after which the value is `to` [s]."),
                                          may("start_time", any, "Time up to which the value is `from` [s].", "0"),
                                          may("from", any, "Value before.", "0"), may("to", any, "Value after.", "1")};
  static const std::vector<LawKind> kinds = {
      {"constant",
       "The same at all times.",
       {need("value", any, "The value.")},
       [](const Value& v, const std::string&, const ReadLaw&) { return laws::make_constant(v.find("value")->number); }},
      {"ramp", "Straight from one value to another; the rate jumps at both ends.", step, make_step<laws::make_ramp>},
      {"smooth_ramp", "Quintic from one value to another; no jump up to the second derivative.", step,
       make_step<laws::make_smooth_ramp>},
      {"cycloidal", "Cycloid from one value to another: s - sin(2 pi s) / (2 pi); no jump up to the second derivative.",
       step, make_step<laws::make_cycloidal>},
      {"harmonic",
       "offset + amplitude sin(omega t + phase).",
       {need("amplitude", any, "Amplitude."), need("omega", any, "Angular frequency [rad/s]."),
        may("phase", any, "Phase [rad].", "0"), may("offset", any, "Mean value.", "0")},
       [](const Value& v, const std::string&, const ReadLaw&) {
         return laws::make_harmonic(v.find("amplitude")->number, v.find("omega")->number, v.find("phase")->number,
                                    v.find("offset")->number);
       }},
      {"table",
       "Through given points; constant outside.",
       {need("times", some_numbers, "Increasing times [s]."), need("values", some_numbers, "One value per time."),
        may("interpolation", word_rule("", {"linear", "cubic", "monotone"}),
            "Straight lines, a cubic spline, or cubics that rise and fall only where the values do.", "\"linear\"")},
       make_table},
      {"piecewise",
       "Different laws one after the other.",
       {need("pieces",
             array_rule("",
                        made(object_of("A piece.", {need("start", any, "Time from which it holds [s]; increasing."),
                                                    need("law", law, "The law, in absolute time.")})),
                        1),
             "The pieces in the order of time; the first also holds before its start.")},
       make_piecewise},
      {"sum",
       "Sum of laws.",
       {need("terms", array_rule("", law, 1), "The terms.")},
       [](const Value& v, const std::string& at, const ReadLaw& read) {
         return laws::make_sum(laws_in(*v.find("terms"), at + "/terms", read));
       }},
      {"product", "Product of laws.", {need("factors", array_rule("", law, 1), "The factors.")}, make_product},
      {"scaled",
       "A multiple of a law.",
       {need("factor", any, "The factor."), need("law", law, "The law.")},
       [](const Value& v, const std::string& at, const ReadLaw& read) {
         return laws::make_scaled(v.find("factor")->number, read(*v.find("law"), at + "/law"));
       }}};
  return kinds;
}

void add_law_rules(RuleTable& t) {
  const RuleRef law = named_rule("law");
  std::vector<RuleRef> kinds = {
      number_rule(""),
      made(object_of("A formula in t: + - * / ^, pi, e, sin cos tan asin acos atan sinh cosh tanh exp log sqrt abs "
                     "sign step pow min max.",
                     {need("expression", text_rule(""), "The formula, for instance \"0.5*sin(2*pi*t)\".")},
                     "expression"))};
  for (const LawKind& kind : law_kinds())
    kinds.push_back(made(object_of_kind({std::string(kind.name)}, kind.about, kind.fields)));
  t.named["law"] =
      choice_rule("A function of time t [s] (in statics: of the load factor, 0 to 1). A bare number is constant.",
                  std::move(kinds));
  const RuleRef signal =
      made(object_of("The value of a signal of the scene.", {need("signal", text_rule(""), "Its name.")}, "signal"));
  t.named["law_or_signal"] =
      choice_rule("A function of time, or {\"signal\": name}: a number that changes with the motion.", {law, signal});
  t.named["three_laws"] = array_rule("Three laws; a number is constant.", law, 3, 3);
  t.named["turn"] =
      made(object_of("A rotation about an axis that is fixed in the axes reached before it.",
                     {need("axis", named_rule("vector"), "Axis; its length does not matter, but is not 0."),
                      need("angle", law, "[rad]; counts turns. With rate: [rad/s]."),
                      may("rate", boolean_rule(""),
                          "The law is the rate; it is integrated exactly from angle 0 at time 0.", "false")}));
}

}  // namespace bough::io
