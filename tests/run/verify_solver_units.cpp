/// The motion of rigid scenes under gravity depends neither on the unit of mass nor on that of length.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "verify_scenes.hpp"

namespace bough::verify {
namespace {

struct Case {
  const char* name;
  double end;
  double tolerance;  ///< of the largest value of the sensor
};

/// Largest difference of any column, relative to the largest of the columns of its sensor.
void expect_same_motion(const Case& c, const std::function<void(scene::Scene&)>& change, double length, double force,
                        const char* what) {
  scene::Scene s = gallery(c.name);
  s.expected.clear();
  s.analysis.end_time = c.end;
  s.analysis.tolerance =
      1e-11;  // below, what Newton leaves would show: 1e-14 of a length is 1e-8 of a force at these steps
  // A new factor for each solution, so that gaps close far below round-off: an old one leaves 1e-16 of a length, 1e-8
  // of a force at steps of 0.1 ms, and rounding decides when it is renewed.
  s.without = {"reuse"};
  const Outcome base = run(s);
  change(s);
  const Outcome other = run(s);
  ASSERT_TRUE(base.ok() && other.ok()) << c.name << ": " << base.text() << other.text();
  ASSERT_EQ(base.rows.size(), other.rows.size()) << c.name;
  double worst = 0.0;
  for (std::size_t q = 0; q < base.header.columns.size(); ++q) {
    const std::string& column = base.header.columns[q];
    const std::string sensor = column.substr(0, column.rfind('.'));
    double most = 0.0, difference = 0.0;
    for (std::size_t p = 0; p < base.header.columns.size(); ++p)
      if (base.header.columns[p].rfind(sensor, 0) == 0)
        for (const records::HistoryRow& row : base.rows) most = std::max(most, std::abs(row.values[p]));
    const double factor = scene::column_factor(s, column, length, force);
    for (std::size_t r = 0; r < base.rows.size(); ++r)
      difference = std::max(difference, std::abs(other.rows[r].values[q] / factor - base.rows[r].values[q]));
    if (column == "energy") most = std::max(most, base.summary.checks.energy_scale);  // parts that nearly cancel
    if (most > 0.0) worst = std::max(worst, difference / most);
    EXPECT_LE(difference, c.tolerance * most) << c.name << ", " << what << ", " << column;
  }
  std::printf("  %s, %s: %.1e\n", c.name, what, worst);
}

/// 1e-9; 1e-8 where a reaction is measured: round-off of a position, 2e-16, over h^2 = 1e-6 is 1e-10 of a force in
/// each step, and rings.
const Case cases[] = {{"pendulum", 0.5, 1e-8},     {"double_pendulum", 0.5, 1e-9}, {"heavy_top", 0.02, 1e-8},
                      {"free_body", 0.5, 1e-9},    {"bricard", 0.1, 1e-9},         {"four_bar_planar", 0.3, 1e-9},
                      {"slider_crank", 0.05, 1e-8}};

TEST(VerifySolverUnits, masses_may_all_be_scaled) {
  for (const Case& c : cases)
    for (const double factor : {1e-6, 1e6})
      expect_same_motion(
          c, [factor](scene::Scene& s) { scene::scale_masses(s, factor); }, 1.0, factor, "masses");
}

TEST(VerifySolverUnits, millimetres_and_tonnes_give_the_same_motion) {
  for (const Case& c : cases) expect_same_motion(c, scene::to_millimetres, 1e3, 1.0, "mm and t");
}

}  // namespace
}  // namespace bough::verify
