// Scenes of control in every dimension: a motor on a flexible arm, a rotor with a limited integrator, a governor with a
// valve of first order, a stop with one-sided damping, a block that sticks and slips. Their motions and states against
// closed forms, to the order of the scheme, and in any position in space.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bough/io/read_scene.hpp"
#include "bough/motion/so3.hpp"
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

// Met at 0.25 s, the stop lets go at the first zero of k x + c x' = exp(-10 t) (20 cos w t + 9800 / w sin w t).
TEST(ControlScenes, a_stop_lets_go_when_its_force_vanishes) {
  const double w = std::sqrt(9900.0), meets = 0.25,
               leaves = meets + (std::numbers::pi - std::atan2(20.0 * w, 9800.0)) / w;
  EXPECT_NEAR(leaves, 0.279560753247495, 1e-15);
  for (const Dimension& dimension : dimensions) {
    SCOPED_TRACE(dimension.name);
    const Outcome out = run_ok(support::gallery("stop", settings(dimension, 2e-5, 0.3, "generalized_alpha")));
    const std::vector<double> push = out.history.of("push");
    std::size_t last = push.size() - 1;
    while (push[last] == 0.0) --last;
    const double slope = (push[last] - push[last - 1]) / (out.history.times[last] - out.history.times[last - 1]);
    EXPECT_NEAR(out.history.times[last] - push[last] / slope, leaves, 2e-6);
    EXPECT_NEAR(out.history.last("speed"), -0.74407939772178, 2e-4);
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

// The arm of the gallery under its weight across the turn, which takes space, and without it, in a plane too. Its
// vibrations make `bdf` take its second order, if no order is asked for.
TEST(ControlScenes, a_motor_on_a_flexible_arm_has_the_order_of_the_scheme) {
  for (const bool is_heavy : {true, false})
    for (const Dimension& dimension : dimensions)
      for (const char* scheme : {"generalized_alpha", "bdf"}) {
        SCOPED_TRACE(std::string(is_heavy ? "heavy, " : "weightless, ") + dimension.name + ", " + scheme);
        const auto run = [&](double step) {
          std::vector<std::string> list = settings(dimension, step, 0.4, scheme);
          if (!is_heavy) list.emplace_back("/gravity=[0, 0, 0]");
          return run_ok(support::gallery("flexible_pd_arm", list));
        };
        const Outcome coarse = run(2e-3), middle = run(1e-3), fine = run(5e-4);
        for (const char* column : {"tip.y", "torque"}) {
          const double a = coarse.history.last(column), b = middle.history.last(column), c = fine.history.last(column);
          EXPECT_NEAR(order(std::abs(a - b), std::abs(b - c)), 2.0, 0.1) << column;
        }
        const double path = 0.02 * (0.8 - std::sin(1.6 * std::numbers::pi) / (2.0 * std::numbers::pi));
        EXPECT_LT(fine.history.last("angle"), path) << "the motor follows";
      }
}

/// angle, rate and integral of the scene limited_pid at `end`, by Runge's and Kutta's method of order 4.
std::array<double, 3> limited_pid(double end) {
  using State = std::array<double, 3>;
  const auto rates = [](const State& y) {
    const double off = 1.0 - y[0], j = std::clamp(y[2], -0.15, 0.15);
    const double torque = std::clamp(60.0 * off + 20.0 * j - 9.0 * y[1], -6.0, 6.0);
    return State{y[1], (torque - 2.0) / 0.5, off + 20.0 * (j - y[2])};
  };
  const auto moved = [](const State& y, const State& by, double size) {
    return State{y[0] + size * by[0], y[1] + size * by[1], y[2] + size * by[2]};
  };
  State y{};
  const int steps = 200000;
  const double h = end / steps;
  for (int k = 0; k < steps; ++k) {
    const State a = rates(y), b = rates(moved(y, a, 0.5 * h)), c = rates(moved(y, b, 0.5 * h)),
                d = rates(moved(y, c, h));
    for (std::size_t i = 0; i < 3; ++i) y[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  }
  return y;
}

// Both limits are reached before the time that is looked at, and the torque has left its own. Rates have kinks there,
// each somewhere in its step, which leave order 2 on the whole: it is measured over four halvings of the step. `bdf` is
// more accurate, with errors of the kinks alone, which come and go with their places.
TEST(ControlScenes, a_limited_integrator_has_order_two) {
  const double end = 1.0;
  const std::array<double, 3> exact = limited_pid(end);
  for (const Dimension& dimension : dimensions)
    for (const char* scheme : {"generalized_alpha", "bdf"}) {
      SCOPED_TRACE(std::string(dimension.name) + ", " + scheme);
      const auto run = [&](double step) {
        return run_ok(support::gallery("limited_pid", settings(dimension, step, end, scheme)));
      };
      const Outcome coarse = run(4e-3), fine = run(2.5e-4);
      EXPECT_EQ(fine.history.largest("torque"), 6.0);
      EXPECT_GT(fine.history.largest("integral"), 0.15);
      const auto order_over_four_halvings = [&](const char* column, double value) {
        return 0.25 * order(std::abs(coarse.history.last(column) - value), std::abs(fine.history.last(column) - value));
      };
      if (std::string(scheme) == "generalized_alpha") {
        EXPECT_GT(order_over_four_halvings("angle", exact[0]), 1.9);
        EXPECT_GT(order_over_four_halvings("integral", exact[2]), 1.9);
      }
      EXPECT_NEAR(fine.history.last("angle"), exact[0], 1e-8);
      EXPECT_NEAR(fine.history.last("integral"), exact[2], 2e-8);
    }
}

// With limits that are not reached, the loop is smooth.
TEST(ControlScenes, an_integrator_within_its_limits_has_the_order_of_the_scheme) {
  for (const Dimension& dimension : dimensions)
    for (const Scheme& scheme : schemes) {
      SCOPED_TRACE(std::string(dimension.name) + ", " + scheme.name);
      const auto run = [&](double step) {
        std::vector<std::string> list = settings(dimension, step, 0.4, scheme.name);
        list.emplace_back(R"-(/signals/4/expression="max(-1, min(1, i))")-");
        list.emplace_back(R"-(/signals/5/expression="max(-99, min(99, 60*err + 20*j - 9*rate))")-");
        return run_ok(support::gallery("limited_pid", list));
      };
      const Outcome coarse = run(2e-3), middle = run(1e-3), fine = run(5e-4);
      for (const char* column : {"angle", "integral", "torque"}) {
        const double a = coarse.history.last(column), b = middle.history.last(column), c = fine.history.last(column);
        EXPECT_NEAR(order(std::abs(a - b), std::abs(b - c)), scheme.order, 0.15) << column;
      }
    }
}

/// A rotation by 1.1 rad about no axis of the scene, and a place off the origin.
motion::Frame<double> elsewhere() {
  const motion::Vec3<double> axis = (1.1 / std::sqrt(14.0)) * motion::Vec3<double>{{1.0, -2.0, 3.0}};
  return {motion::exp_so3(axis), motion::Vec3<double>{{0.3, -0.7, 0.4}}};
}

motion::Vec3<double> place(const std::vector<double>& row, std::size_t k) { return {{row[k], row[k + 1], row[k + 2]}}; }

double distance(const motion::Vec3<double>& a, const motion::Vec3<double>& b) {
  return std::sqrt(lanes::dot(a - b, a - b));
}

// Turned out of the plane together with its gravity, each scene computes the same, in space.
TEST(ControlScenes, the_same_happens_anywhere_in_space) {
  const motion::Frame<double> to = elsewhere();
  for (const auto& [name, end] :
       {std::pair{"flexible_pd_arm", 0.4}, std::pair{"limited_pid", 1.0}, std::pair{"stop", 0.3},
        std::pair{"governor", 1.0}, std::pair{"friction_incline", 0.1}, std::pair{"pd_joint", 0.5},
        std::pair{"cylinder", 0.3}, std::pair{"boom_servo", 0.5}, std::pair{"stick_slip", 0.3}}) {
    SCOPED_TRACE(name);
    const std::vector<std::string> list = {"/analysis/end_time=" + support::text(end), "/analysis/tolerance=1e-11",
                                           "/expected=[]"};
    const scene::Scene here = std::string(name) == "stick_slip" ? block(list) : support::gallery(name, list);
    const Outcome a = run_ok(here), b = run_ok(support::moved(here, to));
    ASSERT_EQ(a.history.times, b.history.times);
    for (std::size_t k = 0; k < a.history.columns.size(); ++k) {
      const std::string& column = a.history.columns[k];
      const bool is_place = column.find(".x") != std::string::npos;
      if (column.find('.') != std::string::npos && !is_place) continue;  // y and z are compared with x
      double most = 0.0;
      for (std::size_t i = 0; i < a.history.times.size(); ++i) {
        const std::vector<double>&u = a.history.rows[i], &v = b.history.rows[i];
        most = std::max(most, is_place ? distance(to.R * place(u, k) + to.x, place(v, k)) : std::abs(u[k] - v[k]));
      }
      EXPECT_LT(most, 1e-10 * a.history.largest(column)) << column;
    }
  }
}

// While the block slips, its bristle is stretched as far as it goes. There the law of its stretching has a kink, at
// which the rates of Newton's iterations say nothing about the next one. In space the kink is met from both sides.
TEST(ControlScenes, friction_at_a_kink_is_as_near_as_the_tolerance_asks) {
  const auto run_with = [&](const char* tolerance) {
    return run_ok(support::moved(block({"/analysis/end_time=0.05", std::string("/analysis/tolerance=") + tolerance,
                                        "/expected=[]", "/output/stride=1"}),
                                 elsewhere()));
  };
  const Outcome exact = run_with("1e-13");
  const std::vector<double> friction = exact.history.of("friction");
  for (const auto& [text, tolerance] : {std::pair{"1e-10", 1e-10}, std::pair{"1e-11", 1e-11}}) {
    const Outcome out = run_with(text);
    ASSERT_EQ(out.history.times, exact.history.times);
    const std::vector<double> found = out.history.of("friction");
    double most = 0.0;
    for (std::size_t k = 0; k < found.size(); ++k) most = std::max(most, std::abs(found[k] - friction[k]));
    // The share of the bristle changes by 33 times its relative stretch, and errors of steps add up.
    EXPECT_LT(most, 4.0 * tolerance * exact.history.largest("friction")) << text;
  }
}

}  // namespace
}  // namespace bough::run
