#include "bough/report/split_plot.hpp"

#include <gtest/gtest.h>

#include "bough/study/frames.hpp"

namespace bough::report {
namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
  return count;
}

TEST(SplitPlot, draws_a_panel_for_each_pair_of_speeds_and_only_parts_that_are_there) {
  const std::string svg = split_svg(study::split_disc({}));
  EXPECT_EQ(count_of(svg, "<g transform"), 6u);
  EXPECT_EQ(count_of(svg, "</g>"), 6u);
  EXPECT_EQ(count_of(svg, "<path class=\"curve s1\""), 6u + 1u);  // Razi: panels and legend
  EXPECT_EQ(count_of(svg, ">razi<"), 1u);
  EXPECT_EQ(count_of(svg, ">coriolis<"), 0u);
  EXPECT_NE(svg.find("spin 4, precession 2 rad/s"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(SplitPlot, many_rows_stay_a_small_drawing) {
  const std::string few = split_svg(study::split_disc({{{5, 1}}, 45.0, 1.0, 2000}));
  const std::string many = split_svg(study::split_disc({{{5, 1}}, 45.0, 1.0, 200000}));
  EXPECT_LT(many.size(), 2 * few.size());
}

TEST(SplitPlot, a_point_at_rest_is_drawn_without_dividing_by_zero) {
  const std::string svg = split_svg(study::split_disc({{{0, 0}}, 45.0, 1.0, 10}));
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace bough::report
