#include "tree_text.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <queue>
#include <string_view>
#include <vector>

#include "bough/io/number_text.hpp"
#include "bough/io/printable_text.hpp"
#include "bough/io/quantity_text.hpp"
#include "result_text.hpp"

namespace bough::app {
namespace {

using io::amount_text;
using io::bytes_text;
using io::rounded_text;
using io::seconds_text;
using records::Profile;
using records::SubdomainProfile;

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

/// Columns that a text takes: bytes that do not continue a character.
int columns_of(std::string_view text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string fit(std::string text, int width, bool to_the_right) {
  const int columns = columns_of(text);
  if (columns < width) {
    const std::string blank(at(width - columns), ' ');
    return to_the_right ? blank + text : text + blank;
  }
  if (columns == width) return text;
  std::string cut;  // whole characters only
  int taken = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if ((text[i] & 0xC0) != 0x80 && ++taken > width) break;
    cut += text[i];
  }
  return cut;
}

/// A line of the tree: a sub-domain, or several that are not opened.
struct Row {
  int subdomain = -1;
  int count = 1;         ///< of sub-domains shown by this row, their descendants left out
  double seconds = 0.0;  ///< with descendants
  std::string rails;     ///< what stands before the name
};

class TreeText {
 public:
  TreeText(const Profile& p, const TextStyle& style, int most_rows) : p_(p), style_(style), most_rows_(most_rows) {
    children_.resize(p.subdomains.size());
    for (const SubdomainProfile& s : p.subdomains)
      if (s.parent >= 0) children_[at(s.parent)].push_back(s.id);
  }

  std::string text() {
    choose();
    add_rows(static_cast<int>(p_.subdomains.size()) - 1, "", "");
    name_width_ = std::clamp(style_.width - 70, 16, 34);
    std::string out = paint(header(), "1") + "\n";
    for (const Row& row : rows_) out += line(row) + "\n";
    return out;
  }

 private:
  /// Opens the costliest branches first, until the rows are used up.
  void choose() {
    is_open_.assign(p_.subdomains.size(), false);
    std::priority_queue<std::pair<double, int>> open;
    const int root = static_cast<int>(p_.subdomains.size()) - 1;
    open.emplace(p_.subdomains[at(root)].subtree_seconds, root);
    int rows = 1;
    while (!open.empty()) {
      const int s = open.top().second;
      open.pop();
      const int more = rows_below(s);
      if (more == 0 || rows + more > most_rows_) continue;
      rows += more;
      is_open_[at(s)] = true;
      for (int c : children_[at(s)]) open.emplace(p_.subdomains[at(c)].subtree_seconds, c);
    }
  }

  bool alike(int a, int b) const {
    const SubdomainProfile &x = p_.subdomains[at(a)], &y = p_.subdomains[at(b)];
    return x.is_leaf && y.is_leaf && x.num_unknowns == y.num_unknowns && x.interface_unknowns == y.interface_unknowns;
  }

  int rows_below(int s) const {
    int rows = 0, last = -1;
    for (int c : children_[at(s)]) {
      if (last < 0 || !alike(last, c)) ++rows;
      last = c;
    }
    return rows;
  }

  void add_rows(int s, const std::string& before, const std::string& below) {
    rows_.push_back({s, 1, p_.subdomains[at(s)].subtree_seconds, before});
    if (!is_open_[at(s)]) return;
    const std::vector<int>& list = children_[at(s)];
    for (std::size_t k = 0; k < list.size();) {
      std::size_t end = k + 1;
      while (end < list.size() && alike(list[k], list[end])) ++end;
      const bool is_last = end == list.size();
      const std::string corner = style_.unicode ? (is_last ? "└─ " : "├─ ") : (is_last ? "`- " : "|- ");
      const std::string rail = is_last ? "   " : style_.unicode ? "│  " : "|  ";
      if (end - k > 1) {
        Row row{list[k], static_cast<int>(end - k), 0.0, below + corner};
        for (std::size_t i = k; i < end; ++i) row.seconds += p_.subdomains[at(list[i])].subtree_seconds;
        rows_.push_back(row);
      } else {
        add_rows(list[k], below + corner, below + rail);
      }
      k = end;
    }
  }

  std::string paint(const std::string& text, const char* code) const {
    return style_.colors ? "\x1b[" + std::string(code) + "m" + text + "\x1b[0m" : text;
  }

  std::string header() const {
    return fit("sub-domain", name_width_, false) + fit("unknowns", 10, true) + fit("interface", 10, true) +
           fit("flops", 8, true) + fit("own", 9, true) + fit("subtree", 9, true) + "  share";
  }

  std::string line(const Row& row) const {
    const SubdomainProfile& s = p_.subdomains[at(row.subdomain)];
    std::string name = row.rails + (s.parent < 0 ? "root" : s.is_leaf ? "leaf " : "node ");
    if (s.parent >= 0) name += std::to_string(s.id);
    if (row.count > 1) {
      name = row.rails + std::to_string(row.count) + " leaves alike";
    } else if (!s.is_leaf && !is_open_[at(row.subdomain)]) {
      name += " (+" + std::to_string(count_below(row.subdomain)) + " below)";
    }
    const double whole = p_.subdomains.back().subtree_seconds;
    const double share = whole > 0.0 ? row.seconds / whole : 0.0;
    const double count = row.count;
    std::string text = fit(name, name_width_, false) + fit(amount_text(count * s.num_unknowns), 10, true) +
                       fit(std::to_string(s.interface_unknowns), 10, true) +
                       fit(amount_text(count * s.flops), 8, true) +
                       fit(seconds_text(count * s.times.solver()), 9, true) + fit(seconds_text(row.seconds), 9, true) +
                       fit(rounded_text(100.0 * share, 3) + " %", 8, true);
    const int room = std::min(style_.width - columns_of(text) - 1, 30);
    if (room < 4) return fit(text, std::min(columns_of(text), style_.width), false);
    const int filled = std::clamp(static_cast<int>(std::lround(share * room)), 0, room);
    std::string bar;
    for (int k = 0; k < filled; ++k) bar += style_.unicode ? "█" : "#";
    return text + " " + paint(bar, share > 0.5 ? "31" : share > 0.1 ? "33" : "32");
  }

  int count_below(int s) const {
    int count = 0;
    std::vector<int> open = children_[at(s)];
    while (!open.empty()) {
      const int c = open.back();
      open.pop_back();
      ++count;
      open.insert(open.end(), children_[at(c)].begin(), children_[at(c)].end());
    }
    return count;
  }

  const Profile& p_;
  TextStyle style_;
  int most_rows_;
  int name_width_ = 30;
  std::vector<std::vector<int>> children_;
  std::vector<bool> is_open_;
  std::vector<Row> rows_;
};

std::string speed_text(const Profile& p) {
  if (p.speed.empty()) return {};
  std::vector<std::vector<std::string>> rows{
      {"  threads", "solution", "with memory", "measured", "speed-up", "measured", "step", "measured"}};
  const records::ThreadsProfile& one = p.speed.front();
  const auto ratio = [](double a, double b) {
    return std::isfinite(a / b) ? rounded_text(a / b, 3) : std::string("-");
  };
  for (const records::ThreadsProfile& t : p.speed)
    rows.push_back({"  " + std::to_string(t.threads), seconds_text(t.predicted), seconds_text(t.predicted_with_memory),
                    seconds_text(t.measured), ratio(one.predicted, t.predicted), ratio(one.measured, t.measured),
                    seconds_text(t.predicted_step), seconds_text(t.measured_step)});
  std::string text = "Threads, predicted and measured: critical path " + seconds_text(p.critical_path) + " of " +
                     seconds_text(p.total) + "\n" + table_text(rows);
  if (p.walks.empty()) return text;
  rows = {{"  walk", "sum", "critical path", "bytes", "read by 1 thread", "by all"}};
  for (const records::WalkProfile& w : p.walks)
    rows.push_back({std::string("  ") + w.work, seconds_text(w.total), seconds_text(w.critical_path),
                    bytes_text(w.bytes), seconds_text(w.memory_seconds.front()),
                    seconds_text(w.memory_seconds.back())});
  return text +
         "Walks of one factorization and solution, and how long reading their factors and element matrices takes\n" +
         table_text(rows);
}

std::string alternatives_text(const Profile& p) {
  if (p.alternatives.size() < 2) return {};
  std::vector<std::vector<std::string>> rows{
      {"  leaf_size", "depth", "sub-domains", "levels", "flops", "1 thread", std::to_string(p.threads) + " threads"}};
  for (const records::Alternative& a : p.alternatives) {
    if (rows.size() > 6) break;
    rows.push_back({"  " + (a.leaf_size == 0 ? "chosen" : std::to_string(a.leaf_size)),
                    a.depth < 0 ? "chosen" : std::to_string(a.depth), std::to_string(a.num_subdomains),
                    std::to_string(a.num_levels), amount_text(a.flops), seconds_text(a.predicted),
                    seconds_text(a.predicted_threads) + (a.is_present ? " (present)" : "")});
  }
  return "Other trees, predicted (bough tune measures)\n" + table_text(rows);
}

}  // namespace

TextStyle style_of_terminal() {
  TextStyle style;
  const bool on_terminal = isatty(STDOUT_FILENO) != 0;
  winsize size{};
  if (on_terminal && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) style.width = size.ws_col;
  if (const char* columns = std::getenv("COLUMNS"); columns != nullptr && std::atoi(columns) > 0)
    style.width = std::atoi(columns);
  style.width = std::clamp(style.width, 60, 200);
  const char *term = std::getenv("TERM"), *no_color = std::getenv("NO_COLOR");
  style.colors =
      on_terminal && (no_color == nullptr || *no_color == '\0') && term != nullptr && std::string_view(term) != "dumb";
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    const std::string_view locale(value);
    style.unicode = locale.find("UTF-8") != std::string_view::npos || locale.find("utf8") != std::string_view::npos;
    break;
  }
  return style;
}

std::string tree_text(const Profile& p, const TextStyle& style, int most_rows) {
  if (p.subdomains.empty()) return "no sub-domains\n";
  const SubdomainProfile& root = p.subdomains.back();
  std::string text = io::printable(p.scene) + ": " + std::to_string(root.subtree_unknowns) + " unknowns, " +
                     std::to_string(p.subdomains.size()) + " sub-domains on " + std::to_string(p.levels.size()) +
                     " levels, " + std::to_string(p.num_in_lanes) + " in lockstep; " + std::to_string(p.steps) +
                     (p.steps == 1 ? " step, " : " steps, ") + std::to_string(p.factorizations) + " factorizations, " +
                     std::to_string(p.threads) + (p.threads == 1 ? " thread\n" : " threads\n");
  text += TreeText(p, style, most_rows).text();
  const records::StepProfile& s = p.step;
  text += "Step " + seconds_text(s.total) + ": upward with factorization " + seconds_text(s.factor) + ", upward " +
          seconds_text(s.forward) + ", downward " + seconds_text(s.backward) + ", check " + seconds_text(s.residual) +
          ", evaluation alone " + seconds_text(s.evaluate) + ", loops over nodes and elements " +
          seconds_text(s.other_chunks) + ", rest " + seconds_text(s.rest) + "\n" + rounded_text(s.walks, 3) +
          " walks over the sub-domains a step, for " + rounded_text(s.solutions, 3) + " solutions\n";
  double worst = std::nan("");
  for (const records::LevelProfile& l : p.levels)
    if (!std::isnan(l.condition_most)) worst = std::isnan(worst) ? l.condition_most : std::max(worst, l.condition_most);
  if (!std::isnan(worst)) text += "Interfaces: condition of their flexibilities up to " + rounded_text(worst, 3) + "\n";
  if (p.speed.empty() && p.trouble.empty())
    text += "The form \"" + p.form + "\" walks no sub-domains: only the step and its parts are timed\n";
  text += "Memory: solver " + bytes_text(static_cast<double>(p.solver_bytes)) + ", of which factors " +
          bytes_text(static_cast<double>(p.factor_bytes)) + " and element matrices " +
          bytes_text(static_cast<double>(p.element_bytes)) + "; program " +
          bytes_text(static_cast<double>(p.peak_bytes)) + "\nLoad balance " + rounded_text(p.load_balance, 3) + ", " +
          rounded_text(100.0 * p.efficiency, 3) + " % of the threads' time in walks is work\n";
  return text + speed_text(p) + alternatives_text(p);
}

}  // namespace bough::app
