#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bough/io/read_scene.hpp"
#include "bough/io/schema_rule.hpp"
#include "bough/laws/formula.hpp"

namespace bough::io {
namespace {

using Json = nlohmann::ordered_json;

/// formulas: {"expression": ...} may stand for numbers.
Json to_schema(const Rule& rule, bool formulas);

Json number_of(double x) {
  return x == std::floor(x) && std::abs(x) < 1e15 ? Json(static_cast<long long>(x)) : Json(x);
}

void add_range(const Rule& rule, Json& out) {
  if (std::isfinite(rule.low)) out[rule.low_open ? "exclusiveMinimum" : "minimum"] = number_of(rule.low);
  if (std::isfinite(rule.high)) out["maximum"] = number_of(rule.high);
}

Json one_required(const std::vector<std::string>& keys) {
  Json list = Json::array();
  for (const std::string& k : keys) list.push_back(Json{{"required", Json::array({k})}});
  return list;
}

/// Schema of the names that formulas may use for numbers.
Json formula_name_schema() {
  return Json{
      {"pattern", "^[A-Za-z_][A-Za-z0-9_]*$"}, {"maxLength", 100}, {"not", Json{{"enum", laws::formula_words()}}}};
}

void add_object(const Rule& rule, Json& out, bool formulas) {
  out["type"] = "object";
  Json properties = Json::object(), required = Json::array();
  for (const Field& f : rule.fields) {
    Json p = to_schema(*f.rule, formulas);
    if (f.key == "kind" && !rule.kinds.empty()) p = Json{{"enum", rule.kinds}};
    // draft-07 ignores keys next to a $ref, so a reference with a description is wrapped
    if (p.contains("$ref")) p = Json{{"allOf", Json::array({p})}};
    const std::string own = p.value("description", "");
    p["description"] = std::string(f.about) + (own.empty() || own == f.about ? "" : " " + own);
    if (!f.default_json.empty()) p["default"] = Json::parse(f.default_json);
    properties[std::string(f.key)] = std::move(p);
    if (f.presence == Presence::required) required.push_back(f.key);
  }
  if (!properties.contains("comment")) properties["comment"] = Json{{"type", "string"}, {"description", "Free text."}};
  out["properties"] = std::move(properties);
  if (!rule.marker.empty() && std::find(required.begin(), required.end(), rule.marker) == required.end())
    required.push_back(rule.marker);
  if (!required.empty()) out["required"] = std::move(required);
  out["additionalProperties"] = rule.others == nullptr ? Json(false) : to_schema(*rule.others, formulas);
  if (rule.others != nullptr) out["propertyNames"] = formula_name_schema();
  Json all = Json::array();
  for (const auto& set : rule.exactly_one) all.push_back(Json{{"oneOf", one_required(set)}});
  for (const auto& set : rule.at_most_one) {
    Json pairs = Json::array();
    for (std::size_t i = 0; i < set.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) pairs.push_back(Json{{"required", Json::array({set[j], set[i]})}});
    all.push_back(Json{{"not", Json{{"anyOf", std::move(pairs)}}}});
  }
  if (!all.empty()) out["allOf"] = std::move(all);
}

Json to_schema(const Rule& rule, bool formulas) {
  if (rule.form == Form::named) return Json{{"$ref", "#/definitions/" + std::string(rule.target)}};
  Json out = Json::object();
  if (!rule.about.empty()) out["description"] = rule.about;
  switch (rule.form) {
    case Form::number:
    case Form::integer: {
      Json number = Json{{"type", rule.form == Form::number ? "number" : "integer"}};
      add_range(rule, number);
      if (formulas)
        out["anyOf"] = Json::array({std::move(number), Json{{"$ref", "#/definitions/formula"}}});
      else
        out.update(number);
      break;
    }
    case Form::boolean:
      out["type"] = "boolean";
      break;
    case Form::text:
      out["type"] = "string";
      break;
    case Form::name:
      out["type"] = "string";
      out["minLength"] = 1;
      out["maxLength"] = 100;
      out["pattern"] = "^[^./\\u0000-\\u001f\\u007f ]([^./\\u0000-\\u001f\\u007f]*[^./\\u0000-\\u001f\\u007f ])?$";
      out["not"] = Json{{"const", "ground"}};
      break;
    case Form::word:
      out["enum"] = rule.words;
      break;
    case Form::array:
      out["type"] = "array";
      out["items"] = to_schema(*rule.item, formulas);
      if (rule.min_items > 0) out["minItems"] = rule.min_items;
      if (rule.max_items != std::numeric_limits<std::size_t>::max()) out["maxItems"] = rule.max_items;
      break;
    case Form::object:
      add_object(rule, out, formulas);
      break;
    case Form::choice: {
      // In a choice that has formulas of its own, such as a law, a number must be a plain number: exactly one option
      // may fit.
      const bool has_own = std::any_of(rule.options.begin(), rule.options.end(),
                                       [](const RuleRef& option) { return option->marker == "expression"; });
      Json options = Json::array();
      for (const RuleRef& option : rule.options)
        options.push_back(to_schema(*option, formulas && !(has_own && option->form == Form::number)));
      out["oneOf"] = std::move(options);
      break;
    }
    case Form::named:
      break;
  }
  return out;
}

}  // namespace

std::string schema_text() { return schema_text_of(scene_rules(), "bough scene"); }

std::string schema_text_of(const RuleTable& table, const std::string& title) {
  Json out = Json::object();
  out["$schema"] = "http://json-schema.org/draft-07/schema#";
  out["title"] = title;
  const Json root = to_schema(*table.root, table.has_formulas);
  for (const auto& [key, value] : root.items()) out[key] = value;
  Json definitions = Json::object();
  for (const auto& [name, rule] : table.named) definitions[std::string(name)] = to_schema(*rule, table.has_formulas);
  out["definitions"] = std::move(definitions);
  return out.dump(2) + "\n";
}

}  // namespace bough::io
