#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <unordered_map>

#include "bough/io/read_scene.hpp"
#include "bough/io/schema_rule.hpp"
#include "bough/laws/formula.hpp"
#include "bough/laws/law_error.hpp"
#include "bough/scene/joint_efforts.hpp"
#include "bough/scene/nearest_name.hpp"
#include "json_path.hpp"
#include "sure_names.hpp"

namespace bough::io {
namespace {

std::string shown_number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

std::string quoted_list(const std::vector<std::string>& words) {
  std::string r;
  for (std::size_t i = 0; i < words.size(); ++i)
    r += (i == 0 ? "\"" : i + 1 == words.size() ? " or \"" : ", \"") + words[i] + "\"";
  return r;
}

/// A key or word of the format, none of which has characters that JSON escapes.
std::string json_word(const std::string& word) { return "\"" + word + "\""; }

std::string with_article(JsonKind kind) {
  switch (kind) {
    case JsonKind::null:
      return "null";
    case JsonKind::boolean:
      return "a truth value";
    case JsonKind::number:
      return "a number";
    case JsonKind::string:
      return "a string";
    case JsonKind::array:
      return "an array";
    case JsonKind::object:
      return "an object";
  }
  return "";
}

JsonKind json_kind(Form form) {
  switch (form) {
    case Form::number:
    case Form::integer:
      return JsonKind::number;
    case Form::boolean:
      return JsonKind::boolean;
    case Form::array:
      return JsonKind::array;
    case Form::object:
      return JsonKind::object;
    default:
      return JsonKind::string;
  }
}

using Path = JsonPath;

constexpr std::size_t most_faults =
    2 * max_problems;  // number of faults kept; further ones are counted, since a file may have millions

class Checker {
 public:
  Checker(const RuleTable& table, std::vector<CheckFault>& faults) : table_(table), faults_(faults) {}

  /// True if the value and everything in it obey their rules.
  bool check(const Rule& rule_in, JsonValue& value, const Path& path) {
    const Rule& rule = table_.resolve(rule_in);
    if (!value.sound) return false;  // already reported by the reader of the text
    if (rule.is_deferred) return true;
    value.sound = check_form(rule, value, path);
    return value.sound;
  }

  std::size_t num_faults() const { return num_faults_; }

 private:
  /// No more faults are shown, so that no hints need to be searched.
  bool is_hopeless() const { return faults_.size() > max_problems; }
  std::string suggestion(const std::string& word, const std::vector<std::string>& known) const {
    const std::string near = is_hopeless() ? "" : scene::nearest_name(word, known);
    return near.empty() ? "" : "did you mean \"" + near + "\"?";
  }

  std::string suggestion_of_kind(const std::string& word, const std::vector<std::string>& kinds) const {
    const std::string meant(scene::effort_kind_meant(word));
    const bool is_known = std::find(kinds.begin(), kinds.end(), meant) != kinds.end();
    return is_known ? "did you mean \"" + meant + "\"?" : suggestion(word, kinds);
  }

  /// Tells of a word that is none of those that it has to be. True if it can only have been meant to be one of them,
  /// which it is from then on.
  bool fail_word(JsonValue& value, const Path& path, const std::vector<std::string>& words, std::string hint) {
    std::string meant =
        is_hopeless() || value.is_made || !value.is(JsonKind::string) ? "" : only_word(value.text.str(), words);
    fail(value, path, "has to be " + quoted_list(words), std::move(hint), false, meant.empty() ? "" : json_word(meant));
    if (meant.empty()) return false;
    value.text = std::move(meant);
    return true;
  }

  /// Tells of a value of another type. True if it is a number in quotes, which it is no longer from then on.
  bool fail_type(const Rule& rule, JsonValue& value, const Path& path) {
    const bool is_number = json_kind(rule.form) == JsonKind::number && value.is(JsonKind::string) && !value.is_made &&
                           is_number_text(value.text);
    fail(value, path, "has to be " + wanted(rule) + ", not " + with_article(value.kind), type_hint(rule, value), false,
         is_number ? value.text.str() : std::string());
    if (!is_number) return false;
    value.number = std::strtod(value.text.str().c_str(), nullptr);
    value.kind = JsonKind::number;
    return std::isfinite(value.number);
  }

  bool fail(const JsonValue& value, const Path& path, std::string rule, std::string hint = {}, bool at_key = false,
            std::string meant = {}) {
    const std::uint32_t offset = at_key ? value.key_offset : value.offset;
    const std::uint32_t length = at_key ? 0 : value.length;  // 0: one token
    if (value.is_copy && is_of_another_copy(value.source, offset, rule)) return false;
    if (faults_.size() < most_faults)
      faults_.push_back(
          {value.source, offset, length, path.text(), std::move(rule), std::move(hint), 0, std::move(meant)});
    ++num_faults_;
    return false;
  }

  /// True if the same fault was reported for another copy of the same text, which then counts this one. A fault in a
  /// thousand copies is one fault.
  bool is_of_another_copy(int source, std::uint32_t offset, const std::string& rule) {
    const std::string key = std::to_string(source) + " " + std::to_string(offset) + " " + rule;
    const auto [at, is_new] = of_copies_.try_emplace(key, faults_.size());
    if (is_new) return false;
    if (at->second < faults_.size()) ++faults_[at->second].other_copies;
    return true;
  }

  bool check_form(const Rule& rule, JsonValue& value, const Path& path) {
    if (value.is(JsonKind::null))
      return fail(value, path, "null is not a value here", "leave the key out where nothing is meant");
    if (rule.form == Form::choice) return check_choice(rule, value, path);
    if (table_.has_formulas && json_kind(rule.form) == JsonKind::number && value.find_given("expression") != nullptr &&
        !evaluate(value, path))
      return false;
    if (!value.is(json_kind(rule.form)) && !fail_type(rule, value, path)) return false;
    switch (rule.form) {
      case Form::number:
      case Form::integer:
        return check_number(rule, value, path);
      case Form::name: {
        const std::string fault = name_fault(value.text);
        return fault.empty() || fail(value, path, fault);
      }
      case Form::word:
        if (std::find(rule.words.begin(), rule.words.end(), value.text) != rule.words.end()) return true;
        return fail_word(value, path, rule.words, suggestion(value.text, rule.words));
      case Form::array:
        return check_array(rule, value, path);
      case Form::object:
        return check_object(rule, value, path);
      default:
        return true;
    }
  }

  /// Replaces a formula by its value.
  bool evaluate(JsonValue& value, const Path& path) {
    if (!check_object(*table_.named.at("formula"), value, path)) return false;
    const JsonValue& formula = *value.find_given("expression");
    const Path at = path.member("expression");
    double x = 0.0;
    try {
      x = laws::eval_constant(formula.text);
    } catch (const laws::LawError& e) {
      const std::string& text = formula.text;
      return fail(formula, at, e.what(), "at " + shown_in_quotes(text.substr(std::min(e.position, text.size())), 20));
    }
    if (!std::isfinite(x)) return fail(formula, at, "gives " + shown_number(x) + ", and numbers are finite");
    value.kind = JsonKind::number;
    value.number = x;
    value.items = {};
    value.is_made = true;
    return true;
  }

  static std::string type_hint(const Rule& rule, const JsonValue& value) {
    if (json_kind(rule.form) == JsonKind::number && value.find("signal") != nullptr)
      return "this number is constant; signals may stand in drives and prescribed motions, efforts of joints (a strut "
             "acts between two points), factors of loads and of gravity, rest_law of springs, and stiffness_factor of "
             "springs and bushings";
    if (json_kind(rule.form) == JsonKind::number && value.is(JsonKind::string))
      return "write numbers without quotes, in SI units";
    if (rule.form == Form::array && value.is(JsonKind::object)) return "put it in brackets: [ ... ]";
    return "";
  }

  /// Describes the values that a rule allows.
  std::string wanted(const Rule& rule_in) const {
    const Rule& rule = table_.resolve(rule_in);
    switch (rule.form) {
      case Form::number:
        return "a number" + range(rule);
      case Form::integer:
        return "a whole number" + range(rule);
      case Form::boolean:
        return "true or false";
      case Form::text:
        return "a string";
      case Form::name:
        return "a name";
      case Form::word:
        return quoted_list(rule.words);
      case Form::array: {
        const Rule& item = table_.resolve(*rule.item);
        const std::string what = item.form == Form::number ? "numbers" : item.form == Form::array ? "arrays" : "items";
        return "an array of " + (rule.min_items == rule.max_items ? std::to_string(rule.min_items) + " " : "") + what;
      }
      case Form::object:
        return !rule.kinds.empty()   ? "an object of kind " + quoted_list(rule.kinds)
               : rule.marker.empty() ? "an object"
                                     : "an object with \"" + std::string(rule.marker) + "\"";
      case Form::choice: {
        std::string r;
        for (std::size_t i = 0; i < rule.options.size(); ++i)
          r += (i == 0 ? "" : i + 1 == rule.options.size() ? " or " : ", ") + wanted(*rule.options[i]);
        return r;
      }
      case Form::named:
        break;
    }
    return "";
  }

  static std::string range(const Rule& rule) {
    std::string r;
    if (std::isfinite(rule.low)) r += (rule.low_open ? " above " : " of at least ") + shown_number(rule.low);
    if (std::isfinite(rule.high)) r += std::string(r.empty() ? "" : " and") + " of at most " + shown_number(rule.high);
    return r;
  }

  bool check_number(const Rule& rule, JsonValue& value, const Path& path) {
    // A formula for a count may have round-off, as 0.3 / 0.1 does; values farther from a whole number are faults.
    if (rule.form == Form::integer && value.is_made && std::abs(value.number - std::round(value.number)) <= 1e-9)
      value.number = std::round(value.number);
    const double x = value.number;
    const bool is_whole = rule.form == Form::number || x == std::floor(x);
    if (is_whole && (rule.low_open ? x > rule.low : x >= rule.low) && x <= rule.high) return true;
    return fail(value, path, "has to be " + wanted(rule));
  }

  bool check_array(const Rule& rule, JsonValue& value, const Path& path) {
    bool sound = true;
    const std::size_t n = value.items.size();
    if (n < rule.min_items || n > rule.max_items) {
      const std::string count = rule.min_items == rule.max_items ? std::to_string(rule.min_items)
                                : n < rule.min_items             ? "at least " + std::to_string(rule.min_items)
                                                                 : "at most " + std::to_string(rule.max_items);
      sound = fail(value, path, "has " + std::to_string(n) + " items and needs " + count);
    }
    for (std::size_t i = 0; i < n; ++i) sound = check(*rule.item, value.items[i], path.at(i)) && sound;
    return sound;
  }

  bool check_object(const Rule& rule, JsonValue& value, const Path& path) {
    bool sound = true;
    std::vector<std::string> missing, meant, free_keys;  // free_keys: known ones that the object does not have
    for (const Field& field : rule.fields)
      if (field.presence == Presence::required && value.find(field.key) == nullptr) missing.emplace_back(field.key);
    for (std::size_t i = 0; i < value.items.size(); ++i) {
      const std::string& key = value.items.key(i);
      const Field* field = field_of(rule, key);
      const Path at = path.member(key);
      if (key == "comment" && field == nullptr) {
        if (!value.items[i].is(JsonKind::string)) sound = fail(value.items[i], at, "a comment has to be a string");
      } else if (field != nullptr) {
        sound = check(*field->rule, value.items[i], at) && sound;
      } else if (rule.others != nullptr) {
        sound = check(*rule.others, value.items[i], at) && sound;
      } else {
        if (meant.empty())  // once: for each of many unknown keys it would take quadratic time
          for (const Field& f : rule.fields)
            if (value.find(f.key) == nullptr) free_keys.emplace_back(f.key);
        meant.push_back(unknown_key(rule, value, i, at, free_keys));
        std::erase(missing, meant.back());
        const Field* renamed = field_of(rule, value.items.key(i));  // nullptr: nobody knows what was meant
        if (renamed == nullptr) value.items[i].sound = false;
        sound = renamed != nullptr && check(*renamed->rule, value.items[i], path.member(renamed->key)) && sound;
      }
    }
    for (const std::string& key : missing) sound = fail(value, path, "needs the key \"" + key + "\"", about(rule, key));
    sound = check_sets(rule, value, path, meant) && sound;
    if (const JsonValue& defaults = table_.defaults_of(rule); !defaults.items.empty())
      value.items.set_defaults(&defaults);
    return sound;
  }

  static const Field* field_of(const Rule& rule, const std::string& key) {
    const auto at = std::find_if(rule.fields.begin(), rule.fields.end(), [&](const Field& f) { return f.key == key; });
    return at == rule.fields.end() ? nullptr : &*at;
  }

  /// Reports a key that is not known; returns the one that was probably meant, which is then not reported as missing.
  /// One that can only have been meant is the name of the member from then on.
  std::string unknown_key(const Rule& rule, JsonValue& value, std::size_t i, const Path& at,
                          const std::vector<std::string>& free_keys) {
    if (is_hopeless()) {  // the key is not shown; a search for similar keys would take quadratic time in total
      fail(value.items[i], at, "this key is not known here", {}, true);
      return {};
    }
    std::vector<std::string> known;
    for (const Field& field : rule.fields) known.emplace_back(field.key);
    std::string near = scene::nearest_name(value.items.key(i), free_keys);
    if (near.empty()) near = scene::nearest_name(value.items.key(i), known);
    std::string hint = near.empty() ? "known keys: " + quoted_list(known) : "did you mean \"" + near + "\"?";
    const bool is_expanded_before = near == "repeat" || near == "parameters";  // of a misspelt one nothing was made
    const bool is_sure = !near.empty() && !is_expanded_before && value.find_given(near) == nullptr &&
                         only_word(value.items.key(i), known) == near;
    fail(value.items[i], at, "this key is not known here", std::move(hint), true, is_sure ? json_word(near) : "");
    if (is_sure) value.items.rename(i, near);
    return near;
  }

  static std::string about(const Rule& rule, const std::string& key) {
    for (const Field& f : rule.fields)
      if (f.key == key) return std::string(f.about);
    return "";
  }

  bool check_sets(const Rule& rule, const JsonValue& value, const Path& path, const std::vector<std::string>& meant) {
    bool sound = true;
    const auto count = [&](const std::vector<std::string>& set) {
      return std::count_if(set.begin(), set.end(), [&](const std::string& k) {
        return value.find(k) != nullptr || std::find(meant.begin(), meant.end(), k) != meant.end();
      });
    };
    for (const auto& set : rule.exactly_one)
      if (count(set) != 1) sound = fail(value, path, "needs exactly one of the keys " + quoted_list(set));
    for (const auto& set : rule.at_most_one)
      if (count(set) > 1) sound = fail(value, path, "takes only one of the keys " + quoted_list(set));
    return sound;
  }

  /// Selects an alternative by the JSON type, then for objects by "kind" or a marker key, then for arrays by their
  /// items.
  bool check_choice(const Rule& rule, JsonValue& value, const Path& path) {
    std::vector<const Rule*> fitting;
    flatten(rule, value.kind, fitting);
    if (fitting.empty() && value.find_given("expression") != nullptr) flatten(rule, JsonKind::number, fitting);
    if (fitting.empty()) return fail(value, path, "has to be " + wanted(rule) + ", not " + with_article(value.kind));
    if (fitting.size() == 1) return check(*fitting.front(), value, path);
    if (value.is(JsonKind::object)) return check_object_choice(fitting, value, path);
    if (value.is(JsonKind::array)) {
      const bool holds_arrays = !value.items.empty() && value.items.front().is(JsonKind::array);
      for (const Rule* option : fitting)
        if ((table_.resolve(*option->item).form == Form::array) == holds_arrays) return check(*option, value, path);
    }
    return check(*fitting.front(), value, path);
  }

  void flatten(const Rule& rule, JsonKind kind, std::vector<const Rule*>& out) const {
    for (const RuleRef& option : rule.options) {
      const Rule& r = table_.resolve(*option);
      if (r.form == Form::choice)
        flatten(r, kind, out);
      else if (json_kind(r.form) == kind)
        out.push_back(&r);
    }
  }

  bool check_object_choice(const std::vector<const Rule*>& options, JsonValue& value, const Path& path) {
    for (const Rule* option : options)
      if (!option->marker.empty() && value.find(option->marker) != nullptr) return check(*option, value, path);
    JsonValue* kind = value.find_given("kind");
    if (kind != nullptr && kind->is(JsonKind::string))
      for (const Rule* option : options)
        if (std::find(option->kinds.begin(), option->kinds.end(), kind->text) != option->kinds.end())
          return check(*option, value, path);
    return no_choice(options, value, path);
  }

  /// Reports what is wrong with an object that fits no alternative.
  bool no_choice(const std::vector<const Rule*>& options, JsonValue& value, const Path& path) {
    std::vector<std::string> kinds, markers, keys;
    for (const Rule* option : options) {
      kinds.insert(kinds.end(), option->kinds.begin(), option->kinds.end());
      if (!option->marker.empty()) markers.emplace_back(option->marker);
      for (const Field& f : option->fields) keys.emplace_back(f.key);
    }
    if (JsonValue* kind = value.find_given("kind"); kind != nullptr && !kinds.empty())
      return fail_word(*kind, path.member("kind"), kinds,
                       kind->is(JsonKind::string) ? suggestion_of_kind(kind->text, kinds) : "") &&
             check_object_choice(options, value, path);
    if (const JsonValue* name = value.find_given("signal"); name != nullptr && name->is(JsonKind::string)) {
      if (path.text().rfind("/frames/", 0) == 0)
        return fail(value, path,
                    "has to be a law of time here: parts are placed in a frame before any signal is known, and forces "
                    "on a frame have no equation of motion",
                    "let the signal prescribe the motion of a node (motions), and join parts to that");
      return fail(
          value, path, "has to be a law of time here: signals are known only together with the motion",
          "they may stand in drives and prescribed motions, efforts of joints and factors of loads; in the place "
          "of a law with parts, a signal of kind \"formula\"");
    }
    std::string needed = kinds.empty() ? "" : "the key \"kind\" (" + quoted_list(kinds) + ")";
    if (!markers.empty())
      needed += (needed.empty() ? "" : ", or ") + std::string("one of the keys ") + quoted_list(markers);
    if (!kinds.empty()) keys.push_back("kind");
    std::vector<std::string> telling = markers;
    if (!kinds.empty()) telling.push_back("kind");
    for (std::size_t i = 0; i < value.items.size(); ++i) {
      const std::string& key = value.items.key(i);
      if (key == "comment" || std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
      std::string hint = suggestion(key, telling);
      if (hint.empty()) hint = suggestion(key, keys);
      return fail(value.items[i], path.member(key), "this key is not known here; the object needs " + needed,
                  std::move(hint), true);
    }
    return fail(value, path, "needs " + needed);
  }

  const RuleTable& table_;
  std::vector<CheckFault>& faults_;
  std::size_t num_faults_ = 0;
  std::unordered_map<std::string, std::size_t> of_copies_;  ///< place and rule of a fault in copies -> its index
};

}  // namespace

const JsonValue& RuleTable::defaults_of(const Rule& rule) const {
  const std::lock_guard<std::recursive_mutex> lock(defaults_->mutex);
  const auto [at, is_new] = defaults_->of_rule.try_emplace(&rule);
  JsonValue& defaults = at->second;
  if (!is_new) return defaults;
  defaults.kind = JsonKind::object;
  std::vector<CheckFault> none;
  for (const Field& field : rule.fields) {
    if (field.default_json.empty()) continue;
    std::vector<JsonFault> no_faults;
    JsonValue& made = defaults.items.add(std::string(field.key)) =
        *parse_json(field.default_json, source_default, no_faults);
    Checker(*this, none).check(*field.rule, made, {});  // gives it the defaults inside the default
  }
  return defaults;
}

std::size_t check_rules(const RuleTable& table, JsonValue& root, std::vector<CheckFault>& faults) {
  return check_rules(table, *table.root, root, "", faults);
}

std::size_t check_rules(const RuleTable& table, const Rule& rule, JsonValue& value, std::string_view pointer,
                        std::vector<CheckFault>& faults) {
  Checker checker(table, faults);
  checker.check(rule, value, {nullptr, pointer, 0});
  return checker.num_faults() - std::min(checker.num_faults(), faults.size());
}

}  // namespace bough::io
