#pragma once
/// What a signal reads of the motion: a coordinate of the relative motion of two frames, or its rate. It is the force
/// that an effort of stiffness 1, or of damping 1, would have along the coordinate, so a reading is a joint without
/// rows that has this one effort, and reduced models restrict it as they do joints:
///   f = k (x - rest) + c x',   df = k g . zeta + c (g . dxi + (dg)^T xi . zeta)
/// g is the gradient of the coordinate x by the right increment zeta of the second frame, xi the relative twist.
#include "bough/elements/evaluate.hpp"

namespace bough::elements {

/// Value of a reading. slopes: null, or room for 2 G::dof numbers: its derivatives by the increments of the nodes of
/// both ports (Slopes), zeros for a port on the ground. turns: angle at the last accepted step [rad].
template <class G>
double eval_reading(const JointOn<G, double>& reading, const FieldOn<G, double>& field, double turns, double* slopes);

/// Its time derivative along the motion, dv/dt included.
template <class G>
double eval_reading_rate(const JointOn<G, double>& reading, const FieldOn<G, double>& field, double turns);

/// The reading of a coordinate, without a damper, as a series in time along the motion in space. The third coefficient
/// lacks the rate of accelerations, which is taken as 0.
lanes::Taylor<double, 3> eval_reading_series(const Joint& reading, const Field& field, double turns);

}  // namespace bough::elements
