#pragma once
/// From node kinematics to an element's residual and tangent in the unknowns of its nodes: one driver for all element types.
/// Tangents are exact: the residual's own source run on jets, or closed forms checked against its complex step.
#include <type_traits>
#include <vector>

#include "bough/elements/beam_forces.hpp"
#include "bough/elements/body.hpp"
#include "bough/elements/joint.hpp"
#include "bough/lanes/taylor.hpp"
#include "bough/motion/compensated.hpp"

namespace bough::elements {

/// Motion of a node: pose, position as a compensated pair, twist and its derivative in the node's axes, and the increment `dq` since the
/// last accepted step (H = H_n exp(dq)).
template <class S>
struct NodeMotionOf {
  Mat3<S> R;
  motion::PositionPair<S> x;
  Vec6<S> v, a, dq;
};
using NodeMotion = NodeMotionOf<double>;

/// How velocity and acceleration follow a position increment eta of the iteration:  dv = velocity T(dq)^-1 eta, da = acceleration T(dq)^-1 eta.
/// `mass_only`: the unknown is the acceleration itself (a consistent start): dv = 0, da = eta; constraint rows keep their gradient.
struct Slopes {
  double velocity = 0.0;      ///< gamma / (beta h) [1/s]
  double acceleration = 0.0;  ///< (1 - alpha_m) / ((1 - alpha_f) beta h^2) [1/s^2]
  bool mass_only = false;
};

/// Node motions and what surrounds them, as read by all elements of a model.
/// observer: the frame in which nodes, ground, carriers and gravity are described, where that moves (its motion in the inertial frame); null:
/// they are described in the inertial frame. Only elements with mass look at it: all others see relative motions.
template <class S>
struct FieldOf {
  const NodeMotionOf<S>* nodes = nullptr;
  Surroundings<S> around;
  Slopes slopes;
  const CarrierMotionOf<S>* carriers = nullptr;
  const CarrierMotionOf<S>* observer = nullptr;
};
using Field = FieldOf<double>;

/// Elements whose forces depend on motions in the inertial frame.
template <class E>
constexpr bool has_mass_matrix = requires(const E& e) {
  e.mass;
};

/// Position of the element's first node off the ground: kernels see positions relative to it.
template <class E, class S>
motion::PositionPair<S> anchor_of(const E& e, const NodeMotionOf<S>* nodes) {
  for (const auto& port : e.ports)
    if (port.node != ground) return nodes[port.node].x;
  return motion::PositionPair<S>::from(Vec3<S>::zero());
}

/// Motion of one port; `anchor` is subtracted from its position. carriers: looked at by ports that name one.
template <class S>
PortMotion<S> eval_port(const PortOf<S>& port, const NodeMotionOf<S>* nodes, const motion::PositionPair<S>& anchor,
                        const CarrierMotionOf<S>* carriers = nullptr) {
  PortMotion<S> p;
  if (port.node == ground && port.carrier >= 0) {
    const CarrierMotionOf<S>& c = carriers[port.carrier];
    p.H.R = c.pose.R * port.offset.R;
    p.H.x = motion::difference(motion::PositionPair<S>{c.pose.x, c.pose.R * port.offset.x}, anchor);
    p.v = motion::inverse_adjoint_times(port.offset, c.twist);
    p.a = motion::inverse_adjoint_times(port.offset, c.twist_rate);
    return p;
  }
  if (port.node == ground) {
    p.H.R = port.offset.R;
    p.H.x = motion::difference(motion::PositionPair<S>::from(port.offset.x), anchor);
    p.v = p.a = Vec6<S>::zero();
    return p;
  }
  const NodeMotionOf<S>& n = nodes[port.node];
  const Vec3<S> x = motion::difference(n.x, anchor);
  if (!port.has_offset) return {{n.R, x}, n.v, n.a};
  p.H.R = n.R * port.offset.R;
  p.H.x = x + n.R * port.offset.x;
  p.v = motion::inverse_adjoint_times(port.offset, n.v);
  p.a = motion::inverse_adjoint_times(port.offset, n.a);
  return p;
}

/// The rotation of a port alone, for what is asked of every element after every step.
inline motion::Mat3<double> eval_port_rotation(const Port& port, const Field& field) {
  if (port.node == ground)
    return port.carrier >= 0 ? field.carriers[port.carrier].pose.R * port.offset.R : port.offset.R;
  const motion::Mat3<double>& node = field.nodes[port.node].R;
  return port.has_offset ? node * port.offset.R : node;
}

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
  for (const auto& port : e.ports) n += port.node == ground ? 0 : 6;
  return n;
}

/// Residual in the unknowns of the nodes (and constraint rows), and the tangent dR/d(eta, lambda), row-major, when `tangent` is given.
/// `multipliers` and `turns` are looked at by joints only. No allocation.
template <class E>
void evaluate(const E& e, const Field& field, const double* multipliers, double turns, double* residual,
              double* tangent);

/// Sum of the magnitudes of the terms behind each entry of a residual, against which its smallness is measured. Elements between nodes push
/// and pull on several; a body's own terms balance within it and are told apart:  |M a| + |M g| + |ad(v)^T M v|.
template <class E, class S>
void eval_magnitude(const E& e, const FieldOf<S>& field, const S* residual, S* magnitude) {
  using std::abs;
  for (int i = 0; i < num_unknowns(e); ++i) magnitude[i] = abs(residual[i]);
  if constexpr (std::is_same_v<E, RigidBodyOf<S>>) {
    const NodeMotionOf<S>& n = field.nodes[e.ports[0].node];
    const Vec3<S> weight = lanes::transpose_times(n.R, field.around.gravity);
    PortMotion<S> p{{n.R, n.x.hi + n.x.lo}, n.v, n.a};
    if (field.around.has_inertia && field.observer != nullptr)
      add_observer_motion(p, Vec3<S>::zero(), field.observer->twist, field.observer->twist_rate);
    if (is_seen_as_point(e, field.around)) {
      Vec3<S> terms[3] = {e.mass(0, 0) * weight, Vec3<S>::zero(), Vec3<S>::zero()};
      if (field.around.has_inertia) terms[1] = e.mass(0, 0) * lanes::linear_part(p.a);
      if (field.around.has_inertia && field.around.nodes_turn)
        terms[2] = lanes::cross(Vec3<S>(e.mass(0, 0) * lanes::linear_part(p.v)), lanes::angular_part(p.v));
      for (int i = 0; i < 3; ++i)
        for (const Vec3<S>& t : terms) magnitude[i] = magnitude[i] + abs(t[i]);
      return;
    }
    Vec6<S> terms[3] = {e.mass * lanes::join(weight, Vec3<S>::zero()), Vec6<S>::zero(), Vec6<S>::zero()};
    if (field.around.has_inertia) {
      terms[1] = e.mass * p.a;
      terms[2] = motion::cross6_transpose_times(p.v, Vec6<S>(e.mass * p.v));
    }
    for (int i = 0; i < 6; ++i)
      for (const Vec6<S>& t : terms) magnitude[i] = magnitude[i] + abs(t[i]);
  }
}

/// Energies, powers and momentum of one element, all of them those of the inertial frame, momentum and load in the axes of the frame in which
/// nodes are described. Without energies, those of joints, springs and bushings are left out: what is watched in every step are powers and loads.
template <class E>
Measures measure(const E& e, const Field& field, const double* multipliers, double turns, bool with_energies = true);

/// d(residual)/dt along the motion with accelerations held: positions, velocities, multipliers' frames and laws move on. Laws come as value
/// and rate. Joints: forces only.
template <class E>
void evaluate_rate(const E& e, const Field& field, const Surroundings<lanes::Taylor<double, 1>>& around,
                   const double* multipliers, double turns, double* residual_rate);

/// Constraint rows of a joint as Taylor coefficients in time up to order 3, along the motion given by twist, acceleration and jerk (the
/// derivative of the acceleration's components) of its nodes.  out[row] = {Phi, Phi', Phi''/2, Phi'''/6}.
void evaluate_constraint_series(const Joint& joint, const Field& field, const Vec6<double>* jerk,
                                const lanes::Taylor<double, 3>* laws, double turns, lanes::Taylor<double, 3>* out);
/// The rows and their first time derivatives alone.
void evaluate_constraint_rates(const Joint& joint, const Field& field, const lanes::Taylor<double, 1>* laws,
                               double turns, lanes::Taylor<double, 1>* out);

/// Relative motion of a joint's frames, for sensors and the state's count of turns.
struct JointMotion {
  Frame<double> relative;  ///< H_a^-1 H_b
  Vec6<double> twist;      ///< of b relative to a, in the axes of b
  double angle = 0.0;      ///< about axis 3, turns counted [rad]
  double angle_rate = 0.0;
};
JointMotion eval_joint_motion(const Joint& joint, const Field& field, double turns);
/// Its angle alone.
double eval_joint_angle(const Joint& joint, const Field& field, double turns);

/// Wrench of the first body on the second at the second's joint frame, in that frame's axes [N, N m].
Vec6<double> eval_reaction(const Joint& joint, const Field& field, const double* multipliers, double turns);

}  // namespace bough::elements
