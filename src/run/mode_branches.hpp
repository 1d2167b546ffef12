#pragma once
/// Modes over a parameter as branches.
#include <complex>
#include <functional>
#include <string>
#include <vector>

#include "bough/records/archive.hpp"
#include "bough/step/modes.hpp"

namespace bough::run {

/// Continues each branch by the mode of the next value that is most like its last one: by the modal assurance criterion
///   MAC = |a^H M b|^2 / ((a^H M a) (b^H M b))
/// times how near the eigenvalue is to the one that the last two of the branch foretell. Complex shapes of forward and
/// backward whirl are orthogonal in it, and so are those of vibrations that cross without touching each other.
class ModeBranches {
 public:
  struct Point {
    std::size_t at = 0;  ///< number of the value
    std::complex<double> eigenvalue;
    double likeness = 1.0;  ///< MAC to the point before
    double residual = 0.0;
    std::string what;
    void checkpoint(records::Archive& archive) { archive(at, eigenvalue, likeness, residual, what); }
  };
  using Branch = std::vector<Point>;

  /// Adds the modes of the next value, but for rigid ones; `linear` is that of this value. Returns why they cannot
  /// continue those of the last; empty: they can.
  std::string add(const step::Linearisation& linear, std::vector<step::Mode> modes,
                  const std::function<std::string(const step::Mode&)>& describe);
  /// Leaves the branches that have the slowest vibrations where they begin.
  void keep(std::size_t count);
  const std::vector<Branch>& all() const { return branches_; }
  /// The branch that mirrors one at a value, lambda = -conj(lambda of that): both come from two vibrations that met there
  /// before. all().size(): there is none.
  std::size_t mirror_of(std::size_t branch, std::size_t at) const;
  void checkpoint(records::Archive& archive) { archive(branches_, shapes_, num_values_); }
  /// Between which values a branch was continued by a mode that is not much like the one before, in words.
  std::string doubt(const std::vector<double>& values) const;

 private:
  std::vector<Branch> branches_, dropped_;
  std::vector<std::vector<std::complex<double>>> shapes_;  ///< of the last point of each branch
  std::size_t num_values_ = 0;
};

/// The eigenvalue of a branch between its points, by the cubic through the four nearest ones.
std::complex<double> value_along(const ModeBranches::Branch& branch, const std::vector<double>& values, double value);
/// A branch of f(lambda of one, lambda of the other) at the values that both have.
ModeBranches::Branch combined(const ModeBranches::Branch& one, const ModeBranches::Branch& other,
                              const std::function<std::complex<double>(std::complex<double>, std::complex<double>)>& f);
/// Values at which a quantity of the eigenvalue and of the value changes from negative to positive, or back.
std::vector<double> zeros_along(const ModeBranches::Branch& branch, const std::vector<double>& values,
                                const std::function<double(std::complex<double>, double)>& quantity);

}  // namespace bough::run
