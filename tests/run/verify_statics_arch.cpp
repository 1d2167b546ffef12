/// Deep clamped-hinged arch of 215 degrees: the crown is driven down, so the run passes the limit load.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "bough/laws/make_law.hpp"
#include "verify_scenes.hpp"

namespace bough::verify {
namespace {

using std::numbers::pi;

/// R = 100, EI = 1e6, EA = GA = 1e8; clamped left, hinged right; the crown goes down by `depth` at factor 1, as far
/// as it likes sideways.
scene::Scene arch(double depth, int elements_a_half, int order) {
  const double R = 100.0, half = 0.5 * 215.0 * pi / 180.0;
  scene::Scene s;
  s.name = "arch";
  s.sections = {scene::make_section("s", 1e8, 1e8, 1e8, 1e6, 1e6, 1e6)};
  const Vec3<double> left{{-R * std::sin(half), R * std::cos(half), 0.0}},
      right{{R * std::sin(half), R * std::cos(half), 0.0}};
  s.nodes = {scene::make_node("left", left), scene::make_node("crown", {{0, R, 0}}), scene::make_node("right", right)};
  s.beams = {scene::make_beam("left half", "s", "left", "crown", elements_a_half, order),
             scene::make_beam("right half", "s", "crown", "right", elements_a_half, order)};
  for (scene::Beam& b : s.beams) {
    b.curve = scene::BeamCurve::curvature;
    b.curvature = {{0, 0, -1.0 / R}};
    b.length = R * half;
  }
  s.beams[0].tangent = {{std::cos(half), std::sin(half), 0.0}};
  s.beams[1].tangent = {{1, 0, 0}};
  for (scene::Beam& b : s.beams) b.axis_2 = {{-b.tangent[1], b.tangent[0], 0.0}};
  s.joints = {scene::make_weld("clamp", "left")};
  s.joints[0].first.offset.x = left;
  scene::Joint hinge;
  hinge.name = "hinge";
  hinge.kind = scene::JointKind::revolute;
  hinge.first.offset.x = right;
  hinge.second.to = "right";
  s.joints.push_back(hinge);
  scene::PrescribedMotion down;
  down.name = "down";
  down.at.to = "crown";
  down.displacement[1] = laws::make_ramp(0.0, 1.0, 0.0, -depth);
  s.motions = {down};
  s.analysis.kind = scene::AnalysisKind::statics;
  s.analysis.tolerance = 1e-11;
  return s;
}

/// Load on the crown, positive downward, once equilibrium is found; the multiplier of the driven row is the force of
/// the drive along y.
struct Path {
  Direct direct;
  double depth, reached = 0.0;
  explicit Path(double d, int elements, int order) : direct(arch(d, elements, order)), depth(d) {}

  /// Steps that fail are halved, as a run does.
  double load_at(double down) {
    double step = down - reached;
    for (int failures = 0; reached != down;) {
      const double next = std::abs(step) >= std::abs(down - reached) ? down : reached + step;
      const step::State before = direct.state;
      const step::StepReport r = step::equilibrate(direct.system, direct.state, direct.options, next / depth);
      if (r.converged) {
        reached = next;
        continue;
      }
      direct.state = before;
      step *= 0.5;
      if (++failures > 10) throw std::runtime_error("no equilibrium at depth " + std::to_string(next) + ": " + r.cause);
    }
    for (const plan::JointPlan& j : direct.plan.joints)
      if (j.name == "down") return direct.state.multipliers[static_cast<std::size_t>(j.multiplier_begin)];
    return 0.0;
  }
};

struct Limit {
  double load = 0.0, down = 0.0;
  Vec3<double> crown;
};

/// Goes down the path, then finds the largest load by golden sections (equilibria depend on the depth alone here).
Limit find_limit(int elements, int order) {
  Path path(130.0, elements, order);
  const double sign = path.load_at(112.0) < 0.0 ? -1.0 : 1.0;
  double a = 112.0, b = 115.5;
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  double c = b - ratio * (b - a), d = a + ratio * (b - a), fc = sign * path.load_at(c), fd = sign * path.load_at(d);
  while (b - a > 2e-4) {
    if (fc > fd) {
      b = d, d = c, fd = fc;
      c = b - ratio * (b - a);
      fc = sign * path.load_at(c);
    } else {
      a = c, c = d, fc = fd;
      d = a + ratio * (b - a);
      fd = sign * path.load_at(d);
    }
  }
  Limit r;
  r.down = 0.5 * (a + b);
  r.load = sign * path.load_at(r.down);
  r.crown = path.direct.position("crown");
  r.crown[1] -= 100.0;
  return r;
}

TEST(VerifyStatics, deep_arch_meets_its_limit_load_when_the_crown_is_driven) {
  const Limit r = find_limit(12, 3);
  std::printf("  limit load %.6f at crown displacement (%.5f, %.5f)\n", r.load, r.crown[0], r.crown[1]);
  EXPECT_NEAR(r.load, 897.28913, 1e-6 * 897.3 + 5e-6);
  // The load is flat there: the place is known to the square root of what the load is.
  EXPECT_NEAR(r.crown[0], 61.1417, 0.02);
  EXPECT_NEAR(r.crown[1], -113.7307, 0.02);
}

TEST(VerifyStatics, deep_arch_converges_below_the_limit_with_orders_2_4_6) {
  const auto load = [](int elements, int order) {
    Path path(130.0, elements, order);
    return path.load_at(60.0);
  };
  const int coarsest[] = {24, 6, 6};
  const double exact = load(32, 3);
  for (int order = 1; order <= 3; ++order) {
    const int n = coarsest[order - 1];
    const double a = load(n, order), b = load(2 * n, order), c = load(4 * n, order);
    const double p = observed_order(std::abs(a - b), std::abs(b - c)), factor = std::pow(2.0, 2.0 * order);
    const double extrapolated = c + (c - b) / (factor - 1.0);
    std::printf("  order %d: observed %.3f, finest %.2e, extrapolated %.2e\n", order, p, std::abs(c / exact - 1.0),
                std::abs(extrapolated / exact - 1.0));
    EXPECT_NEAR(p, 2.0 * order, 0.2) << order;
    EXPECT_LT(std::min(std::abs(c - exact), std::abs(extrapolated - exact)), 1e-6 * std::abs(exact)) << order;
  }
}

}  // namespace
}  // namespace bough::verify
