#pragma once
/// Motion of a node between two states of a smooth stretch.
#include "bough/elements/evaluate.hpp"

namespace bough::step {

/// Pose and twist at `part` of the way from `first` to `last`, h apart in time [s], 0 <= part <= 1:
///   H = H_0 exp(p),  v = T(p) p' / h,   p(s) the cubic with  p(0) = 0,  p'(0) = h v_0,  p(1) = D = log(H_0^-1 H_1),
///     p'(1) = h T(D)^-1 v_1
/// Errors are of order h^4 in poses (h^4 / 384 times the fourth derivative) and h^3 in twists. A motion with a steady
/// twist is met exactly, and nodes that move as one rigid body stay one: p goes over from node to node by Ad. The
/// acceleration and the increment dq of `out` are not set. Pure: no allocation, no failure; the rotation from first
/// to last has to be below pi.
void eval_between(const elements::NodeMotion& first, const elements::NodeMotion& last, double h, double part,
                  elements::NodeMotion& out);

}  // namespace bough::step
