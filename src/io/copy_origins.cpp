#include <charconv>

#include "bough/io/number_text.hpp"
#include "expand_scene.hpp"

namespace bough::io {

std::uint32_t CopyOrigins::add_index(std::string name) {
  names_.push_back(std::move(name));
  return static_cast<std::uint32_t>(names_.size()) - 1;
}

std::int32_t CopyOrigins::add_instance(std::int32_t outer, std::uint32_t index, double value) {
  instances_.push_back({outer, index, value});
  return static_cast<std::int32_t>(instances_.size()) - 1;
}

std::string CopyOrigins::text_of(std::int32_t instance) const {
  std::string text;
  for (; instance >= 0; instance = instances_[static_cast<std::size_t>(instance)].outer) {
    const Instance& one = instances_[static_cast<std::size_t>(instance)];
    std::string part = names_[one.name] + " = ";
    append_number(part, one.value);
    text = text.empty() ? part : part + ", " + text;
  }
  return text;
}

std::uint32_t CopyOrigins::add_template(std::string pointer) {
  sources_.push_back(std::move(pointer));
  return static_cast<std::uint32_t>(sources_.size()) - 1;
}

void CopyOrigins::add_item(const std::string& list, std::size_t before, std::uint32_t source, std::int32_t instance) {
  List& of = lists_[list];
  if (of.items.empty()) of.before = before;
  of.items.push_back({source, instance});
}

CopyOrigins::Place CopyOrigins::source_of(const std::string& pointer) const {
  const std::size_t name_end = pointer.find('/', 1);
  if (lists_.empty() || name_end == std::string::npos) return {pointer, ""};
  const auto list = lists_.find(pointer.substr(1, name_end - 1));
  std::size_t number = 0;
  const char* const end_of_text = pointer.data() + pointer.size();
  const auto [end, error] = std::from_chars(pointer.data() + name_end + 1, end_of_text, number);
  if (list == lists_.end() || error != std::errc() || (end != end_of_text && *end != '/')) return {pointer, ""};
  const List& of = list->second;
  if (number < of.before || number - of.before >= of.items.size()) return {pointer, ""};
  const Item& item = of.items[number - of.before];
  return {sources_[item.source] + std::string(end, end_of_text), text_of(item.instance)};
}

}  // namespace bough::io
