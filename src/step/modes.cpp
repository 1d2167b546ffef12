/// Undamped modes.
#include "bough/step/modes.hpp"

#include <algorithm>
#include <cmath>

#include "bough/step/krylov.hpp"
#include "mode_search.hpp"

namespace bough::step {

namespace {

using Part = Linearisation::Part;
using Vector = Linearisation::Vector;

constexpr double one_frequency = 1e-6;  ///< relative distance of squared frequencies that are taken for one
constexpr double nearly_found = 1e-3;   ///< relative residual at which the place of an eigenvalue is known
constexpr double of_fastest = 1e-12;    ///< shift where the stiffness is singular, over the largest K_ii / M_ii
constexpr double round_off_of_fastest = 0x1p-46;  ///< a squared frequency below this part of the largest is zero
constexpr double above_noise = 1e3;               ///< the same over the round-off of the energy of a rigid motion

/// A mode whose shape has unit modal mass.
struct Found {
  double square;  ///< omega^2
  Vector shape;
};

class Search {
 public:
  Search(Linearisation& linear, const ModesWanted& wanted)
      : linear_(linear),
        wanted_(wanted),
        sigma_(wanted.shift * wanted.shift),
        fastest_(linear.fastest()),
        forces_(linear.size()) {}

  ModesFound run() {
    ModesFound result;
    if (!prepare()) return failed(trouble_);
    if (wanted_.shift == 0.0 && !find_rigid()) return failed(trouble_);
    for (int pass = 0; pass < most_passes && !is_complete(); ++pass) {
      const std::size_t before = found_.size();
      if (!search(pass)) return failed(trouble_);
      if (pass == 0 && !expected_ && !count_in_bounds()) break;
      if (found_.size() == before) break;
    }
    trim();
    if (expected_) result.missing = *expected_ - num_in_bounds();
    for (const Vector& shape : rigid_) result.modes.push_back(make_mode({0.0, shape}));
    for (const Found& one : found_) result.modes.push_back(make_mode(one));
    return result;
  }

 private:
  static constexpr int most_passes = 64;
  static constexpr std::size_t most_rigid = 100, most_of_a_body = 7;

  static ModesFound failed(const std::string& cause) {
    ModesFound result;
    result.cause = cause;
    return result;
  }

  bool factor(double sigma) { return linear_.factor({.mass = -sigma}, solve::Symmetry::symmetric).ok(); }

  /// Factors K - sigma M. Motions without resistance make K singular, or nearly so; and bodies that constraints hold
  /// have no stiffness of their own, so that without their mass they have pivots that cannot be told from zero.
  bool prepare() {
    if (linear_.num_rows() == 0 || sigma_ > 0.0) {
      if (factor(sigma_)) return true;
      if (wanted_.shift > 0.0) return factor(sigma_ *= 1.0 + 1e-6);  // it was an eigenvalue
    }
    sigma_ = fastest_ > 0.0 ? -of_fastest * fastest_ : -1.0;
    if (factor(sigma_)) return true;
    trouble_ = "some motion has neither stiffness nor inertia";
    return false;
  }

  bool apply(const Vector& x, Vector& y) {
    y.resize(x.size());
    linear_.multiply(Part::mass, x, forces_);
    return linear_.solve(forces_, y);
  }
  Krylov make_space() {
    Krylov space([this](const Vector& x, Vector& y) { return apply(x, y); },
                 [this](const Vector& x, Vector& y) {
                   y.resize(x.size());
                   linear_.multiply(Part::mass, x, y);
                   return true;
                 });
    for (const Vector& shape : rigid_) space.lock(shape);
    for (const Found& one : found_) space.lock(one.shape);
    return space;
  }
  bool takes_no_energy(const Vector& x, double energy) const {
    return std::abs(energy) <= std::max(linear_.round_off(Part::stiffness, x), round_off_of_fastest * fastest_);
  }
  double energy(const Vector& x) {  // without multipliers, since G x = 0
    linear_.multiply(Part::stiffness, motion_of(linear_, x), forces_);
    double sum = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (linear_.weights()[i] > 0.0) sum += x[i] * forces_[i];
    return sum;
  }

  /// Motions that take no energy but for round-off, one after the other by inverse iteration. Such a motion may still
  /// have a part of others by the root of that round-off, which further iterations remove.
  bool find_rigid() {
    constexpr int most_iterations = 16, purging = 3;
    Vector next;
    for (bool is_rigid = true; is_rigid;) {
      if (rigid_.size() > most_rigid || (rigid_.size() == most_of_a_body && !are_few()))
        return fail("more than " + std::to_string(most_rigid) +
                    " motions have no resistance, as where a mechanism is not yet loaded by what gives it its shape");
      Krylov space = make_space();
      Vector x = random_vector(linear_, static_cast<unsigned>(rigid_.size()));
      double last = 0.0;
      int without_energy = 0;
      for (int k = 0; k < most_iterations && without_energy <= purging; ++k) {
        if (!space.normalise(x)) return !rigid_.empty() || fail("nothing that can move has mass");
        if (!apply(x, next)) return fail("the solution with the stiffness is not finite");
        const double size = space.length(next);
        if (!(size > 0.0) || !space.normalise(next)) return !rigid_.empty() || fail("nothing that can move has mass");
        x = next;
        const double now = energy(x);
        // A rigid motion is stretched by 1 / -sigma; round-off of those that are locked is not.
        const bool is_stretched = sigma_ >= 0.0 || -sigma_ * size > 0.5;
        without_energy = takes_no_energy(x, now) && is_stretched ? without_energy + 1 : 0;
        if (without_energy == 1 && sigma_ == 0.0 && !shift_below(x)) return false;
        if (k > 1 && without_energy == 0 && std::abs(now - last) < 0.1 * std::abs(now)) break;
        last = now;
      }
      if (without_energy <= purging) without_energy = 0;
      is_rigid = without_energy > 0;
      if (is_rigid)
        rigid_.push_back(x);
      else if (sigma_ < 0.0 && last > round_off_of_fastest * fastest_)
        return shift_beside(last);
    }
    return true;
  }
  /// Whether the motions without resistance are no more than can be found one after the other: an inertia counts all
  /// that are slower than the shift is large.
  bool are_few() {
    if (!(sigma_ < 0.0) || !factor(-sigma_)) return true;
    const bool are = linear_.num_negative() <= static_cast<int>(most_rigid);
    return factor(sigma_) && are;
  }
  /// Takes a shift of the order of the slowest vibration: what a rigid motion still has of a vibration, c, changes its
  /// eigenvalue by c^2 omega^2 / shift.
  bool shift_beside(double slowest) {
    sigma_ = -0.3 * slowest;
    return factor(sigma_) || fail("the stiffness cannot be factored beside a motion without resistance");
  }
  /// Takes a shift below zero, above the round-off of the energy of a rigid motion and of a factor beside the fastest
  /// vibrations.
  bool shift_below(const Vector& rigid) {
    sigma_ = -std::max(above_noise * linear_.round_off(Part::stiffness, rigid), of_fastest * fastest_);
    if (!(sigma_ < 0.0)) sigma_ = -1.0;
    return factor(sigma_) || fail("the stiffness cannot be factored beside a motion without resistance");
  }

  double square_of(const Krylov::Ritz& ritz) const { return sigma_ + 1.0 / ritz.value.real(); }

  /// One Krylov space beside all vectors that are locked. The first pass looks for as many as are wanted, further ones
  /// for what is missing below the bound.
  bool search(int pass) {
    Krylov space = make_space();
    if (!space.begin(random_vector(linear_, 100U + static_cast<unsigned>(pass))) || !space.extend(1) ||
        !is_stretched(space.stretch())) {
      if (pass == 0) expected_ = num_in_bounds();
      return true;  // nothing is left
    }
    const int most = 12 * (wanted_.count + 10);
    std::vector<Krylov::Ritz> ritz;
    for (int size = pass == 0 ? wanted_.count + 8 : 6;; size += 4) {
      if (!space.extend(std::min(size, most))) return fail("the solution with the stiffness is not finite");
      ritz = space.eigenvalues(true);
      if (space.is_invariant() || size >= most || is_settled(ritz, pass)) break;
    }
    if (pass == 0) choose_bounds(ritz);
    Vector next;
    for (const Krylov::Ritz& one : ritz) {
      if (one.residual > converged * std::abs(one.value) || !is_in_bounds(square_of(one)) ||
          !is_stretched(one.value.real()))
        continue;
      // Multipliers, of which M sees nothing, are those of the shape only after one more solution with it.
      Vector shape = real_part(space.vector_of(one));
      if (!space.normalise(shape)) continue;
      if (!apply(shape, next)) return fail("the solution with the stiffness is not finite");
      for (double& value : next) value /= one.value.real();
      if (!space.normalise(next)) continue;
      space.lock(next);
      found_.push_back({square_of(one), next});
    }
    return true;
  }

  /// Whether a vector is stretched by this much as those of vibrations are, even of the fastest ones: round-off of what
  /// constraints and locked vectors exclude is not.
  bool is_stretched(double by) const {
    constexpr double least = 1e-2;
    return std::abs(by) * (fastest_ + std::abs(sigma_)) > least;
  }

  /// Whether all that this pass looks for has converged: the first the vibrations wanted and the place of the next
  /// one, others what may lie within the bounds.
  bool is_settled(const std::vector<Krylov::Ritz>& ritz, int pass) const {
    int vibrations = 0;
    for (const Krylov::Ritz& one : ritz) {
      const double error = one.residual / std::abs(one.value);
      if (pass > 0) {
        if (is_in_bounds(square_of(one)) && error > converged) return false;
        if (!is_in_bounds(square_of(one)) && error < nearly_found) return true;
        continue;
      }
      if (error > (vibrations < wanted_.count ? converged : nearly_found)) return false;
      if (square_of(one) > 0.0 && ++vibrations > wanted_.count) return true;
    }
    return false;
  }

  /// Bounds in a gap beyond the modes that are wanted, in which all have to be found. ritz: nearest to the shift first.
  void choose_bounds(const std::vector<Krylov::Ritz>& ritz) {
    std::sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) { return a.square < b.square; });
    double least = 0.0, most = 0.0;  // of omega^2 - sigma
    int vibrations = 0;
    for (const Krylov::Ritz& one : ritz) {
      if (one.residual > nearly_found * std::abs(one.value)) break;
      const double away = 1.0 / one.value.real(), square = sigma_ + away;
      const double before = away > 0.0 ? most : -least;
      if (vibrations >= wanted_.count && std::abs(away) > (1.0 + one_frequency) * before && before > 0.0) {
        (away > 0.0 ? next_above_ : next_below_) = square;
        if (next_above_ != 0.0) break;
        continue;
      }
      if (away > 0.0)
        most = std::max(most, away);
      else
        least = std::min(least, away);
      if (square > 0.0) ++vibrations;
    }
    upper_ = sigma_ + most;
    upper_ = next_above_ > upper_ ? upper_ + 0.5 * std::min(next_above_ - upper_, 0.02 * most) : upper_ + 0.01 * most;
    if (wanted_.shift > 0.0) {
      double lower = sigma_ + least;
      const double gap = next_below_ != 0.0 ? lower - next_below_ : -0.02 * least;
      lower -= 0.5 * std::min(least < 0.0 ? gap : 0.02 * most, least < 0.0 ? -0.02 * least : 0.02 * most);
      lower_ = lower;
    }
  }

  bool is_in_bounds(double square) const { return square < upper_ && (!lower_ || square > *lower_); }
  int num_in_bounds() const {
    return static_cast<int>(rigid_.size()) +
           static_cast<int>(std::count_if(found_.begin(), found_.end(),
                                          [this](const Found& one) { return is_in_bounds(one.square); }));
  }
  bool is_complete() const { return expected_ && num_in_bounds() >= *expected_; }

  /// By the inertia of K - b M at the bounds; the factor at the shift is made again where the search goes on.
  bool count_in_bounds() {
    if (found_.empty()) return false;
    if (!factor(upper_)) return false;
    int count = linear_.num_negative();
    if (count < 0) return false;
    if (lower_) {
      if (!factor(*lower_)) return false;
      const int below = linear_.num_negative();
      if (below < 0) return false;
      count -= below;
    }
    expected_ = count;
    return is_complete() || factor(sigma_);
  }

  /// Leaves what was asked for: rigid motions, all that is unstable, and the vibrations nearest to the shift, all of
  /// equal frequency where there are several.
  void trim() {
    std::sort(found_.begin(), found_.end(), [this](const Found& a, const Found& b) {
      return std::abs(a.square - sigma_) < std::abs(b.square - sigma_);
    });
    std::size_t vibrations = 0, kept = 0;
    double last = 0.0;
    for (; kept < found_.size(); ++kept) {
      const double away = std::abs(found_[kept].square - sigma_);
      if (!is_in_bounds(found_[kept].square)) break;
      if (vibrations >= static_cast<std::size_t>(wanted_.count) && away > (1.0 + one_frequency) * last) break;
      last = away;
      if (found_[kept].square > 0.0) ++vibrations;
    }
    // What is left out lies beyond the last one, but for unstable motions far from a shift of zero.
    const int left_out = num_in_bounds();
    found_.resize(kept);
    if (expected_) expected_ = *expected_ - (left_out - num_in_bounds());
    std::sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) { return a.square < b.square; });
  }

  Mode make_mode(const Found& one) {
    Mode mode;
    mode.is_rigid = takes_no_energy(one.shape, energy(one.shape));
    if (!mode.is_rigid)
      mode.eigenvalue = one.square > 0.0 ? std::complex<double>(0.0, std::sqrt(one.square))
                                         : std::complex<double>(std::sqrt(-one.square), 0.0);
    mode.shape.assign(one.shape.begin(), one.shape.end());
    mode.residual = residual_of(linear_, mode, false);
    return mode;
  }

  bool fail(const std::string& why) {
    trouble_ = why;
    return false;
  }

  Linearisation& linear_;
  const ModesWanted wanted_;
  double sigma_;
  const double fastest_;  ///< Linearisation::fastest
  Vector forces_;
  std::vector<Vector> rigid_;
  std::vector<Found> found_;
  double upper_ = 0.0, next_above_ = 0.0, next_below_ = 0.0;
  std::optional<double> lower_;
  std::optional<int> expected_;  ///< modes within the bounds
  std::string trouble_;
};

}  // namespace

ModesFound find_undamped_modes(Linearisation& linear, const ModesWanted& wanted) {
  return Search(linear, wanted).run();
}

}  // namespace bough::step
