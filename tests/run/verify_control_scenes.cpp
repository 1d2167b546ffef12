// Scenes of control in every dimension: a governor with a valve of first order, a stop with one-sided damping, a block
// that sticks and slips. Their motions and states against closed forms, to the order of the scheme.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bough/io/read_scene.hpp"
#include "support/scenes.hpp"
#include "support/source_dir.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::run_ok;

/// The dimensions in which a scene can be computed, by the decisions that the plan leaves out.
struct Dimension {
  const char* name;
  const char* without;
};
const Dimension dimensions[] = {{"as planned", "[]"},
                                {"in a plane", "[\"translation\", \"line\"]"},
                                {"in space", "[\"planar\", \"translation\", \"line\"]"}};

std::vector<std::string> settings(const Dimension& dimension, double step, double end, const char* integrator) {
  return {std::string("/without=") + dimension.without,
          "/analysis/step_size=" + support::text(step),
          "/analysis/end_time=" + support::text(end),
          std::string("/analysis/integrator=") + integrator,
          "/analysis/tolerance=1e-11",
          "/expected=[]"};
}

double order(double coarse, double fine) { return std::log2(coarse / fine); }

struct Scheme {
  const char* name;
  double order;
};
const Scheme schemes[] = {{"generalized_alpha", 2.0}, {"bdf", 3.0}};

// With e the deviation of the speed and s = 5, w = sqrt(175):  e = -1 + exp(-s t) (cos w t - 15 / w sin w t), and the
// valve x = (J e' + L) / T.
TEST(ControlScenes, speed_and_valve_of_the_governor_have_the_order_of_the_scheme) {
  const double t = 0.5, s = 5.0, w = std::sqrt(175.0), b = -15.0 / w;
  const double fade = std::exp(-s * t), c = std::cos(w * t), d = std::sin(w * t);
  const double speed = 29.0 + fade * (c + b * d);
  const double rate = fade * ((b * w - s) * c - (w + s * b) * d);
  const double valve = (0.5 * rate + 10.0) / 20.0;
  for (const Dimension& dimension : dimensions)
    for (const Scheme& scheme : schemes) {
      SCOPED_TRACE(std::string(dimension.name) + ", " + scheme.name);
      const auto run = [&](double step) {
        return run_ok(support::gallery("governor", settings(dimension, step, t, scheme.name)));
      };
      const Outcome coarse = run(2e-3), fine = run(1e-3);
      EXPECT_NEAR(order(std::abs(coarse.history.last("speed") - speed), std::abs(fine.history.last("speed") - speed)),
                  scheme.order, 0.15);
      EXPECT_NEAR(order(std::abs(coarse.history.last("valve") - valve), std::abs(fine.history.last("valve") - valve)),
                  scheme.order, 0.15);
    }
}

// In contact from the start, x = exp(-10 t) sin(w t) / w with w = sqrt(9900), until the force vanishes at 0.0296 s.
TEST(ControlScenes, a_stop_presses_to_the_order_of_the_scheme) {
  const double t = 0.02, w = std::sqrt(9900.0), fade = std::exp(-10.0 * t);
  const double depth = fade * std::sin(w * t) / w, speed = fade * (std::cos(w * t) - 10.0 / w * std::sin(w * t));
  for (const Dimension& dimension : dimensions)
    for (const Scheme& scheme : schemes) {
      SCOPED_TRACE(std::string(dimension.name) + ", " + scheme.name);
      const auto run = [&](double step) {
        std::vector<std::string> list = settings(dimension, step, t, scheme.name);
        list.emplace_back("/signals/2/expression=way");
        list.emplace_back(R"-(/signals/3/expression="-max(0, k*depth + c*speed)")-");
        return run_ok(support::gallery("stop", list));
      };
      const Outcome coarse = run(1e-4), fine = run(5e-5);
      EXPECT_NEAR(order(std::abs(coarse.history.last("way") - depth), std::abs(fine.history.last("way") - depth)),
                  scheme.order, 0.15);
      EXPECT_NEAR(order(std::abs(coarse.history.last("speed") - speed), std::abs(fine.history.last("speed") - speed)),
                  scheme.order, 0.15);
    }
}

/// The block on a belt of the gallery.
scene::Scene block(const std::vector<std::string>& overrides) {
  const io::SceneFile file = io::read_scene(support::source_dir() / "data" / "gallery" / "stick_slip.json", overrides);
  EXPECT_TRUE(file.ok());
  return file.scene;
}

// While the block, which moves with the belt, sticks, bristle and block are a linear oscillator: with y = z the
// bristle, x'' = -100 x + s0 z + s1 z', z' = v - x', x(0) = z(0) = 0, x'(0) close to v. The reference is Richardson's
// of finer steps.
TEST(ControlScenes, a_bristle_that_sticks_has_the_order_of_the_scheme) {
  for (const Dimension& dimension : dimensions)
    for (const Scheme& scheme : schemes) {
      SCOPED_TRACE(std::string(dimension.name) + ", " + scheme.name);
      const auto run = [&](double step) {
        std::vector<std::string> list = settings(dimension, step, 0.02, scheme.name);
        list.emplace_back(R"(/initial_velocities=[{"of": "block", "velocity": [0.0995, 0, 0]}])");
        return run_ok(block(list));
      };
      const Outcome coarse = run(8e-5), middle = run(4e-5), fine = run(2e-5);
      for (const char* column : {"x", "speed", "friction"}) {
        const double a = coarse.history.last(column), b = middle.history.last(column), c = fine.history.last(column);
        EXPECT_NEAR(order(std::abs(a - b), std::abs(b - c)), scheme.order, 0.25) << column;
      }
    }
}

// The figures of the scene, of Coulomb's law with 6 and 4 N: a block that sticks for 0.4 s, at the speed of the belt,
// and slips for 0.40689 s.
TEST(ControlScenes, a_block_sticks_and_slips_in_every_dimension) {
  for (const Dimension& dimension : dimensions) {
    SCOPED_TRACE(dimension.name);
    const Outcome out = run_ok(block({std::string("/without=") + dimension.without}));
    ASSERT_EQ(out.summary.expected.size(), 3u);
    for (const records::ExpectedResult& figure : out.summary.expected)
      EXPECT_TRUE(figure.holds) << figure.name << ": " << figure.value;
  }
}

}  // namespace
}  // namespace bough::run
