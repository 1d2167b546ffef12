#include "reaction_watch.hpp"

#include <algorithm>
#include <cmath>

#include "bough/elements/rows.hpp"

namespace bough::study {

namespace {

constexpr double worth_a_look = 5e-4;  ///< bend over the largest reaction: half of what is doubted (TrustLimits::lost)
constexpr double louder = 2.0, fading = 0.995;
constexpr double least_share = 1e-3;  ///< reactions below this part of the largest of all joints are held to that part

}  // namespace

ReactionWatch::ReactionWatch(const step::System& system) : plan_(system.plan()) {
  for (const plan::SensorPlan& s : plan_.sensors) {
    if (s.sensor.kind != scene::SensorKind::joint_reaction || s.joint < 0) continue;
    const plan::JointPlan& j = plan_.joints[static_cast<std::size_t>(s.joint)];
    if (j.block < 0 ||
        std::any_of(joints_.begin(), joints_.end(), [&](const Watched& w) { return w.joint == s.joint; }))
      continue;
    const auto& e = plan::array_of<elements::Joint>(
        plan_.elements)[static_cast<std::size_t>(plan_.directory[static_cast<std::size_t>(j.element)].index)];
    Watched w;
    w.joint = s.joint;
    for (std::size_t i = 0; i < j.rows.size(); ++i) {
      const auto row = static_cast<std::size_t>(j.rows[i]);
      w.rows.push_back({static_cast<std::size_t>(j.multiplier_begin) + row,
                        static_cast<std::size_t>(system.block_begin(j.block)) + i,
                        elements::is_length(e.rows[row].kind) ? 1.0 : 1.0 / system.moment_arm()});
    }
    w.found.joint = j.name;
    joints_.push_back(std::move(w));
  }
}

double ReactionWatch::scale_of(const Watched& w) const { return std::max(w.largest, least_share * largest_); }

bool ReactionWatch::wants_look(const step::State& state) {
  bool wants = false;
  for (Watched& w : joints_) {
    w.bend = 0.0;
    for (Row& r : w.rows) {
      const double now = r.weight * state.multipliers[r.multiplier];
      w.largest = std::max(w.largest, std::abs(now));
      w.bend = std::max(w.bend, std::abs(now - 2.0 * r.before + r.before_that));
      r.before_that = r.before;
      r.before = now;
    }
    largest_ = std::max(largest_, w.largest);
    w.quiet *= fading;
    wants |= num_known_ == 2 && w.bend > std::max(worth_a_look * scale_of(w), louder * w.quiet);
  }
  num_known_ = std::min(num_known_ + 1, 2);
  return wants;
}

std::optional<step::Trouble> ReactionWatch::look(step::System& system, const step::State& state) {
  std::vector<double>&rhs = system.work().rhs, &x = system.work().x;
  if (auto t = system.evaluate(state, {}, false)) return t;
  for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = -system.residual()[i];
  if (auto t = system.solve(rhs.data(), x.data())) return t;
  for (Watched& w : joints_) {
    double error = 0.0, size = 0.0;
    for (const Row& r : w.rows) {
      error = std::max(error, r.weight * std::abs(x[r.unknown]));
      size = std::max(size, r.weight * std::abs(state.multipliers[r.multiplier]));
    }
    w.quiet = std::max(w.quiet, w.bend);
    if (error <= w.found.error) continue;
    w.found.error = error;
    w.found.size = size;
    w.found.time = state.time;
  }
  return std::nullopt;
}

std::vector<results::UnsureReaction> ReactionWatch::found() const {
  std::vector<results::UnsureReaction> list;
  for (const Watched& w : joints_) {
    if (w.found.error == 0.0) continue;
    list.push_back(w.found);
    list.back().largest = scale_of(w);
  }
  return list;
}

}  // namespace bough::study
