#pragma once
/// Bodies of the drivers in evaluate.hpp; included once per element type, in the file that instantiates it.
#include "bough/lanes/taylor.hpp"
#include "driver.hpp"
#include "emit.hpp"

namespace bough::elements {

template <class E>
void evaluate(const E& e, const FieldOn<typename E::Group, double>& field, const double* multipliers, double turns,
              double* residual, double* tangent) {
  evaluate_element(e, field, multipliers, turns, residual, tangent);
}

/// Taylor series of a port's motion from pose, twist, acceleration and jerk of its node.
template <int K>
PortMotion<lanes::Taylor<double, K>> series_of(const PortMotion<double>& p, const Vec6<double>& jerk) {
  using T = lanes::Taylor<double, K>;
  PortMotion<T> r;
  r.H.R = lanes::cast<T>(p.H.R);
  r.H.x = lanes::cast<T>(p.H.x);
  r.v = lanes::cast<T>(p.v);
  r.a = lanes::cast<T>(p.a);
  for (int i = 0; i < 6; ++i) {
    r.v[i].c[1] = p.a[i];
    r.a[i].c[1] = jerk[i];
    if constexpr (K >= 2) r.v[i].c[2] = 0.5 * jerk[i];
  }
  for (int k = 0; k < K; ++k)  // R' = R ~w, x' = R v, coefficient by coefficient
    for (int i = 0; i < 3; ++i) {
      double dx = 0.0, dR[3] = {0.0, 0.0, 0.0};
      for (int j = 0; j <= k; ++j) {
        const double R0 = r.H.R(i, 0).c[j], R1 = r.H.R(i, 1).c[j], R2 = r.H.R(i, 2).c[j];
        const int l = k - j;
        dx += R0 * r.v[0].c[l] + R1 * r.v[1].c[l] + R2 * r.v[2].c[l];
        dR[0] += R1 * r.v[5].c[l] - R2 * r.v[4].c[l];
        dR[1] += R2 * r.v[3].c[l] - R0 * r.v[5].c[l];
        dR[2] += R0 * r.v[4].c[l] - R1 * r.v[3].c[l];
      }
      r.H.x[i].c[k + 1] = dx / (k + 1);
      for (int j = 0; j < 3; ++j) r.H.R(i, j).c[k + 1] = dR[j] / (k + 1);
    }
  return r;
}

/// The same in a plane, where R' = i w R and x' = R u, to first order.
inline PortMotionOn<motion::Se2, lanes::Taylor<double, 1>> series_of(const PortMotionOn<motion::Se2, double>& p,
                                                                     const Vec3<double>& jerk) {
  using T = lanes::Taylor<double, 1>;
  PortMotionOn<motion::Se2, T> r;
  const motion::Vec2<double> turning = p.v[2] * motion::quarter_turn(p.H.R);
  const motion::Vec2<double> moving = motion::complex_times(p.H.R, motion::plane_part(p.v));
  for (int i = 0; i < 2; ++i) {
    r.H.R[i] = T(p.H.R[i]);
    r.H.R[i].c[1] = turning[i];
    r.H.x[i] = T(p.H.x[i]);
    r.H.x[i].c[1] = moving[i];
  }
  for (int i = 0; i < 3; ++i) {
    r.v[i] = T(p.v[i]);
    r.v[i].c[1] = p.a[i];
    r.a[i] = T(p.a[i]);
    r.a[i].c[1] = jerk[i];
  }
  return r;
}
/// The same where nothing turns, x' = v.
template <int N>
PortMotionOn<motion::Translations<N>, lanes::Taylor<double, 1>> series_of(
    const PortMotionOn<motion::Translations<N>, double>& p, const Vec<double, N>& jerk) {
  using T = lanes::Taylor<double, 1>;
  PortMotionOn<motion::Translations<N>, T> r;
  for (int i = 0; i < N; ++i) {
    r.H.x[i] = T(p.H.x[i]);
    r.H.x[i].c[1] = p.v[i];
    r.v[i] = T(p.v[i]);
    r.v[i].c[1] = p.a[i];
    r.a[i] = T(p.a[i]);
    r.a[i].c[1] = jerk[i];
  }
  return r;
}
inline PortMotion<lanes::Taylor<double, 1>> series_of(const PortMotion<double>& p, const Vec6<double>& jerk) {
  return series_of<1>(p, jerk);
}

template <class E>
void evaluate_rate(const E& e, const FieldOn<typename E::Group, double>& field,
                   const SurroundingsOn<typename E::Group, lanes::Taylor<double, 1>>& around, const double* multipliers,
                   double turns, const typename E::Group::template Vector<double>* jerks, double* residual_rate) {
  using G = typename E::Group;
  using T = lanes::Taylor<double, 1>;
  constexpr int P = E::num_ports;
  const auto anchor = anchor_of(e, field.nodes);
  PortMotionOn<G, T> p[P];
  for (int k = 0; k < P; ++k) {
    auto jerk = G::template Vector<double>::zero();
    if (jerks != nullptr && e.ports[k].node != ground)
      jerk = e.ports[k].has_offset ? G::inverse_adjoint_times(e.ports[k].offset, jerks[k]) : jerks[k];
    p[k] = series_of(eval_port(e.ports[k], field.nodes, anchor, field.carriers), jerk);
  }
  if constexpr (has_mass_matrix<E> && G::has_moving_frames) {
    if (field.observer != nullptr && around.has_inertia) {
      Vec6<T> twist = lanes::cast<T>(field.observer->twist), twist_rate = lanes::cast<T>(field.observer->twist_rate);
      for (int i = 0; i < 6; ++i) {
        twist[i].c[1] = field.observer->twist_rate[i];
        twist_rate[i].c[1] = field.observer->twist_second[i];
      }
      for (int k = 0; k < P; ++k)
        add_observer_motion(p[k], lanes::cast<T>(Vec3<double>(anchor.hi + anchor.lo)), twist, twist_rate);
    }
  }
  T out[G::dof * P], rows[E::num_multipliers + 1], lambda[E::num_multipliers + 1] = {};
  for (int k = 0; k < num_multipliers(e); ++k) lambda[k] = T(multipliers[k]);
  eval_kernel(e, p, lambda, around, turns, out, rows);
  double rate[G::dof * P];
  for (int i = 0; i < G::dof * P; ++i) rate[i] = out[i].c[1];
  const Places<E> places(e);
  carry_wrenches(e, places, rate, residual_rate);
  for (int k = 0; k < num_multipliers(e); ++k) residual_rate[places.forces + k] = rows[k].c[1];
}

/// The drivers of evaluate.hpp, to be emitted.
template <class E>
inline constexpr auto alone_drivers = std::tuple{&evaluate<E>, &evaluate_rate<E>};

}  // namespace bough::elements
