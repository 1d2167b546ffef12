#include "study_rules.hpp"

#include "bough/io/read_study.hpp"
#include "schema_parts.hpp"

namespace bough::io {
namespace {

RuleRef settings_rule(Literal about) { return array_rule(about, named_rule("setting"), 0, 1000); }

void add_reference(RuleTable& t) {
  t.named["study_reference"] = made(object_of(
      "A reference that is computed once: by another method, or much tighter settings, than any run.",
      {need("set", settings_rule(""), "What the reference changes in the scene."),
       need("check", settings_rule(""),
            "Changes of a second, independent run; the reference's own error is estimated from their difference."),
       may("order", number_rule("", 0.0, false, 12.0),
           "Where the check takes `ratio` times the step of a method of this order, the difference is (ratio^order - "
           "1) "
           "errors. 0: the whole difference is taken for the error.",
           "0"),
       may("ratio", number_rule("", 1.0, true, 1e6), "Of the step of the check to that of the reference.", "2"),
       may("about", text_rule(""), "What it is, in words.", "\"\"")}));
}

void add_quantity(RuleTable& t) {
  Rule quantity = object_of(
      "A quantity whose error is measured.",
      {need("name", name_rule(""), "Its name in tables and plots."),
       need("sensor", text_rule(""), "A sensor of the scene."),
       may("components", array_rule("", text_rule(""), 1, 100),
           "Of the sensor. Default: all. Components of one quantity share a unit."),
       may("unit", text_rule(""), "Of the components.", "\"\""),
       may("formula", array_rule("", named_rule("law"), 1, 100), "Closed form: one law of time for each component."),
       may("table",
           made(object_of("A table in a file (CSV with one header line).",
                          {need("file", text_rule(""), "Its name, relative to the study's folder."),
                           may("time", text_rule(""), "Column of time [s].", "\"t\""),
                           need("columns", array_rule("", text_rule(""), 1, 100),
                                "One for each component; rotations: three (rotation vector) or four (quaternion, "
                                "scalar first).")})),
           "Published or independent figures at the sample times."),
       may("source", text_rule(""), "Where formula or table come from.", "\"\""),
       may("uncertainty", not_negative(""), "Of formula or table, relative as errors are [-] (rotations: [rad]).",
           "0")});
  quantity.at_most_one = {{"formula", "table"}};
  t.named["study_quantity"] = made(std::move(quantity));
}

void add_axis(RuleTable& t) {
  const RuleRef value = named_rule("setting_value");
  Rule axis = object_of(
      "One thing that is varied.",
      {need("name", text_rule(""), "Its name; a known one needs no pointer."),
       may("pointer", text_rule(""), "JSON pointer into the scene; * stands for every item of a list."),
       may("values", array_rule("", value, 1, 1000), "What stands there, one after the other."),
       may("choices",
           array_rule("",
                      made(object_of("Several changes at a time.",
                                     {need("label", name_rule(""), "In tables and plots."),
                                      need("set", settings_rule(""), "What changes."),
                                      may("value", number_rule(""), "The number on the abscissa, where it is one.")})),
                      1, 1000),
           "In place of values: changes of several things."),
       may("finer", word_rule("", {"smaller", "larger"}), "Which end of the axis is the more accurate.")});
  axis.exactly_one = {{"values", "choices"}};
  axis.at_most_one = {{"pointer", "choices"}};
  t.named["study_axis"] = made(std::move(axis));
}

void add_grid(RuleTable& t) {
  t.named["study_grid"] = made(object_of(
      "All combinations of the values of its axes.",
      {need("name", name_rule(""), "Its name in tables and plots."),
       may("set", settings_rule(""), "What all its runs change in the scene.", "[]"),
       need("axes", array_rule("", named_rule("study_axis"), 1, 8), "What is varied."),
       may("abscissa", text_rule(""),
           "Name of the axis over which errors converge. Default: the first axis of numbers."),
       may("orders",
           array_rule("", made(object_of("What theory says.",
                                         {need("quantity", text_rule(""), "Name of a quantity."),
                                          need("order", number_rule("", 0.0, true, 20.0), "Order of its error."),
                                          need("theory", text_rule(""), "Where this comes from."),
                                          may("explanation", text_rule(""),
                                              "Why the order found is higher, where it is.", "\"\"")}))),
           "Orders that the errors should show.", "[]"),
       may("reference", named_rule("study_reference"), "Of this grid, for all quantities.")}));
}

RuleTable make_study_rules() {
  RuleTable t;
  t.named = scene_rules().named;
  const RuleRef any = number_rule("");
  t.named["setting_value"] =
      choice_rule("", {any, boolean_rule(""), text_rule(""), array_rule("", any), array_rule("", array_rule("", any))});
  t.named["setting"] =
      made(object_of("A change of the scene.",
                     {need("pointer", text_rule(""), "JSON pointer into the scene; * stands for every item of a list."),
                      need("value", named_rule("setting_value"), "What stands there.")}));
  add_reference(t);
  add_quantity(t);
  add_axis(t);
  add_grid(t);
  t.root = made(object_of(
      "A study: one scene over grids of choices, error and run time measured together. A \"comment\" string is allowed "
      "in every object.",
      {may("$schema", text_rule(""), "Address of this schema, for editors; not read."),
       need("schema_version", integer_rule("", 1, 1), "Version of the format: 1."),
       may("title", text_rule(""), "One line.", "\"\""),
       need("scene", text_rule(""), "The scene's file, relative to this file's folder."),
       may("set", settings_rule(""), "What all runs and references change in the scene.", "[]"),
       may("sensors", array_rule("", named_rule("sensor"), 1, 1000), "In place of the scene's own."),
       need("quantities", array_rule("", named_rule("study_quantity"), 1, 100), "What errors are measured of."),
       may("sample_interval", positive(""),
           "Errors are measured at multiples of it [s] (statics: of the load factor); all step sizes divide it. "
           "Default: at the end alone."),
       may("reference", named_rule("study_reference"), "For quantities without formula or table."),
       need("grids", array_rule("", named_rule("study_grid"), 1, 100), "The choices."),
       may("repetitions", integer_rule("", 1, 1000), "Timed runs of every choice.", "3"),
       may("time_limit", positive(""), "Of a run [s]; a longer one is a failure.", "120"),
       may("figures", array_rule("", text_rule(""), 1, 100),
           "Figures of the solver, as in summary.json, drawn over the abscissa of each grid.", "[]"),
       may("wanted", array_rule("", positive(""), 1, 100), "Errors for which the quickest choice is told.",
           "[1e-2, 1e-3, 1e-4, 1e-5, 1e-6]")}));
  return t;
}

}  // namespace

const RuleTable& study_rules() {
  static const RuleTable table = make_study_rules();
  return table;
}

const std::vector<KnownAxis>& known_axes() {
  static const std::vector<KnownAxis> axes = {{"step size", "/analysis/step_size", false},
                                              {"tolerance", "/analysis/step_control/tolerance", false},
                                              {"Newton tolerance", "/analysis/tolerance", false},
                                              {"Newton", "/analysis/newton", false},
                                              {"integrator", "/analysis/integrator", false},
                                              {"spectral radius", "/analysis/spectral_radius", false},
                                              {"load steps", "/analysis/load_steps", true},
                                              {"elements", "/beams/*/elements", true},
                                              {"element order", "/beams/*/order", false},
                                              {"form of the solver", "/solver/form", false},
                                              {"depth", "/solver/depth", false},
                                              {"leaf size", "/solver/leaf_size", false},
                                              {"penalty factor", "/solver/penalty_factor", false},
                                              {"threads", "", false}};
  return axes;
}

std::string study_schema_text() { return schema_text_of(study_rules(), "bough study"); }

}  // namespace bough::io
