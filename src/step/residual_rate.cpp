#include "bough/step/residual_rate.hpp"

#include <array>

#include "element_parts.hpp"

namespace bough::step {

namespace {

template <class G>
void add_rates(System& system, const State& state, double step_size, const std::vector<double>* jerk,
               std::vector<double>& rate) {
  using T = lanes::Taylor<double, 1>;
  const plan::Plan& plan = system.plan();
  const Instant& instant = system.instant();
  elements::FieldOn<G, double> f = instant.field_on<G>(state);
  std::vector<T> laws = instant.rate_series();
  std::vector<double> second;
  system.signals().add_rates(state, laws, second);
  for (std::size_t i = 0; i < system.places().signals().size(); ++i) rate[system.places().signals()[i]] = -second[i];
  const T strength = laws[static_cast<std::size_t>(plan.gravity_law)];
  motion::Vec3<T> gravity;
  for (int k = 0; k < 3; ++k) gravity[k] = plan.gravity[k] * strength;
  if constexpr (G::has_moving_frames) {
    if (!plan.frames.empty()) {
      const plan::FrameMotions& frames = instant.frame_series(step_size);
      f.carriers = frames.in_ground.data();
      if (f.observer != nullptr) {
        f.observer = &frames.observer;
        motion::Vec3<T> turning = lanes::cast<T>(lanes::angular_part(f.observer->twist));
        gravity = lanes::cast<T>(lanes::transpose_times(f.observer->pose.R, plan.gravity));
        for (int k = 0; k < 3; ++k) gravity[k].c[1] = -lanes::cross(turning, gravity)[k].c[0];  // (R^T g)' = -w x R^T g
        gravity = strength * gravity;
      }
    }
  }
  elements::SurroundingsOn<G, T> around;
  if constexpr (G::has_moving_frames)
    around.gravity = gravity;
  else
    around.gravity = plan::along_axes<G>(plan, gravity);
  around.laws = laws.data();
  around.has_inertia = plan.is_dynamic;
  std::array<double, most_unknowns> part;
  std::array<double, elements::max_rows> scratch;
  for (std::size_t e = 0; e < plan.directory.size(); ++e) {
    part.fill(0.0);
    const int j = plan.joint_of_element[e];
    const plan::JointPlan* const joint = plan.joint_of(e);
    const double* multipliers = joint == nullptr ? nullptr : multipliers_on<G>(*joint, state, scratch.data());
    const double turns = joint == nullptr ? 0.0 : state.turns[static_cast<std::size_t>(j)];
    const double* from = part.data();
    plan::with_element(plan::arrays_on<G>(plan), plan.directory[e], [&](const auto& element) {
      using E = std::decay_t<decltype(element)>;
      typename G::template Vector<double> jerks[E::num_ports];
      if (jerk != nullptr)
        for (int k = 0; k < E::num_ports; ++k) {
          const int node = element.ports[k].node;
          if (node != elements::ground) jerks[k] = system.places().part_on<G>(jerk->data(), node);
        }
      elements::evaluate_rate(element, f, around, multipliers, turns, jerk == nullptr ? nullptr : jerks, part.data());
    });
    for_each_part(plan, e, [&](int block, int size, int node) {
      for (int i = 0; i < num_kept(plan, block, size, node); ++i)
        rate[static_cast<std::size_t>(system.places().block_begin(block) + i)] += from[i];
      from += size;
    });
  }
}

}  // namespace

void evaluate_rate(System& system, const State& state, std::vector<double>& rate, double step_size,
                   const std::vector<double>* jerk) {
  rate.assign(system.places().size(), 0.0);
  state.visit([&]<class G>(const NodesOn<G>&) { add_rates<G>(system, state, step_size, jerk, rate); });
}

}  // namespace bough::step
