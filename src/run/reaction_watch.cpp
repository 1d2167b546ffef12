#include "reaction_watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "bough/elements/rows.hpp"
#include "bough/io/number_text.hpp"

namespace bough::run {

namespace {

constexpr double worth_a_look = 5e-4;  ///< relative second difference: half of TrustLimits::lost
constexpr double louder = 2.0, fading = 0.995;
constexpr int followed = 3;          ///< steps checked after the first, because gaps left by round-off are random
constexpr double growth = 3.0;       ///< amplification of local errors, as in ErrorWatch
constexpr double unresolved = 0.05;  ///< relative second difference next to a pole that steps do not resolve
constexpr double like_a_pole = 0.1;  ///< relative tolerance for four steps on c / (t - t0) + b
/// Estimated error, relative to the largest reaction, above which a run is doubted. The estimate is 1.1 to 3.6 times
/// the error of four-bars of two and three windows in steps of 0.5 to 5 ms, so errors of a hundredth or a little more
/// are doubted.
constexpr double misplaced_by = 0.014;
constexpr double least_share = 1e-3;  ///< lower bound on the scale of a reaction, relative to the largest of all joints

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
                        static_cast<std::size_t>(system.places().block_begin(j.block)) + i,
                        elements::is_length(e.rows[row].kind) ? 1.0 : 1.0 / system.moment_arm()});
    }
    w.found.joint = j.name;
    joints_.push_back(std::move(w));
  }
}

double ReactionWatch::scale_of(const Watched& w) const { return std::max(w.largest, least_share * largest_); }

/// Four values at equal steps lie on c / (t - t0) + b if and only if their cross ratio equals that of their times, 4/3.
/// The slope at an inner value is then the harmonic mean of the differences on both sides of it.
double ReactionWatch::steepness_at_pole(const Row& r, double now, double scale) {
  const double bend =
      std::max(std::abs(r.first - 2.0 * r.before_that + r.before), std::abs(r.before_that - 2.0 * r.before + now));
  if (bend < unresolved * scale) return 0.0;
  const double one = (r.first - r.before) * (r.before_that - now),
               other = 4.0 / 3.0 * (r.first - now) * (r.before_that - r.before);
  if (std::abs(one - other) > like_a_pole * std::max(std::abs(one), std::abs(other))) return 0.0;
  const std::array<double, 3> d = {r.before_that - r.first, r.before - r.before_that, now - r.before};
  // The change across the pole has the opposite sign of the two others and is the largest.
  const auto leap = static_cast<std::size_t>(
      std::max_element(d.begin(), d.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }) - d.begin());
  for (std::size_t k = 0; k < d.size(); ++k)
    if (k != leap && d[k] * d[leap] >= 0.0) return 0.0;
  const auto slope = [](double a, double b) { return a + b == 0.0 ? 0.0 : std::abs(2.0 * a * b / (a + b)); };
  return std::max(slope(d[0], d[1]), slope(d[1], d[2]));
}

/// Estimated delay of the motion: its error divided by the largest speed [s].
double ReactionWatch::delay(const step::State& state) const {
  double square = 0.0;
  for (const elements::NodeMotion& n : step::nodes_in_space(plan_, state)) {
    const motion::Vec3<double> v = lanes::linear_part(n.v), w = lanes::angular_part(n.v);
    square = std::max({square, lanes::dot(v, v) / (plan_.length_scale * plan_.length_scale), lanes::dot(w, w)});
  }
  return square > 0.0 ? growth * drift_ / std::sqrt(square) : 0.0;
}

bool ReactionWatch::wants_look(const step::State& state, double drift) {
  bool wants = false, bends = false;
  num_equal_ = num_known_ == 0 ? 0 : state.step_size != step_size_ ? 1 : std::min(num_equal_ + 1, 3);
  step_size_ = state.step_size;
  drift_ = drift;
  for (Watched& w : joints_) {
    w.bend = 0.0;
    w.steepness = 0.0;
    for (Row& r : w.rows) {
      const double now = r.weight * state.multipliers[r.multiplier];
      w.largest = std::max(w.largest, std::abs(now));
      w.bend = std::max(w.bend, std::abs(now - 2.0 * r.before + r.before_that));
      if (num_equal_ == 3) w.steepness = std::max(w.steepness, steepness_at_pole(r, now, scale_of(w)));
      r.first = r.before_that;
      r.before_that = r.before;
      r.before = now;
    }
    largest_ = std::max(largest_, w.largest);
    w.quiet *= fading;
    bends |= num_known_ == 2 && w.bend > worth_a_look * scale_of(w);
    wants |= num_known_ == 2 && w.bend > std::max(worth_a_look * scale_of(w), louder * w.quiet);
    wants |= w.steepness > 0.0;
  }
  num_known_ = std::min(num_known_ + 1, 2);
  if (wants) {
    num_due_ = followed;
  } else if (bends && num_due_ > 0) {
    --num_due_;
    wants = true;
  }
  return wants;
}

std::string ReactionWatch::misplaced() const {
  const auto part = [this](const Watched& w) { return w.shifted > 0.0 ? w.shifted / scale_of(w) : 0.0; };
  const auto worst = std::max_element(joints_.begin(), joints_.end(),
                                      [&](const Watched& a, const Watched& b) { return part(a) < part(b); });
  if (worst == joints_.end() || !(part(*worst) > misplaced_by)) return "";
  return "the reaction of '" + worst->found.joint + "' is off by about " + io::rounded_text(worst->shifted, 3) +
         " N (N m over the size of an element) near time " + io::rounded_text(worst->shifted_at, 6) + ", " +
         io::rounded_text(100.0 * part(*worst), 2) +
         " % of the largest: constraints come to depend on each other there and it passes a pole between two steps, " +
         "where the estimated error of the motion shifts it; take smaller steps or leave these times out";
}

std::optional<step::Trouble> ReactionWatch::look(step::System& system, const step::State& state) {
  std::vector<double>&rhs = system.work().rhs, &x = system.work().x;
  if (auto t = system.evaluate(state, {}, false)) return t;
  rhs = system.right_hand_side();
  if (auto t = system.linear().solve(rhs.data(), x.data())) return t;
  for (Watched& w : joints_) {
    double error = 0.0, size = 0.0;
    for (const Row& r : w.rows) {
      error = std::max(error, r.weight * std::abs(x[r.unknown]));
      size = std::max(size, r.weight * std::abs(state.multipliers[r.multiplier]));
    }
    w.quiet = std::max(w.quiet, w.bend);
    const double shifted = w.steepness > 0.0 ? w.steepness / step_size_ * delay(state) : 0.0;
    if (shifted > w.shifted) {
      w.shifted = shifted;
      w.shifted_at = state.time - step_size_;
    }
    if (error <= w.found.error) continue;
    w.found.error = error;
    w.found.size = size;
    w.found.time = state.time;
  }
  return std::nullopt;
}

std::vector<records::UnsureReaction> ReactionWatch::found() const {
  std::vector<records::UnsureReaction> list;
  for (const Watched& w : joints_) {
    if (w.found.error == 0.0) continue;
    list.push_back(w.found);
    list.back().largest = scale_of(w);
  }
  return list;
}

}  // namespace bough::run
