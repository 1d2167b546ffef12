// Motions of nested frames in series of time against the chain of frames of motion/, which composes velocities and
// accelerations by vectors.
#include "bough/plan/frames.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bough/laws/make_law.hpp"
#include "bough/scene/frames.hpp"

namespace bough::plan {
namespace {

using motion::FrameMotion;
using motion::Vec3;
using motion::Vec6;

scene::FrameDef frame(const std::string& name, const std::string& parent, const Vec3<double>& spread) {
  scene::MovingFrame m;
  m.name = name;
  const char* const paths[3] = {"0.4*sin(1.3*t)", "0.5*t^2 - 0.2*t^3", "cos(0.7*t)"};
  for (int k = 0; k < 3; ++k) m.position[k] = laws::make_scaled(spread[k], laws::make_expression(paths[k]));
  m.rotation = motion::exp_so3(Vec3<double>{{0.3, -0.4, 0.2}});
  m.turns.push_back({{{0.6, 0.0, 0.8}}, laws::make_expression("0.9*sin(1.1*t) + t")});
  m.turns.push_back({{{0.0, 1.0, 0.0}}, laws::make_expression("0.3*t^2")});
  scene::FrameDef f;
  f.name = name;
  f.placement = {scene::motion_at(m, 0.0).pose, parent};
  f.motion = m;
  return f;
}

/// road - vehicle - mast - dish, and a cart on the road.
scene::Scene scene_seen_from(const std::string& ground) {
  scene::Scene s;
  s.frames = {frame("dish", "mast", {{1, 0, 1}}), frame("mast", "vehicle", {{0, 2, 1}}),
              frame("road", "", {{0.1, 0.2, 1}}), frame("vehicle", "road", {{3, 2, 1}}),
              frame("cart", "road", {{1, 1, 0}})};
  scene::Body b;
  b.name = "body";
  b.mass = 1.0;
  s.bodies = {b};
  s.analysis.frame = ground;
  return s;
}

FrameMotions motions_at(const Plan& plan, double t) {
  std::vector<lanes::Taylor<double, 3>> series;
  for (const LawPlan& l : plan.laws) {
    constexpr double d = 1e-4;
    const laws::LawValue v = l.law.at(t);
    series.emplace_back(v.value);
    series.back().c[1] = v.rate;
    series.back().c[2] = 0.5 * v.acceleration;
    series.back().c[3] = (l.law.at(t + d).acceleration - l.law.at(t - d).acceleration) / (12.0 * d);
  }
  FrameMotions m;
  eval_frames(plan, series.data(), m);
  return m;
}

/// Motion of a frame in the inertial one by the chain.
FrameMotion by_chain(const scene::Scene& s, const std::string& name, double t) {
  std::vector<FrameMotion> links;
  for (std::string at = name; !at.empty();) {
    const auto f = std::find_if(s.frames.begin(), s.frames.end(), [&](const auto& g) { return g.name == at; });
    links.insert(links.begin(), scene::motion_at(*f->motion, t));
    at = f->placement.frame;
  }
  const motion::FrameChain chain(links);
  return motion::relative_motion(chain, motion::Of(chain.last()), motion::RelativeTo(0));
}

/// b in a, both in the inertial frame.
FrameMotion relative(const FrameMotion& a, const FrameMotion& b) {
  FrameMotion up;  // the inertial frame in a, by differentiating H_a^-1
  const motion::FrameChain chain({a});
  up = motion::relative_motion(chain, motion::Of(0), motion::RelativeTo(1));
  const motion::FrameChain both({up, b});
  return motion::relative_motion(both, motion::Of(2), motion::RelativeTo(0));
}

double difference(const Vec3<double>& a, const Vec3<double>& b) {
  const Vec3<double> d = a - b;
  return std::sqrt(lanes::dot(d, d));
}

void expect_equal(const elements::CarrierMotion& got, const FrameMotion& expected) {
  constexpr double round_off = 2e-13;  // of sums of some tens of terms up to 40
  const FrameMotion m = motion::motion_from_twist(got.pose, got.twist, got.twist_rate);
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(m.pose.R.m[i], expected.pose.R.m[i], round_off);
  EXPECT_LT(difference(m.pose.x, expected.pose.x), round_off);
  EXPECT_LT(difference(m.velocity, expected.velocity), round_off);
  EXPECT_LT(difference(m.acceleration, expected.acceleration), 10 * round_off);
  EXPECT_LT(difference(m.angular_velocity, expected.angular_velocity), round_off);
  EXPECT_LT(difference(m.angular_acceleration, expected.angular_acceleration), 10 * round_off);
}

const elements::CarrierMotion& of(const Plan& plan, const FrameMotions& m, const std::string& name) {
  const auto f =
      std::find_if(plan.frames.begin(), plan.frames.end(), [&](const FramePlan& g) { return g.name == name; });
  return m.in_ground.at(static_cast<std::size_t>(f - plan.frames.begin()));
}

TEST(PlanFrames, move_in_the_inertial_frame_as_their_chain_does) {
  const scene::Scene s = scene_seen_from("");
  const Plan plan = make_plan(s);
  for (const double t : {0.0, 0.8, 2.1}) {
    const FrameMotions m = motions_at(plan, t);
    for (const char* name : {"road", "vehicle", "mast", "dish", "cart"}) {
      SCOPED_TRACE(name);
      expect_equal(of(plan, m, name), by_chain(s, name, t));
    }
  }
}

TEST(PlanFrames, move_in_the_observers_frame_as_seen_from_it) {
  scene::Scene s = scene_seen_from("vehicle");
  const Plan plan = make_plan(s);
  const double t = 1.3;
  const FrameMotions m = motions_at(plan, t);
  const FrameMotion vehicle = by_chain(s, "vehicle", t);
  expect_equal(m.observer, vehicle);
  expect_equal(of(plan, m, "vehicle"), FrameMotion{});
  for (const char* name : {"road", "mast", "dish", "cart"}) {
    SCOPED_TRACE(name);
    expect_equal(of(plan, m, name), relative(vehicle, by_chain(s, name, t)));
  }
}

TEST(PlanFrames, tell_the_second_derivative_of_their_twist) {
  const Plan plan = make_plan(scene_seen_from("vehicle"));
  constexpr double t = 1.3, d = 1e-4;
  const FrameMotions now = motions_at(plan, t), after = motions_at(plan, t + d), before = motions_at(plan, t - d);
  for (std::size_t f = 0; f < plan.frames.size(); ++f)
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR(now.in_ground[f].twist_second[i],
                  (after.in_ground[f].twist_rate[i] - before.in_ground[f].twist_rate[i]) / (2.0 * d), 1e-5);
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(now.observer.twist_second[i],
                (after.observer.twist_rate[i] - before.observer.twist_rate[i]) / (2.0 * d), 1e-5);
}

TEST(PlanFrames, are_left_out_where_none_moves) {
  scene::Scene s = scene_seen_from("");
  for (scene::FrameDef& f : s.frames) f.motion.reset();
  EXPECT_TRUE(make_plan(s).frames.empty());
}

}  // namespace
}  // namespace bough::plan
