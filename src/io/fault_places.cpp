/// What a report shows beside a fault: its line, another place that one needs to see, and what was surely meant.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "bough/io/fault_codes.hpp"
#include "document_report.hpp"
#include "sure_names.hpp"

namespace bough::io {
namespace {

/// X of a hint that reads: did you mean "X"?
std::string suggested_in(const std::string& hint) {
  constexpr std::string_view start = "did you mean \"", end = "\"?";
  const std::size_t at = hint.find(start);
  if (at == std::string::npos) return {};
  const std::size_t from = at + start.size(), to = hint.find(end, from);
  return to == std::string::npos ? std::string() : hint.substr(from, to - from);
}

std::string quoted_json(const std::string& text) { return nlohmann::json(text).dump(); }

}  // namespace

const DefinedNames& Report::names() {
  if (!names_) names_.emplace(root_);
  return *names_;
}

/// Makes the excerpt of a fault in the file, and what it can only have been meant to be.
void Report::show_place(Placed& placed) {
  const std::size_t token = token_length(text_, placed.offset);
  if (placed.length == 0) placed.length = token;
  placed.problem.excerpt = excerpt_of(text_, placed.problem.line, placed.offset, placed.length);
  if (!placed.problem.fix) suggest_fix(placed);
}

void Report::suggest_fix(Placed& placed) {
  Problem& p = placed.problem;
  const std::string written(text_.substr(std::min(placed.offset, text_.size()), placed.length));
  if (!placed.meant.empty()) {
    if (!written.empty() && written.front() == '"') p.fix = Fix{placed.offset, placed.length, placed.meant};
    return;
  }
  // The text of a copy can read differently from what is written: nothing is changed there.
  if (placed.word.empty() || written != quoted_json(placed.word)) return;
  if (p.code == "unknown-name") {
    constexpr std::size_t most_compared = 2'000'000;  // some tenths of a second
    const std::string near = suggested_in(p.hint);
    if (near.empty() || names_compared_ > most_compared) return;
    names_compared_ += names().all().size();
    if (only_name(placed.word, names().all()) == near) p.fix = Fix{placed.offset, placed.length, quoted_json(near)};
  }
}

/// The name or key of the file that one needs to see beside a fault; nullptr: none.
const JsonValue* Report::second_place(const Placed& placed, std::string& about) {
  const Problem& p = placed.problem;
  if (root_ == nullptr) return nullptr;
  if (p.code == "duplicate-key") {
    const JsonValue* first = locate(p.pointer, nullptr);
    about = "given first here";
    return first == nullptr || first->source != source_file ? nullptr : first;
  }
  const bool is_reference = p.code == "wrong-reference" || p.code == "unknown-name";
  if ((!is_reference && p.code != "duplicate-name") || placed.word.empty()) return nullptr;
  const std::string name =
      p.code == "unknown-name" ? suggested_in(p.hint) : placed.word.substr(0, placed.word.find('.'));
  const DefinedNames::Place* place = names().find(name);
  if (place == nullptr || (placed.in_file && place->name->offset == placed.offset)) return nullptr;
  about = p.code == "unknown-name" ? "a near name is defined here"
          : is_reference           ? "defined here, in \"" + place->list + "\""
                                   : "defined first here";
  return place->name;
}

/// All in the order of the file, so that lines are counted once.
void Report::show_second_places(std::vector<Problem>& problems) {
  std::sort(second_places_.begin(), second_places_.end(),
            [](const SecondPlace& a, const SecondPlace& b) { return a.offset < b.offset; });
  LineIndex lines(text_);
  for (const SecondPlace& s : second_places_)
    problems[s.problem].second = excerpt_of(text_, lines.at(s.offset).line, s.offset, s.length);
  second_places_.clear();
}

std::string Problem::long_text() const {
  Problem first = *this;
  first.hint.clear();
  std::string r = first.text() + (code.empty() ? "" : " [" + code + "]") + "\n";
  if (excerpt.line > 0) r += marked_lines(excerpt, '^', "");
  if (second.line > 0) r += marked_lines(second, '-', second_about);
  if (!hint.empty()) r += "  help: " + hint + "\n";
  return r;
}

}  // namespace bough::io
