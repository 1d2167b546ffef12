#pragma once
/// From node kinematics to an element's residual and tangent in the unknowns of its nodes: one driver for all element types.
/// Tangents are exact: the residual's own source run on jets, or closed forms checked against its complex step.
#include <type_traits>
#include <vector>

#include "bough/elements/beam.hpp"
#include "bough/elements/body.hpp"
#include "bough/elements/joint.hpp"
#include "bough/lanes/taylor.hpp"
#include "bough/motion/compensated.hpp"

namespace bough::elements {

/// Motion of a node: pose, position as a compensated pair, twist and its derivative in the node's axes, and the increment `dq` since the
/// last accepted step (H = H_n exp(dq)).
struct NodeMotion {
  Mat3<double> R;
  motion::Vec3Pair x;
  Vec6<double> v, a, dq;
};

/// How velocity and acceleration follow a position increment eta of the iteration:  dv = velocity T(dq)^-1 eta, da = acceleration T(dq)^-1 eta.
/// `mass_only`: the unknown is the acceleration itself (a consistent start): dv = 0, da = eta; constraint rows keep their gradient.
struct Slopes {
  double velocity = 0.0;      ///< gamma / (beta h) [1/s]
  double acceleration = 0.0;  ///< (1 - alpha_m) / ((1 - alpha_f) beta h^2) [1/s^2]
  bool mass_only = false;
};

/// Node motions and what surrounds them, as read by all elements of a model.
struct Field {
  const NodeMotion* nodes = nullptr;
  Surroundings<double> around;
  Slopes slopes;
};

/// Position of the element's first node off the ground: kernels see positions relative to it.
template <class E>
motion::Vec3Pair anchor_of(const E& e, const NodeMotion* nodes) {
  for (const Port& port : e.ports)
    if (port.node != ground) return nodes[port.node].x;
  return {};
}

/// Motion of one port; `anchor` is subtracted from its position.
PortMotion<double> eval_port(const Port& port, const NodeMotion* nodes, const motion::Vec3Pair& anchor);

/// Unknowns of an element: 6 per port off the ground, then its multipliers.
template <class E>
int num_multipliers(const E& e) {
  if constexpr (E::num_multipliers > 0)
    return e.num_rows;
  else
    return 0;
}
template <class E>
int num_unknowns(const E& e) {
  int n = num_multipliers(e);
  for (const Port& port : e.ports) n += port.node == ground ? 0 : 6;
  return n;
}

/// Residual in the unknowns of the nodes (and constraint rows), and the tangent dR/d(eta, lambda), row-major, when `tangent` is given.
/// `multipliers` and `turns` are looked at by joints only. No allocation.
template <class E>
void evaluate(const E& e, const Field& field, const double* multipliers, double turns, double* residual,
              double* tangent);

/// Sum of the magnitudes of the terms behind each entry of a residual, against which its smallness is measured. Elements between nodes push
/// and pull on several; a body's own terms balance within it and are told apart:  |M a| + |M g| + |ad(v)^T M v|.
template <class E>
void eval_magnitude(const E& e, const Field& field, const double* residual, double* magnitude) {
  for (int i = 0; i < num_unknowns(e); ++i) magnitude[i] = residual[i] < 0.0 ? -residual[i] : residual[i];
  if constexpr (std::is_same_v<E, RigidBody>) {
    const NodeMotion& n = field.nodes[e.ports[0].node];
    Vec6<double> terms[3] = {
        e.mass * lanes::join(lanes::transpose_times(n.R, field.around.gravity), Vec3<double>::zero()),
        Vec6<double>::zero(), Vec6<double>::zero()};
    if (field.around.has_inertia) {
      terms[1] = e.mass * n.a;
      terms[2] = motion::cross6_transpose_times(n.v, Vec6<double>(e.mass * n.v));
    }
    for (int i = 0; i < 6; ++i)
      for (const Vec6<double>& t : terms) magnitude[i] += t[i] < 0.0 ? -t[i] : t[i];
  }
}

/// Energies, powers and momentum of one element.
template <class E>
Measures measure(const E& e, const Field& field, const double* multipliers, double turns);

/// d(residual)/dt along the motion with accelerations held: positions, velocities, multipliers' frames and laws move on. Laws come as value
/// and rate. Joints: forces only.
template <class E>
void evaluate_rate(const E& e, const Field& field, const Surroundings<lanes::Taylor<double, 1>>& around,
                   const double* multipliers, double turns, double* residual_rate);

/// Constraint rows of a joint as Taylor coefficients in time up to order 3, along the motion given by twist, acceleration and jerk (the
/// derivative of the acceleration's components) of its nodes.  out[row] = {Phi, Phi', Phi''/2, Phi'''/6}.
void evaluate_constraint_series(const Joint& joint, const Field& field, const Vec6<double>* jerk,
                                const lanes::Taylor<double, 3>* laws, double turns, lanes::Taylor<double, 3>* out);

/// Relative motion of a joint's frames, for sensors and the state's count of turns.
struct JointMotion {
  Frame<double> relative;  ///< H_a^-1 H_b
  Vec6<double> twist;      ///< of b relative to a, in the axes of b
  double angle = 0.0;      ///< about axis 3, turns counted [rad]
  double angle_rate = 0.0;
};
JointMotion eval_joint_motion(const Joint& joint, const Field& field, double turns);

/// Wrench of the first body on the second at the second's joint frame, in that frame's axes [N, N m].
Vec6<double> eval_reaction(const Joint& joint, const Field& field, const double* multipliers, double turns);

}  // namespace bough::elements
