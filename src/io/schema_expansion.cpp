#include "bough/io/read_scene.hpp"
#include "schema_parts.hpp"

namespace bough::io {
namespace {

RuleRef deferred(const RuleRef& rule) {
  Rule later = *rule;
  later.is_deferred = true;
  return made(std::move(later));
}

}  // namespace

RuleRef copy_count_rule() { return integer_rule("", 0, static_cast<double>(max_json_values)); }
RuleRef copy_first_rule() { return integer_rule("", -1e9, 1e9); }

void add_expansion_rules(RuleTable& t, const std::vector<Field>& lists) {
  t.named["formula"] =
      made(object_of("A number by a formula of named numbers, pi and e: + - * / ^, functions as in laws.",
                     {need("expression", text_rule(""), "The formula, for instance \"2*L\".")}));
  Rule parameters = object_of(
      "Named numbers. A formula {\"expression\": \"2*L\"} may name them, and so may braces in strings: \"link {N-1}\". "
      "They "
      "may depend on each other in any order. `--set /parameters/L=3` changes one.",
      {});
  parameters.others = number_rule("A number, or a formula of other parameters.");
  t.named["parameters"] = made(std::move(parameters));

  Rule group = object_of(
      "Parts that come many times: copies of all lists in here, one for each value of the index. The copies are added "
      "to the "
      "lists of the scene, copy after copy. Formulas may name the index, and so may braces in strings: \"link {i}\", "
      "\"link "
      "{i+1}\".",
      {need("index", text_rule(""), "Name of the index: a letter or _, then letters, digits and _."),
       need("count", deferred(copy_count_rule()),
            "Number of copies; a formula may name parameters and indices around."),
       may("first", deferred(copy_first_rule()), "Index of the first copy.", "0")});
  for (Field list : lists) {
    list.rule = deferred(list.rule);
    list.default_json = {};
    group.fields.push_back(std::move(list));
  }
  group.fields.push_back(may("repeat", named_rule("repeat"), "Copies within each copy, as for a lattice."));
  t.named["repeat_group"] = made(std::move(group));
  t.named["repeat"] = array_rule("", named_rule("repeat_group"));
}

}  // namespace bough::io
