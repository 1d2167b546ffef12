#include "bough/report/document.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>
#include <stdexcept>

namespace bough::report {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
  return count;
}

/// y = 3 x^2 at four x, on logarithmic axes.
Chart power_law() {
  Chart chart{"Error over step size", {"step size [s]", Scale::log}, {"error", Scale::log}, {{"second order", {}}}};
  for (const double x : {1e-3, 2e-3, 4e-3, 8e-3}) chart.series[0].points.push_back({x, 3.0 * x * x});
  return chart;
}

/// Points of path data that starts at them: disc marks begin 3.6 px left of their middle.
std::vector<std::pair<double, double>> disc_centers(const std::string& svg) {
  std::vector<std::pair<double, double>> centers;
  const std::regex disc(R"rx(class="point [a-z0-9]+ (?:solid|hollow)" d="M([0-9.]+) ([0-9.]+)a3\.6 [^"]*" data-y)rx");
  for (std::sregex_iterator it(svg.begin(), svg.end(), disc), end; it != end; ++it)
    centers.emplace_back(std::stod((*it)[1]) + 3.6, std::stod((*it)[2]));
  return centers;
}

TEST(Chart, marks_stand_where_the_axes_say) {
  const Chart chart = power_law();
  const ChartFrame f = chart_frame(chart);
  const auto centers = disc_centers(chart_svg(chart));
  ASSERT_EQ(centers.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    const ChartPoint& p = chart.series[0].points[k];
    EXPECT_NEAR(centers[k].first, f.to_x(std::log10(p.x)), 0.06) << "coordinates are written to a twentieth of a pixel";
    EXPECT_NEAR(centers[k].second, f.to_y(std::log10(p.y)), 0.06);
    EXPECT_GT(centers[k].first, f.left);
    EXPECT_LT(centers[k].first, f.right);
    EXPECT_GT(centers[k].second, f.top);
    EXPECT_LT(centers[k].second, f.bottom);
  }
}

TEST(Chart, a_point_that_is_not_finite_is_left_out_and_breaks_the_line) {
  Chart chart = power_law();
  chart.series[0].points[1].y = nan;
  const std::string svg = chart_svg(chart);
  EXPECT_EQ(disc_centers(svg).size(), 3u);
  const std::smatch line = [&svg] {
    std::smatch m;
    std::regex_search(svg, m, std::regex(R"rx(class="curve s0" d="([^"]*)")rx"));
    return m;
  }();
  ASSERT_FALSE(line.empty());
  EXPECT_EQ(count_of(line[1], "M"), 2u);
  EXPECT_EQ(count_of(svg, "nan"), 0u);
}

TEST(Chart, an_error_of_zero_stands_hollow_on_the_lower_edge) {
  Chart chart = power_law();
  chart.series[0].points[0].y = 0.0;
  const auto centers = disc_centers(chart_svg(chart));
  EXPECT_EQ(count_of(chart_svg(chart), " hollow\""), 1u);
  ASSERT_EQ(centers.size(), 4u);
  EXPECT_NEAR(centers[0].second, chart_frame(chart).bottom, 0.06);
}

TEST(Chart, failures_are_crosses_above_the_plot_with_their_cause) {
  Chart chart = power_law();
  EXPECT_EQ(count_of(chart_svg(chart), "class=\"fail\""), 0u);
  chart.series[0].failures = {{1.6e-2, 0.0, "no convergence <20>"}, {1.6e-2, 0.0, "another"}};
  const std::string svg = chart_svg(chart);
  EXPECT_EQ(count_of(svg, "class=\"fail\""), 2u);
  EXPECT_NE(svg.find("no convergence &lt;20&gt;"), std::string::npos);
  std::vector<double> left;
  const std::regex cross(R"rx(class="fail" d="M([0-9.]+) ([0-9.]+)L)rx");
  for (std::sregex_iterator it(svg.begin(), svg.end(), cross), end; it != end; ++it) {
    left.push_back(std::stod((*it)[1]));
    EXPECT_LT(std::stod((*it)[2]), chart_frame(chart).top);
  }
  ASSERT_EQ(left.size(), 2u);
  EXPECT_GT(std::abs(left[0] - left[1]), 7.0) << "beside each other, not over each other";
}

TEST(Chart, a_slope_line_is_straight_has_its_slope_and_stays_inside) {
  Chart chart = power_law();
  chart.slopes = {{1e-3, 1e-6, 2.0, "2"}};
  const std::string svg = chart_svg(chart);
  std::smatch m;
  ASSERT_TRUE(
      std::regex_search(svg, m, std::regex(R"rx(class="guide" d="M([0-9.]+) ([0-9.]+)L([0-9.]+) ([0-9.]+)")rx")));
  const ChartFrame f = chart_frame(chart);
  const double x1 = std::stod(m[1]), y1 = std::stod(m[2]), x2 = std::stod(m[3]), y2 = std::stod(m[4]);
  for (const double x : {x1, x2}) EXPECT_TRUE(x >= f.left - 0.06 && x <= f.right + 0.06) << x;
  for (const double y : {y1, y2}) EXPECT_TRUE(y >= f.top - 0.06 && y <= f.bottom + 0.06) << y;
  const double per_decade_x = (f.right - f.left) / (f.x_high - f.x_low),
               per_decade_y = (f.bottom - f.top) / (f.y_high - f.y_low);
  EXPECT_NEAR((y1 - y2) / per_decade_y / ((x2 - x1) / per_decade_x), 2.0, 0.01);
  chart.slopes.front().is_below = true;  // the label is beneath the lower end then, on the side away from the line
  const std::string below = chart_svg(chart);
  std::smatch at;
  ASSERT_TRUE(
      std::regex_search(below, at, std::regex(R"rx(<text class="tiny soft" x="([0-9.]+)" y="([0-9.]+)"[^>]*>2<)rx")));
  EXPECT_GT(std::stod(at[1]), std::stod(m[1]));
  EXPECT_LT(std::abs(std::stod(at[2]) - std::max(std::stod(m[2]), std::stod(m[4]))), 8.0);
  chart.slopes = {{1e-3, 1e6, 2.0, "far away"}};
  EXPECT_EQ(count_of(chart_svg(chart), "class=\"guide\""), 0u);
}

TEST(Chart, nothing_to_draw_is_drawn_as_empty_axes) {
  Chart chart{"Nothing", {"x", Scale::log}, {"y", Scale::linear}, {}};
  EXPECT_NE(chart_svg(chart).find("</svg>"), std::string::npos);
  chart.series = {{"one point", {{1.0, 5.0}}}};
  EXPECT_EQ(disc_centers(chart_svg(chart)).size(), 1u);
  EXPECT_EQ(count_of(chart_svg(chart), "nan"), 0u);
}

Document sample_page() {
  Document page("Errors & times", "What was <measured>.", "sample.json");
  page.section("Section", "one");
  page.paragraph("1 < 2 & \"so on\"");
  page.list({"<li>"});
  page.table({{"what", "value"}, {{{"x", Tone::bad}, number_cell(1.23456789e-5, 4, "/runs/0/error")}}, "A table"});
  Chart chart = power_law();
  chart.series.push_back({"first order", {{1e-3, 1e-3}, {1e-2, 1e-2}}, {{2e-2, 0.0, "no convergence"}}});
  chart.slopes = {{1e-3, 1e-6, 2.0, "order 2"}};
  page.charts({chart, chart});
  return page;
}

TEST(Document, everything_is_escaped) {
  const std::string html = sample_page().html();
  EXPECT_NE(html.find("<title>Errors &amp; times</title>"), std::string::npos);
  EXPECT_NE(html.find("What was &lt;measured&gt;."), std::string::npos);
  EXPECT_NE(html.find("1 &lt; 2 &amp; &quot;so on&quot;"), std::string::npos);
  EXPECT_NE(html.find("<li>&lt;li&gt;</li>"), std::string::npos);
}

TEST(Document, needs_neither_scripts_nor_the_network) {
  const std::string html = sample_page().html();
  EXPECT_EQ(count_of(html, "<script"), 0u);
  EXPECT_EQ(count_of(html, "http"), 2u + 1u) << "the name space of two drawings, and one http-equiv";
  EXPECT_EQ(count_of(html, "src="), 0u);
}

TEST(Document, numbers_name_their_source) {
  EXPECT_NE(sample_page().html().find("<td class=\"number\" data-source=\"/runs/0/error\">1.235e-05</td>"),
            std::string::npos);
  EXPECT_NE(sample_page().html().find("<main data-file=\"sample.json\">"), std::string::npos);
  EXPECT_EQ(number_cell(nan).text, "-");
}

TEST(Document, a_row_of_another_length_is_a_mistake_of_the_caller) {
  Document page("x");
  EXPECT_THROW(page.table({{"one", "two"}, {{{"only"}}}}), std::logic_error);
}

// A second series runs along the line where its label would stand at first: beneath the lower end.
TEST(Chart, the_label_of_a_slope_keeps_off_lines_and_marks) {
  Chart chart = power_law();
  chart.series.push_back({"lower", {}});
  for (const double x : {1e-3, 2e-3, 4e-3, 8e-3}) chart.series[1].points.push_back({x, 0.7 * x * x});
  chart.slopes = {{1e-3, 1e-6, 2.0, "order 2", true}};
  const ChartFrame f = chart_frame(chart);
  const std::string svg = chart_svg(chart);
  const std::regex label(
      R"rx(<text class="tiny soft" x="([0-9.]+)" y="([0-9.]+)" text-anchor="(start|end)">order 2<)rx");
  std::smatch at;
  ASSERT_TRUE(std::regex_search(svg, at, label));
  const double width = 6.6 * 7, x = std::stod(at[1]), y = std::stod(at[2]), left = at[3] == "end" ? x - width : x;
  EXPECT_GE(left, f.left);
  EXPECT_LE(left + width, f.right);
  const auto lies_on = [&](double factor) {
    for (double lx = left; lx <= left + width; lx += 0.5) {
      const double log_x = f.x_low + (lx - f.left) / (f.right - f.left) * (f.x_high - f.x_low);
      if (log_x < -3.0 || log_x > std::log10(8e-3)) continue;
      const double ly = f.to_y(std::log10(factor) + 2.0 * log_x);
      if (ly > y - 10.0 && ly < y + 3.0) return true;
    }
    return false;
  };
  EXPECT_FALSE(lies_on(3.0));
  EXPECT_FALSE(lies_on(0.7));
  EXPECT_FALSE(lies_on(1.0)) << "its own line";
}

TEST(Document, a_table_too_wide_for_the_page_goes_on_below_with_its_first_column) {
  Document page("wide", "", "wide.json");
  Table table{{"case"}, {{{"one"}}, {{"two"}}}, "Once"};
  for (int c = 0; c < 20; ++c) {
    table.head.push_back("column " + std::to_string(c));
    for (std::size_t r = 0; r < 2; ++r) table.rows[r].push_back(number_cell(1234.5 + c, 6));
  }
  page.table(table);
  const std::string html = page.html();
  const std::size_t parts = count_of(html, "<table class=\"cards") + count_of(html, "<table>");
  EXPECT_GE(parts, 2u);
  EXPECT_EQ(count_of(html, "<th>case</th>"), parts);
  EXPECT_EQ(count_of(html, "<td data-label=\"case\">two</td>") + count_of(html, "<td>two</td>"), parts);
  EXPECT_EQ(count_of(html, "<caption>"), 1u);
  for (int c = 0; c < 20; ++c) EXPECT_EQ(count_of(html, ">column " + std::to_string(c) + "</th>"), 1u) << c;
  EXPECT_EQ(count_of(html, "<td class=\"number\""), 40u);
  for (int c = 0; c < 20; ++c)
    EXPECT_LE(count_of(html, "data-label=\"column " + std::to_string(c) + "\""), 2u) << "a line of each row's card";
}

}  // namespace
}  // namespace bough::report
