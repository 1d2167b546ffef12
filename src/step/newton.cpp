#include "newton.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>

#include "bough/elements/limits.hpp"
#include "element_parts.hpp"

namespace bough::step {

namespace {

/// Round-off varies from step to step: a residual up to this multiple of the one that was recorded as round-off is
/// taken for round-off, too.
constexpr double noise_spread = 1.5;

/// The floor sum |K| eps |coordinates| counts one rounding of each coordinate. The evaluation of a residual rounds
/// several times (poses, relative motions, sums over elements), so a residual of up to this many floors is accepted
/// above the tolerance.
constexpr double roundings = 16.0;

/// Largest residual, relative to the sum of the magnitudes of its terms, that meets a goal whatever the motion left
/// out.
constexpr double least_residual = 1e-13;

}  // namespace

ResidualSize residual_of(const System& system) {
  ResidualSize r = system.residual_size();
  const double disagreement = system.plan().disagreement();
  if (!(disagreement > 0.0) || system.linear().solver().last_status().deficiency <= 0) return r;
  r.length = std::max(0.0, r.length - disagreement * system.plan().length_scale);
  r.angle = std::max(0.0, r.angle - disagreement);
  return r;
}

double largest_share(const System& system, const ResidualSize& r) {
  const double arm = system.moment_arm();
  constexpr double huge = 1e100;  // larger ratios carry no information and must not overflow
  const auto share = [](double part, double whole) {
    return part == 0.0 ? 0.0 : whole <= part / huge ? huge : part / whole;
  };
  return std::max({share(r.force, std::max(r.force_scale, r.moment_scale / arm)),
                   share(r.moment, std::max(r.moment_scale, r.force_scale * arm)),
                   share(r.length, system.plan().length_scale), r.angle, r.signal});
}

bool is_small(const System& system, const ResidualSize& r, double tolerance) {
  return largest_share(system, r) <= tolerance;
}

IterationGoal make_goal(const State& start, double tolerance) {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  constexpr double share_of_velocity_error = 30.0;  // over the tolerance
  constexpr double roundings_of_increment = 4.0;
  if (!(start.local_error > eps)) return {};
  return {true, share_of_velocity_error * tolerance * start.velocity_error,
          roundings_of_increment * eps * start.increment};
}

bool is_settled(const System& system, const ResidualSize& r, double tolerance, const IterationGoal& goal, double error,
                double share) {
  const double arm = system.moment_arm(), usual = left_open * tolerance;
  const ResidualSize& noise = system.round_off().met().size();
  const auto within = [&](double part, double whole, double rounding, double left) {
    return share * part <= std::max(left * whole, std::min(tolerance * whole, noise_spread * rounding));
  };
  const double force = std::max(r.force_scale, r.moment_scale / arm),
               moment = std::max(r.moment_scale, r.force_scale * arm);
  const auto forces_within = [&](double left) {
    return within(r.force, force, noise.force, left) && within(r.moment, moment, noise.moment, left);
  };
  if (!within(r.length, system.plan().length_scale, 0.0, usual) || !within(r.angle, 1.0, 0.0, usual)) return false;
  if (!within(r.signal, 1.0, 0.0, usual)) return false;
  if (goal.is_set && error <= goal.motion && forces_within(tolerance)) return true;
  if (!forces_within(usual)) return false;
  if (!goal.is_set || error <= goal.round_off || forces_within(least_residual)) return true;
  const ResidualSize& floor = system.round_off().of_poses();
  return share * r.force <= std::max(floor.force, least_residual * force) &&
         share * r.moment <= std::max(floor.moment, least_residual * moment);
}

bool is_noise(const System& system, const ResidualSize& r, double tolerance, double size, double expected) {
  constexpr double too_much = 16.0;  // more than a merely slower contraction explains
  if (size > tolerance || size <= too_much * expected) return false;
  const ResidualSize& floor = system.round_off().floor();
  return r.force <= floor.force && r.moment <= floor.moment;
}

bool is_closed(const System& system, const ResidualSize& r, double tolerance) {
  return r.length <= tolerance * system.plan().length_scale && r.angle <= tolerance &&
         r.signal <= left_open * tolerance;
}

bool is_at_floor(const System& system, const ResidualSize& r, double tolerance) {
  const ResidualSize& floor = system.round_off().floor();
  return r.force <= std::max(roundings * floor.force, tolerance * r.force_scale) &&
         r.moment <= std::max(roundings * floor.moment, tolerance * r.moment_scale) &&
         r.length <= std::max(floor.length, tolerance * system.plan().length_scale) &&
         r.angle <= std::max(floor.angle, tolerance) &&
         r.signal <= std::max(roundings * std::numeric_limits<double>::epsilon(), tolerance);
}

namespace {

/// If this joint is among those whose constraints now depend on each other, the names of the others: " against 'b',
/// 'c'". Else empty.
std::string partners(System& system, int joint) {
  std::string others;
  bool takes_part = false;
  int named = 0;
  for (int b : system.linear().solver().blocks_not_unique()) {
    const int j = system.linear().owners().joint(b);
    takes_part |= j == joint;
    if (j < 0 || j == joint || named == 8) continue;
    others += (named++ == 0 ? " against '" : ", '") + system.plan().joints[static_cast<std::size_t>(j)].name + "'";
  }
  return takes_part ? others : "";
}

}  // namespace

std::string describe(System& system, ResidualSize r, double tolerance) {
  if (r.worst_force_node < 0 && r.worst_moment_node < 0 && r.worst_joint < 0) system.sums().name_worst(r);
  char text[200];
  const double length = system.plan().length_scale;
  if ((r.length > tolerance * length || r.angle > tolerance) && r.worst_joint >= 0) {
    const plan::JointPlan& j = system.plan().joints[static_cast<std::size_t>(r.worst_joint)];
    std::snprintf(text, sizeof text, "%s '%s' stays open by %.3g", j.what.c_str(), j.name.c_str(),
                  std::max(r.length, r.angle));
    return text + partners(system, r.worst_joint);
  }
  if (r.signal > tolerance && r.worst_signal >= 0) {
    std::snprintf(text, sizeof text, "' misses its equation by %.3g of the terms", r.signal);
    return "signal '" + system.plan().signals[static_cast<std::size_t>(r.worst_signal)].name + text;
  }
  const bool force = r.force > tolerance * r.force_scale;
  const int node = force ? r.worst_force_node : r.worst_moment_node;
  if (node < 0) return "the motion still changes";
  std::snprintf(text, sizeof text, "largest unbalanced %s %.3g %s at '%s'", force ? "force" : "moment",
                force ? r.force : r.moment, force ? "N" : "N m",
                system.plan().nodes[static_cast<std::size_t>(node)].name.c_str());
  return text;
}

namespace {

/// The smallest of the numbers that threads note.
template <class Number>
class Smallest {
 public:
  explicit Smallest(Number none) : least_(none) {}
  void note(Number now) {
    Number known = least_.load(std::memory_order_relaxed);
    while (now < known && !least_.compare_exchange_weak(known, now, std::memory_order_relaxed)) {
    }
  }
  Number get() const { return least_.load(std::memory_order_relaxed); }

 private:
  std::atomic<Number> least_;
};

/// The message on the first element that failed the check; none if `bad` is the number of elements.
std::optional<Trouble> describe_shape(const System& system, std::int64_t bad) {
  const plan::Plan& plan = system.plan();
  if (bad == static_cast<std::int64_t>(plan.directory.size())) return std::nullopt;
  const std::string& owner = plan.element_owner[static_cast<std::size_t>(bad)];
  if (system.plan().joint_of_element[static_cast<std::size_t>(bad)] >= 0)
    return Trouble{"joint '" + owner + "' flipped to the opposite pose within one step"};
  return Trouble{"an element of beam '" + owner + "' bends by nearly half a turn; use more elements"};
}

}  // namespace

std::optional<Trouble> check_shape(const System& system, State& state) {
  const plan::Plan& plan = system.plan();
  const auto count = static_cast<std::int64_t>(plan.directory.size());
  Smallest<std::int64_t> first_bad(count);
  Smallest<double> least_margin(std::numeric_limits<double>::infinity());
  const auto look = [&]<class G>(const elements::FieldOn<G, double>& f) {
    auto by_element = [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t id = begin; id < end; ++id)
        plan::with_element(plan::arrays_on<G>(plan), plan.directory[static_cast<std::size_t>(id)], [&](const auto& e) {
          const double margin = elements::eval_shape_margin(e, f);
          least_margin.note(margin);
          if (margin < 0.0) first_bad.note(id);
        });
    };
    system.walker().for_each_chunk(count, element_grain, tree::make_chunk(by_element));
  };
  state.visit([&]<class G>(const NodesOn<G>&) { look(system.instant().field_on<G>(state)); });
  state.shape_margin = plan.frames.empty() ? std::max(least_margin.get(), 0.0) : 0.0;  // frames turn as nodes do
  return describe_shape(system, first_bad.get());
}

void accept_turns(const System& system, State& state) {
  const plan::Plan& plan = system.plan();
  const auto count = [&]<class G>(const elements::FieldOn<G, double>& f) {
    auto by_joint = [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t k = begin; k < end; ++k) {
        const auto j = static_cast<std::size_t>(plan.turning_joints[static_cast<std::size_t>(k)]);
        plan::with_element(plan::arrays_on<G>(plan), plan.directory[static_cast<std::size_t>(plan.joints[j].element)],
                           [&](const auto& e) {
                             if constexpr (std::decay_t<decltype(e)>::role == elements::Role::joint)
                               state.turns[j] = elements::eval_joint_angle(e, f, state.turns[j]);
                           });
      }
    };
    system.walker().for_each_chunk(static_cast<std::int64_t>(plan.turning_joints.size()), element_grain,
                                   tree::make_chunk(by_joint));
  };
  state.visit([&]<class G>(const NodesOn<G>&) { count(system.instant().field_on<G>(state)); });
}

std::optional<Trouble> check_closed(const System& system, const State& state) {
  constexpr double open = 1e-6;  // of the size of the parts at the joint, or rad: far above what iterations leave
  const Violations gaps = system.constraints().violations(state);
  if (gaps.relative_position <= open) return std::nullopt;
  const std::string joint = gaps.open_joint < 0
                                ? "a joint"
                                : system.plan().joints[static_cast<std::size_t>(gaps.open_joint)].what + " '" +
                                      system.plan().joints[static_cast<std::size_t>(gaps.open_joint)].name + "'";
  return Trouble{joint + " is left open by " + std::to_string(gaps.relative_position) +
                 " of the size of the parts that meet in it (or rad)"};
}

}  // namespace bough::step
