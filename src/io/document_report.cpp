#include "document_report.hpp"

#include <algorithm>
#include <iostream>

#include "bough/io/fault_codes.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/number_text.hpp"

namespace bough::io {

void Report::add(const JsonFault& f) {
  Placed& placed = put(problems_, {f.pointer, 0, 0, f.value, f.rule, f.hint}, source_file, f.offset);
  placed.problem.fix = f.fix;
}

void Report::add(const CheckFault& f) {
  std::string value = f.length == 0 ? token(f.source, f.offset) : excerpt(f.source, f.offset, f.length);
  const JsonValue* at = f.length == 0 ? nullptr : locate(f.pointer, nullptr);
  if (at != nullptr) value = summary(*at);
  Placed& placed = put(problems_, {f.pointer, 0, 0, std::move(value), f.rule, f.hint}, f.source, f.offset);
  placed.other_copies += f.other_copies;
  placed.length = f.length;
  placed.meant = f.meant;
  if (at != nullptr && at->is(JsonKind::string)) placed.word = at->text;
}

void Report::add(const ExpansionFault& f, bool is_warning) {
  std::string value = f.length == 0 ? token(f.source, f.offset) : excerpt(f.source, f.offset, f.length);
  Problem p{f.pointer, 0, 0, std::move(value), f.rule, f.hint};
  p.instance = f.instance;
  Placed& placed = put(is_warning ? warnings_ : problems_, std::move(p), f.source, f.offset);
  placed.is_expanded = false;
  placed.other_copies = f.other_copies;
  placed.length = f.length;
}

void Report::add_override(const PlacedFault& f) {
  Placed& placed = put(problems_, {f.pointer, 0, 0, shown(f.value), f.rule, f.hint}, 1, 0);
  placed.is_expanded = origins_ == nullptr || origins_->empty();  // the names in an override refer to the file as
                                                                  // written
}

void Report::add(const PlacedFault& f, bool is_warning) {
  std::string reached;
  const JsonValue* at = locate(f.pointer, &reached);
  // The value at fault may be inside the value that the pointer names. A pointer that leads beyond the document is
  // shortened to its existing part.
  Problem p{reached, 0, 0, f.value, f.rule, f.hint};
  if (p.value.empty() && at != nullptr) p.value = summary(*at);
  std::vector<Placed>& list = is_warning ? warnings_ : problems_;
  const int source = at == nullptr ? source_default : at->source;
  const std::size_t offset = at == nullptr ? 0 : at->offset;
  if (at != nullptr && at->is_copy && is_of_another_copy(list, p, source, offset)) return;
  Placed& placed = put(list, std::move(p), source, offset);
  if (at == nullptr) return;
  placed.length = at->length;
  if (at->is(JsonKind::string)) placed.word = at->text;
}

void Report::add(const PlacedFaults& faults, bool is_warning) {
  for (const PlacedFault& f : faults.kept()) add(f, is_warning);
  count_others(faults.size() - faults.kept().size(), is_warning);
}

void Report::write(std::vector<Problem>& problems, std::vector<Problem>& warnings) {
  finish(problems_, left_out_, problems);
  finish(warnings_, warnings_left_out_, warnings);
}

Report::Placed& Report::put(std::vector<Placed>& list, Problem p, int source, std::size_t offset) {
  if (source > 0) {
    p.hint += std::string(p.hint.empty() ? "" : "; ") + "given by an override";
  }
  // Keys and names may contain any characters; those that could act on a terminal are not shown.
  constexpr std::size_t most = 2000;
  for (std::string* text : {&p.pointer, &p.value, &p.rule, &p.hint}) *text = shown(*text, most);
  list.push_back({std::move(p), source == source_file, offset});
  return list.back();
}

/// True if the same fault was reported for another copy of the same text; it then counts this one.
bool Report::is_of_another_copy(std::vector<Placed>& list, const Problem& p, int source, std::size_t offset) {
  const std::string key =
      (&list == &warnings_ ? "w " : "p ") + std::to_string(source) + " " + std::to_string(offset) + " " + p.rule;
  const auto [at, is_new] = of_copies_.try_emplace(key, list.size());
  if (!is_new) ++list[at->second].other_copies;
  return !is_new;
}

std::string Report::owner(const std::string& pointer) const {
  std::string name;
  locate(pointer, nullptr, &name);
  return name;
}

void Report::finish(std::vector<Placed>& list, std::size_t left_out, std::vector<Problem>& out) {
  std::stable_sort(list.begin(), list.end(), [](const Placed& a, const Placed& b) {
    return a.in_file != b.in_file ? a.in_file : a.in_file && a.offset < b.offset;
  });
  for (std::size_t i = 0; i < list.size() && i < max_problems; ++i) {
    if (list[i].in_file) {
      const LineColumn at = lines_.at(list[i].offset);
      list[i].problem.line = at.line;
      list[i].problem.column = at.column;
    }
    Problem& p = list[i].problem;  // only for those shown, since a search for each of many would take quadratic time
    p.code = code_of(p.rule, p.pointer);
    if (list[i].in_file) show_place(list[i]);
    if (std::string about; const JsonValue* second = second_place(list[i], about)) {
      p.second_about = std::move(about);
      second_places_.push_back({out.size(), second->offset, second->length});
    }
    if (list[i].is_expanded) {
      if (p.owner = owner(p.pointer); p.owner == p.value) p.owner.clear();
      if (origins_ != nullptr) {
        CopyOrigins::Place place = origins_->source_of(p.pointer);
        p.pointer = std::move(place.pointer);
        p.instance = std::move(place.instance);
      }
    }
    if (const std::size_t others = list[i].other_copies; others > 0)
      p.hint += std::string(p.hint.empty() ? "" : "; ") + "the same in " + std::to_string(others) +
                (others == 1 ? " more copy" : " more copies");
    out.push_back(std::move(p));
  }
  show_second_places(out);
  left_out += list.size() - std::min(list.size(), max_problems);
  if (left_out > 0 && !out.empty()) {
    Problem& last = out.back();
    last.hint += (last.hint.empty() ? "" : "; ") + std::to_string(left_out) + " more problems are not shown";
  }
}

std::string_view Report::source_text(int source) const {
  if (source == source_file) return text_;
  if (source > 0) return overrides_[static_cast<std::size_t>(source) - 1];
  return {};
}

std::string Report::excerpt(int source, std::size_t offset, std::size_t length) const {
  const std::string_view text = source_text(source);
  return offset < text.size() ? shown(text.substr(offset, std::min<std::size_t>(length, 400))) : std::string();
}

/// The string that starts at an offset.
std::string Report::token(int source, std::size_t offset) const {
  const std::string_view text = source_text(source);
  std::size_t end = offset + 1;
  while (end < text.size() && end < offset + 400 && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
  return excerpt(source, offset, end + 1 - offset);
}

/// Text of a value; for an object with a name, the name.
std::string Report::summary(const JsonValue& v) const {
  const JsonValue* name = v.is(JsonKind::object) ? v.find("name") : nullptr;
  const JsonValue& told = name != nullptr && name->is(JsonKind::string) ? *name : v;
  const std::string written = excerpt(told.source, told.offset, told.length);
  if (!told.is_made) return written;
  if (told.is(JsonKind::string)) return shown_in_quotes(told.text.str());
  return written + " = " + rounded_text(told.number, 6);
}

/// As JsonValue::find, which looks at one key after the other: of an object with very many the keys are sorted first,
/// since each fault may lead through it.
const JsonValue* Report::member(const JsonValue& object, const std::string& key) const {
  constexpr std::size_t many = 1000;
  if (object.items.size() < many) return object.find(key);
  auto& members = members_[&object];
  if (members.empty())
    for (std::size_t i = 0; i < object.items.size(); ++i) members.try_emplace(object.items.key(i), &object.items[i]);
  const auto at = members.find(key);
  return at == members.end() ? object.find(key) : at->second;
}

/// The value at a pointer, or the innermost existing one on the way to it; also the innermost name on the way.
const JsonValue* Report::locate(const std::string& pointer, std::string* reached, std::string* owner) const {
  const JsonValue* at = root_;
  const auto tokens = split_pointer(pointer);
  if (at == nullptr || !tokens) return at;
  std::string path;
  for (const std::string& t : *tokens) {
    const JsonValue* next = nullptr;
    if (at->is(JsonKind::object)) {
      next = member(*at, t);
    } else if (at->is(JsonKind::array)) {
      const bool is_number = !t.empty() && t.size() < 10 && t.find_first_not_of("0123456789") == std::string::npos;
      if (is_number && std::stoul(t) < at->items.size()) next = &at->items[std::stoul(t)];
    }
    if (next == nullptr || next->source == source_default)
      break;  // a default has no place in the file: its owner is
              // named
    at = next;
    path = pointer_to(path, t);
    const JsonValue* name = at->is(JsonKind::object) ? member(*at, "name") : nullptr;
    if (owner != nullptr && name != nullptr && name->is(JsonKind::string)) *owner = summary(*name);
  }
  if (reached != nullptr) *reached = path;
  return at;
}

namespace {

std::string read_to_end(std::istream& in, Problem& problem) {
  std::string text;
  char buffer[1u << 12u];  // on the stack, which may be small
  while (in.read(buffer, sizeof buffer) || in.gcount() > 0) {
    text.append(buffer, static_cast<std::size_t>(in.gcount()));
    if (text.size() > max_file_bytes) {
      problem.rule = too_large_text(max_file_bytes);
      return {};
    }
  }
  if (in.bad()) problem.rule = "the file can not be read to its end";
  return text;
}

}  // namespace

std::string read_whole_file(const std::filesystem::path& file, Problem& problem) {
  if (file == "-") return read_to_end(std::cin, problem);
  try {
    return read_text(file, max_file_bytes);
  } catch (const Unreadable& fault) {
    problem.rule = fault.why();
    return {};
  }
}

std::string Problem::text() const {
  std::string r;
  if (line > 0) r += "line " + std::to_string(line) + ", column " + std::to_string(column) + ", ";
  r += pointer.empty() ? "the file" : pointer;
  if (!owner.empty()) r += " of " + owner;
  if (!instance.empty()) r += ", copy " + instance;
  r += (value.empty() ? "" : " (" + value + ")") + ": " + rule;
  if (!hint.empty()) r += "; " + hint;
  return r;
}

}  // namespace bough::io
