#include <algorithm>
#include <charconv>

#include "bough/scene/nearest_name.hpp"
#include "read_scene_impl.hpp"

namespace bough::io {
namespace {

constexpr std::size_t most_overrides = 10'000;  // each is a source text of its own

/// A bare word is a string; everything else is JSON.
std::optional<JsonValue> parse_value(const std::string& text, std::int16_t source, std::string& rule) {
  const bool is_word = !text.empty() &&
                       (std::isalpha(static_cast<unsigned char>(text.front())) != 0 || text.front() == '_') &&
                       text != "true" && text != "false" && text != "null";
  if (is_word) {
    JsonValue v;
    v.kind = JsonKind::string;
    v.text = text;
    v.source = source;
    v.length = static_cast<std::uint32_t>(text.size());
    return v;
  }
  std::vector<JsonFault> faults;
  std::optional<JsonValue> v = parse_json(text, source, faults);
  if (faults.empty()) return v;
  rule = "the value of this override " + faults.front().rule;
  return std::nullopt;
}

/// The item of an array by its number or by the name of the object in it.
JsonValue* item_of(JsonValue& array, const std::string& token) {
  std::size_t i = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), i);
  if (error == std::errc() && end == token.data() + token.size())
    return i < array.items.size() ? &array.items[i] : nullptr;
  for (JsonValue& item : array.items)
    if (const JsonValue* name = item.is(JsonKind::object) ? item.find("name") : nullptr;
        name != nullptr && name->text == token)
      return &item;
  return nullptr;
}

std::string hint_for(const JsonValue& at, const std::string& token) {
  std::vector<std::string> known;
  for (std::size_t i = 0; at.is(JsonKind::object) && i < at.items.size(); ++i) known.push_back(at.items.key(i));
  for (const JsonValue& item : at.items)
    if (const JsonValue* name = item.is(JsonKind::object) ? item.find("name") : nullptr;
        name != nullptr && at.is(JsonKind::array))
      known.push_back(name->text);
  const std::string near = scene::nearest_name(token, known);
  return near.empty() ? "" : "did you mean \"" + near + "\"?";
}

void apply_one(JsonValue& root, const std::string& text, std::int16_t source, std::string& value_text,
               std::vector<PlacedFault>& faults) {
  const std::size_t equals = text.find('=');
  const std::string pointer = text.substr(0, equals);
  const auto tokens = split_pointer(pointer);
  if (equals == std::string::npos || !tokens || tokens->empty() || tokens->size() >= max_json_depth) {
    faults.push_back({"", text, "an override reads /pointer=value", "for instance /analysis/step_size=1e-3"});
    return;
  }
  value_text = text.substr(equals + 1);
  std::string rule;
  std::optional<JsonValue> value = parse_value(value_text, source, rule);
  if (!value) {
    faults.push_back({pointer, value_text, rule, ""});
    return;
  }
  JsonValue* at = &root;
  for (std::size_t i = 0; i < tokens->size(); ++i) {
    const std::string& token = (*tokens)[i];
    JsonValue* next = at->is(JsonKind::array)    ? item_of(*at, token)
                      : at->is(JsonKind::object) ? at->find_given(token)
                                                 : nullptr;
    const bool is_parameter = tokens->size() == 2 && i == 1 && tokens->front() == "parameters";
    if (next == nullptr && is_parameter && at->is(JsonKind::object)) {  // a parameter that no formula uses would have
                                                                        // no effect
      faults.push_back({pointer, token, "the scene has no parameter of this name", hint_for(*at, token)});
      return;
    }
    if (next == nullptr && at->is(JsonKind::object)) {
      JsonValue made;
      made.kind = JsonKind::object;
      made.source = source;
      made.length = static_cast<std::uint32_t>(value_text.size());
      next = &(at->items.add(token) = std::move(made));
    }
    if (next == nullptr) {
      faults.push_back({pointer, token,
                        at->is(JsonKind::array) ? "the array has no such item" : "there is nothing inside this value",
                        hint_for(*at, token)});
      return;
    }
    at = next;
  }
  const std::uint32_t key_offset = at->key_offset;
  *at = std::move(*value);
  at->key_offset = key_offset;
}

}  // namespace

void apply_overrides(JsonValue& root, std::span<const std::string> overrides, std::vector<std::string>& texts,
                     std::vector<PlacedFault>& faults) {
  texts.assign(overrides.size(), "");
  if (overrides.size() > most_overrides) {
    faults.push_back({"", std::to_string(overrides.size()),
                      "at most " + std::to_string(most_overrides) + " overrides are taken",
                      "write them into the file"});
    return;
  }
  for (std::size_t i = 0; i < overrides.size(); ++i)
    apply_one(root, overrides[i], static_cast<std::int16_t>(i + 1), texts[i], faults);
}

}  // namespace bough::io
