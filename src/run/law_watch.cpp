#include "law_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "bough/io/number_text.hpp"
#include "bough/laws/bounds.hpp"
#include "bough/plan/elements_of.hpp"

namespace bough::run {

namespace {

constexpr std::size_t most_stretches = 4096;
constexpr long samples = 512;  ///< of a law over the run, for the size of its changes
constexpr long most_samples = 1L << 17;
constexpr long most_parts = 4096;            ///< of a step that does not see a law
constexpr double of_level = 1e-3;            ///< changes below this part of the values do not count
constexpr double negligible = 0.01;          ///< of the impulse: bounds below it are not looked at more closely
constexpr double missed_share = 0.05;        ///< of the impulse: above this the steps do not see the law
constexpr double missed_place_share = 0.04;  ///< of the range of a prescribed place, as for errors of sensors
constexpr int most_work = 20000;             ///< evaluations of a law or its bounds
constexpr int most_halvings = 20;            ///< of a step

/// Steps of equal size, and a bound of the second derivative of a law in them.
struct Piece {
  double begin, step;
  long steps;
  double acceleration;

  double duration() const { return static_cast<double>(steps) * step; }
  /// Bound of the difference between the integral and the trapezoidal sum.
  double of_impulse() const { return duration() * step * step / 12.0 * acceleration; }
  /// Bound of the distance from the straight line between the values at the ends of a step.
  double of_place() const { return step * step / 8.0 * acceleration; }
};

/// The comparison for one law.
class Comparison {
 public:
  explicit Comparison(const laws::Law& law) : law_(law) {}

  Piece piece(double begin, double step, long steps) {
    ++work_;
    const double end = begin + static_cast<double>(steps) * step;
    return {begin, step, steps, laws::largest_acceleration(law_, begin, end)};
  }
  double value(double t, laws::Side side) {
    ++work_;
    const double v = law_.at(t, side).value;
    return std::isfinite(v) ? v : 0.0;
  }
  /// The integral over [a, b] between the values there, by trapezoids that are halved where they may be wrong by more
  /// than `tolerance`.
  double integral(double a, double b, double at_a, double at_b, double tolerance, int halvings) {
    const double plain = 0.5 * (b - a) * (at_a + at_b);
    if (halvings == most_halvings || work_ > most_work || piece(a, b - a, 1).of_impulse() <= tolerance) return plain;
    const double middle = 0.5 * (a + b), there = value(middle, laws::Side::right);
    return integral(a, middle, at_a, there, 0.5 * tolerance, halvings + 1) +
           integral(middle, b, there, at_b, 0.5 * tolerance, halvings + 1);
  }
  /// The difference in one step.
  double missed(const Piece& p, double tolerance) {
    const double end = p.begin + p.step, left = value(p.begin, laws::Side::right), right = value(end, laws::Side::left);
    return std::abs(integral(p.begin, end, left, right, tolerance, 0) - 0.5 * p.step * (left + right));
  }
  /// The largest distance from the straight line between the ends of one step, to `tolerance`.
  double distance(const Piece& p, double tolerance) {
    const double end = p.begin + p.step, left = value(p.begin, laws::Side::right), right = value(end, laws::Side::left);
    return distance(p.begin, end, {p.begin, left, (right - left) / p.step}, tolerance, 0);
  }
  bool is_exhausted() const { return work_ > most_work; }

 private:
  struct Line {
    double begin, value, slope;
  };
  /// The largest distance from a line in [a, b], which is halved where more than `tolerance` may be hidden.
  double distance(double a, double b, const Line& line, double tolerance, int halvings) {
    const double middle = 0.5 * (a + b),
                 here = std::abs(value(middle, laws::Side::right) - line.value - line.slope * (middle - line.begin));
    if (halvings == most_halvings || work_ > most_work || piece(a, b - a, 1).of_place() <= tolerance) return here;
    return std::max(
        {here, distance(a, middle, line, tolerance, halvings + 1), distance(middle, b, line, tolerance, halvings + 1)});
  }

  const laws::Law& law_;
  int work_ = 0;
};

/// Integral over the run of the distance of a law from the straight line between its ends, by samples.
double impulse_of(const laws::Law& law, double begin, double end, long steps) {
  const long count = std::clamp(steps, samples, most_samples);  // what the steps see counts
  const auto value = [&](double t) {
    const double v = law.at(t).value;
    return std::isfinite(v) ? v : 0.0;
  };
  const double first = value(begin), slope = (value(end) - first) / (end - begin),
               width = (end - begin) / static_cast<double>(count);
  double sum = 0.0;
  for (long k = 0; k < count; ++k) {
    const double t = begin + static_cast<double>(k) * width, v = value(t);
    sum += width * (std::abs(v - first - slope * (t - begin)) + of_level * std::abs(v));
  }
  return sum;
}

/// Size of the changes of a law over the run, by samples.
double range_of(const laws::Law& law, double begin, double end, long steps) {
  const long count = std::clamp(steps, samples, most_samples);
  const double width = (end - begin) / static_cast<double>(count);
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (long k = 0; k <= count; ++k) {
    const double v = law.at(begin + static_cast<double>(k) * width).value;
    if (!std::isfinite(v)) continue;
    lowest = std::min(lowest, v);
    highest = std::max(highest, v);
  }
  return highest >= lowest ? highest - lowest + of_level * std::max(std::abs(lowest), std::abs(highest)) : 0.0;
}

/// By index of Plan::laws: whether it prescribes a place or an angle, of a joint or of a frame.
std::vector<bool> laws_of_places(const plan::Plan& plan) {
  std::vector<bool> found(plan.laws.size(), false);
  const auto note = [&](int law) {
    if (law >= 0 && law < static_cast<int>(found.size())) found[static_cast<std::size_t>(law)] = true;
  };
  for (const elements::Joint& joint : plan::array_of<elements::Joint>(plan.elements))
    for (int k = 0; k < joint.num_rows; ++k) note(joint.rows[k].law);
  for (const plan::FramePlan& frame : plan.frames) {
    for (const int law : frame.position) note(law);
    for (const plan::FramePlan::Turn& turn : frame.turns) note(turn.angle);
  }
  return found;
}

/// The smallest number of equal parts of a step, a power of two, with which trapezoids see what is in it.
long parts_needed(Comparison& of, const Piece& p) {
  const double end = p.begin + p.step;
  const auto sum_of = [&](long parts) {
    double sum = 0.0;
    const double h = p.step / static_cast<double>(parts);
    for (long k = 0; k < parts; ++k)
      sum += 0.5 * h *
             (of.value(p.begin + static_cast<double>(k) * h, laws::Side::right) +
              of.value(k + 1 == parts ? end : p.begin + static_cast<double>(k + 1) * h, laws::Side::left));
    return sum;
  };
  double before = sum_of(1);
  long least = 2;
  for (long parts = 2; parts <= most_parts; parts *= 2) {
    const double now = sum_of(parts);
    // What single steps miss adds up in the verdict, and cancels in the sum: half of this step is asked for.
    if (std::abs(now - before) > 0.5 * missed_share * std::max(std::abs(now), std::abs(before))) least = 4 * parts;
    before = now;
  }
  return std::min(least, most_parts);
}

/// The same with which straight lines keep within `distance` of it.
long parts_needed_for_place(Comparison& of, const Piece& p, double distance) {
  for (long parts = 2; parts < most_parts; parts *= 2) {
    const double h = p.step / static_cast<double>(parts);
    double most = 0.0;
    for (long k = 0; k < parts; ++k)
      most = std::max(most, of.distance(of.piece(p.begin + static_cast<double>(k) * h, h, 1), 0.1 * distance));
    if (most <= distance) return parts;
  }
  return most_parts;
}

/// Looks at single steps while `is_open(piece, number of pieces)` says that the one with the largest bound may hide
/// something, and halves what is more than a step.
template <class Bound, class IsOpen, class Look>
void look_where_open(Comparison& of, const std::vector<Piece>& all, Bound bound, IsOpen is_open, Look look) {
  const auto is_less = [bound](const Piece& a, const Piece& b) { return bound(a) < bound(b); };
  std::priority_queue<Piece, std::vector<Piece>, decltype(is_less)> pieces(is_less, all);
  while (!pieces.empty() && !of.is_exhausted()) {
    const Piece p = pieces.top();
    if (!(bound(p) > 0.0) || !is_open(p, pieces.size())) return;
    pieces.pop();
    if (p.steps > 1) {
      const long half = p.steps / 2;
      pieces.push(of.piece(p.begin, p.step, half));
      pieces.push(of.piece(p.begin + static_cast<double>(half) * p.step, p.step, p.steps - half));
    } else {
      look(p);
    }
  }
}

/// What the steps miss most, as a share of all that there is of its kind.
struct Missed {
  double share = 0.0;
  Piece worst{};
  long parts = 1;  ///< of the worst step, which would see it

  bool is_much = false;
};

Missed missed_impulse(const laws::Law& law, const std::vector<Piece>& all, double begin, double end, long steps) {
  const double impulse = impulse_of(law, begin, end, steps);
  Comparison of(law);
  Missed found;
  double missed = 0.0, seen = 0.0, most = 0.0;
  look_where_open(
      of, all, [](const Piece& p) { return p.of_impulse(); },
      [&](const Piece& p, std::size_t count) {
        return static_cast<double>(count) * p.of_impulse() > negligible * (impulse + missed);
      },
      [&](const Piece& p) {
        const double here = of.missed(p, 1e-3 * negligible * (impulse + missed));
        missed += here;
        seen += p.step;
        if (here > most) found.worst = p;
        most = std::max(most, here);
      });
  if (of.is_exhausted() && seen > 0.0) missed *= (end - begin) / seen;  // the steps looked at stand for the others
  if (missed > 0.0) found.share = missed / (impulse + missed);
  found.is_much = found.share > missed_share;
  if (!found.is_much) return found;
  Comparison finer(law);
  found.parts = parts_needed(finer, found.worst);
  return found;
}

Missed missed_place(const laws::Law& law, const std::vector<Piece>& all, double begin, double end, long steps) {
  const double range = range_of(law, begin, end, steps);
  Comparison of(law);
  Missed found;
  double most = 0.0;
  look_where_open(
      of, all, [](const Piece& p) { return p.of_place(); },
      [&](const Piece& p, std::size_t) { return p.of_place() > std::max(most, negligible * range); },
      [&](const Piece& p) {
        const double here = of.distance(p, negligible * range);
        if (here > most) found.worst = p;
        most = std::max(most, here);
      });
  if (most > 0.0) found.share = most / std::max(most, range);
  found.is_much = found.share > missed_place_share;
  if (!found.is_much) return found;
  Comparison finer(law);
  found.parts = parts_needed_for_place(finer, found.worst, missed_place_share * std::max(most, range));
  return found;
}

}  // namespace

LawWatch::LawWatch(const plan::Plan& plan) : plan_(plan) { stretches_.reserve(most_stretches); }

void LawWatch::pass(double begin, double end) {
  const double step = end - begin;
  if (!stretches_.empty()) {
    Stretch& last = stretches_.back();
    if (std::abs(step - last.step) <= 1e-6 * step &&
        std::abs(last.begin + static_cast<double>(last.steps) * last.step - begin) <= 1e-3 * step) {
      last.step = (end - last.begin) / static_cast<double>(++last.steps);
      return;
    }
  }
  if (stretches_.size() < most_stretches) stretches_.push_back({begin, step, 1});
}

std::string LawWatch::text() const {
  if (stretches_.empty()) return {};
  const double begin = stretches_.front().begin;
  const double end = stretches_.back().begin + static_cast<double>(stretches_.back().steps) * stretches_.back().step;
  long steps = 0;
  for (const Stretch& s : stretches_) steps += s.steps;
  const std::vector<bool> is_place = laws_of_places(plan_);
  for (std::size_t i = 0; i < plan_.laws.size(); ++i) {
    const plan::LawPlan& law = plan_.laws[i];
    if (law.law.is_constant()) continue;
    Comparison of(law.law);
    std::vector<Piece> all;
    for (const Stretch& s : stretches_) all.push_back(of.piece(s.begin, s.step, s.steps));
    Missed missed = missed_impulse(law.law, all, begin, end, steps);
    std::string what = " % of its impulse is missed";
    if (!missed.is_much && is_place[i]) {
      missed = missed_place(law.law, all, begin, end, steps);
      what = " % of its range is missed";
    }
    if (!missed.is_much) continue;
    return "the steps do not see the law of '" + law.user + "': between the ends of steps it changes so much that " +
           io::rounded_text(100.0 * missed.share, 3) + what + ", most of it in the step of " +
           io::rounded_text(missed.worst.step, 3) + " s from time " + io::rounded_text(missed.worst.begin, 6) +
           "; take steps of " + io::rounded_text(missed.worst.step / static_cast<double>(missed.parts), 2) + " s";
  }
  return {};
}

}  // namespace bough::run
