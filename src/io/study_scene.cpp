#include "study_scene.hpp"

#include <algorithm>

#include "bough/io/json_text.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/read_study.hpp"
#include "bough/io/schema_rule.hpp"
#include "expand_scene.hpp"
#include "read_scene_impl.hpp"

namespace bough::io {
namespace {

/// True if `inner` names the same value as `outer` or a value within it.
bool is_within(const std::string& inner, const std::string& outer) {
  return inner.size() >= outer.size() && inner.compare(0, outer.size(), outer) == 0 &&
         (inner.size() == outer.size() || inner[outer.size()] == '/');
}

void append_canonical(std::string& out, const JsonValue& v) {
  switch (v.kind) {
    case JsonKind::null:
      out += "null";
      return;
    case JsonKind::boolean:
      out += v.truth ? "true" : "false";
      return;
    case JsonKind::number:
      append_number(out, v.number);
      return;
    case JsonKind::string:
      out += json_string(v.text.str());
      return;
    case JsonKind::array:
      out += '[';
      for (std::size_t i = 0; i < v.items.size(); ++i) {
        if (i > 0) out += ',';
        append_canonical(out, v.items[i]);
      }
      out += ']';
      return;
    case JsonKind::object:
      break;
  }
  std::vector<std::pair<std::string_view, const JsonValue*>> members;
  const auto gather = [&members](const JsonValue& from) {
    for (std::size_t i = 0; i < from.items.size(); ++i)
      if (from.items.key(i) != "comment") members.emplace_back(from.items.key(i), &from.items[i]);
  };
  gather(v);
  if (const JsonValue* defaults = v.items.defaults()) gather(*defaults);
  std::stable_sort(members.begin(), members.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const auto same_key = [](const auto& a, const auto& b) { return a.first == b.first; };  // given keys come before
                                                                                          // defaults
  members.erase(std::unique(members.begin(), members.end(), same_key), members.end());
  out += '{';
  for (const auto& [key, value] : members) {
    if (out.back() != '{') out += ',';
    out += json_string(std::string(key)) + ":";
    append_canonical(out, *value);
  }
  out += '}';
}

}  // namespace

std::vector<std::string> StudyScene::expand(const std::string& pointer, const std::string& value) {
  const auto tokens = split_pointer(pointer);
  if (!tokens || tokens->empty()) return {pointer + "=" + value};  // the reader of overrides reports the fault
  if (!root_) {
    std::vector<JsonFault> faults;
    root_ = parse_json(text_, source_file, faults);
  }
  std::vector<std::string> pointers;
  expand_tokens(root_ ? &*root_ : nullptr, *tokens, 0, "", pointers);
  for (std::string& p : pointers) p += "=" + value;
  return pointers;
}

void StudyScene::expand_tokens(const JsonValue* at, const std::vector<std::string>& tokens, std::size_t k,
                               std::string so_far, std::vector<std::string>& pointers) const {
  if (k == tokens.size()) {
    pointers.push_back(std::move(so_far));
    return;
  }
  if (tokens[k] != "*") {
    const JsonValue* next = at != nullptr && at->is(JsonKind::object) ? at->find(tokens[k]) : nullptr;
    expand_tokens(next, tokens, k + 1, pointer_to(so_far, tokens[k]), pointers);
    return;
  }
  if (at == nullptr || !at->is(JsonKind::array)) return;
  for (std::size_t i = 0; i < at->items.size(); ++i)
    expand_tokens(&at->items[i], tokens, k + 1, pointer_to(so_far, std::to_string(i)), pointers);
}

std::optional<scene::Scene> StudyScene::read(const std::vector<std::string>& overrides,
                                             const std::vector<SettingOrigin>& origins, const std::string& otherwise,
                                             PlacedFaults& faults) {
  SceneFile file = read_scene_text(text_, name_, overrides, folder_);
  if (file.ok()) return std::move(file.scene);
  for (const Problem& problem : file.problems) {
    const SettingOrigin* origin = nullptr;
    for (const SettingOrigin& o : origins)
      if (is_within(problem.pointer, o.scene_pointer) &&
          (origin == nullptr || o.scene_pointer.size() >= origin->scene_pointer.size()))
        origin = &o;
    const std::string at = origin == nullptr ? otherwise : origin->spec_pointer;
    if (!said_.insert(at + "\n" + problem.pointer + "\n" + problem.rule).second) continue;
    const bool is_copied = origin != nullptr && origin->scene_pointer == origin->spec_pointer;
    faults.push_back({is_copied ? problem.pointer : at, "",
                      is_copied ? problem.rule : "the scene is at fault with it: " + problem.text(),
                      is_copied ? problem.hint : ""});
  }
  return std::nullopt;
}

std::string canonical_text(std::string_view text) {
  std::vector<JsonFault> faults;
  const std::optional<JsonValue> root = parse_json(text, source_file, faults);
  if (!root || !faults.empty()) return std::string(text);
  std::string out;
  append_canonical(out, *root);
  return out;
}

std::string canonical_scene(std::string_view text, std::span<const std::string> overrides) {
  std::vector<JsonFault> text_faults;
  std::optional<JsonValue> root = parse_json(text, source_file, text_faults);
  if (!root || !text_faults.empty()) return {};
  std::vector<std::string> texts;
  std::vector<PlacedFault> override_faults;
  std::vector<CheckFault> check_faults;
  apply_overrides(*root, overrides, texts, override_faults);
  const Expansion expansion = expand_scene(*root);
  check_rules(scene_rules(), *root, check_faults);
  if (!override_faults.empty() || !expansion.faults.empty() || !expansion.has_outline || !check_faults.empty())
    return {};
  std::string out;
  append_canonical(out, *root);
  return out;
}

}  // namespace bough::io
