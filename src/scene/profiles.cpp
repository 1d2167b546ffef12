#include "profiles.hpp"

#include <cmath>

namespace bough::scene {
namespace {

using Point = std::array<double, 2>;

struct Sums {
  double area = 0.0, center[2] = {0.0, 0.0}, I2 = 0.0, I3 = 0.0, I23 = 0.0;
};

double length_of(const Wall& w) { return std::hypot(w.end[0] - w.begin[0], w.end[1] - w.begin[1]); }

/// Area moments of the middle lines: the integrals that balance the shear flow.
Sums sums_of(const std::vector<Wall>& walls) {
  Sums s;
  for (const Wall& w : walls) {
    const double A = length_of(w) * w.thickness;
    s.area += A;
    for (std::size_t k = 0; k < 2; ++k) s.center[k] += 0.5 * A * (w.begin[k] + w.end[k]);
  }
  for (double& c : s.center) c /= s.area;
  for (const Wall& w : walls) {
    const double A = length_of(w) * w.thickness;
    const double a2 = w.begin[0] - s.center[0], a3 = w.begin[1] - s.center[1];
    const double b2 = w.end[0] - s.center[0], b3 = w.end[1] - s.center[1];
    s.I3 += A * (a2 * a2 + a2 * b2 + b2 * b2) / 3.0;
    s.I2 += A * (a3 * a3 + a3 * b3 + b3 * b3) / 3.0;
    s.I23 += A * (2.0 * (a2 * a3 + b2 * b3) + a2 * b3 + b2 * a3) / 6.0;
  }
  return s;
}

/// q(s) along a wall for one direction of the force: value at the begin, slope and curvature in s/length.
struct Flow {
  double c0 = 0.0, c1 = 0.0, c2 = 0.0;
  double operator()(double s) const { return c0 + s * (c1 + s * c2); }
};

std::vector<Flow> flows_of(const std::vector<Wall>& walls, const Sums& sums, double Q2, double Q3) {
  const double determinant = sums.I2 * sums.I3 - sums.I23 * sums.I23;
  const double a2 = (sums.I2 * Q2 - sums.I23 * Q3) / determinant, a3 = (sums.I3 * Q3 - sums.I23 * Q2) / determinant;
  std::vector<Flow> flows(walls.size());
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const Wall& w = walls[k];
    const double A = length_of(w) * w.thickness;
    const auto stress = [&](const Point& x) { return a2 * (x[0] - sums.center[0]) + a3 * (x[1] - sums.center[1]); };
    for (const std::size_t b : w.before) flows[k].c0 += flows[b](1.0);
    flows[k].c1 = -A * stress(w.begin);
    flows[k].c2 = -0.5 * A * (stress(w.end) - stress(w.begin));
  }
  return flows;
}

/// int_0^1 p q ds of two parabolas.
double product_of(const Flow& p, const Flow& q) {
  return p.c0 * q.c0 + (p.c0 * q.c1 + p.c1 * q.c0) / 2.0 + (p.c0 * q.c2 + p.c1 * q.c1 + p.c2 * q.c0) / 3.0 +
         (p.c1 * q.c2 + p.c2 * q.c1) / 4.0 + p.c2 * q.c2 / 5.0;
}

}  // namespace

WallFigures eval_walls(const std::vector<Wall>& walls) {
  const Sums sums = sums_of(walls);
  const std::vector<Flow> along_2 = flows_of(walls, sums, 1.0, 0.0), along_3 = flows_of(walls, sums, 0.0, 1.0);
  WallFigures f;
  f.area = sums.area;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const Wall& w = walls[k];
    const double l = length_of(w), t = w.thickness;
    f.compliance_22 += l / t * product_of(along_2[k], along_2[k]);
    f.compliance_33 += l / t * product_of(along_3[k], along_3[k]);
    f.compliance_23 += l / t * product_of(along_2[k], along_3[k]);
    const double arm = (w.begin[0] - sums.center[0]) * (w.end[1] - w.begin[1]) -
                       (w.begin[1] - sums.center[1]) * (w.end[0] - w.begin[0]);
    const Flow one{1.0, 0.0, 0.0};
    f.shear_center_2 += arm * product_of(along_3[k], one);
    f.shear_center_3 -= arm * product_of(along_2[k], one);
    f.open_torsion += l * t * t * t / 3.0;
  }
  return f;
}

std::vector<Wall> walls_of(const IProfile& s) {
  const double a = 0.5 * s.width, h = 0.5 * (s.height - s.flange);
  return {{{-a, h}, {0, h}, s.flange, {}},
          {{a, h}, {0, h}, s.flange, {}},
          {{0, h}, {0, -h}, s.web, {0, 1}},
          // The flow divides in the lower flange: each half is followed from its free edge, against the flow.
          {{-a, -h}, {0, -h}, s.flange, {}},
          {{a, -h}, {0, -h}, s.flange, {}}};
}

std::vector<Wall> walls_of(const CProfile& s) {
  const double a = s.width - 0.5 * s.web, h = 0.5 * (s.height - s.flange);
  return {{{a, h}, {0, h}, s.flange, {}}, {{0, h}, {0, -h}, s.web, {0}}, {{0, -h}, {a, -h}, s.flange, {1}}};
}

std::vector<Wall> walls_of(const LProfile& s) {
  const double a = s.width - 0.5 * s.thickness, h = s.height - 0.5 * s.thickness;
  return {{{0, h}, {0, 0}, s.thickness, {}}, {{0, 0}, {a, 0}, s.thickness, {0}}};
}

std::vector<Wall> walls_of(const HollowBox& s, bool for_force_along_3) {
  const double a = 0.5 * (s.width - s.thickness), h = 0.5 * (s.height - s.thickness), t = s.thickness;
  if (for_force_along_3)
    return {{{0, h}, {a, h}, t, {}},  {{a, h}, {a, -h}, t, {0}},   {{a, -h}, {0, -h}, t, {1}},
            {{0, h}, {-a, h}, t, {}}, {{-a, h}, {-a, -h}, t, {3}}, {{-a, -h}, {0, -h}, t, {4}}};
  return {{{a, 0}, {a, h}, t, {}},  {{a, h}, {-a, h}, t, {0}},   {{-a, h}, {-a, 0}, t, {1}},
          {{a, 0}, {a, -h}, t, {}}, {{a, -h}, {-a, -h}, t, {3}}, {{-a, -h}, {-a, 0}, t, {4}}};
}

}  // namespace bough::scene
