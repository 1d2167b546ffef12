#pragma once
/// A JSON document with the position of every value in its text. Unlike common JSON readers, it repairs nothing
/// silently: duplicate keys, numbers that overflow or underflow, deep nesting and bad UTF-8 are faults.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bough::io {

enum class JsonKind : std::uint8_t { null, boolean, number, string, array, object };

/// The text from which a value comes.
inline constexpr std::int16_t source_file = 0;      ///< the file; n > 0: the n-th override
inline constexpr std::int16_t source_default = -1;  ///< the schema's default

struct JsonValue;

/// A string that takes the space of a pointer if it is empty, as in all values that are no strings.
class JsonString {
 public:
  JsonString() = default;
  JsonString(const JsonString& other) { *this = other.str(); }
  JsonString(JsonString&&) noexcept = default;
  JsonString& operator=(const JsonString& other) { return *this = other.str(); }
  JsonString& operator=(JsonString&&) noexcept = default;
  ~JsonString() = default;
  JsonString& operator=(std::string text) {
    text_ = text.empty() ? nullptr : std::make_unique<std::string>(std::move(text));
    return *this;
  }
  const std::string& str() const;
  operator const std::string&() const { return str(); }  // NOLINT(google-explicit-constructor): reads as one
  bool empty() const { return text_ == nullptr; }
  friend bool operator==(const JsonString& a, std::string_view b) { return a.str() == b; }
  friend bool operator==(const JsonString& a, const JsonString& b) { return a.str() == b.str(); }
  friend std::ostream& operator<<(std::ostream& out, const JsonString& text) { return out << text.str(); }

 private:
  std::unique_ptr<std::string> text_;
};

/// The values of an array, or of an object with their keys, in the order of the file: one block of memory, none if
/// there are no values.
class JsonItems {
 public:
  JsonItems() = default;
  JsonItems(const JsonItems& other);
  JsonItems(JsonItems&& other) noexcept : block_(std::exchange(other.block_, nullptr)) {}
  JsonItems& operator=(JsonItems other) noexcept {
    std::swap(block_, other.block_);
    return *this;
  }
  ~JsonItems();

  std::size_t size() const { return block_ == nullptr ? 0 : block_->size; }
  bool empty() const { return size() == 0; }
  JsonValue* begin() { return block_ == nullptr ? nullptr : values(); }
  const JsonValue* begin() const { return block_ == nullptr ? nullptr : values(); }
  JsonValue* end();
  const JsonValue* end() const;
  JsonValue& operator[](std::size_t i);
  const JsonValue& operator[](std::size_t i) const;
  const JsonValue& at(std::size_t i) const;  ///< std::out_of_range where there is none
  const JsonValue& front() const { return (*this)[0]; }
  JsonValue& back() { return (*this)[size() - 1]; }
  /// Of an object; empty in an array.
  const std::string& key(std::size_t i) const;
  void rename(std::size_t i, std::string key) { keys()[i] = std::move(key); }

  /// Reserves room for exactly so many values; it doubles if more are added. The values of one block all have keys, or
  /// none has.
  void reserve(std::size_t count, bool with_keys);
  JsonValue& add();
  JsonValue& add(std::string key);

  /// Members that an object has by default (`find` returns them): an object that outlives this one, shared by all
  /// objects of one rule.
  const JsonValue* defaults() const { return has_keys() ? *shared() : nullptr; }
  void set_defaults(const JsonValue* defaults);

 private:
  struct Block {
    std::uint32_t size = 0;
    std::uint32_t capacity : 31;
    std::uint32_t has_keys : 1;
  };  // followed by the values, then the keys and the place of the defaults
  static Block* make(std::size_t capacity, bool with_keys);
  static void destroy(Block* block);
  void grow(std::size_t capacity, bool with_keys);
  bool has_keys() const { return block_ != nullptr && block_->has_keys == 1; }
  JsonValue* values() const { return reinterpret_cast<JsonValue*>(block_ + 1); }
  std::string* keys() const;
  const JsonValue** shared() const { return reinterpret_cast<const JsonValue**>(keys() + block_->capacity); }

  Block* block_ = nullptr;
};

/// One value, 40 bytes. A file may have millions of values, so a value may cost at most 30 times its text.
struct JsonValue {
  JsonKind kind = JsonKind::null;
  bool truth : 1 = false;    ///< of a boolean
  bool sound : 1 = true;     ///< cleared by the schema check if this value or anything in it is at fault
  bool is_made : 1 = false;  ///< computed from the text at its position
  bool is_copy : 1 = false;  ///< one of several values with the same position in the text
  std::int16_t source = source_file;
  std::uint32_t offset = 0;      ///< of the first byte in its source
  std::uint32_t length = 0;      ///< [bytes]
  std::uint32_t key_offset = 0;  ///< of the key, for a member of an object
  double number = 0.0;
  JsonString text;  ///< of a string, decoded
  JsonItems items;  ///< of an object or array

  /// A member of an object, given or by default.
  const JsonValue* find(std::string_view key) const;
  /// A member that is given.
  JsonValue* find_given(std::string_view key);
  bool is(JsonKind k) const { return kind == k; }
};
static_assert(sizeof(JsonValue) == 40);

inline std::string* JsonItems::keys() const { return reinterpret_cast<std::string*>(values() + block_->capacity); }
inline JsonValue* JsonItems::end() { return begin() + size(); }
inline const JsonValue* JsonItems::end() const { return begin() + size(); }
inline JsonValue& JsonItems::operator[](std::size_t i) { return values()[i]; }
inline const JsonValue& JsonItems::operator[](std::size_t i) const { return values()[i]; }

/// A change of a text: these bytes of it give way to others.
struct Fix {
  std::size_t offset = 0, length = 0;
  std::string text;
};

/// A fault of the JSON text itself.
struct JsonFault {
  std::size_t offset = 0;
  std::string pointer, value, rule, hint;
  std::optional<Fix> fix = {};  ///< what can only have been meant
};

/// Reads a text. Returns none if the text is not JSON. Duplicate keys are faults too, but reading continues, and the
/// first one counts.
std::optional<JsonValue> parse_json(std::string_view text, std::int16_t source, std::vector<JsonFault>& faults);

/// Appends a token to a JSON pointer, escaping ~ and /.
std::string pointer_to(const std::string& parent, std::string_view token);

/// Splits a pointer into its tokens, unescaped; nothing where it is not one.
std::optional<std::vector<std::string>> split_pointer(std::string_view pointer);

/// Line and column, both from 1, of a byte offset; columns count characters of UTF-8.
struct LineColumn {
  int line = 0, column = 0;
};
/// Stores the last position, so that queries in the order of the text cost one pass over it in total.
class LineIndex {
 public:
  explicit LineIndex(std::string_view text);
  LineColumn at(std::size_t offset);

 private:
  std::string_view text_;
  std::size_t start_ = 0, at_ = 0;
  LineColumn place_{1, 1};
};

/// A part of a text for display: control characters and bad UTF-8 escaped, cut after `limit` characters.
std::string shown(std::string_view text, std::size_t limit = 60);
/// The same in quotes, with a backslash before quotes within.
std::string shown_in_quotes(std::string_view text, std::size_t limit = 60);

}  // namespace bough::io
