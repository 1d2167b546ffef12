#pragma once
/// A clamped chain of beam elements with a load at its end, solved by a dense Newton: the smallest static model.
#include <Eigen/Dense>

#include "elements/check_element.hpp"

namespace bough::elements::check {

template <int N>
struct Chain {
  std::vector<Beam<N>> beams;
  std::vector<NodeMotion> nodes;  ///< node 0 is held
  PointLoad load;                 ///< at the last node, times `factor`
  double factor = 1.0;
  int iterations = 0;           ///< of the last load step
  std::vector<double> changes;  ///< largest increments of its iterations
};

/// `count` elements along poses given by a function of the arc length.
template <int N, class Pose>
Chain<N> make_chain(int count, double length, const Mat6<double>& stiffness, const Pose& pose) {
  Chain<N> c;
  const int last = count * (N - 1);
  for (int k = 0; k <= last; ++k) {
    const Frame<double> H = pose(length * k / last);
    const Vec6<double> none = Vec6<double>::zero();
    c.nodes.push_back({H.R, motion::Vec3Pair::from(H.x), none, none, none, {}});
  }
  for (int k = 0; k < count; ++k) {
    Beam<N> b;
    b.length = length / count;
    b.stiffness = stiffness;
    b.damping = b.mass = Mat6<double>::zero();
    PortMotion<double> p[N];
    for (int i = 0; i < N; ++i) {
      b.ports[i] = port_at(k * (N - 1) + i);
      p[i] = eval_port(b.ports[i], c.nodes.data(), motion::Vec3Pair::from(Vec3<double>::zero()));
    }
    set_reference(b, p);
    c.beams.push_back(b);
  }
  c.load.ports[0] = port_at(last);
  c.load.wrench = Vec6<double>::zero();
  return c;
}

/// Adds one element to the system without node 0.
template <class E>
void assemble(const E& e, const Field& field, Eigen::MatrixXd& K, Eigen::VectorXd& r) {
  constexpr int n = 6 * E::num_ports;
  double residual[n], tangent[n * n];
  evaluate(e, field, nullptr, 0.0, residual, tangent);
  const auto at = [&e](int i) { return 6 * (e.ports[i / 6].node - 1) + i % 6; };
  for (int i = 0; i < n; ++i) {
    if (at(i) < 0) continue;
    r[at(i)] += residual[i];
    for (int j = 0; j < n; ++j)
      if (at(j) >= 0) K(at(i), at(j)) += tangent[i * n + j];
  }
}

/// Newton in `steps` equal load steps; false when one does not converge to an increment below `tolerance`.
template <int N>
bool solve(Chain<N>& c, int steps, double tolerance = 1e-11) {
  const auto size = static_cast<Eigen::Index>(6 * (c.nodes.size() - 1));
  for (int step = 1; step <= steps; ++step) {
    const double law = c.factor * step / steps;
    double change = 1.0;
    c.changes.clear();
    for (c.iterations = 0; change > tolerance; ++c.iterations) {
      if (c.iterations == 60) return false;
      const Field field{c.nodes.data(), {Vec3<double>::zero(), &law, false}, {}};
      Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size, size);
      Eigen::VectorXd r = Eigen::VectorXd::Zero(size);
      for (const Beam<N>& b : c.beams) assemble(b, field, K, r);
      assemble(c.load, field, K, r);
      const Eigen::VectorXd eta = -K.partialPivLu().solve(r);
      change = eta.lpNorm<Eigen::Infinity>();
      c.changes.push_back(change);
      const double part = change > 0.5 ? 0.5 / change : 1.0;  // no node turns by more than half a radian at once
      for (std::size_t k = 1; k < c.nodes.size(); ++k) {
        Vec6<double> own;
        for (int i = 0; i < 6; ++i) own[i] = part * eta[static_cast<Eigen::Index>(6 * (k - 1)) + i];
        const Frame<double> H = motion::exp_se3(own);
        c.nodes[k].x.add(c.nodes[k].R * H.x);
        c.nodes[k].R = c.nodes[k].R * H.R;
      }
    }
  }
  return true;
}

template <int N>
Frame<double> end_of(const Chain<N>& c) {
  return {c.nodes.back().R, c.nodes.back().x.hi};
}
inline double distance(const Vec3<double>& a, const Vec3<double>& b) {
  const Vec3<double> d = a - b;
  return std::sqrt(lanes::dot(d, d));
}
inline Mat6<double> diagonal(const Vec6<double>& d) {
  Mat6<double> m = Mat6<double>::zero();
  for (int i = 0; i < 6; ++i) m(i, i) = d[i];
  return m;
}
inline Frame<double> straight(double s) { return {Mat3<double>::identity(), Vec3<double>{{s, 0.0, 0.0}}}; }

}  // namespace bough::elements::check
