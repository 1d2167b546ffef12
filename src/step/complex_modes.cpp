/// Damped, gyroscopic and circulatory modes.
#include <algorithm>
#include <cmath>

#include "bough/step/krylov.hpp"
#include "bough/step/modes.hpp"
#include "mode_search.hpp"

namespace bough::step {

namespace {

using Part = Linearisation::Part;
using Vector = Linearisation::Vector;
using Complex = std::complex<double>;

constexpr double one_eigenvalue = 1e-3;          ///< relative distance of eigenvalues that may be one
constexpr double two_shapes = 1e-3;              ///< sine of the angle between shapes that are two
constexpr double one_frequency_of_pairs = 1e-7;  ///< the same of magnitudes of modes that are listed together
constexpr double meets_equations = 1e-6;         ///< bound of Mode::residual
constexpr double nearly_meets_equations = 1e-3;  ///< such a mode is none, but there may be one
constexpr int most_starts = 8;

class ComplexSearch {
 public:
  ComplexSearch(Linearisation& linear, const ModesWanted& wanted)
      : linear_(linear),
        wanted_(wanted),
        n_(linear.size()),
        weights_(linear.weights()),
        motion_(n_),
        forces_(n_),
        product_(n_) {}

  ModesFound run() {
    ModesFound result;
    result.is_symmetric = false;
    // The symmetric part tells which motions are rigid and how fast the others are.
    ModesFound undamped = find_undamped_modes(linear_, {2, 0.0});
    if (undamped.cause.empty()) {
      for (Mode& mode : undamped.modes) {
        if (!mode.is_rigid) slowest_ = slowest_ > 0.0 ? std::min(slowest_, mode.frequency()) : mode.frequency();
        if (mode.is_rigid && residual_of(linear_, mode, true) < 1e-8) result.modes.push_back(std::move(mode));
      }
    }
    if (!(slowest_ > 0.0)) slowest_ = std::sqrt(linear_.fastest()) > 0.0 ? std::sqrt(linear_.fastest()) : 1.0;
    scale_ = wanted_.shift > 0.0 ? wanted_.shift : slowest_;
    // A positive shift keeps away from zero, where rigid motions lie, and from all that decays.
    shift_ = wanted_.shift > 0.0 || !result.modes.empty() ? scale_ : 0.25 * scale_;
    if (const auto status = linear_.factor({.damping = shift_, .mass = shift_ * shift_}, solve::Symmetry::general);
        !status.ok()) {
      result.cause = "some motion has neither stiffness, damping nor inertia";
      return result;
    }
    weigh_signals();
    for (int pass = 0; pass < most_starts; ++pass) {
      const std::size_t before = found_.size();
      if (!search(pass)) {
        result.cause = "the solution with the stiffness is not finite";
        return result;
      }
      if (pass > 0 && found_.size() == before) break;
    }
    keep_wanted();
    for (std::size_t k = 0; k < inexact_.size(); ++k)
      if (!found_.empty() && std::abs(inexact_[k]) < found_.back().frequency() && is_new(k)) ++result.inexact;
    for (Mode& mode : found_) result.modes.push_back(std::move(mode));
    return result;
  }

 private:
  /// Signals have units of their own. One is as large as motions of the size of the structure make it by its equation,
  /// and those of its inputs that come before it.
  void weigh_signals() {
    const std::vector<std::size_t>& unknowns = linear_.system().places().signals();
    if (unknowns.empty()) return;
    Vector sizes(n_, 0.0);
    for (std::size_t i = 0; i < n_; ++i)
      if (weights_[i] > 0.0) sizes[i] = 1.0 / std::sqrt(weights_[i]);
    for (const std::size_t unknown : unknowns) sizes[unknown] = 0.0;
    for (std::size_t k = 0; k < unknowns.size(); ++k) {
      linear_.multiply_magnitudes(Part::stiffness, sizes, forces_);
      linear_.multiply_magnitudes(Part::damping, sizes, product_);
      const double sum = forces_[unknowns[k]] + scale_ * product_[unknowns[k]];
      const double own = linear_.system().plan().signals[k].is_state() ? scale_ : 1.0;
      sizes[unknowns[k]] = sum > 0.0 ? sum / own : 1.0;
      weights_[unknowns[k]] = 1.0 / (sizes[unknowns[k]] * sizes[unknowns[k]]);
    }
  }

  /// (x, z / scale) -> (x', z' / scale), with multipliers in the place of x.
  bool apply(const Vector& from, Vector& to) {
    to.resize(2 * n_);
    for (std::size_t i = 0; i < n_; ++i) motion_[i] = linear_.weights()[i] > 0.0 ? from[i] : 0.0;
    const std::span<const double> z(from.data() + n_, n_);
    linear_.multiply(Part::damping, motion_, forces_);
    linear_.multiply(Part::mass, motion_, product_);
    for (std::size_t i = 0; i < n_; ++i) forces_[i] += shift_ * product_[i];
    linear_.multiply(Part::mass, z, product_);
    for (std::size_t i = 0; i < n_; ++i) forces_[i] = -(forces_[i] + scale_ * product_[i]);
    if (!linear_.solve(forces_, std::span(to.data(), n_))) return false;
    for (std::size_t i = 0; i < n_; ++i)
      to[n_ + i] = linear_.weights()[i] > 0.0 ? (motion_[i] + shift_ * to[i]) / scale_ : 0.0;
    return true;
  }

  Complex eigenvalue_of(const Krylov::Ritz& ritz) const { return shift_ + 1.0 / ritz.value; }
  /// Zeros of rigid motions are told by these motions, with multiplicities that the space does not have.
  bool is_zero(const Complex& lambda) const { return std::abs(lambda) < 1e-5 * slowest_; }

  bool search(int pass) {
    Krylov space([this](const Vector& x, Vector& y) { return apply(x, y); },
                 [this](const Vector& x, Vector& y) {
                   y.resize(2 * n_);
                   for (std::size_t i = 0; i < 2 * n_; ++i) y[i] = weights_[i % n_] * x[i];
                   return true;
                 });
    Vector start = random_vector(linear_, 1000U + static_cast<unsigned>(pass));
    const Vector rates = random_vector(linear_, 2000U + static_cast<unsigned>(pass));
    start.insert(start.end(), rates.begin(), rates.end());
    for (std::size_t i = 0; i < 2 * n_; ++i)
      if (weights_[i % n_] > 0.0) start[i] *= std::sqrt(linear_.weights()[i % n_] / weights_[i % n_]);
    Vector in_range;
    if (!apply(start, in_range)) return false;
    if (!space.begin(in_range)) return true;
    const int most = 16 * (wanted_.count + 10);
    std::vector<Krylov::Ritz> ritz;
    for (int size = 3 * wanted_.count + 12;; size += 8) {
      if (!space.extend(std::min(size, most))) return false;
      ritz = space.eigenvalues(false);
      if (space.is_invariant() || size >= most || is_settled(ritz)) break;
    }
    for (const Krylov::Ritz& one : ritz) {
      if (one.residual > converged * std::abs(one.value)) continue;
      const Complex lambda = eigenvalue_of(one);
      if (lambda.imag() < -1e-12 * std::abs(lambda) || is_zero(lambda)) continue;
      take(lambda, space.vector_of(one));
    }
    return true;
  }

  bool is_settled(const std::vector<Krylov::Ritz>& ritz) const {
    int vibrations = 0;
    for (const Krylov::Ritz& one : ritz) {
      if (one.residual > converged * std::abs(one.value)) return false;
      const Complex lambda = eigenvalue_of(one);
      if (!is_zero(lambda) && lambda.imag() > 0.0 && ++vibrations > wanted_.count) return true;
    }
    return false;
  }

  /// Adds a mode that none of those found next to its eigenvalue is, alone or together. Where a space has no more
  /// vectors than round-off, it tells what it has again, less exactly: the one that meets the equations best stays.
  void take(Complex lambda, std::vector<Complex> shape) {
    if (std::abs(lambda.imag()) <= 1e-9 * std::abs(lambda)) lambda = lambda.real();
    shape.resize(n_);
    normalise(shape);
    Mode mode{lambda, shape};
    mode.residual = residual_of(linear_, mode, true);
    if (!(mode.residual < meets_equations)) {  // the others are of vectors that are round-off
      if (mode.residual < nearly_meets_equations) inexact_.push_back(lambda);
      return;
    }
    std::vector<std::vector<Complex>> orthogonal;
    Mode* nearest = nullptr;
    for (Mode& other : found_) {
      const double apart = std::abs(other.eigenvalue - lambda);
      if (apart > one_eigenvalue * std::abs(lambda)) continue;
      orthogonal.push_back(other.shape);
      if (nearest == nullptr || apart < std::abs(nearest->eigenvalue - lambda)) nearest = &other;
    }
    for (std::size_t k = 0; k < orthogonal.size(); ++k) {
      for (std::size_t j = 0; j < k; ++j) remove(orthogonal[j], orthogonal[k]);
      normalise(orthogonal[k]);
      remove(orthogonal[k], shape);
    }
    if (nearest == nullptr || std::sqrt(std::abs(product(shape, shape))) >= two_shapes)
      found_.push_back(std::move(mode));
    else if (mode.residual < nearest->residual)
      *nearest = std::move(mode);
  }
  /// Whether no mode that is listed, and no inexact one before, is near an inexact one.
  bool is_new(std::size_t k) const {
    const auto is_near = [&](Complex other) { return std::abs(other - inexact_[k]) < 1e-2 * std::abs(inexact_[k]); };
    return std::none_of(found_.begin(), found_.end(), [&](const Mode& mode) { return is_near(mode.eigenvalue); }) &&
           std::none_of(inexact_.begin(), inexact_.begin() + static_cast<std::ptrdiff_t>(k), is_near);
  }
  Complex product(const std::vector<Complex>& x, const std::vector<Complex>& y) const {
    Complex sum = 0.0;
    for (std::size_t i = 0; i < n_; ++i) sum += weights_[i] * std::conj(x[i]) * y[i];
    return sum;
  }
  void remove(const std::vector<Complex>& unit, std::vector<Complex>& from) const {
    const Complex along = product(unit, from);
    for (std::size_t i = 0; i < n_; ++i) from[i] -= along * unit[i];
  }
  void normalise(std::vector<Complex>& x) const {
    const double length = std::sqrt(std::abs(product(x, x)));
    if (length > 0.0)
      for (Complex& value : x) value /= length;
  }

  /// The vibrations wanted, nearest to zero or to the shift, and what decays or grows in between without vibrating.
  void keep_wanted() {
    const auto away = [this](const Mode& mode) { return std::abs(std::abs(mode.eigenvalue) - wanted_.shift); };
    std::stable_sort(found_.begin(), found_.end(), [&](const Mode& a, const Mode& b) { return away(a) < away(b); });
    int vibrations = 0;
    double last = 0.0;
    std::size_t kept = 0;
    for (; kept < found_.size(); ++kept) {
      if (vibrations >= wanted_.count && away(found_[kept]) > (1.0 + one_frequency_of_pairs) * last) break;
      last = away(found_[kept]);
      if (found_[kept].vibrates()) ++vibrations;
    }
    found_.resize(kept);
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Mode& a, const Mode& b) { return a.frequency() < b.frequency(); });
  }

  Linearisation& linear_;
  const ModesWanted wanted_;
  const std::size_t n_;
  Vector weights_;                                    ///< those of the equations, but for signals
  double slowest_ = 0.0, scale_ = 1.0, shift_ = 0.0;  ///< [1/s]
  Vector motion_, forces_, product_;
  std::vector<Mode> found_;
  std::vector<Complex> inexact_;
};

}  // namespace

ModesFound find_complex_modes(Linearisation& linear, const ModesWanted& wanted) {
  return ComplexSearch(linear, wanted).run();
}

}  // namespace bough::step
