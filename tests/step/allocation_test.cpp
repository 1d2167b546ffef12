#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "bough/schedule/serial.hpp"
#include "bough/step/advance.hpp"
#include "small_scenes.hpp"
#include "support/given.hpp"

namespace {
long allocations = 0;
}

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // they do match: gcc sees only one of them inlined
#endif

// Counts every allocation of the program; freed with free.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size > 0 ? size : 1)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void* operator new(std::size_t size, std::align_val_t align) {
  ++allocations;
  const auto a = static_cast<std::size_t>(align);
  if (void* p = std::aligned_alloc(a, (size + a - 1) / a * a)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace bough::step {
namespace {

long allocations_of_steps(const scene::Scene& scene, int steps) {
  const plan::Plan plan = plan::make_plan(scene);
  System system(plan, scene.solver, schedule::make_serial_walker());
  State state = make_initial_state(plan);
  StepOptions options = make_step_options(scene.analysis);
  EXPECT_TRUE(make_consistent(system, state, true, 1e-3).ok);
  EXPECT_TRUE(start_alpha(system, state, options, 1e-3).ok);
  State before = state;
  EXPECT_TRUE(advance(system, state, options, 1e-3).converged);
  const long first = allocations;
  for (int k = 2; k < 2 + steps; ++k) {
    before = state;
    if (!advance(system, state, options, k * 1e-3).converged) return -1;
    if (check_shape(system, state)) return -1;
    accept_turns(system, state);
    (void)system.constraints().violation(state, 1);
  }
  return allocations - first;
}

TEST(Advance, allocates_nothing_after_the_first_step_of_a_flexible_chain) {
  EXPECT_EQ(allocations_of_steps(test::make_chain(6), 20), 0);
}

TEST(Advance, allocates_nothing_after_the_first_step_with_elements_of_higher_order) {
  EXPECT_EQ(allocations_of_steps(test::make_chain(2, 3), 5), 0);
}

TEST(Advance, allocates_nothing_after_the_first_step_of_a_chain_that_is_clamped) {
  scene::Scene scene = test::make_chain(4, 2);
  scene.joints[0].kind = scene::JointKind::fixed;
  ASSERT_EQ(plan::make_plan(scene).held.size(), 1u);
  EXPECT_EQ(allocations_of_steps(scene, 20), 0);
}

TEST(Advance, allocates_nothing_after_the_first_step_of_a_chain_that_is_driven) {
  for (bool is_planar : {false, true}) {
    scene::Scene scene = test::make_chain(4, 2);
    if (!is_planar) scene.without = {"planar"};
    scene.joints[0].drives.emplace_back();
    scene.joints[0].drives[0].coordinate = "angle";
    scene.joints[0].drives[0].law = laws::make_harmonic(0.4, 6.0);
    EXPECT_EQ(allocations_of_steps(scene, 20), 0);
  }
}

/// A motor with a lag, a reading of an angle and one of its rate.
TEST(Advance, allocates_nothing_after_the_first_step_of_a_chain_that_signals_drive) {
  for (bool is_planar : {false, true}) {
    scene::Scene scene = test::make_chain(4, 2);
    if (!is_planar) scene.without = {"planar"};
    const auto add = [&scene](const std::string& name, scene::SignalKind kind) -> scene::Signal& {
      scene.signals.emplace_back();
      scene.signals.back().name = name;
      scene.signals.back().kind = kind;
      return scene.signals.back();
    };
    add("angle", scene::SignalKind::joint_angle).joint = scene.joints[0].name;
    add("rate", scene::SignalKind::joint_rate).joint = scene.joints[0].name;
    scene::Signal& torque = add("torque", scene::SignalKind::state);
    torque.inputs = {"angle", "rate", "torque"};
    torque.formula = laws::Formula("(-5*angle - rate - torque)/0.01", torque.inputs);
    scene.joints[0].forces.emplace_back();
    scene.joints[0].forces.back().coordinate = "angle";
    scene.joints[0].forces.back().signal = "torque";
    ASSERT_EQ(plan::make_plan(scene).signals.size(), 3u);
    EXPECT_EQ(allocations_of_steps(scene, 20), 0);
  }
}

/// Described in a frame that turns, with its last link tied to another one.
TEST(Advance, allocates_nothing_after_the_first_step_in_moving_frames) {
  scene::Scene scene = test::make_chain(4);
  for (const char* name : {"table", "hook"}) {
    scene::FrameDef frame;
    frame.name = name;
    frame.motion = scene::MovingFrame{};
    frame.motion->turns.push_back({{{0.0, 0.0, 1.0}}, laws::make_harmonic(0.3, 2.0, 0.0, 0.0)});
    scene.frames.push_back(frame);
  }
  scene.frames[1].placement.frame = "table";
  support::GivenSpring spring;
  spring.name = "rope";
  spring.first.to = "hook";
  spring.first.offset.x = {{3.0, 1.0, 0.0}};
  spring.second.to = "b3";
  spring.stiffness = 50.0;
  spring.rest_length = 1.0;
  scene.couplings.push_back(spring);
  scene.analysis.frame = "table";
  EXPECT_EQ(allocations_of_steps(scene, 20), 0);
}

TEST(Equilibrate, allocates_nothing_after_the_first_load_step) {
  scene::Scene scene = test::make_chain(1, 3);
  scene.analysis.kind = scene::AnalysisKind::statics;
  scene.joints[0].kind = scene::JointKind::fixed;
  const plan::Plan plan = plan::make_plan(scene);
  System system(plan, scene.solver, schedule::make_serial_walker());
  State state = make_initial_state(plan);
  const StepOptions options = make_step_options(scene.analysis);
  ASSERT_TRUE(equilibrate(system, state, options, 0.5).converged);
  const long first = allocations;
  const StepReport second = equilibrate(system, state, options, 1.0);
  EXPECT_EQ(allocations, first);
  EXPECT_TRUE(second.converged);
}

}  // namespace
}  // namespace bough::step
