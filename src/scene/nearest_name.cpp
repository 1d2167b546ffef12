#include "bough/scene/nearest_name.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

namespace bough::scene {
namespace {

int substitution(char a, char b) {
  if (a == b) return 0;
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  if (lower(a) == lower(b)) return 1;
  const auto is_gap = [](char c) { return c == '_' || c == '-' || c == ' '; };
  return is_gap(a) && is_gap(b) ? 1 : 2;
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> before, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = 2 * static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = 2 * static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 2, row[j - 1] + 2, last[j - 1] + substitution(a[i - 1], b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 2);
    }
    before = last;
    last = row;
  }
  return last[b.size()];
}

bool NameSearch::is_spent() const {
  constexpr double most_letters = 1e7;
  return letters_ > most_letters;
}

std::string NameSearch::nearest(std::string_view word, std::span<const std::string> known) {
  constexpr std::size_t longest = 64;  // longer words are no slips of the finger, and the distance is quadratic
  if (word.empty() || word.size() > longest) return {};
  std::string best;
  int best_distance = 0;
  for (const std::string& candidate : known) {
    if (is_spent()) break;
    letters_ += 1.0;
    if (candidate.empty() || candidate.size() > longest) continue;
    const int limit = 2 * std::max(1, static_cast<int>(std::max(word.size(), candidate.size())) / 3);
    const int length_gap = 2 * std::abs(static_cast<int>(word.size()) - static_cast<int>(candidate.size()));
    if (length_gap > limit) continue;
    letters_ += static_cast<double>(word.size() * candidate.size());
    const int d = edit_distance(word, candidate);
    if (d <= limit && (best.empty() || d < best_distance)) {
      best = candidate;
      best_distance = d;
    }
  }
  return best;
}

std::string nearest_name(std::string_view word, std::span<const std::string> known) {
  return NameSearch().nearest(word, known);
}

}  // namespace bough::scene
