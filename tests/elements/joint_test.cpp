/// Constraint rows: gradients, forces, series in time, counted angles, reactions; and rates of all residuals.
#include <gtest/gtest.h>

#include "elements/check_element.hpp"

namespace bough::elements::check {
namespace {

constexpr double exact = 1e-13;
constexpr double pi = 3.14159265358979323846;

std::vector<ConstraintRow> all_rows() {
  std::vector<ConstraintRow> rows = {row_of(RowKind::angle), row_of(RowKind::angle, 0, 0, 1),
                                     row_of(RowKind::screw, 0, 0, -1, 0.3), row_of(RowKind::screw, 0, 0, 2, -0.7)};
  for (int i = 0; i < 3; ++i) {
    rows.push_back(row_of(RowKind::along, i));
    rows.push_back(row_of(RowKind::along, i, 0, 0));
    for (int j = 0; j < 3; ++j) rows.push_back(row_of(RowKind::across, i, j));
  }
  return rows;
}

TEST(ConstraintRow, gradient_is_the_derivative_along_the_increment_of_the_second_frame) {
  Numbers numbers(1);
  const Complex laws[3] = {0.2, -0.3, 0.5};
  for (const ConstraintRow& row : all_rows())
    for (int sample = 0; sample < 5; ++sample) {
      const Frame<double> H = numbers.frame(1.0, 1.2);
      Vec6<double> gradient;
      const double real_laws[3] = {0.2, -0.3, 0.5};
      eval_row(row, H, 0.4, real_laws, gradient);
      for (int k = 0; k < 6; ++k) {
        const Vec6<Complex> zeta = Complex(0.0, complex_step) * Vec6<Complex>::unit(k);
        Vec6<Complex> unused;
        const Complex phi =
            eval_row(row, motion::compose(motion::cast<Complex>(H), motion::exp_se3(zeta)), 0.4, laws, unused);
        EXPECT_NEAR(gradient[k], phi.imag() / complex_step, exact) << "row kind " << static_cast<int>(row.kind);
      }
    }
}

TEST(ConstraintRow, forces_are_the_transposed_gradient_times_the_multipliers) {
  for (const Sample<Joint>& s : joint_samples()) {
    if (s.element.num_efforts > 0) continue;
    SCOPED_TRACE(s.name);
    const Evaluation e = evaluation_of(s, s.field(false));
    const std::size_t m = s.multipliers.size(), n = e.residual.size();
    std::vector<double> forces(e.residual.begin(), e.residual.end() - static_cast<std::ptrdiff_t>(m));
    std::vector<double> expected(n - m, 0.0);
    for (std::size_t i = 0; i < n - m; ++i)
      for (std::size_t k = 0; k < m; ++k) expected[i] += e.tangent[(n - m + k) * n + i] * s.multipliers[k];
    EXPECT_LE(relative_error(forces, expected), exact);
  }
}

TEST(ConstraintRow, is_met_by_the_joint_motion_that_it_leaves_free) {
  const double theta = 0.8, slide = 0.3, pitch = 0.25;
  const Mat3<double> R = motion::exp_so3(Vec3<double>{{0.0, 0.0, theta}});
  Vec6<double> gradient;
  const Frame<double> turned{R, Vec3<double>::zero()}, screwed{R, Vec3<double>{{0.0, 0.0, pitch * theta}}},
      slid{Mat3<double>::identity(), Vec3<double>{{0.0, 0.0, slide}}};
  const double none[1] = {0.0}, at[1] = {theta}, out[1] = {slide};
  for (const int i : {0, 1}) {
    EXPECT_NEAR(eval_row(row_of(RowKind::across, i, 2), turned, 0.0, none, gradient), 0.0, 1e-16);
    EXPECT_NEAR(eval_row(row_of(RowKind::along, i), slid, 0.0, none, gradient), 0.0, 1e-16);
  }
  EXPECT_NEAR(eval_row(row_of(RowKind::angle, 0, 0, 0), turned, 0.0, at, gradient), 0.0, 1e-15);
  EXPECT_NEAR(eval_row(row_of(RowKind::along, 2, 0, 0), slid, 0.0, out, gradient), 0.0, 1e-16);
  EXPECT_NEAR(eval_row(row_of(RowKind::screw, 0, 0, -1, pitch), screwed, 0.0, none, gradient), 0.0, 1e-15);
}

TEST(ConstraintRow, angle_counts_turns_both_ways) {
  for (const double direction : {1.0, -1.0}) {
    double turns = 0.0;
    for (int step = 0; step <= 400; ++step) {
      const double theta = direction * 0.1 * step;  // more than six turns
      const double seen = motion::eval_angle(motion::exp_so3(Vec3<double>{{0.0, 0.0, theta}}), turns);
      ASSERT_NEAR(seen, theta, 1e-14 * (1.0 + std::abs(theta)));
      turns = seen;
    }
    EXPECT_GT(std::abs(turns), 6.0 * 2.0 * pi);
  }
}

TEST(ConstraintRow, angle_is_smooth_where_an_angle_within_half_a_turn_jumps) {
  for (const double turns : {pi, -pi, 3.0 * pi, 7.0}) {
    const double before = motion::eval_angle(motion::exp_so3(Vec3<double>{{0.0, 0.0, turns - 1e-3}}), turns);
    const double after = motion::eval_angle(motion::exp_so3(Vec3<double>{{0.0, 0.0, turns + 1e-3}}), turns);
    EXPECT_NEAR(after - before, 2e-3, 1e-13);
  }
}

/// The joint's nodes on the curves H exp(q(t)), q a cubic: twist, acceleration and jerk from T(q) q' in time series,
/// and the rows on the same curves, which never pass through the recursion under test.
struct Curves {
  std::vector<NodeMotion> nodes;
  std::vector<Vec6<double>> jerk;
  std::vector<NodeState<Taylor3>> states;
};
Curves make_curves(const std::vector<NodeMotion>& start, const motion::Vec3Pair& anchor, Numbers& numbers) {
  Curves r;
  r.nodes = start;
  for (NodeMotion& n : r.nodes) {
    Vec6<Taylor3> q, slope;
    for (int i = 0; i < 6; ++i) {
      q[i] = Taylor3(0.0);
      slope[i] = Taylor3(0.0);
      for (int k = 1; k <= 3; ++k) {
        q[i].c[k] = numbers.next();
        slope[i].c[k - 1] = k * q[i].c[k];
      }
    }
    const Vec6<Taylor3> twist = motion::tangent_times(q, slope);
    Vec6<double> jerk;
    for (int i = 0; i < 6; ++i) {
      n.v[i] = twist[i].c[0];
      n.a[i] = twist[i].c[1];
      jerk[i] = 2.0 * twist[i].c[2];
    }
    r.jerk.push_back(jerk);
    const Frame<double> H{n.R, motion::difference(n.x, anchor)};
    r.states.push_back({motion::compose(motion::cast<Taylor3>(H), motion::exp_se3(q)), twist, twist});
  }
  return r;
}

TEST(ConstraintRow, series_in_time_follows_twist_acceleration_and_jerk) {
  Numbers numbers(2);
  for (const Sample<Joint>& s : joint_samples()) {
    if (s.element.num_rows == 0) continue;
    SCOPED_TRACE(s.name);
    const motion::Vec3Pair anchor = anchor_of(s.element, s.nodes.data());
    const Curves curves = make_curves(s.nodes, anchor, numbers);
    std::vector<Taylor3> laws(3);
    for (Taylor3& law : laws)
      for (double& c : law.c) c = numbers.next();
    Field field = s.field(true);
    field.nodes = curves.nodes.data();
    Taylor3 got[max_rows];
    evaluate_constraint_series(s.element, field, curves.jerk.data(), laws.data(), s.turns, got);

    const auto p = ports_of(s.element, curves.states, anchor.hi);
    const Frame<Taylor3> H = motion::relative(p[0].H, p[1].H);
    for (int k = 0; k < s.element.num_rows; ++k) {
      Vec6<Taylor3> gradient;
      const Taylor3 expected = eval_row(s.element.rows[k], H, s.turns, laws.data(), gradient);
      for (int order = 0; order <= 3; ++order)
        EXPECT_NEAR(got[k].c[order], expected.c[order], 1e-12) << "row " << k << ", order " << order;
    }
  }
}

TEST(ConstraintRow, first_rate_of_the_series_is_the_gradient_times_the_twists) {
  for (const Sample<Joint>& s : joint_samples()) {
    if (s.element.num_rows == 0) continue;
    SCOPED_TRACE(s.name);
    const Evaluation e = evaluation_of(s, s.field(true));
    const std::vector<Taylor3> laws(3, Taylor3(0.0));
    Taylor3 got[max_rows];
    evaluate_constraint_series(s.element, s.field(true), nullptr, laws.data(), s.turns, got);
    const std::size_t m = s.multipliers.size(), n = e.residual.size();
    for (std::size_t k = 0; k < m; ++k) {
      double rate = 0.0;
      for (std::size_t i = 0; i < n - m; ++i)
        rate += e.tangent[(n - m + k) * n + i] * s.nodes[i / 6].v[static_cast<int>(i % 6)];
      EXPECT_NEAR(got[k].c[1], rate, exact * 10.0);
    }
  }
}

TEST(JointMotion, coordinates_and_their_rates_are_those_of_the_relative_motion) {
  for (const Sample<Joint>& s : joint_samples()) {
    const motion::Vec3Pair anchor = anchor_of(s.element, s.nodes.data());
    std::vector<NodeState<Complex>> states = states_of<Complex>(s.nodes, anchor);
    for (NodeState<Complex>& n : states)
      n.H = motion::compose(n.H, motion::exp_se3(Vec6<Complex>(Complex(0.0, complex_step) * n.v)));
    const auto p = ports_of(s.element, states, anchor.hi);
    const Frame<Complex> H = motion::relative(p[0].H, p[1].H);
    const CoordinateMotion angle = eval_joint_coordinate(s.element, RowKind::angle, s.field(true), s.turns);
    const CoordinateMotion slide = eval_joint_coordinate(s.element, RowKind::along, s.field(true), s.turns);
    EXPECT_NEAR(angle.value, motion::eval_angle(H.R, s.turns).real(), exact);
    EXPECT_NEAR(angle.rate, motion::eval_angle(H.R, s.turns).imag() / complex_step, exact);
    EXPECT_NEAR(slide.value, H.x[2].real(), exact * 10.0);
    EXPECT_NEAR(slide.rate, H.x[2].imag() / complex_step, exact * 10.0);
  }
}

TEST(JointMotion, reaction_of_a_hinge_carries_the_weight_of_the_second_body) {
  // A body of 3 kg, its centre 0.5 m along the horizontal axis 1 of a hinge about axis 3 (horizontal too): all at rest.
  Sample<Joint> s = joint_sample("clamp", {}, false, Ends::grounded);
  s.element.ports[0].offset = Frame<double>::identity();
  s.element.ports[1] = port_at(0);
  s.nodes = {{Mat3<double>::identity(), {}, Vec6<double>::zero(), Vec6<double>::zero(), Vec6<double>::zero()}};
  s.element.rows[0] = row_of(RowKind::along, 1);
  s.element.rows[1] = row_of(RowKind::angle);
  s.element.num_rows = 2;
  s.turns = 0.0;
  Sample<RigidBody> body;
  body.element.ports[0] = port_at(0);
  body.element.mass = make_mass_matrix(3.0, Vec3<double>{{0.5, 0.0, 0.0}}, Mat3<double>::identity());
  body.nodes = s.nodes;
  Field field = s.field(false);
  field.around.gravity = Vec3<double>{{0.0, -10.0, 0.0}};
  std::vector<double> weight(6), both(8);
  evaluate(body.element, field, nullptr, 0.0, weight.data(), nullptr);
  EXPECT_NEAR(weight[1], 30.0, 1e-14);
  EXPECT_NEAR(weight[5], 15.0, 1e-14);
  // Multipliers that hold it: along row takes the force, the angle's row the moment.
  s.multipliers = {-30.0, -15.0};
  evaluate(s.element, field, s.multipliers.data(), 0.0, both.data(), nullptr);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(both[i] + weight[i], 0.0, 1e-14);
  const Vec6<double> reaction = eval_reaction(s.element, field, s.multipliers.data(), 0.0);
  EXPECT_NEAR(reaction[1], 30.0, 1e-14);  // upwards
  EXPECT_NEAR(reaction[5], 15.0, 1e-14);  // against the moment of the weight
}

/// Residual rates of all elements along the motion, accelerations held.
template <class E>
void expect_rate(const Sample<E>& s, const CarrierMotion* observer = nullptr) {
  SCOPED_TRACE(s.name);
  const E& e = s.element;
  Field field = s.field(true);
  field.observer = observer;
  std::vector<Taylor1> laws;
  std::vector<Complex> complex_laws;
  for (std::size_t k = 0; k < s.laws.size(); ++k) {
    laws.push_back(Taylor1(s.laws[k]));
    laws[k].c[1] = s.law_rates[k];
    complex_laws.emplace_back(s.laws[k], complex_step * s.law_rates[k]);
  }
  const auto n = static_cast<std::size_t>(num_unknowns(e));
  std::vector<double> got(n), expected;
  evaluate_rate(e, field, {lanes::cast<Taylor1>(field.around.gravity), laws.data(), true}, s.multipliers.data(),
                s.turns, nullptr, got.data());
  const motion::Vec3Pair anchor = anchor_of(e, s.nodes.data());
  std::vector<NodeState<Complex>> states = states_of<Complex>(s.nodes, anchor);
  for (NodeState<Complex>& node : states) {
    node.H = motion::compose(node.H, motion::exp_se3(Vec6<Complex>(Complex(0.0, complex_step) * node.v)));
    node.v += Complex(0.0, complex_step) * node.a;
  }
  const Surroundings<Complex> around{lanes::cast<Complex>(field.around.gravity), complex_laws.data(), true};
  ObserverTwist<Complex> moving = twist_of<Complex>(observer == nullptr ? CarrierMotion{} : *observer);
  if (observer != nullptr)
    for (int i = 0; i < 6; ++i) {
      moving.twist[i] += Complex(0.0, complex_step * observer->twist_rate[i]);
      moving.twist_rate[i] += Complex(0.0, complex_step * observer->twist_second[i]);
    }
  for (const Complex& r : node_residual(e, states, anchor.hi, complex_of(s.multipliers), around, s.turns,
                                        observer == nullptr ? nullptr : &moving))
    expected.push_back(r.imag() / complex_step);
  EXPECT_LE(relative_error(got, expected), exact * 10.0);
}

TEST(ElementRate, is_the_derivative_of_the_residual_in_time_with_accelerations_held) {
  for_all_elements([](const auto& s) { expect_rate(s); });
}

TEST(ElementRate, in_a_moving_frame_goes_with_its_motion) {
  CarrierMotion frame;
  frame.twist = Vec6<double>{{0.7, -1.1, 0.4, 1.3, -0.6, 0.9}};
  frame.twist_rate = Vec6<double>{{-0.3, 0.8, 0.5, -1.2, 0.2, 0.6}};
  frame.twist_second = Vec6<double>{{0.9, 0.1, -0.7, 0.4, 1.1, -0.5}};
  for_all_elements([&](const auto& s) { expect_rate(s, &frame); });
}

}  // namespace
}  // namespace bough::elements::check
