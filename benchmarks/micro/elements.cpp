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
  joint.efforts[0] = {Coordinate::angle, 10.0, 0.1, 1.0, -1};
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
    const double* from[num_lanes];
    std::fill_n(from, num_lanes, numbers_of(c.nodes[k]));
    set_lanes(nodes[k], from);
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

/// A planar beam between nodes in motion, bent.
template <int N>
struct PlanarCase {
  BeamOn<Plane, N> beam;
  NodeMotionOn<Plane, double> nodes[N];
  explicit PlanarCase(bool is_damped) {
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
      nodes[k] = {{{std::cos(0.03 * s), std::sin(0.03 * s)}},
                  {{{0.25 * s, 0.002 * s}}, {{0, 0}}},
                  {{1, 2, 0.3}},
                  {{3, 2, 0.2}},
                  {{1e-3, 2e-3, 1e-4}}};
    }
  }
  static Mat3<double> plane_diagonal(const Vec3<double>& d) { return {{d[0], 0, 0, 0, d[1], 0, 0, 0, d[2]}}; }
};

template <int N>
void planar_alone(benchmark::State& state, const PlanarCase<N>& c) {
  const bool with_tangent = state.range(1) != 0;
  const FieldOn<Plane, double> field{c.nodes, {{{0, -9.81}}, nullptr, state.range(0) != 0}, slopes};
  constexpr int n = 3 * N;
  double residual[n], magnitude[n], tangent[n * n];
  for (auto _ : state) {
    evaluate(c.beam, field, nullptr, 0.0, residual, with_tangent ? tangent : nullptr);
    eval_magnitude(c.beam, field, residual, magnitude);
    benchmark::DoNotOptimize(residual);
    benchmark::DoNotOptimize(tangent);
  }
  set_rate(state, 1);
}

template <int N>
void planar_lanes(benchmark::State& state, const PlanarCase<N>& c) {
  const bool with_tangent = state.range(1) != 0;
  const BeamOn<Plane, N>* elements[1] = {&c.beam};
  int ports[N];
  NodeMotionOn<Plane, LanePack> nodes[N];
  for (int k = 0; k < N; ++k) {
    ports[k] = k;
    const auto* from = reinterpret_cast<const double*>(&c.nodes[k]);
    auto* to = reinterpret_cast<LanePack*>(&nodes[k]);
    for (int i = 0; i < numbers_of_node<Plane>; ++i) to[i] = LanePack(from[i]);
  }
  const auto e = make_lane_element(elements, 1, ports, 0);
  const FieldOn<Plane, LanePack> field{nodes, {{{0.0, -9.81}}, nullptr, state.range(0) != 0}, slopes};
  constexpr int n = 3 * N;
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

#define BOUGH_BENCHMARK_PLANAR(name, sample)                                                                      \
  BENCHMARK_CAPTURE(planar_alone, name, sample)->ArgNames({"dynamic", "tangent"})->ArgsProduct({{0, 1}, {0, 1}}); \
  BENCHMARK_CAPTURE(planar_lanes, name, sample)->ArgNames({"dynamic", "tangent"})->ArgsProduct({{0, 1}, {0, 1}});
BOUGH_BENCHMARK_PLANAR(beam2, PlanarCase<2>(false))
BOUGH_BENCHMARK_PLANAR(damped_beam2, PlanarCase<2>(true))
BOUGH_BENCHMARK_PLANAR(beam3, PlanarCase<3>(false))
BOUGH_BENCHMARK_PLANAR(beam4, PlanarCase<4>(false))
