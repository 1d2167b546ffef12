#include "bough/step/critical_loads.hpp"

#include <algorithm>
#include <cmath>

#include "bough/step/krylov.hpp"
#include "mode_search.hpp"

namespace bough::step {

namespace {

using Part = Linearisation::Part;
using Vector = Linearisation::Vector;

constexpr double is_real = 1e-8;         ///< imaginary part of an eigenvalue over its size that may be round-off
constexpr double has_converged = 1e-10;  ///< relative residual of an eigenvalue
constexpr double one_distance = 1e-2;    ///< relative difference of distances that may be those of equal factors
constexpr int most_searches = 6;

class CriticalSearch {
 public:
  CriticalSearch(Linearisation& linear, bool symmetric, int count)
      : linear_(linear), symmetric_(symmetric), count_(count), forces_(linear.size()) {}

  CriticalLoads run() {
    CriticalLoads found;
    if (!linear_.factor({}, symmetric_ ? solve::Symmetry::symmetric : solve::Symmetry::general).ok()) {
      found.cause = "the tangent is singular: something moves without resistance";
      return found;
    }
    if (symmetric_) found.unstable = linear_.num_negative();
    Krylov space([this](const Vector& x, Vector& y) { return apply(x, y); },
                 [this](const Vector& x, Vector& y) {
                   y.resize(x.size());
                   for (std::size_t i = 0; i < x.size(); ++i) y[i] = linear_.weights()[i] * x[i];
                   return true;
                 });
    for (int pass = 0; pass < most_searches; ++pass) {
      const std::size_t before = found.loads.size();
      if (!space.begin(random_vector(linear_, 300U + static_cast<unsigned>(pass)))) break;
      if (!search(space, found.loads)) {
        found.cause = "the solution with the tangent is not finite";
        return found;
      }
      if (found.loads.size() == before) break;
    }
    std::stable_sort(found.loads.begin(), found.loads.end(), [](const CriticalLoad& a, const CriticalLoad& b) {
      return std::abs(a.distance) < std::abs(b.distance);
    });
    return found;
  }

 private:
  /// y = [K G^T; G 0]^-1 (-K' x), with multipliers, of which -K' sees nothing.
  bool apply(const Vector& x, Vector& y) {
    y.resize(x.size());
    linear_.multiply(Part::mass, x, forces_);
    return linear_.solve(forces_, y);
  }

  bool search(Krylov& space, std::vector<CriticalLoad>& loads) {
    const std::size_t before = loads.size();
    // What a first space has found once may be there several times; all else that a later one tells is round-off.
    const auto is_another = [&](double distance) {
      return before == 0 ||
             std::any_of(loads.begin(), loads.begin() + static_cast<std::ptrdiff_t>(before),
                         [distance](const CriticalLoad& load) {
                           return std::abs(distance - load.distance) <= one_distance * std::abs(distance);
                         });
    };
    const int most = 8 * (count_ + 10);
    std::vector<Krylov::Ritz> ritz;
    for (int size = 2 * count_ + 12;; size += 8) {
      if (!space.extend(std::min(size, most))) return false;
      ritz = space.eigenvalues(false);
      int settled = 0;
      for (const Krylov::Ritz& one : ritz) {
        if (one.residual > has_converged * std::abs(one.value)) break;
        ++settled;
      }
      if (space.is_invariant() || size >= most || settled > count_) break;
    }
    std::vector<CriticalLoad> more;
    for (const Krylov::Ritz& one : ritz) {
      if (one.residual > has_converged * std::abs(one.value) ||
          std::abs(one.value.imag()) > is_real * std::abs(one.value))
        continue;
      CriticalLoad load{1.0 / one.value.real(), real_part(space.vector_of(one))};
      if (!is_another(load.distance)) continue;
      Vector next;  // with the multipliers of the shape
      if (!apply(load.shape, next)) return false;
      if (!space.normalise(load.shape)) continue;
      load.shape = next;
      const double length = std::sqrt(linear_.inner(load.shape, load.shape));
      if (!(length > 0.0)) continue;
      for (double& value : load.shape) value /= length;
      more.push_back(std::move(load));
      if (static_cast<int>(more.size()) > count_) break;
    }
    for (CriticalLoad& load : more) {
      Vector unit = motion_of(linear_, load.shape);
      if (space.normalise(unit)) space.lock(unit);
      loads.push_back(std::move(load));
    }
    return true;
  }

  Linearisation& linear_;
  const bool symmetric_;
  const int count_;
  Vector forces_;
};

}  // namespace

CriticalLoads find_critical_loads(Linearisation& linear, bool symmetric, int count) {
  return CriticalSearch(linear, symmetric, count).run();
}

}  // namespace bough::step
