#include "planar_rod.hpp"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <stdexcept>

namespace bough::stress {

namespace {

using Values = std::array<double, 4>;  // x, y, theta, moment

Values slope_of(const RodPiece& p, const Values& v, double fx, double fy) {
  const double c = std::cos(v[2]), s = std::sin(v[2]);
  const double stretch = 1.0 + (fx * c + fy * s) / p.EA, shear = (fy * c - fx * s) / p.GA;
  const double dx = stretch * c - shear * s, dy = stretch * s + shear * c;
  return {dx, dy, p.curvature + v[3] / p.EI, dy * fx - dx * fy};
}

}  // namespace

double RodSection::normal_force() const { return fx * std::cos(theta) + fy * std::sin(theta); }
double RodSection::shear_force() const { return fy * std::cos(theta) - fx * std::sin(theta); }

RodSection along(const RodPiece& piece, RodSection start, int steps) {
  Values v = {start.x, start.y, start.theta + piece.kink, start.moment};
  const double h = piece.length / steps;
  const auto moved = [&v](const Values& slope, double by) {
    Values w = v;
    for (std::size_t i = 0; i < w.size(); ++i) w[i] += by * slope[i];
    return w;
  };
  for (int k = 0; k < steps; ++k) {
    const Values a = slope_of(piece, v, start.fx, start.fy);
    const Values b = slope_of(piece, moved(a, 0.5 * h), start.fx, start.fy);
    const Values c = slope_of(piece, moved(b, 0.5 * h), start.fx, start.fy);
    const Values d = slope_of(piece, moved(c, h), start.fx, start.fy);
    for (std::size_t i = 0; i < v.size(); ++i) v[i] += h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
  }
  return {v[0], v[1], v[2], v[3], start.fx, start.fy};
}

std::vector<double> shoot(const std::function<std::vector<double>(const std::vector<double>&)>& residuals,
                          std::vector<double> guess, double tolerance) {
  const auto n = static_cast<Eigen::Index>(guess.size());
  const auto at = [](Eigen::Index i) { return static_cast<std::size_t>(i); };
  for (int iteration = 0; iteration < 60; ++iteration) {
    const std::vector<double> r = residuals(guess);
    double most = 0.0;
    for (const double v : r) most = std::max(most, std::abs(v));
    if (most <= tolerance) return guess;
    Eigen::MatrixXd J(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      std::vector<double> moved = guess;
      const double step = 1e-7 * std::max(1.0, std::abs(guess[at(j)]));
      moved[at(j)] += step;
      const std::vector<double> other = residuals(moved);
      for (Eigen::Index i = 0; i < n; ++i) J(i, j) = (other[at(i)] - r[at(i)]) / step;
    }
    const Eigen::VectorXd change = J.partialPivLu().solve(Eigen::Map<const Eigen::VectorXd>(r.data(), n));
    for (Eigen::Index j = 0; j < n; ++j) guess[at(j)] -= change(j);
  }
  throw std::runtime_error("the reference by shooting does not converge");
}

std::vector<RodSection> cantilever_rod(const std::vector<RodPiece>& pieces, double fx, double fy) {
  double length = 0.0;
  for (const RodPiece& p : pieces) length += p.length;
  const double size = std::hypot(fx, fy) * length;
  std::vector<RodSection> sections;
  const auto walk = [&](double moment, double part) {
    sections.assign(1, {0.0, 0.0, 0.0, moment, part * fx, part * fy});
    for (const RodPiece& p : pieces) sections.push_back(along(p, sections.back()));
    return sections.back().moment;
  };
  std::vector<double> moment{0.0};
  for (int k = 1; k <= 8; ++k)
    moment =
        shoot([&](const std::vector<double>& m) { return std::vector<double>{walk(m[0], k / 8.0) / size}; }, moment);
  walk(moment[0], 1.0);
  return sections;
}

}  // namespace bough::stress
