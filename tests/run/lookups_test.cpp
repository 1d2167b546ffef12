// Measures and expected figures find their columns at a cost in proportion to their number.
#include <gtest/gtest.h>

#include <string>

#include "bough/plan/history_header.hpp"
#include "bough/run/measures.hpp"
#include "expected_figures.hpp"
#include "support/operations.hpp"

namespace bough::run {
namespace {

/// A word of 30 letters, which differ at its end alone.
std::string name(const char* stem, int i) {
  const std::string number = std::to_string(i);
  return stem + std::string(30 - std::strlen(stem) - number.size(), '_') + number;
}

/// A body with n sensors of its place, each with an expected figure and two measures, one of which is of the other.
scene::Scene body_with_sensors(int n) {
  scene::Scene s;
  scene::Body body;
  body.name = "body";
  body.mass = 1.0;
  body.inertia = scene::Mat3::identity();
  s.bodies.push_back(body);
  s.analysis.end_time = 1.0;
  for (int i = 0; i < n; ++i) {
    scene::Sensor sensor;
    sensor.name = name("place", i);
    sensor.at.to = body.name;
    s.sensors.push_back(sensor);
    scene::Expected figure;
    figure.quantity = sensor.name + ".x";
    figure.figure = scene::FigureKind::max;
    s.expected.push_back(figure);
    scene::Measure mean;
    mean.name = name("mean", i);
    mean.kind = scene::MeasureKind::mean;
    mean.quantity = figure.quantity;
    scene::Measure twice;
    twice.name = name("twice", i);
    twice.expression = "x + x";
    twice.names = {{"x", mean.name}};
    twice.is_of_measures = true;
    s.measures.insert(s.measures.end(), {mean, twice});
  }
  return s;
}

TEST(Lookups, of_columns_of_measures_and_figures) {
  constexpr int size = 250;
  struct Ready {
    scene::Scene scene;
    plan::Plan plan;
    records::HistoryHeader header;
    explicit Ready(int n)
        : scene(body_with_sensors(n)), plan(plan::make_plan(scene)), header(plan::make_header(plan)) {}
  };
  const Ready small(size), large(8 * size);
  const auto growth = [&](const std::function<void(const Ready&)>& job) {
    return test::growth_by_eight([&](int n) { job(n == size ? small : large); }, size);
  };
  EXPECT_LT(growth([](const Ready& r) { (void)Measures(r.scene, r.header); }), test::linear_by_eight);
  EXPECT_LT(growth([](const Ready& r) { EXPECT_EQ(units_of_measures(r.scene, r.header).back(), "m"); }),
            test::linear_by_eight);
  EXPECT_LT(growth([](const Ready& r) { (void)ExpectedFigures(r.scene, r.scene.expected, r.plan, r.header, {}, {}); }),
            test::linear_by_eight);
}

}  // namespace
}  // namespace bough::run
