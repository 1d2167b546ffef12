#include "law_watch.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "bough/io/number_text.hpp"
#include "bough/laws/bounds.hpp"

namespace bough::run {

namespace {

constexpr std::size_t most_stretches = 4096;
constexpr long samples = 512;          ///< of a law over the run, for the size of its changes
constexpr double of_level = 1e-3;      ///< changes below this part of the values do not count
constexpr double negligible = 0.01;    ///< of the impulse: bounds below it are not looked at more closely
constexpr double missed_share = 0.05;  ///< of the impulse: above this the steps do not see the law
constexpr int most_work = 20000;       ///< evaluations of a law or its bounds
constexpr int most_halvings = 20;      ///< of a step

struct Piece {
  double begin, step;
  long steps;
  double bound;  ///< of the difference
  bool operator<(const Piece& other) const { return bound < other.bound; }
};

/// The comparison for one law.
class Comparison {
 public:
  explicit Comparison(const laws::Law& law) : law_(law) {}

  Piece piece(double begin, double step, long steps) {
    ++work_;
    const double duration = static_cast<double>(steps) * step;
    return {begin, step, steps,
            duration * step * step / 12.0 * laws::largest_acceleration(law_, begin, begin + duration)};
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
    if (halvings == most_halvings || work_ > most_work || piece(a, b - a, 1).bound <= tolerance) return plain;
    const double middle = 0.5 * (a + b), there = value(middle, laws::Side::right);
    return integral(a, middle, at_a, there, 0.5 * tolerance, halvings + 1) +
           integral(middle, b, there, at_b, 0.5 * tolerance, halvings + 1);
  }
  /// The difference in one step.
  double missed(const Piece& p, double tolerance) {
    const double end = p.begin + p.step, left = value(p.begin, laws::Side::right), right = value(end, laws::Side::left);
    return std::abs(integral(p.begin, end, left, right, tolerance, 0) - 0.5 * p.step * (left + right));
  }
  bool is_exhausted() const { return work_ > most_work; }

 private:
  const laws::Law& law_;
  int work_ = 0;
};

/// Integral over the run of the distance of a law from the straight line between its ends, by samples.
double impulse_of(const laws::Law& law, double begin, double end, long steps) {
  constexpr long most = 1L << 17;
  const long count = std::clamp(steps, samples, most);  // what the steps see counts
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
  constexpr long most_parts = 4096;
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
  for (const plan::LawPlan& law : plan_.laws) {
    if (law.law.is_constant()) continue;
    const double impulse = impulse_of(law.law, begin, end, steps);
    Comparison of(law.law);
    std::priority_queue<Piece> pieces;
    double missed = 0.0, seen = 0.0, most = 0.0;
    Piece worst{};
    for (const Stretch& s : stretches_) pieces.push(of.piece(s.begin, s.step, s.steps));
    while (!pieces.empty() && !of.is_exhausted()) {
      const Piece p = pieces.top();
      const double open = static_cast<double>(pieces.size()) * p.bound;
      if (!(p.bound > 0.0) || open <= negligible * (impulse + missed)) break;
      pieces.pop();
      if (p.steps > 1) {
        const long half = p.steps / 2;
        pieces.push(of.piece(p.begin, p.step, half));
        pieces.push(of.piece(p.begin + static_cast<double>(half) * p.step, p.step, p.steps - half));
      } else {
        const double here = of.missed(p, 1e-3 * negligible * (impulse + missed));
        missed += here;
        seen += p.step;
        if (here > most) {
          most = here;
          worst = p;
        }
      }
    }
    if (of.is_exhausted() && seen > 0.0) missed *= (end - begin) / seen;  // the steps looked at stand for the others
    if (!(missed > missed_share * (impulse + missed))) continue;
    Comparison finer(law.law);
    return "the steps do not see the law of '" + law.user + "': between the ends of steps it changes so much that " +
           io::rounded_text(100.0 * missed / (impulse + missed), 2) +
           " % of its impulse is missed, most of it in the step of " + io::rounded_text(worst.step, 3) +
           " s from time " + io::rounded_text(worst.begin, 6) + "; take steps of " +
           io::rounded_text(worst.step / static_cast<double>(parts_needed(finer, worst)), 2) + " s";
  }
  return {};
}

}  // namespace bough::run
