// The disc on a turning shaft against data/reference/razi_unit_disc.csv (closed form) and the figures of its source.
#include "bough/motion/spinning_disc.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "support/source_dir.hpp"

namespace bough::motion {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

AccelerationParts parts_at(double lean_deg, double psi_deg) {
  const SpinningDisc disc{1.0, 1.0, lean_deg * degree, 1.0};
  return acceleration_split(chain_of(disc, psi_deg * degree), point_of(disc), From(0), In(1));
}

/// Half a unit of the last of the 12 printed digits, and the round-off of psi near the zeros.
double half_digit(double printed) {
  const double round_off = 1e-15;
  return printed == 0.0 ? round_off
                        : 0.5 * std::pow(10.0, std::floor(std::log10(std::abs(printed))) - 11.0) + round_off;
}

TEST(SpinningDisc, meets_the_reference_to_all_printed_digits) {
  std::ifstream in(support::source_dir() / "data" / "reference" / "razi_unit_disc.csv");
  ASSERT_TRUE(in.good());
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line.substr(0, line.find('\r')), "lean_deg,psi_deg,|centripetal|,|razi|,|total|,razi_x,razi_y,razi_z");
  int rows = 0;
  for (; std::getline(in, line); ++rows) {
    std::istringstream cells(line);
    double v[8];
    for (double& x : v) {
      cells >> x;
      cells.ignore();
    }
    const AccelerationParts p = parts_at(v[0], v[1]);
    EXPECT_NEAR(norm(p.centripetal), v[2], half_digit(v[2])) << line;
    EXPECT_NEAR(norm(p.razi), v[3], half_digit(v[3])) << line;
    EXPECT_NEAR(norm(p.total()), v[4], half_digit(v[4])) << line;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(p.razi.components(In(1))[i], v[5 + i], half_digit(v[5 + i])) << line;
    for (const Resolved& none : {p.local, p.tangential, p.coriolis, p.origin}) EXPECT_EQ(norm(none), 0.0);
  }
  EXPECT_EQ(rows, 100);
}

TEST(SpinningDisc, perpendicular_axes_have_closed_forms) {
  const AccelerationParts at_0 = parts_at(90.0, 0.0), at_90 = parts_at(90.0, 90.0);
  EXPECT_NEAR(norm(at_0.centripetal), std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(norm(at_0.razi), 1.0, 1e-15);
  EXPECT_NEAR(norm(at_0.total()), std::sqrt(5.0), 1e-15);
  EXPECT_NEAR(norm(at_90.centripetal), 2.0, 1e-15);
  EXPECT_NEAR(norm(at_90.razi), 0.0, 1e-15);
  EXPECT_NEAR(norm(at_90.total()), 2.0, 1e-15);
}

}  // namespace
}  // namespace bough::motion
