/// Energies, powers and momenta of elements: balances in time, exact rigid bodies, signs.
#include <gtest/gtest.h>

#include "elements/check_element.hpp"

namespace bough::elements::check {
namespace {

/// The sample a little later (or earlier) on its motion, to first order exact in pose and twist.
template <class E>
Sample<E> later(const Sample<E>& s, double time) {
  Sample<E> r = s;
  for (NodeMotion& n : r.nodes) {
    const Frame<double> H = motion::compose(Frame<double>{n.R, n.x.hi}, motion::exp_se3(Vec6<double>(time * n.v)));
    n.R = H.R;
    n.x = motion::Vec3Pair::from(H.x);
    n.v += time * n.a;
  }
  return r;
}
template <class E>
Measures measures_of(const Sample<E>& s, bool has_inertia = true) {
  return measure(s.element, s.field(has_inertia), s.multipliers.data(), s.turns);
}
/// d/dt of some measure by differences of fourth order.
template <class E, class Pick>
double rate_of(const Sample<E>& s, const Pick& pick) {
  const double h = 1e-3;
  const auto at = [&](double time) { return pick(measured(later(s, time))); };
  return (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
}
constexpr double differenced = 3e-9;  // h^4 times fifth derivatives of some hundreds, and 1e-13 of round-off

/// Power that the nodes' forces give to the element = energy stored + dissipated - given by loads and drives.
template <class E>
void expect_power_balance(const Sample<E>& s) {
  SCOPED_TRACE(s.name);
  const std::vector<double> r = residual_of(s, s.field(true));
  double power = 0.0;
  std::size_t row = 0;
  for (const Port& port : s.element.ports) {
    if (port.node == ground) continue;
    for (int i = 0; i < 6; ++i) power += r[row++] * s.nodes[static_cast<std::size_t>(port.node)].v[i];
  }
  const Measured m = measured(s);
  const double dissipated = measures_of(s).dissipation_rate;
  const double stored = rate_of(s, [](const Measured& q) { return q.kinetic + q.strain + q.potential; });
  EXPECT_NEAR(power, stored + dissipated - m.work_rate, differenced);
  EXPECT_GE(dissipated, 0.0);
  EXPECT_GE(m.kinetic, 0.0);
  EXPECT_GE(m.strain, 0.0);
}

TEST(Measures, power_at_the_nodes_is_stored_dissipated_or_comes_from_loads) {
  for_all_elements([](const auto& s) { expect_power_balance(s); });
}

/// Resultant that the nodes give to the element + its own load (gravity, loads, ground) = rate of its momentum.
template <class E>
void expect_momentum_balance(const Sample<E>& s) {
  SCOPED_TRACE(s.name);
  const std::vector<double> r = residual_of(s, s.field(true));
  const Measured m = measured(s);
  Vec6<double> balance = m.load;
  std::size_t row = 0;
  for (const Port& port : s.element.ports) {
    if (port.node == ground) continue;
    const NodeMotion& n = s.nodes[static_cast<std::size_t>(port.node)];
    Vec3<double> f, c;
    for (int i = 0; i < 3; ++i) f[i] = r[row + static_cast<std::size_t>(i)];
    for (int i = 0; i < 3; ++i) c[i] = r[row + 3 + static_cast<std::size_t>(i)];
    row += 6;
    const Vec3<double> force = n.R * f;
    balance += lanes::join<double>(force, n.R * c + lanes::cross(n.x.hi, force));
  }
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(balance[i], rate_of(s, [i](const Measured& q) { return q.momentum[i]; }), differenced) << i;
}

TEST(Measures, momentum_changes_by_the_resultant_of_nodes_gravity_loads_and_ground) {
  for_all_elements([](const auto& s) { expect_momentum_balance(s); });
}

TEST(Measures, force_is_the_resultant_of_loads_and_reactions_of_the_ground) {
  for_all_elements([](const auto& s) {
    SCOPED_TRACE(s.name);
    auto weightless = s;
    if constexpr (requires { s.element.mass; }) weightless.element.mass = Mat6<double>::zero();
    const Vec6<double> load = measured(weightless).load;
    const Vec3<double> force = measures_of(weightless).force;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(force[i], load[i], 1e-14 * 10.0);
  });
}

TEST(Measures, of_statics_hold_no_motion) {
  for_all_elements([](const auto& s) {
    const Measured m = measured(s, false);
    EXPECT_EQ(m.kinetic, 0.0);
    EXPECT_EQ(measures_of(s, false).dissipation_rate, 0.0);
    for (int i = 0; i < 6; ++i) EXPECT_EQ(m.momentum[i], 0.0);
    EXPECT_EQ(m.strain, measured(s).strain);
    EXPECT_EQ(m.potential, measured(s).potential);
  });
}

/// A straight beam that moves as a rigid body: mass, centre and inertia in closed form.
template <int N>
void expect_rigid_rod() {
  Numbers numbers(5);
  const double length = 1.7, mass = 2.3;
  const Mat3<double> section_inertia{{0.5, 0.0, 0.0, 0.0, 0.2, 0.04, 0.0, 0.04, 0.3}};
  Sample<Beam<N>> s = beam_sample<N>(Ends::plain);
  s.element.length = length;
  s.element.mass = make_mass_matrix(mass, Vec3<double>::zero(), section_inertia);
  const Vec6<double> twist = numbers.vec6();  // in the axes of the first node
  const Frame<double> start = numbers.frame();
  for (int k = 0; k < N; ++k) {
    const Frame<double> along{Mat3<double>::identity(), Vec3<double>{{k * length / (N - 1), 0.0, 0.0}}};
    const Frame<double> H = motion::compose(start, along);
    s.nodes[static_cast<std::size_t>(k)] = {H.R, motion::Vec3Pair::from(H.x),
                                            motion::inverse_adjoint_times(along, twist), Vec6<double>::zero(),
                                            Vec6<double>::zero()};
  }
  Mat3<double> inertia = length * section_inertia;  // about the centre
  for (const int i : {1, 2}) inertia(i, i) += mass * length * length * length / 12.0;
  const Mat6<double> whole = make_mass_matrix(mass * length, Vec3<double>{{0.5 * length, 0.0, 0.0}}, inertia);
  const Vec6<double> momentum = motion::inverse_adjoint_transpose_times(start, Vec6<double>(whole * twist));
  const Measured m = measured(s);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(m.momentum[i], momentum[i], 1e-14 * 10.0);
  EXPECT_NEAR(m.kinetic, 0.5 * lanes::dot(twist, Vec6<double>(whole * twist)), 1e-14 * 10.0);
  const Vec3<double> centre = motion::transform(start, Vec3<double>{{0.5 * length, 0.0, 0.0}});
  EXPECT_NEAR(m.potential, -mass * length * lanes::dot(s.field(true).around.gravity, centre), 1e-14 * 10.0);
  EXPECT_NEAR(measures_of(s).dissipation_rate, 0.0, 1e-28);  // a rigid motion has no strain rates
}

TEST(Measures, of_a_rigidly_moving_straight_beam_are_those_of_the_rod) {
  expect_rigid_rod<2>();
  expect_rigid_rod<3>();
  expect_rigid_rod<4>();
}

TEST(Measures, of_a_turning_body_do_not_depend_on_the_node_that_carries_it) {
  Sample<RigidBody> about_centre = body_sample(false), about_corner = about_centre;
  const Mat3<double> inertia{{1.1, 0.1, 0.2, 0.1, 0.9, -0.1, 0.2, -0.1, 1.3}};
  const Frame<double> centre{Mat3<double>::identity(), Vec3<double>{{0.2, -0.3, 0.5}}};
  about_corner.element.mass = make_mass_matrix(1.7, centre.x, inertia);
  about_centre.element.mass = make_mass_matrix(1.7, Vec3<double>::zero(), inertia);
  about_centre.element.ports[0] = port_at(0, centre);
  const Measured a = measured(about_centre), b = measured(about_corner);
  EXPECT_NEAR(a.kinetic, b.kinetic, 1e-14);
  EXPECT_NEAR(a.potential, b.potential, 1e-14);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(a.momentum[i], b.momentum[i], 1e-14);
    EXPECT_NEAR(a.load[i], b.load[i], 1e-14);
  }
  EXPECT_LE(relative_error(residual_of(about_centre, about_centre.field(true)),
                           residual_of(about_corner, about_corner.field(true))),
            1e-14);
}

TEST(Measures, mass_matrix_is_that_of_the_body_as_a_cloud_of_points) {
  // Eight points of 0.25 kg at the corners of a box about c.
  const Vec3<double> c{{0.2, -0.3, 0.5}}, half{{0.4, 0.3, 0.2}};
  Mat6<double> sum = Mat6<double>::zero();
  Mat3<double> inertia = Mat3<double>::zero();
  for (int corner = 0; corner < 8; ++corner) {
    Vec3<double> r = half;
    for (int i = 0; i < 3; ++i)
      if ((corner >> i & 1) != 0) r[i] = -r[i];
    const Mat3<double> from_centre = lanes::skew(r);
    inertia = inertia - 0.25 * (from_centre * from_centre);
    // Velocity of the point: [I, -~(c + r)] (v; w).
    lanes::Mat<double, 3, 6> J = lanes::Mat<double, 3, 6>::zero();
    const Mat3<double> lever = lanes::skew(Vec3<double>(c + r));
    for (int i = 0; i < 3; ++i) {
      J(i, i) = 1.0;
      for (int j = 0; j < 3; ++j) J(i, 3 + j) = -lever(i, j);
    }
    sum += 0.25 * lanes::transpose_times(J, J);
  }
  const Mat6<double> got = make_mass_matrix(2.0, c, inertia);
  for (int i = 0; i < 36; ++i) EXPECT_NEAR(got.m[i], sum.m[i], 1e-15 * 4);
}

}  // namespace
}  // namespace bough::elements::check
