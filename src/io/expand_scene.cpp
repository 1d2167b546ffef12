#include "expand_scene.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "bough/io/number_text.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/schema_rule.hpp"
#include "json_path.hpp"
#include "named_numbers.hpp"
#include "read_parameters.hpp"
#include "schema_parts.hpp"

namespace bough::io {
namespace {

constexpr std::size_t most_faults = 2 * max_problems;

/// A repeated part, with the totals of its copies.
struct Group {
  std::string pointer, index;
  const JsonValue *count = nullptr, *first = nullptr;
  std::uint32_t index_id = 0;
  struct Template {
    std::string list, pointer;
    const JsonValue* value;
    std::uint32_t id;
  };
  std::vector<Template> templates;
  std::vector<Group> nested;
  std::size_t num_values = 0, num_bytes = 0;  ///< of one copy, without nested copies
};

std::size_t count_values(const JsonValue& v) {
  std::size_t count = 1;
  for (const JsonValue& item : v.items) count += count_values(item);
  return count;
}

void remove_member(JsonValue& object, std::string_view name) {
  JsonItems left;
  for (std::size_t i = 0; i < object.items.size(); ++i)
    if (object.items.key(i) != name) left.add(object.items.key(i)) = std::move(object.items[i]);
  object.items = std::move(left);
}

class Expander {
 public:
  explicit Expander(JsonValue& root) : root_(root) {}

  Expansion run() {
    std::optional<JsonValue> parameters = taken("parameters"), repeat = taken("repeat");
    if (parameters) read(*parameters);
    apply_to_file();
    if (repeat) make_copies(*repeat);
    if (parameters) warn_of_unused(*parameters);
    return std::move(result_);
  }

 private:
  std::optional<JsonValue> taken(const char* name) {
    JsonValue* at = root_.find_given(name);
    if (at == nullptr) return std::nullopt;
    JsonValue value = std::move(*at);
    remove_member(root_, name);
    return value;
  }

  void read(const JsonValue& parameters) {
    const TellFault tell = [this](const JsonValue& at, const std::string& pointer, std::string rule, std::string hint,
                                  bool at_key) {
      add({at.source, at_key ? at.key_offset : at.offset, at_key ? 0 : at.length, pointer, std::move(rule),
           std::move(hint), "", 0});
    };
    if (parameters.is(JsonKind::object)) return read_parameters(parameters, names_, tell);
    tell(parameters, "/parameters", "has to be an object", "as in \"parameters\": {\"L\": 2}", false);
    result_.has_outline = false;
  }

  void warn_of_unused(const JsonValue& parameters) {
    for (std::size_t i = 0; i < parameters.items.size() && result_.warnings.size() < most_faults; ++i) {
      const JsonValue& v = parameters.items[i];
      const std::string& name = parameters.items.key(i);
      if (names_.holds(name) && !names_.is_used(name) && result_.has_outline)
        result_.warnings.push_back({v.source, v.key_offset, 0, pointer_to("/parameters", name),
                                    "no formula and no name uses this parameter", "", "", 0});
    }
  }

  /// The first of several copies with the same fault is reported, the others are counted.
  void add(ExpansionFault fault) {
    const std::string key = std::to_string(fault.source) + " " + std::to_string(fault.offset) + " " + fault.rule;
    const auto [at, is_new] = told_.try_emplace(key, result_.faults.size());
    if (!is_new) {
      if (at->second < result_.faults.size()) ++result_.faults[at->second].other_copies;
    } else if (result_.faults.size() < most_faults) {
      result_.faults.push_back(std::move(fault));
    } else {
      ++result_.more_faults;
      told_.erase(at);  // faults that are not reported need no memory
    }
  }

  void fail_outline(const JsonValue& at, const std::string& pointer, std::string rule, std::string hint = {}) {
    add({at.source, at.offset, at.length, pointer, std::move(rule), std::move(hint), around(), 0});
    result_.has_outline = false;
  }

  CopyOrigins& origins() { return result_.origins; }

  /// Names the copies that contain the present value.
  std::string around() const {
    std::string text;
    for (const auto& [index, value] : around_) {
      text += (text.empty() ? "" : ", ") + *index + " = ";
      append_number(text, value);
    }
    return text;
  }

  // Names in values.

  void apply_to_file() {
    for (std::size_t i = 0; i < root_.items.size(); ++i)
      if (const std::string& key = root_.items.key(i); key != "comment" && key != "$schema") {
        in_signals_ = key == "signals";
        apply(root_.items[i], JsonPath{}.member(key));
        in_signals_ = false;
      }
  }

  /// Replaces names by numbers in all strings and formulas of a value, except in comments.
  void apply(JsonValue& v, const JsonPath& path) {
    v.is_copy = !around_.empty();
    if (v.is(JsonKind::string)) return apply_to_text(v, path, false);
    for (std::size_t i = 0; i < v.items.size(); ++i) {
      if (v.is(JsonKind::array)) {
        apply(v.items[i], path.at(i));
        continue;
      }
      const std::string& key = v.items.key(i);
      if (key == "comment") continue;
      const bool was_in_signals = std::exchange(in_signals_, in_signals_ || key == "signals" || key == "force_law");
      if (key == "expression" && v.items[i].is(JsonKind::string))
        apply_to_text(v.items[i], path.member(key), true, v.find("of"));
      else
        apply(v.items[i], path.member(key));
      in_signals_ = was_in_signals;
    }
  }

  /// own: an object whose keys are local names of the formula.
  void apply_to_text(JsonValue& v, const JsonPath& path, bool is_formula, const JsonValue* own = nullptr) {
    v.is_copy = !around_.empty();
    if (!is_formula && v.text.str().find_first_of("{}") == std::string::npos) return;
    if (is_full_) {
      v.sound = false;
      return;
    }
    std::string text = v.text;
    const std::optional<NamedFault> fault = !is_formula   ? names_.put_into_text(text)
                                            : in_signals_ ? names_.put_into_signal(text)
                                                          : names_.put_into_formula(text, own);
    if (fault) {
      v.sound = false;
      if (fault->was_told) return;
      return add({v.source, v.offset, v.length, path.text(), fault->rule,
                  fault->unknown.empty() ? fault->hint : names_.hint_for(fault->unknown), around(), 0});
    }
    made_bytes_ += text.size();
    v.text = std::move(text);
    v.is_made = true;
    if (made_bytes_ <= most_made_bytes) return;
    is_full_ = true;
    fail_outline(v, path.text(),
                 "the texts of the scene grow beyond " + std::to_string(most_made_bytes >> 20u) +
                     " MB where numbers stand for their names",
                 "shorten the formulas, or make fewer copies");
  }

  // Copies.

  void make_copies(JsonValue& repeat) {
    const RuleTable& table = scene_rules();
    std::vector<CheckFault> faults;
    result_.more_faults += check_rules(table, *table.named.at("repeat"), repeat, "/repeat", faults);
    for (CheckFault& f : faults)
      add({f.source, f.offset, f.length, std::move(f.pointer), std::move(f.rule), std::move(f.hint), "", 0});
    if (!repeat.sound) {
      result_.has_outline = false;
      return;
    }
    std::vector<Group> groups = groups_of(repeat, "/repeat");
    num_values_ = count_values(root_);
    for (Group& group : groups)
      if (result_.has_outline) measure(group);
    if (!result_.has_outline) return;
    for (const auto& [list, count] : num_items_) made_[list].reserve(count, false);
    for (Group& group : groups) copy(group, -1);
    for (auto& [list, items] : made_) append(list, items, repeat);
  }

  std::vector<Group> groups_of(const JsonValue& repeat, const std::string& pointer) {
    std::vector<Group> groups;
    for (std::size_t i = 0; i < repeat.items.size(); ++i)
      groups.push_back(group_of(repeat.items[i], pointer + "/" + std::to_string(i)));
    return groups;
  }

  Group group_of(const JsonValue& v, const std::string& pointer) {
    Group group;
    group.pointer = pointer;
    group.index = v.find("index")->text;
    group.count = v.find("count");
    group.first = v.find("first");
    group.index_id = origins().add_index(group.index);
    const JsonValue& index = *v.find("index");
    if (const std::string rule = NamedNumbers::fault_of_name(group.index); !rule.empty())
      fail_outline(index, pointer + "/index", rule);
    else if (names_.holds(group.index))
      fail_outline(index, pointer + "/index", "a parameter or an index around this one has the same name");
    group.num_values = 1;
    for (std::size_t k = 0; k < v.items.size(); ++k) {
      const JsonValue& list = v.items[k];
      const std::string& key = v.items.key(k);
      if (!list.is(JsonKind::array) || key == "repeat") continue;
      for (std::size_t i = 0; i < list.items.size(); ++i) {
        const std::string at = pointer_to(pointer, key) + "/" + std::to_string(i);
        group.templates.push_back({key, at, &list.items[i], origins().add_template(at)});
        group.num_values += count_values(list.items[i]);
        group.num_bytes += list.items[i].length;
      }
    }
    if (const JsonValue* nested = v.find("repeat")) {
      const bool is_new = !names_.holds(group.index);
      if (is_new) names_.set(group.index, 0.0);  // so that no inner index may have the same name
      group.nested = groups_of(*nested, pointer + "/repeat");
      if (is_new) names_.remove(group.index);
    }
    return group;
  }

  /// A whole number of a group within the present copies; none if it is at fault.
  std::optional<long> whole(const JsonValue& given, const std::string& pointer, const Rule& rule) {
    JsonValue v = given;
    apply(v, JsonPath{nullptr, pointer, 0});
    if (!v.sound) return std::nullopt;
    std::vector<CheckFault> faults;
    check_rules(scene_rules(), rule, v, pointer, faults);
    if (!faults.empty() && v.is(JsonKind::number) && v.is_made)
      faults.front().hint = "the formula gives " + rounded_text(v.number, 12);
    for (CheckFault& f : faults)
      add({f.source, f.offset, f.length, std::move(f.pointer), std::move(f.rule), std::move(f.hint), around(), 0});
    return faults.empty() ? std::optional<long>(whole_number<long>(v.number)) : std::nullopt;
  }

  /// Calls each(index) for every copy, with the index set to its value; false if the group's numbers are at fault.
  template <class Each>
  bool for_each_copy(const Group& group, const Each& each) {
    static const RuleRef count_rule = copy_count_rule(), first_rule = copy_first_rule();
    const std::optional<long> count = whole(*group.count, group.pointer + "/count", *count_rule),
                              first = whole(*group.first, group.pointer + "/first", *first_rule);
    if (!count || !first) {
      result_.has_outline = false;
      return false;
    }
    around_.emplace_back(&group.index, 0.0);
    for (long k = 0; k < *count && result_.has_outline; ++k) {
      around_.back().second = static_cast<double>(*first + k);
      names_.set(group.index, around_.back().second);
      each(around_.back().second);
    }
    around_.pop_back();
    names_.remove(group.index);
    return true;
  }

  /// Counts the values of all copies, and ends where there are too many.
  void measure(const Group& group) {
    for_each_copy(group, [&](double) {
      num_values_ += group.num_values;
      num_bytes_ += group.num_bytes;
      for (const Group::Template& t : group.templates) ++num_items_[t.list];
      if (num_values_ > max_json_values)
        return fail_outline(
            *group.count, group.pointer + "/count",
            "the scene would hold more than " + std::to_string(max_json_values) + " values with these copies",
            "make fewer, or give beams more elements instead of copying each");
      if (num_bytes_ > max_file_bytes)
        return fail_outline(*group.count, group.pointer + "/count",
                            "the copies would be more than " + std::to_string(max_file_bytes >> 20u) + " MB of text",
                            "make fewer, or shorten the text of a copy");
      for (const Group& nested : group.nested)
        if (result_.has_outline) measure(nested);
    });
  }

  void copy(const Group& group, std::int32_t outer) {
    for_each_copy(group, [&](double index) {
      const std::int32_t instance = origins().add_instance(outer, group.index_id, index);
      for (const Group::Template& t : group.templates) {
        JsonValue& item = made_[t.list].add() = *t.value;
        in_signals_ = t.list == "signals";
        apply(item, JsonPath{nullptr, t.pointer, 0});
        in_signals_ = false;
        const JsonValue* own = root_.find_given(t.list);
        origins().add_item(t.list, own == nullptr ? 0 : own->items.size(), t.id, instance);
      }
      for (const Group& nested : group.nested) copy(nested, instance);
    });
  }

  /// repeat: the place reported for a list that consists of copies only.
  void append(const std::string& name, JsonItems& items, const JsonValue& repeat) {
    JsonValue* list = root_.find_given(name);
    if (list == nullptr) {
      list = &root_.items.add(name);
      list->kind = JsonKind::array;
      list->source = repeat.source;
      list->offset = repeat.offset;
      list->length = repeat.length;
    }
    if (!list->is(JsonKind::array)) return;  // a fault of the outline, which the check reports
    list->items.reserve(list->items.size() + items.size(), false);
    for (JsonValue& item : items) list->items.add() = std::move(item);
  }

  static constexpr std::size_t most_made_bytes = 2 * max_file_bytes;

  JsonValue& root_;
  Expansion result_;
  NamedNumbers names_;
  bool in_signals_ = false;  ///< formulas may call signals here
  std::unordered_map<std::string, std::size_t> told_;
  std::vector<std::pair<const std::string*, double>> around_;  ///< index and value of the enclosing copies
  std::size_t num_values_ = 0, num_bytes_ = 0, made_bytes_ = 0;
  bool is_full_ = false;
  std::map<std::string, std::size_t> num_items_;
  std::map<std::string, JsonItems> made_;
};

}  // namespace

Expansion expand_scene(JsonValue& root) {
  if (root.find_given("parameters") == nullptr && root.find_given("repeat") == nullptr) return {};
  return Expander(root).run();
}

}  // namespace bough::io
