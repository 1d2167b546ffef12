#include "bough/scene/components.hpp"
#include "schema_parts.hpp"

namespace bough::io {

void add_measure_rules(RuleTable& t) {
  std::vector<std::string> figures;
  for (int k = 0; k <= static_cast<int>(scene::MeasureKind::equivalent_range); ++k)
    figures.push_back(scene::to_string(static_cast<scene::MeasureKind>(k)));
  Rule of = object_of("Names in the expression, each with a quantity: \"x\": \"tip.x\".", {});
  of.others = text_rule("");
  const RuleRef any = number_rule("");
  Rule measure = object_of(
      "A figure of a run, taken from all accepted steps: a column of batches and sweeps. value to period are taken as "
      "expected figures are, within steps as well; all others, and those of expressions, take straight lines between "
      "the "
      "ends of steps.",
      {need("name", name_rule(""), "Its name, of the column."),
       may("quantity", text_rule(""), "\"<sensor>.<component>\", or \"<sensor>\" for a scalar."),
       may("expression", text_rule(""), "In place of a quantity: a formula of the names in `of` and of parameters."),
       may("of", made(std::move(of)),
           "Of an expression: its quantities, or names of measures that come before this one; its value is then that "
           "of "
           "the formula, without a figure."),
       may("figure", word_rule("", figures),
           "value, max, min, time_of_max, time_of_min, range (peak to peak), period: as of expected figures. mean, "
           "rms: over "
           "time. percentile: at or below it for `percent` of the time. settling_time: after it within `band` of "
           "`target`. "
           "dominant_frequency: of the largest peak of the amplitude spectrum [1/s]. cycles: number of rainflow cycles "
           "(ASTM E 1049) of a range of at least `range`. equivalent_range: damage-equivalent load, the range of "
           "`cycles` "
           "equal cycles with the same sum of range^exponent.",
           "\"value\""),
       may("from", not_negative(""),
           "The part of the run that counts begins here [s] (statics: load factor); values there are interpolated "
           "between "
           "the ends of steps. Default: at the start."),
       may("to", not_negative(""), "It ends here. Default: at the end."),
       may("time", not_negative(""), "Of figure \"value\" [s] (statics: load factor). Default: at the end."),
       may("level", any, "Of figure \"period\": the value whose upward crossings are counted. Default: 0."),
       may("percent", number_rule("", 0.0, false, 100.0), "Of figure \"percentile\".", "50"),
       may("band", not_negative(""), "Of figure \"settling_time\": largest distance from the target."),
       may("target", any, "Of figure \"settling_time\". Default: the value at the end."),
       may("range", not_negative(""), "Of figure \"cycles\": smaller ranges are not counted.", "0"),
       may("exponent", number_rule("", 1.0, false, 100.0), "Of figure \"equivalent_range\": m of the S-N line [-].",
           "10"),
       may("cycles", positive(""), "Of figure \"equivalent_range\". Default: one a second of the run."),
       may("value", any, "What it has to be, as of expected figures; with one tolerance at least."),
       may("tolerance", positive(""), "Largest difference, absolute; with relative_tolerance the two add up."),
       may("relative_tolerance", positive(""), "Largest difference as a part of |value| [-]."),
       may("source", text_rule(""), "Where the value comes from.")});
  measure.exactly_one = {{"quantity", "expression"}};
  t.named["measure"] = made(std::move(measure));
}

}  // namespace bough::io
