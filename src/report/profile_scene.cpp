/// The scene coloured by sub-domains, one level of the tree at a time.
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "bough/io/number_text.hpp"
#include "bough/report/profile_page.hpp"
#include "bough/report/projection.hpp"
#include "profile_parts.hpp"
#include "svg_text.hpp"

namespace bough::report {

namespace {

using records::Profile;
using records::ProfilePart;

constexpr double page_width = 960.0, margin = 20.0, tallest = 460.0, lowest = 90.0;  // [px]
constexpr int num_colors = 6, most_levels = 7;
constexpr std::size_t most_nodes = 3000;

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

/// Equal axes, fitted to the page.
struct Sheet {
  Projection projection;
  double scale = 1.0, left = 0.0, top = 0.0, height = 0.0;
  Point2 operator()(const std::array<double, 3>& x) const {
    const Point2 p = projection(x.data());
    return {left + scale * p.u, top - scale * p.v};
  }
};

Sheet make_sheet(const Profile& p) {
  Box box;
  for (const ProfilePart& part : p.parts)
    for (const auto& x : part.points)
      for (std::size_t k = 0; k < 3; ++k) {
        if (box.empty) {
          box.low = box.high = x;
          box.empty = false;
        }
        box.low[k] = std::min(box.low[k], x[k]);
        box.high[k] = std::max(box.high[k], x[k]);
      }
  Sheet sheet;
  sheet.projection = projection_of(resolve_view(View::automatic, box));
  double u_low = HUGE_VAL, u_high = -HUGE_VAL, v_low = HUGE_VAL, v_high = -HUGE_VAL;
  for (const ProfilePart& part : p.parts)
    for (const auto& x : part.points) {
      const Point2 q = sheet.projection(x.data());
      u_low = std::min(u_low, q.u);
      u_high = std::max(u_high, q.u);
      v_low = std::min(v_low, q.v);
      v_high = std::max(v_high, q.v);
    }
  const double extent = std::max({u_high - u_low, v_high - v_low, 1e-12});
  const double inner = page_width - 2.0 * margin;
  sheet.scale =
      std::min(inner / std::max(u_high - u_low, 1e-3 * extent), tallest / std::max(v_high - v_low, 1e-3 * extent));
  const double drawn = std::max(lowest, sheet.scale * (v_high - v_low));
  sheet.height = drawn + 2.0 * margin;
  sheet.left = 0.5 * page_width - 0.5 * sheet.scale * (u_low + u_high);
  sheet.top = 0.5 * sheet.height + 0.5 * sheet.scale * (v_low + v_high);
  return sheet;
}

/// For each leaf the colour of its ancestor of each level, numbered from the left.
std::vector<std::vector<int>> colors_of(const Profile& p) {
  std::vector<int> seen(p.levels.size(), 0), number(p.subdomains.size(), 0);
  for (const records::SubdomainProfile& s : p.subdomains) number[at(s.id)] = seen[at(s.level)]++;
  std::vector<std::vector<int>> colors(p.subdomains.size());
  for (std::size_t k = p.subdomains.size(); k-- > 0;) {
    const records::SubdomainProfile& s = p.subdomains[k];
    if (s.parent >= 0) colors[k] = colors[at(s.parent)];
    colors[k].push_back(number[k]);
  }
  return colors;
}

std::string path_of(const ProfilePart& part, const Sheet& sheet) {
  std::string d;
  Point2 last{HUGE_VAL, HUGE_VAL};
  for (std::size_t k = 0; k < part.points.size(); ++k) {
    const Point2 q = sheet(part.points[k]);
    if (k > 0 && k + 1 < part.points.size() && std::hypot(q.u - last.u, q.v - last.v) < 0.3) continue;
    d += k == 0 ? 'M' : 'L';
    append_pixel(d, q.u);
    d += ' ';
    append_pixel(d, q.v);
    last = q;
  }
  return part.points.size() == 1 ? d + "h0" : d;
}

std::string nodes_svg(const Profile& p, const Sheet& sheet) {
  std::string body;
  if (p.separator_nodes.size() > most_nodes) return body;
  for (const records::ProfileNode& n : p.separator_nodes) {
    const int level = p.subdomains[at(n.subdomain)].level;
    const Point2 q = sheet(n.position);
    body += "<circle class=\"mark\" cx=\"" + pixel(q.u) + "\" cy=\"" + pixel(q.v) + "\" r=\"" +
            pixel(std::max(1.6, 6.0 - level)) + "\"><title>separator of sub-domain " + std::to_string(n.subdomain) +
            ", level " + std::to_string(level) + "</title></circle>\n";
  }
  return body;
}

/// Forces at the interfaces of the sub-domains of each level, shown with it: what the rest exerts on a sub-domain, from
/// the node on, the longest of the level with a length of its own.
std::string forces_svg(const Profile& p, const Sheet& sheet, int last) {
  constexpr double longest = 60.0;  // [px]
  constexpr std::size_t most_arrows = 2000;
  std::string body;
  for (int level = 1; level <= last; ++level) {
    double largest = 0.0;
    std::size_t count = 0;
    for (const records::SubdomainProfile& s : p.subdomains)
      if (s.level == level && !s.nodes.empty()) {
        largest = std::max(largest, s.largest_force());
        count += s.nodes.size();
      }
    if (!(largest > 0.0) || count > most_arrows) continue;
    body += "<g class=\"force-" + std::to_string(level) + "\">\n";
    for (const records::SubdomainProfile& s : p.subdomains)
      for (const records::InterfaceNode& n : s.nodes) {
        if (s.level != level) continue;
        const double size = std::hypot(n.force[0], n.force[1], n.force[2]);
        std::array<double, 3> from{}, to{};
        for (std::size_t k = 0; k < 3; ++k) {
          from[k] = n.place[k];
          to[k] = n.place[k] + (sheet.scale > 0.0 ? longest / sheet.scale * n.force[k] / largest : 0.0);
        }
        const Point2 a = sheet(from), b = sheet(to);
        const std::string text = "<title>on sub-domain " + s.path + " at " + escaped(n.name) + ": (" +
                                 io::rounded_text(n.force[0], 4) + ", " + io::rounded_text(n.force[1], 4) + ", " +
                                 io::rounded_text(n.force[2], 4) + ") N, (" + io::rounded_text(n.moment[0], 4) + ", " +
                                 io::rounded_text(n.moment[1], 4) + ", " + io::rounded_text(n.moment[2], 4) +
                                 ") N m</title>";
        body += "<line class=\"arrow\" x1=\"" + pixel(a.u) + "\" y1=\"" + pixel(a.v) + "\" x2=\"" + pixel(b.u) +
                "\" y2=\"" + pixel(b.v) + "\">" + text + "</line>";
        body += "<circle class=\"head\" cx=\"" + pixel(b.u) + "\" cy=\"" + pixel(b.v) + "\" r=\"" +
                pixel(size > 0.0 ? 2.6 : 1.6) + "\">" + text + "</circle>\n";
      }
    body += "</g>\n";
  }
  return body;
}

}  // namespace

std::string subdomains_html(const Profile& p) {
  if (p.parts.empty()) return {};
  const Sheet sheet = make_sheet(p);
  const std::vector<std::vector<int>> colors = colors_of(p);
  const int num_levels = static_cast<int>(p.levels.size());
  const int last = std::min(num_levels - 1, most_levels);
  std::map<int, std::array<std::string, 3>> paths;  // by leaf: beams, bodies, joints
  for (const ProfilePart& part : p.parts) paths[part.leaf][static_cast<std::size_t>(part.kind)] += path_of(part, sheet);
  static constexpr const char* light[] = {"#2a78d6", "#eb6834", "#1baf7a", "#4a3aa7", "#e87ba4", "#c98500"};
  static constexpr const char* dark[] = {"#3987e5", "#d95926", "#199e70", "#9085e9", "#d55181", "#c98500"};
  std::string style =
      "<style>.scene path{fill:none;stroke-linecap:round;stroke-linejoin:round;stroke:#898781}"
      ".scene g{display:none}.scene .arrow{stroke:#898781;stroke-width:1.4}.scene .head{fill:#898781}"
      ".scene .p0{stroke-width:2.5}.scene .p1{stroke-width:7;stroke-opacity:.7}.scene .p2{stroke-width:1.2}";
  std::string night;
  std::vector<std::pair<std::string, std::string>> choices;
  for (int level = 0; level <= last; ++level) {
    choices.emplace_back(std::to_string(level), "level " + std::to_string(level) + " (" +
                                                    std::to_string(p.levels[at(level)].num_subdomains) + ")");
    for (int c = 0; c < num_colors; ++c) {
      const std::string rule = "#scene-" + std::to_string(level) + ":checked~svg .l" + std::to_string(level) + "-" +
                               std::to_string(c) + "{stroke:";
      style += rule + light[c] + "}";
      night += rule + dark[c] + "}";
    }
    style += "#scene-" + std::to_string(level) + ":checked~svg .force-" + std::to_string(level) + "{display:inline}";
  }
  style += "@media (prefers-color-scheme:dark){" + night + "}</style>";
  std::string body = "<div class=\"scene\">" + style + "<span class=\"choose\">Sub-domains of </span>" +
                     radio_buttons("scene", choices, at(std::min(last, 2))) + "<svg viewBox=\"0 0 960 " +
                     pixel(sheet.height) +
                     "\" role=\"img\" aria-label=\"scene by sub-domains\">\n<rect class=\"paper\" x=\"0\" "
                     "y=\"0\" width=\"960\" height=\"" +
                     pixel(sheet.height) + "\"/>\n";
  for (const auto& [leaf, data] : paths) {
    std::string classes;
    const std::vector<int>& own = colors[at(leaf)];
    for (int level = 0; level <= last; ++level)
      classes +=
          " l" + std::to_string(level) + "-" + std::to_string(own[std::min(at(level), own.size() - 1)] % num_colors);
    for (std::size_t kind : {2u, 1u, 0u}) body += path_element("p" + std::to_string(kind) + classes, data[kind]);
  }
  return body + nodes_svg(p, sheet) + forces_svg(p, sheet, last) + "</svg></div>\n";
}

}  // namespace bough::report
