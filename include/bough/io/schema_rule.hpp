#pragma once
/// Rules for JSON values: one table of them checks scenes and is published as their JSON Schema.
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "bough/io/json_value.hpp"

namespace bough::io {

enum class Form {
  number,   ///< a finite number between low and high
  integer,  ///< the same, whole (20.0 and 2e1 are whole)
  boolean,
  text,    ///< any string
  name,    ///< a string that names a thing: see name_rule
  word,    ///< one of `words`
  array,   ///< min_items to max_items of `item`
  object,  ///< `fields` and nothing else
  choice,  ///< one of `options`, distinguished by JSON type, by "kind", or by a key that only one has
  named    ///< the rule of that name in the table
};

/// A string literal of the program. Rules have hundreds of texts, and copying them would take longer than checking a
/// small scene.
struct Literal : std::string_view {
  constexpr Literal(const char* text = "") : std::string_view(text) {}
};

struct Rule;
using RuleRef = std::shared_ptr<const Rule>;

enum class Presence { optional, required };

struct Field {
  Literal key;
  RuleRef rule;
  Literal about;  ///< one sentence with the unit
  Presence presence = Presence::optional;
  Literal default_json = {};  ///< inserted if the key is missing; empty: no default
};

struct Rule {
  Form form = Form::text;
  Literal about = {};
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool low_open = false;  ///< low itself is not allowed
  std::vector<std::string> words = {};
  std::size_t min_items = 0, max_items = std::numeric_limits<std::size_t>::max();
  RuleRef item = nullptr;
  std::vector<Field> fields = {};
  RuleRef others = nullptr;  ///< of an object: rule of all members that are not fields; nullptr: none are allowed
  std::vector<std::string> kinds =
      {};               ///< of an object told by "kind": the values that mean this one (they become the key's enum)
  Literal marker = {};  ///< of an object in a choice: the key that identifies it
  std::vector<std::vector<std::string>> exactly_one = {};  ///< sets of keys of which exactly one is given
  std::vector<std::vector<std::string>> at_most_one = {};
  std::vector<RuleRef> options = {};
  Literal target = {};       ///< of a named rule
  bool is_deferred = false;  ///< not checked now, but when its copies are made (`repeat`)
};

struct RuleTable {
  std::map<std::string_view, RuleRef> named;
  RuleRef root;
  bool has_formulas = false;  ///< {"expression": ...} may stand for any number
  const Rule& resolve(const Rule& rule) const;
  /// An object with the default members of objects of this rule; made once, valid as long as the table or a copy of it
  /// exists.
  const JsonValue& defaults_of(const Rule& rule) const;

 private:
  struct Defaults {
    std::recursive_mutex mutex;
    std::unordered_map<const Rule*, JsonValue> of_rule;
  };
  std::shared_ptr<Defaults> defaults_ = std::make_shared<Defaults>();
};

/// The table of scene files.
const RuleTable& scene_rules();

/// Rule for names: 1 to 100 characters, no control characters, no '.' or '/', no space at an end, not "ground". Returns
/// the rule that the name breaks; empty if the name is valid.
std::string name_fault(const std::string& name);

struct CheckFault {
  int source = source_file;
  std::uint32_t offset = 0, length = 0;  ///< of the value at fault; an unknown key, or the object that misses one
  std::string pointer, rule, hint;
  std::size_t other_copies = 0;  ///< further copies of the same text with the same fault
  std::string meant = {};        ///< JSON: what the key or value at fault can only have been meant to be
};

/// Checks a document, fills in defaults (source_default), puts numbers in the place of formulas, clears
/// `sound` of values at fault and of all that hold them. Of what a key or value can only have been meant to be the
/// fault is told, and the document is checked further, and read, as if it had been written, so that it hides no other.
/// Appends the first hundreds of faults and returns how many more there are.
std::size_t check_rules(const RuleTable& table, JsonValue& root, std::vector<CheckFault>& faults);
/// The same for a value by one rule of the table; pointer: of the value.
std::size_t check_rules(const RuleTable& table, const Rule& rule, JsonValue& value, std::string_view pointer,
                        std::vector<CheckFault>& faults);

/// A table as a JSON Schema (draft-07).
std::string schema_text_of(const RuleTable& table, const std::string& title);

// Makers of rules, for the table.
RuleRef number_rule(Literal about, double low = -std::numeric_limits<double>::infinity(), bool low_open = false,
                    double high = std::numeric_limits<double>::infinity());
RuleRef positive(Literal about);
RuleRef not_negative(Literal about);
RuleRef integer_rule(Literal about, double low, double high);
RuleRef boolean_rule(Literal about);
RuleRef text_rule(Literal about);
RuleRef name_rule(Literal about);
RuleRef word_rule(Literal about, std::vector<std::string> words);
RuleRef array_rule(Literal about, RuleRef item, std::size_t min_items = 0,
                   std::size_t max_items = std::numeric_limits<std::size_t>::max());
RuleRef choice_rule(Literal about, std::vector<RuleRef> options);
RuleRef named_rule(Literal target);
Field need(Literal key, RuleRef rule, Literal about);
Field may(Literal key, RuleRef rule, Literal about, Literal default_json = {});

}  // namespace bough::io
