#include <charconv>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <unordered_set>

#include "bough/io/json_value.hpp"
#include "bough/io/printable_text.hpp"
#include "bough/io/read_scene.hpp"

namespace bough::io {
namespace {

using Base = nlohmann::json;

std::string too_many_values() { return "the file holds more than " + std::to_string(max_json_values) + " values"; }

/// Number of values in each array and object, in the order in which they open, so that none reserves too much memory.
/// For a text that is not JSON the numbers have no meaning, but their sum does not exceed the length of the text.
std::vector<std::uint32_t> count_items(std::string_view text) {
  std::vector<std::uint32_t> counts;
  std::vector<std::size_t> open;
  bool is_empty = false;  // the innermost one has no value yet
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == ' ' || c == '\n' || c == '\t' || c == '\r') continue;
    if (c == '}' || c == ']') {
      if (!open.empty()) {
        if (!is_empty) ++counts[open.back()];
        open.pop_back();
      }
      is_empty = false;
      continue;
    }
    is_empty = false;
    if (c == '"') {
      for (++i; i < text.size() && text[i] != '"'; ++i)
        if (text[i] == '\\') ++i;
    } else if (c == ',' && !open.empty()) {
      ++counts[open.back()];
    } else if (c == '{' || c == '[') {
      if (open.size() > max_json_depth) break;  // where reading ends
      open.push_back(counts.size());
      counts.push_back(0);
      is_empty = true;
    }
  }
  return counts;
}

/// Builds the tree from the reader's events. The reader reports no positions. Its events come in the order of the text,
/// however, and each corresponds to one token, so a cursor that steps over the same tokens knows the position of each.
class Builder : public nlohmann::json_sax<Base> {
 public:
  Builder(std::string_view text, std::int16_t source, std::vector<JsonFault>& faults, std::vector<std::uint32_t> counts)
      : text_(text), source_(source), faults_(faults), counts_(std::move(counts)) {
    if (text_.substr(0, 3) == "\xEF\xBB\xBF") cursor_ = 3;
  }

  JsonValue root;

  bool null() override { return scalar(JsonKind::null); }
  bool boolean(bool val) override {
    if (!scalar(JsonKind::boolean)) return false;
    last_->truth = val;
    return true;
  }
  bool number_integer(number_integer_t) override { return number(); }
  bool number_unsigned(number_unsigned_t) override { return number(); }
  bool number_float(number_float_t, const string_t&) override { return number(); }
  bool string(string_t& val) override {
    if (!scalar(JsonKind::string)) return false;
    last_->text = std::move(val);
    return true;
  }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(JsonKind::object); }
  bool start_array(std::size_t) override { return open(JsonKind::array); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& val) override {
    take_token();
    Level& level = levels_.back();
    level.key_offset = token_offset_;
    level.is_duplicate = !level.is_new(val);
    level.key = std::move(val);
    if (level.is_duplicate)
      fault(token_offset_, path(), std::string(text_.substr(token_offset_, token_length_)), "this key was given before",
            "keep one of the two");
    return true;
  }

  bool parse_error(std::size_t position, const std::string& last_token, const nlohmann::detail::exception& e) override;

 private:
  struct Level {
    JsonValue* value;
    std::string key;
    std::uint32_t key_offset = 0;
    bool is_duplicate = false;
    std::unordered_set<std::string> seen{};  ///< of an object with many keys

    bool is_new(const std::string& name) {
      constexpr std::size_t few = 16;
      const JsonItems& items = value->items;
      if (items.size() < few) {
        for (std::size_t i = 0; i < items.size(); ++i)
          if (items.key(i) == name) return false;
        return true;
      }
      if (seen.empty())
        for (std::size_t i = 0; i < items.size(); ++i) seen.insert(items.key(i));
      return seen.insert(name).second;
    }
  };

  std::string path() const {
    std::string p;
    for (std::size_t i = 0; i < levels_.size(); ++i) {
      const Level& level = levels_[i];
      if (level.value->is(JsonKind::object))
        p = pointer_to(p, level.key);
      else
        p += "/" + std::to_string(level.value->items.size() - (i + 1 < levels_.size() ? 1 : 0));
    }
    return p;
  }

  void fault(std::size_t offset, std::string pointer, std::string value, std::string rule, std::string hint) {
    if (faults_.size() <= max_problems)
      faults_.push_back({offset, std::move(pointer), shown(value), std::move(rule), std::move(hint)});
  }

  void skip_gap() {
    while (cursor_ < text_.size() && std::string_view(" \t\r\n,:").find(text_[cursor_]) != std::string_view::npos)
      ++cursor_;
  }

  void take_token() {
    skip_gap();
    std::size_t end = cursor_;
    if (end < text_.size() && text_[end] == '"') {
      for (++end; end < text_.size() && text_[end] != '"'; ++end)
        if (text_[end] == '\\') ++end;
      ++end;
    } else if (end < text_.size() && std::string_view("{}[]").find(text_[end]) != std::string_view::npos) {
      ++end;
    } else {
      while (end < text_.size() && std::string_view(" \t\r\n,:{}[]\"").find(text_[end]) == std::string_view::npos)
        ++end;
      const std::size_t zero = cursor_ + (text_.substr(cursor_, 1) == "-" ? 1 : 0);
      if (zero + 1 < end && text_[zero] == '0' && text_[zero + 1] >= '0' && text_[zero + 1] <= '9')
        end = zero + 1;  // 01: two tokens
    }
    token_offset_ = static_cast<std::uint32_t>(cursor_);
    token_length_ = static_cast<std::uint32_t>(std::min(end, text_.size()) - cursor_);
    cursor_ = std::min(end, text_.size());
  }

  /// Makes a new value at the place where the open object or array expects it.
  bool scalar(JsonKind kind) {
    take_token();
    if (++count_ > max_json_values) {
      fault(token_offset_, path(), "", too_many_values(), "");
      return false;
    }
    JsonValue* v = &root;
    if (!levels_.empty()) {
      Level& level = levels_.back();
      if (level.is_duplicate) {
        spare_.push_back(std::make_unique<JsonValue>());
        v = spare_.back().get();
      } else {
        JsonItems& items = level.value->items;
        v = level.value->is(JsonKind::object) ? &items.add(level.key) : &items.add();
      }
      v->key_offset = level.key_offset;
    }
    v->kind = kind;
    v->source = source_;
    v->offset = token_offset_;
    v->length = token_length_;
    last_ = v;
    return true;
  }

  bool number() {
    if (!scalar(JsonKind::number)) return false;
    const std::string_view word = text_.substr(token_offset_, token_length_);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), last_->number);
    if (error == std::errc() && end == word.data() + word.size()) return true;
    last_->sound = false;
    last_->number = 0.0;
    const bool vanishes =
        word.find_first_of("eE") != std::string_view::npos && word.find('-', 1) != std::string_view::npos;
    fault(token_offset_, value_path(), std::string(word),
          vanishes ? "is too small for a double (it would silently become 0)" : "is too large for a double",
          vanishes ? "write 0 if that is meant" : "");
    return true;
  }

  /// Path of the value just made (the array has grown by it).
  std::string value_path() const {
    std::string p = path();
    if (!levels_.empty() && levels_.back().value->is(JsonKind::array)) {
      p.erase(p.rfind('/'));
      p += "/" + std::to_string(levels_.back().value->items.size() - 1);
    }
    return p;
  }

  bool open(JsonKind kind) {
    if (!scalar(kind)) return false;
    if (levels_.size() == max_json_depth) {
      fault(token_offset_, value_path(), "",
            "arrays and objects are nested deeper than " + std::to_string(max_json_depth), "");
      return false;
    }
    const std::size_t count = next_count_ < counts_.size() ? counts_[next_count_++] : 0;
    if (count > 0) last_->items.reserve(count, kind == JsonKind::object);
    levels_.push_back({last_, {}, 0, false, {}});
    return true;
  }

  bool close() {
    take_token();
    JsonValue* v = levels_.back().value;
    v->length = static_cast<std::uint32_t>(cursor_) - v->offset;
    levels_.pop_back();
    return true;
  }

  std::string_view text_;
  std::int16_t source_;
  std::vector<JsonFault>& faults_;
  std::vector<std::uint32_t> counts_;
  std::size_t next_count_ = 0;
  std::size_t cursor_ = 0;
  std::size_t count_ = 0;
  std::uint32_t token_offset_ = 0, token_length_ = 0;
  JsonValue* last_ = nullptr;
  std::vector<Level> levels_;
  std::vector<std::unique_ptr<JsonValue>> spare_;  ///< values of duplicate keys: read, then dropped
};

/// Hints for common additions that JSON does not allow.
std::string syntax_hint(std::string_view rest, char before, bool after_zero) {
  const auto starts = [&](std::string_view s) { return rest.substr(0, s.size()) == s; };
  if (rest.empty()) return "the file ends too early: a closing bracket, brace or quote is missing";
  if (starts("//") || starts("/*") || starts("#")) return "JSON has no comments; use a \"comment\" key";
  if (starts("'")) return "strings and keys take double quotes";
  if (before == ',' && (starts("]") || starts("}"))) return "remove the comma before it";
  if (starts("NaN") || starts("nan") || starts("Inf") || starts("inf") || starts("-I") || starts("-i") ||
      starts("-N") || starts("-n"))
    return "numbers are finite";
  if (starts("+") || starts(".") || starts("-.")) return "write numbers as 0.5, 1e-3 or -2";
  if (after_zero && rest.front() >= '0' && rest.front() <= '9') return "numbers have no leading zeros";
  if (starts("True") || starts("False")) return "write true or false";
  if (starts("None") || starts("undefined")) return "leave the key out";
  if (starts("\"") && before != ',') return "a comma may be missing before it";
  return "";
}

/// The change of a text that can only have been meant where the reader stopped at an offset: a comma before a closing
/// bracket is left out, and True, False, +1 and .5 are written as JSON has them. last: end of the token before.
std::optional<Fix> syntax_fix(std::string_view text, std::size_t last, std::size_t offset) {
  const std::string_view rest = text.substr(std::min(offset, text.size()));
  const std::string_view gap = text.substr(std::min(last, text.size()), offset - std::min(last, offset));
  const std::size_t comma = gap.find(',');
  const bool is_after_value = last > 0 && text[last - 1] != '[' && text[last - 1] != '{';
  if (is_after_value && !rest.empty() && (rest.front() == ']' || rest.front() == '}') && comma != std::string::npos &&
      gap.find_first_of(",:", comma + 1) == std::string::npos && gap.find(':') == std::string::npos)
    return Fix{last + comma, 1, ""};
  const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n,:{}[]\"/#"));
  if (word == "True") return Fix{offset, word.size(), "true"};
  if (word == "False") return Fix{offset, word.size(), "false"};
  const bool has_sign = !word.empty() && (word.front() == '+' || word.front() == '-');
  std::string number(word.substr(has_sign ? 1 : 0));
  if (!number.empty() && number.front() == '.') number.insert(0, "0");
  if (number.empty() || number.front() < '0' || number.front() > '9' || number == word) return {};
  if (has_sign && word.front() == '-') number.insert(0, "-");
  if (!nlohmann::json::accept(number)) return {};
  return Fix{offset, word.size(), number};
}

/// The encoding of a text whose characters take two or four bytes each, known by its mark or by the zero bytes of its
/// first character, which is ASCII in every JSON text; null: none of these.
const char* wide_encoding(std::string_view text) {
  const auto starts = [&](std::string_view s) { return text.substr(0, s.size()) == s; };
  const auto is_zero = [&](std::size_t k) { return k < text.size() && text[k] == '\0'; };
  if (starts({"\xFF\xFE\0\0", 4}) || starts({"\0\0\xFE\xFF", 4})) return "UTF-32";
  if (starts("\xFF\xFE") || starts("\xFE\xFF")) return "UTF-16";
  if (is_zero(0) == is_zero(1)) return is_zero(0) && is_zero(2) && !is_zero(3) && text.size() > 3 ? "UTF-32" : nullptr;
  if (is_zero(1) && is_zero(2) && is_zero(3)) return "UTF-32";
  return text.size() > 2 && is_zero(is_zero(0) ? 2 : 3) ? "UTF-16" : nullptr;
}

/// "the byte \xF6 is not UTF-8"
std::string bad_byte_text(char byte) {
  std::string text = "the byte ";
  append_printable(text, {&byte, 1}, 0);
  return text + " is not UTF-8";
}

bool Builder::parse_error(std::size_t position, const std::string& last_token, const nlohmann::detail::exception& e) {
  std::size_t end_of_last = cursor_;
  skip_gap();
  const std::string what = e.what();
  std::string rule = "is not JSON";
  std::size_t offset = cursor_;
  if (e.id == 406) {  // a number out of range is the only faulty number at which the reader stops
    rule = "is too large for a double";
  } else if (const std::size_t at = what.find("syntax error"); at != std::string::npos) {
    rule += ": " + what.substr(at);
    if (const std::size_t last = rule.find("; last read"); last != std::string::npos) {
      const std::size_t next = rule.find("'; expected");
      rule = rule.substr(0, last) + (next == std::string::npos ? "" : rule.substr(next + 1));
    }
    if (what.find("invalid string") != std::string::npos && position > 0) offset = position - 1;
  }
  std::size_t bad = cursor_;
  while (bad < text_.size() && utf8_length(text_.substr(bad)) > 0) bad += utf8_length(text_.substr(bad));
  if (what.find("ill-formed UTF-8") != std::string::npos && bad < text_.size()) {
    fault(bad, levels_.empty() ? "" : path(), "", bad_byte_text(text_[bad]),
          "save the file as UTF-8; in files of one byte a character, as Latin-1, letters with accents have such bytes");
    return false;
  }
  char before = end_of_last < cursor_ ? '\0' : ' ';
  for (std::size_t i = end_of_last; i < cursor_; ++i)
    if (text_[i] == ',' || text_[i] == ':') before = text_[i];
  const std::string_view rest = text_.substr(std::min(offset, text_.size()));
  const bool after_zero = end_of_last == cursor_ && cursor_ > 0 && text_[cursor_ - 1] == '0';
  std::string token(rest.substr(0, std::min(rest.find_first_of(" \t\r\n,:{}[]", 1), std::size_t{40})));
  if (token.empty()) token = shown(last_token);
  fault(offset, levels_.empty() ? "" : path(), token, shown(rule, 300),
        e.id == 406 ? "" : syntax_hint(rest, before, after_zero));
  if (e.id != 406 && !faults_.empty()) faults_.back().fix = syntax_fix(text_, end_of_last, offset);
  return false;
}

}  // namespace

std::optional<JsonValue> parse_json(std::string_view text, std::int16_t source, std::vector<JsonFault>& faults) {
  if (text.size() > max_file_bytes) {
    faults.push_back({0, "", "", "is larger than " + std::to_string(max_file_bytes >> 20u) + " MB", ""});
    return std::nullopt;
  }
  if (const char* encoding = wide_encoding(text); encoding != nullptr) {
    faults.push_back({0, "", "", std::string("is ") + encoding, "save the file as UTF-8"});
    return std::nullopt;
  }
  // The reader takes a zero byte for the end of the text, and would silently ignore what follows.
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos) {
    faults.push_back(
        {zero, "", "", "holds a zero byte, which no JSON text may", "remove it and what was not meant after it"});
    return std::nullopt;
  }
  std::vector<std::uint32_t> counts = count_items(text);
  if (std::accumulate(counts.begin(), counts.end(), std::size_t{1}) >
      max_json_values) {  // before memory is reserved for them
    faults.push_back(
        {0, "", "", too_many_values(), "split it, or give beams more elements instead of writing each as a beam"});
    return std::nullopt;
  }
  Builder builder(text, source, faults, std::move(counts));
  if (!nlohmann::json::sax_parse(text.begin(), text.end(), &builder)) return std::nullopt;
  return std::move(builder.root);
}

}  // namespace bough::io
