#pragma once
/// Estimates and records of the part of a residual that is round-off.
#include <cstdint>
#include <optional>
#include <vector>

#include "bough/step/element_evaluation.hpp"
#include "bough/step/residual_sums.hpp"

namespace bough::step {

/// Residuals that iterations could not make smaller although they contracted: zero until one was met, and again after
/// 64 iterations, since forces change.
class RoundOffMemory {
 public:
  const ResidualSize& size() const { return size_; }
  void note(const ResidualSize& r) { size_ = r; }
  /// To be called when an iteration has ended.
  void count_iteration() {
    if (++age_ < lasts) return;
    size_ = {};
    age_ = 0;
  }
  void checkpoint(records::Archive& archive) { archive(size_, age_); }

 private:
  static constexpr int lasts = 64;
  ResidualSize size_;
  int age_ = 0;
};

/// Estimates sum |K| eps |coordinates|, by force and moment, from the element matrices K now present. Each is computed
/// when it is first asked for and kept until the matrices change.
class RoundOff {
 public:
  RoundOff(const plan::Plan& plan, const UnknownPlaces& places, const LinearSolution& linear,
           const ElementLengths& lengths, const tree::Walker& walker);

  /// What round-off alone leaves in the residual.
  const ResidualSize& floor() const;
  /// The same of elements with two or more ports only, which respond to differences of rounded poses. The inertia of a
  /// body responds to the increment of a step, which is rounded much less.
  const ResidualSize& of_poses() const;
  /// What iterations of this run could not make smaller.
  RoundOffMemory& met() { return met_; }
  const RoundOffMemory& met() const { return met_; }

 private:
  struct Estimate {
    ResidualSize size;
    long matrices = -1;  ///< LinearSolution::num_matrices for which it was made
  };
  /// Sums over the elements that count.
  template <class Counts>
  const ResidualSize& estimate(Estimate& known, Counts&& counts) const;

  const plan::Plan& plan_;
  const UnknownPlaces& places_;
  const LinearSolution& linear_;
  const ElementLengths& lengths_;
  tree::Walker walker_;
  mutable Estimate floor_, of_poses_;
  std::vector<char> is_length_;          ///< by unknown: a displacement of a node
  std::vector<std::int64_t> row_begin_;  ///< by element, into rows_
  mutable std::vector<double> rows_;     ///< scratch: sums of the rows of elements
  mutable std::vector<double> sums_;     ///< scratch
  RoundOffMemory met_;
};

}  // namespace bough::step
