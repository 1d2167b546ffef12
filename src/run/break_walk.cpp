#include "break_walk.hpp"

#include <algorithm>

#include "bough/scene/break_limits.hpp"

namespace bough::run {

BreakWalk::BreakWalk(const plan::Plan& plan, const scene::Analysis& analysis) : analysis_(analysis) {
  for (const plan::LawPlan& law : plan.laws)
    if (!law.law.is_constant()) laws_.push_back(&law);
}

bool BreakWalk::next(double begin, double& end) {
  const double least = 1e-9 * analysis_.step_size;
  for (;;) {
    while (at_ < found_.size() && !(found_[at_] > begin + least)) ++at_;
    if (at_ < found_.size() && found_[at_] < analysis_.end_time - least) {
      end = found_[at_];
      return true;
    }
    if (searched_to_ >= analysis_.end_time) {
      end = analysis_.end_time;
      return true;
    }
    const double part = stretch_ * scene::steps_a_stretch * analysis_.step_size;
    if (search(std::min(analysis_.end_time, searched_to_ + part))) continue;
    end = searched_to_;  // the run continues to this time; the next call fails
    return searched_to_ > begin + least;
  }
}

/// Searches breakpoints up to `end`. If a law has more of them than the limit in a stretch longer than usual, the
/// stretch is halved for the next search; in a stretch of usual length that is a fault.
bool BreakWalk::search(double end) {
  found_.clear();
  at_ = 0;
  std::vector<double> found;
  for (const plan::LawPlan* law : laws_) {
    const laws::Breaks breaks = law->law.breakpoints(searched_to_, end, scene::most_breaks_a_stretch);
    found.insert(found.end(), breaks.times.begin(), breaks.times.end());
    if (!breaks.is_cut) continue;
    if (stretch_ > 1.0) {
      stretch_ *= 0.5;
      return true;
    }
    fault_ = "the law of '" + law->user + "' " + scene::too_many_breaks(analysis_, searched_to_) + "; " +
             scene::fewer_breaks;
    return false;
  }
  found_ = std::move(found);
  std::sort(found_.begin(), found_.end());
  stretch_ = found_.empty() ? 2.0 * stretch_ : 1.0;
  searched_to_ = end;
  return true;
}

}  // namespace bough::run
