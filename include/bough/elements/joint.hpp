#pragma once
/// Kinematic constraints between two frames, each row a scalar function of the relative motion H = H_a^-1 H_b alone,
/// with one multiplier; and efforts (springs, dampers, torques) along the joint's free coordinates.
///   residual: F_b = G^T lambda + efforts,  F_a = -Ad(H^-1)^T F_b,  and the rows Phi(H, t) themselves.
/// G holds the rows' gradients with respect to the right increment zeta of the second frame, H <- H exp(zeta).
#include "bough/elements/port.hpp"
#include "bough/motion/coordinates.hpp"

namespace bough::elements {

using motion::eval_coordinate;
using motion::RowKind;

/// A row and the directions that it compares: in space axis i of the first and axis j of the second frame, in a plane
/// one direction d.
template <class G, class C>
struct ConstraintRowOn : G::template Direction<C> {
  RowKind kind = RowKind::along;
  int law = -1;      ///< -1: zero
  C constant = 0.0;  ///< displacement per radian (screw) [m/rad], length (between points) [m]
};
using ConstraintRow = ConstraintRowOn<motion::Se3, double>;

template <class G, class C>
struct EffortOn {
  RowKind coordinate = RowKind::angle;  ///< `angle`, `along`, `distance`
  C stiffness = 0.0, rest = 0.0, damping = 0.0;
  int law = -1;  ///< effort on the second body along the axis; -1: none
  typename G::template Direction<C> direction =
      G::template Direction<C>::axial();  ///< in space axis 3 of the first frame
};
using Effort = EffortOn<motion::Se3, double>;

constexpr int max_rows = 6;
constexpr int max_efforts = 4;

/// A joint with `num_rows` constraint rows, at the begin of the array. The angle at the last accepted step belongs to
/// the state of a run. It is passed to the kernel as `turns`, and the present angle is unwrapped from it.
template <class G, class C = double>
struct JointOn {
  using Group = G;
  static constexpr int num_ports = 2;
  static constexpr int num_multipliers = max_rows;  ///< at most
  PortOn<G, C> ports[2];
  ConstraintRowOn<G, C> rows[max_rows];
  int num_rows = 0;
  EffortOn<G, C> efforts[max_efforts];
  int num_efforts = 0;
  /// Of a scene in a plane: the sign of the joint's axis along the normal of the plane, 0 where the axis lies in the
  /// plane and the joint does not turn; and whether the rows would also be satisfied after half a turn.
  int axis_sign = 1;
  bool has_branch = false;

  static constexpr Role role = Role::joint;
  static constexpr Cost cost{250e-9, 900e-9, 40e-9, 190e-9};
  static constexpr bool has_stiffness_matrix = false, acts_along_line = false;
  static constexpr DataAxes data_axes = DataAxes::none;
  template <class A, class B, class Visit>
  static void visit_data(A& a, B& b, Visit& visit) {
    visit.flag(a.num_rows, b.num_rows);
    for (int k = 0; k < a.num_rows; ++k) {
      visit.flag(a.rows[k].kind, b.rows[k].kind);
      visit.direction(a.rows[k], b.rows[k]);
      visit.number(a.rows[k].constant, b.rows[k].constant);
      visit.law(a.rows[k].law, b.rows[k].law);
    }
    visit.flag(a.num_efforts, b.num_efforts);
    for (int k = 0; k < a.num_efforts; ++k) {
      auto& x = a.efforts[k];
      auto& y = b.efforts[k];
      visit.flag(x.coordinate, y.coordinate);
      visit.direction(x.direction, y.direction);
      visit.number(x.stiffness, y.stiffness);
      visit.number(x.rest, y.rest);
      visit.number(x.damping, y.damping);
      visit.law(x.law, y.law);
    }
  }
};
using Joint = JointOn<motion::Se3>;

/// Whether an effort has a damper; if none has, no velocities are needed.
template <class G, class C>
bool is_damped(const JointOn<G, C>& joint) {
  bool damped = false;
  for (int k = 0; k < joint.num_efforts; ++k) damped = damped || is_present(joint.efforts[k].damping);
  return damped;
}
template <class G, class C>
bool looks_at_rates(const JointOn<G, C>& joint) {
  return is_damped(joint);
}
/// Whether a row is driven by a law.
template <class G, class C>
bool is_driven(const JointOn<G, C>& joint) {
  bool driven = false;
  for (int k = 0; k < joint.num_rows; ++k) driven = driven || joint.rows[k].law >= 0;
  return driven;
}
template <class G, class C>
bool exchanges_energy(const JointOn<G, C>& joint) {
  return is_driven(joint) || joint.num_efforts > 0;
}

/// Whether rows k to k + 2 of a joint align all axes of its frames: e_1 . R e_2 = e_2 . R e_3 = e_3 . R e_1 = 0. These
/// equations are also satisfied after half a turn about any of the axes.
inline bool aligns_all_axes(const Joint& e, int k) {
  return k + 2 < e.num_rows && e.rows[k].i == 0 && e.rows[k].j == 1 && e.rows[k + 1].kind == RowKind::across &&
         e.rows[k + 1].i == 1 && e.rows[k + 1].j == 2 && e.rows[k + 2].kind == RowKind::across;
}

template <class G, class S, class C>
BOUGH_INLINE S eval_row(const ConstraintRowOn<G, C>& row, const typename G::template Pose<S>& H, const C& turns,
                        const Constant<S>* laws, typename G::template Wrench<S>& gradient) {
  const S value = eval_coordinate<G, S, C>(row.kind, row, row.constant, H, turns, gradient);
  return row.law < 0 ? value : S(value - laws[row.law]);
}

/// In space, the gradient (linear; angular) as a plain vector.
template <class S, class C>
S eval_row(const ConstraintRowOn<motion::Se3, C>& row, const Frame<S>& H, const C& turns, const Constant<S>* laws,
           Vec6<S>& gradient) {
  motion::DualVec<S> g;
  const S value = eval_row<motion::Se3, S, C>(row, H, turns, laws, g);
  gradient = motion::wrench_vector(g);
  return value;
}

/// Coordinate of an effort and its gradient.
template <class G, class S, class C>
BOUGH_INLINE S eval_coordinate(const EffortOn<G, C>& e, const typename G::template Pose<S>& H, const C& turns,
                               typename G::template Wrench<S>& gradient) {
  return eval_coordinate<G, S, C>(e.coordinate, e.direction, C(0.0), H, turns, gradient);
}

/// Force of the spring, the damper and the given effort along one coordinate, on the second body, counted against the
/// motion. rate: that of the coordinate, nullptr where no damper needs it.
template <class G, class S, class C>
BOUGH_INLINE S eval_effort(const EffortOn<G, C>& e, const S& coordinate, const S* rate, const Constant<S>* laws) {
  S f = e.stiffness * (coordinate - e.rest);
  if (rate != nullptr) f = f + e.damping * *rate;
  if (e.law >= 0) f = f - laws[e.law];
  return f;
}

/// Twist of the second frame relative to the first, in the axes of the second.
template <class G, class S>
BOUGH_INLINE typename G::template Motion<S> relative_twist(const typename G::template Pose<S>& H,
                                                           const PortMotionOn<G, S>* p) {
  return G::motion(p[1].v) - G::motion(G::inverse_adjoint_times(H, p[0].v));
}

/// Adds the efforts along all free coordinates, as a wrench on the second port that resists the motion.
template <class G, class S, class C>
BOUGH_INLINE void add_efforts(const JointOn<G, C>& joint, const typename G::template Pose<S>& H,
                              const PortMotionOn<G, S>* p, const SurroundingsOn<G, S>& around, const C& turns,
                              typename G::template Wrench<S>& f) {
  typename G::template Wrench<S> gradient;
  for (int k = 0; k < joint.num_efforts; ++k) {
    const S value = eval_coordinate<G, S, C>(joint.efforts[k], H, turns, gradient);
    const bool damps = around.has_inertia && is_present(joint.efforts[k].damping);
    S rate(0.0);
    if (damps) rate = G::real_power(gradient, relative_twist<G, S>(H, p));
    f = G::add(f, eval_effort<G, S, C>(joint.efforts[k], value, damps ? &rate : nullptr, around.laws), gradient);
  }
}

/// Wrenches on both ports, computed from the wrench on the second.
template <class G, class S>
BOUGH_INLINE void put_relative_wrench(const typename G::template Pose<S>& H, const typename G::template Wrench<S>& f,
                                      S* out) {
  const typename G::template Vector<S> second = G::vector_of_wrench(f),
                                       first = G::inverse_adjoint_transpose_times(H, second);
  for (int k = 0; k < G::dof; ++k) {
    out[k] = -first[k];
    out[G::dof + k] = second[k];
  }
}

/// out: wrenches on the ports; rows: values of the constraints.
template <class G, class S, class C>
BOUGH_INLINE void eval_residual(const JointOn<G, C>& joint, const PortMotionOn<G, S>* p, const Constant<S>* multipliers,
                                const SurroundingsOn<G, S>& around, const C& turns, S* out, S* rows) {
  const typename G::template Pose<S> H = G::relative(p[0].H, p[1].H);
  auto f = G::wrench(G::template Vector<S>::zero());
  typename G::template Wrench<S> gradient;
  for (int k = 0; k < joint.num_rows; ++k) {
    rows[k] = eval_row<G, S, C>(joint.rows[k], H, turns, around.laws, gradient);
    f = G::add(f, multipliers[k], gradient);
  }
  add_efforts<G, S, C>(joint, H, p, around, turns, f);
  put_relative_wrench<G, S>(H, f, out);
}

/// Strain energy of the efforts' springs [J].
template <class G, class S, class C>
S eval_strain_energy(const JointOn<G, C>& joint, const PortMotionOn<G, S>* p, const C& turns) {
  const typename G::template Pose<S> H = G::relative(p[0].H, p[1].H);
  typename G::template Wrench<S> gradient;
  S sum(0.0);
  for (int k = 0; k < joint.num_efforts; ++k) {
    const S stretch = eval_coordinate<G, S, C>(joint.efforts[k], H, turns, gradient) - joint.efforts[k].rest;
    sum = sum + 0.5 * joint.efforts[k].stiffness * stretch * stretch;
  }
  return sum;
}

}  // namespace bough::elements
