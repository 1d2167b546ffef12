#pragma once
/// How far parts turn between two pictures.
#include <vector>

#include "bough/step/state.hpp"
#include "bough/step/system.hpp"

namespace bough::run {

/// The largest rotation of a node or a moving frame away from a state at which it began, at any state looked at since.
/// Turns of more than half a turn from one look to the next cannot be told. Allocates only at the first start.
class TurnWatch {
 public:
  void begin(const step::System& system, const step::State& state);
  void look(const step::System& system, const step::State& state);
  double turn() const;  ///< [rad]
  bool has_begun() const { return has_begun_; }
  void checkpoint(records::Archive& archive) { archive(has_begun_, from_, least_cosine_); }

 private:
  bool has_begun_ = false;
  std::vector<double> from_;  ///< rotations at the start: matrices, or (cos, sin) in a plane
  double least_cosine_ = 1.0;
};

}  // namespace bough::run
