#include "schema_parts.hpp"

namespace bough::io {

void add_law_rules(RuleTable& t) {
  const RuleRef any = number_rule("");
  const RuleRef law = named_rule("law");
  const std::vector<Field> step = {need("end_time", any, "Time after which the value is `to` [s]."),
                                   may("start_time", any, "Time up to which the value is `from` [s].", "0"),
                                   may("from", any, "Value before.", "0"), may("to", any, "Value after.", "1")};
  t.named["law"] = choice_rule(
      "A function of time t [s] (in statics: of the load factor, 0 to 1). A bare number is constant.",
      {any,
       made(object_of("A formula in t: + - * / ^, pi, e, sin cos tan asin acos atan sinh cosh tanh exp log sqrt abs "
                      "sign step pow min max.",
                      {need("expression", text_rule(""), "The formula, for instance \"0.5*sin(2*pi*t)\".")},
                      "expression")),
       made(object_of_kind({"constant"}, "The same at all times.", {need("value", any, "The value.")})),
       made(object_of_kind({"ramp"}, "Straight from one value to another; the rate jumps at both ends.", step)),
       made(object_of_kind({"smooth_ramp"}, "Quintic from one value to another; no jump up to the second derivative.",
                           step)),
       made(object_of_kind(
           {"cycloidal"},
           "Cycloid from one value to another: s - sin(2 pi s) / (2 pi); no jump up to the second derivative.", step)),
       made(object_of_kind({"harmonic"}, "offset + amplitude sin(omega t + phase).",
                           {need("amplitude", any, "Amplitude."), need("omega", any, "Angular frequency [rad/s]."),
                            may("phase", any, "Phase [rad].", "0"), may("offset", any, "Mean value.", "0")})),
       made(
           object_of_kind({"table"}, "Through given points; constant outside.",
                          {need("times", array_rule("", any, 1), "Increasing times [s]."),
                           need("values", array_rule("", any, 1), "One value per time."),
                           may("interpolation", word_rule("", {"linear", "cubic", "monotone"}),
                               "Straight lines, a cubic spline, or cubics that rise and fall only where the values do.",
                               "\"linear\"")})),
       made(object_of_kind(
           {"piecewise"}, "Different laws one after the other.",
           {need("pieces",
                 array_rule("",
                            made(object_of("A piece.", {need("start", any, "Time from which it holds [s]; increasing."),
                                                        need("law", law, "The law, in absolute time.")})),
                            1),
                 "The pieces in the order of time; the first also holds before its start.")})),
       made(object_of_kind({"sum"}, "Sum of laws.", {need("terms", array_rule("", law, 1), "The terms.")})),
       made(object_of_kind({"product"}, "Product of laws.", {need("factors", array_rule("", law, 1), "The factors.")})),
       made(object_of_kind({"scaled"}, "A multiple of a law.",
                           {need("factor", any, "The factor."), need("law", law, "The law.")}))});
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
