/// Tangents of all elements against the complex step of their residuals, in the sense of the time step.
#include <gtest/gtest.h>

#include "bough/elements/law_slope.hpp"
#include "elements/check_element.hpp"

namespace bough::elements::check {
namespace {

// Both derivatives are exact; what differs is the order of some hundred roundings of numbers near one.
constexpr double exact = 1e-13;

template <class E>
void expect_tangent(const Sample<E>& s, bool has_inertia, const Slopes& slopes,
                    const CarrierMotion* observer = nullptr) {
  SCOPED_TRACE(s.name);
  Field field = s.field(has_inertia, slopes);
  field.observer = observer;
  const Evaluation got = evaluation_of(s, field);
  EXPECT_LE(relative_error(got.tangent, complex_tangent(s, field)), exact);
  std::vector<double> alone(got.residual.size());
  evaluate(s.element, field, s.multipliers.data(), s.turns, alone.data(), nullptr);
  EXPECT_EQ(got.residual, alone) << "the same bits with and without a tangent";
  const auto around = field.around;
  const ObserverTwist<double> moving = twist_of<double>(observer == nullptr ? CarrierMotion{} : *observer);
  const motion::Vec3Pair anchor = anchor_of(s.element, s.nodes.data());
  EXPECT_LE(relative_error(got.residual,
                           node_residual(s.element, states_of<double>(s.nodes, anchor), anchor.hi, s.multipliers,
                                         around, s.turns, observer == nullptr ? nullptr : &moving)),
            exact);
}

TEST(ElementTangent, is_the_derivative_of_the_static_residual) {
  for_all_elements([](const auto& s) { expect_tangent(s, false, Slopes{}); });
}

TEST(ElementTangent, follows_velocity_and_acceleration_of_the_time_step) {
  for_all_elements([](const auto& s) { expect_tangent(s, true, Slopes{3.1, 7.3, false}); });
}

TEST(ElementTangent, follows_a_time_step_described_in_a_frame_that_drifts_and_falls) {
  for_all_elements([](const auto& s) { expect_tangent(s, true, Slopes{3.1, 7.3, false, 0.0, false, true, false}); });
  for_all_elements([](const auto& s) { expect_tangent(s, true, Slopes{3.1, 7.3, false, 0.0, false, true, true}); });
}

TEST(ElementTangent, of_a_consistent_start_is_the_mass_and_the_rows_gradient) {
  for_all_elements([](const auto& s) { expect_tangent(s, true, Slopes{0.0, 0.0, true}); });
}

// Laws enter residuals linearly: the derivative by one is the change of the residual with 1 more of it.
TEST(ElementTangent, by_a_law_is_the_change_of_the_residual_with_the_law) {
  int found = 0;
  for_all_elements([&found](const auto& s) {
    SCOPED_TRACE(s.name);
    int laws[max_laws];
    for (int k = 0; k < list_laws(s.element, laws); ++k, ++found)
      for (const bool has_inertia : {false, true}) {
        const Field field = s.field(has_inertia, Slopes{3.1, 7.3, false});
        const std::vector<double> before = residual_of(s, field);
        std::vector<double> slope(before.size());
        evaluate_law_slope(s.element, field, s.multipliers.data(), s.turns, laws[k], slope.data());
        auto with_more = s;
        with_more.laws[static_cast<std::size_t>(laws[k])] += 1.0;
        std::vector<double> change = residual_of(with_more, with_more.field(has_inertia, field.slopes));
        for (std::size_t i = 0; i < change.size(); ++i) change[i] -= before[i];
        EXPECT_LE(relative_error(slope, change), exact) << "law " << laws[k];
      }
  });
  EXPECT_GT(found, 30);
}

/// A frame that turns and moves every way it can.
CarrierMotion turning_frame() {
  CarrierMotion m;
  m.twist = Vec6<double>{{0.7, -1.1, 0.4, 1.3, -0.6, 0.9}};
  m.twist_rate = Vec6<double>{{-0.3, 0.8, 0.5, -1.2, 0.2, 0.6}};
  return m;
}

TEST(ElementTangent, in_a_moving_frame_follows_the_nodes_place_in_it) {
  const CarrierMotion frame = turning_frame();
  for_all_elements([&](const auto& s) { expect_tangent(s, true, Slopes{3.1, 7.3, false}, &frame); });
}

TEST(ElementTangent, at_rest_in_a_moving_frame_is_that_of_its_inertial_loads) {
  const CarrierMotion frame = turning_frame();
  for_all_elements([&](auto s) {
    for (NodeMotion& n : s.nodes) n.v = n.a = n.dq = Vec6<double>::zero();
    expect_tangent(s, true, Slopes{}, &frame);
  });
}

TEST(ElementTangent, of_a_consistent_start_in_a_moving_frame_is_the_same_mass) {
  const CarrierMotion frame = turning_frame();
  for_all_elements([&](const auto& s) { expect_tangent(s, true, Slopes{0.0, 0.0, true}, &frame); });
}

std::vector<double> magnitude_of(const Sample<RigidBody>& s, const Field& field, const Evaluation& of) {
  std::vector<double> magnitude(of.residual.size());
  eval_magnitude(s.element, field, of.residual.data(), magnitude.data());
  return magnitude;
}

TEST(ElementTangent, of_a_point_mass_is_that_of_a_body_whose_inertia_is_zero) {
  const CarrierMotion frame = turning_frame();
  for (const bool offset : {false, true})
    for (const bool has_inertia : {false, true})
      for (const CarrierMotion* observer : {static_cast<const CarrierMotion*>(nullptr), &frame}) {
        const Sample<RigidBody> point = point_sample(offset);
        Sample<RigidBody> body = point;
        body.element.is_point = false;
        Field field = point.field(has_inertia, Slopes{3.1, 7.3, false});
        field.observer = observer;
        const Evaluation got = evaluation_of(point, field), want = evaluation_of(body, field);
        EXPECT_LE(relative_error(got.residual, want.residual), exact);
        EXPECT_LE(relative_error(got.tangent, want.tangent), exact);
        EXPECT_LE(relative_error(magnitude_of(point, field, got), magnitude_of(body, field, want)), exact);
      }
}

TEST(ElementTangent, of_statics_ignores_motion) {
  for_all_elements([](auto s) {
    SCOPED_TRACE(s.name);
    const Evaluation moving = evaluation_of(s, s.field(false, Slopes{3.1, 7.3, false}));
    for (NodeMotion& n : s.nodes) n.v = n.a = n.dq = Vec6<double>::zero();
    const Evaluation resting = evaluation_of(s, s.field(false));
    EXPECT_EQ(moving.residual, resting.residual);
    EXPECT_EQ(moving.tangent, resting.tangent);
  });
}

TEST(ElementTangent, of_a_beam_without_mass_and_damping_is_the_static_one) {
  const auto check = [](auto s) {
    const Evaluation dynamic = evaluation_of(s, s.field(true, Slopes{3.1, 7.3, false}));
    const Evaluation statics = evaluation_of(s, s.field(false));
    EXPECT_LE(relative_error(dynamic.tangent, statics.tangent), exact);
  };
  check(beam_sample<2>(Ends::offset, false, false));
  check(beam_sample<3>(Ends::offset, false, false));
  check(beam_sample<4>(Ends::offset, false, false));
}

TEST(ElementTangent, of_inertia_is_the_symmetric_mass_matrix_at_a_consistent_start) {
  for_all_beams([](const auto& s) {
    SCOPED_TRACE(s.name);
    const std::vector<double> mass = evaluation_of(s, s.field(true, Slopes{0.0, 0.0, true})).tangent;
    const auto n = static_cast<std::size_t>(num_unknowns(s.element));
    double asymmetry = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) asymmetry = std::max(asymmetry, std::abs(mass[i * n + j] - mass[j * n + i]));
    EXPECT_LE(asymmetry, exact * largest(mass));
    EXPECT_GT(largest(mass), 0.1);
  });
}

}  // namespace
}  // namespace bough::elements::check
