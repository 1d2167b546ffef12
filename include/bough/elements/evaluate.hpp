#pragma once
/// From node kinematics to an element's residual and tangent in the unknowns of its nodes: one driver for all element
/// types. Tangents are exact: the residual's own source run on jets, or closed forms checked against its complex
/// step.
#include <algorithm>
#include <iterator>
#include <tuple>
#include <type_traits>
#include <vector>

#include "bough/elements/beam_forces.hpp"
#include "bough/elements/body.hpp"
#include "bough/elements/catalogue.hpp"
#include "bough/elements/joint.hpp"
#include "bough/lanes/taylor.hpp"
#include "bough/motion/compensated.hpp"

namespace bough::elements {

/// What a frame that does not turn has in place of a drift.
struct NoDrift {};
/// Velocity of the inertial frame relative to which an integrator describes a node over a step, in the node's axes.
template <class G, class S>
using DriftOf = std::conditional_t<G::turns, typename G::template Translation<S>, NoDrift>;

/// Motion of a node on the group G: rotation, position as a compensated pair, twist and its derivative in the node's
/// axes, the increment `dq` since the last accepted step, and the drift. Seen from the frame that drifts, H = H_n
/// exp(dq).
template <class G, class S>
struct NodeMotionOn {
  [[no_unique_address]] typename G::template Rotation<S> R;
  motion::PositionPair<S, G::translations> x;
  typename G::template Vector<S> v, a, dq;
  [[no_unique_address]] DriftOf<G, S> drift;
};
template <class S>
using NodeMotionOf = NodeMotionOn<motion::Se3, S>;
using NodeMotion = NodeMotionOf<double>;

/// How velocity and acceleration follow a position increment eta of the iteration:  dv = velocity T(dq)^-1 eta, da =
/// acceleration T(dq)^-1 eta, relative to frames that drift (NodeMotionOn::drift) where the integrator has such.
/// `mass_only`: the unknown is the acceleration itself (a consistent start): dv = 0, da = eta; constraint rows keep
/// their gradient.
struct Slopes {
  double velocity = 0.0;      ///< gamma / (beta h) [1/s]
  double acceleration = 0.0;  ///< (1 - alpha_m) / ((1 - alpha_f) beta h^2) [1/s^2]
  bool mass_only = false;
  double rate = 0.0;          ///< of x' by x of a first-order state [1/s]
  bool holds_drives = false;  ///< the rows of joints do not change with signals that are their laws
  bool drifts = false;        ///< nodes are described relative to frames that drift
  bool falls = false;         ///< these frames fall with gravity
};

/// Motions of all nodes, and the quantities common to all elements of a model.
/// observer: the motion, in the inertial frame, of the frame in which nodes, ground, carriers and gravity are
/// described; null if that is the inertial frame itself. Only elements with mass use it: the forces of all others
/// depend on relative motions. Moving frames are supported in space only.
template <class G, class S>
struct FieldOn {
  const NodeMotionOn<G, S>* nodes = nullptr;
  SurroundingsOn<G, S> around;
  Slopes slopes;
  const CarrierMotionOf<S>* carriers = nullptr;
  const CarrierMotionOf<S>* observer = nullptr;
};
template <class S>
using FieldOf = FieldOn<motion::Se3, S>;
using Field = FieldOf<double>;

namespace detail {
template <class G, class... Coupling>
std::tuple<BeamOn<G, 2>, BeamOn<G, 3>, BeamOn<G, 4>, RigidBodyOn<G>, JointOn<G>, Coupling..., PointLoadOn<G>,
           LineLoadOn<G, 2>, LineLoadOn<G, 3>, LineLoadOn<G, 4>>
elements_with(std::tuple<Coupling...>*);
}  // namespace detail
/// All types of elements on the group G, with the couplings of the catalogue: the one list of them. A type that cannot
/// live on G stands in it all the same, so that an element has one place in the lists of all groups.
template <class G>
using ElementsOn = decltype(detail::elements_with<G>(static_cast<CatalogueOn<G>*>(nullptr)));

/// True for elements whose forces depend on motions with respect to the inertial frame.
template <class E>
constexpr bool has_mass_matrix = requires(const E& e) {
  e.mass;
};

/// Position of the first node of an element that is not the ground. Kernels receive positions relative to it.
template <class E, class G, class S>
BOUGH_INLINE motion::PositionPair<S, G::translations> anchor_of(const E& e, const NodeMotionOn<G, S>* nodes) {
  for (const auto& port : e.ports)
    if (port.node != ground) return nodes[port.node].x;
  return motion::PositionPair<S, G::translations>::from(G::template Translation<S>::zero());
}

/// Motion of one port, with `anchor` subtracted from its position. carriers: used by ports that name one.
template <class S>
PortMotion<S> eval_carried_port(const PortOf<S>& port, const motion::PositionPair<S>& anchor,
                                const CarrierMotionOf<S>& c) {
  PortMotion<S> p;
  p.H.R = c.pose.R * port.offset.R;
  p.H.x = motion::difference(motion::PositionPair<S>{c.pose.x, c.pose.R * port.offset.x}, anchor);
  p.v = motion::inverse_adjoint_times(port.offset, c.twist);
  p.a = motion::inverse_adjoint_times(port.offset, c.twist_rate);
  return p;
}
template <class G, class S>
BOUGH_INLINE PortMotionOn<G, S> eval_port(const PortOn<G, S>& port, const NodeMotionOn<G, S>* nodes,
                                          const motion::PositionPair<S, G::translations>& anchor,
                                          const CarrierMotionOf<S>* carriers = nullptr) {
  using Pair = motion::PositionPair<S, G::translations>;
  using Vector = typename G::template Vector<S>;
  if constexpr (G::has_moving_frames)
    if (port.node == ground && port.carrier >= 0) return eval_carried_port(port, anchor, carriers[port.carrier]);
  if (port.node == ground)
    return {{port.offset.R, motion::difference(Pair::from(port.offset.x), anchor)}, Vector::zero(), Vector::zero()};
  const NodeMotionOn<G, S>& n = nodes[port.node];
  const typename G::template Pose<S> H{n.R, motion::difference(n.x, anchor)};
  if (!port.has_offset) return {H, n.v, n.a};
  return {G::compose(H, port.offset), G::inverse_adjoint_times(port.offset, n.v),
          G::inverse_adjoint_times(port.offset, n.a)};
}

/// The rotation of a port only: it is needed for every joint after every step.
inline motion::Mat3<double> eval_port_rotation(const Port& port, const Field& field) {
  if (port.node == ground)
    return port.carrier >= 0 ? field.carriers[port.carrier].pose.R * port.offset.R : port.offset.R;
  const motion::Mat3<double>& node = field.nodes[port.node].R;
  return port.has_offset ? node * port.offset.R : node;
}

inline motion::Vec2<double> eval_port_rotation(const PortOn<motion::Se2, double>& port,
                                               const FieldOn<motion::Se2, double>& field) {
  if (port.node == ground) return port.offset.R;
  const motion::Vec2<double>& node = field.nodes[port.node].R;
  return port.has_offset ? motion::complex_times(node, port.offset.R) : node;
}

template <class E>
bool holds_on_to_ground(const E& e) {
  return std::any_of(std::begin(e.ports), std::end(e.ports), [](const auto& port) { return port.node == ground; });
}

/// Number of unknowns of an element: G::dof for each port that is not on the ground, and its multipliers.
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
  for (const auto& port : e.ports) n += port.node == ground ? 0 : E::Group::dof;
  return n;
}

/// Residual in the unknowns of the nodes (and constraint rows), and, if `tangent` is given, the tangent dR/d(eta,
/// lambda), row-major. Only joints use `multipliers` and `turns`. No allocation.
template <class E>
void evaluate(const E& e, const FieldOn<typename E::Group, double>& field, const double* multipliers, double turns,
              double* residual, double* tangent);

/// Adds `count` rows of K eta from `row` on to `to`. K: tangent of an element in space; increment(node) returns eta.
template <class E, class Increment>
void add_tangent_times(const E& e, const double* K, int row, int count, Increment&& increment, double* to) {
  const int n = num_unknowns(e);
  int column = 0;
  for (const Port& port : e.ports) {
    if (port.node == ground) continue;
    const Vec6<double> eta = increment(port.node);
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < 6; ++j) to[i] += K[(row + i) * n + column + j] * eta[j];
    column += 6;
  }
}

/// Sum of the magnitudes of the terms in each entry of a residual: the scale of its round-off and of the test for
/// convergence. Elements between nodes contribute their forces on each node. The terms of a body balance within the
/// element and are added separately: |M a| + |M g| + |ad(v)^T M v|.
template <class E, class G, class S>
void eval_magnitude(const E& e, const FieldOn<G, S>&, const S* residual, S* magnitude) {
  using std::abs;
  for (int i = 0; i < num_unknowns(e); ++i) magnitude[i] = abs(residual[i]);
}
template <class G, class C, class S>
void eval_magnitude(const RigidBodyOn<G, C>& e, const FieldOn<G, S>& field, const S* residual, S* magnitude) {
  using std::abs;
  using Vector = typename G::template Vector<S>;
  const NodeMotionOn<G, S>& n = field.nodes[e.ports[0].node];
  PortMotionOn<G, S> p{{n.R, n.x.hi + n.x.lo}, n.v, n.a};
  if constexpr (G::has_moving_frames)
    if (field.around.has_inertia && field.observer != nullptr)
      add_observer_motion(p, Vec3<S>::zero(), field.observer->twist, field.observer->twist_rate);
  for (int i = 0; i < G::dof; ++i) magnitude[i] = abs(residual[i]);
  Vector term;
  const auto add = [&] {
    for (int i = 0; i < G::dof; ++i) magnitude[i] = magnitude[i] + abs(term[i]);
  };
  const auto weight = G::turned_back(p.H, field.around.gravity);
  if (is_seen_as_point(e)) {
    const S m = e.mass(0, 0);
    G::put_force(m * weight, term.v), add();
    if (!field.around.has_inertia) return;
    G::put_force(m * G::linear(p.a), term.v), add();
    if (G::turns) G::put_force(G::spin(p.v, m * G::linear(p.v)), term.v), add();
    return;
  }
  G::put(G::matrix_times(e.mass, weight), term.v), add();
  if (!field.around.has_inertia) return;
  const auto v = G::motion(p.v);
  G::put(G::matrix_times(e.mass, G::motion(p.a)), term.v), add();
  G::put(G::dual_bracket(v, G::matrix_times(e.mass, v)), term.v), add();
}

/// What the checks made in every step need of one element with respect to the inertial frame; the force is in the axes
/// of the frame in which nodes are described.
template <class E>
Measures measure(const E& e, const Field& field, const double* multipliers, double turns);

/// Time derivative of the residual along the motion: positions, velocities, accelerations, frames of multipliers and
/// laws advance. Laws are given as value and rate. Of joints only the forces are differentiated. jerks: d2v/dt2 of the
/// nodes of the ports, null where accelerations are constant.
template <class E>
void evaluate_rate(const E& e, const FieldOn<typename E::Group, double>& field,
                   const SurroundingsOn<typename E::Group, lanes::Taylor<double, 1>>& around, const double* multipliers,
                   double turns, const typename E::Group::template Vector<double>* jerks, double* residual_rate);

/// Constraint rows of a joint as Taylor coefficients in time up to order 3, along the motion given by twist,
/// acceleration and jerk (the derivative of the acceleration's components) of its nodes.  out[row] = {Phi, Phi',
/// Phi''/2, Phi'''/6}.
void evaluate_constraint_series(const Joint& joint, const Field& field, const Vec6<double>* jerk,
                                const lanes::Taylor<double, 3>* laws, double turns, lanes::Taylor<double, 3>* out);
/// Only the rows and their first time derivatives.
void evaluate_constraint_rates(const Joint& joint, const Field& field, const lanes::Taylor<double, 1>* laws,
                               double turns, lanes::Taylor<double, 1>* out);

/// Value and rate of a coordinate along or about axis 3 of a joint's frames, turns counted [m, rad; per s].
struct CoordinateMotion {
  double value, rate;
};
CoordinateMotion eval_joint_coordinate(const Joint& joint, RowKind coordinate, const Field& field, double turns);

/// Wrench of the first body on the second at the second's joint frame, in that frame's axes [N, N m].
Vec6<double> eval_reaction(const Joint& joint, const Field& field, const double* multipliers, double turns);

}  // namespace bough::elements
