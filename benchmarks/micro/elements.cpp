/// Residual, and residual with exact tangent, of the elements: one call each, and one call over eight lanes. The
/// counter `element` is the CPU time of one element: with lanes, of one lane.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "bough/elements/evaluate_lanes.hpp"

namespace {

using namespace bough::elements;
using bough::motion::Vec3Pair;
using Plane = bough::motion::Se2;
using bough::motion::Translations;

/// An element between nodes 0 .. P - 1 in motion, bent and twisted.
template <class E>
struct Case {
  static constexpr int num_nodes = E::num_ports;
  E element;
  NodeMotion nodes[num_nodes];
  double multipliers[max_rows] = {1, 2, 3, 4, 5, 6};
  explicit Case(const E& e) : element(e) {
    for (int k = 0; k < num_nodes; ++k) {
      const double s = static_cast<double>(k) / (num_nodes > 1 ? num_nodes - 1 : 1);
      element.ports[k].node = k;
      nodes[k].R = bough::motion::exp_so3(Vec3<double>{{0.01 * s, 0.02 * s, 0.03 * s}});
      nodes[k].x = Vec3Pair::from({{0.25 * s, 0.001 * s, 0.002 * s}});
      nodes[k].v = {{1, 2, 3, 0.1, 0.2, 0.3}};
      nodes[k].a = {{3, 2, 1, 0.3, 0.1, 0.2}};
      nodes[k].dq = {{1e-3, 2e-3, 3e-3, 1e-4, 2e-4, 1e-4}};
    }
  }
};

Mat6<double> diagonal(const Vec6<double>& d) {
  Mat6<double> m = Mat6<double>::zero();
  for (int i = 0; i < 6; ++i) m(i, i) = d[i];
  return m;
}

template <int N>
Beam<N> make_beam() {
  Beam<N> beam;
  beam.length = 0.25;
  beam.stiffness = diagonal({{8.4e7, 2.7e7, 2.7e7, 1.8e3, 2.8e3, 2.8e3}});
  beam.damping = Mat6<double>::zero();
  beam.mass = diagonal({{3.14, 3.14, 3.14, 1e-4, 1e-4, 1e-4}});
  beam.has_mass = true;
  for (auto& strain : beam.reference_strain) strain = {{1, 0, 0, 0, 0, 0}};
  return beam;
}
RigidBody make_body() {
  RigidBody body;
  body.mass = make_mass_matrix(3.0, {{0.1, 0.2, 0.3}}, {{1, 0, 0, 0, 2, 0, 0, 0, 3}});
  return body;
}
Spring make_spring() {
  Spring spring;
  spring.stiffness = 100.0;
  spring.rest_length = 0.2;
  spring.damping = 1.0;
  return spring;
}
Bushing make_bushing() {
  Bushing bushing;
  bushing.stiffness = diagonal({{1e3, 1e3, 1e3, 10, 10, 10}});
  bushing.damping = diagonal({{1, 1, 1, 0.1, 0.1, 0.1}});
  bushing.has_damping = true;
  return bushing;
}
Joint make_revolute() {
  Joint joint;
  for (int i = 0; i < 3; ++i) joint.rows[i].i = i;
  for (int i = 0; i < 2; ++i) {
    joint.rows[3 + i].kind = RowKind::across;
    joint.rows[3 + i].i = i;
    joint.rows[3 + i].j = 2;
  }
  joint.num_rows = 5;
  return joint;
}
/// The same joint with a spring and a damper about its axis.
Joint make_sprung_revolute() {
  Joint joint = make_revolute();
  joint.efforts[0] = {RowKind::angle, 10.0, 0.1, 1.0, -1};
  joint.num_efforts = 1;
  return joint;
}

constexpr Slopes slopes{2e3, 4e6, false};

void set_rate(benchmark::State& state, int elements) {
  state.counters["element"] = benchmark::Counter(
      static_cast<double>(elements), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class E>
void alone(benchmark::State& state, const E& element) {
  const Case<E> c(element);
  const bool with_tangent = state.range(1) != 0;
  const Field field{c.nodes, {{{0, 0, -9.81}}, nullptr, state.range(0) != 0}, slopes};
  constexpr int n = 6 * E::num_ports + E::num_multipliers;
  double residual[n], tangent[n * n];
  for (auto _ : state) {
    evaluate(c.element, field, c.multipliers, 0.0, residual, with_tangent ? tangent : nullptr);
    benchmark::DoNotOptimize(residual);
    benchmark::DoNotOptimize(tangent);
  }
  set_rate(state, 1);
}

template <class E>
void lanes(benchmark::State& state, const E& element) {
  const Case<E> c(element);
  const bool with_tangent = state.range(1) != 0;
  const E* elements[1] = {&c.element};
  int ports[E::num_ports];
  for (int k = 0; k < E::num_ports; ++k) ports[k] = k;
  const LaneElement<E> e = make_lane_element(elements, 1, ports, 0);
  NodeLanes nodes[E::num_ports];
  for (int k = 0; k < E::num_ports; ++k) {
    const auto* const from = reinterpret_cast<const double*>(&c.nodes[k]);
    for (int i = 0; i < numbers_of_node<typename E::Group>; ++i)
      reinterpret_cast<LanePack*>(&nodes[k])[i] = LanePack(from[i]);
  }
  LanePack multipliers[max_rows];
  for (int k = 0; k < max_rows; ++k) multipliers[k] = LanePack(c.multipliers[k]);
  const FieldLanes field{nodes, {{{0.0, 0.0, -9.81}}, nullptr, state.range(0) != 0}, slopes};
  constexpr int n = 6 * E::num_ports + E::num_multipliers;
  LanePack residual[n], magnitude[n], tangent[n * n];
  for (auto _ : state) {
    evaluate_lanes(e, field, multipliers, LanePack(0.0), residual, magnitude, with_tangent ? tangent : nullptr);
    benchmark::DoNotOptimize(residual);
    benchmark::DoNotOptimize(tangent);
  }
  set_rate(state, num_lanes);
}

/// An element on a group other than SE(3), between nodes in motion.
template <class E>
struct GroupCase {
  using Element = E;
  using G = typename E::Group;
  E element;
  NodeMotionOn<G, double> nodes[E::num_ports];
};

Mat3<double> plane_diagonal(const Vec3<double>& d) { return {{d[0], 0, 0, 0, d[1], 0, 0, 0, d[2]}}; }

/// A planar beam, bent.
template <int N>
GroupCase<BeamOn<Plane, N>> make_planar_beam(bool is_damped) {
  GroupCase<BeamOn<Plane, N>> c;
  BeamOn<Plane, N>& beam = c.element;
  beam.length = 0.25;
  beam.stiffness = plane_diagonal({{8.4e7, 2.7e7, 2.8e3}});
  beam.damping = is_damped ? plane_diagonal({{8.4e3, 2.7e3, 0.28}}) : Mat3<double>::zero();
  beam.mass = plane_diagonal({{3.14, 3.14, 1e-4}});
  beam.has_mass = true;
  beam.has_damping = is_damped;
  for (auto& strain : beam.reference_strain) strain = {{1, 0, 0}};
  for (int k = 0; k < N; ++k) {
    const double s = static_cast<double>(k) / (N - 1);
    beam.ports[k].node = k;
    c.nodes[k] = {{{std::cos(0.03 * s), std::sin(0.03 * s)}},
                  {{{0.25 * s, 0.002 * s}}, {{0, 0}}},
                  {{1, 2, 0.3}},
                  {{3, 2, 0.2}},
                  {{1e-3, 2e-3, 1e-4}}};
  }
  return c;
}

/// Nodes that translate in space or along a line, under an element without rotations.
template <class E>
GroupCase<E> between_places(const E& element) {
  GroupCase<E> c{element, {}};
  for (int k = 0; k < E::num_ports; ++k) {
    c.element.ports[k].node = k;
    for (int i = 0; i < E::Group::dof; ++i) {
      c.nodes[k].x.hi[i] = i == 0 ? 0.25 * k : 0.001 * k;
      c.nodes[k].x.lo[i] = 0.0;
      c.nodes[k].v[i] = 1.0 + i;
      c.nodes[k].a[i] = 3.0 - i;
      c.nodes[k].dq[i] = 1e-3;
    }
  }
  return c;
}
template <int N>
GroupCase<SpringOn<Translations<N>>> make_spring_between_places() {
  SpringOn<Translations<N>> spring;
  spring.stiffness = 100.0;
  spring.rest_length = 0.2;
  spring.damping = 2.0;
  return between_places(spring);
}
template <int N>
GroupCase<RigidBodyOn<Translations<N>>> make_mass() {
  RigidBodyOn<Translations<N>> body;
  body.mass = 3.0 * Mat<double, N, N>::identity();
  return between_places(body);
}

template <class G>
typename G::template Translation<double> any_gravity() {
  auto g = G::template Translation<double>::zero();
  g[G::translations - 1] = -9.81;
  return g;
}

template <class Sample>
void on_group_alone(benchmark::State& state, const Sample& c) {
  using G = typename Sample::G;
  const bool with_tangent = state.range(1) != 0;
  const FieldOn<G, double> field{c.nodes, {any_gravity<G>(), nullptr, state.range(0) != 0}, slopes};
  constexpr int n = G::dof * Sample::Element::num_ports;
  double residual[n], magnitude[n], tangent[n * n];
  for (auto _ : state) {
    evaluate(c.element, field, nullptr, 0.0, residual, with_tangent ? tangent : nullptr);
    eval_magnitude(c.element, field, residual, magnitude);
    benchmark::DoNotOptimize(residual);
    benchmark::DoNotOptimize(tangent);
  }
  set_rate(state, 1);
}

template <class Sample>
void on_group_lanes(benchmark::State& state, const Sample& c) {
  using G = typename Sample::G;
  using E = typename Sample::Element;
  const bool with_tangent = state.range(1) != 0;
  const E* elements[1] = {&c.element};
  int ports[E::num_ports];
  NodeMotionOn<G, LanePack> nodes[E::num_ports];
  for (int k = 0; k < E::num_ports; ++k) {
    ports[k] = k;
    const auto* from = reinterpret_cast<const double*>(&c.nodes[k]);
    auto* to = reinterpret_cast<LanePack*>(&nodes[k]);
    for (int i = 0; i < numbers_of_node<G>; ++i) to[i] = LanePack(from[i]);
  }
  const auto e = make_lane_element(elements, 1, ports, 0);
  const FieldOn<G, LanePack> field{
      nodes, {bough::lanes::cast<LanePack>(any_gravity<G>()), nullptr, state.range(0) != 0}, slopes};
  constexpr int n = G::dof * E::num_ports;
  const LanePack turns(0.0);
  LanePack residual[n], magnitude[n], tangent[n * n];
  for (auto _ : state) {
    evaluate_lanes(e, field, nullptr, turns, residual, magnitude, with_tangent ? tangent : nullptr);
    benchmark::DoNotOptimize(residual);
    benchmark::DoNotOptimize(tangent);
  }
  set_rate(state, num_lanes);
}

}  // namespace

#define BOUGH_BENCHMARK_ELEMENT(name, element)                                                              \
  BENCHMARK_CAPTURE(alone, name, element)->ArgNames({"dynamic", "tangent"})->ArgsProduct({{0, 1}, {0, 1}}); \
  BENCHMARK_CAPTURE(lanes, name, element)->ArgNames({"dynamic", "tangent"})->ArgsProduct({{0, 1}, {0, 1}});
BOUGH_BENCHMARK_ELEMENT(beam2, make_beam<2>())
BOUGH_BENCHMARK_ELEMENT(beam3, make_beam<3>())
BOUGH_BENCHMARK_ELEMENT(beam4, make_beam<4>())
BOUGH_BENCHMARK_ELEMENT(body, make_body())
BOUGH_BENCHMARK_ELEMENT(spring, make_spring())
BOUGH_BENCHMARK_ELEMENT(bushing, make_bushing())
BOUGH_BENCHMARK_ELEMENT(revolute, make_revolute())
BOUGH_BENCHMARK_ELEMENT(sprung_revolute, make_sprung_revolute())

#define BOUGH_BENCHMARK_ON_GROUP(name, sample)                                                                      \
  BENCHMARK_CAPTURE(on_group_alone, name, sample)->ArgNames({"dynamic", "tangent"})->ArgsProduct({{0, 1}, {0, 1}}); \
  BENCHMARK_CAPTURE(on_group_lanes, name, sample)->ArgNames({"dynamic", "tangent"})->ArgsProduct({{0, 1}, {0, 1}});
BOUGH_BENCHMARK_ON_GROUP(planar_beam2, make_planar_beam<2>(false))
BOUGH_BENCHMARK_ON_GROUP(planar_damped_beam2, make_planar_beam<2>(true))
BOUGH_BENCHMARK_ON_GROUP(planar_beam3, make_planar_beam<3>(false))
BOUGH_BENCHMARK_ON_GROUP(planar_beam4, make_planar_beam<4>(false))
BOUGH_BENCHMARK_ON_GROUP(spring_without_rotations, make_spring_between_places<3>())
BOUGH_BENCHMARK_ON_GROUP(spring_on_a_line, make_spring_between_places<1>())
BOUGH_BENCHMARK_ON_GROUP(mass_without_rotations, make_mass<3>())
BOUGH_BENCHMARK_ON_GROUP(mass_on_a_line, make_mass<1>())
