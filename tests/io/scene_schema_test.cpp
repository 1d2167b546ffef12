// The published schema and the reader come from one table. Written here: the schema and the files for
// tests/io/check_schema.py, which asks an independent validator whether it agrees.
#include <gtest/gtest.h>

#include <set>

#include "bough/io/json_value.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/schema_rule.hpp"

namespace bough::io {
namespace {

TEST(SceneSchema, the_schema_is_json_and_names_its_draft) {
  std::vector<JsonFault> faults;
  const auto schema = parse_json(schema_text(), source_file, faults);
  ASSERT_TRUE(schema && faults.empty());
  EXPECT_EQ(schema->find("$schema")->text, "http://json-schema.org/draft-07/schema#");
  EXPECT_EQ(schema->find("definitions")->items.size(), scene_rules().named.size());
}

/// Visits every rule once.
template <class Visit>
void visit_rules(const Rule& rule, std::set<const Rule*>& seen, const Visit& visit) {
  if (!seen.insert(&rule).second) return;
  visit(rule);
  if (rule.form == Form::named) visit_rules(scene_rules().resolve(rule), seen, visit);
  if (rule.item) visit_rules(*rule.item, seen, visit);
  if (rule.others) visit_rules(*rule.others, seen, visit);
  for (const RuleRef& option : rule.options) visit_rules(*option, seen, visit);
  for (const Field& field : rule.fields) visit_rules(*field.rule, seen, visit);
}

TEST(SceneSchema, every_key_is_described_and_keys_are_spelt_in_one_way) {
  std::set<const Rule*> seen;
  int fields = 0;
  visit_rules(*scene_rules().root, seen, [&](const Rule& rule) {
    for (const Field& field : rule.fields) {
      ++fields;
      EXPECT_FALSE(field.about.empty()) << field.key;
      EXPECT_EQ(field.key.find_first_of(" -."), std::string::npos) << field.key;
    }
  });
  EXPECT_GT(fields, 150);
}

TEST(SceneSchema, every_default_keeps_its_own_rule) {
  std::set<const Rule*> seen;
  visit_rules(*scene_rules().root, seen, [&](const Rule& rule) {
    for (const Field& field : rule.fields) {
      if (field.default_json.empty()) continue;
      std::vector<JsonFault> text_faults;
      auto value = parse_json(field.default_json, source_file, text_faults);
      ASSERT_TRUE(value && text_faults.empty()) << field.key;
      RuleTable table = scene_rules();
      table.root = field.rule;
      std::vector<CheckFault> faults;
      check_rules(table, *value, faults);
      EXPECT_TRUE(faults.empty()) << field.key << ": " << field.default_json;
    }
  });
}

TEST(SceneSchema, every_named_rule_is_used) {
  std::set<const Rule*> seen;
  std::set<std::string_view> used = {"formula"};  // what may stand for any number
  visit_rules(*scene_rules().root, seen, [&](const Rule& rule) {
    if (rule.form == Form::named) used.insert(rule.target);
  });
  for (const auto& [name, rule] : scene_rules().named) EXPECT_EQ(used.count(name), 1u) << name;
}

}  // namespace
}  // namespace bough::io
