#pragma once
/// Maps motions of nodes to ports, and wrenches and tangents at the ports to the unknowns of nodes; written once for
/// all groups and elements. Internal.
#include "beam_tangent.hpp"
#include "body_tangent.hpp"
#include "bough/elements/evaluate.hpp"
#include "jet_tangent.hpp"
#include "joint_tangent.hpp"

namespace bough::elements {

/// Completes slopes of a port that are relative to a frame which moves with the velocity b and falls with c, in the axes
/// of the port. With B = (b; 0), C = (c; 0), and w the twist relative to that frame, v = w + B and a = w' + C + ad(B) w:
///   dv = dw + ad(B) eta,   da = dw' + ad(B) dw + (ad(C) - ad(w) ad(B)) eta
/// `turning` is the angular part of w. Only the columns of rotations change.
template <class S>
BOUGH_INLINE void add_drift(const Vec3<S>& b, const Vec3<S>& c, const Vec3<S>& turning, motion::DualMat<S>& velocity,
                            motion::DualMat<S>& acceleration) {
  const Mat3<S> by = skew(b);
  acceleration.b = acceleration.b + by * velocity.a + skew(c) - skew(turning) * by;
  velocity.b = velocity.b + by;
}
template <class S>
BOUGH_INLINE void add_drift(const motion::Vec2<S>& b, const motion::Vec2<S>& c, const S& turning,
                            motion::PlaneMap<S>& velocity, motion::PlaneMap<S>& acceleration) {
  const motion::Vec2<S> by = -motion::quarter_turn(b);
  acceleration.t = acceleration.t + velocity.b * by - motion::quarter_turn(c) - turning * b;
  velocity.t = velocity.t + by;
}
template <class S>
BOUGH_INLINE Vec3<S> angular_of(const Vec6<S>& v) {
  return lanes::angular_part(v);
}
template <class S>
BOUGH_INLINE S angular_of(const Vec3<S>& v) {
  return v[2];
}

/// Derivatives of the motions `p` of an element's ports, relative to the ground, by the unknowns of their nodes.
template <class E, class G, class S>
void eval_port_slopes(const E& e, const FieldOn<G, S>& field, const PortMotionOn<G, S>* p, PortSlopesOn<G, S>* ports) {
  using Map = typename G::template Map<S>;
  const bool has_rates = field.around.has_inertia && looks_at_rates(e);
  for (int k = 0; k < E::num_ports; ++k) {
    const PortOn<G, S>& port = e.ports[k];
    ports[k].moves = !field.slopes.mass_only;
    if (port.node == ground || !has_rates || field.slopes.mass_only) {
      ports[k].velocity = ports[k].acceleration = Map::zero();
      if (port.node != ground && has_rates) ports[k].acceleration = Map::identity();
      continue;
    }
    typename G::template Vector<S> dq = field.nodes[port.node].dq;
    if (port.has_offset) dq = G::inverse_adjoint_times(port.offset, dq);
    const Map inverse = matrix(motion::eval_inverse_tangent_operator<G, S>(G::motion(dq)));
    ports[k].velocity = G::scaled(field.slopes.velocity, inverse);
    ports[k].acceleration = G::scaled(field.slopes.acceleration, inverse);
    if constexpr (G::turns) {
      if (!field.slopes.drifts) continue;
      typename G::template Translation<S> b = field.nodes[port.node].drift, c = G::template Translation<S>::zero();
      if (port.has_offset) b = G::turned_back(port.offset, b);
      if (field.slopes.falls) c = G::turned_back(p[k].H, field.around.gravity);
      add_drift(b, c, angular_of(p[k].v), ports[k].velocity, ports[k].acceleration);
    }
  }
}

/// Motions of an element with mass with respect to the inertial frame, where nodes are described in a moving frame.
/// With slopes, also their derivatives by the port's increment eta, since Ad((H exp(eta))^-1) V = c + ad(c) eta:
///   dv_s = dv + ad(c) eta,   da_s = da + ad(c) dv + (ad(Ad(H^-1) V') - ad(v) ad(c)) eta
/// All of these are operators on motions, as the kernels expect them. Precondition: there is an observer.
template <class E, class S>
BOUGH_INLINE void see_from_inertial(const E&, const FieldOf<S>& field, const motion::PositionPair<S>& anchor,
                                    PortMotion<S>* p, PortSlopesOn<motion::Se3, S>* slopes) {
  if constexpr (has_mass_matrix<E>) {
    if (!field.around.has_inertia) return;
    const CarrierMotionOf<S>& o = *field.observer;
    const Vec3<S> from = anchor.hi + anchor.lo;
    for (int k = 0; k < E::num_ports; ++k) {
      if (slopes != nullptr && slopes[k].moves) {
        const Frame<S> H{p[k].H.R, p[k].H.x + from};
        const auto carried = motion::motion_dual(motion::inverse_adjoint_times(H, o.twist));
        const auto rate = motion::motion_dual(motion::inverse_adjoint_times(H, o.twist_rate));
        const auto by_twist = motion::skew(carried);
        motion::DualMat<S>& acceleration = slopes[k].acceleration;
        add_product(acceleration, by_twist, slopes[k].velocity);
        acceleration = acceleration + motion::skew(rate) -
                       motion::skew_product(motion::skew(motion::motion_dual(p[k].v)), carried);
        slopes[k].velocity = slopes[k].velocity + by_twist;
      }
      add_observer_motion(p[k], from, o.twist, o.twist_rate);
    }
  }
}
// ---- nodes

/// Offsets of an element's ports among its unknowns: dof unknowns for each port that is not on the ground, then the
/// multipliers.
template <class E>
struct Places {
  static constexpr int dof = E::Group::dof;
  int of[E::num_ports];  ///< first unknown of the port's node; -1: on the ground
  int forces = 0;        ///< number of unknowns of nodes
  explicit Places(const E& e) {
    for (int k = 0; k < E::num_ports; ++k) {
      of[k] = e.ports[k].node == ground ? -1 : forces;
      if (of[k] >= 0) forces += dof;
    }
  }
};

/// Transforms wrenches at the ports, `out`, to wrenches at the nodes: F_node = Ad(offset)^-T F.
template <class E, class S>
BOUGH_INLINE void carry_wrenches(const E& e, const Places<E>& places, const S* out, S* residual) {
  using G = typename E::Group;
  for (int k = 0; k < E::num_ports; ++k) {
    if (places.of[k] < 0) continue;
    typename G::template Vector<S> f;
    for (int i = 0; i < G::dof; ++i) f[i] = out[G::dof * k + i];
    if (e.ports[k].has_offset) f = G::inverse_adjoint_transpose_times(e.ports[k].offset, f);
    for (int i = 0; i < G::dof; ++i) residual[places.of[k] + i] = f[i];
  }
}

/// Adds the derivatives by the ports' increments to the rows and columns of the nodes' unknowns. Elements of one kind
/// of ports share it, and with it the code that writes their tangents.
template <class G, class S>
class TangentWriter {
 public:
  template <class E>
  TangentWriter(const E& e, const Places<E>& places, int size, S* tangent)
      : ports_(e.ports), of_(places.of), forces_(places.forces), size_(size), tangent_(tangent) {}
  /// A block of forces:  K_node = J_i^T K J_j, J = Ad(offset^-1).
  template <class Block>
  BOUGH_INLINE void operator()(int i, int j, const Block& block) const {
    if (of_[i] < 0 || of_[j] < 0) return;
    const bool left = ports_[i].has_offset, right = ports_[j].has_offset;
    if (left || right) return move_and_write(i, j, block);
    write(of_[i], of_[j], block);
  }
  /// The gradient of a joint's row: a row of the tangent and, since forces are G^T lambda, also a column.
  BOUGH_INLINE void row(int k, int port, typename G::template Vector<S> gradient) const {
    if (of_[port] < 0) return;
    if (ports_[port].has_offset) gradient = G::inverse_adjoint_transpose_times(ports_[port].offset, gradient);
    const int at = forces_ + k, to = of_[port];
    for (int j = 0; j < G::dof; ++j) tangent_[at * size_ + to + j] = tangent_[(to + j) * size_ + at] = gradient[j];
  }
  /// Rows do not depend on multipliers: that block is zero.
  void clear_rows() const {
    for (int i = forces_; i < size_; ++i)
      for (int j = forces_; j < size_; ++j) tangent_[i * size_ + j] = S(0.0);
  }

 private:
  /// Out of line: inlined at every block, it made g++ 12 fail on the three-node beam for AVX-512.
  template <class Block>
  BOUGH_NOINLINE void move_and_write(int i, int j, Block block) const {
    if (ports_[j].has_offset) block = G::block_product(block, G::inverse_adjoint_map(ports_[j].offset));
    if (ports_[i].has_offset) block = G::transposed_product(G::inverse_adjoint_map(ports_[i].offset), block);
    write(of_[i], of_[j], block);
  }
  template <class Block>
  BOUGH_INLINE void write(int row, int column, const Block& block) const {
    for (int k = 0; k < G::dof; ++k)
      for (int l = 0; l < G::dof; ++l) tangent_[(row + k) * size_ + column + l] = block(k, l);
  }
  const PortOn<G, S>* ports_;
  const int* of_;  ///< Places::of
  int forces_;
  int size_;
  S* tangent_;
};

/// Calls the kernel of an element; joints also return the values of their constraints.
template <class E, class G, class S, class M, class C>
BOUGH_INLINE void eval_kernel(const E& e, const PortMotionOn<G, S>* p, const M* multipliers,
                              const SurroundingsOn<G, S>& around, const C& turns, S* out, S* rows) {
  if constexpr (E::num_multipliers > 0)
    eval_residual(e, p, multipliers, around, turns, out, rows);
  else
    eval_residual(e, p, around, out);
}

/// The driver of all elements, for doubles and for packs. S: scalar of the element's constants too.
template <class E, class G, class S>
void evaluate_element(const E& e, const FieldOn<G, S>& field, const S* multipliers, const S& turns, S* residual,
                      S* tangent) {
  constexpr int P = E::num_ports;
  const auto anchor = anchor_of(e, field.nodes);
  PortMotionOn<G, S> p[P];
  for (int k = 0; k < P; ++k) p[k] = eval_port(e.ports[k], field.nodes, anchor, field.carriers);
  const Places<E> places(e);
  const int m = num_multipliers(e), size = places.forces + m;
  S out[G::dof * P], rows[E::num_multipliers + 1];
  if (tangent == nullptr) {
    if constexpr (G::has_moving_frames)
      if (field.observer != nullptr) see_from_inertial(e, field, anchor, p, static_cast<PortSlopesOn<G, S>*>(nullptr));
    eval_kernel(e, p, multipliers, field.around, turns, out, rows);
  } else {
    PortSlopesOn<G, S> slopes[P];
    eval_port_slopes(e, field, p, slopes);
    if constexpr (G::has_moving_frames)
      if (field.observer != nullptr) see_from_inertial(e, field, anchor, p, slopes);
    const TangentWriter<G, S> put(e, places, size, tangent);
    if constexpr (E::num_multipliers > 0) {
      eval_tangent(e, p, slopes, multipliers, field.around, turns, out, rows, put);
      put.clear_rows();
    } else {
      eval_tangent(e, p, slopes, field.around, out, put);
    }
  }
  carry_wrenches(e, places, out, residual);
  for (int k = 0; k < m; ++k) residual[places.forces + k] = rows[k];
}

}  // namespace bough::elements
