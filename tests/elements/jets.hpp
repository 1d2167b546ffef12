#pragma once
/// Residual and tangent of an element in a plane, or where nothing turns, from its kernel run on jets through a driver
/// of its own. The library's closed tangents and its driver are checked against it.
#include <vector>

#include "bough/elements/evaluate_lanes.hpp"

namespace bough::elements::in_plane {

using motion::Se2;
using Port = PortOn<Se2, double>;
using Node = NodeMotionOn<Se2, double>;
using NodeLanes = NodeMotionOn<Se2, LanePack>;
using Field = FieldOn<Se2, double>;
using FieldLanes = FieldOn<Se2, LanePack>;
template <int N>
using Beam = BeamOn<Se2, N>;
template <int N>
using LineLoad = LineLoadOn<Se2, N>;
using RigidBody = RigidBodyOn<Se2>;
using PointLoad = PointLoadOn<Se2>;
using Spring = SpringOn<Se2>;
using Bushing = BushingOn<Se2>;
using Joint = JointOn<Se2>;

}  // namespace bough::elements::in_plane

namespace bough::elements::check {

/// T(d)^-1 of SE(2), T(d) = sum (-ad d)^k / (k + 1)! = [C, t; 0, 1] with C that of a complex number.
inline Mat3<double> inverse_tangent_by_series(const Vec3<double>& d) {
  const Mat3<double> minus_ad{{0, d[2], -d[1], -d[2], 0, d[0], 0, 0, 0}};
  Mat3<double> term = Mat3<double>::identity(), T = term;
  for (int k = 2; k < 30; ++k) {
    term = (1.0 / k) * (term * minus_ad);
    T += term;
  }
  const double by = 1.0 / (T(0, 0) * T(0, 0) + T(1, 0) * T(1, 0)), c = by * T(0, 0), s = by * T(1, 0);
  return {{c, s, -(c * T(0, 2) + s * T(1, 2)), -s, c, s * T(0, 2) - c * T(1, 2), 0, 0, 1}};
}

/// A frame with the velocity b and, if it falls, the acceleration c in the node's axes adds (b; 0) to v and (c - w x b;
/// 0) to a; b and c turn back by theta where the node turns by it. Adds the derivatives from column `begin` on.
template <class T>
void add_drift_to(const FieldOn<motion::Se2, double>& field, int node, int begin, PortMotionOn<motion::Se2, T>& p) {
  const auto& n = field.nodes[node];
  const auto& g = field.around.gravity;
  double c[2] = {n.R[0] * g[0] + n.R[1] * g[1], n.R[0] * g[1] - n.R[1] * g[0]};
  if (!field.slopes.falls) c[0] = c[1] = 0.0;
  const double turned_back[2][2] = {{n.drift[1], -n.drift[0]}, {c[1], -c[0]}}, w = n.v[2];
  for (int i = 0; i < 2; ++i) {
    p.v[i].d[begin + 2] += turned_back[0][i];
    p.a[i].d[begin + 2] += turned_back[1][i] - w * n.drift[i];
    for (int j = 0; j < 3; ++j) p.a[i].d[begin + j] += p.v[2].d[begin + j] * turned_back[0][i];
  }
}

struct JetResult {
  std::vector<double> residual, tangent;
};

/// Columns: the nodes' increments, then the multipliers. With `mass_only` the unknowns are accelerations: rows keep
/// the gradient by poses, and of forces only what follows the acceleration is left.
template <class E>
JetResult evaluate_on_jets(const E& e, const FieldOn<typename E::Group, double>& field, const double* multipliers,
                           double turns) {
  using G = typename E::Group;
  constexpr int P = E::num_ports, dof = G::dof, D = dof * P;
  using T = lanes::Jet<double, D>;
  using Pair = motion::PositionPair<double, G::translations>;
  using Vector = typename G::template Vector<double>;
  const int m = num_multipliers(e), n = num_unknowns(e), forces = n - m;
  const auto anchor = anchor_of(e, field.nodes);
  const auto cast_pose = [](const typename G::template Pose<double>& H) -> typename G::template Pose<T> {
    if constexpr (G::turns)
      return {lanes::cast<T>(H.R), lanes::cast<T>(H.x)};
    else
      return {{}, lanes::cast<T>(H.x)};
  };
  const auto seeded = [&](bool moves, bool has_rates, PortMotionOn<G, T>* p) {
    for (int k = 0; k < P; ++k) {
      const PortOn<G, double>& port = e.ports[k];
      PortMotionOn<G, double> at =
          port.node == ground
              ? PortMotionOn<G, double>{{port.offset.R, motion::difference(Pair::from(port.offset.x), anchor)},
                                        Vector::zero(),
                                        Vector::zero()}
              : PortMotionOn<G, double>{
                    {field.nodes[port.node].R, motion::difference(field.nodes[port.node].x, anchor)},
                    field.nodes[port.node].v,
                    field.nodes[port.node].a};
      p[k] = {cast_pose(at.H), lanes::cast<T>(at.v), lanes::cast<T>(at.a)};
      if (port.node == ground) continue;
      if (moves) {
        if constexpr (G::turns) {  // dR = i R theta, dx = R u
          p[k].H.R[0].d[3 * k + 2] = -at.H.R[1];
          p[k].H.R[1].d[3 * k + 2] = at.H.R[0];
          p[k].H.x[0].d[3 * k] = p[k].H.x[1].d[3 * k + 1] = at.H.R[0];
          p[k].H.x[1].d[3 * k] = at.H.R[1];
          p[k].H.x[0].d[3 * k + 1] = -at.H.R[1];
        } else {
          for (int i = 0; i < dof; ++i) p[k].H.x[i].d[dof * k + i] = 1.0;
        }
      }
      if (has_rates) {
        const bool held = field.slopes.mass_only;
        auto U = G::template Matrix<double>::identity();
        if constexpr (G::turns)
          if (!held) U = inverse_tangent_by_series(field.nodes[port.node].dq);
        for (int i = 0; i < dof; ++i)
          for (int j = 0; j < dof; ++j) {
            if (!held) p[k].v[i].d[dof * k + j] = field.slopes.velocity * U(i, j);
            p[k].a[i].d[dof * k + j] = held ? U(i, j) : field.slopes.acceleration * U(i, j);
          }
        if constexpr (G::turns)
          if (field.slopes.drifts && !held) add_drift_to(field, port.node, 3 * k, p[k]);
      }
      if (!port.has_offset) continue;
      const auto offset = lanes::cast<T>(port.offset.x);
      if constexpr (G::turns) {
        const motion::Vec2<T> x = motion::complex_times(offset, p[k].H.R);
        p[k].H = {motion::complex_times(lanes::cast<T>(port.offset.R), p[k].H.R), motion::Vec2<T>(p[k].H.x + x)};
      } else {
        p[k].H.x = p[k].H.x + offset;
      }
      p[k].v = G::inverse_adjoint_times(port.offset, p[k].v);
      p[k].a = G::inverse_adjoint_times(port.offset, p[k].a);
    }
  };
  const SurroundingsOn<G, T> around{lanes::cast<T>(field.around.gravity), field.around.laws, field.around.has_inertia};
  JetResult r{std::vector<double>(static_cast<std::size_t>(n)), std::vector<double>(static_cast<std::size_t>(n * n))};
  const auto at = [](auto& v, int i) -> double& { return v[static_cast<std::size_t>(i)]; };
  const auto fill = [&](bool moves, bool has_rates, bool keep_forces, bool keep_rows) {
    PortMotionOn<G, T> p[P];
    seeded(moves, has_rates, p);
    T out[D], rows[E::num_multipliers + 1];
    if constexpr (E::num_multipliers > 0)
      eval_residual(e, p, multipliers, around, turns, out, rows);
    else
      eval_residual(e, p, around, out);
    int row = 0;
    const auto put = [&](int i, const T& x, bool keep) {
      at(r.residual, i) = x.a;
      int column = 0;
      for (int q = 0; q < P; ++q) {
        if (e.ports[q].node == ground) continue;
        for (int j = 0; j < dof; ++j, ++column)
          if (keep) at(r.tangent, i * n + column) = x.d[dof * q + j];
      }
    };
    for (int k = 0; k < P; ++k) {
      if (e.ports[k].node == ground) continue;
      typename G::template Vector<T> f;
      for (int i = 0; i < dof; ++i) f[i] = out[dof * k + i];
      if (e.ports[k].has_offset) f = G::inverse_adjoint_transpose_times(e.ports[k].offset, f);
      for (int i = 0; i < dof; ++i) put(row++, f[i], keep_forces);
    }
    for (int k = 0; k < m; ++k) {
      put(row++, rows[k], keep_rows);
      for (int j = 0; j < forces && keep_rows; ++j)
        at(r.tangent, j * n + forces + k) = at(r.tangent, (forces + k) * n + j);
    }
  };
  const bool start = field.slopes.mass_only;
  fill(!start, field.around.has_inertia, true, !start);
  if (start && m > 0) fill(true, false, false, true);
  return r;
}

}  // namespace bough::elements::check
