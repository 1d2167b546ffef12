#include "bough/io/schema_words.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "bough/io/number_text.hpp"
#include "bough/io/schema_rule.hpp"
#include "kinematics_rules.hpp"
#include "study_rules.hpp"
#include "sweep_rules.hpp"

namespace bough::io {
namespace {

using VisitWord = std::function<void(const std::string& word, SchemaEntry entry)>;

/// Walks over a table of rules and tells each key and each value with its place. A named rule that stands in several
/// places is walked once, under its name.
class WordWalk {
 public:
  WordWalk(const RuleTable& table, std::string format, const VisitWord& visit)
      : table_(table), format_(std::move(format)), visit_(visit) {}

  void walk() {
    walk(*table_.root, "");
    for (const auto& [name, rule] : table_.named)
      if (seen_.insert(std::string(name)).second) walk(*rule, std::string(name));
  }

 private:
  /// about: what the key says for which the rule stands.
  void walk(const Rule& rule, const std::string& place, const std::string& about = {}) {
    switch (rule.form) {
      case Form::named:
        if (is_list_item(place) && seen_.insert(std::string(rule.target)).second) walk(table_.resolve(rule), place);
        return;
      case Form::array:
        return walk(*rule.item, place + "[]");
      case Form::choice:
        for (const RuleRef& option : rule.options) walk(*option, place);
        return;
      case Form::word:
        for (const std::string& word : rule.words)
          visit_(word, {format_, place, "", rule.about.empty() ? about : part_about(rule, word)});
        return;
      case Form::object:
        return walk_object(rule, place);
      default:
        return;
    }
  }

  /// "joints[]": places by which users know a rule better than by its name.
  static bool is_list_item(const std::string& place) {
    return place.ends_with("[]") && place.find('.') == std::string::npos;
  }

  void walk_object(const Rule& rule, const std::string& place) {
    std::string keys;
    for (const Field& f : rule.fields)
      if (f.key != "kind" && f.key != "name") keys += (keys.empty() ? "" : ", ") + std::string(f.key);
    for (const std::string& kind : rule.kinds)
      visit_(kind, {format_, place.empty() ? "kind" : place + ".kind", keys.empty() ? "" : "with " + keys,
                    std::string(rule.about)});
    for (const Field& f : rule.fields) {
      const std::string at = place.empty() ? std::string(f.key) : place + "." + std::string(f.key);
      std::string value = value_words(*f.rule);
      if (f.presence == Presence::required)
        value += ", required";
      else if (!f.default_json.empty())
        value += ", default " + std::string(f.default_json);
      const std::string own(table_.resolve(*f.rule).about);
      std::string about(f.about);
      if (f.rule->form != Form::word && !own.empty() && own != about) about += (about.empty() ? "" : " ") + own;
      visit_(std::string(f.key), {format_, at, std::move(value), std::move(about)});
      if (f.key != "kind" || rule.kinds.empty()) walk(*f.rule, at, std::string(f.about));
    }
  }

  /// Of a text that describes words one after the other, "ball: ... hinge: ...", the part of one of them.
  static std::string part_about(const Rule& rule, const std::string& word) {
    const std::string about(rule.about);
    const std::size_t at = about.starts_with(word + ": ") ? 0 : about.find(" " + word + ": ");
    if (at == std::string::npos) return about;
    const std::size_t begin = about.find(": ", at) + 2;
    std::size_t end = about.size();
    for (const std::string& other : rule.words)
      if (const std::size_t next = about.find(" " + other + ": ", begin); next != std::string::npos)
        end = std::min(end, next);
    return about.substr(begin, end - begin);
  }

  std::string value_words(const Rule& rule) const {
    switch (rule.form) {
      case Form::number:
        return "number" + range_words(rule);
      case Form::integer:
        return "whole number" + range_words(rule);
      case Form::boolean:
        return "true or false";
      case Form::text:
        return "text";
      case Form::name:
        return "name";
      case Form::word:
        return join(rule.words);
      case Form::array: {
        const std::string count = rule.min_items == rule.max_items ? std::to_string(rule.min_items) + " x " : "";
        return "list of " + count + value_words(*rule.item);
      }
      case Form::object:
        return !rule.kinds.empty()   ? "object of kind " + join(rule.kinds)
               : rule.marker.empty() ? "object"
                                     : "object with \"" + std::string(rule.marker) + "\"";
      case Form::choice: {
        std::string text;
        for (const RuleRef& option : rule.options) text += (text.empty() ? "" : " or ") + value_words(*option);
        return text;
      }
      case Form::named:
        return std::string(rule.target);
    }
    return "";
  }

  static std::string range_words(const Rule& rule) {
    std::string text;
    if (std::isfinite(rule.low)) text += (rule.low_open ? " > " : " >= ") + rounded_text(rule.low, 6);
    if (std::isfinite(rule.high)) text += (text.empty() ? " <= " : ", <= ") + rounded_text(rule.high, 6);
    return text;
  }

  static std::string join(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "\"" : ", \"") + word + "\"";
    return text;
  }

  const RuleTable& table_;
  std::string format_;
  const VisitWord& visit_;
  std::set<std::string> seen_;
};

void visit_schemas(const VisitWord& visit) {
  WordWalk(scene_rules(), "scene", visit).walk();
  WordWalk(sweep_rules(), "sweep", visit).walk();
  WordWalk(study_rules(), "study", visit).walk();
  WordWalk(frame_rules(), "chain of frames", visit).walk();
  WordWalk(motion_rules(), "motion", visit).walk();
}

/// "/bodies/0/kind" and "bodies[].kind" give "bodies[].kind".
std::string place_of(std::string_view text) {
  std::string place;
  for (std::size_t begin = text.starts_with('/') ? 1 : 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('/', begin), text.size());
    const std::string_view part = text.substr(begin, end - begin);
    if (!part.empty() && part.find_first_not_of("0123456789") == std::string_view::npos)
      place += "[]";
    else
      place += (place.empty() ? "" : ".") + std::string(part);
    begin = end + 1;
  }
  return place;
}

}  // namespace

std::vector<SchemaEntry> schema_entries(std::string_view word) {
  std::vector<SchemaEntry> entries;
  visit_schemas([&](const std::string& key, SchemaEntry entry) {
    // Sweeps and studies take parts of scenes, which are not told twice.
    const auto same = [&](const SchemaEntry& e) {
      return (e.place == entry.place || e.format != entry.format) && e.value == entry.value && e.about == entry.about;
    };
    if (key == word && std::none_of(entries.begin(), entries.end(), same)) entries.push_back(std::move(entry));
  });
  if (!entries.empty() || word.find_first_of("/.[") == std::string_view::npos) return entries;
  const std::string place = place_of(word);
  visit_schemas([&](const std::string&, SchemaEntry entry) {
    const auto same = [&](const SchemaEntry& e) { return e.format == entry.format && e.about == entry.about; };
    if (entry.place == place && std::none_of(entries.begin(), entries.end(), same)) entries.push_back(std::move(entry));
  });
  return entries;
}

std::vector<std::string> schema_words() {
  std::set<std::string> words;
  visit_schemas([&](const std::string& key, const SchemaEntry&) { words.insert(key); });
  return {words.begin(), words.end()};
}

}  // namespace bough::io
