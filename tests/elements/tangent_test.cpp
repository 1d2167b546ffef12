/// Tangents of all elements against the complex step of their residuals, in the sense of the time step.
#include <gtest/gtest.h>

#include "elements/check_element.hpp"

namespace bough::elements::check {
namespace {

// Both derivatives are exact; what differs is the order of some hundred roundings of numbers near one.
constexpr double exact = 1e-13;

template <class E>
void expect_tangent(const Sample<E>& s, bool has_inertia, const Slopes& slopes) {
  SCOPED_TRACE(s.name);
  const Field field = s.field(has_inertia, slopes);
  const Evaluation got = evaluation_of(s, field);
  EXPECT_LE(relative_error(got.tangent, complex_tangent(s, field)), exact);
  EXPECT_EQ(got.residual, residual_of(s, field)) << "the same bits with and without a tangent";
  const auto around = field.around;
  const motion::Vec3Pair anchor = anchor_of(s.element, s.nodes.data());
  EXPECT_LE(relative_error(got.residual, node_residual(s.element, states_of<double>(s.nodes, anchor), anchor.hi,
                                                       s.multipliers, around, s.turns)),
            exact);
}

TEST(ElementTangent, is_the_derivative_of_the_static_residual) {
  for_all_elements([](const auto& s) { expect_tangent(s, false, Slopes{}); });
}

TEST(ElementTangent, follows_velocity_and_acceleration_of_the_time_step) {
  for_all_elements([](const auto& s) { expect_tangent(s, true, Slopes{3.1, 7.3, false}); });
}

TEST(ElementTangent, of_a_consistent_start_is_the_mass_and_the_rows_gradient) {
  for_all_elements([](const auto& s) { expect_tangent(s, true, Slopes{0.0, 0.0, true}); });
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
