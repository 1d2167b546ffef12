// The cost of a plan is in proportion to its scene, whatever is in it. Each list was once gone through for every
// element.
#include "support/growth.hpp"

#include <gtest/gtest.h>

#include "../step/small_scenes.hpp"
#include "bough/laws/make_law.hpp"
#include "bough/plan/plan.hpp"

namespace bough::plan {
namespace {

using scene::Frame;
using scene::Mat3;
using scene::Scene;
using scene::Vec3;

Frame at(double x, double y = 0.0) { return {Mat3::identity(), Vec3{{x, y, 0.0}}}; }
std::string name(const char* stem, int i) { return stem + std::to_string(i); }

/// A row of n beams between n + 1 nodes, the first of them held.
Scene row_of_beams(int n) {
  Scene s;
  s.sections.push_back(test::make_bar_section());
  for (int i = 0; i <= n; ++i) s.nodes.push_back({name("n", i), {at(i), ""}});
  for (int i = 0; i < n; ++i) {
    scene::Beam b;
    b.name = name("b", i);
    b.section = s.sections.back().name;
    b.start = name("n", i);
    b.end = name("n", i + 1);
    s.beams.push_back(b);
  }
  scene::Joint j;
  j.name = "wall";
  j.second.to = "n0";
  s.joints.push_back(j);
  s.analysis.end_time = 1.0;
  return s;
}

void expect_linear(const std::function<void(Scene&, int)>& add, int size = 1500) {
  const auto prepare = [&](int n) -> std::function<void()> {
    Scene s = row_of_beams(n);
    add(s, n);
    return [s] { EXPECT_GT(make_plan(s).nodes.size(), 0u); };
  };
  EXPECT_LT(test::growth_by_sixteen(prepare, size / 4), test::linear_by_sixteen);
}

TEST(PlanGrowth, of_line_loads_and_sections) {
  expect_linear([](Scene& s, int n) {
    for (int i = 0; i < n; ++i) {
      s.sections.push_back(test::make_bar_section());
      s.sections.back().name = s.beams[static_cast<std::size_t>(i)].section = name("s", i);
      scene::LineLoad l;
      l.name = name("l", i);
      l.beam = name("b", i);
      l.force = {{0.0, -1.0, 0.0}};
      s.line_loads.push_back(l);
    }
  });
}

TEST(PlanGrowth, of_sensors_and_initial_velocities) {
  expect_linear([](Scene& s, int n) {
    for (int i = 0; i < n; ++i) {
      scene::Sensor sensor;
      sensor.name = name("force", i);
      sensor.kind = scene::SensorKind::section_force;
      sensor.beam = name("b", i);
      s.sensors.push_back(sensor);
      scene::InitialVelocity v;
      v.of = name("n", i);
      v.velocity = {{0.0, 1.0, 0.0}};
      s.initial_velocities.push_back(v);
    }
  });
}

TEST(PlanGrowth, of_bodies_joints_and_their_sensors) {
  expect_linear([](Scene& s, int n) {
    for (int i = 0; i < n; ++i) {
      scene::Body b;
      b.name = name("p", i);
      b.mass = 1.0;
      b.inertia = Mat3::identity();
      b.placement.pose = at(i, 1.0);
      s.bodies.push_back(b);
      scene::Joint j;
      j.name = name("j", i);
      j.kind = scene::JointKind::revolute;
      j.first = {name("n", i), at(0.0, 1.0)};
      j.second.to = b.name;
      s.joints.push_back(j);
      scene::Sensor sensor;
      sensor.name = name("angle", i);
      sensor.kind = scene::SensorKind::joint_angle;
      sensor.joint = j.name;
      s.sensors.push_back(sensor);
    }
  });
}

/// Point masses on rods, each held in one line: its inertia was looked for among all bodies.
TEST(PlanGrowth, of_point_masses_met_beside_their_origins) {
  expect_linear([](Scene& s, int n) {
    for (int i = 0; i < n; ++i) {
      scene::Body b;
      b.name = name("p", i);
      b.is_point_mass = true;
      b.mass = 1.0;
      b.placement.pose = at(i, 1.0);
      s.bodies.push_back(b);
      scene::Joint j;
      j.name = name("j", i);
      j.kind = scene::JointKind::spherical;
      j.first.to = name("n", i);
      j.second = {b.name, at(0.0, -1.0)};
      s.joints.push_back(j);
    }
  });
}

/// Bodies that the ground holds, tied to each other in pairs: each was the start of a search with a mark for every
/// node.
TEST(PlanGrowth, of_nodes_that_are_held) {
  expect_linear(
      [](Scene& s, int n) {
        for (int i = 0; i < n; ++i) {
          scene::Body b;
          b.name = name("p", i);
          b.mass = 1.0;
          b.inertia = Mat3::identity();
          b.placement.pose = at(i, 1.0);
          s.bodies.push_back(b);
          scene::Joint j;
          j.name = name("j", i);
          j.first.offset = b.placement.pose;
          j.second.to = b.name;
          s.joints.push_back(j);
        }
      },
      1500);
}

/// Parts that nothing moves: every name was looked at for every part.
TEST(PlanGrowth, of_idle_parts) {
  expect_linear([](Scene& s, int n) {
    for (int i = 0; i < n; ++i) {
      for (const char* stem : {"p", "q"}) {
        scene::Body b;
        b.name = name(stem, i);
        b.mass = 1.0;
        b.inertia = Mat3::identity();
        b.placement.pose = at(i, stem[0] == 'p' ? 1.0 : 2.0);
        s.bodies.push_back(b);
      }
      scene::Joint j;
      j.name = name("j", i);
      j.first = {name("p", i), at(0.0, 1.0)};
      j.second.to = name("q", i);
      s.joints.push_back(j);
    }
  });
}

TEST(PlanGrowth, of_frames_that_move_in_each_other) {
  expect_linear([](Scene& s, int n) {
    for (int i = 0; i < n; ++i) {
      scene::FrameDef f;
      f.name = name("f", i);
      f.placement = {at(0.01), i == 0 ? "" : name("f", i - 1)};
      f.motion.emplace();
      f.motion->name = f.name;
      f.motion->position[0] = laws::make_harmonic(0.01, 1.0, 0.1);
      s.frames.push_back(f);
    }
  });
}

}  // namespace
}  // namespace bough::plan
