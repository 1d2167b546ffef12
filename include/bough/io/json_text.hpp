#pragma once
/// JSON written in the order of the calls, indented, valid whatever the values are.
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bough::io {

/// Builds one JSON text. Numbers are shortest round trip; JSON has no words for NaN and infinity, so those become the
/// strings "nan", "inf" and "-inf" (never null). Strings that are not UTF-8 have the offending bytes replaced.
class JsonText {
 public:
  void begin_object() { open('{'); }
  void end_object() { close('}'); }
  void begin_array() { open('['); }
  void end_array() { close(']'); }
  void key(std::string_view name);

  void value(double number);
  void value(long long number);
  void value(bool flag);
  void value(std::string_view text);
  void value(const char* text) { value(std::string_view(text)); }
  void raw(std::string_view json);  ///< a JSON value as text; what is not valid JSON is written as a string

  template <class T>
  void member(std::string_view name, const T& v) {
    key(name);
    value(v);
  }

  /// The text so far, which is then forgotten: a long one can be written piece by piece, with text() as the last.
  [[nodiscard]] std::string take() { return std::exchange(text_, {}); }
  /// The text with a final newline.
  [[nodiscard]] std::string text() const { return text_ + "\n"; }

 private:
  void open(char bracket);
  void close(char bracket);
  void separate();

  std::string text_;
  std::vector<bool> has_items_;
  bool after_key_ = false;
};

/// `text` quoted and escaped for JSON.
std::string json_string(std::string_view text);

}  // namespace bough::io
