/// Elements in a plane: closed-form tangents against the derivatives of their residual carried through its own
/// source, alone and in lanes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bough/elements/law_slope.hpp"
#include "elements/jets.hpp"
#include "elements/samples.hpp"

namespace bough::elements::in_plane {
namespace {

using check::Numbers;
using motion::Vec2;

/// Symmetric positive definite, all entries coupled.
Mat3<double> definite(Numbers& numbers) {
  Mat3<double> a;
  for (double& x : a.m) x = numbers.next(0.5);
  return lanes::transpose_times(a, a) + Mat3<double>::identity();
}
Vec2<double> turned(double angle) { return {{std::cos(angle), std::sin(angle)}}; }

/// What an element is made of, and where its ports are.
struct Kind {
  bool has_mass, has_damping, has_offsets, on_ground;
};

constexpr double law_values[2] = {0.7, -1.3}, multiplier_values[max_rows] = {0.4, -0.8, 1.1, 0.3, -0.6, 0.9};
constexpr double turns = 6.5;

template <class E>
struct Sample {
  E element;
  Node nodes[E::num_ports];
};

/// Nodes and ports in general position; seed 0 turns no node against another, seed 1 hardly.
template <class E>
void place(Sample<E>& s, const Kind& kind, unsigned seed, Numbers& numbers) {
  constexpr int P = E::num_ports;
  const double angle = seed == 0 ? 0.0 : seed == 1 ? 1e-7 : 2.4 / P;
  for (int k = 0; k < P; ++k) {
    s.element.ports[k].node = k;
    const double about = angle * (k + numbers.next(0.4));
    s.nodes[k] = {turned(about),
                  {{{0.7 * k + numbers.next(0.2), numbers.next(0.5)}}, {{numbers.next(1e-17), numbers.next(1e-17)}}},
                  numbers.vec3(),
                  numbers.vec3(),
                  numbers.vec3(seed == 0 ? 0.0 : 1.5),
                  {{0.6, -1.1}}};
    if (kind.has_offsets && k != 1)
      s.element.ports[k] = {
          k, true, {turned(angle == 0.0 ? 0.0 : numbers.next(0.3)), {{numbers.next(), numbers.next()}}}};
  }
  if (kind.on_ground && P > 1)
    s.element.ports[P - 1] = {ground, false, {turned(angle * P), {{0.7 * P, numbers.next()}}}};
}

template <int N>
void make(Beam<N>& e, const Kind& kind, Numbers& numbers) {
  e.length = 1.0 + numbers.next(0.5);
  e.stiffness = definite(numbers);
  e.damping = kind.has_damping ? definite(numbers) : Mat3<double>::zero();
  e.mass = kind.has_mass ? definite(numbers) : Mat3<double>::zero();
  e.has_mass = kind.has_mass;
  e.has_damping = kind.has_damping;
  for (auto& strain : e.reference_strain) strain = numbers.vec3();
}
template <int N>
void make(LineLoad<N>& e, const Kind& kind, Numbers& numbers) {
  e.length = 1.0 + numbers.next(0.5);
  e.wrench = numbers.vec3();
  e.follows = kind.has_mass;
  e.law = 1;
}
void make(RigidBody& e, const Kind& kind, Numbers& numbers) {
  e.mass = definite(numbers);
  e.is_point = !kind.has_mass;
}
void make(PointLoad& e, const Kind& kind, Numbers& numbers) {
  e.wrench = numbers.vec3();
  e.follows = kind.has_mass;
  e.law = 1;
}
void make(Spring& e, const Kind& kind, Numbers& numbers) {
  e.stiffness = 1.7;
  e.rest_length = 0.4 + numbers.next(0.2);
  e.damping = kind.has_damping ? 0.6 : 0.0;
}
void make(Bushing& e, const Kind& kind, Numbers& numbers) {
  e.stiffness = definite(numbers);
  e.damping = kind.has_damping ? definite(numbers) : Mat3<double>::zero();
  e.has_damping = kind.has_damping;
  e.rest = numbers.vec3();
  e.factor = kind.has_mass ? 1 : -1;
}
/// Rows of every kind that a plane has, efforts along a displacement and about the normal.
void make(Joint& e, const Kind& kind, Numbers& numbers) {
  const RowKind kinds[] = {RowKind::along, RowKind::across, RowKind::angle, RowKind::distance};
  for (const RowKind row : kinds) {
    ConstraintRowOn<Se2, double>& r = e.rows[e.num_rows++];
    r.kind = row;
    r.d = turned(numbers.next(3.0));
    if (row == RowKind::angle) r.d = {{-1.0, 0.0}};
    r.law = row == RowKind::across ? -1 : 1;
    r.constant = row == RowKind::distance ? 0.7 : 0.0;
  }
  if (!kind.has_mass && !kind.has_damping) return;
  const double damping = kind.has_damping ? 0.8 : 0.0;
  e.efforts[e.num_efforts++] = {RowKind::angle, 1.3, 0.2, damping, 0, {{{-1.0, 0.0}}}};
  e.efforts[e.num_efforts++] = {RowKind::along, 0.9, -0.3, damping, -1, {turned(0.4)}};
}

template <class E>
Sample<E> sample(const Kind& kind, unsigned seed) {
  Numbers numbers(100 * E::num_ports + seed);
  Sample<E> s;
  make(s.element, kind, numbers);
  place(s, kind, seed, numbers);
  return s;
}

struct Result {
  std::vector<double> residual, magnitude, tangent;
};
template <class E>
Result evaluated(const Sample<E>& s, const Field& field) {
  const auto n = static_cast<std::size_t>(num_unknowns(s.element));
  Result r{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n * n)};
  evaluate(s.element, field, multiplier_values, turns, r.residual.data(), r.tangent.data());
  eval_magnitude(s.element, field, r.residual.data(), r.magnitude.data());
  return r;
}
SurroundingsOn<Se2, double> surroundings(bool has_inertia) { return {{{1.5, -9.81}}, law_values, has_inertia}; }

/// All kinds, in statics, in a time step and at a consistent start.
template <class Visit>
void visit_cases(const Visit& visit) {
  const Slopes step{1.7, 2.9, false}, drifting{1.7, 2.9, false, 0.0, false, true, false},
      falling{1.7, 2.9, false, 0.0, false, true, true}, start{0.0, 0.0, true};
  for (const bool has_mass : {false, true})
    for (const bool has_damping : {false, true})
      for (const bool has_offsets : {false, true})
        for (const bool on_ground : {false, true}) {
          const Kind kind{has_mass, has_damping, has_offsets, on_ground};
          SCOPED_TRACE(testing::Message() << "mass " << has_mass << ", damping " << has_damping << ", offsets "
                                          << has_offsets << ", on the ground " << on_ground);
          visit(kind, false, Slopes{});
          visit(kind, true, step);
          visit(kind, true, drifting);
          visit(kind, true, falling);
          visit(kind, true, start);
          visit(kind, false, start);
        }
}

template <class E>
void compare_with_jets(const char* name) {
  SCOPED_TRACE(name);
  visit_cases([](const Kind& kind, bool has_inertia, const Slopes& slopes) {
    for (unsigned seed = 0; seed < 6; ++seed) {
      const Sample<E> s = sample<E>(kind, seed);
      const Field field{s.nodes, surroundings(has_inertia), slopes};
      const Result r = evaluated(s, field);
      const check::JetResult expected = check::evaluate_on_jets(s.element, field, multiplier_values, turns);
      double most = 0.0, off = 0.0, largest = 0.0, away = 0.0;
      for (std::size_t i = 0; i < r.tangent.size(); ++i) {
        most = std::max(most, std::abs(expected.tangent[i]));
        off = std::max(off, std::abs(expected.tangent[i] - r.tangent[i]));
      }
      for (std::size_t i = 0; i < r.residual.size(); ++i) {
        largest = std::max(largest, std::abs(expected.residual[i]));
        away = std::max(away, std::abs(expected.residual[i] - r.residual[i]));
      }
      EXPECT_LE(off, 2e-14 * most) << "seed " << seed << ", start " << slopes.mass_only;
      EXPECT_LE(away, 2e-14 * largest) << "seed " << seed << ", start " << slopes.mass_only;
      std::vector<double> alone(r.residual.size());
      evaluate(s.element, field, multiplier_values, turns, alone.data(), nullptr);
      EXPECT_EQ(alone, r.residual) << "the same bits with and without a tangent";
    }
  });
}

TEST(PlanarElements, have_the_tangent_of_their_residual) {
  compare_with_jets<Beam<2>>("beam of two nodes");
  compare_with_jets<Beam<3>>("beam of three nodes");
  compare_with_jets<Beam<4>>("beam of four nodes");
  compare_with_jets<LineLoad<2>>("line load on two nodes");
  compare_with_jets<LineLoad<3>>("line load on three nodes");
  compare_with_jets<LineLoad<4>>("line load on four nodes");
  compare_with_jets<RigidBody>("body");
  compare_with_jets<PointLoad>("point load");
  compare_with_jets<Spring>("spring");
  compare_with_jets<Bushing>("bushing");
  compare_with_jets<Joint>("joint");
}

/// Laws enter residuals linearly: the derivative by one is the change of the residual with 1 more of it.
template <class E>
void compare_law_slopes() {
  visit_cases([](const Kind& kind, bool has_inertia, const Slopes& slopes) {
    const Sample<E> s = sample<E>(kind, 3);
    int laws[max_laws];
    for (int k = 0; k < list_laws(s.element, laws); ++k) {
      double values[2] = {law_values[0], law_values[1]};
      Field field{s.nodes, surroundings(has_inertia), slopes};
      field.around.laws = values;
      std::vector<double> slope(static_cast<std::size_t>(num_unknowns(s.element)));
      evaluate_law_slope(s.element, field, multiplier_values, turns, laws[k], slope.data());
      const Result before = evaluated(s, field);
      values[laws[k]] += 1.0;
      const Result after = evaluated(s, field);
      for (std::size_t i = 0; i < slope.size(); ++i)
        EXPECT_NEAR(slope[i], after.residual[i] - before.residual[i], 1e-13) << "law " << laws[k] << ", entry " << i;
    }
  });
}

TEST(PlanarElements, change_with_a_law_as_the_law_slope_says) {
  compare_law_slopes<PointLoad>();
  compare_law_slopes<LineLoad<2>>();
  compare_law_slopes<Bushing>();
  compare_law_slopes<Joint>();
}

template <class E>
void compare_lanes(const char* name) {
  SCOPED_TRACE(name);
  visit_cases([](const Kind& kind, bool has_inertia, const Slopes& slopes) {
    constexpr int P = E::num_ports;
    std::vector<Sample<E>> samples;
    for (unsigned seed = 0; seed < num_lanes; ++seed) samples.push_back(sample<E>(kind, seed));
    const E* elements[num_lanes];
    int places[P];
    NodeLanes nodes[P];
    for (int k = 0; k < P; ++k) places[k] = k;
    for (int l = 0; l < num_lanes; ++l) {
      const Sample<E>& s = samples[static_cast<std::size_t>(l)];
      elements[l] = &s.element;
      for (int k = 0; k < P; ++k)
        for (int i = 0; i < numbers_of_node<Se2>; ++i)
          reinterpret_cast<LanePack*>(&nodes[k])[i].set(l, reinterpret_cast<const double*>(&s.nodes[k])[i]);
    }
    ASSERT_TRUE(may_share_lanes(*elements[0], *elements[1]));
    const LaneElement<E> e = make_lane_element(elements, num_lanes, places, 0);
    int laws[max_laws];
    const int num_laws = list_laws(*elements[0], laws);
    LanePack law_lanes[max_laws], multipliers[max_rows];
    for (int k = 0; k < num_laws; ++k) law_lanes[k] = LanePack(law_values[laws[k]]);
    for (int k = 0; k < max_rows; ++k) multipliers[k] = LanePack(multiplier_values[k]);
    const auto n = static_cast<std::size_t>(num_unknowns(*elements[0]));
    const FieldLanes field{nodes, {{{1.5, -9.81}}, law_lanes, has_inertia}, slopes};
    std::vector<LanePack> residual(n), magnitude(n), tangent(n * n), alone(n);
    evaluate_lanes(e, field, multipliers, LanePack(turns), residual.data(), magnitude.data(), tangent.data());
    evaluate_lanes(e, field, multipliers, LanePack(turns), alone.data(), nullptr, nullptr);
    for (int l = 0; l < num_lanes; ++l) {
      const Sample<E>& s = samples[static_cast<std::size_t>(l)];
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

TEST(PlanarElements, in_lanes_have_the_bits_of_the_element_alone) {
  compare_lanes<Beam<2>>("beam of two nodes");
  compare_lanes<Beam<3>>("beam of three nodes");
  compare_lanes<Beam<4>>("beam of four nodes");
  compare_lanes<LineLoad<2>>("line load on two nodes");
  compare_lanes<LineLoad<3>>("line load on three nodes");
  compare_lanes<LineLoad<4>>("line load on four nodes");
  compare_lanes<RigidBody>("body");
  compare_lanes<PointLoad>("point load");
  compare_lanes<Spring>("spring");
  compare_lanes<Bushing>("bushing");
  compare_lanes<Joint>("joint");
}

}  // namespace
}  // namespace bough::elements::in_plane
