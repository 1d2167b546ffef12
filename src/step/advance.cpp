#include "bough/step/advance.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "newton.hpp"
#include "planar_step.hpp"
#include "system_parts.hpp"

namespace bough::step {

using motion::Vec6;

namespace {

constexpr double largest_turn =
    2.8;  ///< rotation of a node in one step [rad]: below pi, where the logarithm is no longer unique

bool turns_far(const elements::NodeMotion& node) {
  const motion::Vec3<double> turn = lanes::angular_part(node.dq);
  return lanes::dot(turn, turn) > largest_turn * largest_turn;
}

/// A step by the rule from a start, in space or in the plane.
struct Integrator {
  AlphaRule rule;
  const State& start;

  std::optional<Trouble> follow(const System& system, State& state) const {
    if (const PlanarStep* plane = system.planar_step(); plane != nullptr && plane->is_under_way()) {
      const int far = plane->turned_beyond(largest_turn);
      return far < 0 ? std::nullopt : std::optional(describe_turn(system, static_cast<std::size_t>(far)));
    }
    std::atomic<bool> turned_far = false;
    auto by_node = [&](std::int64_t begin, std::int64_t end) {
      for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
        elements::NodeMotion& node = state.nodes[n];
        const auto rates = rule.follow(node.dq, start.nodes[n].v, start.nodes[n].a, start.algorithmic[n]);
        node.v = rates.v;
        node.a = rates.a;
        state.algorithmic[n] = rates.algorithmic;
        if (turns_far(node)) turned_far = true;
      }
    };
    system.walker().for_each_chunk(static_cast<std::int64_t>(state.nodes.size()), block_grain,
                                   tree::make_chunk(by_node));
    if (!turned_far) return std::nullopt;
    const auto far = std::find_if(state.nodes.begin(), state.nodes.end(), turns_far);
    return describe_turn(system, static_cast<std::size_t>(far - state.nodes.begin()));
  }

  /// Predictor: dv/dt goes on as the polynomial through past ones that would have been nearest last; a_{n+1} follows. So do
  /// multipliers: the first solution would find them whatever they were, but an old factor the better the nearer they
  /// are. Writes all of `state`, its nodes in one pass over the start.
  void predict(System& system, State& state, bool in_plane, bool is_end) const {
    state.step_size = start.step_size;
    system.predict_multipliers(start, state);
    state.turns = start.turns;
    state.behind = 0;
    if (in_plane) return system.planar_step()->enter(start, is_end, rule, system.walker());
    state.nodes.resize(start.nodes.size());
    state.rotation.resize(start.nodes.size());
    state.algorithmic.resize(start.nodes.size());
    auto by_node = [&](std::int64_t begin, std::int64_t end) {
      Vec6<double> eta[nodes_in_lanes];
      for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); n += nodes_in_lanes) {
        const std::size_t some = std::min(nodes_in_lanes, static_cast<std::size_t>(end) - n);
        for (std::size_t i = 0; i < some; ++i) {
          const elements::NodeMotion& from = start.nodes[n + i];
          const Vec6<double> change =
              predicted_change(start.predictor_order, start.acceleration_trend[n + i], start.trend_change[n + i]);
          eta[i] = rule.predict(from.v, from.a, start.algorithmic[n + i], change);
          state.nodes[n + i] = from;
          state.nodes[n + i].dq = eta[i];
          state.rotation[n + i] = start.rotation[n + i];
        }
        move_nodes(state, n, some, eta, false);
      }
    };
    system.walker().for_each_chunk(static_cast<std::int64_t>(start.nodes.size()), block_grain,
                                   tree::make_chunk(by_node));
  }

 private:
  static Trouble describe_turn(const System& system, std::size_t node) {
    return {"'" + system.plan().nodes[node].name + "' turns by nearly half a turn in one step"};
  }
};

/// What the next step goes by: its predictor, and how far it iterates. Angular accelerations count by the arm that turns
/// them into linear ones.
void note_end(System& system, const AlphaRule& rule, const State& start, State& state) {
  const double arm = system.moment_arm(), per_length = 1.0 / system.plan().length_scale;
  std::vector<Workspace::StepEnd>& parts = system.work().step_ends;
  const std::size_t count = state.nodes.size();
  state.acceleration_trend.resize(count);
  state.trend_change.resize(count);
  parts.resize((count + block_grain - 1) / block_grain);
  const auto square = [arm](const Vec6<double>& a) {
    return lanes::dot(lanes::linear_part(a), lanes::linear_part(a)) +
           arm * arm * lanes::dot(lanes::angular_part(a), lanes::angular_part(a));
  };
  const auto include = [per_length](double& most, const Vec6<double>& v) {
    for (int i = 0; i < 6; ++i) most = std::max(most, (i < 3 ? per_length : 1.0) * std::abs(v[i]));
  };
  auto by_node = [&](std::int64_t begin, std::int64_t end) {
    Workspace::StepEnd part;
    for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
      const elements::NodeMotion& node = state.nodes[n];
      const Vec6<double> now = node.a - start.nodes[n].a;
      const Vec6<double> of_trend = now - start.acceleration_trend[n];
      part.misses[0] += square(now);
      part.misses[1] += square(of_trend);
      part.misses[2] += square(of_trend - start.trend_change[n]);
      include(part.error, rule.local_error(now, motion::cross6_times(node.v, node.a)));
      include(part.increment, node.dq);
      state.acceleration_trend[n] = now;
      state.trend_change[n] = of_trend;
    }
    parts[static_cast<std::size_t>(begin / block_grain)] = part;
  };
  system.walker().for_each_chunk(static_cast<std::int64_t>(count), block_grain, tree::make_chunk(by_node));
}

/// The same over all nodes, once Workspace::step_ends tell of all chunks.
void note_whole_end(System& system, const State& start, State& state) {
  Workspace::StepEnd whole;
  for (const Workspace::StepEnd& part : system.work().step_ends) {
    for (std::size_t k = 0; k < whole.misses.size(); ++k) whole.misses[k] += part.misses[k];
    whole.error = std::max(whole.error, part.error);
    whole.increment = std::max(whole.increment, part.increment);
  }
  state.predictor_order = least_missed(whole.misses);
  state.local_error = whole.error;
  state.increment = whole.increment;
  system.note_multipliers(start, state);
}

Integrator make_rule(const StepOptions& options, const State& start) {
  return {{make_alpha_coefficients(options.spectral_radius), start.step_size}, start};
}

/// The predicted state, its laws and velocities.
std::optional<Trouble> enter(System& system, State& state, const Integrator& step, double end_time, bool in_plane,
                             bool is_end) {
  if (auto t = system.set_time(end_time, laws::Side::left)) return t;
  if (step.start.behind != 0 && !(in_plane && system.planar_step()->knows(step.start))) return lost_nodes(step.start);
  step.predict(system, state, in_plane, is_end || step.start.behind != 0);
  state.time = end_time;
  return step.follow(system, state);
}

StepReport try_step(System& system, State& state, State& start, const StepOptions& options, double end_time,
                    const Handover& handover) {
  const Integrator step = make_rule(options, start);
  StepReport report;
  const auto fail = [&](const Trouble& t) {
    if (PlanarStep* plane = system.planar_step()) plane->abandon();
    report.converged = false;
    report.cause = t.text;
    return report;
  };
  PlanarStep* plane = system.planar_step();
  const bool stays = plane != nullptr && plane->joints_with_angles().empty();  // these are looked at in space
  if (const auto t = enter(system, state, step, end_time, plane != nullptr, stays && handover.is_untouched))
    return fail(*t);
  report = iterate(system, state, options, make_goal(start), step.rule.slopes(),
                   [&](State& s) { return step.follow(system, s); });
  if (!report.converged) return fail({report.cause});
  const bool is_read = handover.is_read || !stays;
  if (plane == nullptr) {
    if (const auto t = check_shape(system, state)) return fail(*t);
    note_end(system, step.rule, start, state);
  } else {
    if (const auto t = check_folds_in_plane(system)) return fail(*t);
    plane->finish(system.moment_arm(), system.work().step_ends, system.walker());
    if (is_read)
      plane->write(state, system.walker());
    else
      plane->keep(start, state);
    if (const auto t = check_flips_in_plane(system, state)) return fail(*t);
  }
  note_whole_end(system, start, state);
  if (is_read) system.recover_multipliers(state);
  return report;
}

}  // namespace

std::optional<Trouble> predict(System& system, State& state, const StepOptions& options, double end_time,
                               elements::Slopes& slopes) {
  const State start = state;
  const Integrator step = make_rule(options, start);
  slopes = step.rule.slopes();
  return enter(system, state, step, end_time, false, false);
}

StepReport advance(System& system, State& state, const StepOptions& options, double end_time,
                   const Handover& handover) {
  State& start = system.work().start;
  std::swap(state, start);
  StepReport report = try_step(system, state, start, options, end_time, handover);
  if (!report.converged) std::swap(state, start);
  return report;
}

}  // namespace bough::step
