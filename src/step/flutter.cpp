#include "bough/step/flutter.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

namespace bough::step {

namespace {

using motion::Vec6;
using Vector = Eigen::VectorXd;

constexpr int most_vectors = 40;       ///< of the Krylov space
constexpr double is_found = 1e-6;      ///< relative residual of an eigenvalue that counts
constexpr double least_growth = 1e-3;  ///< relative to the frequency: below this it may be round-off of a double one
constexpr double slowest = 1e-6;       ///< eigenvalues below this part of the largest are not looked at

/// K^-1 M x by unknown, multipliers left out. K is factored.
class InverseTimesMass {
 public:
  InverseTimesMass(System& system, const State& state) : system_(system), state_(state), moved_(state) {
    const plan::Plan& plan = system.plan();
    weights_.setZero(static_cast<Eigen::Index>(system.places().size()));
    std::vector<double> one(system.places().size(), 0.0);
    for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
      const std::int64_t begin = system.places().node_begin(static_cast<int>(n));
      if (begin < 0) continue;
      const int count = plan.unknowns.count_of(n);
      for (int i = 0; i < count; ++i) weights_[begin + i] = plan.unknowns.is_length(i) ? 1.0 / plan.length_scale : 1.0;
    }
    rhs_.resize(system.places().size());
    y_ = rhs_;
  }
  /// In scaled unknowns, lengths over the size of the structure. False: it failed.
  bool apply(const Vector& x, Vector& y) {
    for (std::size_t i = 0; i < y_.size(); ++i) {
      const double w = weights_[static_cast<Eigen::Index>(i)];
      y_[i] = w > 0.0 ? x[static_cast<Eigen::Index>(i)] / w : 0.0;
    }
    if (system_.evaluate(state_, {}, false)) return false;
    rhs_ = system_.right_hand_side();
    for (std::size_t n = 0; n < system_.plan().nodes.size(); ++n)
      set_acceleration(system_.plan(), moved_, n, system_.places().node_part(y_.data(), static_cast<int>(n)));
    if (system_.evaluate(moved_, {}, false)) return false;
    for (std::size_t i = 0; i < rhs_.size(); ++i) rhs_[i] -= system_.right_hand_side()[i];
    if (system_.linear().solve(rhs_.data(), y_.data())) return false;
    y.resize(weights_.size());
    for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = weights_[i] * y_[static_cast<std::size_t>(i)];
    return y.allFinite();
  }
  Vector start() const {
    Vector x(weights_.size());
    for (Eigen::Index i = 0; i < x.size(); ++i)
      x[i] = weights_[i] > 0.0 ? 1.0 + std::sin(static_cast<double>(7 * i + 1)) : 0.0;
    return x;
  }

 private:
  System& system_;
  const State& state_;
  State moved_;
  Vector weights_;
  std::vector<double> rhs_, y_;
};

int largest_node(const System& system, const Eigen::VectorXcd& x) {
  int found = 0;
  double largest = 0.0;
  for (std::size_t n = 0; n < system.plan().nodes.size(); ++n) {
    const std::int64_t begin = system.places().node_begin(static_cast<int>(n));
    if (begin < 0) continue;
    const double size = x.segment(begin, system.plan().unknowns.count_of(n)).squaredNorm();
    if (size <= largest) continue;
    largest = size;
    found = static_cast<int>(n);
  }
  return found;
}

}  // namespace

std::optional<Flutter> find_flutter(System& system, const State& state) {
  system.linear().drop_symmetry();
  if (system.evaluate(state, {}, true) || system.linear().factor(true, {})) return std::nullopt;
  InverseTimesMass operation(system, state);
  std::vector<Vector> basis;
  Vector next;
  if (!operation.apply(operation.start(), next) || !(next.norm() > 0.0)) return std::nullopt;
  basis.push_back(next / next.norm());
  Eigen::MatrixXd projected = Eigen::MatrixXd::Zero(most_vectors + 1, most_vectors);
  int count = 0;
  double size = 0.0;
  while (count < most_vectors) {
    if (!operation.apply(basis.back(), next)) return std::nullopt;
    const double before = next.norm();
    for (int repeated = 0; repeated < 2; ++repeated)
      for (int i = 0; i <= count; ++i) {
        const double along = basis[static_cast<std::size_t>(i)].dot(next);
        projected(i, count) += along;
        next -= along * basis[static_cast<std::size_t>(i)];
      }
    const double rest = next.norm();
    projected(count + 1, count) = rest;
    size = std::max(size, before);
    ++count;
    if (!(rest > 1e-12 * size)) break;  // the space is invariant
    basis.push_back(next / rest);
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(projected.topLeftCorner(count, count));
  if (solver.info() != Eigen::Success) return std::nullopt;
  const double last = projected(count, count - 1), largest = solver.eigenvalues().cwiseAbs().maxCoeff();
  Flutter worst;
  for (int k = 0; k < count; ++k) {
    const std::complex<double> of = solver.eigenvalues()[k];  // 1 / squared frequency
    const Eigen::VectorXcd v = solver.eigenvectors().col(k);
    if (std::abs(of) < slowest * largest || last * std::abs(v[count - 1]) > is_found * std::abs(of) * v.norm())
      continue;
    const std::complex<double> frequency = std::sqrt(1.0 / of);
    const double growth = std::abs(frequency.imag());
    if (growth <= least_growth * std::abs(frequency) || growth <= worst.growth) continue;
    Eigen::VectorXcd x = Eigen::VectorXcd::Zero(next.size());
    for (int i = 0; i < count; ++i) x += v[i] * basis[static_cast<std::size_t>(i)];
    worst = {true, std::abs(frequency.real()), growth, largest_node(system, x)};
    if (worst.frequency < 1e-6 * growth) worst.frequency = 0.0;
  }
  return worst;
}

}  // namespace bough::step
