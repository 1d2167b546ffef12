#include "statics.hpp"

#include "largest_load.hpp"

namespace bough::run {

/// Adds the stability of the equilibria to the summary and, if an instability was found, the largest load.
void Statics::sum_up() {
  if (summary().status == records::RunStatus::ok) stability_.look_at_end(state_);
  summary().stability = stability_.seen();
  records::Stability& s = *summary().stability;
  if (s.unstable_directions > 0 || s.first_lost || !s.hidden.empty())
    s.largest_load = largest_load(scene_, plan_, state_.time, recording_.conservation().mass());
}

}  // namespace bough::run
