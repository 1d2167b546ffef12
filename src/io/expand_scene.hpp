#pragma once
/// Expands named numbers (`parameters`) and repeated parts (`repeat`) to a plain scene, before the rules of scenes are
/// checked.
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "bough/io/json_value.hpp"

namespace bough::io {

/// A fault in parameters or copies; the pointer refers to the file.
struct ExpansionFault {
  int source = source_file;
  std::uint32_t offset = 0, length = 0;
  std::string pointer, rule, hint, instance;
  std::size_t other_copies = 0;
};

/// For each item that `repeat` added to a list, the place in the file that it was copied from.
class CopyOrigins {
 public:
  struct Place {
    std::string pointer;   ///< in the file
    std::string instance;  ///< "i = 3, j = 0"; empty: not a copy
  };
  /// The source of the value at a pointer into the expanded scene.
  Place source_of(const std::string& pointer) const;
  bool empty() const { return lists_.empty(); }

  /// Adds a copy of a part, within the copy `outer` (-1: none); returns its number.
  std::int32_t add_instance(std::int32_t outer, std::uint32_t index, double value);
  std::uint32_t add_index(std::string name);
  std::string text_of(std::int32_t instance) const;
  std::uint32_t add_template(std::string pointer);
  /// Adds the next item of a list of which the first `before` items are written in the file.
  void add_item(const std::string& list, std::size_t before, std::uint32_t source, std::int32_t instance);

 private:
  struct Instance {
    std::int32_t outer;
    std::uint32_t name;
    double value;
  };
  struct Item {
    std::uint32_t source;
    std::int32_t instance;
  };
  struct List {
    std::size_t before = 0;
    std::vector<Item> items;
  };
  std::vector<std::string> names_, sources_;
  std::vector<Instance> instances_;
  std::unordered_map<std::string, List> lists_;
};

struct Expansion {
  std::vector<ExpansionFault> faults, warnings;
  std::size_t more_faults = 0;
  bool has_outline = true;  ///< false: copies are missing, so that references to them would be reported as well
  CopyOrigins origins;
};

/// Expands `parameters` and `repeat`. A scene without them is left unchanged, at the cost of two searches among the
/// keys of its root. Never makes more than max_json_values values or max_file_bytes of text; both are counted before
/// anything is copied.
Expansion expand_scene(JsonValue& root);

}  // namespace bough::io
