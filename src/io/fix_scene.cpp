#include "bough/io/fix_scene.hpp"

#include <algorithm>

namespace bough::io {
namespace {

constexpr int most_rounds = 200;               // a text that is not JSON shows one fault at a time
constexpr std::size_t most_read = 64u << 20u;  // bytes of all rounds: some tens of seconds
constexpr std::size_t context_lines = 3;       // as diff -u

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    lines.push_back(text.substr(0, end + 1));
    text.remove_prefix(end + 1);
  }
  return lines;
}

void add_line(std::string& diff, char mark, std::string_view line) {
  diff += mark;
  diff += line;
  if (line.empty() || line.back() != '\n') diff += "\n\\ No newline at end of file\n";
}

}  // namespace

std::string with_fixes(std::string_view text, std::vector<Fix> fixes) {
  std::sort(fixes.begin(), fixes.end(), [](const Fix& a, const Fix& b) { return a.offset < b.offset; });
  std::string result;
  std::size_t at = 0;
  for (const Fix& fix : fixes) {
    if (fix.offset < at || fix.offset + fix.length > text.size()) continue;  // within another one
    result += text.substr(at, fix.offset - at);
    result += fix.text;
    at = fix.offset + fix.length;
  }
  return result.append(text.substr(at));
}

FixedScene fixed_scene(std::string_view text, const std::filesystem::path& folder) {
  FixedScene result{std::string(text), {}, {}};
  std::size_t num_read = 0;
  for (int round = 0;; ++round) {
    num_read += result.text.size();
    result.file = read_scene_text(result.text, "scene", {}, folder);
    if (round == most_rounds || num_read > most_read) return result;
    std::vector<Fix> fixes;
    for (const Problem& p : result.file.problems) {
      if (!p.fix) continue;
      const bool is_new =
          std::none_of(fixes.begin(), fixes.end(), [&](const Fix& f) { return f.offset == p.fix->offset; });
      if (!is_new) continue;
      fixes.push_back(*p.fix);
      result.done.push_back({p, result.text.substr(p.fix->offset, p.fix->length)});
    }
    if (fixes.empty()) return result;
    result.text = with_fixes(result.text, std::move(fixes));
  }
}

std::string diff_of(const std::string& name, std::string_view before, std::string_view after) {
  const std::vector<std::string_view> a = lines_of(before), b = lines_of(after);
  std::string diff;
  std::size_t end = 0;  // of the hunk before
  for (std::size_t i = 0; i < a.size() && a.size() == b.size(); ++i) {
    if (a[i] == b[i]) continue;
    if (diff.empty()) diff = "--- " + name + "\n+++ " + name + " (fixed)\n";
    const std::size_t begin = std::max(end, i - std::min(i, context_lines));
    std::size_t last = i;
    for (std::size_t k = i; k < std::min(a.size(), last + 2 * context_lines + 1); ++k)
      if (a[k] != b[k]) last = k;
    end = std::min(a.size(), last + 1 + context_lines);
    const std::string place = std::to_string(begin + 1) + "," + std::to_string(end - begin);
    diff += "@@ -" + place + " +" + place + " @@\n";
    for (std::size_t k = begin; k < end;) {
      if (a[k] == b[k]) {
        add_line(diff, ' ', a[k++]);
        continue;
      }
      std::size_t stop = k;
      while (stop < end && a[stop] != b[stop]) ++stop;
      for (std::size_t j = k; j < stop; ++j) add_line(diff, '-', a[j]);
      for (std::size_t j = k; j < stop; ++j) add_line(diff, '+', b[j]);
      k = stop;
    }
    i = end - 1;
  }
  return diff;
}

}  // namespace bough::io
