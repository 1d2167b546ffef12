/// Residuals as derivatives of energies: elasticity from the strain energy, inertia from the kinetic energy.
#include <gtest/gtest.h>

#include "bough/elements/energies.hpp"
#include "bough/lanes/jet.hpp"
#include "elements/check_element.hpp"

namespace bough::elements::check {
namespace {

constexpr double exact = 1e-13;  // both sides exact, numbers near one

/// Derivative of the strain energy along all node increments.
template <class E>
std::vector<double> energy_gradient(const Sample<E>& s) {
  const motion::Vec3Pair anchor = anchor_of(s.element, s.nodes.data());
  const std::vector<Complex> laws = complex_of(s.laws);
  std::vector<double> r;
  for (const Port& port : s.element.ports) {
    if (port.node == ground) continue;
    for (int k = 0; k < 6; ++k) {
      std::vector<NodeState<Complex>> states = states_of<Complex>(s.nodes, anchor);
      NodeState<Complex>& n = states[static_cast<std::size_t>(port.node)];
      n.H = motion::compose(n.H, motion::exp_se3(Vec6<Complex>(Complex(0.0, complex_step) * Vec6<Complex>::unit(k))));
      const auto p = ports_of(s.element, states, anchor.hi);
      r.push_back(energy_of(s.element, p.data(), s.turns, laws.data()).imag() / complex_step);
    }
  }
  return r;
}

template <class E>
void expect_conservative(const Sample<E>& s) {
  SCOPED_TRACE(s.name);
  const std::vector<double> gradient = energy_gradient(s);
  EXPECT_LE(relative_error(residual_of(s, s.field(false)), gradient), exact);
  EXPECT_GT(largest(gradient), 0.5);  // not compared with nothing: all samples are strained
}

TEST(ElementEnergy, static_residual_of_a_beam_is_the_derivative_of_its_strain_energy) {
  for (const Ends ends : {Ends::plain, Ends::offset, Ends::grounded}) {
    expect_conservative(beam_sample<2>(ends, false));
    expect_conservative(beam_sample<3>(ends, false));
    expect_conservative(beam_sample<4>(ends, false));
  }
}

/// Energies as they are reported, of a beam that moves.
template <int N>
void expect_energies(const Sample<Beam<N>>& s) {
  SCOPED_TRACE(s.name);
  const motion::Vec3Pair anchor = anchor_of(s.element, s.nodes.data());
  const auto p = ports_of(s.element, states_of<double>(s.nodes, anchor), anchor.hi);
  const Energies got = eval_energies(s.element, s.field(true), 0.0);
  const double strain = strain_energy_of(s.element, p.data()), kinetic = kinetic_energy_of(s.element, p.data());
  EXPECT_NEAR(got.strain, strain, exact * strain);
  EXPECT_NEAR(got.kinetic, kinetic, exact * kinetic);
}

TEST(ElementEnergy, of_a_beam_is_that_of_its_sections) {
  for (const Ends ends : {Ends::plain, Ends::offset, Ends::grounded}) {
    expect_energies(beam_sample<2>(ends, true));
    expect_energies(beam_sample<3>(ends, true));
    expect_energies(beam_sample<4>(ends, true));
  }
}

TEST(ElementEnergy, static_residual_of_springs_bushings_and_joint_springs_is_the_derivative_of_their_energy) {
  for_all_couplings([](const auto& s) { expect_conservative(s); });
  for (const Ends ends : {Ends::plain, Ends::offset, Ends::grounded}) {
    Sample<Joint> s = joint_sample("springs of a joint", {}, true, ends);
    s.element.efforts[0].law = -1;  // a drive has no energy
    expect_conservative(s);
  }
}

TEST(ElementEnergy, stress_free_shape_has_neither_energy_nor_forces) {
  const auto check = [](auto s) {
    SCOPED_TRACE(s.name);
    s.element.has_mass = false;
    constexpr int N = std::remove_cvref_t<decltype(s.element)>::num_ports;
    std::vector<Frame<double>> poses;
    for (const NodeMotion& n : s.nodes) poses.push_back({n.R, n.x.hi});
    set_reference(s.element, still(poses).data());
    EXPECT_LE(largest(residual_of(s, s.field(false))), 1e-14 * N);
    EXPECT_LE(strain_energy_of(s.element, still(poses).data()), 1e-28);
  };
  check(beam_sample<2>(Ends::plain));
  check(beam_sample<3>(Ends::plain));
  check(beam_sample<4>(Ends::plain));
}

/// Without elasticity, damping and gravity: what is left is inertia.
template <int N>
Sample<Beam<N>> only_inertia(Sample<Beam<N>> s) {
  s.element.stiffness = Mat6<double>::zero();
  s.element.has_damping = false;
  return s;
}
inline Sample<RigidBody> only_inertia(Sample<RigidBody> s) { return s; }

/// Inertia forces of the kinetic energy K(H, v):  d/dt (dK/dv) - ad(v)^T dK/dv - dK/dH, in the ports' axes. The
/// derivatives by v and their rates come from jets within a series in time along the motion, those by H from jets.
template <class E>
std::vector<double> euler_poincare(const E& e, const std::vector<PortMotion<double>>& p) {
  constexpr int P = E::num_ports, D = 6 * P;
  using J = lanes::Jet<double, D>;
  using T = lanes::Taylor<J, 1>;
  PortMotion<T> moving[P];
  PortMotion<J> displaced[P];
  for (int k = 0; k < P; ++k) {
    const PortMotion<double>& q = p[static_cast<std::size_t>(k)];
    const Mat3<double> spin = q.H.R * lanes::skew(lanes::angular_part(q.v));
    const Vec3<double> velocity = q.H.R * lanes::linear_part(q.v);
    moving[k] = {motion::cast<T>(q.H), lanes::cast<T>(q.v), lanes::cast<T>(q.a)};
    displaced[k] = {motion::cast<J>(q.H), lanes::cast<J>(q.v), lanes::cast<J>(q.a)};
    for (int i = 0; i < 9; ++i) moving[k].H.R.m[i].c[1] = J(spin.m[i]);
    for (int i = 0; i < 3; ++i) moving[k].H.x[i].c[1] = J(velocity[i]);
    Vec6<J> eta = Vec6<J>::zero();
    for (int i = 0; i < 6; ++i) {
      moving[k].v[i].c[0].d[6 * k + i] = 1.0;
      moving[k].v[i].c[1] = J(q.a[i]);
      eta[i] = J::variable(0.0, 6 * k + i);
    }
    displaced[k].H = motion::compose(displaced[k].H, motion::exp_se3(eta));
  }
  const T along = kinetic_energy_of(e, moving);
  const J across = kinetic_energy_of(e, displaced);
  std::vector<double> r;
  for (int k = 0; k < P; ++k) {
    Vec6<double> momentum;
    for (int i = 0; i < 6; ++i) momentum[i] = along.c[0].d[6 * k + i];
    const Vec6<double> carried = motion::cross6_transpose_times(p[static_cast<std::size_t>(k)].v, momentum);
    for (int i = 0; i < 6; ++i) r.push_back(along.c[1].d[6 * k + i] - carried[i] - across.d[6 * k + i]);
  }
  return r;
}

template <class E>
void expect_consistent_inertia(const Sample<E>& given) {
  SCOPED_TRACE(given.name);
  const Sample<E> s = only_inertia(given);
  Field field = s.field(true);
  field.around.gravity = Vec3<double>::zero();
  const std::vector<double> forces = residual_of(s, field);
  const motion::Vec3Pair anchor = anchor_of(s.element, s.nodes.data());
  const auto p = ports_of(s.element, states_of<double>(s.nodes, anchor), anchor.hi);
  EXPECT_LE(relative_error(forces, euler_poincare(s.element, p)), exact);

  // Power balance: F . v = dK/dt.
  double power = 0.0, scale = 0.0;
  std::vector<PortMotion<Taylor1>> moving;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const Mat3<double> spin = p[k].H.R * lanes::skew(lanes::angular_part(p[k].v));
    const Vec3<double> velocity = p[k].H.R * lanes::linear_part(p[k].v);
    moving.push_back({motion::cast<Taylor1>(p[k].H), lanes::cast<Taylor1>(p[k].v), lanes::cast<Taylor1>(p[k].a)});
    for (int i = 0; i < 9; ++i) moving[k].H.R.m[i].c[1] = spin.m[i];
    for (int i = 0; i < 3; ++i) moving[k].H.x[i].c[1] = velocity[i];
    for (int i = 0; i < 6; ++i) {
      moving[k].v[i].c[1] = p[k].a[i];
      power += forces[6 * k + static_cast<std::size_t>(i)] * p[k].v[i];
      scale += std::abs(forces[6 * k + static_cast<std::size_t>(i)] * p[k].v[i]);
    }
  }
  EXPECT_NEAR(power, kinetic_energy_of(s.element, moving.data()).c[1], exact * scale);
}

TEST(ElementEnergy, inertia_forces_are_those_of_the_kinetic_energy) {
  expect_consistent_inertia(body_sample(false));
  expect_consistent_inertia(beam_sample<2>(Ends::plain));
  expect_consistent_inertia(beam_sample<3>(Ends::plain));
  expect_consistent_inertia(beam_sample<4>(Ends::plain));
}

/// Gravity against a dead line load of the same weight on a mass whose axis is its centre line.
template <int N>
void expect_weight() {
  Sample<Beam<N>> s = only_inertia(beam_sample<N>(Ends::plain));
  s.element.mass = make_mass_matrix(2.5, Vec3<double>::zero(), Mat3<double>::identity());
  Sample<LineLoad<N>> q = line_load_sample<N>(false, Ends::plain);
  q.nodes = s.nodes;
  const Field field = s.field(false);
  q.element.wrench = lanes::join<double>((2.5 / q.laws[2]) * field.around.gravity, Vec3<double>::zero());
  EXPECT_LE(relative_error(residual_of(s, field), residual_of(q, field)), exact);
}

TEST(ElementEnergy, gravity_is_a_dead_load_of_the_weight) {
  expect_weight<2>();
  expect_weight<3>();
  expect_weight<4>();
}

/// Potential of gravity, differenced: the mass is eccentric, so gravity turns the nodes too.
template <class E>
void expect_gravity_potential(const Sample<E>& given) {
  SCOPED_TRACE(given.name);
  const Sample<E> s = only_inertia(given);
  const Field field = s.field(false);
  std::vector<double> slope;
  for (const Port& port : s.element.ports) {
    if (port.node == ground) continue;
    for (int k = 0; k < 6; ++k) {
      const double step = 1e-4;
      double potential[4];
      for (int side = 0; side < 4; ++side) {
        Sample<E> moved = s;
        NodeMotion& n = moved.nodes[static_cast<std::size_t>(port.node)];
        const double at = step * (side < 2 ? 1.0 : 2.0) * (side % 2 == 0 ? 1.0 : -1.0);
        const Frame<double> H =
            motion::compose(Frame<double>{n.R, n.x.hi}, motion::exp_se3(Vec6<double>(at * Vec6<double>::unit(k))));
        n.R = H.R;
        n.x = motion::Vec3Pair::from(H.x);
        potential[side] = measured(moved, false).potential;
      }
      slope.push_back((8.0 * (potential[0] - potential[1]) - (potential[2] - potential[3])) / (12.0 * step));
    }
  }
  // Fourth order differences: 1e-16 of truncation, 1e-12 of round-off.
  EXPECT_LE(relative_error(residual_of(s, field), slope), 1e-11);
}

TEST(ElementEnergy, gravity_is_the_derivative_of_the_measured_potential) {
  expect_gravity_potential(body_sample(true));
  Mat6<double> eccentric = make_mass_matrix(1.4, Vec3<double>{{0.0, 0.2, -0.1}}, Mat3<double>::identity());
  const auto check = [&](auto s) {
    s.element.mass = eccentric;
    expect_gravity_potential(s);
  };
  check(beam_sample<2>(Ends::offset));
  check(beam_sample<3>(Ends::offset));
  check(beam_sample<4>(Ends::grounded));
}

TEST(ElementEnergy, dead_forces_do_the_work_of_their_resultant_and_follower_forces_turn_with_the_port) {
  Sample<PointLoad> dead = point_load_sample(false), follower = point_load_sample(true);
  const Port& port = dead.element.ports[0];
  for (Sample<PointLoad>* s : {&dead, &follower}) {
    const NodeMotion& n = s->nodes[0];
    const Frame<double> H = motion::compose(Frame<double>{n.R, n.x.hi}, port.offset);
    const Vec6<double> given = s->laws[1] * s->element.wrench;
    const Vec3<double> force = s->element.follows ? H.R * lanes::linear_part(given) : lanes::linear_part(given);
    const Vec3<double> moment = s->element.follows ? H.R * lanes::angular_part(given) : lanes::angular_part(given);
    // Resultant at the node, in inertial axes.
    const Vec3<double> at_node = moment + lanes::cross(H.x - n.x.hi, force);
    const std::vector<double> r = residual_of(*s, s->field(false));
    const Vec3<double> got_force = n.R * Vec3<double>{{-r[0], -r[1], -r[2]}};
    const Vec3<double> got_moment = n.R * Vec3<double>{{-r[3], -r[4], -r[5]}};
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(got_force[i], force[i], 1e-15 * 4);
      EXPECT_NEAR(got_moment[i], at_node[i], 1e-15 * 4);
    }
  }
}

}  // namespace
}  // namespace bough::elements::check
