#include "sweep_rules.hpp"

#include "bough/io/read_sweep.hpp"
#include "schema_parts.hpp"

namespace bough::io {
namespace {

Field variables_field(Literal rule, Literal about) {
  return need("variables", array_rule("", named_rule(rule), 1, 100), about);
}

void add_variables(RuleTable& t) {
  const RuleRef any = number_rule("");
  t.named["sweep_value"] = choice_rule("", {any, boolean_rule(""), text_rule("")});
  t.named["distribution"] = choice_rule(
      "How a number is distributed.",
      {made(object_of_kind({"uniform"}, "Equally between two bounds.",
                           {need("low", any, "Lower bound."), need("high", any, "Upper bound, above it.")})),
       made(object_of_kind(
           {"normal"}, "Normal.",
           {need("mean", any, "Mean."), need("standard_deviation", positive(""), "Standard deviation.")})),
       made(object_of_kind({"lognormal"}, "Its logarithm is normal.",
                           {need("log_mean", any, "Mean of the natural logarithm; exp of it is the median."),
                            need("log_standard_deviation", positive(""), "Standard deviation of the logarithm.")})),
       made(object_of_kind({"discrete"}, "One of several values.",
                           {need("values", array_rule("", any, 1, 100000), "The values."),
                            may("weights", array_rule("", not_negative(""), 1, 100000),
                                "How often each comes, in any unit. Default: equally often.")}))});
  const auto variable = [](std::vector<Field> more, Literal about) {
    std::vector<Field> fields = {
        need("name", name_rule(""), "Its name, of the column."),
        may("pointer", text_rule(""),
            "JSON pointer into the scene, as of --set; * stands for every item of a list. Default: "
            "the parameter of this name.")};
    fields.insert(fields.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
    return made(object_of(about, std::move(fields)));
  };
  const Field values = need("values", array_rule("", named_rule("sweep_value"), 1, 100000), "What it takes.");
  t.named["plain_variable"] = variable({}, "Something that is varied.");
  t.named["column_variable"] =
      variable({may("column", text_rule(""), "Column of the table. Default: that of its name.")},
               "Something that is varied, with its column.");
  t.named["listed_variable"] = variable({values}, "Something that is varied, with its values.");
  t.named["centred_variable"] = variable({values, need("nominal", named_rule("sweep_value"), "While others vary.")},
                                         "The same, with a value at rest.");
  t.named["random_variable"] = variable({need("distribution", named_rule("distribution"), "How it is distributed.")},
                                        "Something that is varied, with its distribution.");
}

void add_designs(RuleTable& t) {
  const Field seed = may("seed", integer_rule("", 0, 9007199254740991.0), "Equal seeds give equal draws.", "1");
  const auto samples = [](double most) { return need("samples", integer_rule("", 1, most), "How many."); };
  constexpr double most = static_cast<double>(most_sweep_cases);
  t.named["design"] = choice_rule(
      "Values for some variables.",
      {made(object_of_kind({"list"}, "Rows of values.",
                           {variables_field("plain_variable", "Of the columns."),
                            need("rows", array_rule("", array_rule("", named_rule("sweep_value"), 1, 100), 1),
                                 "Values by variable.")})),
       made(object_of_kind({"csv"}, "The rows of a table: CSV with one header line.",
                           {need("file", text_rule(""), "Its name, relative to the sweep's folder."),
                            variables_field("column_variable", "Those that columns give.")})),
       made(object_of_kind({"grid"}, "All combinations of the values, the last variable fastest.",
                           {variables_field("listed_variable", "What varies.")})),
       made(object_of_kind({"one_at_a_time"}, "All nominal values, then each variable through its values.",
                           {variables_field("centred_variable", "What varies.")})),
       made(object_of_kind({"random"}, "Independent draws.",
                           {variables_field("random_variable", "What varies."), samples(most), seed})),
       made(object_of_kind(
           {"latin_hypercube"},
           "Draws of which each variable has one in each of as many equally likely strata (McKay, Beckman, "
           "Conover 1979).",
           {variables_field("random_variable", "What varies."), samples(most), seed})),
       made(object_of_kind(
           {"sobol"},
           "Sobol's sequence, moved by one draw a variable modulo 1. Powers of two are balanced. At most 21 variables.",
           {variables_field("random_variable", "What varies."), samples(most), seed})),
       made(object_of_kind(
           {"morris"},
           "Trajectories on a grid of quantiles along which one variable after the other moves (Morris 1991): "
           "(variables + 1) cases each.",
           {variables_field("random_variable", "What varies."),
            need("trajectories", integer_rule("", 2, 1e5), "How many."),
            may("levels", integer_rule("", 2, 1000), "Of the grid, an even number.", "4"), seed})),
       made(object_of_kind(
           {"saltelli"},
           "For Sobol's indices: samples times (variables + 2) cases (Saltelli et al. 2010). At most 10 variables.",
           {variables_field("random_variable", "What varies."), samples(most / 3.0), seed}))});
}

RuleTable make_sweep_rules() {
  RuleTable t;
  t.named = scene_rules().named;
  t.named["setting_value"] =
      choice_rule("", {number_rule(""), boolean_rule(""), text_rule(""), array_rule("", number_rule("")),
                       array_rule("", array_rule("", number_rule("")), 1)});
  t.named["setting"] =
      made(object_of("A change of the scene.",
                     {need("pointer", text_rule(""), "JSON pointer into the scene; * stands for every item of a list."),
                      need("value", named_rule("setting_value"), "What stands there.")}));
  add_variables(t);
  add_designs(t);
  t.named["condition"] =
      made(object_of("A condition that cases have to keep.",
                     {need("expression", text_rule(""), "A formula of variables."),
                      may("low", number_rule(""), "Least value."), may("high", number_rule(""), "Largest value.")}));
  t.root = made(object_of(
      "A sweep: one scene in many cases. A \"comment\" string is allowed in every object.",
      {may("$schema", text_rule(""), "Address of this schema, for editors; not read."),
       need("schema_version", integer_rule("", 1, 1), "Version of the format: 1."),
       may("title", text_rule(""), "One line.", "\"\""),
       need("scene", text_rule(""), "The scene's file, relative to this file's folder."),
       may("set", array_rule("", named_rule("setting"), 0, 1000), "What all cases change in the scene.", "[]"),
       need("designs", array_rule("", named_rule("design"), 1, 10),
            "What varies. Of several designs all combinations are made, the last one fastest."),
       may("where", array_rule("", named_rule("condition"), 0, 100), "Other cases are left out.", "[]"),
       may("measures", array_rule("", named_rule("measure"), 0, 1000), "Beside those of the scene.", "[]")}));
  return t;
}

}  // namespace

const RuleTable& sweep_rules() {
  static const RuleTable table = make_sweep_rules();
  return table;
}

std::string sweep_schema_text() { return schema_text_of(sweep_rules(), "bough sweep"); }

}  // namespace bough::io
