#include "bough/io/json_value.hpp"

#include <algorithm>
#include <memory>
#include <new>
#include <stdexcept>

#include "bough/io/printable_text.hpp"

namespace bough::io {

const std::string& JsonString::str() const {
  static const std::string none;
  return text_ == nullptr ? none : *text_;
}

const std::string& JsonItems::key(std::size_t i) const { return has_keys() ? keys()[i] : JsonString().str(); }

JsonItems::Block* JsonItems::make(std::size_t capacity, bool with_keys) {
  static_assert(sizeof(Block) == alignof(JsonValue) && alignof(std::string) <= alignof(JsonValue));
  const std::size_t each = sizeof(JsonValue) + (with_keys ? sizeof(std::string) : 0);
  const std::size_t bytes = sizeof(Block) + capacity * each + (with_keys ? sizeof(const JsonValue*) : 0);
  auto* block = new (::operator new(bytes)) Block;
  block->capacity = static_cast<std::uint32_t>(capacity) & 0x7fffffffu;
  block->has_keys = with_keys ? 1 : 0;
  return block;
}

void JsonItems::destroy(Block* block) {
  if (block == nullptr) return;
  JsonItems owner;
  owner.block_ = block;
  for (JsonValue& value : owner) value.~JsonValue();
  if (block->has_keys == 1) std::destroy_n(owner.keys(), block->size);
  owner.block_ = nullptr;
  ::operator delete(block);
}

JsonItems::JsonItems(const JsonItems& other) {
  if (other.block_ == nullptr) return;
  reserve(other.size(), other.has_keys());
  for (std::size_t i = 0; i < other.size(); ++i) (has_keys() ? add(other.key(i)) : add()) = other[i];
  if (has_keys()) *shared() = other.defaults();
}

JsonItems::~JsonItems() { destroy(block_); }

const JsonValue& JsonItems::at(std::size_t i) const {
  if (i >= size()) throw std::out_of_range("JsonItems::at");
  return (*this)[i];
}

void JsonItems::grow(std::size_t capacity, bool with_keys) {
  JsonItems larger;
  larger.block_ = make(capacity, with_keys);
  if (with_keys) *larger.shared() = defaults();
  for (std::size_t i = 0; i < size(); ++i)
    (with_keys ? larger.add(std::move(keys()[i])) : larger.add()) = std::move((*this)[i]);
  *this = std::move(larger);
}

void JsonItems::reserve(std::size_t count, bool with_keys) {
  if (block_ == nullptr || count > block_->capacity) grow(count, with_keys);
}

JsonValue& JsonItems::add() {
  if (block_ == nullptr || size() == block_->capacity) grow(std::max<std::size_t>(4, 2 * size()), false);
  return *new (values() + block_->size++) JsonValue;
}

JsonValue& JsonItems::add(std::string key) {
  if (block_ == nullptr || size() == block_->capacity) grow(std::max<std::size_t>(4, 2 * size()), true);
  new (keys() + block_->size) std::string(std::move(key));
  return *new (values() + block_->size++) JsonValue;
}

void JsonItems::set_defaults(const JsonValue* defaults) {
  if (block_ == nullptr) grow(0, true);
  *shared() = defaults;
}

const JsonValue* JsonValue::find(std::string_view key) const {
  if (!is(JsonKind::object)) return nullptr;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (items.key(i) == key) return &items[i];
  return items.defaults() == nullptr ? nullptr : items.defaults()->find(key);
}

JsonValue* JsonValue::find_given(std::string_view key) {
  if (!is(JsonKind::object)) return nullptr;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (items.key(i) == key) return &items[i];
  return nullptr;
}

std::string pointer_to(const std::string& parent, std::string_view token) {
  std::string r = parent + "/";
  for (const char c : token) {
    if (c == '~')
      r += "~0";
    else if (c == '/')
      r += "~1";
    else
      r += c;
  }
  return r;
}

std::optional<std::vector<std::string>> split_pointer(std::string_view pointer) {
  std::vector<std::string> tokens;
  if (pointer.empty()) return tokens;
  if (pointer.front() != '/') return std::nullopt;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      tokens.emplace_back();
    } else if (pointer[i] == '~') {
      ++i;
      if (i == pointer.size() || (pointer[i] != '0' && pointer[i] != '1')) return std::nullopt;
      tokens.back() += pointer[i] == '0' ? '~' : '/';
    } else {
      tokens.back() += pointer[i];
    }
  }
  return tokens;
}

LineIndex::LineIndex(std::string_view text) : text_(text) {
  if (text_.substr(0, 3) == "\xEF\xBB\xBF") start_ = 3;  // a byte order mark is no column
  at_ = start_;
}

LineColumn LineIndex::at(std::size_t offset) {
  offset = std::clamp(offset, start_, std::max(start_, text_.size()));
  if (offset < at_) {
    at_ = start_;
    place_ = {1, 1};
  }
  for (; at_ < offset; ++at_) {
    if (text_[at_] == '\n')
      place_ = {place_.line + 1, 1};
    else if ((static_cast<unsigned char>(text_[at_]) & 0xC0u) != 0x80u)
      ++place_.column;
  }
  return place_;
}

std::string shown(std::string_view text, std::size_t limit) {
  std::string r;
  std::size_t count = 0;
  for (std::size_t i = 0; i < text.size(); ++count) {
    if (count == limit) return r + "...";
    const auto c = static_cast<unsigned char>(text[i]);
    const std::size_t n = utf8_length(text.substr(i));
    if (c == '\n' || c == '\t' || c == '\r') {
      if (r.empty() || r.back() != ' ') r += ' ';
      ++i;
    } else {
      append_printable(r, text.substr(i), n);
      i += n == 0 ? 1 : n;
    }
  }
  return r;
}

std::string shown_in_quotes(std::string_view text, std::size_t limit) {
  std::string r = "\"";
  for (const char c : shown(text, limit)) r += c == '"' ? std::string("\\\"") : std::string(1, c);
  return r + "\"";
}

}  // namespace bough::io
