#pragma once
/// A scene with its plan, system and state; the same in a system with fewer unknowns.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bough/schedule/serial.hpp"
#include "bough/step/advance.hpp"

namespace bough::test {

struct Rig {
  scene::Scene scene;
  plan::Plan plan;
  step::System system;
  step::State state;
  explicit Rig(const scene::Scene& s, const tree::Walker& walker = schedule::make_serial_walker())
      : scene(s),
        plan(plan::make_plan(scene)),
        system(plan, scene.solver, walker),
        state(step::make_initial_state(plan)) {}

  /// The nodes in space.
  const std::vector<elements::NodeMotion>& nodes() const { return nodes_in_space(system.plan(), state); }

  /// A consistent start and steps of generalized-alpha.
  void run(int steps, double h) {
    const step::StepOptions options = step::make_step_options(scene.analysis);
    ASSERT_TRUE(step::make_consistent(system, state, true, 1e-3).ok);
    ASSERT_TRUE(step::start_alpha(system, state, options, h).ok);
    for (int k = 1; k <= steps; ++k) {
      const step::StepReport report = step::advance(system, state, options, k * h);
      ASSERT_TRUE(report.converged) << report.cause;
    }
  }
};

/// Nodes of two states on the same group, bit by bit.
inline void expect_same_nodes(const step::State& a, const step::State& b) {
  a.visit([&b]<class G>(const step::NodesOn<G>& nodes) {
    const step::NodesOn<G>& others = b.on<G>();
    ASSERT_EQ(nodes.motion.size(), others.motion.size());
    const auto* x = reinterpret_cast<const double*>(nodes.motion.data());
    const auto* y = reinterpret_cast<const double*>(others.motion.data());
    for (std::size_t i = 0; i < nodes.motion.size() * elements::numbers_of_node<G>; ++i) EXPECT_EQ(x[i], y[i]);
    for (std::size_t n = 0; n < nodes.motion.size(); ++n)
      for (int i = 0; i < G::dof; ++i) {
        EXPECT_EQ(nodes.algorithmic[n][i], others.algorithmic[n][i]);
        EXPECT_EQ(nodes.acceleration_trend[n][i], others.acceleration_trend[n][i]);
      }
  });
}

/// A vector of the system with fewer unknowns, in the unknowns of the system with more; the additional ones are zero.
inline std::vector<double> expand(const Rig& fewer, const Rig& more, const std::vector<double>& x) {
  std::vector<double> out(more.system.places().size(), 0.0);
  for (std::size_t n = 0; n < fewer.plan.nodes.size(); ++n)
    more.system.places().set_node_part(out.data(), static_cast<int>(n),
                                       fewer.system.places().node_part(x.data(), static_cast<int>(n)));
  for (std::size_t j = 0; j < fewer.plan.joints.size(); ++j) {
    const plan::JointPlan &from = fewer.plan.joints[j], &to = more.plan.joints[j];
    for (std::size_t r = 0; r < from.rows.size() && from.block >= 0; ++r) {
      const auto row = std::find(to.rows.begin(), to.rows.end(), from.rows[r]) - to.rows.begin();
      out[static_cast<std::size_t>(more.system.places().block_begin(to.block) + row)] =
          x[static_cast<std::size_t>(fewer.system.places().block_begin(from.block)) + r];
    }
  }
  return out;
}

}  // namespace bough::test
