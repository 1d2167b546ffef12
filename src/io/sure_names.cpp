#include "sure_names.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <nlohmann/json.hpp>

#include "bough/scene/nearest_name.hpp"

namespace bough::io {
namespace {

constexpr std::size_t longest_word = 64;  // as of scene::NameSearch

char folded(char c) {
  if (c == '-' || c == ' ') return '_';
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string digits_of(std::string_view text) {
  std::string r;
  std::copy_if(text.begin(), text.end(), std::back_inserter(r), is_digit);
  return r;
}

std::string folded_text(std::string_view text) {
  std::string r(text);
  std::transform(r.begin(), r.end(), r.begin(), folded);
  return r;
}

/// One letter of the longer text, within it, is missing in the shorter; at its end it may only be a doubled one.
bool lacks_one(const std::string& shorter, const std::string& longer) {
  for (std::size_t i = 1; i < longer.size(); ++i) {
    if (is_digit(longer[i]) || (i + 1 == longer.size() && longer[i] != longer[i - 1])) continue;
    if (longer.substr(0, i) + longer.substr(i + 1) == shorter) return true;
  }
  return false;
}

bool is_slip(const std::string& word, const std::string& name) {
  if (word == name) return true;
  if (word.size() + 1 == name.size()) return lacks_one(word, name);
  if (name.size() + 1 == word.size()) return lacks_one(name, word);
  if (word.size() != name.size()) return false;
  const auto [at, of_name] = std::mismatch(word.begin(), word.end(), name.begin());
  if (std::next(at) == word.end() || is_digit(*at) || is_digit(*std::next(at))) return false;
  std::string swapped = word;
  const auto i = static_cast<std::size_t>(at - word.begin());
  std::swap(swapped[i], swapped[i + 1]);
  return swapped == name;
}

}  // namespace

std::string only_word(std::string_view word, std::span<const std::string> words) {
  constexpr std::size_t least_letters = 4;
  if (word.size() < least_letters || word.size() > longest_word) return {};
  constexpr int edit = 2, far = 1000;  // in half steps, as of scene::edit_distance
  std::string found;
  int least = far, second = far;
  for (const std::string& candidate : words) {
    if (candidate.size() > longest_word || candidate == found) continue;
    const int distance = scene::edit_distance(word, candidate);
    if (distance < least) {
      second = least;
      least = distance;
      found = candidate;
    } else {
      second = std::min(second, distance);
    }
  }
  const int most = edit * static_cast<int>(std::max(word.size(), found.size()) / 4);
  return least <= most && second >= least + 2 * edit && digits_of(word) == digits_of(found) ? found : std::string();
}

bool is_number_text(const std::string& text) {
  constexpr std::string_view digits = "0123456789";
  if (text.empty() || digits.find(text.back()) == std::string_view::npos) return false;
  return (text.front() == '-' || digits.find(text.front()) != std::string_view::npos) && nlohmann::json::accept(text);
}

std::string only_name(std::string_view word, std::span<const std::string> names) {
  constexpr std::size_t least_letters = 3;
  if (word.size() < least_letters || word.size() > longest_word) return {};
  const std::string own = folded_text(word);
  std::string found;
  for (const std::string& name : names) {
    const std::size_t gap = word.size() > name.size() ? word.size() - name.size() : name.size() - word.size();
    if (gap > 1 || name == found || !is_slip(own, folded_text(name))) continue;
    if (!found.empty()) return {};
    found = name;
  }
  return found;
}

}  // namespace bough::io
