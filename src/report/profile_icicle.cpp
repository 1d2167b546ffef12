/// The hierarchy as an icicle plot: one row per level with the root on top; widths are the unknowns of each subtree.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bough/io/quantity_text.hpp"
#include "bough/report/profile_page.hpp"
#include "profile_parts.hpp"
#include "svg_text.hpp"

namespace bough::report {

namespace {

using records::Profile;
using records::SubdomainProfile;

constexpr double width = 960.0, least_width = 1.2;  // [px]
constexpr std::size_t num_measures = 4;

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

struct Measure {
  const char* key;
  const char* label;
  double (*of)(const SubdomainProfile&);
  std::string (*text)(double);
};

constexpr std::array<Measure, num_measures> measures{{
    {"time", "own time in one factorization and solution", [](const SubdomainProfile& s) { return s.times.solver(); },
     io::seconds_text},
    {"size", "unknowns of the interface",
     [](const SubdomainProfile& s) { return static_cast<double>(s.interface_unknowns); }, io::amount_text},
    {"condition", "condition of the interface flexibility", [](const SubdomainProfile& s) { return s.condition; },
     io::amount_text},
    {"force", "largest force at a node of the interface [N]",
     [](const SubdomainProfile& s) { return s.largest_force(); }, io::amount_text},
}};

/// Range of a measure's colours, logarithmic.
struct Range {
  double low = HUGE_VAL, high = -HUGE_VAL;
  bool has_any() const { return low <= high; }
  int color(double x) const {
    if (!std::isfinite(x) || x <= 0.0) return -1;
    if (!(high > low)) return num_shades / 2;
    const double t = std::log(x / low) / std::log(high / low);
    return std::clamp(static_cast<int>(t * num_shades), 0, num_shades - 1);
  }
};

struct Cell {
  double left = 0.0, right = 0.0;
  int subdomain = 0;  ///< the most expensive of the sub-domains drawn as one cell
  int count = 1;
};

std::string tip_of(const SubdomainProfile& s, int count) {
  std::string t = "sub-domain " + std::to_string(s.id) + ", level " + std::to_string(s.level) +
                  (s.path.empty() ? "" : ", path " + s.path);
  if (count > 1) t = "the costliest of " + std::to_string(count) + ": " + t;
  t += s.is_leaf ? ", leaf of " + std::to_string(s.num_elements) + " elements" : ", separator";
  t += "\n" + std::to_string(s.num_unknowns) + " unknowns, interface " + std::to_string(s.interface_unknowns) +
       ", fill " + io::amount_text(static_cast<double>(s.fill)) + ", " + io::amount_text(s.flops) + "flop, " +
       io::bytes_text(s.bytes);
  const records::SubdomainTimes& times = s.times;
  t += "\nassemble " + io::seconds_text(times.assemble) + ", factor " + io::seconds_text(times.factor) + ", condense " +
       io::seconds_text(times.condense) + ", forward " + io::seconds_text(times.forward) + ", back-substitute " +
       io::seconds_text(times.backward) + ", check " + io::seconds_text(times.residual) + "\nsubtree " +
       io::seconds_text(s.subtree_seconds);
  if (s.num_in_visit > 1) t += "; in lockstep with " + std::to_string(s.num_in_visit - 1) + " others";
  if (!std::isnan(s.condition)) t += "\ncondition of the interface flexibility " + io::rounded_text(s.condition, 3);
  if (!s.nodes.empty())
    t += "\nheld at " + std::to_string(s.nodes.size()) + (s.nodes.size() == 1 ? " node" : " nodes") + " by up to " +
         io::rounded_text(s.largest_force(), 3) + " N and " + io::rounded_text(s.largest_moment(), 3) + " N m";
  return t;
}

/// Cells of each level, from left to right; cells that would be too narrow are merged.
std::vector<std::vector<Cell>> lay_out(const Profile& p) {
  const std::size_t n = p.subdomains.size();
  std::vector<double> left(n, 0.0), used(n, 0.0), extent(n, 0.0);
  std::vector<std::vector<Cell>> rows(p.levels.size());
  const auto whole = static_cast<double>(std::max<std::int64_t>(p.subdomains.back().subtree_unknowns, 1));
  for (std::size_t k = n; k-- > 0;) {  // parents before children, so from the right to the left
    const SubdomainProfile& s = p.subdomains[k];
    extent[k] = width * static_cast<double>(s.subtree_unknowns) / whole;
    if (s.parent < 0) {
      left[k] = 0.0;
    } else {
      // Children share the width of their parent; its separator takes no width.
      const auto parent = at(s.parent);
      const SubdomainProfile& above = p.subdomains[parent];
      const auto below = static_cast<double>(above.subtree_unknowns - above.num_unknowns);
      extent[k] = below > 0.0 ? extent[parent] * static_cast<double>(s.subtree_unknowns) / below : 0.0;
      used[parent] += extent[k];
      left[k] = left[parent] + extent[parent] - used[parent];
    }
    rows[at(s.level)].push_back({left[k], left[k] + extent[k], static_cast<int>(k)});
  }
  for (std::vector<Cell>& row : rows) {
    std::sort(row.begin(), row.end(), [](const Cell& a, const Cell& b) { return a.left < b.left; });
    std::vector<Cell> merged;
    for (const Cell& cell : row) {
      if (!merged.empty() && merged.back().right - merged.back().left < least_width &&
          cell.left - merged.back().right < 0.01) {
        Cell& last = merged.back();
        last.right = cell.right;
        last.count += cell.count;
        if (p.subdomains[at(cell.subdomain)].times.solver() > p.subdomains[at(last.subdomain)].times.solver())
          last.subdomain = cell.subdomain;
        continue;
      }
      merged.push_back(cell);
    }
    row = std::move(merged);
  }
  return rows;
}

std::string legend(const Measure& m, const Range& range, double top) {
  std::string text =
      "<g class=\"of-" + std::string(m.key) + "\">\n" + text_element("tiny soft", 0.0, top + 11.0, "start", m.label);
  if (!range.has_any()) return text + text_element("tiny soft", 400.0, top + 11.0, "start", "not known") + "</g>\n";
  text += text_element("tiny soft", 592.0, top + 11.0, "end", m.text(range.low));
  for (int c = 0; c < num_shades; ++c)
    text += "<rect class=\"f" + std::to_string(c) + "\" x=\"" + pixel(600.0 + 28.0 * c) + "\" y=\"" + pixel(top) +
            "\" width=\"28\" height=\"14\"/>\n";
  return text + text_element("tiny soft", 608.0 + 28.0 * num_shades, top + 11.0, "start", m.text(range.high)) +
         "</g>\n";
}

}  // namespace

namespace {

/// Class of letters on a colour of fill_styles: their contrast is at least 4.5, in light and dark mode.
std::string_view class_on(int color) { return color >= 7 ? "tiny on strong" : color >= 4 ? "tiny on" : "tiny on weak"; }

}  // namespace

std::string fill_styles(const std::string& selector, const std::string& prefix) {
  static constexpr const char* light[] = {"#cde2fb", "#b4d3f8", "#9ec5f4", "#86b6ef", "#6da7ec",
                                          "#4b8fe0", "#2a78d6", "#1c5cab", "#0d366b"};
  static constexpr const char* dark[] = {"#14315a", "#184f95", "#1c5cab", "#256abf", "#2a78d6",
                                         "#3987e5", "#6da7ec", "#9ec5f4", "#cde2fb"};
  std::string text, night;
  for (int c = 0; c < num_shades; ++c) {
    const std::string rule = selector + "." + prefix + std::to_string(c) + "{fill:";
    text += rule + light[c] + "}";
    night += rule + dark[c] + "}";
  }
  return text + "@media (prefers-color-scheme:dark){" + night + "}\n";
}

std::string radio_buttons(const std::string& group, const std::vector<std::pair<std::string, std::string>>& choices,
                          std::size_t chosen) {
  std::string text;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    const std::string id = group + "-" + choices[k].first;
    text += "<input type=\"radio\" name=\"" + group + "\" id=\"" + id + "\"" + (k == chosen ? " checked" : "") +
            "> <label for=\"" + id + "\">" + escaped(choices[k].second) + "</label> ";
  }
  return text + "\n";
}

std::string icicle_html(const Profile& p) {
  if (p.subdomains.empty()) return {};
  std::array<Range, num_measures> ranges;
  for (const SubdomainProfile& s : p.subdomains)
    for (std::size_t m = 0; m < num_measures; ++m) {
      const double x = measures[m].of(s);
      if (!std::isfinite(x) || x <= 0.0) continue;
      ranges[m].low = std::min(ranges[m].low, x);
      ranges[m].high = std::max(ranges[m].high, x);
    }
  const std::vector<std::vector<Cell>> rows = lay_out(p);
  const double row_height = std::clamp(260.0 / static_cast<double>(rows.size()), 14.0, 34.0);
  const double top = 26.0, height = top + row_height * static_cast<double>(rows.size());
  std::string style = "<style>.choose{font-size:13px}.cx{fill:#b9b8b0}.icicle rect{stroke:#fcfcfb;stroke-width:.6}" +
                      fill_styles("", "f") + ".on{fill:#000}.on.strong{fill:#fff}" +
                      "@media (prefers-color-scheme:dark){.cx{fill:#55544f}.icicle "
                      "rect{stroke:#1a1a19}.on.weak{fill:#fff}.on.strong{fill:#000}}";
  const std::string keys[] = {"a", "b", "c", "d"};
  for (std::size_t m = 0; m < num_measures; ++m) {
    const std::string chosen = "#icicle-" + std::string(measures[m].key) + ":checked~svg ";
    style += fill_styles(chosen, keys[m]) + chosen + "." + keys[m] + "x{fill:#b9b8b0}" + ".of-" + measures[m].key +
             "{display:none}" + chosen + ".of-" + measures[m].key + "{display:inline}";
  }
  std::string body =
      "<div class=\"icicle\">" + style + "</style><span class=\"choose\">Colour: </span>" +
      radio_buttons("icicle", {{"time", "time"}, {"size", "size"}, {"condition", "condition"}, {"force", "force"}}, 0) +
      "<svg viewBox=\"0 0 960 " + pixel(height + 4.0) + "\" role=\"img\" aria-label=\"hierarchy\">\n" +
      "<rect class=\"paper\" x=\"0\" y=\"0\" width=\"960\" height=\"" + pixel(height + 4.0) + "\"/>\n";
  for (std::size_t m = 0; m < num_measures; ++m) body += legend(measures[m], ranges[m], 4.0);
  for (std::size_t level = 0; level < rows.size(); ++level)
    for (const Cell& cell : rows[level]) {
      const SubdomainProfile& s = p.subdomains[at(cell.subdomain)];
      const double y = top + row_height * static_cast<double>(level);
      body += "<rect class=\"";
      for (std::size_t m = 0; m < num_measures; ++m) {
        const int color = ranges[m].color(measures[m].of(s));
        body += (m > 0 ? " " : "") + keys[m] + (color < 0 ? "x" : std::to_string(color));
      }
      body += "\" x=\"" + pixel(cell.left) + "\" y=\"" + pixel(y) + "\" width=\"" +
              pixel(std::max(0.5, cell.right - cell.left)) + "\" height=\"" + pixel(row_height) + "\"><title>" +
              escaped(tip_of(s, cell.count)) + "</title></rect>\n";
      if (cell.right - cell.left < 64.0 || row_height < 14.0) continue;
      for (std::size_t m = 0; m < num_measures; ++m) {
        const double x = measures[m].of(s);
        if (!std::isfinite(x)) continue;
        body += "<g class=\"of-" + std::string(measures[m].key) + "\" pointer-events=\"none\">" +
                text_element(class_on(ranges[m].color(x)), 0.5 * (cell.left + cell.right), y + 0.5 * row_height + 4.0,
                             "middle", measures[m].text(x)) +
                "</g>\n";
      }
    }
  return body + "</svg></div>\n";
}

}  // namespace bough::report
