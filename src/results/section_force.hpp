#pragma once
/// Sectional forces along a beam element, from equilibrium.
#include <algorithm>
#include <array>
#include <cmath>

#include "bough/lanes/taylor.hpp"
#include "bough/results/observe.hpp"

namespace bough::results {

using Series = lanes::Taylor<double, 1>;  ///< value and change to first order

/// Motion of a port and its first-order change with the node's increment eta (in the node's own axes) that is below the
/// round-off of its position (State::unsettled): R' = R ~w, x' = R v.
inline elements::PortMotion<Series> with_unsettled(const elements::PortMotion<double>& p, const elements::Port& port,
                                                   const step::State& state) {
  elements::PortMotion<Series> r;
  r.H.R = lanes::cast<Series>(p.H.R);
  r.H.x = lanes::cast<Series>(p.H.x);
  r.v = r.a = motion::Vec6<Series>::zero();
  if (port.node == elements::ground) return r;
  motion::Vec6<double> eta = state.unsettled[static_cast<std::size_t>(port.node)];
  if (port.has_offset) eta = motion::inverse_adjoint_times(port.offset, eta);
  const motion::Vec3<double> dx = p.H.R * lanes::linear_part(eta), w = lanes::angular_part(eta);
  for (int i = 0; i < 3; ++i) {
    r.H.x[i].c[1] = dx[i];
    for (int j = 0; j < 3; ++j) {
      const int k = (j + 1) % 3, l = (j + 2) % 3;
      r.H.R(i, j).c[1] = p.H.R(i, k) * w[l] - p.H.R(i, l) * w[k];
    }
  }
  return r;
}

/// Adds the residual of an element to `sum`. In statics it includes the first-order effect of that increment, f + K
/// eta; see step/settle.hpp.
template <class E>
void add_settled_residual(const E& e, const elements::PortMotion<double>* p, const elements::Field& f,
                          const step::State& state, double* sum) {
  constexpr int n = 6 * E::num_ports;
  double out[n];
  elements::eval_residual(e, p, f.around, out);
  for (int k = 0; k < n; ++k) sum[k] += out[k];
  if (state.unsettled.empty()) return;
  elements::PortMotion<Series> moved[E::num_ports];
  for (int i = 0; i < E::num_ports; ++i) moved[i] = with_unsettled(p[i], e.ports[i], state);
  Series law(0.0);
  elements::Surroundings<Series> around{lanes::cast<Series>(f.around.gravity), &law, f.around.has_inertia};
  E own = e;
  if constexpr (E::role == elements::Role::load) {
    law = Series(f.around.laws[own.law]);
    own.law = 0;
  }
  Series change[n];
  elements::eval_residual(own, moved, around, change);
  for (int k = 0; k < n; ++k) sum[k] += change[k].c[1];
}

/// A wrench in the axes of a section and about its origin, as one about the origin of the frame in which the section
/// has the pose H, and the reverse.
inline motion::Vec6<double> to_frame(const motion::Frame<double>& H, const motion::Vec6<double>& f) {
  const motion::Vec3<double> force = H.R * lanes::linear_part(f);
  return lanes::join(force, H.R * lanes::angular_part(f) + lanes::cross(H.x, force));
}
inline motion::Vec6<double> from_frame(const motion::Frame<double>& H, const motion::Vec6<double>& f) {
  const motion::Vec3<double> force = lanes::linear_part(f);
  return lanes::join(lanes::transpose_times(H.R, force),
                     lanes::transpose_times(H.R, lanes::angular_part(f) - lanes::cross(H.x, force)));
}

/// Sectional force of an element at s in [0, 1]: what the rest of the beam beyond s exerts there, by the equilibrium of
/// the part before it. With the wrenches F_i on the nodes, which balance the element, and the load q of mass, gravity
/// and line loads per length, all about one point,
///   F(s) = - sum_{s_i < s} F_i - L int_0^s q + s g,   g = sum_i F_i + L int_0^1 q.
/// g is what the quadrature of the element leaves over: with it F(1) is the wrench on the last node. So the forces at
/// the ends are those of nodal equilibrium, and between them nothing depends on the order of the element but the shape
/// on which the loads act. In statics the wrenches include the first-order effect of increments below the round-off of
/// positions.
template <class E>
class ElementForce {
 public:
  ElementForce(const step::System& system, const E& e, const std::vector<int>& loads, const elements::Field& f,
               const step::State& state)
      : system_(system), e_(e), loads_(loads), field_(f) {
    eval_motions();
    eval_nodal_wrenches(state);
    has_load_ = e.has_mass || !loads.empty();
    for (int i = 0; i < N; ++i) left_over_ += nodal_[i];
    if (!has_load_) return;
    pieces_ = pieces_for_bend();
    total_ = integral(0.0, 1.0);
    left_over_ += total_;
  }

  /// In the axes of the section. Cheapest where s grows from call to call.
  motion::Vec6<double> at(double s) {
    motion::Vec6<double> sum = s * left_over_;
    for (int i = 0; i < N; ++i)
      if (i == 0 || static_cast<double>(i) / (N - 1) < s) sum -= nodal_[i];
    if (has_load_) {
      if (s < done_) {
        done_ = 0.0;
        load_ = motion::Vec6<double>::zero();
      }
      if (1.0 - s < s - done_)
        load_ = total_ - integral(s, 1.0);
      else
        load_ += integral(done_, s);
      done_ = s;
      sum -= load_;
    }
    return from_frame(section_at(s).relative, sum);
  }

 private:
  static constexpr int N = E::num_ports;

  elements::SectionMotion<double> section_at(double s) const {
    double shape[N], slope[N];
    elements::eval_interpolation<N>(s, shape, slope);
    return elements::eval_section<double, N>(shape, shape_, rate_, rate2_, port_[E::reference]);
  }

  void eval_motions() {
    const motion::Vec3Pair anchor = elements::anchor_of(e_, field_.nodes);
    for (int i = 0; i < N; ++i) {
      port_[i] = elements::eval_port(e_.ports[i], field_.nodes, anchor);
      if (field_.observer != nullptr)
        elements::add_observer_motion(port_[i], motion::Vec3<double>(anchor.hi + anchor.lo), field_.observer->twist,
                                      field_.observer->twist_rate);
    }
    shape_ = elements::eval_shape<double, N>(port_);
    elements::eval_shape_rates<double, N>(shape_, port_, rate_);
    elements::eval_shape_accelerations<double, N>(shape_, port_, rate_, rate2_);
  }

  /// Wrenches on the nodes, in the axes of the reference node and about its origin.
  void eval_nodal_wrenches(const step::State& state) {
    double out[6 * N] = {};
    add_settled_residual(e_, port_, field_, state, out);
    for_each_load([&](const auto& load) { add_settled_residual(load, port_, field_, state, out); });
    for (int i = 0; i < N; ++i) {
      motion::Vec6<double> own;
      for (int k = 0; k < 6; ++k) own[k] = out[6 * i + k];
      nodal_[i] = to_frame(shape_.relative[i], own);
    }
  }

  template <class Visit>
  void for_each_load(const Visit& visit) const {
    const plan::Plan& plan = system_.plan();
    for (const int id : loads_)
      plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(id)], [&](const auto& load) {
        using L = std::decay_t<decltype(load)>;
        if constexpr (L::role == elements::Role::load && L::num_ports == N) visit(load);
      });
  }

  /// Load per length on a section, in its axes: line loads, and weight less inertia, -(m (a - R^T g) - ad(v)^T m v).
  motion::Vec6<double> load_on(const elements::SectionMotion<double>& m, const motion::Mat3<double>& R) const {
    motion::Vec6<double> sum = motion::Vec6<double>::zero();
    for_each_load([&](const auto& load) {
      const motion::Vec6<double> w = field_.around.laws[load.law] * load.wrench;
      sum += load.follows ? w
                          : lanes::join(lanes::transpose_times(R, lanes::linear_part(w)),
                                        lanes::transpose_times(R, lanes::angular_part(w)));
    });
    if (!e_.has_mass) return sum;
    motion::Vec6<double> a = motion::Vec6<double>::zero();
    if (field_.around.has_inertia) a = m.a;
    const motion::Vec3<double> weight = lanes::transpose_times(R, field_.around.gravity);
    for (int k = 0; k < 3; ++k) a[k] -= weight[k];
    sum -= e_.mass * a;
    if (field_.around.has_inertia) sum += motion::cross6_transpose_times(m.v, e_.mass * m.v);
    return sum;
  }

  /// Into how many pieces the quadrature cuts the element. Three points of Gauss on a piece over which sections turn by
  /// an angle t leave over a share of about t^6 / 2e6 of a load that turns with them: 1e-10 for a quarter of a radian.
  /// At most eight pieces, for two radians.
  int pieces_for_bend() const {
    double angle = 0.0;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < i; ++j)
        angle = std::max(angle, lanes::length_of(lanes::angular_part(shape_.d[i]) - lanes::angular_part(shape_.d[j])));
    return std::clamp(static_cast<int>(std::ceil(4.0 * angle)), 1, 8);
  }

  /// L times the integral of the load over [from, to], by three points of Gauss, exact for a fifth degree, on each piece.
  motion::Vec6<double> integral(double from, double to) const {
    constexpr double offset = 0.7745966692414834, weights[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    const int pieces = std::max(1, static_cast<int>(std::ceil(pieces_ * (to - from))));
    const double width = (to - from) / pieces;
    motion::Vec6<double> sum = motion::Vec6<double>::zero();
    for (int k = 0; k < 3 * pieces; ++k) {
      const double s = from + width * (k / 3 + 0.5 + 0.5 * offset * (k % 3 - 1));
      const elements::SectionMotion<double> m = section_at(s);
      const motion::Mat3<double> R = port_[E::reference].H.R * m.relative.R;
      sum += (weights[k % 3] * width * e_.length) * to_frame(m.relative, load_on(m, R));
    }
    return sum;
  }

  const step::System& system_;
  const E& e_;
  const std::vector<int>& loads_;
  const elements::Field& field_;
  elements::PortMotion<double> port_[N];
  elements::BeamShape<double, N> shape_;
  motion::Vec6<double> rate_[N], rate2_[N], nodal_[N];
  motion::Vec6<double> left_over_ = motion::Vec6<double>::zero();
  bool has_load_ = false;
  int pieces_ = 1;
  motion::Vec6<double> total_ = motion::Vec6<double>::zero();  ///< integral of the load over the element
  double done_ = 0.0;                                          ///< up to where load_ is the integral
  motion::Vec6<double> load_ = motion::Vec6<double>::zero();
};

}  // namespace bough::results
