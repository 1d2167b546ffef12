/// Closed-form tangents of planar beams against the derivatives of their residual carried through its own source, alone and in lanes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "elements/planar_jets.hpp"
#include "elements/samples.hpp"

namespace bough::elements::planar {
namespace {

using check::Numbers;

/// Symmetric positive definite, all entries coupled.
Mat3<double> definite(Numbers& numbers) {
  Mat3<double> a;
  for (double& x : a.m) x = numbers.next(0.5);
  return lanes::transpose_times(a, a) + Mat3<double>::identity();
}
Vec2<double> turned(double angle) { return {{std::cos(angle), std::sin(angle)}}; }

/// What a beam is made of, and where its ports are.
struct Kind {
  bool has_mass, has_damping, has_offsets, on_ground;
};

template <int N>
struct Sample {
  Beam<N> beam;
  Node nodes[N];
};

/// In general position; seed 0 turns no node against another, seed 1 hardly.
template <int N>
Sample<N> sample(const Kind& kind, unsigned seed) {
  Numbers numbers(100 * N + seed);
  Sample<N> s;
  Beam<N>& e = s.beam;
  e.length = 1.0 + numbers.next(0.5);
  e.stiffness = definite(numbers);
  e.damping = kind.has_damping ? definite(numbers) : Mat3<double>::zero();
  e.mass = kind.has_mass ? definite(numbers) : Mat3<double>::zero();
  e.has_mass = kind.has_mass;
  e.has_damping = kind.has_damping;
  for (auto& strain : e.reference_strain) strain = numbers.vec3();
  const double angle = seed == 0 ? 0.0 : seed == 1 ? 1e-7 : 2.4 / N;
  for (int k = 0; k < N; ++k) {
    e.ports[k].node = k;
    const double about = angle * (k + numbers.next(0.4));
    s.nodes[k] = {turned(about),
                  {{{0.7 * k + numbers.next(0.2), numbers.next(0.5)}}, {{numbers.next(1e-17), numbers.next(1e-17)}}},
                  numbers.vec3(),
                  numbers.vec3(),
                  numbers.vec3(seed == 0 ? 0.0 : 1.5)};
    if (kind.has_offsets && k != 1)
      e.ports[k] = {k, true, turned(angle == 0.0 ? 0.0 : numbers.next(0.3)), {{numbers.next(), numbers.next()}}};
  }
  if (kind.on_ground) e.ports[N - 1] = {ground, false, turned(angle * N), {{0.7 * N, numbers.next()}}};
  return s;
}

struct Result {
  std::vector<double> residual, magnitude, tangent;
};
template <int N>
Result evaluated(const Sample<N>& s, const Field& field) {
  const auto n = static_cast<std::size_t>(num_unknowns(s.beam));
  Result r{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n * n)};
  evaluate(s.beam, field, nullptr, 0.0, r.residual.data(), r.magnitude.data(), r.tangent.data());
  return r;
}
Surroundings<double> surroundings(bool has_inertia) { return {{{1.5, -9.81}}, nullptr, has_inertia}; }

/// All kinds of beams, in statics, in a time step and at a consistent start.
template <class Visit>
void visit_cases(const Visit& visit) {
  const Slopes step{1.7, 2.9, false}, start{0.0, 0.0, true};
  for (const bool has_mass : {false, true})
    for (const bool has_damping : {false, true})
      for (const bool has_offsets : {false, true})
        for (const bool on_ground : {false, true}) {
          const Kind kind{has_mass, has_damping, has_offsets, on_ground};
          SCOPED_TRACE(testing::Message() << "mass " << has_mass << ", damping " << has_damping << ", offsets "
                                          << has_offsets << ", on the ground " << on_ground);
          visit(kind, false, Slopes{});
          visit(kind, true, step);
          visit(kind, true, start);
          visit(kind, false, start);
        }
}

template <int N>
void compare_with_jets() {
  visit_cases([](const Kind& kind, bool has_inertia, const Slopes& slopes) {
    for (unsigned seed = 0; seed < 6; ++seed) {
      const Sample<N> s = sample<N>(kind, seed);
      const Field field{s.nodes, surroundings(has_inertia), slopes};
      const Result r = evaluated(s, field);
      std::vector<double> expected(r.tangent.size());
      check::eval_tangent_on_jets(s.beam, field, expected.data());
      double most = 0.0, off = 0.0;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        most = std::max(most, std::abs(expected[i]));
        off = std::max(off, std::abs(expected[i] - r.tangent[i]));
      }
      EXPECT_LE(off, 2e-14 * most) << N << " nodes, seed " << seed << ", start " << slopes.mass_only;
      std::vector<double> alone(r.residual.size()), magnitude(r.residual.size());
      evaluate(s.beam, field, nullptr, 0.0, alone.data(), magnitude.data(), nullptr);
      EXPECT_EQ(alone, r.residual) << "the same bits with and without a tangent";
    }
  });
}

TEST(PlanarBeams, have_the_tangent_of_their_residual) {
  compare_with_jets<2>();
  compare_with_jets<3>();
  compare_with_jets<4>();
}

template <int N>
void compare_lanes() {
  visit_cases([](const Kind& kind, bool has_inertia, const Slopes& slopes) {
    std::vector<Sample<N>> samples;
    for (unsigned seed = 0; seed < num_lanes; ++seed) samples.push_back(sample<N>(kind, seed));
    const Beam<N>* beams[num_lanes];
    int places[N];
    NodeLanes nodes[N];
    for (int k = 0; k < N; ++k) places[k] = k;
    for (int l = 0; l < num_lanes; ++l) {
      const Sample<N>& s = samples[static_cast<std::size_t>(l)];
      beams[l] = &s.beam;
      for (int k = 0; k < N; ++k)
        for (int i = 0; i < numbers_of_node; ++i)
          reinterpret_cast<LanePack*>(&nodes[k])[i].set(l, reinterpret_cast<const double*>(&s.nodes[k])[i]);
    }
    ASSERT_TRUE(may_share_lanes(*beams[0], *beams[1]));
    const LaneElement<Beam<N>> e = make_lane_element(beams, num_lanes, places, 0);
    const auto n = static_cast<std::size_t>(num_unknowns(*beams[0]));
    const FieldLanes field{nodes, {{{1.5, -9.81}}, nullptr, has_inertia}, slopes};
    std::vector<LanePack> residual(n), magnitude(n), tangent(n * n), alone(n);
    evaluate_lanes<LaneElement<Beam<N>>>(e, field, nullptr, LanePack(0.0), residual.data(), magnitude.data(),
                                         tangent.data());
    evaluate_lanes<LaneElement<Beam<N>>>(e, field, nullptr, LanePack(0.0), alone.data(), nullptr, nullptr);
    for (int l = 0; l < num_lanes; ++l) {
      const Sample<N>& s = samples[static_cast<std::size_t>(l)];
      const Result r = evaluated(s, {s.nodes, surroundings(has_inertia), slopes});
      for (std::size_t i = 0; i < n; ++i) {
        EXPECT_EQ(residual[i][l], r.residual[i]);
        EXPECT_EQ(alone[i][l], r.residual[i]);
        EXPECT_EQ(magnitude[i][l], r.magnitude[i]);
      }
      for (std::size_t i = 0; i < n * n; ++i) EXPECT_EQ(tangent[i][l], r.tangent[i]) << "lane " << l << ", " << i;
    }
  });
}

TEST(PlanarBeams, in_lanes_have_the_bits_of_the_beam_alone) {
  compare_lanes<2>();
  compare_lanes<3>();
  compare_lanes<4>();
}

}  // namespace
}  // namespace bough::elements::planar
