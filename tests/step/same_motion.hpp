#pragma once
/// The same scene with a decision of its plan taken and barred: steps of both, and whether their states agree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "bough/step/integrator.hpp"
#include "small_scenes.hpp"
#include "support/rig.hpp"

namespace bough::test {

inline scene::Body block(const std::string& name, double x, double y, double z) {
  scene::Body b;
  b.name = name;
  b.mass = 0.7;
  b.inertia = motion::Mat3<double>::identity();
  b.center_of_mass = {{0.01, 0.02, -0.03}};
  b.placement.pose.x = {{x, y, z}};
  return b;
}

/// The hinge by which a body "block" carries one named "arm".
inline scene::Joint make_arm_hinge() {
  scene::Joint hinge;
  hinge.name = "arm's hinge";
  hinge.kind = scene::JointKind::revolute;
  hinge.first.to = "block";
  hinge.second.to = "arm";
  hinge.first.offset.x = {{0.2, 0.0, 0.0}};
  hinge.second.offset.x = {{-0.3, 0.0, -0.2}};
  return hinge;
}

/// Poses, velocities, accelerations and multipliers at random, the same in a system and in one with more unknowns.
inline void stir(Rig& fewer, Rig& whole) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto any = [&](double size) {
    motion::Vec6<double> v;
    for (int i = 0; i < 6; ++i) v[i] = size * uniform(random);
    return v;
  };
  for (std::size_t n = 0; n < fewer.plan.nodes.size(); ++n) {
    const motion::Vec6<double> eta = any(0.05), v = any(1.0), a = any(10.0);
    if (fewer.plan.block_of_node[n] < 0) continue;
    for (Rig* rig : {&fewer, &whole}) {
      step::move_node(rig->plan, rig->state, n, eta);
      step::set_velocity(rig->plan, rig->state, n, v);
      step::set_acceleration(rig->plan, rig->state, n, a);
    }
  }
  for (std::size_t m = 0; m < fewer.state.multipliers.size(); ++m)
    fewer.state.multipliers[m] = whole.state.multipliers[m] = 10.0 * uniform(random);
}

inline double largest(const std::vector<double>& v) {
  double most = 0.0;
  for (double x : v) most = std::max(most, std::abs(x));
  return most;
}

/// Places are rounded by eps |x| / 2 at both ends of an element, in each of the two runs that are compared, and the
/// stiffest element answers with EA / L times that: forces that kernels with other arithmetic (planar, in lanes) give
/// at the same state differ by as much.
inline double rounding_of_forces(const Rig& rig) {
  return rig.scene.sections.empty() ? 0.0 : 8.4e7 / 0.5 * 2.0 * 2.2e-16 * rig.plan.length_scale;
}

inline void expect_equal(const Rig& a, const Rig& b, double tolerance) {
  double size = 0.0, speed = 0.0;
  for (const elements::NodeMotion& n : b.nodes())
    for (int i = 0; i < 6; ++i) {
      speed = std::max(speed, std::abs(n.v[i]));
      size = std::max(size, std::abs(n.a[i]));
    }
  const double h = b.state.step_size;  // 0 before the first step
  // Places are rounded in each step, and accelerations hold their increments dq / (beta h^2). What a step has left in
  // the accelerations of stiff modes decays by the spectral radius in each of the following ones, of which there are
  // 20: 4.9 times the rounding of one step. HeldNodes.move_nothing_else_in_time differs by 2.0 to 3.4 times.
  const double radius = b.scene.analysis.spectral_radius;
  double steps = 0.0;
  for (int k = 0; k < 20; ++k) steps = 1.0 + radius * steps;
  const double beta = step::make_alpha_coefficients(radius).beta;
  const double rounding = h > 0.0 ? steps * 2.2e-16 * b.plan.length_scale / (beta * h * h) : 0.0;
  for (std::size_t n = 0; n < a.plan.nodes.size(); ++n)
    for (int i = 0; i < 6; ++i) {
      if (i < 3) {
        EXPECT_NEAR(a.nodes()[n].x.hi[i], b.nodes()[n].x.hi[i], tolerance);
      }
      EXPECT_NEAR(a.nodes()[n].v[i], b.nodes()[n].v[i], tolerance * speed);
      EXPECT_NEAR(a.nodes()[n].a[i], b.nodes()[n].a[i], tolerance * size + rounding);
    }
  const double allowed = tolerance * largest(b.state.multipliers) + rounding_of_forces(b);
  for (std::size_t m = 0; m < a.state.multipliers.size(); ++m)
    EXPECT_NEAR(a.state.multipliers[m], b.state.multipliers[m], allowed) << "multiplier " << m;
}

/// Of the variational integrator; others have none.
inline void expect_near_momenta(const step::State& a, const step::State& b, double tolerance) {
  a.visit([&]<class G>(const step::NodesOn<G>& nodes) {
    for (std::size_t n = 0; n < nodes.momentum.size(); ++n)
      for (int i = 0; i < G::dof; ++i) EXPECT_NEAR(nodes.momentum[n][i], b.on<G>().momentum[n][i], tolerance);
  });
}

/// 20 steps by the integrator of the scene. Returns the iterations that they took.
inline int take_steps(Rig& rig, double h) {
  const step::StepOptions options = step::make_step_options(rig.scene.analysis);
  const std::unique_ptr<step::Integrator> integrator = step::make_integrator(rig.system, rig.scene.solver, options);
  const step::StartReport started = integrator->start(rig.state, options, h);
  EXPECT_TRUE(started.ok) << started.cause;
  int iterations = 0;
  for (int k = 1; k <= 20; ++k) {
    const step::StepReport report = integrator->advance(rig.state, options, k * h);
    EXPECT_TRUE(report.converged) << report.cause;
    step::accept_turns(rig.system, rig.state);
    iterations += report.iterations;
  }
  return iterations;
}

}  // namespace bough::test
