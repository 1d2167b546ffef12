#pragma once
/// A JSON document with the place of every value in its text, and without the silent repairs common JSON readers make:
/// duplicate keys, numbers that overflow or vanish, deep nesting and bad UTF-8 are faults.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bough::io {

enum class JsonKind : std::uint8_t { null, boolean, number, string, array, object };

/// Which text a value comes from.
inline constexpr int source_file = 0;      ///< the file; n > 0: the n-th override
inline constexpr int source_default = -1;  ///< the schema's default

struct JsonValue {
  JsonKind kind = JsonKind::null;
  bool truth = false;  ///< of a boolean
  bool sound = true;   ///< cleared by the schema check where this value or anything in it is at fault
  int source = source_file;
  std::uint32_t offset = 0;      ///< of the first byte in its source
  std::uint32_t length = 0;      ///< [bytes]
  std::uint32_t key_offset = 0;  ///< of the key, for a member of an object
  double number = 0.0;
  std::string text;               ///< of a string, decoded
  std::vector<std::string> keys;  ///< of an object, in the order of the file
  std::vector<JsonValue> items;   ///< of an object or array

  const JsonValue* find(std::string_view key) const;
  JsonValue* find(std::string_view key);
  bool is(JsonKind k) const { return kind == k; }
};

/// A fault of the text itself.
struct JsonFault {
  std::size_t offset = 0;
  std::string pointer, value, rule, hint;
};

/// Reads a text. Returns nothing where the text is not JSON; duplicate keys are faults too, but reading goes on (the first one counts).
std::optional<JsonValue> parse_json(std::string_view text, int source, std::vector<JsonFault>& faults);

/// Appends a token to a JSON pointer, escaping ~ and /.
std::string pointer_to(const std::string& parent, std::string_view token);

/// Splits a pointer into its tokens, unescaped; nothing where it is not one.
std::optional<std::vector<std::string>> split_pointer(std::string_view pointer);

/// Line and column, both from 1, of a byte offset; columns count characters of UTF-8.
struct LineColumn {
  int line = 0, column = 0;
};
class LineIndex {
 public:
  explicit LineIndex(std::string_view text);
  LineColumn at(std::size_t offset) const;

 private:
  std::string_view text_;
  std::vector<std::size_t> starts_;
};

/// A piece of text fit to be shown: control characters and bad UTF-8 escaped, cut after `limit` characters.
std::string shown(std::string_view text, std::size_t limit = 60);

}  // namespace bough::io
