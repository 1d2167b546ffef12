#include "bough/scene/break_limits.hpp"

#include <algorithm>

#include "problem_list.hpp"

namespace bough::scene {

double end_of_stretch(const Analysis& analysis, double begin) {
  return std::min(analysis.end_time, begin + steps_a_stretch * analysis.step_size);
}

std::string too_many_breaks(const Analysis& analysis, double begin) {
  return "changes branch more than " + std::to_string(most_breaks_a_step) + " times a step of " +
         text_of(analysis.step_size) + " s between t = " + text_of(begin) +
         " and t = " + text_of(end_of_stretch(analysis, begin)) + " s, and a step ends at each change; or its " +
         "formula is too long to find that out";
}

}  // namespace bough::scene
