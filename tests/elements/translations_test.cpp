/// Elements on translations alone, R^3 and R^1: against the elements in space at nodes without rotation, against their
/// own source run on jets, against the derivative of their energy, and in lanes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bough/elements/momentum.hpp"
#include "elements/jets.hpp"
#include "elements/samples.hpp"

namespace bough::elements {
namespace {

using check::Numbers;
template <int N>
using Group = motion::Translations<N>;

constexpr double law_values[2] = {0.7, -1.3}, law_rates[2] = {0.4, 0.9};
constexpr double multiplier_values[max_rows] = {0.4, -0.8, 1.1, 0.3, -0.6, 0.9};
constexpr double bound = 1e-14;

struct Kind {
  bool has_damping, has_offsets, on_ground;
};

/// The same element on the group and in space, at nodes that do not turn.
template <template <class, class> class E, int N>
struct Twins {
  using G = Group<N>;
  E<G, double> element;
  E<motion::Se3, double> in_space;
  NodeMotionOn<G, double> nodes[2];
  NodeMotion space_nodes[2];

  FieldOn<G, double> field(bool has_inertia, const Slopes& slopes) const {
    SurroundingsOn<G, double> around{{}, law_values, has_inertia};
    for (int i = 0; i < N; ++i) around.gravity[i] = gravity[i];
    return {nodes, around, slopes};
  }
  Field space_field(bool has_inertia, const Slopes& slopes) const {
    Vec3<double> g = Vec3<double>::zero();
    for (int i = 0; i < N; ++i) g[i] = gravity[i];
    return {space_nodes, {g, law_values, has_inertia}, slopes};
  }
  static constexpr double gravity[3] = {1.5, -9.81, 0.7};
};

template <int N>
Vec6<double> six(const Vec<double, N>& v) {
  Vec6<double> r = Vec6<double>::zero();
  for (int i = 0; i < N; ++i) r[i] = v[i];
  return r;
}
template <int N>
Vec<double, N> any(Numbers& numbers, double size = 1.0) {
  Vec<double, N> v;
  for (int i = 0; i < N; ++i) v[i] = numbers.next(size);
  return v;
}

template <class T, int N>
void make(RigidBodyOn<Group<N>>& e, T& space, const Kind&, Numbers& numbers) {
  const double mass = 1.5 + numbers.next();
  e.mass = mass * Mat<double, N, N>::identity();
  e.is_point = space.is_point = true;
  space.mass = Mat6<double>::zero();
  for (int i = 0; i < 3; ++i) space.mass(i, i) = mass;
}
template <class T, int N>
void make(PointLoadOn<Group<N>>& e, T& space, const Kind&, Numbers& numbers) {
  e.wrench = any<N>(numbers);
  space.wrench = six<N>(e.wrench);
  e.law = space.law = 1;
}
template <class T, int N>
void make(SpringOn<Group<N>>& e, T& space, const Kind& kind, Numbers& numbers) {
  e.stiffness = space.stiffness = 1.7;
  e.rest_length = space.rest_length = 0.4 + numbers.next(0.2);
  e.damping = space.damping = kind.has_damping ? 0.6 : 0.0;
}
/// Displacements along the axes, of which one is given (on a line there is one), and the distance.
template <class T, int N>
void make(JointOn<Group<N>>& e, T& space, const Kind&, Numbers&) {
  for (int i = 0; i < N; ++i) {
    e.rows[i].d = Vec<double, N>::unit(i);
    space.rows[i].kind = RowKind::along;
    space.rows[i].i = i;
    if (i == 0) e.rows[i].law = space.rows[i].law = 1;
  }
  e.rows[N].kind = space.rows[N].kind = RowKind::distance;
  e.rows[N].constant = space.rows[N].constant = 0.7;
  e.num_rows = space.num_rows = N + 1;
}

template <template <class, class> class E, int N>
Twins<E, N> make_twins(const Kind& kind, unsigned seed) {
  Numbers numbers(10 * seed + N);
  Twins<E, N> t;
  make(t.element, t.in_space, kind, numbers);
  constexpr int P = E<Group<N>, double>::num_ports;
  for (int k = 0; k < P; ++k) {
    auto& n = t.nodes[k];
    n.x.hi = any<N>(numbers);
    n.x.hi[0] += 2.0 * k;  // apart
    n.x.lo = any<N>(numbers, 1e-17);
    n.v = any<N>(numbers), n.a = any<N>(numbers), n.dq = any<N>(numbers);
    t.space_nodes[k] = {Mat3<double>::identity(),
                        {lanes::linear_part(six<N>(n.x.hi)), lanes::linear_part(six<N>(n.x.lo))},
                        six<N>(n.v),
                        six<N>(n.a),
                        six<N>(n.dq)};
    t.element.ports[k].node = t.in_space.ports[k].node = k;
    if (!kind.has_offsets) continue;
    t.element.ports[k].has_offset = t.in_space.ports[k].has_offset = true;
    t.element.ports[k].offset.x = any<N>(numbers, 0.3);
    t.in_space.ports[k].offset.x = lanes::linear_part(six<N>(t.element.ports[k].offset.x));
  }
  if (kind.on_ground && P > 1) {
    t.element.ports[0].node = t.in_space.ports[0].node = ground;
    t.element.ports[0].has_offset = t.in_space.ports[0].has_offset = false;
  }
  return t;
}

/// In statics, in a time step and at a consistent start.
template <class Visit>
void visit_cases(const Visit& visit) {
  const Slopes step{1.7, 2.9, false}, start{0.0, 0.0, true};
  for (const bool has_damping : {false, true})
    for (const bool has_offsets : {false, true})
      for (const bool on_ground : {false, true})
        for (unsigned seed = 0; seed < 8; ++seed) {
          const Kind kind{has_damping, has_offsets, on_ground};
          SCOPED_TRACE(testing::Message() << "damping " << has_damping << ", offsets " << has_offsets
                                          << ", on the ground " << on_ground << ", seed " << seed);
          visit(kind, seed, false, Slopes{});
          visit(kind, seed, true, step);
          visit(kind, seed, true, start);
        }
}

struct Result {
  std::vector<double> residual, magnitude, tangent, rate;
};
template <class E>
Result evaluated(const E& e, const FieldOn<typename E::Group, double>& field) {
  using G = typename E::Group;
  using T = lanes::Taylor<double, 1>;
  const auto n = static_cast<std::size_t>(num_unknowns(e));
  Result r{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n * n), std::vector<double>(n)};
  evaluate(e, field, multiplier_values, 0.0, r.residual.data(), r.tangent.data());
  eval_magnitude(e, field, r.residual.data(), r.magnitude.data());
  T laws[2];
  for (int i = 0; i < 2; ++i) {
    laws[i].c[0] = law_values[i];
    laws[i].c[1] = law_rates[i];
  }
  const SurroundingsOn<G, T> around{lanes::cast<T>(field.around.gravity), laws, field.around.has_inertia};
  evaluate_rate(e, field, around, multiplier_values, 0.0, nullptr, r.rate.data());
  return r;
}

/// The unknowns of the element in space that the element on the group has.
template <class E, class F>
std::vector<std::size_t> kept_unknowns(const E& on_group, const F& space) {
  std::vector<std::size_t> kept;
  std::size_t begin = 0;
  for (const Port& port : space.ports) {
    if (port.node == ground) continue;
    for (std::size_t i = 0; i < E::Group::dof; ++i) kept.push_back(begin + i);
    begin += 6;
  }
  for (int k = 0; k < num_multipliers(on_group); ++k) kept.push_back(begin + static_cast<std::size_t>(k));
  return kept;
}

template <template <class, class> class E, int N>
void compare_with_space() {
  visit_cases([](const Kind& kind, unsigned seed, bool has_inertia, const Slopes& slopes) {
    const Twins<E, N> t = make_twins<E, N>(kind, seed);
    const auto field = t.field(has_inertia, slopes);
    const Field space_field = t.space_field(has_inertia, slopes);
    const Result r = evaluated(t.element, field), space = evaluated(t.in_space, space_field);
    const std::vector<std::size_t> kept = kept_unknowns(t.element, t.in_space);
    const std::size_t n = kept.size(), whole = space.residual.size();
    ASSERT_EQ(r.residual.size(), n);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(r.residual[i], space.residual[kept[i]], bound * 10.0);
      EXPECT_NEAR(r.magnitude[i], space.magnitude[kept[i]], bound * 40.0);
      EXPECT_NEAR(r.rate[i], space.rate[kept[i]], bound * 10.0);
      for (std::size_t j = 0; j < n; ++j)
        EXPECT_NEAR(r.tangent[n * i + j], space.tangent[whole * kept[i] + kept[j]], bound * 10.0) << i << ", " << j;
    }
    std::vector<double> P(12), F(12), space_P(12), space_F(12);
    evaluate_momentum(t.element, field, 0.0, 0.0, P.data(), F.data());
    evaluate_momentum(t.in_space, space_field, 0.0, 0.0, space_P.data(), space_F.data());
    const auto forces = n - static_cast<std::size_t>(num_multipliers(t.element));
    for (std::size_t i = 0; i < forces; ++i) {
      EXPECT_NEAR(P[i], space_P[kept[i]], bound * 10.0);
      EXPECT_NEAR(F[i], space_F[kept[i]], bound * 40.0);
    }
  });
}

template <int N>
void compare_all_with_space() {
  compare_with_space<RigidBodyOn, N>();
  compare_with_space<PointLoadOn, N>();
  compare_with_space<SpringOn, N>();
  compare_with_space<JointOn, N>();
}
TEST(ElementsThatTranslate, are_those_of_space_at_nodes_that_do_not_turn) {
  compare_all_with_space<3>();
  compare_all_with_space<1>();
}

template <template <class, class> class E, int N>
void compare_with_jets() {
  visit_cases([](const Kind& kind, unsigned seed, bool has_inertia, const Slopes& slopes) {
    const Twins<E, N> t = make_twins<E, N>(kind, seed);
    const auto field = t.field(has_inertia, slopes);
    const Result r = evaluated(t.element, field);
    const check::JetResult expected = check::evaluate_on_jets(t.element, field, multiplier_values, 0.0);
    for (std::size_t i = 0; i < r.residual.size(); ++i) EXPECT_NEAR(r.residual[i], expected.residual[i], bound * 10.0);
    for (std::size_t i = 0; i < r.tangent.size(); ++i) EXPECT_NEAR(r.tangent[i], expected.tangent[i], bound * 10.0);
    std::vector<double> alone(r.residual.size());
    evaluate(t.element, field, multiplier_values, 0.0, alone.data(), nullptr);
    EXPECT_EQ(alone, r.residual) << "the same bits with and without a tangent";
  });
}
TEST(ElementsThatTranslate, have_the_tangent_of_their_residual) {
  compare_with_jets<RigidBodyOn, 3>();
  compare_with_jets<PointLoadOn, 3>();
  compare_with_jets<SpringOn, 3>();
  compare_with_jets<JointOn, 3>();
  compare_with_jets<RigidBodyOn, 1>();
  compare_with_jets<PointLoadOn, 1>();
  compare_with_jets<SpringOn, 1>();
  compare_with_jets<JointOn, 1>();
}

/// The force of a spring is the derivative of its energy; that of a body at rest the derivative of its potential.
template <int N>
void compare_with_energy() {
  using G = Group<N>;
  using T = lanes::Jet<double, 2 * N>;
  visit_cases([](const Kind& kind, unsigned seed, bool, const Slopes&) {
    const Twins<SpringOn, N> t = make_twins<SpringOn, N>({false, kind.has_offsets, false}, seed);
    const auto field = t.field(false, {});
    PortMotionOn<G, T> p[2];
    for (int k = 0; k < 2; ++k)
      for (int i = 0; i < N; ++i) {
        const auto port = static_cast<std::size_t>(k);
        p[k].H.x[i] = T(t.nodes[port].x.hi[i] + t.nodes[port].x.lo[i] + t.element.ports[port].offset.x[i]);
        p[k].H.x[i].d[N * k + i] = 1.0;
      }
    const T energy = eval_strain_energy(t.element, p);
    const Result r = evaluated(t.element, field);
    for (int i = 0; i < 2 * N; ++i) EXPECT_NEAR(r.residual[static_cast<std::size_t>(i)], energy.d[i], bound * 10.0);
  });
}
TEST(ElementsThatTranslate, resist_by_the_derivative_of_their_energy) {
  compare_with_energy<3>();
  compare_with_energy<1>();
}

template <template <class, class> class E, int N>
void compare_lanes() {
  using G = Group<N>;
  using Element = E<G, double>;
  visit_cases([](const Kind& kind, unsigned seed, bool has_inertia, const Slopes& slopes) {
    if (seed > 0) return;
    constexpr int P = Element::num_ports;
    std::vector<Twins<E, N>> twins;
    const Element* elements[num_lanes];
    int places[P];
    NodeMotionOn<G, LanePack> nodes[P];
    for (int k = 0; k < P; ++k) places[k] = k;
    for (unsigned l = 0; l < num_lanes; ++l) twins.push_back(make_twins<E, N>(kind, l));
    for (int l = 0; l < num_lanes; ++l) {
      const Twins<E, N>& t = twins[static_cast<std::size_t>(l)];
      elements[l] = &t.element;
      for (int k = 0; k < P; ++k)
        for (int i = 0; i < numbers_of_node<G>; ++i)
          reinterpret_cast<LanePack*>(&nodes[k])[i].set(l, reinterpret_cast<const double*>(&t.nodes[k])[i]);
    }
    ASSERT_TRUE(may_share_lanes(*elements[0], *elements[1]));
    const LaneElement<Element> e = make_lane_element(elements, num_lanes, places, 0);
    int laws[max_laws];
    LanePack law_lanes[max_laws], multipliers[max_rows];
    const int num_laws = list_laws(*elements[0], laws);
    for (int k = 0; k < num_laws; ++k) law_lanes[k] = LanePack(law_values[laws[k]]);
    for (int k = 0; k < max_rows; ++k) multipliers[k] = LanePack(multiplier_values[k]);
    const auto n = static_cast<std::size_t>(num_unknowns(*elements[0]));
    const SurroundingsOn<G, double> alone = twins[0].field(has_inertia, slopes).around;
    const FieldOn<G, LanePack> field{nodes, {lanes::cast<LanePack>(alone.gravity), law_lanes, has_inertia}, slopes};
    std::vector<LanePack> residual(n), magnitude(n), tangent(n * n);
    evaluate_lanes(e, field, multipliers, LanePack(0.0), residual.data(), magnitude.data(), tangent.data());
    for (int l = 0; l < num_lanes; ++l) {
      const Twins<E, N>& t = twins[static_cast<std::size_t>(l)];
      const Result r = evaluated(t.element, t.field(has_inertia, slopes));
      for (std::size_t i = 0; i < n; ++i) {
        EXPECT_EQ(residual[i][l], r.residual[i]);
        EXPECT_EQ(magnitude[i][l], r.magnitude[i]);
      }
      for (std::size_t i = 0; i < n * n; ++i) EXPECT_EQ(tangent[i][l], r.tangent[i]) << "lane " << l << ", " << i;
    }
  });
}
TEST(ElementsThatTranslate, in_lanes_have_the_bits_of_the_element_alone) {
  compare_lanes<RigidBodyOn, 3>();
  compare_lanes<PointLoadOn, 3>();
  compare_lanes<SpringOn, 3>();
  compare_lanes<JointOn, 3>();
  compare_lanes<RigidBodyOn, 1>();
  compare_lanes<PointLoadOn, 1>();
  compare_lanes<SpringOn, 1>();
  compare_lanes<JointOn, 1>();
}

}  // namespace
}  // namespace bough::elements
