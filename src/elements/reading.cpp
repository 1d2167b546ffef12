#include "bough/elements/reading.hpp"

#include "evaluate_impl.hpp"

namespace bough::elements {

namespace {

template <class G, class S>
S eval_read_effort(const JointOn<G, double>& reading, const PortMotionOn<G, S>* p, bool has_rates, double turns) {
  const EffortOn<G, double>& effort = reading.efforts[0];
  const typename G::template Pose<S> H = G::relative(p[0].H, p[1].H);
  typename G::template Wrench<S> gradient;
  const S value = eval_coordinate<G, S, double>(effort, H, turns, gradient);
  const bool damps = has_rates && is_present(effort.damping);
  S rate(0.0);
  if (damps) rate = G::real_power(gradient, relative_twist<G, S>(H, p));
  return eval_effort<G, S, double>(effort, value, damps ? &rate : nullptr, nullptr);
}

/// The derivatives by the increments of both ports:  df = row . zeta + c g . dxi  in the terms of relative_force.hpp.
template <class G>
void eval_port_rows(const JointOn<G, double>& reading, const PortMotionOn<G, double>* p,
                    const PortSlopesOn<G, double>* ports, bool has_rates, double turns,
                    typename G::template Vector<double>* rows) {
  using Wrench = typename G::template Wrench<double>;
  const EffortOn<G, double>& effort = reading.efforts[0];
  const typename G::template Pose<double> H = G::relative(p[0].H, p[1].H);
  const auto Q = G::inverse_adjoint_map(H);
  Wrench gradient;
  eval_coordinate<G, double, double>(effort, H, turns, gradient);
  const bool damps = has_rates && is_present(effort.damping), moves = ports[0].moves;
  const Wrench damped = G::scaled(effort.damping, gradient);
  Wrench row = G::scaled(moves ? effort.stiffness : 0.0, gradient);
  if (damps && moves) {
    if (has_gradient_slope<G>(effort.coordinate)) {
      const auto xi = relative_twist<G, double>(H, p);
      const auto slope = eval_gradient_slope<G, double, double>(effort.coordinate, effort.direction, 0.0, H);
      if constexpr (G::turns) {
        if (slope.has_force)
          row = G::add(row, effort.damping, Wrench(G::moment(G::force_slope_transpose_times(slope.force, xi))));
        if (slope.has_moment)
          row = G::add(row, effort.damping, Wrench(G::moment(G::moment_slope_transpose_times(slope.moment, xi))));
      }
      if (slope.has_lateral) {
        const Wrench across =
            G::add(G::force(G::linear(G::vector_of_motion(xi))), -G::real_power(gradient, xi), gradient);
        row = G::add(row, effort.damping * slope.lateral, across);
      }
    }
    row = G::add(row, -1.0, Wrench(G::dual_bracket(G::times(Q, G::motion(p[0].v)), damped)));
  }
  rows[1] = G::vector_of_wrench(row);
  rows[0] = -G::inverse_adjoint_transpose_times(H, rows[1]);
  if (!damps) return;
  rows[1] += G::vector_of_wrench(Wrench(G::transpose_times(ports[1].velocity, damped)));
  const typename G::template Vector<double> carried =
      -G::inverse_adjoint_transpose_times(H, G::vector_of_wrench(damped));
  rows[0] += G::vector_of_wrench(Wrench(G::transpose_times(ports[0].velocity, G::wrench(carried))));
}

}  // namespace

template <class G>
double eval_reading(const JointOn<G, double>& reading, const FieldOn<G, double>& field, double turns, double* slopes) {
  const auto anchor = anchor_of(reading, field.nodes);
  PortMotionOn<G, double> p[2];
  for (int k = 0; k < 2; ++k) p[k] = eval_port(reading.ports[k], field.nodes, anchor, field.carriers);
  const bool has_rates = field.around.has_inertia;
  if (slopes != nullptr) {
    PortSlopesOn<G, double> ports[2];
    eval_port_slopes(reading, field, p, ports);
    typename G::template Vector<double> rows[2];
    eval_port_rows<G>(reading, p, ports, has_rates, turns, rows);
    for (int k = 0; k < 2; ++k) {
      const PortOn<G, double>& port = reading.ports[k];
      if (port.has_offset) rows[k] = G::inverse_adjoint_transpose_times(port.offset, rows[k]);
      for (int i = 0; i < G::dof; ++i) slopes[G::dof * k + i] = port.node == ground ? 0.0 : rows[k][i];
    }
  }
  return eval_read_effort<G, double>(reading, p, has_rates, turns);
}

template <class G>
double eval_reading_rate(const JointOn<G, double>& reading, const FieldOn<G, double>& field, double turns) {
  using T = lanes::Taylor<double, 1>;
  const auto anchor = anchor_of(reading, field.nodes);
  PortMotionOn<G, T> p[2];
  for (int k = 0; k < 2; ++k)
    p[k] =
        series_of(eval_port(reading.ports[k], field.nodes, anchor, field.carriers), G::template Vector<double>::zero());
  return eval_read_effort<G, T>(reading, p, field.around.has_inertia, turns).c[1];
}

lanes::Taylor<double, 3> eval_reading_series(const Joint& reading, const Field& field, double turns) {
  using T = lanes::Taylor<double, 3>;
  const auto anchor = anchor_of(reading, field.nodes);
  PortMotion<T> p[2];
  for (int k = 0; k < 2; ++k)
    p[k] = series_of<3>(eval_port(reading.ports[k], field.nodes, anchor, field.carriers), Vec6<double>::zero());
  return eval_read_effort<motion::Se3, T>(reading, p, false, turns);
}

#define BOUGH_INSTANTIATE_READING(G)                                                                   \
  template double eval_reading(const JointOn<G, double>&, const FieldOn<G, double>&, double, double*); \
  template double eval_reading_rate(const JointOn<G, double>&, const FieldOn<G, double>&, double);
BOUGH_FOR_EVERY_GROUP(BOUGH_INSTANTIATE_READING)

}  // namespace bough::elements
