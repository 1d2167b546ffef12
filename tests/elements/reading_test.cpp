/// Readings of signals on SE(3) and SE(2): derivatives by the nodes' increments and in time, against differences.
#include "bough/elements/reading.hpp"

#include <gtest/gtest.h>

#include "bough/motion/vectors_on.hpp"
#include "elements/samples.hpp"

namespace bough::elements {
namespace {

using check::Numbers;

constexpr double turns = 6.4;

template <class G>
typename G::template Vector<double> vector_of(Numbers& numbers, double scale) {
  typename G::template Vector<double> v;
  for (int i = 0; i < G::dof; ++i) v[i] = numbers.next(scale);
  return v;
}

/// Two nodes in motion and a reading between frames beside them.
template <class G>
struct Sample {
  JointOn<G, double> reading;
  NodeMotionOn<G, double> nodes[2];
  Slopes slopes{7.0, 130.0, false};

  Sample(RowKind coordinate, bool is_rate, unsigned seed) {
    Numbers numbers(seed);
    reading.num_efforts = 1;
    EffortOn<G, double>& effort = reading.efforts[0];
    effort.coordinate = coordinate;
    effort.stiffness = is_rate ? 0.0 : 1.0;
    effort.damping = is_rate ? 1.0 : 0.0;
    if constexpr (G::template Direction<double>::has_numbers)
      if (coordinate == RowKind::along) effort.direction.d = {{0.6, -0.8}};
    for (int k = 0; k < 2; ++k) {
      reading.ports[k].node = k;
      reading.ports[k].has_offset = true;
      reading.ports[k].offset = G::exp(vector_of<G>(numbers, 0.7));
      const auto H = G::exp(vector_of<G>(numbers, 0.8));
      nodes[k] = {H.R, motion::PositionPair<double, G::translations>::from(H.x), vector_of<G>(numbers, 1.0),
                  vector_of<G>(numbers, 1.0), vector_of<G>(numbers, 0.3)};
    }
  }
  double value(double* by_nodes = nullptr) const {
    FieldOn<G, double> field;
    field.nodes = nodes;
    field.slopes = slopes;
    return eval_reading(reading, field, turns, by_nodes);
  }
  double rate() const {
    FieldOn<G, double> field;
    field.nodes = nodes;
    return eval_reading_rate(reading, field, turns);
  }
  /// H <- H exp(eta)
  void move(int node, const typename G::template Vector<double>& eta) {
    auto& n = nodes[node];
    const auto H = G::compose({n.R, n.x.hi + n.x.lo}, G::exp(eta));
    n.R = H.R;
    n.x = motion::PositionPair<double, G::translations>::from(H.x);
  }
};

template <class G>
void expect_derivatives(RowKind coordinate, bool is_rate) {
  using Vector = typename G::template Vector<double>;
  constexpr double step = 1e-5, near = 2e-8;
  for (unsigned seed = 1; seed < 6; ++seed) {
    const Sample<G> s(coordinate, is_rate, seed);
    double slopes[2 * G::dof];
    s.value(slopes);
    for (int k = 0; k < 2; ++k)
      for (int i = 0; i < G::dof; ++i) {
        double at[2];
        for (int side = 0; side < 2; ++side) {
          Sample<G> moved = s;
          const Vector eta = (side == 0 ? -step : step) * Vector::unit(i);
          moved.move(k, eta);
          moved.nodes[k].v +=
              s.slopes.velocity * motion::VectorsOn<G>::template inverse_tangent_times<double>(s.nodes[k].dq, eta);
          at[side] = moved.value();
        }
        EXPECT_NEAR(slopes[G::dof * k + i], (at[1] - at[0]) / (2.0 * step), near) << "node " << k << ", " << i;
      }
    double at[2];
    for (int side = 0; side < 2; ++side) {
      const double t = side == 0 ? -step : step;
      Sample<G> later = s;
      for (int k = 0; k < 2; ++k) {
        later.move(k, Vector(t * s.nodes[k].v + (0.5 * t * t) * s.nodes[k].a));
        later.nodes[k].v += t * s.nodes[k].a;
      }
      at[side] = later.value();
    }
    EXPECT_NEAR(s.rate(), (at[1] - at[0]) / (2.0 * step), near);
  }
}

TEST(Reading, has_the_derivatives_of_its_value_in_space) {
  for (const RowKind coordinate : {RowKind::angle, RowKind::along, RowKind::distance})
    for (const bool is_rate : {false, true}) expect_derivatives<motion::Se3>(coordinate, is_rate);
}
TEST(Reading, has_the_derivatives_of_its_value_in_a_plane) {
  for (const RowKind coordinate : {RowKind::angle, RowKind::along, RowKind::distance})
    for (const bool is_rate : {false, true}) expect_derivatives<motion::Se2>(coordinate, is_rate);
}

}  // namespace
}  // namespace bough::elements
