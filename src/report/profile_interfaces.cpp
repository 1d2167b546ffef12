/// The interfaces of the hierarchy: their forces, the spectra of their flexibilities, and pictures of these.
#include <algorithm>
#include <cmath>
#include <vector>

#include "bough/report/document.hpp"
#include "bough/report/profile_page.hpp"
#include "profile_parts.hpp"
#include "svg_text.hpp"

namespace bough::report {

namespace {

using records::Profile;
using records::SubdomainProfile;

constexpr double side = 300.0, head = 20.0;  // [px]

/// Entries of P^1/2 F P^1/2 by magnitude: nine decades up to the largest.
std::string flexibility_svg(const SubdomainProfile& s) {
  const std::size_t n = s.unknowns.size();
  const double cell = side / static_cast<double>(n);
  double largest = 0.0;
  for (const double f : s.flexibility) largest = std::max(largest, std::abs(f));
  std::string svg =
      "<svg class=\"flexibility\" width=\"300\" viewBox=\"0 0 300 320\" role=\"img\" aria-label=\"flexibility of "
      "interface " +
      s.path + "\">\n" +
      text_element("tiny", 0.0, 13.0, "start",
                   s.path + ": " + std::to_string(n) + " unknowns, condition " + io::rounded_text(s.condition, 3));
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      const double value = s.flexibility[j * n + i];
      const double decades = value == 0.0 || !(largest > 0.0) ? -num_shades : std::log10(std::abs(value) / largest);
      const int color = num_shades - 1 + std::max(1 - num_shades, static_cast<int>(std::ceil(decades)));
      svg += "<rect class=\"h" + std::to_string(std::clamp(color, 0, num_shades - 1)) + "\" x=\"" +
             pixel(cell * static_cast<double>(j)) + "\" y=\"" + pixel(head + cell * static_cast<double>(i)) +
             "\" width=\"" + pixel(cell) + "\" height=\"" + pixel(cell) + "\"><title>" + escaped(s.unknowns[i]) +
             " by " + escaped(s.unknowns[j]) + ": " + io::rounded_text(value, 3) + "</title></rect>\n";
    }
  return svg + "</svg>\n";
}

/// Forces at the nodes of the interfaces nearest to the root.
Table forces_of(const Profile& p) {
  constexpr std::size_t most_rows = 40;
  Table table{{"sub-domain", "level", "node", "force, N", "", "", "moment, N m", "", ""}, {}};
  std::size_t left_out = 0;
  for (std::size_t k = p.subdomains.size(); k-- > 0;) {  // the root is the last
    const SubdomainProfile& s = p.subdomains[k];
    for (std::size_t i = 0; i < s.nodes.size(); ++i) {
      if (table.rows.size() == most_rows) {
        ++left_out;
        continue;
      }
      const std::string source = "/sub_domains/" + std::to_string(k) + "/interface/" + std::to_string(i);
      std::vector<Cell> row{{s.path},
                            {std::to_string(s.level), Tone::plain, true},
                            {s.nodes[i].name, Tone::plain, false, source + "/node"}};
      for (std::size_t c = 0; c < 3; ++c)
        row.push_back(number_cell(s.nodes[i].force[c], 4, source + "/force/" + std::to_string(c)));
      for (std::size_t c = 0; c < 3; ++c)
        row.push_back(number_cell(s.nodes[i].moment[c], 4, source + "/moment/" + std::to_string(c)));
      table.rows.push_back(std::move(row));
    }
  }
  table.caption =
      "What the rest of the structure exerts on a sub-domain at the nodes of its interface at the last step, "
      "in the ground's axes, about each node: the local Lagrange multipliers." +
      (left_out > 0 ? " " + std::to_string(left_out) + " more are in profile.json." : std::string());
  return table;
}

}  // namespace

void add_interfaces(Document& page, const Profile& p) {
  const bool has_any =
      std::any_of(p.subdomains.begin(), p.subdomains.end(), [](const SubdomainProfile& s) { return !s.nodes.empty(); });
  if (!has_any) return;
  page.section("Interfaces", "interfaces");
  page.table(forces_of(p));
  Chart levels{"Condition of P^1/2 F P^1/2 by level", {"level"}, {"condition", Scale::log}, {}};
  ChartSeries conditions{"interfaces", {}, {}, 0, false};
  Chart spectra{"Singular values of P^1/2 F P^1/2", {"number"}, {"singular value", Scale::log}, {}};
  std::vector<std::string> pictures;
  for (const SubdomainProfile& s : p.subdomains) {
    if (std::isfinite(s.condition) && !s.nodes.empty())
      conditions.points.push_back({static_cast<double>(s.level), s.condition, s.path});
    if (s.flexibility.empty()) continue;
    pictures.push_back(flexibility_svg(s));
    ChartSeries spectrum{s.path, {}};
    spectrum.has_marks = s.spectrum.size() <= 24;
    for (std::size_t k = 0; k < s.spectrum.size(); ++k)
      spectrum.points.push_back({static_cast<double>(k + 1), s.spectrum[k]});
    spectra.series.push_back(std::move(spectrum));
  }
  if (conditions.points.empty()) return;
  levels.series.push_back(std::move(conditions));
  page.charts({levels, spectra});
  if (pictures.empty()) return;
  page.markup("<style>" + fill_styles(".flexibility ", "h") + "</style>");
  page.figures(pictures);
  page.paragraph(
      "The scaled flexibilities of the interfaces of the largest conditions: a decade of magnitude a shade. The nearer "
      "to a diagonal, the nearer is its condition to 1.");
}

}  // namespace bough::report
